from __future__ import annotations

import csv
import errno
from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import shapely

from processing.core.errors import Cancelled, InUse, NoSpace
from processing.core.monitor import SilentMonitor
from processing.core.parameters import MOST_LETTERS, parameters_of
from processing.core.text import Text
from processing.formats.reports.plan_picture import OUTLINE, change_plan
from processing.formats.reports.volume_report import write_volume_report
from processing.formats.reports.volume_rows import VolumeFacts, section_rows, section_sums
from processing.formats.reports.volume_tables import write_volume_csv, write_volume_xlsx
from processing.formats.work_facts import SideFacts, WorkFacts
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import change_classes
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine
from processing.methods.earthwork.volumes.other_methods import shown_sections
from processing.methods.earthwork.volumes.volume_result import Registration, VolumeResult, Volumes
from processing.methods.ground.filters.cells import CellGrid
from processing.project.work_details import WorkDetails, details_of
from tests.monitors import CancelledAfter
from tests.pages import picture_of, plain, words_of

LONG = (
    "令和8年度 一般国道999号 佐々木髙原道路 第三工区（延伸）"
    "改良及び法面保護工事（その2・変更第3回）追加分"
)


def site(cells: int = 60) -> ChangeGrid:
    """60 m wide: a metre of fill in the south-west, two of cut in the north-east, noise else."""
    grid = CellGrid(np.array([-12_380.0, -36_690.0, 5.0]), 60.0 / cells, cells, cells)
    y, x = np.mgrid[0:cells, 0:cells] * grid.size_m
    change = np.random.default_rng(0).normal(0.0, 0.004, (cells, cells))
    change[(x < 20) & (y < 20)] = 1.0
    change[(x > 40) & (y > 40)] = -2.0
    is_measured = ~((x > 25) & (x < 35) & (y > 25) & (y < 35))
    before = np.zeros((cells, cells), np.float32)
    inside = (np.hypot(x - 30, y - 30) < 40).astype(np.float32)
    return ChangeGrid(grid, before, change.astype(np.float32), is_measured, inside)


def volume(method: str = "grid", change: ChangeGrid | None = None) -> VolumeResult:
    told = Volumes(1512.34, 430.06, 3462.9, 100.0, 36.47, 1480.0, 428.0)
    found = Registration((0.004, -0.003, 0.021), (0.002, 0.003, 0.001), 812.0, True, False)
    notes = (Text("Small change is taken for noise.", "小さな変化は誤差とみなす。"),)
    return VolumeResult(told, method, 0.1, change or site(), found, notes)


def line(count: int = 4) -> SectionedLine:
    sections = []
    for number in range(count):
        offsets = np.linspace(-10.0, 10.0, 41)
        before = 20.0 + 0.1 * offsets
        after = before + np.sin(offsets / 3)
        after[:3] = np.nan
        name = f"No.{number}"
        sections.append(
            DrawnSection(10.0 * number, name, offsets, before, after, 4.0 + number, 2.0 * number)
        )
    return SectionedLine("中心線", np.zeros((2, 2)), 0.0, tuple(sections))


def facts(**changed: object) -> VolumeFacts:
    work = WorkFacts(
        work="△△造成工事",
        crs="EPSG:6677",
        height_datum="JGD2011",
        version="9.8.7",
        made_on=date(2026, 11, 22),
    )
    before = SideFacts("起工測量", "before.laz", date(2026, 10, 1), 12_345_678)
    after = SideFacts("出来高測量", "after.laz", date(2026, 11, 20), 23_456_789)
    return replace(VolumeFacts(work, before, after, "範囲.geojson"), **changed)


