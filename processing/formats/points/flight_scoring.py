"""What scores of a flight's echoes and waveforms are made from: its truth, and a tool's result.

The truth is a folder as ``zuka simulate flight`` leaves it, or one file in it: ``beams.npz`` (per
pulse ``origin``, ``direction``, ``gps``; per true echo ``echo_beam``, ``echo_range``,
``echo_energy``, ``echo_spread``; ``noise_sigma``), ``truth.npz`` (per point ``beam``, ``packet``,
``range_m``, ``loc_ps``), ``first.npz`` (per first return ``index``, ``wave``, ``label``), and
the delivered points with waveforms in ``in`` beside that folder, which say how long packets are.
"""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.errors import BadFile, MissingInput, report_as_user_error
from processing.core.text import Text
from processing.formats.points.point_files import read_chunks, read_info
from processing.recording.columns.array_files import read_arrays
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.columns.quantisation import Quantisation
from processing.recording.waveform_packets.descriptors import DESCRIPTOR, PACKET
from processing.recording.waveform_packets.packet_samples import map_bytes, read_samples
from processing.scoring.points.six_classes import as_six_classes
from processing.scoring.waveforms.echo_scores import TrueEchoes
from processing.scoring.waveforms.flight_scores import (
    HALF_LIGHT_M_NS,
    FlightTruth,
    FoundEchoes,
    TrueWaves,
    recorded_echoes,
    rows_at,
)

_PS_IN_NS = 1000.0
_BEAMS, _POINTS, _FIRST = "beams.npz", "truth.npz", "first.npz"

# Any: arrays of whatever type the file has.
Arrays = Mapping[str, NDArray[Any]]


def read_flight_truth(path: Path) -> FlightTruth:
    """What the pulses of a flight met.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        A file of the truth or the delivered points are not there or damaged.
    """
    beams = _arrays(
        path,
        _BEAMS,
        ("origin", "direction", "gps", "echo_beam", "echo_range", "echo_energy", "echo_spread"),
    )
    sigma = float(_arrays(path, _BEAMS, ("noise_sigma",))["noise_sigma"].ravel()[0])
    points = _arrays(path, _POINTS, ("beam", "packet", "range_m", "loc_ps"))
    _, owners = np.unique(points["packet"], return_index=True)
    location_ns = points["loc_ps"][owners] / _PS_IN_NS
    first_m = points["range_m"][owners] - location_ns * HALF_LIGHT_M_NS
    order = np.lexsort((beams["echo_range"], beams["echo_beam"]))
    pulse = beams["echo_beam"][order].astype(np.int64)
    range_m = beams["echo_range"][order]
    recorded = recorded_echoes(
        pulse, range_m, points["beam"][owners].astype(np.int64), first_m, _span_m(path)
    )
    return FlightTruth(
        beams["gps"],
        beams["origin"],
        beams["direction"],
        TrueEchoes(
            pulse,
            range_m,
            beams["echo_spread"][order].astype(np.float64),
            beams["echo_energy"][order].astype(np.float64) / sigma,
            recorded,
        ),
    )


def read_true_waves(path: Path) -> TrueWaves:
    """The cleaned waveforms of first returns; plants of any height are one class.

    Raises
    ------
    MissingInput, NoSpace, BadFile
    """
    first = _arrays(path, _FIRST, ("index", "wave", "label"))
    beam = _arrays(path, _POINTS, ("beam",))["beam"]
    gps = _arrays(path, _BEAMS, ("gps",))["gps"]
    index = first["index"].astype(np.int64)
    if index.size and not 0 <= int(index.min()) <= int(index.max()) < beam.size:
        raise _damaged(_file_of(path, _FIRST), "index")
    return TrueWaves(
        gps[beam[index]],
        first["wave"].astype(np.float64),
        as_six_classes(first["label"].astype(np.uint8)),
    )


def read_found_echoes(path: Path) -> FoundEchoes:
    """The points of a decomposed flight.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, or has no times.
    """
    info = read_info(path)
    if not info.has_time:
        raise _without(path, Text("The points have no times.", "点に時刻がありません。"))
    quantisation = Quantisation(info.scale, info.offset)
    times: list[Floats] = [np.empty(0)]
    places: list[Floats] = [np.empty((0, 3))]
    for chunk in read_chunks(path):
        times.append(chunk.columns["time"])
        places.append(quantisation.metres(chunk.columns["xyz"]))
    return FoundEchoes(np.concatenate(times), np.concatenate(places))


