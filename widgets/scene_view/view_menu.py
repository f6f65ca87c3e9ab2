"""The 3D view's own part of the context menu."""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QCoreApplication
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QWidget, QWidgetAction

from widgets.scene_view.clipping import ClipChoice, Clipping
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.slab_form import SlabForm


class SceneViewCommands(Protocol):
    """What the menu does with the view."""

    @property
    def camera(self) -> SceneCamera:
        """From where it looks."""

    @property
    def clipping(self) -> Clipping:
        """Which part of space is shown."""

    def look_along_drive(self) -> None:
        """Look along the drive."""

    def look_from_above(self) -> None:
        """Look straight down."""

    def show_everything(self) -> None:
        """Show all."""

    def center_on_selection(self) -> None:
        """Put what is chosen into the middle."""

    def set_shading(self, *, is_on: bool) -> None:
        """Turn eye-dome lighting on or off."""

    def set_perspective(self, *, is_on: bool) -> None:
        """Draw far things smaller, or not."""


def view_menu(parent: QWidget, view: SceneViewCommands, *, is_shading_wanted: bool) -> QMenu:
    """From where one can look, and at what; it goes when it was closed."""

    def shade(is_on: bool) -> None:  # noqa: FBT001 - Qt's signal
        view.set_shading(is_on=is_on)

    def flatten(is_on: bool) -> None:  # noqa: FBT001 - Qt's signal
        view.set_perspective(is_on=not is_on)

    menu = QMenu(parent)
    menu.addAction(
        QCoreApplication.translate("SceneView", "Along the drive"), view.look_along_drive
    )
    menu.addAction(QCoreApplication.translate("SceneView", "From above"), view.look_from_above)
    menu.addAction(QCoreApplication.translate("SceneView", "Show everything"), view.show_everything)
    menu.addAction(
        QCoreApplication.translate("SceneView", "Centre on the selection"), view.center_on_selection
    )
    menu.addSeparator()
    flat = menu.addAction(QCoreApplication.translate("SceneView", "Without perspective"))
    _make_checkable(flat, is_checked=view.camera.is_parallel)
    flat.toggled.connect(flatten)
    shading = menu.addAction(
        QCoreApplication.translate("SceneView", "Shade by depth (eye-dome lighting)")
    )
    _make_checkable(shading, is_checked=is_shading_wanted)
    shading.toggled.connect(shade)
    _add_clipping(menu, view.clipping)
    menu.aboutToHide.connect(menu.deleteLater)
    return menu


def _add_clipping(menu: QMenu, clipping: Clipping) -> None:
    part = menu.addMenu(QCoreApplication.translate("SceneView", "Show only"))
    texts = {
        ClipChoice.EVERYTHING: QCoreApplication.translate("SceneView", "All points"),
        ClipChoice.SELECTION: QCoreApplication.translate("SceneView", "Around what is chosen"),
        ClipChoice.SECTION: QCoreApplication.translate("SceneView", "Within the section"),
        ClipChoice.DRIVE: QCoreApplication.translate("SceneView", "Around the drive"),
    }
    group = QActionGroup(part)
    for choice, text in texts.items():
        action = QAction(text, part)
        _make_checkable(action, is_checked=clipping.choice is choice)
        action.setEnabled(clipping.can_choose(choice))
        action.triggered.connect(lambda _=False, wanted=choice: clipping.choose(wanted))
        group.addAction(action)
        part.addAction(action)
    reach = QWidgetAction(part)
    reach.setDefaultWidget(SlabForm(clipping, part))
    reach.setEnabled(clipping.can_choose(ClipChoice.DRIVE))
    part.addAction(reach)


def _make_checkable(action: QAction, *, is_checked: bool) -> None:
    action.setCheckable(True)
    action.setChecked(is_checked)
