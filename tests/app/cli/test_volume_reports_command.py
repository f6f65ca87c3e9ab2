"""The papers of ``zuka run volume``: form 31-2, its limits, the work details, named layers."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import ezdxf.filemanagement
import laspy
import numpy as np
import openpyxl
import pypdfium2
import pytest
from pyproj import CRS

from app.cli.terminal import DONE, run_in_terminal
from processing.core.parameters import parameters_of
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.project.project import Project
from processing.project.work_details import WorkDetails
from processing.project.work_store import WorkStore
from resources import path_of
from tests.app.volume_command import CORNER, SIDE_M, refused, reported, write_design

TOO_HIGH_M = 0.03
WORK = 'work = "造成工事その1"\nclient = "A県"\nsurveyor = "測量 花子"\nheight_datum = "JGD2024"\n'
DESIGN_UP_M = 2.0


def write_built(path: Path) -> Path:
    """Level ground that was built 3 cm too high, measured with a noise of 2 mm."""
    random = np.random.default_rng(3)
    count = 20_000
    plan = random.uniform(0.0, SIDE_M, (count, 2))
    z = DESIGN_UP_M + TOO_HIGH_M + random.normal(0, 0.002, count)
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), CORNER
    header.add_crs(CRS.from_epsg(6677))
    las = laspy.LasData(header)
    las.x, las.y, las.z = (np.column_stack([plan, z]) + CORNER).T
    las.classification = np.full(count, 2, np.uint8)
    las.write(path)
    return path


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A design, and the ground built after it."""
    folder = tmp_path_factory.mktemp("site")
    return write_design(folder / "設計.xml", "計画面"), write_built(folder / "出来形.laz")


