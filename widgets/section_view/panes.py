"""SectionPanes: the picture of a section, or two of them while a place is held."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QSplitter, QWidget
from typing_extensions import override

from processing.core.text import Language
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.section_view.lines import SectionLines
from widgets.section_view.pane import SectionPane
from widgets.section_view.picture.section_position import SectionPosition
from widgets.section_view.picture.settings import SectionSettings
from widgets.section_view.pinned import PinnedSections
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_LEAST_WIDE_PX = 300


class SectionPanes(QSplitter):
    """Both pictures; the second one is there only while a place is held.

    They stand side by side, in a narrow dock one above the other.

    Attributes
    ----------
    all : tuple of SectionPane
        The first and the second, shown or not.
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        lines: SectionLines,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setChildrenCollapsible(False)
        first, second = (
            SectionPane(source, shared, lines, self, language=language) for _ in range(2)
        )
        self.all = (first, second)
        for pane in self.all:
            self.addWidget(pane)
        second.hide()
        self.setFocusProxy(first)

    @property
    def shown(self) -> tuple[SectionPane, ...]:
        """One, or two while a place is held."""
        return self.all if self.all[0].is_pinned else self.all[:1]

    def show_one(self, standing: SectionPosition | None) -> None:
        """Show one section; None: nothing."""
        self._be_pinned(is_pinned=False)
        self.all[0].show_standing(standing)
        self.all[1].show_standing(None)

    def show_two(self, pinned: PinnedSections) -> None:
        """Show a place across its line and along it."""
        self._be_pinned(is_pinned=True)
        self.all[0].show_standing(pinned.across)
        self.all[1].show_standing(pinned.along)

    def use_settings(self, settings: SectionSettings) -> None:
        """Colour points and draw heights like this."""
        for pane in self.all:
            pane.use_settings(settings)

    def use_tool_parameters(self, parameters: Mapping[str, object]) -> None:
        """Show what tools look at with these parameters, by their ids."""
        for pane in self.all:
            pane.use_tool_parameters(parameters)

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does."""
        for pane in self.all:
            pane.set_mouse_tool(tool)

    def are_clicked_at(self, position: PickedPosition) -> bool:
        """Whether a place is being clicked here just now, within the slab that is shown."""
        for pane in self.shown:
            if pane.is_clicking and pane.cut is not None:
                return bool(pane.cut.holds(pane.cut.to_section([position.xyz]))[0])
        return False

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        is_wide = self.width() >= 2 * _LEAST_WIDE_PX
        standing = Qt.Orientation.Horizontal if is_wide else Qt.Orientation.Vertical
        if standing != self.orientation():
            self.setOrientation(standing)
        super().resizeEvent(event)

    def take_down(self) -> None:
        """Stop looking for points; may be called again."""
        for pane in self.all:
            pane.close()

    def _be_pinned(self, *, is_pinned: bool) -> None:
        for pane in self.all:
            pane.is_pinned = is_pinned
        self.all[1].setVisible(is_pinned)
