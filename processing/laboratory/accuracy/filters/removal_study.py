"""The two experiments of the machine-removal study, on simulated scenes like its own, as tables.

``python -m processing.laboratory.accuracy.filters.removal_study --markdown docs/accuracy.md`` makes
the page's section; without ``--markdown`` it is written to standard output. Experiment I looks at
sections 1 m wide across a levee and across a cutting, with a grid of 5 m; experiment II at an
extent with two machines, of some 20,000 points, with grids of 1, 3 and 10 m.

References
----------
Sakurai et al., 地上設置型レーザスキャナを用いた出来高管理のための地表面抽出手法の検討, section 4.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_methods import FilterMethod, study_methods
from processing.laboratory.accuracy.filters.filter_scenes import FilterScene, sites
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.site import simulate_site
from processing.laboratory.simulate.sites.bodies import SiteKind

HEADING = "## Machines removed as in the study"
SEEDS = (971, 972)
"""Of the sites: nobody looked at them while the method was worked out."""

_STYLES = ("levee", "cutting")
_STATIONS, _SPACING_M = 2, 0.1
"""A scanner some tens of metres away at the height of the site, as in the study: few stations."""

_SECTION_M = 1.0
_SECTION_GRID_M, _EXTENT_GRIDS_M = 5.0, (1.0, 3.0, 10.0)
_EXTENT_POINTS = 20_000
_MARGIN_M = 3.0
_CELL_M = 1.0
_MACHINES = (SiteKind.EXCAVATOR, SiteKind.DUMP_TRUCK, SiteKind.BULLDOZER, SiteKind.ROLLER)
_GROUND = 2


class _Scores(NamedTuple):
    """Of the removed machine points: precision, recall, F; and the share of the ground kept."""

    precision: float
    recall: float
    f_measure: float
    ground_kept: float


def main(arguments: list[str]) -> int:
    """Write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        scenes = list(_scenes(Path(folder)))
        sections, extents = list(_sections(scenes)), list(_extents(scenes))
    content = f"{_ABOUT}\n{markdown_table(sections)}\n{_ABOUT_EXTENTS}\n{markdown_table(extents)}"
    write_sections(chosen.markdown, {HEADING: content})
    return 0


def _scenes(folder: Path) -> Iterator[FilterScene]:
    """The earlier date of each site: ground and machines, as the study's clouds."""
    for style in _STYLES:
        for seed in SEEDS:
            request = SiteRequest(seed=seed, style=style, stations=_STATIONS, spacing_m=_SPACING_M)
            simulate_site(request, folder / f"{style} {seed}", SilentMonitor())
    for scene in sites(folder):
        if scene.name.endswith("before"):
            kind = scene.kinds["kind"]
            yield _part(scene, np.isin(kind, (int(SiteKind.TERRAIN), *map(int, _MACHINES))))


def _part(scene: FilterScene, chosen: NDArray[np.bool_]) -> FilterScene:
    kinds = {name: kind[chosen] for name, kind in scene.kinds.items()}
    return replace(scene, cloud=None, xyz=scene.xyz[chosen], truth=scene.truth[chosen], kinds=kinds)


def _sections(scenes: list[FilterScene]) -> Iterator[list[str]]:
    yield ["site", "method", "machine points in the section", "of them left", "ground lost"]
    for scene in scenes:
        inside = _across_largest_machine(scene)
        for method in study_methods((_SECTION_GRID_M,), with_lowest=False):
            is_ground = _is_ground(method, scene)[inside]
            machine = scene.truth[inside] != _GROUND
            left = float(is_ground[machine].mean()) if machine.any() else 0.0
            lost = float((~is_ground[~machine]).mean())
            name = f"{method.name} {method.settings}"
            yield [scene.name, name, f"{machine.sum():,}", f"{left:.1%}", f"{lost:.1%}"]


def _across_largest_machine(scene: FilterScene) -> NDArray[np.bool_]:
    """Points of a section across the longer side of the site, through its largest machine."""
    labels = _machine_labels(scene)
    largest = int(np.argmax(np.bincount(labels)[1:])) + 1
    along = int(np.argmax(np.ptp(scene.xyz[:, :2], axis=0)))
    middle = float(np.median(scene.xyz[labels == largest, along]))
    inside: NDArray[np.bool_] = np.abs(scene.xyz[:, along] - middle) <= _SECTION_M / 2
    return inside


