"""ExistingMaps: a map that was delivered before is compared or taken in, beside the window."""

from __future__ import annotations

from pathlib import Path

from app.review.review import Review
from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.vectors.delivered_maps import ReadMap
from processing.map.change import Change
from processing.map.renewal.existing_map import TAKE, ExistingMap
from processing.map.renewal.map_comparison import COMPARISON_NAME, ComparisonLimits
from processing.operations.map_steps import (
    CompareMapOperation,
    MapSnapshot,
    TakeMapOperation,
    TakenMap,
    differences_from,
    label_of_taking,
    read_for_taking,
)
from processing.project.comparison.found_differences import FoundDifferences, store_differences
from processing.project.project import Project
from widgets.dialogs.existing_map import ExistingMapForm

_TAKING = Text("Taking in {file}", "{file} の取り込み")
_MORE = Text("{said} – {more}", "{said}　{more}")


class ExistingMaps:
    """What the file menu does with maps that there are.

    Parameters
    ----------
    parts : WindowParts
    dialogs : ProjectDialogs
    """

    def __init__(self, parts: WindowParts, dialogs: ProjectDialogs) -> None:
        self._parts = parts
        self._dialogs = dialogs

    def choose(self) -> None:
        """Ask for a map and what is to become of it."""
        if self._parts.document.project is None:
            return

        def make() -> ExistingMapForm:
            form = ExistingMapForm(self._parts.language, self._parts.window)
            form.map_given.connect(self.start)
            return form

        self._dialogs.show(ExistingMapForm, make)

    def start(self, given: ExistingMap) -> None:
        """Begin a job that reads the map; what it gives goes to the project that is open now."""
        project = self._parts.document.project
        if project is None:
            return
        if given.use == TAKE:
            self._take(project, given)
        else:
            self._compare(project, given)

    def _take(self, project: Project, given: ExistingMap) -> None:
        path = Path(given.file)
        operation = TakeMapOperation(project.folder, path, given.crs, given.of_kind)
        snapshot = MapSnapshot.of(project)

        def work(monitor: Monitor) -> ReadMap:
            return read_for_taking(operation, snapshot, monitor)

        def act(opened: Project, read: ReadMap) -> Change:
            change = Change(added=read.features)
            if read.features:
                opened.features.apply(label_of_taking(read, path), change)
            return change

        def done(read: ReadMap) -> None:
            self._tell(TakenMap(len(read.features), read.notes).words)

        title = _TAKING.filled(file=path.name)
        self._parts.document.prepare_step(title, work, act, done)

    def _compare(self, project: Project, given: ExistingMap) -> None:
        operation = CompareMapOperation(
            project.folder,
            Path(given.file),
            given.crs,
            given.of_kind,
            ComparisonLimits(given.tolerance_m, given.search_m),
        )
        snapshot = MapSnapshot.of(project)

        def work(monitor: Monitor) -> tuple[FoundDifferences, tuple[Text, ...]]:
            return differences_from(operation, snapshot, monitor)

        def act(opened: Project, made: tuple[FoundDifferences, tuple[Text, ...]]) -> Change:
            return store_differences(opened, made[0])

        def done(made: tuple[FoundDifferences, tuple[Text, ...]]) -> None:
            found, notes = made
            self._tell((found.run.summary, *notes))
            if found.features:
                review = self._parts.of(Review)
                self._parts.window.show_panel("review")
                review.open((found.run.id,), review.progress.state.order)

        self._parts.document.prepare_step(COMPARISON_NAME, work, act, done)

    def _tell(self, words: tuple[Text, ...]) -> None:
        said, *more = words
        for one in more:
            said = _MORE.filled(said=said, more=one)
        self._parts.document.reported.emit(said)
