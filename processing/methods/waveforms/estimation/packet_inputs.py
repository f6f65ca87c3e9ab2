"""What the estimator knows of packets: their returns, neighbours and the recording as a whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.methods.waveforms.estimation.pulse_returns import FIRST_SAMPLE_NS, SAMPLES
from processing.methods.waveforms.estimation.ray_kernels import (
    Neighbours,
    plan_grid,
    profile_kernel,
)
from processing.methods.waveforms.estimation.response_network import (
    PULSE_BEFORE_NS,
    PULSE_BEHIND_NS,
    ResponseNetwork,
    channels_of,
)

RADII = np.array([0.6, 1.5, 4.0])
"""Of the weights of neighbours, in spacings of pulses: the next one or two, those that hit the same
thing, and the surroundings."""

RADII_LEAST_M, RADII_MOST_M = np.array([0.15, 0.3, 0.8]), np.array([0.5, 1.2, 3.0])
"""A footprint is .1 to .5 m wide, a crown some metres, whatever the spacing."""

_CELL_M = 1.0
_FAINT_PERCENT = 2.0
"""Returns fainter than the faintest hundredths are missing: what wasn't told lies below."""

F32 = NDArray[np.float32]


@dataclass(frozen=True)
class SystemResponse:
    """A pulse by time: ``times`` (n,) float64 ns, 0 at the target; ``values``, maximum 1."""

    times: Floats
    values: Floats

    @property
    def fwhm_ns(self) -> float:
        """Full width at half maximum."""
        fine = np.arange(self.times[0], self.times[-1], 0.05)
        return 0.05 * float((np.interp(fine, self.times, self.values) > 0.5).sum())

    def at(self, times: Floats | Integers) -> Floats:
        """Values at any times, ns; 0 beyond its ends."""
        return np.asarray(np.interp(times, self.times, self.values, left=0.0, right=0.0))

    @property
    def by_ns(self) -> F32:
        """Values at whole nanoseconds, as the network's pulse."""
        return self.at(np.arange(-PULSE_BEFORE_NS, PULSE_BEHIND_NS + 1)).astype(np.float32)


class ReturnBrightness(NamedTuple):
    """Of a recording's returns, in intensities: of a usual first one, and of the faintest."""

    usual: float
    faint: float


def brightness_of(counts: Integers, first_counts: Integers) -> ReturnBrightness:
    """From how many returns have each intensity: of all, and of first ones."""
    usual = np.searchsorted(np.cumsum(first_counts), 0.5 * first_counts.sum())
    faint = np.searchsorted(np.cumsum(counts), _FAINT_PERCENT / 100 * counts.sum())
    return ReturnBrightness(max(1.0, float(usual)), max(1.0, float(faint)))


class PulseReturns(NamedTuple):
    """Returns of some packets and of those around.

    ``xyz`` (n, 3) float64 m; ``energy`` (n,) float32 intensities; ``packet`` (n,) int64;
    ``after_ns`` (n,) float32, after the packet's first; ``is_first`` (n,) bool.
    """

    xyz: Floats
    energy: F32
    packet: Integers
    after_ns: F32
    is_first: NDArray[np.bool_]


class PacketInputs(NamedTuple):
    """What the network is given of k packets.

    ``channels`` (k, c, SAMPLES), ``facts`` (k, f) and ``plain`` (k, SAMPLES), the plain estimate,
    as :class:`ResponseNetwork` has them; ``top`` (k,) each packet's strongest return, intensities,
    the unit of the others. All float32.
    """

    channels: F32
    facts: F32
    plain: F32
    top: F32