def test_the_report_states_what_the_rule_asks_for(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(), facts(), "ja")
    numbers, plan = words_of(path)
    for words in (
        "土量計算書",
        "△△造成工事",
        "点高法",
        "0.1 m × 0.1 m",
        "起工測量",
        "before.laz",
        "2026年10月1日",
        "12,345,678 点",
        "平面直角座標系 第9系",
        "JGD2011",
        "範囲.geojson",
        "1,512.3",
        "430.1",
        "−1,082.3",
        "±36.5 m³",
        "3,462.9",
        "100.0",
        "+0.021",
        "偶然の範囲を超えるが、補正していない",
        "小さな変化は誤差とみなす",
        "Zuka 9.8.7",
    ):
        assert plain(words) in numbers, words
    for words in ("変化量分布図", "縮尺1:", "Y−12,360", "X−36,660", "未計測", "N", "m超"):
        assert plain(words) in plan, words


@pytest.mark.parametrize(
    ("method", "ja", "en"),
    [
        ("grid", "点高法", "Grid of cells"),
        ("tin", "プリズモイダル法", "TIN against TIN"),
        ("end-area", "平均断面法", "Average end areas"),
        ("prismoidal", "角柱公式", "Prismoidal formula"),
    ],
)
def test_each_method_has_its_name(tmp_path: Path, method: str, ja: str, en: str) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(method), facts(), "ja")
    assert ja in words_of(path)[0]
    write_volume_report(path, volume(method), facts(), "en")
    assert plain(en) in words_of(path)[0]


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (None, "was not compared"),
        (Registration((0.0,) * 3, (0.001,) * 3, 9.0, False, False), "within chance"),
        (Registration((0.0,) * 3, (0.001,) * 3, 9.0, True, True), "was moved back"),
    ],
)
def test_what_became_of_the_registration_is_said(
    tmp_path: Path, found: Registration | None, said: str
) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, replace(volume(), registration=found), facts(), "en")
    assert plain(said) in words_of(path)[0]


def test_sections_are_listed_summed_and_drawn(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume("end-area"), facts(line=line(40)), "ja")
    pages = words_of(path)
    table = next(page for page in pages if "合計" in page)
    rows = section_rows(facts(line=line(40)))
    distance, cut, fill = section_sums(rows)
    assert cut == pytest.approx(sum(10 * (4.5 + number) for number in range(39)))
    assert fill == pytest.approx(sum(10 * (1.0 + 2 * number) for number in range(39)))
    for number in (distance, cut, fill):
        assert f"{number:,.2f}" in table
    assert sum(page.count("切土断面積") for page in pages) == 1
    drawn = "".join(pages[3:])
    assert all(f"No.{number}切土" in drawn for number in range(40))
    assert len(pages) == 3 + 10


def test_a_table_of_many_sections_goes_on_over_pages_with_its_head(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume("end-area"), facts(line=line(100)), "ja")
    heads = [page for page in words_of(path) if "切土断面積" in page]
    assert len(heads) == 3
    assert "合計" in heads[-1]


def test_volumes_between_sections_may_be_given() -> None:
    rows = section_rows(facts(line=line(3), between=((1.0, 2.0), (3.0, 4.0))))
    assert section_sums(rows) == (20.0, 4.0, 6.0)


def test_a_section_halfway_between_two_stations_tells_its_areas_only(tmp_path: Path) -> None:
    nan = float("nan")
    told = facts(line=line(3), between=((nan, nan), (3.0, 4.0)))
    assert section_sums(section_rows(told)) == (20.0, 3.0, 4.0)
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume("prismoidal"), told, "ja")
    assert "nan" not in "".join(words_of(path))
    csv_path = tmp_path / "volume.csv"
    write_volume_csv(csv_path, volume("prismoidal"), told, "ja")
    assert "No.1,10.00,5.00,,2.00," in csv_path.read_text(encoding="utf-8-sig")


def test_a_section_without_ground_is_an_empty_frame(tmp_path: Path) -> None:
    (section,) = line(1).sections
    nothing = np.full_like(section.before, np.nan)
    empty = replace(line(1), sections=(replace(section, before=nothing, after=nothing),))
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume("end-area"), facts(line=empty), "ja")
    assert "nan" not in "".join(words_of(path))


