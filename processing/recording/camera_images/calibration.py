"""Offsets of a camera against the orientation it was delivered with: applied, and estimated."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.vehicle_path.trajectory import Trajectory

_PAIRS_FOR_ROTATION = 2
"""Pairs of places and pixels from which a rotation follows: four equations for three unknowns."""

_PAIRS_FOR_SHIFT = 5
"""Pairs from which a shift follows too: ten equations for six unknowns, so that a wrong one
shows."""

_STEEP = 1e-9
"""Cosine of the pitch below which heading and roll cannot be separated."""

_LEAST_SINGULAR = 1e-6
"""Of the largest singular value: below it a direction of the offset is not determined by the pairs
but by rounding. By trial; no measurement is recorded."""

_BEHIND_PX = 1e4
"""Stands for the error of a place behind the camera: larger than any image."""


@dataclass(frozen=True)
class CameraOffset:
    """What is added to the delivered orientation of every image of one camera.

    Attributes
    ----------
    roll_deg, pitch_deg, yaw_deg : float
        How the camera is turned more: right side down, upwards, to the right, in this order
        about its own axes.
    right_m, up_m, forward_m : float
        How the perspective centre is moved, along the delivered camera's axes.
    time_s : float
        Added to the time of exposure; the camera moves along the trajectory with it.
    """

    roll_deg: float = 0.0
    pitch_deg: float = 0.0
    yaw_deg: float = 0.0
    right_m: float = 0.0
    up_m: float = 0.0
    forward_m: float = 0.0
    time_s: float = 0.0

    @property
    def is_zero(self) -> bool:
        """Whether it changes nothing."""
        return not any(dataclasses.astuple(self))


NO_OFFSET = CameraOffset()


@dataclass(frozen=True)
class PixelPair:
    """The same place in an image and in space.

    Attributes
    ----------
    image : CameraImage
        As delivered, no offset applied.
    pixel : tuple of float
        Column and row.
    xyz : tuple of float
        m, project CRS.
    """

    image: CameraImage
    pixel: tuple[float, float]
    xyz: tuple[float, float, float]


@dataclass(frozen=True)
class EstimatedOffset:
    """An offset from pairs.

    Attributes
    ----------
    residuals_px : (n,) float64
        How far each pair is off with it.
    rms_px : float
        Root of their mean square.
    has_shift : bool
        Whether there were pairs enough to estimate the shift as well as the rotation.
    """

    offset: CameraOffset
    residuals_px: NDArray[np.float64]
    rms_px: float
    has_shift: bool


def camera_of(image: CameraImage) -> str:
    """Which camera took an image, by its name without its numbers: ``front_0012`` is ``front``.

    Images whose names are nothing but numbers are named by their folder.
    """
    words = [word for word in re.split(r"\d{3,}", image.path.stem) if word.strip(" _-.")]
    return "_".join(word.strip(" _-.") for word in words) or image.path.parent.name


def apply_offset(
    image: CameraImage, offset: CameraOffset, trajectory: Trajectory | None
) -> CameraImage:
    """An image as its camera's offset wants it.

    Parameters
    ----------
    trajectory : Trajectory or None
        What the time moves the camera along; the time stays without effect where it doesn't
        cover both moments.
    """
    return _move_images([image], offset, trajectory)[0]


def apply_offsets(
    images: ImageList, offsets: Mapping[str, CameraOffset], trajectory: Trajectory | None
) -> ImageList:
    """All images, each with the offset of its camera; cameras without one stay as delivered."""
    if all(offset.is_zero for offset in offsets.values()):
        return images
    moved = list(images)
    cameras = np.array([camera_of(image) for image in images])
    for camera, offset in offsets.items():
        own = np.flatnonzero(cameras == camera)
        for number, image in zip(
            own.tolist(),
            _move_images([images[n] for n in own.tolist()], offset, trajectory),
            strict=True,
        ):
            moved[number] = image
    return ImageList(tuple(moved))


def angles_of(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of rotations R3(kappa) R2(phi) R1(omega).

    Parameters
    ----------
    rotations : (..., 3, 3) float64

    Returns
    -------
    (..., 3) float64
        Omega, phi and kappa, deg.
    """
    r = rotations
    level = np.hypot(r[..., 2, 1], r[..., 2, 2])
    phi = np.arctan2(r[..., 2, 0], level)
    # Where the camera looks along east or west only the sum of omega and kappa is defined.
    is_steep = level < _STEEP
    omega = np.where(is_steep, 0.0, np.arctan2(-r[..., 2, 1], r[..., 2, 2]))
    kappa = np.where(
        is_steep,
        np.arctan2(r[..., 0, 1], r[..., 1, 1]),
        np.arctan2(-r[..., 1, 0], r[..., 0, 0]),
    )
    return np.asarray(np.degrees(np.stack([omega, phi, kappa], axis=-1)))


