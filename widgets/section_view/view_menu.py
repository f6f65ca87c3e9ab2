"""What the right button offers in a section beside what every view does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QMenu

from widgets.section_view.picture.settings import EXAGGERATIONS, SectionSettings


def add_settings(
    menu: QMenu, settings: SectionSettings, choose: Callable[[SectionSettings], None]
) -> None:
    """Offer what is shown and how; what was chosen is told as the settings then wanted."""
    colours = menu.addAction(
        QCoreApplication.translate("SectionMenu", "Colour by distance from the plane")
    )
    colours.setCheckable(True)
    colours.setChecked(settings.is_by_distance)
    colours.toggled.connect(lambda is_on: choose(replace(settings, is_by_distance=is_on)))
    ground = menu.addAction(QCoreApplication.translate("SectionMenu", "Line of the found ground"))
    ground.setCheckable(True)
    ground.setChecked(settings.shows_ground)
    ground.toggled.connect(lambda is_on: choose(replace(settings, shows_ground=is_on)))
    diagnostics = menu.addAction(QCoreApplication.translate("SectionMenu", "Scanline and tests"))
    diagnostics.setCheckable(True)
    diagnostics.setChecked(settings.shows_diagnostics)
    diagnostics.toggled.connect(lambda is_on: choose(replace(settings, shows_diagnostics=is_on)))
    waveforms = menu.addAction(
        QCoreApplication.translate("SectionMenu", "Waveforms along their rays")
    )
    waveforms.setCheckable(True)
    waveforms.setChecked(settings.shows_waveforms)
    waveforms.toggled.connect(lambda is_on: choose(replace(settings, shows_waveforms=is_on)))
    heights = menu.addMenu(QCoreApplication.translate("SectionMenu", "Heights"))
    for factor in EXAGGERATIONS:
        entry = heights.addAction(f"{factor:g}×")
        entry.setCheckable(True)
        entry.setChecked(factor == settings.exaggeration)
        wanted = replace(settings, exaggeration=factor)
        entry.triggered.connect(lambda _, wanted=wanted: choose(wanted))
