"""Photographs of the synthetic street: what every pixel shows is known by construction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.recording.camera_images.calibration import angles_of
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ProjectionName
from tests.builders import START
from tests.street_scene import Rays, StreetScene

Triple = tuple[float, float, float]

SURFACE_COLOURS = np.array(
    [[90, 90, 90], [200, 60, 60], [60, 160, 60], [60, 60, 200], [220, 200, 40], [0, 0, 0]], np.uint8
)
"""Red, green, blue of road, curb face, sidewalk, wall, pole, and of nothing."""

SKY = 5


def looking(
    path: Path,
    at: Triple,
    ahead: Triple,
    *,
    focal_px: float = 250.0,
    size: tuple[int, int] = (400, 300),
    time_s: float = 205_000.5,
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0),
    projection: ProjectionName = "perspective",
) -> CameraImage:
    """A camera at a place, m from the street's start, that looks along a direction, upright."""
    backwards = -np.array(ahead) / np.linalg.norm(ahead)
    right = np.cross([0.0, 0.0, 1.0], backwards)
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(backwards, right), backwards])
    omega, phi, kappa = angles_of(rotation).tolist()
    easting, northing, height = (START + at).tolist()
    return CameraImage(
        path=path,
        time_s=time_s,
        xyz=(easting, northing, height),
        omega_deg=omega,
        phi_deg=phi,
        kappa_deg=kappa,
        focal_px=focal_px,
        cx_px=(size[0] - 1) / 2,
        cy_px=(size[1] - 1) / 2,
        width_px=size[0],
        height_px=size[1],
        distortion=distortion,
        projection=projection,
    )


def seen_by(
    image: CameraImage, pixels: NDArray[np.float64], length_m: float = 10.0
) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    """Distance of what pixels of an image show (infinite: sky), and its surface or `SKY`."""
    rays = Camera(image).rays_of(pixels)
    origin = np.broadcast_to(np.array(image.xyz) - START, rays.shape)
    scene = StreetScene(0.0, length_m)
    ranges, surface, _ = scene.ranges(Rays(origin, rays), np.random.default_rng(0))
    return ranges, np.where(np.isfinite(ranges), surface, SKY).astype(np.uint8)


def photograph(image: CameraImage, length_m: float = 10.0) -> NDArray[np.uint8]:
    """Write what a camera sees of the street to the image's file; gives it, (h, w) surfaces."""
    import cv2

    columns, rows = np.meshgrid(np.arange(image.width_px), np.arange(image.height_px))
    pixels = np.column_stack([columns.ravel(), rows.ravel()]).astype(np.float64)
    surface = seen_by(image, pixels, length_m)[1].reshape(columns.shape)
    image.path.parent.mkdir(parents=True, exist_ok=True)
    _, content = cv2.imencode(".png", SURFACE_COLOURS[surface][:, :, ::-1])
    content.tofile(image.path)
    return surface
