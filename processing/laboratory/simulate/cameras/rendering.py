"""A picture of a street: one ray for each pixel, the sun's shadow, sky, lens and sensor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.cameras.daylight import Daylight
from processing.laboratory.simulate.cameras.grain_kernels import Singles
from processing.laboratory.simulate.cameras.surface_colours import colours_of, tone_map
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage

Picture = NDArray[np.uint8]

_OFF_M = 0.01  # shadows begin so far before a surface
_MIDDLE_GREY = 0.2
_EXPOSURES = (0.55, 1.9)
_BLUR_PX = 0.5
_NOISE = 1.6  # standard deviation, of 255
_FALL_OFF = 0.18  # of light at a corner
_GREYING = 0.2  # small sensors show less colour than there is
_REFLECTS = {Material.GLASS: 0.55, Material.MIRROR: 0.7, Material.WATER: 0.5}


def render_image(
    image: CameraImage,
    scenes: Sequence[RaycastScene],
    light: Daylight,
    random: Generator,
    check: Callable[[], None] = lambda: None,
) -> Picture:
    """What a camera sees.

    Parameters
    ----------
    image : CameraImage
        In the frame of the scenes.
    scenes : sequence of RaycastScene
        What stands, and what moves, where it is at the time of the image.
    random : Generator
        For the sensor's noise.
    check : callable, optional
        Called between steps; raises to stop.

    Returns
    -------
    (h, w, 3) uint8
        Red, green, blue.
    """
    directions = directions_of(image)
    centre = np.array(image.xyz)
    origins = np.broadcast_to(centre, directions.shape)
    ranges, nearest, triangles = _first_met(scenes, origins, directions)
    check()
    linear = light.sky(directions)
    for number, scene in enumerate(scenes):
        rows = np.flatnonzero(nearest == number)
        if rows.size:
            positions = centre + ranges[rows, None] * directions[rows]
            normals = _normals(scene, triangles[rows], directions[rows])
            is_lit = _lit(scenes, light, positions, normals)
            check()
            seen = colours_of(scene.mesh, triangles[rows], positions)
            seen *= light.falling_on(normals, is_lit)
            _mirror(light, scene.mesh.material[triangles[rows]], (directions[rows], normals), seen)
            linear[rows] = seen
    _add_haze(light, ranges, linear)
    check()
    return _developed(linear.reshape(image.height_px, image.width_px, 3), image, random)


def directions_of(image: CameraImage) -> Floats:
    """Where the pixels of an image look, row by row: (h × w, 3) float64 unit vectors."""
    lens = replace(image, path=image.path.parent, time_s=0.0, xyz=(0.0, 0.0, 0.0))
    lens = replace(lens, omega_deg=0.0, phi_deg=0.0, kappa_deg=0.0)
    return np.asarray(_directions_of_lens(lens) @ Camera(image).rotation)


@lru_cache(maxsize=4)
def _directions_of_lens(lens: CameraImage) -> Floats:
    """Where pixels look in the camera's axes, by the program's own model of cameras."""
    columns, rows = np.meshgrid(
        np.arange(lens.width_px, dtype=np.float64), np.arange(lens.height_px, dtype=np.float64)
    )
    return Camera(lens).rays_of(np.column_stack([columns.ravel(), rows.ravel()]))


def _first_met(
    scenes: Sequence[RaycastScene], origins: Floats, directions: Floats
) -> tuple[Floats, NDArray[np.int16], Integers]:
    """Range, number of the scene (−1: none) and triangle that each ray meets first."""
    ranges = np.full(directions.shape[0], np.inf)
    nearest = np.full(directions.shape[0], -1, np.int16)
    triangles = np.full(directions.shape[0], -1, np.int64)
    for number, scene in enumerate(scenes):
        hits = scene.cast(origins, directions)
        is_nearer = hits.ranges < ranges
        ranges = np.where(is_nearer, hits.ranges, ranges)
        nearest[is_nearer] = number
        triangles = np.where(is_nearer, hits.triangles, triangles)
    return ranges, nearest, triangles


def _normals(scene: RaycastScene, triangles: Integers, directions: Floats) -> Floats:
    corners = scene.mesh.vertices[scene.mesh.triangles[triangles]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    long = np.sqrt(np.einsum("ij,ij->i", normals, normals))
    turned = np.where(np.einsum("ij,ij->i", normals, directions) > 0, -1.0, 1.0)
    return np.asarray(normals * (turned / np.maximum(long, 1e-12))[:, None])


def _lit(
    scenes: Sequence[RaycastScene], light: Daylight, positions: Floats, normals: Floats
) -> Floats:
    """1 where the sun reaches a place, 0 in shadow."""
    lit = np.zeros(positions.shape[0])
    rows = np.flatnonzero(normals @ light.sun > 0.0)
    for scene in scenes:
        if rows.size:
            origins = positions[rows] + normals[rows] * _OFF_M
            hits = scene.cast(origins, np.broadcast_to(light.sun, origins.shape))
            rows = rows[~np.isfinite(hits.ranges)]
    lit[rows] = 1.0
    return lit


def _mirror(
    light: Daylight,
    material: NDArray[np.uint8],
    directions_and_normals: tuple[Floats, Floats],
    seen: Singles,
) -> None:
    """Let glass, mirrors and water show the sky as well."""
    directions, normals = directions_and_normals
    for kind, share in _REFLECTS.items():
        rows = np.flatnonzero(material == kind)
        if rows.size:
            across = 2 * np.einsum("ij,ij->i", directions[rows], normals[rows])
            back = directions[rows] - across[:, None] * normals[rows]
            seen[rows] = (1 - share) * seen[rows] + share * 0.8 * light.sky(back)


def _add_haze(light: Daylight, ranges: Floats, linear: Singles) -> None:
    rows = np.flatnonzero(np.isfinite(ranges) & (ranges > 20.0))
    if rows.size:
        level = light.sky(np.array([[1.0, 0.0, 0.0]]))[0]
        share = light.haze(ranges[rows])[:, None]
        linear[rows] += (level - linear[rows]) * share


def _developed(linear: Singles, image: CameraImage, random: Generator) -> Picture:
    """Exposed, blurred by the lens, darker in the corners, noisy."""
    import cv2

    brightness = float(np.median(linear[::8, ::8].mean(axis=2)))
    exposure = float(np.clip(_MIDDLE_GREY / max(brightness, 1e-3), *_EXPOSURES))
    exposure *= float(random.uniform(0.92, 1.1))
    if image.projection == "perspective":
        rows, columns = np.ogrid[-1 : 1 : 1j * linear.shape[0], -1 : 1 : 1j * linear.shape[1]]
        linear = linear * (1 - _FALL_OFF * (rows**2 + columns**2) / 2)[:, :, None]
    linear = linear + _GREYING * (linear.mean(axis=2, keepdims=True) - linear)
    blurred = cv2.GaussianBlur((linear * exposure).astype(np.float32), (3, 3), _BLUR_PX)
    picture = tone_map(np.asarray(blurred)).astype(np.float32)
    picture += _NOISE * random.standard_normal(picture.shape, np.float32)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)
