"""Cameras on the vehicle: where they sit, which way they look, through which lens."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scanning.simulated_passes import SimulatedPass
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.recording.camera_images.calibration import angles_of
from processing.recording.camera_images.image_list import CameraImage, ProjectionName

Distortion = tuple[float, float, float, float, float]


@dataclass(frozen=True)
class RigCamera:
    """One camera of a rig.

    Attributes
    ----------
    name : str
        Of its files: ``front``, ``left``, ``right``, ``panorama``.
    lever_m : (3,) float
        From the trajectory's reference point: forward, left, up.
    yaw_deg, pitch_deg, roll_deg : float
        How it looks: to the left of forward, up, right side down.
    focal_px, cx_px, cy_px : float
    width_px, height_px : int
    distortion : tuple of float
        Brown's k1, k2, p1, p2, k3.
    projection : str
    """

    name: str
    lever_m: tuple[float, float, float]
    yaw_deg: float
    pitch_deg: float
    roll_deg: float
    focal_px: float
    cx_px: float
    cy_px: float
    width_px: int
    height_px: int
    distortion: Distortion = (0.0, 0.0, 0.0, 0.0, 0.0)
    projection: ProjectionName = "perspective"

    def turn(self) -> Floats:
        """(3, 3): rows are the camera's right, up and backward axes in the vehicle's axes."""
        yaw, pitch, roll = np.radians([self.yaw_deg, self.pitch_deg, self.roll_deg])
        ahead = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
        level = np.array([np.sin(yaw), -np.cos(yaw), 0.0])
        upward = np.cross(level, ahead)
        right = np.cos(roll) * level - np.sin(roll) * upward
        return np.stack([right, np.cross(right, ahead), -ahead])


@dataclass(frozen=True)
class Pose:
    """Where the vehicle is when its cameras open.

    Attributes
    ----------
    time_s : float
        From the pass' beginning.
    position : (3,) float64
        Of the reference point, m, the street's frame.
    turn : (3, 3) float64
        Columns: the vehicle's forward, left and up axes.
    error : (3,) float64
        What the delivered position is off, m.
    chainage_m : float
    """

    time_s: float
    position: Floats
    turn: Floats
    error: Floats
    chainage_m: float


def rig_of(seed: int) -> tuple[RigCamera, ...]:
    """The cameras that a seed's vehicle carries: one ahead, three, or a panorama too."""
    random = chance(seed, "rig")
    kind = float(random.random())
    front = _camera(random, "front", 0.0)
    if kind < 0.25:
        return (front,)
    aside = float(random.uniform(50, 90))
    sides = _camera(random, "left", aside), _camera(random, "right", -aside)
    if kind < 0.7:
        return (front, *sides)
    panorama = _panorama(random)
    return (front, panorama) if kind < 0.85 else (panorama,)


def poses_of_pass(driven: SimulatedPass, spacing_m: float = 10.0) -> list[Pose]:
    """A pose every so many metres driven; none while the vehicle stands."""
    direction = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(driven.chainages)))])
    marks = np.arange(0.3 * spacing_m, direction[-1], spacing_m)
    rows = np.searchsorted(direction, marks).tolist()
    return [
        Pose(
            float(driven.time_s[row]),
            driven.positions[row],
            driven.rotations[row],
            driven.errors[row],
            float(driven.chainages[row]),
        )
        for row in rows
    ]


def image_of(camera: RigCamera, pose: Pose, path: Path) -> CameraImage:
    """The image that a camera truly takes, in the street's frame and on the pass' time."""
    omega, phi, kappa = angles_of(camera.turn() @ pose.turn.T).tolist()
    x, y, z = (pose.position + pose.turn @ np.array(camera.lever_m)).tolist()
    return CameraImage(
        path=path,
        time_s=pose.time_s,
        xyz=(x, y, z),
        omega_deg=omega,
        phi_deg=phi,
        kappa_deg=kappa,
        focal_px=camera.focal_px,
        cx_px=camera.cx_px,
        cy_px=camera.cy_px,
        width_px=camera.width_px,
        height_px=camera.height_px,
        distortion=camera.distortion,
        projection=camera.projection,
    )


def _camera(random: Generator, name: str, yaw_deg: float) -> RigCamera:
    wide, high = [(800, 600), (960, 600), (1024, 768)][int(random.integers(3))]
    aside = np.sin(np.radians(yaw_deg))
    return RigCamera(
        name,
        (
            round(float(random.uniform(0.4, 1.0)), 3),
            round(float(0.45 * aside + random.normal(0, 0.05)), 3),
            round(float(random.uniform(0.0, 0.35)), 3),
        ),
        yaw_deg + float(random.normal(0, 0.6)),
        float(random.uniform(-12, 2)),
        float(random.normal(0, 0.4)),
        round(wide * float(random.uniform(0.52, 0.85)), 2),
        round((wide - 1) / 2 + float(random.normal(0, 4)), 2),
        round((high - 1) / 2 + float(random.normal(0, 4)), 2),
        wide,
        high,
        _distortion(random),
    )


def _distortion(random: Generator) -> Distortion:
    """Barrel or pincushion; none in rigs whose images were made plain before delivery."""
    if random.random() < 0.3:
        return (0.0, 0.0, 0.0, 0.0, 0.0)
    k1 = float(random.uniform(-0.28, 0.04))
    # Above 0.45 k1² the radial polynomial of k1 and k2 rises everywhere: no ring is seen twice.
    k2 = k1 * k1 * float(random.uniform(0.6, 1.2))
    p1, p2 = (float(random.normal(0, 0.0008)) for _ in range(2))
    return (round(k1, 6), round(k2, 6), round(p1, 7), round(p2, 7), 0.0)


def _panorama(random: Generator) -> RigCamera:
    wide = int(random.choice([1200, 1440]))
    return RigCamera(
        "panorama",
        (
            round(float(random.uniform(-0.4, 0.2)), 3),
            0.0,
            round(float(random.uniform(0.4, 0.8)), 3),
        ),
        float(random.normal(0, 1.0)),
        float(random.normal(0, 0.5)),
        float(random.normal(0, 0.5)),
        round(wide / (2 * np.pi), 4),
        (wide - 1) / 2,
        (wide / 2 - 1) / 2,
        wide,
        wide // 2,
        projection="equirectangular",
    )
