"""GroundLayers: the ground in a section: of the volume that is shown, or else as it was found."""

from __future__ import annotations

from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from processing.core.text import Language
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.change_lines import ChangePainter
from widgets.section_view.picture.feed import SectionPicture
from widgets.section_view.picture.ground_line import paint_ground_legend, paint_ground_lines
from widgets.shared.shown_volume import ShownVolume


class GroundLayers:
    """Two lines of one ground would only hide each other.

    Parameters
    ----------
    volume : ShownVolume
    view : QWidget
        Painted again where another volume is shown.
    language : Language
    """

    def __init__(self, volume: ShownVolume, view: QWidget, language: Language) -> None:
        self._change = ChangePainter(volume)
        volume.changed.connect(view.update)
        volume.look_changed.connect(view.update)
        self._language: Language = language

    def paint(self, painter: QPainter, viewport: PlaneViewport, picture: SectionPicture) -> None:
        """Lines over the points."""
        cut = picture.request.cut
        line = self._change.line_in(cut)
        if line is None:
            paint_ground_lines(painter, viewport, cut, picture.ground)
        else:
            self._change.paint(painter, viewport, cut, line)

    def paint_legend(
        self, painter: QPainter, viewport: PlaneViewport, picture: SectionPicture
    ) -> None:
        """What the lines are."""
        if self._change.line_in(picture.request.cut) is None:
            paint_ground_legend(painter, viewport, picture, self._language)
        else:
            self._change.paint_legend(painter, viewport, self._language)
