"""An office's own catalogue in a project: nothing drawn loses its kind, nothing half is written."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, InUse, Unsuitable, UserError
from processing.core.text import Text
from processing.map.catalogue import (
    LINE_TYPES,
    AttributeField,
    AttributeType,
    Catalogue,
    FeatureKind,
    Geometry,
)
from processing.map.catalogue_change import compare, keep_used_kinds
from processing.map.catalogue_file import read_catalogue, symbol_names
from processing.map.catalogue_writing import write_catalogue
from processing.map.change import Change
from processing.project.project import Project
from resources import path_of
from tests.processing.project.drawn import LABEL, curb, features_of, new_project, sign, tree_of


@pytest.fixture(scope="module")
def bundled() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return new_project(tmp_path / "a.zuka", curb("a"), curb("b"), sign("s"))


def _office(folder: Path, catalogue: Catalogue) -> Path:
    path = folder / "事務所.toml"
    write_catalogue(path, catalogue)
    return path


def _without(catalogue: Catalogue, *ids: str) -> Catalogue:
    return Catalogue(tuple(kind for kind in catalogue if kind.id not in ids))


def _with(catalogue: Catalogue, id_: str, **values: object) -> Catalogue:
    return Catalogue(
        tuple(
            replace(kind, **values) if kind.id == id_ else kind  # type: ignore[arg-type]
            for kind in catalogue
        )
    )


def _layers(folder: Path) -> dict[str, str]:
    with closing(sqlite3.connect(folder / "project.gpkg")) as connection:
        return dict(connection.execute("SELECT id, layer FROM features"))


def test_a_comparison_says_what_is_new_changed_and_gone(bundled: Catalogue) -> None:
    kind = replace(bundled["mirror"], id="mirror_2", name=Text("Mirror {2}", "鏡{2}"))
    new = Catalogue((*_without(_with(bundled, "sign", aci=7), "mirror", "curb_lower"), kind))
    found = compare(bundled, new, [curb("a"), curb("b"), sign("s")])
    assert [one.id for one in found.added] == ["mirror_2"]
    assert {one.id for one in found.removed} == {"mirror", "curb_lower"}
    assert [one.id for one in found.changed] == ["sign"]
    assert dict(found.used_missing) == {"curb_lower": 2}
    assert dict(found.used_reshaped) == {}
    assert not found.loses_nothing
    assert [text.en for text in found.texts()] == [
        "New kinds: Mirror {2}",
        "Changed kinds: Sign",
        "Kinds that go, used by nothing: Convex mirror",
        "Missing kinds that features use: Curb, lower edge (2)",
    ]


def test_the_same_catalogue_changes_nothing(bundled: Catalogue) -> None:
    found = compare(bundled, bundled, [curb("a"), replace(sign("b"), kind="of_another_time")])
    assert found.loses_nothing
    assert found.texts() == ()
    assert keep_used_kinds(bundled, found) == bundled


def test_a_kind_that_did_not_fit_before_is_no_obstacle(bundled: Catalogue) -> None:
    odd = replace(curb("a"), kind="sign")
    assert compare(bundled, bundled, [odd]).loses_nothing
    orphan = replace(curb("a"), kind="new")
    new = Catalogue((replace(bundled["sign"], id="new"),))
    assert dict(compare(bundled, new, [orphan]).used_reshaped) == {"new": 1}


def test_an_adopted_catalogue_is_drawn_by_now_and_after_a_restart(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    office = _office(tmp_path, _with(bundled, "curb_lower", layer="縁石", colour="#123456"))
    before = office.read_bytes()
    with closing(Project.open(folder)) as project:
        found = project.adopt_catalogue(office)
        assert [kind.id for kind in found.changed] == ["curb_lower"]
        assert project.catalogue["curb_lower"].colour == "#123456"
        assert _layers(folder) == {"a": "縁石", "b": "縁石", "s": "標識"}
        project.features.apply(LABEL, Change(added=(curb("c"),)))
        assert _layers(folder)["c"] == "縁石"
    office.unlink()
    with closing(Project.open(folder, writing=False)) as project:
        assert project.catalogue["curb_lower"].layer == "縁石"
    assert b"#123456" in before


@pytest.mark.parametrize("keep_used", [False, True])
def test_a_bad_file_is_refused_with_its_line_and_nothing_happens(
    tmp_path: Path, folder: Path, keep_used: bool
) -> None:
    office = tmp_path / "bad.toml"
    office.write_text('[[kind]]\nid = "post"\n', encoding="utf-8")
    before = tree_of(folder)
    with closing(Project.open(folder)) as project:
        catalogue = project.catalogue
        for act in (project.compare_catalogue, project.adopt_catalogue):
            with pytest.raises(BadFile) as refusal:
                act(office)
            assert "line 1" in refusal.value.where.en
        with pytest.raises(BadFile):
            project.adopt_catalogue(office, keep_used=keep_used)
        assert project.catalogue == catalogue
    assert tree_of(folder) == before


def test_a_catalogue_without_a_used_kind_is_refused_with_the_counts(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    office = _office(tmp_path, _without(bundled, "curb_lower", "sign", "mirror"))
    before = tree_of(folder)
    with closing(Project.open(folder)) as project:
        with pytest.raises(Unsuitable) as refusal:
            project.adopt_catalogue(office)
        assert project.catalogue == bundled
    assert "Curb, lower edge (2), Sign (1)" in refusal.value.what.en
    assert "縁石下端（2）、標識（1）" in refusal.value.what.ja
    assert office.name in refusal.value.where.en
    assert tree_of(folder) == before


def test_used_kinds_are_kept_in_the_projects_copy_when_asked(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    own = replace(bundled["mirror"], id="own", key="1")
    office = _office(tmp_path, Catalogue((own,)))
    before = office.read_bytes()
    with closing(Project.open(folder)) as project:
        project.adopt_catalogue(office, keep_used=True)
        kept = project.catalogue
        assert [kind.id for kind in kept] == ["own", "curb_lower", "sign"]
        assert kept["curb_lower"] == replace(bundled["curb_lower"], key="")
        assert kept["sign"] == bundled["sign"]
    assert office.read_bytes() == before
    with closing(Project.open(folder)) as project:
        assert project.catalogue == kept


def test_another_geometry_of_a_used_kind_is_refused_even_when_kinds_are_kept(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    office = _office(tmp_path, _with(bundled, "curb_lower", geometry=Geometry.AREA))
    before = tree_of(folder)
    with closing(Project.open(folder)) as project, pytest.raises(Unsuitable) as refusal:
        project.adopt_catalogue(office, keep_used=True)
    assert "Curb, lower edge (2)" in refusal.value.what.en
    assert tree_of(folder) == before


def test_features_whose_kind_is_gone_come_back_by_undo_and_go_again(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    with closing(Project.open(folder)) as project:
        drawn = features_of(project)
        project.features.apply(LABEL, Change(removed=(drawn["s"],)))
        project.adopt_catalogue(_office(tmp_path, _without(bundled, "sign")))
        project.features.undo()
        assert features_of(project) == drawn
        assert _layers(folder)["s"] == ""
        assert "sign" not in project.catalogue
    with closing(Project.open(folder)) as project:
        assert features_of(project) == drawn
        project.features.redo()
        assert set(features_of(project)) == {"a", "b"}
        project.features.undo()
        project.adopt_catalogue(path_of("catalogue/level500.toml"))
        assert _layers(folder)["s"] == "標識"


def test_a_copy_that_was_edited_by_hand_is_adopted_from_its_place(
    folder: Path, bundled: Catalogue
) -> None:
    own = folder / "catalogue.toml"
    with closing(Project.open(folder)) as project:
        project.adopt_catalogue(path_of("catalogue/level500.toml"))
        text = own.read_text(encoding="utf-8")
        own.write_text(text.replace("縁石下端", "新しい縁石"), encoding="utf-8")
        project.adopt_catalogue(own)
        assert project.catalogue["curb_lower"].layer == "新しい縁石"
    assert _layers(folder)["a"] == "新しい縁石"
    assert bundled["curb_lower"].layer == "縁石下端"


def test_layers_follow_a_catalogue_that_was_written_while_the_project_was_closed(
    folder: Path, bundled: Catalogue
) -> None:
    write_catalogue(folder / "catalogue.toml", _with(bundled, "sign", layer="板"))
    with closing(Project.open(folder, writing=False)):
        assert _layers(folder)["s"] == "標識"
    with closing(Project.open(folder)):
        assert _layers(folder)["s"] == "板"
    before = tree_of(folder)
    Project.open(folder).close()
    assert tree_of(folder) == before


def test_a_catalogue_that_cannot_take_its_place_leaves_layers_and_kinds(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    office = _office(tmp_path, _with(bundled, "sign", layer="板"))
    with closing(Project.open(folder)) as project:
        blocked = folder / "catalogue.toml"
        (blocked / "in the way").mkdir(parents=True)
        with pytest.raises(UserError):
            project.adopt_catalogue(office)
        assert project.catalogue == bundled
        assert _layers(folder)["s"] == "標識"
        project.features.apply(LABEL, Change(added=(sign("t"),)))
        assert _layers(folder)["t"] == "標識"
    assert sorted(path.name for path in blocked.iterdir()) == ["in the way"]


def test_a_database_that_another_program_holds_leaves_no_catalogue_behind(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    office = _office(tmp_path, _with(bundled, "sign", layer="板"))
    with closing(Project.open(folder)) as project:
        with closing(sqlite3.connect(folder / "project.gpkg")) as other:
            other.execute("BEGIN IMMEDIATE")
            with pytest.raises(InUse):
                project.adopt_catalogue(office)
            other.execute("ROLLBACK")
        assert project.catalogue == bundled
        assert not (folder / "catalogue.toml").exists()
        project.adopt_catalogue(office)
        assert _layers(folder)["s"] == "板"


_ON_A_FULL_DISK = """
import resource, sys
from pathlib import Path
from processing.core.errors import UserError
from processing.project.project import Project
folder, office = Path(sys.argv[1]), Path(sys.argv[2])
project = Project.open(folder)
before = project.catalogue
soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]), hard))
try:
    project.adopt_catalogue(office)
