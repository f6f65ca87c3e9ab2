"""ScenePainter: everything that is painted in the image view, from the ground up."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QCoreApplication, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPolygonF
from PySide6.QtWidgets import QWidget

from processing.core.errors import UserError
from processing.core.text import Language
from processing.image.attributes.attributes import ATTRIBUTES, most_telling_attribute
from processing.map.catalogue import Catalogue
from widgets.feature_drawing.screen_marks import paint_cross, paint_note, paint_outline, paint_snap
from widgets.image_view.colour_key import paint_colour_key
from widgets.image_view.features.feature_overlay import FeatureOverlay
from widgets.image_view.mosaic import Mosaic
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.shown_cursor import ShownCursor
from widgets.image_view.tile_images import TileImages
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Drawing
from widgets.shared.snap_state import SNAP_NAMES, SnapMark
from widgets.shared.view_settings import PointStyle

BACKGROUND = QColor("#14161a")
_PLATE = QColor(16, 18, 22, 190)
_INK = QColor("#d5dae0")


@dataclass(frozen=True)
class Overlays:
    """What is painted over the tiles.

    Attributes
    ----------
    outline : QPolygonF or None
        The rectangle or the lasso that is being drawn, widget pixels.
    snap : SnapMark or None
        Where the next click would land.
    refusal : UserError or None
        Why there is no picture.
    """

    drawing: Drawing | None
    catalogue: Catalogue
    look: PointStyle
    cursor: ShownCursor
    outline: QPolygonF | None
    snap: SnapMark | None
    refusal: UserError | None

    @staticmethod
    def of(
        shared: SharedState,
        catalogue: Catalogue,
        *,
        cursor: ShownCursor,
        outline: QPolygonF | None,
        refusal: UserError | None,
    ) -> Overlays:
        """What there is now: a view's own, and what all views share."""
        return Overlays(
            drawing=shared.sketch.drawing,
            catalogue=catalogue,
            look=shared.view_settings.look,
            cursor=cursor,
            outline=outline,
            snap=shared.snap.mark,
            refusal=refusal,
        )


class ScenePainter:
    """Paints a view.

    Parameters
    ----------
    view : QWidget
    language : Language
        Of what comes from below Qt.
    """

    def __init__(
        self, view: QWidget, images: TileImages, features: FeatureOverlay, language: Language
    ) -> None:
        self._view = view
        self._images = images
        self._mosaic = Mosaic(images)
        self._features = features
        self._language: Language = language

    def paint(self, picture: OrientedImage | None, viewport: Viewport, overlays: Overlays) -> bool:
        """Paint everything; says whether the tiles are as sharp as they will be."""
        refusal, is_sharp = overlays.refusal, False
        with QPainter(self._view) as painter:
            painter.fillRect(self._view.rect(), BACKGROUND)
            if picture is not None:
                painter.setClipRect(viewport.window)
                is_sharp = self._mosaic.paint(painter, picture, viewport)
                self._paint_over(painter, picture, viewport, overlays)
                self._paint_words(painter, picture, viewport, overlays.look)
                refusal = self._images.refusal
            if refusal is not None:
                self._paint_refusal(painter, refusal)
        return is_sharp

    def _paint_over(
        self, painter: QPainter, picture: OrientedImage, viewport: Viewport, overlays: Overlays
    ) -> None:
        drawing, catalogue = overlays.drawing, overlays.catalogue
        self._features.paint(painter, viewport, catalogue, drawing)
        if drawing is not None:
            self._features.paint_sketch(
                painter, viewport, picture, catalogue=catalogue, drawing=drawing
            )
        spot, before = overlays.cursor.spot, overlays.cursor.before
        if spot is not None:
            trail = None if before is None else viewport.position_of(*before)
            paint_cross(painter, viewport.position_of(*spot), trail)
        if drawing is not None:
            for note in drawing.notes:
                position = self._features.screen_position(viewport, note.xyz)
                if position is not None:
                    paint_note(painter, position, note)
        if overlays.snap is not None:
            position = self._features.screen_position(viewport, overlays.snap.xyz)
            if position is not None:
                name = SNAP_NAMES[overlays.snap.mode].in_language(self._language)
                paint_snap(painter, position, overlays.snap.mode, name)
        if overlays.outline is not None:
            paint_outline(painter, overlays.outline)

    def _paint_words(
        self, painter: QPainter, picture: OrientedImage, viewport: Viewport, look: PointStyle
    ) -> None:
        """Paint the key to the colours, and beside it what the picture is."""
        clip = painter.clipBoundingRect()
        shown = most_telling_attribute(picture.drive, look.attribute)
        key = paint_colour_key(
            painter,
            QPointF(clip.right() - 8, clip.bottom() - 8),
            picture.drive,
            shown,
            (look.low_percent, look.high_percent),
            language=self._language,
        )
        words = self._describe_picture(picture, viewport, look)
        self._paint_line(painter, words, key.left() - 8)

    def _describe_picture(
        self, picture: OrientedImage, viewport: Viewport, look: PointStyle
    ) -> str:
        shown = most_telling_attribute(picture.drive, look.attribute)
        row_m = picture.orientation.length_m / max(picture.size[0], 1)
        scale = QCoreApplication.translate("ScenePainter", "1 px = {metres:.3f} m").format(
            metres=row_m / viewport.zoom_u
        )
        words = (
            picture.drive.info.name,
            picture.image.kind.title.in_language(self._language),
            ATTRIBUTES[shown].title.in_language(self._language),
            "" if shown == look.attribute else self._lacks(look.attribute),
            scale,
        )
        return "  ·  ".join(word for word in words if word)

    def _lacks(self, attribute: str) -> str:
        reported = QCoreApplication.translate("ScenePainter", "no “{name}” in this drive")
        return reported.format(name=ATTRIBUTES[attribute].title.in_language(self._language))

    def _paint_line(self, painter: QPainter, line: str, end: float) -> None:
        clip = painter.clipBoundingRect()
        room = end - clip.left() - 24
        metrics = painter.fontMetrics()
        shown = metrics.elidedText(line, Qt.TextElideMode.ElideRight, int(room))
        width, height = metrics.horizontalAdvance(shown), metrics.height()
        left = clip.left() + 8
        plate = QRectF(left, clip.bottom() - height - 12, width + 16, height + 4)
        painter.fillRect(plate, _PLATE)
        painter.setPen(_INK)
        painter.drawText(QPointF(left + 8, plate.bottom() - 2 - metrics.descent()), shown)

    def _paint_refusal(self, painter: QPainter, refusal: UserError) -> None:
        what, remedy = (part.in_language(self._language) for part in (refusal.what, refusal.remedy))
        room = QRectF(self._view.rect()).adjusted(24, 24, -24, -24)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        box = painter.boundingRect(room, int(flags), f"{what}\n{remedy}")
        painter.fillRect(box.adjusted(-12, -8, 12, 8), _PLATE)
        painter.setPen(_INK)
        painter.drawText(room, int(flags), f"{what}\n{remedy}")
