"""What a tile is made of, told to the system before it is read.

A coarse tile samples rows that lie far apart in the files. Read one after the other, each waits
for the disk and brings megabytes along that nobody looks at; told all at once, the disk gathers
just the rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from processing.image.attributes.attributes import ATTRIBUTES
from processing.image.tiles.tiles import TileKey

if TYPE_CHECKING:  # named in annotations only
    from processing.image.point_image import PointCloudImage
    from processing.recording.columns.columns import Columns

_MADE_FROM = {
    "normal": ("normal",),
    "shape": ("shape",),
    "color": ("seen_color", "is_seen", "color"),
    "label": ("label",),
    "class": ("label",),
}
"""Columns an attribute looks at where they are, besides those it needs."""

_NOISE_IS_TOLD_BY = ("classification", "label")

_NEAR_POINTS = 2_000
"""Rows no farther apart than this are read as one: seeking takes longer than reading 24 kB."""


def expect_tile(
    columns: Columns,
    image: PointCloudImage,
    key: TileKey,
    attribute: str,
    *,
    hides_noise: bool = False,
) -> None:
    """Tell that a tile of an image is made next; comes back at once."""
    rows, _ = image.pyramid.rows_columns(key)
    sampled = np.arange(rows.start, rows.stop, 1 << key.level)
    if not sampled.size:
        return
    starts, stops = image.row_starts[sampled], image.row_starts[sampled + 1]
    is_apart = starts[1:] - stops[:-1] > _NEAR_POINTS
    starts = starts[np.concatenate([[True], is_apart])]
    stops = stops[np.concatenate([is_apart, [True]])]
    names = ("pulse", *ATTRIBUTES[attribute].needs, *_MADE_FROM.get(attribute, ()))
    for name in dict.fromkeys(names + (_NOISE_IS_TOLD_BY if hides_noise else ())):
        if columns.has(name):
            columns.expect(name, starts, stops)
