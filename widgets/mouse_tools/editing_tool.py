"""EditingTool: what tools that change features on the map have in common."""

from __future__ import annotations

from PySide6.QtCore import QObject

from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.drafting.crossings import crosses_itself
from processing.map.feature import Feature
from widgets.mouse_tools.mouse_tool import Hit, MouseTool
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

PICK_FEATURE = Text("Click on a feature.", "地物の上をクリックしてください。")
PICK_LINE = Text("Click on a line.", "線の上をクリックしてください。")
WOULD_CROSS = Text(
    "The area would cross itself near E {east:.2f}, N {north:.2f}; it stays as it was.",
    "面の境界が E {east:.2f}、N {north:.2f} 付近で交差するため、変更しませんでした。",
)


class EditingTool(MouseTool):
    """Knows the map, the selection and the sketch; Escape drops the gesture, then gives up.

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
        self._selection = shared.selection
        self._sketch = shared.sketch

    def _feature_of(self, hit: Hit) -> Feature | None:
        return self._source.feature(hit.feature) if hit.feature else None

    def _line_of(self, hit: Hit) -> Feature | None:
        """The line under the mouse, or None after asking for one."""
        feature = self._feature_of(hit)
        if feature is None or feature.geometry is not Geometry.LINE:
            self.reported.emit(PICK_LINE)
            return None
        return feature

    def _selected_features(self) -> tuple[Feature, ...]:
        found = [self._source.feature(id_) for id_ in sorted(self._selection.features)]
        return tuple(feature for feature in found if feature is not None)

    def _replace(self, label: Text, before: Feature, after: Feature) -> None:
        """Ask for one feature to become another, unless its ring would cross itself."""
        if after == before:
            return
        if after.geometry is Geometry.AREA:
            positions = [vertex.xyz for vertex in after.vertices]
            crossing = crosses_itself(positions, is_closed=True)
            if crossing is not None:
                self.reported.emit(WOULD_CROSS.filled(east=crossing[0], north=crossing[1]))
                return
        self.change_requested.emit(label, Change(replaced=(Replacement(before, after),)))

    def _report_refusal(self, refusal: UserError) -> None:
        joined = Text("{what} {remedy}", "{what}{remedy}")
        self.reported.emit(joined.filled(what=refusal.what, remedy=refusal.remedy))
