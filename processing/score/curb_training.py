"""``python -m processing.score.curb_training``: what tells curbs apart, learnt from known streets.

Simulates streets of ``--seeds``, finds lines on them without leaving any out, and fits
`processing.road.curbs.curb_confidence.WEIGHTS` to which of them are curbs; streets of ``--check``
are not learnt from. ``--deliveries`` are further streets to learn from, recorded before. Prints the
weights and how many lines of each confidence are right: of streets learnt from by weights that were
fitted without the street itself.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from processing.formats.mapped_shapes import read_mapped
from processing.monitor import SilentMonitor
from processing.road.curbs.curb_confidence import CurbFacts, terms_of
from processing.road.curbs.curb_doubts import step_runs
from processing.score.curb_lines import FOUND_SHARE, TOLERANCE_M
from processing.score.curb_sections import kind_of
from processing.score.filter_tables import markdown_table
from processing.score.line_places import Lines, length_m, middle_places
from processing.score.mapped_features import MappedFile
from processing.score.road_scenes import RoadScene, given_scenes, simulated_scenes
from processing.tools.curbs import CurbParameters, measured_curbs, step_settings

_Floats = NDArray[np.float64]

# What reasoning expects before anything is learnt, and how far it may be off: tens of streets have
# few false lines of each kind. No weight may change its sign.
_EXPECTED = CurbFacts(1.0, -25.0, -8.0, -1.0, -20.0, -8.0, -2.0, -1.0)
_OFF = CurbFacts(0.3, 10.0, 5.0, 0.7, 8.0, 4.0, 1.0, 0.7)
_CONSTANT, _CONSTANT_OFF = 2.5, 2.0
_SHORTEST_M, _LONGEST_M, _PLACES_M = 0.75, 10.0, 0.1
_BOUNDS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)


@dataclass(frozen=True)
class KnownLines:
    """Lines of which it is known whether they are curbs.

    Attributes
    ----------
    terms : (n, 8) float64
        Facts as the weights take them.
    is_curb : (n,) bool
    lengths_m : (n,) float64
    street : (n,) int64
        Which street each is from.
    """

    terms: _Floats
    is_curb: NDArray[np.bool_]
    lengths_m: _Floats
    street: NDArray[np.int64]

    def of(self, chosen: NDArray[np.bool_]) -> KnownLines:
        """Some of them."""
        return KnownLines(
            self.terms[chosen], self.is_curb[chosen], self.lengths_m[chosen], self.street[chosen]
        )


def known_lines(scenes: Iterator[RoadScene]) -> KnownLines:
    """All lines on some streets; rear edges of kerb stones, which count neither way, left out."""
    rows: list[tuple[CurbFacts, bool, float, int]] = []
    for number, scene in enumerate(scenes):
        rows += [(*one, number) for one in _judged(scene, read_mapped(scene.truth("curbs")))]
        sys.stderr.write(f"{scene.name}: {len(rows)} lines\n")
    return KnownLines(
        np.array([row[0] for row in rows], np.float64).reshape(-1, len(_EXPECTED)),
        np.array([row[1] for row in rows], np.bool_),
        np.array([row[2] for row in rows], np.float64),
        np.array([row[3] for row in rows], np.int64),
    )


def _judged(scene: RoadScene, truth: MappedFile) -> Iterator[tuple[CurbFacts, bool, float]]:
    lower = [one for one in truth.features if one.facts.get("edge") == "lower"]
    fronts = Lines([one.xyz for one in lower if kind_of(one) != "back"])
    rears = Lines([one.xyz for one in truth.features if kind_of(one) == "back"])
    parameters = CurbParameters()
    settings, monitor = step_settings(parameters), SilentMonitor()
    runs = [
        run
        for number, drive in enumerate(scene.drives)
        for run in step_runs(drive, number, settings, monitor)
    ]
    for one in measured_curbs(scene.drives, runs, parameters, monitor):
        long_m = length_m(one.line.lower)
        if long_m < _SHORTEST_M:
            continue
        at = middle_places(one.line.lower, _PLACES_M)
        shares = [
            float((lines.nearest(at, TOLERANCE_M).line >= 0).mean()) for lines in (fronts, rears)
        ]
        if shares[0] >= FOUND_SHARE or shares[1] < FOUND_SHARE:
            yield terms_of(one.facts), shares[0] >= FOUND_SHARE, long_m


def fitted(known: KnownLines) -> _Floats:
    """(9,) constant and weights: the most likely ones after what was expected and what was seen.

    References
    ----------
    Hosmer, Lemeshow: Applied Logistic Regression; Gelman et al. 2008 (weakly informative priors).
    """
    expected = np.array([_CONSTANT, *_EXPECTED])
    off = np.array([_CONSTANT_OFF, *_OFF])
    terms = np.column_stack([np.ones(known.is_curb.size), known.terms])
    # Long lines have more to say, though not so many times more.
    worth = np.sqrt(np.clip(known.lengths_m, 1.0, _LONGEST_M))
    worth /= worth.mean() if worth.size else 1.0

    def doubt(weights: _Floats) -> tuple[float, _Floats]:
        logits, away = terms @ weights, (weights - expected) / off
        loss = worth * (np.logaddexp(0.0, logits) - known.is_curb * logits)
        slope = terms.T @ (worth * (_chance(logits) - known.is_curb))
        return float(loss.sum() + 0.5 * (away**2).sum()), slope + away / off

    bounds = [(None, None), *((0.0, None) if one > 0 else (None, 0.0) for one in _EXPECTED)]
    found = minimize(doubt, expected, jac=True, method="L-BFGS-B", bounds=bounds)
    return np.asarray(found.x, np.float64)


def chances(known: KnownLines, weights: _Floats) -> _Floats:
    """(n,) by some weights."""
    return _chance(weights[0] + known.terms @ weights[1:])


def left_out(known: KnownLines) -> _Floats:
    """(n,) each street's by weights that were fitted without it."""
    result = np.zeros(known.is_curb.size)
    for street in np.unique(known.street):
        is_here = known.street == street
        result[is_here] = chances(known.of(is_here), fitted(known.of(~is_here)))
    return result


