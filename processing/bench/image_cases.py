"""Benchmarks of the point-cloud image: building it, and switching what its pixels show."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.bench.case import Measurement
from processing.bench.import_cases import seconds_of
from processing.bench.large_street import write_large_street
from processing.image.attributes import available, colours
from processing.image.kinds import ImageKind
from processing.monitor import SilentMonitor
from processing.points.drive import Drive
from processing.project.importing import ImportRequest, import_drives
from processing.runner import RunRequest, columns_of, run
from processing.text import Text
from processing.tools.normals import NORMALS
from processing.tools.segments import SEGMENTS

_POINTS = 10_000_000
_REPEATS = 5
_SCREEN = (768, 1366)


def measure_image() -> Measurement:
    """Points per second put into the raster of a whole drive, the slowest of the four kinds."""
    with _large_drive() as drive:
        speeds = {}
        for kind in drive.image_kinds:
            image = drive.image(kind)
            image.raster(range(image.rows), range(image.width))
            times = [
                seconds_of(lambda: image.raster(range(image.rows), range(image.width)))  # noqa: B023
                for _ in range(_REPEATS)
            ]
            speeds[kind] = drive.count / sorted(times)[_REPEATS // 2] / 1e6
    slowest = min(speeds.values())
    detail = ", ".join(f"{kind.value} {speed:.0f}" for kind, speed in speeds.items())
    return Measurement(
        "image",
        Text("Building a point-cloud image", "点群画像の作成"),
        slowest,
        "M points/s",
        20.0,
        is_at_most=False,
        detail=detail,
    )


def measure_switch() -> Measurement:
    """Time to colour a full screen of pixels by another attribute, the slowest of those at hand.

    The columns that the window prepares in the background are there, as they are for a surveyor
    some seconds after the import.
    """
    with _large_drive() as drive:
        for tool in (NORMALS, SEGMENTS):
            request = RunRequest(tool.id, drive, tool.parameters())
            for name, values in columns_of(run(request, SilentMonitor())).items():
                drive.columns.add(name, values)
        image = drive.image(ImageKind.TRAJECTORY_CENTER)
        rows = range(min(image.rows, _SCREEN[1]))
        columns = range(min(image.width, _SCREEN[0]))
        points = image.raster(rows, columns)
        times = {}
        for attribute in available(drive):
            colours(drive, points, attribute, 2.0, 98.0)
            measured = [
                seconds_of(lambda: colours(drive, points, attribute, 2.0, 98.0))  # noqa: B023
                for _ in range(_REPEATS)
            ]
            times[attribute] = sorted(measured)[_REPEATS // 2] * 1000
    detail = ", ".join(f"{name} {time:.0f} ms" for name, time in times.items())
    return Measurement(
        "switch",
        Text("Showing another attribute on a full screen", "全画面の表示属性の切り替え"),
        max(times.values()),
        "ms",
        100.0,
        is_at_most=True,
        detail=detail,
    )


@contextmanager
def _large_drive() -> Iterator[Drive]:
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, _POINTS)
        request = ImportRequest((cloud,), (trajectory,))
        (drive_folder,) = import_drives(request, folder / "drives", SilentMonitor())
        yield Drive(drive_folder)
