"""Road signs against their truth: by given positions as the thesis does it, and without any.

``python -m processing.laboratory.accuracy.road.signs --markdown docs/accuracy.md`` simulates
streets of seeds that nobody looked at and runs the tool with its own parameters: once as it stands,
and once each with positions, with shapes, and with sizes besides. ``--samples FOLDER…`` adds
deliveries with ``truth/`` that the program's own simulator did not make.
"""

from __future__ import annotations

import argparse
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.safe_write import write_safely
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import replace_section
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    found_by,
    given_scenes,
    map_candidate,
    options_of,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.road_tables import (
    ALL,
    ScoredStreet,
    percent,
    reliability_table,
    sum_counts,
)
from processing.laboratory.simulate.requests import StreetRequest
from processing.scoring.features.file_scores import FileScore
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import match_objects
from processing.scoring.features.signs import (
    LEAST_FRONT_POINTS,
    POSITION_M,
    SIZE_SHARE,
    WITHIN_M,
    sign_score,
)
from processing.scoring.points.reliability import reliability_of_pairs
from processing.tools.signs import SignParameters, find_signs

_SEEDS = (*range(720, 726), *range(730, 736), *range(780, 786), *range(790, 800))
_FRESH_SEEDS = tuple(range(8231, 8243))
SEEDS = (*_SEEDS, *_FRESH_SEEDS)
LENGTH_M = 80.0
FARTHEST_M = 2.0
"""Errors of given positions, evenly over a disc."""

GIVEN = ("position", "and shape", "and size")
_SAME_SIDE_DEG = 90.0
"""Plates that are turned by more show their back for their face."""

_FAST_KM_H = (80.0, 100.0)
_LINES = (1, 3, 5, 8, 12, 20, 1_000_000)

_HEADING = "## Road signs"
_ABOUT = """`python -m processing.laboratory.accuracy.road.signs --markdown docs/accuracy.md`: \
streets of 80 m from which nothing was learnt, of which seeds 8231 to 8242 were not looked at \
before they were scored, once; expressways are driven at 80 and 100 km/h. Streets by name are \
deliveries of another simulator (`--samples`), from which nothing was learnt. A sign is asked for \
if ten points lie on its face; right is its place within 15 cm, its shape, and its size within a \
tenth. Supplementary plates are judged apart.
"""
_ABOUT_GIVEN = """Right in place, shape and size where rough positions are given, up to 2 m off \
in plan and half a metre in height, and their shapes, and their sizes:
"""
_ABOUT_LINES = "The same, positions alone being given, by the scan lines that met the plate:\n"
_ABOUT_FAILURES = "Signs that were missed or are wrong without positions, and false ones:\n"
_ABOUT_CONFIDENCE = "What confidence means:\n"


class SignScores:
    """What is known so far."""

    def __init__(self) -> None:
        self.streets: list[ScoredStreet] = []
        self.given: dict[str, list[tuple[int, int]]] = {name: [] for name in GIVEN}
        self.names: list[str] = []
        self.by_lines: dict[int, list[bool]] = defaultdict(list)
        self.failures: list[list[str]] = []
        self.judged: list[tuple[float, bool]] = []
        self.facing: list[tuple[int, int]] = []

    def add(self, scene: RoadScene) -> None:
        """Run the tool on a street in all ways, and score it."""
        truth = read_mapped(scene.truth("signs"))
        result = found_by("signs", scene.drives).result
        count = len(result.features)
        self.streets.append(ScoredStreet(scene.name, "", sign_score(result, truth), count))
        self.names.append(scene.name)
        self._add_failures(scene.name, result, truth)
        asked = [one for one in truth.features if is_asked(one)]
        for number, name in enumerate(GIVEN):
            placed = _placed(scene, asked, number)
            right = [is_right(placed, one) for one in asked]
            self.given[name].append((sum(one is True for one in right), len(asked)))
            if number == 0:
                for sign, one in zip(asked, right, strict=True):
                    self.by_lines[_lines_on(placed, sign)].append(one)

    def _add_failures(self, name: str, result: MappedFile, truth: MappedFile) -> None:
        true = list(truth.features)
        found = match_objects(result.features, true, [True] * len(true), WITHIN_M, in_space=True)
        turned = [_turned(one.result, one.truth) for one in found.partners]
        self.facing.append((sum(one < _SAME_SIDE_DEG for one in turned), len(turned)))
        for pair in found.partners:
            self.judged.append((result.number(pair.result, "confidence"), True))
            if is_asked(pair.truth) and not _is_like(pair.result, pair.truth):
                self.failures.append([name, _words(pair.truth), _words(pair.result)])
        for one in found.alone:
            self.judged.append((result.number(one, "confidence"), False))
            self.failures.append([name, "nothing", _words(one)])
        hit = {id(pair.truth) for pair in found.partners}
        self.failures += [
            [name, _words(one), "missed"] for one in true if is_asked(one) and id(one) not in hit
        ]

    def section(self) -> str:
        """Of the page."""
        lack = markdown_table([["street", "true", "found"], *self.failures])
        return (
            f"{_HEADING}\n{_ABOUT}\n{_found_table(self.streets, self.facing)}\n{_ABOUT_GIVEN}\n"
            f"{_given_table(self.names, self.given)}\n{_ABOUT_LINES}\n"
            f"{_lines_table(self.by_lines)}\n{_ABOUT_CONFIDENCE}\n"
            f"{reliability_table({'signs': reliability_of_pairs(self.judged)})}\n"
            f"{_ABOUT_FAILURES}\n{lack}"
        )


