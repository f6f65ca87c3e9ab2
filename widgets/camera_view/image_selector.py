"""ImageSelector: which image is shown, of those that see the place looked at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.cameras.depth import DepthPicture
from processing.core.errors import UserError
from processing.recording.camera_images.choice import Sighting, field_of_view
from widgets.camera_view.image_loader import ImageLoader, ImageRequest
from widgets.camera_view.photo import Photo
from widgets.camera_view.taken_images import TakenImage, TakenImages
from widgets.shared.cursor import PickedPosition

_MOST_COMING = 6
_FIELDS_SHOWN = 8
_FIELD_LEAST_M, _FIELD_BEYOND = 15.0, 1.2


class ImageSelector:
    """Chooses the best image, and lets the user walk through the others.

    Parameters
    ----------
    image_loader : ImageLoader

    Attributes
    ----------
    images : TakenImages
    position : PickedPosition or None
        What is looked at.
    sightings : tuple of Sighting
        The images that see it and can be read, best first.
    number : int
        Of the image shown; −1: none.
    """

    def __init__(self, image_loader: ImageLoader) -> None:
        self._image_loader = image_loader
        self._coming: tuple[NDArray[np.float64], ...] = ()
        self._is_walking = False
        self.images = TakenImages((), {})
        self.position: PickedPosition | None = None
        self.sightings: tuple[Sighting, ...] = ()
        self.number = -1

    @property
    def taken(self) -> TakenImage | None:
        """The image shown."""
        return self.images.images[self.number] if self.number >= 0 else None

    @property
    def index(self) -> int:
        """Which of `sightings` is shown; −1: none."""
        numbers = [sighting.number for sighting in self.sightings]
        return numbers.index(self.number) if self.number in numbers else -1

    @property
    def photo(self) -> Photo | None:
        """The shown image's pixels; None while they aren't there."""
        return None if self.taken is None else self._image_loader.photo(self.taken.image)

    @property
    def depth(self) -> DepthPicture | None:
        """What hides what in the shown image; None while that isn't known."""
        return None if self.taken is None else self._image_loader.depth(self.taken.image)

    @property
    def trouble(self) -> UserError | None:
        """Why the best image of the place can't be shown, when none can."""
        if self.sightings or self.position is None:
            return None
        seeing = self.images.choice.seeing(np.array(self.position.xyz))
        return self._image_loader.trouble(seeing[0].image) if seeing else None

    @property
    def is_hidden(self) -> bool:
        """Whether something is known to hide the place in the shown image."""
        index = self.index
        return index >= 0 and self.sightings[index].is_hidden is True

    def use(self, images: TakenImages) -> None:
        """Show these images from now on; the same one, if it is still there by its file."""
        before = self.taken
        self.images = images
        paths = [taken.delivered for taken in images.images]
        is_there = before is not None and before.delivered in paths
        self.number = paths.index(before.delivered) if before is not None and is_there else -1

    def look_at(self, position: PickedPosition | None) -> None:
        """Look at another place: the best image of it is shown."""
        self.position = position
        self._is_walking = False
        self.refresh()

    def stay(self, position: PickedPosition | None) -> None:
        """Another place is looked at in the image that is shown."""
        self.position = position
        self._is_walking = True
        self.refresh()

    def refresh(self) -> None:
        """Choose again with what is known now, unless the user walked to an image."""
        self.sightings = self._readable()
        if not self._is_walking:
            self.number = self.sightings[0].number if self.sightings else -1
        elif self.taken is not None and self._image_loader.trouble(self.taken.image) is not None:
            self._is_walking = False
            self.refresh()
            return
        self._send_request()

    def walk_to(self, number: int) -> None:
        """Show an image that the user wants, the best one or not."""
        self.number = number
        self._is_walking = True
        self._send_request()

    def prepare(self, positions: tuple[PickedPosition, ...]) -> None:
        """Have the images ready that show these places best, the first ones first."""
        self._coming = tuple(np.array(position.xyz) for position in positions[:_MOST_COMING])
        self._send_request()

    def fields_of_view(self) -> tuple[list[NDArray[np.float64]], int]:
        """What the images that see the place see of the plan, and which of them is shown."""
        fields = [
            field_of_view(one.image, max(_FIELD_LEAST_M, _FIELD_BEYOND * one.distance_m))
            for one in self.sightings[:_FIELDS_SHOWN]
        ]
        index = self.index
        return fields, index if index < len(fields) else -1

    def _readable(self) -> tuple[Sighting, ...]:
        if self.position is None or self.images.remark is not None:
            return ()
        images = self.images.images
        seeing = self.images.choice.seeing(
            np.array(self.position.xyz),
            lambda n, xyz: self._image_loader.hides(images[n].image, xyz),
        )
        return tuple(one for one in seeing if self._image_loader.trouble(one.image) is None)

    def _send_request(self) -> None:
        # The next image of the walk is likely to be wanted next.
        following = self.sightings[self.index + 1 :][:1]
        shown = [self.number] if self.number >= 0 else []
        numbers = (*shown, *(one.number for one in following))
        choice = self.images.choice
        self._image_loader.want(ImageRequest(choice, self.images.drives, numbers, self._coming))
