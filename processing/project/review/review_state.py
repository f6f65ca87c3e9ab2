"""Where the review of candidates stands, kept with the project so that it goes on another day."""

from __future__ import annotations

import math
import statistics
from dataclasses import dataclass, replace
from enum import Enum

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.project.store.project_settings import JsonValue, ProjectSettings

_KEY = "review"
_MOST_TIMES = 50
_LEAST_TIMES = 3
_LONGEST_S = 120.0
"""What takes longer is a break."""


class ReviewOrder(Enum):
    """In which order candidates are shown."""

    CONFIDENCE = "confidence"
    """The one that the tool was least sure of first."""
    STREET = "street"
    """As the vehicle passed them, drive by drive."""


@dataclass(frozen=True)
class ReviewState:
    """What is under review, and how far it is; the decisions themselves are in the features.

    Attributes
    ----------
    runs : tuple of str
        Ids of the runs whose candidates are judged; none: no review is going on.
    feature : str
        Id of the candidate that is shown; empty when all are decided.
    decisions : int
        How many were made in this review.
    total_s : float
        How long they took together.
    last_s : tuple of float
        How long the last ones took, in seconds, the latest at the end.
    """

    runs: tuple[str, ...] = ()
    order: ReviewOrder = ReviewOrder.CONFIDENCE
    feature: str = ""
    decisions: int = 0
    total_s: float = 0.0
    last_s: tuple[float, ...] = ()

    @property
    def is_open(self) -> bool:
        """Whether a review is going on."""
        return bool(self.runs)

    @property
    def seconds_per_decision(self) -> float | None:
        """The median of the last ones; None until there are three."""
        return statistics.median(self.last_s) if len(self.last_s) >= _LEAST_TIMES else None

    def decided(self, seconds: float) -> ReviewState:
        """The state after one more decision, which took so long."""
        took = round(min(seconds, _LONGEST_S), 2)
        last = (*self.last_s, took)[-_MOST_TIMES:]
        total = round(self.total_s + took, 2)
        return replace(self, decisions=self.decisions + 1, total_s=total, last_s=last)


@dataclass(frozen=True)
class ReviewProgress:
    """A review in numbers.

    Attributes
    ----------
    accepted, rejected, left : int
        Of the features of the runs under review.
    position : int
        Which of them is shown, counted from 1 in the order of the review; 0: none.
    """

    state: ReviewState
    accepted: int = 0
    rejected: int = 0
    left: int = 0
    position: int = 0

    @property
    def total(self) -> int:
        """All features of the runs."""
        return self.accepted + self.rejected + self.left

    @property
    def seconds_left(self) -> float | None:
        """How long the rest takes at the pace of the last decisions; None while unknown."""
        pace = self.state.seconds_per_decision
        return None if pace is None else pace * self.left

    @property
    def decisions_per_minute(self) -> float | None:
        """The pace of the last decisions; None while unknown."""
        pace = self.state.seconds_per_decision
        return 60 / pace if pace else None


def read_review_state(settings: ProjectSettings) -> ReviewState:
    """The review that a project remembers.

    Raises
    ------
    BadFile
        What is stored is none.
    """
    stored = settings.get(_KEY)
    if stored is None:
        return ReviewState()
    try:
        return _state_of(stored)
    except (KeyError, TypeError, ValueError) as error:
        raise BadFile(
            Text("The place in the review can't be read.", "確認作業の途中状態を読み取れません。"),
            Text.same(f"zuka_settings.{_KEY}: {error}"),
            Text(
                "Start the review again; all decisions are kept.",
                "確認作業を始め直してください。これまでの判定は保存されています。",
            ),
        ) from error


def write_review_state(settings: ProjectSettings, state: ReviewState) -> None:
    """Let the project remember a review.

    Raises
    ------
    NoSpace, InUse
        The old one stays.
    """
    settings.put(
        _KEY,
        {
            "runs": list(state.runs),
            "order": state.order.value,
            "feature": state.feature,
            "decisions": state.decisions,
            "total_s": state.total_s,
            "last_s": list(state.last_s),
        },
    )


def _state_of(stored: JsonValue) -> ReviewState:
    if not isinstance(stored, dict):
        raise TypeError(stored)
    return ReviewState(
        runs=tuple(_text(run) for run in _list(stored["runs"])),
        order=ReviewOrder(stored["order"]),
        feature=_text(stored["feature"]),
        decisions=int(_number(stored["decisions"])),
        total_s=_number(stored["total_s"]),
        last_s=tuple(_number(seconds) for seconds in _list(stored["last_s"])),
    )


def _list(value: JsonValue) -> list[JsonValue]:
    if not isinstance(value, list):
        raise TypeError(value)
    return value


def _text(value: JsonValue) -> str:
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def _number(value: JsonValue) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise TypeError(value)
    return float(value)