def read_found_waves(path: Path, truth: TrueWaves) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Waveforms of a truth's first returns, (n, samples) counts, and which the file has.

    The count that a waveform has is its sample x gain + offset; behind a packet's end it is 0.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, has no times or no waveforms, or none of these returns.
    """
    info = read_info(path)
    told = info.waveforms
    if not info.has_time or told is None or not told.is_readable:
        reason = Text("", "") if told is None else told.reason
        what = Text("The points have no times or no waveforms.", "点に時刻か波形がありません。")
        if reason.en:
            what = Text("No waveforms: {why}.", "波形がありません（{why}）。").filled(why=reason)
        raise _without(path, what)
    waves = np.zeros((len(truth.waves), truth.waves.shape[1]), np.float32)
    has_wave = np.zeros(len(waves), np.bool_)
    pages = MappedPages()
    data = map_bytes(told.path, pages)[told.first_byte :]
    for chunk in read_chunks(path):
        columns = chunk.columns
        mine = np.flatnonzero((columns["return_number"] == 1) & (columns[PACKET] >= 0))
        rows = rows_at(truth.time_s, columns["time"][mine])
        mine, rows = mine[rows >= 0], rows[rows >= 0]
        for number in np.unique(columns[DESCRIPTOR][mine]).tolist():
            one = told.descriptors[number]
            some = columns[DESCRIPTOR][mine] == number
            size = int(some.sum())
            read = np.empty((size, one.samples), np.float32)
            lengths = np.full(size, one.samples, np.int32)
            widths = np.full(size, one.bits // 8, np.int32)
            starts = columns[PACKET][mine[some]].astype(np.int64)
            read_samples(data, starts, lengths, widths, read)
            most = min(one.samples, waves.shape[1])
            waves[rows[some], :most] = read[:, :most] * one.gain + one.offset
        has_wave[rows] = True
    if not has_wave.any():
        raise other_flight(path)
    return waves, has_wave


def other_flight(path: Path) -> BadFile:
    """A result of which nothing has the time of a pulse of the truth."""
    return BadFile(
        Text(
            "No point has the time of a pulse of the truth.",
            "正解データのパルスと同じ時刻の点がありません。",
        ),
        Text.same(str(path)),
        Text(
            "Name the result and the truth of the same flight.",
            "同じ飛行の結果と正解データを指定してください。",
        ),
    )


def _file_of(path: Path, name: str) -> Path:
    """A file of the truth, whichever of them, or their folder, was named."""
    if path.is_dir():
        inner = path / "truth" / name
        return inner if inner.is_file() else path / name
    return path.with_name(name)


def _arrays(path: Path, name: str, wanted: tuple[str, ...]) -> Arrays:
    file = _file_of(path, name)
    try:
        with report_as_user_error(file):
            found = read_arrays(file)
    except (ValueError, EOFError, zipfile.BadZipFile, KeyError) as error:
        raise _damaged(file, "") from error
    for one in wanted:
        if one not in found:
            raise _damaged(file, one)
    return found


def _span_m(path: Path) -> float:
    """How far the packets of the delivered points reach; their longest descriptor's span."""
    folder = _file_of(path, _BEAMS).parent.parent / "in"
    for file in sorted((*folder.glob("*.las"), *folder.glob("*.laz"))):
        told = read_info(file).waveforms
        known = (
            [] if told is None else [one for one in told.descriptors.values() if one.is_readable]
        )
        if known:
            return max(one.samples * one.interval_ns for one in known) * HALF_LIGHT_M_NS
    raise MissingInput(
        Text(
            "No delivered points with waveforms say how long the records of the truth are.",
            "正解データの記録長を示す波形付きの納品点群がありません。",
        ),
        Text.same(str(folder)),
        Text(
            "Keep the flight's LAS with waveforms in the folder “in” beside its truth.",
            "波形付きLASを、正解データのフォルダと並ぶ in フォルダに置いてください。",
        ),
    )


def _damaged(file: Path, array: str) -> BadFile:
    where = f"{file}, {array}" if array else str(file)
    return BadFile(
        Text(
            "The truth of the flight is damaged or lacks an array.",
            "飛行の正解データが壊れているか、配列が足りません。",
        ),
        Text.same(where),
        Text(
            "Name the truth folder that “zuka simulate flight” writes, or a file in it.",
            "zuka simulate flight が書き出す truth フォルダ、またはその中のファイルを"
            "指定してください。",
        ),
    )


def _without(path: Path, what: Text) -> BadFile:
    return BadFile(
        what,
        Text.same(str(path)),
        Text(
            "Name what the tool wrote: LAS or LAZ with gps_time.",
            "ツールが書き出した、gps_time のあるLAS・LAZを指定してください。",
        ),
    )
