"""DrawParallel: copies of a line beside it, at the mouse or at an exact distance."""

from __future__ import annotations

import math
from dataclasses import replace

from PySide6.QtCore import QObject, Signal
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.change import Change
from processing.map.drafting.heights import set_on_ground
from processing.map.drafting.parallels import distance_to_line, parallel
from processing.map.feature import Feature, Position, Provenance, Vertex, new_feature_id
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT
from widgets.mouse_tools.editing_tool import EditingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

PARALLEL = Text("Parallel copy", "平行複写")
PICK_LINE_OR_AREA = Text("Click on a line or an area.", "線または面をクリックしてください。")
PICK_SIDE = Text(
    "Click where the copy should run; where a distance is set, the click only says the side.",
    "複写する位置をクリックしてください。距離を入力した場合は、クリックした側に複写します。",
)
_LEAST_M = 0.005
_STEP_M, _NEAR_STEP_M = 0.5, 0.06
"""How far above or below the line points of the copy may lie; and with a rise that was set."""


class DrawParallel(EditingTool):
    """The first click takes the line, the second says where the copy runs.

    With a distance that was set, only the side is taken from the mouse. Heights come from the
    measured points under the copy; the tool keeps the new line, so that one copy follows another.

    Signals
    -------
    kind_taken(kind: str)
        The kind of the line that was taken: the copy is of that kind too, unless another of the
        same shape is chosen then.
    """

    kind_taken = Signal(str)

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(source, shared, parent)
        self._line: Feature | None = None
        self._fixed_m: float | None = None
        self._rise_m = 0.0
        self._kind: FeatureKind | None = None
        self._aside_m = 0.0

    @property
    @override
    def snaps(self) -> bool:
        return self._line is not None

    @property
    @override
    def snaps_to_edges(self) -> bool:
        return self._line is not None

    @property
    @override
    def is_busy(self) -> bool:
        return self._line is not None

    def fix_distance(self, metres: float | None) -> None:
        """Copy at exactly this distance; None: at the mouse."""
        self._fixed_m = metres if metres is not None and metres >= _LEAST_M else None
        if self._fixed_m is not None and self._aside_m:
            self._aside_m = math.copysign(self._fixed_m, self._aside_m)
        self._show()

    def set_rise(self, metres: float) -> None:
        """Look for the copy's heights so much above the line: the upper edge of a curb."""
        self._rise_m = metres
        self._show()

    def makes(self, kind: FeatureKind) -> bool:
        """Whether a copy of the line at hand can be of a kind."""
        return self._line is not None and self._line.geometry is kind.geometry

    def set_kind(self, kind: FeatureKind) -> None:
        """Make copies of this kind from the line at hand."""
        self._kind = kind
        self._show()

    def take(self, line: Feature) -> None:
        """Take a line as if it had been clicked."""
        self._line, self._aside_m, self._kind = line, 0.0, None
        self.kind_taken.emit(line.kind)
        self._selection.choose_features(frozenset({line.id}))
        self.reported.emit(PICK_SIDE)

    @override
    def press(self, hit: Hit) -> None:
        if self._line is None:
            feature = self._feature_of(hit)
            if feature is None or feature.geometry is Geometry.POINT:
                self.reported.emit(PICK_LINE_OR_AREA)
            else:
                self.take(feature)
            return
        if hit.position is None:
            self.reported.emit(NO_POINT)
            return
        self._aside_m = self._aside(hit.position.xyz)
        self.complete()

    @override
    def move(self, hit: Hit) -> None:
        if self._line is not None and hit.position is not None:
            self._aside_m = self._aside(hit.position.xyz)
            self._show()

    @override
    def complete(self) -> None:
        line = None if self._line is None else self._source.feature(self._line.id)
        if line is None or abs(self._aside_m) < _LEAST_M:
            return
        try:
            positions = self._positions(line)
        except UserError as refusal:
            self._report_refusal(refusal)
            return
        # At the edge of a curb both heights are near; the rise that was set says which is meant.
        step_m = _NEAR_STEP_M if self._rise_m else _STEP_M
        vertices = set_on_ground(positions, self._source.drives(), step_m=step_m)
        copy = replace(
            line,
            id=new_feature_id(),
            kind=self._kind_of(line),
            vertices=vertices,
            # What is true of one edge needn't be of another kind's.
            attributes=line.attributes if self._kind_of(line) == line.kind else {},
            provenance=Provenance(),
        )
        self.put_down()
        self.change_requested.emit(PARALLEL, Change(added=(copy,)))
        if self._source.feature(copy.id) is not None:
            self.take(copy)

    @override
    def put_down(self) -> None:
        self._line, self._aside_m = None, 0.0
        self._sketch.show(None)

    def _kind_of(self, line: Feature) -> str:
        return line.kind if self._kind is None else self._kind.id

    def _aside(self, position: Position) -> float:
        line = self._line
        if line is None:
            return 0.0
        is_closed = line.geometry is Geometry.AREA
        positions = [vertex.xyz for vertex in line.vertices]
        aside = distance_to_line(positions, position, is_closed=is_closed)
        if self._fixed_m is None:
            return aside
        return self._fixed_m if aside >= 0 else -self._fixed_m

    def _positions(self, line: Feature) -> tuple[Position, ...]:
        positions = [vertex.xyz for vertex in line.vertices]
        beside = parallel(positions, self._aside_m, is_closed=line.geometry is Geometry.AREA)
        return tuple((east, north, up + self._rise_m) for east, north, up in beside)

    def _show(self) -> None:
        line = self._line
        if line is None or abs(self._aside_m) < _LEAST_M:
            self._sketch.show(None)
            return
        try:
            positions = self._positions(line)
        except UserError:  # told when it is clicked
            self._sketch.show(None)
            return
        vertices = tuple(Vertex(position) for position in positions)
        ring = (vertices[0],) if line.geometry is Geometry.AREA else ()
        rise = f"  ↑{self._rise_m:+.3f} m" if self._rise_m else ""
        note = Note(positions[len(positions) // 2], f"{abs(self._aside_m):.3f} m{rise}")
        self._sketch.show(
            Drawing(
                self._kind_of(line), Geometry.LINE, vertices[:1], vertices[1:] + ring, notes=(note,)
            )
        )
