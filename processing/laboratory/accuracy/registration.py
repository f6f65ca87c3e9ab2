"""How near registered drives come to each other and to the truth, on streets whose truth is known.

``python -m processing.laboratory.accuracy.registration STREET_FOLDER…``

A street folder holds LAZ files, a trajectory for each pass, ``control_points.csv`` and among its
truth ``NAME.delta.npy``: true minus delivered place of each point, in tenths of a millimetre. Both
the program's own simulator and other deliveries give that.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.survey.control_points import read_control_points
from processing.methods.registration.control_points import ControlPoint, Role
from processing.methods.registration.registration import SurveyRegistration, register_drives
from processing.methods.registration.summary import sureness
from processing.methods.registration.visits import REACH_M
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.drive import Drive

_DELTA_M = 1e-4
_MILLIMETRES = 1000.0
_EVERY = 7
_CHECKED = 2
"""Every so many control points of a file without roles are check points."""

_HEAD = (
    "| street | control | between passes before | after | between heads before | after "
    "| to the truth, plan before | after | stated | height before | after | stated |"
)


@dataclass(frozen=True, eq=False)
class _Truth:
    """Of one drive: places of some points, and how far those are delivered from where they are."""

    tree: cKDTree
    xyz: Floats
    time: Floats
    delta: Floats


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("streets", nargs="+", type=Path)
    given = parser.parse_args(arguments)
    print(_HEAD)  # noqa: T201  # what a table of accuracy is for
    print("|" + "---|" * (_HEAD.count("|") - 1))  # noqa: T201
    for street in given.streets:
        for line in _street_lines(street):
            print(line, flush=True)  # noqa: T201
    return 0


def _street_lines(street: Path) -> list[str]:
    points = tuple(sorted(street.glob("*.laz")))
    trajectories = tuple(
        path for path in sorted(street.glob("*.csv")) if path.stem.startswith(("pass", "traj"))
    )
    control = _with_roles(read_control_points(street / "control_points.csv"))
    with TemporaryDirectory() as folder:
        request = ImportRequest(points, trajectories)
        folders = import_drives(request, Path(folder) / "drives", SilentMonitor())
        drives = [Drive(path) for path in folders]
        truths = [_truth_of(drive, street) for drive in drives]
        lines = []
        for name, used in (("none", ()), (str(_used(control)), control)):
            found = register_drives(drives, used, SilentMonitor())
            lines.append(_line(street.name, name, found, truths))
    return lines


def _with_roles(control: Sequence[ControlPoint]) -> tuple[ControlPoint, ...]:
    if any(one.role is Role.CHECK for one in control):
        return tuple(control)
    return tuple(
        replace(one, role=Role.CHECK if number % _CHECKED else Role.CONTROL)
        for number, one in enumerate(control)
    )


def _used(control: Sequence[ControlPoint]) -> int:
    return sum(one.role is Role.CONTROL for one in control)


def _truth_of(drive: Drive, street: Path) -> _Truth:
    some = np.arange(0, drive.count, _EVERY)
    _, rows = drive.sources(0, drive.count)
    delta = np.load(street / "truth" / f"{Path(drive.info.sources[0].path).stem}.delta.npy")
    xyz = drive.xyz(some)
    time = np.asarray(drive.columns["time"])[some]
    return _Truth(cKDTree(xyz), xyz, time, delta[rows[some]] * _DELTA_M)


def _line(street: str, control: str, found: SurveyRegistration, truths: Sequence[_Truth]) -> str:
    cells = [street, control]
    for of_heads in (False, True):
        before, after = _between(found, truths, of_heads=of_heads)
        cells += [_spread(before), _spread(after)]
    before, after = _to_truth(found, truths)
    stated = sureness(found)
    plan = float(np.sqrt(np.mean([one.plan_m**2 for one in stated])))
    height = float(np.sqrt(np.mean([one.height_m**2 for one in stated])))
    for axes, sigma in ((slice(0, 2), plan), (slice(2, 3), height)):
        cells += [_rms(before[:, axes]), _rms(after[:, axes]), f"{sigma * _MILLIMETRES:.1f}"]
    return "| " + " | ".join(cells) + " |"


def _between(
    found: SurveyRegistration, truths: Sequence[_Truth], *, of_heads: bool
) -> tuple[Floats, Floats]:
    """How far two visits lie from each other in space, at all places in common, by the truth."""
    survey, ties = found.survey, found.ties
    track = np.array([survey.track_of(number) for number in range(len(survey.drives))])
    is_one = (track[ties.drive[:, 0]] == track[ties.drive[:, 1]]) & (
        ties.drive[:, 0] != ties.drive[:, 1]
    )
    ties = ties.chosen(is_one == of_heads)
    before, after = np.zeros((len(ties), 3)), np.zeros((len(ties), 3))
    for side, sign in ((0, 1.0), (1, -1.0)):
        for number, truth in enumerate(truths):
            mine = np.flatnonzero(ties.drive[:, side] == number)
            if not mine.size:
                continue
            places = ties.xyz[mine, side] + survey.origin
            _, near = truth.tree.query(places)
            delta = truth.delta[near]
            moved = found.corrections[number].shifts(truth.time[near], truth.xyz[near])
            before[mine] += sign * delta
            after[mine] += sign * (delta - moved)
    return np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)


def _to_truth(found: SurveyRegistration, truths: Sequence[_Truth]) -> tuple[Floats, Floats]:
    """What points within reach are off, before and after: (n, 3) m."""
    before, after = [], []
    for correction, truth in zip(found.corrections, truths, strict=True):
        at, _ = correction.track.places(truth.time)
        near = np.linalg.norm(truth.xyz - at, axis=1) < REACH_M
        moved = correction.shifts(truth.time[near], truth.xyz[near])
        before.append(truth.delta[near])
        after.append(truth.delta[near] - moved)
    return np.concatenate(before), np.concatenate(after)


def _spread(gaps: Floats) -> str:
    if not gaps.size:
        return "–"
    middle, most = np.median(gaps), np.percentile(gaps, 95)
    return f"{middle * _MILLIMETRES:.1f} / {most * _MILLIMETRES:.1f}"


def _rms(off: Floats) -> str:
    return f"{float(np.sqrt((off**2).sum(axis=1).mean())) * _MILLIMETRES:.1f}"


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
