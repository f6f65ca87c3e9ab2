"""Truth of covers in the ground: manholes, valves, hand holes, gratings of basins.

A cover's instance has pieces, and the share of them that points show says how well it was seen.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import Fact, SectionBuilder, TrueFeature

VALVE_M = 0.35
"""Round covers up to here are of valves: 仕切弁 and ガス弁 have 0.1 to 0.3 m, manholes 0.6 m."""


def tell_round_cover(
    built: SectionBuilder,
    where: tuple[Floats, float],
    diameter_m: float,
    which: tuple[int, int],
) -> None:
    """Tell a round cover.

    Parameters
    ----------
    where : ((3,) float64, float)
        Its middle, on its top, and its chainage.
    which : (int, int)
        Its instance, and how many pieces it has.
    """
    middle, chainage = where
    instance, pieces = which
    facts: dict[str, Fact] = {
        "kind": "valve_cover" if diameter_m <= VALVE_M else "manhole",
        "shape": "round",
        "diameter_m": diameter_m,
        "lies_in": "carriageway",
        "pieces": pieces,
    }
    xyz = np.asarray(middle, np.float64).reshape(1, 3)
    built.truth.append(TrueFeature("covers", "Point", xyz, facts, instance, chainage))


def tell_square_cover(
    built: SectionBuilder,
    where: tuple[Floats, float, str],
    kind: str,
    which: tuple[int, int],
    *,
    is_asked: bool = True,
) -> None:
    """Tell a cover with four corners.

    Parameters
    ----------
    where : ((4, 3) float64, float, str)
        Its corners round it, its chainage, and what it lies in.
    kind : str
        Of the catalogue.
    which : (int, int)
        Its instance, and how many pieces it has.
    is_asked : bool
        Whether it should be found: gratings between lids belong to their gutter.
    """
    corners, chainage, lies_in = where
    instance, pieces = which
    sides = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    facts: dict[str, Fact] = {
        "kind": kind,
        "shape": "square",
        "width_m": float(min(sides[:2])),
        "length_m": float(max(sides[:2])),
        "lies_in": lies_in,
        "pieces": pieces,
    }
    if not is_asked:
        facts["is_asked"] = False
    ring = np.concatenate([corners, corners[:1]])
    built.truth.append(TrueFeature("covers", "Polygon", ring, facts, instance, chainage))
