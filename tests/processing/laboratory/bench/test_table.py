"""The page of benchmarks is made by the command, and keeps what people wrote."""

from __future__ import annotations

import json
from pathlib import Path

from processing.core.text import Text
from processing.laboratory.bench.case import Measurement
from processing.laboratory.bench.table import KEPT, Circumstances, write_table

FIRST = Circumstances("zuka bench import", "2026-01-01", "2 cores", (0.1, 2.0))
SECOND = Circumstances("zuka bench start", "2026-02-02", "4 cores", ())


def row(name: str, value: float | None, target: float | None = 2.0) -> Measurement:
    what = Text(f"What {name} is", f"{name}とは")
    return Measurement(name, what, value, "x", target, is_at_most=True, detail="behind")


def test_a_page_says_command_machine_load_and_whether_targets_are_met(tmp_path: Path) -> None:
    page = tmp_path / "benchmarks.md"
    write_table(page, FIRST, [row("a", 1.5), row("b", 1234.5), row("c", None), row("d", 1.0, None)])
    text = page.read_text("utf-8")
    assert "## `zuka bench import`\n\n2026-01-01; 2 cores. Processes" in text
    assert "| `a` | What a is | 1.50 x | ≤ 2 x | yes | behind |" in text
    assert "| `b` | What b is | 1,234 x | ≤ 2 x | **no** | behind |" in text
    assert "| `c` | What c is | – | ≤ 2 x | – | behind |" in text
    assert "| `d` | What d is | 1.00 x | – | – | behind |" in text


def test_a_busy_machine_is_told(tmp_path: Path) -> None:
    page = tmp_path / "benchmarks.md"
    write_table(page, FIRST, [row("a", 1.0)])
    assert "busy" not in page.read_text("utf-8")
    write_table(page, Circumstances("zuka bench b", "", "", (3.5, 1.0)), [row("b", 1.0)])
    assert "before and after: 3.5 to 1. **The machine was busy" in page.read_text("utf-8")


def test_rows_measured_again_are_replaced_and_others_stay(tmp_path: Path) -> None:
    page = tmp_path / "benchmarks.md"
    write_table(page, FIRST, [row("a", 1.0), row("b", 1.25)])
    write_table(page, SECOND, [row("b", 1.75)])
    runs = json.loads((tmp_path / "benchmarks.json").read_text("utf-8"))
    assert [[one["name"] for one in run["rows"]] for run in runs] == [["a"], ["b"]]
    assert runs[1]["rows"][0]["value"] == 1.75
    assert runs[1]["command"] == "zuka bench start"
    write_table(page, SECOND, [row("a", 1.0)])
    assert "zuka bench import" not in page.read_text("utf-8")


def test_what_people_wrote_below_the_table_stays(tmp_path: Path) -> None:
    page = tmp_path / "benchmarks.md"
    page.write_text(f"# Old\n\n{KEPT}\n\nBecause of this.\n", "utf-8")
    write_table(page, FIRST, [row("a", 1.0)])
    text = page.read_text("utf-8")
    assert text.endswith(f"{KEPT}\n\nBecause of this.\n")
    assert "# Old" not in text


def test_what_could_not_be_measured_now_replaces_no_figure(tmp_path: Path) -> None:
    page = tmp_path / "benchmarks.md"
    write_table(page, FIRST, [row("a", 1.5)])
    write_table(page, SECOND, [row("a", None)])
    assert "| `a` | What a is | 1.50 x |" in page.read_text("utf-8")
    assert "zuka bench start" not in page.read_text("utf-8")
