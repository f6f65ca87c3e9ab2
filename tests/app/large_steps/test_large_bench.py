"""The benchmark of a large project uses a real window from the delivery to the export."""

from __future__ import annotations

from app.cli.bench import CASES
from processing.laboratory.bench.case import BenchmarkOptions


def test_every_step_is_done_and_told_on_little_data() -> None:
    rows = {row.name: row for row in CASES["large"](BenchmarkOptions(points=300_000, share=0.02))}
    assert len(rows) == 18
    for name, row in rows.items():
        if "memory" not in name:
            assert row.value is not None, name
            assert row.value > 0, name
    assert rows["large-pan"].figures["count"] == 1
    assert rows["large-open"].figures["longest_pause_ms"] > 0