def _move_images(
    images: Sequence[CameraImage], offset: CameraOffset, trajectory: Trajectory | None
) -> list[CameraImage]:
    """Images of one camera with its offset."""
    if offset.is_zero or not images:
        return list(images)
    rotations = np.array([Camera(image).rotation for image in images])
    centres = np.array([image.xyz for image in images])
    times = np.array([image.time_s for image in images])
    if offset.time_s and trajectory is not None:
        known = trajectory.covers(times) & trajectory.covers(times + offset.time_s)
        before, after = times[known], times[known] + offset.time_s
        turns = trajectory.rotations_at(after) @ trajectory.rotations_at(before).swapaxes(1, 2)
        lever = centres[known] - trajectory.positions_at(before)
        centres[known] = trajectory.positions_at(after) + np.einsum("nij,nj->ni", turns, lever)
        rotations[known] = rotations[known] @ turns.swapaxes(1, 2)
        times[known] = after
    # The transposed rotation takes camera axes to project axes.
    centres += np.array([offset.right_m, offset.up_m, -offset.forward_m]) @ rotations
    angles = angles_of(_turn_of(offset) @ rotations)
    return [
        dataclasses.replace(
            image, time_s=time, xyz=tuple(xyz), omega_deg=omega, phi_deg=phi, kappa_deg=kappa
        )
        for image, time, xyz, (omega, phi, kappa) in zip(
            images, times.tolist(), centres.tolist(), angles.tolist(), strict=True
        )
    ]


def estimate_offset(
    pairs: Sequence[PixelPair], trajectory: Trajectory | None = None, *, time_s: float = 0.0
) -> EstimatedOffset:
    """The offset with which measured points fall on the pixels that show them.

    Rotation from two pairs on, rotation and shift from five on, by least squares of the distances
    in pixels; the time is taken as given, as places alone hardly tell it from a shift.

    Raises
    ------
    Unsuitable
        There are too few pairs, or their places don't determine the offset.
    """
    from scipy.optimize import least_squares

    if len(pairs) < _PAIRS_FOR_ROTATION:
        raise Unsuitable(_FEW, Text.same(f"{len(pairs)}"), _MORE)
    has_shift = len(pairs) >= _PAIRS_FOR_SHIFT
    delivered = [(apply_offset(p.image, CameraOffset(time_s=time_s), trajectory), p) for p in pairs]

    def misses(unknowns: NDArray[np.float64]) -> NDArray[np.float64]:
        offset = _offset_of(unknowns)
        away = [
            Camera(apply_offset(image, offset, None)).pixels_of(np.array([pair.xyz]))[0]
            - pair.pixel
            for image, pair in delivered
        ]
        return np.asarray(np.nan_to_num(np.concatenate(away), nan=_BEHIND_PX))

    start = np.zeros(6 if has_shift else 3)
    found = least_squares(misses, start, method="lm")
    singular = np.linalg.svd(np.asarray(found.jac, dtype=np.float64), compute_uv=False)
    if not found.success or singular[-1] < _LEAST_SINGULAR * singular[0]:
        raise Unsuitable(_NOT_DETERMINED, Text.same(f"{len(pairs)}"), _SPREAD)
    residuals = np.linalg.norm(found.fun.reshape(-1, 2), axis=1)
    offset = dataclasses.replace(_offset_of(found.x), time_s=time_s)
    rms = float(np.sqrt(np.mean(residuals**2)))
    return EstimatedOffset(offset, residuals, rms, has_shift)


def residuals_px(
    pairs: Sequence[PixelPair], offset: CameraOffset, trajectory: Trajectory | None
) -> NDArray[np.float64]:
    """How far pairs are off with an offset: (n,), px; NaN for places behind the camera."""
    away = [
        Camera(apply_offset(pair.image, offset, trajectory)).pixels_of(np.array([pair.xyz]))[0]
        - pair.pixel
        for pair in pairs
    ]
    return np.asarray(np.linalg.norm(np.array(away).reshape(-1, 2), axis=1))


def _offset_of(unknowns: NDArray[np.float64]) -> CameraOffset:
    return CameraOffset(*(float(value) for value in unknowns))


def _turn_of(offset: CameraOffset) -> NDArray[np.float64]:
    """(3, 3), from the delivered camera's axes to those of the turned one."""
    angles = np.radians([offset.roll_deg, offset.pitch_deg, offset.yaw_deg])
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    # Camera axes: x right, y up, z backwards.
    roll = np.array([[cr, -sr, 0], [sr, cr, 0], [0, 0, 1]])
    pitch = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    yaw = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return np.asarray(roll @ pitch @ yaw, dtype=np.float64)


_FEW = Text(
    "There are too few pairs for an offset.", "オフセットを求めるための対応点が足りません。"
)
_MORE = Text(
    "Mark at least two places in the image and in a view of the points; five give the shift too.",
    "画像と点群で2か所以上の対応点を指定してください（5か所以上で位置のずれも求めます）。",
)
_NOT_DETERMINED = Text(
    "The pairs lie too close together to determine the offset.",
    "対応点が近すぎるため、オフセットを決められません。",
)
_SPREAD = Text(
    "Spread them over the image, near and far.", "画像全体に、手前と奥に散らして指定してください。"
)
