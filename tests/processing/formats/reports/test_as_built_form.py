from __future__ import annotations

import csv
import errno
from dataclasses import replace
from datetime import date
from functools import lru_cache
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from numpy.typing import NDArray

from processing.core.errors import Cancelled, InUse, NoSpace, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.core.text import Language
from processing.formats.reports.as_built_form import write_as_built_form
from processing.formats.reports.as_built_rows import AsBuiltFacts
from processing.formats.reports.as_built_tables import write_as_built_csv, write_as_built_xlsx
from processing.formats.work_facts import SideFacts, WorkFacts
from processing.methods.earthwork.as_built.as_built import AsBuiltResult, evaluate_as_built
from processing.methods.earthwork.as_built.limits_file import as_built_limits
from processing.methods.earthwork.maps.heat_map import SHARE_CLASSES
from tests.embankment import SOUTH, WEST, embankment, measured_on
from tests.monitors import CancelledAfter
from tests.pages import fonts_of, picture_of, plain, words_of

LONG_WORK = (
    "令和8年度 一般国道999号 佐々木髙原道路 第三工区（延伸）"
    "改良及び法面保護その他附帯工事（その2・変更第3回）追加分"
)
LONG_FILE = "road_design_surface_" * 3 + "final_20261122.xml"
FACTS = AsBuiltFacts(
    WorkFacts(
        work="国道○号線 改良工事",
        client="△△地方整備局",
        contractor="山﨑建設 株式会社",
        crs="EPSG:6677",
        height_datum="JGD2011",
        version="9.8.7",
        made_on=date(2026, 11, 22),
    ),
    SideFacts("設計面", "design_road.xml", None, 40, counts_triangles=True),
    SideFacts("出来形", "after.laz", date(2026, 11, 20), 48_000),
)


