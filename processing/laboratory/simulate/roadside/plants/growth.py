"""Kinds of trees along Japanese streets: how high, how wide, how they branch."""

from __future__ import annotations

from dataclasses import dataclass

from processing.laboratory.simulate.street.styles import Range


@dataclass(frozen=True)
class Growth:
    """What trees of one kind are drawn from.

    Attributes
    ----------
    high_m : (float, float)
    slenderness : (float, float)
        Height by trunk diameter.
    base : (float, float)
        Where the crown begins, as a share of the height.
    crown : (float, float)
        Its diameter by its height.
    rise_deg : (float, float)
        Of branches above the level where they leave the trunk; negative hang.
    form : float
        Where the crown is widest: 0 at its base (cone), 0.5 in the middle, 1 at its top (vase).
    droop : float
        How far the ends of branches sink, as a share of their length; negative rise.
    stems : tuple of int
        Fewest and most.
    is_evergreen : bool
    """

    name: str
    high_m: Range
    slenderness: Range
    base: Range
    crown: Range
    rise_deg: Range
    form: float
    droop: float
    stems: tuple[int, int] = (1, 1)
    is_evergreen: bool = False


# Kinds and sizes after 国土技術政策総合研究所資料第1059号 (street trees of Japan, 2018): ginkgo,
# cherry, zelkova, dogwood and maple are the most frequent ones.
GROWTHS = (
    Growth("ginkgo", (5, 14), (34, 55), (0.2, 0.35), (0.3, 0.5), (35, 60), 0.3, -0.1),
    Growth("cherry", (4, 9), (20, 38), (0.25, 0.35), (0.9, 1.4), (15, 45), 0.6, 0.1),
    Growth("zelkova", (6, 15), (28, 48), (0.22, 0.35), (0.7, 1.0), (45, 70), 0.8, 0.1),
    Growth("dogwood", (2.8, 6), (35, 60), (0.28, 0.42), (0.6, 0.9), (20, 50), 0.5, 0.0),
    Growth("maple", (4, 10), (30, 50), (0.25, 0.38), (0.6, 0.9), (30, 55), 0.5, 0.0),
    Growth("plane tree, pollarded", (4, 8), (14, 26), (0.45, 0.6), (0.5, 0.9), (30, 80), 0.6, -0.2),
    Growth("camphor", (5, 12), (20, 34), (0.22, 0.34), (0.7, 1.0), (25, 55), 0.5, 0.0,
           is_evergreen=True),
    Growth("oak, evergreen", (3, 8), (28, 48), (0.3, 0.45), (0.4, 0.7), (30, 60), 0.5, -0.05,
           (1, 2), is_evergreen=True),
    Growth("willow", (4, 9), (22, 36), (0.3, 0.42), (0.8, 1.2), (35, 65), 0.6, 0.75),
    Growth("metasequoia", (7, 16), (34, 50), (0.14, 0.24), (0.25, 0.4), (5, 30), 0.05, 0.05),
    Growth("crape myrtle", (2.8, 6), (38, 60), (0.32, 0.45), (0.6, 1.0), (45, 70), 0.7, 0.05,
           (2, 5)),
    Growth("ash, several stems", (3.5, 8), (42, 70), (0.3, 0.45), (0.5, 0.8), (40, 65), 0.6, 0.0,
           (2, 5)),
    Growth("poplar, columnar", (6, 14), (35, 55), (0.15, 0.25), (0.15, 0.3), (65, 80), 0.4, -0.2),
)  # fmt: skip
YARD_GROWTHS = tuple(one for one in GROWTHS if one.high_m[0] < 5)
AVENUE_GROWTHS = tuple(one for one in GROWTHS if one.high_m[1] >= 8 and one.crown[1] >= 0.5)
CEDAR = Growth(
    "cedar", (9, 22), (45, 75), (0.3, 0.6), (0.25, 0.45), (-5, 20), 0.1, 0.1, is_evergreen=True
)
"""Sugi and hinoki of plantations beside country roads."""
