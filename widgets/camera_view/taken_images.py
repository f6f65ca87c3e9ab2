"""TakenImages: the camera images of all drives, each once, with the offsets that count now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from processing.core.text import Text
from processing.recording.camera_images.calibration import CameraOffset, apply_offsets, camera_of
from processing.recording.camera_images.choice import ImageFinder
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_remarks import far_away
from processing.recording.drive import Drive


@dataclass(frozen=True)
class TakenImage:
    """One image, and which drive's trajectory its time belongs to.

    Attributes
    ----------
    image, delivered : CameraImage
        With its camera's offset; as delivered.
    """

    image: CameraImage
    delivered: CameraImage
    drive: Drive

    @property
    def camera(self) -> str:
        """See :func:`processing.recording.camera_images.calibration.camera_of`."""
        return camera_of(self.delivered)


class TakenImages:
    """What a camera view can show.

    Parameters
    ----------
    drives : tuple of Drive
        Drives of one import share their images.
    tried : mapping of str to CameraOffset
        Offsets by camera that are tried out in place of those that are kept.

    Attributes
    ----------
    images : tuple of TakenImage
    choice : ImageFinder
        By the same numbers.
    remark : Text or None
        Why they can't belong to the points, if they are far away.
    """

    def __init__(self, drives: tuple[Drive, ...], tried: Mapping[str, CameraOffset]) -> None:
        self.drives = drives
        found: dict[CameraImage, TakenImage] = {}
        for drive in drives:
            delivered = drive.delivered_images or ImageList(())
            offsets = {**drive.camera_offsets, **tried}
            images = apply_offsets(delivered, offsets, drive.trajectory if offsets else None)
            for before, image in zip(delivered, images, strict=True):
                if before not in found:
                    found[before] = TakenImage(image, before, drive)
        self.images = tuple(found.values())
        self.choice = ImageFinder(taken.image for taken in self.images)
        self.remark = _remark(drives)


def _remark(drives: tuple[Drive, ...]) -> Text | None:
    """The images are far from all drives that have any."""
    remarks = [
        far_away(images, np.array(drive.info.lowest), np.array(drive.info.highest))
        for drive in drives
        if (images := drive.delivered_images or ImageList(())) and len(images)
    ]
    return remarks[0] if remarks and all(remark is not None for remark in remarks) else None
