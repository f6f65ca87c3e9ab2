"""MapLayer: the map's features as the 3D view draws and hits them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, QTimer, Signal

from processing.image.search.clip import Clip
from processing.map.catalogue import Catalogue
from processing.map.feature import Feature, Status
from processing.map.solids import thickness_of
from widgets.feature_drawing.feature_shapes import FeatureShapes, FlatShapes, flatten_shapes
from widgets.feature_drawing.feature_style import colour_of_kind, style_of
from widgets.feature_drawing.own_point_marks import OwnPointPlaces
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

if TYPE_CHECKING:  # importing it imports VTK, which is done after the view was shown
    from widgets.scene_view.rendering.feature_actors import DottedPoints
    from widgets.scene_view.rendering.scene_renderer import SceneRenderer


class MapLayer(QObject):
    """Reads features from the document and draws them, and the map of change of a volume.

    Parameters
    ----------
    source : MapSource
    shared : SharedState

    Attributes
    ----------
    flat : FlatShapes
        The features that are drawn.
    replaced : str
        The feature that isn't, because it is being edited; or empty.

    Signals
    -------
    outdated()
        What is drawn isn't what is to be seen any longer; told once for all changes of a moment.
    """

    outdated = Signal()

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._shapes = FeatureShapes(np.zeros(3), ())
        self._chosen = OwnPointPlaces(source, shared)
        self.flat: FlatShapes = flatten_shapes(())
        self.replaced = ""
        self._clip: Clip | None = None
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self.outdated)
        shared.map_changes.features_changed.connect(self._on_map_features_changed)
        shared.selection.features_changed.connect(self._soon.start)
        shared.view_settings.shown_features_changed.connect(self._soon.start)
        shared.sketch.changed.connect(self._on_sketch_changed)
        shared.volume.changed.connect(self._soon.start)
        shared.volume.look_changed.connect(self._soon.start)

    def read_all(self) -> None:
        """Take over all features, about the document's origin."""
        self._shapes = FeatureShapes(self._source.origin(), self._source.features())
        self._soon.start()

    def clip_to(self, clip: Clip | None) -> None:
        """Draw the map of change only in this part of space; features are drawn everywhere."""
        self._clip = clip
        self._soon.start()

    def catch_up(self) -> None:
        """Tell now what would be told soon: a frame is about to be drawn anyway."""
        if self._soon.isActive():
            self._soon.stop()
            self.outdated.emit()

    def show(self, scene_renderer: SceneRenderer | None) -> None:
        """Draw what is to be seen, once there is a stage."""
        self.replaced = self._replaced_now()
        seen = self._shapes.seen(self._shared.view_settings.shows, self.replaced)
        self.flat = flatten_shapes(seen)
        if scene_renderer is None:
            return
        volume = self._shared.volume
        scene_renderer.change.show(volume.drawn, volume.look, self._source.origin(), self._clip)
        # Imported here: it draws by VTK.
        from widgets.scene_view.rendering.feature_actors import StyledShape
        from widgets.scene_view.rendering.solid_actors import StyledSolid

        catalogue, chosen = self._source.catalogue(), self._shared.selection.features
        styled = [
            StyledShape(
                shape,
                style_of(catalogue, shape.feature, is_selected=shape.feature.id in chosen),
            )
            for shape in seen
        ]
        scene_renderer.features.show(styled, scene_renderer.scale, self._own_points())
        scene_renderer.solids.show(
            [
                StyledSolid(one.shape, one.style, thickness_m)
                for one in styled
                if (thickness_m := _thickness(catalogue, one.shape.feature))
            ]
        )

    def places_of(self, ids: Iterable[str]) -> NDArray[np.float64] | None:
        """(n, 3): vertices of features, metres from the origin; None when there are none."""
        shapes = [self._shapes.get(id_) for id_ in ids]
        positions = [shape.local_xyz for shape in shapes if shape is not None]
        return np.concatenate(positions) if positions else None

    def _own_points(self) -> tuple[DottedPoints, ...]:
        """The points that chosen things consist of."""
        from widgets.scene_view.rendering.feature_actors import DottedPoints

        catalogue, origin = self._source.catalogue(), self._source.origin()
        return tuple(
            DottedPoints(self._chosen.xyz(one) - origin, colour_of_kind(catalogue, one.kind))
            for one in self._chosen.features()
        )

    def _on_map_features_changed(self, ids: tuple[str, ...]) -> None:
        for id_ in ids:
            self._shapes.replace(id_, self._source.feature(id_))
        self._soon.start()

    def _on_sketch_changed(self) -> None:
        if self._replaced_now() != self.replaced:
            self._soon.start()

    def _replaced_now(self) -> str:
        drawing = self._shared.sketch.drawing
        return "" if drawing is None else drawing.replaces


def _thickness(catalogue: Catalogue, feature: Feature) -> float:
    """Of the body below a feature; 0 without one, as what was rejected is."""
    if feature.status is Status.REJECTED or feature.kind not in catalogue:
        return 0.0
    return thickness_of(catalogue[feature.kind], feature)
