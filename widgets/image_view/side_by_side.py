"""ImageViews: one to three images beside each other, which show the same stretch of the street."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt, Signal
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.text import Language
from processing.image.attributes.tile_cache import TileCache
from processing.recording.drive import Drive
from widgets.image_view.orientation.locked_scrolling import following, is_opposite
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.panes import Pane, PaneHeader, SecondaryImage, ShownImage
from widgets.image_view.view import ImageView
from widgets.mouse_tools.mouse_tool import MouseTool
from widgets.pictures.image_view_settings import ImageViewSettings
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.own_settings import OwnSettings
from widgets.shared.shared_state import SharedState

MOST = 3

_TAKES = (
    QEvent.Type.MouseButtonPress,
    QEvent.Type.Wheel,
    QEvent.Type.KeyPress,
    QEvent.Type.FocusIn,
)


class ImageViews(QWidget):
    """Holds image views in a splitter; the main one follows the shared settings.

    The others have a drive, a kind, an attribute and sides of their own; cursor, selection and
    sketch are shared. Streets that run from left to right stand one above the other, streets that
    go up beside each other, so that one place of the street is on one line.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    tiles : TileCache
    language : Language

    Signals
    -------
    open_requested, import_requested, sharpened, features_placed
        Of the main image.
    menu_requested(wish: MenuRequest)
        Of any image.
    images_changed()
        An image was added or closed, or shows something else.
    """

    open_requested = Signal()
    import_requested = Signal()
    sharpened = Signal()
    features_placed = Signal()
    menu_requested = Signal(object)
    images_changed = Signal()

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        tiles: TileCache,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._tiles = tiles
        self._language: Language = language
        self._tool: MouseTool | None = None
        self._is_locked = True
        self._splitter = QSplitter(self)
        self._splitter.setChildrenCollapsible(False)
        self._beside: list[SecondaryImage] = []
        self._main = ImageView(source, shared, tiles, language=language)
        self._active = self._main
        self._adopt(self._main)
        choice = ImageViewSettings(
            source, shared.map_changes, shared.view_settings, language=language
        )
        self._main_header = PaneHeader(choice)
        self._splitter.addWidget(Pane(self._main, self._main_header))
        self._main.open_requested.connect(self.open_requested)
        self._main.import_requested.connect(self.import_requested)
        self._main.sharpened.connect(self.sharpened)
        self._main.features_placed.connect(self.features_placed)
        self.setFocusProxy(self._main)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._splitter)
        shared.view_settings.image_orientation_changed.connect(self._stand)
        shared.view_settings.image_changed.connect(self._on_settings_image_changed)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        self._main_header.close_button.hide()
        self._main_header.hide()
        self._stand()

    # What is held.

    @property
    def main(self) -> ImageView:
        """The image that follows the shared settings."""
        return self._main

    @property
    def active(self) -> ImageView:
        """The image that was clicked, turned or pushed last."""
        return self._active

    @property
    def views(self) -> tuple[ImageView, ...]:
        """All images, the main one first."""
        return (self._main, *(one.view for one in self._beside))

    @property
    def images(self) -> tuple[ShownImage, ...]:
        """What the images beside the main one show, to be given to :meth:`arrange`."""
        return tuple(one.shown for one in self._beside)

    @property
    def can_add(self) -> bool:
        """Whether there is room for one more image."""
        return bool(self._source.drives()) and len(self.views) < MOST

    @property
    def is_locked(self) -> bool:
        """Whether all images show the same stretch of the street."""
        return self._is_locked

    def lock(self, is_locked: bool) -> None:  # noqa: FBT001 - a slot of a checked action
        """Let all images follow the one that is moved, or let each go its way."""
        self._is_locked = is_locked
        self._follow(self._active)

    def add(self, shown: ShownImage | None = None) -> ImageView | None:
        """Put one more image beside the others; None when there is no room.

        Parameters
        ----------
        shown : ShownImage, optional
            Otherwise the next drive that isn't shown, or the same drive by another attribute.
        """
        if not self.can_add:
            return None
        one = self._make_image()
        one.show_image(self._next() if shown is None else shown)
        self._beside.append(one)
        self._adopt(one.view)
        one.view.set_mouse_tool(self._tool)
        one.pane.header.closed.connect(lambda: self.close_image(one.view))
        settings = one.settings
        for signal in (
            settings.image_changed,
            settings.look_changed,
            settings.image_orientation_changed,
        ):
            signal.connect(self._on_beside_changed)
        self._splitter.addWidget(one.pane)
        self._share()
        return one.view

    def show_beside(self, drive_id: str) -> ImageView | None:
        """Show another drive's image beside; where there is no room, in place of the last one.

        A drive that went the other way is turned about, so that the street runs as in the first.
        """
        shown = next((one for one in self._beside if one.shown.drive_id == drive_id), None)
        if shown is not None or drive_id not in {drive.id for drive in self._source.drives()}:
            return None if shown is None else shown.view
        if not self.can_add and self._beside:
            self.close_image(self._beside[-1].view)
        return self.add(self._image_of(self._source.drive(drive_id)))

    def close_image(self, view: ImageView) -> None:
        """Take an image away; the main one stays."""
        for one in [one for one in self._beside if one.view is view]:
            self._beside.remove(one)
            if self._active is view:
                self._active = self._main
            one.pane.setParent(None)
            one.pane.deleteLater()
            self._share()

    def arrange(self, images: tuple[ShownImage, ...]) -> None:
        """Show exactly these beside the main one, but for those of drives that aren't there."""
        for view in self.views[1:]:
            self.close_image(view)
        drives = {drive.id for drive in self._source.drives()}
        for shown in images:
            if shown.drive_id in drives:
                self.add(shown)

    # What an image view is asked as well.

    @property
    def viewport(self) -> Viewport:
        """What the active image shows, and how large."""
        return self._active.viewport

    @property
    def picture(self) -> OrientedImage | None:
        """What the active image shows; None while it is empty."""
        return self._active.picture

    def set_mouse_tool(self, tool: MouseTool | None) -> None:
        """Tell this tool from now on what the mouse does in any image."""
        self._tool = tool
        self._each(lambda view: view.set_mouse_tool(tool))

    def look_through(self, viewport: Viewport) -> None:
        """Show this part of the active image, as large."""
        self._active.look_through(viewport)

    def show_everything(self) -> None:
        """Show the whole drive."""
        self._each(lambda view: view.show_everything())

    def show_one_to_one(self) -> None:
        """Show one pixel of the active image on one of the screen."""
        self._active.show_one_to_one()

    def zoom_by(self, factor: float) -> None:
        """Zoom about the middle of the active image."""
        self._active.zoom_by(factor)

    def center_on(self, position: PickedPosition) -> None:
        """Put a place in the middle of every image that has it."""
        self._each(lambda view: view.center_on(position))

    def center_on_selection(self) -> None:
        """Put the chosen features in the middle, or the cursor when none is chosen."""
        self._each(lambda view: view.center_on_selection())

    def position_of(self, position: PickedPosition) -> QPointF | None:
        """Where a place is in the active image, in this widget; None when it isn't there."""
        at = self._active.position_of(position)
        return None if at is None else at + QPointF(self._active.mapTo(self, QPoint(0, 0)))

    # Events.

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in _TAKES and isinstance(watched, ImageView):
            self._active = watched
        return super().eventFilter(watched, event)

    # What others tell.

    def _on_settings_image_changed(self) -> None:
        # The main image has changed by now: it was connected before.
        self._follow(self._active)

    def _on_beside_changed(self) -> None:
        self._follow(self._active)
        self.images_changed.emit()

    def _on_map_drives_changed(self) -> None:
        drives = {drive.id for drive in self._source.drives()}
        for one in tuple(self._beside):
            if one.shown.drive_id not in drives:
                self.close_image(one.view)
        self.images_changed.emit()

    # What is done in more than one place.

    def _adopt(self, view: ImageView) -> None:
        view.installEventFilter(self)
        view.menu_requested.connect(self.menu_requested)
        view.looked.connect(lambda: self._follow(view))

    def _follow(self, leader: ImageView) -> None:
        """Let the others show what the active image shows."""
        if leader is not self._active or not self._is_locked or not self._beside:
            return
        if leader.picture is None:
            return
        for view in self.views:
            if view is not leader and view.picture is not None:
                found = following(leader.picture, leader.viewport, view.picture, view.viewport)
                if found is not None and found != view.viewport:
                    view.look_through(found)

    def _each(self, act: Callable[[ImageView], None]) -> None:
        # The active one last: the others follow it.
        for view in sorted(self.views, key=lambda view: view is self._active):
            act(view)

    def _next(self) -> ShownImage:
        settings = self._shared.view_settings
        drives = self._source.drives()
        seen = {settings.drive_id, *(one.shown.drive_id for one in self._beside)}
        drive = next((drive for drive in drives if drive.id not in seen), None)
        if drive is None:
            kind, look = settings.image_kind, settings.look
            attribute = "height" if look.attribute != "height" else "intensity"
            return ShownImage(settings.drive_id, kind, attribute, settings.image_orientation)
        return self._image_of(drive)

    def _image_of(self, drive: Drive) -> ShownImage:
        """As the main one is shown; turned about where the drive went the other way."""
        settings, kinds = self._shared.view_settings, drive.image_kinds
        attribute = settings.look.attribute
        kind = settings.image_kind if settings.image_kind in kinds else kinds[0]
        orientation, main = settings.image_orientation, self._main.picture
        if main is not None and is_opposite(main, self._main.viewport.centre, drive, kind):
            orientation = replace(
                orientation,
                is_reversed_along=not orientation.is_reversed_along,
                is_mirrored_across=not orientation.is_mirrored_across,
            )
        return ShownImage(drive.id, kind, attribute, orientation)

    def _stand(self) -> None:
        is_vertical = self._shared.view_settings.image_orientation.is_vertical
        along = Qt.Orientation.Horizontal if is_vertical else Qt.Orientation.Vertical
        self._splitter.setOrientation(along)

    def _make_image(self) -> SecondaryImage:
        source, changes = self._source, self._shared.map_changes
        own = OwnSettings(self._shared.view_settings)
        shared = replace(self._shared, view_settings=own.settings)
        view = ImageView(source, shared, self._tiles, language=self._language)
        choice = ImageViewSettings(source, changes, own.settings, language=self._language)
        pane = Pane(view, PaneHeader(choice))
        own.setParent(pane)
        return SecondaryImage(pane, own.settings)

    def _share(self) -> None:
        """Give all images the same room, and lines that say what they show if there are several."""
        self._main_header.setVisible(bool(self._beside))
        self._splitter.setSizes([1000] * self._splitter.count())
        self.images_changed.emit()
