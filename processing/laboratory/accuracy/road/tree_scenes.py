"""Streets and deliveries on which trees are scored, and what was measured of each trunk there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import laspy
import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.baselines.tree_baselines import TrunkPoints
from processing.laboratory.accuracy.road.road_scenes import (
    avenue_options_of,
    map_candidate,
    worn_options_of,
)
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.streets import simulate_street
from processing.methods.road.objects.column_points import points_about
from processing.methods.road.objects.foot import foot_height
from processing.methods.road.objects.sparse_plan import plan_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import (
    ObjectMatch,
    ObjectMatches,
    is_in_span,
    match_objects,
    positions_of,
    shows_enough,
)
from processing.scoring.features.trees import LEAST_TRUNK_POINTS, WITHIN_M
from processing.tools.trees import TreeParameters, find_trees

_CRS = "EPSG:6677"
_LEAST_CONFIDENCE = 0.02
_LENGTH_M = 60.0
_TRUNK_M = 0.9
_FLOOR, _USUAL_RADIUS_M = 0.001, 0.13
_MOST_POINTS = 10_000
_HEIGHTS = "hag"
"""Heights above the ground in files of lidR."""

AVENUES = (
    *(range(740, 746), range(776, 780), range(790, 798)),
    *(range(9301, 9309), range(9321, 9329), range(9601, 9609)),
)
STREETS = (
    *(range(760, 764), range(8131, 8137), range(8171, 8175), range(8175, 8179)),
    *(range(9311, 9315), range(9341, 9347), range(9611, 9617)),
)
"""Seeds by which nothing was learnt; all but those from 9601 on were looked at while the method was
made or since."""


@dataclass(frozen=True)
class TreeScene:
    """A street that was recorded, with its true trees.

    Attributes
    ----------
    name : str
    group : str
        By which scanner it was recorded.
    drives : tuple of Drive
    truth : MappedFile
    labels : Path
        The folder of the true classes of its points.
    """

    name: str
    group: str
    drives: tuple[Drive, ...]
    truth: MappedFile
    labels: Path


@dataclass(frozen=True)
class ScoredTrees:
    """What was found on a street.

    Attributes
    ----------
    scene : TreeScene
    result : MappedFile
        All candidates, unlikely ones included.
    likely : MappedFile
        Those that the tool shows by its own parameters.
    matches : ObjectMatches
        Of the likely ones.
    judged : tuple of (float, bool)
        Confidence of each candidate, and whether it is right.
    """

    scene: TreeScene
    result: MappedFile
    likely: MappedFile
    matches: ObjectMatches
    judged: tuple[tuple[float, bool], ...]

    def number(self, match: ObjectMatch, name: str) -> float:
        """A measure of what was found."""
        return self.likely.number(match.result, name)

    def true(self, match: ObjectMatch, name: str) -> float:
        """A true measure."""
        return self.scene.truth.number(match.truth, name)

    def missed(self) -> list[MappedFeature]:
        """Trees that were asked for and not found."""
        found = {one.truth.number for one in self.matches.partners}
        asked = zip(self.scene.truth.features, asked_of(self.scene.truth), strict=True)
        return [one for one, is_asked in asked if is_asked and one.number not in found]


def own_scenes() -> Iterator[TreeScene]:
    """Own streets, one after the other; each is gone when the next one is asked for."""
    kinds = ((avenue_options_of, AVENUES), (worn_options_of, STREETS))
    requests = [
        options_of(number, seed, _LENGTH_M)
        for options_of, series in kinds
        for seeds in series
        for number, seed in enumerate(seeds)
    ]
    for one in requests:
        with TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position) / "street"
            simulate_street(one, folder, SilentMonitor())
            drives = import_files(folder, "trajectory*.csv", Path(position) / "drives")
            truth = read_mapped(folder / "truth" / "trees.geojson")
            yield TreeScene(name_of(one), one.sensor, drives, truth, folder / "truth")


def name_of(request: StreetRequest) -> str:
    """What an own street is called."""
    kind = "avenue" if request.avenue else request.style
    twice = " twice" if request.passes > 1 else ""
    return f"{kind} {request.sensor} {request.seed}{twice}"


def given_tree_scenes(folders: Sequence[Path]) -> Iterator[TreeScene]:
    """Deliveries; of passes that drift, all together with the truth of their mean."""
    for folder in folders:
        passes = any(folder.glob("pass[0-9].csv"))
        truth = folder / ("truth_mean" if passes else "truth") / "trees.geojson"
        with TemporaryDirectory(prefix="zuka-") as position:
            parts = sorted(folder.glob("pass[0-9].csv")) if passes else [None]
            drives: list[Drive] = []
            for number, one in enumerate(parts):
                into = Path(position) / f"{number}"
                stem = one.stem if one is not None else ""
                drives += import_files(folder, f"{stem or 'trajectory*'}.csv", into, stem)
            found = read_mapped(truth)
            yield TreeScene(folder.name, "delivery", tuple(drives), found, folder / "truth")


def import_files(folder: Path, trajectories: str, into: Path, stem: str = "") -> tuple[Drive, ...]:
    """The drives of a delivery, of one pass if its files begin so."""
    clouds, ways = sorted(folder.glob(f"{stem}*.laz")), sorted(folder.glob(trajectories))
    request = ImportRequest(tuple(clouds), tuple(ways), crs=_CRS)
    return tuple(Drive(one) for one in import_drives(request, into, SilentMonitor()))


def asked_of(truth: MappedFile) -> list[bool]:
    """Of each true tree, whether the points show it."""
    return [
        is_in_span(one) and shows_enough(truth, one, "trunk_points", LEAST_TRUNK_POINTS)
        for one in truth.features
    ]


def score_scene(scene: TreeScene) -> ScoredTrees:
    """Run the tool on a street and hold it against the truth."""
    parameters = TreeParameters(least_confidence=_LEAST_CONFIDENCE)
    candidates = find_trees(scene.drives, parameters, SilentMonitor()).candidates
    features = [map_candidate(one, number + 1) for number, one in enumerate(candidates)]
    likely = [
        one
        for one, candidate in zip(features, candidates, strict=True)
        if candidate.confidence >= TreeParameters().least_confidence
    ]
    true, asked = scene.truth.features, asked_of(scene.truth)
    every = match_objects(features, true, asked, WITHIN_M)
    right = {one.result.number for one in every.partners}
    wrong = {one.number for one in every.alone}
    judged = tuple(
        (candidate.confidence, one.number in right)
        for one, candidate in zip(features, candidates, strict=True)
        if one.number in right or one.number in wrong
    )
    file = Path("trees.geojson")
    return ScoredTrees(
        scene,
        MappedFile(file, _CRS, tuple(features)),
        MappedFile(file, _CRS, tuple(likely)),
        match_objects(likely, true, asked, WITHIN_M),
        judged,
    )


def trunk_points(scene: TreeScene) -> list[TrunkPoints]:
    """What was measured about the foot of each true tree."""
    return points_about_feet(scene.drives, positions_of(scene.truth.features))


def points_about_feet(drives: Sequence[Drive], feet: Floats) -> list[TrunkPoints]:
    """What was measured about some feet.

    Parameters
    ----------
    feet : (n, 3) float64
        m, project CRS.
    """
    plan = plan_of([(drive.info.lowest, drive.info.highest) for drive in drives])
    for drive in drives:
        plan.add(drive.coordinates.chunk_about(0, drive.count, plan.origin))
    local_feet = feet - plan.origin
    gathered = points_about(drives, plan, local_feet[:, :2].copy(), _TRUNK_M, SilentMonitor())
    pulses = np.full(len(gathered.local), -1, np.int64)
    per_turn: list[int] = []
    for number, drive in enumerate(drives):
        per_turn.append(0)
        if drive.revolutions is not None:
            per_turn[-1] = round(drive.revolutions.pulses_per_revolution)
            own = gathered.drives == number
            pulses[own] = drive.columns["pulse"][gathered.points[own]]
    return [
        TrunkPoints(
            gathered.local[part] - foot, gathered.drives[part], pulses[part], tuple(per_turn)
        )
        for foot, part in ((foot, gathered.of(number)) for number, foot in enumerate(local_feet))
    ]


def standing_trees(path: Path) -> dict[str, TrunkPoints]:
    """The trunks of a cloud that holds nothing but trees, from west to east, by name.

    Of a plot those that the tool finds; of one tree all that lies about its trunk.
    """
    with TemporaryDirectory(prefix="zuka-") as position:
        request = ImportRequest((path,), (), crs=_CRS)
        drives = [
            Drive(one) for one in import_drives(request, Path(position) / "d", SilentMonitor())
        ]
        found = find_trees(tuple(drives), TreeParameters(), SilentMonitor()).candidates
        feet = np.array([one.xyz[0] for one in found]).reshape(-1, 3)
        if len(feet) > 1:
            feet = feet[np.argsort(feet[:, 0])]
            trunks = [_thinned(one) for one in points_about_feet(drives, feet)]
            return {f"{path.stem} {number + 1}": one for number, one in enumerate(trunks)}
    return {path.stem: _thinned(standing_tree(path))}


def _thinned(points: TrunkPoints) -> TrunkPoints:
    """Every so many-th point of what a tripod scanned: wires of all of them would take minutes."""
    kept = slice(None, None, max(1, len(points.local) // _MOST_POINTS))
    return TrunkPoints(
        points.local[kept], points.drives[kept], points.pulses[kept], points.per_turn
    )


def standing_tree(path: Path) -> TrunkPoints:
    """The trunk of a tree that was scanned by itself, from a LAS file.

    Heights above the ground count where the file has them.
    """
    cloud = laspy.read(path)
    xyz = np.asarray(cloud.xyz)
    has_heights = _HEIGHTS in cloud.point_format.dimension_names
    up = np.asarray(cloud[_HEIGHTS]) if has_heights else xyz[:, 2] - xyz[:, 2].min()
    breast = xyz[(up > 1.0) & (up < 1.4), :2]
    middle = np.median(breast, axis=0)
    near = np.hypot(*(xyz[:, :2] - middle).T) < _TRUNK_M
    local = np.column_stack([xyz[near, :2] - middle, up[near]])
    if not has_heights:
        coarse = float(np.quantile(local[:, 2], _FLOOR))
        local[:, 2] -= foot_height(local, np.zeros(2), coarse, _USUAL_RADIUS_M)
    unknown = np.full(len(local), -1, np.int64)
    return TrunkPoints(local, np.zeros(len(local), np.int64), unknown, (0,))
