"""Dust, ground that seems too low, the sun: where they lie, and that stretches agree on them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.noise_options import noise_options, varied_noise
from processing.laboratory.simulate.scanning.passing_noise import PassingNoise, Path, way_through
from processing.laboratory.simulate.scanning.returns import BeamHits
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import MeshBuilder, grid

_TURNS, _PULSES, _HIGH_M = 400, 500, 1.9


@pytest.fixture(scope="module")
def drive() -> tuple[Beams, BeamHits]:
    """Two seconds along x at 10 m/s over level ground; the mirror turns across."""
    numbers = np.arange(_TURNS * _PULSES)
    time_s = numbers / (200.0 * _PULSES)
    turn = 2 * np.pi * (numbers % _PULSES) / _PULSES
    directions = np.column_stack([np.zeros(numbers.size), np.sin(turn), -np.cos(turn)])
    origins = np.column_stack([10.0 * time_s, *np.tile([0.0, _HIGH_M], (numbers.size, 1)).T])
    built = MeshBuilder()
    built.add(
        grid(np.array([[[-90.0, -90, 0], [90, -90, 0]], [[-90, 90, 0], [90, 90, 0]]])),
        Material.ASPHALT,
        11,
        7,
    )
    mesh = built.mesh()
    scene = RaycastScene(mesh, np.zeros(3))
    return Beams(0, time_s, origins, directions), BeamHits.of(scene.cast(origins, directions), mesh)


def _path(beams: Beams) -> Path:
    return Path(beams.time_s, beams.origins)


def _ranges(
    beams: Beams, met: BeamHits, path: Path, seed: int, **kinds: float
) -> NDArray[np.float64]:
    options = {"clouds_per_s": 0.0, "patches_per_s": 0.0, "sun": 0.0, **kinds}
    ranges = np.full(beams.time_s.size, np.nan)
    ground = np.flatnonzero(np.isfinite(met.ranges))
    PassingNoise(seed, path, **options).measure(beams, met, ground, 99, ranges)
    return ranges


def _part(beams: Beams, met: BeamHits, start: int) -> tuple[Beams, BeamHits]:
    part = Beams(
        beams.first + start, beams.time_s[start:], beams.origins[start:], beams.directions[start:]
    )
    fields = (met.ranges, met.cosines, met.material, met.label, met.evidence)
    return part, BeamHits(*(one[start:] for one in fields))


@pytest.mark.parametrize("kind", ["clouds_per_s", "patches_per_s"])
def test_what_is_passed_is_the_same_however_the_pass_is_cut(
    drive: tuple[Beams, BeamHits], kind: str
) -> None:
    beams, met = drive
    whole = _ranges(beams, met, _path(beams), 5, **{kind: 4.0})
    part = _ranges(*_part(beams, met, 60_321), _path(beams), 5, **{kind: 4.0})
    assert np.isfinite(whole).sum() > 100
    np.testing.assert_array_equal(whole[60_321:], part)


def test_dust_lies_before_what_the_beam_met_and_in_clouds(drive: tuple[Beams, BeamHits]) -> None:
    beams, met = drive
    ranges = _ranges(beams, met, _path(beams), 5, clouds_per_s=3.0)
    dust = np.flatnonzero(np.isfinite(ranges))
    assert dust.size > 100
    assert (ranges[dust] < met.ranges[dust]).all()
    xyz = beams.origins[dust] + ranges[dust, None] * beams.directions[dust]
    assert (xyz[:, 2] > -0.01).all()
    assert (xyz[:, 2] < _HIGH_M + 2.2).all()


def test_dust_lies_as_far_aside_as_is_asked_for(drive: tuple[Beams, BeamHits]) -> None:
    beams, met = drive
    least = []
    for aside_m in (3.0, 30.0):
        ranges = _ranges(beams, met, _path(beams), 5, clouds_per_s=4.0, aside_m=aside_m)
        least.append(float(np.nanmedian(ranges)))
    assert least[1] > least[0] + 2.0


def test_patches_lie_some_centimetres_to_decimetres_below_the_ground(
    drive: tuple[Beams, BeamHits],
) -> None:
    beams, met = drive
    ranges = _ranges(beams, met, _path(beams), 7, patches_per_s=2.0)
    low = np.flatnonzero(np.isfinite(ranges))
    assert low.size > 100
    depth = (ranges[low] - met.ranges[low]) * -beams.directions[low, 2]
    assert (depth > -0.05).all()
    assert (depth < 0.95).all()
    assert np.median(depth) > 0.05


def test_the_sun_dazzles_where_a_head_looks_at_it_and_nowhere_else() -> None:
    around = np.linspace(-np.pi, np.pi, 720)
    up = np.radians(np.arange(0.0, 90.0, 0.5))
    azimuth, high = (one.ravel() for one in np.meshgrid(around, up))
    flat = np.cos(high)
    directions = np.column_stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(high)])
    count = high.size
    beams = Beams(0, np.arange(count) / 1e5, np.zeros((count, 3)), directions)
    met = BeamHits(
        np.full(count, np.inf), np.ones(count), *(np.zeros(count, np.uint8) for _ in range(3))
    )
    ranges = _ranges(beams, met, Path(beams.time_s, beams.origins), 3, sun=0.5)
    dazzled = np.flatnonzero(np.isfinite(ranges))
    assert dazzled.size > 5
    middle = directions[dazzled].mean(axis=0)
    assert (directions[dazzled] @ (middle / np.linalg.norm(middle)) > np.cos(np.radians(6.5))).all()
    assert np.ptp(ranges[dazzled]) > 5.0


def test_beams_pass_an_ellipsoid_between_two_ranges() -> None:
    beams = Beams(
        0, np.zeros(2), np.array([[0.0, 0, 0], [0, 5, 0]]), np.array([[1.0, 0, 0], [1, 0, 0]])
    )
    rays, enters, leaves = way_through(beams, np.array([10.0, 0, 0]), np.array([2.0, 1, 1]))
    assert rays.tolist() == [0]
    assert (enters[0], leaves[0]) == pytest.approx((8.0, 12.0))


def test_noise_is_so_many_times_as_often_and_never_more_than_all() -> None:
    usual = noise_options(3, SENSORS["zf9012"])
    more, none = (noise_options(3, SENSORS["zf9012"], often) for often in (4.0, 0.0))
    assert more.arcs_per_s == pytest.approx(4 * usual.arcs_per_s)
    assert more.drops == pytest.approx(4 * usual.drops)
    assert more.folded == usual.folded
    assert noise_options(3, SENSORS["zf9012"], 1e9).lone == 1.0
    assert none.arcs_per_s == none.drops == none.lone == none.clouds_per_s == 0.0


def test_varied_noise_has_every_kind_in_many_recordings() -> None:
    drawn = [varied_noise(seed, SENSORS["zf9012"]) for seed in range(60)]
    for kind in ("arcs_per_s", "clouds_per_s", "patches_per_s", "sun", "glints_per_s"):
        share = np.mean([getattr(one, kind) > 0 for one in drawn])
        assert 0.15 < share < 0.95, kind
    assert np.ptp(np.log10([one.lone for one in drawn])) > 1.5
    assert max(one.pane for one in drawn) > 1.5 * min(one.pane for one in drawn)
    assert 0.5 < np.mean([one.glazed > 0 for one in drawn]) < 0.9
    by_pulses = [varied_noise(seed, SENSORS["vq250"]) for seed in range(60)]
    assert not any(one.arcs_per_s or one.folded for one in by_pulses)
    assert np.median([one.lone for one in by_pulses]) < np.median([one.lone for one in drawn])


def test_clear_panes_differ_in_nothing_else() -> None:
    usual, clear = (
        [varied_noise(seed, SENSORS["zf9012"], has_clear_panes=has) for seed in range(40)]
        for has in (False, True)
    )
    assert not any(one.spotless for one in usual)
    assert 0.4 < np.mean([one.spotless >= 0.5 for one in clear]) < 0.8
    assert all(0.01 <= one.faint <= 1.0 for one in clear)
    for one, other in zip(usual, clear, strict=True):
        assert replace(other, spotless=0.0, faint=1.0) == one
    by_pulses = varied_noise(3, SENSORS["vq250"], has_clear_panes=True)
    assert by_pulses.faint == 1.0
