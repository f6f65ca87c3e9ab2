"""Pulse folders: a line scanner's own pulses and echoes, one folder of plain numbers an attribute.

The layout of the LI3DS project: ``pulse-float32-theta/NAME.bin`` has a value for every pulse that
was fired, ``echo-float32-range/NAME.bin`` one for every echo, ``pulse-uint8-n_echo`` says how many
echoes a pulse has, ``pulse-linear-time/NAME.txt`` when pulses were fired. All little endian.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile

_FOLDER = re.compile(r"(pulse|echo)-(float32|uint8)-(\w+)")
_DTYPES = {"float32": "<f4", "uint8": "u1"}
_TIME_FOLDER = "pulse-linear-time"
_LINEAR_TIME = re.compile(r"(\d+) entries ([\d.eE+-]+) \+ ([\d.eE+-]+) pulse_index")
_LONGEST_TEXT = 1_000


@dataclass(frozen=True)
class _Layout:
    """The folders of one recording: attribute to folder and dtype."""

    path: Path
    pulse: dict[str, tuple[Path, str]]
    echo: dict[str, tuple[Path, str]]


def is_pulse_folder(path: Path) -> bool:
    """Whether a folder holds pulses and echoes as this format lays them out."""
    return (path / _TIME_FOLDER).is_dir() and (path / "pulse-uint8-n_echo").is_dir()


def open_pulse_folder(path: Path) -> FloatFile:
    """The echoes of a recording, in the scanner's own frame.

    The scan plane stands upright, its up side where most pulses have no echo: the sky. ``x`` is
    to the side, ``y`` along the spin axis, ``z`` up, from the scanner, in metres.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        An attribute is missing, or the numbers of values don't agree.
    """
    with report_as_user_error(path):
        layout = _layout_of(path)
    for kind, name in (("pulse", "theta"), ("pulse", "n_echo"), ("echo", "range")):
        if name not in (layout.pulse if kind == "pulse" else layout.echo):
            raise _make_damage_error(
                path, Text(f"There is no {kind} {name}.", f"{kind} の {name} がありません。")
            )
    return FloatFile(path, "pulse folder", lambda: _blocks(layout))


def _layout_of(path: Path) -> _Layout:
    layout = _Layout(path, {}, {})
    for folder in sorted(path.iterdir()):
        found = _FOLDER.fullmatch(folder.name)
        if found and folder.is_dir():
            attributes = layout.pulse if found.group(1) == "pulse" else layout.echo
            attributes[found.group(3)] = (folder, _DTYPES[found.group(2)])
    return layout


def _blocks(layout: _Layout) -> Iterator[ColumnBlock]:
    with report_as_user_error(layout.path):
        names = sorted(file.stem for file in layout.pulse["n_echo"][0].glob("*.bin"))
    up: float | None = None
    for name in names:
        echoes = _read(layout.pulse, "n_echo", name)
        theta = _read_numbers(layout.pulse, "theta", name)
        if theta.size != echoes.size:
            raise _sizes_differ(layout.path, name, theta.size, echoes.size)
        up = _up_angle(theta, echoes) if up is None else up
        yield _block(layout, name, theta - up, echoes.astype(np.int64))


def _block(
    layout: _Layout, name: str, theta: NDArray[np.float64], echoes: NDArray[np.int64]
) -> ColumnBlock:
    pulse_of_echo = np.repeat(np.arange(echoes.size), echoes)
    ranges = _read_numbers(layout.echo, "range", name)
    if ranges.size != pulse_of_echo.size:
        raise _sizes_differ(layout.path, name, ranges.size, pulse_of_echo.size)
    phi = np.zeros(echoes.size)
    if "phi" in layout.pulse:
        phi = _read_numbers(layout.pulse, "phi", name)
    angle, tilt = theta[pulse_of_echo], phi[pulse_of_echo]
    first_echo = np.cumsum(echoes) - echoes
    block: ColumnBlock = {
        "xyz": np.column_stack(
            [
                ranges * np.cos(tilt) * np.sin(angle),
                ranges * np.sin(tilt),
                ranges * np.cos(tilt) * np.cos(angle),
            ]
        ),
        "time": _times(layout.path, name, echoes.size)[pulse_of_echo],
        "return_number": np.arange(ranges.size) - first_echo[pulse_of_echo] + 1,
        "number_of_returns": echoes[pulse_of_echo],
    }
    strength = next((key for key in ("reflectance", "amplitude") if key in layout.echo), None)
    if strength is not None:
        block["intensity"] = _read(layout.echo, strength, name)
    return block


def _up_angle(theta: NDArray[np.float64], echoes: NDArray[np.generic]) -> float:
    """Where the sky is: the mean direction of the pulses without an echo, rad."""
    empty = theta[(echoes == 0) & np.isfinite(theta)]
    return float(np.angle(np.exp(1j * empty).sum())) if empty.size else 0.0


def _read_numbers(
    attributes: dict[str, tuple[Path, str]], attribute: str, name: str
) -> NDArray[np.float64]:
    """As :func:`_read`; what is no finite number is NaN, and such echoes are passed over later."""
    with np.errstate(invalid="ignore"):
        values = _read(attributes, attribute, name).astype(np.float64)
    values[~np.isfinite(values)] = np.nan
    return values


def _read(
    attributes: dict[str, tuple[Path, str]], attribute: str, name: str
) -> NDArray[np.generic]:
    folder, dtype = attributes[attribute]
    path = folder / f"{name}.bin"
    with report_as_user_error(path):
        if path.stat().st_size % np.dtype(dtype).itemsize:
            raise _make_damage_error(
                path, Text("The file ends inside a value.", "ファイルが値の途中で終わっています。")
            )
        return np.fromfile(path, dtype=dtype)


def _times(folder: Path, name: str, pulses: int) -> NDArray[np.float64]:
    path = folder / _TIME_FOLDER / f"{name}.txt"
    with report_as_user_error(path), path.open("rb") as file:
        words = file.read(_LONGEST_TEXT).decode("utf-8", errors="replace")
    found = _LINEAR_TIME.match(words)
    if found is None:
        raise _make_damage_error(path, Text("The times can't be read.", "時刻を読み取れません。"))
    times: NDArray[np.float64] = float(found.group(2)) + float(found.group(3)) * np.arange(
        pulses, dtype=np.float64
    )
    return times


def _sizes_differ(folder: Path, name: str, found: int, wanted: int) -> BadFile:
    what = Text(
        f"The numbers of values don't agree: {found:,} and {wanted:,}.",
        f"値の数が一致しません（{found:,} と {wanted:,}）。",
    )
    return _make_damage_error(folder / name, what)


def _make_damage_error(path: Path, what: Text) -> BadFile:
    return BadFile(
        what,
        Text.same(str(path)),
        Text(
            "Copy the folder again from the delivery. {unchanged}",
            "納品データからフォルダをコピーし直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
