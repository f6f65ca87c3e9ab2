"""A project keeps its templates by name and gives them to others as files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from processing.core.errors import BadFile, OutOfRange
from processing.project.project import Project
from processing.project.template_store import TemplateStore, export_template
from tests.processing.methods.templates.curb_street import CURB, WALL_FOOT


@pytest.fixture
def project(tmp_path: Path) -> Iterator[Project]:
    made = Project.create(tmp_path / "street.zuka", "EPSG:6677")
    yield made
    made.close()


def test_templates_are_there_when_the_project_is_opened_again(project: Project) -> None:
    store = TemplateStore(project.settings)
    store.put(CURB)
    store.put(WALL_FOOT)
    store.put(replace(CURB, tolerance_m=0.01))
    project.close()
    again = Project.open(project.folder)
    stored = TemplateStore(again.settings).all()
    again.close()
    assert stored == (replace(CURB, tolerance_m=0.01), WALL_FOOT)


def test_names_are_changed_and_stay_different(project: Project) -> None:
    store = TemplateStore(project.settings)
    store.put(CURB)
    store.put(WALL_FOOT)
    store.rename("curb", " 縁石 15cm ")
    assert [one.name for one in store.all()] == ["縁石 15cm", "step"]
    with pytest.raises(OutOfRange, match="already"):
        store.rename("step", "縁石 15cm")
    with pytest.raises(OutOfRange, match="needs a name"):
        store.rename("step", "  ")
    assert store.free_name("step") == "step 2"
    store.remove("縁石 15cm")
    assert store.all() == (WALL_FOOT,)


def test_a_file_brings_a_template_to_another_project(project: Project, tmp_path: Path) -> None:
    store = TemplateStore(project.settings)
    store.put(CURB)
    path = tmp_path / "curb.json"
    export_template(CURB, path)
    assert store.import_file(path) == replace(CURB, name="curb 2")
    assert store.get("curb 2") is not None
    path.write_text("{}", encoding="utf-8")
    with pytest.raises(BadFile, match="no template"):
        store.import_file(path)
    assert len(store.all()) == 2


def test_damaged_settings_are_named(project: Project) -> None:
    project.settings.put("templates", [{"format": "zuka-template"}])
    with pytest.raises(BadFile, match=r"zuka_settings\.templates"):
        TemplateStore(project.settings).all()
