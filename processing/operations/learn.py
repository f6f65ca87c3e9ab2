"""Learning from corrections: a project's labels set by hand become a model of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from processing.core.errors import Unsuitable, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.owned_files import make_marked, remove_folder, unmark
from processing.core.scratch_arrays import scratch_array
from processing.core.text import Text
from processing.labels.label_column import LABEL
from processing.map.change import Change
from processing.methods.classes.aerial_cells import is_from_air
from processing.methods.classes.class_models import shipped_models, shipped_sample
from processing.methods.classes.learning import Gain, gain_of, learnt_forest
from processing.methods.classes.own_model import ModelFacts, write_own_model
from processing.methods.classes.painted_cells import (
    PaintedCells,
    PaintedLabels,
    painted_cells,
)
from processing.operations.inputs import opened_project
from processing.project.own_models import model_id, model_name
from processing.project.project import Project
from processing.project.results.run_findings import set_by_hand
from processing.recording.columns.classes import point_classes
from processing.recording.density import is_single_scan
from processing.recording.drive import Drive

LEARN = Text("Learn from corrections", "修正から学習")

_AT_ONCE = 1 << 20
_LOOKING, _ASKING = 0.4, 0.9
"""Of the progress: when the painted cells are known, and when the gain is."""

_LEAST_PLACES = 4
"""Places of a class, 10 m square: with fewer, leaving a quarter of them out leaves nothing to learn
from or nothing to ask."""

_LEAST_CLASSES = 2

_LEAST_CELLS = 100
"""Painted cells of 10 cm: fewer are five leaves of a tree, and no more than one stroke."""

_LEARNT = Text(
    "{learn}: {points} points at {places} places; mean F there, each place left out in turn: "
    "{before} % → {after} %",
    "{learn}: {places}か所の{points}点。各箇所を除いて検証した平均F値: {before} % → {after} %",
)
_NO_BETTER = Text(
    "{learnt}. “Classes” goes on with the program's own model.",
    "{learnt}。改善しないため、「点群の分類」では引き続き付属のモデルを使います。",
)
_OF_CLASS = Text(
    "{name}: {cells} cells, F {before} → {after}", "{name}: {cells}セル、F値 {before} → {after}"
)


@dataclass(frozen=True)
class LearnOperation:
    """A project whose corrections are to be learnt from.

    Attributes
    ----------
    project : Path
    """

    project: Path


@dataclass(frozen=True)
class LearntModel:
    """A model whose folder is written and waits to be taken in."""

    facts: ModelFacts
    folder: Path

    @property
    def summary(self) -> Text:
        """What was learnt, and how much it helps."""
        gain = self.facts.gain
        before, after = gain.mean_f
        learnt = _LEARNT.filled(
            learn=LEARN,
            points=f"{self.facts.points:,}",
            places=gain.places,
            before=f"{100 * before:.1f}",
            after=f"{100 * after:.1f}",
        )
        return learnt if gain.helps else _NO_BETTER.filled(learnt=learnt)

    @property
    def words(self) -> tuple[Text, ...]:
        """The summary, and a line for each class."""
        return (self.summary, *_class_lines(self.facts.gain))


def learn_in_project(operation: LearnOperation, monitor: Monitor) -> LearntModel:
    """Learn from what was painted in a project and let it keep the model, as one step.

    Raises
    ------
    UserError, Cancelled
        As :func:`learn` and :func:`store_model`; the project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        learnt = learn(project.drives, project.temporary_folder(), monitor)
        store_model(project, learnt)
        return learnt


def learn(drives: Sequence[Drive], into: Path, monitor: Monitor) -> LearntModel:
    """Learn from what was painted on drives; the model is written. For a worker's thread.

    Parameters
    ----------
    into : Path
        A new folder on the project's disk.

    Raises
    ------
    Unsuitable
        Too little was painted, or one class only, or all of it on clouds from the air or
        single scans.
    NoSpace, Cancelled
    """
    with report_as_user_error(into):
        make_marked(into)
    try:
        points, cells = _painted(drives, into, PartMonitor(monitor, 0.0, _LOOKING))
        _check(cells, drives)
        models, sample = shipped_models(), shipped_sample()
        gain = gain_of(cells, sample, models, PartMonitor(monitor, _LOOKING, _ASKING))
        forest = learnt_forest(cells, sample, models, PartMonitor(monitor, _ASKING, 1.0))
        made = datetime.now(UTC)
        facts = ModelFacts(model_id(made), made, points, gain)
        write_own_model(facts, forest, into)
    except BaseException:
        remove_folder(into)
        raise
    return LearntModel(facts, into)