@dataclass(frozen=True)
class PacketDescriber:
    """Makes of returns what the network sees; training and use share it.

    Attributes
    ----------
    pulse : SystemResponse
    brightness : ReturnBrightness
    spacing_m : float
        Between pulses, seen from above.
    knows_intensity : bool
        Else each pulse's energy is shared evenly by its returns.
    """

    pulse: SystemResponse
    brightness: ReturnBrightness
    spacing_m: float
    knows_intensity: bool

    def inputs(self, own: PulseReturns, directions: Floats, around: Neighbours) -> PacketInputs:
        """What is known of packets.

        Parameters
        ----------
        own : PulseReturns
            All returns of k packets, ``packet`` from 0 to k − 1, each with its first return.
        directions : (k, 3) float64
            Of the packets, away from the sensor.
        around : Neighbours
            Returns, those of the packets too, with energies in units of the usual one; ``packet``
            in the same numbers, others below 0 or from k on.
        """
        packets = len(directions)
        top, impulses, plain = self._own_light(own, packets)
        scaled = impulses / top[:, None], plain / top[:, None]
        profiles = self._profiles(own, directions, around)
        many = profiles.shape[1] // 2
        by = self.brightness.usual / top if self.knows_intensity else np.zeros(packets)
        profiles[:, :many] *= by.astype(np.float32)[:, None, None]
        returns = np.bincount(own.packet, minlength=packets)
        facts = np.stack(
            [
                np.log(top / self.brightness.usual),
                np.log(top / self.brightness.faint),
                returns,
                np.full(packets, np.log(self.pulse.fwhm_ns)),
                np.full(packets, np.log(self.spacing_m)),
                1.0 + directions[:, 2],
            ],
            axis=1,
        ).astype(np.float32)
        return PacketInputs(channels_of(*scaled, profiles), facts, scaled[1], top)

    def _own_light(self, own: PulseReturns, packets: int) -> tuple[F32, F32, F32]:
        """Strongest return of each packet, its returns by ns, and the pulse at each."""
        top, impulses = np.zeros(packets, np.float32), np.zeros((packets, SAMPLES), np.float32)
        plain = np.zeros((packets, SAMPLES), np.float32)
        np.maximum.at(top, own.packet, own.energy)
        place = own.after_ns + np.float32(FIRST_SAMPLE_NS)
        whole = np.minimum(place.astype(np.int64), SAMPLES - 2)
        part = place - whole
        np.add.at(impulses, (own.packet, whole), own.energy * (1 - part))
        np.add.at(impulses, (own.packet, whole + 1), own.energy * part)
        near = np.arange(-PULSE_BEFORE_NS, PULSE_BEHIND_NS + 1)
        sample = whole[:, None] + near
        values = self.pulse.at(sample - place[:, None]) * own.energy[:, None]
        row, column = np.nonzero((sample >= 0) & (sample < SAMPLES))
        np.add.at(plain, (own.packet[row], sample[row, column]), values[row, column])
        return np.maximum(top, 1e-3), impulses, plain

    def _profiles(self, own: PulseReturns, directions: Floats, around: Neighbours) -> F32:
        radii = np.clip(RADII * self.spacing_m, RADII_LEAST_M, RADII_MOST_M)
        first = np.flatnonzero(own.is_first)
        packets = own.packet[first]
        into = np.zeros((len(directions), 2 * radii.size, SAMPLES), np.float32)
        rays = own.xyz[first], np.ascontiguousarray(directions[packets]), packets
        found = np.zeros((first.size, *into.shape[1:]), np.float32)
        profile_kernel(plan_grid(around.xyz, _CELL_M), around, rays, radii, found)
        into[packets] = found
        return into


@dataclass(frozen=True)
class Estimator:
    """Makes waveforms of returns: what a network answers to what is known of them."""

    network: ResponseNetwork
    known: PacketDescriber

    def waves(self, own: PulseReturns, directions: Floats, around: Neighbours) -> F32:
        """Waveforms of packets in intensities, (k, SAMPLES); as :meth:`PacketDescriber.inputs`."""
        seen = self.known.inputs(own, directions, around)
        pulse = self.known.pulse.by_ns
        found = self.network.waves(seen.channels, seen.facts, seen.plain, pulse)
        return np.asarray(found * seen.top[:, None], np.float32)
