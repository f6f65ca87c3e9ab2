"""Cables between utility poles, and down to service poles in yards.

The span from a pole to the next one belongs to the section in which the first one stands.
"""

from __future__ import annotations

import numpy as np

from processing.laboratory.simulate.roadside.pole_line import LinePole, cable_ends, pole_line
from processing.laboratory.simulate.roadside.poles import POLE, SUNK_M, WIRE, pole_truth
from processing.laboratory.simulate.roadside.rods import rods
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_to_m,
)

LONGEST_SPAN_M = 75.0
_SIDES = 5
_STEPS = 24  # straight pieces of a cable: 1.3 m of a usual span, off its curve by a millimetre
_DROP_SAG_M = 0.15
_USUAL_SPAN_M = 30.0
_SEEN_WIDER_M = 0.004  # a beam 15 m away is as wide as a wire, and returns from its edge too


def hanging(starts: Floats, ends: Floats, sags: Floats, steps: int = _STEPS) -> Floats:
    """Cables as parabolas: (c, 3) ends and (c,) sags in m to (c, steps + 1, 3) places.

    A parabola differs from the catenary by less than a centimetre at these sags.
    """
    share = np.linspace(0.0, 1.0, steps + 1)[None, :, None]
    paths: Floats = starts[:, None] + share * (ends - starts)[:, None]
    paths[..., 2] -= sags[:, None] * (4 * share * (1 - share))[..., 0]
    return paths


def add_wires(positions: FreePositions, built: SectionBuilder) -> None:
    """Add the spans that begin in this section, and the cables to its yards."""
    section = positions.section
    line = pole_line(section)
    for pole, following in zip(line.poles, line.poles[1:], strict=False):
        if pole.section != section.plan.index:
            continue
        starts = cable_ends(section.alignment, pole, line)
        ends = cable_ends(section.alignment, following, line)
        span = float(np.linalg.norm(ends[0] - starts[0]))
        if span > LONGEST_SPAN_M:
            continue
        random = section.chance("span", pole.number)
        sags = (
            line.cables[:, 3] * (span / _USUAL_SPAN_M) ** 2 * random.uniform(0.8, 1.25, len(ends))
        )
        at = (pole.spot.chainage_m + following.spot.chainage_m) / 2
        paths = hanging(starts, ends, sags)
        radii = line.cables[:, 2] + _SEEN_WIDER_M
        for path, sag, radius in zip(paths, sags.tolist(), radii.tolist(), strict=True):
            _add_cable(built, path, (radius, sag, at))
    for pole in line.poles:
        if pole.section == section.plan.index:
            _add_drop_wires(positions, built, pole)


def _add_drop_wires(positions: FreePositions, built: SectionBuilder, pole: LinePole) -> None:
    section = positions.section
    random = section.chance("drop wires", pole.number)
    start = cable_ends(section.alignment, pole, pole_line(section))[-1]
    for _ in range(int(random.integers(0, 4))):
        side = pole.spot.side if random.random() < 0.65 else -pole.spot.side
        plan = section.plan.side(side)
        outside = plan.band("outside")
        if plan.outside != "lots" or outside is None:
            continue
        reach = float(random.uniform(-9.0, 9.0))
        away = outside.inner_m + float(random.uniform(0.25, 0.6))
        spot = FreePosition(pole.spot.chainage_m + reach, side * away)
        if away > free_to_m(plan) or not positions.take(spot, 0.7):
            continue
        # Lowest height of service drops over roads: 5 m (電気設備技術基準の解釈, article 116).
        crosses = side != pole.spot.side
        high = float(random.uniform(5.6, 7.0) if crosses else random.uniform(4.2, 6.2))
        top = _add_service_pole(positions, built, spot, high)
        path = hanging(start[None], top[None], np.array([_DROP_SAG_M]))[0]
        _add_cable(built, path, (0.006, _DROP_SAG_M, spot.chainage_m))


def _add_cable(built: SectionBuilder, path: Floats, shape: tuple[float, float, float]) -> None:
    """One cable with its truth; a piece of it for each step (``shape``: radius, sag, chainage)."""
    radius, sag, at = shape
    instance = built.thing("wire")
    vertices, triangles = rods(path[None], radius, _SIDES, is_closed=False)
    # The first half of the triangles has one of each pair, the second the other.
    piece = np.tile(np.repeat(np.arange(_STEPS), _SIDES), 2)
    built.mesh.add((vertices, triangles), Material.CABLE, WIRE, instance, piece=piece)
    facts: dict[str, str | int | float | bool | list[float] | None] = {
        "kind": "wire",
        "sag_m": sag,
        "diameter_m": 2 * radius,
    }
    built.truth.append(TrueFeature("wires", "LineString", path, facts, instance, at))


def _add_service_pole(
    positions: FreePositions, built: SectionBuilder, spot: FreePosition, high_m: float
) -> Floats:
    """A thin steel pole in a yard (引込柱); its top."""
    random = positions.section.chance("service pole", int(spot.chainage_m * 100))
    foot = positions.where(spot)
    top = foot + np.array([*random.normal(0, 0.03, 2), high_m])
    radius = float(random.choice([0.0445, 0.05715, 0.0695]))
    instance = built.thing("pole")
    path = np.stack([foot - [0.0, 0.0, SUNK_M], foot, top])
    material = Material.PAINTED_METAL if random.random() < 0.7 else Material.STEEL
    built.mesh.add(rods(path[None], radius, 12), material, POLE, instance, piece=1)
    facts = {"height_m": high_m, "diameter_m": 2 * radius}
    pole_truth(built, spot, instance, foot, type="other", **facts)
    return np.asarray(top - [0.0, 0.0, 0.1], np.float64)
