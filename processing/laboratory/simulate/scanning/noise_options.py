"""How much noise a recording has: of what kinds, and how often each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from processing.laboratory.simulate.scanning.sensors import Sensor
from processing.laboratory.simulate.scene.chance import chance

_DUSTY_SHARE = 0.25
"""Of streets: where something throws up dust, spray or steam beside the road."""

_SUNNY_SHARE = 0.5
"""Of recordings: where a head may look towards the sun."""

_SPOTLESS_SHARE, _SPOTLESS = 0.6, (0.5, 1.0)
_FAINT = (-2.0, 0.0)
"""Powers of ten."""


@dataclass(frozen=True)
class NoiseOptions:
    """How much noise a recording has, as shares of pulses where nothing else is said.

    Attributes
    ----------
    arcs_per_s : float
        Arcs that begin in a second.
    folded : float
        Of what lies beyond the range of unambiguity.
    streaks : float
        Of pulses on retro-reflecting plates.
    drops : float
        Of all pulses: rain, dust, insects.
    late : float
        Of all pulses: echoes by way of a second surface, behind what the beam met.
    lone : float
        Of all pulses: ranges of nothing, as a receiver measures its own noise.
    clouds_per_s : float
        Clouds of dust, spray or steam that the vehicle passes in a second.
    patches_per_s : float
        Patches of ground that a second way of the light shows lower, passed in a second.
    sun : float
        Of pulses that look into the sun.
    glints_per_s : float
        Times in a second that the sun shines into the receiver by way of panes, chrome and water.
    mirrored : float
        Of pulses on panes, mirrors and water: those that may come back of what is seen there.
    pane : float
        Of the light that a pane sends back. Clear double panes: 0.15 (their four faces by Fresnel,
        index 1.52: 4.3 % each, less what the faces before let by); coatings against heat, made to
        send back the near infrared, 0.3 to 0.6 and more; metal 0.9.
    spotless : float
        Of pulses on panes, mirrors and water: those of which the surface itself, clean or still,
        sends nothing back.
    faint : float
        Of the weakest echo that is taken from a surface: what an image needs. A phase is compared
        all the time, of whatever light there is.
    saturated : float
        Strength of an echo, 1 that of a white surface 10 m away, beyond which the receiver is
        driven too far and measures as it does on retro-reflecting plates.
    streak_m : float
        Standard deviation of ranges that are measured so.
    lasting : float
        How many times as long as usual arcs and glints last: a scanner on a tripod turns so slowly
        that what shines into it does so for a good part of a scan.
    arc_turn : float
        Half of the widest arc, of a turn.
    aside_m : float
        How far from the carrier's way clouds lie, at most.
    lone_anywhere : bool
        Whether ranges of nothing may lie behind what the beam met, too: where no echo is waited
        for, weak light is measured anywhere.
    glazed : float
        Of upright walls: shop windows, glazed halls, panes of glass where walls would stand.
    """

    arcs_per_s: float
    folded: float
    streaks: float
    drops: float
    late: float = 0.0
    lone: float = 0.0
    clouds_per_s: float = 0.0
    patches_per_s: float = 0.0
    sun: float = 0.0
    glints_per_s: float = 0.0
    mirrored: float = 0.25
    pane: float = 0.15
    spotless: float = 0.0
    faint: float = 1.0
    saturated: float = math.inf
    streak_m: float = 0.5
    lasting: float = 1.0
    arc_turn: float = 0.2
    aside_m: float = 8.0
    lone_anywhere: bool = False
    glazed: float = 0.0

    def times(self, often: float) -> NoiseOptions:
        """The same kinds so many times as often; shares of what is bright or far are the same."""
        if often == 1.0:
            return self
        shares = {name: min(1.0, often * getattr(self, name)) for name in ("drops", "late", "lone")}
        counts = ("arcs_per_s", "clouds_per_s", "patches_per_s", "glints_per_s")
        return replace(self, **shares, **{name: often * getattr(self, name) for name in counts})


def noise_options(seed: int, sensor: Sensor, often: float = 1.0) -> NoiseOptions:
    """How noisy a recording of this seed is.

    Parameters
    ----------
    often : float
        How many times the usual.

    Notes
    -----
    A phase-based scanner compares waves all the time and gives a range for whatever light comes
    in; one of pulses waits for an echo that stands out, and sees little where nothing is.
    """
    random, others = chance(seed, "noise"), chance(seed, "more noise")
    dust = float(others.uniform(0.05, 0.5)) if others.random() < _DUSTY_SHARE else 0.0
    is_sunny = bool(others.random() < _SUNNY_SHARE)
    if sensor.measures_by == "phase":
        found = NoiseOptions(
            float(random.uniform(0.5, 6.0)),
            float(random.uniform(0.3, 0.9)),
            float(random.uniform(0.1, 0.4)),
            float(10 ** random.uniform(-4, -2.7)),
            lone=float(10 ** others.uniform(-4, -2.7)),
            clouds_per_s=dust,
            patches_per_s=float(others.uniform(0.0, 1.0)),
            sun=float(others.uniform(0.05, 0.4)) if is_sunny else 0.0,
        )
    else:
        found = NoiseOptions(
            0.0,
            0.0,
            float(random.uniform(0.0, 0.03)),
            float(10 ** random.uniform(-5.5, -3.5)),
            float(10 ** random.uniform(-5.5, -4.0)),
            lone=float(10 ** others.uniform(-6.5, -5.0)),
            clouds_per_s=dust,
            patches_per_s=float(others.uniform(0.0, 0.1)),
            sun=float(others.uniform(0.0, 0.02)) if is_sunny else 0.0,
        )
    return found.times(often)


def varied_noise(seed: int, sensor: Sensor, *, has_clear_panes: bool = False) -> NoiseOptions:
    """Noise of which every kind is met in many recordings, its share drawn over powers of ten.

    For learning what noise is: where one kind alone is frequent, the others stay unknown. Which
    kinds a scanner has at all depends on how it measures, as in `noise_options`.

    Parameters
    ----------
    has_clear_panes : bool
        Whether most panes of many recordings send nothing back themselves, and images in them need
        less light than a surface does, where light is compared all the time.
    """
    found = _every_kind(seed, sensor)
    if not has_clear_panes:
        return found
    panes = chance(seed, "varied panes")
    spotless = float(panes.uniform(*_SPOTLESS)) if panes.random() < _SPOTLESS_SHARE else 0.0
    is_phase = sensor.measures_by == "phase"
    faint = float(10 ** panes.uniform(*_FAINT)) if is_phase else 1.0
    return replace(found, spotless=spotless, faint=faint)


def _every_kind(seed: int, sensor: Sensor) -> NoiseOptions:
    random = chance(seed, "varied noise")
    is_phase = sensor.measures_by == "phase"

    def power(low: float, high: float, share: float = 1.0) -> float:
        drawn, value = random.random(), float(10 ** random.uniform(low, high))
        return value if drawn < share else 0.0

    # One of pulses waits for an echo that stands out: a fifth of the false ones.
    fewer = 1.0 if is_phase else 0.2
    lasting = power(0.0, 1.0)
    return NoiseOptions(
        arcs_per_s=power(0.3, 1.5, 0.9) / math.sqrt(lasting) if is_phase else 0.0,
        folded=float(random.uniform(0.2, 0.95)) if is_phase else 0.0,
        streaks=fewer * float(random.uniform(0.2, 0.9)),
        drops=fewer * power(-4.0, -2.0),
        late=power(-5.5, -3.0),
        lone=fewer * power(-4.0, -2.0),
        clouds_per_s=power(-0.7, 0.6, 0.8),
        patches_per_s=power(-0.7, 1.0, 0.8),
        sun=fewer * power(-1.0, -0.2, 0.8),
        glints_per_s=power(0.0, 1.6, 0.8),
        mirrored=float(random.uniform(0.3, 0.9)),
        pane=float(10 ** random.uniform(-0.25, 0.0)),
        saturated=power(-0.6, 0.7),
        streak_m=power(-0.7, 0.4),
        lasting=lasting,
        arc_turn=float(random.uniform(0.1, 0.35)),
        aside_m=power(0.5, 1.3),
        lone_anywhere=is_phase,
        glazed=power(-1.0, -0.15, 0.7),
    )
