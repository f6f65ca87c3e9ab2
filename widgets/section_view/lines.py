"""SectionLines: the lines that sections stand on: trajectories, what is drawn, a site's axis."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QObject

from processing.core.errors import UserError
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Position
from processing.recording.drive import Drive
from processing.section.site_axis import site_axis
from processing.section.stations import Stations
from widgets.mouse_tools.near_features import NearFeatures
from widgets.section_view.picture.section_position import CutLine, SectionPosition
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_LINE_REACH_M = 0.5
"""A drawn line is under the mouse within so much in plan; and so high above or below."""

_HEIGHT_REACH_M = 1.5
_TRAJECTORY_REACH_M = 1.0
_SAME_PASS_M = 60.0
_START_M = 10.0


class SectionLines(QObject):
    """Finds lines and where places stand on them; keeps their stations.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    """

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._near = NearFeatures(source, shared.map_changes, self)
        self._drawn: dict[str, tuple[Feature, CutLine | None]] = {}
        self._driven: dict[str, CutLine | None] = {}
        self._axis: CutLine | None = None
        self._has_looked_for_axis = False
        shared.map_changes.drives_changed.connect(self._on_drives_changed)
        shared.map_changes.features_changed.connect(self._on_features_changed)

    @property
    def has_own(self) -> bool:
        """Whether there is a line to stand on though none is drawn."""
        drives = self._source.drives()
        return any(self.trajectory(drive) for drive in drives) or self.axis is not None

    @property
    def axis(self) -> CutLine | None:
        """The middle line of a site where nobody drove; None where a drive has a trajectory."""
        drives = self._source.drives()
        if not self._has_looked_for_axis and not any(map(self.trajectory, drives)):
            self._has_looked_for_axis = True
            self._axis = _axis_of(drives)
        return self._axis

    def drawn(self, feature_id: str) -> CutLine | None:
        """A drawn line or the outline of an area; None where there is none with a length."""
        feature = self._source.feature(feature_id)
        if feature is None or feature.geometry is Geometry.POINT:
            return None
        known = self._drawn.get(feature_id)
        if known is None or known[0] is not feature:
            known = self._drawn[feature_id] = feature, _line_of(feature)
        return known[1]

    def trajectory(self, drive: Drive) -> CutLine | None:
        """The trajectory of a drive; None where it has none or never moved."""
        if drive.id not in self._driven:
            self._driven[drive.id] = _driven_line(drive)
        return self._driven[drive.id]

    def standing_at(self, line: CutLine, position: PickedPosition) -> SectionPosition:
        """Where the section across a line goes through a place."""
        between = None
        if line.drive and position.measured is not None and position.measured.drive == line.drive:
            between = self._pass_of(line, position.measured.point)
        return SectionPosition(
            line, line.stations.through(position.xyz, between), through=position.xyz
        )

    def across_trajectory(self, position: PickedPosition) -> SectionPosition | None:
        """Where a section across the nearest trajectory goes through a place.

        That of the place's own drive goes before others; where nobody drove, the site's axis.
        """
        drives = self._source.drives()
        if position.measured is not None:
            drives = tuple(one for one in drives if one.id == position.measured.drive) or drives
        lines = [line for drive in drives if (line := self.trajectory(drive)) is not None]
        if not lines:
            others = [self.trajectory(drive) for drive in self._source.drives()]
            lines = [line for line in others if line is not None]
        if not lines and self.axis is not None:
            lines = [self.axis]
        found = [self.standing_at(line, position) for line in lines]
        return min(found, key=lambda one: _distance(one, position), default=None)

    def start(self) -> SectionPosition | None:
        """Near the beginning of the drive that the image view shows, or of the first one.

        Where nobody drove, in the middle of the site.
        """
        chosen = self._shared.view_settings.drive_id
        drives = sorted(self._source.drives(), key=lambda drive: drive.id != chosen)
        for drive in drives:
            line = self.trajectory(drive)
            if line is not None:
                return SectionPosition(line, min(_START_M, line.stations.length_m / 2))
        axis = self.axis
        return None if axis is None else SectionPosition(axis, axis.stations.length_m / 2)

    def under(self, position: PickedPosition) -> SectionPosition | None:
        """The line under a place, drawn ones before trajectories; None where none is near."""
        best: tuple[float, CutLine] | None = None
        easting, northing, height = position.xyz
        reach = _LINE_REACH_M
        for line in self._near_lines(position):
            stations = line.stations
            left, low, right, high = stations.bounds
            is_beside = not (left - reach <= easting <= right + reach)
            if is_beside or not (low - reach <= northing <= high + reach):
                continue
            station_m = stations.nearest(position.xyz)
            away = stations.distance(position.xyz, station_m)
            above = height - stations.position_at(station_m)[2]
            is_near = away <= reach and abs(above) <= _HEIGHT_REACH_M
            if is_near and (best is None or away < best[0]):
                best = away, line
        if best is not None:
            return self.standing_at(best[1], position)
        driven = self.across_trajectory(position)
        if driven is None or driven.line.is_axis:
            return None  # nothing on the ground shows an axis
        is_near = _distance(driven, position) <= _TRAJECTORY_REACH_M
        return driven if is_near else None

    def in_background(self) -> str:
        """Id of the chosen line, or else of the one at the cursor; empty when there is none."""
        for id_ in sorted(self._shared.selection.features):
            if self.drawn(id_) is not None:
                return id_
        position = self._shared.cursor.position
        found = None if position is None else self.under(position)
        return "" if found is None else found.line.feature

    def near(self, position: Position, reach_m: float) -> list[Feature]:
        """The features that are shown and whose bounds come within reach of a place."""
        settings = self._shared.view_settings
        return [
            feature for feature in self._near.within(position, reach_m) if settings.shows(feature)
        ]

    def _near_lines(self, position: PickedPosition) -> list[CutLine]:
        """The lines about a place; of those that are not, no stations are made."""
        near = self.near(position.xyz, _LINE_REACH_M)
        about = [one for one in near if one.id in self._drawn or _is_about(one, position.xyz)]
        found = [self.drawn(feature.id) for feature in about]
        return [line for line in found if line is not None]

    def _pass_of(self, line: CutLine, point: int) -> tuple[float, float] | None:
        """The stretch that was driven about the time of a point: streets are driven twice."""
        drive = self._source.drive(line.drive)
        station = line.stations.station_at_time(float(drive.columns["time"][point]))
        return None if station is None else (station - _SAME_PASS_M, station + _SAME_PASS_M)

    def _on_drives_changed(self) -> None:
        self._drawn.clear()
        self._driven.clear()
        self._axis, self._has_looked_for_axis = None, False

    def _on_features_changed(self, ids: tuple[str, ...]) -> None:
        for id_ in ids:
            self._drawn.pop(id_, None)


def _is_about(feature: Feature, position: Position) -> bool:
    eastings, northings, _ = zip(*(vertex.xyz for vertex in feature.vertices), strict=True)
    easting, northing, _ = position
    reach = _LINE_REACH_M
    is_beside = not (min(eastings) - reach <= easting <= max(eastings) + reach)
    return not is_beside and bool(min(northings) - reach <= northing <= max(northings) + reach)


def _line_of(feature: Feature) -> CutLine | None:
    positions = np.array([vertex.xyz for vertex in feature.vertices])
    try:
        stations = Stations(positions, is_closed=feature.geometry is Geometry.AREA)
    except UserError:  # a line without length is no line to cut across
        return None
    return CutLine(feature.id, "", stations)


def _axis_of(drives: Sequence[Drive]) -> CutLine | None:
    try:
        found = site_axis(drives)
    except UserError:  # a damaged drive; the image view says why
        return None
    return None if found is None else CutLine("", "", found.stations, found.half_length_m)


def _driven_line(drive: Drive) -> CutLine | None:
    trajectory = drive.trajectory
    if trajectory is None:
        return None
    try:
        return CutLine("", drive.id, Stations.of_trajectory(trajectory))
    except UserError:  # the vehicle never moved
        return None


def _distance(standing: SectionPosition, position: PickedPosition) -> float:
    return standing.line.stations.distance(position.xyz, standing.station_m)
