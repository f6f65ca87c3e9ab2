"""The tool CLASSIFY: what every point belongs to, from ground and grass to signs and wires."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from processing.core.errors import UserError, report_as_user_error
from processing.core.monitor import Monitor, PartMonitor, parts_of
from processing.core.owned_files import remove_folder
from processing.core.parameters import ParameterChoice, choice, file, ratio, switch
from processing.core.scratch_arrays import scratch_array
from processing.core.text import Text
from processing.methods.classes.aerial_cells import is_from_air, spacing_m
from processing.methods.classes.aerial_classes import classify_thin_cloud
from processing.methods.classes.class_models import (
    SCAN_CELL_M,
    ClassModels,
    aerial_models,
    scan_models,
    shipped_models,
)
from processing.methods.classes.drive_classes import FoundClasses, classify_drive
from processing.methods.classes.found_things import FoundThings
from processing.methods.classes.own_model import ModelFacts, read_own_model
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.density import is_single_scan
from processing.recording.drive import Drive
from processing.scoring.scorers import CLASS_SCORER
from processing.tools.found_things import LookedFor, look_for_things
from processing.tools.tool import (
    FinishedColumns,
    Needs,
    OutputColumn,
    Together,
    TogetherResult,
    Tool,
)

_CLASS, _CONFIDENCE = "classification", "confidence"
_LOOKING, _FINDING = 0.5, 0.95
"""Of the progress: when things were looked for; of a drive, when all its points have a class."""
_OTHER = 1

CLASSES = (2, 3, 4, 5, 6, 11, 14, 64, 65, 66, 67)
"""Ground, grass, low plants, crowns, buildings, roads, wires, what moves, signs, poles, curbs."""

_TOWER = 15
"""Of clouds from the air only: their model knows power lines' towers, and neither grass, roads,
signs nor curbs."""


OWN, SHIPPED = "own", "shipped"

_NO_NOTE = Text("", "")
_NOTHING = LookedFor(FoundThings(), _NO_NOTE)
_LEARNT = Text("model learnt on {date}, {points} points", "{date}学習のモデル、{points}点")
_SHIPPED = Text("the program's own model", "付属のモデル")
_WORSE = Text(
    "the program's own model; what was learnt on {date} is no better",
    "付属のモデル。{date}の学習結果は改善していません",
)
_FROM_AIR = Text(
    "points lie {spacing} m apart, so the model for clouds from the air says what they are",
    "点間隔が{spacing} mのため、上空からの点群用のモデルで分類しました",
)
_SINGLE_SCAN = Text(
    "few points about one scanner, so the model for single scans says what they are",
    "1か所から測ったまばらな点群のため、単独スキャン用のモデルで分類しました",
)
_UNREADABLE = Text("the program's own model: {why}", "付属のモデル: {why}")


@dataclass(frozen=True)
class ClassifyParameters:
    """How sure a class must be, and who says so."""

    least_confidence: float = ratio(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Least confidence", "信頼度の下限"),
        explanation=Text(
            "Points whose class is less likely than this become “other” (1).",
            "クラスの信頼度がこの値より低い点は「その他」（1）とします。",
        ),
    )
    looks_for_things: bool = switch(
        default=True,
        name=Text("Look for things first", "地物を先に探索"),
        explanation=Text(
            "Curbs, signs, poles and trees are found as their own tools find them, and tell the "
            "class of their points. It takes about twice the time.",
            "縁石・標識・柱状物・樹木をそれぞれの抽出機能で探し、その点のクラスを決めます。"
            "処理時間は約2倍です。",
        ),
    )
    model: str = choice(
        OWN,
        choices=(
            ParameterChoice(OWN, Text("Learnt here, if there is one", "学習したモデルを優先")),
            ParameterChoice(SHIPPED, Text("The program's own", "付属のモデル")),
        ),
        name=Text("Model", "モデル"),
        explanation=Text(
            "What was learnt from your corrections is used where it did no worse on them than the "
            "model that comes with the program.",
            "修正から学習したモデルを使います。付属のモデルより悪い場合は付属のモデルを使います。",
        ),
    )
    model_folder: str = file(
        name=Text("Folder of a learnt model", "学習したモデルのフォルダ"),
        explanation=Text(
            "Empty: the newest that this project learnt. Those of a project are in its folder "
            "models/classes.",
            "空欄の場合は、このプロジェクトで最後に学習したモデルです。"
            "モデルはプロジェクトの models/classes フォルダにあります。",
        ),
    )


def mark_classes(
    drives: tuple[Drive, ...],
    parameters: ClassifyParameters,
    into: Path,
    points_at_once: int,
    monitor: Monitor,
) -> TogetherResult:
    """The class of every point and how sure it is; noise keeps its class.

    Parameters
    ----------
    drives : tuple of Drive
        Recorded together: what is found on them tells the points of all.
    into : Path
        Gets the columns of the first drive, and folders for the others.
    points_at_once : int
        Not asked: what is in memory at a time is part of the method.

    Raises
    ------
    NoSpace
        The disk can't hold the columns and some 20 bytes a point meanwhile.
    """
    del points_at_once
    folders = [into / str(number) if number else into for number in range(len(drives))]
    with report_as_user_error(into):
        for folder in folders[1:]:
            folder.mkdir()
    models, note = models_of(parameters)
    known = _Known(models, parameters.least_confidence)
    from_air = tuple(drive for drive in drives if is_from_air(drive))
    scans = tuple(drive for drive in drives if drive not in from_air and is_single_scan(drive))
    on_street = tuple(drive for drive in drives if drive not in (*from_air, *scans))
    looked, start = _NOTHING, 0.0
    if parameters.looks_for_things and on_street:
        looked, start = look_for_things(on_street, PartMonitor(monitor, 0.0, _LOOKING)), _LOOKING
    thin = [_Thin((drive,), SCAN_CELL_M, scan_models()) for drive in scans]
    if from_air:
        apart_m = spacing_m(from_air)
        thin.append(_Thin(from_air, apart_m, aerial_models()))
        note = _joined(note, _FROM_AIR.filled(spacing=f"{apart_m:.2f}"))
    if scans:
        note = _joined(note, _SINGLE_SCAN)
    sizes = [drive.count for drive in on_street] + [one.count for one in thin]
    parts = parts_of(PartMonitor(monitor, start, 1.0), sizes)
    folder_of = dict(zip((drive.id for drive in drives), folders, strict=True))
    columns: dict[str, FinishedColumns] = {}
    for drive, part in zip(on_street, parts[: len(on_street)], strict=True):
        columns[drive.id] = _mark_street(drive, known, looked.things, folder_of[drive.id], part)
    for cloud, part in zip(thin, parts[len(on_street) :], strict=True):
        columns |= _mark_thin(cloud, parameters.least_confidence, folder_of, part)
    return TogetherResult(
        tuple(columns[drive.id] for drive in drives), note=_joined(note, looked.note)
    )


@dataclass(frozen=True)
class _Known:
    """What says what a street's point is, and how sure any point's class must be."""

    models: ClassModels
    least_confidence: float


def _mark_street(
    drive: Drive, known: _Known, things: FoundThings, into: Path, monitor: Monitor
) -> FinishedColumns:
    scratch = into / "scratch"
    with report_as_user_error(scratch):
        scratch.mkdir()
        found = unknown_classes(drive, scratch)
        if drive.count:
            classify_drive(
                drive,
                found.codes,
                found.confidence,
                scratch,
                PartMonitor(monitor, 0.0, _FINDING),
                models=known.models,
                things=things,
            )
        columns = write_classes(drive, found, known.least_confidence, into, monitor)
        remove_folder(scratch)
    return columns


@dataclass(frozen=True)
class _Thin:
    """Drives that are classified together by cells of their own width, and by which models."""

    drives: tuple[Drive, ...]
    cell_m: float
    models: ClassModels

    @property
    def count(self) -> int:
        return sum(drive.count for drive in self.drives)


def _mark_thin(
    cloud: _Thin, least_confidence: float, folder_of: Mapping[str, Path], monitor: Monitor
) -> dict[str, FinishedColumns]:
    """Classify strips of a flight together, or one single scan of a street."""
    scratch = folder_of[cloud.drives[0].id] / "scratch"
    columns: dict[str, FinishedColumns] = {}
    with report_as_user_error(scratch):
        scratch.mkdir()
        found = [unknown_classes(drive, scratch) for drive in cloud.drives]
        classify_thin_cloud(
            cloud.drives,
            [one.codes for one in found],
            [one.confidence for one in found],
            scratch,
            PartMonitor(monitor, 0.0, _FINDING),
            models=cloud.models,
            cell_m=cloud.cell_m,
        )
        for drive, one in zip(cloud.drives, found, strict=True):
            into = folder_of[drive.id]
            columns[drive.id] = write_classes(drive, one, least_confidence, into, monitor)
        remove_folder(scratch)
    return columns


def unknown_classes(drive: Drive, scratch: Path) -> FoundClasses:
    """Room on the disk for what is found of a drive's points."""
    return FoundClasses(
        scratch_array(scratch / f"codes {drive.id}", np.uint8, drive.count),
        scratch_array(scratch / f"confidence {drive.id}", np.float32, drive.count),
    )


