"""Points that no surface gave: arcs and folds of phase-based scanners, mirrors, sun, rain.

Kinds and looks follow Kogure et al. 2022 (arcs about the vehicle's path, of one range each) and
what recordings of phase-based profilers show.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.scanning.beams import Beams, ScanPattern
from processing.laboratory.simulate.scanning.casting import NOWHERE, CastHits, RaycastScene
from processing.laboratory.simulate.scanning.mirrored_echoes import (
    MIRRORS,
    MirroredEchoes,
    mirrored_echoes,
    panes_in_walls,
)
from processing.laboratory.simulate.scanning.noise_options import NoiseOptions, noise_options
from processing.laboratory.simulate.scanning.passing_noise import PassingNoise, Path
from processing.laboratory.simulate.scanning.return_kernels import PASSED, WEAKEST
from processing.laboratory.simulate.scanning.returns import (
    HIGH_NOISE,
    LOW_NOISE,
    NO_EVIDENCE,
    BeamHits,
    Returns,
    number_returns,
    shares_of,
)
from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import Floats, Integers

_GROUND_LABELS = (2, 3, 11, 67)
_SLOT_S = 1.0
_LEAST_M = 0.6
_GLINT_TURNS, _GLINT_SHARES, _GLINT_REACH_M = (0.001, 0.01), (0.05, 0.6), (1.0, 30.0)
_PANES_M = (1.0, 8.0), (1.0, 4.0)
"""From a door's width to a shop's, and from a low window's height to a hall's."""

_LONE_M = 40.0  # beyond it a receiver's own noise is as seldom as far things
_WEAK = 0.02  # of the power that a white surface 10 m away gives
_JUMPING_SHARE = 0.02
_FINER_WAVES = 60.0  # in the range of unambiguity
_LEAST_DETOUR_M = 0.2  # shorter ones are one echo with the first; a metre more in the mean
_OWN_LIKE_M = 0.05  # noise that falls so near to the true surface is none


@dataclass(frozen=True)
class PulseHits:
    """A stretch of pulses and what they truly met.

    Attributes
    ----------
    beams : Beams
    met : BeamHits
        Of each beam.
    returns : Returns
        Without this noise.
    scene : RaycastScene
    scanner : (13,) float64
        `scanner_numbers`.
    """

    beams: Beams
    met: BeamHits
    returns: Returns
    scene: RaycastScene
    scanner: Floats


class NoiseSource:
    """The noise of one head during one pass.

    Parameters
    ----------
    position : tuple of int
        Number of the pass, number of the head.
    path : Path
        Of the pass.
    options : NoiseOptions or None
        None: what is usual for the seed.
    """

    def __init__(
        self,
        seed: int,
        position: tuple[int, int],
        sensor: Sensor,
        scan_pattern: ScanPattern,
        path: Path,
        *,
        options: NoiseOptions | None = None,
    ) -> None:
        self._seed, self._position, self._sensor, self._scan_pattern = (
            seed,
            position,
            sensor,
            scan_pattern,
        )
        options = options or noise_options(seed, sensor)
        self._request = options
        self._passing = PassingNoise(
            seed,
            path,
            clouds_per_s=options.clouds_per_s,
            patches_per_s=options.patches_per_s,
            sun=options.sun,
            aside_m=options.aside_m,
        )
        self._pane_m = tuple(chance(seed, "panes").uniform(*np.transpose(_PANES_M)).tolist())
        self._key = int(chance(seed, "noise key", *position).integers(1 << 40))

    def first_met(self, beams: Beams, hits: CastHits, scene: RaycastScene) -> BeamHits:
        """What beams meet first of a scene, some of whose walls are glass."""
        met = BeamHits.of(hits, scene.mesh)
        if self._request.glazed > 0:
            share, pane = self._request.glazed, self._pane_m
            is_pane = panes_in_walls(beams, hits, scene.mesh, (share, *pane), self._seed)
            met.material[is_pane] = Material.GLASS
        return met

    def added(self, recorded: PulseHits) -> Returns:
        """The returns with some replaced by noise, and noise where nothing came back."""
        beams, met = recorded.beams, recorded.met
        ranges = np.full(met.ranges.size, np.nan)
        is_ground = np.isin(met.label, _GROUND_LABELS) & np.isfinite(met.ranges)
        self._passing.measure(beams, met, np.flatnonzero(is_ground), self._key, ranges)
        self._lone(beams, met, ranges)
        self._arcs(beams, ranges)
        self._glints(beams, met, ranges)
        self._folded(beams, met, ranges)
        self._jumps(recorded, ranges)
        self._streaks(recorded, ranges)
        self._drops(beams, met, ranges)
        self._late(beams, met, ranges)
        images = self._mirrored(recorded, ranges)
        known = np.where(np.isfinite(met.ranges), met.ranges, NOWHERE)
        ranges[np.abs(ranges - known) < _OWN_LIKE_M] = np.nan
        return self._merged(recorded, ranges, images)

    def _chosen(self, beams: Beams, rows: Integers, share: float, salt: int) -> Integers:
        return rows[shares_of(beams.first + rows, self._key + salt) < share]

    def _normal(self, beams: Beams, rows: Integers, salt: int) -> Floats:
        """Nearly normal numbers with standard deviation 1, each of its pulse."""
        total: Floats = np.full(rows.size, -2.0)
        for one in range(4):
            total += shares_of(beams.first + rows, self._key + salt + one)
        return total * math.sqrt(3.0)

    def _slots(self, beams: Beams) -> range:
        """Seconds in which may have begun what lasts into the time of some beams."""
        first, last = (int(beams.time_s[end] // _SLOT_S) for end in (0, -1))
        return range(max(0, first - math.ceil(self._request.lasting)), last + 1)

    def _arcs(self, beams: Beams, ranges: Floats) -> None:
        """One range over a part of the turn, for some turns: begun in slots of a second."""
        if self._request.arcs_per_s <= 0 or beams.time_s.size == 0:
            return
        lasting = self._request.lasting
        for slot in self._slots(beams):
            random = chance(self._seed, "arcs", *self._position, slot)
            for _ in range(random.poisson(self._request.arcs_per_s)):
                start = (slot + random.random()) * _SLOT_S
                long_s = float(np.exp(random.uniform(np.log(0.01), np.log(_SLOT_S)))) * lasting
                reach, drift = random.uniform(1.5, 18.0), random.normal(0, 0.3)
                middle, half = random.random(), random.uniform(0.01, self._request.arc_turn)
                share = float(random.choice([0.02, 0.06, 0.15, 0.4]))
                salt = int(random.integers(1000, 1 << 30))
                low, high = np.searchsorted(beams.time_s, [start, start + long_s])
                rows = np.arange(low, high)
                turned = (beams.first + rows) / self._scan_pattern.pulses - middle
                rows = rows[np.abs(turned - np.round(turned)) < half]
                rows = self._chosen(beams, rows, share, salt)
                spread = 0.002 + 0.02 * (salt % 7) / 7
                there = reach + drift * (beams.time_s[rows] - start)
                ranges[rows] = there + spread * self._normal(beams, rows, salt + 1)

    def _folded(self, beams: Beams, met: BeamHits, ranges: Floats) -> None:
        """What lies beyond the range of unambiguity, brought nearer by it."""
        if self._request.folded <= 0:
            return
        most = self._sensor.most_m
        rows = np.flatnonzero((met.ranges > most) & (met.ranges < 2 * most))
        rows = self._chosen(beams, rows, self._request.folded, 100)
        ranges[rows] = met.ranges[rows] - most + 0.01 * self._normal(beams, rows, 110)

    def _jumps(self, recorded: PulseHits, ranges: Floats) -> None:
        """Weak returns of phase-based scanners whose finer wave is counted wrongly."""
        if self._sensor.measures_by != "phase":
            return
        returns, met = recorded.returns, recorded.met
        rows = returns.pulse[returns.strength < _WEAK] - recorded.beams.first
        rows = self._chosen(recorded.beams, rows, _JUMPING_SHARE, 600)
        waves = np.round(2 * self._normal(recorded.beams, rows, 610))
        ranges[rows] = met.ranges[rows] + waves * self._sensor.most_m / _FINER_WAVES

    def _glints(self, beams: Beams, met: BeamHits, ranges: Floats) -> None:
        """Ranges of nothing in a narrow part of the turn, for as long as something blinks."""
        if self._request.glints_per_s <= 0 or beams.time_s.size == 0:
            return
        is_phase = self._sensor.measures_by == "phase"
        lasting = self._request.lasting
        for slot in self._slots(beams):
            random = chance(self._seed, "glints", *self._position, slot)
            for _ in range(random.poisson(self._request.glints_per_s)):
                start = (slot + random.random()) * _SLOT_S
                long_s = lasting * 10 ** random.uniform(-2.3, -0.5)
                middle, half = random.random(), random.uniform(*_GLINT_TURNS)
                share, salt = random.uniform(*_GLINT_SHARES), int(random.integers(1000, 1 << 30))
                rows = np.arange(*np.searchsorted(beams.time_s, [start, start + long_s]))
                turned = (beams.first + rows) / self._scan_pattern.pulses - middle
                rows = rows[np.abs(turned - np.round(turned)) < half]
                rows = self._chosen(beams, rows, float(share), salt)
                low, high = _GLINT_REACH_M
                away = low + (high - low) * shares_of(beams.first + rows, self._key + salt + 1)
                # An echo that comes first is taken; a phase is that of all light together.
                is_taken = is_phase | (away < met.ranges[rows])
                ranges[rows[is_taken]] = away[is_taken]

    def _streaks(self, recorded: PulseHits, ranges: Floats) -> None:
        """Ranges spread along the beam where something shines back too strongly."""
        beams, met, returns = recorded.beams, recorded.met, recorded.returns
        is_bright = (met.material == Material.SIGN_FACE) & np.isfinite(met.ranges)
        is_bright[returns.pulse[returns.strength > self._request.saturated] - beams.first] = True
        rows = self._chosen(beams, np.flatnonzero(is_bright), self._request.streaks, 200)
        ranges[rows] = met.ranges[rows] + self._request.streak_m * self._normal(beams, rows, 210)

    def _drops(self, beams: Beams, met: BeamHits, ranges: Floats) -> None:
        """Rain, dust and insects: single points, most of them near the scanner."""
        rows = self._chosen(beams, np.arange(met.ranges.size), self._request.drops, 300)
        away = _LEAST_M - 4.0 * np.log(np.maximum(shares_of(beams.first + rows, 301), 1e-9))
        is_free = away < met.ranges[rows]
        ranges[rows[is_free]] = away[is_free]

    def _lone(self, beams: Beams, met: BeamHits, ranges: Floats) -> None:
        """Ranges of nothing, most before what the beam met: the receiver's own noise."""
        rows = self._chosen(beams, np.arange(met.ranges.size), self._request.lone, 800)
        away = _LEAST_M + (_LONE_M - _LEAST_M) * shares_of(beams.first + rows, self._key + 801)
        is_free = self._request.lone_anywhere | (away < met.ranges[rows])
        ranges[rows[is_free]] = away[is_free]

    def _late(self, beams: Beams, met: BeamHits, ranges: Floats) -> None:
        """Echoes that came back by way of a second surface: single points behind the first."""
        rows = np.flatnonzero(np.isfinite(met.ranges))
        rows = self._chosen(beams, rows, self._request.late, 700)
        detour = _LEAST_DETOUR_M - np.log(np.maximum(shares_of(beams.first + rows, 701), 1e-9))
        ranges[rows] = met.ranges[rows] + detour

    def _mirrored(self, recorded: PulseHits, ranges: Floats) -> MirroredEchoes:
        """Glass and water: some beams come back from what they mirror."""
        beams, met = recorded.beams, recorded.met
        rows = np.flatnonzero(np.isin(met.material, MIRRORS) & np.isfinite(met.ranges))
        rows = self._chosen(beams, rows, self._request.mirrored, 400)
        scanner = recorded.scanner.copy()
        scanner[PASSED] = self._request.pane**2  # there and back
        scanner[WEAKEST] *= self._request.faint
        images = mirrored_echoes(beams, met, recorded.scene, scanner, rows, key=self._key)
        ranges[images.rays] = images.ranges
        return images

    def _without_panes(self, beams: Beams, met: BeamHits, returns: Returns) -> Returns:
        """The returns but those of panes that send nothing back themselves."""
        if self._request.spotless <= 0:
            return returns
        rows = returns.pulse - beams.first
        is_lost = np.isin(met.material[rows], MIRRORS)
        is_lost &= shares_of(returns.pulse, self._key + 410) < self._request.spotless
        return number_returns(returns.chosen(~is_lost))

    def _merged(self, recorded: PulseHits, ranges: Floats, images: MirroredEchoes) -> Returns:
        beams, met, returns = recorded.beams, recorded.met, recorded.returns
        returns = self._without_panes(beams, met, returns)
        rows = np.flatnonzero((ranges > _LEAST_M) & (ranges < self._sensor.most_m))
        if rows.size == 0:
            return returns
        is_below = np.isin(met.label[rows], _GROUND_LABELS) & (ranges[rows] > met.ranges[rows])
        is_below |= np.isin(rows, images.rays[images.is_level])
        positions = beams.origins[rows] + beams.directions[rows] * ranges[rows, None]
        is_below |= _under_ground(recorded.scene, positions)
        label = np.where(is_below, LOW_NOISE, HIGH_NOISE).astype(np.uint8)
        weak = 10.0 ** (-3.0 + 2.5 * shares_of(beams.first + rows, self._key + 500))
        is_image = np.isin(rows, images.rays)
        weak[is_image] = images.strengths[np.searchsorted(images.rays, rows[is_image])]
        ones = np.ones(rows.size, np.uint8)
        noise = Returns(
            beams.first + rows,
            beams.time_s[rows],
            positions,
            weak,
            ones,
            ones,
            label,
            np.full(rows.size, NO_EVIDENCE, np.int64),
        )
        is_replaced = np.zeros(ranges.size, np.bool_)
        is_replaced[rows] = True
        kept = returns.chosen(~is_replaced[returns.pulse - beams.first])
        joined = Returns.joined([kept, noise])
        return number_returns(joined.chosen(np.argsort(joined.pulse, kind="stable")))


def _under_ground(scene: RaycastScene, positions: Floats) -> NDArray[np.bool_]:
    """Whether ground is the first thing above places: what panes mirror may seem to lie there."""
    hits = scene.cast(positions, np.broadcast_to([0.0, 0.0, 1.0], positions.shape))
    is_hit = hits.triangles >= 0
    under: NDArray[np.bool_] = np.zeros(is_hit.size, np.bool_)
    under[is_hit] = np.isin(scene.mesh.label[hits.triangles[is_hit]], _GROUND_LABELS)
    return under
