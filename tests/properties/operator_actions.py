"""Everything that an operator may do next: each action is valid, which one comes is chance."""

from __future__ import annotations

import random
from collections.abc import Callable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QDialog,
    QLineEdit,
    QMenu,
    QTableView,
    QWidget,
)

from processing.image.attributes.attributes import available
from processing.recording.columns.point_features import POINT_FEATURES
from processing.recording.kinds import ImageKind
from processing.tools.listed import registry
from tests.properties.operator_input import CTRL, FREE, RIGHT, SHIFT, Operator
from tests.properties.operator_views import review, stand_otherwise

OperatorAction = Callable[[Operator, random.Random], None]

TOOLS = (
    *("line", "area", "point", "trace", "arc", "spline", "rectangle", "circle", "parallel"),
    *("select", "lasso", "edit", "move", "split", "extend", "trim", "measure", "measure-area"),
    *("paint-brush", "paint-rectangle", "paint-lasso", "paint-segment", "template"),
)
_EDITS = ("join", "reverse", "simplify", "close-lines", "open-lines", "continue-line")
_STATUSES = ("status-accepted", "status-candidate", "status-rejected")
_SELECTIONS = (
    *("select-all", "select-none", "select-kind", "select-status", "select-attributes"),
    "select-occluded",
)
_SNAPS = ("vertex", "crossing", "line", "extension", "lowest", "highest", "edge")
_PLANES = ("plane-level", "plane-fitted", "plane-off", "plane-off")
_THEMES = ("theme-light", "theme-dark", "theme-system")
_LETTERS = ("0.15", "12", "2024-05-01", "縁石 A", "", "-3", "９９")
_DELETE = Qt.Key.Key_Delete
_MOST_FEATURES, _MOST_COPIED = 80, 10


# Drawing.


def take_tool(operator: Operator, choice: random.Random) -> None:
    operator.trigger(f"tool-{choice.choice(TOOLS)}")


def take_kind(operator: Operator, choice: random.Random) -> None:
    operator.trigger(f"kind-key-{choice.randint(0, 9)}")


def click_anywhere(operator: Operator, choice: random.Random) -> None:
    operator.click(operator.some_spot(choice), operator.modifiers(choice))


def click_on_vertex(operator: Operator, choice: random.Random) -> None:
    feature = operator.some_feature(choice)
    if feature is None:
        return
    spot = operator.spot_on_vertex(feature, choice.randrange(len(feature.vertices)))
    if spot is not None:
        operator.click(spot, operator.modifiers(choice))


def click_on_line(operator: Operator, choice: random.Random) -> None:
    feature = operator.some_feature(choice)
    spot = None if feature is None else operator.spot_on_line(feature, choice)
    if spot is not None:
        operator.click(spot, operator.modifiers(choice))


def draw_some(operator: Operator, choice: random.Random) -> None:
    """A few clicks along the street, and the end of it."""
    operator.trigger(f"tool-{choice.choice(('line', 'line', 'area', 'trace', 'spline', 'arc'))}")
    start = operator.some_spot(choice)
    step = choice.choice((-40, 40))
    for number in range(choice.randint(3, 6)):
        spot = start + QPoint(step * number, choice.randint(-30, 30))
        if operator.view.rect().contains(spot):
            operator.click(spot)
    operator.key(Qt.Key.Key_Return)


def put_points(operator: Operator, choice: random.Random) -> None:
    """Signs, lids and trees, one click or three each."""
    operator.trigger(f"tool-{choice.choice(('point', 'rectangle', 'circle'))}")
    start = operator.some_spot(choice)
    for _ in range(3):
        operator.click(start + QPoint(choice.randint(0, 60), choice.randint(-20, 20)))


def end_drawing(operator: Operator, choice: random.Random) -> None:
    operator.key(choice.choice((Qt.Key.Key_Return, Qt.Key.Key_Escape, Qt.Key.Key_Backspace)))


def double_click(operator: Operator, choice: random.Random) -> None:
    spot = operator.some_spot(choice)
    operator.click(spot)
    QTest.mouseDClick(operator.view, Qt.MouseButton.LeftButton, FREE, spot)


def close_drawing(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(("close-drawing", "keep-measurement", "cycle-kind")))


def press_right(operator: Operator, choice: random.Random) -> None:
    """End a gesture, or choose from the menu that comes."""
    operator.click(operator.some_spot(choice), button=RIGHT)
    menu = QApplication.activePopupWidget()
    if isinstance(menu, QMenu):
        offered = [one for one in menu.actions() if one.isEnabled() and not one.isSeparator()]
        menu.close()
        choice.choice(offered).trigger()


def click_in_3d(operator: Operator, choice: random.Random) -> None:
    picture = operator.parts.scene_view.picture
    if picture is None:
        return
    spot = QPoint(choice.randrange(picture.width()), choice.randrange(picture.height()))
    operator.click(spot, operator.modifiers(choice), widget=picture)


# Editing.


