"""What a flight delivers of its pulses: returns and the packets that they lie in."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.laboratory.simulate.airborne.beam_kernels import FootprintHits
from processing.laboratory.simulate.airborne.flight_sensors import FlightSensor
from processing.laboratory.simulate.airborne.landscapes import Floats
from processing.laboratory.simulate.airborne.waveform_kernels import (
    HALF_LIGHT_M_NS,
    LABEL_REACH_M,
    Records,
)

_TAIL_NS = 15.0
"""A return nearer to its packet's end begins another packet: its echo would be cut."""


class PacketReturns(NamedTuple):
    """Returns in the order of pulses and ranges.

    ``beam`` int64, row of its pulse; ``packet`` int64, row of its packet; ``range_m`` float64;
    ``location_ps`` float64 from the packet's first sample; ``height`` float32, counts; ``number``
    and ``of_pulse`` uint8; ``label`` uint8.
    """

    beam: NDArray[np.int64]
    packet: NDArray[np.int64]
    range_m: Floats
    location_ps: Floats
    height: NDArray[np.float32]
    number: NDArray[np.uint8]
    of_pulse: NDArray[np.uint8]
    label: NDArray[np.uint8]


def returns_of(
    hits: FootprintHits, records: Records, sensor: FlightSensor
) -> tuple[PacketReturns, NDArray[np.float32]]:
    """Returns, and the packets that they lie in: (k, samples) counts."""
    n = int(records.found.sum())
    beam = np.repeat(np.arange(len(records.found)), records.found)
    first = np.cumsum(records.found) - records.found
    number = np.arange(n) - first[beam]
    place, height = records.place[beam, number], records.height[beam, number]
    packet, starts = np.empty(n, np.int64), np.empty(n, np.int64)
    lead = round(sensor.lead_ns / sensor.interval_ns)
    room = sensor.samples - round(_TAIL_NS / sensor.interval_ns)
    count = _packet_kernel(beam, place, (lead, room), packet, starts)
    step_m = sensor.interval_ns * HALF_LIGHT_M_NS
    range_m = records.first_m[beam] + place * step_m
    labels = np.zeros(n, np.uint8)
    _label_kernel(hits, beam, range_m, labels)
    owner = np.searchsorted(packet, np.arange(count))
    samples = starts[owner][:, None] + np.arange(sensor.samples)
    wave = records.counts[beam[owner][:, None], np.clip(samples, 0, records.counts.shape[1] - 1)]
    location = (place - starts) * sensor.interval_ns * 1000.0
    returns = PacketReturns(
        beam,
        packet,
        range_m,
        location,
        height,
        (number + 1).astype(np.uint8),
        records.found[beam].astype(np.uint8),
        labels,
    )
    return returns, wave


@kernel
def _packet_kernel(
    beam: NDArray[np.int64],
    place: NDArray[np.float64],
    size: tuple[int, int],
    packet: NDArray[np.int64],
    starts: NDArray[np.int64],
) -> int:
    lead, room = size
    count, start = 0, 0
    for at in range(beam.size):
        if at == 0 or beam[at] != beam[at - 1] or place[at] > start + room:
            start = max(0, int(np.floor(place[at])) - lead)
            count += 1
        packet[at], starts[at] = count - 1, start
    return count


@kernel
def _label_kernel(
    hits: FootprintHits,
    beam: NDArray[np.int64],
    range_m: NDArray[np.float64],
    labels: NDArray[np.uint8],
) -> None:
    of_code = np.zeros(256)
    for at in range(beam.size):
        of_code[:] = 0.0
        best, row = 0, beam[at]
        for one in range(hits.met[row]):
            if abs(hits.range_m[row, one] - range_m[at]) <= LABEL_REACH_M:
                of_code[hits.code[row, one]] += hits.energy[row, one]
        for code in range(256):
            if of_code[code] > of_code[best]:
                best = code
        labels[at] = best
