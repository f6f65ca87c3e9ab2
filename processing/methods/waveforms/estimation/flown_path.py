"""Where an aircraft was, from the pulses that came back more than once: each shows its own ray."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats

_APART_M = 1.5
"""Between the first and the last return of a pulse whose direction is used: coordinates of a
centimetre tell it to half a degree, and there are hundreds."""

_TURNS = 4
_FEWEST = 12
"""Rays that six unknowns are taken of."""

_STRETCH_S = 10.0
"""An aircraft flies straight and steadily for that long."""

_PAUSE_S = 2.0
"""Between two lines."""

_LOWEST_M = 20.0
"""Least height above what it measures; a solution below is none."""


class FlownPath(NamedTuple):
    """Straight pieces of a flight.

    ``begins`` (k,) float64, s, rising; ``place`` (k, 3) float64, m, at a piece's beginning;
    ``speed`` (k, 3) float64, m/s; NaN where it isn't known.
    """

    begins: Floats
    place: Floats
    speed: Floats

    def directions(self, xyz: Floats, time: Floats) -> Floats:
        """Unit vectors away from the sensor, (n, 3); straight down where nothing is known.

        Parameters
        ----------
        xyz : (n, 3) float64
            First returns, m.
        time : (n,) float64
            Of their pulses, s.
        """
        piece = np.clip(np.searchsorted(self.begins, time, side="right") - 1, 0, None)
        after = (time - self.begins[piece])[:, None]
        ray = xyz - (self.place[piece] + after * self.speed[piece])
        length = np.linalg.norm(ray, axis=1, keepdims=True)
        known = np.isfinite(length[:, 0]) & (ray[:, 2] < -_LOWEST_M)
        down = np.array([0.0, 0.0, -1.0])
        return np.where(known[:, None], ray / np.maximum(length, 1e-9), down)


def flown_path(time: Floats, first: Floats, last: Floats, bounds: tuple[float, float]) -> FlownPath:
    """The path that rays through pairs of returns come from.

    Parameters
    ----------
    time : (n,) float64
        Of pulses with several returns, s, rising.
    first, last : (n, 3) float64
        Their first and last returns, m.
    bounds : (float, float)
        When the recording begins and ends, s.
    """
    apart = np.linalg.norm(last - first, axis=1)
    used = apart > _APART_M
    time, first, last, apart = time[used], first[used], last[used], apart[used]
    begins = _pieces(time, bounds)
    place, speed = np.full((begins.size, 3), np.nan), np.full((begins.size, 3), np.nan)
    ends = np.append(begins[1:], np.inf)
    for number, (begin, end) in enumerate(zip(begins, ends, strict=True)):
        here = slice(*np.searchsorted(time, [begin, end]))
        if time[here].size >= _FEWEST:
            ray = (last[here] - first[here]) / apart[here, None]
            place[number], speed[number] = _line(time[here] - begin, first[here], ray, apart[here])
    return FlownPath(begins, place, speed)


def _pieces(time: Floats, bounds: tuple[float, float]) -> Floats:
    starts = [bounds[0], *time[1:][np.diff(time) > _PAUSE_S].tolist()]
    ends = [*starts[1:], bounds[1]]
    pieces = [
        np.linspace(start, end, max(1, round((end - start) / _STRETCH_S)), endpoint=False)
        for start, end in zip(starts, ends, strict=True)
    ]
    return np.unique(np.concatenate(pieces))


def _line(after: Floats, through: Floats, ray: Floats, apart: Floats) -> tuple[Floats, Floats]:
    """A point that moves evenly and from which all rays come, by least squares.

    The farther apart a ray's two returns, the better its direction is known; rays that miss the
    others' path by far are taken less and less.
    """
    across = np.eye(3) - ray[:, :, None] * ray[:, None, :]
    # At the farther end an error of the direction weighs with the distance, the same for all.
    terms = np.concatenate([across, across * after[:, None, None]], axis=2)
    wanted = np.einsum("nij,nj->ni", across, through)
    weight = np.minimum(apart, 20.0)
    solved = np.zeros(6)
    for _ in range(_TURNS):
        left = (terms * weight[:, None, None]).reshape(-1, 6)
        right = (wanted * weight[:, None]).ravel()
        # A hover, or too little time to see a speed: the shortest answer has none.
        solved = np.linalg.lstsq(left, right, rcond=1e-9)[0]
        missed = np.linalg.norm(terms @ solved - wanted, axis=1)
        scale = float(np.median(missed * apart)) + 1e-9
        weight = np.minimum(apart, 20.0) / (1.0 + (missed * apart / (3.0 * scale)) ** 2)
    return solved[:3], solved[3:]