def drag_vertex(operator: Operator, choice: random.Random) -> None:
    feature = operator.some_feature(choice)
    if feature is None:
        return
    spot = operator.spot_on_vertex(feature, choice.randrange(len(feature.vertices)))
    if spot is None:
        return
    if choice.random() < 0.5:
        operator.trigger("tool-edit")
    else:
        operator.trigger("tool-select")
        operator.click(spot)
    end = spot + QPoint(choice.randint(-80, 80), choice.randint(-40, 40))
    operator.drag([spot, (spot + end) / 2, end], operator.modifiers(choice))


def hold_vertex(operator: Operator, choice: random.Random) -> None:
    """Take hold of a vertex, do something by key before it is let go."""
    feature = operator.some_feature(choice)
    spot = None if feature is None else operator.spot_on_vertex(feature, 0)
    if spot is None:
        return
    operator.trigger("tool-edit")
    operator.press(spot)
    operator.move(spot + QPoint(20, 5), button=Qt.MouseButton.LeftButton)
    choice.choice(
        (
            operator.undo,
            lambda: operator.trigger("redo"),
            lambda: operator.key(Qt.Key.Key_Escape),
            lambda: operator.key(Qt.Key.Key_Delete),
            lambda: take_tool(operator, choice),
            lambda: operator.trigger("select-none"),
        )
    )()
    operator.release(spot + QPoint(30, 5))


def drag_box(operator: Operator, choice: random.Random) -> None:
    operator.trigger(f"tool-{choice.choice(('select', 'lasso'))}")
    way = [operator.some_spot(choice) for _ in range(choice.randint(2, 5))]
    operator.drag(way, choice.choice((FREE, SHIFT)))


def drag_features(operator: Operator, choice: random.Random) -> None:
    feature = operator.some_feature(choice)
    spot = None if feature is None else operator.spot_on_line(feature, choice)
    if spot is not None:
        operator.trigger("tool-move")
        end = spot + QPoint(choice.randint(-60, 60), choice.randint(-30, 30))
        operator.drag([spot, end], choice.choice((FREE, CTRL)))


def edit_lines(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(_EDITS))


def judge(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(_STATUSES))


def choose(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(_SELECTIONS))


def cut_and_paste(operator: Operator, choice: random.Random) -> None:
    """A full map is emptied, so that the next day is as long as this one."""
    if _is_full(operator):
        operator.trigger("select-all")
        operator.trigger("delete")
    elif len(operator.parts.document.shared.selection.features) > _MOST_COPIED:
        operator.trigger("select-none")
    else:
        operator.trigger(choice.choice(("copy", "cut", "paste", "paste")))


def delete(operator: Operator, choice: random.Random) -> None:
    """Seldom all there is; a full map is thinned out."""
    if len(operator.parts.document.shared.selection.features) < 4 or _is_full(operator):
        choice.choice((lambda: operator.trigger("delete"), lambda: operator.key(_DELETE)))()


def _is_full(operator: Operator) -> bool:
    return len(operator.features()) > _MOST_FEATURES


def step_back(operator: Operator, choice: random.Random) -> None:
    for _ in range(choice.randint(1, 4)):
        operator.undo()
    for _ in range(choice.randint(0, 4)):
        operator.trigger("redo")


# Panels.


def type_attribute(operator: Operator, choice: random.Random) -> None:
    """Change one field of the attribute panel, by keys or by choosing."""
    form = operator.parts.attribute_panel._form
    if form is None:
        return
    fields = [one for one in form.findChildren(QWidget) if isinstance(one, QLineEdit | QComboBox)]
    fields = [one for one in fields if one.isEnabled() and one.isVisible()]
    if not fields:
        return
    field = choice.choice(fields)
    if isinstance(field, QComboBox):
        _choose_in(field, choice)
        return
    field.setFocus()
    field.selectAll()
    _type(field, choice.choice(_LETTERS))
    if choice.random() < 0.7:
        QTest.keyClick(field, Qt.Key.Key_Return)
    operator.view.setFocus()


def _type(field: QLineEdit, letters: str) -> None:
    """Type letters; those without a key come at once, as an input method sends them."""
    if letters.isascii():
        QTest.keyClicks(field, letters)
    else:
        field.insert(letters)


def _choose_in(box: QComboBox, choice: random.Random) -> None:
    if box.count():
        index = choice.randrange(box.count())
        box.setCurrentIndex(index)
        box.activated.emit(index)


def use_table(operator: Operator, choice: random.Random) -> None:
    """Show or hide the table, mark rows, filter them, sort them."""
    table = operator.parts.feature_table
    if not table.isVisible() or choice.random() < 0.2:
        operator.trigger("panel-features")
        return
    rows = table.findChild(QTableView)
    what = choice.randrange(5)
    if what == 0 and rows.model().rowCount():
        rows.selectRow(choice.randrange(rows.model().rowCount()))
    elif what == 1:
        table.findChild(QLineEdit, "words").setText(choice.choice(("", "curb", "縁石", "sign")))
    elif what == 2:
        _choose_in(table.findChild(QComboBox, choice.choice(("kind", "status"))), choice)
    elif what == 3:
        table.findChild(QCheckBox, "occluded").setChecked(choice.random() < 0.3)
    else:
        rows.sortByColumn(
            choice.randrange(rows.model().columnCount()), choice.choice(list(Qt.SortOrder))
        )


