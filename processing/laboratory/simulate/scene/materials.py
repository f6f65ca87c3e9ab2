"""What surfaces are made of, and how a laser and a camera see them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, auto


class Material(IntEnum):
    """What a triangle is made of; fits into a byte."""

    ASPHALT = 0
    WORN_ASPHALT = auto()
    CONCRETE = auto()
    OLD_CONCRETE = auto()
    PAVING = auto()
    TACTILE = auto()
    PAINT = auto()
    STEEL = auto()
    PAINTED_METAL = auto()
    GRATING = auto()
    SOIL = auto()
    GRAVEL = auto()
    GRASS = auto()
    LEAVES = auto()
    BARK = auto()
    WOOD = auto()
    SIGN_FACE = auto()
    SIGN_BACK = auto()
    GLASS = auto()
    PLASTER = auto()
    BRICK = auto()
    ROOF = auto()
    CAR_PAINT = auto()
    RUBBER = auto()
    CLOTH = auto()
    CABLE = auto()
    MIRROR = auto()
    WATER = auto()
    PLASTIC = auto()
    NET = auto()
    OLD_IRON = auto()
    JOINT = auto()


@dataclass(frozen=True)
class SurfaceOptics:
    """How a material reflects and how rough it is.

    Attributes
    ----------
    reflectance : float
        Of the near infrared (0–1) at right angles, diffuse.
    spread : float
        Relative standard deviation of the reflectance from place to place.
    roughness_m : float
        Standard deviation of the surface about its triangles, m.
    grain_m : float
        Over how many metres the roughness changes.
    shine : float
        Share of the light that leaves as a mirror does: lost but near right angles.
    retro : float
        How many times more than a diffuse white surface it returns (retro-reflective beads).
    stands_m : float
        Height of blades that stand on it and return the beam first, m; 0 for none.
    is_open : bool
        A beam may pass on between its parts (leaves, nets): later returns come from behind.
    colour : tuple of int
        Red, green, blue of a photograph, 0–255.
    """

    reflectance: float
    spread: float
    roughness_m: float
    grain_m: float
    shine: float = 0.0
    retro: float = 0.0
    stands_m: float = 0.0
    is_open: bool = False
    colour: tuple[int, int, int] = (128, 128, 128)


# Reflectances at 905–1550 nm in the range of published spectra (ECOSTRESS library 1.0: asphalt
# 0.1–0.25, concrete 0.3–0.5, grass and leaves 0.3–0.6, soil 0.3–0.5); roughness of pavements from
# mean profile depths of 0.3–1.5 mm (ISO 13473-1).
SURFACES: dict[Material, SurfaceOptics] = {
    Material.ASPHALT: SurfaceOptics(0.13, 0.18, 0.0012, 0.02, colour=(92, 92, 95)),
    Material.WORN_ASPHALT: SurfaceOptics(0.2, 0.22, 0.0018, 0.03, colour=(122, 120, 117)),
    Material.CONCRETE: SurfaceOptics(0.45, 0.1, 0.0007, 0.05, colour=(178, 176, 170)),
    Material.OLD_CONCRETE: SurfaceOptics(0.3, 0.2, 0.0015, 0.04, colour=(140, 137, 128)),
    Material.PAVING: SurfaceOptics(0.33, 0.15, 0.001, 0.1, colour=(158, 142, 130)),
    Material.TACTILE: SurfaceOptics(0.48, 0.12, 0.002, 0.02, colour=(222, 186, 50)),
    Material.PAINT: SurfaceOptics(0.6, 0.18, 0.0008, 0.03, retro=0.6, colour=(232, 232, 228)),
    Material.STEEL: SurfaceOptics(0.35, 0.15, 0.0004, 0.05, shine=0.4, colour=(120, 118, 116)),
    Material.PAINTED_METAL: SurfaceOptics(
        0.55, 0.08, 0.0003, 0.1, shine=0.15, colour=(214, 216, 214)
    ),
    Material.GRATING: SurfaceOptics(0.25, 0.2, 0.0008, 0.02, shine=0.3, colour=(96, 94, 92)),
    Material.SOIL: SurfaceOptics(0.35, 0.2, 0.008, 0.08, colour=(124, 100, 76)),
    Material.GRAVEL: SurfaceOptics(0.32, 0.25, 0.007, 0.025, colour=(148, 144, 138)),
    Material.GRASS: SurfaceOptics(0.42, 0.25, 0.01, 0.06, stands_m=0.12, colour=(92, 124, 58)),
    Material.LEAVES: SurfaceOptics(0.45, 0.2, 0.002, 0.05, is_open=True, colour=(62, 104, 44)),
    Material.BARK: SurfaceOptics(0.35, 0.2, 0.002, 0.02, colour=(98, 82, 66)),
    Material.WOOD: SurfaceOptics(0.45, 0.15, 0.001, 0.05, colour=(160, 130, 92)),
    Material.SIGN_FACE: SurfaceOptics(0.6, 0.05, 0.0003, 0.1, retro=20.0, colour=(40, 78, 170)),
    Material.SIGN_BACK: SurfaceOptics(0.4, 0.08, 0.0003, 0.1, shine=0.2, colour=(150, 152, 154)),
    Material.GLASS: SurfaceOptics(0.04, 0.1, 0.0002, 0.2, shine=0.85, colour=(96, 120, 134)),
    Material.PLASTER: SurfaceOptics(0.5, 0.12, 0.0015, 0.05, colour=(206, 200, 188)),
    Material.BRICK: SurfaceOptics(0.38, 0.15, 0.002, 0.05, colour=(156, 108, 88)),
    Material.ROOF: SurfaceOptics(0.25, 0.15, 0.004, 0.1, colour=(82, 84, 92)),
    Material.CAR_PAINT: SurfaceOptics(0.4, 0.1, 0.0003, 0.2, shine=0.5, colour=(176, 180, 188)),
    Material.RUBBER: SurfaceOptics(0.06, 0.2, 0.001, 0.02, colour=(38, 38, 40)),
    Material.CLOTH: SurfaceOptics(0.4, 0.2, 0.006, 0.08, colour=(70, 76, 110)),
    Material.CABLE: SurfaceOptics(0.12, 0.1, 0.0005, 0.05, colour=(40, 40, 42)),
    Material.MIRROR: SurfaceOptics(0.1, 0.1, 0.0003, 0.2, shine=0.9, colour=(168, 176, 180)),
    Material.WATER: SurfaceOptics(0.03, 0.2, 0.003, 0.1, shine=0.9, colour=(70, 84, 86)),
    Material.PLASTIC: SurfaceOptics(0.5, 0.1, 0.0005, 0.1, colour=(226, 112, 40)),
    Material.NET: SurfaceOptics(0.4, 0.15, 0.002, 0.05, is_open=True, colour=(70, 128, 96)),
    # Cast iron with a pattern a few mm high, dark with rust and dirt; dirt in the joint of a frame.
    Material.OLD_IRON: SurfaceOptics(0.08, 0.2, 0.0015, 0.03, shine=0.1, colour=(78, 70, 64)),
    Material.JOINT: SurfaceOptics(0.07, 0.25, 0.001, 0.02, colour=(60, 56, 50)),
}
