"""What an office says of a work: in a file of its own, and kept with a project."""

from __future__ import annotations

from dataclasses import asdict, fields
from datetime import date
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.core.parameters import MOST_LETTERS, parameters_of
from processing.project.work_details import WorkDetails, details_of, read_work_details

DETAILS = WorkDetails(
    work="令和8年度 国道1号改良工事",
    place="No.0〜No.12",
    client="国土交通省 関東地方整備局",
    contractor="株式会社 髙橋組",
    surveyor="吉田 﨑子",
    height_datum="JGD2024",
)
ALL = "".join(f'{name} = "{value}"\n' for name, value in asdict(DETAILS).items())


def written(folder: Path, text: str) -> Path:
    path = folder / "工事.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_gives_every_detail(tmp_path: Path) -> None:
    assert read_work_details(written(tmp_path, ALL)) == DETAILS


def test_what_a_file_leaves_out_is_blank(tmp_path: Path) -> None:
    assert read_work_details(written(tmp_path, "")) == WorkDetails()
    assert read_work_details(written(tmp_path, 'client = " A県 "')) == WorkDetails(client="A県")


def test_windows_line_ends_and_a_mark_are_read(tmp_path: Path) -> None:
    path = tmp_path / "work.toml"
    path.write_bytes(b"\xef\xbb\xbf" + ALL.replace("\n", "\r\n").encode())
    assert read_work_details(path) == DETAILS


@pytest.mark.parametrize(
    ("old", "new", "line", "said"),
    [
        ("client", "customer", 3, "“customer”"),
        ('height_datum = "JGD2024"', "height_datum = 2024", 6, "“height_datum”"),
        ('surveyor = "', 'surveyor = "\\u0007', 5, "“surveyor”"),
        ('surveyor = "', 'surveyor = "x\\n', 5, "“surveyor”"),
        ('place = "', f'place = "{"あ" * MOST_LETTERS}', 2, "100 letters"),
        ('client = "国土交通省 関東地方整備局"', "[client]", 3, "“client”"),
        ('client = "', "client = ", 3, "not TOML"),
        ("place = ", "client = ", 3, "not TOML"),
    ],
)
def test_a_bad_entry_is_told_with_its_line(
    tmp_path: Path, old: str, new: str, line: int, said: str
) -> None:
    assert old in ALL
    text = ALL.replace(old, new, 1)
    if new == "[client]":
        text = "\n\n[client]\n"
    with pytest.raises(BadFile, match=said) as told:
        read_work_details(written(tmp_path, text))
    assert told.value.where.en.endswith(f"line {line}")
    assert "\n" not in told.value.line("ja")


def test_a_file_that_is_no_text_or_too_long_or_not_there_is_told(tmp_path: Path) -> None:
    path = tmp_path / "work.toml"
    path.write_bytes("work = '道路'".encode("cp932"))
    with pytest.raises(BadFile, match="not text in UTF-8"):
        read_work_details(path)
    path.write_bytes(b"#" * (2 << 20))
    with pytest.raises(BadFile, match="too long"):
        read_work_details(path)
    with pytest.raises(MissingInput):
        read_work_details(tmp_path / "none.toml")


def test_every_detail_stands_in_the_facts_of_a_paper() -> None:
    facts = DETAILS.facts("EPSG:6677", "1.2", date(2026, 11, 22))
    for one in fields(WorkDetails):
        assert getattr(facts, one.name) == getattr(DETAILS, one.name)
    assert (facts.crs, facts.software, facts.made_on) == (
        "EPSG:6677",
        "Zuka 1.2",
        date(2026, 11, 22),
    )


def test_every_detail_has_a_name_in_both_languages() -> None:
    for one in parameters_of(WorkDetails):
        assert one.name.en
        assert one.name.ja


@given(st.text(st.characters(exclude_categories=("Cc", "Cs", "Zl", "Zp")), max_size=MOST_LETTERS))
def test_any_line_of_words_is_kept_without_the_blanks_around_it(words: str) -> None:
    assert details_of({"contractor": words}).contractor == words.strip()


@pytest.mark.parametrize("words", ["a\nb", "a\tb", "a\u2028b", "\ud800", "x" * 101])
def test_what_is_no_short_line_is_refused(words: str) -> None:
    with pytest.raises(OutOfRange, match="one line of up to 100 letters"):
        details_of({"work": words})
