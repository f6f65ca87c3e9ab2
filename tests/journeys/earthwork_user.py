"""A construction site delivered twice, and the hand of who works on it in the window."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QAbstractButton, QComboBox, QFileDialog

from app.volumes.earthwork import Earthwork
from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Vertex, new_feature_id
from processing.project.importing.importing import ImportRequest
from tests.earthwork_site import CORNER, EarthworkSite, earthwork_site, write_site
from tests.journeys.conftest import WAIT_MS
from widgets.parts.number_field import NumberField
from widgets.shared.cursor import PickedPosition

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


def two_epochs(folder: Path) -> tuple[Path, Path]:
    """Deliveries of the site before and after the work, two months apart."""
    before = write_site(earthwork_site(1), folder / "施工前.laz", start_s=APRIL_S)
    later = APRIL_S + 61 * DAY_S
    after = write_site(_worked(earthwork_site(2)), folder / "施工後.laz", start_s=later)
    return before, after


class Builder:
    """What a surveyor does on a construction site's data."""

    def __init__(self, surveyor):
        self.surveyor = surveyor
        self.parts, self.bot = surveyor.parts, surveyor.bot
        self.panel, self.earthwork = self.parts.volume_panel, self.parts.of(Earthwork)
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
            self.surveyor.document.reported,
            timeout=WAIT_MS,
            check_params_cb=lambda text: path.name in text.en,
        ):
            action.trigger()
        return path

    def refused(self, words: str) -> UserError:
        """What is said when a button is pressed."""
        with self.bot.waitSignal(self.surveyor.document.refused, timeout=WAIT_MS) as reported:
            self.click(words)
        error = reported.args[0]
        assert isinstance(error, UserError)
        return error

    def area(self, low: tuple[float, float], high: tuple[float, float]) -> Feature:
        """An area of the map, selected; of the first kind that areas have."""
        document = self.surveyor.document
        kind = next(one for one in document.catalogue() if one.geometry is Geometry.AREA)
        ring = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        positions = [(*(CORNER[:2] + corner).tolist(), float(CORNER[2])) for corner in ring]
        feature = Feature(
            new_feature_id(),
            kind.id,
            Geometry.AREA,
            tuple(Vertex(position) for position in positions),
        )
        assert document.apply(Text.same("area"), Change(added=(feature,)))
        document.shared.selection.choose_features(frozenset({feature.id}))
        return feature

    def spot(self, east: float, north: float) -> QPoint:
        x, y = np.add(CORNER[:2], (east, north)).tolist()
        position = self.parts.map_view.position_of(PickedPosition((x, y, float(CORNER[2]))))
        assert position is not None
        return position.toPoint()

    @property
    def level(self) -> NumberField:
        """The field of the height that is compared with."""
        fields = self.panel.form.findChildren(NumberField)
        return next(one for one in fields if one.isVisible() and one.minimum() < -1000.0)

    def number(self, id_: str) -> float:
        return float(self.panel.table.value(id_).replace(",", "").lstrip("±+ "))
