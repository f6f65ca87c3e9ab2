"""What a tool said of points is corrected by hand, in sections, and seen in every view at once."""

from __future__ import annotations

from functools import partial

import laspy
import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from processing.core.text import Text
from processing.image.attributes.colour_maps import class_colours
from processing.labels.label_column import labels_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.operations.export import ExportRequest
from processing.project.importing.importing import ImportRequest
from processing.recording.columns.counted_classes import class_columns
from processing.tools.ground import GroundParameters
from tests.earthwork_site import (
    CORNER,
    GRADE,
    GROUND,
    LOW_NOISE,
    OTHER,
    SIZE_M,
    EarthworkSite,
    earthwork_site,
    write_site,
)
from tests.journeys.conftest import WAIT_MS
from tests.mouse_events import NO_KEYS, move_mouse

LEFT = Qt.MouseButton.LeftButton
CONTROL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
LIFT = 72.0  # what is dark is lifted off the ground of a section


class Corrector:
    """The surveyor on a site whose classes a run has left, with the box taken for ground."""

    def __init__(self, surveyor, site: EarthworkSite, folder):
        self.surveyor, self.bot, self.site = surveyor, surveyor.bot, site
        self.parts, self.document = surveyor.parts, surveyor.document
        self.shared = self.document.shared
        self.file = write_site(site, folder / "現場.laz")
        assert self.document.create(folder / "現場.zuka", "EPSG:6677")
        surveyor.wait_for_job(lambda: self.document.import_files(ImportRequest((self.file,), ())))
        self.classify(np.where(site.truth == OTHER, GROUND, site.truth))
        window = self.parts.window
        with self.bot.waitActive(window):
            window.activateWindow()
        self.shared.view_settings.change_look(attribute="class")
        self.parts.view_docks.show_view("section")
        self.parts.view_docks.show_view("map")
        self.until(lambda: self.parts.map_view._pictures.newest is not None)
        self.until(lambda: self.parts.scene_view.cloud is not None)
        self.parts.view_docks.show_view("section")

    @property
    def pane(self):
        return self.parts.section_view.panes[0]

    def truth_of(self, drive) -> np.ndarray:
        return self.site.truth[drive.sources(0, drive.count)[1]]

    def classes(self) -> np.ndarray:
        """What counts, in the order of the file."""
        found = np.zeros(len(self.site.xyz), np.uint8)
        for drive in self.document.drives():
            every = np.arange(drive.count)
            codes = class_columns(drive.columns).codes_of(every)
            found[drive.sources(0, drive.count)[1]] = codes
        return found

    def classify(self, codes: np.ndarray) -> None:
        """Give every point a class, as a run does."""
        changes = []
        for drive in self.document.drives():
            every = np.arange(drive.count)
            after = codes[drive.sources(0, drive.count)[1]]
            for code in np.unique(after).tolist():
                points = every[after == code]
                changes += label_changes(drive.id, points, labels_of(drive, points), code)
        assert self.document.apply(Text.same("run"), Change(labels=tuple(changes)))

    def do(self, action: str) -> None:
        self.parts.window.actions_by_id[action].trigger()

    def key(self, key, modifiers=NO_KEYS) -> None:
        self.bot.keyClick(self.pane, key, modifiers)

    def cut_at(self, east_m: float) -> None:
        """Step by keys to so many metres east of the site's corner."""
        self.until(lambda: self.pane.picture is not None)
        section = self.parts.section_view
        while True:
            here = section.cut.middle[0] - self.site.xyz[:, 0].min()
            if abs(here - east_m) <= 0.51:
                break
            self.key(Qt.Key.Key_W if here < east_m else Qt.Key.Key_Q)
        self.until(lambda: self.pane.cut == section.cut)

    def spots(self, xyz: np.ndarray) -> np.ndarray:
        """Where places are in the section's window."""
        projection = self.pane.projection()
        return self.pane.viewport.to_screen(projection.on_plane(projection.cut.to_section(xyz)))

    def lasso(self, xyz: np.ndarray, by_px: float) -> None:
        """Draw round all of some places with the mouse."""
        spots = self.spots(xyz)
        (left, top), (right, bottom) = spots.min(axis=0) - by_px, spots.max(axis=0) + by_px
        corners = [(left, top), (left, bottom), (right, bottom), (right, top), (left, top)]
        way = [QPoint(round(x), round(y)) for x, y in corners]
        QTest.mousePress(self.pane, LEFT, NO_KEYS, way[0])
        for spot in way[1:]:
            move_mouse(self.pane, spot, LEFT)
        QTest.mouseRelease(self.pane, LEFT, NO_KEYS, way[-1])

    def until(self, is_so) -> None:
        self.bot.waitUntil(is_so, timeout=WAIT_MS)

    def drawn(self) -> dict[str, list[tuple[str, np.ndarray, np.ndarray]]]:
        """What each view draws: ids of drives, points, colours."""
        picture, plan = self.pane.picture, self.parts.map_view._pictures.newest
        numbers, shown = picture.drive_numbers, self.parts.image_view.picture.drive.id
        look = self.shared.view_settings.look
        asked = shown, look.attribute, look.hides_noise
        return {
            "section": [
                (drive.id, picture.points[numbers == n], picture.colours[numbers == n])
                for n, drive in enumerate(picture.request.drives)
            ],
            "3D": [
                (one.tile.id.drive_id, one.tile.points, one.tile.colours)
                for one in self.parts.scene_view.cloud.drawn
            ],
            "map": [
                (
                    drive.id,
                    np.where(plan.picture.drives == n, plan.picture.points, -1).ravel(),
                    plan.picture.pixels[:, :, 2::-1].reshape(-1, 3),
                )
                for n, (drive, _) in enumerate(plan.request.drives)
            ],
            "image": [
                (shown, pixels.points.ravel(), pixels.colours.reshape(-1, 3))
                for request, pixels in list(self.document.tiles._tiles.items())
                if (request.drive_id, request.attribute, request.hides_noise) == asked
            ],
        }

    def noise_seen(self) -> dict[str, int]:
        """How many points of noise each view draws."""
        columns = {drive.id: class_columns(drive.columns) for drive in self.document.drives()}
        return {
            view: sum(
                int(columns[drive].are_noise(points[points >= 0]).sum())
                for drive, points, _ in parts
            )
            for view, parts in self.drawn().items()
        }

    def colours_of(self, are_wanted: np.ndarray) -> dict[str, set[tuple[int, int, int]]]:
        """In which colours each view draws some of the file's points."""
        index_of = {d.id: d.sources(0, d.count)[1] for d in self.document.drives()}
        return {
            view: {
                tuple(colour)
                for drive, points, colours in parts
                for colour in np.unique(
                    colours[(points >= 0) & are_wanted[index_of[drive][points]]], axis=0
                ).tolist()
            }
            for view, parts in self.drawn().items()
        }


