"""How well snapping and line following find the true curbs of a street.

``python -m processing.laboratory.accuracy.trace_accuracy STREET_FOLDER… [--trajectory]`` imports
every LAZ file of a street to a temporary place and writes one Markdown table. A street is a folder
with LAZ files, ``trajectory.csv`` and ``truth/curbs.geojson``.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.image.edges.edges import edge_beside
from processing.image.tracing.trace import trace
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive

_CLICKS, _ASIDE_PX = 400, 8
_SNAPPED_M, _FOLLOWED_M = 0.02, 0.03
_LEAST_LENGTH_M = 20.0
STEP_M = 0.005
"""True lines are taken so densely that their steps add nothing to a distance."""
_SEEN_M, _SEEN_POINTS = 0.10, 3  # a place is seen where so many points lie so near
_HOLE_M = 1.0
_JOINED_M = 0.6  # curbs and dropped curbs whose ends are this near are one line


@dataclass(frozen=True)
class TrueLine:
    """One edge of one stretch of curb.

    Attributes
    ----------
    edge, kind : str
        ``lower`` or ``upper``; ``curb`` or ``dropped``.
    xyz : (n, 3) float64
        Every 5 mm, m.
    is_covered : (n,) bool
        Whether the truth says that points cover it there.
    """

    edge: str
    kind: str
    xyz: Floats
    is_covered: NDArray[np.bool_]


@dataclass(frozen=True)
class TraceScore:
    """Shares of what was asked, and how long it took.

    Attributes
    ----------
    what : str
    asked : str
        Number of clicks, or metres.
    share : float
    median_off_m : float
    detail : str
    """

    what: str
    asked: str
    share: float
    median_off_m: float
    detail: str


def main(arguments: list[str]) -> int:
    """Score the streets named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("streets", nargs="+", type=Path)
    parser.add_argument("--trajectory", action="store_true", help="import with trajectory.csv")
    chosen = parser.parse_args(arguments)
    sys.stdout.write("| street | drive | what | asked | found | median off | detail |\n")
    sys.stdout.write("|---|---|---|---|---|---|---|\n")
    for street in chosen.streets:
        lines = read_true_lines(street / "truth" / "curbs.geojson")
        for cloud in sorted(street.glob("*.laz")):
            trajectories = (street / "trajectory.csv",) if chosen.trajectory else ()
            for score in _scores_of(cloud, trajectories, lines):
                sys.stdout.write(
                    f"| {street.name} | {cloud.stem} | {score.what} | {score.asked} "
                    f"| {100 * score.share:.1f} % | {1000 * score.median_off_m:.1f} mm "
                    f"| {score.detail} |\n"
                )
    return 0


def read_true_lines(path: Path) -> list[TrueLine]:
    """The edges of a street's curbs, in the order of the file."""
    lines = []
    for feature in json.loads(path.read_text(encoding="utf-8"))["features"]:
        facts = feature["properties"]
        positions, along = densely(np.array(feature["geometry"]["coordinates"], dtype=np.float64))
        is_covered = np.zeros(along.size, np.bool_)
        for section in facts["sections"]:
            inside = (along >= section["u0"]) & (along <= section["u1"])
            is_covered |= inside & (section["covered"] >= 0.9)
        lines.append(TrueLine(facts["edge"], facts["type"], positions, is_covered))
    return lines


def snap_clicks(drive: Drive, lines: list[TrueLine], kind: str) -> TraceScore:
    """Clicks up to 8 pixels beside seen edges of one kind; how near the next edge they land."""
    xyz = drive.xyz(slice(0, drive.count))
    pulses = np.asarray(drive.columns["pulse"])
    tree, edges = cKDTree(xyz), cKDTree(np.vstack([line.xyz for line in lines]))
    of_kind = [line for line in lines if line.kind == kind]
    positions = np.vstack(
        [line.xyz[has_points_on(tree, line.xyz) & line.is_covered] for line in of_kind]
    )
    random = np.random.default_rng(0)
    off: list[float] = []
    seconds: list[float] = []
    while positions.size and len(off) < _CLICKS:
        nearest = int(tree.query(positions[random.integers(len(positions))])[1])
        aside = pulses[nearest] + random.integers(-_ASIDE_PX, _ASIDE_PX + 1)
        click = int(np.searchsorted(pulses, aside))
        if click >= pulses.size or pulses[click] != aside:
            continue
        start = time.thread_time()
        found = edge_beside(drive, click, _ASIDE_PX)
        seconds.append(time.thread_time() - start)
        off.append(np.inf if found is None else float(edges.query(found.xyz)[0]))
    if not off:
        return TraceScore(f"snap, {kind}", "0 clicks", np.nan, np.nan, "not seen")
    offs = np.array(off)
    detail = f"{100 * np.isinf(offs).mean():.1f} % without an edge; "
    detail += (
        f"{1000 * np.median(seconds):.1f} ms, 95 % within {1000 * np.quantile(seconds, 0.95):.1f}"
    )
    share = float((offs <= _SNAPPED_M).mean())
    return TraceScore(f"snap, {kind}", f"{len(off)} clicks", share, float(np.median(offs)), detail)


