"""Control points of a simulated street: feet of poles, surveyed with small errors."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import TrueFeature

SURVEYED_M = 0.003
"""Standard deviation of a coordinate: a total station set up with care."""

_CHECKED = 3
"""Every so many are check points."""

_HEADER = "id,easting_m,northing_m,height_m,role,where"


def write_control_points(
    folder: Path, features: Iterable[TrueFeature], origin: Floats, seed: int, per_km: float
) -> None:
    """Write ``control_points.csv`` as delivered, and the same without errors among the truth.

    Points lie as evenly along the street as there are poles; where there are none, there are fewer.
    """
    random = chance(seed, "control points")
    poles = sorted((one for one in features if one.file == "poles"), key=_chainage)
    chainages = np.array([one.chainage_m for one in poles])
    rows: list[tuple[list[str], str, TrueFeature]] = []
    if poles:
        step = 1000.0 / per_km
        wanted = np.arange(max(0.0, chainages[0]), chainages[-1] + step, step)
        near = np.abs(chainages[None] - wanted[:, None]).argmin(axis=1)
        chosen = sorted(set(near.tolist()))
        rows = [
            (
                [f"K{number:02d}"],
                "check" if number % _CHECKED == 0 else "control",
                poles[one],
            )
            for number, one in enumerate(chosen, 1)
        ]
    for path, sigma in (
        (folder / "control_points.csv", SURVEYED_M),
        (folder / "truth" / "control_points.csv", 0.0),
    ):
        lines = [_HEADER]
        for words, role, pole in rows:
            place = pole.xyz[0] + origin + sigma * random.normal(size=3)
            lines.append(",".join([*words, *(f"{one:.4f}" for one in place), role, "pole_foot"]))
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _chainage(feature: TrueFeature) -> float:
    return feature.chainage_m
