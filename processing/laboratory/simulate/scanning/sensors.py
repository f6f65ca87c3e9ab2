"""Scanners as their makers describe them, and how they are mounted."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

from processing.core.errors import BadFile, name_with_type, report_as_user_error
from processing.core.text import Text
from resources import path_of

_LIMITS = {
    "turns_per_s": (0.1, 1000.0),
    "pulses": (1, 50_000),
    "most_m": (1.0, 5000.0),
    "noise_m": (1e-6, 1.0),
    "exit_m": (0.0, 1.0),
    "divergence_rad": (1e-6, 0.1),
    "returns": (1, 15),  # as many as LAS 1.4 can count
}
"""What any scanner lies within, by far: own files are refused beyond."""


@dataclass(frozen=True)
class Head:
    """One scanner on the vehicle.

    Attributes
    ----------
    name : str
        Of its files: ``left``, ``right``.
    source_id : int
        Its ``point_source_id``.
    lever_m : (3,) float
        From the trajectory's reference point: forward, left, up.
    yaw_deg, pitch_deg : float
        Where the axis points about which the mirror spins: to the left of forward, and up.
    """

    name: str
    source_id: int
    lever_m: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float


@dataclass(frozen=True)
class Sensor:
    """A scanner.

    Attributes
    ----------
    kind : str
        ``mobile`` or ``standing`` (on a tripod).
    turns_per_s : float
        Of the mirror.
    pulses : int
        In one revolution.
    measures_by : str
        ``pulse``, or ``phase``: one return, folded beyond its range of unambiguity, and arcs.
    most_m : float
        Reach for a surface of 80 %; of a phase-based one its range of unambiguity.
    noise_m : float
        Standard deviation of a range to a bright surface 10 m away.
    exit_m, divergence_rad : float
        Width of the beam where it leaves, and how fast it widens.
    returns : int
        Most returns of one pulse.
    heads : tuple of Head
        As usually mounted; empty for one on a tripod.
    """

    id: str
    name: Text
    kind: Literal["mobile", "standing"]
    turns_per_s: float
    pulses: int
    measures_by: Literal["pulse", "phase"]
    most_m: float
    noise_m: float
    exit_m: float
    divergence_rad: float
    returns: int
    heads: tuple[Head, ...] = ()

    @property
    def rate_hz(self) -> float:
        """Pulses per second of one head."""
        return self.turns_per_s * self.pulses


def _sensors_in(text: str) -> dict[str, Sensor]:
    table = tomllib.loads(text)
    mounts = {
        name: tuple(Head(**{**head, "lever_m": _position(head["lever_m"])}) for head in heads)
        for name, heads in table.get("mount", {}).items()
    }
    sensors = {}
    for one in table["sensor"]:
        facts = dict(one)
        name, mount = Text.same(facts.pop("name")), facts.pop("mount", None)
        heads = () if mount is None else mounts[mount]
        sensors[facts["id"]] = Sensor(**facts, name=name, heads=heads)
    return sensors


def _position(numbers: list[float]) -> tuple[float, float, float]:
    forward, left, up = (float(one) for one in numbers)
    return forward, left, up


SENSORS = _sensors_in(path_of("catalogue/sensors.toml").read_text(encoding="utf-8"))


def sensor_of(name: str, kind: str, own: str = "") -> Sensor:
    """The sensor of a name.

    Parameters
    ----------
    kind : {"mobile", "standing"}
    own : str
        Path of a file of sensors and mountings in the form of ``sensors.toml``; its first sensor
        of this kind is taken in place of the one of the name. Empty for none.

    Raises
    ------
    OutOfRange
        There is none of this kind; names those there are.
    BadFile, MissingInput, NoSpace
        The file can't be read, or doesn't describe a sensor of this kind.
    """
    if own:
        return _own_sensor(Path(own), kind)
    known = {one.id: one for one in SENSORS.values() if one.kind == kind}
    nothing = Text("There is no such sensor for this.", "この用途に使えるセンサーではありません。")
    return name_with_type(known, name, nothing)


def _own_sensor(path: Path, kind: str) -> Sensor:
    with report_as_user_error(path):
        content = path.read_bytes()
    try:
        sensors = _sensors_in(content.decode("utf-8"))
        sensor = next(one for one in sensors.values() if one.kind == kind)
        _check(sensor)
    except (StopIteration, KeyError, TypeError, ValueError, AttributeError) as error:
        raise BadFile(
            Text(
                "The file doesn't describe a sensor for this ({why}).",
                "この用途に使えるセンサーの記述がありません（{why}）。",
            ).filled(why=str(error) or kind),
            Text.same(str(path)),
            Text(
                "Write it like the program's own sensors.toml: a sensor, and for a vehicle the "
                "heads of its mounting.",
                "プログラム付属のsensors.tomlにならって、センサーと、"
                "車載の場合は取付けの各ヘッドを記述してください。",
            ),
        ) from error
    return sensor


def _check(sensor: Sensor) -> None:
    """Refuse what no scanner is.

    Raises
    ------
    ValueError
    """
    for name, (low, high) in _LIMITS.items():
        _check_number(name, getattr(sensor, name), low, high)
    if sensor.measures_by not in ("pulse", "phase"):
        raise ValueError(f"measures_by = {sensor.measures_by}")
    if sensor.kind == "mobile" and not sensor.heads:
        raise ValueError("mount")
    for head in sensor.heads:
        _check_head(head)
    if len({head.name for head in sensor.heads}) < len(sensor.heads):
        raise ValueError("mount.name")


def _check_head(head: Head) -> None:
    # Files are named after it.
    if not isinstance(head.name, str) or not re.fullmatch(r"[\w-]+", head.name):
        raise ValueError(f"mount.name = {head.name}")
    _check_number("mount.source_id", head.source_id, 0, 65_535)
    for angle in (head.yaw_deg, head.pitch_deg):
        _check_number("mount.yaw_deg, pitch_deg", angle, -360, 360)
    for position in head.lever_m:
        _check_number("mount.lever_m", position, -20, 20)


def _check_number(name: str, value: object, low: float, high: float) -> None:
    is_whole = name in ("pulses", "returns", "mount.source_id")
    is_number = isinstance(value, int if is_whole else (int, float)) and value is not True
    if not is_number or not low <= cast("float", value) <= high:
        raise ValueError(f"{name} = {value} ({low:g} … {high:g})")
