"""``zuka score`` on small files with figures worked out by hand, and on files that don't fit."""

from __future__ import annotations

import re
from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from app.cli.terminal import DONE, run_in_terminal
from tests.app.score_answers import refused, scored

OFFSET = (-11_000.0, -35_000.0, 100.0)
TRUTH = np.array([0, 0, 0, 0, 0, 0, 7, 7, 18, 18], np.uint8)
RESULT = np.array([0, 0, 0, 0, 1, 7, 7, 18, 18, 0], np.uint8)
KINDS = np.array([1, 1, 2, 2, 0, 0, -1, -1, -1, -1], np.int8)


def positions(count: int = 10) -> NDArray[np.int64]:
    random = np.random.default_rng(3)
    return random.integers(0, 40_000, (count, 3))


def write_las(
    path: Path, integers: NDArray[np.int64], codes: NDArray[np.uint8], scale: float = 0.001
) -> Path:
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [scale] * 3, list(OFFSET)
    las = laspy.LasData(header)
    las.X, las.Y, las.Z = integers.T.astype(np.int32)
    las.classification = codes
    las.write(path)
    return path


def test_noise_is_scored_by_both_classes_with_what_doing_nothing_would_give(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = write_las(tmp_path / "結果.laz", positions(), RESULT)
    np.savez(tmp_path / "truth.npz", code=TRUTH, kind=KINDS, ground_z=np.zeros(10, np.float32))
    reported = scored(capsys, "noise", result, tmp_path / "truth.npz")
    assert reported["points"] == 10
    assert reported["paired_by"] == "order"
    kept, nothing, noise = reported["classes"].values()
    assert list(reported["classes"]) == ["kept", "kept_if_nothing_is_removed", "noise"]
    assert (kept["tp"], kept["fp"], kept["fn"], kept["tn"]) == (5, 1, 1, 3)
    assert kept["precision"] == kept["recall"] == kept["f"] == pytest.approx(5 / 6)
    assert (nothing["precision"], nothing["recall"]) == (0.6, 1.0)
    assert (noise["precision"], noise["recall"], noise["f"]) == (0.75, 0.75, 0.75)
    assert reported["shares"]["noise_share"] == {"points": 4, "of": 10, "share": 0.4}
    assert reported["shares"]["noise_left"]["points"] == 1
    assert reported["shares"]["true_lost"] == {"points": 1, "of": 6, "share": pytest.approx(1 / 6)}
    # Three noise points were found, and one of them lies below although it was called 18.
    assert reported["shares"]["right_code"] == {"points": 2, "of": 3, "share": pytest.approx(2 / 3)}
    shares = {kind: one["share"] for kind, one in reported["kinds"]["kind"].items()}
    assert shares == {"-1": 0.75, "0": 0.5, "1": 1.0, "2": 1.0}


def test_ground_is_scored_with_both_types_of_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = np.array([2, 2, 2, 2, 2, 2, 1, 1, 1, 7], np.uint8)
    codes = np.array([2, 2, 2, 2, 1, 18, 1, 1, 2, 7], np.uint8)
    result = write_las(tmp_path / "result.las", positions(), codes)
    np.save(tmp_path / "labels_after.npy", truth)
    np.save(tmp_path / "kinds_after.npy", np.array([0, 0, 0, 0, 0, 0, 1, 1, 3, -2], np.int8))
    reported = scored(capsys, "ground", result, tmp_path / "labels_after.npy")
    removed, ground = reported["classes"]["removed"], reported["classes"]["ground"]
    assert (removed["precision"], removed["recall"]) == (0.6, 0.75)
    assert removed["f"] == pytest.approx(2 * 0.6 * 0.75 / 1.35)
    assert (ground["tp"], ground["fp"], ground["fn"], ground["tn"]) == (4, 1, 2, 3)
    assert reported["shares"]["type_1"]["share"] == pytest.approx(2 / 6)
    assert reported["shares"]["type_2"]["share"] == pytest.approx(1 / 4)
    assert reported["shares"]["total_error"] == {"points": 3, "of": 10, "share": 0.3}
    assert reported["figures"]["kappa"] == pytest.approx((0.7 - 0.5) / 0.5)
    assert reported["kinds"]["kind"]["3"] == {"points": 0, "of": 1, "share": 0.0}


def test_a_perfect_result_scores_one_and_undefined_figures_are_null(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = write_las(tmp_path / "truth.laz", positions(), np.full(10, 2, np.uint8))
    reported = scored(capsys, "ground", truth, truth)
    assert reported["classes"]["ground"]["f"] == 1.0
    assert reported["classes"]["removed"]["f"] is None
    assert reported["figures"]["kappa"] is None
    assert run_in_terminal(["score", "ground", str(truth), str(truth)]) == DONE
    assert "–" in capsys.readouterr().out


def test_all_classes_are_scored_each_against_the_others_and_by_their_mean(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truth = np.array([2, 2, 2, 2, 11, 11, 65, 65, 0, 18], np.uint8)
    codes = np.array([2, 2, 2, 11, 11, 11, 65, 1, 5, 18], np.uint8)
    result = write_las(tmp_path / "result.las", positions(), codes)
    np.save(tmp_path / "left.labels.npy", truth)
    reported = scored(capsys, "classify", result, tmp_path / "left.labels.npy")
    assert reported["points"] == 9
    f = {code: one["f"] for code, one in reported["classes"].items()}
    assert f == pytest.approx(
        {"1": 0, "2": 6 / 7, "11": 0.8, "18": 1, "65": 2 / 3, "ground_and_road": 1}
    )
    assert reported["figures"]["mean_f"] == pytest.approx((6 / 7 + 0.8 + 2 / 3) / 3)
    assert reported["figures"]["mean_f_ground_joined"] == pytest.approx((1 + 2 / 3) / 2)
    assert reported["shares"]["right"]["points"] == 7
    assert reported["matrix"]["codes"] == [1, 2, 11, 18, 65]
    assert reported["matrix"]["counts"][1] == [0, 3, 1, 0, 0]
    by_chance = (4 * 3 + 2 * 3 + 2 * 1 + 1 * 1) / 81
    assert reported["figures"]["kappa"] == pytest.approx((7 / 9 - by_chance) / (1 - by_chance))
    truth_of_points = write_las(tmp_path / "truth.laz", positions(), truth)
    assert scored(capsys, "classify", result, truth_of_points)["figures"] == reported["figures"]


def test_the_matrix_of_all_classes_is_a_table_of_true_and_given_classes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")
    np.save(tmp_path / "left.labels.npy", np.array([2, 2, 2, 5, 5, 5, 65, 65, 65, 65], np.uint8))
    codes = np.array([2, 2, 5, 5, 5, 5, 65, 2, 65, 65], np.uint8)
    result = write_las(tmp_path / "result.las", positions(), codes)
    arguments = ["score", "classify", str(result), str(tmp_path / "left.labels.npy")]
    assert run_in_terminal(arguments) == DONE
    *_, head, ground, trees, signs = capsys.readouterr().out.rstrip("\n").splitlines()
    assert head.split()[-3:] == ["2", "5", "65"]
    assert [line.split() for line in (ground, trees, signs)] == [
        ["2", "2", "1", "0"],
        ["5", "0", "3", "0"],
        ["65", "1", "0", "3"],
    ]
    np.savez(tmp_path / "truth.npz", code=TRUTH)
    result = write_las(tmp_path / "noise.las", positions(), RESULT)
    assert "matrix" not in scored(capsys, "noise", result, tmp_path / "truth.npz")


def test_text_of_the_isprs_test_has_ground_0_and_object_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    integers = positions() // 10
    written = integers * 0.01 + np.array(OFFSET)
    is_object = np.array([0, 1] * 5)
    lines = [
        f"{x:.2f}\t{y:.2f}\t{z:.2f}\t{code}"
        for (x, y, z), code in zip(written, is_object, strict=True)
    ]
    (tmp_path / "samp.txt").write_text("\n".join(lines) + "\n", "ascii")
    codes = np.where(is_object == 1, 1, 2).astype(np.uint8)
    result = write_las(tmp_path / "result.laz", integers, codes, scale=0.01)
    reported = scored(capsys, "ground", result, tmp_path / "samp.txt")
    assert reported["paired_by"] == "order"
    assert reported["classes"]["removed"]["f"] == reported["classes"]["ground"]["f"] == 1.0
    assert reported["classes"]["removed"]["tp"] == 5


def test_points_in_another_order_are_paired_by_their_places_duplicates_one_to_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    integers = positions(500)
    integers[100:150] = integers[:50]
    integers[150:160] = integers[:10]
    codes = np.random.default_rng(1).choice(np.array([1, 2], np.uint8), 500)
    codes[100:150] = codes[:50]
    codes[150:160] = codes[:10]
    truth = write_las(tmp_path / "truth.laz", integers, codes)
    order = np.random.default_rng(2).permutation(500)
    result = write_las(tmp_path / "result.las", integers[order], codes[order])
    reported = scored(capsys, "ground", result, truth)
    assert reported["paired_by"] == "place"
    assert reported["points"] == 500
    assert reported["classes"]["removed"]["f"] == reported["classes"]["ground"]["f"] == 1.0


def test_a_result_that_lacks_points_is_refused_with_their_number(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    integers, codes = positions(100), np.full(100, 2, np.uint8)
    truth = write_las(tmp_path / "truth.laz", integers, codes)
    result = write_las(tmp_path / "result.laz", integers[:90], codes[:90])
    line = refused(capsys, "ground", result, truth)
    assert "0 of the result's 90 points and 10 of the truth's 100" in line
    np.save(tmp_path / "truth.npy", codes)
    line = refused(capsys, "ground", result, tmp_path / "truth.npy")
    assert "The truth has 100 points, the result 90." in line


@pytest.mark.parametrize(
    ("name", "array", "says"),
    [
        ("a.npy", np.zeros((5, 2), np.uint8), "whole numbers"),
        ("a.npy", np.full(10, 300), "whole numbers"),
        ("a.npy", np.zeros(10), "whole numbers"),
        ("a.npy", np.array([{"code": 2}] * 10, object), "damaged"),
    ],
)
def test_arrays_that_are_no_codes_are_refused(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    name: str,
    array: NDArray[np.generic],
    says: str,
) -> None:
    result = write_las(tmp_path / "result.laz", positions(), RESULT)
    np.save(tmp_path / name, array)
    assert says in refused(capsys, "noise", result, tmp_path / name)


def test_a_truth_that_is_missing_cut_off_or_of_another_tool_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = write_las(tmp_path / "result.laz", positions(), RESULT)
    assert "no such file" in refused(capsys, "noise", result, tmp_path / "none.npz")
    np.savez(tmp_path / "truth.npz", ground=np.zeros(10, bool))
    assert "no array of true classes" in refused(capsys, "noise", result, tmp_path / "truth.npz")
    whole = (tmp_path / "truth.npz").read_bytes()
    (tmp_path / "truth.npz").write_bytes(whole[: len(whole) // 2])
    assert "damaged" in refused(capsys, "noise", result, tmp_path / "truth.npz")
    (tmp_path / "truth.txt").write_text("1 2 3 0\n1 2 nan 1\n", "ascii")
    assert "point 2" in refused(capsys, "ground", result, tmp_path / "truth.txt")
    (tmp_path / "truth.txt").write_text("1 2 3 0\n1 2 3 0.5\n", "ascii")
    assert "point 2" in refused(capsys, "ground", result, tmp_path / "truth.txt")
    known = refused(capsys, "ceilings", result, tmp_path / "truth.txt").rpartition(": ")[2]
    assert {"noise", "ground", "classify", "curbs", "trees"} <= set(known.rstrip(".").split(", "))


def test_the_table_lines_up_in_japanese_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "ja")
    result = write_las(tmp_path / "result.laz", positions(), RESULT)
    np.savez(tmp_path / "truth.npz", signal=TRUTH == 0)
    assert run_in_terminal(["score", "noise", str(result), str(tmp_path / "truth.npz")]) == DONE
    lines = capsys.readouterr().out.splitlines()
    head, kept, *_ = lines[2:]
    assert head.split() == ["正例とするクラス", "適合率", "再現率", "F値", "TP", "FP", "FN", "TN"]
    wide = [len(line) + sum(ord(one) > 0x2E80 for one in line) for line in (head, kept)]
    assert wide[0] == wide[1]


def test_the_matrix_is_drawn_with_natural_and_balanced_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")
    np.save(tmp_path / "left.labels.npy", np.array([2, 2, 2, 2, 2, 2, 5, 5, 65, 1], np.uint8))
    codes = np.array([2, 2, 2, 2, 2, 65, 5, 2, 65, 5], np.uint8)
    result = write_las(tmp_path / "result.las", positions(), codes)
    picture = tmp_path / "matrix.svg"
    arguments = ["score", "classify", str(result), str(tmp_path / "left.labels.npy")]
    assert run_in_terminal([*arguments, "--picture", str(picture)]) == DONE
    words = re.findall(r">([^<]+)</text>", picture.read_text(encoding="utf-8"))
    assert {"83", "17", "50", "100"} <= set(words)  # % of a true class
    # Of six, two and one point, five, one and one are right: F of 2 is 5 / 6, of 65 it is 2 / 3.
    assert {"0.833", "0.667", "0.500"} <= set(words)
    # As many of each: of 65, one sixth of 2 is beside it, so that precision is 6 / 7.
    assert "0.857" in words
    capsys.readouterr()
    assert run_in_terminal([*arguments, "--picture", str(tmp_path / "matrix.png")]) == 2
    assert ".svg" in capsys.readouterr().err
    np.savez(tmp_path / "truth.npz", code=TRUTH)
    noise = write_las(tmp_path / "noise.las", positions(), RESULT)
    noisy = ["score", "noise", str(noise), str(tmp_path / "truth.npz")]
    assert run_in_terminal([*noisy, "--picture", str(tmp_path / "noise.svg")]) == 2
    assert not (tmp_path / "noise.svg").exists()
