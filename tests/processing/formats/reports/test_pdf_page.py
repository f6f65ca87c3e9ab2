from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from processing.formats.reports.pdf_page import break_lines, drawable, width_of
from processing.formats.work_facts import crs_words, format_signed

WORDS = st.text(st.sampled_from("あ漢、。（）a-1 .mxyz"), max_size=60)


@given(WORDS, st.floats(12.0, 80.0))
def test_wrapped_lines_hold_every_word_and_are_no_wider(words: str, width: float) -> None:
    lines = break_lines(words, 8.0, width)
    assert "".join("".join(lines).split()) == "".join(words.split())
    assert all(width_of(line, 8.0) <= width + 1e-6 for line in lines)


def test_lines_break_between_words_and_not_before_a_full_stop() -> None:
    assert break_lines("one two three", 8.0, width_of("one two ", 8.0)) == ["one two", "three"]
    lines = break_lines("設計値より高い。低い", 8.0, width_of("設計値より高い", 8.0))
    assert lines == ["設計値より高", "い。低い"]


def test_a_number_stays_with_its_sign_and_its_unit() -> None:
    for words in ("誤差は −0.003 m である", "面積は ±36.5 m³ 以内", "割合は 95 % である"):
        number = next(one for one in ("−0.003 m", "±36.5 m³", "95 %") if one in words)
        for width in range(16, 40):
            lines = break_lines(words, 8.0, float(width))
            assert any(number in line for line in lines), (width, lines)


def test_a_name_without_places_to_break_is_broken_where_the_line_is_full() -> None:
    lines = break_lines("a" * 90, 8.0, 40.0)
    assert "".join(lines) == "a" * 90
    assert len(lines) > 2


def test_the_font_has_what_japanese_offices_write() -> None:
    for words in ("髙﨑㈱①Ⅱ㎡㎥−±÷×…～〜", "計画地盤高 1,234.5 m³", "Größe é"):
        assert "〓" not in drawable(words)


def test_zones_are_named_as_surveyors_name_them() -> None:
    assert crs_words("EPSG:6677").ja == "平面直角座標系 第9系（JGD2011、EPSG:6677）"
    assert crs_words("EPSG:6687").ja.startswith("平面直角座標系 第19系")
    assert crs_words("EPSG:32654").en == "WGS 84 / UTM zone 54N (EPSG:32654)"
    assert crs_words("").ja == "—"
    assert crs_words("EPSG:1").en == "EPSG:1"


def test_numbers_have_a_sign_and_zero_has_none() -> None:
    assert format_signed(1234.56, 1) == "+1,234.6"
    assert format_signed(-0.26, 1) == "−0.3"
    assert format_signed(-0.04, 1) == "0.0"
