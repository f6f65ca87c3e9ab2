"""What the files of a drive's folder are: which have checksums, and which can be made again."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from pathlib import Path

from processing.core.block_sums import SUFFIX, keep_sums, record_of, sums_of
from processing.core.errors import report_as_user_error
from processing.core.owned_files import is_link
from processing.recording.columns.columns import COLUMN_TYPES, column_path
from processing.recording.columns.point_features import POINT_FEATURES

REQUIRED_COLUMNS = ("xyz", "time", "intensity", "pulse")
_DERIVED_COLUMNS = (
    "normal", "shape", "segment", "seen_color", "is_seen", "judged", "height_above_ground",
    "confidence", "pulse_keys", "pulse_starts", "pulse_points", *POINT_FEATURES,
)  # fmt: skip
_BY_HAND = ("label", "truth")
_SUMMED = (
    "*.bin", "*.wdp", "*.json", "trajectory.npy", "revolutions.npz", "ground_surface.tiles",
    "truths/*/truth.bin", "runs/*/*.bits", "runs/*/*.codes",
)  # fmt: skip
_MADE_WHEN_NEEDED = ("image_rows_*", "tile_bounds_*")


class FileOrigin(Enum):
    """Where a file of a drive comes from."""

    DELIVERED = "delivered"
    """Made at the import: the delivered files say it again."""
    DERIVED = "derived"
    """Made from the others, by the program itself or by a tool: it may be deleted."""
    BY_HAND = "by hand"
    """Labels, truths, offsets, and what runs said: nothing else tells it."""


def origin_of(path: Path) -> FileOrigin:
    """Where a file of a drive comes from, by its name."""
    if path.suffix in (".bits", ".codes") or path.name == "camera_offsets.json":
        return FileOrigin.BY_HAND
    if path.suffix == ".bin" and path.stem in _BY_HAND:
        return FileOrigin.BY_HAND
    is_derived = path.suffix == ".bin" and path.stem in _DERIVED_COLUMNS
    if is_derived or path.suffix == ".tiles" or any(path.match(one) for one in _MADE_WHEN_NEEDED):
        return FileOrigin.DERIVED
    return FileOrigin.DELIVERED


def summed_files(folder: Path) -> list[Path]:
    """The files of a drive that have, or should have, checksums; no links."""
    found = {path for pattern in _SUMMED for path in folder.glob(pattern)}
    return sorted(
        path for path in found if path.is_file() and not is_link(path) and _is_known(path)
    )


def missing_files(folder: Path) -> list[Path]:
    """Files that have checksums and are gone, and columns that no drive is without."""
    records = [path for pattern in _SUMMED for path in folder.glob(f"{pattern}{SUFFIX}")]
    files = [record.with_name(record.name.removesuffix(SUFFIX)) for record in records]
    files += [column_path(folder, name) for name in REQUIRED_COLUMNS]
    return sorted({file for file in files if not file.exists()})


def sum_drive(folder: Path, check: Callable[[], object]) -> list[Path]:
    """Write the checksums of the files of a drive that have none; gives these files.

    Parameters
    ----------
    check : callable
        Called between blocks; may raise to stop.

    Raises
    ------
    NoSpace, MissingInput
    """
    new = []
    for path in summed_files(folder):
        with report_as_user_error(path):
            if not record_of(path).exists():
                keep_sums(path, sums_of(path, check))
                new.append(path)
    return new


def _is_known(path: Path) -> bool:
    return path.suffix != ".bin" or path.stem in COLUMN_TYPES or path.stem in _DERIVED_COLUMNS
