"""Echoes that were found in waveforms, held against those that the pulses really met."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from processing.core.arrays import Floats, Integers

KINDS = ("alone", "apart", "near", "weak")
"""Of true echoes: by how far the next is, and weak ones."""

APART_M, NEAR_M = 1.2, 0.6
"""A pulse of 4 ns separates targets 0.6 m apart (Shinohara 2022, equation 2.2)."""

CLEAR, SEEN, FELT = 8.0, 4.0, 3.0
"""Standard deviations of the noise: maxima of clear and of weak echoes, and of those that count as
neighbours. Below 4 the samples of one echo don't show it with one false echo in 500."""

_REACH_M = 0.3
"""Farthest that a found echo lies from the true one; half the gap where another is near."""

_LEAST_REACH_M = 0.15
_LEVEL_M = 0.03
"""Spread of what a compact echo comes from, standard deviation."""

SURE = 20.0
"""Standard deviations of the noise of echoes whose ranges are compared: below, noise alone moves
them by a centimetre."""


@dataclass(frozen=True)
class TrueEchoes:
    """Echoes in the order of pulses.

    ``pulse`` (n,) int64; ``range_m`` and ``spread_m`` float64; ``amplitude`` float64, in standard
    deviations of the noise; ``recorded`` (n,) bool, whether a packet holds its range.
    """

    pulse: Integers
    range_m: Floats
    spread_m: Floats
    amplitude: Floats
    recorded: np.typing.NDArray[np.bool_]


@dataclass
class EchoScore:
    """How many were found.

    Attributes
    ----------
    found, wanted : dict
        By kind: ``alone`` (the next at least 1.2 m away), ``apart`` (0.6 to 1.2 m), ``near``,
        ``weak`` (4 to 8 standard deviations, the next at least 0.6 m away).
    false, points : int
        Found echoes where there is nothing, and all.
    split, lone : int
        Lone clear echoes found twice or more, and all that were found.
    errors_m, compact_errors_m : list of float
        Of ranges of clear lone echoes, and of those from a flat target across the beam.
    """

    found: dict[str, int] = field(default_factory=lambda: dict.fromkeys(KINDS, 0))
    wanted: dict[str, int] = field(default_factory=lambda: dict.fromkeys(KINDS, 0))
    false: int = 0
    points: int = 0
    split: int = 0
    lone: int = 0
    errors_m: list[float] = field(default_factory=list)
    compact_errors_m: list[float] = field(default_factory=list)

    @property
    def measures(self) -> Mapping[str, float]:
        """Shares, and root mean squares in cm, by name."""
        values = {kind: self.found[kind] / max(1, self.wanted[kind]) for kind in KINDS}
        values["false"] = self.false / max(1, self.points)
        values["split"] = self.split / max(1, self.lone)
        for name, errors in (("range_cm", self.errors_m), ("compact_cm", self.compact_errors_m)):
            values[name] = 100.0 * float(np.sqrt(np.mean(np.square(errors)))) if errors else np.nan
        return values


def echo_score(truth: TrueEchoes, pulse: Integers, range_m: Floats) -> EchoScore:
    """Score found echoes.

    Parameters
    ----------
    pulse, range_m : (k,)
        Of the found echoes, in the order of pulses.
    """
    score = EchoScore(points=len(pulse))
    for number in np.unique(np.concatenate([truth.pulse[truth.recorded], pulse])):
        true = slice(*np.searchsorted(truth.pulse, [number, number + 1]))
        mine = slice(*np.searchsorted(pulse, [number, number + 1]))
        _score_pulse(truth, true, range_m[mine], score)
    return score


def _score_pulse(truth: TrueEchoes, true: slice, found_m: Floats, score: EchoScore) -> None:
    ranges, spread, height = truth.range_m[true], truth.spread_m[true], truth.amplitude[true]
    recorded = truth.recorded[true]
    away = np.abs(found_m[:, None] - ranges) - 3.0 * spread
    score.false += int((away.min(axis=1, initial=np.inf) > _REACH_M).sum())
    taken: set[int] = set()
    for one in np.argsort(-height):
        if not recorded[one] or height[one] < SEEN:
            continue
        others = np.abs(np.delete(ranges, one) - ranges[one])
        gap = float(others[np.delete(height, one) > FELT].min(initial=np.inf))
        reach = max(_LEAST_REACH_M, min(_REACH_M, 0.5 * gap)) + spread[one]
        off = np.abs(found_m - ranges[one])
        order = [int(k) for k in np.argsort(off) if k not in taken and off[k] < reach]
        if order:
            taken.add(order[0])
        kind = _kind_of(float(height[one]), gap)
        if not kind:
            continue
        score.wanted[kind] += 1
        score.found[kind] += bool(order)
        if kind == "alone" and order and others.min(initial=np.inf) > APART_M:
            score.lone += 1
            if (off < APART_M).sum() > 1:
                score.split += 1
            elif height[one] > SURE:
                error = float(found_m[order[0]] - ranges[one])
                score.errors_m.append(error)
                if spread[one] < _LEVEL_M:
                    score.compact_errors_m.append(error)


def _kind_of(height: float, gap: float) -> str:
    if height < CLEAR:
        return "weak" if gap > NEAR_M else ""
    return "alone" if gap > APART_M else "apart" if gap > NEAR_M else "near"
