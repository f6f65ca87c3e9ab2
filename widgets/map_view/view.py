"""MapView: the street from above, with the drawn map on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Signal
from PySide6.QtGui import (
    QAction,
    QActionGroup,
    QCloseEvent,
    QPainter,
    QPolygonF,
    QResizeEvent,
    QShowEvent,
)
from PySide6.QtWidgets import QMenu, QWidget
from typing_extensions import override

from processing.core.arrays import Floats
from processing.core.text import Language
from processing.image.attributes.tile_cache import TileCache
from processing.image.from_above.plan_points import PlanPoints, PointQuery
from processing.map.feature import PointReference
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.feature_drawing.outlines import are_inside
from widgets.map_view.map_decorations import (
    paint_fields_of_view,
    paint_north,
    paint_scale_bar,
    paint_slab,
    paint_vehicle_paths,
)
from widgets.map_view.plan_enclosed import points_below
from widgets.map_view.plan_feed import PlanFeed, PlanRequest, ShownPlan, whole_frame
from widgets.map_view.plan_pictures import PlanPictures
from widgets.map_view.plan_projection import MapPoint, PlanProjection, frame_of, on_plan
from widgets.map_view.vehicle_path import VehiclePath, vehicle_paths_of
from widgets.map_view.volume_layer import VolumeLayer
from widgets.parts.opening_page import OpeningPage
from widgets.plane_view.feature_hits import EnclosedPoints
from widgets.plane_view.projection import PlaneProjection
from widgets.plane_view.view import PlaneView
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

LIMIT_M = 3.0
_LIMITS_M = (1.0, 2.0, 3.0, 5.0, 10.0)
_QUICK_PX, _CLICK_PX, _CLOSE_PX = 1.0, 6.0, 1.0
_ALONG_SHARE = 0.12
_STREET_HALF_M = 15.0


class MapView(PlaneView):
    """Paints points, paths and features from above, north up.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    tiles : TileCache
    language : Language
        Of names that come from below Qt.

    Signals
    -------
    open_requested, import_requested
        The buttons of the empty view.
    limit_changed(limit_m: object)
        Points higher above the road (float, m) are hidden; None: all are shown.
    """

    open_requested = Signal()
    import_requested = Signal()
    limit_changed = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        tiles: TileCache,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(source, shared, parent, language=language)
        self._projection = PlanProjection()
        self._drives: tuple[tuple[Drive, ImageKind], ...] = ()
        self._vehicle_paths: tuple[VehiclePath, ...] = ()
        self._points = PlanPoints(())
        self._limit_m: float | None = LIMIT_M
        self._fields: tuple[Floats, ...] = ()
        self._best_field = -1
        self._slab: Floats | None = None
        self._age = 0
        self._is_closed = False
        self._pictures = PlanPictures()
        self._volume = VolumeLayer(shared.volume, self, language)
        self._feed = PlanFeed(tiles)
        self._feed.pictured.connect(self._on_feed_pictured)
        self._empty = OpeningPage(self.tr("A recording is shown here from above."), self)
        self._empty.open_requested.connect(self.open_requested)
        self._empty.import_requested.connect(self.import_requested)
        self.viewport_changed.connect(self._request)
        shared.map_changes.drive_columns_changed.connect(self._on_map_drive_columns_changed)
        shared.map_changes.follow_labels(self._on_map_labels_changed)
        shared.view_settings.look_changed.connect(self._on_settings_look_changed)
        shared.view_settings.image_changed.connect(self._on_settings_image_changed)
        shared.view_settings.hidden_drives_changed.connect(self._on_settings_image_changed)
        self._volume.outdated.connect(self.set_ground_stale)
        self._read_drives()

    # What others ask.

    @property
    def limit_m(self) -> float | None:
        """How far above the road points are shown; None: all of them."""
        return self._limit_m

    def set_limit(self, limit_m: float | None) -> None:
        """Hide what is more than this above the road; None: nothing."""
        if limit_m != self._limit_m:
            self._limit_m = limit_m
            self._request()
            self.limit_changed.emit(limit_m)

    def show_fields_of_view(self, polygons: Sequence[Floats], best: int) -> None:
        """Mark what camera images see.

        Parameters
        ----------
        polygons : sequence of (n, 2) float64
            Easting and northing of the corners on the ground, m, project CRS.
        best : int
            Number of the image that shows the cursor best; −1 for none.
        """
        self._fields = tuple(on_plan(np.asarray(polygon)) for polygon in polygons)
        self._best_field = best
        self.set_ground_stale()

    def show_slab(self, corners: Floats | None) -> None:
        """Mark where the section cuts; None where it doesn't.

        Parameters
        ----------
        corners : (4, 2) float64 or None
            Easting and northing of the slab's corners, m, project CRS.
        """
        self._slab = None if corners is None else on_plan(corners)
        self.update()

    @override
    def close(self) -> bool:
        """Stop making pictures; may be called again."""
        self._take_down()
        return super().close()

    # What the common view asks.

    @override
    def projection(self) -> PlaneProjection | None:
        return self._projection if self._drives else None

    @override
    def extent(self) -> QRectF | None:
        if not self._drives:
            return None
        low, high = self._bounds()
        everything = QRectF(low[0], -high[1], *np.maximum(high - low, 1.0).tolist())
        street = QRectF()
        for vehicle_path in self._vehicle_paths:
            street = street.united(vehicle_path.beside(_STREET_HALF_M))
        # A beam that went far through a gate makes nobody's street wider.
        return everything if street.isNull() else street.intersected(everything)

    @override
    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        self._pictures.paint(painter, viewport)
        self._volume.paint(painter, viewport)
        paint_fields_of_view(painter, viewport, self._fields, self._best_field)
        paint_vehicle_paths(painter, viewport, self._vehicle_paths)

    @override
    def paint_frame(self, painter: QPainter, viewport: PlaneViewport) -> None:
        if self._slab is not None:
            paint_slab(painter, viewport, self._slab)
        paint_scale_bar(painter, viewport)
        paint_north(painter, viewport)
        self._volume.paint_frame(painter, viewport)

    @override
    def position_at(
        self, position: MapPoint, reach: float, *, exact: bool
    ) -> PickedPosition | None:
        shown = self._pictures.newest
        if shown is None:
            return None
        easting, northing = position[0], -position[1]
        px_m = 1.0 / self.viewport.scale
        reach_m = min(reach, _CLICK_PX * px_m)
        if exact:
            ceiling_m = shown.ceiling_at(easting, northing)
            sought = PointQuery(easting, northing, _CLOSE_PX * px_m, reach_m, ceiling_m)
            found = self._points.point_at(sought)
            return None if found is None else _position_of(*found)
        drawn = shown.picture.point_at(easting, northing, reach_m)
        return None if drawn is None else _position_of(shown.request.drives[drawn[0]][0], drawn[1])

    @override
    def points_inside(self, outline: QPolygonF) -> Mapping[str, NDArray[np.int64]]:
        shown = self._pictures.newest
        if shown is None:
            return {}
        rows, columns = np.nonzero(shown.picture.points >= 0)
        frame = shown.picture.frame
        plane = np.column_stack(
            [
                frame.west + (columns + 0.5) / frame.px_per_m,
                (rows + 0.5) / frame.px_per_m - frame.north,
            ]
        )
        pixels = self.viewport.to_screen(plane)
        box = QPolygonF(outline.boundingRect())
        inside = np.flatnonzero(are_inside(pixels, box))
        inside = inside[are_inside(pixels[inside], outline)]
        rows, columns = rows[inside], columns[inside]
        drives, points = shown.picture.drives[rows, columns], shown.picture.points[rows, columns]
        return {
            shown.request.drives[number][0].id: np.unique(points[drives == number])
            for number in np.unique(drives).tolist()
        }

    @override
    def finder_inside(self, outline: QPolygonF) -> Callable[[], EnclosedPoints] | None:
        shown, viewport = self._pictures.newest, self.viewport
        if shown is None:
            return None
        corners = [viewport.to_plane(corner.x(), corner.y()) for corner in outline.toList()]
        return partial(points_below, shown, np.array(corners), viewport.scale)

    @override
    def on_drives_changed(self) -> None:
        self._age += 1
        self._pictures.clear()
        self._fields, self._best_field, self._slab = (), -1, None
        self._read_drives()

    @override
    def move_along(self, notches: float) -> None:
        viewport = self.viewport
        if not self._vehicle_paths:
            super().move_along(notches)
            return
        vehicle_path = min(
            self._vehicle_paths, key=lambda vehicle_path: vehicle_path.distance_to(viewport.centre)
        )
        here = vehicle_path.station_near(viewport.centre)
        there = (
            here - notches * _ALONG_SHARE * min(viewport.width, viewport.height) / viewport.scale
        )
        before, after = vehicle_path.at(np.array([here, there]))
        x, y = (np.array(viewport.centre) + after - before).tolist()
        self.set_viewport(viewport.centred_on(x, y))

    @override
    def view_menu(self) -> QMenu:
        menu = super().view_menu()
        menu.addSeparator()
        limits = menu.addMenu(self.tr("Hide what stands high above the road"))
        group = QActionGroup(limits)
        for limit_m in (None, *_LIMITS_M):
            words = self.tr("Hide nothing")
            if limit_m is not None:
                words = self.tr("Higher than {metres} m").format(metres=f"{limit_m:g}")
            action = limits.addAction(words)
            action.setCheckable(True)
            action.setChecked(limit_m == self._limit_m)
            action.setData(limit_m)
            group.addAction(action)
        group.triggered.connect(self._on_limit_triggered)
        limits.setEnabled(bool(self._vehicle_paths))
        return menu

    # Events.

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._request()

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        self._empty.setGeometry(self.rect())
        super().resizeEvent(event)

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        self._take_down()
        super().closeEvent(event)

    # What others tell.

    def _on_feed_pictured(self, shown: ShownPlan) -> None:
        if self._is_closed or shown.request.age != self._age:
            return
        self._pictures.take(shown)
        self.set_ground_stale()
        if shown.is_sharp and not shown.is_overview:
            self.sharpened.emit()

    def _on_map_drive_columns_changed(self, drive_id: str) -> None:
        if any(drive.id == drive_id for drive, _ in self._drives):
            self._age += 1
            self._request()

    def _on_map_labels_changed(self, drive_id: str, _points: object) -> None:
        if self._shared.view_settings.look.follows_labels:
            self._find_anew()
            self._on_map_drive_columns_changed(drive_id)

    def _on_settings_look_changed(self) -> None:
        self._find_anew()
        self._request()

    def _on_settings_image_changed(self) -> None:
        before = self._drives
        self._read_drives()
        if before != self._drives:
            self._age += 1
            if not self._drives:  # all are hidden
                self._pictures.clear()
                self.update()
            self._request()

    def _on_limit_triggered(self, action: QAction) -> None:
        limit_m: float | None = action.data()
        self.set_limit(limit_m)

    # What is done in more than one place.

    def _read_drives(self) -> None:
        wanted = self._shared.view_settings.image_kind
        before = [drive for drive, _ in self._drives]
        self._drives = tuple(
            (drive, wanted if wanted in drive.image_kinds else drive.image_kinds[0])
            for drive in self._source.drives()
            if drive.count and drive.id not in self._shared.view_settings.hidden_drives
        )
        drives = [drive for drive, _ in self._drives]
        if drives != before:
            self._vehicle_paths = vehicle_paths_of(drives)
        self._find_anew()
        self._empty.setVisible(not any(drive.count for drive in self._source.drives()))
        self._request()

    def _find_anew(self) -> None:
        hides_noise = self._shared.view_settings.look.hides_noise
        self._points = PlanPoints(self._drives, hides_noise=hides_noise)

    def _request(self) -> None:
        """Ask for a picture of what is seen, unless nobody sees it."""
        if self._is_closed or not self._drives or not self.isVisible():
            return
        ratio = self.devicePixelRatioF()
        look = self._shared.view_settings.look
        request = PlanRequest(
            frame=frame_of(self.viewport, ratio),
            everything=whole_frame(*self._bounds()),
            drives=self._drives,
            origin=self._source.origin(),
            age=self._age,
            look=look,
            size_px=max(1, round(look.point_size_px * ratio)),
            limit_m=self._limit_m,
        )
        self._feed.request(request)

    def _bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest easting and northing of all points, m."""
        low = np.min([drive.info.lowest[:2] for drive, _ in self._drives], axis=0)
        high = np.max([drive.info.highest[:2] for drive, _ in self._drives], axis=0)
        return low, high

    def _take_down(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            self._feed.close()


def _position_of(drive: Drive, point: int) -> PickedPosition:
    easting, northing, height = drive.xyz(np.array([point]))[0].tolist()
    return PickedPosition((easting, northing, height), PointReference(drive.id, point))
