"""The echoes of all waveforms of a drive, as places: what its sensor told, and what it did not."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.waveforms.decomposition import Digitiser, Echoes, decompose
from processing.methods.waveforms.system_pulse import (
    RecordNoise,
    SystemPulse,
    noise_of,
    own_pulse,
    system_pulse,
)
from processing.recording.drive import Drive
from processing.recording.waveform_facts import waveform_facts
from processing.recording.waveforms import PulseBlock, Waveforms, waveforms_of

_LEARNT_FROM = 8_000
"""Packets, evenly among all, that the noise and an own pulse are taken from: a few thousand clear
lone echoes, of which :mod:`processing.methods.waveforms.system_pulse` asks for some hundred."""

_PACKETS_AT_ONCE = 1_024
"""Some .2 s of work: so soon a stop is heard."""


@dataclass(frozen=True, eq=False)
class EchoPoints:
    """Echoes with a place, in the order of packets and ranges.

    Attributes
    ----------
    xyz : (k, 3) float64
        m, project CRS.
    owners : (k,) int64
        The delivered point that each one's packet counts for.
    number, count : (k,) int64
        Which echo of its packet, from 1, and of how many.
    echoes : Echoes
        ``row`` counts the packets of this part.
    range_sigma_m : (k,) float64
        Standard deviation along the ray, m.
    """

    xyz: Floats
    owners: Integers
    number: Integers
    count: Integers
    echoes: Echoes
    range_sigma_m: Floats


@dataclass(frozen=True)
class _Known:
    """What is known of a recording before its packets are looked at one by one."""

    noise: RecordNoise
    pulse: SystemPulse
    interval_ns: float

    def pulse_at(self, interval_ns: float) -> SystemPulse:
        """The pulse where samples lie otherwise apart: its table is counted in samples."""
        if interval_ns == self.interval_ns:
            return self.pulse
        return SystemPulse(self.pulse.table, self.pulse.grid * (self.interval_ns / interval_ns))


def echoes_of(
    drive: Drive, given: tuple[Floats, Floats] | None, monitor: Monitor
) -> Iterator[EchoPoints]:
    """Decompose all waveforms of a drive, some at a time.

    Parameters
    ----------
    given : tuple of (n,) float64 or None
        Times, ns, and amplitudes of the system's pulse; None: from the drive's own echoes.

    Raises
    ------
    Unsuitable
        There are no waveforms, or they tell neither rays nor, where it is asked for, a pulse.
    BadFile, Cancelled
    """
    waveforms = waveforms_of(drive)
    if waveforms is None or waveforms.count == 0:
        raise _without(drive)
    known, has_rays = _known(waveforms, given), False
    for block in waveforms.blocks(_PACKETS_AT_ONCE):
        monitor.check()
        monitor.report(int(block.pulses.numbers[0]) / waveforms.count)
        for found in _points_of(block, waveforms, known):
            has_rays = True
            yield found
    if not has_rays:
        raise _without(drive)


def _known(waveforms: Waveforms, given: tuple[Floats, Floats] | None) -> _Known:
    """Noise and pulse, from packets of the commonest description."""
    step = max(1, waveforms.count // _LEARNT_FROM)
    numbers = np.arange(0, waveforms.count, step)
    pulses = waveforms.pulses(numbers)
    own = pulses.descriptor == np.bincount(pulses.descriptor).argmax()
    descriptor = waveforms.descriptors[int(pulses.descriptor[own][0])]
    samples = waveforms.samples_of(numbers[own])
    lengths = pulses.lengths[own]
    noise = noise_of(samples, lengths)
    if given is None:
        pulse = own_pulse(samples, lengths, noise, 2.0**descriptor.bits - 1)
    else:
        pulse = system_pulse(given[0] / descriptor.interval_ns, given[1])
    return _Known(noise, pulse, descriptor.interval_ns)


def _points_of(block: PulseBlock, waveforms: Waveforms, known: _Known) -> Iterator[EchoPoints]:
    pulses = block.pulses
    for number in np.unique(pulses.descriptor).tolist():
        descriptor = waveforms.descriptors[number]
        rows = np.flatnonzero(
            (pulses.descriptor == number) & np.isfinite(pulses.direction).all(axis=1)
        )
        if not rows.size:
            continue
        echoes = decompose(
            block.samples[rows],
            pulses.lengths[rows],
            known.pulse_at(descriptor.interval_ns),
            known.noise,
            Digitiser(descriptor.interval_ns, 2.0**descriptor.bits - 1),
        )
        yield _placed(block, rows, echoes)


def _placed(block: PulseBlock, rows: Integers, echoes: Echoes) -> EchoPoints:
    packet = rows[echoes.row]
    count: NDArray[np.int64] = np.bincount(echoes.row, minlength=rows.size)
    first = np.cumsum(count) - count
    m_per_ns = np.linalg.norm(block.pulses.direction[packet], axis=1)
    return EchoPoints(
        block.pulses.xyz_at(packet, echoes.time_ns),
        block.pulses.owners[packet],
        np.arange(echoes.row.size) - first[echoes.row] + 1,
        count[echoes.row],
        echoes,
        echoes.time_sigma_ns * m_per_ns,
    )


def _without(drive: Drive) -> Unsuitable:
    """What stands against it: what is wrong with the packets there are, or that there are none."""
    facts = waveform_facts(drive)
    if facts is not None and facts.remarks:
        delivered = [Path(file.delivered) for file in facts.files] or [*drive.delivered_files]
        files = ", ".join(path.name for path in delivered)
        return Unsuitable(
            Text("None of the waveforms can be read.", "読める波形が1つもありません。"),
            Text("{files}: {remark}", "{files}: {remark}").filled(
                files=files, remark=facts.remarks[0]
            ),
            Text(
                "Ask for the waveforms as they were recorded; the points can be used without.",
                "記録時のままの波形を納品元に依頼してください。点は波形なしで使えます。",
            ),
        )
    return Unsuitable(
        Text(
            "There are no waveforms with rays in this recording.",
            "この計測データには、光線の分かる波形がありません。",
        ),
        Text.same(drive.info.name),
        Text(
            "Import LAS of format 4, 5, 9 or 10 together with its .wdp.",
            "ポイントフォーマット4・5・9・10のLASを、.wdpと一緒に指定してください。",
        ),
    )
