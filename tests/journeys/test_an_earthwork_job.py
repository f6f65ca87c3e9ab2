"""From two deliveries of a site to cut and fill, in the window: by buttons, menus and the mouse."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import ezdxf
import laspy
import numpy as np
import pypdfium2
import pytest
import rasterio
from pyproj import CRS
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog, QLabel, QLineEdit

from app.jobs.jobs import JobState
from app.volumes.volume_exports import VOLUME_EXPORTS
from processing.formats.surfaces.landxml import read_landxml
from processing.formats.surfaces.landxml_writing import LandXmlFacts, WrittenSurface, write_landxml
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.maps.heat_map import change_classes
from processing.project.volumes.volume import SideKind
from resources import path_of
from tests.earthwork_site import CORNER, GRADE
from tests.journeys.conftest import WAIT_MS
from tests.journeys.earthwork_user import CUT_M3, DEPTH_M, FILL_M3, HEIGHT_M, Builder, two_epochs
from tests.mouse_events import move_mouse
from widgets.dialogs.work_details import WorkDetailsForm
from widgets.panels.volume.style_form import VolumeStyleForm
from widgets.shared.cursor import PickedPosition
from widgets.shared.shown_volume import ContourOf


@pytest.fixture
def deliveries(tmp_path: Path) -> tuple[Path, Path]:
    """Two epochs, two months apart."""
    return two_epochs(tmp_path)


@pytest.fixture
def builder(surveyor) -> Builder:
    return Builder(surveyor)


def test_from_two_deliveries_to_cut_fill_heat_map_and_files(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path, monkeypatch
) -> None:
    builder.open(tmp_path / "現場.zuka", deliveries)
    form = builder.panel.form
    assert [box.currentText() for box in (form.before, form.after)] == [
        "施工前 (2026-03-31)",
        "施工後 (2026-05-31)",
    ]
    assert not builder.button("Compute the volume").isEnabled()
    builder.find_ground()
    builder.compute()

    assert builder.number("cut") == pytest.approx(CUT_M3, rel=0.04)
    assert builder.number("fill") == pytest.approx(FILL_M3, rel=0.06)
    assert builder.number("area") == pytest.approx(600.0, rel=0.05)

    _look_at_the_map(builder)
    _look_at_the_section(builder)
    _change_range_and_contours(builder)
    _give_out(builder, tmp_path, monkeypatch)


def _look_at_the_map(builder: Builder) -> None:
    view, volume = builder.parts.map_view, builder.volume
    with builder.bot.waitSignal(view.sharpened, timeout=WAIT_MS):
        view.show_everything()
        view.zoom_by(0.9)
    volume.use_look(replace(volume.look, opacity=1.0))
    picture = view.grab().toImage()
    classes = change_classes(volume.look.limit_m)
    for position, change_m in (((8.0, 9.0), -DEPTH_M), ((23.0, 6.0), HEIGHT_M)):
        spot = builder.spot(*position)
        move_mouse(view, spot)
        reading = volume.reading
        assert reading is not None
        assert reading.change_m == pytest.approx(change_m, abs=0.03)
        height_m = CORNER[2] + GRADE * position[1]
        assert reading.before_m == pytest.approx(height_m, abs=0.06)
        assert "Δ" in builder.parts.status_line.change_text
        rgb = next(one.rgb for one in classes if one.low <= reading.change_m < one.high)
        assert picture.pixelColor(spot).getRgb()[:3] == rgb


def _look_at_the_section(builder: Builder) -> None:
    section = builder.parts.section_view
    easting, northing = np.add(CORNER[:2], (8.0, 9.0)).tolist()
    position = PickedPosition((easting, northing, float(CORNER[2] + GRADE * 9.0)))
    with builder.bot.waitSignal(section.sharpened, timeout=WAIT_MS):
        section.show_position(position)
    cut = section.cut
    assert cut is not None
    plain = section.panes[0].grab().toImage()
    builder.act("heat-map")
    assert builder.volume.drawn is None
    assert section.panes[0].grab().toImage() != plain
    builder.act("heat-map")
    assert builder.volume.drawn is not None


def _change_range_and_contours(builder: Builder) -> None:
    form = builder.panel.findChildren(VolumeStyleForm)[0]
    builder.pick(builder.box_with("Of the ground after"), "Of the ground after")
    assert builder.volume.look.contours is ContourOf.AFTER
    with builder.bot.waitSignal(
        builder.volume.contours_changed,
        timeout=WAIT_MS,
        check_params_cb=lambda: bool(builder.volume.contours),
    ):
        builder.volume.use_look(replace(builder.volume.look, interval_m=0.5))
    levels = {line.level_m for line in builder.volume.contours}
    assert levels
    assert all(abs(level / 0.5 - round(level / 0.5)) < 1e-9 for level in levels)
    assert form.isEnabled()


def _give_out(builder: Builder, folder: Path, monkeypatch) -> None:
    """Every file that is offered is written; those that other tests don't read are read."""
    made = {
        one.id: builder.give_out(one.id, folder / f"{one.id}{one.format.ending}", monkeypatch)
        for one in VOLUME_EXPORTS
        if builder.offers(one.id)
    }
    left_out = {one.id for one in VOLUME_EXPORTS} - set(made)
    assert all(id_.startswith(("form", "sections")) for id_ in left_out), "a design, or a line"
    assert all(path.stat().st_size > 0 for path in made.values())
    with rasterio.open(made["geotiff"]) as raster:
        assert CRS(raster.crs).to_epsg() == 6677
        row, column = raster.index(*np.add(CORNER[:2], (8.0, 9.0)))
        assert raster.read(1)[row, column] == pytest.approx(-DEPTH_M, abs=0.03)
    assert not ezdxf.readfile(made["plan"]).audit().errors
    surface = read_landxml(made["surface"]).only().surface
    near = np.hypot(*(surface.xyz[:, :2] - np.add(CORNER[:2], (8.0, 9.0))).T) < 0.3
    expected = CORNER[2] + GRADE * 9.0 - DEPTH_M
    assert np.median(surface.xyz[near, 2]) == pytest.approx(expected, abs=0.03)
    points = laspy.read(made["ground"])
    assert len(points.x) > 15_000
    assert set(np.unique(points.classification)) == {2}
    _read_the_report(builder, made["report"])
    table = made["report-csv"].read_text(encoding="utf-8-sig")
    assert "EPSG:6677" in table
    assert "2026-03-31" in table


