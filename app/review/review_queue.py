"""ReviewQueue: candidates in the order in which they are judged, and where one goes next."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections import Counter
from collections.abc import Iterator, Sequence

from processing.map.feature import Status


class ReviewQueue:
    """The features of the runs under review; decided ones stay in their places.

    Parameters
    ----------
    ids : sequence of str
        In the order of the review.
    statuses : sequence of Status
    confidences : sequence of float
        Of each.
    """

    def __init__(
        self,
        ids: Sequence[str] = (),
        statuses: Sequence[Status] = (),
        confidences: Sequence[float] = (),
    ) -> None:
        self._ids = list(ids)
        self._positions = {id_: position for position, id_ in enumerate(self._ids)}
        self._statuses = dict(zip(self._ids, statuses, strict=True))
        self._confidences = dict(zip(self._ids, confidences, strict=True))
        self._counts = Counter(self._statuses.values())
        self._undecided = sorted(self._confidences[id_] for id_ in self.undecided())

    def __len__(self) -> int:
        return len(self._ids)

    def __contains__(self, id_: str) -> bool:
        return id_ in self._statuses

    def count(self, status: Status) -> int:
        """How many features have a status."""
        return self._counts[status]

    def status(self, id_: str) -> Status | None:
        """What a feature was when it was last told of; None for one that isn't in the queue."""
        return self._statuses.get(id_)

    def position(self, id_: str) -> int:
        """A feature's place, counted from 1; 0 for one that isn't in the queue."""
        return self._positions.get(id_, -1) + 1

    def took(self, id_: str, status: Status) -> None:
        """A feature of the queue has this status now."""
        before, confidence = self._statuses[id_], self._confidences[id_]
        if before is Status.CANDIDATE:
            del self._undecided[bisect_left(self._undecided, confidence)]
        if status is Status.CANDIDATE:
            insort(self._undecided, confidence)
        self._counts[before] -= 1
        self._counts[status] += 1
        self._statuses[id_] = status

    def without(self, ids: set[str]) -> ReviewQueue:
        """The queue after some features are gone."""
        left = [id_ for id_ in self._ids if id_ not in ids]
        return ReviewQueue(
            left,
            [self._statuses[id_] for id_ in left],
            [self._confidences[id_] for id_ in left],
        )

    def count_from(self, least: float) -> int:
        """How many that nobody has judged have at least this confidence."""
        return len(self._undecided) - bisect_left(self._undecided, least)

    def undecided_from(self, least: float) -> list[str]:
        """Their ids, in the order of the review."""
        return [id_ for id_ in self.undecided() if self._confidences[id_] >= least]

    def undecided(self, after: str = "") -> Iterator[str]:
        """Ids that nobody has judged, those behind a feature first, then from the beginning.

        The feature itself comes at the very end.
        """
        start = self.position(after)
        for id_ in (*self._ids[start:], *self._ids[:start]):
            if self._statuses[id_] is Status.CANDIDATE:
                yield id_

    def before(self, id_: str) -> str:
        """The feature in the place before, judged or not; empty at the beginning."""
        position = self.position(id_)
        return self._ids[position - 2] if position > 1 else ""
