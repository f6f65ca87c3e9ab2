"""ImageMargins: what stands round the picture: ruler and minimap beside it, or the empty page."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QWidget

from processing.image.attributes.tile_cache import TileCache
from widgets.image_view.minimap import Minimap
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.ruler import Ruler
from widgets.parts.opening_page import OpeningPage
from widgets.shared.view_settings import PointStyle

_RULER_PX = 20
_MINIMAP_PX = 40


class ImageMargins:
    """Holds the parts at the edges of a view and tells them what is shown.

    Where the street goes up, the ruler stands on the left and the minimap on the right; else above
    and below.

    Parameters
    ----------
    view : QWidget
        The parts are its children.
    tiles : TileCache
    """

    def __init__(self, view: QWidget, tiles: TileCache) -> None:
        self._view = view
        self.ruler = Ruler(view)
        self.minimap = Minimap(tiles, view)
        words = QCoreApplication.translate(
            "EmptyPage", "A recording is shown here as an image: every pixel is a laser point."
        )
        self.empty = OpeningPage(words, view)
        self._has_strip = True

    def lay_out(self, viewport: Viewport) -> Viewport:
        """Stand at the edges of the view; the viewport gets what is left."""
        width, height = self._view.width(), self._view.height()
        strip = _MINIMAP_PX if self._has_strip else 0
        self.empty.setGeometry(0, 0, width, height)
        if viewport.orientation.is_vertical:
            self.ruler.setGeometry(0, 0, _RULER_PX, height)
            self.minimap.setGeometry(width - strip, 0, strip, height)
            return viewport.sized(width - _RULER_PX - strip, height, 0, _RULER_PX)
        self.ruler.setGeometry(0, 0, width, _RULER_PX)
        self.minimap.setGeometry(0, height - strip, width, strip)
        return viewport.sized(width, height - _RULER_PX - strip, _RULER_PX)

    def show_picture(
        self, picture: OrientedImage | None, look: PointStyle, *, is_refused: bool
    ) -> None:
        """Belong to a picture, or say that there is none."""
        self.minimap.show_picture(picture, look)
        self.empty.setVisible(picture is None and not is_refused)
        self.ruler.setVisible(picture is not None)
        # A strip is no map of what is seen from above.
        self._has_strip = picture is None or picture.rows_go_right
        self.minimap.setVisible(picture is not None and self._has_strip)

    def show_part(self, picture: OrientedImage | None, viewport: Viewport) -> None:
        """Tell which part of the picture is shown."""
        self.ruler.show_part(picture, viewport)
        if picture is not None:
            span = viewport.span
            self.minimap.mark(span.left, span.right, viewport.orientation)
