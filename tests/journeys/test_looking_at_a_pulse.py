"""Somebody imports a flight with waveforms, clicks points, and reads the pulse behind them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt

from processing.project.importing.dropped_files import request_of_files
from processing.recording.waveforms import waveforms_of
from tests.journeys.conftest import Surveyor
from tests.waveform_flight import change_points, write_flight


def _open_flight(surveyor: Surveyor, tmp_path: Path, *, spoilt: bool = False) -> None:
    flight = write_flight(tmp_path / "航空.las", 600)
    if spoilt:
        change_points(flight.path, lambda fields: fields["byte"].__setitem__(slice(None), 1 << 40))
    assert surveyor.document.create(tmp_path / "Flight.zuka", "")
    request = request_of_files((flight.path,), "")
    surveyor.wait_for_job(lambda: surveyor.document.import_files(request))


def _open_panel(surveyor: Surveyor) -> None:
    window = surveyor.parts.window
    with surveyor.bot.waitActive(window):  # keys reach the menus of the active window only
        window.activateWindow()
    surveyor.parts.image_view.setFocus()
    surveyor.key(Qt.Key.Key_F6, Qt.KeyboardModifier.ShiftModifier)
    surveyor.bot.waitUntil(surveyor.parts.pulse_panel.isVisible)


def _pulse_with_two_returns(surveyor: Surveyor) -> np.ndarray:
    waveforms = waveforms_of(surveyor.drive)
    pulses = waveforms.pulses(slice(0, waveforms.count))
    return waveforms.points_of(int(np.flatnonzero(pulses.returns == 2)[40]))


def test_a_click_shows_the_pulse_and_all_returns_on_it(surveyor: Surveyor, tmp_path: Path) -> None:
    _open_flight(surveyor, tmp_path)
    panel = surveyor.parts.pulse_panel
    _open_panel(surveyor)
    assert len(panel.lines()) == 1
    top, ground = _pulse_with_two_returns(surveyor).tolist()
    surveyor.click(top)
    surveyor.bot.waitUntil(lambda: panel.plot.pulse is not None)
    shown = panel.plot.pulse
    assert shown.points.tolist() == [top, ground]
    assert shown.points[shown.chosen] == surveyor.document.shared.cursor.position.measured.point
    np.testing.assert_allclose(shown.heights, [3.0, 0.0], atol=0.01)
    assert len(panel.lines()) == 3
    assert "3.000 m" in panel.lines()[1]


def test_a_point_without_its_packet_is_explained(surveyor: Surveyor, tmp_path: Path) -> None:
    _open_flight(surveyor, tmp_path, spoilt=True)
    panel = surveyor.parts.pulse_panel
    _open_panel(surveyor)
    surveyor.document.shared.cursor.move_to(surveyor.position_of(0))
    assert panel.plot.pulse is None
    words = {"en": "beyond the end", "ja": "終端"}[surveyor.parts.language]
    assert words in panel.lines()[0]


def test_a_street_without_waveforms_says_so(surveyor: Surveyor, tmp_path: Path) -> None:
    surveyor.open_sample_street(tmp_path / "Street.zuka")
    panel = surveyor.parts.pulse_panel
    _open_panel(surveyor)
    surveyor.document.shared.cursor.move_to(surveyor.position_of(100))
    assert panel.plot.pulse is None
    assert {"en": "no waveforms", "ja": "波形はありません"}[surveyor.parts.language] in (
        panel.lines()[0]
    )
