"""What the density view tells of a place is what the map holds there."""

from __future__ import annotations

import re

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from pytestqt.qtbot import QtBot

from processing.laboratory.simulate.scanning.density import DensityMap, density_map, survey_of
from processing.laboratory.simulate.scanning.sensors import SENSORS
from widgets.parts.density_view import DensityView


@pytest.fixture
def density() -> DensityMap:
    return density_map(survey_of(SENSORS["zf9012"], 40.0))


@pytest.fixture
def view(qtbot: QtBot, density: DensityMap) -> DensityView:
    view = DensityView("en")
    qtbot.addWidget(view)
    view.resize(640, 420)
    view.show_density(density)
    view.show()
    qtbot.waitExposed(view)
    return view


def places_of(view: DensityView, words: str) -> list[tuple[QPointF, str]]:
    """All pixels of which something with these words is told."""
    every = [QPointF(x, y) for x in range(0, view.width(), 7) for y in range(0, view.height(), 7)]
    return [(one, reported) for one in every if words in (reported := view.told_at(one))]


def test_left_is_left_and_the_figures_are_those_of_the_map(view, density) -> None:
    left, right = places_of(view, "m to the left"), places_of(view, "m to the right")
    assert max(one.x() for one, _ in left) < min(one.x() for one, _ in right)
    roads = [reported for _, reported in left if reported.startswith("Road")]
    assert roads
    for reported in roads:
        side, value = (
            float(one.replace(",", "")) for one in re.findall(r"([\d.,]+) (?:m to|p)", reported)
        )
        near = np.abs(density.across_m - side) <= 0.21
        low, high = density.road[near].min(), density.road[near].max()
        assert low - 1 <= value <= high + 1


def test_walls_are_higher_up_in_the_picture_the_higher_they_are(view) -> None:
    walls = [
        (one.y(), float(re.findall(r"([\d.]+) m up", reported)[0]))
        for one, reported in places_of(view, "Wall")
    ]
    heights = [height for _, height in sorted(walls)]
    assert heights == sorted(heights, reverse=True)
    assert min(heights) < 1
    assert max(heights) > 9


def test_where_the_vehicle_drives_and_outside_nothing_is_counted(view) -> None:
    assert places_of(view, "Here the vehicle drives.")
    assert view.told_at(QPointF(1, 1)) == ""


def test_the_picture_has_the_colours_of_the_map(view) -> None:
    seen = view.grab().toImage()
    shades = {
        seen.pixelColor(one.toPoint()).lightness() for one, reported in places_of(view, "Road")
    }
    assert len(shades) > 4
