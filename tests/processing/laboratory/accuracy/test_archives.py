"""Archives classified as the thesis does: which points, whose truth, what is refused."""

from __future__ import annotations

import shutil
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import UserError
from processing.core.monitor import SilentMonitor
from processing.laboratory.accuracy.archives.archive_classes import main
from processing.laboratory.accuracy.archives.archive_points import (
    ArchiveRequest,
    archive_points,
)
from processing.laboratory.accuracy.archives.chained_classes import INPUTS, scores_of
from processing.laboratory.simulate.flights import simulate_flight
from processing.laboratory.simulate.requests import FlightRequest

_DALES = {2: 1, 11: 1, 4: 2, 5: 2, 6: 8, 14: 5, 15: 7}
_PLY = """ply
format ascii 1.0
element vertex {count}
property double x
property double y
property double z
property int sem_class
end_header
"""


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("flown") / "flight"
    request = FlightRequest(seed=12, style="lines", length_m=40.0, density=1.0)
    simulate_flight(request, folder, SilentMonitor())
    return folder


@pytest.fixture(scope="module")
def labelled(flight: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The flight at a Japanese path, its truth in DALES' codes, and some cars."""
    copy = tmp_path_factory.mktemp("納品") / "航空.las"
    shutil.copyfile(flight / "in" / "flight.wdp", copy.with_suffix(".wdp"))
    las = laspy.read(flight / "in" / "flight.las")
    label = np.load(flight / "truth" / "truth.npz")["label"]
    las.classification = np.array([_DALES.get(int(one), 0) for one in label], np.uint8)
    las.classification[:7] = 3
    las.write(copy)
    return copy


def _rows(words: str) -> list[list[str]]:
    lines = [line for line in words.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]


def test_a_city_is_scored_by_each_input_and_by_the_codes_of_its_truth(
    labelled: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["city", str(labelled), "--density", "0", "--returns", "all"]) == 0
    rows = _rows(capsys.readouterr().out)
    scores = [row for row in rows if row[4:5] == ["P"]]
    inputs = ["points alone", "estimated waveforms", "real waveforms"]
    assert [row[1] for row in scores] == inputs
    delivered = np.asarray(laspy.read(labelled).classification)
    ignored = np.count_nonzero(np.isin(delivered, (0, 3)))
    assert {row[3] for row in scores} == {str(ignored)}, "cars are no class of the table"
    f_rows = [row for row in rows if row[4:5] == ["F"]]
    assert all(float(row[5]) > 0.9 for row in f_rows), "ground of an open field"
    cars = [row for row in rows if row[2:4] == ["3", "not scored"]]
    assert [row[4] for row in cars] == ["7"] * 3
    assert all(sum(map(float, row[6:])) == pytest.approx(1.0, abs=0.004) for row in cars)


def test_a_flight_is_scored_as_surface_with_those_that_were_thinned_out(
    flight: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    las = laspy.read(flight / "in" / "points.laz")
    las.classification = np.load(flight / "truth" / "truth.npz")["label"]
    las.write(tmp_path / "archive.laz")
    words = ["surface", str(tmp_path / "archive.laz"), "--density", "1", "--every-point"]
    page = tmp_path / "page.md"
    page.write_text("# Page\n", "utf-8")
    assert main([*words, "--markdown", str(page)]) == 0
    assert capsys.readouterr().out == ""
    scores = [row for row in _rows(page.read_text("utf-8")) if row[4:5] == ["P"]]
    assert [row[1] for row in scores] == ["points alone", "estimated waveforms"]
    counts = [[int(cell.replace(",", "")) for cell in row[2:4]] for row in scores]
    assert {sum(count) for count in counts} == {len(las.points)}


def test_first_returns_are_thinned_by_pulse_and_their_truth_is_hidden(
    flight: Path, tmp_path: Path
) -> None:
    label = np.load(flight / "truth" / "truth.npz")["label"]
    path = flight / "in" / "flight.las"
    whole = archive_points(ArchiveRequest(path, density=0.0), tmp_path / "whole", label)
    thin = archive_points(ArchiveRequest(path, density=0.5), tmp_path / "thin", label)
    returns = np.asarray(laspy.read(path).return_number)
    assert whole.truth.size == np.count_nonzero(returns == 1)
    assert whole.all_truth.size == label.size
    assert np.bincount(whole.truth).tolist() == np.bincount(label[returns == 1]).tolist()
    assert 0.3 < thin.truth.size / whole.truth.size < 0.7
    for drive in (*whole.drives, *thin.drives):
        assert set(np.asarray(drive.columns["classification"])) == {1}
    pulses = archive_points(
        ArchiveRequest(path, density=0.5, first_only=False), tmp_path / "pulses", label
    )
    (drive,) = pulses.drives
    time, number = np.asarray(drive.columns["time"]), np.asarray(drive.columns["number_of_returns"])
    _, times, sizes = np.unique(time, return_index=True, return_counts=True)
    assert np.array_equal(sizes, number[times]), "pulses stay whole"


def test_points_without_times_intensities_and_returns_leave_a_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    side = np.arange(30.0)
    x, y = (one.ravel() for one in np.meshgrid(side, side))
    rows = [f"{a} {b} {0.01 * a} {1 + (a > 20)}" for a, b in zip(x, y, strict=True)]
    path = tmp_path / "点.ply"
    path.write_text(_PLY.format(count=x.size) + "\n".join(rows) + "\n", "ascii")
    assert main(["city", str(path)]) == 0
    rows_of = {row[1]: row for row in _rows(capsys.readouterr().out) if row[0] == "点.ply"}
    assert float(rows_of["points alone"][2].replace(",", "") or 0) > 0
    assert "estimated waveforms" in rows_of


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--codes", "ground=60"], "No point has a class that is scored. | "),
        (["--codes", "car=3"], "This names no class and its codes. | car=3"),
        (["--codes", "ground=x"], "This names no class and its codes. | ground=x"),
        (["--column", "真値"], "The file has no column “真値”. | "),
    ],
)
def test_what_cannot_be_scored_is_told_in_a_sentence(
    labelled: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["city", str(labelled), *words]) == 2
    error = capsys.readouterr().err
    assert error.startswith(said)
    assert error.count("\n") == 1


