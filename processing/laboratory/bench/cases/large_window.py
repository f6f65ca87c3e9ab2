"""Rows of the table from what a window on a large project told of its steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from processing.core.text import Text
from processing.laboratory.bench.case import Measurement
from processing.laboratory.bench.cases.large_import import memory_row
from processing.laboratory.bench.timing import percentile
from processing.laboratory.bench.watched_run import WatchedRun

StepRecord = Mapping[str, Any]  # as JSON gives it
"""``step``, ``began``, ``ended``, ``longest_pause_s``, all s; ``times_s`` by what took them."""


@dataclass(frozen=True)
class _Judged:
    """One row.

    Attributes
    ----------
    step, times : str
        Which seconds of which step.
    at_most_ms : float or None
        For the 99th percentile; None for the median where ``least_frames`` counts.
    least_frames : float or None
        Frames a second, by the median.
    """

    name: str
    what: Text
    step: str
    times: str
    at_most_ms: float | None = None
    least_frames: float | None = None


_ROWS = (
    _Judged(
        "open",
        Text("Opening until the image is sharp", "開いて画像が鮮明になるまで"),
        "open",
        "sharp",
        3000.0,
    ),
    _Judged("open-again", Text("Opening again", "再び開く"), "open again", "sharp", 3000.0),
    _Judged(
        "pan",
        Text(
            "Dragging the image along the street, a pulse a pixel or more",
            "画像を道路に沿ってドラッグ（1パルス1画素以上）",
        ),
        "pan",
        "frame",
        None,
        60.0,
    ),
    _Judged(
        "pan-far",
        Text("Dragging the image seen from far", "縮小した画像のドラッグ"),
        "pan far",
        "frame",
        None,
        60.0,
    ),
    _Judged(
        "zoom",
        Text(
            "Wheel from the whole drive to single pulses and back",
            "全体から1パルスまでのホイール拡大・縮小",
        ),
        "zoom",
        "frame",
        None,
        60.0,
    ),
    _Judged(
        "first-tile",
        Text("Jump anywhere: first sharp tile", "任意の場所への移動: 最初の鮮明なタイル"),
        "jump",
        "first tile",
        100.0,
    ),
    _Judged(
        "sharp",
        Text("Jump anywhere: whole window sharp", "任意の場所への移動: 全画面が鮮明"),
        "jump",
        "window sharp",
    ),
    _Judged(
        "switch",
        Text(
            "Another attribute in the whole window, sharp",
            "全画面の表示属性の切り替え（鮮明になるまで）",
        ),
        "switch",
        "sharp",
    ),
    _Judged("orbit", Text("Turning in 3D", "3Dの回転"), "orbit", "frame", None, 10.0),
    _Judged(
        "flight",
        Text("Flying along the drive in 3D", "3Dで走行に沿って移動"),
        "flight",
        "frame",
        None,
        10.0,
    ),
    _Judged(
        "hover",
        Text("Mouse over the image with a line begun, snapping", "作図中のマウス移動（スナップ）"),
        "hover",
        "frame",
        None,
        60.0,
    ),
    _Judged(
        "vertex",
        Text("Click of a vertex until it is painted", "頂点のクリックから描画まで"),
        "draw",
        "vertex",
        50.0,
    ),
    _Judged(
        "undo", Text("Undo of a line of 50 vertices", "50頂点の線の取り消し"), "undo", "undo", 50.0
    ),
    _Judged(
        "export",
        Text("Export of what was drawn, DXF and CSV", "作図結果の書き出し（DXF・CSV）"),
        "export",
        "written",
    ),
)


def window_rows(run: WatchedRun, steps: Sequence[StepRecord]) -> tuple[Measurement, ...]:
    """A row for each that is judged, and the memory."""
    by_name = {step["step"]: step for step in steps}
    return tuple(_row(row, by_name[row.step]) for row in _ROWS) + _memory_rows(run, by_name)


def _row(row: _Judged, step: StepRecord) -> Measurement:
    milliseconds = [1000 * seconds for seconds in step["times_s"][row.times]]
    median, most = percentile(milliseconds, 50), percentile(milliseconds, 99)
    figures = {
        "count": float(len(milliseconds)),
        "median_ms": median,
        "p99_ms": most,
        "longest_ms": max(milliseconds),
        "longest_pause_ms": 1000 * step["longest_pause_s"],
    }
    detail = (
        f"{len(milliseconds)} times: median {median:.0f} ms, 99th percentile {most:.0f} ms, "
        f"longest {max(milliseconds):.0f} ms"
    )
    name = f"large-{row.name}"
    if row.least_frames is not None:
        value, unit = 1000 / median, "frames/s"
        target: float | None = row.least_frames
    else:
        value, unit, target = most, "ms", row.at_most_ms
    return Measurement(
        name,
        row.what,
        value,
        unit,
        target,
        is_at_most=row.least_frames is None,
        detail=detail,
        figures=figures,
    )


def _memory_rows(run: WatchedRun, steps: Mapping[str, StepRecord]) -> tuple[Measurement, ...]:
    baseline, first, end = (steps[name] for name in ("baseline", "open", "end"))
    peak = run.over_baseline(baseline["ended"], first["began"], end["ended"])
    left = run.over_baseline(baseline["ended"], end["began"], end["ended"])
    return (
        memory_row(
            "large-memory",
            Text(
                "Peak memory of the window over an empty one",
                "ウィンドウの最大メモリ（空の状態からの増分）",
            ),
            *peak,
        ),
        memory_row(
            "large-memory-end",
            Text("Memory of the window when all is done", "終了時のメモリ（空の状態からの増分）"),
            *left,
        ),
    )