@pytest.fixture
def corrector(surveyor, tmp_path):
    return Corrector(surveyor, earthwork_site(), tmp_path)


def lifted(code: int) -> tuple[int, int, int]:
    return tuple((LIFT + class_colours()[code] * (1.0 - LIFT / 255.0)).astype(np.uint8).tolist())


def all_in(code: int) -> dict[str, set[tuple[int, int, int]]]:
    """One class in every view."""
    plain = {tuple(class_colours()[code].tolist())}
    return {"section": {lifted(code)}, "3D": plain, "map": plain, "image": plain}


def test_a_machine_left_as_ground_is_taken_off_it_by_a_lasso_in_the_section(
    corrector, surveyor, tmp_path
):
    user, document, site = corrector, corrector.document, corrector.site
    assert (user.classes()[site.truth == OTHER] == GROUND).all()
    before = user.classes()
    user.cut_at(SIZE_M[0] / 2)
    user.do("tool-paint-lasso")
    user.key("1")
    assert document.shared.labels.rule.code == OTHER
    box = site.truth == OTHER
    cut = user.pane.cut
    in_slab = np.abs(cut.to_section(site.xyz)[:, 2]) <= cut.width_m / 2
    assert cut.width_m == 1.0
    wanted = box & in_slab
    user.lasso(site.xyz[wanted], 2.0)
    user.until(lambda: (user.classes() != before).any())
    after = user.classes()
    assert (after[wanted] == OTHER).all()
    # A foot of ground may lie within two pixels of the box, but nothing outside the slab.
    assert not (after != before)[~in_slab].any()
    assert ((after != before) & ~wanted).sum() <= 20
    assert document.undo_stack.undo_label.en == "Label points: Other"
    user.until(lambda: user.colours_of(wanted) == all_in(OTHER))
    # Handed in: every point in its place, with what counts.
    surveyor.wait_for_job(
        lambda: document.export(ExportRequest(("las",), tmp_path / "out", never=(user.file,)))
    )
    (out,) = (tmp_path / "out").glob("*.la[sz]")
    np.testing.assert_array_equal(np.asarray(laspy.read(out).classification), after)
    user.key(Qt.Key.Key_Z, CONTROL)
    np.testing.assert_array_equal(user.classes(), before)
    user.until(lambda: user.colours_of(wanted) == all_in(GROUND))
    user.key(Qt.Key.Key_Y, CONTROL)
    np.testing.assert_array_equal(user.classes(), after)
    document.close()
    assert document.open(tmp_path / "現場.zuka")
    np.testing.assert_array_equal(user.classes(), after)
    assert document.undo()
    np.testing.assert_array_equal(user.classes(), before)


