"""Scenes of what tools found: the queue of candidates, what came of it, the runs."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from datetime import UTC, datetime, timedelta

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QTreeWidget

from app.review.review import Review
from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.street import LEFT, RIGHT
from processing.core.text import Text
from processing.map.change import Change
from processing.map.feature import Feature, Vertex
from processing.project.results.found_features import found_features
from processing.project.review.review_state import ReviewOrder
from processing.tools.template import TEMPLATE
from processing.tools.tool import Candidate, CandidateGeometry, CandidateResult
from widgets.panels.project.project_runs import RUN

_STARTED = datetime(2026, 11, 20, 9, 30, tzinfo=UTC)
_SAW_TEETH = 17
_EMPTY_MAP = Text("Empty map", "図面を空にする")


def waiting(studio: ScreenshotWindow) -> None:
    """Two runs that wait to be reviewed."""
    _find_curbs(studio)
    studio.bring("review")


def candidate(studio: ScreenshotWindow) -> None:
    """A candidate in all views, and what can be done with it."""
    _open(studio)
    _judge(studio, 5)


def worst(studio: ScreenshotWindow) -> None:
    """The first candidate: the one of which its tool was least sure."""
    _open(studio)


def correcting(studio: ScreenshotWindow) -> None:
    """A candidate that is being corrected."""
    _open(studio)
    _judge(studio, 2)
    studio.act("review-edit")


def with_rejected(studio: ScreenshotWindow) -> None:
    """Rejected candidates are drawn as well."""
    _open(studio)
    _judge(studio, 9)
    studio.act("show-rejected")


def done(studio: ScreenshotWindow) -> None:
    """All candidates were judged."""
    _open(studio)
    review = studio.parts.of(Review)
    _judge(studio, 6)
    review.accept_from(0.0)


def evaluation(studio: ScreenshotWindow) -> None:
    """What became of the candidates, by tool, with the curve of reliability."""
    _find_curbs(studio)
    studio.parts.of(Review).open(_runs(studio), ReviewOrder.CONFIDENCE)
    _judge(studio, 22)
    studio.act("evaluation")


def evaluation_empty(studio: ScreenshotWindow) -> None:
    """Nothing was judged yet."""
    studio.act("evaluation")


def runs(studio: ScreenshotWindow) -> None:
    """The runs in the project's tree, with what can be done to one."""
    _find_curbs(studio)
    studio.parts.of(Review).open(_runs(studio), ReviewOrder.CONFIDENCE)
    _judge(studio, 4)
    studio.parts.of(Review).close()
    studio.bring("project")
    studio.settle()
    tree = studio.parts.project_tree.findChildren(QTreeWidget)[0]
    items = tree.findItems("", Qt.MatchFlag.MatchContains | Qt.MatchFlag.MatchRecursive, 0)
    run = next(item for item in items if item.data(0, RUN))
    tree.scrollToItem(run)
    spot = tree.visualItemRect(run).center()
    studio.mouse.click(tree.viewport(), spot)
    tree.customContextMenuRequested.emit(spot)


def _open(studio: ScreenshotWindow) -> None:
    """Candidates in the layout for checking; the queue is begun by its key."""
    _find_curbs(studio)
    studio.act("layout-checking")
    studio.settle()
    studio.act("review-start")
    studio.settle()


def _judge(studio: ScreenshotWindow, count: int) -> None:
    """Decide as somebody does who finds that unsure candidates are often wrong."""
    review = studio.parts.of(Review)
    for number in range(count):
        feature = review.current
        if feature is None:
            return
        confidence = feature.provenance.confidence or 0.0
        is_right = confidence > 0.25 + 0.5 * (number * 7 % _SAW_TEETH) / _SAW_TEETH
        studio.act("review-accept" if is_right else "review-reject")


def _find_curbs(studio: ScreenshotWindow) -> None:
    """Let a tool have found the curbs of the drawing piece by piece, instead of somebody."""
    document = studio.parts.document
    drawn = tuple(document.features())
    document.apply(_EMPTY_MAP, Change(removed=drawn))
    random = np.random.default_rng(4)
    for number, name in enumerate((RIGHT, LEFT)):
        drive = studio.drive(name).id
        found = [
            _candidate(feature, vertices, float(random.uniform(0.2, 0.99)))
            for feature in drawn
            for vertices in _pieces(feature)
            if all(one.measured is not None and one.measured.drive == drive for one in vertices)
        ]
        started = _STARTED + timedelta(minutes=3 * number)
        document.store_run(
            found_features(
                CandidateResult(tuple(found)),
                TEMPLATE,
                TEMPLATE.parameters(),
                (drive,),
                started=started,
                finished=started + timedelta(seconds=41),
            )
        )


def _pieces(feature: Feature) -> list[tuple[Vertex, ...]]:
    """A line's segments, a point as it is."""
    if len(feature.vertices) == 1:
        return [feature.vertices]
    return list(itertools.pairwise(feature.vertices))


def _candidate(feature: Feature, vertices: tuple[Vertex, ...], confidence: float) -> Candidate:
    points = [-1 if one.measured is None else one.measured.point for one in vertices]
    xyz = np.array([one.xyz for one in vertices])
    geometry: CandidateGeometry = "point" if len(vertices) == 1 else "line"
    return Candidate(feature.kind, geometry, xyz, np.array(points), confidence)


def _runs(studio: ScreenshotWindow) -> tuple[str, ...]:
    return tuple(run.id for run in studio.parts.document.runs())


CHECKING: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "evaluation": evaluation,
    "evaluation-empty": evaluation_empty,
    "review-candidate": candidate,
    "review-correct": correcting,
    "review-done": done,
    "review-rejected": with_rejected,
    "review-waiting": waiting,
    "review-worst": worst,
    "runs-menu": runs,
}
