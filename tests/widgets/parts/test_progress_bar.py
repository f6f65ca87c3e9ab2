"""Progress never makes the window paint in the middle of something else."""

from __future__ import annotations

from PySide6.QtGui import QPaintEvent
from pytestqt.qtbot import QtBot
from typing_extensions import override

from widgets.parts.progress_bar import ProgressBar


class _Counting(ProgressBar):
    painted = 0

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        self.painted += 1
        super().paintEvent(event)


def test_many_values_are_painted_once_and_with_the_next_frame(qtbot: QtBot) -> None:
    bar = _Counting()
    qtbot.addWidget(bar)
    bar.setRange(0, 1000)
    bar.show()
    qtbot.waitExposed(bar)
    qtbot.waitUntil(lambda: bar.painted > 0, timeout=30_000)
    before = bar.painted
    for value in range(1000):
        bar.show_value(value)
    assert bar.value() == 999
    assert bar.painted == before
    qtbot.waitUntil(lambda: bar.painted > before, timeout=30_000)
