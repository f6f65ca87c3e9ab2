"""What a job's patterns match: folders and point files, each a delivery with a name of its own."""

from __future__ import annotations

import glob
import hashlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.text import Text
from processing.operations.batch.job import JobFile
from processing.project.importing.dropped_files import request_of_files
from processing.project.importing.import_request import ImportRequest

_LETTERS = 6


@dataclass(frozen=True)
class BatchDelivery:
    """A folder of delivered files, or one point file.

    Attributes
    ----------
    name : str
        No other delivery of the job has it.
    path : Path
    """

    name: str
    path: Path

    def request(self) -> ImportRequest:
        """Its files, sorted into points, trajectories and images.

        Raises
        ------
        MissingInput
            It holds no points, or is gone.
        """
        return request_of_files((self.path,), "")

    @property
    def size(self) -> int:
        """Bytes of its files, by which the time that is left is foretold; 0 where it is gone."""
        files = self.path.iterdir() if self.path.is_dir() else [self.path]
        return sum(one.stat().st_size for one in files if one.is_file())


def deliveries_of(file: JobFile) -> tuple[BatchDelivery, ...]:
    """The deliveries of a job, in the order of their paths.

    Raises
    ------
    MissingInput
        A pattern matches nothing; says which.
    """
    found: dict[Path, None] = {}
    for pattern in file.job.deliveries:
        matched = matches(file, pattern)
        if not matched:
            raise MissingInput(
                Text("No folder or file is there.", "該当するフォルダやファイルがありません。"),
                Text.same(f"{file.path}: deliveries, {pattern}"),
                Text(
                    "Check the name; it counts from the folder of the job.",
                    "名前を確認してください。ジョブファイルのフォルダから数えます。",
                ),
            )
        found |= dict.fromkeys(matched)
    return named(sorted(found))


def matches(file: JobFile, pattern: str) -> list[Path]:
    """What one pattern matches now; the job's own results are no delivery."""
    with report_as_user_error(file.folder):
        paths = glob.glob(pattern, root_dir=file.folder)  # noqa: PTH207 - takes whole paths too
        whole = [(file.folder / one).resolve() for one in paths]
    own = {file.output.resolve(), file.path}
    return [one for one in whole if one not in own]


def named(paths: Iterable[Path]) -> tuple[BatchDelivery, ...]:
    """Deliveries by the names of their paths; where several share one, letters are added.

    The letters follow from the path alone: the same delivery has the same name in the next run.
    """
    every = list(paths)
    count = Counter(_plain_name(path) for path in every)
    return tuple(
        BatchDelivery(
            _plain_name(path) + (_letters_of(path) if count[_plain_name(path)] > 1 else ""), path
        )
        for path in every
    )


def _plain_name(path: Path) -> str:
    return path.name if path.is_dir() else path.name.split(".")[0] or path.name


def _letters_of(path: Path) -> str:
    digest = hashlib.sha256(str(path).encode("utf-8", "surrogateescape")).hexdigest()
    return f"-{digest[:_LETTERS]}"
