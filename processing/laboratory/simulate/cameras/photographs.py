"""The camera images of a pass and their list, written as a delivery has them."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.laboratory.simulate.cameras.daylight import daylight_of
from processing.laboratory.simulate.cameras.rendering import Picture, render_image
from processing.laboratory.simulate.cameras.rigs import Pose, RigCamera, image_of
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.recording.camera_images.image_list import CameraImage

_QUALITY = 85
_COLUMNS = (
    "path", "time_s", "easting_m", "northing_m", "height_m", "omega_deg", "phi_deg", "kappa_deg",
    "focal_px", "cx_px", "cy_px", "width_px", "height_px", "k1", "k2", "p1", "p2", "k3",
    "projection",
)  # fmt: skip
_TAKING = Text("Taking photographs", "写真を撮影しています")


@dataclass(frozen=True)
class DeliveryFrame:
    """How what is written counts.

    Attributes
    ----------
    origin : (3,) float64
        Of the street's frame: easting, northing, height, m, in the delivery's CRS.
    clock_s : float
        The delivery's time when the pass begins.
    prefix : str
        Before the names of the images, so that passes don't overwrite each other.
    """

    origin: Floats
    clock_s: float
    prefix: str = ""


def write_images(
    folder: Path,
    poses: Sequence[Pose],
    scenes_of: Callable[[Pose], Sequence[RaycastScene]],
    monitor: Monitor,
    *,
    seed: int,
    rig: Sequence[RigCamera],
    frame: DeliveryFrame,
) -> list[CameraImage]:
    """Take the photographs of a pass.

    Parameters
    ----------
    folder : Path
        Of the delivery; the images go into ``images`` below it.
    poses : sequence of Pose
        Where the vehicle is at each exposure; all cameras open at once.
    scenes_of : callable
        What is met around a pose at its time.

    Returns
    -------
    list of CameraImage
        As delivered, for `write_image_list`.

    Raises
    ------
    NoSpace, MissingInput, BadFile
        What the operating system says.
    Cancelled
        By the monitor; the images so far stay.
    """
    light = daylight_of(seed)
    delivered = []
    for number, pose in enumerate(poses):
        monitor.report(number / len(poses), _TAKING)
        scenes = scenes_of(pose)
        for camera in rig:
            monitor.check()
            path = folder / "images" / f"{frame.prefix}{camera.name}_{number:04d}.jpg"
            image = image_of(camera, pose, path)
            random = chance(seed, "sensor", frame.prefix, camera.name, number)
            _write_picture(path, render_image(image, scenes, light, random, monitor.check))
            delivered.append(_delivered(image, pose, frame))
    monitor.report(1.0, _TAKING)
    return delivered


def write_image_list(path: Path, images: Sequence[CameraImage]) -> None:
    """Write the list of images, their paths relative to its folder.

    Raises
    ------
    NoSpace, MissingInput, BadFile
        What the operating system says.
    """
    with write_safely(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(_COLUMNS)
        table.writerows(_row(one, path.parent) for one in images)


def _row(image: CameraImage, folder: Path) -> list[str]:
    lens = (image.focal_px, image.cx_px, image.cy_px)
    return [
        image.path.relative_to(folder).as_posix(),
        f"{image.time_s:.6f}",
        *(f"{value:.4f}" for value in image.xyz),
        *(f"{value:.6f}" for value in (image.omega_deg, image.phi_deg, image.kappa_deg)),
        *(f"{value:.4f}" for value in lens),
        str(image.width_px),
        str(image.height_px),
        *(f"{value:.8g}" for value in image.distortion),
        image.projection,
    ]


def _delivered(image: CameraImage, pose: Pose, frame: DeliveryFrame) -> CameraImage:
    easting, northing, height = (np.array(image.xyz) + pose.error + frame.origin).tolist()
    return replace(image, time_s=pose.time_s + frame.clock_s, xyz=(easting, northing, height))


def _write_picture(path: Path, picture: Picture) -> None:
    import cv2

    quality = [cv2.IMWRITE_JPEG_QUALITY, _QUALITY]
    _, content = cv2.imencode(".jpg", np.ascontiguousarray(picture[:, :, ::-1]), quality)
    with write_safely(path) as part:
        content.tofile(part)
