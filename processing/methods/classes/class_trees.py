"""Boosted trees with several classes: how likely each class is for rows of features.

Sixty-four rows are asked at a time. Which of them answer a question with "more" is one word, a bit
a row; trees have few different questions, since features were put into bins when they grew. A node
then divides the word of the rows that reach it, and rows that lie side by side mostly go the same
way, so that most of a tree's nodes are never seen. Sums are added tree by tree as before: the
shares are the same to the last bit as of a walk row by row.

References
----------
Lucchese and others 2015, QuickScorer (bits instead of branches); Leiserson, Prokop and Randall
1998, Using de Bruijn sequences to index a 1 in a computer word.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.noise.neighbours.sharing import share_out
from processing.methods.noise.tree_files import Forest
from processing.methods.noise.trees import Trees

_ROWS_AT_ONCE = 8_192
"""Rows of a share of a core's work."""

_WORD = 64
"""Rows that are asked together: the bits of a word."""

_NONE, _ONE = np.uint64(0), np.uint64(1)
_DE_BRUIJN, _TOP = np.uint64(0x03F79D71B4CB0A89), np.uint64(58)
"""Times a power of two, its six highest bits tell which."""

_BIT_OF = np.zeros(_WORD, np.int64)
for _bit in range(_WORD):
    _BIT_OF[((0x03F79D71B4CB0A89 << _bit) & 0xFFFFFFFFFFFFFFFF) >> 58] = _bit


class WordTrees(NamedTuple):
    """Trees as they are asked: every node before those below it, the left ones first.

    ``questions`` (m,) int32: the place of a node's threshold among all, −1 at a leaf; ``values``
    (m,): of leaves; ``rights`` (m,) int32: the node where the answer is "more", the other one is
    the next; ``ends`` (m,) int32: the first node that isn't below; ``roots`` (t + 1,) int32;
    ``firsts`` (f + 1,) int32: the first threshold of each feature; ``thresholds`` (q,) rising for
    each feature.
    """

    questions: NDArray[np.int32]
    values: Floats
    rights: NDArray[np.int32]
    ends: NDArray[np.int32]
    roots: NDArray[np.int32]
    firsts: NDArray[np.int32]
    thresholds: Floats


def class_shares(model: Forest, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float32]:
    """(n, k) how likely each class is for rows of features, (n, f)."""
    shares = np.empty((rows.shape[0], model.codes.size), np.float32)
    rows = np.ascontiguousarray(rows)
    trees = word_trees(model.trees, rows.shape[1])

    def weigh(start: int, stop: int) -> None:
        shares_kernel(trees, model.class_of, model.bases, rows[start:stop], shares[start:stop])

    share_out(weigh, rows.shape[0], _ROWS_AT_ONCE, monitor)
    return shares


def word_trees(trees: Trees, columns: int) -> WordTrees:
    """Trees that ask about so many columns, in the order in which words are divided."""
    inner = trees.features >= 0
    asked = np.column_stack([trees.features[inner].astype(np.float64), trees.thresholds[inner]])
    different, which = np.unique(asked, axis=0, return_inverse=True)
    questions = np.full(trees.features.size, -1, np.int32)
    questions[inner] = np.ravel(which)
    firsts = np.searchsorted(different[:, 0], np.arange(columns + 1)).astype(np.int32)
    count = trees.features.size
    order, rights, ends = (np.empty(count, np.int32) for _ in range(3))
    roots = np.empty(trees.roots.size + 1, np.int32)
    used = order_kernel(trees, order, rights, ends, roots)
    order = order[:used]
    return WordTrees(
        questions[order],
        trees.thresholds[order],
        rights[:used],
        ends[:used],
        roots,
        firsts,
        np.ascontiguousarray(different[:, 1]),
    )


