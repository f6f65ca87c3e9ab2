"""Benchmark of growth: the same work on one, three, ten … millions of points."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.image.attributes.attributes import colours
from processing.image.images_of_drives import image_of
from processing.labels.label_column import labels_of
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.large_street import LongDelivery, write_long_delivery
from processing.laboratory.bench.timing import median_seconds, seconds_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project
from processing.project.results.label_export import write_labelled_points
from processing.recording.drive import Drive
from processing.tools.normals import NORMALS
from processing.tools.running.runner import RunRequest, run
from processing.tools.segments import SEGMENTS

SIZES = (1_000_000, 3_000_000, 10_000_000, 30_000_000, 100_000_000)
MOST_EXPONENT = 1.05
"""As fast as the data, and a twentieth for what measuring itself is unsure of."""

_FILES = 2
_SCREEN = (768, 1366)
_REPEATS = 5
_LABELLED_OF = 10
_CLASS = 2
_LABEL = Text("Label points", "点のラベル")
_WORKS: Mapping[str, Text] = {
    "import": Text("Import", "インポート"),
    "open": Text("Opening the project", "プロジェクトを開く"),
    "screen": Text("Raster of a screen at full sharpness", "1画面の画素計算"),
    "overview": Text("First sharp tile of an overview", "全体表示の最初のタイル"),
    "tiles": Text("Table of all tiles", "全タイルの表"),
    "normals": Text("Normals and shape", "法線と形状"),
    "segments": Text("Segments", "セグメント"),
    "label-undo": Text("Undo of a label on a tenth of all points", "全点の1/10のラベルの取り消し"),
    "label-export": Text("Export of labelled points (LAZ)", "ラベル付き点群の書き出し（LAZ）"),
}


def measure_growth(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """The exponent with which the time of each work grows with the points, and its times."""
    sizes = sizes_within(options)
    times: dict[str, list[float]] = {name: [] for name in _WORKS}
    for size in _rehearse_first(sizes):
        with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
            for work, seconds in _times_of(Path(name), abs(size)):
                if size > 0:
                    times[work].append(seconds)
    return tuple(growth_row(name, work, sizes, times[name]) for name, work in _WORKS.items())


def exponent_of(sizes: Sequence[int], seconds: Sequence[float]) -> float:
    """Of the power law nearest to the times, by least squares of logarithms."""
    slope, _ = np.polyfit(np.log(sizes), np.log(seconds), 1)
    return float(slope)


def sizes_within(options: BenchmarkOptions) -> list[int]:
    """At least two of the sizes, or smaller ones where fewer points are wanted."""
    sizes = [size for size in SIZES if size == options.limited(size)]
    most = options.limited(SIZES[-1])
    return sizes if len(sizes) > 1 else [max(1, most // 3), most]


def _rehearse_first(sizes: list[int]) -> Iterator[int]:
    """The sizes, and before them the first one as a negative number: done, but not measured."""
    yield -sizes[0]
    yield from sizes


def _times_of(folder: Path, points: int) -> Iterator[tuple[str, float]]:
    delivery = write_long_delivery(folder, points, scanners=("left",), files=_FILES)
    position = folder / "street.zuka"
    yield "import", seconds_of(partial(_import, delivery, position))
    yield "open", median_seconds(partial(_open, position), _REPEATS)
    with closing(Project.open(position)) as project:
        (drive,) = project.drives
        yield from _image_times(drive)
        yield from _tool_times(drive, folder / "columns")
        yield from _label_times(project, drive, folder)


def _import(delivery: LongDelivery, position: Path) -> None:
    with closing(Project.create(position, "EPSG:6677")) as project:
        request = ImportRequest(delivery.clouds, (delivery.trajectory,))
        made = import_drives(request, project.temporary_folder(), SilentMonitor())
        project.adopt_drives(made)


def _open(position: Path) -> None:
    """To the first tile that can be drawn of the drive's beginning."""
    with closing(Project.open(position)) as project:
        (drive,) = project.drives
        image = image_of(drive, drive.image_kinds[0])
        image.raster(range(min(image.rows, 256)), range(min(image.width, 256)))


def _image_times(drive: Drive) -> Iterator[tuple[str, float]]:
    image = image_of(drive, drive.image_kinds[0])
    middle = image.rows // 2
    rows = range(middle, min(middle + _SCREEN[1], image.rows))
    columns = range(min(image.width, _SCREEN[0]))
    yield "screen", median_seconds(partial(image.raster, rows, columns), _REPEATS)
    pyramid = image.pyramid

    def overview() -> None:
        colours(drive, pyramid.points(pyramid.top), "intensity", 2.0, 98.0)

    yield "overview", median_seconds(overview, _REPEATS)
    yield "tiles", seconds_of(pyramid.prepare)


def _tool_times(drive: Drive, into: Path) -> Iterator[tuple[str, float]]:
    for tool in (NORMALS, SEGMENTS):
        request = RunRequest(tool.id, drive, tool.parameters())
        yield tool.id, seconds_of(partial(run, request, SilentMonitor(), into=into))
        shutil.rmtree(into)


def _label_times(project: Project, drive: Drive, folder: Path) -> Iterator[tuple[str, float]]:
    points = np.arange(0, drive.count, _LABELLED_OF)
    before = labels_of(drive, points)
    change = Change(labels=label_changes(drive.id, points, before, _CLASS))
    project.features.apply(_LABEL, change)
    yield "label-undo", seconds_of(project.features.undo)
    project.features.redo()
    out = folder / "labelled"
    out.mkdir()
    position: Callable[[str], Path] = out.joinpath
    yield (
        "label-export",
        seconds_of(partial(write_labelled_points, [drive], position, SilentMonitor())),
    )


def growth_row(
    name: str, work: Text, sizes: Sequence[int], seconds: Sequence[float]
) -> Measurement:
    """The exponent with which the time of a work grows with the points."""
    reported = ", ".join(
        f"{size / 1e6:g} M {_short(one)}" for size, one in zip(sizes, seconds, strict=True)
    )
    return Measurement(
        f"growth-{name}",
        Text("Growth: {work}", "増え方: {work}").filled(work=work),
        exponent_of(sizes, seconds),
        "exponent",
        MOST_EXPONENT,
        is_at_most=True,
        detail=reported,
        figures={f"{size}_s": one for size, one in zip(sizes, seconds, strict=True)},
    )


def _short(seconds: float) -> str:
    return f"{1000 * seconds:.1f} ms" if seconds < 0.1 else f"{seconds:.2f} s"