def hide_kinds(operator: Operator, choice: random.Random) -> None:
    kinds = {feature.kind for feature in operator.features()}
    hidden = frozenset(one for one in sorted(kinds) if choice.random() < 0.2)
    operator.parts.document.shared.view_settings.hide_kinds(hidden)


# Looking.


def look_elsewhere(operator: Operator, choice: random.Random) -> None:
    modifiers = choice.choice((FREE, FREE, SHIFT, CTRL))
    operator.wheel(operator.some_spot(choice), choice.choice((-3, -1, 1, 3)), modifiers)


def look_at_all(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(("everything", "center")))
    if choice.random() < 0.5:
        operator.view.show_one_to_one()


def snap_to(operator: Operator, choice: random.Random) -> None:
    operator.trigger(f"snap-{choice.choice(_SNAPS)}")


def work_on_plane(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice(_PLANES))


def change_look(operator: Operator, choice: random.Random) -> None:
    settings = operator.parts.document.shared.view_settings
    drive = operator.parts.document.drive(settings.drive_id)
    chosen = choice.choice((*available(drive), *drive.image_kinds))
    if isinstance(chosen, ImageKind):
        operator.trigger(f"image-{chosen.value}")
    elif chosen in POINT_FEATURES:  # they have no actions, only entries above the image
        settings.change_look(attribute=chosen)
    else:
        operator.trigger(f"show-{chosen}")


def change_drive(operator: Operator, choice: random.Random) -> None:
    drive = choice.choice(operator.parts.document.drives())
    operator.parts.project_tree.drive_chosen.emit(drive.id)


def change_theme(operator: Operator, choice: random.Random) -> None:
    operator.trigger(choice.choice((*_THEMES, "side-by-side", "top-view", "along-view")))


def change_language(operator: Operator, choice: random.Random) -> None:
    wanted = "en" if operator.parts.language == "ja" else "ja"
    operator.trigger(f"language-{wanted}")
    window = operator.parts.window
    operator.wait(lambda: operator.parts.language == wanted and window.updatesEnabled())


def open_palette(operator: Operator, choice: random.Random) -> None:
    """Open a palette, choose a kind by its name or leave."""
    operator.trigger("choose-kind")
    operator.settle()
    for dialog in operator.parts.window.findChildren(QDialog):
        if dialog.isVisible():
            line = dialog.findChild(QLineEdit)
            _type(line, choice.choice(("curb", "sign", "縁石", "tree")))
            QTest.keyClick(line, choice.choice((Qt.Key.Key_Return, Qt.Key.Key_Escape)))
            dialog.close()
    operator.view.setFocus()


# The project.


def run_tool(operator: Operator, choice: random.Random) -> None:
    """Start a run that goes on in the background while other things are done."""
    document = operator.parts.document
    if not operator.parts.jobs.is_busy:
        tool = choice.choice(sorted(registry.TOOLS))
        parameters = registry.TOOLS[tool].parameters()
        document.start_run(tool, document.shared.view_settings.drive_id, parameters)


def reopen(operator: Operator, choice: random.Random) -> None:
    """Close the project, whatever is being done, and open it again."""
    operator.trigger("close")
    assert operator.parts.document.open(operator.project)


OFTEN: tuple[OperatorAction, ...] = (
    *(take_tool, take_tool, take_kind, click_anywhere, click_anywhere, click_anywhere),
    *(click_on_vertex, click_on_vertex, click_on_line, click_on_line),
    *(draw_some, draw_some, draw_some, draw_some, put_points, put_points),
    *(end_drawing, end_drawing, close_drawing, press_right, double_click),
)
EDITING: tuple[OperatorAction, ...] = (
    *(drag_vertex, drag_vertex, hold_vertex, drag_box, drag_features, edit_lines, edit_lines),
    *(judge, choose, choose, cut_and_paste, cut_and_paste, delete, step_back, step_back),
    *(type_attribute, type_attribute, use_table, use_table, hide_kinds),
)
LOOKING: tuple[OperatorAction, ...] = (
    *(look_elsewhere, look_elsewhere, look_elsewhere, look_at_all, snap_to, work_on_plane),
    *(change_look, change_drive, open_palette, stand_otherwise, stand_otherwise, review),
)
SELDOM: tuple[OperatorAction, ...] = (click_in_3d, change_theme, change_language, run_tool, reopen)


def any_action(choice: random.Random) -> OperatorAction:
    """One of them, as often as in a day's work."""
    share = choice.random()
    if share < 0.50:
        return choice.choice(OFTEN)
    if share < 0.80:
        return choice.choice(EDITING)
    return choice.choice(LOOKING if share < 0.96 else SELDOM)
