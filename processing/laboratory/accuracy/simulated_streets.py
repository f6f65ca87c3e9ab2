"""Simulated recordings held against their own truth: what the points show of what it says.

``python -m processing.laboratory.accuracy.simulated_streets --markdown docs/accuracy.md`` simulates
streets of seeds that nobody looked at, and measures rates, heights, trunks and plates from the
points alone.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import laspy
import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.trajectories.trajectory_csv import read_trajectory_csv
from processing.laboratory.accuracy.disturbed_truths import score_disturbed
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.scanning.density import road_density, survey_of
from processing.laboratory.simulate.scanning.sensors import sensor_of
from processing.laboratory.simulate.streets import simulate_street
from processing.recording.columns.point_source import PointColumns
from processing.recording.revolutions.pulse_clock import estimate_clock

HEADING = "## Simulated streets against their truth"
DISTURBED_HEADING = "## Truths of simulated streets, disturbed"
SEEDS = range(901, 913)
_STYLES = ("urban", "rural", "highway")
_SENSORS = ("vq250", "vq450", "zf9012", "vmx2ha")
_LENGTH_M = 100.0
_ABOUT = (
    "`python -m processing.laboratory.accuracy.simulated_streets --markdown docs/accuracy.md`: "
    "streets of 100 m "
    "of seeds that nobody looked at, recorded without drift, and measured from their points alone. "
    "Errors are the middle ± the middle distance from it (how many)."
)
_ABOUT_TRUTHS = (
    "The same command: truths scored against themselves, as they are and disturbed. Places within "
    "their tolerance don't fall (curbs 10 cm, signs 15 cm or 1 m, poles 50 cm, trees 2 m)."
)
_HEAD = (
    "style, sensor, seed",
    "points",
    "pulses/s: measured − true (ppm)",
    "points on the road, of those told",
    "curb steps (mm)",
    "trunk diameters (mm)",
    "plates, along their normal (mm)",
    "plates, turned (°)",
)

_POLE, _SIGN, _CURB, _ROAD = 66, 65, 67, 11
_DENSE_M = (0.5, 1.0)
_FEWEST_POINTS = 30
_STONE_M = 0.1  # of the top behind the upper edge, and of the apron before the lower one
_BESIDE_M = 0.25
_BREAST_M = (1.1, 1.3)
_FULL_ARC_DEG = 130.0

_Members = list[dict[str, Any]]  # whatever JSON can hold


@dataclass(frozen=True)
class RecordedCloud:
    """All points of a simulated recording with their truth.

    Attributes
    ----------
    xyz : (n, 3) float64
        m.
    label, instance : (n,)
    """

    xyz: Floats
    label: NDArray[np.uint8]
    instance: NDArray[np.int32]


@dataclass(frozen=True)
class MeasureErrors:
    """How far measured values are from true ones.

    Attributes
    ----------
    count : int
    median, spread : float
        Of the errors: the middle, and the middle of their distances from it.
    """

    count: int
    median: float
    spread: float

    @staticmethod
    def of(errors: Sequence[float]) -> MeasureErrors:
        """Of some errors; NaN where there are none."""
        if not errors:
            return MeasureErrors(0, np.nan, np.nan)
        middle = float(np.median(errors))
        return MeasureErrors(
            len(errors), middle, float(np.median(np.abs(np.array(errors) - middle)))
        )

    def cell(self, factor: float) -> str:
        """As a table's cell: middle ± spread (how many), times a factor."""
        if not self.count:
            return "–"
        return f"{factor * self.median:+.1f} ± {factor * self.spread:.1f} ({self.count})"


def cloud_of(folder: Path) -> RecordedCloud:
    """The points of a simulated delivery."""
    parts = [laspy.read(path) for path in sorted(folder.glob("*.laz"))]
    truth = folder / "truth"
    names = sorted(path.stem for path in folder.glob("*.laz"))
    return RecordedCloud(
        np.concatenate([np.asarray(one.xyz) for one in parts]),
        np.concatenate([np.load(truth / f"{name}.labels.npy") for name in names]),
        np.concatenate([np.load(truth / f"{name}.instances.npy") for name in names]),
    )


def curb_heights(cloud: RecordedCloud, truth: Path) -> MeasureErrors:
    """Steps of seen 2 m stretches, from the points before and behind the edges, against truth."""
    edges = [one for one in _members(truth / "curbs.geojson") if _facts(one)["type"] != "back"]
    lower = {_facts(one)["run"]: one for one in edges if _facts(one)["edge"] == "lower"}
    near = np.isin(cloud.label, (2, 11, _CURB))
    xyz = cloud.xyz[near]
    order = np.argsort(xyz[:, 0])
    xyz = xyz[order]
    errors = []
    for one in edges:
        run = _facts(one)["run"]
        if _facts(one)["edge"] != "upper" or run not in lower or _facts(one)["type"] != "curb":
            continue
        high, low = _line(one), _line(lower[run])
        along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(high, axis=0), axis=1))]
        for section in _facts(one)["sections"]:
            if section["in_span"] and section["covered"] > 0.9 and section["u1"] > 1.5:
                middle = (section["u0"] + section["u1"]) / 2
                error = _step_error(xyz, high, low, _at(high, along, middle))
                errors += [] if error is None else [error]
    return MeasureErrors.of(errors)


