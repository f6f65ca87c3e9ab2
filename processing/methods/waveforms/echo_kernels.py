"""Echoes of one waveform: sums of broadened system pulses, fitted by Levenberg and Marquardt.

A component is (amplitude, place, width): the response to a flat target, broadened by a Gaussian.
They are added one after another where the residual, filtered with the pulse, is strongest, and
kept only where they lessen it by more than noise and the pulse's own error would.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

MOST_ECHOES = 10
"""Of one packet; scanners deliver no more returns than that of a crown."""

FACTS = 9
"""Of an echo: place, amplitude, width (samples), their standard deviations, the height of its
maximum, the covariance of place and amplitude, the chi-square of a sample around it."""

_ROUNDS = 25
"""Steps of a fit at most: it ends by itself after some six."""

_ENOUGH = 1e-3
"""A fit has ended where chi-square falls by a smaller share."""

_WIDTH_FROM = 10.0
"""Standard deviations of its amplitude above which an echo's width is asked for: below, the width's
own standard deviation is as large as the pulse is wide."""


_BROAD = 0.12
"""Widths of the pulse: a broadening from which on an echo may be two."""


_APART = 0.4
"""Widths of the pulse: nearer maxima can't be told from one surface with some depth."""

_LEAST_PART = 4.0
"""Standard deviations of the noise that either half of a split echo has at least."""


