"""Which images see a place, best first, and what an image sees of the ground, for the map."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage

if TYPE_CHECKING:  # its import takes a third of a second, which the program's start hasn't got
    from scipy.spatial import cKDTree

REACH_M = 50.0
"""From farther away an image isn't offered: things are a few pixels wide."""

_NEAREST_M = 0.5
"""Nearer there is the vehicle itself."""

_MARGIN = 0.01
"""Share of an image along its edges in which nothing is offered: what lies there is cut."""

_EDGE_STEPS = 24
"""Rays along each edge of the ground that an image shows: a smooth outline."""

_LOWEST_DEG = -89.0
"""Rays closer to straight down are taken as that: below a spherical image is the vehicle."""

OcclusionTest = Callable[[int, NDArray[np.float64]], bool | None]
"""Whether something hides a place, (3,) float64 m, in the image of a number; None: not known."""


@dataclass(frozen=True)
class Sighting:
    """A place as one image sees it.

    Attributes
    ----------
    number : int
        Of the image in the list that was asked.
    pixel : tuple of float
        Column and row.
    distance_m : float
        From the perspective centre.
    footprint_m : float
        What one pixel of the image measures at the place.
    is_hidden : bool or None
        Whether a surface lies in front of the place; None where that is not known yet.
    """

    number: int
    image: CameraImage
    pixel: tuple[float, float]
    distance_m: float
    footprint_m: float
    is_hidden: bool | None


class ImageFinder:
    """Finds the images that see a place among thousands.

    Parameters
    ----------
    images : iterable of CameraImage
        In one reference system.
    """

    def __init__(self, images: Iterable[CameraImage]) -> None:
        self.images = tuple(images)
        self.cameras = tuple(Camera(image) for image in self.images)
        self._centres = np.array([image.xyz for image in self.images]).reshape(-1, 3)
        self._tree = _tree_of(self._centres) if self.images else None

    def seeing(
        self,
        xyz: NDArray[np.float64],
        hides: OcclusionTest | None = None,
        *,
        reach_m: float = REACH_M,
    ) -> tuple[Sighting, ...]:
        """The images that see a place, best first.

        Good is an image in which a pixel is small at the place, the place isn't near the image's
        edge, and nothing is known to hide it.

        Parameters
        ----------
        xyz : (3,) float64
            m, project CRS.
        hides : callable, optional
            What is known of surfaces in front.
        """
        found = []
        for number in self._near(xyz, reach_m):
            sighting = self._sighting(number, xyz, hides)
            if sighting is not None:
                found.append(sighting)
        found.sort(key=lambda pair: (pair[1].is_hidden is True, pair[0]))
        return tuple(sighting for _, sighting in found)

    def nearest_m(self, xyz: NDArray[np.float64]) -> tuple[int, float]:
        """The image taken nearest to a place, whether it sees it or not, and its distance.

        Returns
        -------
        (int, float)
            −1 and infinity when there are no images.
        """
        if self._tree is None:
            return -1, np.inf
        distance, number = self._tree.query(xyz)
        return int(number), float(distance)

    def around(self, xyz: NDArray[np.float64], reach_m: float) -> list[int]:
        """Numbers of the images taken within a distance of a place, in their order."""
        return sorted(self._near(xyz, reach_m))

    def _near(self, xyz: NDArray[np.float64], reach_m: float) -> list[int]:
        if self._tree is None or not np.isfinite(xyz).all():
            return []
        return list(self._tree.query_ball_point(xyz, reach_m))

    def _sighting(
        self, number: int, xyz: NDArray[np.float64], hides: OcclusionTest | None
    ) -> tuple[float, Sighting] | None:
        camera, image = self.cameras[number], self.images[number]
        distance = float(np.linalg.norm(xyz - self._centres[number]))
        pixel = camera.pixels_of(xyz[None, :])[0]
        off = np.abs(pixel - (image.width_px / 2, image.height_px / 2))
        limits = np.array([image.width_px, image.height_px]) * (0.5 - _MARGIN)
        if distance < _NEAREST_M or not (off <= limits).all():
            return None
        footprint = distance / pixels_per_radian(image)
        # A panorama has no left and right edge.
        aside = (off / limits)[1:] if image.projection == "equirectangular" else off / limits
        hidden = hides(number, xyz) if hides is not None else None
        position = (float(pixel[0]), float(pixel[1]))
        score = footprint * (1.0 + float((aside * aside).sum()) / 2)
        return score, Sighting(number, image, position, distance, footprint, hidden)


def pixels_per_radian(image: CameraImage) -> float:
    """How many pixels a radian is in the middle of an image."""
    if image.projection == "equirectangular":
        return image.width_px / (2 * np.pi)
    return image.focal_px


def field_of_view(image: CameraImage, reach_m: float) -> NDArray[np.float64]:
    """What an image sees of the plan, up to a distance.

    Parameters
    ----------
    reach_m : float
        In plan.

    Returns
    -------
    (n, 2) float64
        A ring of eastings and northings, m, its first place not repeated: a sector from the
        perspective centre, or a circle around it for a panorama and for a camera that looks
        down.
    """
    centre = np.array(image.xyz[:2])
    angles = _view_angles(image)
    if angles is None:
        turn = np.linspace(0, 2 * np.pi, 3 * _EDGE_STEPS, endpoint=False)
        return np.asarray(centre + reach_m * np.column_stack([np.cos(turn), np.sin(turn)]))
    arc = np.linspace(*angles, _EDGE_STEPS)
    rim = centre + reach_m * np.column_stack([np.cos(arc), np.sin(arc)])
    return np.vstack([centre[None, :], rim])


def _view_angles(image: CameraImage) -> tuple[float, float] | None:
    """Plan angles (anticlockwise from east) of a camera's left and right; None: all around."""
    if image.projection == "equirectangular":
        return None
    rows = np.linspace(0, image.height_px, _EDGE_STEPS)
    camera = Camera(image)
    sides = [
        camera.rays_of(np.column_stack([np.full(rows.size, column), rows]))
        for column in (0.0, float(image.width_px))
    ]
    rays = np.vstack([*sides, camera.rays_of([[image.cx_px, image.cy_px]])])
    if np.degrees(np.arcsin(rays[-1, 2])) < _LOWEST_DEG / 2:
        return None
    middle = np.arctan2(rays[-1, 1], rays[-1, 0])
    turned = np.arctan2(rays[:, 1], rays[:, 0]) - middle
    turned = (turned + np.pi) % (2 * np.pi) - np.pi
    return float(middle + turned.min()), float(middle + turned.max())


def _tree_of(positions: NDArray[np.float64]) -> cKDTree:
    from scipy.spatial import cKDTree

    return cKDTree(positions)