def spotted(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """12 mm too high, and three cells of the top half a metre too low."""
    position = np.floor(xy - [WEST, SOUTH])
    spots = [(10.0, 10.0), (12.0, 20.0), (15.0, 30.0)]
    is_spot = np.any([(position == spot).all(axis=1) for spot in spots], axis=0)
    return np.where(is_spot, -0.5, 0.012)


@lru_cache(maxsize=1)
def result() -> AsBuiltResult:
    design = embankment()
    limits = (as_built_limits(), "road_embankment")
    return evaluate_as_built(measured_on(design, spotted), design, limits, SilentMonitor())


def without_slope() -> AsBuiltResult:
    top, slope = result().faces
    nan = float("nan")
    empty = replace(
        slope,
        count=0,
        mean_m=nan,
        largest_m=nan,
        smallest_m=nan,
        within_50=0,
        within_80=0,
        unmeasured_area_m2=slope.area_m2,
        verdicts=dict.fromkeys(slope.verdicts, False),
    )
    return replace(result(), faces=(top, empty))


def test_the_form_has_the_numbers_and_words_as_text(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    write_as_built_form(path, result(), FACTS, "ja")
    (page,) = words_of(path)
    for words in (
        "様式-31-2",
        "出来形合否判定総括表",
        "国道○号線改良工事",
        "山﨑建設",
        "+12.0mm",
        "±50mm",
        "±150mm",
        "±190mm",
        "棄却点数",
        "3点(0.30%)",
        "0.3%以下(3点以下)",
        "1,000点(1.01点/m2)",
        "995.0m2",
        "平面直角座標系第9系(JGD2011、EPSG:6677)",
        "2026年11月20日",
        "2026年11月22日",
        "令和8年3月",
        "Zuka9.8.7",
        "天端の棄却点を含む値:−500.0…+12.0mm",
    ):
        assert plain(words) in page, words
    assert "不合格" not in page
    assert page.count("合格") == 11  # five items on two faces, and the whole


def test_the_form_speaks_english_too(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    write_as_built_form(path, result(), FACTS, "en")
    page = words_of(path)[0]
    for words in ("Form 31-2", "Mean", "+12.0 mm", "Rejected points", "Pass", "2026-11-20"):
        assert plain(words) in page


def test_the_japanese_font_is_carried_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    write_as_built_form(path, result(), FACTS, "ja")
    assert all(name.endswith("ZukaPaper-Regular") for name in fonts_of(path))
    assert b"/FontFile2" in path.read_bytes()


def test_the_map_shows_the_colours_of_what_was_found(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    write_as_built_form(path, result(), FACTS, "ja")
    picture = picture_of(path)
    right = picture[:, picture.shape[1] // 2 : -140].reshape(-1, 3)
    for number in (0, 4):
        near = np.abs(right.astype(int) - SHARE_CLASSES[number].rgb).max(axis=1) < 12
        assert near.sum() > 10


@pytest.mark.parametrize("language", ["ja", "en"])
def test_long_names_stay_within_the_sheet(tmp_path: Path, language: Language) -> None:
    facts = AsBuiltFacts(
        replace(FACTS.work, work=LONG_WORK, contractor=LONG_WORK, place=LONG_WORK),
        replace(FACTS.design, source=LONG_FILE),
        replace(FACTS.ground, source=LONG_FILE),
    )
    path = tmp_path / "form.pdf"
    write_as_built_form(path, result(), facts, language)
    text = "".join(words_of(path))
    assert text.count(plain(LONG_WORK)) == 3
    assert text.count(plain(LONG_FILE)) == 2
    for page in range(len(words_of(path))):
        picture = picture_of(path, page)
        assert (picture[:, :30] == 255).all()
        assert (picture[:, -30:] == 255).all()
        assert (picture[-20:] == 255).all()


def test_a_face_without_data_fails_with_words_in_place_of_numbers(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    write_as_built_form(path, without_slope(), FACTS, "ja")
    page = words_of(path)[0]
    assert "データなし" in page
    assert "nan" not in page
    assert page.count("不合格") == 6


def test_a_one_sided_limit_is_worded_and_noted(tmp_path: Path) -> None:
    design = embankment()
    limits = (as_built_limits(), "river_embankment")
    river = evaluate_as_built(measured_on(design, spotted), design, limits, SilentMonitor())
    path = tmp_path / "form.pdf"
    write_as_built_form(path, river, FACTS, "ja")
    page = words_of(path)[0]
    assert "−150mm以上" in page
    assert "規格値が片側だけの場合" in page


def test_a_character_that_the_font_lacks_is_marked(tmp_path: Path) -> None:
    path = tmp_path / "form.pdf"
    facts = replace(FACTS, work=replace(FACTS.work, work="𠮷野川\t工事\x07"))
    write_as_built_form(path, result(), facts, "ja")
    assert "〓野川工事" in words_of(path)[0]


def test_a_million_cells_make_a_small_file(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    percent = random.normal(0, 60, (1000, 1000)).astype(np.float32)
    grid = replace(result().grid, rows=1000, columns=1000)
    many = replace(result(), grid=grid, percent=percent, is_judged=np.ones((1000, 1000), bool))
    path = tmp_path / "form.pdf"
    write_as_built_form(path, many, FACTS, "ja")
    assert path.stat().st_size < 2_000_000


def test_the_csv_has_the_same_numbers_and_is_read_back(tmp_path: Path) -> None:
    for encoding, reads in (("cp932", "cp932"), ("utf-8", "utf-8-sig")):
        path = tmp_path / f"{encoding}.csv"
        write_as_built_csv(path, result(), replace(FACTS), "ja", encoding=encoding)
        with path.open(encoding=reads, newline="") as file:
            rows = list(csv.reader(file))
        facts = {row[0]: row[1] for row in rows if len(row) == 2}
        lines = {(row[0], row[1]): row[2:] for row in rows if len(row) == 6}
        assert facts["工事名"] == "国道○号線 改良工事"
        assert facts["合否判定結果"] == "合格"
        assert lines["天端", "平均値"] == ["12.0", "mm", "±50 mm", "合格"]
        assert lines["天端", "棄却点数"][0] == "3"
        assert float(lines["天端", "評価面積"][0]) == pytest.approx(995.0, abs=0.05)


def test_a_character_that_cp932_lacks_is_told(tmp_path: Path) -> None:
    facts = replace(FACTS, work=replace(FACTS.work, work="𠮷野川"))
    path = tmp_path / "form.csv"
    with pytest.raises(OutOfRange, match="𠮷"):
        write_as_built_csv(path, result(), facts, "ja", encoding="cp932")
    assert not path.exists()


def test_the_workbook_has_the_numbers_as_numbers_and_the_map(tmp_path: Path) -> None:
    path = tmp_path / "form.xlsx"
    facts = replace(FACTS, work=replace(FACTS.work, work="=1+1", place="a\x07b"))
    write_as_built_xlsx(path, result(), facts, "ja")
    sheet = openpyxl.load_workbook(path)["様式-31-2"]
    rows = [[cell.value for cell in row[:6]] for row in sheet.iter_rows()]
    lines = {(row[0], row[1]): row[2:] for row in rows}
    assert lines["天端", "平均値"] == [12.0, "mm", "±50 mm", "合格"]
    assert lines["法面（小段含む）", "棄却点数"][0] == 0
    assert sheet["B2"].value == "=1+1"
    assert sheet["B2"].data_type == "s"
    assert lines["測点・範囲", "a b"] == [None] * 4
    assert "B2:F2" in {str(one) for one in sheet.merged_cells.ranges}
    assert len(sheet._images) == 1


def test_a_face_without_data_leaves_cells_empty(tmp_path: Path) -> None:
    path = tmp_path / "form.xlsx"
    write_as_built_xlsx(path, without_slope(), FACTS, "en")
    rows = [[cell.value for cell in row[:6]] for row in openpyxl.load_workbook(path).active]
    assert ["Slope (with berms)", "Mean", None, "mm", "±80 mm", "Fail"] in rows


def test_an_input_is_never_overwritten(tmp_path: Path) -> None:
    delivered = tmp_path / "delivered.pdf"
    delivered.write_bytes(b"theirs")
    with pytest.raises(InUse):
        write_as_built_form(delivered, result(), FACTS, "ja", never=[delivered])
    with pytest.raises(InUse):
        write_as_built_xlsx(delivered, result(), FACTS, "ja", never=[delivered])
    with pytest.raises(InUse):
        write_as_built_csv(delivered, result(), FACTS, "ja", never=[delivered])
    assert delivered.read_bytes() == b"theirs"


def test_a_cancel_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(Cancelled):
        write_as_built_form(tmp_path / "form.pdf", result(), FACTS, "ja", monitor=CancelledAfter(2))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("write", [write_as_built_form, write_as_built_xlsx, write_as_built_csv])
def test_a_full_disk_is_told_and_nothing_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, write: object
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(NoSpace):
        write(tmp_path / "form.out", result(), FACTS, "ja")  # type: ignore[operator]
    assert not list(tmp_path.iterdir())
