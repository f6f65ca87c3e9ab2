"""From two deliveries of a site to cut and fill, in the window: by buttons, menus and the mouse."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import rasterio
from pyproj import CRS
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QAbstractButton, QComboBox, QFileDialog, QLabel

from app.jobs import JobState
from app.volume_exports import VOLUME_EXPORTS
from processing.earthwork.heat_map import change_classes
from processing.earthwork.triangle_surface import TriangleSurface
from processing.errors import UserError
from processing.formats.landxml import read_landxml
from processing.formats.landxml_writing import LandXmlFacts, WrittenSurface, write_landxml
from processing.project.catalogue import Geometry
from processing.project.change import Change
from processing.project.feature import Feature, Vertex, new_feature_id
from processing.project.importing import ImportRequest
from processing.project.volume import SideKind
from processing.text import Text
from tests.earthwork_site import CORNER, GRADE, EarthworkSite, earthwork_site, write_site
from tests.journeys.conftest import WAIT_MS
from tests.mouse_events import move_mouse
from widgets.panels.volume.look_form import LookForm
from widgets.parts.number_field import NumberField
from widgets.shared.cursor import Place
from widgets.shared.shown_volume import ContourOf

LEFT = Qt.MouseButton.LeftButton
PIT_LOW, PIT_HIGH, DEPTH_M = (4.0, 4.0), (12.0, 14.0), 0.5
HEAP_LOW, HEAP_HIGH, HEIGHT_M = (18.0, 4.0), (28.0, 8.0), 0.4
CUT_M3, FILL_M3 = 8.0 * 10.0 * DEPTH_M, 10.0 * 4.0 * HEIGHT_M
APRIL_S, DAY_S = 1_459_000_000.0, 86_400.0


def _worked(site: EarthworkSite) -> EarthworkSite:
    """The same site after earth was moved, measured anew."""
    xyz = site.xyz.copy()
    plan = xyz[:, :2] - CORNER[:2]
    is_ground = site.truth == 2
    for low, high, change_m in (
        (PIT_LOW, PIT_HIGH, -DEPTH_M),
        (HEAP_LOW, HEAP_HIGH, HEIGHT_M),
    ):
        inside = is_ground & ((plan > low) & (plan < high)).all(axis=1)
        xyz[inside, 2] += change_m
    return replace(site, xyz=np.round(xyz, 3))


@pytest.fixture
def deliveries(tmp_path: Path) -> tuple[Path, Path]:
    """Two epochs, two months apart."""
    before = write_site(earthwork_site(1), tmp_path / "施工前.laz", start_s=APRIL_S)
    later = APRIL_S + 61 * DAY_S
    after = write_site(_worked(earthwork_site(2)), tmp_path / "施工後.laz", start_s=later)
    return before, after


class Builder:
    """What a surveyor does on a construction site's data."""

    def __init__(self, surveyor):
        self.surveyor = surveyor
        self.parts, self.bot = surveyor.parts, surveyor.bot
        self.panel, self.earthwork = self.parts.volume_panel, self.parts.earthwork
        self.volume = self.parts.document.shared.volume

    def open(self, folder: Path, clouds: tuple[Path, ...]) -> None:
        document = self.surveyor.document
        assert document.create(folder, "EPSG:6677")
        with self.bot.waitSignal(
            self.earthwork.epochs_changed,
            timeout=WAIT_MS,
            check_params_cb=lambda: len(self.earthwork.epochs) == len(clouds),
        ):
            self.surveyor.wait_for_job(lambda: document.import_files(ImportRequest(clouds)))
        self.act("layout-earthwork")
        self.act("volume")
        self.bot.waitUntil(self.panel.isVisible, timeout=WAIT_MS)

    def act(self, id_: str) -> None:
        self.parts.window.actions_by_id[id_].trigger()

    def button(self, words: str) -> QAbstractButton:
        return next(one for one in self.panel.findChildren(QAbstractButton) if one.text() == words)

    def click(self, words: str) -> None:
        button = self.button(words)
        assert button.isEnabled(), words
        self.bot.mouseClick(button, LEFT)

    def pick(self, box: QComboBox, words: str) -> None:
        number = box.findText(words)
        assert number >= 0, [box.itemText(at) for at in range(box.count())]
        box.setCurrentIndex(number)
        box.activated.emit(number)

    def box_with(self, words: str) -> QComboBox:
        return next(one for one in self.panel.findChildren(QComboBox) if one.findText(words) >= 0)

    def find_ground(self) -> None:
        with self.bot.waitSignal(
            self.earthwork.epochs_changed,
            timeout=WAIT_MS,
            check_params_cb=lambda: (
                not any(self.earthwork.lacks_ground(epoch.side) for epoch in self.earthwork.epochs)
            ),
        ):
            self.click("Find the ground of both")

    def compute(self) -> None:
        with self.bot.waitSignal(
            self.volume.changed,
            timeout=WAIT_MS,
            check_params_cb=lambda: self.volume.change is not None,
        ):
            self.click("Compute the volume")

    def offers(self, id_: str) -> bool:
        """Whether the menu of exports has this one."""
        return any(
            one.isVisible() for one in self.panel.export_menu.actions() if one.objectName() == id_
        )

    def give_out(self, id_: str, path: Path, monkeypatch) -> Path:
        """Choose an export and wait until it is said that it was written."""
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
        action = next(one for one in self.panel.export_menu.actions() if one.objectName() == id_)
        assert action.isVisible()
        with self.bot.waitSignal(
            self.surveyor.document.told,
            timeout=WAIT_MS,
            check_params_cb=lambda text: path.name in text.en,
        ):
            action.trigger()
        return path

    def refused(self, words: str) -> UserError:
        """What is said when a button is pressed."""
        with self.bot.waitSignal(self.surveyor.document.refused, timeout=WAIT_MS) as told:
            self.click(words)
        error = told.args[0]
        assert isinstance(error, UserError)
        return error

    def area(self, low: tuple[float, float], high: tuple[float, float]) -> Feature:
        """An area of the map, selected; of the first kind that areas have."""
        document = self.surveyor.document
        kind = next(one for one in document.catalogue() if one.geometry is Geometry.AREA)
        ring = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        places = [(*(CORNER[:2] + corner).tolist(), float(CORNER[2])) for corner in ring]
        feature = Feature(
            new_feature_id(), kind.id, Geometry.AREA, tuple(Vertex(place) for place in places)
        )
        assert document.apply(Text.same("area"), Change(added=(feature,)))
        document.shared.selection.choose_features(frozenset({feature.id}))
        return feature

    def spot(self, east: float, north: float) -> QPoint:
        x, y = np.add(CORNER[:2], (east, north)).tolist()
        position = self.parts.map_view.position_of(Place((x, y, float(CORNER[2]))))
        assert position is not None
        return position.toPoint()

    @property
    def level(self) -> NumberField:
        """The field of the height that is compared with."""
        fields = self.panel.form.findChildren(NumberField)
        return next(one for one in fields if one.isVisible() and one.minimum() < -1000.0)

    def number(self, id_: str) -> float:
        return float(self.panel.table.value(id_).replace(",", "").lstrip("±+ "))


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
    for place, change_m in (((8.0, 9.0), -DEPTH_M), ((23.0, 6.0), HEIGHT_M)):
        spot = builder.spot(*place)
        move_mouse(view, spot)
        reading = volume.reading
        assert reading is not None
        assert reading.change_m == pytest.approx(change_m, abs=0.03)
        height_m = CORNER[2] + GRADE * place[1]
        assert reading.before_m == pytest.approx(height_m, abs=0.06)
        assert "Δ" in builder.parts.status_line.change_text
        rgb = next(one.rgb for one in classes if one.low <= reading.change_m < one.high)
        assert picture.pixelColor(spot).getRgb()[:3] == rgb