@kernel
def _solve(a: NDArray[np.float64], b: NDArray[np.float64], n: int) -> bool:
    """Solve a positive definite system in place by Cholesky; the answer comes to lie in ``b``."""
    for j in range(n):
        for k in range(j):
            a[j, j] -= a[j, k] * a[j, k]
        if a[j, j] <= 1e-30:
            return False
        a[j, j] = np.sqrt(a[j, j])
        for i in range(j + 1, n):
            for k in range(j):
                a[i, j] -= a[i, k] * a[j, k]
            a[i, j] /= a[j, j]
    for i in range(n):
        for k in range(i):
            b[i] -= a[i, k] * b[k]
        b[i] /= a[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= a[k, i] * b[k]
        b[i] /= a[i, i]
    return True


@kernel
def _pulse(
    table: NDArray[np.float64], grid: NDArray[np.float64], time: float, width: float,
    out: NDArray[np.float64],
) -> None:  # fmt: skip
    """Value of the broadened pulse, and its derivatives by time and by width."""
    place, row = (time - grid[0]) / grid[1], width / grid[2]
    i, k = int(np.floor(place)), int(row)
    k = min(k, table.shape[0] - 2)
    if i < 0 or i + 1 >= table.shape[1]:
        out[0], out[1], out[2] = 0.0, 0.0, 0.0
        return
    u, v = place - i, row - k
    a, b = table[k, i], table[k, i + 1]
    c, d = table[k + 1, i], table[k + 1, i + 1]
    low, high = a + u * (b - a), c + u * (d - c)
    out[0] = low + v * (high - low)
    out[1] = ((b - a) * (1.0 - v) + (d - c) * v) / grid[1]
    out[2] = (high - low) / grid[2]


@kernel
def _model(
    table: NDArray[np.float64], grid: NDArray[np.float64], p: NDArray[np.float64], count: int,
    model: NDArray[np.float64],
) -> None:  # fmt: skip
    out = np.empty(3)
    model[:] = 0.0
    after = grid[0] + grid[1] * (table.shape[1] - 1)
    for one in range(count):
        first = max(0, int(np.ceil(p[one, 1] + grid[0])))
        last = min(model.size - 1, int(np.floor(p[one, 1] + after)))
        for at in range(first, last + 1):
            _pulse(table, grid, at - p[one, 1], p[one, 2], out)
            model[at] += p[one, 0] * out[0]


@kernel
def _chi(
    y: NDArray[np.float64], model: NDArray[np.float64], sigma: float, share: float, top: float
) -> float:
    """Chi-square; what the recorder cut off at its top can only be exceeded."""
    total = 0.0
    for at in range(y.size):
        off = y[at] - model[at]
        if y[at] >= top and off < 0.0:
            continue
        total += off * off / (sigma * sigma + (share * model[at]) ** 2)
    return total


@kernel
def _fit(
    y: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    noise: tuple[float, float, float],
    p: NDArray[np.float64],
    count: int,
    model: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> float:
    """Fit all components together; gives chi-square. ``inverse`` gets the covariance."""
    sigma, share, top = noise
    widest = grid[2] * (table.shape[0] - 1)
    n, damping = 3 * count, 1e-3
    jac = np.zeros((n, y.size))
    normal, right = np.empty((n, n)), np.empty(n)
    whole, gradient = np.empty((n, n)), np.empty(n)
    other_model, moved = p.copy(), model.copy()
    _model(table, grid, p, count, model)
    best = _chi(y, model, sigma, share, top)
    for _ in range(_ROUNDS):
        _derivatives(y, table, grid, noise, p[:count], model, jac)
        _normal_equations(y, model, jac, noise, (whole, gradient))
        improved = False
        for _ in range(6):
            normal[:], right[:] = whole, gradient
            for i in range(n):
                # A width that isn't asked for has no column: it stays.
                normal[i, i] = normal[i, i] * (1.0 + damping) + 1e-9
            if not _solve(normal, right, n):
                damping *= 10.0
                continue
            _move(p[:count], right, y.size - 1.0, widest, other_model)
            _model(table, grid, other_model, count, moved)
            chi = _chi(y, moved, sigma, share, top)
            if chi < best:
                improved = best - chi > _ENOUGH * best
                best = chi
                p[:count, :3] = other_model[:count, :3]
                model[:] = moved
                damping = max(1e-7, 0.2 * damping)
                break
            damping *= 8.0
        if not improved:
            break
    _covariance(whole, n, inverse)
    return best


@kernel
def _derivatives(
    y: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    noise: tuple[float, float, float],
    p: NDArray[np.float64],
    model: NDArray[np.float64],
    jac: NDArray[np.float64],
) -> None:
    """Weighted derivatives of the model by each component's amplitude, place and width."""
    sigma, share, top = noise
    out = np.empty(3)
    after = grid[0] + grid[1] * (table.shape[1] - 1)
    jac[:] = 0.0
    for one in range(len(p)):
        first = max(0, int(np.ceil(p[one, 1] + grid[0])))
        last = min(y.size - 1, int(np.floor(p[one, 1] + after)))
        for at in range(first, last + 1):
            if y[at] >= top and model[at] > y[at]:
                continue
            _pulse(table, grid, at - p[one, 1], p[one, 2], out)
            weight = 1.0 / np.sqrt(sigma * sigma + (share * model[at]) ** 2)
            jac[3 * one, at] = weight * out[0]
            jac[3 * one + 1, at] = -weight * p[one, 0] * out[1]
            jac[3 * one + 2, at] = weight * p[one, 0] * out[2] * p[one, 3]


@kernel
def _move(
    p: NDArray[np.float64],
    step: NDArray[np.float64],
    last: float,
    widest: float,
    moved: NDArray[np.float64],
) -> None:
    """Components after a step, within what they can be; no place moves by more than two samples."""
    for one in range(len(p)):
        moved[one, 0] = max(0.0, p[one, 0] + step[3 * one])
        aside = min(2.0, max(-2.0, step[3 * one + 1]))
        moved[one, 1] = min(last, max(0.0, p[one, 1] + aside))
        wider = min(widest, max(0.0, p[one, 2] + step[3 * one + 2]))
        moved[one, 2] = wider if p[one, 3] > 0 else p[one, 2]


@kernel
def _normal_equations(
    y: NDArray[np.float64],
    model: NDArray[np.float64],
    jac: NDArray[np.float64],
    noise: tuple[float, float, float],
    out: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> None:
    sigma, share, top = noise
    whole, gradient = out
    whole[:], gradient[:] = 0.0, 0.0
    n = len(gradient)
    for at in range(y.size):
        off = (y[at] - model[at]) / np.sqrt(sigma * sigma + (share * model[at]) ** 2)
        if y[at] >= top and off < 0.0:
            off = 0.0
        for i in range(n):
            if jac[i, at] != 0.0:
                gradient[i] += jac[i, at] * off
                for k in range(i + 1):
                    whole[i, k] += jac[i, at] * jac[k, at]
    for i in range(n):
        for k in range(i):
            whole[k, i] = whole[i, k]


@kernel
def _covariance(whole: NDArray[np.float64], n: int, inverse: NDArray[np.float64]) -> None:
    column = np.empty(n)
    for i in range(n):
        whole[i, i] += 1e-9
    for i in range(n):
        column[:] = 0.0
        column[i] = 1.0
        copy = whole.copy()
        if not _solve(copy, column, n):
            column[:] = 1e9
        for k in range(n):
            inverse[k, i] = column[k]


@kernel
def _strongest(
    y: NDArray[np.float64],
    model: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    noise: tuple[float, float],
) -> tuple[float, float, float]:
    """Where the residual looks most like a pulse: its significance, place and amplitude."""
    sigma, share = noise
    best, place, height = 0.0, 0.0, 0.0
    out = np.empty(3)
    reach = max(2, int(np.ceil(grid[3])))
    for centre in range(y.size):
        for part in range(2):
            at = centre + 0.5 * part
            total, square = 0.0, 0.0
            for sample in range(max(0, centre - reach), min(y.size, centre + reach + 2)):
                _pulse(table, grid, sample - at, 0.0, out)
                weight = 1.0 / (sigma * sigma + (share * model[sample]) ** 2)
                total += weight * out[0] * (y[sample] - model[sample])
                square += weight * out[0] * out[0]
            if square > 0.0 and total / np.sqrt(square) > best:
                best, place, height = total / np.sqrt(square), at, total / square
    return best, place, height


@kernel
def _decompose_one(
    y: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    rule: tuple[float, float, float, float, float, float],
    p: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> tuple[int, float]:
    """Components of one waveform whose baseline is 0; gives how many, and chi-square a sample."""
    sigma, share, top, least, gain, _ = rule
    noise = (sigma, share, top)
    model, kept_model = np.zeros(y.size), np.zeros(y.size)
    chi = _chi(y, model, sigma, share, top)
    count = 0
    kept = p.copy()
    while count < MOST_ECHOES:
        found, place, height = _strongest(y, model, table, grid, (sigma, share))
        if found < least:
            break
        kept[:], kept_model[:] = p, model
        p[count, 0], p[count, 1], p[count, 2], p[count, 3] = height, place, 0.0, 0.0
        # With its own width first: a broad echo is one component before it is two.
        for one in range(count + 1):
            p[one, 3] = 1.0 if p[one, 0] > _WIDTH_FROM * sigma else 0.0
        after = _fit(y, table, grid, noise, p, count + 1, model, inverse)
        if chi - after < gain:
            p[:], model[:] = kept, kept_model
            break
        chi = after
        count += 1
    count = _drop_weak(y, table, grid, rule, p, count, model, inverse)
    count = _split_broad(y, table, grid, rule, p, count, model, inverse)
    if count > 0:
        chi = _fit(y, table, grid, noise, p, count, model, inverse)
    return count, chi / y.size


@kernel
def _drop_weak(
    y: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    rule: tuple[float, float, float, float, float, float],
    p: NDArray[np.float64],
    count: int,
    model: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> int:
    """Leave out components without which the others fit as well."""
    sigma, share, top, _, gain, _ = rule
    noise = (sigma, share, top)
    other = np.zeros_like(p)
    other_model = np.zeros(y.size)
    while count > 1:
        chi = _fit(y, table, grid, noise, p, count, model, inverse)
        weakest = 0
        for one in range(1, count):
            if p[one, 0] < p[weakest, 0]:
                weakest = one
        other[:] = p
        for one in range(weakest, count - 1):
            other[one] = p[one + 1]
        for one in range(count - 1):
            other[one, 3] = 1.0 if other[one, 0] > _WIDTH_FROM * sigma else 0.0
        without = _fit(y, table, grid, noise, other, count - 1, other_model, inverse)
        if without - chi > gain:
            return count
        p[:], model[:] = other, other_model
        count -= 1
    return count


@kernel
def _split_broad(
    y: NDArray[np.float64],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    rule: tuple[float, float, float, float, float, float],
    p: NDArray[np.float64],
    count: int,
    model: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> int:
    """Take a broad component for two narrow ones where these explain the samples better."""
    sigma, share, top, _, _, split = rule
    noise = (sigma, share, top)
    if count == 0:
        return 0
    chi = _fit(y, table, grid, noise, p, count, model, inverse)
    other, other_model = p.copy(), model.copy()
    one = 0
    while one < count and count < MOST_ECHOES:
        width = p[one, 2]
        if p[one, 3] == 0.0 or width < _BROAD * grid[3]:
            one += 1
            continue
        other[:] = p
        other[one, 0], other[count, 0] = 0.5 * p[one, 0], 0.5 * p[one, 0]
        other[one, 1], other[count, 1] = p[one, 1] - width, p[one, 1] + width
        other[one, 2], other[count, 2] = 0.0, 0.0
        other[one, 3], other[count, 3] = 0.0, 0.0
        two = _fit(y, table, grid, noise, other, count + 1, other_model, inverse)
        least = min(other[one, 0], other[count, 0])
        apart = abs(other[one, 1] - other[count, 1])
        if chi - two > split and least > _LEAST_PART * sigma and apart > _APART * grid[3]:
            p[:], model[:] = other, other_model
            chi = two
            count += 1
        one += 1
    return count


@kernel
def decompose_kernel(
    samples: NDArray[np.float32],
    lengths: NDArray[np.int32],
    table: NDArray[np.float64],
    grid: NDArray[np.float64],
    rule: NDArray[np.float64],
    counts: NDArray[np.int32],
    echoes: NDArray[np.float64],
) -> None:
    """Echoes of each row, in the order of time: (n,) counts and (n, most, facts)."""
    p, inverse = (
        np.zeros((MOST_ECHOES + 1, 4)),
        np.zeros((3 * MOST_ECHOES + 3, 3 * MOST_ECHOES + 3)),
    )
    baseline, sigma, share, top, least, gain, split = rule
    out = np.empty(3)
    for row in range(len(samples)):
        y = samples[row, : lengths[row]].astype(np.float64) - baseline
        p[:] = 0.0
        count, chi = _decompose_one(
            y, table, grid, (sigma, share, top - baseline, least, gain, split), p, inverse
        )  # fmt: skip
        order = np.argsort(p[:count, 1])
        written = 0
        for one in order:
            _pulse(table, grid, 0.0, p[one, 2], out)
            if p[one, 0] <= 0.0:
                continue
            facts = echoes[row, written]
            facts[0], facts[1], facts[2] = p[one, 1], p[one, 0], p[one, 2]
            facts[3] = np.sqrt(max(0.0, inverse[3 * one + 1, 3 * one + 1]))
            facts[4] = np.sqrt(max(0.0, inverse[3 * one, 3 * one]))
            facts[5] = (
                np.sqrt(max(0.0, inverse[3 * one + 2, 3 * one + 2])) if p[one, 3] > 0 else np.nan
            )
            facts[6] = p[one, 0] * out[0]
            facts[7] = inverse[3 * one, 3 * one + 1]
            facts[8] = chi
            written += 1
        counts[row] = written
