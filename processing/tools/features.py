"""The tool FEATURES: the numbers that the thesis describes a point by, as columns to look at."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import Unsuitable, name_with_type, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.core.parameters import ParameterChoice, choice, text
from processing.core.scratch_arrays import scratch_array
from processing.core.text import Text
from processing.methods.point_features.drive_features import computable_features, drive_features
from processing.recording.columns.columns import column_path
from processing.recording.columns.point_features import (
    BEST,
    POINT_FEATURES,
    SCALES_M,
    SELECTED,
    PointFeature,
)
from processing.recording.drive import Drive
from processing.tools.tool import FinishedColumns, Needs, OutputColumn, PerDrive, Tool

_SELECTED, _ALL = "selected", "all"
_SPHERES = Text("In space, {scale}", "3次元 {scale}")
_DISCS = Text("In plan, all radii", "2次元 全半径")
_SIZES = {scale: Text.same(f"{radius:g} m") for scale, radius in SCALES_M.items()} | {
    BEST: Text("best number of neighbours", "最適な近傍点数")
}


@dataclass(frozen=True)
class FeaturesParameters:
    """Which features are computed."""

    group: str = choice(
        _SELECTED,
        choices=(
            ParameterChoice(_SELECTED, Text("The thesis' selection", "論文で選択された特徴量")),
            *(
                ParameterChoice(f"sphere_{scale}", _SPHERES.filled(scale=words))
                for scale, words in _SIZES.items()
            ),
            ParameterChoice("disc", _DISCS),
            ParameterChoice("cell", Text("In a cell of 25 cm", "25 cmグリッド")),
            ParameterChoice("path", Text("From the trajectory", "走行軌跡")),
            ParameterChoice("line", Text("Of the scan line", "スキャンライン")),
            ParameterChoice(_ALL, Text("All", "すべて")),
        ),
        name=Text("Features", "特徴量"),
        explanation=Text(
            "Each is a column of 4 bytes a point. All of them take about three minutes a million "
            "points on one core, the best number of neighbours almost half of that.",
            "特徴量ごとに1点あたり4バイトの列になります。すべて計算すると1コアで100万点あたり約3分、"
            "その半分近くは最適な近傍点数の計算です。",
        ),
    )
    names: str = text(
        name=Text("Only these", "計算する特徴量"),
        explanation=Text(
            "Names with commas between, such as verticality_1m,cell_height; empty: all of the "
            "group. They are listed in the manual.",
            "verticality_1m,cell_height のようにコンマ区切りで指定します。"
            "空欄の場合は選んだグループのすべてです。名前はマニュアルに記載しています。",
        ),
    )


def chosen_features(parameters: FeaturesParameters) -> tuple[str, ...]:
    """Names of the features that are asked for, in the order of all.

    Raises
    ------
    OutOfRange
        There is no feature of a name.
    """
    names = {word.strip() for word in parameters.names.split(",")} - {""}
    for name in sorted(names):
        name_with_type(POINT_FEATURES, name, _NO_SUCH_FEATURE)
    if names:
        return tuple(name for name in POINT_FEATURES if name in names)
    return tuple(
        name for name, column in POINT_FEATURES.items() if _is_in(column, parameters.group)
    )


_NO_SUCH_FEATURE = Text("There is no such feature.", "そのような特徴量はありません。")


def _is_in(column: PointFeature, group: str) -> bool:
    if group == _SELECTED:
        return column.id in SELECTED
    return group == _ALL or column.group == group or column.group.startswith(f"{group}_")


def write_features(
    drive: Drive, parameters: FeaturesParameters, into: Path, points_at_once: int, monitor: Monitor
) -> FinishedColumns:
    """The chosen features of every point; those that a drive has what they need for.

    Parameters
    ----------
    into : Path
        Where the columns come to lie.
    points_at_once : int
        Not asked: what is in memory at a time is part of the method.

    Raises
    ------
    OutOfRange
        There is no feature of a name.
    Unsuitable
        The drive lacks what all that was chosen needs.
    NoSpace
        The disk can't hold the columns and 8 bytes a point meanwhile.
    """
    del points_at_once
    names, lacking = computable_features(drive, chosen_features(parameters))
    if not names:
        raise Unsuitable(
            Text("None of these features can be computed: {why}.",
                 "選択した特徴量は計算できません（{why}）。").filled(why=lacking),
            Text.same(drive.info.name),
            Text("Choose others, or import the drive with what it lacks.",
                 "他の特徴量を選ぶか、不足しているデータと一緒にインポートし直してください。"),
        )  # fmt: skip
    scratch = into / "scratch"
    with report_as_user_error(into):
        scratch.mkdir()
        columns = {name: _new_column(into, name, drive.count) for name in names}
        drive_features(drive, columns, scratch, monitor)
        for values in columns.values():
            if isinstance(values, np.memmap):
                values.flush()
        remove_folder(scratch)
    note = _LEFT_OUT.filled(why=lacking) if lacking.en else Text("", "")
    return FinishedColumns(into, names, drive.count, note)


_LEFT_OUT = Text("left out: {why}", "計算できない特徴量: {why}")


def _new_column(folder: Path, name: str, count: int) -> NDArray[np.float32]:
    path = column_path(folder, name)
    if not count:
        path.touch()
    values: NDArray[np.float32] = scratch_array(path, np.float32, count)
    values[:] = np.nan
    return values


FEATURES = Tool(
    id="features",
    name=Text("Features of points", "点群特徴量"),
    explanation=Text(
        "Describes every point by what lies around it: spheres of four radii and of the best "
        "number of neighbours, discs, cells of 25 cm, scan lines and the trajectory. Each number "
        "is a column that points can be coloured by.",
        "各点を周囲の点群で記述します（4種類の半径と最適な近傍点数の球、円、25 cmグリッド、"
        "スキャンライン、走行軌跡）。特徴量はそれぞれ列になり、点の色分けに使えます。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.POINTS,
    parameters=FeaturesParameters,
    method=PerDrive(
        write_features,
        outputs=tuple(
            OutputColumn(column.id, "float32", 1, column.title)
            for column in POINT_FEATURES.values()
        ),
    ),
)