def follow_lines(drive: Drive, lines: list[TrueLine], what: str) -> TraceScore:
    """Share of the length of lines that a trace between two clicks at their seen ends follows."""
    xyz = drive.xyz(slice(0, drive.count))
    tree = cKDTree(xyz)
    length, good, number, whole, seconds = 0.0, 0.0, 0, 0, 0.0
    off: list[Floats] = []
    for line in lines:
        for stretch in _seen_stretches(has_points_on(tree, line.xyz)):
            wanted = line.xyz[stretch]
            start, end = (int(tree.query(position)[1]) for position in (wanted[0], wanted[-1]))
            began = time.thread_time()
            traced = trace(drive, start, end)
            seconds += time.thread_time() - began
            distances = off_polyline(wanted, traced.xyz)
            length += len(wanted) * STEP_M
            good += float((distances <= _FOLLOWED_M).sum()) * STEP_M
            number, whole = number + 1, whole + int(traced.is_complete)
            off.append(distances)
    if not number:
        return TraceScore(what, "0 m", np.nan, np.nan, "none so long is seen")
    detail = f"{number} lines, {whole} to their end; {100 * seconds / length:.2f} s per 100 m"
    median = float(np.median(np.concatenate(off)))
    return TraceScore(what, f"{length:.0f} m", good / length, median, detail)


def _scores_of(
    cloud: Path, trajectories: tuple[Path, ...], lines: list[TrueLine]
) -> Iterator[TraceScore]:
    with tempfile.TemporaryDirectory(prefix="zuka-score-") as name:
        request = ImportRequest((cloud,), trajectories)
        for folder in import_drives(request, Path(name) / "drives", SilentMonitor()):
            drive = Drive(folder)
            yield snap_clicks(drive, lines, "curb")
            yield snap_clicks(drive, lines, "dropped")
            curbs = [line for line in lines if line.kind == "curb"]
            yield follow_lines(drive, curbs, "trace, curbs of 20 m and more")
            yield follow_lines(drive, _join_lines(lines), "trace, with dropped curbs between")


def _join_lines(lines: list[TrueLine]) -> list[TrueLine]:
    """Stretches of one edge that follow each other, as one line."""
    joined: list[TrueLine] = []
    for edge in ("lower", "upper"):
        begun = False
        for line in (line for line in lines if line.edge == edge):
            last = joined[-1] if begun else None
            if last is not None and np.linalg.norm(last.xyz[-1] - line.xyz[0]) <= _JOINED_M:
                joined[-1] = TrueLine(
                    edge,
                    "joined",
                    np.vstack([last.xyz, line.xyz]),
                    np.concatenate([last.is_covered, line.is_covered]),
                )
            else:
                joined.append(line)
            begun = True
    return [line for line in joined if line.kind == "joined"]


def densely(corners: Floats) -> tuple[Floats, Floats]:
    """Places every 5 mm on a polyline, (n, 3) float64, and how far along it each is, m."""
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    along = np.arange(0.0, ends[-1], STEP_M)
    return np.column_stack([np.interp(along, ends, corners[:, k]) for k in range(3)]), along


def has_points_on(tree: cKDTree, positions: Floats) -> NDArray[np.bool_]:
    """Where this drive, not only the other scanner, has points on the edge."""
    counts = tree.query_ball_point(positions, _SEEN_M, return_length=True)
    return np.asarray(counts >= _SEEN_POINTS)


def _seen_stretches(is_seen: NDArray[np.bool_]) -> list[slice]:
    """Stretches of 20 m and more without a hole of over a metre."""
    seen = np.flatnonzero(is_seen)
    parts = np.split(seen, np.flatnonzero(np.diff(seen) * STEP_M > _HOLE_M) + 1)
    spans = [slice(int(part[0]), int(part[-1]) + 1) for part in parts if part.size]
    return [span for span in spans if (span.stop - span.start) * STEP_M >= _LEAST_LENGTH_M]


def off_polyline(positions: Floats, corners: Floats) -> Floats:
    """(n,) distance of (n, 3) places from a polyline, m; inf where it has no length."""
    if corners.shape[0] < 2:
        return np.full(positions.shape[0], np.inf)
    best = np.full(positions.shape[0], np.inf)
    for start, end in itertools.pairwise(corners):
        span, away = end - start, positions - start
        share = np.clip(away @ span / max(float(span @ span), 1e-12), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(away - share[:, None] * span, axis=1))
    return best


if __name__ == "__main__":
    write_every_character()
    sys.exit(main(sys.argv[1:]))
