"""The diagnostic layer: the scanline of the section, and why places on it were taken or not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from processing.points.passes import passes_of
from processing.road.trials import Outcome, Trial
from processing.text import Text
from tests.widgets.builders import OpenMap, imported_drive
from tests.widgets.section_view.conftest import Hand, shown
from widgets.section_view.found_trials import SectionTrials, ShownTrial
from widgets.section_view.lay import SectionLay
from widgets.section_view.trial_marks import TrialMarks
from widgets.shared.cursor import Place

BLUE = np.array([0x56, 0xB4, 0xE9])


def blue(hand: Hand) -> NDArray[np.int64]:
    """Columns of the window's pixels, right of the legend, that are a scanline's."""
    image = hand.pane.grab().toImage().convertToFormat(QImage.Format.Format_RGBA8888)
    pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
    is_line = np.abs(pixels[120:, :, :3] - BLUE).max(axis=2) < 24
    return np.flatnonzero(is_line.any(axis=0))


def _point(spot: NDArray[np.float64]) -> QPointF:
    return QPointF(*spot.tolist())


def test_the_scanline_is_drawn_over_its_points_until_it_is_turned_off(
    qtbot: QtBot, tmp_path: Path
) -> None:
    hand = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    (drive,) = hand.map.drives()
    (way,) = passes_of(drive)
    middle = way.places_at(way.station_at([np.median(drive.columns["time"])]))[0]
    hand.do(lambda: hand.view.show_place(Place(tuple(middle.tolist()))))
    assert not blue(hand).size
    wanted = replace(hand.view.settings, shows_trials=True)
    hand.do(lambda: hand.view.use_settings(wanted))
    picture = hand.pane.picture
    assert picture is not None
    assert picture.trials is not None
    (found,) = picture.trials
    assert found.drive == drive.info.name
    line = np.concatenate(found.lines)
    assert line[:, 0].min() < -3.0 < 3.0 < line[:, 0].max()
    assert np.abs(line[:, 2]).max() < 0.2
    near = picture.section[np.abs(picture.section[:, 0]) < 2.0, 1]
    road = line[np.abs(line[:, 0]) < 2.0, 1]
    assert near.min() - 0.02 < road.min() <= road.max() < near.max() + 0.02
    assert blue(hand).size > 100
    hand.do(lambda: hand.view.use_settings(replace(wanted, shows_trials=False)))
    assert not blue(hand).size
    hand.view.close()


def test_the_mark_at_the_mouse_tells_its_tests(qtbot: QtBot, tmp_path: Path) -> None:
    hand = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, viewport = hand.pane.picture, hand.pane.viewport
    assert picture is not None
    cut = picture.wish.cut
    outcome = Outcome(Text("Height of the step", "段差の高さ"), 0.021, 0.03, "m", is_met=False)
    places = np.array([[2.0, cut.middle[2], 0.0], [-2.0, cut.middle[2], 0.0]])
    trials = tuple(
        ShownTrial("curbs", Trial(cut.to_space(place[None])[0], (outcome,), is_taken), place)
        for place, is_taken in zip(places, (True, False), strict=True)
    )
    told = replace(picture, trials=(SectionTrials("street", (), trials),))
    marks = TrialMarks("en")
    spots = viewport.to_screen(SectionLay(cut).on_plane(places))
    assert marks.hover(told, viewport, _point(spots[1]))
    assert marks.hovered is trials[1]
    assert not marks.hover(told, viewport, _point(spots[1] + 2.0))
    assert marks.hover(told, viewport, _point(spots[1] + 40.0))
    assert marks.hovered is None
    assert not marks.hover(None, viewport, _point(spots[1]))
    hand.view.close()
