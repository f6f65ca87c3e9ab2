"""ImageList: which camera images a drive has, and from where and how they look."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

ProjectionName = Literal["perspective", "equirectangular"]


@dataclass(frozen=True)
class CameraImage:
    """One image with its orientation.

    Attributes
    ----------
    path : Path
        The image file; it may be missing on this machine.
    time_s : float
        On the trajectory's clock.
    xyz : tuple of float
        Perspective centre: easting, northing, height, m, project CRS.
    omega_deg, phi_deg, kappa_deg : float
        Photogrammetric angles; see :mod:`processing.recording.camera_images.camera`.
    focal_px, cx_px, cy_px : float
        Focal length and principal point.
    width_px, height_px : int
        Size of the image.
    distortion : tuple of float
        Brown's k1, k2, p1, p2, k3.
    projection : str
        ``perspective`` or ``equirectangular``.
    """

    path: Path
    time_s: float
    xyz: tuple[float, float, float]
    omega_deg: float
    phi_deg: float
    kappa_deg: float
    focal_px: float
    cx_px: float
    cy_px: float
    width_px: int
    height_px: int
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    projection: ProjectionName = "perspective"


@dataclass(frozen=True)
class ImageList:
    """The images of a drive, in the order of their list."""

    images: tuple[CameraImage, ...]

    def __len__(self) -> int:
        return len(self.images)

    def __iter__(self) -> Iterator[CameraImage]:
        return iter(self.images)

    def __getitem__(self, index: int) -> CameraImage:
        return self.images[index]
