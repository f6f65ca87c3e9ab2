"""Echoes and waveforms of a flight against what its pulses really met."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.scoring.features.file_scores import FileScore, errors_of, named_share
from processing.scoring.points.point_scores import NamedFigure
from processing.scoring.waveforms.echo_scores import (
    APART_M,
    CLEAR,
    NEAR_M,
    SEEN,
    SURE,
    TrueEchoes,
    echo_score,
)
from processing.scoring.waveforms.wave_errors import best_constant, constant_error, wave_error

HALF_LIGHT_M_NS = 0.149896229
"""Range for each ns of a waveform: half the speed of light."""

SAME_TIME_S = 1e-6
"""Times of one pulse differ by less, in whatever unit a file kept them; pulses follow later."""

_BEFORE_NS, _BEHIND_NS = 2.0, 8.0
"""An echo nearer to its packet's ends is not wholly recorded."""

_KIND_NAMES = {
    "alone": ("clear echoes alone that were found", "単独の明瞭なエコーの検出"),
    "apart": (
        "with the next at 0.6 to 1.2 m that were found",
        "隣が0.6～1.2mのエコーの検出",
    ),
    "near": ("with the next nearer than 0.6 m that were found", "隣が0.6m未満のエコーの検出"),
    "weak": ("weak echoes that were found", "弱いエコーの検出"),
}
_CLASS_NAMES = {
    2: ("ground", "地面"),
    5: ("vegetation", "植生"),
    6: ("building", "建物"),
    11: ("road", "道路"),
    14: ("wire", "電線"),
    15: ("tower", "鉄塔"),
}


@dataclass(frozen=True, eq=False)
class FlightTruth:
    """What a flight's pulses met, and what of it was recorded.

    Attributes
    ----------
    time_s : (b,) float64
        Of each pulse, as the delivered points have it.
    origin, direction : (b, 3) float64
        Where each pulse began, m; unit vectors away from the sensor.
    echoes : TrueEchoes
    """

    time_s: Floats
    origin: Floats
    direction: Floats
    echoes: TrueEchoes


@dataclass(frozen=True, eq=False)
class FoundEchoes:
    """Points of a decomposed flight: ``time_s`` (k,) of their pulses, ``xyz`` (k, 3) m."""

    time_s: Floats
    xyz: Floats


@dataclass(frozen=True, eq=False)
class TrueWaves:
    """First returns: ``time_s`` (n,), ``waves`` (n, m) counts, ``label`` (n,) of six classes."""

    time_s: Floats
    waves: NDArray[Any]
    label: NDArray[np.uint8]


@dataclass(frozen=True)
class EchoScorer:
    """How points of decomposed waveforms are scored.

    Attributes
    ----------
    tool : str
    name : Text
    score : callable
    """

    tool: str
    name: Text
    score: Callable[[FoundEchoes, FlightTruth], FileScore]


@dataclass(frozen=True)
class WaveScorer:
    """How estimated waveforms are scored.

    Attributes
    ----------
    tool : str
    name : Text
    score : callable
        Of the waveforms (n, m), in counts, of the truth's first returns, which of them (n,) the
        result has, and the truth.
    """

    tool: str
    name: Text
    score: Callable[[NDArray[np.float32], NDArray[np.bool_], TrueWaves], FileScore]


def recorded_echoes(
    pulse: Integers, range_m: Floats, beam: Integers, first_m: Floats, span_m: float
) -> NDArray[np.bool_]:
    """Which true echoes lie wholly in a packet.

    Parameters
    ----------
    pulse, range_m : (n,)
        Of the echoes, in the order of pulses.
    beam, first_m : (k,)
        Of packets: their pulse, and the range of the first sample, m.
    span_m : float
        From the first to behind the last sample.
    """
    recorded = np.zeros(pulse.size, np.bool_)
    begins, ends = np.searchsorted(pulse, beam), np.searchsorted(pulse, beam, "right")
    for begin, end, first in zip(begins.tolist(), ends.tolist(), first_m.tolist(), strict=True):
        after = range_m[begin:end] - first
        recorded[begin:end] |= (after > _BEFORE_NS * HALF_LIGHT_M_NS) & (
            after < span_m - _BEHIND_NS * HALF_LIGHT_M_NS
        )
    return recorded