def _joined(*notes: Text) -> Text:
    said = [one for one in notes if one.en]
    return Text("; ".join(one.en for one in said), "。".join(one.ja for one in said))


def models_of(parameters: ClassifyParameters) -> tuple[ClassModels, Text]:
    """The models that parameters ask for, and which they are.

    A model that can't be read is named, and the one that comes with the program takes its place: a
    project is to be classified on the day after an update, too.
    """
    if parameters.model == SHIPPED or not parameters.model_folder:
        chosen = _SHIPPED if parameters.model == SHIPPED else _NO_NOTE
        return shipped_models(), chosen
    try:
        facts, models = read_own_model(Path(parameters.model_folder))
    except UserError as error:
        return shipped_models(), _UNREADABLE.filled(why=_without_stop(error.what))
    if not facts.gain.helps:
        return shipped_models(), _WORSE.filled(date=_date_of(facts))
    return models, _LEARNT.filled(date=_date_of(facts), points=f"{facts.points:,}")


def _date_of(facts: ModelFacts) -> str:
    return f"{facts.made.astimezone():%Y-%m-%d %H:%M}"


def _without_stop(sentence: Text) -> Text:
    return Text(sentence.en.rstrip("."), sentence.ja.rstrip("。"))


def write_classes(
    drive: Drive, classes: FoundClasses, least: float, into: Path, monitor: Monitor
) -> FinishedColumns:
    """The columns of a drive; less sure points are “other”, unasked ones as they were delivered."""
    with ColumnWriter(into) as writer:
        writer.append({_CLASS: np.empty(0, np.uint8), _CONFIDENCE: np.empty(0, np.float32)})
        for start, stop in chunk_ranges(drive.count):
            monitor.check()
            found = np.array(classes.codes[start:stop])
            confidence = np.array(classes.confidence[start:stop])
            found[(found > 0) & (confidence < least)] = _OTHER
            if drive.columns.has(_CLASS):
                delivered = read_chunk(drive.folder, _CLASS, start, stop)
                found = np.where(found > 0, found, delivered)
            writer.append({_CLASS: found, _CONFIDENCE: confidence})
    return FinishedColumns(into, (_CLASS, _CONFIDENCE), drive.count)


