"""A whole street by hand: curbs, signs, trees; undone, redone, reopened; judged by the export."""

from __future__ import annotations

import os
import sys
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtCore import Qt
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.operations.export import ExportRequest
from processing.project.importing.dropped_files import request_of_files
from processing.recording.drive import Drive
from tests.journeys.conftest import Surveyor
from tests.journeys.true_street import TrueStreet
from tests.journeys.window_user import WindowUser

OTHER = os.environ.get("ZUKA_STREET", "")
"""A folder with left.laz, right.laz, trajectory.csv and truth/, to be drawn instead."""

CLICKED_M = 0.03
METRES_AN_ACTION = 4.5
"""So much of curb edges each click or key draws, on a street of only 40 m; 120 m: 6.7 m."""
FOLLOWED_SHARE = 0.7
"""Of the true edges within 3 cm of what was drawn, lowered stretches and hidden ones included."""

CONTROL = Qt.KeyboardModifier.ControlModifier


def _length(line: Floats) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def _off(positions: Floats, line: Floats) -> Floats:
    """(n,) distances of places from a line, m."""
    begins, ways = line[:-1], np.diff(line, axis=0)
    offset = positions[:, None] - begins
    squares = np.maximum((ways**2).sum(-1), 1e-12)
    share = np.clip((offset * ways).sum(-1) / squares, 0.0, 1.0)
    return np.linalg.norm(offset - share[..., None] * ways, axis=-1).min(axis=1)


def _nearest(drive: Drive, position: Floats) -> int:
    return int(cKDTree(drive.xyz(slice(0, drive.count))).query(position)[1])


def _off_plate(positions: Floats, centre: Floats, facing_deg: float) -> Floats:
    """How far places lie before or behind a plate."""
    facing = np.radians(facing_deg)
    return np.abs((positions - centre) @ np.array([np.sin(facing), np.cos(facing), 0.0]))


def _on_plate(drive: Drive, centre: Floats, facing_deg: float) -> int:
    """The measured point of a plate nearest to its middle."""
    xyz = drive.xyz(slice(0, drive.count))
    is_on = _off_plate(xyz, centre, facing_deg) < CLICKED_M
    return int(np.argmin(np.where(is_on, np.linalg.norm(xyz - centre, axis=1), np.inf)))


def _off_trunk(positions: Floats, foot: Floats, dbh_m: float) -> Floats:
    """How far places lie from the bark of a trunk."""
    return np.abs(np.hypot(*(positions - foot)[:, :2].T) - dbh_m / 2)


def _on_trunk(drive: Drive, foot: Floats, dbh_m: float) -> int:
    """The lowest measured point of a trunk above its foot."""
    xyz = drive.xyz(slice(0, drive.count))
    above = xyz[:, 2] - foot[2]
    is_low = (above > 0.15) & (above < 1.2) & (_off_trunk(xyz, foot, dbh_m) < CLICKED_M)
    return int(np.argmin(np.where(is_low, above, np.inf)))


def _draw_curbs(user: WindowUser, truth: TrueStreet) -> list[tuple[str, tuple[Floats, ...]]]:
    keys = {kind.id: kind.key for kind in user.parts.document.catalogue()}
    drawn = []
    for name, kind, pieces in sorted(truth.curbs, key=lambda one: one[0]):
        drive, since = user.drive(name), user.actions
        user.trace(
            drive, keys[kind], _nearest(drive, pieces[0][0]), _nearest(drive, pieces[-1][-1])
        )
        user.note("curbs", since)
        drawn.append((kind, pieces))
    return drawn


def _draw_points(user: WindowUser, truth: TrueStreet) -> None:
    since = user.actions
    for name, centre, _, facing_deg in truth.signs[:3]:
        drive = user.drive(name)
        user.put_point(drive, "sign", _on_plate(drive, centre, facing_deg))
    user.note("signs", since)
    since = user.actions
    for name, foot, dbh_m in truth.trees[:10]:
        drive = user.drive(name)
        user.put_point(drive, "street_tree", _on_trunk(drive, foot, dbh_m))
    user.note("trees", since)


def _exported(surveyor: Surveyor, folder: Path) -> dict[str, list[Floats]]:
    """Vertices of what stands on each layer of the exported drawing."""
    request = ExportRequest(("dxf",), folder, "ja")
    surveyor.wait_for_job(lambda: surveyor.document.export(request))
    (path,) = folder.glob("*.dxf")
    space = ezdxf.readfile(path).modelspace()
    found: dict[str, list[Floats]] = {}
    for line in space.query("POLYLINE"):
        positions = np.array([tuple(vertex.dxf.location) for vertex in line.vertices])
        found.setdefault(line.dxf.layer, []).append(positions)
    for symbol in space.query("INSERT"):
        found.setdefault(symbol.dxf.layer, []).append(np.array([tuple(symbol.dxf.insert)]))
    return found


