"""TileImages: tiles as pictures that can be painted at once; what is missing is asked for.

Painting never computes points: a tile that isn't there is requested from the loader, and
``changed`` tells when it has come. Until then the painter shows an older or a coarser one.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QColor, QImage

from processing.core.errors import UserError
from processing.image.attributes.attributes import SHOWS_LABELS
from processing.image.attributes.tile_cache import TileCache, TilePixels, TileRequest
from processing.image.search.touched_tiles import TouchedTiles
from processing.image.tiles.tiles import TileKey
from processing.recording.kinds import ImageKind
from widgets.feature_drawing.feature_style import ACCENT
from widgets.image_view.orientation.oriented_image import OrientedImage
from widgets.shared.view_settings import PointStyle

MOST_BYTES = 96 * 2**20
THINNINGS = (1, 2, 4, 8)
"""How many columns of a tile may become one; a street is some six times denser across."""

_TINT_SHARE = 0.65

_Slot = tuple[str, ImageKind, TileKey, int]


@dataclass(frozen=True)
class _Made:
    """A picture of a tile and what it was made for."""

    token: tuple[object, ...]
    image: QImage


class TileImages(QObject):
    """Pictures of tiles, the least used thrown away; lives on the window's thread.

    Parameters
    ----------
    tiles : TileCache
        Loads and colours tiles in its own threads.
    limit_bytes : int
        What the pictures may hold together.
    """

    changed = Signal()
    # Sent by a loader's thread:
    _arrived = Signal(object, object)  # TileRequest, TilePixels
    _refused = Signal()

    def __init__(self, tiles: TileCache, *, limit_bytes: int = MOST_BYTES) -> None:
        super().__init__()
        self._tiles = tiles
        self._limit_bytes = limit_bytes
        self._picture: OrientedImage | None = None
        self._look = PointStyle()
        self._made: OrderedDict[_Slot, _Made] = OrderedDict()
        self._bytes = 0
        self._chosen = np.empty(0, np.int64)
        self._chosen_in: OrientedImage | None = None
        self._age = 0
        self._is_complete = False
        self._version = 0
        self._arrived.connect(self._on_arrived, Qt.ConnectionType.QueuedConnection)
        self._refused.connect(self.changed, Qt.ConnectionType.QueuedConnection)

    @property
    def refusal(self) -> UserError | None:
        """Why the drive can't be shown by the attribute, once that is known."""
        if self._picture is None:
            return None
        return self._tiles.refusal(self._picture.drive.id, self._look.attribute)

    @property
    def version(self) -> int:
        """Counts whenever a picture is made."""
        return self._version

    @property
    def is_complete(self) -> bool:
        """Whether all tiles asked for last were there, in the look of now."""
        return self._is_complete

    def show(self, picture: OrientedImage | None, look: PointStyle) -> None:
        """Make pictures of this image in this look from now on."""
        self._picture, self._look = picture, look

    def tint(self, points: NDArray[np.int64]) -> None:
        """Mark points of the drive shown, (n,) sorted."""
        before, was_in = self._chosen, self._chosen_in
        self._chosen, self._chosen_in = points, self._picture
        if not points.size and not before.size:
            return
        if was_in is self._picture:
            self.make_touched_anew(np.setxor1d(before, points, assume_unique=True))
        else:
            self._age += 1

    def make_anew(self) -> None:
        """What tiles show has changed; the old pictures stay until the new ones are there."""
        self._age += 1

    def make_touched_anew(self, points: NDArray[np.int64]) -> None:
        """What tiles show of these points of the drive shown has changed."""
        picture = self._picture
        if picture is None or not points.size:
            return
        shown, touched = (picture.drive.id, picture.image.kind), TouchedTiles(picture.image, points)
        for slot, made in self._made.items():
            if slot[:2] != shown or slot[2] in touched:
                self._made[slot] = replace(made, token=())

    def show_labels(self, drive_id: str, points: NDArray[np.int64]) -> None:
        """The labels of these points of a drive have changed."""
        picture, touched = self._picture, None
        if picture is not None and picture.drive.id == drive_id and self._look.follows_labels:
            touched = TouchedTiles(picture.image, points)
        for slot, made in self._made.items():
            is_old = slot[0] == drive_id and made.token[:1] == (True,)
            if picture is not None and touched is not None and slot[1] is picture.image.kind:
                is_old &= slot[2] in touched
            if is_old:
                self._made[slot] = replace(made, token=())
        if touched is not None:
            self.changed.emit()

    def forget(self) -> None:
        """Drop all pictures."""
        self._made.clear()
        self._bytes = 0

    def images(
        self, keys: Sequence[TileKey], thinning: int = 1, ahead: Sequence[TileKey] = ()
    ) -> dict[TileKey, QImage]:
        """Pictures of tiles as far as there are any; the rest is asked for, the first ones first.

        Parameters
        ----------
        thinning : int
            So many columns of a tile become one, by their mean.
        ahead : sequence of TileKey
            What may be looked at next: loaded once the others are there.
        """
        picture = self._picture
        if picture is None:
            return {}
        found: dict[TileKey, QImage] = {}
        missing: list[TileRequest] = []
        for key in keys:
            request = self._request_for(picture, key)
            slot = (picture.drive.id, picture.image.kind, key, thinning)
            made = self._made.get(slot)
            if made is not None and made.token == self._token(request):
                self._made.move_to_end(slot)
            else:
                pixels = self._tiles.get(request)
                if pixels is None:
                    missing.append(request)
                else:
                    made = self._keep(slot, request, self._draw_tile(picture, pixels))
            if made is not None:
                found[key] = made.image
        self._is_complete = not missing
        self._tiles.keep_only(self._report, frozenset(missing))
        for request in reversed(missing):  # the loader serves the newest first
            self._tiles.request(request, self._report, self._report_refusal)
        if not missing:
            self._load_ahead([self._request_for(picture, key) for key in ahead])
        return found

    def _load_ahead(self, requests: list[TileRequest]) -> None:
        lacking = [request for request in requests if self._tiles.get(request) is None]
        self._tiles.keep_only(self._have_ahead, frozenset(lacking))
        for request in lacking:
            self._tiles.request(request, self._have_ahead)

    def available(self, key: TileKey) -> QImage | None:
        """The picture of a tile if there is one or its points are there; asks for nothing."""
        picture = self._picture
        if picture is None:
            return None
        for thinning in THINNINGS:
            slot = (picture.drive.id, picture.image.kind, key, thinning)
            if slot in self._made:
                self._made.move_to_end(slot)
                return self._made[slot].image
        request = self._request_for(picture, key)
        pixels = self._tiles.get(request)
        if pixels is None:
            return None
        return self._keep((*slot[:3], 1), request, self._draw_tile(picture, pixels)).image

    def _have_ahead(self, request: TileRequest, pixels: TilePixels) -> None:
        """Tiles loaded ahead are found when they are looked at."""

    def _report(self, request: TileRequest, pixels: TilePixels) -> None:
        self._arrived.emit(request, pixels)

    def _report_refusal(self, request: TileRequest, refusal: UserError) -> None:  # noqa: ARG002
        # What was refused is asked for when it is painted.
        self._refused.emit()

    def _on_arrived(self, request: TileRequest, pixels: TilePixels) -> None:
        picture = self._picture
        if picture is not None and request == self._request_for(picture, request.key):
            # One that became old on its way is looked up, or asked for, when it is painted.
            if self._tiles.is_current(request, pixels):
                slot = (picture.drive.id, picture.image.kind, request.key, 1)
                self._keep(slot, request, self._draw_tile(picture, pixels))
            self.changed.emit()

    def _request_for(self, picture: OrientedImage, key: TileKey) -> TileRequest:
        look = self._look
        ends = look.low_percent, look.high_percent
        kind = picture.image.kind
        return TileRequest(
            picture.drive.id, kind, key, look.attribute, *ends, hides_noise=look.hides_noise
        )

    def _token(self, request: TileRequest) -> tuple[object, ...]:
        follows_labels = request.hides_noise or request.attribute in SHOWS_LABELS
        ends = request.low_percent, request.high_percent
        return follows_labels, request.attribute, *ends, request.hides_noise, self._age

    def _draw_tile(self, picture: OrientedImage, pixels: TilePixels) -> QImage:
        colours = pixels.colours
        if self._chosen.size:
            colours = tint_points(pixels, self._chosen)
        return as_image(picture.laid(colours))

    def _keep(self, slot: _Slot, request: TileRequest, whole: QImage) -> _Made:
        made = _Made(self._token(request), _thin_image(whole, slot, self._picture))
        before = self._made.pop(slot, None)
        self._bytes += made.image.sizeInBytes() - (before.image.sizeInBytes() if before else 0)
        self._made[slot] = made
        self._version += 1
        while self._bytes > self._limit_bytes and len(self._made) > 1:
            self._bytes -= self._made.popitem(last=False)[1].image.sizeInBytes()
        return made