def _read_the_report(builder: Builder, path: Path) -> None:
    """Its pages tell the numbers of the panel and show the earth that was moved."""
    report = pypdfium2.PdfDocument(path)
    pages = list(report)
    words = "".join(page.get_textpage().get_text_range() for page in pages)
    for amount in ("cut", "fill", "uncertainty"):
        assert builder.panel.table.value(amount).lstrip("± ") in words, amount
    colours = {
        tuple(colour)
        for page in pages
        for colour in np.unique(page.render(scale=2).to_numpy()[..., ::-1].reshape(-1, 3), axis=0)
    }
    classes = change_classes(builder.volume.look.limit_m)
    for change_m in (-DEPTH_M, HEIGHT_M):
        rgb = next(one.rgb for one in classes if one.low <= change_m < one.high)
        assert rgb in colours, change_m
    report.close()


def test_a_volume_is_there_again_when_the_project_is_opened_and_can_be_removed(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    folder = tmp_path / "p.zuka"
    builder.open(folder, deliveries)
    builder.find_ground()
    builder.compute()
    sides = builder.panel.form.sides
    cut = builder.panel.table.value("cut")
    document = builder.surveyor.document
    builder.parts.window.actions_by_id["language-ja"].trigger()
    builder.bot.waitUntil(lambda: builder.parts.language == "ja", timeout=WAIT_MS)
    assert builder.parts.volume_panel.table.value("cut") == cut
    assert builder.parts.volume_panel.form.sides == sides
    builder.parts.window.actions_by_id["language-en"].trigger()
    builder.bot.waitUntil(lambda: builder.parts.language == "en", timeout=WAIT_MS)
    builder.panel = builder.parts.volume_panel
    document.close()
    assert builder.volume.change is None
    assert builder.earthwork.volumes == ()
    with builder.bot.waitSignal(
        builder.volume.changed,
        timeout=WAIT_MS,
        check_params_cb=lambda: builder.volume.change is not None,
    ):
        assert document.open(folder)
    assert builder.panel.table.value("cut") == cut
    builder.click("✕")
    assert builder.earthwork.volumes == ()
    assert builder.volume.change is None
    assert not any((folder / "results" / "volumes").iterdir())


def test_only_what_a_selected_area_or_the_area_of_a_layer_holds_counts(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path, monkeypatch
) -> None:
    builder.open(tmp_path / "p.zuka", deliveries)
    builder.find_ground()
    builder.pick(builder.box_with("Selected areas"), "Selected areas")
    error = builder.refused("Compute the volume")
    assert error.what.en == "No area is selected that the volume could be computed within."
    builder.area((3.0, 3.0), (13.0, 15.0))
    builder.compute()
    assert builder.number("area") == pytest.approx(120.0, rel=0.01)
    assert builder.number("cut") == pytest.approx(CUT_M3, rel=0.06)
    assert builder.number("fill") < 1.0
    kept = builder.earthwork.shown
    assert kept is not None
    assert kept.request.boundary is not None
    assert kept.request.boundary.area == pytest.approx(120.0)
    _compute_within_a_layer(builder, tmp_path, monkeypatch)


def _compute_within_a_layer(builder: Builder, folder: Path, monkeypatch) -> None:
    """A drawing with areas on two layers: both are listed, and the second one is taken."""
    drawing = ezdxf.filemanagement.new("R2018")
    ring = CORNER[:2] + np.array([[1.0, 1.0], [15.0, 1.0], [15.0, 11.0], [1.0, 11.0]])
    for layer, east_m in (("工区1", 0.0), ("工区2", 14.0)):
        positions = [(east + east_m, north) for east, north in ring.tolist()]
        drawing.modelspace().add_lwpolyline(positions, close=True, dxfattribs={"layer": layer})
    path = folder / "工区.dxf"
    drawing.saveas(path)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    box = builder.box_with("Selected areas")
    with builder.bot.waitSignal(
        builder.surveyor.document.reported,
        timeout=WAIT_MS,
        check_params_cb=lambda text: "several layers" in text.en,
    ):
        builder.pick(box, "Area from a file…")
    assert box.currentText() == "工区.dxf: 工区1"
    builder.pick(box, "工区.dxf: 工区2")
    before = builder.earthwork.shown
    with builder.bot.waitSignal(
        builder.volume.changed,
        timeout=WAIT_MS,
        check_params_cb=lambda: builder.earthwork.shown is not before,
    ):
        builder.click("Compute the volume")
    assert builder.number("area") == pytest.approx(140.0, rel=0.01)
    assert builder.number("fill") == pytest.approx(FILL_M3, rel=0.06)
    assert builder.number("cut") < 1.0
    path.write_bytes(b"nothing")
    with builder.bot.waitSignal(builder.surveyor.document.refused, timeout=WAIT_MS) as reported:
        builder.pick(box, "Area from a file…")
    assert "工区.dxf" in reported.args[0].where.en
    assert box.currentText() == "工区.dxf: 工区2"


def test_an_epoch_against_a_level(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    builder.open(tmp_path / "p.zuka", deliveries)
    builder.find_ground()
    builder.pick(builder.panel.form.before, "Level")
    builder.level.setValue(float(CORNER[2]))
    builder.compute()
    kept = builder.earthwork.shown
    assert kept is not None
    assert kept.request.before.kind is SideKind.LEVEL
    # The slope above its own foot, less the pit, with the heap.
    whole = 0.5 * GRADE * 20.0 * 600.0 - CUT_M3 + FILL_M3
    assert kept.volumes.net_m3 == pytest.approx(whole, rel=0.03)


def test_end_areas_along_the_middle_of_the_site_have_sections_to_give_out(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path, monkeypatch
) -> None:
    folder = tmp_path / "p.zuka"
    builder.open(folder, deliveries)
    builder.find_ground()
    builder.panel.form.parameters.set_values({"method": "end-area", "interval_m": 1.0})
    builder.compute()
    assert builder.number("cut") == pytest.approx(CUT_M3, rel=0.1)
    document = builder.surveyor.document
    document.close()
    with builder.bot.waitSignal(
        builder.volume.changed,
        timeout=WAIT_MS,
        check_params_cb=lambda: builder.volume.change is not None,
    ):
        assert document.open(folder)
    path = builder.give_out("sections", tmp_path / "断面.dxf", monkeypatch)
    assert not ezdxf.readfile(path).audit().errors


def test_a_design_is_judged_by_the_form(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path, monkeypatch
) -> None:
    builder.open(tmp_path / "p.zuka", deliveries)
    builder.find_ground()
    corners = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [0.0, 20.0]])
    heights = GRADE * corners[:, 1]
    design = TriangleSurface(
        CORNER + np.column_stack([corners, heights]), np.array([[0, 1, 2], [0, 2, 3]]), "設計"
    )
    path = tmp_path / "設計.xml"
    write_landxml(path, (WrittenSurface(design),), LandXmlFacts("test", "EPSG:6677", ""))
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    box = builder.panel.form.after
    with builder.bot.waitSignal(box.chosen, timeout=WAIT_MS):
        builder.pick(box, "Design from LandXML…")
    assert box.currentText() == "設計.xml"
    builder.compute()
    # Nothing was moved before the work: the ground is the design's slope.
    assert builder.number("cut") + builder.number("fill") < 5.0
    _enter_what_the_office_knows(builder, tmp_path, monkeypatch)
    form = builder.give_out("form-csv", tmp_path / "様式.csv", monkeypatch)
    words = form.read_text(encoding="utf-8-sig")
    for said in ("設計.xml", "A県", "B建設", "事務所の基準", "JGD2024", "Excavation", "±47 mm"):
        assert said in words, said
    report = pypdfium2.PdfDocument(builder.give_out("report", tmp_path / "書.pdf", monkeypatch))
    said_there = "".join(page.get_textpage().get_text_range() for page in report)
    for said in ("A県", "B建設", "JGD2024"):
        assert said in said_there, said
    report.close()
    surface = builder.give_out("surface", tmp_path / "地盤.xml", monkeypatch)
    assert 'desc="JGD2024"' in surface.read_text(encoding="utf-8")