def test_long_names_and_many_notes_stay_within_the_sheet(tmp_path: Path) -> None:
    work = replace(facts().work, work=LONG, client=LONG, contractor=LONG, place=LONG)
    side = SideFacts(LONG, "b" * 80 + ".laz", date(2026, 1, 1), 10**10)
    notes = tuple(Text.same(f"{number} {LONG}") for number in range(30))
    path = tmp_path / "volume.pdf"
    many = replace(volume(), notes=notes)
    write_volume_report(path, many, facts(work=work, before=side, after=side), "en")
    pages = words_of(path)
    text = "".join(pages)
    assert text.count(plain(LONG)) == 4 + 2 + 30
    assert text.count("b") >= 160
    for page in range(len(pages)):
        picture = picture_of(path, page)
        assert (picture[:, :30] == 255).all()
        assert (picture[:, -30:] == 255).all()
        assert (picture[-25:] == 255).all()


def test_work_details_as_long_as_can_be_stay_within_the_sheet(tmp_path: Path) -> None:
    longest = "漢" * MOST_LETTERS
    details = details_of({one.id: longest for one in parameters_of(WorkDetails)})
    work = details.facts("EPSG:6677", "9.8.7", date(2026, 11, 22))
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(), facts(work=work), "ja")
    pages = words_of(path)
    assert pages[0].count(longest) == 6
    for page in range(len(pages)):
        assert (picture_of(path, page)[-25:] == 255).all()
    foot = picture_of(path)[-75:-25, 200:-200]
    assert (foot == 255).all(), "no table over the foot"


def test_a_million_cells_make_a_small_file(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(change=site(1000)), facts(), "ja")
    assert path.stat().st_size < 2_000_000


def test_a_map_without_any_change_is_drawn(tmp_path: Path) -> None:
    change = replace(site(), after=np.full((60, 60), np.nan, np.float32))
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(change=change), facts(), "ja")
    assert len(words_of(path)) == 2


def test_large_grids_are_reduced_and_keep_what_stands_out() -> None:
    change = site(60)
    many = np.zeros((4000, 4000), np.float32)
    many[2001, 3003] = -2.0
    grid = CellGrid(change.grid.origin, 0.1, 4000, 4000)
    every = np.ones(many.shape, bool)
    whole = ChangeGrid(grid, np.zeros_like(many), many, every, every.astype(np.float32))
    classes = change_classes(1.0)
    plan = change_plan(whole, classes)
    assert max(plan.rgb.shape) <= 1600
    assert (plan.rgb == classes[0].rgb).all(axis=2).any()
    assert plan.east - plan.west == pytest.approx(400.0, abs=0.3)


def test_north_is_above_and_east_to_the_right() -> None:
    classes = change_classes(2.0)
    plan = change_plan(site(), classes)
    rows, columns = plan.rgb.shape[:2]
    red, blue = (
        plan.rgb[round(rows * y), round(columns * x)].astype(int)
        for x, y in ((0.2, 0.75), (0.8, 0.25))
    )
    assert red[0] > red[2]
    assert blue[2] > blue[0]


def test_the_csv_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "volume.csv"
    write_volume_csv(path, volume("end-area"), facts(line=line()), "ja", encoding="cp932")
    with path.open(encoding="cp932", newline="") as file:
        rows = {row[0]: row[1:] for row in csv.reader(file) if row}
    assert rows["切土量"] == ["1512.34", "1480.00", "m3"]
    assert float(rows["差引土量（盛土 － 切土）"][0]) == pytest.approx(-1082.28)
    assert rows["計算方法"] == ["平均断面法"]
    assert rows["合計"] == ["30.00", "", "165.00", "", "90.00"]