@pytest.fixture(scope="module")
def project(site: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same ground in a project."""
    folder = tmp_path_factory.mktemp("kept") / "造成.zuka"
    assert run_in_terminal(["import", str(folder), str(site[1])]) == DONE
    return folder


def own_table(path: Path, *, mean_mm: float = 10.0) -> Path:
    """A table with one work type, stricter than the program's."""
    path.write_text(
        f"""[standard]
name = {{ en = "Office", ja = "事務所" }}
edition = {{ en = "2026", ja = "令和8年" }}
rejected_percent = 0.3
margin_mm = 50
density_per_m2 = 1
[[work_type]]
id = "levelling"
name = {{ en = "Levelling", ja = "整地工" }}
[[work_type.face]]
face = "flat"
name = {{ en = "Flat", ja = "平場" }}
mean_mm = {mean_mm}
single_mm = 150
""",
        encoding="utf-8",
    )
    return path


def rows_of(path: Path) -> dict[str, str]:
    """What stands behind a name in a table."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        return {row[0]: row[1] for row in csv.reader(file) if len(row) > 1 and row[0]}


def words_of(path: Path) -> str:
    paper = pypdfium2.PdfDocument(path)
    words = "".join(page.get_textpage().get_text_range() for page in paper)
    paper.close()
    return words


def test_the_form_tells_the_verdict_on_every_kind_of_paper(
    site: tuple[Path, Path], tmp_path: Path
) -> None:
    for ending in (".pdf", ".xlsx", ".csv"):
        form = tmp_path / f"様式{ending}"
        found = reported(tmp_path / "out.json", *site, f"form={form}", "work_type=cutting")
        assert found["as_built"] == {"work_type": "cutting", "passes": True}
        assert str(found["cut_m3"]) == "0.0", "nothing was cut"
        assert form.stat().st_size > 0
    assert "31-2" in words_of(tmp_path / "様式.pdf")
    assert openpyxl.load_workbook(tmp_path / "様式.xlsx").sheetnames
    table = (tmp_path / "様式.csv").read_text(encoding="utf-8-sig")
    assert "設計.xml" in table
    assert "出来形.laz" in table


def test_it_is_the_same_whichever_side_the_design_is_on(
    site: tuple[Path, Path], tmp_path: Path
) -> None:
    for name, sides in (("a", site), ("b", site[::-1])):
        reported(
            tmp_path / f"{name}.json", *sides, f"form={tmp_path / name}.csv", "work_type=cutting"
        )
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_an_office_s_own_limits_decide(site: tuple[Path, Path], tmp_path: Path) -> None:
    """Three centimetres are too much for it; its only work type needs no naming."""
    limits = own_table(tmp_path / "事務所.toml")
    form = tmp_path / "form.csv"
    found = reported(tmp_path / "out.json", *site, f"form={form}", f"limits={limits}")
    assert found["as_built"] == {"work_type": "levelling", "passes": False}
    assert "±10 mm" in form.read_text(encoding="utf-8-sig")
    own_table(limits, mean_mm=40.0)
    found = reported(tmp_path / "out.json", *site, f"form={form}", f"limits={limits}")
    assert found["as_built"]["passes"]


def test_details_of_a_file_stand_on_report_and_form(
    site: tuple[Path, Path], tmp_path: Path
) -> None:
    work = tmp_path / "工事.toml"
    work.write_text(WORK, encoding="utf-8")
    form, report = tmp_path / "form.pdf", tmp_path / "report.csv"
    settings = (f"form={form}", f"report={report}", f"work={work}", "work_type=cutting")
    reported(tmp_path / "out.json", *site, *settings)
    for words in (words_of(form), report.read_text(encoding="utf-8-sig")):
        for said in ("造成工事その1", "A県", "測量 花子", "JGD2024"):
            assert said in words


def test_without_details_blanks_are_left(site: tuple[Path, Path], tmp_path: Path) -> None:
    report = tmp_path / "report.csv"
    reported(tmp_path / "out.json", *site, f"report={report}")
    rows = rows_of(report)
    assert (rows["Work"], rows["Client"], rows["Contractor"]) == ("", "", "")


def test_a_project_brings_its_details_and_limits(
    site: tuple[Path, Path], project: Path, tmp_path: Path
) -> None:
    copy = tmp_path / "造成.zuka"
    shutil.copytree(project, copy)
    form = tmp_path / "form.csv"
    sides = (site[0], copy)
    reported(tmp_path / "out.json", *sides, f"form={form}", "work_type=cutting")
    assert rows_of(form)["Work"] == "造成", "the project's name where no other is entered"
    opened = Project.open(copy)
    store = WorkStore(opened.settings)
    store.keep_details(WorkDetails(work="本工事", client="B市"))
    store.adopt_limits(own_table(tmp_path / "own.toml"))
    opened.close()
    found = reported(tmp_path / "out.json", *sides, f"form={form}")
    rows = rows_of(form)
    assert (rows["Work"], rows["Client"]) == ("本工事", "B市")
    assert found["as_built"] == {"work_type": "levelling", "passes": False}
    work = tmp_path / "work.toml"
    work.write_text(WORK, encoding="utf-8")
    limits = path_of("catalogue/as_built_limits.toml")
    settings = (f"work={work}", f"limits={limits}", "work_type=cutting")
    found = reported(tmp_path / "out.json", *sides, f"form={form}", *settings)
    assert rows_of(form)["Client"] == "A県", "what is named goes before what is kept"
    assert found["as_built"]["passes"]


def test_what_no_form_can_be_made_of_is_refused_before_any_work(
    site: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    design, built = site
    form = ("--set", f"form={tmp_path / 'form.pdf'}")
    cutting = ("--set", "work_type=cutting")
    sides = ("--before", design, "--after", built)
    for before, after in ((built, built), (built, 7.0), (design, 7.0), (design, design)):
        words = ("--before", before, "--after", after)
        assert "design on the other" in refused(tmp_path, capsys, *words, *form, *cutting)
    assert "river_embankment" in refused(tmp_path, capsys, *sides, *form)
    assert "cutting" in refused(tmp_path, capsys, *sides, *form, "--set", "work_type=tunnel")
    other = ("--set", f"form={tmp_path / 'form.doc'}")
    assert ".xlsx" in refused(tmp_path, capsys, *sides, *other, *cutting)
    same = ("--set", f"report={tmp_path / 'form.pdf'}")
    assert "same name" in refused(tmp_path, capsys, *sides, *form, *cutting, *same)
    control = ("--set", "work_type=a\nb")
    assert "one line" in refused(tmp_path, capsys, *sides, *form, *control)


def test_bad_files_of_details_and_limits_are_told_with_their_line(
    site: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sides = ("--before", site[0], "--after", site[1])
    work, limits = tmp_path / "work.toml", own_table(tmp_path / "limits.toml", mean_mm=-1.0)
    work.write_text('client = "A"\ncustomer = "B"\n', encoding="utf-8")
    assert "work.toml, line 2" in refused(tmp_path, capsys, *sides, "--set", f"work={work}")
    assert "limits.toml, line 13" in refused(tmp_path, capsys, *sides, "--set", f"limits={limits}")
    for name in ("work", "limits"):
        setting = f"{name}={tmp_path / 'gone.toml'}"
        assert "gone.toml" in refused(tmp_path, capsys, *sides, "--set", setting)


def test_neither_form_nor_numbers_are_written_over_what_was_read(
    site: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    design, built = (Path(shutil.copy(one, tmp_path)) for one in site)
    taken = tmp_path / "taken.csv"
    taken.hardlink_to(built)
    held = taken.read_bytes()
    sides = ("--before", design, "--after", built, "--set", "work_type=cutting")
    map_ = ("--set", f"map={tmp_path / 'map.tif'}")
    refused(tmp_path, capsys, *sides, *map_, "--set", f"form={taken}")
    assert taken.read_bytes() == held


def test_a_layer_of_the_boundary_is_named_behind_the_file(
    site: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "範囲.dxf"
    drawing = ezdxf.filemanagement.new("R2018")
    for layer, size_m in (("工区1", 10.0), ("工区2", 15.0)):
        ring = [(2.0, 2.0), (2.0 + size_m, 2.0), (2.0 + size_m, 12.0), (2.0, 12.0)]
        positions = [tuple(CORNER[:2] + position) for position in ring]
        drawing.modelspace().add_lwpolyline(positions, close=True, dxfattribs={"layer": layer})
    drawing.saveas(path)
    report = tmp_path / "report.csv"
    for layer, area_m2 in (("工区1", 100.0), ("工区2", 150.0)):
        found = reported(
            tmp_path / "out.json", *site, f"boundary={path}#{layer}", f"report={report}"
        )
        assert found["area_m2"] == pytest.approx(area_m2, rel=1e-6)
        assert f"範囲.dxf#{layer}" in report.read_text(encoding="utf-8-sig")
    sides = ("--before", site[0], "--after", site[1])
    assert "範囲.dxf#工区1" in refused(tmp_path, capsys, *sides, "--set", f"boundary={path}")
    third = f"boundary={path}#工区3"
    assert "工区1, 工区2" in refused(tmp_path, capsys, *sides, "--set", third)
    taken = tmp_path / "taken.tif"
    taken.hardlink_to(path)
    over = ("--set", f"boundary={path}#工区1", "--set", f"map={taken}")
    assert "taken.tif" in refused(tmp_path, capsys, *sides, *over)


def test_the_tool_says_which_details_a_file_may_hold() -> None:
    (told_of,) = [one for one in parameters_of(VolumeParameters) if one.id == "work"]
    for one in parameters_of(WorkDetails):
        assert one.id in told_of.explanation.en
        assert one.id in told_of.explanation.ja
