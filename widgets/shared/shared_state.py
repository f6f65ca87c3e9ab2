"""SharedState: the small objects that all views of one window share, handed over together."""

from __future__ import annotations

from dataclasses import dataclass, field

from widgets.shared.cursor import Cursor
from widgets.shared.label_palette import LabelPalette
from widgets.shared.map_changes import MapChanges
from widgets.shared.selection import Selection
from widgets.shared.shown_volume import ShownVolume
from widgets.shared.sketch import Sketch
from widgets.shared.snap_state import SnapState
from widgets.shared.view_settings import ViewSettings


@dataclass(frozen=True)
class SharedState:
    """What views listen to; no logic of its own."""

    cursor: Cursor
    selection: Selection
    map_changes: MapChanges
    view_settings: ViewSettings
    sketch: Sketch
    snap: SnapState
    labels: LabelPalette = field(default_factory=LabelPalette)
    volume: ShownVolume = field(default_factory=ShownVolume)
