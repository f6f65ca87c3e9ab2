"""Wiring of the views beside the image: section, camera and map tell each other where they are."""

from __future__ import annotations

from app.window_parts import WindowParts


def connect_views(parts: WindowParts) -> None:
    """Connect the views with each other and with the window; again for new ones."""
    section = parts.section_view
    section.told.connect(parts.status_line.show_message)
    section.settings_changed.connect(parts.settings.remember_section)
