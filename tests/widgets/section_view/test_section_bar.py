"""The bar above the section fits into narrow docks."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from tests.widgets.section_view.conftest import SectionViewUser
from widgets.section_view.bar import SectionBar


@pytest.mark.parametrize("width", [340, 460, 900])
def test_nothing_in_the_bar_is_cut_or_hidden(qtbot: QtBot, width: int) -> None:
    host = QWidget()
    qtbot.addWidget(host)
    column = QVBoxLayout(host)
    column.setContentsMargins(0, 0, 0, 0)
    bar = SectionBar(host)
    column.addWidget(bar)
    column.addStretch(1)
    host.resize(width, 200)
    host.show()
    qtbot.waitExposed(host)
    qtbot.waitUntil(lambda: bar.height() == bar.sizeHint().height(), timeout=30_000)
    for part in bar.findChildren(QWidget):
        if part.parentWidget() is not bar:
            continue
        assert bar.rect().contains(part.geometry())
        assert part.width() >= part.sizeHint().width()
    is_one_line = bar._numbers.mapTo(bar, QPoint()).y() < bar.height() / 2
    assert is_one_line == (width == 900)


def test_held_windows_stand_above_each_other_in_a_narrow_dock(user: SectionViewUser) -> None:
    user.view.resize(420, 500)
    user.view.set_pinned(True)
    across, along = user.view.panes
    user.qtbot.waitUntil(lambda: along.geometry().top() > across.geometry().top(), timeout=30_000)
    user.view.resize(900, 500)
    user.qtbot.waitUntil(lambda: along.geometry().left() > across.geometry().left(), timeout=30_000)
