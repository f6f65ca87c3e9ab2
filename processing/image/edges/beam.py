"""The laser's line of sight through a pixel, whether something came back from there or not.

Within a revolution the beam sweeps at a steady rate about one centre, so the points that did come
back say where the centre is and which way every pulse went.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.image.point_image import PointCloudImage
from processing.recording.drive import Drive

BeamPoint = tuple[float, float, float]

_FEWEST_POINTS = 30
_FEWEST_DEGREES = 40.0
"""Points, and an arc of directions, from which a centre follows: over less it is a small difference
of nearly parallel beams. By trial; no measurement is recorded."""

_MOST_POINTS = 1_500
"""More take longer and make the centre hardly surer."""

_LEAST_LENGTH = 1e-9
"""Guard of a division: all beams alike."""


@dataclass(frozen=True)
class BeamSweep:
    """One revolution in the frame in which its points are given.

    Attributes
    ----------
    centre : (3,) float64
    axes : (2, 3) float64
        Spanning the plane of the sweep.
    phase : float
        Radians of pulse 0 from the first axis.
    rate : float
        Radians a pulse; negative where it turns the other way.
    """

    centre: Floats
    axes: Floats
    phase: float
    rate: float

    def direction(self, pulse: float) -> Floats:
        """(3,): unit vector along which a pulse was sent."""
        angle = self.phase + self.rate * pulse
        along: Floats = np.cos(angle) * self.axes[0] + np.sin(angle) * self.axes[1]
        return along


def beam_at(
    drive: Drive, image: PointCloudImage, row: int, column: int
) -> tuple[BeamPoint, BeamPoint] | None:
    """Where the laser was and which way it looked for a pixel.

    Parameters
    ----------
    image : PointCloudImage
        Of the drive; of any kind that has revolutions.

    Returns
    -------
    tuple of two (3,) tuples, or None
        Origin (m, project CRS) and unit direction. None without revolutions, outside the image, and
        where a revolution has too few points to say.
    """
    revolutions = drive.revolutions
    if revolutions is None or not (0 <= row < image.rows and 0 <= column < image.width):
        return None
    start, stop = int(image.row_starts[row]), int(image.row_starts[row + 1])
    if stop - start < _FEWEST_POINTS:
        return None
    layout = image.layout
    half = (2 * column + 1) * layout.spans[row] / layout.per_span / 2
    pulse = (layout.origins[row] + half) / 2
    points = np.arange(start, stop, max(1, (stop - start) // _MOST_POINTS))
    pulses = np.asarray(drive.columns["pulse"][points], dtype=np.float64) - pulse
    xyz, trajectory = drive.xyz(points), drive.trajectory
    if trajectory is None:
        sweep = sweep_of(xyz - xyz[0], pulses, 2 * np.pi / revolutions.pulses_per_revolution)
        return None if sweep is None else _as_positions(sweep.centre + xyz[0], sweep.direction(0.0))
    times = np.asarray(drive.columns["time"][points], dtype=np.float64)
    slope = np.polyfit(pulses, times - times[0], 1)
    moment = np.array([times[0] + slope[1]])
    if not (trajectory.covers(times).all() and trajectory.covers(moment).all()):
        return None
    vehicle = trajectory.to_vehicle(xyz, times)
    sweep = sweep_of(vehicle, pulses, 2 * np.pi / revolutions.pulses_per_revolution)
    if sweep is None:
        return None
    turned = trajectory.rotations_at(moment)[0]
    origin = trajectory.positions_at(moment)[0] + turned @ sweep.centre
    return _as_positions(origin, turned @ sweep.direction(0.0))


def sweep_of(xyz: Floats, pulses: Floats, rate: float) -> BeamSweep | None:
    """The sweep that explains points and their pulse numbers best, either way round.

    Parameters
    ----------
    xyz : (n, 3) float64
        Points of one revolution, m, in the frame in which the head does not move.
    pulses : (n,) float64
        Their pulse numbers.
    rate : float
        Radians a pulse.

    Returns
    -------
    BeamSweep or None
        None over too narrow an arc.
    """
    middle = xyz.mean(axis=0)
    _, _, axes = np.linalg.svd(xyz - middle, full_matrices=False)
    flat = (xyz - middle) @ axes[:2].T
    best: tuple[float, BeamSweep] | None = None
    for sense in (rate, -rate):
        found = _turned_centre(flat, sense * pulses)
        if found is None:
            continue
        centre, phase, residual = found
        sweep = BeamSweep(middle + centre @ axes[:2], axes[:2], phase, sense)
        if best is None or residual < best[0]:
            best = residual, sweep
    if best is None or np.ptp(pulses) * rate < np.radians(_FEWEST_DEGREES):
        return None
    return best[1]


def _turned_centre(flat: Floats, angles: Floats) -> tuple[Floats, float, float] | None:
    """Centre, phase and misfit of beams at known angle differences through points of a plane.

    A point (x, y) on the beam at angle a + p from the centre (u, v) has
    (x − u) sin(a + p) = (y − v) cos(a + p), which is linear in cos p, sin p and two products.
    """
    x, y = flat.T
    sines, cosines = np.sin(angles), np.cos(angles)
    scale = float(np.abs(flat).max())
    rows = np.column_stack(
        [
            (x * sines - y * cosines) / scale,
            (x * cosines + y * sines) / scale,
            -sines,
            -cosines,
        ]
    )
    _, values, basis = np.linalg.svd(rows, full_matrices=False)
    cos_p, sin_p, a, b = basis[-1]
    length = float(np.hypot(cos_p, sin_p))
    if length < _LEAST_LENGTH:
        return None
    cos_p, sin_p, a, b = (value / length for value in (cos_p, sin_p, a * scale, b * scale))
    centre = np.array([a * cos_p + b * sin_p, a * sin_p - b * cos_p])
    phase = float(np.arctan2(sin_p, cos_p))
    ways = np.column_stack([np.cos(angles + phase), np.sin(angles + phase)])
    if float(((flat - centre) * ways).sum()) < 0:
        phase += np.pi
    return centre, phase, float(values[-1]) / length


def _as_positions(origin: Floats, direction: Floats) -> tuple[BeamPoint, BeamPoint]:
    (x, y, z), (east, north, up) = origin.tolist(), direction.tolist()
    return (x, y, z), (east, north, up)
