"""How well a template that was drawn once follows the true curbs of a street.

``python -m processing.laboratory.accuracy.template_accuracy STREET_FOLDER… [--trajectory]`` imports
every LAZ file of a street to a temporary place and writes one Markdown table. In the middle of each
true curb longer than 10 m a template is drawn from the true profile, as an operator draws it in a
section, and fitted from there along the whole street. A street is a folder with LAZ files,
``trajectory.csv`` and ``truth/curbs.geojson``.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.trajectories.trajectory_csv import read_trajectory_csv
from processing.laboratory.accuracy.trace_accuracy import (
    STEP_M,
    TrueLine,
    densely,
    has_points_on,
    off_polyline,
    read_true_lines,
)
from processing.methods.templates.fit import FitSettings, fit_along, fit_at
from processing.methods.templates.fitted_lines import FittedLine, fitted_lines
from processing.methods.templates.profile_template import MadeLine, ProfileTemplate
from processing.methods.templates.slab import SectionFrame
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.vehicle_path.trajectory import Trajectory

_EDGES = ("upper", "lower")
_LONGER_THAN_M = 10.0
_LEAST_SEEN_M = 2.0
_FOUND_M, _FALSE_M = 0.03, 0.10
_BESIDE_M = 0.25
"""So much of sidewalk and road is drawn with the curb."""
_GROUND_M = (0.40, 0.04, 0.10)
"""Points this near along, across and in height say where the ground is."""
_FEWEST = 3
_HEADINGS = (
    "street",
    "drive",
    "side",
    "starts",
    "true edges seen",
    "found, median (least)",
    "median off",
    "drawn",
    "> 3 cm off",
    "> 10 cm off",
    "CPU per 100 m",
)


@dataclass(frozen=True)
class TemplateOrigin:
    """Where a template is drawn.

    Attributes
    ----------
    template : ProfileTemplate
        Its anchor is the upper edge.
    frame : SectionFrame
        On the true upper edge, looking as the vehicle does.
    side : float
        1 right of the vehicle, −1 left of it.
    """

    template: ProfileTemplate
    frame: SectionFrame
    side: float


@dataclass(frozen=True)
class TemplateScore:
    """What one start gave, upper and lower edge together.

    Attributes
    ----------
    found : float
        Share of the side's seen true edges within 3 cm of the drawn lines.
    median_off_m : float
        Of what was found.
    drawn_m, off_m, false_m : float
        Length of the drawn lines; of it farther than 3 cm and than 10 cm from any true edge of
        that name, dropped and unseen ones included.
    cpu_s, walked_m : float
    """

    found: float
    median_off_m: float
    drawn_m: float
    off_m: float
    false_m: float
    cpu_s: float
    walked_m: float


class CurbStreet:
    """A drive beside true curbs.

    Parameters
    ----------
    drive : Drive
    lines : list of TrueLine
    way : Trajectory
        Tells left from right and in which direction a section is looked at.
    """

    def __init__(self, drive: Drive, lines: list[TrueLine], way: Trajectory) -> None:
        self._drive = drive
        self._xyz = drive.xyz(slice(0, drive.count))
        self._way = way
        self._settings = FitSettings()
        tree = cKDTree(self._xyz)
        self._curbs = [line for line in lines if line.kind == "curb" and line.edge in _EDGES]
        self._seen = [has_points_on(tree, line.xyz) & line.is_covered for line in self._curbs]
        self._sides = [self._side_of(line.xyz[len(line.xyz) // 2]) for line in self._curbs]
        self._edges = {
            edge: np.vstack([line.xyz for line in lines if line.edge == edge]) for edge in _EDGES
        }
        self._trees = {edge: cKDTree(positions) for edge, positions in self._edges.items()}

    def starts(self) -> list[TemplateOrigin]:
        """One in the middle of what is seen of each curb longer than 10 m, 2 m of it at least."""
        found = []
        for line, is_seen, side in zip(self._curbs, self._seen, self._sides, strict=True):
            positions = np.flatnonzero(is_seen)
            is_long = len(line.xyz) * STEP_M > _LONGER_THAN_M
            if line.edge == "upper" and is_long and positions.size * STEP_M >= _LEAST_SEEN_M:
                position = line.xyz[positions[positions.size // 2]]
                frame = SectionFrame(position, self._heading_at(position))
                found.append(
                    TemplateOrigin(self._template_at(frame), frame, math.copysign(1.0, side))
                )
        return found

    def true_m(self, side: float) -> float:
        """Length of the seen true edges of one side of the vehicle."""
        return sum(len(positions) for positions in self._seen_edges(side).values()) * STEP_M

    def away_m(self, side: float) -> float:
        """How far from the vehicle's path the curbs of one side are, in the median."""
        return float(np.median([abs(one) for one in self._sides if one * side > 0]))

    def follow(self, start: TemplateOrigin) -> TemplateScore:
        """Fit a template from where it was drawn and compare the lines with the truth.

        Raises
        ------
        Unsuitable
            It is refused.
        """
        monitor = SilentMonitor()
        # What is loaded and compiled once is no part of the time.
        fit_at(self._drive, start.template, start.frame, self._settings)
        began = time.process_time()
        walk = fit_along(self._drive, start.template, start.frame, self._settings, monitor)
        drawn = fitted_lines(self._drive, walk, self._settings, monitor)
        cpu_s = time.process_time() - began
        walked_m = float(np.linalg.norm(np.diff(walk.positions, axis=0), axis=1).sum())
        missed, off = self._distances(drawn, start.side)
        is_found = missed <= _FOUND_M
        return TemplateScore(
            found=float(is_found.mean()),
            median_off_m=float(np.median(missed[is_found])) if is_found.any() else math.nan,
            drawn_m=off.size * STEP_M,
            off_m=float((off > _FOUND_M).sum()) * STEP_M,
            false_m=float((off > _FALSE_M).sum()) * STEP_M,
            cpu_s=cpu_s,
            walked_m=walked_m,
        )

    def _distances(self, drawn: tuple[FittedLine, ...], side: float) -> tuple[Floats, Floats]:
        """Of true places from the drawn lines, and of drawn places from the true edges, m."""
        missed, off = [], [np.empty(0)]
        for edge, true in self._seen_edges(side).items():
            lines = [line.xyz for line in drawn if line.edge == edge]
            far = np.full(len(true), np.inf)
            missed.append(np.min([far, *(off_polyline(true, line) for line in lines)], axis=0))
            off += [np.asarray(self._trees[edge].query(densely(line)[0])[0]) for line in lines]
        return np.concatenate(missed), np.concatenate(off)

    def _seen_edges(self, side: float) -> dict[str, Floats]:
        """The places of the seen true edges of one side, upper and lower."""
        curbs = list(zip(self._curbs, self._seen, self._sides, strict=True))
        return {
            edge: np.vstack(
                [np.empty((0, 3))]
                + [
                    line.xyz[is_seen]
                    for line, is_seen, own in curbs
                    if line.edge == edge and own * side > 0
                ]
            )
            for edge in _EDGES
        }

    def _nearest_record(self, position: Floats) -> int:
        away = self._way.xyz[:, :2] - position[:2]
        return int((away**2).sum(axis=1).argmin())

    def _heading_at(self, position: Floats) -> float:
        """Where the vehicle looked beside a place, counter-clockwise from the easting, rad."""
        azimuth = float(self._way.roll_pitch_heading_deg[self._nearest_record(position), 2])
        return math.radians(90.0 - azimuth)

    def _side_of(self, position: Floats) -> float:
        """How far a place is to the right of the vehicle's path, m."""
        beside = SectionFrame(
            self._way.xyz[self._nearest_record(position)], self._heading_at(position)
        )
        return float((position - beside.position) @ beside.right)

    def _template_at(self, frame: SectionFrame) -> ProfileTemplate:
        """Sidewalk, face and road as they are there, rounded to millimetres."""
        edge = self._edges["lower"][self._trees["lower"].query(frame.position)[1]] - frame.position
        low = round(float(edge @ frame.right), 3), round(float(edge[2]), 3)
        beside = math.copysign(_BESIDE_M, low[0])
        road = round(low[0] + beside, 3)
        shape = (
            (-beside, self._ground(frame, -beside, 0.0)),
            (0.0, 0.0),
            low,
            (road, self._ground(frame, road, low[1])),
        )
        return ProfileTemplate("curb", (shape,), (MadeLine("curb"), MadeLine("curb", low)))

    def _ground(self, frame: SectionFrame, offset: float, height: float) -> float:
        """Median height of the points beside the curb; level where there are none."""
        away = self._xyz - frame.position
        along, across = away @ frame.along, away @ frame.right - offset
        near = np.abs(np.column_stack([along, across, away[:, 2] - height])) < _GROUND_M
        heights = away[near.all(axis=1), 2]
        return height if heights.size < _FEWEST else round(float(np.median(heights)), 3)


