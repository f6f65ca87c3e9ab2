"""Points where nothing is: mirrored by water and metal, echoed twice, dust, arcs of phase."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import CastHits, RaycastScene
from processing.laboratory.simulate.scanning.passing_noise import way_through
from processing.laboratory.simulate.scanning.returns import (
    NO_EVIDENCE,
    BeamHits,
    Returns,
    number_returns,
)
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers
from processing.laboratory.simulate.sites.bodies import SiteKind
from processing.laboratory.simulate.sites.layout import StandingObject
from processing.laboratory.simulate.sites.movement import DustCloud

MACHINES = (SiteKind.EXCAVATOR, SiteKind.DUMP_TRUCK, SiteKind.BULLDOZER, SiteKind.ROLLER)

# How often a beam that meets a mirror-like surface is taken from what the mirror shows.
_MIRRORS = {
    Material.WATER: 0.5,
    Material.GLASS: 0.2,
    Material.STEEL: 0.01,
    Material.CAR_PAINT: 0.01,
}
_FARTHEST_MIRRORED_M = 60.0
_NEAR_MACHINE_M = 2.5
_TWICE_NEAR_MACHINE = 0.03
_TWICE_ON_WET = 0.002
_TAIL = 0.12  # of the beams at an edge, on a usual day
_LONGEST_TAIL_M = 6.0
_IN_THE_AIR = 1.5e-5
_PHASE_IN_THE_SKY = 4e-4


@dataclass(frozen=True)
class PhaseArc:
    """Ranges that a phase-based scanner gives wrongly: a piece of a ring about it.

    Attributes
    ----------
    reach_m : float
    from_rad, to_rad : float
        Azimuths; anticlockwise from east.
    low_rad, high_rad : float
        Elevations.
    share : float
        Of the pulses there.
    """

    reach_m: float
    from_rad: float
    to_rad: float
    low_rad: float
    high_rad: float
    share: float


@dataclass(frozen=True)
class GhostSources:
    """Where ghosts come from in one scan.

    Attributes
    ----------
    wetness : float
        Share of the ground that is wet.
    is_phase : bool
        Whether the scanner measures by phase.
    restless : float
        How many times more than usual is echoed twice or seen in the air on that day.
    """

    machines: list[StandingObject]
    dust: list[DustCloud]
    arcs: list[PhaseArc]
    wetness: float
    is_phase: bool
    restless: float


@dataclass(frozen=True)
class Ghosts:
    """Pulses that return from where nothing is, in place of what they met.

    Attributes
    ----------
    rays : (n,) int64
        Rows of the beams, rising.
    ranges, strengths : (n,) float64
    kinds : (n,) int8
        `SiteKind.GHOST` or `SiteKind.DUST`.
    """

    rays: Integers
    ranges: Floats
    strengths: Floats
    kinds: NDArray[np.int8]


def arcs_of(random: Generator) -> list[PhaseArc]:
    """Arcs of one scan of a phase-based scanner; often none."""
    arcs = []
    for _ in range(int(random.integers(0, 3))):
        start, low = random.uniform(-np.pi, np.pi), np.radians(random.uniform(-35, 5))
        arcs.append(
            PhaseArc(
                random.uniform(3, 25),
                start,
                start + np.radians(random.uniform(15, 120)),
                low,
                low + np.radians(random.uniform(0.3, 2.0)),
                random.uniform(0.1, 0.6),
            )
        )
    return arcs


def ghosts_of(
    random: Generator,
    beams: Beams,
    met: BeamHits,
    seen: tuple[CastHits, RaycastScene],
    ghost_sources: GhostSources,
) -> Ghosts:
    """Ghosts of a stretch of pulses.

    Parameters
    ----------
    met : BeamHits
        What the beams met first, of all that stands and moves.
    seen : (CastHits, RaycastScene)
        What they met of what stands, for what mirrors show.
    """
    parts = [_dust(random, beams, met, cloud) for cloud in ghost_sources.dust]
    parts.append(_mirrored(random, beams, met, *seen))
    parts.append(_twice(random, beams, met, ghost_sources))
    parts.append(_mixed_points(random, beams, met, ghost_sources))
    parts.append(_in_the_air(random, met, ghost_sources))
    parts += [_arc(random, beams, arc) for arc in ghost_sources.arcs]
    rays = np.concatenate([one.rays for one in parts])
    rays, first = np.unique(rays, return_index=True)
    return Ghosts(
        rays,
        np.concatenate([one.ranges for one in parts])[first],
        np.concatenate([one.strengths for one in parts])[first],
        np.concatenate([one.kinds for one in parts])[first],
    )


def add_ghosts(
    returns: Returns, kinds: NDArray[np.int8], beams: Beams, ghosts: Ghosts
) -> tuple[Returns, NDArray[np.int8]]:
    """Returns with ghosts in place of what their pulses met, in the order of the pulses."""
    if ghosts.rays.size == 0:
        return returns, kinds
    rays = ghosts.rays
    taken = np.zeros(beams.time_s.size, np.bool_)
    taken[rays] = True
    keep = ~taken[returns.pulse - beams.first]
    kept = returns.chosen(keep)
    ones = np.ones(rays.size, np.uint8)
    positions = beams.origins[rays] + beams.directions[rays] * ghosts.ranges[:, None]
    pulse = np.concatenate([kept.pulse, beams.first + rays])
    order = np.argsort(pulse, kind="stable")
    joined = Returns(
        pulse,
        np.concatenate([kept.time_s, beams.time_s[rays]]),
        np.concatenate([kept.xyz, positions]),
        np.concatenate([kept.strength, ghosts.strengths]),
        np.concatenate([kept.number, ones]),
        np.concatenate([kept.count, ones]),
        np.concatenate([kept.label, ones]),
        np.concatenate([kept.evidence, np.full(rays.size, NO_EVIDENCE)]),
    ).chosen(order)
    return number_returns(joined), np.concatenate([kinds[keep], ghosts.kinds])[order]


def _ghosts(
    rays: Integers, ranges: Floats, strength: Floats | float, kind: SiteKind = SiteKind.GHOST
) -> Ghosts:
    strengths = np.broadcast_to(np.asarray(strength, np.float64), rays.shape).copy()
    return Ghosts(rays, ranges, strengths, np.full(rays.size, int(kind), np.int8))


def _dust(random: Generator, beams: Beams, met: BeamHits, cloud: DustCloud) -> Ghosts:
    """A return from somewhere on a beam's way through the cloud, seldom or often."""
    first, last = float(beams.time_s[0]), float(beams.time_s[-1])
    if last < cloud.from_s or first > cloud.to_s:
        return _ghosts(np.empty(0, np.int64), np.empty(0), 0.0)
    centre = cloud.centre + cloud.drift * (first - cloud.from_s)
    rays, enters, leaves = way_through(beams, centre, cloud.radii)
    near, far = np.maximum(enters, 1.5), np.minimum(leaves, met.ranges[rays])
    long = np.maximum(far - near, 0.0)
    struck = random.random(rays.size) < 1 - np.exp(-cloud.per_m * long)
    ranges = (near + random.random(rays.size) * long)[struck]
    return _ghosts(rays[struck], ranges, 0.02 * (10 / np.maximum(ranges, 2)) ** 2, SiteKind.DUST)


