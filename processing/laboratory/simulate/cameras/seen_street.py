"""What cameras see at a moment: the sections around, and movers where they are at that time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.cameras.rigs import Pose
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.moving import poses_of
from processing.laboratory.simulate.scanning.surroundings import scene_around
from processing.laboratory.simulate.scene.mesh import Mesh, place_shape
from processing.laboratory.simulate.scene.things import Mover

_REACH_M = 160.0


class SeenStreet:
    """A street and its traffic as photographs show them.

    Parameters
    ----------
    street : Street
    movers : sequence of Mover
        Of the pass.
    check : callable
        Raises when the work shall end.
    """

    def __init__(self, street: Street, movers: Sequence[Mover], check: Callable[[], None]) -> None:
        self._street, self._movers, self._check = street, movers, check
        self._row = -1
        self._standing: RaycastScene | None = None

    def at(self, pose: Pose) -> list[RaycastScene]:
        """The scenes around a pose at its time: what stands, and what moves."""
        row = self._street.within(pose.chainage_m, pose.chainage_m)[0]
        if self._standing is None or row != self._row:
            self._standing = scene_around(self._street, row, _REACH_M, self._check)
            self._row = row
        meshes = [self._placed(one, pose) for one in self._movers if self._is_near(one, pose)]
        if not meshes:
            return [self._standing]
        return [self._standing, RaycastScene(Mesh.joined(meshes), pose.position)]

    def _is_near(self, mover: Mover, pose: Pose) -> bool:
        if not mover.from_s <= pose.time_s <= mover.to_s:
            return False
        at, _ = mover.direction_at(pose.time_s)
        return abs(float(at) - pose.chainage_m) < _REACH_M

    def _placed(self, mover: Mover, pose: Pose) -> Mesh:
        positions, headings = poses_of(mover, self._street, np.array([pose.time_s]))
        vertices, _ = place_shape(
            (mover.mesh.vertices, mover.mesh.triangles), positions[0].tolist(), float(headings[0])
        )
        return replace(mover.mesh, vertices=vertices)
