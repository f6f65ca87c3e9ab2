"""Scenes of what is chosen and edited."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPoint, Qt

from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL, PLAIN, SHIFT
from app.screenshots.street import MARKING_M, RIGHT, SIDEWALK_M, at


def edit_vertices(studio: ScreenshotWindow) -> None:
    """A vertex of a curb on its way to another point."""
    spot = _curb(studio, 4, 9)
    studio.letter("V")
    studio.mouse.click(studio.view, spot)
    studio.mouse.drag(studio.view, [spot, spot + QPoint(14, 22)], CONTROL)


def move(studio: ScreenshotWindow) -> None:
    """A line on its way, with how far it was moved."""
    spot = _curb(studio, 4, 7)
    studio.letter("G")
    studio.mouse.drag(studio.view, [spot, spot + QPoint(30, 34)], CONTROL)


def split(studio: ScreenshotWindow) -> None:
    """A line that was split; one half is chosen."""
    spot = (_curb(studio, 4, 7) + studio.spot(RIGHT, _vertex(studio, 5))) / 2
    studio.letter("X")
    studio.mouse.click(studio.view, spot)
    studio.letter("S")
    studio.settle()
    studio.mouse.click(studio.view, spot + QPoint(40, 0))


def extend(studio: ScreenshotWindow) -> None:
    """A line taken at its end; which line it goes on to is asked."""
    studio.look(RIGHT, at(9.0, 0.6), 7)
    studio.letter("4")
    studio.draw(RIGHT, [at(7.0, 1.9), at(8.0, 1.2)])
    studio.key(Qt.Key.Key_Return)
    studio.letter("X", SHIFT)
    studio.mouse.click(studio.view, studio.spot(RIGHT, at(8.0, 1.2)))
    studio.hover(studio.spot(RIGHT, at(9.0, 0.2)))


def trim(studio: ScreenshotWindow) -> None:
    """The line that cuts was chosen; which part is kept is asked."""
    studio.look(RIGHT, at(9.0, 0.2), 7)
    studio.letter("4")
    studio.draw(RIGHT, [at(8.5, SIDEWALK_M), at(9.5, MARKING_M)])
    studio.key(Qt.Key.Key_Return)
    studio.letter("T", SHIFT)
    studio.mouse.click(studio.view, studio.spot(RIGHT, at(8.5, SIDEWALK_M)))
    studio.hover(studio.spot(RIGHT, _vertex(studio, 5)))


def chosen(studio: ScreenshotWindow) -> None:
    """A chosen line with its attributes."""
    spot = _curb(studio, 4, 6)
    studio.mouse.click(studio.view, spot)


def several_chosen(studio: ScreenshotWindow) -> None:
    """Several features, and what they have in common."""
    studio.look(RIGHT, at(9.0, 0.0), 3)
    view = studio.view
    first = True
    for feature in studio.features("curb_lower", RIGHT) + studio.features("street_tree", RIGHT):
        if not view.rect().contains(studio.spot(RIGHT, feature.vertices[0].xyz)):
            continue
        spot = studio.spot(RIGHT, feature.vertices[0].xyz)
        studio.mouse.click(view, spot, PLAIN if first else SHIFT)
        first = False


def box(studio: ScreenshotWindow) -> None:
    """A box being drawn."""
    studio.look(RIGHT, at(9.0, 0.0), 3)
    middle = studio.view.rect().center()
    studio.mouse.drag(studio.view, [middle - QPoint(240, 60), middle + QPoint(180, 50)])


def points_chosen(studio: ScreenshotWindow) -> None:
    """Points chosen with a box, as both views show them."""
    box(studio)
    studio.mouse.let_go()


def lasso(studio: ScreenshotWindow) -> None:
    """A lasso being drawn."""
    studio.look(RIGHT, at(9.0, 0.0), 3)
    studio.letter("S", SHIFT)
    middle = studio.view.rect().center()
    way = [(-200, 20), (-120, -70), (40, -80), (160, -20), (120, 60), (-60, 70)]
    studio.mouse.drag(studio.view, [middle + QPoint(*step) for step in way])


def menu_of_line(studio: ScreenshotWindow) -> None:
    """The menu of a line."""
    studio.mouse.right_click(studio.view, _curb(studio, 4, 6))


def menu_of_nothing(studio: ScreenshotWindow) -> None:
    """The menu where nothing is drawn."""
    studio.look(RIGHT, at(9.0, MARKING_M), 6)
    studio.mouse.right_click(studio.view, studio.spot(RIGHT, at(9.0, -2.0)))


def _vertex(studio: ScreenshotWindow, number: int) -> tuple[float, float, float]:
    return studio.feature("curb_lower", RIGHT).vertices[number].xyz


def _curb(studio: ScreenshotWindow, number: int, notches: int) -> QPoint:
    """Go to a vertex of the drawn lower edge; gives where it is then."""
    studio.look(RIGHT, _vertex(studio, number), notches)
    return studio.spot(RIGHT, _vertex(studio, number))


EDITING: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "attributes-many": several_chosen,
    "attributes-one": chosen,
    "edit-extend": extend,
    "edit-move": move,
    "edit-split": split,
    "edit-trim": trim,
    "edit-vertices": edit_vertices,
    "menu-line": menu_of_line,
    "menu-nothing": menu_of_nothing,
    "select-box": box,
    "select-lasso": lasso,
    "select-points": points_chosen,
}