def store_model(project: Project, learnt: LearntModel) -> Change:
    """Let a project keep a model, as one step that can be undone.

    Raises
    ------
    NoSpace, InUse, MissingInput
        It keeps what it had.
    """
    files = project.new_step_files()
    with report_as_user_error(learnt.folder):
        unmark(learnt.folder)
    files.give(learnt.folder, model_name(learnt.facts.id))
    change = Change(files=files.files())
    project.features.apply(learnt.summary, change)
    return change


def _painted(drives: Sequence[Drive], into: Path, monitor: Monitor) -> tuple[int, PaintedCells]:
    """How many points were painted by hand, and the cells that they are of."""
    labelled = [one for one in drives if one.count and one.columns.has(LABEL)]
    painted = [one for one in labelled if not (is_from_air(one) or is_single_scan(one))]
    if labelled and not painted:
        raise Unsuitable(
            Text(
                "The models for clouds from the air and for single scans do not learn from "
                "corrections.",
                "上空からの点群用と単独スキャン用のモデルは、修正から学習できません。",
            ),
            _where(labelled),
            Text(
                "What you painted stays as it is.",
                "塗ったラベルはそのまま残ります。",
            ),
        )
    points, found = 0, list[PaintedCells]()
    for number, part in enumerate(parts_of(monitor, [one.count for one in painted])):
        drive, scratch = painted[number], into / "scratch"
        with report_as_user_error(scratch):
            scratch.mkdir()
        labels = PaintedLabels(
            *(scratch_array(scratch / name, np.uint8, drive.count) for name in ("hand", "runs"))
        )
        count = _read_labels(drive, labels, part)
        if count:
            points += count
            found += painted_cells(drive, labels, scratch, part, models=shipped_models())
        del labels
        remove_folder(scratch)
    if not found:
        raise _too_little(drives)
    return points, PaintedCells.joined(found)


def _read_labels(drive: Drive, into: PaintedLabels, monitor: Monitor) -> int:
    """Labels by where they come from; how many no run gave."""
    count = 0
    for start in range(0, drive.count, _AT_ONCE):
        monitor.check()
        points = np.arange(start, min(start + _AT_ONCE, drive.count))
        labels = np.array(drive.columns[LABEL][points], np.uint8)
        is_by_hand = set_by_hand(drive, points, labels)
        into.by_hand[points] = np.where(is_by_hand, labels, 0)
        into.by_runs[points] = np.where(is_by_hand, 0, labels)
        count += int(np.count_nonzero(is_by_hand))
    return count


def _check(cells: PaintedCells, drives: Sequence[Drive]) -> None:
    places = np.unique(cells.painted_places).size
    if len(cells.painted) < _LEAST_CELLS or places < _LEAST_PLACES:
        raise _too_little(drives)
    if len(cells.classes) < _LEAST_CLASSES:
        raise Unsuitable(
            Text("Only one class was painted.", "塗られたクラスが1種類しかありません。"),
            _where(drives),
            Text(
                "Paint what is mistaken for it as well.",
                "そのクラスと混同されている別のクラスも塗ってください。",
            ),
        )


def _too_little(drives: Sequence[Drive]) -> Unsuitable:
    return Unsuitable(
        Text(
            "Too little was painted by hand to learn from.",
            "学習するには手動で塗られた点が足りません。",
        ),
        _where(drives),
        Text(
            "Paint what is wrong at {places} places at least that are 10 m apart.",
            "10 m以上離れた{places}か所以上で、誤っている点を塗ってください。",
        ).filled(places=_LEAST_PLACES),
    )


def _where(drives: Sequence[Drive]) -> Text:
    return Text.same(", ".join(drive.info.name for drive in drives))


def _class_lines(gain: Gain) -> list[Text]:
    names = {one.code: one.name for one in point_classes()}
    true = dict(zip(gain.before.codes, gain.before.true_counts.tolist(), strict=True))
    return [
        _OF_CLASS.filled(
            name=names.get(code, Text.same(str(code))),
            cells=f"{count:,}",
            before=_percent(gain.before.against_rest((code,)).f_measure),
            after=_percent(gain.after.against_rest((code,)).f_measure),
        )
        for code, count in true.items()
        if code in gain.classes
    ]


def _percent(share: float) -> str:
    return f"{100 * share:.1f} %"