def rows_at(times_s: Floats, wanted_s: Floats) -> Integers:
    """For each wanted time the row of the same one in ``times_s``; −1 where there is none."""
    if not times_s.size:
        return np.full(wanted_s.size, -1, np.int64)
    order = np.argsort(times_s, kind="stable")
    ordered = times_s[order]
    right = np.clip(np.searchsorted(ordered, wanted_s), 0, ordered.size - 1)
    left = np.maximum(right - 1, 0)
    is_left = np.abs(ordered[left] - wanted_s) <= np.abs(ordered[right] - wanted_s)
    nearest = np.where(is_left, left, right)
    fits = np.abs(ordered[nearest] - wanted_s) < SAME_TIME_S
    return np.where(fits, order[nearest], -1).astype(np.int64)


def flight_echo_score(found: FoundEchoes, truth: FlightTruth) -> FileScore:
    """Recalls by how near the next echo is, false and split points, errors of ranges.

    A point's pulse is told by its time, its range is the projection on the pulse's ray; points
    whose time no pulse has count as false.
    """
    pulse = rows_at(truth.time_s, found.time_s)
    away = found.xyz - truth.origin[pulse]
    range_m = np.einsum("ij,ij->i", away, truth.direction[pulse])
    order = np.lexsort((range_m, pulse))
    score = echo_score(truth.echoes, pulse[order], range_m[order])
    shares = [
        named_share(kind, name, score.found[kind], score.wanted[kind])
        for kind, name in _KIND_NAMES.items()
    ]
    shares.append(
        named_share("false", ("points where nothing is", "誤検出の点"), score.false, score.points)
    )
    shares.append(
        named_share(
            "split",
            ("lone echoes found twice or more", "複数に分かれた単独エコー"),
            score.split,
            score.lone,
        )
    )
    errors = (
        errors_of(
            "range", ("range, clear lone echoes", "距離（単独の明瞭なエコー）"), "m", score.errors_m
        ),
        errors_of(
            "compact", ("range, flat targets", "距離（平らな面）"), "m", score.compact_errors_m
        ),
    )
    return FileScore(
        "waveform-decompose",
        shares=tuple(shares),
        errors=errors,
        left_out={
            "unrecorded_echoes": int((~truth.echoes.recorded).sum()),
            "points_of_no_pulse": int((pulse < 0).sum()),
        },
        limits={
            "apart_m": APART_M,
            "near_m": NEAR_M,
            "clear_sigma": CLEAR,
            "weak_sigma": SEEN,
            "range_sigma": SURE,
            "same_time_s": SAME_TIME_S,
        },
    )


def flight_wave_score(
    waves: NDArray[np.float32], has_wave: NDArray[np.bool_], truth: TrueWaves
) -> FileScore:
    """Mean absolute errors over all samples, aligned within half a sample.

    ``as_written`` are the counts of the file; ``fitted`` those times the one factor that fits the
    truth best, as the plain estimate is compared; a first return without a waveform counts as
    zeros. ``by_constant`` is what ``fitted`` leaves of the best constant waveform's error.
    """
    written = wave_error(waves, truth.waves, truth.label, factor=1.0)
    fitted = wave_error(waves, truth.waves, truth.label)
    typical = best_constant(truth.waves, truth.label)
    constant = constant_error(typical, truth.waves, truth.label)
    errors = [
        errors_of(
            "as_written",
            ("mean of classes, as written", "クラス平均（出力値のまま）"),
            "counts",
            list(written.of_class.values()),
        ),
        errors_of(
            "fitted",
            ("mean of classes, one factor fitted", "クラス平均（係数1つで調整）"),
            "counts",
            list(fitted.of_class.values()),
        ),
        errors_of(
            "constant",
            ("mean of classes, best constant", "クラス平均（最良の一定波形）"),
            "counts",
            list(constant.of_class.values()),
        ),
    ]
    for code in fitted.of_class:
        en, ja = _CLASS_NAMES.get(code, (f"class {code}", f"クラス{code}"))
        errors.append(
            errors_of(f"class_{code}", (en, ja), "counts", fitted.each[truth.label == code])
        )
    has = int(has_wave.sum())
    return FileScore(
        "waveform-estimate",
        shares=(
            named_share(
                "with_waveform",
                ("first returns with a waveform", "波形のある最初のリターン"),
                has,
                has_wave.size,
            ),
        ),
        errors=tuple(errors),
        figures=(
            NamedFigure(
                "by_constant",
                Text("error as a share of the best constant's", "最良の一定波形に対する誤差の比"),
                fitted.mean / constant.mean if constant.mean else float("nan"),
            ),
        ),
        limits={"aligned_samples": 0.5, "factor": fitted.factor, "same_time_s": SAME_TIME_S},
    )
