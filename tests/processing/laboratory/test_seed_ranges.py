"""Seeds as words of a command: ranges, single ones, and several of both."""

from __future__ import annotations

import pytest

from processing.laboratory.seed_ranges import seeds_of


@pytest.mark.parametrize(
    ("text", "seeds"),
    [("", ()), ("7", (7,)), ("7-9", (7, 8, 9)), ("7-8,11,20-21", (7, 8, 11, 20, 21))],
)
def test_words_are_seeds(text: str, seeds: tuple[int, ...]) -> None:
    assert seeds_of(text) == seeds
