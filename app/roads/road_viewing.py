"""RoadViewing: the road model of the open project, worked out in a job and shown as a plot."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QTemporaryDir

from app.window.action import Action
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.text import Text
from processing.operations.export import ExportRequest
from processing.operations.map_steps import ROAD_FORMAT
from widgets.dialogs.road_plot import RoadPlotView

TITLE = Text("Road model", "道路モデル")


class RoadViewing:
    """Works the road model out and shows it.

    Parameters
    ----------
    dialogs : ProjectDialogs
        Where its plot is shown.
    """

    def __init__(self, parts: WindowParts, dialogs: ProjectDialogs) -> None:
        self._parts = parts
        self._dialogs = dialogs

    def action(self) -> Action:
        """The entry of the file menu."""
        return Action(
            "road-model",
            TITLE,
            self.choose,
            "file",
            ("Ctrl+Shift+F2",),
            "mdi6.road",
            hint=Text(
                "Widths, crossfall, slope and clearance along the roads as a plot; also as tables"
                " by Export.",
                "路線に沿った幅員・横断勾配・縦断勾配・建築限界を図で表示します。"
                "表は「書き出し」で出力できます。",
            ),
            needs_project=True,
        )

    def choose(self) -> None:
        """Work it out in the background, then show it."""
        if self._parts.document.project is None:
            return
        folder = QTemporaryDir()
        request = ExportRequest((ROAD_FORMAT,), Path(folder.path()), self._parts.language)

        def show() -> None:
            pages = [path.read_bytes() for path in plots_in(Path(folder.path()))]
            folder.remove()
            self.show_pages(pages)

        self._parts.document.make_pages(request, show, TITLE)

    def show_pages(self, pages: list[bytes]) -> RoadPlotView:
        """Show pages of SVG in the dialog of the road model, in place of older ones."""

        def make() -> RoadPlotView:
            return RoadPlotView(self._parts.window)

        view = self._dialogs.show(RoadPlotView, make)
        view.show_pages(pages)
        return view


def plots_in(folder: Path) -> list[Path]:
    """The plots of an exported road model, in their order."""
    return sorted(folder.glob("road*.svg"), key=lambda path: (len(path.stem), path.stem))
