from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.methods.earthwork.as_built.limits import AllowedRange, FaceKind
from processing.methods.earthwork.as_built.limits_file import as_built_limits, read_limits
from resources import path_of

OWN = """[standard]
name = { en = "Office", ja = "事務所" }
edition = { en = "2025", ja = "令和7年" }
rejected_percent = 0.5
margin_mm = 30
density_per_m2 = 2

[[work_type]]
id = "bank"
name = { en = "Bank", ja = "築堤" }

[[work_type.face]]
face = "slope"
name = { en = "Slope", ja = "法面" }
mean_mm = [-40, 60.5]
single_mm = [-100, inf]
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "limits.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_table_that_comes_with_the_program_has_the_rule_s_numbers() -> None:
    table = as_built_limits()
    road = {one.face: one for one in table["road_embankment"].faces}
    cutting = {one.face: one for one in table["cutting"].faces}
    assert (road[FaceKind.FLAT].mean, road[FaceKind.FLAT].single) == (
        AllowedRange(-0.05, 0.05),
        AllowedRange(-0.15, 0.15),
    )
    assert (road[FaceKind.SLOPE].mean, road[FaceKind.SLOPE].single) == (
        AllowedRange(-0.08, 0.08),
        AllowedRange(-0.19, 0.19),
    )
    assert cutting[FaceKind.SLOPE].single == AllowedRange(-0.16, 0.16)
    assert (table.rejected_share, table.margin_m, table.density_per_m2) == (0.003, 0.05, 1.0)


def test_an_office_may_have_a_table_of_its_own(tmp_path: Path) -> None:
    table = read_limits(written(tmp_path, OWN))
    (face,) = table["bank"].faces
    assert table.standard.ja == "事務所"
    assert table.rejected_share == 0.005
    assert face.mean == AllowedRange(-0.04, 0.0605)
    assert face.single == AllowedRange(-0.1, math.inf)


def test_windows_line_ends_and_a_mark_are_read(tmp_path: Path) -> None:
    path = tmp_path / "limits.toml"
    path.write_bytes(b"\xef\xbb\xbf" + OWN.replace("\n", "\r\n").encode("utf-8"))
    assert read_limits(path).margin_m == 0.03


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("margin_mm = 30", "margin_mm = -1", 5),
        ("margin_mm = 30", "margin_mm = nan", 5),
        ("margin_mm = 30", "margin_mm = '30'", 5),
        ("margin_mm = 30\n", "", 1),
        ("rejected_percent = 0.5", "rejected_percent = 101", 4),
        ("density_per_m2 = 2", "density = 2", 6),
        ('edition = { en = "2025", ja = "令和7年" }', 'edition = "2025"', 3),
        ('edition = { en = "2025", ja = "令和7年" }', 'edition = { en = "", ja = "x" }', 3),
        ('id = "bank"', 'id = "Bank 1"', 9),
        ('face = "slope"', 'face = "side"', 13),
        ("mean_mm = [-40, 60.5]", "mean_mm = 0", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = [40, 60]", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = [-inf, inf]", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = [-40, nan]", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = [-40]", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = true", 15),
        ("mean_mm = [-40, 60.5]", "mean_mm = [-40, ", 16),
        ("[standard]", "[standards]", 1),
        ("[[work_type.face]]", "[work_type.face]", 8),
        ('name = { en = "Slope", ja = "法面" }', "name = 3", 14),
    ],
)
def test_a_bad_entry_is_told_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    assert old in OWN
    with pytest.raises(BadFile) as told:
        read_limits(written(tmp_path, OWN.replace(old, new, 1)))
    assert told.value.where.en.endswith(f"line {line}")
    assert "\n" not in told.value.line("ja")


def test_a_work_type_or_a_face_that_stands_twice_is_told(tmp_path: Path) -> None:
    start = OWN.index("[[work_type]]")
    with pytest.raises(BadFile, match="“bank” stands twice") as told:
        read_limits(written(tmp_path, OWN + OWN[start:]))
    assert told.value.where.en.endswith("line 18")
    face = OWN[OWN.index("[[work_type.face]]") :]
    with pytest.raises(BadFile, match="“slope” stands twice"):
        read_limits(written(tmp_path, OWN + face))


def test_the_line_of_a_second_work_type_s_face_is_its_own(tmp_path: Path) -> None:
    second = OWN[OWN.index("[[work_type]]") :].replace('"bank"', '"cut"')
    with pytest.raises(BadFile) as told:
        read_limits(written(tmp_path, OWN + second.replace("single_mm", "single")))
    assert told.value.where.en.endswith(f"line {(OWN + second).count(chr(10))}")


def test_a_file_that_is_no_text_is_told(tmp_path: Path) -> None:
    path = tmp_path / "limits.toml"
    path.write_bytes(b"[standard]\nname = \x83\x7f\xff")
    with pytest.raises(BadFile, match="not text in UTF-8") as told:
        read_limits(path)
    assert told.value.where.en.endswith("line 2")
    with pytest.raises(MissingInput):
        read_limits(tmp_path / "none.toml")


def test_a_work_type_that_the_table_lacks_is_told_with_those_it_has() -> None:
    with pytest.raises(OutOfRange, match="road_embankment"):
        as_built_limits()["tunnel"]


def test_a_limit_is_met_by_its_own_value_and_not_by_more() -> None:
    limit = AllowedRange(-0.05, 0.05)
    assert limit.holds(0.05)
    assert limit.holds(-0.05)
    assert not limit.holds(0.0501)
    assert not limit.holds(-0.0501)
    assert not limit.holds(math.nan)
    assert AllowedRange(-0.05, math.inf).holds(9.0)


def test_a_share_of_the_limit_is_taken_on_the_deviation_s_own_side() -> None:
    share = AllowedRange(-0.1, 0.2).percent(np.array([-0.05, 0.05, 0.0]))
    assert share == pytest.approx([-50.0, 25.0, 0.0])
    one_sided = AllowedRange(-0.1, math.inf).percent(np.array([-0.05, 0.15]))
    assert one_sided == pytest.approx([-50.0, 150.0])


def test_what_meets_the_limit_is_not_shown_beyond_it() -> None:
    values = np.array([0.15 + 1e-12, -0.15 - 1e-12])
    assert AllowedRange(-0.15, 0.15).percent(values).tolist() == [100.0, -100.0]


def test_limits_are_worded_as_a_form_has_them() -> None:
    assert AllowedRange(-0.05, 0.05).words().ja == "±50 mm"
    assert AllowedRange(-0.04, 0.0605).words().en == "−40 … +60.5 mm"
    assert AllowedRange(-0.06, math.inf).words().ja == "−60 mm 以上"
    assert AllowedRange(-math.inf, 0.06).words().en == "+60 mm or less"


def test_the_table_is_bundled() -> None:
    assert path_of("catalogue/as_built_limits.toml").is_file()


@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_table_that_the_manual_shows_can_be_read(tmp_path: Path, language: str) -> None:
    page = path_of(f"manual/{language}/earthwork.html").read_text(encoding="utf-8")
    shown = next(part for part in page.split("<pre><code>")[1:] if part.startswith("[standard]"))
    table = read_limits(written(tmp_path, shown.partition("</code>")[0]))
    (face,) = table["levelling"].faces
    assert face.single == AllowedRange(-0.15, math.inf)