@pytest.fixture
def truth() -> TrueStreet:
    if not OTHER:
        return TrueStreet.read(Path(__file__).with_name("sample_street_truth.json"))
    folder = Path(OTHER)
    clouds = {path.stem: path for path in folder.glob("*.laz")}
    return TrueStreet.seen_in(clouds, folder / "truth")


@pytest.fixture
def street(surveyor: Surveyor, tmp_path: Path) -> Surveyor:
    if OTHER:
        files = (*Path(OTHER).glob("*.laz"), Path(OTHER) / "trajectory.csv")
        assert surveyor.document.create(tmp_path / "通り.zuka", "")
        request = request_of_files(files, "")
        surveyor.wait_for_job(lambda: surveyor.document.import_files(request))
    else:
        surveyor.import_sample_street(tmp_path / "通り.zuka")
    surveyor.key(Qt.Key.Key_Home)
    return surveyor


def test_a_street_is_drawn_undone_redone_and_exported(
    street: Surveyor, truth: TrueStreet, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    user = WindowUser(street.bot, street.parts)
    curbs = _draw_curbs(user, truth)
    _draw_points(user, truth)
    features = {feature.id: feature for feature in street.document.features()}
    count = len(curbs) + 3 + len(truth.trees[:10])
    assert len(features) == count

    layers = {kind.id: kind.layer for kind in street.document.catalogue()}
    drawing = _exported(street, tmp_path / "out")
    _check_curbs(curbs, {kind: drawing[layers[kind]] for kind, _ in curbs})
    signs, trees = (np.concatenate(drawing[layers[kind]]) for kind in ("sign", "street_tree"))
    for _, centre, size_m, facing_deg in truth.signs[:3]:
        away = np.linalg.norm(signs - centre, axis=1)
        assert _off_plate(signs[[away.argmin()]], centre, facing_deg)[0] < CLICKED_M
        assert away.min() < size_m / 2
    for _, foot, dbh_m in truth.trees[:10]:
        assert _off_trunk(trees, foot, dbh_m).min() < CLICKED_M

    metres = sum(_length(piece) for _, pieces in curbs for piece in pieces)
    with capsys.disabled():
        sys.stdout.write(f"\n{user.counted}, {metres:.0f} m of curb edges\n")
    assert metres / user.counted["curbs"] >= METRES_AN_ACTION, user.counted
    _go_back_and_forth(user, street, features)


def _check_curbs(
    curbs: list[tuple[str, tuple[Floats, ...]]], drawn: dict[str, list[Floats]]
) -> None:
    """Every line is there: its clicked ends on an edge to 3 cm, most of it on its own edge."""
    edges = [_longer(np.concatenate(pieces)) for _, pieces in curbs]
    near, total = 0.0, 0.0
    for kind, pieces in curbs:
        start, end = pieces[0][0], pieces[-1][-1]
        line = min(drawn[kind], key=lambda positions: _off(np.array([start, end]), positions).sum())
        # At a lowered curb both edges are 3 cm apart: which one is clicked can't be told there.
        off_ends = np.min([_off(line[[0, -1]], edge) for edge in edges], axis=0)
        assert off_ends.max() < CLICKED_M, kind
        assert _off(np.array([start, end]), line).max() < 0.5, kind
        dense = [np.linspace(a, b, 20) for piece in pieces for a, b in pairwise(piece)]
        off = _off(np.concatenate(dense), line)
        near, total = near + (off < CLICKED_M).sum(), total + off.size
    assert near / total > FOLLOWED_SHARE


def _longer(line: Floats) -> Floats:
    """A line a step longer at both ends: a click may land on the edge beyond what was aimed at."""
    return np.concatenate([2 * line[:1] - line[1:2], line, 2 * line[-1:] - line[-2:-1]])


def _go_back_and_forth(user: WindowUser, street: Surveyor, features: dict[str, object]) -> None:
    """All is undone, redone, and after a restart undone again."""
    document = street.document
    for _ in features:
        user.key(Qt.Key.Key_Z, CONTROL)
    assert not list(document.features())
    for _ in features:
        user.key(Qt.Key.Key_Y, CONTROL)
    assert {feature.id: feature for feature in document.features()} == features
    folder = document.project.folder
    document.close()
    assert document.open(folder)
    assert {feature.id: feature for feature in document.features()} == features
    for _ in features:
        user.key(Qt.Key.Key_Z, CONTROL)
    assert not list(document.features())
