"""Templates as values and as files: what is kept, mirrored, moved, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.methods.templates.profile_template import MadeLine, ProfileTemplate
from processing.methods.templates.template_text import (
    parse_template,
    read_template,
    template_line,
    template_text,
)
from tests.processing.methods.templates.curb_street import CURB

GUTTER = ProfileTemplate(
    "側溝 L型",
    (((0.0, 0.0), (0.12, -0.1), (0.6, -0.08)), ((0.0, 0.0), (-0.25, 0.005))),
    (MadeLine("curb_upper"), MadeLine("gutter_l", (0.12, -0.1))),
    (((0.05, 0.05), (0.3, 0.05), (0.3, 0.3)),),
    0.015,
)


def test_a_template_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "側溝.json"
    path.write_text("\ufeff" + template_text(GUTTER), encoding="utf-8")
    assert read_template(path) == GUTTER
    assert parse_template(template_text(CURB), "here") == CURB
    line = template_line(GUTTER)
    assert line.startswith('{"name": "側溝 L型"')
    assert "\n" not in line
    assert parse_template(line, "here") == GUTTER


def test_mirrored_twice_it_is_the_same() -> None:
    assert GUTTER.mirrored() != GUTTER
    assert GUTTER.mirrored().mirrored() == GUTTER
    assert GUTTER.mirrored().kind_at((-0.12, -0.1)) == "gutter_l"


def test_about_another_vertex_the_shape_is_the_same() -> None:
    moved = GUTTER.about((0.12, -0.1))
    assert moved.kind_at((0.0, 0.0)) == "gutter_l"
    assert moved.length_m == pytest.approx(GUTTER.length_m)
    back = moved.about(moved.vertices[0])
    for mine, theirs in zip(back.vertices, GUTTER.vertices, strict=True):
        assert mine == pytest.approx(theirs)


def test_lines_at_vertices_are_chosen_and_taken_away() -> None:
    foot = (0.0, -0.15)
    assert CURB.with_kind_at(foot, "").kind_at(foot) == ""
    changed = CURB.with_kind_at(foot, "curb_lower")
    assert [line.kind for line in changed.lines] == ["curb_upper", "curb_lower"]
    assert CURB.with_kind_at((-0.3, 0.0), "a").lines[0].kind == "a"


@pytest.mark.parametrize(
    ("what", "changes"),
    [
        ("needs a name", {"name": " "}),
        ("at least two places", {"shape": (((0.0, 0.0),),)}),
        ("at least two places", {"shape": ()}),
        ("at least two places", {"shape": (((0.0, 0.0), (0.0, 0.0)),)}),
        ("at least three places", {"empty": (((0.0, 0.0), (1.0, 1.0)),)}),
        ("2 cm to 10 m", {"shape": (((0.0, 0.0), (0.0, 11.0)),)}),
        ("2 cm to 10 m", {"shape": (((0.0, 0.0), (float("nan"), 0.1)),)}),
        ("at vertices of the shape", {"lines": (MadeLine("curb", (0.5, 0.5)),)}),
        ("at vertices of the shape", {"shape": (((0.1, 0.0), (0.2, 0.0)),), "lines": ()}),
        ("3 mm to 20 cm", {"tolerance_m": 0.5}),
    ],
)
def test_what_is_no_profile_is_refused(what: str, changes: dict[str, object]) -> None:
    fields = {"name": "curb", "shape": CURB.shape, "lines": CURB.lines, **changes}
    with pytest.raises(OutOfRange, match=what):
        ProfileTemplate(**fields)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{",
        '{"format": "other"}',
        template_text(CURB).replace('"version": 1', '"version": 7'),
        template_text(CURB).replace('"name": "curb"', '"name": 3'),
        template_text(CURB).replace('"kind": "curb_upper"', '"kind": null', 1),
        template_text(CURB).replace("0.3", '"far"', 1),
        template_text(CURB).replace("0.3", "true", 1),
        template_text(CURB).replace("0.3", "1e999", 1),
        json.dumps({"format": "zuka-template", "version": 1, "name": "x", "shape": {}}),
        json.dumps({"format": "zuka-template", "version": 1, "name": "x", "shape": [[[1]]]}),
        "[" * 100_000,
    ],
)
def test_what_is_no_template_is_refused_with_its_place(text: str) -> None:
    with pytest.raises(BadFile) as caught:
        parse_template(text, "street.json")
    assert "street.json" in caught.value.line("en")
    assert "street.json" in caught.value.line("ja")


def test_files_that_are_missing_or_no_text_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MissingInput):
        read_template(tmp_path / "none.json")
    (tmp_path / "a.json").write_bytes(b"\xff\xfe\x00{")
    with pytest.raises(BadFile, match="UTF-8"):
        read_template(tmp_path / "a.json")
    (tmp_path / "b.json").write_bytes(b" " * (2 << 20))
    with pytest.raises(BadFile, match="too large"):
        read_template(tmp_path / "b.json")
