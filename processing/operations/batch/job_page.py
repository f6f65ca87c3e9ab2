"""What is done, what is left and what went wrong: a page for a browser, and the same as JSON."""

from __future__ import annotations

import html
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.operations.batch.unit_state import LOG_FILE, TaskState, UnitProgress, UnitState

PAGE, STATUS = "index.html", "status.json"

Standing = Literal["waiting", "working", "done", "failed", "stopped"]

STANDINGS: dict[Standing, Text] = {
    "waiting": Text("waiting", "待機中"),
    "working": Text("at work", "処理中"),
    "done": Text("done", "完了"),
    "failed": Text("failed", "失敗"),
    "stopped": Text("stopped", "中断"),
}
_HEADINGS = (
    Text("Drive", "走行データ"),
    Text("State", "状態"),
    Text("Done", "進捗"),
    Text("Time", "時間"),
    Text("Memory", "メモリー"),
    Text("What", "内容"),
    Text("Log", "ログ"),
)
_COUNTED = Text(
    "{done} of {every} done, {failed} failed", "{every}件中 完了{done}件、失敗{failed}件"
)
_LEFT = Text("about {time} left", "残り約{time}")
_NOW = Text("now {held}, at most {peak}", "現在 {held}、最大 {peak}")
_STYLE = (
    "body{font:13px 'Noto Sans','Noto Sans CJK JP',sans-serif;margin:16px;color:#222}"
    "table{border-collapse:collapse}th,td{text-align:left;padding:4px 12px 4px 0;"
    "border-bottom:1px solid #ddd;vertical-align:top}td.n{text-align:right;"
    "font-variant-numeric:tabular-nums}tr.failed td{color:#a03000}progress{width:120px}"
    "@media(prefers-color-scheme:dark){body{background:#1e1e1e;color:#ddd}"
    "th,td{border-color:#444}tr.failed td{color:#ff9060}}"
)
_MIB = 1 << 20
_EVERY_S = 2


@dataclass(frozen=True)
class UnitRow:
    """How a drive stands.

    Attributes
    ----------
    size : int
        Bytes that were delivered.
    seconds : float
        Since work on it began, or that it took.
    """

    state: UnitState
    standing: Standing
    progress: UnitProgress = field(default_factory=UnitProgress)
    size: int = 0
    seconds: float = 0.0
    folder: Path = Path()

    @property
    def fraction(self) -> float:
        """0 to 1."""
        is_over = self.standing in ("done", "failed")
        return 1.0 if is_over else self.progress.fraction

    @property
    def peak_bytes(self) -> int:
        """The most memory that its processes held, of no file."""
        return max(self.state.peak_bytes, self.progress.peak_bytes)

    @property
    def words(self) -> tuple[Text, ...]:
        """What it does, what came of it, or what went wrong."""
        if self.standing == "failed":
            errors = (one.error for one in self.state.troubles)
            return tuple(one.what for one in errors if one is not None)
        if self.standing == "working":
            return (self.progress.text,)
        return tuple(word for one in self.state.tasks for word in one.words)


@dataclass(frozen=True)
class BatchStatus:
    """How a job stands.

    Attributes
    ----------
    left_s : float or None
        Seconds that are left, by the bytes that were done so far; None where nothing tells.
    dashboard : str
        The address of a cluster's own page; empty without one.
    """

    name: str
    rows: tuple[UnitRow, ...]
    left_s: float | None = None
    dashboard: str = ""

    @property
    def fraction(self) -> float:
        """0 to 1, by the bytes of the deliveries."""
        weights = [one.size or 1 for one in self.rows]
        done = sum(one.fraction * weight for one, weight in zip(self.rows, weights, strict=True))
        return done / (sum(weights) or 1)

    @property
    def text(self) -> Text:
        """One line on all of it."""
        count = {one: sum(row.standing == one for row in self.rows) for one in STANDINGS}
        words = _COUNTED.filled(
            done=str(count["done"]), every=str(len(self.rows)), failed=str(count["failed"])
        )
        if self.left_s is None:
            return words
        left = _LEFT.filled(time=_rough_time(self.left_s))
        return Text("{words}, {left}", "{words}、{left}").filled(words=words, left=left)


