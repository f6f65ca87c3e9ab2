"""TakenImages: the camera images of all drives, each once, with the offsets that count now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from processing.cameras.calibration import NO_OFFSET, CameraOffset, camera_of, with_offset
from processing.cameras.choice import ImageChoice
from processing.cameras.image_list import CameraImage, ImageList
from processing.cameras.image_remarks import far_away
from processing.points.drive import Drive
from processing.text import Text


@dataclass(frozen=True)
class TakenImage:
    """One image, and which drive's trajectory its time belongs to.

    Attributes
    ----------
    image, delivered : CameraImage
        With its camera's offset; as delivered.
    camera : str
        See :func:`processing.cameras.calibration.camera_of`.
    """

    image: CameraImage
    delivered: CameraImage
    drive: Drive
    camera: str


class TakenImages:
    """What a camera view can show.

    Parameters
    ----------
    drives : tuple of Drive
        Drives of one import share their images.
    trial : mapping of str to CameraOffset
        Offsets by camera that are tried out in place of those that are kept.

    Attributes
    ----------
    images : tuple of TakenImage
    choice : ImageChoice
        By the same numbers.
    remark : Text or None
        Why they can't belong to the points, if they are far away.
    """

    def __init__(self, drives: tuple[Drive, ...], trial: Mapping[str, CameraOffset]) -> None:
        self.drives = drives
        found: dict[CameraImage, TakenImage] = {}
        for drive in drives:
            for delivered in drive.delivered_images or ():
                if delivered not in found:
                    found[delivered] = _taken(delivered, drive, trial)
        self.images = tuple(found.values())
        self.choice = ImageChoice(taken.image for taken in self.images)
        self.remark = _remark(drives)


def _taken(delivered: CameraImage, drive: Drive, trial: Mapping[str, CameraOffset]) -> TakenImage:
    camera = camera_of(delivered)
    offset = trial.get(camera) or drive.camera_offsets.get(camera, NO_OFFSET)
    image = delivered if offset.is_zero else with_offset(delivered, offset, drive.trajectory)
    return TakenImage(image, delivered, drive, camera)


def _remark(drives: tuple[Drive, ...]) -> Text | None:
    """The images are far from all drives that have any."""
    remarks = [
        far_away(images, np.array(drive.info.lowest), np.array(drive.info.highest))
        for drive in drives
        if (images := drive.delivered_images or ImageList(())) and len(images)
    ]
    return remarks[0] if remarks and all(remark is not None for remark in remarks) else None
