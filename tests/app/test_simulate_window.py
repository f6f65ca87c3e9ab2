"""A simulation from the window: made in the background, opened as a project, or nothing at all."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QApplication, QLabel, QPushButton, QToolButton

from processing.laboratory.simulate.requests import StreetRequest
from widgets.dialogs.simulate import SimulateForm, SimulationRequest
from widgets.parts.density_view import DensityView

WAIT_MS = 60_000
SMALL = StreetRequest(
    style="highway", length_m=10.0, pulses=200, turns_per_s=30.0, speed_km_h=20.0, images=False
)


def form_of(parts) -> SimulateForm:
    """The form, shown as the menu shows it; its values are known."""
    parts.window.actions_by_id["simulate"].trigger()
    return next(
        one for one in parts.window.findChildren(SimulateForm) if isinstance(one, SimulateForm)
    )


def ask(parts, folder: Path, request: StreetRequest = SMALL) -> None:
    form = form_of(parts)
    form.simulation_requested.emit(SimulationRequest("street", request, folder))
    form.close()


def test_a_simulation_is_opened_as_a_project_and_says_where_its_truth_is(
    qtbot, parts, tmp_path
) -> None:
    folder = tmp_path / "通り"
    reported = []
    parts.document.reported.connect(lambda text: reported.append(text.en))
    ask(parts, folder)
    qtbot.waitUntil(lambda: any("truth" in one for one in reported), timeout=WAIT_MS)
    assert parts.document.project.folder == tmp_path / "通り.zuka"
    assert [one.info.name for one in parts.document.drives()] == ["left", "right"]
    assert parts.document.crs() == "EPSG:6677"
    assert str(folder / "truth") in reported[-1]
    assert parts.document.drives()[0].revolutions is not None


def test_an_open_project_is_only_put_away_when_one_says_so(qtbot, parts, tmp_path) -> None:
    parts.document.create(tmp_path / "mine.zuka", "")
    ask(parts, tmp_path / "a")
    qtbot.waitUntil(lambda: "is ready" in parts.message_bar.text, timeout=WAIT_MS)
    assert parts.document.project.folder.name == "mine.zuka"
    buttons = parts.message_bar.findChildren(QToolButton)
    next(one for one in buttons if one.isVisible() and one.text() == "Open").click()
    qtbot.waitUntil(lambda: len(parts.document.drives()) == 2, timeout=WAIT_MS)
    assert parts.document.project.folder.name == "a.zuka"


def test_a_cancelled_simulation_leaves_nothing_and_opens_nothing(qtbot, parts, tmp_path) -> None:
    folder = tmp_path / "sub" / "long"
    with qtbot.waitSignal(parts.jobs.cancelled, timeout=WAIT_MS):
        ask(parts, folder, StreetRequest(length_m=400.0, images=False))
        qtbot.waitUntil(
            lambda: any(one.fraction > 0 for one in parts.jobs.statuses), timeout=WAIT_MS
        )
        next(one for one in parts.status_line.findChildren(QToolButton) if one.isVisible()).click()
    assert not folder.exists()
    assert not list(tmp_path.rglob("*.laz"))
    assert parts.document.project is None


def test_what_goes_wrong_is_said_in_the_window(qtbot, parts, tmp_path) -> None:
    (tmp_path / "used").mkdir()
    (tmp_path / "used" / "file").touch()
    with qtbot.waitSignal(parts.jobs.failed, timeout=WAIT_MS):
        ask(parts, tmp_path / "used")
    assert "something in this folder" in parts.message_bar.text
    assert [one.name for one in (tmp_path / "used").iterdir()] == ["file"]


def test_the_form_tells_what_its_last_values_give(qtbot, parts) -> None:
    form = form_of(parts)
    for speed in (10.0, 20.0, 36.0):
        form.form("street").set_values({"speed_km_h": speed})
        form.form("street").changed.emit()

    def tells_the_last() -> bool:
        found = form.findChild(DensityView).density
        return found is not None and abs(found.survey.speed_m_s - 10.0) < 1e-9

    qtbot.waitUntil(tells_the_last, timeout=WAIT_MS)
    assert not parts.jobs.statuses
    form.close()
    QApplication.processEvents()


def test_the_form_tells_what_is_wrong_with_an_own_sensor(qtbot, parts, tmp_path) -> None:
    own = tmp_path / "センサー.toml"
    own.write_text("[[sensor]]\n", encoding="utf-8")
    form = form_of(parts)
    request = StreetRequest(own_sensor=str(own))
    form.forecast_wanted.emit(SimulationRequest("street", request, tmp_path / "a"))
    reported = form.findChildren(QLabel)
    qtbot.waitUntil(lambda: any(own.name in one.text() for one in reported), timeout=WAIT_MS)
    create = next(one for one in form.findChildren(QPushButton) if one.text() == "Create")
    assert not create.isEnabled()
    form.close()


def test_the_form_is_shown_once(parts) -> None:
    first = form_of(parts)
    parts.window.actions_by_id["simulate"].trigger()
    assert parts.window.findChildren(SimulateForm) == [first]
    first.close()
