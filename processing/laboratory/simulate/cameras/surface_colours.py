"""Colours of what pixels show: by material, by thing, by place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.cameras.grain_kernels import Singles, grain
from processing.laboratory.simulate.cameras.sign_pictures import paint_signs
from processing.laboratory.simulate.scene.materials import SURFACES, Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh

_COLOURS = np.array([SURFACES[one].colour for one in Material], np.float32)
_SPREADS = np.array([SURFACES[one].spread for one in Material], np.float32)
_GAMMA = 2.2
_FINE_M, _COARSE_M = 0.04, 0.9
_GREY_VARIETY = 0.18  # how far brightness of one thing's material may lie from another's

# As many as are sold: white, silver, black, grey and dark blue before red (自動車の色の割合).
_PALETTES: dict[Material, list[tuple[int, int, int]]] = {
    Material.CAR_PAINT: [
        (176, 180, 188), (196, 198, 200), (140, 146, 152), (150, 34, 38), (70, 96, 150),
        (196, 182, 150), (120, 144, 164),
    ],
    Material.CLOTH: [
        (70, 76, 110), (44, 44, 50), (122, 120, 116), (176, 168, 152), (138, 52, 56),
        (60, 88, 74), (206, 202, 196), (96, 80, 64), (58, 84, 128),
    ],
    Material.ROOF: [(82, 84, 92), (64, 60, 58), (120, 72, 58), (58, 72, 92), (96, 100, 100)],
    Material.PLASTER: [
        (206, 200, 188), (222, 220, 214), (186, 168, 142), (164, 162, 158), (200, 184, 160),
        (146, 128, 112),
    ],
    Material.BRICK: [(156, 108, 88), (134, 84, 70), (176, 140, 112), (128, 116, 106)],
    Material.PAINTED_METAL: [
        (214, 216, 214), (214, 216, 214), (190, 194, 196), (206, 204, 190), (150, 140, 126),
    ],
    Material.PLASTIC: [(226, 112, 40), (214, 60, 44), (230, 190, 40), (226, 112, 40)],
}  # fmt: skip

_VEHICLES = 64
_LAMPS = np.array([(186, 30, 34), (196, 40, 36), (170, 26, 30), (222, 116, 40)], np.float32)

_LINEAR = ((np.arange(256) / 255.0) ** _GAMMA).astype(np.float32)
_SHOWN = np.round(255 * (np.arange(4096) / 4095.0) ** (1 / _GAMMA)).astype(np.uint8)


def colours_of(mesh: Mesh, triangles: Integers, positions: Floats) -> Singles:
    """What surfaces look like in plain light.

    Parameters
    ----------
    mesh : Mesh
    triangles : (n,) int64
    positions : (n, 3) float64
        Where on them, in the frame of the mesh.

    Returns
    -------
    (n, 3) float32
        Linear red, green, blue, 0 to 1.
    """
    material, instance = mesh.material[triangles], mesh.instance[triangles]
    colours = _COLOURS[material]
    mixed = _mixed(instance)
    for kind, palette in _PALETTES.items():
        rows = np.flatnonzero(material == kind)
        table = np.array(palette, np.float32)
        colours[rows] = table[mixed[rows] % len(table)]
    is_lamp = (material == Material.PLASTIC) & (mesh.label[triangles] == _VEHICLES)
    colours[is_lamp] = _LAMPS[mixed[is_lamp] % len(_LAMPS)]
    paint_signs(mesh, triangles, positions, colours)
    stains = 0.6 * grain(positions, _COARSE_M) + 0.7 * grain(positions, _FINE_M)
    bright = 1 + _SPREADS[material] * stains
    bright *= 1 + _GREY_VARIETY * ((mixed >> 9) % 101 / 50.0 - 1.0).astype(np.float32) * (
        instance > 0
    )
    linear = _LINEAR[np.clip(colours, 0, 255).astype(np.uint8)]
    return np.asarray(linear * bright[:, None], np.float32)


def tone_map(linear: Singles) -> NDArray[np.uint8]:
    """Linear light 0 to 1 as bytes of a picture, with a soft shoulder above three quarters."""
    knee = 0.75
    over = np.maximum(linear - knee, 0)
    soft = np.minimum(linear, knee) + (1 - knee) * (over / (over + (1 - knee)))
    return np.asarray(_SHOWN[np.clip(soft * 4095, 0, 4095).astype(np.int32)])


def _mixed(instance: NDArray[np.int32]) -> Integers:
    """Numbers of things, mixed so that neighbours differ."""
    mixed = instance.astype(np.int64) * 2654435761 & 0xFFFFFFFF
    return (mixed ^ (mixed >> 15)) * 2246822519 >> 7 & 0xFFFFFF