def as_image(pixels: NDArray[np.uint8]) -> QImage:
    """(h, w, 3) colours as a picture that owns its memory."""
    height, width = pixels.shape[:2]
    packed = np.full((height, width, 4), 255, np.uint8)
    packed[..., :3] = pixels[..., ::-1]  # blue first, as 32-bit colours lie in memory
    return QImage(packed.data, width, height, 4 * width, QImage.Format.Format_RGB32).copy()


def tint_points(pixels: TilePixels, chosen: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Colours of a tile with the chosen points, (n,) sorted, in the accent colour."""
    positions = np.searchsorted(chosen, pixels.points)
    is_chosen = chosen[np.minimum(positions, chosen.size - 1)] == pixels.points
    if not is_chosen.any():
        return pixels.colours
    colours = pixels.colours.copy()
    accent = np.array(_rgb(ACCENT)) * _TINT_SHARE
    colours[is_chosen] = (colours[is_chosen] * (1 - _TINT_SHARE) + accent).astype(np.uint8)
    return colours


def _rgb(colour: QColor) -> tuple[int, int, int]:
    return colour.red(), colour.green(), colour.blue()


def _thin_image(image: QImage, slot: _Slot, picture: OrientedImage | None) -> QImage:
    thinning = slot[3]
    if thinning == 1 or picture is None:
        return image
    width, height = image.width(), image.height()
    if picture.rows_go_right:
        height = -(-height // thinning)
    else:
        width = -(-width // thinning)
    return image.scaled(
        width,
        height,
        Qt.AspectRatioMode.IgnoreAspectRatio,
        Qt.TransformationMode.SmoothTransformation,
    )
