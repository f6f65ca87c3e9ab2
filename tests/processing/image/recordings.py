"""Recordings for tests of the image: pulses with known turns, and small drives on disk."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.text import Text
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.recording.drive_info import DriveInfo, read_drive_info, write_drive_info
from processing.recording.revolutions.revolutions import Revolutions
from processing.recording.revolutions.revolutions_file import write_revolutions
from tests.builders import SimulatedDrive, simulated_drive


@dataclass(frozen=True)
class PulsedRecording:
    """Pulses of points, and the turns they were fired in."""

    pulses: Integers
    revolutions: Revolutions


def revolutions_of(
    folds: Integers,
    *,
    row_ends: Integers | None = None,
    segments: NDArray[np.int32] | None = None,
    pulse_rate_hz: float = 1000.0,
) -> Revolutions:
    """Turns that begin at given pulses."""
    rows = folds.size - 1
    return Revolutions(
        method="trajectory",
        revolution_rate_hz=pulse_rate_hz / float(np.median(np.diff(folds))),
        pulse_rate_hz=pulse_rate_hz,
        pulses_per_revolution=float(np.median(np.diff(folds))),
        reference_times=folds / pulse_rate_hz,
        fold_pulses=folds,
        segments=np.zeros(rows, np.int32) if segments is None else segments,
        row_ends=folds[1:].copy() if row_ends is None else row_ends,
        coherence=1.0,
    )


def random_recording(
    seed: int,
    *,
    pulses_per_revolution: int,
    revolutions: int,
    lost_share: float = 0.2,
    double_share: float = 0.1,
    stop_pulses: int = 0,
) -> PulsedRecording:
    """Turns of slightly different lengths; with a stop in the middle of a turn if wanted.

    Some pulses come before the first fold and some after the last, as in a real recording.
    """
    random = np.random.default_rng(seed)
    wander = min(2, pulses_per_revolution - 1)
    lengths = pulses_per_revolution + random.integers(-wander, wander + 1, revolutions)
    first = int(random.integers(0, 3 * pulses_per_revolution))
    folds = first + np.concatenate([[0], np.cumsum(lengths)])
    last = int(folds[-1] + random.integers(0, 2 * pulses_per_revolution))
    pulses = np.arange(max(0, first - int(random.integers(0, 2 * pulses_per_revolution))), last + 1)
    row_ends, segments = folds[1:].copy(), np.zeros(revolutions, np.int32)
    if stop_pulses and revolutions > 1:
        row = int(random.integers(1, revolutions))
        stop = int(folds[row] - random.integers(1, pulses_per_revolution - wander))
        row_ends[row - 1] = stop
        segments[row:] = 1
        folds[row:] += stop_pulses
        row_ends[row:] += stop_pulses
        pulses = np.where(pulses >= stop, pulses + stop_pulses, pulses)
    kept = pulses[random.random(pulses.size) >= lost_share]
    kept = kept if kept.size else pulses[:1]
    times = 1 + (random.random(kept.size) < double_share)
    return PulsedRecording(
        np.repeat(kept, times).astype(np.int64),
        revolutions_of(folds, row_ends=row_ends, segments=segments),
    )


def drive_of(simulated: SimulatedDrive, folder: Path, **more: NDArray[Any]) -> Drive:
    """A drive folder with the true pulses and turns of a simulated recording.

    Parameters
    ----------
    more : array
        Further columns by name.
    """
    folder.mkdir(parents=True)
    columns = {name: values for name, values in simulated.columns.items() if name != "scanner"}
    count = simulated.count
    with ColumnWriter(folder) as writer:
        writer.append(
            {
                **columns,
                **more,
                "pulse": simulated.pulse,
                "source_index": np.arange(count),
                "source_file": np.zeros(count),
            }
        )
    write_revolutions(folder, true_revolutions(simulated))
    lowest, highest = simulated.xyz.min(axis=0), simulated.xyz.max(axis=0)
    write_drive_info(folder, info_of(folder.name, count, simulated, (lowest, highest)))
    return Drive(folder)


def true_revolutions(simulated: SimulatedDrive) -> Revolutions:
    """Turns of a simulated recording without a stop, from its fold times."""
    times = simulated.fold_times[~np.isnan(simulated.fold_times)]
    start = float(simulated.columns["time"][0]) - simulated.pulse[0] / simulated.pulse_rate_hz
    folds = np.rint((times - start) * simulated.pulse_rate_hz).astype(np.int64)
    return revolutions_of(folds, pulse_rate_hz=simulated.pulse_rate_hz)


def info_of(
    name: str,
    count: int,
    simulated: SimulatedDrive,
    extent: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> DriveInfo:
    """Facts on a drive."""
    lowest, highest = ((float(e[0]), float(e[1]), float(e[2])) for e in extent)
    return DriveInfo(
        id=name,
        name=name,
        scanner=1,
        count=count,
        scale=simulated.scale,
        offset=simulated.offset,
        lowest=lowest,
        highest=highest,
        crs="EPSG:6677",
        sources=(),
        clock_offset_s=0.0,
        rows_by="trajectory",
    )


def small_drive(folder: Path, seed: int = 0, **changes: Any) -> tuple[Drive, SimulatedDrive]:
    """A drive of some 10,000 points with its truth."""
    simulated = simulated_drive(seed, length_m=4.0, **changes)
    return drive_of(simulated, folder), simulated


def without_revolutions(drive: Drive) -> Drive:
    """The same folder as a top view of one cell per pulse."""
    (drive.folder / "revolutions.npz").unlink()
    info = dataclasses.replace(
        read_drive_info(drive.folder),
        rows_by="top-view",
        rows_reason=Text("The points have no times.", "点に時刻がありません。"),
        cell_m=0.1,
        cells_per_row=400,
    )
    write_drive_info(drive.folder, info)
    return Drive(drive.folder)
