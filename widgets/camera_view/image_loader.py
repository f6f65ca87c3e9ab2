"""ImageLoader: reads camera images and finds what hides what in them, beside the window."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from processing.cameras.depth import DepthPicture
from processing.core.errors import Cancelled, UserError
from processing.recording.camera_images.choice import ImageFinder
from processing.recording.camera_images.image_list import CameraImage
from processing.recording.camera_images.image_pixels import read_pixels
from processing.recording.drive import Drive
from widgets.camera_view.photo import Photo, photo_of

_KEPT_BYTES = 300_000_000
_MOST_PIXELS = 12_000_000
_KEPT_DEPTHS = 24
_TRIED = 4
_WARMED = ((0.5, 0.5), (0.25, 0.6), (0.75, 0.6), (0.5, 0.8))


@dataclass(frozen=True)
class ImageRequest:
    """What the view wants, the newest wish counts.

    Attributes
    ----------
    choice : ImageFinder
    drives : tuple of Drive
    shown : tuple of int
        Numbers of the images wanted now, the most urgent first.
    coming : tuple of (3,) float64
        Places that will be looked at next; the image that shows each best is prepared.
    """

    choice: ImageFinder
    drives: tuple[Drive, ...]
    shown: tuple[int, ...] = ()
    coming: tuple[NDArray[np.float64], ...] = ()


@dataclass(frozen=True)
class _Task:
    """One thing to find out about an image: its pixels, or what hides what in it."""

    image: CameraImage
    is_photo: bool


class ImageLoader(QObject):
    """Keeps the images that were looked at last; a thread of its own makes new ones.

    Signals
    -------
    developed
        Something more is known: a photo, a depth picture, or that a file can't be read.
    """

    developed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._photos: OrderedDict[Path, Photo] = OrderedDict()
        self._depths: OrderedDict[CameraImage, DepthPicture] = OrderedDict()
        self._troubles: dict[Path, UserError] = {}
        self._blind: dict[CameraImage, UserError] = {}
        self._request: ImageRequest | None = None
        self._known_drives: tuple[Drive, ...] = ()
        self._is_closing = False
        self._is_new = threading.Condition()
        self._thread: threading.Thread | None = None

    def want(self, request: ImageRequest) -> None:
        """Work on this from now on."""
        with self._is_new:
            if request.drives != self._known_drives:
                # Other points hide other things.
                self._known_drives = request.drives
                self._depths.clear()
                self._blind.clear()
            self._request = request
            self._is_new.notify()
        if self._thread is None and not self._is_closing:
            self._thread = threading.Thread(target=self._work, name="darkroom", daemon=True)
            self._thread.start()

    def photo(self, image: CameraImage) -> Photo | None:
        """An image's pixels; None while they aren't there."""
        with self._is_new:
            return self._photos.get(image.path)

    def depth(self, image: CameraImage) -> DepthPicture | None:
        """What hides what in an image; None while that isn't known."""
        with self._is_new:
            return self._depths.get(image)

    def trouble(self, image: CameraImage) -> UserError | None:
        """Why an image can't be shown; None where it can, or nobody tried."""
        with self._is_new:
            return self._troubles.get(image.path)

    def blindness(self, image: CameraImage) -> UserError | None:
        """Why it can't be known what an image hides."""
        with self._is_new:
            return self._blind.get(image)

    def forget_troubles(self) -> None:
        """Try files again that could not be read."""
        with self._is_new:
            self._troubles.clear()

    def hides(self, image: CameraImage, xyz: NDArray[np.float64]) -> bool | None:
        """Whether something hides a place in an image; None while that isn't known."""
        depth = self.depth(image)
        return None if depth is None else bool(depth.hides(xyz[None, :])[0])

    def close(self) -> None:
        """Stop the thread and wait for it."""
        with self._is_new:
            self._is_closing = True
            self._is_new.notify()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _work(self) -> None:
        last: ImageRequest | None = None
        done: set[_Task] = set()
        while True:
            with self._is_new:
                request = self._request
            if request is not last:
                last, done = request, set()
            # What was made for this wish and dropped again isn't made a second time.
            tasks = (
                () if request is None else (one for one in self._tasks(request) if one not in done)
            )
            task = next(iter(tasks), None)
            if request is None or task is None:
                with self._is_new:
                    if self._is_closing:
                        return
                    if self._request is request:
                        self._is_new.wait()
                continue
            done.add(task)
            try:
                self._do(task, request)
            except Cancelled:
                return
            self.developed.emit()

    def _do(self, task: _Task, request: ImageRequest) -> None:
        self._check()
        image = task.image
        if task.is_photo:
            self._read(image)
            self._drop_old(request)
            return
        try:
            depth = DepthPicture(image, request.drives, check=self._check)
        except UserError as error:
            with self._is_new:
                self._blind[image] = error
            return
        with self._is_new:
            if request.drives == self._known_drives:
                self._depths[image] = depth
                while len(self._depths) > _KEPT_DEPTHS:
                    self._depths.popitem(last=False)
        if request.shown and request.choice.images[request.shown[0]] == image:
            # The first click into it then finds its points read.
            for across, down in _WARMED:
                self._check()
                depth.point_at((across * image.width_px, down * image.height_px))

    def _read(self, image: CameraImage) -> None:
        try:
            photo = photo_of(read_pixels(image, _MOST_PIXELS))
        except UserError as error:
            with self._is_new:
                self._troubles[image.path] = error
            return
        with self._is_new:
            self._photos[image.path] = photo

    def _tasks(self, request: ImageRequest) -> Iterator[_Task]:
        """What isn't known of all that is wanted, the most urgent first."""
        for number in request.shown:
            yield from self._lacking(request.choice.images[number])
        for xyz in request.coming:
            seeing = request.choice.seeing(
                xyz, lambda n, at: self.hides(request.choice.images[n], at)
            )
            usable = [one.image for one in seeing if self.trouble(one.image) is None]
            for image in usable[:_TRIED]:
                lacking = tuple(self._lacking(image))
                yield from (task for task in lacking if not task.is_photo)
                if self.hides(image, xyz) is False:
                    yield from (task for task in lacking if task.is_photo)
                    break

    def _lacking(self, image: CameraImage) -> Iterator[_Task]:
        with self._is_new:
            has_photo, has_depth = image.path in self._photos, image in self._depths
            is_bad = image.path in self._troubles
            if has_photo:
                self._photos.move_to_end(image.path)
            if has_depth:
                self._depths.move_to_end(image)
        if not is_bad and not has_photo:
            yield _Task(image, is_photo=True)
        if not is_bad and not has_depth:
            yield _Task(image, is_photo=False)

    def _drop_old(self, request: ImageRequest) -> None:
        """Forget the photos that were used longest ago, but not the one that is shown."""
        shown = {request.choice.images[number].path for number in request.shown[:1]}
        with self._is_new:
            for path in list(self._photos):
                if sum(photo.bytes for photo in self._photos.values()) <= _KEPT_BYTES:
                    return
                if path not in shown:
                    del self._photos[path]

    def _check(self) -> None:
        if self._is_closing:
            raise Cancelled