def trunk_diameters(cloud: RecordedCloud, truth: Path) -> MeasureErrors:
    """Girth-diameters of trunks seen well from two sides, from circles through their points."""
    errors = []
    for one in _members(truth / "trees.geojson"):
        facts = _facts(one)
        if facts["arc_deg"] < _FULL_ARC_DEG or facts["stems"] != 1:
            continue
        own = cloud.xyz[(cloud.instance == facts["instance"]) & (cloud.label == _POLE)]
        above = own[:, 2] - one["geometry"]["coordinates"][2]
        ring = own[(above > _BREAST_M[0]) & (above < _BREAST_M[1]), :2]
        if len(ring) >= _FEWEST_POINTS:
            errors.append(_circle_diameter(ring) - facts["dbh_m"])
    return MeasureErrors.of(errors)


def plate_distances(cloud: RecordedCloud, truth: Path) -> tuple[MeasureErrors, MeasureErrors]:
    """Distances of plates' points from the true plane (m), and turns of their fitted one (°)."""
    away, turned = [], []
    for one in _members(truth / "signs.geojson"):
        facts = _facts(one)
        if facts["front_points"] < _FEWEST_POINTS:
            continue
        own = cloud.xyz[(cloud.instance == facts["instance"]) & (cloud.label == _SIGN)]
        facing = np.radians(facts["facing_deg"])
        normal = np.array([np.sin(facing), np.cos(facing)])
        centre = np.array(one["geometry"]["coordinates"])
        off = (own[:, :2] - centre[:2]) @ normal
        away.append(float(np.median(off)))
        across = np.array([-normal[1], normal[0]])
        beside = (own[:, :2] - centre[:2]) @ across
        if np.ptp(beside) > 0.2:
            matrix = np.column_stack([beside, own[:, 2] - centre[2], np.ones(beside.size)])
            slope = np.linalg.lstsq(matrix, off, rcond=None)[0][0]
            turned.append(float(np.degrees(np.arctan(slope))))
    return MeasureErrors.of(away), MeasureErrors.of(turned)


