"""Scenes of labels painted on points, and of templates drawn in the section."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QPushButton

from app.screenshots.hand import CONTROL, SHIFT
from app.screenshots.street import MARKING_M, RIGHT, SIDEWALK_M, at
from app.screenshots.studio import Studio
from processing.project.feature import Position
from processing.section.cut import Cut
from widgets.section_view.pane import SectionPane
from widgets.shared.cursor import Place

_GROUND, _TREE, _ROAD = 2, 5, 11
_FITTED_MS = 60_000


def brush(studio: Studio) -> None:
    """A stroke of the brush along the sidewalk, points in the colours of their labels."""
    _take(studio, "U", _GROUND)
    _drag(studio, [at(5.0, SIDEWALK_M), at(9.0, 0.9), at(13.0, SIDEWALK_M)])


def rectangle(studio: Studio) -> None:
    """A rectangle on the road; the stroke before is done."""
    brush(studio)
    studio.hand.let_go()
    studio.letter("U", SHIFT)
    studio.parts.document.shared.labels.choose(_ROAD)
    begin, end = (studio.spot(RIGHT, at(*place)) for place in ((5.5, -0.9), (12.0, -3.0)))
    studio.hand.drag(studio.view, [begin, end])


def segment(studio: Studio) -> None:
    """A tree labelled as a whole."""
    tree = studio.features("street_tree", RIGHT)[1].vertices[0].xyz
    _take(studio, "Y", _TREE, tree)
    studio.hand.click(studio.view, studio.spot(RIGHT, tree) + QPoint(0, -40))


def lasso_in_3d(studio: Studio) -> None:
    """A lasso in 3D."""
    _take(studio, "U", _GROUND)
    studio.hand.click(studio.view, studio.spot(RIGHT, at(9.0, MARKING_M)), CONTROL)
    studio.letter("U", CONTROL)
    scene = studio.parts.scene_view
    scene.center_on(studio.place(RIGHT, at(9.0, SIDEWALK_M)))
    picture = scene.picture
    if picture is None:
        return
    studio.hand.wheel(picture, picture.rect().center(), 6)
    studio.settle()
    middle = picture.rect().center()
    way = [(-150, 20), (-90, -70), (30, -80), (120, -20), (90, 60), (-40, 70), (-140, 30)]
    studio.hand.drag(picture, [middle + QPoint(*step) for step in way])


def template(studio: Studio) -> None:
    """A curb's profile being drawn in the section."""
    street = _CurbSection.of(studio)
    studio.act("tool-template")
    street.click(studio, street.profile[:3])
    street.hover(studio, street.profile[3])


def template_panel(studio: Studio) -> None:
    """The drawn template, with the points of the section where it lies."""
    _drawn_template(studio)


def template_zone(studio: Studio) -> None:
    """Where nothing should be, being drawn above the template."""
    street = _drawn_template(studio)
    studio.act("tool-template-zone")
    street.click(studio, street.zone[:3])
    street.hover(studio, street.zone[3])


def template_fit(studio: Studio) -> None:
    """Candidates along the street, found from the template."""
    _drawn_template(studio)
    parts = studio.parts
    before = len(parts.document.runs())
    direct = Qt.FindChildOption.FindDirectChildrenOnly
    *_, fit = parts.template_panel.findChildren(QPushButton, options=direct)
    studio.hand.click(fit, fit.rect().center())
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
    def of(studio: Studio) -> _CurbSection:
        upper = studio.feature("curb_upper", RIGHT).vertices[4].xyz
        lower = studio.feature("curb_lower", RIGHT).vertices[4].xyz
        studio.bring("view-section")
        studio.look(RIGHT, upper, 6)
        place = studio.place(RIGHT, upper)
        studio.parts.document.shared.cursor.move_to(place)
        section = studio.parts.section_view
        section.center_on(place)
        studio.settle()
        pane, cut = section.panes[0], section.cut
        if cut is None:
            message = "there is no section"
            raise LookupError(message)
        spot = pane.position_of(place)
        if spot is not None:
            studio.hand.wheel(pane, spot.toPoint(), 12)
        pane.center_on(place)
        studio.settle()
        (across, up, _), (beside, _, _) = cut.to_section([upper, lower]).tolist()
        return _CurbSection(pane, cut, (across, up), 1.0 if beside > across else -1.0)

    @property
    def profile(self) -> list[Place]:
        corners = [(0.0, 0.0), (0.02, -0.13), (0.3, -0.12), (0.6, -0.1)]
        return [self.place(*corner) for corner in corners]

    @property
    def zone(self) -> list[Place]:
        corners = [(0.1, 0.1), (0.6, 0.1), (0.6, 0.5), (0.1, 0.5)]
        return [self.place(*corner) for corner in corners]

    def place(self, towards_road: float, up: float) -> Place:
        across = self.anchor[0] + self.to_road * towards_road
        xyz = self.cut.to_space([[across, self.anchor[1] + up, 0.0]])[0].tolist()
        return Place((xyz[0], xyz[1], xyz[2]))

    def click(self, studio: Studio, places: list[Place]) -> None:
        for place in places:
            studio.hand.click(self.pane, self._spot(place))

    def hover(self, studio: Studio, place: Place) -> None:
        studio.hand.move(self.pane, self._spot(place) - QPoint(7, 3))
        studio.hand.move(self.pane, self._spot(place))

    def _spot(self, place: Place) -> QPoint:
        at_ = self.pane.position_of(place)
        return QPoint() if at_ is None else at_.toPoint()


def _drawn_template(studio: Studio) -> _CurbSection:
    street = _CurbSection.of(studio)
    studio.act("tool-template")
    street.click(studio, street.profile)
    studio.hand.key(street.pane, Qt.Key.Key_Return)
    studio.settle()
    return street


def _take(studio: Studio, tool: str, code: int, xyz: Position | None = None) -> None:
    """A paint tool with a class, labels shown, and their panel."""
    studio.act("show-label")
    studio.bring("labels")
    studio.look(RIGHT, at(9.0, 0.5) if xyz is None else xyz, 6)
    studio.letter(tool)
    studio.parts.document.shared.labels.choose(code)


def _drag(studio: Studio, places: list[Position]) -> None:
    studio.hand.drag(studio.view, [studio.spot(RIGHT, xyz) for xyz in places])


PAINTING: Mapping[str, Callable[[Studio], None]] = {
    "paint-brush": brush,
    "paint-lasso": lasso_in_3d,
    "paint-rectangle": rectangle,
    "paint-segment": segment,
    "template": template,
    "template-fit": template_fit,
    "template-panel": template_panel,
    "template-zone": template_zone,
}
