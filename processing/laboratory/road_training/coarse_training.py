"""What tells trunks and poles on sparse recordings, learnt from simulated ones.

``python -m processing.laboratory.road_training.coarse_training``.

Needs the extra ``train``. Streets of ``--profiles`` are driven along with sparse profile scanners,
on those of ``--scans`` single turns of spinning heads are made; of both, columns are found and the
models of `processing.methods.road.coarse` fitted to which of them are trunks and poles. Prints how
many of each confidence are right, each street by models that were fitted without some streets, it
among them; then the same of ``--check-profiles`` and ``--check-scans``, which nothing is learnt
from. The same seeds give the same models.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.real_street_things import foot_of
from processing.laboratory.noise_training.fitting import TreesSize
from processing.laboratory.progress_lines import say
from processing.laboratory.road_training.boosted_confidence import learn_model
from processing.laboratory.road_training.coarse_recordings import (
    CoarseRecording,
    profile_recordings,
    scan_recordings,
)
from processing.laboratory.road_training.learned_confidence import LabelledThings
from processing.laboratory.seed_ranges import seeds_of
from processing.methods.road.coarse.coarse_uprights import (
    MODELS,
    POLE,
    TREE,
    known_columns,
    model_name,
    summed_columns,
)
from processing.methods.road.coarse.column_facts import ColumnFacts
from processing.recording.density import are_sparse

_SIZE = TreesSize(trees=150, leaves=12, rate=0.05)

_OTHER, _NEITHER_WAY = 0, -1
_CODES = {TREE: 1, POLE: 2}

_POLE_LIKE = 66
_FEWEST, _LEAST_HIGH_M = 20, 1.0
"""Points of a trunk or pole that is asked for, and how high they stand."""

_ON_M, _NEAR_M = 0.5, 0.8
"""How near to a thing's foot a column is its own, the one with the most points; and how near others
count neither way."""

_NEARER = 2.0
"""Powers of ten in points that a metre nearer outweighs."""


@dataclass(frozen=True)
class KnownColumns:
    """Columns of recordings of one kind.

    Attributes
    ----------
    facts : (n, f) float32
    codes : (n,) int64
        What each is.
    street : (n,) int64
        Which of the streets each is from.
    """

    facts: NDArray[np.float32]
    codes: Integers
    street: Integers

    def chosen(self, which: NDArray[np.bool_]) -> KnownColumns:
        """Some of them."""
        return KnownColumns(self.facts[which], self.codes[which], self.street[which])


def known_columns_of(recordings: Iterator[CoarseRecording]) -> KnownColumns:
    """All columns of some recordings that are sparse, but those that count neither way."""
    facts: list[ColumnFacts] = []
    codes: list[int] = []
    streets: list[int] = []
    numbers: dict[str, int] = {}
    for recording in recordings:
        street = numbers.setdefault(recording.name.partition(".")[0], len(numbers))
        for told, code in _judged(recording):
            facts.append(told)
            codes.append(code)
            streets.append(street)
        say(f"{recording.name}: {len(codes):,} columns")
    rows = np.array(facts, np.float32).reshape(-1, len(ColumnFacts._fields))
    return KnownColumns(rows, np.array(codes, np.int64), np.array(streets, np.int64))


def _judged(recording: CoarseRecording) -> list[tuple[ColumnFacts, int]]:
    with TemporaryDirectory(prefix="zuka-") as position:
        drive = recording.drive(Path(position))
        if not are_sparse([drive]):
            return []
        plan, _, sums = summed_columns([drive], SilentMonitor())
    told = known_columns(sums, SilentMonitor())
    places = sums.axes.base[[number for number, _ in told]] + plan.origin[:2]
    codes = label_columns(places, [one.points for _, one in told], recording)
    return [
        (facts, int(code))
        for (_, facts), code in zip(told, codes, strict=True)
        if code != _NEITHER_WAY
    ]


def label_columns(places: Floats, points: Sequence[float], recording: CoarseRecording) -> Integers:
    """(n,) what columns are.

    Parameters
    ----------
    places : (n, 2) float64
        m.
    points : sequence of float
        Decimal logarithm of those on each axis.
    """
    codes = np.full(len(places), _OTHER, np.int64)
    is_upright = recording.label == _POLE_LIKE
    own: list[tuple[Floats, int]] = []
    for instance in np.unique(recording.instance[is_upright]).tolist():
        thing = recording.xyz[is_upright & (recording.instance == instance)]
        middle = foot_of(thing)
        code = _CODES.get(recording.kinds.get(instance, ""), _OTHER)
        if len(thing) < _FEWEST or np.ptp(thing[:, 2]) < _LEAST_HIGH_M:
            code = _OTHER
        codes[np.hypot(*(places - middle).T) < _NEAR_M] = _NEITHER_WAY
        if code != _OTHER:
            own.append((middle, code))
    for middle, code in own:
        away = np.hypot(*(places - middle).T)
        near = np.flatnonzero(away < _ON_M)
        if near.size:
            worth = np.array(points)[near] - _NEARER * away[near]
            codes[near[int(worth.argmax())]] = code
    return codes


def _things_of(known: KnownColumns, kind: str) -> LabelledThings:
    """The columns with whether each is of a kind."""
    is_right = known.codes == _CODES[kind]
    facts, worth = known.facts.astype(np.float64), np.ones(is_right.size)
    return LabelledThings(facts, is_right, worth, known.street)


def make_models(known: KnownColumns, check: KnownColumns, *, is_scan: bool) -> str:
    """Fit and write the models of one kind of recordings; how reliable they are."""
    lines: list[str] = []
    for kind in _CODES:
        name = model_name(kind, is_scan=is_scan)
        things, others = _things_of(known, kind), _things_of(check, kind)
        lines += [name, learn_model(f"{MODELS}/{name}", things, others, _SIZE)]
    return "\n\n".join(lines) + "\n"


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(
        prog="python -m processing.laboratory.road_training.coarse_training"
    )
    parser.add_argument("--profiles", default="9001-9120", help="streets of profiles")
    parser.add_argument("--scans", default="9101-9149", help="streets of single scans")
    parser.add_argument("--check-profiles", default="9131-9142", help="others to check with")
    parser.add_argument("--check-scans", default="9151-9156", help="others to check with")
    asked = parser.parse_args(arguments)
    for make, learnt, check, is_scan in (
        (profile_recordings, asked.profiles, asked.check_profiles, False),
        (scan_recordings, asked.scans, asked.check_scans, True),
    ):
        known = known_columns_of(make(seeds_of(learnt)))
        others = known_columns_of(make(seeds_of(check)))
        sys.stdout.write(make_models(known, others, is_scan=is_scan))
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
