"""A scanner's response to a flat target: from given values, or from a recording's own echoes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text

_STEP = 0.05
"""Samples between values of the table: linear between them errs by a thousandth of the pulse."""

_WIDTHS = 24
_WIDEST = 1.2
"""Broadest echo, as a Gaussian's standard deviation in widths of the pulse: a slope of 60° under a
footprint of half a metre widens a pulse of 4 ns by less."""

_NOTHING = 1e-3
"""Share of the maximum below which a pulse has ended."""

_CLEAR = 25.0
"""Standard deviations of the noise that an echo has which a pulse is learnt from: its shape is
known to some hundredths, and a thousand of them average to a thousandth."""

_QUIET = 5.0
"""Standard deviations of the noise that nothing else in such a waveform exceeds."""

_NARROWEST = 0.35
"""Share of the clear lone echoes, by width, that are taken: flat targets across the beam."""

_FEWEST, _MOST = 20, 4000
_STACK_STEP = 0.1
_TURNS = 4


class RecordNoise(NamedTuple):
    """Counts where nothing is met: mean and standard deviation."""

    baseline: float
    sigma: float


class SystemPulse(NamedTuple):
    """A pulse broadened by Gaussians.

    ``table`` (widths, values) float64, maximum 1 where it isn't broadened; ``grid`` (4,) float64,
    in samples: time of the first value, between values, between widths, full width at half
    maximum. Time 0 is that of the target's range: of an own pulse its maximum.
    """

    table: Floats
    grid: Floats


_ROUNDING = 12.0**-0.5
"""Standard deviation of counts that are rounded to whole numbers."""


def noise_of(samples: NDArray[np.float32], lengths: NDArray[np.int32]) -> RecordNoise:
    """Mean and standard deviation of the counts between echoes, robustly.

    Parameters
    ----------
    samples : (n, m) float32
        Counts, some thousand packets.
    lengths : (n,) int32
        Samples of each.
    """
    counts = np.where(np.arange(samples.shape[1]) < np.asarray(lengths)[:, None], samples, np.nan)
    # nanpercentile goes row by row, 3 s for some thousand: what is no count is sorted to the end.
    ordered = np.sort(counts, axis=1)
    quarter, middle = (_in_order(ordered, lengths, share) for share in (0.25, 0.5))
    bend = counts[:, :-2] - 2.0 * counts[:, 1:-1] + counts[:, 2:]
    quiet = np.abs(bend[counts[:, 1:-1] <= middle[:, None]])
    quiet = quiet[np.isfinite(quiet)]
    # 1.4826: from the median to a normal distribution's deviation; 6: variances of a bend.
    sigma = 1.4826 * float(np.median(quiet)) / np.sqrt(6.0) if quiet.size else 0.0
    sigma = max(sigma, _ROUNDING)
    baseline = float(np.median(quarter)) + 0.67 * sigma
    for _ in range(5):
        near = counts[np.abs(counts - baseline) < 3.0 * sigma]
        if near.size == 0:
            break
        # 1.014: what is cut off beyond three deviations.
        baseline, sigma = float(near.mean()), max(_ROUNDING, 1.014 * float(near.std()))
    return RecordNoise(baseline, sigma)


def _in_order(
    ordered: NDArray[np.float32], lengths: NDArray[np.int32], share: float
) -> NDArray[np.float64]:
    """(n,) what stands at a share of the way through each row's first values, between two."""
    last = np.maximum(np.minimum(lengths, ordered.shape[1]) - 1, 0)
    at = share * last
    low = at.astype(np.int64)
    rows = np.arange(len(ordered))
    below = ordered[rows, low].astype(np.float64)
    above = ordered[rows, np.minimum(low + 1, last)]
    return np.asarray(below + (at - low) * (above - below), np.float64)


def system_pulse(times: Floats, values: Floats) -> SystemPulse:
    """A pulse from its values.

    Parameters
    ----------
    times : (n,) float64
        In samples, evenly apart and rising; 0 is where a target's range is taken.
    values : (n,) float64
        In any unit.

    Raises
    ------
    Unsuitable
        There is no maximum within.
    """
    top = int(np.argmax(values))
    if len(values) < _LEAST_VALUES or top in {0, len(values) - 1} or values[top] <= 0.0:
        raise Unsuitable(
            Text("These values are no pulse.", "パルスの波形ではありません。"),
            Text.same(f"{len(values)}"),
            Text(
                "Give times and amplitudes with a maximum between them.",
                "途中に最大値をもつ時刻と振幅を指定してください。",
            ),
        )
    placed, scaled = np.asarray(times, np.float64), np.asarray(values) / values[top]
    fine = np.arange(placed[0], placed[-1], _STEP)
    fine_values = np.interp(fine, placed, scaled)
    fwhm = float((fine_values > 0.5).sum()) * _STEP
    seen = np.flatnonzero(np.abs(fine_values) > _NOTHING)
    first, last = fine[seen[0]], fine[seen[-1]]
    between = _WIDEST * fwhm / (_WIDTHS - 1)
    axis = np.arange(first - 3.2 * _WIDEST * fwhm, last + 3.2 * _WIDEST * fwhm, _STEP)
    base = np.interp(axis, placed, scaled, left=0.0, right=0.0)
    length = 2 * axis.size
    turns = np.fft.rfft(base, length)
    frequency = np.fft.rfftfreq(length, _STEP)
    widths = between * np.arange(_WIDTHS)[:, None]
    table = np.fft.irfft(turns * np.exp(-2.0 * (np.pi * frequency * widths) ** 2), length, axis=1)
    table = table[:, : axis.size]
    table[0] = base
    kept = np.flatnonzero(np.abs(table).max(axis=0) > 2.0 * _NOTHING)
    table = np.ascontiguousarray(table[:, kept[0] : kept[-1] + 1])
    return SystemPulse(table, np.array([axis[kept[0]], _STEP, between, fwhm]))


