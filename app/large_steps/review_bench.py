"""How long a key of the review takes until every view shows the next candidate.

Run by ``zuka bench review`` in a process of its own: ``python -m app.large_steps.review_bench
COUNT``.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtCore import QEvent, QEventLoop, QObject
from PySide6.QtWidgets import QApplication
from typing_extensions import override

from app.application import build_window, make_application
from app.review.review import Review
from app.settings.settings import Settings
from app.window.window_parts import WindowParts
from processing.core.output_streams import write_every_character
from processing.laboratory.bench.street_candidates import street_candidates
from processing.project.importing.dropped_files import request_of_files
from processing.project.results.found_features import found_features
from processing.project.review.review_state import ReviewOrder
from processing.tools.template import TEMPLATE
from resources import path_of

_LONGEST_S = 60.0
_POLL_MS = 2


def measure(count: int) -> dict[str, list[float]]:
    """Milliseconds of each decision.

    Returns
    -------
    dict
        ``centred``: until every view that can be seen was painted with the candidate in its
        middle; ``sharp``: until section and camera are as sharp as they will be.
    """
    make_application()
    with TemporaryDirectory(prefix="zuka-") as folder:
        settings = Settings(Path(folder) / "settings.ini")
        parts = build_window(settings, Path(folder))
        try:
            return _measure_review(parts, Path(folder) / "street.zuka", count)
        finally:
            parts.window.close()


def _measure_review(parts: WindowParts, folder: Path, count: int) -> dict[str, list[float]]:
    parts.window.show()
    parts.document.create(folder, "")
    parts.document.import_files(request_of_files((path_of("sample_street"),), ""))
    _wait(lambda: bool(parts.document.drives()) and not parts.jobs.is_busy)
    drive = parts.document.drives()[0]
    now = datetime.now(UTC)
    made = found_features(
        street_candidates(drive, count),
        TEMPLATE,
        TEMPLATE.parameters(),
        (drive.id,),
        started=now,
        finished=now,
    )
    parts.document.store_run(made)
    parts.window.actions_by_id["layout-checking"].trigger()
    _wait(lambda: parts.scene_view.is_settled)
    sharp_sections: list[bool] = []
    parts.section_view.sharpened.connect(lambda: sharp_sections.append(True))
    parts.of(Review).open((made.run.id,), ReviewOrder.CONFIDENCE)
    _wait(lambda: bool(sharp_sections) and _is_camera_sharp(parts))
    painted = _Painted(parts)
    times: dict[str, list[float]] = {"centred": [], "sharp": []}
    while parts.of(Review).current is not None:
        sharp_sections.clear()
        painted.seen.clear()
        began = time.perf_counter()
        parts.window.actions_by_id["review-accept"].trigger()
        _wait(lambda: painted.seen >= painted.watched)
        times["centred"].append(1000 * (time.perf_counter() - began))
        if parts.of(Review).current is None:
            break
        _wait(lambda: bool(sharp_sections) and _is_camera_sharp(parts))
        times["sharp"].append(1000 * (time.perf_counter() - began))
    return times


class _Painted(QObject):
    """Which pictures of the views that can be seen were painted."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__()
        views = [
            parts.image_view,
            parts.section_view.panes[0],
            parts.camera_view,
            parts.map_view,
        ]
        self.seen: set[QObject] = set()
        self.watched: set[QObject] = set()
        for view in views:
            if not view.visibleRegion().isEmpty():
                view.installEventFilter(self)
                self.watched.add(view)
        scene = parts.scene_view.picture
        if scene is not None and not scene.visibleRegion().isEmpty():
            # The view is painted with its old picture as well while the new one is drawn.
            scene.frame_painted.connect(lambda: self.seen.add(scene))
            self.watched.add(scene)

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Paint:
            self.seen.add(watched)
        return False


def _is_camera_sharp(parts: WindowParts) -> bool:
    camera = parts.camera_view
    return camera.is_sharp or camera.projection() is None


def _wait(is_done: Callable[[], bool]) -> None:
    until = time.monotonic() + _LONGEST_S
    while not is_done():
        if time.monotonic() > until:
            raise TimeoutError
        QApplication.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, _POLL_MS)


if __name__ == "__main__":
    write_every_character()
    sys.stdout.write(json.dumps(measure(int(sys.argv[1]))) + "\n")
