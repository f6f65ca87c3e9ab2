"""TileCache: one store and one loader of coloured tiles for all views."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, NoSpace, UserError
from processing.core.text import Text
from processing.image import point_image
from processing.image.attributes.attributes import SHOWS_LABELS, colours, most_telling_attribute
from processing.image.attributes.tile_reading import expect_tile
from processing.image.images_of_drives import image_of
from processing.image.search.touched_tiles import TouchedTiles
from processing.image.tiles.tiles import TileKey
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

LIMIT_BYTES = 256 * 2**20
"""Of coloured tiles that are kept, 256 MiB: some 1,300, several screens of each view."""

_LOADERS = 2
"""Threads that load tiles: one reads while the other colours."""


@dataclass(frozen=True)
class TileRequest:
    """A tile as a view wants to show it.

    Attributes
    ----------
    hides_noise : bool
        Without the points whose class is noise.
    """

    drive_id: str
    kind: ImageKind
    key: TileKey
    attribute: str
    low_percent: float
    high_percent: float
    hides_noise: bool = False


@dataclass(frozen=True)
class TilePixels:
    """What a tile shows.

    Attributes
    ----------
    points : (h, w) int64
        −1 where empty.
    colours : (h, w, 3) uint8
    age : int
        How often the drive had changed when the tile was begun; see :meth:`TileCache.is_current`.
    """

    points: NDArray[np.int64]
    colours: NDArray[np.uint8]
    age: int = 0

    @property
    def size_bytes(self) -> int:
        """Memory held."""
        return self.points.nbytes + self.colours.nbytes


TileReceiver = Callable[[TileRequest, TilePixels], None]
"""Told of a finished tile, from a loader's thread."""

TileErrorReceiver = Callable[[TileRequest, UserError], None]
"""Told why a tile can't be shown, from a loader's thread."""

_Listeners = dict[TileReceiver, TileErrorReceiver | None]