def reliability(known: KnownLines, chance: _Floats) -> str:
    """A table: lines, right ones and metres by confidence."""
    rows = []
    for low, high in itertools.pairwise(_BOUNDS):
        chosen = (chance >= low) & ((chance < high) | (high == _BOUNDS[-1]))
        count, right = int(chosen.sum()), int(known.is_curb[chosen].sum())
        metres = known.lengths_m[chosen]
        share = f"{100 * right / count:.0f} %" if count else "–"
        right_m = metres[known.is_curb[chosen]].sum()
        rows.append(
            [
                f"{low:.1f}–{high:.1f}",
                str(count),
                str(right),
                share,
                f"{right_m:.0f}",
                f"{metres.sum():.0f}",
            ]
        )
    head = ["confidence", "lines", "right", "share", "right, m", "of, m"]
    return markdown_table([head, *rows])


def _chance(logits: _Floats) -> _Floats:
    result: _Floats = 1.0 / (1.0 + np.exp(-np.clip(logits, -50.0, 50.0)))
    return result


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m processing.score.curb_training")
    parser.add_argument("--seeds", default="500-529", help="streets to learn from")
    parser.add_argument("--check", default="530-539", help="streets to check with")
    parser.add_argument("--length", type=float, default=60.0, help="m of each")
    parser.add_argument("--deliveries", type=Path, nargs="*", default=[])
    asked = parser.parse_args(arguments)
    learnt = simulated_scenes(_seeds(asked.seeds), asked.length)
    known = known_lines(itertools.chain(learnt, given_scenes(asked.deliveries)))
    weights = fitted(known)
    sys.stdout.write(f"constant {weights[0]:.2f}\n")
    for name, weight in zip(CurbFacts._fields, weights[1:], strict=True):
        sys.stdout.write(f"{name} {weight:.2f}\n")
    sys.stdout.write(f"\n{reliability(known, left_out(known))}\n")
    check = known_lines(simulated_scenes(_seeds(asked.check), asked.length))
    sys.stdout.write(f"\n{reliability(check, chances(check, weights))}\n")
    return 0


def _seeds(text: str) -> range:
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


if __name__ == "__main__":
    sys.exit(main())
