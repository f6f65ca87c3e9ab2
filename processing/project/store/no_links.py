"""A project holds what it owns, no links: or it would write and remove outside of itself."""

from __future__ import annotations

from pathlib import Path

from processing.core.owned_files import links_below, refuse_link
from processing.labels.label_column import LABEL
from processing.recording.columns.columns import column_path

_DRIVES = "drives"
_COLUMN_DEPTH = 3  # drives, the drive, the column


def refuse_links(folder: Path, own: tuple[str, ...]) -> None:
    """Refuse a project with a link among what is its own.

    A column on another disk may be a link: columns are replaced, never written; but for labels,
    which are painted in place.

    Parameters
    ----------
    own : tuple of str
        Files and folders of a project, at most two names deep; other things in its folder are
        none of its business.

    Raises
    ------
    InUse
        Names the link; nothing was touched.
    """
    for path in (folder / name for name in own):
        if path.parent != folder:
            refuse_link(path.parent)
        for link in links_below(path):
            if not _is_column(link, folder):
                refuse_link(link)


def _is_column(path: Path, folder: Path) -> bool:
    parts = path.relative_to(folder).parts
    is_one = len(parts) == _COLUMN_DEPTH and parts[0] == _DRIVES and path.suffix == ".bin"
    return is_one and path.is_file() and path.name != column_path(folder, LABEL).name
