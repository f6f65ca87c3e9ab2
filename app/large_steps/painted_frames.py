"""PaintedFrames: from an event to the painted view, by what Qt itself tells."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import (
    QCoreApplication,
    QEvent,
    QEventLoop,
    QObject,
    Qt,
    QTimer,
    Signal,
    SignalInstance,
)
from PySide6.QtWidgets import QWidget
from typing_extensions import override

LONGEST_MS = 300_000
_PULSE_MS = 5

PaintedStep = Callable[[], object]
_SEEN = QEvent.Type(QEvent.registerEventType())


class PaintedFrames(QObject):
    """Tells how long a view takes to be painted after something was done.

    Parameters
    ----------
    view : QWidget
    drawn : signal, optional
        Told when a new picture was painted, by views that are painted again with the old one while
        it is being drawn; others are watched for their paint events.
    """

    def __init__(self, view: QWidget, drawn: SignalInstance | None = None) -> None:
        super().__init__(view)
        self._is_wanted: Callable[[], bool] | None = None
        self._painted_at = 0.0
        self._loop = QEventLoop()
        if drawn is None:
            view.installEventFilter(self)
        else:
            drawn.connect(self._look_when_shown)

    def seconds_to_paint(
        self,
        act: PaintedStep,
        when: Callable[[], bool] = lambda: True,
        *,
        follows: Callable[[], bool] = lambda: True,
    ) -> float:
        """Do something, and give the time until the next frame for which a condition holds.

        Parameters
        ----------
        act, when : callable
            What is done, and the condition, asked after each frame.
        follows : callable
            Asked when it was done: whether a frame follows. Where nothing looks other than
            before, the time is that of doing it.

        Raises
        ------
        TimeoutError
            No such frame came.
        """
        # A view may have been painted twice; the second time tells nothing of what comes now.
        QCoreApplication.removePostedEvents(self, _SEEN.value)
        self._painted_at = 0.0
        self._is_wanted = when
        began = time.perf_counter()
        act()
        if not follows():
            self._is_wanted = None
            return time.perf_counter() - began
        if not self._painted_at:
            _live(self._loop)
        self._is_wanted = None
        if not self._painted_at:
            raise TimeoutError
        return self._painted_at - began

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Paint:
            self._look_when_shown()
        return False

    @override
    def event(self, event: QEvent) -> bool:
        if event.type() == _SEEN:
            self._look()
            return True
        return super().event(event)

    def _look_when_shown(self) -> None:
        if self._is_wanted is not None:
            # Comes back as soon as the window has painted and shown all its parts.
            urgent = Qt.EventPriority.HighEventPriority
            QCoreApplication.postEvent(self, QEvent(_SEEN), urgent.value)

    def _look(self) -> None:
        if self._is_wanted is not None and not self._painted_at and self._is_wanted():
            self._painted_at = time.perf_counter()
            self._loop.quit()


class Pulse(QObject):
    """How long the window's thread answered nothing, at most.

    Signals
    -------
    felt()
        Many times a second, while the window answers.
    """

    felt = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._before = time.perf_counter()
        self._longest_s = 0.0
        timer = QTimer(self, timerType=Qt.TimerType.PreciseTimer, interval=_PULSE_MS)
        timer.timeout.connect(self._on_timeout)
        timer.start()

    def take(self) -> float:
        """The longest pause since this was asked last, s."""
        self._on_timeout()
        longest, self._longest_s = self._longest_s, 0.0
        return longest

    def _on_timeout(self) -> None:
        now = time.perf_counter()
        self._longest_s = max(self._longest_s, now - self._before)
        self._before = now
        self.felt.emit()


def wait_until(is_so: Callable[[], bool], told_by: SignalInstance) -> None:
    """Let the window live until something is so; the signal says when to look again.

    Raises
    ------
    TimeoutError
        It never came to be.
    """
    loop = QEventLoop()

    def look() -> None:
        if is_so():
            loop.quit()

    told_by.connect(look)
    if not is_so():
        _live(loop)
    told_by.disconnect(look)
    if not is_so():
        raise TimeoutError


def _live(loop: QEventLoop) -> None:
    timer = QTimer(singleShot=True, interval=LONGEST_MS)
    timer.timeout.connect(loop.quit)
    timer.start()
    loop.exec()
    timer.stop()