@kernel
def order_kernel(
    trees: Trees,
    order: NDArray[np.int32],
    rights: NDArray[np.int32],
    ends: NDArray[np.int32],
    roots: NDArray[np.int32],
) -> int:
    """Number the nodes of trees, each before those below it; how many there are."""
    waiting = np.empty(order.size + 1, np.int64)
    above = np.empty(order.size + 1, np.int64)
    used = 0
    for tree in range(trees.roots.size):
        roots[tree] = used
        waiting[0], above[0], left = trees.roots[tree], -1, 1
        while left > 0:
            left -= 1
            node = waiting[left]
            if above[left] >= 0:
                rights[above[left]] = used
            order[used], rights[used] = node, -1
            if trees.features[node] >= 0:
                waiting[left], above[left] = trees.rights[node], used
                waiting[left + 1], above[left + 1] = trees.lefts[node], -1
                left += 2
            used += 1
    roots[trees.roots.size] = used
    for number in range(used - 1, -1, -1):
        ends[number] = ends[rights[number]] if rights[number] >= 0 else number + 1
    return used


@kernel
def shares_kernel(
    trees: WordTrees,
    class_of: NDArray[np.int32],
    bases: Floats,
    rows: NDArray[np.float32],
    shares: NDArray[np.float32],
) -> None:
    """Shares of the classes for some rows; NaN goes right."""
    more = np.empty(trees.thresholds.size, np.uint64)
    reaching = np.zeros(trees.questions.size, np.uint64)
    totals = np.empty((bases.size, _WORD))
    for start in range(0, rows.shape[0], _WORD):
        count = min(_WORD, rows.shape[0] - start)
        _answers(trees, rows, start, count, more)
        for which in range(bases.size):
            totals[which] = bases[which]
        _divide(trees, class_of, more, count, reaching, totals)
        for row in range(count):
            most = totals[:, row].max()
            total = 0.0
            for which in range(bases.size):
                totals[which, row] = np.exp(totals[which, row] - most)
                total += totals[which, row]
            for which in range(bases.size):
                shares[start + row, which] = totals[which, row] / total


@kernel
def _answers(
    trees: WordTrees,
    rows: NDArray[np.float32],
    start: int,
    count: int,
    more: NDArray[np.uint64],
) -> None:
    """For each threshold the rows that don't stay at or below it, a bit each."""
    values = np.zeros(_WORD)
    passed = np.empty(_WORD, np.int32)
    ending = np.zeros(trees.thresholds.size + 1, np.uint64)
    for feature in range(trees.firsts.size - 1):
        first, stop = trees.firsts[feature], trees.firsts[feature + 1]
        if first == stop:
            continue
        for row in range(count):
            values[row] = rows[start + row, feature]
        passed[:] = 0
        for question in range(first, stop):
            threshold = trees.thresholds[question]
            for row in range(_WORD):
                passed[row] += not values[row] <= threshold
        for row in range(count):
            ending[passed[row]] |= _ONE << np.uint64(row)
        word = ending[stop - first]
        ending[stop - first] = _NONE
        for question in range(stop - 1, first - 1, -1):
            more[question] = word
            word |= ending[question - first]
            ending[question - first] = _NONE


@kernel
def _divide(
    trees: WordTrees,
    class_of: NDArray[np.int32],
    more: NDArray[np.uint64],
    count: int,
    reaching: NDArray[np.uint64],
    totals: Floats,
) -> None:
    """Add what the trees, one after the other, say of the rows of a word: ``totals`` (k, 64)."""
    everything = ~_NONE if count == _WORD else (_ONE << np.uint64(count)) - _ONE
    for tree in range(trees.roots.size - 1):
        node, stop = trees.roots[tree], trees.roots[tree + 1]
        sums = totals[class_of[tree]]
        reaching[node] = everything
        while node < stop:
            word = reaching[node]
            if word == _NONE:
                node = trees.ends[node]
                continue
            question = trees.questions[node]
            if question >= 0:
                reaching[node + 1] = word & ~more[question]
                reaching[trees.rights[node]] = word & more[question]
            else:
                value = trees.values[node]
                while word != _NONE:
                    lowest = word & (~word + _ONE)
                    sums[_BIT_OF[(lowest * _DE_BRUIJN) >> _TOP]] += value
                    word ^= lowest
            node += 1


def warm_up() -> None:
    """Compile the kernels."""
    none = np.zeros(1, np.int32)
    leaf = Trees(none - 1, np.zeros(1), none, none, none, 0.0)
    shares = np.empty((1, 1), np.float32)
    rows = np.zeros((1, 1), np.float32)
    shares_kernel(word_trees(leaf, 1), none, np.zeros(1), rows, shares)
