"""Features as one file, by the ending of its name: what ``zuka run`` gives for tools that find."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Language
from processing.formats.format import Content
from processing.formats.format_list import FormatList
from processing.formats.map_delivery import MapDelivery
from processing.formats.registry import FORMATS
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature


def write_feature_file(
    path: Path,
    features: Sequence[Feature],
    catalogue: Catalogue,
    crs: str,
    monitor: Monitor,
    *,
    never: Iterable[Path] = (),
    language: Language | None = None,
    formats: FormatList = FORMATS,
) -> None:
    """Write features with kind, confidence, status and attributes.

    Parameters
    ----------
    path : Path
        Its ending says the format.
    crs : str
        ``EPSG:n``; empty where it is not known, which the file then says.
    never : iterable of Path
        Files that must not be overwritten.
    language : "en", "ja" or None
        Of the headers of a table; None for the ids of its columns.

    Raises
    ------
    OutOfRange
        The ending says no known format.
    UserError
        What stands against writing; `Cancelled`.
    """
    write = formats.format_to_write(path, Content.FEATURES).writer(Content.FEATURES)
    delivery = MapDelivery(tuple(features), catalogue, crs, language)
    write(path, delivery, monitor, never=never)