def _mirrored(
    random: Generator, beams: Beams, met: BeamHits, hits: CastHits, scene: RaycastScene
) -> Ghosts:
    """What a mirror shows, taken for something straight behind it."""
    shares = np.zeros(len(Material))
    for material, share in _MIRRORS.items():
        shares[material] = share
    stands = met.ranges == hits.ranges
    chance = shares[met.material] * (stands & (hits.triangles >= 0))
    rays = np.flatnonzero(chance > 0)
    rays = rays[random.random(rays.size) < chance[rays]]
    corners = scene.mesh.vertices[scene.mesh.triangles[hits.triangles[rays]]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None]
    directions = beams.directions[rays]
    on = directions - 2 * np.einsum("ij,ij->i", directions, normals)[:, None] * normals
    positions = beams.origins[rays] + directions * met.ranges[rays, None] + 0.01 * on
    beyond = scene.cast(positions, on).ranges
    shown = (beyond > 0.2) & (beyond < _FARTHEST_MIRRORED_M)
    rays, beyond = rays[shown], beyond[shown]
    ranges = met.ranges[rays] + beyond + random.normal(0, 0.02, rays.size)
    return _ghosts(rays, ranges, 0.05 * (10 / ranges) ** 2)


def _twice(random: Generator, beams: Beams, met: BeamHits, ghost_sources: GhostSources) -> Ghosts:
    """Beams that go to and fro between the ground and a machine or water before they return."""
    rays = np.flatnonzero(np.isfinite(met.ranges) & (met.evidence // 256 == 0))
    rays = rays[random.random(rays.size) < _TWICE_NEAR_MACHINE * ghost_sources.restless]
    x, y = (
        beams.origins[rays, axis] + beams.directions[rays, axis] * met.ranges[rays]
        for axis in (0, 1)
    )
    near = np.zeros(rays.size, np.bool_)
    for one in ghost_sources.machines:
        near |= np.hypot(x - one.x, y - one.y) < one.radius_m * 0.6 + _NEAR_MACHINE_M
    seldom = _TWICE_ON_WET * ghost_sources.wetness / _TWICE_NEAR_MACHINE
    rays = rays[near | (random.random(rays.size) < seldom)]
    longer = 0.1 + random.exponential(0.7, rays.size)
    ranges = met.ranges[rays] + longer
    return _ghosts(rays, ranges, 0.03 * (10 / ranges) ** 2)


def _mixed_points(
    random: Generator, beams: Beams, met: BeamHits, ghost_sources: GhostSources
) -> Ghosts:
    """Ranges between an edge and what lies behind it, of beams that meet both."""
    here, beside = met.ranges[:-1], met.ranges[1:]
    rays = np.flatnonzero(np.isfinite(here) & np.isfinite(beside))
    near = np.minimum(here[rays], beside[rays])
    gap = np.abs(beside[rays] - here[rays])
    apart = np.linalg.norm(np.cross(beams.directions[rays], beams.directions[rays + 1]), axis=1)
    # On one and the same surface neighbours differ by this much, however flat the beam meets it.
    same = near * apart / np.maximum(np.minimum(met.cosines[rays], met.cosines[rays + 1]), 0.01)
    drawn = random.random(rays.size) < _TAIL * min(ghost_sources.restless, 3.0)
    keep = drawn & (gap > 0.08 + 3 * same) & (gap < _LONGEST_TAIL_M)
    share = random.beta(0.7, 0.7, int(keep.sum()))
    ranges = near[keep] + share * gap[keep]
    return _ghosts(rays[keep], ranges, 0.1 * (10 / np.maximum(ranges, 2)) ** 2)


def _in_the_air(random: Generator, met: BeamHits, ghost_sources: GhostSources) -> Ghosts:
    """Single points of sun, rain and birds; of a phase-based scanner more where it sees the sky."""
    drawn = random.random(met.ranges.size)
    share = np.full(drawn.size, _IN_THE_AIR * ghost_sources.restless)
    if ghost_sources.is_phase:
        share[~np.isfinite(met.ranges)] = _PHASE_IN_THE_SKY
    rays = np.flatnonzero(drawn < share)
    ranges = random.uniform(2.0, 45.0, rays.size)
    keep = ranges < met.ranges[rays]
    return _ghosts(rays[keep], ranges[keep], 0.01)


def _arc(random: Generator, beams: Beams, arc: PhaseArc) -> Ghosts:
    elevation = np.arcsin(np.clip(beams.directions[:, 2], -1, 1))
    azimuth = np.arctan2(beams.directions[:, 1], beams.directions[:, 0])
    turned = (azimuth - arc.from_rad) % (2 * np.pi)
    inside = (turned < arc.to_rad - arc.from_rad) & (elevation > arc.low_rad)
    rays = np.flatnonzero(inside & (elevation < arc.high_rad))
    rays = rays[random.random(rays.size) < arc.share]
    return _ghosts(rays, arc.reach_m + random.normal(0, 0.015, rays.size), 0.02)


def machines_among(things: Iterable[StandingObject]) -> list[StandingObject]:
    """The machines of what stands."""
    return [one for one in things if one.kind in MACHINES]
