"""What comes back of beams at bodies of known shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from processing.laboratory.simulate.scanning.beams import Beams, ScanPattern
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.mirrored_echoes import mirrored_echoes
from processing.laboratory.simulate.scanning.noise_options import NoiseOptions
from processing.laboratory.simulate.scanning.passing_noise import Path
from processing.laboratory.simulate.scanning.return_kernels import PASSED
from processing.laboratory.simulate.scanning.returns import (
    NO_EVIDENCE,
    BeamHits,
    Returns,
    Weather,
    returns_of,
    scanner_numbers,
)
from processing.laboratory.simulate.scanning.scanner_noise import NoiseSource, PulseHits
from processing.laboratory.simulate.scanning.sensors import SENSORS, Sensor
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Mesh, MeshBuilder, box, grid

_PULSE, _PHASE = SENSORS["vq250"], SENSORS["zf9012"]
_STANDS = Path(np.array([0.0, 10.0]), np.tile([0.0, 0.0, 2.5], (2, 1)))


def _floor(material: Material, half_m: float = 60.0) -> MeshBuilder:
    built = MeshBuilder()
    corners = np.array([[[-half_m, -half_m, 0.0], [half_m, -half_m, 0.0]]])
    rows = np.concatenate([corners, corners + np.array([0.0, 2 * half_m, 0.0])])
    built.add(grid(rows), material, 11, 7, piece=3)
    return built


def _fan(count: int, low_deg: float, high_deg: float) -> Beams:
    """Beams from 2.5 m above the floor, in a plane, from steep to flat."""
    angles = np.radians(np.linspace(low_deg, high_deg, count))
    directions = np.column_stack([np.sin(angles), np.zeros(count), -np.cos(angles)])
    return Beams(5000, np.arange(count) / 3e5, np.tile([0.0, 0.0, 2.5], (count, 1)), directions)


def _returned(mesh: Mesh, beams: Beams, sensor: Sensor, wetness: float = 0.0) -> Returns:
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    scanner = scanner_numbers(sensor, 3000, Weather(wetness, 0.5))
    return returns_of(beams, met, scene, scanner, 99)[0]


def test_points_of_a_plane_scatter_by_the_scanners_noise_and_the_surface() -> None:
    beams = _fan(20_000, 30, 60)
    returns = _returned(_floor(Material.CONCRETE).mesh(), beams, _PULSE)
    assert returns.pulse.size == 20_000
    assert abs(returns.xyz[:, 2].mean()) < 0.001
    assert 0.002 < returns.xyz[:, 2].std() < 0.008
    assert (returns.evidence == 7 * 256 + 3).all()
    assert (returns.label == 11).all()


def test_flat_and_wet_ground_loses_returns() -> None:
    flat = _fan(20_000, 84, 87.5)
    dry = _returned(_floor(Material.ASPHALT).mesh(), flat, _PULSE).pulse.size
    wet = _returned(_floor(Material.ASPHALT).mesh(), flat, _PULSE, wetness=0.7).pulse.size
    steep = _returned(_floor(Material.ASPHALT).mesh(), _fan(20_000, 10, 40), _PULSE).pulse.size
    assert wet < 0.8 * dry
    assert dry <= steep == 20_000


def test_a_bright_plate_is_far_stronger_than_paint_and_asphalt() -> None:
    beams = _fan(2000, 30, 60)
    strengths = [
        np.median(_returned(_floor(one).mesh(), beams, _PULSE).strength)
        for one in (Material.ASPHALT, Material.PAINT, Material.SIGN_FACE)
    ]
    assert strengths[0] * 3 < strengths[1] < strengths[2] / 5


def _with_a_box(height_m: float) -> Mesh:
    built = _floor(Material.CONCRETE)
    built.add(box((3.0, -5.0, 0.0), (3.6, 5.0, height_m)), Material.STEEL, 1, 9)
    return built.mesh()


def test_a_pulse_at_an_edge_returns_twice_and_a_phase_in_between() -> None:
    """The top of a wall is 1 m above the ground behind it."""
    turn, mesh = _fan(200, 45, 75), _with_a_box(1.0)
    beams = Beams(
        0,
        np.arange(200_000) / 3e5,
        *(np.tile(one, (1000, 1)) for one in (turn.origins, turn.directions)),
    )
    pulses = _returned(mesh, beams, _PULSE)
    seconds = pulses.number == 2
    assert seconds.sum() > 20
    assert (np.abs(pulses.xyz[seconds, 2]) < 0.1).all()
    assert (pulses.count[seconds] == 2).all()
    phases = _returned(mesh, beams, _PHASE)
    between = phases.label == 18
    assert between.sum() > 10
    assert (phases.count == 1).all()
    assert (phases.evidence[between] == NO_EVIDENCE).all()


def test_a_receiver_of_one_return_takes_the_middle_of_two_leaves() -> None:
    """Two sheets of leaves half a metre apart are one tree, and ranges between them are noise."""
    built = MeshBuilder()
    for west, high in ((-9.0, 0.2), (0.0, 0.7)):
        sheet = [[[west, -9, high], [west + 9, -9, high]], [[west, 9, high], [west + 9, 9, high]]]
        built.add(grid(np.array(sheet, float)), Material.LEAVES, 5, 12)
    turn = _fan(200, -30, 30)
    beams = Beams(
        0,
        np.arange(200_000) / 3e5,
        *(np.tile(one, (1000, 1)) for one in (turn.origins, turn.directions)),
    )
    single = _returned(built.mesh(), beams, replace(_PULSE, returns=1))
    between = single.label == 18
    assert between.sum() > 10
    assert (single.count == 1).all()
    heights = single.xyz[between, 2]
    assert ((heights > 0.23) & (heights < 0.67)).all()
    assert not (_returned(built.mesh(), beams, _PULSE).label == 18).any()


def test_leaves_let_beams_through() -> None:
    built = _floor(Material.CONCRETE)
    built.add(grid(np.array([[[-9, -9, 1], [9, -9, 1]], [[-9, 9, 1], [9, 9, 1]]], float)),
              Material.LEAVES, 5, 12)  # fmt: skip
    returns = _returned(built.mesh(), _fan(5000, 10, 40), _PULSE)
    last = returns.label == 11
    assert 0.3 < last.sum() / 5000 < 0.8
    assert (returns.number[last] == 2).all()
    assert np.abs(returns.xyz[last, 2]).max() < 0.05


def test_grass_returns_from_above_the_ground() -> None:
    returns = _returned(_floor(Material.GRASS).mesh(), _fan(20_000, 10, 60), _PULSE)
    assert 0.03 < returns.xyz[:, 2].mean() < 0.25


def test_a_pulse_returns_the_same_with_whatever_it_is_recorded() -> None:
    beams, mesh = _fan(3000, 30, 60), _floor(Material.ASPHALT).mesh()
    part = Beams(
        beams.first + 1000, beams.time_s[1000:], beams.origins[1000:], beams.directions[1000:]
    )
    whole, rest = (_returned(mesh, one, _PULSE) for one in (beams, part))
    assert np.array_equal(whole.xyz[whole.pulse >= part.first], rest.xyz)


def test_what_lies_beyond_the_range_of_unambiguity_is_folded_back() -> None:
    built = MeshBuilder()
    built.add(box((150.0, -50.0, -50.0), (151.0, 50.0, 50.0)), Material.PLASTER, 6, 4)
    mesh = built.mesh()
    beams = _fan(20_000, 85, 95)
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    scanner = scanner_numbers(_PHASE, 5080, Weather(0.0, 0.5))
    returns, _ = returns_of(beams, met, scene, scanner, 99)
    noise = NoiseSource(3, (0, 0), _PHASE, ScanPattern(5080, 200.0, 0.0), _STANDS)
    noisy = noise.added(PulseHits(beams, met, returns, scene, scanner))
    folded = np.abs(np.linalg.norm(noisy.xyz - beams.origins[0], axis=1) - 31.0) < 1.0
    assert folded.sum() > 1000
    assert set(noisy.label[folded].tolist()) <= {7, 18}


def test_points_in_a_window_are_told_to_be_noise() -> None:
    """A window 5 m away mirrors a wall behind the scanner."""
    built = MeshBuilder()
    built.add(box((5.0, -9.0, 0.0), (5.01, 9.0, 9.0)), Material.GLASS, 6, 4)
    built.add(box((-4.0, -9.0, 0.0), (-3.0, 9.0, 9.0)), Material.PLASTER, 6, 5)
    mesh, beams = built.mesh(), _fan(20_000, 80, 100)
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    scanner = scanner_numbers(_PULSE, 3000, Weather(0.0, 0.5))
    returns, _ = returns_of(beams, met, scene, scanner, 99)
    quiet = replace(_PULSE, most_m=100.0)
    noisy = NoiseSource(3, (0, 0), quiet, ScanPattern(3000, 100.0, 0.0), _STANDS).added(
        PulseHits(beams, met, returns, scene, scanner)
    )
    behind = noisy.xyz[:, 0] > 6
    assert behind.sum() > 2000
    assert (noisy.label[behind] == 18).all()
    assert noisy.xyz[behind, 0] == pytest.approx(13.0, abs=0.3)


def test_an_image_in_a_window_is_measured_less_exactly_than_its_wall() -> None:
    built = MeshBuilder()
    built.add(box((5.0, -9.0, 0.0), (5.01, 9.0, 9.0)), Material.GLASS, 6, 4)
    built.add(box((-4.0, -9.0, 0.0), (-3.0, 9.0, 9.0)), Material.PLASTER, 6, 5)
    mesh, beams = built.mesh(), _fan(20_000, 80, 100)
    scene, scanner = RaycastScene(mesh, np.zeros(3)), scanner_numbers(_PULSE, 3000, Weather(0, 1))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    rays = np.arange(20_000)
    scanner[PASSED] = 0.15**2
    images = mirrored_echoes(beams, met, scene, scanner, rays, key=99)
    wall = replace(beams, directions=beams.directions * [-1.0, 1.0, 1.0])
    seen = BeamHits.of(scene.cast(wall.origins, wall.directions), mesh)
    whole = 13.0 / beams.directions[images.rays, 0]
    direct = _returned(mesh, wall, _PULSE)
    rows = direct.pulse - wall.first
    near = np.linalg.norm(direct.xyz - wall.origins[rows], axis=1) - seen.ranges[rows]
    assert 1.5 * near.std() < (images.ranges - whole).std() < 0.05
    assert np.median(images.strengths) < 0.05 * np.median(direct.strength)


def test_weak_returns_of_a_phase_scanner_jump_by_whole_waves() -> None:
    mesh, beams = _floor(Material.RUBBER).mesh(), _fan(40_000, 70, 84)
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    scanner = scanner_numbers(_PHASE, 5080, Weather(0.0, 0.5))
    returns, truths = returns_of(beams, met, scene, scanner, 99)
    noise = NoiseSource(3, (0, 0), _PHASE, ScanPattern(5080, 200.0, 0.0), _STANDS)
    noisy = noise.added(PulseHits(beams, met, returns, scene, scanner))
    off = np.linalg.norm(noisy.xyz - beams.origins[0], axis=1) - truths[noisy.pulse - beams.first]
    waves = off * 60.0 / _PHASE.most_m
    jumped = (np.abs(waves - np.round(waves)) < 0.05) & (np.abs(np.round(waves)) >= 1)
    assert jumped.sum() > 100
    assert set(noisy.label[jumped].tolist()) <= {7, 18}


def test_what_a_pane_mirrors_from_the_ground_is_noise_below_the_ground() -> None:
    built = _floor(Material.CONCRETE)
    pane = np.array([[[7.95, -5.0, 0.5], [7.95, 5.0, 0.5]], [[8.05, -5.0, 2.4], [8.05, 5.0, 2.4]]])
    built.add(grid(pane), Material.GLASS, 6, 9)
    mesh = built.mesh()
    scene, beams = RaycastScene(mesh, np.zeros(3)), _fan(6000, 75.0, 89.0)
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    quiet = replace(_PULSE, noise_m=0.0)
    scanner = scanner_numbers(quiet, 3000, Weather(0.0, 0.5))
    returns = returns_of(beams, met, scene, scanner, 99)[0]
    noisy = NoiseSource(3, (0, 0), quiet, ScanPattern(3000, 100.0, 0.0), _STANDS).added(
        PulseHits(beams, met, returns, scene, scanner)
    )
    is_low = noisy.xyz[:, 2] < -0.1
    assert is_low.sum() > 20
    assert (noisy.label[is_low] == 7).all()


_NOTHING = NoiseOptions(0.0, 0.0, 0.0, 0.0)


def _noisy(mesh: Mesh, beams: Beams, sensor: Sensor, options: NoiseOptions) -> Returns:
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    scanner = scanner_numbers(sensor, 3000, Weather(0.0, 0.5))
    returns = returns_of(beams, met, scene, scanner, 99)[0]
    source = NoiseSource(3, (0, 0), sensor, ScanPattern(3000, 100.0, 0.0), _STANDS, options=options)
    return source.added(PulseHits(beams, met, returns, scene, scanner))


def test_a_glint_blinds_a_narrow_part_of_the_turn_for_a_moment() -> None:
    mesh, beams = _floor(Material.CONCRETE).mesh(), _fan(60_000, 30, 60)
    noisy = _noisy(mesh, beams, _PHASE, replace(_NOTHING, glints_per_s=200.0))
    pulses = noisy.pulse[noisy.label != 11]
    assert 50 < pulses.size < 30_000
    turned = np.unique((pulses % 3000) // 30)
    assert turned.size < 100
    assert np.ptp(np.linalg.norm(noisy.xyz[noisy.label != 11] - beams.origins[0], axis=1)) > 10.0
    none = _noisy(mesh, beams, _PHASE, _NOTHING)
    assert (none.label == 11).all()


def test_what_shines_back_too_strongly_is_measured_along_the_beam() -> None:
    mesh, beams = _floor(Material.PLASTER).mesh(), _fan(20_000, 10, 80)
    streaks = replace(_NOTHING, streaks=0.5, streak_m=1.0)
    assert (_noisy(mesh, beams, _PHASE, streaks).label == 11).all()
    noisy = _noisy(mesh, beams, _PHASE, replace(streaks, saturated=0.5))
    strong = np.linalg.norm(noisy.xyz - beams.origins[0], axis=1)[noisy.label != 11]
    assert strong.size > 500
    assert np.median(strong) < 6.0


def _pane_before_a_wall() -> Mesh:
    built = MeshBuilder()
    built.add(box((9.0, -9.0, 0.0), (9.01, 9.0, 9.0)), Material.GLASS, 6, 4)
    built.add(box((-13.0, -9.0, 0.0), (-12.0, 9.0, 9.0)), Material.BRICK, 6, 5)
    return built.mesh()


def test_a_spotless_pane_shows_images_and_never_itself() -> None:
    mesh, beams = _pane_before_a_wall(), _fan(20_000, 80, 100)
    usual = replace(_NOTHING, mirrored=0.5, pane=0.6)
    dirty, clean = (
        _noisy(mesh, beams, _PULSE, replace(usual, spotless=share)) for share in (0.0, 1.0)
    )
    assert (dirty.label == 6).sum() > 1000
    assert not (clean.label == 6).any()
    assert (clean.label == 18).sum() == (dirty.label == 18).sum() > 1000


def test_faint_images_are_measured_where_light_is_compared_all_the_time() -> None:
    mesh, beams = _pane_before_a_wall(), _fan(20_000, 80, 100)
    usual = replace(_NOTHING, mirrored=0.5, pane=0.02)
    strong, faint = (
        _noisy(mesh, beams, _PHASE, replace(usual, faint=share)) for share in (1.0, 0.01)
    )
    assert (faint.label == 18).sum() > 2 * (strong.label == 18).sum()


def test_a_pane_that_sends_more_light_back_shows_more() -> None:
    mesh, beams = _pane_before_a_wall(), _fan(20_000, 80, 100)
    shown = [
        int(
            (
                _noisy(mesh, beams, _PULSE, replace(_NOTHING, mirrored=0.5, pane=pane)).label == 18
            ).sum()
        )
        for pane in (0.02, 0.6)
    ]
    assert shown[1] > 2 * shown[0]


def test_a_share_of_upright_walls_is_glass_at_the_same_places_for_all_beams() -> None:
    built = _floor(Material.PLASTER)
    built.add(box((9.0, -9.0, 0.0), (9.5, 9.0, 9.0)), Material.PLASTER, 6, 4)
    mesh, beams = built.mesh(), _fan(20_000, 60, 100)
    scene = RaycastScene(mesh, np.zeros(3))
    pattern = ScanPattern(3000, 100.0, 0.0)
    wall, glazed = (
        NoiseSource(
            3, (0, 0), _PHASE, pattern, _STANDS, options=replace(_NOTHING, glazed=share)
        ).first_met
        for share in (0.0, 1.0)
    )
    hits = scene.cast(beams.origins, beams.directions)
    assert (wall(beams, hits, scene).material == Material.PLASTER).all()
    is_pane = glazed(beams, hits, scene).material == Material.GLASS
    is_wall = (hits.triangles >= 0) & (mesh.label[hits.triangles] == 6)
    assert not is_pane[~is_wall].any()
    assert 0.4 < is_pane[is_wall].mean() < 1.0
    rest = Beams(
        beams.first + 9000, beams.time_s[9000:], beams.origins[9000:], beams.directions[9000:]
    )
    part = glazed(rest, scene.cast(rest.origins, rest.directions), scene).material
    np.testing.assert_array_equal(part == Material.GLASS, is_pane[9000:])


def test_what_lasts_longer_blinds_more_and_stretches_agree_on_it() -> None:
    mesh, beams = _floor(Material.CONCRETE).mesh(), _fan(60_000, 30, 60)
    beams = replace(beams, time_s=np.arange(60_000) / 2e4)
    usual = replace(_NOTHING, arcs_per_s=5.0)
    short, long = (
        _noisy(mesh, beams, _PHASE, replace(usual, lasting=times)) for times in (1.0, 8.0)
    )
    assert (long.label != 11).sum() > 1.5 * (short.label != 11).sum()
    late = Beams(
        beams.first + 50_000,
        beams.time_s[50_000:],
        beams.origins[50_000:],
        beams.directions[50_000:],
    )
    part = _noisy(mesh, late, _PHASE, replace(usual, lasting=8.0))
    whole = long.chosen(long.pulse >= late.first)
    np.testing.assert_array_equal(part.label, whole.label)


def test_ranges_of_nothing_may_lie_behind_what_the_beam_met() -> None:
    mesh, beams = _floor(Material.CONCRETE).mesh(), _fan(20_000, 10, 60)
    behind = []
    for anywhere in (False, True):
        options = replace(_NOTHING, lone=0.1, lone_anywhere=anywhere)
        noisy = _noisy(mesh, beams, _PHASE, options)
        behind.append(int((noisy.xyz[:, 2] < -0.1).sum()))
    assert behind[0] == 0
    assert behind[1] > 500


def test_dense_grass_ends_flat_beams_earlier() -> None:
    mesh, beams = _floor(Material.GRASS).mesh(), _fan(20_000, 84, 86)
    scene = RaycastScene(mesh, np.zeros(3))
    met = BeamHits.of(scene.cast(beams.origins, beams.directions), mesh)
    heights = []
    for flattest in (0.25, 0.05):
        scanner = scanner_numbers(_PULSE, 3000, Weather(0.0, 0.5, flattest=flattest))
        heights.append(float(returns_of(beams, met, scene, scanner, 99)[0].xyz[:, 2].mean()))
    assert heights[1] > 1.5 * heights[0]
