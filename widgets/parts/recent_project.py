"""RecentProject: a project that was opened before, as the start page lists it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path


@dataclass(frozen=True)
class RecentProject:
    """One line of the list.

    Attributes
    ----------
    opened_at : datetime or None
        When it was opened last; None where that isn't known.
    is_missing : bool
        The folder is not there now.
    """

    folder: Path
    opened_at: datetime | None = None
    is_missing: bool = False