except UserError as error:
    print(type(error).__name__, file=sys.stderr)
    assert project.catalogue == before
    print("refused")
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
project.close()
"""


@pytest.mark.parametrize("most_bytes", [0, 5000, 40_000])
def test_on_a_full_disk_the_old_catalogue_stays(
    tmp_path: Path, folder: Path, bundled: Catalogue, most_bytes: int
) -> None:
    office = _office(tmp_path, _with(bundled, "sign", layer="板"))
    command = [sys.executable, "-c", _ON_A_FULL_DISK, str(folder), str(office), str(most_bytes)]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    assert told.stdout.strip() == "refused", told.stderr
    with closing(Project.open(folder)) as project:
        assert project.catalogue == bundled
    assert _layers(folder)["s"] == "標識"
    assert sorted(path.suffix for path in folder.iterdir() if path.name != "lock") == [".gpkg"]


def test_a_template_is_written_for_an_office_but_never_over_files_in_use(
    tmp_path: Path, folder: Path, bundled: Catalogue
) -> None:
    template = tmp_path / "new" / "雛形.toml"
    with closing(Project.open(folder)) as project:
        project.export_catalogue(template)
        assert read_catalogue(template) == bundled
        project.adopt_catalogue(template)
        for taken in (
            folder / "project.gpkg",
            folder / "catalogue.toml",
            path_of("catalogue/level500.toml"),
        ):
            before = taken.read_bytes()
            with pytest.raises(InUse):
                project.export_catalogue(taken)
            assert taken.read_bytes() == before


def test_a_catalogue_that_could_not_be_read_again_is_not_written(
    tmp_path: Path, bundled: Catalogue
) -> None:
    path = tmp_path / "a.toml"
    with pytest.raises(BadFile):
        write_catalogue(path, _with(bundled, "sign", layer="a/b"))
    with pytest.raises(BadFile):
        write_catalogue(path, _with(bundled, "sign", name=Text("x" * (5 << 20), "標識")))
    assert list(tmp_path.iterdir()) == []


_words = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=8).filter(str.strip)
_ids = st.from_regex(r"[a-z][a-z0-9_]{0,3}", fullmatch=True).filter(lambda one: one != "id")
_texts = st.builds(Text, _words, _words)


@st.composite
def _attributes(draw: st.DrawFn) -> AttributeField:
    type_ = draw(st.sampled_from(get_args(AttributeType)))
    choices = draw(st.lists(_words, min_size=1, max_size=3, unique=True))
    if type_ != "choice":
        choices = []
    names = tuple(draw(_texts) for _ in choices)
    unit = draw(st.sampled_from(["", "m", "°", '"', "\\"]))
    return AttributeField(draw(_ids), draw(_texts), type_, unit, tuple(choices), names)


@st.composite
def _catalogues(draw: st.DrawFn) -> Catalogue:
    fields = draw(st.lists(_attributes(), max_size=6))
    ids = draw(st.lists(_ids, min_size=1, max_size=4, unique=True))
    keys = draw(st.permutations("1234567890"))
    kinds = []
    for number, id_ in enumerate(ids):
        several = draw(st.lists(st.sampled_from(fields), max_size=4)) if fields else []
        attributes = {field.id: field for field in several}
        kinds.append(
            FeatureKind(
                id_,
                draw(_texts),
                draw(st.sampled_from(Geometry)),
                draw(st.sampled_from(["", "2101", "0000"])),
                draw(st.sampled_from(["縁石", "2101_道路縁", "a b (c)"])),
                draw(st.from_regex(r"#[0-9a-f]{6}", fullmatch=True)),
                draw(st.integers(1, 255)),
                draw(st.sampled_from(sorted(LINE_TYPES))),
                draw(st.sampled_from(["", *symbol_names()])),
                tuple(attributes.values()),
                draw(st.sampled_from(["", keys[number]])),
            )
        )
    return Catalogue(tuple(kinds))


@given(catalogue=_catalogues())
def test_what_is_written_is_read_the_same(
    tmp_path_factory: pytest.TempPathFactory, catalogue: Catalogue
) -> None:
    path = tmp_path_factory.getbasetemp() / "round.toml"
    write_catalogue(path, catalogue)
    assert read_catalogue(path) == catalogue


def test_the_bundled_catalogue_is_written_and_read_the_same(
    tmp_path: Path, bundled: Catalogue
) -> None:
    write_catalogue(tmp_path / "a.toml", bundled)
    assert read_catalogue(tmp_path / "a.toml") == bundled