def is_asked(sign: MappedFeature) -> bool:
    """Whether the points show a true sign's face, and it is no supplement."""
    facts = sign.facts
    seen = facts.get("front_points")
    return (
        facts.get("in_span") in (None, True)
        and facts.get("supplementary") not in (True,)
        and isinstance(seen, int | float)
        and seen >= LEAST_FRONT_POINTS
    )


def _placed(scene: RoadScene, asked: Sequence[MappedFeature], known: int) -> MappedFile:
    """What is found by positions that are off, with shapes and sizes if they are known."""
    random = np.random.default_rng(7)
    rows = ["easting_m,northing_m,height_m,shape,size_m"]
    for one in asked:
        turn, away = random.uniform(0, 2 * np.pi), FARTHEST_M * np.sqrt(random.uniform())
        x, y, z = one.xyz[0] + (away * np.cos(turn), away * np.sin(turn), random.uniform(-0.5, 0.5))
        shape = one.facts["shape"] if known > 0 else ""
        size = one.facts["size_m"] if known > 1 else ""
        rows.append(f"{x:.3f},{y:.3f},{z:.3f},{shape},{size}")
    with TemporaryDirectory(prefix="zuka-") as folder:
        table = Path(folder) / "positions.csv"
        table.write_text("\n".join(rows) + "\n", "utf-8")
        found = find_signs(scene.drives, SignParameters(positions=str(table)), SilentMonitor())
    features = [map_candidate(one, number) for number, one in enumerate(found.candidates, 1)]
    return MappedFile(Path("signs.geojson"), "", tuple(features))


def is_right(result: MappedFile, sign: MappedFeature) -> bool:
    """Whether a sign was found in its place with its shape and size."""
    return any(_is_like(one, sign) for one in result.features)


def _is_like(found: MappedFeature, sign: MappedFeature) -> bool:
    facts = sign.facts
    centres = np.array([sign.xyz[0], facts.get("bbox_centre", sign.xyz[0])], np.float64)
    off = np.linalg.norm(centres - found.xyz[0], axis=1).min()
    size, true = float(str(found.facts["size_m"])), float(str(facts["size_m"]))
    is_size = abs(size / true - 1) <= SIZE_SHARE
    return bool(off <= POSITION_M and found.facts["shape"] == facts["shape"] and is_size)


def _turned(found: MappedFeature, sign: MappedFeature) -> float:
    """By how many degrees a plate faces another way than it does in truth, 0 to 180."""
    first, second = (float(str(one.facts["facing_deg"])) for one in (found, sign))
    return abs((first - second + 180) % 360 - 180)


def _lines_on(result: MappedFile, sign: MappedFeature) -> int:
    """Scan lines on what was found nearest to a sign; 0: nothing."""
    near = [
        (float(np.linalg.norm(one.xyz[0] - sign.xyz[0])), one.facts["scan_lines"])
        for one in result.features
    ]
    best = min(near, default=(np.inf, 0))
    return int(str(best[1])) if best[0] <= WITHIN_M else 0


def _words(sign: MappedFeature) -> str:
    facts = sign.facts
    tag = f" ({facts['tag']})" if facts.get("tag") else ""
    seen = f", {facts['front_points']} points" if "front_points" in facts else ""
    return f"{facts['shape']} {100 * float(str(facts['size_m'])):.0f} cm{tag}{seen}"


