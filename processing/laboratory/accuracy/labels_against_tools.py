"""What labels alone give of a street, beside what its tools find, and what mending labels costs.

``python -m processing.laboratory.accuracy.labels_against_tools --samples FOLDER…
--markdown docs/accuracy.md``

Curbs, trees, signs and poles are made from the classes of points by nothing but joining what hangs
together, and scored as the tools are. Classes are found without the tools' help there.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.parts_of_points import parts_of_points
from processing.laboratory.accuracy.road.road_scenes import RoadScene, found_by, given_scenes
from processing.laboratory.accuracy.road.true_labels import labels_of_drive
from processing.methods.classes.class_models import shipped_models
from processing.methods.classes.drive_classes import classify_drive
from processing.scoring.features.curb_lines import curb_score
from processing.scoring.features.file_scores import FileScore
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.poles import pole_score
from processing.scoring.features.signs import sign_score
from processing.scoring.features.trees import tree_score

HEADING = "### Labels against tools"
CORRECTIONS = "### Corrections a kilometre"

_CROWN, _SIGN, _POLE_LIKE, _CURB = 5, 65, 66, 67
_NOISE = (0, 7, 18)

_CELL_M, _LINK_M = 0.2, 0.36
"""Points of a class hang together through cells that touch, by a corner at most."""

_LEAST_POINTS = 20
"""Fewer are no thing: as many as the scores ask of a pole or a trunk."""

_LEAST_HEIGHT_M = 1.0
"""Lower pole-like things are bollards and stumps, which neither score asks for."""

_FOOT_M = 0.5
"""The lowest part of a pole or trunk, whose middle is its foot."""

_CROWN_M = 1.5
"""So near above its foot a trunk has its crown."""

_STEP_M = 1.0
"""Distance of the vertices of a curb's lines."""

_PATCH_M, _PATCH_LINK_M, _LEAST_PATCH = 0.25, 0.45, 4
"""Wrong cells that touch are mended by one stroke; fewer than four of them nobody sees."""

_TYPES: Mapping[str, Callable[[MappedFile, MappedFile], FileScore]] = {
    "curbs": curb_score,
    "trees": tree_score,
    "signs": sign_score,
    "poles": pole_score,
}


