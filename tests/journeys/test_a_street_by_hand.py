"""A whole street by hand: curbs, signs, trees; undone, redone, reopened; judged by the export."""

from __future__ import annotations

from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtCore import Qt
from scipy.spatial import cKDTree

from processing.project.export import ExportRequest
from tests.journeys.conftest import Surveyor
from tests.journeys.hand_at_street import Hand, TrueStreet

TRUTH = TrueStreet.read(Path(__file__).with_name("sample_street_truth.json"))
LONG_M = 5.0
METRES_AN_ACTION = 5.0 / 1.0


def _length(line) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def _off(places, line):
    """(n,) distances of places from a line, m."""
    begins, ways = line[:-1], np.diff(line, axis=0)
    offset = places[:, None] - begins
    share = np.clip((offset * ways).sum(-1) / (ways**2).sum(-1), 0.0, 1.0)
    return np.linalg.norm(offset - share[..., None] * ways, axis=-1).min(axis=1)


def _nearest(drive, place) -> int:
    xyz = drive.xyz(slice(0, drive.count))
    return int(cKDTree(xyz).query(place)[1])


def _on_plate(drive, centre, facing_deg) -> int:
    """The measured point of a plate nearest to its middle."""
    xyz = drive.xyz(slice(0, drive.count))
    facing = np.radians(facing_deg)
    normal = np.array([np.sin(facing), np.cos(facing), 0.0])
    off = xyz - centre
    cost = np.where(np.abs(off @ normal) < 0.03, np.linalg.norm(off, axis=1), np.inf)
    return int(np.argmin(cost))


def _on_trunk(drive, foot, dbh_m) -> int:
    """A measured point low on a trunk."""
    xyz = drive.xyz(slice(0, drive.count))
    off = xyz - foot
    axis = np.hypot(off[:, 0], off[:, 1])
    low = (off[:, 2] > 0.15) & (off[:, 2] < 1.2) & (np.abs(axis - dbh_m / 2) < 0.03)
    cost = np.where(low, off[:, 2], np.inf)
    return int(np.argmin(cost))


def _draw(hand: Hand) -> list[tuple[str, object]]:
    """Draw the street; gives what each feature should be, in the order of drawing."""
    wanted: list[tuple[str, object]] = []
    keys = {kind.id: kind.key for kind in hand.parts.document.catalogue()}
    curbs = [one for one in TRUTH.curbs if _length(one[2]) >= LONG_M]
    for name, kind, line in sorted(curbs, key=lambda one: one[0]):
        drive = hand.drive(name)
        since = hand.actions
        hand.trace(drive, keys[kind], _nearest(drive, line[0]), _nearest(drive, line[-1]))
        hand.note("curbs", since)
        wanted.append((kind, line))
    since = hand.actions
    for name, centre, size_m, facing_deg in TRUTH.signs[:3]:
        drive = hand.drive(name)
        hand.put_point(drive, "sign", [_on_plate(drive, centre, facing_deg)])
        wanted.append(("sign", (centre, size_m, facing_deg)))
    hand.note("signs", since)
    since = hand.actions
    for name, foot, dbh_m in TRUTH.trees:
        drive = hand.drive(name)
        hand.put_point(drive, "street_tree", [_on_trunk(drive, foot, dbh_m)])
        wanted.append(("street_tree", (foot, dbh_m)))
    hand.note("trees", since)
    return wanted


def _exported(surveyor: Surveyor, folder: Path):
    """Vertices of lines and places of points in the DXF, by layer."""
    request = ExportRequest(("dxf",), folder, "ja", "R2018", "utf-8", candidates=False)
    surveyor.wait_for_job(lambda: surveyor.document.export(request))
    (path,) = folder.glob("*.dxf")
    space = ezdxf.readfile(path).modelspace()
    lines = [
        (one.dxf.layer, np.array([tuple(v.dxf.location) for v in one.vertices]))
        for one in space.query("POLYLINE")
    ]
    points = [(one.dxf.layer, np.array([tuple(one.dxf.location)])) for one in space.query("POINT")]
    return lines, points


def _right(kind: str, truth, places) -> bool:
    """Whether a drawn feature is where the true one is, within 3 cm."""
    if kind.startswith("curb"):
        return bool((_off(places, truth) < 0.03).all())
    if kind == "sign":
        centre, size_m, facing_deg = truth
        facing = np.radians(facing_deg)
        normal = np.array([np.sin(facing), np.cos(facing), 0.0])
        off = places[0] - centre
        return abs(off @ normal) < 0.03 and np.linalg.norm(off) < size_m / 2
    foot, dbh_m = truth
    away = np.hypot(*(places[0] - foot)[:2])
    return abs(away - dbh_m / 2) < 0.03


@pytest.fixture
def street(surveyor: Surveyor, tmp_path: Path) -> Surveyor:
    surveyor.import_sample_street(tmp_path / "通り.zuka")
    surveyor.key(Qt.Key.Key_Home)
    return surveyor


def test_a_street_is_drawn_undone_redone_and_exported(
    street: Surveyor, tmp_path: Path, record_property
) -> None:
    hand = Hand(street.bot, street.parts)
    wanted = _draw(hand)
    features = {feature.id: feature for feature in street.document.features()}
    assert len(features) == len(wanted)

    lines, points = _exported(street, tmp_path / "out")
    catalogue = street.document.catalogue()
    for kind, truth in wanted:
        drawn = lines if kind.startswith("curb") else points
        layer = catalogue[kind].layer
        mine = [places for of, places in drawn if of == layer]
        assert any(_right(kind, truth, places) for places in mine), kind

    metres = sum(_length(line) for kind, line in wanted if kind.startswith("curb"))
    record_property("actions", str(hand.counted))
    record_property("curb_metres_an_action", metres / hand.counted["curbs"])

    control = Qt.KeyboardModifier.ControlModifier
    for _ in wanted:
        hand.key(Qt.Key.Key_Z, control)
    assert not list(street.document.features())
    for _ in wanted:
        hand.key(Qt.Key.Key_Y, control)
    assert {feature.id: feature for feature in street.document.features()} == features

    folder = street.document.project.folder
    street.document.close()
    assert street.document.open(folder)
    assert {feature.id: feature for feature in street.document.features()} == features
    for _ in wanted:
        hand.key(Qt.Key.Key_Z, control)
    assert not list(street.document.features())
