"""ProcessingPanel: every processing tool by group, its settings, and the button that runs it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QSplitter,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)
from typing_extensions import override

from processing.core.parameters import ParameterValue
from processing.core.text import Language, Text
from processing.tools.listed.registry import tools_of_drives
from processing.tools.tool import Tool
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.panels.tree_items import children_of
from widgets.parts.literal_text import literal
from widgets.parts.search_field import SearchField
from widgets.pictures.parameter_picture import ParameterPicture

Reason = Callable[[str], Text | None]
"""From a tool's id to why it can't run now, or None."""

_ID = Qt.ItemDataRole.UserRole
_LEAST_HIGH_PX = 40
"""Of list and form: both can be scrolled, and low screens have other panels too."""

_PICTURE_PX = 380
"""In a lower panel the fields need the room of the pictures."""

_BOTH_PX = 560
"""From this height on the list stays open above the form; below it is opened to choose."""


class ProcessingPanel(QWidget):
    """Choose a tool, set it, run it.

    Parameters
    ----------
    language : Language
    tools : mapping of str to Tool, optional
        What can be chosen; every tool of the program that runs on a drive.

    Signals
    -------
    run_requested(tool: str, parameters: object)
        The tool's id and its frozen parameters.
    values_changed
        A tool is set otherwise.
    """

    run_requested = Signal(str, object)
    values_changed = Signal()

    def __init__(
        self,
        language: Language,
        tools: Mapping[str, Tool] | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._language = language
        self._tools = tools_of_drives() if tools is None else tools
        self._reason: Reason | None = None
        self._remark: Reason | None = None
        self._forms: dict[str, ParameterForm] = {}
        self._has_pictures = False
        self._open_list = QToolButton(self)
        self._open_list.setToolTip(self.tr("Choose another tool"))
        self._open_list.setArrowType(Qt.ArrowType.DownArrow)
        self._open_list.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self._open_list.setCheckable(True)
        self._open_list.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._open_list.toggled.connect(self._share_room)
        self._list = QTreeWidget(self)
        self._search = SearchField(self._list, self)
        self._search.setPlaceholderText(self.tr("Search for a tool"))
        self._list.setHeaderHidden(True)
        self._list.setRootIsDecorated(False)
        self._list.setIndentation(12)
        self._list.setMinimumHeight(_LEAST_HIGH_PX)
        self._explanation = QLabel(self)
        self._explanation.setWordWrap(True)
        self._scroll = QScrollArea(self)
        self._scroll.setWidgetResizable(True)
        self._scroll.setMinimumHeight(_LEAST_HIGH_PX)
        self._scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        self._scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._picture = ParameterPicture(self)
        self._why_not = QLabel(self)
        self._why_not.setWordWrap(True)
        self._run = QPushButton(self.tr("Run"), self)
        self._run.clicked.connect(self._on_run_clicked)
        self._lay_out()
        self._fill()
        self._search.textChanged.connect(self._on_search_text_changed)
        self._list.currentItemChanged.connect(self._on_list_current_item_changed)
        self._list.itemClicked.connect(self._on_list_item_clicked)
        self._choose_first()

    @property
    def tool(self) -> str:
        """Id of the chosen tool; empty when none is."""
        item = self._list.currentItem()
        return "" if item is None else str(item.data(0, _ID) or "")

    @property
    def form(self) -> ParameterForm | None:
        """The form of the chosen tool."""
        return self._forms.get(self.tool)

    def parameters_of(self, tool: str) -> object:
        """A tool's frozen parameters as its form has them, or its defaults."""
        form = self._forms.get(tool)
        return self._tools[tool].parameters() if form is None else form.value()

    def use_values(self, tool: str, values: Mapping[str, ParameterValue]) -> None:
        """Choose a tool and set some of its parameters.

        Raises
        ------
        OutOfRange
            As :meth:`ParameterForm.set_values`.
        """
        self.show_tool(tool)
        form = self._forms.get(tool)
        if form is not None:
            form.set_values(values)
            self.values_changed.emit()

    def run_tool(self, tool: str) -> bool:
        """Run a tool as its form stands, or by its defaults; says whether it can run now."""
        if self._reason is not None and self._reason(tool) is not None:
            return False
        self.run_requested.emit(tool, self.parameters_of(tool))
        return True

    def ask_reasons_from(self, reason: Reason) -> None:
        """Ask this whether a tool can run."""
        self._reason = reason
        self.refresh()

    def ask_remarks_from(self, remark: Reason) -> None:
        """Ask this what must be given for a tool that can run."""
        self._remark = remark
        self.refresh()

    def refresh(self) -> None:
        """Ask again whether the chosen tool can run: another drive is shown."""
        why_not = remark = None
        if self.tool and self._reason is not None:
            why_not = self._reason(self.tool)
        if self.tool and self._remark is not None:
            remark = self._remark(self.tool)
        self._run.setEnabled(bool(self.tool) and why_not is None)
        said = why_not or remark
        self._why_not.setText("" if said is None else said.in_language(self._language))
        self._why_not.setVisible(said is not None)

    def show_tool(self, tool: str) -> None:
        """Choose a tool, as if it had been clicked."""
        self._search.clear()
        self._open_list.setChecked(False)
        for item in self._items():
            if item.data(0, _ID) == tool:
                self._list.setCurrentItem(item)

    def _lay_out(self) -> None:
        inside = QWidget(self)
        self._inside = QVBoxLayout(inside)
        self._inside.setContentsMargins(0, 0, 4, 0)
        self._inside.setSpacing(8)
        self._inside.addWidget(self._explanation)
        self._inside.addStretch(1)
        self._scroll.setWidget(inside)
        self._choosing = QWidget(self)
        choosing = QVBoxLayout(self._choosing)
        choosing.setContentsMargins(0, 0, 0, 0)
        choosing.setSpacing(4)
        choosing.addWidget(self._search)
        choosing.addWidget(self._list, 1)
        self._form_side = QWidget(self)
        layout = QVBoxLayout(self._form_side)
        layout.setContentsMargins(0, 4, 0, 0)
        layout.setSpacing(4)
        layout.addWidget(self._scroll, 1)
        # Below what scrolls: it stays in sight whatever field is at hand.
        layout.addWidget(self._picture)
        layout.addWidget(self._why_not)
        layout.addWidget(self._run)
        halves = QSplitter(Qt.Orientation.Vertical, self)
        halves.setChildrenCollapsible(False)
        halves.addWidget(self._choosing)
        halves.addWidget(self._form_side)
        halves.setStretchFactor(0, 1)
        halves.setStretchFactor(1, 2)
        halves.setSizes([100, 200])
        whole = QVBoxLayout(self)
        whole.setContentsMargins(8, 8, 8, 8)
        whole.setSpacing(4)
        whole.addWidget(self._open_list)
        whole.addWidget(halves, 1)

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._share_room()

    def _share_room(self) -> None:
        """Show list and form above each other, or where that is too low the one or the other."""
        has_room = self.height() >= _BOTH_PX
        is_choosing = self._open_list.isChecked()
        self._picture.setVisible(self._has_pictures and self.height() >= _PICTURE_PX)
        self._open_list.setVisible(not has_room)
        self._choosing.setVisible(has_room or is_choosing)
        self._form_side.setVisible(has_room or not is_choosing)
        if is_choosing and not has_room:
            self._search.setFocus()

    def _fill(self) -> None:
        groups: dict[Text, QTreeWidgetItem] = {}
        for tool in self._tools.values():
            if tool.group not in groups:
                group = QTreeWidgetItem(self._list, [tool.group.in_language(self._language)])
                group.setFlags(Qt.ItemFlag.ItemIsEnabled)
                groups[tool.group] = group
            item = QTreeWidgetItem(groups[tool.group], [tool.name.in_language(self._language)])
            item.setData(0, _ID, tool.id)
            item.setToolTip(0, tool.explanation.in_language(self._language))
        self._list.expandAll()

    def _items(self) -> list[QTreeWidgetItem]:
        return [item for group in children_of(self._list) for item in children_of(group)]

    def _choose_first(self) -> None:
        visible = [item for item in self._items() if not item.isHidden()]
        if visible:
            self._list.setCurrentItem(visible[0])
        self._show_form()

    def _show_form(self) -> None:
        tool = self._tools.get(self.tool)
        if tool is None:
            self._explanation.clear()
            self.refresh()
            return
        self._explanation.setText(tool.explanation.in_language(self._language))
        self._open_list.setText(literal(tool.name.in_language(self._language)))
        if tool.id not in self._forms:
            self._forms[tool.id] = ParameterForm(tool.parameters, self._language)
            self._forms[tool.id].changed.connect(self.values_changed)
            self._forms[tool.id].pictured.connect(self._show_picture)
            self._inside.insertWidget(1, self._forms[tool.id])
        for form in self._forms.values():
            # Forms keep what was typed while another tool is looked at.
            form.setVisible(form is self._forms[tool.id])
        self._scroll.verticalScrollBar().setValue(0)
        self._show_picture(self._forms[tool.id].picture)
        self.refresh()

    def _show_picture(self, name: str) -> None:
        self._picture.show_picture(name)
        form = self.form
        # Room is kept for a form that has pictures at all, so that nothing jumps under the mouse.
        self._has_pictures = form is not None and form.has_pictures
        self._picture.setVisible(self._has_pictures and self.height() >= _PICTURE_PX)

    def _on_search_text_changed(self, words: str) -> None:
        wanted = words.lower().split()
        for item in self._items():
            tool = self._tools[str(item.data(0, _ID))]
            names = f"{tool.id} {tool.name.en} {tool.name.ja}".lower()
            item.setHidden(not all(word in names for word in wanted))
        for group in children_of(self._list):
            group.setHidden(all(item.isHidden() for item in children_of(group)))
        current = self._list.currentItem()
        if current is None or current.isHidden():
            self._choose_first()

    def _on_list_current_item_changed(self) -> None:
        if self.tool:
            self._show_form()

    def _on_list_item_clicked(self) -> None:
        if self.tool:
            self._open_list.setChecked(False)

    def _on_run_clicked(self) -> None:
        form = self.form
        if form is not None:
            self.run_requested.emit(self.tool, form.value())
