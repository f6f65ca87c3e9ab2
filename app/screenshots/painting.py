"""Scenes of labels painted on points, and of templates drawn in the section."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QPushButton

from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL, SHIFT
from app.screenshots.street import MARKING_M, RIGHT, SIDEWALK_M, at
from processing.map.feature import Position
from processing.section.cut import Cut
from widgets.section_view.pane import SectionPane
from widgets.shared.cursor import PickedPosition

_GROUND, _TREE, _ROAD = 2, 5, 11
_FITTED_MS = 60_000


def brush(studio: ScreenshotWindow) -> None:
    """A stroke of the brush along the sidewalk, points in the colours of their labels."""
    _take(studio, "U", _GROUND)
    _drag(studio, [at(5.0, SIDEWALK_M), at(9.0, 0.9), at(13.0, SIDEWALK_M)])


def rectangle(studio: ScreenshotWindow) -> None:
    """A rectangle on the road; the stroke before is done."""
    brush(studio)
    studio.mouse.let_go()
    studio.letter("U", SHIFT)
    studio.parts.document.shared.labels.choose(_ROAD)
    begin, end = (studio.spot(RIGHT, at(*position)) for position in ((5.5, -0.9), (12.0, -3.0)))
    studio.mouse.drag(studio.view, [begin, end])


def segment(studio: ScreenshotWindow) -> None:
    """A tree labelled as a whole."""
    tree = studio.features("street_tree", RIGHT)[1].vertices[0].xyz
    _take(studio, "Y", _TREE, tree)
    studio.mouse.click(studio.view, studio.spot(RIGHT, tree) + QPoint(0, -40))


def lasso_in_3d(studio: ScreenshotWindow) -> None:
    """A lasso in 3D."""
    _take(studio, "U", _GROUND)
    studio.mouse.click(studio.view, studio.spot(RIGHT, at(9.0, MARKING_M)), CONTROL)
    studio.letter("U", CONTROL)
    scene = studio.parts.scene_view
    scene.center_on(studio.position(RIGHT, at(9.0, SIDEWALK_M)))
    picture = scene.picture
    if picture is None:
        return
    studio.mouse.wheel(picture, picture.rect().center(), 6)
    studio.settle()
    middle = picture.rect().center()
    way = [(-150, 20), (-90, -70), (30, -80), (120, -20), (90, 60), (-40, 70), (-140, 30)]
    studio.mouse.drag(picture, [middle + QPoint(*step) for step in way])


def template(studio: ScreenshotWindow) -> None:
    """A curb's profile being drawn in the section."""
    street = _CurbSection.of(studio)
    studio.act("tool-template")
    street.click(studio, street.profile[:3])
    street.hover(studio, street.profile[3])


def template_panel(studio: ScreenshotWindow) -> None:
    """The drawn template, with the points of the section where it lies."""
    _drawn_template(studio)


def template_zone(studio: ScreenshotWindow) -> None:
    """Where nothing should be, being drawn above the template."""
    street = _drawn_template(studio)
    studio.act("tool-template-zone")
    street.click(studio, street.zone[:3])
    street.hover(studio, street.zone[3])


def template_fit(studio: ScreenshotWindow) -> None:
    """Candidates along the street, found from the template."""
    _drawn_template(studio)
    parts = studio.parts
    before = len(parts.document.runs())
    direct = Qt.FindChildOption.FindDirectChildrenOnly
    *_, fit = parts.template_panel.findChildren(QPushButton, options=direct)
    studio.mouse.click(fit, fit.rect().center())
    studio.wait(lambda: len(parts.document.runs()) > before, _FITTED_MS)
    studio.wait(lambda: not parts.jobs.is_busy)


@dataclass(frozen=True)
class _CurbSection:
    """The section through a drawn curb, large enough to draw in."""

    pane: SectionPane
    cut: Cut
    anchor: tuple[float, float]
    to_road: float

    @staticmethod
    def of(studio: ScreenshotWindow) -> _CurbSection:
        upper = studio.feature("curb_upper", RIGHT).vertices[4].xyz
        lower = studio.feature("curb_lower", RIGHT).vertices[4].xyz
        studio.bring("view-section")
        studio.look(RIGHT, upper, 6)
        position = studio.position(RIGHT, upper)
        studio.parts.document.shared.cursor.move_to(position)
        section = studio.parts.section_view
        section.center_on(position)
        studio.settle()
        pane, cut = section.panes[0], section.cut
        if cut is None:
            message = "there is no section"
            raise LookupError(message)
        spot = pane.position_of(position)
        if spot is not None:
            studio.mouse.wheel(pane, spot.toPoint(), 12)
        pane.center_on(position)
        studio.settle()
        (across, up, _), (beside, _, _) = cut.to_section([upper, lower]).tolist()
        return _CurbSection(pane, cut, (across, up), 1.0 if beside > across else -1.0)

    @property
    def profile(self) -> list[PickedPosition]:
        corners = [(0.0, 0.0), (0.02, -0.13), (0.3, -0.12), (0.6, -0.1)]
        return [self.position(*corner) for corner in corners]

    @property
    def zone(self) -> list[PickedPosition]:
        corners = [(0.1, 0.1), (0.6, 0.1), (0.6, 0.5), (0.1, 0.5)]
        return [self.position(*corner) for corner in corners]

    def position(self, towards_road: float, up: float) -> PickedPosition:
        across = self.anchor[0] + self.to_road * towards_road
        xyz = self.cut.to_space([[across, self.anchor[1] + up, 0.0]])[0].tolist()
        return PickedPosition((xyz[0], xyz[1], xyz[2]))

    def click(self, studio: ScreenshotWindow, positions: list[PickedPosition]) -> None:
        for position in positions:
            studio.mouse.click(self.pane, self._spot(position))

    def hover(self, studio: ScreenshotWindow, position: PickedPosition) -> None:
        studio.mouse.move(self.pane, self._spot(position) - QPoint(7, 3))
        studio.mouse.move(self.pane, self._spot(position))

    def _spot(self, position: PickedPosition) -> QPoint:
        at_ = self.pane.position_of(position)
        return QPoint() if at_ is None else at_.toPoint()


def _drawn_template(studio: ScreenshotWindow) -> _CurbSection:
    street = _CurbSection.of(studio)
    studio.act("tool-template")
    street.click(studio, street.profile)
    studio.mouse.key(street.pane, Qt.Key.Key_Return)
    studio.settle()
    return street


def _take(studio: ScreenshotWindow, tool: str, code: int, xyz: Position | None = None) -> None:
    """A paint tool with a class, labels shown, and their panel."""
    studio.act("show-label")
    studio.bring("labels")
    studio.look(RIGHT, at(9.0, 0.5) if xyz is None else xyz, 6)
    studio.letter(tool)
    studio.parts.document.shared.labels.choose(code)


def _drag(studio: ScreenshotWindow, positions: list[Position]) -> None:
    studio.mouse.drag(studio.view, [studio.spot(RIGHT, xyz) for xyz in positions])


PAINTING: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "paint-brush": brush,
    "paint-lasso": lasso_in_3d,
    "paint-rectangle": rectangle,
    "paint-segment": segment,
    "template": template,
    "template-fit": template_fit,
    "template-panel": template_panel,
    "template-zone": template_zone,
}