class TileCache:
    """Coloured tiles, the ones used last kept; may be called from any thread.

    Parameters
    ----------
    limit_bytes : int
        What the tiles may hold together.
    """

    def __init__(self, *, limit_bytes: int = LIMIT_BYTES) -> None:
        self._drive_of: Callable[[str], Drive] | None = None
        self._limit_bytes = limit_bytes
        self._changed = threading.Condition()
        self._tiles: OrderedDict[TileRequest, TilePixels] = OrderedDict()
        self._held_bytes = 0
        # The newest request is last and is served first.
        self._waiting: OrderedDict[TileRequest, _Listeners] = OrderedDict()
        self._loading: dict[TileRequest, _Listeners] = {}
        self._refusals: dict[tuple[str, str], UserError] = {}
        self._stand_ins: set[str] = set()
        self._ages: dict[str, int] = {}
        self._busy = 0
        self._is_warm = True
        self._is_closed = False
        self._loaders = [
            threading.Thread(target=self._load_all, name=f"tiles-{number}", daemon=True)
            for number in range(_LOADERS)
        ]
        for loader in self._loaders:
            loader.start()

    def use(self, drive_of: Callable[[str], Drive]) -> None:
        """Say where drives come from, before anything is requested.

        Parameters
        ----------
        drive_of : callable
            From an id to the open drive, called from loaders' threads; KeyError when there is no
            open drive of that id.
        """
        self._drive_of = drive_of

    def get_ready(self) -> None:
        """Let a loader fetch its machine code now, and not when the first tile is waited for."""
        with self._changed:
            self._is_warm = False
            self._changed.notify()

    @property
    def held_bytes(self) -> int:
        """What the tiles hold now."""
        with self._changed:
            return self._held_bytes

    def get(self, request: TileRequest) -> TilePixels | None:
        """The tile if it is there; never waits for a loader."""
        with self._changed:
            pixels = self._tiles.get(request)
            if pixels is not None:
                self._tiles.move_to_end(request)
            return pixels

    def is_current(self, request: TileRequest, pixels: TilePixels) -> bool:
        """Whether what a tile shows has not changed since it was made.

        For who is told of a tile and looks at it a moment later, when it may have been dropped.
        """
        with self._changed:
            is_kept = self._tiles.get(request) is pixels
            return is_kept or pixels.age == self._ages.get(request.drive_id, 0)

    def request(
        self, request: TileRequest, done: TileReceiver, refused: TileErrorReceiver | None = None
    ) -> None:
        """Load a tile, before all that was asked for earlier, and tell ``done``.

        A tile that is there already is told at once, from this thread. That a drive can't be
        shown by an attribute is told to ``refused`` when a loader finds out; further requests of
        that kind are ignored until the drive is dropped (see :meth:`refusal`).

        Raises
        ------
        ValueError
            Before :meth:`use`.
        """
        if self._drive_of is None:
            message = "the tile cache was not told where drives come from"
            raise ValueError(message)
        with self._changed:
            if self._is_closed or (request.drive_id, request.attribute) in self._refusals:
                return
            pixels = self._tiles.get(request)
            if pixels is None:
                self._wait_for(request, {done: refused})
                return
        done(request, pixels)

    def keep_only(self, done: TileReceiver, wanted: Collection[TileRequest]) -> None:
        """Give up what a listener asked for and no longer wants, as far as it isn't loading."""
        with self._changed:
            for request in list(self._waiting):
                listeners = self._waiting[request]
                if request not in wanted and done in listeners:
                    del listeners[done]
                    if not listeners:
                        del self._waiting[request]

    def tell_nobody(self) -> None:
        """Give up all that was asked for; who asked is told nothing after this and may go.

        Waits for the tiles that are being made just now.
        """
        with self._changed:
            self._waiting.clear()
            for listeners in self._loading.values():
                listeners.clear()
            self._changed.wait_for(lambda: self._busy == 0)

    def refusal(self, drive_id: str, attribute: str) -> UserError | None:
        """Why a drive can't be shown by an attribute, once a loader has found out."""
        with self._changed:
            return self._refusals.get((drive_id, attribute))

    def drop(self, drive_id: str) -> None:
        """Forget all tiles of a drive: its columns changed or it was closed."""
        with self._changed:
            self._ages[drive_id] = self._ages.get(drive_id, 0) + 1
            for request in [request for request in self._tiles if request.drive_id == drive_id]:
                self._held_bytes -= self._tiles.pop(request).size_bytes
            self._stand_ins.discard(drive_id)
            for refused in [refused for refused in self._refusals if refused[0] == drive_id]:
                del self._refusals[refused]

    def drop_relabelled(self, drive: Drive, points: NDArray[np.int64]) -> None:
        """Forget the tiles that show labels of some points, or hide points by them.

        Parameters
        ----------
        points : (n,) int64
        """
        with self._changed:
            # What is being made now may show points as they were.
            self._ages[drive.id] = self._ages.get(drive.id, 0) + 1
            for attribute in SHOWS_LABELS:
                self._refusals.pop((drive.id, attribute), None)
            mine = [
                one
                for one in self._tiles
                if one.drive_id == drive.id and (one.hides_noise or one.attribute in SHOWS_LABELS)
            ]
        touched = {
            kind: TouchedTiles(image_of(drive, kind), points) for kind in {one.kind for one in mine}
        }
        with self._changed:
            for request in mine:
                if request.key in touched[request.kind]:
                    pixels = self._tiles.pop(request, None)
                    self._held_bytes -= pixels.size_bytes if pixels is not None else 0

    def is_stand_in(self, drive_id: str) -> bool:
        """Whether tiles of a drive that lacks classes show something else in their place."""
        with self._changed:
            return drive_id in self._stand_ins

    def close(self) -> None:
        """Stop the loaders and wait for them; nothing is told afterwards."""
        with self._changed:
            self._is_closed = True
            self._waiting.clear()
            self._changed.notify_all()
        for loader in self._loaders:
            if loader is not threading.current_thread():
                loader.join()

    def _wait_for(self, request: TileRequest, more: _Listeners) -> None:
        listeners = self._loading.get(request)
        if listeners is None:
            listeners = self._waiting.setdefault(request, {})
            self._waiting.move_to_end(request)
            self._changed.notify_all()
        listeners.update(more)

    def _load_all(self) -> None:
        while True:
            with self._changed:
                while not self._waiting and not self._is_closed and self._is_warm:
                    self._changed.wait()
                drive_of = self._drive_of
                if self._is_closed:
                    return
                was_warm, self._is_warm = self._is_warm, True
                if was_warm:
                    request, self._loading[request] = self._waiting.popitem()
                    age = self._ages.get(request.drive_id, 0)
                self._busy += 1
            try:
                if not was_warm:
                    point_image.warm_up()
                elif drive_of is not None:
                    self._load(request, age, drive_of)
            finally:
                with self._changed:
                    self._busy -= 1
                    self._changed.notify_all()

    def _load(self, request: TileRequest, age: int, drive_of: Callable[[str], Drive]) -> None:
        made: TilePixels | UserError | None = None
        try:
            made = replace(self._pixels_of(request, drive_of), age=age)
        except UserError as error:
            made = error
        except MemoryError:
            made = self._short_of_memory(request)
        except KeyError:
            made = None  # the drive was closed meanwhile; no one waits for its tiles
        finally:
            listeners = self._keep_made(request, made, age)
        for done, refused in listeners.items():
            if isinstance(made, TilePixels):
                done(request, made)
            elif made is not None and refused is not None:
                refused(request, made)

    def _short_of_memory(self, request: TileRequest) -> UserError:
        """Give back what tiles hold, and say what is to be done."""
        with self._changed:
            self._tiles.clear()
            self._held_bytes = 0
        return NoSpace(
            Text(
                "There is not enough memory to show the points.",
                "メモリが不足しているため、点を表示できません。",
            ),
            Text.same(request.drive_id),
            Text(
                "Close other programs or views, then open the project again. {unchanged}",
                "ほかのプログラムやビューを閉じてから、プロジェクトを開き直してください。"
                "{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )

    def _keep_made(
        self, request: TileRequest, made: TilePixels | UserError | None, age: int
    ) -> _Listeners:
        """Keep what a loader made; gives who is to be told."""
        with self._changed:
            listeners = self._loading.pop(request)
            if self._is_closed:
                return {}
            if age != self._ages.get(request.drive_id, 0):
                # The drive changed while the tile was made: make it again for who still waits.
                self._wait_for(request, listeners)
                return {}
            if isinstance(made, UserError):
                self._refusals[request.drive_id, request.attribute] = made
            elif made is not None:
                self._keep(request, made)
            return listeners

    def _pixels_of(self, request: TileRequest, drive_of: Callable[[str], Drive]) -> TilePixels:
        drive = drive_of(request.drive_id)
        image = image_of(drive, request.kind)
        hides_noise, attribute = (
            request.hides_noise,
            most_telling_attribute(drive, request.attribute),
        )
        if attribute != request.attribute and request.attribute in SHOWS_LABELS:
            with self._changed:
                self._stand_ins.add(drive.id)
        expect_tile(drive.columns, image, request.key, attribute, hides_noise=hides_noise)
        classes = class_columns(drive.columns) if hides_noise else None
        points = image.pyramid.points(request.key, without_noise=classes)
        shown = colours(drive, points, attribute, request.low_percent, request.high_percent)
        return TilePixels(points, shown)

    def _keep(self, request: TileRequest, pixels: TilePixels) -> None:
        if request not in self._tiles:
            self._held_bytes += pixels.size_bytes
        self._tiles[request] = pixels
        while self._held_bytes > self._limit_bytes and len(self._tiles) > 1:
            _, oldest = self._tiles.popitem(last=False)
            self._held_bytes -= oldest.size_bytes
