"""The demo's main job done by itself: the window is used with real clicks, results are written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PySide6.QtCore import QEvent, QEventLoop, QPointF, Qt, QTimer
from PySide6.QtGui import QGuiApplication, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.cli.image import write_image
from app.cli.import_drives import describe_drive
from app.cli.output import print_lines
from app.demo.sample_drawing import read_sample_drawing
from app.window.window_parts import WindowParts
from processing.core.errors import InUse, MissingInput, UserError, report_as_user_error
from processing.core.owned_files import mark, remove_marked
from processing.core.text import Text
from processing.image.attributes.attributes import available
from processing.image.search.nearest import nearest_point
from processing.map.feature import Feature, PointReference
from processing.operations.export import ExportRequest
from processing.project.importing.dropped_files import request_of_files
from processing.project.project import is_project
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.tools.features import FEATURES
from processing.tools.listed.registry import point_tools
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY
from resources import path_of
from widgets.shared.cursor import PickedPosition
from widgets.shared.view_settings import PointStyle

_FORMATS = ("dxf", "csv", "gpkg", "geojson")
"""A drawing and its ledgers. What needs a route, the grid of map sheets or facts of a work is no
part of a first look."""

_LONGEST_WAIT_MS = 300_000
_SETTLE_MS = 1_500
_MOST_WAITS, _RESTED = 8, 2
"""Rests between looks at the window, and so many in a row in which 3D had nothing to draw."""
_NEAR_M = 0.3


def do_demo_job(parts: WindowParts, out: Path) -> int:
    """Import the sample street, draw on it, take steps back and forth, export; then close.

    Parameters
    ----------
    out : Path
        Folder for the project, drawings, ledgers, images and screenshots; an older demo's project
        in it is replaced.

    Returns
    -------
    int
        0; what was made is printed.

    Raises
    ------
    UserError
        The folder can't be written, or a step was refused.
    """
    out = out.resolve()
    with report_as_user_error(out):
        out.mkdir(parents=True, exist_ok=True)
    job = _DemoJob(parts, out)
    try:
        job.import_street()
        job.draw()
        job.step_back_and_forth()
        job.run_tools()
        job.show_and_shoot()
        job.export()
        job.write_images()
    finally:
        parts.window.close()
    print_lines(*job.made)
    return 0


_LEFT_OUT = (FEATURES.id, WAVEFORM_CLASSIFY.id)
"""Half of the time for numbers that few look at; and classes of flights, which say nothing of a
street."""


class _DemoJob:
    def __init__(self, parts: WindowParts, out: Path) -> None:
        self._parts = parts
        self._document = parts.document
        self._out = out
        self._errors: list[UserError] = []
        self.made: list[str] = []
        parts.document.refused.connect(self._errors.append)

    def import_street(self) -> None:
        folder = self._out / "sample_street.zuka"
        if is_project(folder) and not remove_marked(folder):
            raise _no_demo(folder)
        self._document.create(folder, "")
        self._raise_refusal()
        with report_as_user_error(folder):
            mark(folder)
        request = request_of_files((path_of("sample_street"),), "")
        self._wait_for_job(lambda: self._document.import_files(request))
        self.made += [describe_drive(drive) for drive in self._document.drives()]
        self.made.append(str(folder))

    def draw(self) -> None:
        """Draw with clicks on the image, as a person does."""
        settings = self._document.shared.view_settings
        for wanted in read_sample_drawing():
            drive = next(d for d in self._document.drives() if wanted.drive in d.info.name)
            settings.show_image(drive.id, ImageKind.TRAJECTORY_CENTER)
            self._parts.image_view.show_one_to_one()
            self._parts.toolbox.choose_kind(self._document.catalogue()[wanted.kind])
            for xyz in wanted.positions:
                self._click_nearest(drive, xyz)
            self._parts.toolbox.complete()
        self._parts.toolbox.choose("select")
        self._raise_refusal()
        drawn = sum(1 for _ in self._document.features())
        reported = Text(
            "{count} features drawn on the image", "画像上に{count}個の地物を作図しました"
        )
        self.made.append(reported.filled(count=drawn).in_language(self._parts.language))

    def step_back_and_forth(self) -> None:
        before = self._by_id()
        while self._document.undo():
            pass
        taken_back = sum(1 for _ in self._document.features()) == 0
        while self._document.redo():
            pass
        if not taken_back or before != self._by_id():
            message = "undo and redo did not give the drawing back"
            raise RuntimeError(message)

    def _by_id(self) -> dict[str, Feature]:
        return {feature.id: feature for feature in self._document.features()}

    def run_tools(self) -> None:
        for drive in self._document.drives():
            for tool in point_tools().values():
                if tool.id not in _LEFT_OUT:
                    self._run(tool.id, drive.id, tool.parameters())

    def show_and_shoot(self) -> None:
        """Show a piece of the street with the drawing and keep the window's picture."""
        first = self._document.drives()[0]
        settings = self._document.shared.view_settings
        settings.show_image(first.id, ImageKind.TRAJECTORY_CENTER)
        settings.change_look(attribute=PointStyle().attribute)
        self._parts.image_view.show_one_to_one()
        feature = next(f for f in self._document.features() if len(f.vertices) > 2)
        vertex = feature.vertices[len(feature.vertices) // 2]
        position = PickedPosition(vertex.xyz, vertex.measured)
        self._parts.image_view.center_on(position)
        self._parts.scene_view.show_everything()
        self._document.shared.cursor.move_to(position)
        self._document.shared.selection.choose_features(frozenset({feature.id}))
        self._shoot("window.png")
        settings.change_look(attribute="height")
        self._shoot("window-height.png")
        settings.change_look(attribute=PointStyle().attribute)
        self._document.shared.selection.clear()

    def export(self) -> None:
        request = ExportRequest(
            formats=_FORMATS,
            folder=self._out / "export",
            language=self._parts.language,
            candidates=False,
        )
        self._wait_for_job(lambda: self._document.export(request))
        self.made += [str(path) for path in sorted(request.folder.iterdir())]

    def write_images(self) -> None:
        for drive in self._document.drives():
            for kind in drive.image_kinds:
                self._write_image(drive, kind, "intensity")
            for attribute in available(drive):
                if attribute != "intensity":
                    self._write_image(drive, ImageKind.TRAJECTORY_CENTER, attribute)

    def _write_image(self, drive: Drive, kind: ImageKind, attribute: str) -> None:
        path = self._out / "images" / f"{drive.info.name}-{kind.value}-{attribute}.png"
        rows, columns = write_image(drive, kind, attribute, path)
        self.made.append(f"{path}: {rows} x {columns}")

    def _click_nearest(self, drive: Drive, xyz: tuple[float, float, float]) -> None:
        point = nearest_point(drive, np.array(xyz), _NEAR_M)
        if point < 0:
            raise MissingInput(
                Text("The demo's drawing is off the points.", "デモの図形が点群から外れています。"),
                Text.same(f"{drive.info.name}: {xyz}"),
                Text("Install the program again.", "プログラムを再インストールしてください。"),
            )
        exact = drive.xyz(np.array([point]))[0]
        position = PickedPosition(
            (float(exact[0]), float(exact[1]), float(exact[2])), PointReference(drive.id, point)
        )
        self._parts.image_view.center_on(position)
        pixel = self._parts.image_view.position_of(position)
        if pixel is None:
            message = f"point {point} of {drive.id} is in no pixel"
            raise RuntimeError(message)
        _click(self._parts.image_view, pixel)

    def _run(self, tool: str, drive_id: str, parameters: object) -> None:
        self._wait_for_job(lambda: self._document.start_run(tool, drive_id, parameters))

    def _wait_for_job(self, start: Callable[[], str]) -> None:
        """Start a job and let the window live until it has ended."""
        loop = QEventLoop()
        jobs = self._parts.jobs
        wanted = ""

        def leave(job: str) -> None:
            if job == wanted:
                loop.quit()

        for ending in (jobs.finished, jobs.failed, jobs.cancelled):
            ending.connect(leave)
        QTimer.singleShot(_LONGEST_WAIT_MS, loop.quit)
        wanted = start()
        loop.exec()
        self._raise_refusal()

    def _shoot(self, name: str) -> None:
        """Let tiles load and views settle, then keep what the window shows."""
        loop, rested = QEventLoop(), 0
        for _ in range(_MOST_WAITS):
            QTimer.singleShot(_SETTLE_MS, loop.quit)
            loop.exec()
            rested = rested + 1 if self._parts.scene_view.is_settled else 0
            if rested == _RESTED:
                break
        path = self._out / name
        picture = QGuiApplication.primaryScreen().grabWindow(self._parts.window.winId())
        if not picture.save(str(path)):
            with report_as_user_error(path):
                path.touch()
        self.made.append(str(path))

    def _raise_refusal(self) -> None:
        if self._errors:
            raise self._errors[0]


def _no_demo(folder: Path) -> InUse:
    return InUse(
        Text(
            "There is a project in this place that the demo did not make.",
            "この場所には、デモで作成したものではないプロジェクトがあります。",
        ),
        Text.same(str(folder)),
        Text(
            "Name another folder with --out, or move the project away.",
            "--out で別のフォルダを指定するか、プロジェクトを移動してください。",
        ),
    )


def _click(widget: QWidget, position: QPointF) -> None:
    """Click a pixel with Ctrl held: exactly this point, whatever edge is beside it."""
    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    for kind, held in (
        (QEvent.Type.MouseButtonPress, left),
        (QEvent.Type.MouseButtonRelease, none),
    ):
        event = QMouseEvent(
            kind,
            position,
            widget.mapToGlobal(position),
            left,
            held,
            Qt.KeyboardModifier.ControlModifier,
        )
        QApplication.sendEvent(widget, event)
