"""BenchWindow: a real window, a hand at it, and what tells when its views were painted."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QPoint
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from app.large_steps.painted_frames import PaintedFrames, Pulse, wait_until
from app.screenshots.simulated_mouse import SimulatedMouse
from app.window.window_parts import WindowParts
from widgets.image_view.minimap import Minimap
from widgets.image_view.tile_images import TileImages
from widgets.scene_view.rendering.scene_picture import ScenePicture

StepTimings = dict[str, list[float]]
"""Seconds by what took them."""


class BenchWindow:
    """What steps are done with.

    Parameters
    ----------
    parts : WindowParts
        Of a window that is shown, with a project open.
    project, out : Path
        The project's folder, and one for exports.
    share : float
        Of the frames and repetitions that steps mean to do.

    Attributes
    ----------
    pulse : Pulse
        Tells how long the window answered nothing.
    image : QWidget
        The main image; ``image_frames`` tells when it was painted.
    picture : QWidget
        The 3D picture, with ``picture_frames``.
    tiles : TileImages
        Of the main image.
    minimap : Minimap
        The strip with the whole drive.
    """

    def __init__(self, parts: WindowParts, project: Path, out: Path, share: float) -> None:
        self.parts = parts
        self.project = project
        self.out = out
        self._share = share
        self.mouse = SimulatedMouse()
        self.pulse = Pulse(parts.window)
        self.image: QWidget = parts.image_view
        self.image_frames = PaintedFrames(self.image)
        self.minimap = parts.image_view.findChildren(Minimap)[0]
        self.tiles = parts.image_view.findChildren(TileImages)[0]
        wait_until(lambda: parts.scene_view.picture is not None, self.pulse.felt)
        self.picture = _picture_of(parts)
        self.picture_frames = PaintedFrames(self.picture, self.picture.frame_painted)

    @property
    def middle(self) -> QPoint:
        """Of the main image."""
        return self.image.rect().center()

    def some(self, count: int) -> int:
        """The wanted share of a number of repetitions, at least one."""
        return max(1, round(self._share * count))

    def act(self, id_: str) -> None:
        """Choose a command."""
        self.parts.window.actions_by_id[id_].trigger()

    def activate(self) -> None:
        """Let keys come to the window."""
        self.parts.window.activateWindow()
        QTest.qWaitForWindowActive(self.parts.window)
        self.image.setFocus()

    def rest(self) -> None:
        """Wait until nothing is loaded, computed or drawn any more.

        What the window prepares unasked (surfaces, segments) is given up: on a long drive it
        takes longer than all that is measured.
        """
        parts, felt = self.parts, self.pulse.felt

        def is_idle() -> bool:
            for status in parts.jobs.statuses:
                parts.jobs.cancel(status.id)
            return not parts.jobs.is_busy

        wait_until(is_idle, felt)
        wait_until(lambda: self.tiles.is_complete, felt)
        wait_until(lambda: parts.scene_view.is_settled, felt)


def _picture_of(parts: WindowParts) -> ScenePicture:
    picture = parts.scene_view.picture
    if picture is None:
        message = "the 3D picture was not made"
        raise RuntimeError(message)
    return picture
