"""Crossings of the mesh put in order: from left to right along each section."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Integers
from processing.core.kernels import kernel
from processing.image.scan_lines.scanline_arrays import ChainArrays, Crossings


@kernel
def _walk(
    crossings: Crossings, start: int, is_done: NDArray[np.bool_], order: Integers, at: int
) -> int:
    """Follow a chain from an end, or round a loop; gives where the next one is written."""
    here = start
    while here >= 0:
        is_done[here] = True
        order[at] = here
        at += 1
        a, b = crossings[here].first, crossings[here].second
        here = -1
        if a >= 0 and not is_done[a]:
            here = a
        elif b >= 0 and not is_done[b]:
            here = b
    return at


@kernel
def _leftmost(crossings: Crossings, start: int) -> int:
    """Where a loop is leftmost."""
    leftmost, before, here = start, start, crossings[start].first
    while here != start:
        if crossings[here].across < crossings[leftmost].across:
            leftmost = here
        step = crossings[here].first
        if step == before:
            step = crossings[here].second
        before, here = here, step
    return int(leftmost)


@kernel
def chains_kernel(crossings: Crossings, last_level: int, order: Integers, chains: Integers) -> int:
    """Chains of crossings up to a level, each from its left end; gives how many there are.

    ``order`` (n,) gets the crossings chain by chain, ``chains`` (n, 2) where each begins in it and
    its level; crossings that stand alone are left out.
    """
    count = crossings.shape[0]
    is_done = np.zeros(count, np.bool_)
    found, at = 0, 0
    # Open chains first, from their ends; what is left then are loops, cut where they are leftmost.
    for is_loop in (False, True):
        for vertex in range(count):
            if is_done[vertex] or crossings[vertex].level > last_level:
                continue
            a, b = crossings[vertex].first >= 0, crossings[vertex].second >= 0
            if not (a and b) if is_loop else a == b:
                continue
            start = _leftmost(crossings, vertex) if is_loop else vertex
            end = _walk(crossings, start, is_done, order, at)
            if crossings[order[end - 1]].across < crossings[order[at]].across:
                order[at:end] = order[at:end][::-1].copy()
            chains[found, 0], chains[found, 1] = at, crossings[vertex].level
            found += 1
            at = end
    chains[found, 0] = at
    return found


@kernel
def kept_kernel(crossings: Crossings, count: int, last_level: int, moved: Integers) -> int:
    """Move crossings above a level to the front; ``moved`` says where each went, −1: dropped."""
    kept = 0
    for vertex in range(count):
        moved[vertex] = -1
        if crossings[vertex].level > last_level:
            moved[vertex] = kept
            crossings[kept] = crossings[vertex]
            kept += 1
    for vertex in range(kept):
        one = crossings[vertex]
        if one.first >= 0:
            one.first = moved[one.first]
        if one.second >= 0:
            one.second = moved[one.second]
    return kept


@kernel
def gather_kernel(
    crossings: Crossings, order: Integers, chains: Integers, given: ChainArrays
) -> None:
    """Copy the crossings chain by chain; ``chains`` (k, 2) are their ends in the order."""
    level, across, height, time, intensity, point, is_break = given
    to = 0
    for chain in range(chains.shape[0]):
        for at in range(chains[chain, 0], chains[chain, 1]):
            one = crossings[order[at]]
            level[to] = one.level
            across[to], height[to], time[to] = one.across, one.height, one.time
            intensity[to], point[to] = one.intensity, one.point
            is_break[to] = at == chains[chain, 0]
            to += 1
