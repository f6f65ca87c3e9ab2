"""The window compares an existing map with what is drawn; its changes go through the review."""

from __future__ import annotations

from pathlib import Path

from pytestqt.qtbot import QtBot

from app.importing.existing_maps import ExistingMaps
from app.review.review import Review
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.map.catalogue import CHANGE_KIND
from processing.map.change import Change
from processing.map.feature import Status
from processing.map.renewal.existing_map import TAKE, ExistingMap
from processing.operations.export import ExportRequest, export
from tests.app.cli.test_map_comparison import BEFORE, EXPECTED, NOW
from widgets.dialogs.existing_map import ExistingMapForm

_CRS = "EPSG:6677"


def _opened(parts: WindowParts, tmp_path: Path) -> Path:
    """A project with the map of today, and the file of the last one."""
    document = parts.document
    assert document.create(tmp_path / "street.zuka", _CRS)
    assert document.apply(Text.same("map"), Change(added=NOW))
    request = ExportRequest(("gpkg",), tmp_path / "old")
    return export(BEFORE, document.catalogue(), _CRS, request)[0]


def test_changes_are_judged_by_the_review_and_taken_back_in_one_step(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    old = _opened(parts, tmp_path)
    maps = ExistingMaps(parts, ProjectDialogs(parts))
    with qtbot.waitSignal(parts.document.reported, timeout=60_000) as told:
        maps.start(ExistingMap(file=str(old)))
    assert "2 new, 2 moved, 3 gone" in told.args[0].en
    review = parts.of(Review)
    assert review.progress.left == len(EXPECTED)
    assert review.accept()
    assert review.reject()
    changes = [one for one in parts.document.features() if one.kind == CHANGE_KIND]
    assert sorted(one.status.value for one in changes)[0] == Status.ACCEPTED.value
    for _ in range(3):
        parts.document.undo()
    assert [one.id for one in parts.document.features()] == [one.id for one in NOW]


def test_a_map_is_taken_in_beside_the_window(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    old = _opened(parts, tmp_path)
    maps = ExistingMaps(parts, ProjectDialogs(parts))
    with qtbot.waitSignal(parts.document.reported, timeout=60_000):
        maps.start(ExistingMap(file=str(old), use=TAKE))
    assert len(list(parts.document.features())) == len(NOW) + len(BEFORE)
    parts.document.undo()
    assert len(list(parts.document.features())) == len(NOW)


def test_a_map_that_cannot_be_read_changes_nothing(
    parts: WindowParts, tmp_path: Path, qtbot: QtBot
) -> None:
    _opened(parts, tmp_path)
    bad = tmp_path / "map.gpkg"
    bad.write_bytes(b"no package")
    with qtbot.waitSignal(parts.document.refused, timeout=60_000) as refused:
        ExistingMaps(parts, ProjectDialogs(parts)).start(ExistingMap(file=str(bad)))
    assert "GeoPackage" in refused.args[0].what.en
    assert len(list(parts.document.features())) == len(NOW)


def test_the_form_gives_what_was_chosen(qtbot: QtBot) -> None:
    form = ExistingMapForm("ja")
    qtbot.addWidget(form)
    assert not form.ok_button.isEnabled()
    form.form.set_values({"file": "/maps/old.dxf", "tolerance_m": 0.5})
    with qtbot.waitSignal(form.map_given) as given:
        form.ok_button.setEnabled(True)
        form.ok_button.click()
    assert given.args[0].file == "/maps/old.dxf"
    assert given.args[0].tolerance_m == 0.5
