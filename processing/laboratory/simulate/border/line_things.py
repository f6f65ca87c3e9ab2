"""Things that stand along a line: their triangles by pieces of it, and their truth."""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.border.along import stations
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, TriangleShape
from processing.laboratory.simulate.scene.things import Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.section import StreetSection

OTHER = 1

PIECE_M = 2.0
"""The steps in which rails and walls are led along the road: a triangle lies in one piece."""

_MOST_PIECES = 255


class LineThing:
    """One thing along a line beside the road.

    Parameters
    ----------
    kind : str
        In a word, as the scene tells it.
    line : (float, float, float)
        Chainages from and to, offset to the left of the centre, m: where it stands.
    """

    def __init__(
        self,
        section: StreetSection,
        built: SectionBuilder,
        kind: str,
        line: tuple[float, float, float],
    ) -> None:
        low, far, offset = line
        step = max(PIECE_M, (far - low) / _MOST_PIECES)
        self.instance = built.thing(kind)
        self._built = built
        self._line: Floats = section.position(stations(low, far, step), offset)
        self._chainage_m = (low + far) / 2

    def add(self, shape: TriangleShape, material: Material) -> None:
        """Add triangles; each belongs to the nearest piece of the line."""
        self._built.mesh.add(shape, material, OTHER, self.instance, piece=self._pieces_of(shape))

    def tell(
        self, type_: str, height_m: float, posts_m: float | None = None, kind: str = "fence"
    ) -> None:
        """Tell the truth of it.

        Parameters
        ----------
        type_ : str
            As the tool for barriers names them; ``other``: neither asked for nor wrong.
        height_m : float
            Of its top above its foot.
        posts_m : float, optional
            From post to post.
        kind : str
            Of the catalogue.
        """
        facts: dict[str, Fact] = {"kind": kind, "type": type_, "height_m": height_m}
        if posts_m is not None:
            facts["posts_m"] = posts_m
        self._built.truth.append(
            TrueFeature(
                "barriers", "LineString", self._line, facts, self.instance, self._chainage_m
            )
        )

    def _pieces_of(self, shape: TriangleShape) -> Integers:
        from scipy.spatial import cKDTree

        vertices, triangles = shape
        middles = vertices[triangles].mean(axis=1)[:, :2]
        pieces = (self._line[:-1, :2] + self._line[1:, :2]) / 2
        return np.asarray(cKDTree(pieces).query(middles)[1], np.int64)


def spacing_of(low_m: float, far_m: float, step_m: float) -> float:
    """How far apart posts stand that are at most a step apart."""
    return float(np.diff(stations(low_m, far_m, step_m)[:2])[0])
