"""Moving about in 3D: turning about the street, and flying along it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.large_steps.bench_window import BenchWindow, StepTimings
from app.large_steps.image import drag_to
from app.screenshots.simulated_mouse import PLAIN, RIGHT, SHIFT

_MOVES, _STEP_PX = 60, 5
_NOTCHES_NEARER = 4
_FLIGHT = 120


def orbit(window: BenchWindow) -> StepTimings:
    """Turned by the right button: over the whole, and near what is in the middle."""
    window.mouse.key(window.picture, Qt.Key.Key_Home)
    window.rest()
    times = _turn(window)
    for _ in range(_NOTCHES_NEARER):
        times.append(_frame(window, lambda: _wheel(window, 1, PLAIN)))
    window.rest()
    return {"frame": times + _turn(window)}


def fly(window: BenchWindow) -> StepTimings:
    """Along the drive by the wheel with Shift, forwards and back."""
    window.act("show-intensity")
    window.mouse.key(window.picture, Qt.Key.Key_Home)
    window.rest()
    times = [_frame(window, lambda: _wheel(window, 1, SHIFT)) for _ in range(window.some(_FLIGHT))]
    return {"frame": times + [_frame(window, lambda: _wheel(window, -1, SHIFT)) for _ in times]}


def _turn(window: BenchWindow) -> list[float]:
    picture = window.picture
    begin = picture.rect().center() - QPoint(_MOVES * _STEP_PX // 2, 0)
    QTest.mousePress(picture, RIGHT, PLAIN, begin)
    # The first move only shows that it is a drag.
    drag_to(picture, begin + QPoint(_STEP_PX, 0), RIGHT)
    times = []
    for number in range(2, window.some(_MOVES) + 2):
        spot = begin + QPoint(number * _STEP_PX, number % 7)
        times.append(_frame(window, partial(drag_to, picture, spot, RIGHT)))
    QTest.mouseRelease(picture, RIGHT, PLAIN, spot)
    return times


def _wheel(window: BenchWindow, notches: int, modifiers: Qt.KeyboardModifier) -> None:
    window.mouse.wheel(window.picture, window.picture.rect().center(), notches, modifiers)


def _frame(window: BenchWindow, act: Callable[[], object]) -> float:
    return window.picture_frames.seconds_to_paint(act)
