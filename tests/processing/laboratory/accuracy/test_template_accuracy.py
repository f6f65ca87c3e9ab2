"""Templates that follow curbs are scored against edges that are known by construction."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.formats.trajectories.trajectory_csv import read_trajectory_csv
from processing.laboratory.accuracy.template_accuracy import CurbStreet, main
from processing.laboratory.accuracy.trace_accuracy import read_true_lines
from processing.recording.drive import Drive
from tests.processing.methods.templates.curb_street import (
    LENGTH_M,
    LOW_M,
    TOP_M,
    frame_at,
    recorded,
)
from tests.street_scene import CURB_AT_M, CURB_HEIGHT_M

LEFT, RIGHT = -1.0, 1.0
FROM_M, TO_M = 7.0, LENGTH_M - 7.0
BEFORE_M, BEYOND_M = -5.0, LENGTH_M + 5.0  # farther than anything is recorded
VEHICLE_AT_M = 0.5


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return recorded(tmp_path_factory.mktemp("street"))


def curb(
    start: float,
    end: float,
    *,
    across: float = CURB_AT_M,
    top: float = TOP_M,
    kind: str = "curb",
    edges: tuple[str, ...] = ("upper", "lower"),
) -> list[dict[str, Any]]:
    """Both true edges of a stretch of curb, as the truth file has them."""
    heights = {"upper": top, "lower": top - CURB_HEIGHT_M}
    sections = [{"u0": 0.0, "u1": 2 * (end - start), "covered": 1.0}]
    return [
        {
            "properties": {"edge": edge, "type": kind, "sections": sections},
            "geometry": {
                "coordinates": [
                    frame_at(along, across, heights[edge]).position.tolist()
                    for along in np.arange(start, end + 0.05, 0.1).tolist()
                ]
            },
        }
        for edge in edges
    ]


def with_truth(drive: Drive, folder: Path, curbs: list[dict[str, Any]]) -> CurbStreet:
    """A recorded street beside curbs that are said to be there."""
    (folder / "curbs.geojson").write_text(json.dumps({"features": curbs}))
    recording = drive.folder.parent.parent
    way = read_trajectory_csv(recording / "trajectory.csv")
    return CurbStreet(drive, read_true_lines(folder / "curbs.geojson"), way)


def test_a_template_drawn_from_the_truth_follows_both_edges_of_its_side(
    street: Drive, tmp_path: Path
) -> None:
    curbs = curb(FROM_M, TO_M) + curb(FROM_M, TO_M, across=-CURB_AT_M)
    truth = with_truth(street, tmp_path, curbs)
    starts = truth.starts()
    assert [start.side for start in starts] == [LEFT, RIGHT]
    for start in starts:
        away_m = CURB_AT_M + start.side * VEHICLE_AT_M
        assert truth.away_m(start.side) == pytest.approx(away_m, abs=0.05)
        followed = truth.follow(start)
        assert followed.found > 0.98
        assert followed.median_off_m < 0.005
        assert followed.drawn_m > 2 * (TO_M - FROM_M)
        assert followed.cpu_s > 0.0
        assert followed.walked_m > TO_M - FROM_M
    inner, outer = (2 * (TO_M - FROM_M) * (1 - at / 60) for at in (CURB_AT_M, -CURB_AT_M))
    assert truth.true_m(LEFT) == pytest.approx(inner, abs=1.0)
    assert truth.true_m(RIGHT) == pytest.approx(outer, abs=1.0)


@pytest.mark.parametrize(("aside_m", "is_false"), [(0.06, False), (0.15, True)])
def test_where_the_truth_lies_aside_of_the_line_the_line_is_off(
    street: Drive, tmp_path: Path, aside_m: float, is_false: bool
) -> None:
    aside = curb(18.0, BEYOND_M, across=CURB_AT_M + aside_m, kind="dropped")
    truth = with_truth(street, tmp_path, curb(BEFORE_M, 18.0) + aside)
    (start,) = truth.starts()
    followed = truth.follow(start)
    right = with_truth(street, tmp_path, curb(BEFORE_M, BEYOND_M))
    whole = right.follow(right.starts()[0])
    assert whole.off_m == 0.0
    # What is drawn of this side until there is as long as what is seen of the truth.
    assert followed.off_m == pytest.approx(whole.drawn_m - truth.true_m(LEFT), abs=2.0)
    assert followed.false_m == (pytest.approx(followed.off_m, abs=1.0) if is_false else 0.0)
    assert followed.found > 0.95


def test_true_edges_that_no_line_reaches_are_not_found(street: Drive, tmp_path: Path) -> None:
    # Of the rest only an upper edge is said to be there, five centimetres too high.
    end = 18.5
    curbs = curb(FROM_M, end) + curb(end, TO_M, top=TOP_M + 0.05, edges=("upper",))
    truth = with_truth(street, tmp_path, curbs)
    followed = truth.follow(truth.starts()[0])
    assert followed.found == pytest.approx(
        2 * (end - FROM_M) / (end - FROM_M + TO_M - FROM_M), abs=0.02
    )
    assert followed.median_off_m < 0.005


def test_templates_start_on_curbs_over_ten_metres_that_this_drive_has_seen(
    street: Drive, tmp_path: Path
) -> None:
    curbs = (
        curb(3.0, 12.5)
        + curb(3.0, 26.0, across=-CURB_AT_M, kind="dropped")
        + curb(3.0, 26.0, across=2.0, top=TOP_M + 3.0)
        + curb(10.0, 24.0)
    )
    (start,) = with_truth(street, tmp_path, curbs).starts()
    assert np.linalg.norm(start.frame.position - frame_at(17.0, CURB_AT_M, TOP_M).position) < 0.1
    low = np.array(start.template.lines[1].at)
    assert np.abs(low - [0.0, LOW_M - TOP_M]).max() <= 0.002
    heights = [position[1] for position in start.template.shape[0]]
    assert heights == pytest.approx([0.0, 0.0, LOW_M - TOP_M, LOW_M - TOP_M + 0.005], abs=0.004)


@pytest.mark.parametrize("flags", [[], ["--trajectory"]])
def test_the_command_writes_a_row_for_each_side_and_counts_what_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], flags: list[str]
) -> None:
    recorded(tmp_path)
    (tmp_path / "truth").mkdir()
    no_curb = curb(FROM_M, TO_M, across=-1.5, top=0.04)
    (tmp_path / "truth" / "curbs.geojson").write_text(
        json.dumps({"features": no_curb + curb(FROM_M, TO_M)})
    )
    assert main([str(tmp_path), *flags]) == 0
    head, line, near, far = (
        [cell.strip() for cell in row.strip("|\n").split("|")]
        for row in capsys.readouterr().out.splitlines()
    )
    assert len(head) == len(line) == len(near) == len(far)
    assert near[:4] == [tmp_path.name, "street", "near, 2.0 m", "1, 1 refused"]
    assert set(near[5:]) == {"–"}
    assert far[:4] == [tmp_path.name, "street", "far, 3.5 m", "1, 0 refused"]
    assert float(far[5].split()[0]) > 98.0


def test_what_is_no_curb_refuses_the_template(street: Drive, tmp_path: Path) -> None:
    truth = with_truth(street, tmp_path, curb(FROM_M, TO_M, across=-1.5, top=0.04))
    (start,) = truth.starts()
    with pytest.raises(Unsuitable, match="doesn't fit"):
        truth.follow(start)
