"""Benchmarks of the point-cloud image: building it, and switching what its pixels show."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.image.attributes.attributes import available, colours
from processing.image.images_of_drives import image_of
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.large_street import write_large_street
from processing.laboratory.bench.timing import median_seconds
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.tools.normals import NORMALS
from processing.tools.running.runner import RunRequest, run
from processing.tools.segments import SEGMENTS
from processing.tools.tool import FinishedColumns

_POINTS = 10_000_000
_REPEATS = 5
_SCREEN = (768, 1366)


def measure_image(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Points per second put into the raster of a whole drive, the slowest of the four kinds."""
    with _large_drive(options.limited(_POINTS)) as drive:
        speeds = {}
        for kind in drive.image_kinds:
            image = image_of(drive, kind)
            image.raster(range(image.rows), range(image.width))
            whole = partial(image.raster, range(image.rows), range(image.width))
            speeds[kind] = drive.count / median_seconds(whole, _REPEATS) / 1e6
    slowest = min(speeds.values())
    detail = ", ".join(f"{kind.value} {speed:.0f}" for kind, speed in speeds.items())
    figures = {kind.value: speed for kind, speed in speeds.items()}
    row = Measurement(
        "image",
        Text("Building a point-cloud image", "点群画像の作成"),
        slowest,
        "M points/s",
        20.0,
        is_at_most=False,
        detail=detail,
        figures=figures,
    )
    return (row,)


def measure_switch(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Time to colour a full screen of pixels by another attribute, the slowest of those at hand.

    The columns that the window prepares in the background are there, as they are for a surveyor
    some seconds after the import.
    """
    with _large_drive(options.limited(_POINTS)) as drive:
        for tool in (NORMALS, SEGMENTS):
            request = RunRequest(tool.id, drive, tool.parameters())
            found = run(request, SilentMonitor(), into=drive.folder.parent / tool.id)
            if isinstance(found, FinishedColumns):
                found.hand_over(drive.columns)
        image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
        rows = range(min(image.rows, _SCREEN[1]))
        columns = range(min(image.width, _SCREEN[0]))
        points = image.raster(rows, columns)
        times = {}
        for attribute in available(drive):
            colours(drive, points, attribute, 2.0, 98.0)
            switch = partial(colours, drive, points, attribute, 2.0, 98.0)
            times[attribute] = 1000 * median_seconds(switch, _REPEATS)
    detail = ", ".join(f"{name} {time:.0f} ms" for name, time in times.items())
    figures = {f"{name}_ms": time for name, time in times.items()}
    row = Measurement(
        "switch",
        Text("Showing another attribute on a full screen", "全画面の表示属性の切り替え"),
        max(times.values()),
        "ms",
        100.0,
        is_at_most=True,
        detail=detail,
        figures=figures,
    )
    return (row,)


@contextmanager
def _large_drive(points: int) -> Iterator[Drive]:
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, points)
        request = ImportRequest((cloud,), (trajectory,))
        (drive_folder,) = import_drives(request, folder / "drives", SilentMonitor())
        yield Drive(drive_folder)
