"""Boosted decision trees as plain arrays, asked about many rows at once.

Sixty-four rows are asked at a time. Which of them answer a question with "more" is one word, a bit
a row; trees have few different questions, since features were put into bins when they grew. A node
then divides the word of the rows that reach it, and rows that lie side by side mostly go the same
way, so that most of a tree's nodes are never seen. Sums are added tree by tree: they are the same
to the last bit as of a walk row by row, in less than half of the time.

Kernels of its own, for onnxruntime 1.31 is no faster: on the rows that the sample street asks
about (60,223 of 19, 22,007 of 73 and 7,709 of 90 features; two cores) it took 0.083, 0.125 and
0.062 s, a walk row by row 0.097, 0.167 and 0.031 s, as it skips the trees that no longer matter.
It would add 68 MB to what is installed, and answers in float32.

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

_HOPELESS = -4.0
"""Log-odds (2 % likely) after a third of the trees from which the others aren't asked: they change
little that matters then. By trial."""

_ROWS_AT_ONCE = 16_384
"""Rows of a share of a core's work."""

_WORD = 64
"""Rows that are asked together: the bits of a word."""

_NONE, _ONE = np.uint64(0), np.uint64(1)
_DE_BRUIJN, _TOP = np.uint64(0x03F79D71B4CB0A89), np.uint64(58)
"""Times a power of two, its six highest bits tell which."""

_BIT_OF = np.zeros(_WORD, np.int64)
for _bit in range(_WORD):
    _BIT_OF[((0x03F79D71B4CB0A89 << _bit) & 0xFFFFFFFFFFFFFFFF) >> 58] = _bit


class Trees(NamedTuple):
    """A sum of trees that gives the log-odds of a claim.

    ``features`` (m,) int32: the column asked at each node, −1 at a leaf; ``thresholds`` (m,):
    at most this goes left, at a leaf the value; ``lefts``, ``rights`` (m,) int32: next nodes;
    ``roots`` (t,) int32; ``base``: log-odds before any tree.
    """

    features: NDArray[np.int32]
    thresholds: NDArray[np.float64]
    lefts: NDArray[np.int32]
    rights: NDArray[np.int32]
    roots: NDArray[np.int32]
    base: float


class WordTrees(NamedTuple):
    """Trees as they are asked: every node before those below it, the left ones first.

    ``questions`` (m,) int32: the place of a node's threshold among all, −1 at a leaf; ``values``
    (m,): of leaves; ``rights`` (m,) int32: the node where the answer is "more", the other one is
    the next; ``ends`` (m,) int32: the first node that isn't below; ``roots`` (t + 1,) int32;
    ``firsts`` (f + 1,) int32: the first threshold of each feature; ``thresholds`` (q,) float32
    rising for each feature: what a single number is at most that is at most the tree's.
    """

    questions: NDArray[np.int32]
    values: Floats
    rights: NDArray[np.int32]
    ends: NDArray[np.int32]
    roots: NDArray[np.int32]
    firsts: NDArray[np.int32]
    thresholds: NDArray[np.float32]


def log_odds(trees: Trees, rows: NDArray[np.float32], monitor: Monitor) -> NDArray[np.float64]:
    """(n,) log-odds of the claim for rows of features, (n, f).

    A row that the first third of the trees finds hopeless isn't shown to the others.
    """
    found = np.full((rows.shape[0], 1), trees.base)
    rows = np.ascontiguousarray(rows)
    words = word_trees(trees, rows.shape[1])
    alike, third = np.zeros(trees.roots.size, np.int32), trees.roots.size // 3

    def weigh(start: int, stop: int) -> None:
        sums_kernel(words, alike, third, rows[start:stop], found[start:stop])

    share_out(weigh, found.size, _ROWS_AT_ONCE, monitor)
    return found[:, 0]


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
        rounded_down(different[:, 1]),
    )


def rounded_down(thresholds: Floats) -> NDArray[np.float32]:
    """The largest single numbers that are at most some double ones."""
    with np.errstate(over="ignore"):
        nearest = thresholds.astype(np.float32)
    below = np.nextafter(nearest, np.float32(-np.inf))
    return np.where(nearest > thresholds, below, nearest)


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
def sums_kernel(
    trees: WordTrees,
    class_of: NDArray[np.int32],
    pause: int,
    rows: NDArray[np.float32],
    sums: Floats,
) -> None:
    """Add what trees say of some rows to their sums; NaN goes right.

    Parameters
    ----------
    class_of : (t,) int32
        The sum that each tree adds to.
    pause : int
        Trees after which rows are asked no more that have a hopeless first sum.
    sums : (n, k) float64
    """
    more = np.empty(trees.thresholds.size, np.uint64)
    reaching = np.zeros(trees.questions.size, np.uint64)
    totals = np.empty((sums.shape[1], _WORD))
    last = trees.roots.size - 1
    for start in range(0, rows.shape[0], _WORD):
        count = min(_WORD, rows.shape[0] - start)
        for row in range(count):
            for which in range(sums.shape[1]):
                totals[which, row] = sums[start + row, which]
        _answers(trees, rows, start, count, more)
        asked = ~_NONE if count == _WORD else (_ONE << np.uint64(count)) - _ONE
        _divide(trees, (0, pause), class_of, more, asked, reaching, totals)
        if pause < last:
            asked = _NONE
            for row in range(count):
                if not totals[0, row] < _HOPELESS:
                    asked |= _ONE << np.uint64(row)
            _divide(trees, (pause, last), class_of, more, asked, reaching, totals)
        for row in range(count):
            for which in range(sums.shape[1]):
                sums[start + row, which] = totals[which, row]


@kernel
def _answers(
    trees: WordTrees,
    rows: NDArray[np.float32],
    start: int,
    count: int,
    more: NDArray[np.uint64],
) -> None:
    """For each threshold the rows that don't stay at or below it, a bit each."""
    values = np.zeros(_WORD, np.float32)
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
    some: tuple[int, int],
    class_of: NDArray[np.int32],
    more: NDArray[np.uint64],
    asked: np.uint64,
    reaching: NDArray[np.uint64],
    totals: Floats,
) -> None:
    """Add what some trees, one after the other, say of rows of a word: ``totals`` (k, 64)."""
    for tree in range(some[0], some[1]):
        node, stop = trees.roots[tree], trees.roots[tree + 1]
        sums = totals[class_of[tree]]
        reaching[node] = asked
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
    rows = np.zeros((1, 1), np.float32)
    sums_kernel(word_trees(leaf, 1), none, 1, rows, np.zeros((1, 1)))
