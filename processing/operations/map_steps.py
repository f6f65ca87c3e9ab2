"""Steps of a project's map: a delivered map taken in, ledgers numbered, the last step undone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from processing.core.errors import UNCHANGED, MissingInput, OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.vectors.delivered_maps import features_of_map
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.map.change import Change
from processing.map.reference_system import reference_system
from processing.map.routes.numbering import number_along_routes
from processing.map.routes.route import routes_of
from processing.operations.inputs import opened_project
from processing.scoring.features.mapped_features import IN_DEGREES, MappedFile

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
_TAKE_LABEL = Text("Take in {count} features of {file}", "{file}から{count}個の地物を取り込み")
_TAKEN = Text("{count} features taken in.", "{count}個の地物を取り込みました。")
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


@dataclass(frozen=True)
class TakeMapOperation:
    """A map that was delivered before, to become features of a project.

    Attributes
    ----------
    project : Path
    path : Path
        DXF, GeoPackage, GeoJSON, SIMA or extended DM.
    crs : str
        ``EPSG:n`` of a file that doesn't say it; empty where it does.
    of_kind : str
        What things become that say no kind the catalogue knows; empty: they are left out.
    """

    project: Path
    path: Path
    crs: str = ""
    of_kind: str = ""


@dataclass(frozen=True)
class TakenMap:
    """How many features were added, and what has to be known about them."""

    count: int
    notes: tuple[Text, ...]

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for what was added, and one for each note."""
        return (_TAKEN.filled(count=f"{self.count:,}"), *self.notes)


def take_map(operation: TakeMapOperation, monitor: Monitor) -> TakenMap:
    """Add the features of a delivered map to a project, as one step to be undone.

    Raises
    ------
    MissingInput
        Neither the file nor the operation says its reference system; the project has none.
    OutOfRange
        The file says another system than the operation; there is no such system or kind.
    Unsuitable, BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    mapped = read_mapped(operation.path)
    monitor.check()
    with opened_project(operation.project, writing=True) as project:
        mapped = replace(mapped, crs=_system_of(mapped, operation, project.crs))
        read = features_of_map(
            mapped,
            project.catalogue,
            crs=project.crs,
            known=frozenset(one.id for one in project.features.all()),
            kind=operation.of_kind,
        )
        monitor.check()
        if read.features:
            label = _TAKE_LABEL.filled(count=f"{len(read.features):,}", file=operation.path.name)
            project.features.apply(label, Change(added=read.features))
        return TakenMap(len(read.features), read.notes)


def _system_of(mapped: MappedFile, operation: TakeMapOperation, own: str) -> str:
    """The reference system of a map: as the file says, else as was given."""
    given = reference_system(operation.crs) if operation.crs else ""
    said = "" if mapped.crs == IN_DEGREES and given else mapped.crs
    if said and given and said != given:
        raise OutOfRange(
            Text(
                f"The file says {said}, not {given}.",
                f"ファイルの座標参照系は{said}です（{given}ではありません）。",
            ),
            Text.same(str(operation.path)),
            Text("Leave --crs out.", "--crsを省略してください。"),
        )
    if not own or not (said or given):
        what = Text(
            "The project has no reference system.", "プロジェクトの座標参照系が未設定です。"
        )
        if own:
            what = Text(
                "The file does not say its reference system.",
                "ファイルに座標参照系の記載がありません。",
            )
        raise MissingInput(
            what,
            Text.same(str(operation.path if own else operation.project)),
            Text(
                "Give it with --crs, for instance --crs EPSG:6677. {unchanged}",
                "--crs EPSG:6677のように指定してください。{unchanged}",
            ).filled(unchanged=UNCHANGED)
            if own
            else Text("Set it in the project first.", "先にプロジェクトで設定してください。"),
        )
    return said or given
