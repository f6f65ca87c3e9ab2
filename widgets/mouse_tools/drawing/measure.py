"""Measure: distances, heights, slopes, angles and areas by clicks, kept as features on demand."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal
from typing_extensions import override

from processing.core.text import Text
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.change import Change
from processing.map.drafting.crossings import crosses_itself
from processing.map.drafting.measuring import Measure, measures_of
from processing.map.feature import AttributeValue, Feature, Vertex, new_feature_id
from widgets.mouse_tools.drawing.draw_line import CROSSES
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT
from widgets.mouse_tools.editing_tool import EditingTool
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing, Note

KEEP = Text("Keep a measurement", "計測結果の保存")
NOTHING_TO_KEEP = Text("Measure something first.", "先に計測してください。")
NO_SUCH_KIND = Text(
    "The project's catalogue has no kind “{name}” to keep it as.",
    "プロジェクトのカタログに、保存先の種別「{name}」がありません。",
)
MEASUREMENT = "measurement"
MEASURED_AREA = "measured_area"
"""Kinds of the catalogue as which measurements are kept."""


class MeasureTool(EditingTool):
    """Clicks add places; what lies between them is told at once, also while the mouse moves.

    Enter or the right button ends a measurement: it stays to be read until the next click.

    Parameters
    ----------
    is_closed : bool
        Whether areas are measured.

    Signals
    -------
    measured(measures: tuple[Measure, ...])
        What is measured now; empty when nothing is.
    """

    measured = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        *,
        is_closed: bool = False,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(source, shared, parent)
        self._is_closed = is_closed
        self._vertices: tuple[Vertex, ...] = ()
        self._preview: Vertex | None = None
        self._is_done = False

    @property
    @override
    def snaps(self) -> bool:
        return True

    @property
    @override
    def snaps_to_edges(self) -> bool:
        return True

    @property
    @override
    def last_vertex(self) -> Vertex | None:
        return self._vertices[-1] if self._vertices and not self._is_done else None

    @property
    @override
    def is_busy(self) -> bool:
        return bool(self._vertices)

    @override
    def press(self, hit: Hit) -> None:
        vertex = hit.as_vertex()
        if vertex is None:
            self.reported.emit(NO_POINT)
            return
        if self._is_done:
            self.put_down()
        if vertex not in self._vertices[-1:]:
            self._vertices += (vertex,)
        self._show()

    @override
    def move(self, hit: Hit) -> None:
        if self._vertices and not self._is_done:
            self._preview = hit.as_vertex()
            self._show()

    @override
    def complete(self) -> None:
        if self._vertices:
            self._is_done, self._preview = True, None
            self._show()

    @override
    def step_back(self) -> None:
        self._is_done = False
        self._vertices = self._vertices[:-1]
        self._show()

    @override
    def put_down(self) -> None:
        self._vertices, self._preview, self._is_done = (), None, False
        self._show()

    def keep(self) -> None:
        """Keep what is measured as a feature of its own."""
        least = 3 if self._is_closed else 2
        if len(self._vertices) < least:
            self.reported.emit(NOTHING_TO_KEEP)
            return
        name = MEASURED_AREA if self._is_closed else MEASUREMENT
        catalogue = self._source.catalogue()
        if name not in catalogue:
            self.reported.emit(NO_SUCH_KIND.filled(name=name))
            return
        crossing = None
        if self._is_closed:
            crossing = crosses_itself([one.xyz for one in self._vertices], is_closed=True)
        if crossing is None:
            self._ask_for(catalogue[name])
        else:
            self.reported.emit(CROSSES.filled(east=crossing[0], north=crossing[1]))

    def _ask_for(self, kind: FeatureKind) -> None:
        attributes: dict[str, AttributeValue] = {
            measure.id: round(measure.value, measure.decimals)
            for measure in self._measures(self._vertices)
            if kind.attribute(measure.id) is not None
        }
        geometry = Geometry.AREA if self._is_closed else Geometry.LINE
        feature = Feature(new_feature_id(), kind.id, geometry, self._vertices, attributes)
        self.put_down()
        self.change_requested.emit(KEEP, Change(added=(feature,)))

    def _measures(self, vertices: tuple[Vertex, ...]) -> tuple[Measure, ...]:
        if len(vertices) < 2:
            return ()
        is_closed = self._is_closed and len(vertices) > 2
        return measures_of([vertex.xyz for vertex in vertices], is_closed=is_closed)

    def _show(self) -> None:
        if not self._vertices:
            self._sketch.show(None)
            self.measured.emit(())
            return
        preview = () if self._preview is None else (self._preview,)
        if self._vertices[-1:] == preview:  # the mouse rests where it clicked
            preview = ()
        whole = self._vertices + preview
        measures = self._measures(whole)
        geometry = Geometry.AREA if self._is_closed else Geometry.LINE
        notes = (Note(whole[-1].xyz, _short(measures)),) if measures else ()
        kind = MEASURED_AREA if self._is_closed else MEASUREMENT
        drawn = self._vertices
        if self._is_closed and self._is_done and len(drawn) > 2:
            drawn += drawn[:1]
        self._sketch.show(Drawing(kind, geometry, drawn, preview, notes=notes))
        self.measured.emit(measures)


def _short(measures: tuple[Measure, ...]) -> str:
    """The first measure, beside the mouse; the bar names them all."""
    first = measures[0]
    return f"{first.value:.{first.decimals}f} {first.unit}".rstrip()
