"""Plates of road signs: their outlines, bodies and truth.

Pieces of a plate: 1 the bright face, 2 the dull back, 0 the rim and the brackets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, TriangleShape
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.methods.road.signs.sign_shapes import rounded_corners

SIGN = 65
FRONT_PIECE, BACK_PIECE = 1, 2
THICK_M = 0.0025

PlateShape = Literal["circle", "triangle", "square", "diamond", "pentagon", "rectangle"]

_ARC = 5  # corners of a rounded corner
_CORNER_SHARE = {"triangle": 0.03, "square": 0.05, "diamond": 0.06, "pentagon": 0.05}


@dataclass(frozen=True)
class SignPlate:
    """A plate as it hangs.

    Attributes
    ----------
    shape : str
        As the contract names them; a triangle stands on its tip.
    size_m : float
        Diameter or side; of a pentagon its base, of a rectangle its width.
    high_m : float
        Of a rectangle; else 0.
    is_supplementary : bool
        A small one that belongs to the plate above it.
    """

    shape: PlateShape
    size_m: float
    high_m: float = 0.0
    is_supplementary: bool = False


@dataclass(frozen=True)
class PlateMounting:
    """Where and how a plate hangs.

    Attributes
    ----------
    middle : (3,) float64
        Of its outline's box, on the bright face, m.
    facing_rad : float
        Where its bright face looks: anticlockwise from east.
    tilt_rad, roll_rad : float
        How far it looks up, and is turned about the way it looks.
    bend : float
        1/m: how much it is bent about its upright axis.
    ground_m : float
        z of the ground under it.
    """

    middle: Floats
    facing_rad: float
    tilt_rad: float = 0.0
    roll_rad: float = 0.0
    bend: float = 0.0
    ground_m: float = 0.0


def outline(plate: SignPlate) -> Floats:
    """Its corners, (n, 2) float64, m: to the right and up as one looks at it, anticlockwise.

    Proportions after the Order on Road Signs (標識令, 別表第二) and templates of the literature:
    a pentagon's upright sides are a third of its base and its height is its base.
    """
    size = plate.size_m
    half = size / 2
    if plate.shape == "circle":
        angles = np.arange(40) * (2 * np.pi / 40)
        return half * np.column_stack([np.cos(angles), np.sin(angles)])
    if plate.shape == "triangle":
        high = size * np.sqrt(3) / 2
        corners = [[0.0, -high / 2], [half, high / 2], [-half, high / 2]]
    elif plate.shape == "diamond":
        away = size / np.sqrt(2)
        corners = [[0.0, -away], [away, 0.0], [0.0, away], [-away, 0.0]]
    elif plate.shape == "pentagon":
        corners = [[-half, -half], [half, -half], [half, -half + size / 3], [0.0, half]]
        corners += [[-half, -half + size / 3]]
    else:
        tall = half if plate.shape == "square" else plate.high_m / 2
        corners = [[-half, -tall], [half, -tall], [half, tall], [-half, tall]]
    least = size if plate.shape != "rectangle" else min(size, plate.high_m)
    return rounded_corners(np.array(corners), least * _CORNER_SHARE.get(plate.shape, 0.05), _ARC)


def axes_of(hung: PlateMounting) -> tuple[Floats, Floats, Floats]:
    """Unit vectors of a plate: to its right as one looks at it, up, and where it looks."""
    cosine, sine = np.cos(hung.facing_rad), np.sin(hung.facing_rad)
    flat = np.cos(hung.tilt_rad)
    look = np.array([cosine * flat, sine * flat, np.sin(hung.tilt_rad)])
    right = np.array([-sine, cosine, 0.0])
    up = np.cross(look, right)
    c, s = np.cos(hung.roll_rad), np.sin(hung.roll_rad)
    return c * right + s * up, c * up - s * right, look


def face(corners: Floats, hung: PlateMounting, behind_m: float) -> TriangleShape:
    """One sheet of a plate: a fan about its middle, looking where the plate looks."""
    right, up, look = axes_of(hung)
    flat = np.concatenate([corners.mean(axis=0)[None], corners])
    deep = -hung.bend * flat[:, 0] ** 2 - behind_m
    positions = hung.middle + flat[:, :1] * right + flat[:, 1:] * up + deep[:, None] * look
    rim = np.arange(len(corners))
    following = (rim + 1) % len(corners)
    return positions, np.column_stack([np.zeros_like(rim), rim + 1, following + 1])


def add_plate(
    built: SectionBuilder, plate: SignPlate, hung: PlateMounting, chainage_m: float
) -> int:
    """Add a plate and its truth; its instance."""
    corners = outline(plate)
    front, back = face(corners, hung, 0.0), face(corners, hung, THICK_M)
    instance = built.thing("sign")
    built.mesh.add(front, Material.SIGN_FACE, SIGN, instance, piece=FRONT_PIECE)
    built.mesh.add(
        (back[0], back[1][:, ::-1]), Material.SIGN_BACK, SIGN, instance, piece=BACK_PIECE
    )
    count = len(corners)
    here = np.arange(count) + 1
    beside = here % count + 1
    rim = np.concatenate(
        [
            np.column_stack([here, here + count + 1, beside]),
            np.column_stack([beside, here + count + 1, beside + count + 1]),
        ]
    )
    built.mesh.add((np.concatenate([front[0], back[0]]), rim), Material.SIGN_BACK, SIGN, instance)
    centre, normal = centre_and_normal(front)
    box = np.concatenate([corners.min(axis=0)[None], corners.max(axis=0)[None]])
    right, up, _ = axes_of(hung)
    middle = hung.middle + box.mean(axis=0)[0] * right + box.mean(axis=0)[1] * up
    built.truth.append(
        TrueFeature(
            "signs",
            "Point",
            centre[None],
            {
                "kind": "sign",
                "shape": plate.shape,
                "size_m": plate.size_m,
                "width_m": float(box[1, 0] - box[0, 0]),
                "plate_height_m": float(box[1, 1] - box[0, 1]),
                "facing_deg": float(np.rad2deg(np.arctan2(normal[0], normal[1])) % 360),
                "height_m": float(centre[2] - hung.ground_m),
                "supplementary": plate.is_supplementary,
                "bbox_centre": [float(one) for one in middle],
            },
            instance,
            chainage_m,
        )
    )
    return instance


def centre_and_normal(shape: TriangleShape) -> tuple[Floats, Floats]:
    """Centroid of the area of some triangles, and their mean unit normal: (3,) each."""
    corners = shape[0][shape[1]]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(areas, axis=1)
    centre = (corners.mean(axis=1) * size[:, None]).sum(axis=0) / size.sum()
    normal = areas.sum(axis=0)
    return centre, normal / np.linalg.norm(normal)
