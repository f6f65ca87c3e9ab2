"""Text is read in the encodings that Japanese offices deliver, and refused otherwise."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import BadFile
from processing.core.japanese_text import decode_text, read_lines

_WORDS = "縁石①，12.5ｍ～表"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp932", "utf-16"])
def test_every_usual_encoding_gives_the_same_words(encoding: str) -> None:
    assert decode_text(_WORDS.encode(encoding), Path("a.csv")) == _WORDS


def test_lines_end_in_any_way_and_keep_rare_marks(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_bytes("一\r\n二\n三\r四\x0b五".encode("cp932"))
    assert read_lines(path) == ["一", "二", "三", "四\x0b五"]


@pytest.mark.parametrize(
    "data", [b"ab\x00cd", b"\xef\xbb\xbfok\xff\xfe", b"a\x81\x20b", b"\xff\xfea"]
)
def test_what_is_no_text_is_told_with_its_byte(data: bytes) -> None:
    with pytest.raises(BadFile) as refusal:
        decode_text(data, Path("図面.csv"))
    assert "図面.csv" in refusal.value.where.ja
    assert "byte" in refusal.value.where.en