def test_what_the_tool_ground_found_is_seen_at_once_with_its_line(corrector, surveyor):
    user, document, site = corrector, corrector.document, corrector.site
    assert document.undo()
    assert not user.classes().any()
    user.shared.view_settings.change_look(attribute="toned")
    user.until(lambda: user.pane.picture is not None)
    assert user.pane.picture.ground == ()
    drive = document.drives()[0]
    surveyor.wait_for_job(lambda: document.start_run("ground", drive.id, GroundParameters()))
    assert (user.classes() == site.truth)[site.truth != LOW_NOISE].mean() > 0.98
    assert user.shared.view_settings.look.attribute == "class"
    found = user.classes()
    user.until(lambda: user.colours_of(found == OTHER) == all_in(OTHER))
    user.until(lambda: user.colours_of(found == GROUND) == all_in(GROUND))
    user.cut_at(2.0)
    user.until(lambda: bool(user.pane.picture.ground))
    (line, *_) = user.pane.picture.ground
    assert not line.is_filled
    north = user.pane.cut.to_space(np.insert(line.positions, 2, 0.0, axis=1))
    wanted = CORNER[2] + GRADE * (north[:, 1] - CORNER[1])
    np.testing.assert_allclose(line.positions[:, 1], wanted, atol=0.1)
    assert document.undo()
    assert not user.classes().any()


def test_noise_is_hidden_in_all_views_by_a_key_and_painted_back(corrector, tmp_path):
    user, document, site = corrector, corrector.document, corrector.site
    user.cut_at(SIZE_M[0] / 2)
    noise = site.truth == LOW_NOISE
    user.until(lambda: all(user.noise_seen().values()))
    shown_map = user.parts.map_view._pictures.newest
    user.key(Qt.Key.Key_N, SHIFT)
    look = document.shared.view_settings.look
    assert look.hides_noise
    assert user.parts.window.actions_by_id["hide-noise"].isChecked()
    user.until(lambda: user.parts.map_view._pictures.newest is not shown_map)
    user.until(lambda: not any(user.noise_seen().values()))
    assert all(any(points.size for _, points, _ in parts) for parts in user.drawn().values())
    # Nothing under the mouse where a point of noise was, and no lasso holds it.
    cut = user.pane.cut
    in_slab = np.abs(cut.to_section(site.xyz)[:, 2]) <= cut.width_m / 2
    wanted = noise & in_slab
    x, y = user.spots(site.xyz[wanted][:1])[0].tolist()
    spot = user.pane.viewport.to_plane(x, y)
    found = partial(user.pane.position_at, spot, 0.2, exact=True)
    assert found() is None
    user.do("tool-paint-lasso")
    user.key("2")
    before = user.classes()
    user.lasso(site.xyz[wanted], 3.0)
    np.testing.assert_array_equal(user.classes(), before)
    # Shown again it is painted back, and stays when noise is hidden.
    user.key(Qt.Key.Key_N, SHIFT)
    user.until(lambda: user.noise_seen()["section"] > 0)
    assert found() is not None
    user.lasso(site.xyz[wanted], 3.0)
    user.until(lambda: (user.classes()[wanted] == GROUND).all())
    assert (user.classes() != before).sum() == wanted.sum()
    user.key(Qt.Key.Key_N, SHIFT)
    user.until(lambda: not any(user.noise_seen().values()))
    user.until(lambda: user.colours_of(wanted)["section"] == {lifted(GROUND)})
    # Undone while it is hidden, it goes at once.
    user.key(Qt.Key.Key_Z, CONTROL)
    user.until(lambda: not user.colours_of(wanted)["section"])
    document.close()
    assert not document.shared.view_settings.look.hides_noise
    assert document.open(tmp_path / "現場.zuka")
    assert document.shared.view_settings.look.hides_noise
