"""Points with the classes they were given, a block at a time, and two files of one order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text

_ALMOST = 1e-3  # of a step, for coordinates that should lie on the same lattice


@dataclass(frozen=True)
class CodedPoints:
    """Consecutive points of a file.

    Attributes
    ----------
    codes : (n,) uint8
    xyz : (n, 3) float64 or None
        m; None where the file has codes alone.
    kinds : mapping of str to (n,) int16
        What each point belongs to, by the names that the file has for it; may be empty.
    """

    codes: NDArray[np.uint8]
    xyz: NDArray[np.float64] | None = None
    kinds: Mapping[str, NDArray[np.int16]] = field(default_factory=dict)

    def part(self, chosen: slice | NDArray[np.int64]) -> CodedPoints:
        """Some of the points."""
        return CodedPoints(
            self.codes[chosen],
            None if self.xyz is None else self.xyz[chosen],
            {name: values[chosen] for name, values in self.kinds.items()},
        )


@dataclass(frozen=True)
class CodedFile:
    """A file of points with classes.

    Attributes
    ----------
    path : Path
        For messages.
    count : int
        Points.
    step_m : float
        What the coordinates are rounded to; 0 where they are as written, or there are none.
    has_positions : bool
        Whether its blocks have coordinates.
    blocks : callable
        Gives the points in the file's order, as often as asked, in blocks of any size.
    """

    path: Path
    count: int
    step_m: float
    has_positions: bool
    blocks: Callable[[], Iterator[CodedPoints]]


@dataclass(frozen=True)
class CodePairs:
    """The same points in the truth and in the result.

    Attributes
    ----------
    truth, result : CodedPoints
        Of one length.
    """

    truth: CodedPoints
    result: CodedPoints


def pairs_by_order(truth: CodedFile, result: CodedFile, monitor: Monitor) -> Iterator[CodePairs]:
    """The points of two files of the same order, a block at a time.

    Raises
    ------
    Unsuitable
        The files have not the same number of points, or coordinates differ by more than half of
        what they are rounded to.
    """
    if truth.count != result.count:
        raise _other_count(truth, result)
    off_m = max(truth.step_m, result.step_m) * (0.5 + _ALMOST) + _ALMOST**2
    done = 0
    for ours, theirs in _align_blocks(truth.blocks(), result.blocks()):
        monitor.check()
        if ours.xyz is not None and theirs.xyz is not None:
            far = ~(np.abs(ours.xyz - theirs.xyz).max(axis=1) <= off_m)
            if far.any():
                raise _other_order(truth, result, done + int(np.argmax(far)) + 1)
        done += len(ours.codes)
        monitor.report(done / max(truth.count, 1))
        yield CodePairs(ours, theirs)


def _align_blocks(
    ours: Iterator[CodedPoints], theirs: Iterator[CodedPoints]
) -> Iterator[tuple[CodedPoints, CodedPoints]]:
    """Blocks of both, cut where either ends."""
    one, other = next(ours, None), next(theirs, None)
    while one is not None and other is not None:
        size = min(len(one.codes), len(other.codes))
        if size:
            yield one.part(slice(0, size)), other.part(slice(0, size))
        one = one.part(slice(size, None)) if size < len(one.codes) else next(ours, None)
        other = other.part(slice(size, None)) if size < len(other.codes) else next(theirs, None)


def _other_count(truth: CodedFile, result: CodedFile) -> Unsuitable:
    return Unsuitable(
        Text(
            "The truth has {truth} points, the result {result}.",
            "正解の点数は{truth}、結果の点数は{result}で、一致しません。",
        ).filled(truth=f"{truth.count:,}", result=f"{result.count:,}"),
        both_names(truth, result),
        SAME_CLOUD,
    )


def _other_order(truth: CodedFile, result: CodedFile, point: int) -> Unsuitable:
    return Unsuitable(
        Text(
            "Point {point} lies at another place in the result than in the truth.",
            "{point}番目の点の位置が、結果と正解とで異なります。",
        ).filled(point=f"{point:,}"),
        both_names(truth, result),
        SAME_CLOUD,
    )


def both_names(truth: CodedFile, result: CodedFile) -> Text:
    """Where a message is about: both files."""
    return Text.same(f"{result.path}, {truth.path}")


SAME_CLOUD = Text(
    "Score what the tool wrote of the very cloud that the truth is for; points must be classified, "
    "not deleted.",
    "正解と同じ点群を処理した結果を指定してください。点は削除せず、分類した結果が必要です。",
)
"""What to do when two files don't hold the same points."""
