"""Opening a project, writing its map, and coming to rest."""

from __future__ import annotations

import time

from app.large_steps.bench_window import BenchWindow, StepTimings
from app.large_steps.painted_frames import wait_until
from processing.operations.export import ExportRequest


def start(window: BenchWindow) -> StepTimings:
    """An empty project with its 3D view: what the memory of the rest is compared with."""
    window.activate()
    return {}


def open_project(window: BenchWindow) -> StepTimings:
    """From the request to a picture of the street, and to one that is sharp; then the 3D view's."""
    began = time.perf_counter()
    first: list[float] = []

    def is_sharp() -> bool:
        if window.parts.image_view.picture is None:
            return False
        if not first:
            first.append(time.perf_counter() - began)
        return window.tiles.is_complete

    def request() -> None:
        window.parts.window.files_dropped.emit((window.project,))

    sharp = window.image_frames.seconds_to_paint(request, is_sharp)
    wait_until(lambda: window.parts.scene_view.is_settled, window.pulse.felt)
    settled = time.perf_counter() - began
    window.rest()
    return {"painted": first, "sharp": [sharp], "3D sharp": [settled]}


def open_again(window: BenchWindow) -> StepTimings:
    """The same once more: facts on tiles are kept in the project by then."""
    window.act("close")
    return open_project(window)


def export(window: BenchWindow) -> StepTimings:
    """What was drawn, as DXF and CSV."""
    request = ExportRequest(("dxf", "csv"), window.out, language=window.parts.language)
    began = time.perf_counter()
    window.parts.document.export(request)
    wait_until(lambda: not window.parts.jobs.is_busy, window.pulse.felt)
    if not any(window.out.iterdir()):
        message = "nothing was exported"
        raise RuntimeError(message)
    return {"written": [time.perf_counter() - began]}


def rest(window: BenchWindow) -> StepTimings:
    """Nothing: what memory is held when all is done."""
    window.rest()
    return {}
