"""An open map without a document: what views ask of one, and drives to look at."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex, new_feature_id
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.photos import photo_of
from processing.project.store.runs import Run
from processing.recording.drive import Drive
from tests.builders import simulated_drive, write_laz, write_trajectory_csv
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.shared.cursor import Cursor, PickedPosition
from widgets.shared.map_changes import MapChanges
from widgets.shared.selection import Selection
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Sketch
from widgets.shared.snap_state import SnapState
from widgets.shared.view_settings import ViewSettings

KINDS = Catalogue(
    (
        FeatureKind("curb", Text("Curb", "縁石"), Geometry.LINE, "", "curb", "#e69f00", 30),
        FeatureKind(
            "lid", Text("Lid", "側溝蓋"), Geometry.AREA, "", "lid", "#56b4e9", 150, thickness_m=0.3
        ),
        FeatureKind("pole", Text("Pole", "電柱"), Geometry.POINT, "", "pole", "#009e73", 96),
    )
)
"""A kind of each shape."""


def shared_state() -> SharedState:
    """The state that the views of one window share."""
    return SharedState(Cursor(), Selection(), MapChanges(), ViewSettings(), Sketch(), SnapState())


def imported_drive(folder: Path, *, head: str = "left", seed: int = 1) -> Drive:
    """A simulated street of ten metres, imported as a delivery would be."""
    folder.mkdir(parents=True, exist_ok=True)
    street = simulated_drive(seed, head="left" if head == "left" else "right")
    points = write_laz(street, folder / f"{head}.laz")
    trajectory = write_trajectory_csv(street, folder / "trajectory.csv")
    into = folder / "drives"
    into.mkdir()
    (made,) = import_drives(ImportRequest((points,), (trajectory,)), into, SilentMonitor())
    return Drive(made)


@dataclass
class OpenMap:
    """Drives and features in memory; changes are told as the document tells them."""

    all_drives: tuple[Drive, ...] = ()
    shared: SharedState = field(default_factory=shared_state)
    stored: dict[str, Feature] = field(default_factory=dict)
    applied: list[tuple[Text, Change]] = field(default_factory=list)
    reported: list[Text] = field(default_factory=list)
    all_runs: tuple[Run, ...] = ()
    folder: Path = Path()

    def drives(self) -> tuple[Drive, ...]:
        return self.all_drives

    def drive(self, id: str) -> Drive:
        return {drive.id: drive for drive in self.all_drives}[id]

    def origin(self) -> NDArray[np.float64]:
        return np.array(self.all_drives[0].info.lowest) if self.all_drives else np.zeros(3)

    def features(self) -> Iterable[Feature]:
        return tuple(self.stored.values())

    def feature(self, id: str) -> Feature | None:
        return self.stored.get(id)

    def photo(self, feature: Feature) -> Path | None:
        return photo_of(feature, self.folder)

    def runs(self) -> tuple[Run, ...]:
        return self.all_runs

    def catalogue(self) -> Catalogue:
        return KINDS

    def crs(self) -> str:
        return "EPSG:6677"

    def apply(self, label: Text, change: Change) -> None:
        """Do a change and tell the views."""
        for feature in change.removed:
            del self.stored[feature.id]
        for feature in (*change.added, *(pair.after for pair in change.replaced)):
            self.stored[feature.id] = feature
        self.applied.append((label, change))
        self.shared.map_changes.features_changed.emit(change.feature_ids)

    def listen_to(self, tool: MouseTool) -> MouseTool:
        """Do what a tool asks for and remember what it says."""
        tool.change_requested.connect(self.apply)
        tool.reported.connect(self.reported.append)
        return tool

    def kind_of(self, geometry: Geometry) -> str:
        """Some kind of that shape."""
        return next(kind.id for kind in KINDS if kind.geometry is geometry)

    def add(self, geometry: Geometry, drive: Drive, *points: int, **fields: object) -> Feature:
        """Put a feature on measured points of a drive."""
        feature = Feature(
            new_feature_id(),
            self.kind_of(geometry),
            geometry,
            tuple(vertex_on(drive, point) for point in points),
            **fields,  # type: ignore[arg-type]
        )
        self.apply(Text.same("test"), Change(added=(feature,)))
        return feature


def do_now(work: Callable[[], object], take: Callable[[object | None], None]) -> None:
    """What the document does in the background, at once."""
    take(work())


def path_tool(source: OpenMap, geometry: Geometry) -> DrawLine:
    """A tool that draws lines or areas of some kind."""
    tool = DrawLine(source, source.shared, geometry, do_now)
    tool.set_kind(KINDS[source.kind_of(geometry)])
    return tool


def position_on(drive: Drive, point: int) -> PickedPosition:
    """A measured point as a place."""
    easting, northing, height = drive.xyz(np.array([point]))[0].tolist()
    return PickedPosition((easting, northing, height), PointReference(drive.id, point))


def vertex_on(drive: Drive, point: int) -> Vertex:
    """A measured point as a vertex."""
    position = position_on(drive, point)
    return Vertex(position.xyz, position.measured)
