"""Steps of a project's map: its ledgers numbered along the routes, the last step taken back."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import UNCHANGED, MissingInput
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.map.routes.numbering import number_along_routes
from processing.map.routes.route import routes_of
from processing.operations.inputs import opened_project

NO_CENTRE_LINE = Text(
    "Draw the road's centre line first and give it its route.",
    "先に道路中心線を描き、路線名を記入してください。",
)
ALL_NUMBERED = Text(
    "All that ledgers list along the centre lines is filled in.",
    "中心線沿いの台帳の地物は、すべて記入済みです。",
)
NUMBER_LABEL = Text("Number {count} features along the route", "{count}個の地物に測点・番号を記入")
NUMBERED = Text(
    "Number, route, station and side filled in for {count} features.",
    "{count}個の地物に整理番号・路線名・測点・左右を記入しました。",
)
_UNDONE = Text("Undone: {label}", "元に戻しました: {label}")
_NOTHING = Text("There is nothing to undo.", "元に戻す操作はありません。")


@dataclass(frozen=True)
class NumberOperation:
    """A project whose ledgers are to be numbered.

    Attributes
    ----------
    project : Path
    """

    project: Path


@dataclass(frozen=True)
class NumberedFeatures:
    """How many features say more now; 0 where all was filled in."""

    count: int

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        if not self.count:
            return (ALL_NUMBERED,)
        return (NUMBERED.filled(count=f"{self.count:,}"),)


def number_features(operation: NumberOperation, monitor: Monitor) -> NumberedFeatures:
    """Fill in numbers, routes, stations and sides of what ledgers list, as one step to be undone.

    What is written stays, so that a second time changes nothing and additions get new numbers.

    Raises
    ------
    MissingInput
        The map has no accepted centre line; or there is no such project.
    BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        features, catalogue = tuple(project.features.all()), project.catalogue
        monitor.check()
        if not routes_of(features, catalogue):
            raise MissingInput(
                Text("The map has no centre line.", "道路中心線がありません。"),
                Text.same(str(operation.project)),
                Text("{remedy} {unchanged}", "{remedy}{unchanged}").filled(
                    remedy=NO_CENTRE_LINE, unchanged=UNCHANGED
                ),
            )
        change = number_along_routes(features, catalogue)
        count = len(change.replaced)
        if count:
            project.features.apply(NUMBER_LABEL.filled(count=f"{count:,}"), change)
        return NumberedFeatures(count)


@dataclass(frozen=True)
class UndoOperation:
    """The last step of a project, to be taken back.

    Attributes
    ----------
    project : Path
    """

    project: Path


@dataclass(frozen=True)
class UndoneStep:
    """The step that was taken back.

    Attributes
    ----------
    label : Text or None
        What the undo menu calls it; None where there was none.
    """

    label: Text | None

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        return (_NOTHING if self.label is None else _UNDONE.filled(label=self.label),)


def undo_step(operation: UndoOperation, monitor: Monitor) -> UndoneStep:
    """Take the last step back; it can be done again in the window.

    Raises
    ------
    MissingInput, BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        monitor.check()
        label = project.history.undo_label
        return UndoneStep(None if project.features.undo() is None else label)
