"""ImageOrientation: which way the street runs in an image."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ImageOrientation:
    """How an image is turned and mirrored; the standard one is as the drive saw it from above.

    Attributes
    ----------
    is_vertical : bool
        The drive goes up, its left side is left, as one sees the road ahead; else it goes from
        left to right, its left side up.
    is_mirrored_across : bool
        The sides of the drive are exchanged.
    is_reversed_along : bool
        The drive goes the other way: down, or to the left.
    """

    is_vertical: bool = False
    is_mirrored_across: bool = False
    is_reversed_along: bool = False
