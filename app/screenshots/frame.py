"""Scenes of the window itself: panels, menus, palettes, messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QLineEdit, QTableView, QToolButton

from app.screenshots.editing import several_chosen
from app.screenshots.screenshot_window import ScreenshotWindow
from app.screenshots.simulated_mouse import CONTROL, SHIFT
from app.screenshots.street import RIGHT, at
from processing.core.monitor import Monitor
from processing.core.text import Text
from widgets.parts.command_palette import CommandPalette

_ROW = Text("row {row} of 1,046", "1,046行中{row}行目")
_MENU_KEYS = {"file": "F", "edit": "E", "view": "V", "draw": "D", "process": "P", "help": "H"}


def window(studio: ScreenshotWindow) -> None:
    """The street, nothing in the hand."""
    studio.look(RIGHT, at(9.0, 0.0), 3)


def whole(studio: ScreenshotWindow) -> None:
    """The whole recording, coloured by height."""
    studio.key(Qt.Key.Key_Home)
    studio.act("show-height")


def classes(studio: ScreenshotWindow) -> None:
    """The surfaces' directions, views side by side."""
    studio.act("side-by-side")
    studio.look(RIGHT, at(9.0, 0.0), 2)
    studio.act("show-normal")


def table(studio: ScreenshotWindow) -> None:
    """The table of features."""
    studio.key(Qt.Key.Key_F6)


def table_filtered(studio: ScreenshotWindow) -> None:
    """The table after a word was typed, some rows chosen."""
    table(studio)
    studio.settle()
    features = studio.parts.feature_table
    studio.mouse.type(features.findChildren(QLineEdit)[0], "tree")
    rows = features.findChildren(QTableView)[0]
    studio.settle()
    for row, modifiers in ((0, Qt.KeyboardModifier.NoModifier), (2, SHIFT)):
        spot = rows.visualRect(rows.model().index(row, 1)).center()
        studio.mouse.click(rows.viewport(), spot, modifiers)


def jobs(studio: ScreenshotWindow) -> None:
    """A long job that runs, and one that waits."""
    studio.bring("jobs")

    def work(monitor: Monitor) -> None:
        step = 0
        while True:
            step = min(step + 1, 43)
            monitor.report(step / 100, _ROW.filled(row=10 * step))
            monitor.check()
            studio.pause()

    for title in (Text("Segments: right", "区分: right"), Text("Segments: left", "区分: left")):
        studio.parts.jobs.start(title, work)
    studio.wait(lambda: any(one.seconds_left for one in studio.parts.jobs.statuses))


def processing(studio: ScreenshotWindow) -> None:
    """A tool's settings."""
    studio.bring("processing")


def project(studio: ScreenshotWindow) -> None:
    """What the project holds."""
    studio.bring("project")


def layers_searched(studio: ScreenshotWindow) -> None:
    """Kinds found by a part of their name."""
    studio.bring("layers")
    words = {"en": "manhole", "ja": "m"}[studio.parts.language]
    studio.mouse.type(studio.parts.layers_panel.findChildren(QLineEdit)[0], words)


def kind_palette(studio: ScreenshotWindow) -> None:
    """What to draw, by name."""
    studio.letter("K", CONTROL)
    studio.mouse.type(studio.dialog(CommandPalette).findChildren(QLineEdit)[0], "cur")


def command_palette(studio: ScreenshotWindow) -> None:
    """Every command by name."""
    studio.letter("P", CONTROL | SHIFT)
    studio.mouse.type(studio.dialog(CommandPalette).findChildren(QLineEdit)[0], "line")


def menu_of_snaps(studio: ScreenshotWindow) -> None:
    """What clicks snap to."""
    button = studio.parts.drawing_bar.findChildren(QToolButton)[-1]
    studio.point_at(button)
    studio.mouse.click(button, button.rect().center())


def error(studio: ScreenshotWindow) -> None:
    """Trouble: a file that was dropped is no point cloud."""
    path = studio.scratch / "street.las"
    path.write_bytes(b"not a point cloud")
    studio.mouse.drop(studio.parts.window, [str(path)])
    studio.wait(lambda: not studio.parts.jobs.is_busy)


def two_in_the_box(studio: ScreenshotWindow) -> None:
    """Attributes of many at work, the table beside them."""
    several_chosen(studio)
    table(studio)


def _menu(name: str) -> Callable[[ScreenshotWindow], None]:
    def open_menu(studio: ScreenshotWindow) -> None:
        bar = studio.parts.window.menuBar()
        action = bar.actions()[list(_MENU_KEYS).index(name)]
        spot = bar.actionGeometry(action).center()
        studio.mouse.click(bar, QPoint(spot))

    return open_menu


FRAME: Mapping[str, Callable[[ScreenshotWindow], None]] = {
    "window": window,
    "window-beside": classes,
    "window-whole": whole,
    "error": error,
    "jobs": jobs,
    "layers-search": layers_searched,
    "menu-snaps": menu_of_snaps,
    **{f"menu-{name}": _menu(name) for name in _MENU_KEYS},
    "palette-commands": command_palette,
    "palette-kinds": kind_palette,
    "panel-processing": processing,
    "panel-project": project,
    "table": table,
    "table-filter": table_filtered,
    "table-many": two_in_the_box,
}
