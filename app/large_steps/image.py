"""Moving about in the image: jumps, drags, the wheel, another attribute."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.large_steps.bench_window import BenchWindow, StepTimings
from app.screenshots.simulated_mouse import MIDDLE, PLAIN, move

_JUMPS = 40
_DRAGS, _MOVES, _STEP_PX = 8, 40, 24
_FAR_NOTCHES = 12
_ROUNDS, _MOST_NOTCHES = 4, 60
_SEED = 5
_ATTRIBUTES = ("height", "class", "intensity", "height", "intensity")


def jump(window: BenchWindow) -> StepTimings:
    """Clicks on the strip with the whole drive, here and there: the first tile, and all of them."""
    nearer(window)
    found: StepTimings = {"first tile": [], "window sharp": []}
    random = np.random.default_rng(_SEED)
    for share in random.uniform(0.02, 0.98, window.some(_JUMPS)).tolist():
        first, sharp = _time_sharp(window, partial(go_to, window, share))
        found["first tile"].append(first)
        found["window sharp"].append(sharp)
    return found


def pan(window: BenchWindow) -> StepTimings:
    """Drags along the street where a pulse is a pixel or more."""
    go_to(window, 0.3)
    nearer(window)
    window.rest()
    return {"frame": _drag_along(window)}


def pan_far(window: BenchWindow) -> StepTimings:
    """Drags along the street seen from far, where a tile is some thousand revolutions long."""
    window.mouse.key(window.image, Qt.Key.Key_Home)
    window.mouse.wheel(window.image, window.middle, _FAR_NOTCHES)
    window.rest()
    return {"frame": _drag_along(window)}


def zoom(window: BenchWindow) -> StepTimings:
    """The wheel, from the whole drive to where a pulse is a pixel, and back; at several places."""
    view, found = window.parts.image_view, StepTimings(frame=[])
    shares = np.linspace(0.2, 0.8, window.some(_ROUNDS))
    for share in shares.tolist():
        window.mouse.key(window.image, Qt.Key.Key_Home)
        window.rest()
        spot = QPoint(round(share * view.width()), window.middle.y())
        notches = 0
        while view.viewport.zoom < 1.0 and notches < _MOST_NOTCHES:
            found["frame"].append(_wheel(window, spot, 1))
            notches += 1
        found["frame"] += [_wheel(window, spot, -1) for _ in range(notches)]
    return found


def switch_attribute(window: BenchWindow) -> StepTimings:
    """Another attribute on all that is seen, until it is sharp."""
    go_to(window, 0.6)
    nearer(window)
    window.rest()
    times = []
    for attribute in _ATTRIBUTES:
        _, sharp = _time_sharp(window, partial(window.act, f"show-{attribute}"))
        times.append(sharp)
        window.rest()
    return {"sharp": times}


def go_to(window: BenchWindow, share: float) -> None:
    """Click the strip at a share of its length."""
    strip = window.minimap
    spot = QPoint(round(share * strip.width()), strip.height() // 2)
    QTest.mouseClick(strip, Qt.MouseButton.LeftButton, PLAIN, spot)


def nearer(window: BenchWindow) -> None:
    """Turn the wheel until a pulse is a pixel, or out until it is hardly more."""
    view = window.parts.image_view
    for _ in range(_MOST_NOTCHES):
        if view.viewport.zoom >= 1.0:
            return
        _wheel(window, window.middle, 1)


def _time_sharp(window: BenchWindow, act: Callable[[], object]) -> tuple[float, float]:
    """Seconds to the frame with the first tile that was missing, and to the one with the last."""
    came: list[bool] = []
    first: list[float] = []

    def note() -> None:
        came.append(True)

    def is_sharp() -> bool:
        if not first and (came or window.tiles.is_complete):
            first.append(time.perf_counter() - began)
        return window.tiles.is_complete

    window.tiles.changed.connect(note)
    began = time.perf_counter()
    sharp = window.image_frames.seconds_to_paint(act, is_sharp)
    window.tiles.changed.disconnect(note)
    return first[0], sharp


def _wheel(window: BenchWindow, spot: QPoint, notches: int) -> float:
    mouse, image = window.mouse, window.image
    return window.image_frames.seconds_to_paint(lambda: mouse.wheel(image, spot, notches))


def _drag_along(window: BenchWindow) -> list[float]:
    """Drags with the middle button, each as long as the window is wide; a frame for each move."""
    times: list[float] = []
    image = window.image
    y = window.middle.y()
    moves = min(window.some(_MOVES), (image.width() - 40) // _STEP_PX)
    for _ in range(window.some(_DRAGS)):
        begin = QPoint(image.width() - 20, y)
        QTest.mousePress(image, MIDDLE, PLAIN, begin)
        for number in range(1, moves + 1):
            spot = begin - QPoint(number * _STEP_PX, 0)
            times.append(window.image_frames.seconds_to_paint(partial(drag_to, image, spot)))
        QTest.mouseRelease(image, MIDDLE, PLAIN, spot)
    return times


def drag_to(widget: QWidget, spot: QPoint, held: Qt.MouseButton = MIDDLE) -> None:
    """Move the mouse with a button held."""
    move(widget, spot, PLAIN, held)
