"""WindowRequest: what the command line asks of the window, without knowing Qt."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class WindowRequest:
    """Open the window, with something in it.

    Attributes
    ----------
    paths : tuple of Path
        A project folder, or delivered files to import.
    demo : bool
        Open the demo street.
    headless_out : Path or None
        Do the demo's job by itself, write to this folder and quit.
    """

    paths: tuple[Path, ...] = ()
    demo: bool = False
    headless_out: Path | None = None
