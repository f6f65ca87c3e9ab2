"""What trees scored, as Markdown tables, with the thesis' figures beside them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.road.road_tables import ALL, percent
from processing.laboratory.accuracy.road.tree_scenes import ScoredTrees
from processing.scoring.features.mapped_features import MappedFeature
from processing.scoring.features.object_matches import ObjectMatch, shows_enough
from processing.scoring.features.trees import LEAST_ARC_DEG
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

MOST_CM = 4.0
"""Asked for: no diameter is farther off."""


@dataclass(frozen=True)
class MeasuredTrunk:
    """A trunk whose diameter is known, measured in several ways.

    Attributes
    ----------
    group : str
        By which scanner.
    true_m : float
    is_staked, is_multiple : bool
    by_way : mapping of str to float
        Diameters, m; NaN: not measured.
    by_head : tuple of float
        Each drive alone, those that measured it.
    """

    group: str
    true_m: float
    is_staked: bool
    is_multiple: bool
    by_way: Mapping[str, float]
    by_head: tuple[float, ...]


def streets_table(streets: Sequence[ScoredTrees]) -> str:
    """Streets, sums by scanner, and the sum of all."""
    rows = [
        ["street", "found, false, missed", "P", "R", "**F**", "diameter RMS, greatest (cm)",
         "staked", "within", "foot RMS (cm)", "height RMS (m)", "crown RMS (m)"],
    ]  # fmt: skip
    rows += [_row(one.scene.name, [one]) for one in streets]
    groups = sorted({one.scene.group for one in streets})
    if len(groups) > 1:
        rows += [
            _row(f"*{group}*", [one for one in streets if one.scene.group == group])
            for group in groups
        ]
    rows.append(_row(ALL, streets))
    rows += [
        ["thesis, one head", "97, 0, 5", "100.0 %", "95.1 %", "97.5 %", "2.6, 9.9",
         *["–"] * 5],
        ["to reach", "", "", "", "99 %", "1.2, 4.0", "1.2, 4.0", "95 %", "", "", ""],
    ]  # fmt: skip
    return markdown_table(rows)


def kinds_table(streets: Sequence[ScoredTrees]) -> str:
    """Trees by species or, of deliveries, by what is special about them, and by their leaves."""
    rows = [["trees", "found, missed", "R", "diameter RMS, greatest (cm)", "within"]]
    for group_of in (_species_of, _leaves_of):
        groups = sorted({group_of(tree) for one in streets for tree in _asked(one)} - {""})
        for group in groups:
            asked = [t for one in streets for t in _asked(one) if group_of(t) == group]
            pairs = [
                (one, match)
                for one in streets
                for match in one.matches.partners
                if group_of(match.truth) == group
            ]
            counts = BinaryConfusionMatrix(len(pairs), 0, len(asked) - len(pairs), 0)
            seen = _seen(pairs)
            rows.append(
                [
                    group,
                    f"{counts.hits}, {counts.misses}",
                    percent(counts.recall),
                    _errors(100 * _offs(seen, "dbh_m")),
                    _within(seen),
                ]
            )
    return markdown_table(rows)


def _asked(street: ScoredTrees) -> list[MappedFeature]:
    """Trees that points show, and those that were found all the same."""
    return [*(match.truth for match in street.matches.partners), *street.missed()]


def _species_of(tree: MappedFeature) -> str:
    return str(tree.facts.get("growth") or tree.facts.get("variant") or "")


def _leaves_of(tree: MappedFeature) -> str:
    share = tree.facts.get("leaf_share")
    if not isinstance(share, float | int):
        return ""
    return "*bare*" if share == 0 else "*in leaf*" if share == 1 else "*few leaves*"


def _row(name: str, streets: Sequence[ScoredTrees]) -> list[str]:
    counts = sum((one.matches.counts for one in streets), BinaryConfusionMatrix(0, 0, 0, 0))
    pairs = [(one, match) for one in streets for match in one.matches.partners]
    seen = _seen(pairs)
    staked = [(one, match) for one, match in seen if one.true(match, "stakes") > 0]
    feet = [float(np.hypot(*(match.result.xyz[0] - match.truth.xyz[0])[:2])) for _, match in pairs]
    return [
        name,
        f"{counts.hits}, {counts.false_alarms}, {counts.misses}",
        *(percent(one) for one in (counts.precision, counts.recall, counts.f_measure)),
        _errors(100 * _offs(seen, "dbh_m")),
        _errors(100 * _offs(staked, "dbh_m")),
        _within(seen),
        _rms(100 * np.array(feet)),
        _rms(_offs(pairs, "height_m")),
        _rms(_offs(pairs, "crown_m")),
    ]


def _seen(
    pairs: Sequence[tuple[ScoredTrees, ObjectMatch]],
) -> list[tuple[ScoredTrees, ObjectMatch]]:
    """Those whose diameter can be asked for."""
    return [
        (one, match)
        for one, match in pairs
        if shows_enough(one.scene.truth, match.truth, "arc_deg", LEAST_ARC_DEG)
    ]


def _within(seen: Sequence[tuple[ScoredTrees, ObjectMatch]]) -> str:
    """How many errors are no greater than was told."""
    within = [
        abs(_off(one, match, "dbh_m")) <= one.number(match, "dbh_within_m") for one, match in seen
    ]
    return percent(float(np.mean(within))) if within else "–"


def _offs(pairs: Sequence[tuple[ScoredTrees, ObjectMatch]], name: str) -> Floats:
    return np.array([_off(one, match, name) for one, match in pairs], np.float64)


def _off(street: ScoredTrees, match: ObjectMatch, name: str) -> float:
    return street.number(match, name) - street.true(match, name)


def _errors(off: Floats) -> str:
    """RMS and the greatest: “1.2, 3.4”."""
    return f"{_rms(off)}, {np.abs(off).max():.1f}" if off.size else "–"


def _rms(off: Floats) -> str:
    return f"{math.sqrt(float(np.mean(off**2))):.1f}" if off.size else "–"


def ways_table(trunks: Sequence[MeasuredTrunk]) -> str:
    """Each way: of how many trunks it gives a diameter, and how far that is off."""
    rows = [["way", "measured", "RMS, greatest (cm)", "off by more than 4 cm", "median (cm)"]]
    for way in trunks[0].by_way if trunks else ():
        off = 100 * np.array([one.by_way[way] - one.true_m for one in trunks])
        off = off[~np.isnan(off)]
        far = int(np.count_nonzero(np.abs(off) > MOST_CM))
        median = f"{np.median(off):+.1f}" if off.size else "–"
        rows.append([way, f"{off.size} of {len(trunks)}", _errors(off), f"{far}", median])
    return markdown_table(rows)


def heads_table(trunks: Sequence[MeasuredTrunk]) -> str:
    """Heads and passes alone against all together, of trunks that several measured."""
    rows = [["trunks that two drives and more measured", "RMS, greatest (cm)"]]
    several = [one for one in trunks if len(one.by_head) > 1]
    alone = [100 * (each - one.true_m) for one in several for each in one.by_head]
    apart = [100 * (one.by_head[0] - one.by_head[1]) for one in several]
    together = [100 * (one.by_way["this program"] - one.true_m) for one in several]
    for name, off in (("each alone", alone), ("all together", together), ("two apart", apart)):
        known = np.array(off, np.float64)
        rows.append([f"{name}, {len(several)} trunks", _errors(known[~np.isnan(known)])])
    return markdown_table(rows)


def real_table(trees: Mapping[str, Mapping[str, float]]) -> str:
    """Diameters of trees of which no truth is known."""
    ways = list(next(iter(trees.values())))
    rows = [["tree", *(f"{way} (cm)" for way in ways)]]
    for name, told in trees.items():
        cells = ("–" if math.isnan(told[way]) else f"{100 * told[way]:.1f}" for way in ways)
        rows.append([name, *cells])
    return markdown_table(rows)


def failures_of(streets: Sequence[ScoredTrees]) -> str:
    """Each failure, a line."""
    lines: list[str] = []
    for one in streets:
        truth = one.scene.truth
        for tree in one.missed():
            told = (
                f"{truth.number(tree, 'stems'):.0f} stems, "
                f"{100 * truth.number(tree, 'dbh_m'):.0f} cm thick, "
                f"{truth.number(tree, 'height_m'):.1f} m high, "
                f"{truth.number(tree, 'trunk_points'):.0f} points on the trunk, "
                f"{truth.number(tree, 'stakes'):.0f} stakes"
            )
            lines.append(f"- {one.scene.name}: not found: {told}.")
        for found in one.matches.alone:
            told = (
                f"{100 * one.likely.number(found, 'dbh_m'):.0f} cm thick, "
                f"{one.likely.number(found, 'height_m'):.1f} m high, "
                f"confidence {one.likely.number(found, 'confidence'):.2f}"
            )
            lines.append(f"- {one.scene.name}: no tree: {told}.")
        for match in one.matches.partners:
            off = _off(one, match, "dbh_m")
            if abs(off) > MOST_CM / 100:
                lines.append(
                    f"- {one.scene.name}: diameter off by {100 * off:+.1f} cm: "
                    f"{100 * one.true(match, 'dbh_m'):.0f} cm thick, "
                    f"{one.true(match, 'stems'):.0f} stems, {one.true(match, 'stakes'):.0f} stakes."
                )
    return "\n".join([*lines, ""]) if lines else "None.\n"
