"""Steps of a project's map: ledgers numbered, lines drawn, a map taken in or compared, an undo."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path

from processing.core.errors import UNCHANGED, MissingInput, OutOfRange
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.vectors.delivered_maps import ReadMap, features_of_map
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.map.catalogue import CHANGE_KIND, Catalogue
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Status
from processing.map.map_extent import extent_of
from processing.map.reference_system import reference_system
from processing.map.renewal.map_comparison import (
    MOST_SEARCH_M,
    ComparisonLimits,
    MapComparison,
    compare_maps,
)
from processing.map.routes.centre_lines import centre_lines
from processing.map.routes.numbering import number_along_routes
from processing.map.routes.route import PITCH_M, routes_of
from processing.map.routes.width_lines import width_lines
from processing.methods.road.surface.road_frame import driven_lines
from processing.operations.inputs import opened_project
from processing.project.comparison.found_differences import (
    FoundDifferences,
    found_differences,
    store_differences,
)
from processing.project.comparison.measured_ground import MeasuredGround
from processing.project.project import Project
from processing.project.store.runs import Run
from processing.recording.drive import Drive
from processing.scoring.features.mapped_features import IN_DEGREES, MappedFile

ROAD_FORMAT = "road"
"""Id of the format of the road model."""

LEAST_PITCH_M, MOST_PITCH_M = 1.0, 1000.0
"""From station to station."""

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
WIDTHS_LABEL = Text("Draw {count} width lines", "幅員線を{count}本作図")
WIDTHS_DRAWN = Text(
    "{count} width lines drawn; those drawn so before were replaced.",
    "幅員線を{count}本作図しました（以前に自動作図したものは置き換えました）。",
)
NO_WIDTHS = Text(
    "No width can be measured: draw curbs, footways or road edges on both sides of the centre"
    " line.",
    "幅員を測れる線がありません。中心線の両側に縁石・歩道・道路縁を描いてください。",
)
CENTRE_LINES_LABEL = Text("Draw {count} centre lines", "道路中心線を{count}本作図")
CENTRE_LINES_DRAWN = Text(
    "{count} centre lines drawn midway between the edges; those drawn so before were replaced.",
    "両側の縁の中間に道路中心線を{count}本作図しました（以前に自動作図したものは置き換えました）。",
)
NO_EDGES = Text(
    "No centre line can be made: that needs a trajectory, and accepted curbs, footways or road"
    " edges on both sides of it.",
    "道路中心線を作成できません。軌跡と、その両側の採用済みの縁石・歩道・道路縁が必要です。",
)
_TAKE_LABEL = Text("Take in {count} features of {file}", "{file}から{count}個の地物を取り込み")
_TAKEN = Text("{count} features taken in.", "{count}個の地物を取り込みました。")
_SAME = Text("{count} things are where they were.", "{count}個の地物に変化はありません。")
_ONLY_BEFORE = Text(
    "Not compared, since nothing of the kind is on today's map: {kinds}.",
    "今回の図面に同じ種別がないため、次は比較していません: {kinds}",
)
_ONLY_NOW = Text(
    "Not compared, since nothing of the kind is on the last map: {kinds}.",
    "既存図に同じ種別がないため、次は比較していません: {kinds}",
)
_UNREACHED = Text(
    "{count} things or pieces of the last map lie where nothing was measured: nothing is said of"
    " them.",
    "既存図の{count}か所は計測範囲の外にあるため、判定していません。",
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
        _require_route(features, catalogue, operation.project)
        change = number_along_routes(features, catalogue)
        count = len(change.replaced)
        if count:
            project.features.apply(NUMBER_LABEL.filled(count=f"{count:,}"), change)
        return NumberedFeatures(count)


def _require_route(features: tuple[Feature, ...], catalogue: Catalogue, project: Path) -> None:
    if not routes_of(features, catalogue):
        raise MissingInput(
            Text("The map has no centre line.", "道路中心線がありません。"),
            Text.same(str(project)),
            Text("{remedy} {unchanged}", "{remedy}{unchanged}").filled(
                remedy=NO_CENTRE_LINE, unchanged=UNCHANGED
            ),
        )


@dataclass(frozen=True)
class WidthOperation:
    """A project whose roads' widths are to be drawn across them.

    Attributes
    ----------
    project : Path
    pitch_m : float
        From station to station; widths that change in between have lines too.
    """

    project: Path
    pitch_m: float = PITCH_M

    def check(self) -> None:
        """Refuse a pitch that is none before anything is opened.

        Raises
        ------
        OutOfRange
        """
        if not LEAST_PITCH_M <= self.pitch_m <= MOST_PITCH_M:
            raise OutOfRange(
                Text("Stations aren't so far apart.", "測点の間隔が範囲外です。"),
                Text.same(f"{self.pitch_m:g} m"),
                Text(
                    f"Give {LEAST_PITCH_M:g} to {MOST_PITCH_M:g} m; the project is unchanged.",
                    f"{LEAST_PITCH_M:g}～{MOST_PITCH_M:g} mで指定してください。"
                    "プロジェクトは変更されていません。",
                ),
            )


@dataclass(frozen=True)
class DrawnWidths:
    """How many width lines were drawn."""

    count: int

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        if not self.count:
            return (NO_WIDTHS,)
        return (WIDTHS_DRAWN.filled(count=f"{self.count:,}"),)


def draw_widths(operation: WidthOperation, monitor: Monitor) -> DrawnWidths:
    """Draw the widths of roads across them, as one step to be undone.

    Raises
    ------
    OutOfRange
        The pitch is none.
    MissingInput
        The map has no accepted centre line; or there is no such project.
    BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    operation.check()
    with opened_project(operation.project, writing=True) as project:
        features, catalogue = tuple(project.features.all()), project.catalogue
        monitor.check()
        _require_route(features, catalogue, operation.project)
        change = width_lines(features, catalogue, operation.pitch_m)
        count = len(change.added)
        if count:
            project.features.apply(WIDTHS_LABEL.filled(count=f"{count:,}"), change)
        return DrawnWidths(count)


