"""Wiring of templates: drawn in the section, kept in the panel, fitted along the street."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from app.layout.panel_room import make_room
from app.window.window_parts import WindowParts
from processing.section.cut import Cut
from widgets.mouse_tools.drawing.draw_template import DrawnProfile, DrawTemplate, TemplatePart

_TOOLS = {TemplatePart.SHAPE: "template", TemplatePart.EMPTY_ZONE: "template-zone"}

_TEMPLATES_PX = 600


def connect_templates(parts: WindowParts) -> None:
    """Connect panel, section and tools; again for new widgets."""
    wiring = _TemplateWiring(parts)
    panel, section, document = parts.template_panel, parts.section_view, parts.document
    section.cut_changed.connect(wiring.on_section_cut_changed)
    section.template_requested.connect(wiring.on_section_template_requested)
    for tool in parts.toolbox.tools_of(DrawTemplate):
        tool.drawn.connect(wiring.on_tool_drawn)
    panel.draw_requested.connect(wiring.on_panel_draw_requested)
    panel.fit_requested.connect(wiring.on_panel_fit_requested)
    panel.refused.connect(document.refused)
    panel.reported.connect(parts.status_line.show_message)
    parts.toolbox.kind_chosen.connect(panel.use_kind)
    for changed in (document.opened, document.closed, document.catalogue_changed):
        changed.connect(panel.read_project)
    panel.read_project()
    wiring.on_section_cut_changed(section.cut)


class _TemplateWiring(QObject):
    """What has to be translated between the section, the tools and the panel."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._when_laid_out = QTimer(self, singleShot=True)
        self._when_laid_out.timeout.connect(self._make_room)

    def on_section_cut_changed(self, cut: Cut | None) -> None:
        self._parts.template_panel.use_cut(cut)
        for tool in self._parts.toolbox.tools_of(DrawTemplate):
            tool.use_cut(cut)

    def on_section_template_requested(self) -> None:
        self._show_panel()

    def on_panel_draw_requested(self, part: TemplatePart) -> None:
        self._parts.view_docks.show_view("section")
        self._parts.toolbox.choose(_TOOLS[part])

    def on_tool_drawn(self, drawn: DrawnProfile) -> None:
        self._show_panel()
        self._parts.template_panel.take_drawn(drawn)
        self._parts.toolbox.choose("select")

    def on_panel_fit_requested(self, drive: str, parameters: object) -> None:
        self._parts.document.start_run("template", drive, parameters)

    def _show_panel(self) -> None:
        panel = self._parts.template_panel
        was_shown = panel.isVisible()
        self._parts.window.show_panel("templates")
        if not was_shown:
            self._when_laid_out.start()

    def _make_room(self) -> None:
        make_room(self._parts.window, "templates", _TEMPLATES_PX)
