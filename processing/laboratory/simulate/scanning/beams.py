"""The beams of a spinning scanner: when each pulse leaves, from where, and in which direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.laboratory.simulate.scanning.sensors import Head
from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.mesh import Floats


@dataclass(frozen=True)
class ScanPattern:
    """How a head sends its pulses.

    Attributes
    ----------
    pulses : int
        In one revolution.
    turns_per_s : float
    phase_rad : float
        Where the mirror points at time 0.
    """

    pulses: int
    turns_per_s: float
    phase_rad: float

    @property
    def rate_hz(self) -> float:
        """Pulses per second."""
        return self.pulses * self.turns_per_s


@dataclass(frozen=True)
class Beams:
    """Some pulses in the order in which they were sent.

    Attributes
    ----------
    first : int
        Number of the first pulse, counted from the beginning of the pass.
    time_s : (n,) float64
        From the beginning of the pass.
    origins, directions : (n, 3) float64
        m, the street's frame; unit vectors.
    """

    first: int
    time_s: Floats
    origins: Floats
    directions: Floats


def head_axes(head: Head) -> Floats:
    """The head's axes in the vehicle's frame (forward, left, up).

    Returns
    -------
    (3, 3) float64
        Columns: the direction of the beam at angle 0 (upwards), that a quarter of a turn on, and
        the axis about which the mirror spins.
    """
    yaw, pitch = np.radians(head.yaw_deg), np.radians(head.pitch_deg)
    axis = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
    up = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
    up /= np.linalg.norm(up)
    return np.stack([up, np.cross(axis, up), axis], axis=-1)


def beams_of(driven: SimulatedPass, head: Head, scan_pattern: ScanPattern, pulses: range) -> Beams:
    """Pulses of a head, by their numbers from the beginning of the pass."""
    count = len(pulses)
    time_s = (pulses.start + np.arange(count)) / scan_pattern.rate_hz
    origins, directions = np.empty((count, 3)), np.empty((count, 3))
    _beams_kernel(
        pulses.start,
        (scan_pattern.rate_hz, 1.0 / scan_pattern.pulses, scan_pattern.phase_rad),
        (driven.time_s, driven.positions, driven.rotations),
        (np.array(head.lever_m), head_axes(head)),
        (origins, directions),
    )
    return Beams(pulses.start, time_s, origins, directions)


@kernel
def _beams_kernel(
    first: int,
    scan_pattern: tuple[float, float, float],
    poses: tuple[Floats, Floats, Floats],
    head: tuple[Floats, Floats],
    out: tuple[Floats, Floats],
) -> None:
    """Poses are interpolated between records element by element."""
    rate, per_revolution, phase = scan_pattern
    times, positions, rotations = poses
    lever, axes = head
    origins, directions = out
    row = 0
    beam = np.empty(3)
    for number in range(origins.shape[0]):
        pulse = first + number
        time = pulse / rate
        while row < times.size - 2 and times[row + 1] <= time:
            row += 1
        share = (time - times[row]) / (times[row + 1] - times[row])
        angle = phase + 2 * np.pi * (pulse * per_revolution - np.floor(pulse * per_revolution))
        c, s = np.cos(angle), np.sin(angle)
        for axis in range(3):
            beam[axis] = c * axes[axis, 0] + s * axes[axis, 1]
        length = 0.0
        for axis in range(3):
            at = positions[row, axis] + share * (positions[row + 1, axis] - positions[row, axis])
            direction = 0.0
            for one in range(3):
                low, high = rotations[row, axis, one], rotations[row + 1, axis, one]
                turn = low + share * (high - low)
                at += turn * lever[one]
                direction += turn * beam[one]
            origins[number, axis], directions[number, axis] = at, direction
            length += direction * direction
        length = np.sqrt(length)
        for axis in range(3):
            directions[number, axis] /= length


def warm_up() -> None:
    """Compile the kernel."""
    poses = np.array([0.0, 1.0]), np.zeros((2, 3)), np.stack([np.eye(3)] * 2)
    out: tuple[NDArray[np.float64], NDArray[np.float64]] = np.empty((1, 3)), np.empty((1, 3))
    _beams_kernel(0, (1.0, 1.0, 0.0), poses, (np.zeros(3), np.eye(3)), out)
