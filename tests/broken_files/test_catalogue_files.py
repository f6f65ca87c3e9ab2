"""A catalogue that is wrong is refused with the line that is wrong, and nothing else happens."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, MissingInput
from processing.map.catalogue_file import read_catalogue
from resources import path_of
from tests.broken_files.damage import check_refusal, flipped, outcome, overwritten

_GOOD = """[attribute.side]
ja = "左右"
en = "Side"
type = "choice"
choices = ["left", "right"]

[[kind]]
id = "post"
ja = "柱"
en = "Post"
geometry = "point"
dm_code = "4119"
layer = "4119_柱"
colour = "#d55e00"
aci = 30
line_type = "dashed"
symbol = "pole"
attributes = ["side"]
key = "4"

[[kind]]
id = "edge"
ja = "縁"
en = "Edge"
geometry = "line"
layer = "縁"
colour = "#56b4e9"
aci = 5
"""


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('geometry = "line"', 'geometry = "curve"', 25),
        ('colour = "#56b4e9"', 'colour = "blue"', 27),
        ('colour = "#d55e00"', 'colour = "#d55e0"', 14),
        ('ja = "柱"\n', "", 7),
        ('en = "Edge"', 'en = "  "', 24),
        ('en = "Side"', "en = 5", 3),
        ('id = "edge"', 'id = "post"', 22),
        ('id = "edge"', 'id = "Edge 1"', 22),
        ('id = "edge"', "", 21),
        ("aci = 5", "aci = 256", 28),
        ("aci = 5", "aci = true", 28),
        ("aci = 5", 'aci = 5\nthickness_m = "thin"', 29),
        ("aci = 5", "aci = 5\nthickness_m = -0.1", 29),
        ("aci = 5", "aci = 5\nthickness_m = nan", 29),
        ("aci = 5", 'aci = 5\nkey = "4"', 29),
        ("aci = 5", 'aci = 5\nkey = "a"', 29),
        ("aci = 5", 'aci = 5\ncolor = "#000000"', 29),
        ('line_type = "dashed"', 'line_type = "wavy"', 16),
        ('symbol = "pole"', 'symbol = "unicorn"', 17),
        ('dm_code = "4119"', 'dm_code = "41 9"', 12),
        ('layer = "縁"', 'layer = "縁/1"', 26),
        ('attributes = ["side"]', 'attributes = ["height_m"]', 18),
        ('attributes = ["side"]', 'attributes = ["side", "side"]', 18),
        ('attributes = ["side"]', "attributes = 5", 18),
        ('type = "choice"', 'type = "colour"', 4),
        ('type = "choice"', 'type = "text"', 5),
        ('choices = ["left", "right"]\n', "", 4),
        ('choices = ["left", "right"]', "choices = []", 4),
        ('choices = ["left", "right"]', 'choices = ["left", "left"]', 5),
        ('choices = ["left", "right"]', 'choices = { a = "b" }', 5),
        ("[attribute.side]", "[attribute.geom]", 1),
        ("[attribute.side]", "[attribut.side]", 1),
        ("[[kind]]", "[kind]", 21),
        ('id = "post"', 'id = "post', 8),
        ("aci = 30", "aci = 30 30", 15),
        ("aci = 30", "aci = " + "9" * 5000, 1),
        ("aci = 30", "aci = " + "[" * 5000, 1),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    path = tmp_path / "種別.toml"
    assert old in _GOOD
    path.write_text(_GOOD.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(BadFile) as refusal:
        read_catalogue(path)
    check_refusal(refusal.value, path)
    assert refusal.value.where.en.endswith(f"line {line}")


def test_the_catalogue_that_the_damages_start_from_is_good(tmp_path: Path) -> None:
    path = tmp_path / "good.toml"
    path.write_text(_GOOD, encoding="utf-8")
    assert len(read_catalogue(path)) == 2


@pytest.mark.parametrize("data", [b"", b"# nothing\n", b"kind = []\n", b"kind = [1]\n", b"\0" * 9])
def test_a_file_without_kinds_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "empty.toml"
    path.write_bytes(data)
    with pytest.raises(BadFile) as refusal:
        read_catalogue(path)
    check_refusal(refusal.value, path)


def test_kinds_in_one_inline_array_are_refused_with_the_arrays_line(tmp_path: Path) -> None:
    path = tmp_path / "inline.toml"
    path.write_text('\n\nkind = [{ id = "post" }]\n', encoding="utf-8")
    with pytest.raises(BadFile) as refusal:
        read_catalogue(path)
    assert refusal.value.where.en.endswith("line 3")


def test_a_missing_catalogue_is_told(tmp_path: Path) -> None:
    with pytest.raises(MissingInput):
        read_catalogue(tmp_path / "none.toml")


def test_a_catalogue_of_many_megabytes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "long.toml"
    path.write_text(_GOOD + "# " + "x" * (5 << 20), encoding="utf-8")
    with pytest.raises(BadFile):
        read_catalogue(path)


def test_a_damaged_catalogue_ends_in_kinds_or_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "damaged.toml"
    data = path_of("catalogue/level500.toml").read_bytes()[:6000]
    for damaged in (*flipped(_GOOD.encode(), 300, 3), *overwritten(data, 40, 4)):
        path.write_bytes(damaged)
        outcome(lambda: read_catalogue(path), path)


def test_a_catalogue_cut_at_any_byte_ends_in_kinds_or_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "cut.toml"
    data = _GOOD.encode("cp932")
    for size in range(len(data)):
        path.write_bytes(data[:size])
        outcome(lambda: read_catalogue(path), path)


@given(
    key=st.sampled_from(["id", "ja", "geometry", "layer", "colour", "aci", "attributes", "key"]),
    value=st.one_of(
        st.text(max_size=20).map(repr),
        st.integers().map(str),
        st.sampled_from(["[]", "{}", "[[1]]", "1979-05-27", "inf", "''", '"""\n"""', "{a = [1]}"]),
    ),
)
def test_any_value_of_any_key_ends_in_kinds_or_in_a_sentence(
    tmp_path_factory: pytest.TempPathFactory, key: str, value: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.toml"
    lines = [line for line in _GOOD.split("\n")[:19] if not line.startswith(f"{key} =")]
    text = "\n".join([*lines, f"{key} = {value}", ""])
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    outcome(lambda: read_catalogue(path), path)
