"""A project keeps what its papers say, and the limits that its forms judge by."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from processing.core.errors import BadFile, InUse, MissingInput, OutOfRange
from processing.methods.earthwork.as_built.limits_file import as_built_limits, read_limits
from processing.project.project import Project
from processing.project.work_details import WorkDetails
from processing.project.work_store import ChosenLimits, WorkStore
from resources import path_of

OWN = """[standard]
name = { en = "Office", ja = "事務所" }
edition = { en = "2025", ja = "令和7年" }
rejected_percent = 0.5
margin_mm = 30
density_per_m2 = 2
""" + "".join(
    f"""
[[work_type]]
id = "{id_}"
name = {{ en = "{id_}", ja = "築堤" }}

[[work_type.face]]
face = "slope"
name = {{ en = "Slope", ja = "法面" }}
mean_mm = 40
single_mm = [-100, inf]
"""
    for id_ in ("bank", "cutting")
)


@pytest.fixture
def project(tmp_path: Path) -> Iterator[Project]:
    made = Project.create(tmp_path / "site.zuka", "EPSG:6677")
    yield made
    made.close()


@pytest.fixture
def table(tmp_path: Path) -> Path:
    path = tmp_path / "事務所.toml"
    path.write_text(OWN, encoding="utf-8")
    return path


def again(project: Project) -> WorkStore:
    """What is there when the project is opened again."""
    project.close()
    opened = Project.open(project.folder, writing=False)
    opened.close()
    return WorkStore(opened.settings)


def test_a_new_project_has_blanks_and_the_program_s_table(project: Project) -> None:
    store = WorkStore(project.settings)
    assert store.details() == WorkDetails()
    assert store.limits() == ChosenLimits(as_built_limits())
    assert store.limits().shown_work_type == "road_embankment"


def test_details_are_there_when_the_project_is_opened_again(project: Project) -> None:
    store = WorkStore(project.settings)
    store.keep_details(WorkDetails(client="A県", surveyor="測 太郎"))
    store.keep_details(WorkDetails(work="造成工事", client="B県"))
    assert again(project).details() == WorkDetails(work="造成工事", client="B県")


def test_a_work_type_is_there_again_and_another_one_is_refused(project: Project) -> None:
    store = WorkStore(project.settings)
    store.choose_work_type("cutting")
    with pytest.raises(OutOfRange, match="road_embankment"):
        store.choose_work_type("tunnel")
    assert again(project).limits() == ChosenLimits(as_built_limits(), "", "cutting")


def test_an_own_table_stays_when_its_file_is_changed_or_gone(project: Project, table: Path) -> None:
    store = WorkStore(project.settings)
    store.adopt_limits(table)
    table.write_text("damaged", encoding="utf-8")
    assert store.limits().file_name == "事務所.toml"
    table.unlink()
    kept = again(project).limits()
    assert kept.table.standard.ja == "事務所"
    assert kept.table.rejected_share == 0.005
    assert kept.shown_work_type == "bank"


def test_the_work_type_goes_over_to_a_table_that_has_it_too(project: Project, table: Path) -> None:
    store = WorkStore(project.settings)
    store.choose_work_type("cutting")
    store.adopt_limits(table)
    assert store.limits().work_type == "cutting"
    store.choose_work_type("bank")
    assert store.limits().file_name == "事務所.toml"
    store.drop_limits()
    assert store.limits() == ChosenLimits(as_built_limits())


def test_a_bad_table_changes_nothing(project: Project, table: Path, tmp_path: Path) -> None:
    store = WorkStore(project.settings)
    store.adopt_limits(table)
    bad = tmp_path / "bad.toml"
    bad.write_text(OWN.replace("mean_mm = 40", "mean_mm = 0"), encoding="utf-8")
    with pytest.raises(BadFile) as told:
        store.adopt_limits(bad)
    assert told.value.where.en.endswith("bad.toml, line 15")
    with pytest.raises(MissingInput):
        store.adopt_limits(tmp_path / "none.toml")
    assert store.limits().file_name == "事務所.toml"


def test_the_table_that_counts_can_be_written_and_read_again(
    project: Project, table: Path, tmp_path: Path
) -> None:
    store = WorkStore(project.settings)
    store.write_limits(tmp_path / "bundled.toml")
    assert read_limits(tmp_path / "bundled.toml") == as_built_limits()
    store.adopt_limits(table)
    store.write_limits(tmp_path / "own.toml")
    assert (tmp_path / "own.toml").read_text(encoding="utf-8") == OWN
    held = table.read_bytes()
    for path in (table, path_of("catalogue/as_built_limits.toml")):
        with pytest.raises(InUse):
            store.write_limits(path, never=(table,))
    assert table.read_bytes() == held


@pytest.mark.parametrize(
    "stored", [3, {"work": 3}, {"client": "x" * 101}, {"unknown": ""}, {"work": "a\nb"}]
)
def test_damaged_details_are_told_and_can_be_entered_anew(project: Project, stored) -> None:
    store = WorkStore(project.settings)
    project.settings.put("work_details", stored)
    with pytest.raises(BadFile, match=r"zuka_settings\.work_details"):
        store.details()
    store.keep_details(WorkDetails(work="造成"))
    assert store.details().work == "造成"


@pytest.mark.parametrize(
    "stored", ["x", {"file_name": "a.toml"}, {"file_name": 1}, {"work_type": 1}]
)
def test_damaged_limits_are_told_and_can_be_chosen_anew(
    project: Project, table: Path, stored
) -> None:
    store = WorkStore(project.settings)
    for choose in (store.drop_limits, lambda: store.adopt_limits(table)):
        project.settings.put("as_built_limits", stored)
        with pytest.raises(BadFile, match=r"zuka_settings\.as_built_limits"):
            store.limits()
        choose()
        assert store.limits().table.work_types