def _found_table(streets: Sequence[ScoredStreet], facing: Sequence[tuple[int, int]]) -> str:
    rows = [
        ["street", "found, false, missed", "P", "R", "**F**", "place", "place, shape and size",
         "centre, RMS (cm)", "faces the right way", "facing, RMS (°)",
         "supplements: found, false, missed"],
    ]  # fmt: skip
    for one, (right, of) in zip(streets, facing, strict=True):
        score = one.score
        shares = [percent(score.share_of(name)) for name in ("place", "place_shape_size")]
        off = (
            f"{100 * score.errors_of('place').rms:.1f}",
            f"{right} of {of}",
            f"{score.errors_of('facing_deg').rms:.1f}",
        )
        rows.append([one.name, *_counts([one], "signs"), *shares, *off,
                     _counts([one], "supplementary")[0]])  # fmt: skip
    weights = [_asked_count(one.score) for one in streets]
    shares = [
        percent(sum(s.score.share_of(name) * w for s, w in zip(streets, weights, strict=True) if w)
                / max(1, sum(weights)))
        for name in ("place", "place_shape_size")
    ]  # fmt: skip
    right, of = np.sum(facing, axis=0).tolist()
    rows.append([ALL, *_counts(streets, "signs"), *shares, "", f"{right} of {of}", "",
                 _counts(streets, "supplementary")[0]])  # fmt: skip
    rows.append(["published", "–", "", "", "95.1 %", *["–"] * 6])
    rows.append(["to reach", "–", "", "", "97 %", *["–"] * 6])
    return markdown_table(rows)


def _asked_count(score: FileScore) -> int:
    counts = score.counts_of("signs")
    return counts.hits + counts.misses


def _counts(streets: Sequence[ScoredStreet], name: str) -> list[str]:
    counts = sum_counts(streets, name)
    found = f"{counts.hits}, {counts.false_alarms}, {counts.misses}"
    return [found, percent(counts.precision), percent(counts.recall), percent(counts.f_measure)]


def _given_table(names: Sequence[str], given: dict[str, list[tuple[int, int]]]) -> str:
    rows = [["street", "signs", *given]]
    for number, name in enumerate(names):
        counts = [of_street[number] for of_street in given.values()]
        rows.append([name, f"{counts[0][1]}", *(_share(*one) for one in counts)])
    sums = [np.sum(of, axis=0).tolist() for of in given.values()]
    rows.append([ALL, f"{sums[0][1]}", *(_share(*one) for one in sums)])
    rows.append(["thesis", "135", "84.4 %", "88.9 %", "96.3 %"])
    rows.append(["to reach", "", "97 %", "", ""])
    return markdown_table(rows)


def _share(right: int, of: int) -> str:
    return percent(right / of) if of else "–"


def _lines_table(by_lines: dict[int, list[bool]]) -> str:
    rows = [["scan lines", "right of all"], ["nothing found", f"0 of {len(by_lines.get(0, []))}"]]
    for low, high in pairwise(_LINES):
        inside = list(chain(*(of for lines, of in by_lines.items() if low <= lines < high)))
        name = f"{low} to {high - 1}" if high < _LINES[-1] else f"{low} and more"
        rows.append([name, f"{sum(inside)} of {len(inside)}"])
    return markdown_table(rows)


def fast_options_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The usual streets in turn, every third an expressway at 80 or 100 km/h without a stop."""
    options = options_of(number, seed, length_m)
    if number % 3 != 2:  # the last of three
        return options
    speed = _FAST_KM_H[number // 3 % 2]
    return replace(options, style="highway", speed_km_h=speed, stops=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--seeds", type=int, nargs="*", default=list(SEEDS))
    parser.add_argument("--length", type=float, default=LENGTH_M)
    options = parser.parse_args(arguments)
    scores = SignScores()
    for scene in _scenes(options):
        sys.stderr.write(f"{scene.name}: {scene.points:,} points\n")
        scores.add(scene)
    section = scores.section()
    if options.markdown is None:
        sys.stdout.write(f"{section}\n")
        return 0
    page = replace_section(options.markdown.read_text("utf-8"), _HEADING, section)
    with write_safely(options.markdown) as path:
        path.write_text(page, "utf-8")
    return 0


def _scenes(options: argparse.Namespace) -> Iterator[RoadScene]:
    yield from given_scenes(options.samples)
    yield from simulated_scenes(options.seeds, options.length, options_of_seed)


def options_of_seed(_number: int, seed: int, length_m: float) -> StreetRequest:
    """A street is the same whichever others are made with it."""
    return fast_options_of(seed % 10, seed, length_m)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
