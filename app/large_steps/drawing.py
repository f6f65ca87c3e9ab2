"""Drawing on the image: the mouse that snaps, clicks, and steps back."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.large_steps.bench_window import BenchWindow, StepTimings
from app.large_steps.image import drag_to, go_to, nearer
from app.screenshots.simulated_mouse import LEFT, NO_BUTTON, PLAIN
from processing.map.catalogue import Geometry

_HOVERS = 200
_VERTICES = 50
_LINES = 5
_LEAST_VERTICES = 8
_MARGIN_PX = 40


def hover(window: BenchWindow) -> StepTimings:
    """The mouse over the image with a line begun: what it snaps to, and the line to it."""
    go_to(window, 0.5)
    nearer(window)
    window.rest()
    catalogue = window.parts.document.catalogue()
    kind = next(one for one in catalogue if one.geometry is Geometry.LINE)
    window.parts.toolbox.choose_kind(kind)
    frames = window.image_frames
    frames.seconds_to_paint(lambda: _click(window, _spot(window, 0.0)))
    answers = _Answers(window)
    for number in range(window.some(_HOVERS)):
        spot = _spot(window, number / _HOVERS) + QPoint(number % 5, number % 3)
        answers.take(partial(drag_to, window.image, spot, NO_BUTTON))
    window.mouse.key(window.image, Qt.Key.Key_Escape)
    return {"frame": answers.end()}


def draw(window: BenchWindow) -> StepTimings:
    """Lines of fifty vertices, each a click."""
    frames, answers, done = window.image_frames, _Answers(window), []
    before = _drawn_ids(window)
    lines, vertices = window.some(_LINES), max(_LEAST_VERTICES, window.some(_VERTICES))
    for number in range(lines):
        for vertex in range(vertices):
            spot = _spot(window, (vertex + 0.5) / vertices) + QPoint(0, 9 * number)
            answers.take(partial(_click, window, spot))
        done.append(
            frames.seconds_to_paint(lambda: window.mouse.key(window.image, Qt.Key.Key_Return))
        )
    if len(_drawn_ids(window) - before) != lines:
        message = "the lines that were clicked are not on the map"
        raise RuntimeError(message)
    return {"vertex": answers.end(), "line done": done}


def undo(window: BenchWindow) -> StepTimings:
    """Each line taken back, and drawn again by redo."""
    frames, lines = window.image_frames, window.some(_LINES)
    undone = [frames.seconds_to_paint(lambda: window.act("undo")) for _ in range(lines)]
    redone = [frames.seconds_to_paint(lambda: window.act("redo")) for _ in range(lines)]
    return {"undo": undone, "redo": redone}


class _Answers:
    """Seconds until each act was painted; where it changes nothing that is seen, to do it."""

    def __init__(self, window: BenchWindow) -> None:
        shared = window.parts.document.shared
        self._frames = window.image_frames
        self._signals = shared.sketch.changed, shared.snap.mark_changed
        self._is_other = False
        self._times: list[float] = []
        for signal in self._signals:
            signal.connect(self._note)

    def take(self, act: Callable[[], object]) -> None:
        self._is_other = False
        self._times.append(self._frames.seconds_to_paint(act, follows=lambda: self._is_other))

    def end(self) -> list[float]:
        for signal in self._signals:
            signal.disconnect(self._note)
        return self._times

    def _note(self) -> None:
        self._is_other = True


def _drawn_ids(window: BenchWindow) -> set[str]:
    return {feature.id for feature in window.parts.document.features()}


def _click(window: BenchWindow, spot: QPoint) -> None:
    drag_to(window.image, spot, NO_BUTTON)
    QTest.mouseClick(window.image, LEFT, PLAIN, spot)


def _spot(window: BenchWindow, share: float) -> QPoint:
    """Along a wave through the middle of the image, where the street is."""
    width = window.image.width() - 2 * _MARGIN_PX
    high = math.sin(20.0 * share) * 0.1 * window.image.height()
    return QPoint(_MARGIN_PX + round(share * width), window.middle.y() + round(high))
