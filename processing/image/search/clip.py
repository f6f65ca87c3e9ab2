"""Clip: which part of space is shown; what lies outside is neither drawn nor hit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.image.search.corridor import Corridor


@dataclass(frozen=True)
class Clip:
    """A part of space between planes and along a drive.

    Attributes
    ----------
    planes : tuple of (a, b, c, d)
        What is shown has a·easting + b·northing + c·height ≥ d for all of them.
    corridor : Corridor or None
        What is shown lies in it as well.
    """

    planes: tuple[tuple[float, float, float, float], ...] = ()
    corridor: Corridor | None = None

    @staticmethod
    def box(low: Floats, high: Floats) -> Clip:
        """Between two corners, (3,) float64 each, m, project CRS."""
        normals = np.concatenate([np.eye(3), -np.eye(3)])
        return Clip(_planes(normals, np.concatenate([low, -high])))

    @staticmethod
    def around(positions: Floats, margin_m: float) -> Clip:
        """So far about places, (n, 3) float64, m, project CRS; n ≥ 1."""
        return Clip.box(positions.min(axis=0) - margin_m, positions.max(axis=0) + margin_m)

    @staticmethod
    def upright(outline: Floats) -> Clip:
        """Above and below a convex outline in plan, such as a section's.

        Parameters
        ----------
        outline : (k, 2) float64
            Easting and northing of its corners, m, anticlockwise; k ≥ 3.
        """
        along = np.roll(outline, -1, axis=0) - outline
        inwards = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(outline))])
        inwards /= np.linalg.norm(inwards, axis=1)[:, None]
        return Clip(_planes(inwards, (inwards[:, :2] * outline).sum(axis=1)))

    def holds(self, xyz: Floats) -> NDArray[np.bool_]:
        """(n,) which of (n, 3) float64 places, m, project CRS, are shown."""
        inside = np.empty(len(xyz), np.bool_)
        planes = np.array(self.planes, dtype=np.float64).reshape(-1, 4)
        planes_kernel(np.ascontiguousarray(xyz, dtype=np.float64), planes, inside)
        if self.corridor is not None:
            positions = np.flatnonzero(inside)
            inside[positions] = self.corridor.holds(xyz[positions])
        return inside

    def may_hold(self, low: Floats, high: Floats) -> NDArray[np.bool_]:
        """Which boxes may hold something that is shown.

        Parameters
        ----------
        low, high : (n, 3) float64
            Opposite corners, m, project CRS.

        Returns
        -------
        (n,) bool
            False only where all of a box is outside.
        """
        inside = np.ones(len(low), np.bool_)
        for a, b, c, d in self.planes:
            normal = np.array([a, b, c])
            inside &= np.where(normal > 0, high, low) @ normal >= d
        if self.corridor is not None:
            inside &= self.corridor.may_hold(low, high)
        return inside


def _planes(normals: Floats, distances: Floats) -> tuple[tuple[float, float, float, float], ...]:
    return tuple((a, b, c, d) for a, b, c, d in np.column_stack([normals, distances]).tolist())


@kernel
def planes_kernel(
    xyz: NDArray[np.float64], planes: NDArray[np.float64], inside: NDArray[np.bool_]
) -> None:
    """Whether places lie on the inner side of all planes; unknown ones (NaN) don't."""
    for i in range(xyz.shape[0]):
        holds = True
        for plane in range(planes.shape[0]):
            a, b, c, d = planes[plane]
            holds = holds and a * xyz[i, 0] + b * xyz[i, 1] + c * xyz[i, 2] >= d
        inside[i] = holds


def warm_up() -> None:
    """Compile the kernel."""
    planes_kernel(np.zeros((2, 3)), np.zeros((1, 4)), np.empty(2, np.bool_))
