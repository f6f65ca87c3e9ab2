"""What moves while a site is scanned, and the dust it raises."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.returns import BeamHits
from processing.laboratory.simulate.scene.mesh import Floats, Integers, Mesh, MeshBuilder
from processing.laboratory.simulate.sites.bodies import OTHER, SiteBody
from processing.laboratory.simulate.sites.layout import SiteLayout
from processing.laboratory.simulate.sites.machines import bulldozer, dump_truck, roller
from processing.laboratory.simulate.sites.relief import wander
from processing.laboratory.simulate.sites.small_things import worker

_ABOUT = np.zeros(3)


@dataclass(frozen=True)
class MovementTrack:
    """A thing on its way to and fro.

    Attributes
    ----------
    body : SiteBody
    instance : int
    times : (n,) float64
        s of the whole recording.
    x, y, headings : (n,) float64
        m and radians, the site's frame; it stands where two places are the same.
    """

    body: SiteBody
    instance: int
    times: Floats
    x: Floats
    y: Floats
    headings: Floats


@dataclass(frozen=True)
class DustCloud:
    """Dust: an ellipsoid that drifts.

    Attributes
    ----------
    centre, radii, drift : (3,) float64
        m, m, m/s.
    from_s, to_s : float
    per_m : float
        Chance of a return from a metre of it.
    """

    centre: Floats
    radii: Floats
    drift: Floats
    from_s: float
    to_s: float
    per_m: float


def tracks_of(random: Generator, layout: SiteLayout, seconds: float) -> list[MovementTrack]:
    """People and machines that move during a recording of so many seconds."""
    east, north = layout.ground.heights.size_m
    makers = [worker] * int(random.integers(1, 4))
    makers += [
        (dump_truck, bulldozer, roller)[int(random.integers(3))]
        for _ in range(int(random.integers(0, 3)))
    ]
    tracks = []
    for number, make in enumerate(makers):
        body = make(random)
        is_machine = any(body.footing_m)
        margin = 0.12 if is_machine else 0.05
        start = random.uniform(margin, 1 - margin, 2) * (east, north)
        reach = np.array([0.5 * east, 0.1 * north]) if is_machine else np.array([9.0, 9.0])
        end = np.clip(start + random.uniform(-1, 1, 2) * reach, 1.0, (east - 1.0, north - 1.0))
        path = wander(random, start, end, 0.5)
        speed = random.uniform(1.0, 3.5) if is_machine else random.uniform(0.3, 1.3)
        instance = len(layout.things) + 1 + number
        tracks.append(_to_and_fro(random, body, instance, path, speed=speed, seconds=seconds))
    return tracks


def _to_and_fro(
    random: Generator, body: SiteBody, instance: int, path: Floats, *, speed: float, seconds: float
) -> MovementTrack:
    steps = np.hypot(*np.diff(path, axis=0).T) / speed
    legs_times, legs_rows, now = [], [], -random.uniform(0, 30)
    rows = np.arange(len(path))
    while now < seconds:
        legs_times.append(now + np.r_[0.0, np.cumsum(steps)])
        legs_rows.append(rows)
        now = float(legs_times[-1][-1]) + random.uniform(2, 90)
        legs_times.append(np.array([now - 0.5]))
        legs_rows.append(rows[-1:])
        rows, steps = rows[::-1], steps[::-1]
    order, times = np.concatenate(legs_rows), np.concatenate(legs_times)
    x, y = path[order].T
    dx, dy = np.gradient(path[:, 0]), np.gradient(path[:, 1])
    # Machines go back the way they came in reverse, so that headings belong to places.
    return MovementTrack(body, instance, times, x, y, np.unwrap(np.arctan2(dy, dx))[order])


def dust_of(
    random: Generator, layout: SiteLayout, scans_at: list[float], scan_s: float
) -> list[DustCloud]:
    """Dust that drifts over the site for some seconds or minutes.

    Parameters
    ----------
    scans_at : list of float
        When the scans begin, s.
    scan_s : float
        How long each of them takes.
    """
    heights = layout.ground.heights
    clouds = []
    for _ in range(int(random.integers(0, 4))):
        x, y = random.uniform(0.05, 0.95, 2) * heights.size_m
        radii = random.uniform((1.0, 1.0, 0.5), (5.0, 5.0, 1.8))
        start = scans_at[int(random.integers(len(scans_at)))] + random.uniform(-20, 0.8 * scan_s)
        clouds.append(
            DustCloud(
                np.array([x, y, float(heights.height(x, y)) + 0.7 * radii[2]]),
                radii,
                random.normal(0, (0.12, 0.12, 0.01)),
                start,
                start + random.uniform(15, 150),
                random.uniform(0.002, 0.05),
            )
        )
    return clouds


class MovingThings:
    """Tracks with a small scene of each.

    Parameters
    ----------
    tracks : list of MovementTrack
    layout : SiteLayout
        Whose ground they go on.
    """

    def __init__(self, tracks: list[MovementTrack], layout: SiteLayout) -> None:
        self.tracks = tracks
        self._heights = layout.ground.heights
        self._scenes = [_scene_of(track) for track in tracks]

    def meet(self, beams: Beams, met: BeamHits) -> None:
        """Put what moves before what stands, where it is nearer."""
        for track, (scene, radius) in zip(self.tracks, self._scenes, strict=True):
            x = np.interp(beams.time_s, track.times, track.x)
            y = np.interp(beams.time_s, track.times, track.y)
            rays = _near(beams, x, y, radius)
            if rays.size == 0:
                continue
            x, y = x[rays], y[rays]
            z = self._height(track.body, x, y)
            turn = np.interp(beams.time_s[rays], track.times, track.headings)
            c, s = np.cos(turn), np.sin(turn)
            off = beams.origins[rays] - np.column_stack([x, y, z])
            origins, directions = _turned(off, c, s), _turned(beams.directions[rays], c, s)
            met.take(rays, scene.cast(origins, directions), scene.mesh)

    def _height(self, body: SiteBody, x: Floats, y: Floats) -> Floats:
        """Of the ground under it: a machine stands on its highest wheels."""
        reach = max(body.footing_m) * 0.7
        around = [
            self._heights.height(x + a * reach, y + b * reach)
            for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
        ]
        return np.asarray(np.max(around, axis=0), np.float64)


def _scene_of(track: MovementTrack) -> tuple[RaycastScene, float]:
    builder = MeshBuilder()
    for shape, material in track.body.parts:
        builder.add(shape, material, OTHER, track.instance)
    mesh: Mesh = builder.mesh()
    return RaycastScene(mesh, _ABOUT), float(np.hypot(*mesh.vertices[:, :2].T).max()) + 0.05


def _near(beams: Beams, x: Floats, y: Floats, radius: float) -> Integers:
    """Beams that pass over or through an upright cylinder about a place."""
    dx, dy = x - beams.origins[:, 0], y - beams.origins[:, 1]
    flat = np.hypot(beams.directions[:, 0], beams.directions[:, 1])
    aside = np.abs(beams.directions[:, 0] * dy - beams.directions[:, 1] * dx)
    ahead = beams.directions[:, 0] * dx + beams.directions[:, 1] * dy
    return np.flatnonzero((aside < radius * flat) & (ahead > -radius))


def _turned(vectors: Floats, c: Floats, s: Floats) -> Floats:
    """Into the frame of what moves."""
    return np.column_stack(
        [
            c * vectors[:, 0] + s * vectors[:, 1],
            c * vectors[:, 1] - s * vectors[:, 0],
            vectors[:, 2],
        ]
    )