CLASSIFY = Tool(
    id="classify",
    name=Text("Classes", "点群の分類"),
    explanation=Text(
        "Gives every point a class with a confidence: ground (2), grass (3), low plants (4), "
        "crowns (5), buildings (6), roads (11), wires (14), vehicles and people (64), signs (65), "
        "poles and trunks (66), curbs (67), other (1). Noise keeps its class. It asks for neither "
        "trajectory nor rows. Clouds from the air have a model of their own: ground, low plants, "
        "crowns, buildings, wires, towers (15), poles and vehicles; so have single scans of "
        "spinning heads, with a street's classes.",
        "各点にクラスと信頼度を付けます。地面（2）、草地（3）、低木（4）、樹冠（5）、建物（6）、"
        "路面（11）、電線（14）、移動体（64）、標識（65）、柱状物・幹（66）、縁石（67）、その他（1）。"
        "ノイズのクラスはそのままです。走行軌跡もスキャンの並びも必要ありません。"
        "上空からの点群には専用のモデルを使い、地面・低木・樹冠・建物・電線・鉄塔（15）・柱状物・"
        "移動体に分けます。回転式スキャナの単独スキャンにも専用のモデルがあり、"
        "クラスは道路と同じです。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.POINTS,
    parameters=ClassifyParameters,
    method=Together(
        mark_classes,
        outputs=(
            OutputColumn(_CLASS, "uint8", 1, Text("Class", "クラス")),
            OutputColumn(_CONFIDENCE, "float32", 1, Text("Confidence", "信頼度")),
        ),
    ),
    gives_classes=(_OTHER, *CLASSES, _TOWER),
    scorer=CLASS_SCORER,
)