@dataclass(frozen=True)
class LabelledStreet:
    """The points of a street, their true classes and those that were found.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    true, said : (n,) uint8
    """

    xyz: Floats
    true: NDArray[np.uint8]
    said: NDArray[np.uint8]

    @property
    def length_m(self) -> float:
        """How long the street is: the extent of its points along its main direction."""
        flat = self.xyz[:: max(1, len(self.xyz) // 10_000), :2]
        flat = flat - flat.mean(axis=0)
        along = flat @ np.linalg.svd(flat, full_matrices=False)[2][0]
        return float(np.subtract(*np.percentile(along, [99.0, 1.0])))


def main(arguments: list[str]) -> int:
    """Score labels and tools on streets."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--markdown", type=Path)
    chosen = parser.parse_args(arguments)
    streets = [(scene.name, *_scored(scene)) for scene in given_scenes(chosen.samples)]
    tools = markdown_table(list(_tool_rows(streets)))
    corrections = markdown_table(list(_correction_rows([one for *_, one in streets])))
    sections = {
        HEADING: f"{_ABOUT}\n{tools}",
        CORRECTIONS: f"{_ABOUT_CORRECTIONS}\n{corrections}",
    }
    write_sections(chosen.markdown, sections)
    return 0


_Scores = Mapping[str, tuple[FileScore, FileScore]]


def _scored(scene: RoadScene) -> tuple[_Scores, LabelledStreet]:
    street = _street_of(scene)
    made = features_of_labels(street.xyz, street.said)
    scores = {}
    for tool, score in _TYPES.items():
        path = scene.delivery / "truth" / f"{tool}.geojson"
        if path.is_file():
            true = read_mapped(path)
            scores[tool] = score(made[tool], true), score(found_by(tool, scene.drives).result, true)
    return scores, street


def _street_of(scene: RoadScene) -> LabelledStreet:
    xyz, true, said = [], [], []
    for drive in scene.drives:
        codes, sure = np.zeros(drive.count, np.uint8), np.zeros(drive.count, np.float32)
        with TemporaryDirectory(prefix="zuka-") as folder:
            classify_drive(
                drive, codes, sure, Path(folder), SilentMonitor(), models=shipped_models()
            )
        xyz.append(drive.xyz(slice(0, drive.count)))
        true.append(labels_of_drive(drive, scene.delivery / "truth"))
        said.append(codes)
    return LabelledStreet(np.concatenate(xyz), np.concatenate(true), np.concatenate(said))


def features_of_labels(xyz: Floats, codes: NDArray[np.uint8]) -> dict[str, MappedFile]:
    """Curbs, trees, signs and poles made from classes alone, by tool.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    codes : (n,) uint8
    """
    crowns = xyz[codes == _CROWN]
    above = cKDTree(crowns[:, :2]) if len(crowns) else None
    found: dict[str, list[tuple[Floats, dict[str, object]]]] = {tool: [] for tool in _TYPES}
    for part in parts_of(xyz[codes == _SIGN]):
        found["signs"].append((part.mean(axis=0)[None], {"kind": "sign"}))
    for part in parts_of(xyz[codes == _POLE_LIKE]):
        low, high = part[:, 2].min(), part[:, 2].max()
        if high - low < _LEAST_HEIGHT_M:
            continue
        foot = np.append(part[part[:, 2] < low + _FOOT_M, :2].mean(axis=0), low)
        near = [] if above is None else above.query_ball_point(foot[:2], _CROWN_M)
        is_tree = len(near) >= _LEAST_POINTS and crowns[near, 2].max() > high - _FOOT_M
        tool, kind = ("trees", "tree") if is_tree else ("poles", "pole")
        found[tool].append((foot[None], {"kind": kind}))
    for run, part in enumerate(parts_of(xyz[codes == _CURB])):
        for edge, line in _edges_of(part).items():
            found["curbs"].append((line, {"kind": f"curb_{edge}", "edge": edge, "run": run}))
    return {tool: _file_of(tool, ones) for tool, ones in found.items()}


def parts_of(xyz: Floats) -> Iterator[Floats]:
    """Points that hang together, (k, 3) each; fewer than can be a thing are left out."""
    if len(xyz) < _LEAST_POINTS:
        return
    part = parts_of_points(xyz, _CELL_M, _LINK_M)
    order = np.argsort(part, kind="stable")
    for own in np.split(order, np.flatnonzero(np.diff(part[order])) + 1):
        if own.size >= _LEAST_POINTS:
            yield xyz[own]


def corrections_of(street: LabelledStreet) -> Counter[int]:
    """Strokes that mend the labels of a street, by the class that points truly are of."""
    wrong = (street.true != street.said) & ~np.isin(street.true, _NOISE)
    strokes: Counter[int] = Counter()
    for code in np.unique(street.true[wrong]).tolist():
        cells = np.unique(np.floor(street.xyz[wrong & (street.true == code)] / _PATCH_M), axis=0)
        part = parts_of_points(cells * _PATCH_M, _PATCH_M, _PATCH_LINK_M)
        strokes[code] = int((np.bincount(part) >= _LEAST_PATCH).sum())
    return strokes


def _edges_of(part: Floats) -> dict[str, Floats]:
    """The upper and the lower edge of points on a curb, each (k, 3), where it is long enough."""
    middle = part.mean(axis=0)
    ahead = np.linalg.svd((part - middle)[:, :2], full_matrices=False)[2][0]
    along = (part - middle)[:, :2] @ ahead
    bins = np.floor((along - along.min()) / _STEP_M).astype(np.int64)
    lines: dict[str, list[Floats]] = {"upper": [], "lower": []}
    for one in np.unique(bins).tolist():
        own = part[bins == one]
        for edge, share in (("upper", 90.0), ("lower", 10.0)):
            height = np.percentile(own[:, 2], share)
            is_near = own[:, 2] >= height if edge == "upper" else own[:, 2] <= height
            lines[edge].append(np.append(own[is_near, :2].mean(axis=0), height))
    return {edge: np.array(line) for edge, line in lines.items() if len(line) > 1}


def _file_of(tool: str, found: Sequence[tuple[Floats, dict[str, object]]]) -> MappedFile:
    features = tuple(
        MappedFeature(number, "point" if len(xyz) == 1 else "line", xyz, facts)
        for number, (xyz, facts) in enumerate(found, 1)
    )
    return MappedFile(Path(f"{tool}.geojson"), "", features)


def _tool_rows(streets: Sequence[tuple[str, _Scores, LabelledStreet]]) -> Iterator[list[str]]:
    yield ["street", *(f"{tool}, {side}" for tool in _TYPES for side in ("labels", "tool"))]
    for name, scores, _ in streets:
        cells = []
        for tool in _TYPES:
            cells += [_f_of(one) for one in scores[tool]] if tool in scores else ["–", "–"]
        yield [name, *cells]


def _f_of(score: FileScore) -> str:
    """F of what is counted first, in percent: upper edges of curbs, signs without what hangs."""
    counts = score.counts[0].counts
    return f"{100 * counts.f_measure:.1f}"


def _correction_rows(streets: Sequence[LabelledStreet]) -> Iterator[list[str]]:
    yield ["class", "share of the points", "recall", "corrections a kilometre"]
    true, right, strokes = Counter[int](), Counter[int](), Counter[int]()
    for street in streets:
        true.update(street.true.tolist())
        right.update(street.true[street.true == street.said].tolist())
        strokes.update(corrections_of(street))
    counted = sum(count for code, count in true.items() if code not in _NOISE)
    kilometres = sum(street.length_m for street in streets) / 1000.0
    for code, count in strokes.most_common():
        yield [
            str(code),
            f"{100 * true[code] / counted:.1f} %",
            f"{right[code] / true[code]:.3f}",
            f"{count / kilometres:,.0f}",
        ]


_ABOUT = """\
`python -m processing.laboratory.accuracy.labels_against_tools --samples FOLDER… \
--markdown docs/accuracy.md` makes this section: F in percent of curbs (sections of upper edges \
within 10 cm), trees, signs and poles that are made from the classes of points by joining what \
hangs together, beside what the tools find on the same streets. Classes are found without the \
tools' help here.
"""

_ABOUT_CORRECTIONS = """\
Strokes that mend the labels of these streets, by the class that the points truly are of: cells of \
25 cm that are wrong and touch are mended by one; patches of fewer than four nobody sees.
"""


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
