"""Which way the directions of pulses lead: the standard leaves it open, and writers differ."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.recording.columns.columns import Columns
from processing.recording.columns.quantisation import Quantisation
from processing.recording.waveform_packets.descriptors import DIRECTION, KEY_OF_FILE, LOCATION
from processing.recording.waveform_packets.pulse_index import KEYS, POINTS, STARTS

BY_RETURNS, DOWNWARDS = "returns", "down"

_MOST_PULSES = 100_000
"""A vote: some hundred would do, more cost nothing."""

_STEEP = 0.7
"""Sine of how steep a flight's rays are: less than 45 degrees from the plumb line, where scanners
on vehicles and tripods turn through the horizon."""

_CLEAR_SHARE = 0.9
"""So many must agree: rounding turns some of very near returns round, a wrong sign turns all."""


@dataclass(frozen=True)
class RaySign:
    """Whether directions lead to the sensor, and what told it, as :class:`PacketFile` says."""

    towards_sensor: bool
    told_by: str


def is_from_air(directions: NDArray[np.float32]) -> bool:
    """Whether rays are those of a flight: nearly all of them steep.

    Parameters
    ----------
    directions : (n, 3) float32
        Of either sign; zeros tell nothing.
    """
    lengths = np.linalg.norm(directions, axis=1)
    known = lengths > 0
    if not known.any():
        return False
    steep = np.abs(directions[known, 2]) > _STEEP * lengths[known]
    return bool(steep.mean() > _CLEAR_SHARE)


def ray_signs(folder: Path, count: int, quantisation: Quantisation) -> dict[int, RaySign]:
    """The sign of the rays of each file whose packets a drive folder has.

    Later returns of a pulse lie farther from the sensor, so their difference leads away from it.
    Where no packet has two returns, light that goes down is taken for a flight's. Where neither
    tells, directions lead to the sensor, as LASlib and rlas read them.

    Parameters
    ----------
    folder : Path
        With the index of its pulses.
    """
    keys = np.fromfile(folder / KEYS, "<i8")
    starts = np.fromfile(folder / STARTS, "<i8")
    points = np.memmap(folder / POINTS, "<i8", "r") if keys.size else np.empty(0, "<i8")
    columns = Columns(folder, count)
    files = keys // KEY_OF_FILE
    signs = {}
    for number in np.unique(files).tolist():
        mine = np.flatnonzero(files == number)
        several = mine[np.diff(starts)[mine] > 1]
        told = _sign_by_returns(several, starts, points, columns, quantisation)
        signs[number] = told or _sign_by_height(mine, starts, points, columns)
    return signs


def _sign_by_returns(
    pulses: Integers,
    starts: Integers,
    points: Integers,
    columns: Columns,
    quantisation: Quantisation,
) -> RaySign | None:
    pulses = _some(pulses)
    one, other = points[starts[pulses]], points[starts[pulses + 1] - 1]
    later = columns[LOCATION][other].astype(np.float64) - columns[LOCATION][one]
    apart = quantisation.metres(columns["xyz"][other]) - quantisation.metres(columns["xyz"][one])
    along = (apart * columns[DIRECTION][one]).sum(axis=1) * np.sign(later)
    return _voted(along, BY_RETURNS, towards_sensor_is_negative=True)


def _sign_by_height(
    pulses: Integers, starts: Integers, points: Integers, columns: Columns
) -> RaySign:
    up = columns[DIRECTION][points[starts[_some(pulses)]]][:, 2].astype(np.float64)
    told = _voted(up, DOWNWARDS, towards_sensor_is_negative=False)
    return told or RaySign(towards_sensor=True, told_by="")


def _some(pulses: Integers) -> Integers:
    return pulses[:: max(1, -(-pulses.size // _MOST_PULSES))]


def _voted(values: Floats, by: str, *, towards_sensor_is_negative: bool) -> RaySign | None:
    votes = np.sign(values[values != 0])
    if not votes.size:
        return None
    share = float((votes > 0).mean())
    if max(share, 1 - share) < _CLEAR_SHARE:
        return None
    return RaySign((share < 1 - share) == towards_sensor_is_negative, by)