def _enter_what_the_office_knows(builder: Builder, folder: Path, monkeypatch) -> None:
    """Work details in their form, and a table of limits of the office's own, whose file goes."""
    builder.act("work-details")
    form = builder.parts.window.findChild(WorkDetailsForm)
    for id_, words in (("client", "A県"), ("contractor", "B建設"), ("height_datum", "JGD2024")):
        form.findChild(QLineEdit, id_).setText(words)
    form.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).click()
    text = path_of("catalogue/as_built_limits.toml").read_text(encoding="utf-8")
    table = folder / "事務所.toml"
    text = text.replace("As-built control by 3D", "事務所の基準").replace("Cutting", "Excavation")
    text = text.replace("mean_mm = 50", "mean_mm = 47").replace("mean_mm = 70", "mean_mm = 47")
    table.write_text(text, encoding="utf-8")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(table), ""))
    box = builder.panel.limits
    assert box.isVisible()
    builder.pick(box, "Other table…")
    builder.pick(box, "Excavation  [事務所.toml]")
    table.unlink()


def test_what_can_not_be_compared_is_said_and_nothing_runs(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    builder.open(tmp_path / "p.zuka", deliveries[:1])
    form = builder.panel.form

    def said() -> str:
        shown = [one.text() for one in form.findChildren(QLabel) if one.isVisible()]
        assert not builder.button("Compute the volume").isEnabled()
        return " ".join(shown)

    assert "one epoch only" in said()
    builder.pick(form.after, form.before.currentText())
    assert "Before and after are the same" in said()
    for box in (form.before, form.after):
        builder.pick(box, "Level")
    assert "has to be an epoch or a design" in said()
    assert not [one for one in builder.parts.jobs.statuses if one.state is JobState.FAILED]
    assert builder.earthwork.volumes == ()


def test_a_volume_that_is_cancelled_leaves_nothing(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    folder = tmp_path / "p.zuka"
    builder.open(folder, deliveries)
    builder.find_ground()
    with builder.bot.waitSignal(builder.parts.jobs.cancelled, timeout=WAIT_MS):
        builder.click("Compute the volume")
        for status in builder.parts.jobs.statuses:
            if status.state in (JobState.WAITING, JobState.RUNNING):
                builder.parts.jobs.cancel(status.id)
    assert builder.earthwork.volumes == ()
    assert not (folder / "results").exists()