@dataclass(frozen=True)
class CentreLineOperation:
    """A project whose roads are to get centre lines.

    Attributes
    ----------
    project : Path
    """

    project: Path


@dataclass(frozen=True)
class DrawnCentreLines:
    """How many centre lines were drawn."""

    count: int

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        if not self.count:
            return (NO_EDGES,)
        return (CENTRE_LINES_DRAWN.filled(count=f"{self.count:,}"),)


def draw_centre_lines(operation: CentreLineOperation, monitor: Monitor) -> DrawnCentreLines:
    """Draw centre lines midway between the edges of roads, as one step to be undone.

    Raises
    ------
    MissingInput, BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        ways = driven_lines(project.drives)
        monitor.check()
        change = centre_lines(tuple(project.features.all()), project.catalogue, ways)
        count = len(change.added)
        if count:
            project.features.apply(CENTRE_LINES_LABEL.filled(count=f"{count:,}"), change)
        return DrawnCentreLines(count)


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
        DXF, GeoPackage, GeoJSON, Shapefile, SIMA or extended DM.
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


@dataclass(frozen=True)
class CompareMapOperation:
    """A map that was delivered before, to be compared with a project's.

    Attributes
    ----------
    project, path, crs, of_kind
        As of :class:`TakeMapOperation`.
    limits : ComparisonLimits
    """

    project: Path
    path: Path
    crs: str = ""
    of_kind: str = ""
    limits: ComparisonLimits = field(default_factory=ComparisonLimits)

    def check(self) -> None:
        """Refuse limits that say nothing.

        Raises
        ------
        OutOfRange
        """
        if not 0.0 < self.limits.tolerance_m <= self.limits.search_m <= MOST_SEARCH_M:
            raise OutOfRange(
                Text(
                    "The tolerance must be above 0 and no larger than the search distance.",
                    "許容差は0より大きく、探索距離以下にしてください。",
                ),
                Text.same(f"{self.limits.tolerance_m:g} m, {self.limits.search_m:g} m"),
                Text(
                    f"Search up to {MOST_SEARCH_M:g} m.", f"探索距離は{MOST_SEARCH_M:g} m以下です。"
                ),
            )


@dataclass(frozen=True)
class MapSnapshot:
    """A project's map as it is when a job begins.

    Attributes
    ----------
    folder : Path
        Of the project.
    """

    folder: Path
    features: tuple[Feature, ...]
    catalogue: Catalogue
    crs: str
    drives: tuple[Drive, ...]

    @staticmethod
    def of(project: Project) -> MapSnapshot:
        """Of an open project."""
        return MapSnapshot(
            project.folder,
            tuple(project.features.all()),
            project.catalogue,
            project.crs,
            project.drives,
        )


@dataclass(frozen=True)
class ComparedMap:
    """What was stored of a comparison, and what has to be known about it.

    Attributes
    ----------
    run : Run
    notes : tuple of Text
    """

    run: Run
    notes: tuple[Text, ...]

    @property
    def words(self) -> tuple[Text, ...]:
        """A line for what was found, and one for each note."""
        return (self.run.summary, *self.notes)


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
    with opened_project(operation.project, writing=True) as project:
        snapshot = MapSnapshot.of(project)
        read = read_for_taking(operation, snapshot, monitor)
        if read.features:
            project.features.apply(label_of_taking(read, operation.path), Change(read.features))
        return TakenMap(len(read.features), read.notes)


def read_for_taking(
    operation: TakeMapOperation, snapshot: MapSnapshot, monitor: Monitor
) -> ReadMap:
    """What a project's map would get, without what it has; see :func:`take_map`."""
    known = frozenset(one.id for one in snapshot.features)
    ground = MeasuredGround(snapshot.drives, monitor)
    return _read(operation, snapshot, ground, monitor, known=known)