def write_status(folder: Path, status: BatchStatus, language: Language) -> None:
    """Write how a job stands, as a page and as JSON, each whole.

    Raises
    ------
    NoSpace, MissingInput
    """
    with write_safely(folder / STATUS) as temporary:
        text = json.dumps(_described(status), ensure_ascii=False, indent=1)
        temporary.write_text(text + "\n", encoding="utf-8", errors="backslashreplace")
    with write_safely(folder / PAGE) as temporary:
        page = _page(status, language)
        temporary.write_text(page, encoding="utf-8", errors="backslashreplace")


def _described(status: BatchStatus) -> dict[str, object]:
    return {
        "name": status.name,
        "fraction": round(status.fraction, 4),
        "left_s": None if status.left_s is None else round(status.left_s, 1),
        "drives": [
            {
                "name": row.state.name,
                "state": row.standing,
                "fraction": round(row.fraction, 4),
                "doing": row.progress.text.en if row.standing == "working" else "",
                "seconds": round(row.seconds, 1),
                "memory_bytes": row.progress.held_bytes,
                "peak_memory_bytes": row.peak_bytes,
                "tasks": [_task(one) for one in row.state.tasks],
                "errors": [
                    one.error.error().line("en")
                    for one in row.state.troubles
                    if one.error is not None
                ],
            }
            for row in status.rows
        ],
    }


def _task(task: TaskState) -> dict[str, object]:
    return {
        "title": task.title.en,
        "state": task.became,
        "seconds": round(task.seconds, 2),
        "peak_memory_bytes": task.peak_bytes,
    }


def _page(status: BatchStatus, language: Language) -> str:
    is_over = all(row.standing not in ("waiting", "working") for row in status.rows)
    again = "" if is_over else f'<meta http-equiv="refresh" content="{_EVERY_S}">'
    name = html.escape(status.name)
    headings = "".join(f"<th>{one.in_language(language)}</th>" for one in _HEADINGS)
    rows = "\n".join(_row(one, language) for one in status.rows)
    board = html.escape(status.dashboard)
    link = f'<p><a href="{board}">Dask: {board}</a></p>' if board else ""
    return (
        f'<!DOCTYPE html>\n<html lang="{language}"><head><meta charset="utf-8">{again}'
        f"<title>{name}</title><style>{_STYLE}</style></head>\n<body><h1>{name}</h1>"
        f'<p><progress value="{status.fraction:.4f}"></progress> '
        f"{html.escape(status.text.in_language(language))}</p>{link}\n"
        f"<table><tr>{headings}</tr>\n{rows}\n</table></body></html>\n"
    )


def _row(row: UnitRow, language: Language) -> str:
    words = "<br>".join(html.escape(one.in_language(language)) for one in row.words)
    held, peak = (f"{one / _MIB:,.0f} MiB" for one in (row.progress.held_bytes, row.peak_bytes))
    memory = peak
    if row.standing == "working":
        memory = _NOW.filled(held=held, peak=peak).in_language(language)
    cells = (
        f"<td>{html.escape(row.state.name)}</td>",
        f"<td>{STANDINGS[row.standing].in_language(language)}</td>",
        f'<td class="n">{row.fraction:.0%}</td>',
        f'<td class="n">{_time(row.seconds)}</td>',
        f'<td class="n">{memory if row.peak_bytes else "–"}</td>',
        f"<td>{words}</td>",
        f'<td><a href="{html.escape(row.folder.name)}/{LOG_FILE}">{LOG_FILE}</a></td>',
    )
    return f'<tr class="{row.standing}">{"".join(cells)}</tr>'


def _rough_time(seconds: float) -> str:
    """A time that changes as seldom as it is known well."""
    step = 10 if seconds < 2 * 60 else 60 if seconds < 60 * 60 else 10 * 60
    return _time(step * max(1, round(seconds / step)))


def _time(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
