"""The benchmarks of the window run it in a process of its own and read what it prints."""

from __future__ import annotations

import pytest

from app.cli.bench import CASES
from processing.core.errors import MissingInput
from processing.laboratory.bench.case import BenchmarkOptions
from processing.laboratory.bench.cases.start_case import measure_start

LITTLE = BenchmarkOptions(share=0.02)


def test_the_start_of_the_window_is_timed_from_outside() -> None:
    (row,) = CASES["start"](LITTLE)
    assert row.name == "start"
    assert row.value is not None
    assert 0 < row.value < 60


def test_the_review_gives_the_time_of_a_decision() -> None:
    (row,) = CASES["review"](LITTLE)
    assert row.name == "review"
    assert row.value is not None
    assert row.value > 0


def test_a_window_that_cant_be_shown_is_refused_with_its_last_words() -> None:
    with pytest.raises(MissingInput, match="could not be shown"):
        measure_start(LITTLE, window="processing.no_such_window")