def label_of_taking(read: ReadMap, path: Path) -> Text:
    """What the undo menu calls the step."""
    return _TAKE_LABEL.filled(count=f"{len(read.features):,}", file=path.name)


def compare_map(operation: CompareMapOperation, monitor: Monitor) -> ComparedMap:
    """Put what is new, moved and gone since a map into a project, as candidates of a run.

    Raises
    ------
    MissingInput
        As :func:`take_map`; nothing is accepted yet; the catalogue has no kind for changes.
    OutOfRange, Unsuitable, BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    operation.check()
    with opened_project(operation.project, writing=True) as project:
        found, notes = differences_from(operation, MapSnapshot.of(project), monitor)
        store_differences(project, found)
        stored = project.runs.get(found.run.id) or found.run
        return ComparedMap(stored, notes)


def differences_from(
    operation: CompareMapOperation, snapshot: MapSnapshot, monitor: Monitor
) -> tuple[FoundDifferences, tuple[Text, ...]]:
    """What :func:`compare_map` stores, and what has to be known about it."""
    operation.check()
    started = datetime.now().astimezone()
    now = [
        one
        for one in snapshot.features
        if one.status is Status.ACCEPTED and one.kind != CHANGE_KIND
    ]
    if not now:
        raise MissingInput(
            Text(
                "Nothing is accepted or drawn yet that could be compared.",
                "比較できる採用済みの地物がまだありません。",
            ),
            Text.same(str(snapshot.folder)),
            Text(
                "Draw or accept features first. {unchanged}",
                "先に作図または採用してください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )
    ground = MeasuredGround(snapshot.drives, monitor)
    read = _read(operation, snapshot, ground, monitor, known=frozenset())
    before = [one for one in read.features if one.kind != CHANGE_KIND]
    compared = compare_maps(before, now, operation.limits, ground.holds, monitor)
    parameters: dict[str, AttributeValue] = {
        "map": operation.path.name,
        "tolerance_m": operation.limits.tolerance_m,
        "search_m": operation.limits.search_m,
    }
    found = found_differences(compared, snapshot.catalogue, now, parameters, started)
    return found, (*read.notes, *_notes_of(compared, snapshot.catalogue))


def _notes_of(compared: MapComparison, catalogue: Catalogue) -> Iterator[Text]:
    yield _SAME.filled(count=f"{compared.same:,}")
    for words, kinds in ((_ONLY_BEFORE, compared.only_before), (_ONLY_NOW, compared.only_now)):
        if kinds:
            names = [catalogue[kind].name for kind in kinds]
            listed = Text(", ".join(n.en for n in names), "、".join(n.ja for n in names))
            yield words.filled(kinds=listed)
    if compared.unreached:
        yield _UNREACHED.filled(count=f"{compared.unreached:,}")


def _read(
    operation: TakeMapOperation | CompareMapOperation,
    snapshot: MapSnapshot,
    ground: MeasuredGround,
    monitor: Monitor,
    *,
    known: frozenset[str],
) -> ReadMap:
    mapped = read_mapped(operation.path)
    monitor.check()
    mapped = replace(mapped, crs=_system_of(mapped, operation, snapshot))
    read = features_of_map(
        mapped,
        snapshot.catalogue,
        crs=snapshot.crs,
        known=known,
        kind=operation.of_kind,
        around=ground.bounds_with(extent_of(snapshot.features)),
    )
    monitor.check()
    return read


def _system_of(
    mapped: MappedFile, operation: TakeMapOperation | CompareMapOperation, snapshot: MapSnapshot
) -> str:
    """The reference system of a map: as the file says, else as was given."""
    own = snapshot.crs
    given = reference_system(operation.crs) if operation.crs else ""
    said = "" if mapped.crs == IN_DEGREES and given else mapped.crs
    if said and given and said != given:
        raise OutOfRange(
            Text(
                f"The file says {said}, not {given}.",
                f"ファイルの座標参照系は{said}です（{given}ではありません）。",
            ),
            Text.same(str(operation.path)),
            Text(
                "Leave the system out (--crs). {unchanged}",
                "座標参照系（--crs）の指定を省略してください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
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
                "Give it (--crs), for instance EPSG:6677. {unchanged}",
                "座標参照系（--crs）をEPSG:6677のように指定してください。{unchanged}",
            ).filled(unchanged=UNCHANGED)
            if own
            else Text("Set it in the project first.", "先にプロジェクトで設定してください。"),
        )
    return said or given
