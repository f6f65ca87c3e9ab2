"""Beams against what moves: every pulse meets it where it is at that pulse's time."""

from __future__ import annotations

import numpy as np

from processing.core.kernels import kernel
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.returns import BeamHits
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.scene.things import Mover

_STEP_S = 0.05
_REACH_M = 130.0
_KEPT_S = 20.0  # stretches are recorded side by side: an earlier one may still need a mover
_FASTEST_M_S = 90.0  # of anything towards the recording vehicle


class MovingScene:
    """Movers of a recording, each with a small scene of its own.

    Parameters
    ----------
    street : Street
    movers : list of Mover
    """

    def __init__(self, street: Street, movers: list[Mover]) -> None:
        self._street, self._movers = street, movers
        self._scenes: dict[int, tuple[RaycastScene, float]] = {}

    def meet(self, beams: Beams, met: BeamHits) -> None:
        """Put what moves before what stands, where it is nearer."""
        if beams.time_s.size == 0:
            return
        first, last = float(beams.time_s[0]), float(beams.time_s[-1])
        middle = beams.origins.mean(axis=0)
        for number, mover in enumerate(self._movers):
            if last < mover.from_s or first > mover.to_s:
                if first > mover.to_s + _KEPT_S:
                    self._scenes.pop(number, None)
                continue
            reach = _REACH_M + _FASTEST_M_S * (last - first)
            if not self._may_be_near(mover, first, middle, reach):
                continue
            times = np.arange(np.floor(first / _STEP_S), np.ceil(last / _STEP_S) + 2) * _STEP_S
            positions, headings = poses_of(mover, self._street, times)
            if np.linalg.norm(positions - middle, axis=1).min() > _REACH_M:
                continue
            self._meet_one(beams, met, number, (times, positions, headings))

    def _may_be_near(self, mover: Mover, time_s: float, position: Floats, reach_m: float) -> bool:
        """Whether it is worth to work out where it stands: that takes the ground's height."""
        at, offset = mover.direction_at(time_s)
        away = self._street.alignment.at(at, offset, position[2]) - position
        return bool(np.linalg.norm(away) < reach_m)

    def _meet_one(
        self, beams: Beams, met: BeamHits, number: int, poses: tuple[Floats, Floats, Floats]
    ) -> None:
        mover = self._movers[number]
        scene, radius = self._scene(number)
        rays = np.empty(beams.time_s.size, np.int64)
        origins, directions = np.empty((rays.size, 3)), np.empty((rays.size, 3))
        span = (mover.from_s, mover.to_s, radius)
        sent = (beams.time_s, beams.origins, beams.directions)
        count = _turned_kernel(sent, poses, span, (rays, origins, directions))
        if count:
            chosen = rays[:count]
            hits = scene.cast(origins[:count], directions[:count])
            met.take(chosen, hits, mover.mesh)

    def _scene(self, number: int) -> tuple[RaycastScene, float]:
        if number not in self._scenes:
            mesh = self._movers[number].mesh
            radius = float(np.linalg.norm(mesh.vertices, axis=1).max()) + 0.05
            self._scenes[number] = RaycastScene(mesh, np.zeros(3)), radius
        return self._scenes[number]


def poses_of(mover: Mover, street: Street, times: Floats) -> tuple[Floats, Floats]:
    """Where a mover is at times: its place on the ground (n, 3) and its heading (n,) in radians."""
    at, offset = mover.direction_at(times)
    positions = street.alignment.at(at, offset, street.ground_height(at, offset))
    return positions, street.alignment.heading(at) + mover.turn_rad


@kernel
def _turned_kernel(
    beams: tuple[Floats, Floats, Floats],
    poses: tuple[Floats, Floats, Floats],
    span: tuple[float, float, float],
    out: tuple[Integers, Floats, Floats],
) -> int:
    """Choose beams that pass near the mover, and turn them into its own frame."""
    times, origins, directions = beams
    marks, positions, headings = poses
    start, end, radius = span
    rays, own_origins, own_directions = out
    found, row = 0, 0
    for ray in range(times.size):
        time = times[ray]
        if time < start or time > end:
            continue
        while row < marks.size - 2 and marks[row + 1] <= time:
            row += 1
        share = (time - marks[row]) / (marks[row + 1] - marks[row])
        x = origins[ray, 0] - (
            positions[row, 0] + share * (positions[row + 1, 0] - positions[row, 0])
        )
        y = origins[ray, 1] - (
            positions[row, 1] + share * (positions[row + 1, 1] - positions[row, 1])
        )
        z = origins[ray, 2] - (
            positions[row, 2] + share * (positions[row + 1, 2] - positions[row, 2])
        )
        along = x * directions[ray, 0] + y * directions[ray, 1] + z * directions[ray, 2]
        away = x * x + y * y + z * z
        if away > radius * radius and (along > 0 or away - along * along > radius * radius):
            continue
        turn = headings[row] + share * (headings[row + 1] - headings[row])
        c, s = np.cos(turn), np.sin(turn)
        rays[found] = ray
        own_origins[found, 0], own_origins[found, 1] = c * x + s * y, c * y - s * x
        own_origins[found, 2], own_directions[found, 2] = z, directions[ray, 2]
        own_directions[found, 0] = c * directions[ray, 0] + s * directions[ray, 1]
        own_directions[found, 1] = c * directions[ray, 1] - s * directions[ray, 0]
        found += 1
    return found


def warm_up() -> None:
    """Compile the kernel."""
    one, three = np.zeros(1), np.zeros((1, 3))
    poses = np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros(2)
    out = np.zeros(1, np.int64), three.copy(), three.copy()
    _turned_kernel((one, three, three), poses, (0.0, 1.0, 1.0), out)
