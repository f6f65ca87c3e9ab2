"""RunComparing: two runs of a tool beside each other, and the one that is kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QObject

from app.window.project_dialogs import ProjectDialogs
from app.window.window_parts import WindowParts
from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.feature import Feature
from processing.operations.runs.run_comparison import (
    ComparedRun,
    compare_runs,
    keep_run,
    runs_to_compare,
)
from processing.project.project import Project
from processing.project.store.runs import Run
from widgets.dialogs.compare_runs import CompareRunsForm, RunSide
from widgets.panels.feature_tally import RunOfTool
from widgets.panels.run_words import facts_of_run, name_of_run

_ONLY = Text(
    "There is no other run of this tool over these drives to compare with.",
    "比較できる、同じ走行データに対する同じツールの実行結果が他にありません。",
)
_KEEP = Text("Keep {name}", "{name} を残す")
_FOUND = Text("Confidence, median", "信頼度（中央値）")


class RunComparing(QObject):
    """Shows the form and stores what it decides.

    Parameters
    ----------
    parts : WindowParts
    dialogs : ProjectDialogs
    """

    def __init__(self, parts: WindowParts, dialogs: ProjectDialogs) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._dialogs = dialogs

    def choose(self, run: str) -> None:
        """Compare a run with the one before it."""
        document = self._parts.document
        project = document.project
        if project is None:
            return
        try:
            runs = runs_to_compare(project, run)
        except UserError as error:
            document.refused.emit(error)
            return
        ids = [one.id for one in runs]
        if len(runs) < 2 or run not in ids:
            document.reported.emit(_ONLY)
            return
        at = ids.index(run)
        other = ids[at + 1] if at + 1 < len(ids) else ids[at - 1]
        for form in self._parts.window.findChildren(CompareRunsForm):
            form.close()
        names = [(one.id, self._name(one)) for one in runs]

        def make() -> CompareRunsForm:
            form = CompareRunsForm(names, self._parts.window)
            form.pair_chosen.connect(self._show)
            form.keep_requested.connect(self._keep)
            return form

        self._dialogs.show(CompareRunsForm, make)
        self._show(other, run)

    def _show(self, first: str, second: str) -> None:
        project = self._parts.document.project
        runs = {one.id: one for one in self._parts.document.runs()}
        if project is None or first not in runs or second not in runs:
            return
        try:
            pair = compare_runs(project, runs[first], runs[second])
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        facts = self._facts(project, pair)
        for form in self._parts.window.findChildren(CompareRunsForm):
            form.show_pair((self._side(pair[0]), self._side(pair[1])), facts)

    def _keep(self, run: str) -> None:
        document = self._parts.document
        runs = {one.id: one for one in document.runs()}
        if document.project is None or run not in runs:
            return
        try:
            change = keep_run(document.project, runs[run])
        except UserError as error:
            document.refused.emit(error)
            return
        if not change.is_empty:
            document.apply(_KEEP.filled(name=self._name(runs[run])), change)

    def _name(self, run: Run) -> str:
        origin = RunOfTool(run.tool, run.id)
        return name_of_run(origin, {run.id: run}, self._parts.language)

    def _side(self, one: ComparedRun) -> RunSide:
        shapes = [_outline(candidate) for candidate in one.candidates]
        return RunSide(one.run.id, self._name(one.run), shapes, one.in_both)

    def _facts(
        self, project: Project, pair: tuple[ComparedRun, ComparedRun]
    ) -> list[tuple[str, str, str]]:
        """Drives, version, parameters and confidence of both, line by line."""
        language = self._parts.language
        drives = {drive.id: drive.info.name for drive in project.drives}
        columns = []
        for one in pair:
            names = ", ".join(drives[id_] for id_ in one.run.drives if id_ in drives)
            lines = dict(
                line.split(": ", 1) for line in facts_of_run(one.run, (), language) if ": " in line
            )
            title = Text("Drives", "走行データ").in_language(language)
            columns.append(
                {
                    title: names,
                    **lines,
                    _FOUND.in_language(language): _median_confidence(one.candidates),
                }
            )
        named = dict.fromkeys([*columns[0], *columns[1]])
        return [(name, columns[0].get(name, "—"), columns[1].get(name, "—")) for name in named]


def _median_confidence(candidates: Sequence[Feature]) -> str:
    values = [one.provenance.confidence for one in candidates]
    known = [value for value in values if value is not None]
    return f"{float(np.median(known)):.2f}" if known else "—"


def _outline(candidate: Feature) -> Floats:
    places = [vertex.xyz[:2] for vertex in candidate.vertices]
    if candidate.geometry is Geometry.AREA:
        places = [*places, places[0]]
    return np.array(places)