def density_share(cloud: RecordedCloud, folder: Path, options: StreetRequest) -> float:
    """Points counted on the road half a metre to a metre beside the path, of those told.

    The vehicle's height is taken from the points, as a density map doesn't know it.
    """
    from scipy.spatial import cKDTree

    driven = read_trajectory_csv(folder / "trajectory.csv")
    middle = slice(driven.time.size // 4, 3 * driven.time.size // 4)
    path = driven.xyz[middle, :2]
    long = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    seconds = float(driven.time[middle][-1] - driven.time[middle][0])
    ways = np.gradient(path, axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    road = cloud.xyz[cloud.label == _ROAD]
    tree: Any = cKDTree(path)  # its stub gives a scalar or an array
    _, nearest = tree.query(road[:, :2], distance_upper_bound=_DENSE_M[1] + 0.5)
    near = nearest < len(path)
    road, nearest = road[near], nearest[near]
    off, way = road[:, :2] - path[nearest], ways[nearest]
    ahead = np.einsum("ij,ij->i", off, way)
    aside = np.abs(off[:, 0] * way[:, 1] - off[:, 1] * way[:, 0])
    counted = (aside > _DENSE_M[0]) & (aside < _DENSE_M[1]) & (np.abs(ahead) < 0.1)
    high = float(np.median(driven.xyz[middle, 2][nearest[counted]] - road[counted, 2]))
    survey = survey_of(sensor_of(options.sensor, "mobile"), 3.6 * long / seconds)
    survey = replace(survey, height_m=high)
    positions = np.linspace(*_DENSE_M, 21)
    told = float(road_density(survey, np.r_[-positions, positions]).mean())
    return float(counted.sum()) / (2 * long * (_DENSE_M[1] - _DENSE_M[0])) / told


def pulse_rate(path: Path) -> float:
    """Pulses per second as an import finds them from a file's times; NaN where it finds none."""
    points = laspy.read(path)
    sample = PointColumns(
        np.column_stack([points.X, points.Y, points.Z]),
        tuple(points.header.scales),
        tuple(points.header.offsets),
        np.asarray(points.gps_time),
        np.asarray(points.return_number),
        np.asarray(points.number_of_returns),
    )
    clock = estimate_clock([sample])
    return np.nan if clock is None else 1.0 / clock.interval_s


@dataclass
class Tables:
    """Rows of cells, the head first.

    Attributes
    ----------
    streets : list
        One row per street.
    disturbed : list
        Scores of disturbed truths, of one street of each style.
    """

    streets: list[list[str]]
    disturbed: list[list[str]]


def tables_of(seeds: Sequence[int] = SEEDS, length_m: float = _LENGTH_M) -> Tables:
    """Simulate streets of these seeds, of each style and several sensors, and measure them."""
    tables = Tables([list(_HEAD)], [])
    for number, seed in enumerate(seeds):
        style, sensor = _STYLES[number % len(_STYLES)], _SENSORS[number % len(_SENSORS)]
        options = StreetRequest(seed=seed, length_m=length_m, style=style, sensor=sensor)
        options = replace(options, drift_m=0.0, images=False)
        with tempfile.TemporaryDirectory(prefix="zuka-") as position:
            folder = Path(position) / "street"
            simulate_street(options, folder, SilentMonitor())
            tables.streets.append([f"{style}, {sensor}, {seed}", *_cells(folder, options)])
            if number < len(_STYLES):
                head, *rows = score_disturbed(folder / "truth")
                tables.disturbed += [] if tables.disturbed else [["street", *head]]
                tables.disturbed += [[f"{style} {seed}", *row] for row in rows]
    return tables


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--length", type=float, default=_LENGTH_M)
    parser.add_argument("--seeds", type=int, nargs="+", default=list(SEEDS))
    options = parser.parse_args(arguments)
    tables = tables_of(options.seeds, options.length)
    sections = {
        HEADING: (_ABOUT, tables.streets),
        DISTURBED_HEADING: (_ABOUT_TRUTHS, tables.disturbed),
    }
    written = {
        heading: f"{about}\n\n{markdown_table(rows)}" for heading, (about, rows) in sections.items()
    }
    write_sections(options.markdown, written)
    return 0


def _cells(folder: Path, options: StreetRequest) -> list[str]:
    truth = folder / "truth"
    scene = json.loads((truth / "scene.json").read_text("utf-8"))
    cloud = cloud_of(folder)
    true_rate = scene["pulses_per_revolution"] * scene["revolutions_per_s"]
    rate = pulse_rate(min(folder.glob("*.laz")))
    away, turned = plate_distances(cloud, truth)
    return [
        f"{cloud.label.size:,}",
        f"{1e6 * (rate / true_rate - 1):+.0f}",
        f"{density_share(cloud, folder, options):.3f}",
        curb_heights(cloud, truth).cell(1000),
        trunk_diameters(cloud, truth).cell(1000),
        away.cell(1000),
        turned.cell(1),
    ]


def _members(path: Path) -> _Members:
    members: _Members = json.loads(path.read_text("utf-8"))["features"]
    return members


def _facts(member: dict[str, Any]) -> dict[str, Any]:
    facts: dict[str, Any] = member["properties"]
    return facts


def _line(member: dict[str, Any]) -> Floats:
    return np.array(member["geometry"]["coordinates"], np.float64)


def _at(line: Floats, along: Floats, middle: float) -> Floats:
    return np.array([np.interp(middle, along, axis) for axis in line.T])


def _step_error(xyz: Floats, high: Floats, low: Floats, position: Floats) -> float | None:
    """Measured less true height of the step within 25 cm of a place of the upper edge."""
    nearest = low[np.argmin(np.hypot(*(low[:, :2] - position[:2]).T))]
    behind = int(np.argmin(np.hypot(*(high[:, :2] - position[:2]).T)))
    way = high[min(behind + 1, len(high) - 1)] - high[max(behind - 1, 0)]
    way = way[:2] / np.linalg.norm(way[:2])
    aside = np.array([-way[1], way[0]])
    if (nearest[:2] - position[:2]) @ aside > 0:
        aside = -aside  # away from the road
    span = np.searchsorted(xyz[:, 0], [position[0] - 1, position[0] + 1])
    own = xyz[span[0] : span[1]]
    along, across = (own[:, :2] - position[:2]) @ way, (own[:, :2] - position[:2]) @ aside
    foot = float((nearest[:2] - position[:2]) @ aside)
    is_near = (np.abs(along) < _BESIDE_M) & (np.abs(own[:, 2] - position[2]) < 0.5)
    profile = np.column_stack([across, own[:, 2]])
    top = profile[is_near & (across > 0.03) & (across < _STONE_M)]
    road = profile[is_near & (across < foot - 0.02) & (across > foot - _STONE_M)]
    if min(len(top), len(road)) < _FEWEST_POINTS:
        return None
    return float(_level(top, 0.0) - _level(road, foot) - (position[2] - nearest[2]))


def _level(profile: Floats, across: float) -> float:
    """Height of a surface at an edge, from the slope of its points beside it."""
    return float(np.polyval(np.polyfit(profile[:, 0], profile[:, 1], 1), across))


def _circle_diameter(ring: Floats) -> float:
    """The circle nearest to points in the plane (Kåsa's fit), then without the farthest."""
    for _ in range(3):
        matrix = np.column_stack([2 * ring, np.ones(len(ring))])
        answer, *_ = np.linalg.lstsq(matrix, (ring**2).sum(axis=1), rcond=None)
        centre, radius = answer[:2], np.sqrt(max(0.0, answer[2] + answer[:2] @ answer[:2]))
        off = np.abs(np.hypot(*(ring - centre).T) - radius)
        ring = ring[off <= max(3 * np.median(off), 1e-4)]
    return float(2 * radius)


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
