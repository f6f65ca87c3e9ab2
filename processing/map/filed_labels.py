"""FiledLabels: the labels of many points, before and after, in a folder of the project.

What somebody paints lies in the database. What a tool says of millions of points would hold it up
for seconds: it is written by a worker's thread, and the database only names the folder.
"""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from processing.core.block_sums import SUFFIX
from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.map.label_change import LabelChange

LABEL_STEPS = "label_steps"
"""Folder of a project: a folder for each step."""

PARTS = "parts.bin"
"""File of such a folder: packed points and codes, part after part."""


_CHECK = 4


@dataclass(frozen=True)
class FiledPart:
    """Where one `LabelChange` lies in the file.

    Attributes
    ----------
    drive : str
    count, first, last : int
        Number of points, and the lowest and highest of them.
    position : int
        Of its first byte.
    sizes : tuple of int
        Bytes of its points, of their codes before and after.
    """

    drive: str
    count: int
    first: int
    last: int
    position: int
    sizes: tuple[int, int, int]


@dataclass(frozen=True)
class FiledLabels:
    """Labels of many points that become others; a point is named at most once.

    Attributes
    ----------
    folder : Path
    parts : tuple of FiledPart
    is_inverse : bool
        Whether it takes back what the file says.
    """

    folder: Path
    parts: tuple[FiledPart, ...]
    is_inverse: bool = False

    @property
    def counts(self) -> Mapping[str, int]:
        """Points by drive."""
        counts: Counter[str] = Counter()
        for part in self.parts:
            counts[part.drive] += part.count
        return counts

    def changes(self, drive: str = "") -> Iterator[LabelChange]:
        """The parts, one after the other, of all drives or of one.

        Raises
        ------
        MissingInput, BadFile
            The file is gone or can't be read.
        """
        for part in self.parts:
            if drive in ("", part.drive):
                yield self.read(part)

    def read(self, part: FiledPart) -> LabelChange:
        """One part.

        Raises
        ------
        MissingInput, BadFile
            The file is gone, can't be read or is damaged.
        """
        path = self.folder / PARTS
        with report_as_user_error(path), path.open("rb") as file:
            file.seek(part.position)
            packed = file.read(sum(part.sizes) + _CHECK)
        content, check = packed[: sum(part.sizes)], packed[sum(part.sizes) :]
        if check != check_of(content):
            raise _make_damage_error(path)
        points_end, before_end = part.sizes[0], part.sizes[0] + part.sizes[1]
        change = LabelChange(
            part.drive,
            part.count,
            content[:points_end],
            content[points_end:before_end],
            content[before_end:],
        )
        return change.inverse() if self.is_inverse else change

    def column_file(self, drive: str) -> Path:
        """Where a drive's column, as this makes it, lies until it takes the old one's place."""
        return self.folder / f"{'before' if self.is_inverse else 'after'}-{drive}.bin"

    def inverse(self) -> FiledLabels:
        """What takes this back."""
        return replace(self, is_inverse=not self.is_inverse)


def is_file_of_step(name: str) -> bool:
    """Whether a file of such a folder may have this name."""
    is_column = name.startswith(("before-", "after-")) and name.endswith((".bin", f".bin{SUFFIX}"))
    return name == PARTS or is_column


def check_of(content: bytes) -> bytes:
    """What stands behind a part, so that damage is told from labels."""
    return zlib.crc32(content).to_bytes(_CHECK, "little")


def _make_damage_error(path: Path) -> BadFile:
    return BadFile(
        Text("The labels of this step are damaged.", "この操作のラベルの記録が壊れています。"),
        Text.same(str(path)),
        Text(
            "Take the project from a backup, or go on from the labels as they are. {unchanged}",
            "バックアップからプロジェクトを復元するか、現在のラベルのまま続けてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def filed_to_plain(filed: FiledLabels) -> dict[str, object]:
    """What the history remembers: the folder's name, and what lies where."""
    parts = [[p.drive, p.count, p.first, p.last, p.position, *p.sizes] for p in filed.parts]
    return {"folder": filed.folder.name, "parts": parts}


def filed_of_plain(stored: Mapping[str, Any], steps: Path) -> FiledLabels:
    """The labels of :func:`filed_to_plain`; ``Any`` since it is JSON.

    Parameters
    ----------
    steps : Path
        The project's folder of such folders.

    Raises
    ------
    ValueError, KeyError, TypeError
        It is damaged.
    """
    name = str(stored["folder"])
    if Path(name).name != name:
        message = f"a folder {name}"
        raise ValueError(message)
    parts = []
    for drive, *numbers in stored["parts"]:
        count, first, last, position, *sizes = map(int, numbers)
        points, before, after = sizes
        parts.append(FiledPart(str(drive), count, first, last, position, (points, before, after)))
    return FiledLabels(steps / name, tuple(parts))