def _machine_labels(scene: FilterScene) -> NDArray[np.int64]:
    """Number of the machine that a point belongs to, 0 for none: machines stand a metre apart."""
    machine = scene.truth != _GROUND
    cell = np.floor(scene.local_xyz[:, :2] / _CELL_M).astype(np.int64)
    plan = np.zeros(cell.max(axis=0) + 1, np.uint8)
    plan[tuple(cell[machine].T)] = 1
    _, labels = cv2.connectedComponents(plan, connectivity=8)
    found: NDArray[np.int64] = np.where(machine, labels[tuple(cell.T)], 0).astype(np.int64)
    return found


def _extents(scenes: list[FilterScene]) -> Iterator[list[str]]:
    yield ["site", "points", "machine", "method", "P", "R", "**F**", "ground kept"]
    for scene in scenes:
        part = _with_two_machines(scene)
        sizes = [f"{len(part.xyz):,}", f"{(part.truth != _GROUND).sum():,}"]
        for method in study_methods(_EXTENT_GRIDS_M, with_lowest=True):
            scores = _scores(part.truth != _GROUND, ~_is_ground(method, part))
            name = f"{method.name} {method.settings}"
            yield [scene.name, *sizes, name, *(f"{score:.2f}" for score in scores)]
    for name, *figures in _PUBLISHED:
        yield ["published: Kako River", "19,971", "5,293", name, *figures]


def _with_two_machines(scene: FilterScene) -> FilterScene:
    """The extent of the two machines with most points among neighbours, thinned evenly."""
    labels = _machine_labels(scene)
    counts = np.bincount(labels)[1:]
    largest = int(np.argmax(counts)) + 1
    centres = np.array(
        [scene.xyz[labels == label, :2].mean(axis=0) for label in range(1, len(counts) + 1)]
    )
    away = np.linalg.norm(centres - centres[largest - 1], axis=1)
    # A part of a machine that is seen in two pieces is no second machine.
    nearest = np.where((counts > counts.max() / 10) & (away > 0), away, np.inf)
    second = int(np.argmin(nearest)) + 1 if np.isfinite(nearest).any() else largest
    both = np.isin(labels, (largest, second))
    low = scene.xyz[both, :2].min(axis=0) - _MARGIN_M
    high = scene.xyz[both, :2].max(axis=0) + _MARGIN_M
    inside = np.flatnonzero(np.all((scene.xyz[:, :2] > low) & (scene.xyz[:, :2] < high), axis=1))
    if len(inside) > _EXTENT_POINTS:
        inside = np.random.default_rng(1).choice(inside, _EXTENT_POINTS, replace=False)
    chosen = np.zeros(len(scene.xyz), np.bool_)
    chosen[inside] = True
    return _part(scene, chosen)


def _is_ground(method: FilterMethod, scene: FilterScene) -> NDArray[np.bool_]:
    with tempfile.TemporaryDirectory(prefix="zuka-") as folder:
        codes = method.codes(scene, Path(folder))
    found: NDArray[np.bool_] = np.asarray(codes) == _GROUND
    return found


def _scores(machine: NDArray[np.bool_], removed: NDArray[np.bool_]) -> _Scores:
    hits = float((machine & removed).sum())
    precision, recall = hits / max(1, int(removed.sum())), hits / max(1, int(machine.sum()))
    both = max(precision + recall, np.finfo(float).tiny)
    kept = float((~removed[~machine]).mean())
    return _Scores(precision, recall, 2 * precision * recall / both, kept)


_ABOUT = f"""\
`python -m processing.laboratory.accuracy.filters.removal_study --markdown docs/accuracy.md` \
makes this section: simulated levees and cuttings of seeds {SEEDS[0]} and {SEEDS[1]}, two \
stations, and of their points only those of ground and machines, as in the study's clouds. \
Experiment I: a section {_SECTION_M:g} m wide through the largest machine; the study judged it by \
eye, with a grid of {_SECTION_GRID_M:g} m.
"""
_ABOUT_EXTENTS = f"""\
Experiment II: the extent of two machines, thinned to {_EXTENT_POINTS:,} points. Positive is the \
removed machine point; ground kept follows from the study's counts.
"""
# Sakurai et al., table 2, and the ground kept by its counts.
_PUBLISHED = (
    ("published g = 1 m", "0.85", "0.84", "0.84", "0.95"),
    ("published g = 3 m", "0.91", "0.83", "0.87", "0.97"),
    ("published g = 10 m", "0.63", "0.86", "0.73", "0.82"),
    ("lowest points, strict g = 1 m", "0.42", "0.88", "0.56", "0.56"),
    ("lowest points, strict g = 3 m", "0.33", "0.95", "0.49", "0.30"),
    ("lowest points, strict g = 10 m", "0.27", "0.98", "0.42", "0.05"),
)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
