"""Differences of height in words, with their signs; in the status line too."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.change_reading import ChangeReading
from processing.methods.ground.filters.cells import CellGrid
from tests.widgets.builders import OpenMap
from widgets.parts.change_words import change_words, format_difference
from widgets.parts.status_line import StatusLine
from widgets.shared.cursor import PickedPosition


@pytest.mark.parametrize(
    ("value", "digits", "words"),
    [
        (0.2341, 3, "+0.234"),
        (-1.05, 3, "−1.050"),
        (0.0004, 3, "0.000"),
        (-0.0004, 3, "0.000"),
        (1234.56, 1, "+1,234.6"),
        (-51.4, 0, "−51"),
    ],
)
def test_a_difference_has_its_sign_and_nothing_has_none(
    value: float, digits: int, words: str
) -> None:
    assert format_difference(value, digits) == words


def test_a_reading_tells_both_heights_and_what_was_filled_in() -> None:
    reading = ChangeReading(125.682, 126.0, is_measured=True)
    assert change_words(reading).en == "+0.318 m (before 125.682, after 126.000)"
    filled = change_words(ChangeReading(125.682, 125.0, is_measured=False))
    assert filled.en == "−0.682 m (before 125.682, after 125.000; filled in)"
    assert filled.ja == "−0.682 m（前 125.682、後 125.000、補間）"


def test_the_status_line_reads_the_map_where_the_mouse_is(qtbot: QtBot) -> None:
    street = OpenMap()
    line = StatusLine(street, street.shared, "en")
    qtbot.addWidget(line)
    volume = street.shared.volume
    ground = np.zeros((2, 2), np.float32)
    volume.show(
        ChangeGrid(
            CellGrid(np.array([100.0, 200.0, 50.0]), 1.0, 2, 2),
            ground,
            ground + np.float32(0.5),
            np.ones((2, 2), np.bool_),
            np.ones((2, 2), np.float32),
        )
    )
    volume.hover_over_point(PickedPosition((101.5, 200.5, 50.0)))
    assert line.change_text == "Δ +0.500 m (before 50.000, after 50.500)"
    volume.hover_over_point(PickedPosition((110.0, 200.5, 50.0)))
    assert line.change_text == ""
    volume.hover_over((100.5, 201.5))
    volume.hover_over_point(None)
    assert line.change_text, "a view that shows the map reads it by itself"
    volume.hover_over(None)
    assert line.change_text == ""