def main(arguments: list[str]) -> int:
    """Score the streets named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("streets", nargs="+", type=Path)
    parser.add_argument("--trajectory", action="store_true", help="import with trajectory.csv")
    chosen = parser.parse_args(arguments)
    sys.stdout.write(f"| {' | '.join(_HEADINGS)} |\n{'|---' * len(_HEADINGS)}|\n")
    for street in chosen.streets:
        lines = read_true_lines(street / "truth" / "curbs.geojson")
        for cloud in sorted(street.glob("*.laz")):
            for row in _rows_of(cloud, lines, is_with_trajectory=chosen.trajectory):
                sys.stdout.write(f"| {street.name} | {cloud.stem} | {row} |\n")
                sys.stdout.flush()
    return 0


def _rows_of(cloud: Path, lines: list[TrueLine], *, is_with_trajectory: bool) -> Iterator[str]:
    way = cloud.with_name("trajectory.csv")
    with tempfile.TemporaryDirectory(prefix="zuka-score-") as name:
        request = ImportRequest((cloud,), (way,) if is_with_trajectory else ())
        for folder in import_drives(request, Path(name) / "drives", SilentMonitor()):
            street = CurbStreet(Drive(folder), lines, read_trajectory_csv(way))
            starts = street.starts()
            sides = sorted({start.side for start in starts}, key=street.away_m)
            for which, side in zip(("near", "far"), sides, strict=False):
                of_side = [start for start in starts if start.side == side]
                yield f"{which}, {street.away_m(side):.1f} m | {_measure_side(street, of_side)}"


def _measure_side(street: CurbStreet, starts: list[TemplateOrigin]) -> str:
    """The cells of one side of the vehicle."""
    followed = []
    for start in starts:
        try:
            followed.append(street.follow(start))
        except Unsuitable:
            continue
    true_m = street.true_m(starts[0].side)
    asked = f"{len(starts)}, {len(starts) - len(followed)} refused | {true_m:.0f} m"
    if not followed:
        return asked + " | –" * 6
    least = min(one.found for one in followed)
    walked_m = sum(one.walked_m for one in followed)
    cpu_s = 100 * sum(one.cpu_s for one in followed) / walked_m

    def median(field: str) -> float:
        return float(np.nanmedian([getattr(one, field) for one in followed]))

    found, off = 100 * median("found"), 1000 * median("median_off_m")
    return (
        f"{asked} | {found:.1f} % ({100 * least:.1f} %) | {off:.1f} mm "
        f"| {median('drawn_m'):.0f} m | {median('off_m'):.1f} m | {median('false_m'):.1f} m "
        f"| {cpu_s:.2f} s"
    )


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
