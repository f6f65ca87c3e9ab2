"""Projects as earlier versions of the program left them: files without checksums."""

from __future__ import annotations

from pathlib import Path

from processing.core.block_sums import SUFFIX


def forget_all_sums(folder: Path) -> Path:
    """Take away the checksums of all files in a folder, so that what is in them counts."""
    for record in folder.rglob(f"*{SUFFIX}"):
        record.unlink()
    return folder
