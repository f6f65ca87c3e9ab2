"""The table of benchmarks: a page made of what runs measured, and the same as JSON beside it."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from processing.core.errors import report_as_user_error
from processing.core.safe_write import write_safely
from processing.laboratory.bench.case import Measurement

KEPT = "## What the figures mean"
"""From this heading on, the page is written by people, and stays."""

_HEAD = "| name | what | measured | target | met | behind it |\n|---|---|---|---|---|---|\n"
_QUIET = 1.0
"""More processes than that before the first benchmark are others."""
_MET = {True: "yes", False: "**no**", None: "–"}


@dataclass(frozen=True)
class Circumstances:
    """When, how and where something was measured.

    Attributes
    ----------
    command : str
        As it was typed.
    machine : str
        Cores, memory, system, Python; no names.
    load : tuple of float
        How many processes wanted a core, in the last minute before and at the end; empty where
        the system doesn't tell.
    """

    command: str
    date: str
    machine: str
    load: tuple[float, ...]

    @staticmethod
    def of(command: str, load: tuple[float, ...]) -> Circumstances:
        """Those of now."""
        return Circumstances(
            command, datetime.now(UTC).date().isoformat(), _machine(), load + load_now()
        )


def load_now() -> tuple[float, ...]:
    """How many processes wanted a core in the last minute; empty where the system doesn't tell."""
    return (round(os.getloadavg()[0], 1),) if hasattr(os, "getloadavg") else ()


def write_table(page: Path, circumstances: Circumstances, rows: Sequence[Measurement]) -> None:
    """Put rows into a page and into the JSON beside it.

    Rows of earlier runs stay, each with its circumstances, unless they are measured again; what
    could not be measured now, for want of a peer, replaces nothing that was.

    Parameters
    ----------
    page : Path
        Markdown; ``.json`` beside it has the same figures.

    Raises
    ------
    NoSpace
    """
    data = page.with_suffix(".json")
    with report_as_user_error(page):
        before = json.loads(data.read_text("utf-8")) if data.exists() else []
        text = page.read_text("utf-8") if page.exists() else ""
    measured = {one["name"] for run in before for one in run["rows"] if one["value"] is not None}
    rows = [row for row in rows if row.value is not None or row.name not in measured]
    new = {row.name for row in rows}
    runs = [
        {**run, "rows": [one for one in run["rows"] if one["name"] not in new]} for run in before
    ]
    runs = [run for run in runs if run["rows"]]
    if rows:
        runs.append(_describe_rows(circumstances, rows))
    kept = KEPT + text.partition(KEPT)[2] if KEPT in text else f"{KEPT}\n"
    with write_safely(data) as path:
        path.write_text(json.dumps(runs, ensure_ascii=False, indent=1) + "\n", "utf-8")
    with write_safely(page) as path:
        path.write_text(_page_of(runs) + kept, "utf-8")


def describe_row(row: Measurement) -> dict[str, object]:
    """A row as JSON has it."""
    return {
        "name": row.name,
        "what": {"en": row.what.en, "ja": row.what.ja},
        "value": row.value,
        "unit": row.unit,
        "target": row.target,
        "is_at_most": row.is_at_most,
        "is_met": row.is_met,
        "detail": row.detail,
        "figures": dict(row.figures),
    }


def number(value: float) -> str:
    """With as many digits as say something."""
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


def _describe_rows(circumstances: Circumstances, rows: Sequence[Measurement]) -> dict[str, object]:
    return {
        "command": circumstances.command,
        "date": circumstances.date,
        "machine": circumstances.machine,
        "load": list(circumstances.load),
        "rows": [describe_row(row) for row in rows],
    }


_Json = Mapping[str, Any]  # as JSON gives it


def _page_of(runs: Sequence[_Json]) -> str:
    parts = ["# Benchmarks\n", *map(_section, runs)]
    return "\n".join(parts) + "\n"


def _section(run: _Json) -> str:
    load = " to ".join(f"{one:g}" for one in run["load"])
    reported = f"{run['date']}; {run['machine']}."
    if load:
        reported += f" Processes that wanted a core, before and after: {load}."
        if run["load"][0] > _QUIET:
            reported += " **The machine was busy with other work.**"
    lines = "".join(map(_line, run["rows"]))
    return f"## `{run['command']}`\n\n{reported}\n\n{_HEAD}{lines}"


def _line(row: _Json) -> str:
    measured = "–" if row["value"] is None else f"{number(row['value'])} {row['unit']}"
    sign = "≤" if row["is_at_most"] else "≥"
    target = "–" if row["target"] is None else f"{sign} {row['target']:g} {row['unit']}"
    cells = [
        f"`{row['name']}`",
        row["what"]["en"],
        measured,
        target,
        _MET[row["is_met"]],
        row["detail"],
    ]
    return "| " + " | ".join(cells) + " |\n"


def _machine() -> str:
    facts = [f"{os.cpu_count()} cores of {platform.machine()}"]
    memory = _memory_bytes()
    if memory:
        facts.append(f"{memory / 1024**3:.0f} GiB of memory")
    return ", ".join([*facts, _system(), f"Python {platform.python_version()}"])


def _memory_bytes() -> int:
    if "SC_PHYS_PAGES" not in getattr(os, "sysconf_names", {}):
        return 0
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def _system() -> str:
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:  # not a Linux that tells
        return f"{platform.system()} {platform.release()}"
