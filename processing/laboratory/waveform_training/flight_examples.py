"""Packets of a flight as the network sees them, beside the waveforms that they truly had."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.waveforms.estimation.drive_waveforms import EVEN_ENERGY
from processing.methods.waveforms.estimation.flown_path import flown_path
from processing.methods.waveforms.estimation.known_pulse import response_of
from processing.methods.waveforms.estimation.packet_inputs import (
    F32,
    PacketDescriber,
    PulseReturns,
    brightness_of,
)
from processing.methods.waveforms.estimation.pulse_returns import (
    FIRST_SAMPLE_NS,
    GroupedReturns,
    packets_of_returns,
)
from processing.methods.waveforms.estimation.ray_kernels import Neighbours
from processing.methods.waveforms.pulse_file import read_pulse

CLASSES = (2, 5, 6, 11, 14, 15)
"""Ground, vegetation, building, road, wire, tower: of the same number of examples, where a flight
has so many."""

_LOW_PLANTS, _PLANTS, _WIRE = 4, 5, 14
_AREA_CELL_M = 2.0
_INTENSITIES = 65_536
_AT_FIRST = slice(int(FIRST_SAMPLE_NS) - 2, int(FIRST_SAMPLE_NS) + 4)
"""Samples of the first return's maximum."""


@dataclass(frozen=True, eq=False)
class FlightExamples:
    """Packets of first returns of one flight, n of them.

    Attributes
    ----------
    channels : (n, c, SAMPLES) float16
    facts : (n, f) float32
    plain : (n, SAMPLES) float32
        In units of the packet's strongest return, as what the network answers.
    true : (n, SAMPLES) float32
        Waveforms in the same unit.
    bright : (n,) float32
        Strongest return in units of the flight's usual one.
    counts : (n,) float32
        Of the recorded samples, in one unit of the packet.
    label : (n,) uint8
        Class of `CLASSES`.
    pulse : (p,) float32
        The scanner's, by ns, as the network has it.
    """

    channels: NDArray[np.float16]
    facts: F32
    plain: F32
    true: F32
    bright: F32
    counts: F32
    label: NDArray[np.uint8]
    pulse: F32

    def write(self, path: Path) -> None:
        """Keep them."""
        names = [one.name for one in dataclasses.fields(self)]
        np.savez_compressed(path, **{name: getattr(self, name) for name in names})

    @staticmethod
    def read(path: Path) -> FlightExamples:
        """What :meth:`write` kept."""
        with np.load(path) as kept:
            return FlightExamples(**{name: kept[name] for name in kept})


class _Delivery(NamedTuple):
    """Returns of a flight in the order of their packets; xyz from their middle, m."""

    xyz: Floats
    time: Floats
    energy: F32
    grouped: GroupedReturns


def examples_of(
    folder: Path, most: int, random: np.random.Generator, *, knows_intensity: bool
) -> FlightExamples:
    """Examples of a flight as ``zuka simulate flight`` leaves it.

    Parameters
    ----------
    most : int
        Of a class.
    """
    delivery = _delivery(folder, knows_intensity=knows_intensity)
    grouped, xyz = delivery.grouped, delivery.xyz
    packets = grouped.owner.size
    numbers, waves, label = _truth(folder, grouped, most, random)
    firsts = np.zeros(xyz.shape[0], np.bool_)
    firsts[grouped.owner] = True
    levels = delivery.energy.astype(np.int64)
    brightness = brightness_of(
        np.bincount(levels, minlength=_INTENSITIES),
        np.bincount(levels[firsts], minlength=_INTENSITIES),
    )
    cells = np.unique((xyz[:, :2] // _AREA_CELL_M).astype(np.int64), axis=0)
    spacing_m = float(np.sqrt(len(cells) * _AREA_CELL_M**2 / packets))
    pulse = response_of(*read_pulse(folder / "in" / "system_pulse.csv"))
    row_of = np.full(packets, -1, np.int64)
    row_of[numbers] = np.arange(numbers.size)
    row = row_of[grouped.packet]
    own = np.flatnonzero(row >= 0)
    returns = PulseReturns(
        xyz[own], delivery.energy[own], row[own], grouped.after_ns[own], firsts[own]
    )
    energy = (delivery.energy / brightness.usual).astype(np.float32)
    describer = PacketDescriber(pulse, brightness, spacing_m, knows_intensity)
    directions = _directions(delivery)[numbers]
    seen = describer.inputs(returns, directions, Neighbours(xyz, energy, row, firsts))
    alone = np.bincount(returns.packet) == 1
    counts = seen.top * _counts_of_energy(waves, seen.plain * seen.top[:, None], alone, label)
    return FlightExamples(
        seen.channels.astype(np.float16),
        seen.facts,
        seen.plain,
        (waves / counts[:, None]).astype(np.float32),
        (seen.top / brightness.usual).astype(np.float32),
        counts.astype(np.float32),
        label,
        pulse.by_ns,
    )


def _delivery(folder: Path, *, knows_intensity: bool) -> _Delivery:
    cloud = laspy.read(folder / "in" / "points.laz")
    xyz, time = np.asarray(cloud.xyz), np.asarray(cloud.gps_time)
    grouped = packets_of_returns(xyz, time, np.asarray(cloud.return_number, np.uint8))
    if knows_intensity:
        energy = np.asarray(cloud.intensity, np.float32)[grouped.order]
    else:
        energy = (EVEN_ENERGY / np.bincount(grouped.packet)[grouped.packet]).astype(np.float32)
    return _Delivery((xyz - xyz.mean(axis=0))[grouped.order], time[grouped.order], energy, grouped)


def _truth(
    folder: Path, grouped: GroupedReturns, most: int, random: np.random.Generator
) -> tuple[Integers, F32, NDArray[np.uint8]]:
    """Packets of drawn first returns, rising; their cleaned waveforms, counts; their classes."""
    with np.load(folder / "truth" / "first.npz") as first:
        index, waves, label = first["index"], first["wave"], first["label"].astype(np.uint8)
    label[label == _LOW_PLANTS] = _PLANTS
    drawn = [random.permutation(np.flatnonzero(label == one))[:most] for one in CLASSES]
    place = np.empty(grouped.order.size, np.int64)
    place[grouped.order] = np.arange(grouped.order.size)
    some = np.concatenate(drawn)
    numbers = grouped.packet[place[index[some]]]
    order = np.argsort(numbers)
    some = some[order]
    return numbers[order], waves[some].astype(np.float32), label[some]


def _directions(delivery: _Delivery) -> Floats:
    """(k, 3) of all packets, as the tool finds them: from pulses with several returns."""
    grouped, xyz, time = delivery.grouped, delivery.xyz, delivery.time
    last = np.append(grouped.owner[1:], len(xyz)) - 1
    several = np.flatnonzero(last > grouped.owner)
    first = grouped.owner[several]
    path = flown_path(time[first], xyz[first], xyz[last[several]], (time[0], time[-1]))
    return path.directions(xyz[grouped.owner], time[grouped.owner])


def _counts_of_energy(
    waves: F32, plain: F32, alone: NDArray[np.bool_], label: NDArray[np.uint8]
) -> float:
    """How many counts of the samples one of the intensities is: of lone returns, no wires."""
    usual = alone & (label != _WIRE)
    return float(np.median(waves[usual, _AT_FIRST].max(axis=1) / plain[usual].max(axis=1)))
