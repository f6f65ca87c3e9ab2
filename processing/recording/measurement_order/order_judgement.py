"""Whether an order of points is an order of measurement: profile after profile along a way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.recording.measurement_order.order_stretches import (
    WINDOW_POINTS,
    cut_stretches,
    is_in_planes,
    normals_of_order,
)
from processing.recording.measurement_order.sweep_fit import SweepFit, fit_sweep

_SAMPLES = 5
"""Windows of a stretch that are looked at, spread over it."""

_LEAST_FOLLOWING = 0.95
"""Share of points that must be what the beam reached next. Shuffled points keep under 0.2, points
by cell or by a coordinate under 0.75, profiles of every scanner seen 0.97 and more."""

_LEAST_COHERENCE = 0.05
"""Of increments with whole pulses: 0 is chance. Coordinates of 1 cm leave 0.1 to 0.6, of 1 mm 0.9.
The planes and the steps forward must hold as well."""

_MOST = 0.5
"""Share of the windows that must agree: most of them."""

_LEAST_STRETCH = 0.1
"""Share of the points that the longest stretch must have, for others to be joined to it: with less
the planes of most of them would be guessed."""

_SHORTEST_PIECE = 200
"""Points of the longest stretch of a shuffled recording are fewer: between near neighbours by
chance. The pieces of things that were sorted by object are longer."""

_STOOD_M = 0.5
"""Centres that scatter by less about one place: the scanner stood."""

REFUSED = Text(
    "The points have no times, and their order tells no rows: {why}; the top view is shown.",
    "点に時刻がなく、並び順からも行を決められません（{why}）。上面画像で表示します。",
)
TOO_FEW = Text("there are too few points", "点数が少なすぎます")
TOO_MANY = Text("there are too many points to look through", "点数が多すぎて調べられません")
_SHUFFLED = Text(
    "points that follow one another are no neighbours in a sweep",
    "連続する点が走査の隣り合う点ではありません",
)
_OFF_PLANES = Text(
    "they are sorted by place or come from several beams at once, not profile after profile",
    "断面ごとの並びではなく、位置順または複数ビームの並びです",
)
_FAR_AWAY = Text(
    "the lines don't come from a scanner within some metres of the road",
    "路面の近くにあるスキャナによる走査線ではありません",
)
_STOOD = Text(
    "they are sweeps of a scanner that stood still or went less than a metre",
    "静止した（または1 mも進んでいない）スキャナの走査順に並んでいます",
)
UNCONFIRMED = Text(
    "the rows that the longest stretch tells don't hold for most of the points",
    "最長区間から推定した行が大半の点に当てはまりません",
)
_PIECES = Text(
    "they come in pieces, of which none goes on along a way",
    "断片に分かれ、走行方向に続く区間がありません",
)


def longest_stretch(xyz: Floats, quantum_m: float) -> tuple[int, int, SweepFit] | Text:
    """The longest stretch in order of measurement, or why there is none.

    Parameters
    ----------
    xyz : (n, 3) float64
        m, in order, about a local origin.
    quantum_m : float
        What the coordinates are rounded to.

    Returns
    -------
    start, stop : int
        Its points.
    SweepFit
        Of one of its windows, with the step from pulse to pulse that holds for all.
    """
    middles, normals = normals_of_order(xyz)
    start, stop = cut_stretches(xyz, middles, normals)[0]
    if stop - start < max(WINDOW_POINTS, _LEAST_STRETCH * xyz.shape[0]):
        return _PIECES if stop - start >= _SHORTEST_PIECE else _SHUFFLED
    stretch = xyz[start:stop]
    windows, fits = [], []
    for first in np.unique(np.linspace(0, len(stretch) - WINDOW_POINTS, _SAMPLES).astype(int)):
        window = stretch[first : first + WINDOW_POINTS]
        fit = fit_sweep(window, quantum_m)
        if fit is not None:
            windows.append(window)
            fits.append(fit)
    if not fits:
        return _SHUFFLED
    return _refusal(windows, fits, quantum_m) or (start, stop, _agreed(fits))


def _refusal(windows: list[Floats], fits: list[SweepFit], quantum_m: float) -> Text | None:
    """Why the windows are no profiles along a way; None where they are."""
    if np.median([fit.following for fit in fits]) < _LEAST_FOLLOWING:
        return _SHUFFLED
    planar = [
        is_in_planes(window, fit.normal, quantum_m)
        for window, fit in zip(windows, fits, strict=True)
    ]
    coherence = float(np.median([fit.coherence for fit in fits]))
    if np.mean(planar) < _MOST or coherence < _LEAST_COHERENCE:
        return _OFF_PLANES
    if np.mean([fit.is_near for fit in fits]) < _MOST:
        return _FAR_AWAY
    centres: NDArray[np.float64] = np.array([fit.centre for fit in fits])
    scatter = np.linalg.norm(centres - np.median(centres, axis=0), axis=1)
    return _STOOD if np.median(scatter) < _STOOD_M else None


def _agreed(fits: list[SweepFit]) -> SweepFit:
    """The most coherent one, with the step in the middle of all."""
    best = max(fits, key=lambda fit: fit.coherence)
    return replace(best, step_rad=float(np.median([fit.step_rad for fit in fits])))