def test_a_file_without_points_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    laspy.LasData(laspy.LasHeader(point_format=6, version="1.4")).write(tmp_path / "empty.las")
    assert main(["surface", str(tmp_path / "empty.las")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert main(["surface", str(tmp_path / "nowhere.las")]) == 2
    assert "nowhere.las" in capsys.readouterr().err


def test_text_is_asked_what_its_columns_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "点.txt"
    rows = [f"{x}.5\t{y}.5\t{0.01 * x:.2f}\t{int(x > 9)}" for x in range(20) for y in range(20)]
    path.write_text("\n".join(rows) + "\n", "ascii")
    words = ["surface", str(path), "--codes", "surface=0", "other=1"]
    assert main(words) == 2
    assert capsys.readouterr().err.startswith("The file has no classes of points. | ")
    with pytest.raises(UserError, match="classes"):
        archive_points(ArchiveRequest(path), tmp_path / "refused")
    asked = ArchiveRequest(path, density=0.0, columns=("x", "y", "z", "classification"))
    truth = archive_points(asked, tmp_path / "asked").truth
    assert np.bincount(truth).tolist() == [200, 200]


def test_a_flight_is_scored_through_all_four_inputs(flight: Path) -> None:
    found = {given: matrix for given, matrix, _ in scores_of(flight)}
    assert tuple(found) == INPUTS
    assert len({matrix.count for matrix in found.values()}) == 1
    assert found["estimated waveforms"].mean_f > found["physical waveforms"].mean_f