def test_the_workbook_has_numbers_sections_and_the_map(tmp_path: Path) -> None:
    path = tmp_path / "volume.xlsx"
    write_volume_xlsx(path, volume("end-area"), facts(line=line()), "ja")
    book = openpyxl.load_workbook(path)
    rows = {row[0].value: [cell.value for cell in row[1:4]] for row in book["土量計算書"]}
    assert rows["盛土量"] == [430.06, 428.0, "m³"]
    assert rows["不確かさ（±）"] == [36.47, None, "m³"]
    assert len(book["土量計算書"]._images) == 1
    assert book["断面"].cell(6, 4).value == 165.0


def test_names_are_printed_as_they_are_and_never_as_markup(tmp_path: Path) -> None:
    name = "R&D <b>Bank</b> &amp; =1+1"
    told = facts()
    told = replace(told, work=replace(told.work, work=name), before=replace(told.before, name=name))
    report, table = tmp_path / "volume.pdf", tmp_path / "volume.xlsx"
    write_volume_report(report, volume(), told, "en")
    assert plain(name) in plain(words_of(report)[0])
    write_volume_xlsx(table, volume(), told, "en")
    cells = [cell.value for row in openpyxl.load_workbook(table).worksheets[0] for cell in row]
    assert name in cells


def test_an_input_is_never_overwritten_and_a_full_disk_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    delivered = tmp_path / "before.laz"
    delivered.write_bytes(b"theirs")
    for write in (write_volume_report, write_volume_csv, write_volume_xlsx):
        with pytest.raises(InUse):
            write(delivered, volume(), facts(), "ja", never=[delivered])

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    for write in (write_volume_report, write_volume_csv, write_volume_xlsx):
        with pytest.raises(NoSpace):
            write(tmp_path / "volume.out", volume(), facts(), "ja")
    assert [path.name for path in tmp_path.iterdir()] == ["before.laz"]
    assert delivered.read_bytes() == b"theirs"


def test_a_cancel_while_sections_are_drawn_leaves_no_file(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    with pytest.raises(Cancelled):
        write_volume_report(path, volume(), facts(line=line(9)), "ja", monitor=CancelledAfter(5))
    assert not list(tmp_path.iterdir())


def wide_site() -> ChangeGrid:
    """The same site, and as much of nothing to its east."""
    whole = site()
    grid = replace(whole.grid, columns=2 * whole.grid.columns)
    far = {
        name: np.concatenate([part := getattr(whole, name), part], axis=1)
        for name in ("before", "after", "is_measured", "inside")
    }
    return replace(whole, grid=grid, **far)


def test_a_wide_site_lies_on_its_sheet_and_tables_stand(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume("end-area", wide_site()), facts(line=line(4)), "ja")
    shapes = [picture_of(path, page).shape[:2] for page in range(4)]
    assert [high > wide for high, wide in shapes] == [True, False, True, True]


def test_the_edge_of_what_counts_is_drawn_on_the_map_and_named(tmp_path: Path) -> None:
    path = tmp_path / "volume.pdf"
    west, south = site().grid.origin[:2]
    area = shapely.box(west + 10.0, south + 10.0, west + 900.0, south + 50.0)
    write_volume_report(path, volume(), facts(area=area), "ja")
    assert plain("枠線: 範囲.geojson") in words_of(path)[1]
    drawn = picture_of(path, 1).astype(int)
    assert (np.abs(drawn - OUTLINE).sum(axis=2) < 90).sum() > 200
    write_volume_report(path, volume(), facts(), "ja")
    drawn = picture_of(path, 1).astype(int)
    assert (np.abs(drawn - OUTLINE).sum(axis=2) < 90).sum() == 0


def test_sections_that_only_show_the_ground_have_no_table(tmp_path: Path) -> None:
    shown = shown_sections(site(), None, SilentMonitor())
    assert shown is not None
    assert len(shown.sections) == 6
    path = tmp_path / "volume.pdf"
    write_volume_report(path, volume(), facts(figures=shown), "ja")
    pages = words_of(path)
    assert not any("切土断面積" in page for page in pages)
    assert "断面(L1)" in pages[2]
