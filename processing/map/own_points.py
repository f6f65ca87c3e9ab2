"""OwnPoints: the measured points that a thing consists of, as runs of numbers in one drive."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_RUNS = re.compile(r"[0-9]{1,15}:[0-9]{1,15}(?: [0-9]{1,15}:[0-9]{1,15})*")


@dataclass(frozen=True)
class OwnPoints:
    """Points of one drive. Neighbours on a scan line follow each other, so runs are few and short.

    Attributes
    ----------
    drive : str
        Its id.
    runs : str
        ``"gap:length gap:length …"``: so many points of the drive are not the thing's, and so many
        then are. A text takes less room than numbers and can be compared.

    Raises
    ------
    ValueError
        ``runs`` is no such text.
    """

    drive: str
    runs: str

    def __post_init__(self) -> None:
        if not _RUNS.fullmatch(self.runs):
            message = f"no runs of points: {self.runs[:80]!r}"
            raise ValueError(message)

    @property
    def count(self) -> int:
        """How many points they are."""
        return int(self._pairs()[:, 1].sum())

    def numbers(self, count: int) -> NDArray[np.int64]:
        """Their numbers in the drive, rising; those that a drive of ``count`` points has."""
        pairs = self._pairs()
        stops = np.minimum(np.cumsum(pairs.sum(axis=1)), count)
        starts = np.minimum(np.cumsum(pairs.sum(axis=1)) - pairs[:, 1], count)
        lengths = stops - starts
        firsts = starts - (np.cumsum(lengths) - lengths)
        return np.repeat(firsts, lengths) + np.arange(int(lengths.sum()))

    def _pairs(self) -> NDArray[np.int64]:
        numbers = self.runs.replace(":", " ").split()
        return np.array(numbers, dtype=np.int64).reshape(-1, 2)


def own_points(drive: str, numbers: ArrayLike) -> OwnPoints:
    """Points of a drive by their numbers.

    Parameters
    ----------
    numbers : (n,) int64
        At least one, in any order; the same one may come twice.
    """
    rising = np.unique(np.asarray(numbers, dtype=np.int64))
    ends = np.flatnonzero(np.diff(rising) != 1)
    starts = rising[np.concatenate([[0], ends + 1])]
    stops = rising[np.concatenate([ends, [rising.size - 1]])] + 1
    gaps = starts - np.concatenate([[0], stops[:-1]])
    pairs = zip(gaps.tolist(), (stops - starts).tolist(), strict=True)
    return OwnPoints(drive, " ".join(f"{gap}:{length}" for gap, length in pairs))