def _look_at_the_section(builder: Builder) -> None:
    section = builder.parts.section_view
    easting, northing = np.add(CORNER[:2], (8.0, 9.0)).tolist()
    place = Place((easting, northing, float(CORNER[2] + GRADE * 9.0)))
    with builder.bot.waitSignal(section.sharpened, timeout=WAIT_MS):
        section.show_place(place)
    cut = section.cut
    assert cut is not None
    plain = section.panes[0].grab().toImage()
    builder.volume.use_look(replace(builder.volume.look, is_shown=False))
    assert section.panes[0].grab().toImage() != plain
    builder.volume.use_look(replace(builder.volume.look, is_shown=True))


def _change_range_and_contours(builder: Builder) -> None:
    form = builder.panel.findChildren(LookForm)[0]
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
        one.id: builder.give_out(one.id, folder / f"{one.id}{one.ending}", monkeypatch)
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
    assert made["report"].read_bytes().startswith(b"%PDF")
    table = made["report-csv"].read_text(encoding="utf-8-sig")
    assert "EPSG:6677" in table
    assert "2026-03-31" in table


def test_a_volume_is_there_again_when_the_project_is_opened_and_can_be_removed(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    folder = tmp_path / "p.zuka"
    builder.open(folder, deliveries)
    builder.find_ground()
    builder.compute()
    cut = builder.panel.table.value("cut")
    document = builder.surveyor.document
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


def test_only_what_a_selected_area_holds_counts(
    builder: Builder, deliveries: tuple[Path, Path], tmp_path: Path
) -> None:
    builder.open(tmp_path / "p.zuka", deliveries)
    builder.find_ground()
    builder.pick(builder.box_with("Selected areas"), "Selected areas")
    error = builder.refused("Compute the volume")
    assert error.what.en == "No area is selected that the volume could be told within."
    builder.area((3.0, 3.0), (13.0, 15.0))
    builder.compute()
    assert builder.number("area") == pytest.approx(120.0, rel=0.01)
    assert builder.number("cut") == pytest.approx(CUT_M3, rel=0.06)
    assert builder.number("fill") < 1.0
    kept = builder.earthwork.shown
    assert kept is not None
    assert kept.wish.boundary is not None
    assert kept.wish.boundary.area == pytest.approx(120.0)


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
    assert kept.wish.before.kind is SideKind.LEVEL
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
    form = builder.give_out("form-csv", tmp_path / "様式.csv", monkeypatch)
    assert "設計.xml" in form.read_text(encoding="utf-8-sig")


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