_LEAST_VALUES = 5


def own_pulse(
    samples: NDArray[np.float32], lengths: NDArray[np.int32], noise: RecordNoise, top: float
) -> SystemPulse:
    """The pulse of a recording, stacked from its narrowest clear lone echoes.

    Parameters
    ----------
    samples, lengths
        As of :func:`noise_of`.
    top : float
        Counts at which the recorder cuts off.

    Raises
    ------
    Unsuitable
        Too few echoes are clear and alone.
    """
    inside = np.arange(samples.shape[1]) < np.asarray(lengths)[:, None]
    waves = np.where(inside, samples - noise.baseline, 0.0)
    peak = waves.argmax(axis=1)
    height = waves[np.arange(len(waves)), peak]
    clear = (height > _CLEAR * noise.sigma) & (height < 0.97 * (top - noise.baseline))
    rows = np.flatnonzero(clear & (peak > 1) & (peak < np.asarray(lengths) - 2))
    widths = (waves[rows] > 0.5 * height[rows, None]).sum(axis=1)
    reach = int(3 * np.median(widths)) + 2 if rows.size else 1
    away = np.abs(np.arange(samples.shape[1]) - peak[rows, None]) > reach
    alone = (np.abs(waves[rows]) * away).max(axis=1, initial=0.0) < np.maximum(
        _QUIET * noise.sigma, 0.04 * height[rows]
    )
    rows = rows[alone]
    area = waves[rows].sum(axis=1) / height[rows]
    rows = rows[np.argsort(area, kind="stable")][: max(_FEWEST, int(_NARROWEST * rows.size))]
    if rows.size < _FEWEST:
        raise Unsuitable(
            Text(
                "Too few echoes are clear and alone to learn the scanner's pulse from them.",
                "明瞭な単独エコーが少なく、スキャナのパルス波形を求められません。",
            ),
            Text.same(f"{rows.size}"),
            Text(
                "Give the pulse: --set pulse=FILE.csv.", "--set pulse=FILE.csv で指定してください。"
            ),
        )
    rows = rows[:: max(1, rows.size // _MOST)]
    return _stacked(waves[rows], peak[rows].astype(np.float64), reach)


def _stacked(waves: Floats, place: Floats, reach: int) -> SystemPulse:
    """Mean of waveforms that are brought over each other, again and again."""
    sample = np.arange(waves.shape[1])
    bins = np.arange(-reach, reach + _STACK_STEP / 2, _STACK_STEP)
    rows = np.arange(len(waves))
    at = place.astype(np.int64)
    bend = waves[rows, at - 1] - 2.0 * waves[rows, at] + waves[rows, at + 1]
    lean = waves[rows, at - 1] - waves[rows, at + 1]
    place = place + np.where(bend < 0.0, 0.5 * lean / np.minimum(bend, -1e-9), 0.0)
    height = waves.max(axis=1)
    shape = np.zeros(bins.size)
    for _ in range(_TURNS):
        time = sample - place[:, None]
        number = np.rint((time + reach) / _STACK_STEP).astype(np.int64)
        used = (number >= 0) & (number < bins.size)
        scaled = waves / height[:, None]
        total = np.bincount(number[used], scaled[used], bins.size)
        count = np.bincount(number[used], minlength=bins.size)
        met = count > 0
        shape = np.interp(bins, bins[met], total[met] / count[met])
        shape = np.convolve(np.pad(shape, 1, mode="edge"), [0.25, 0.5, 0.25], mode="valid")
        shape /= shape.max()
        slope = np.gradient(shape, _STACK_STEP)
        model, lean = np.interp(time, bins, shape), np.interp(time, bins, slope)
        model, lean = np.where(used, model, 0.0), np.where(used, lean, 0.0)
        # One step of least squares for each waveform's height and place.
        mm, ll, ml = (
            (one * two).sum(axis=1) for one, two in ((model, model), (lean, lean), (model, lean))
        )
        my, ly = (model * waves).sum(axis=1), (lean * waves).sum(axis=1)
        by = np.maximum(mm * ll - ml**2, 1e-12)
        height = (my * ll - ly * ml) / by
        place = place - np.clip((ly * mm - my * ml) / by / np.maximum(height, 1e-9), -0.5, 0.5)
    near = shape > _TOP
    bend, lean, _ = np.polyfit(bins[near], shape[near], 2)
    return system_pulse(bins + 0.5 * lean / bend, shape)


_TOP = 0.8
"""Share of the maximum above which a stacked pulse is a parabola, which tells its top."""
