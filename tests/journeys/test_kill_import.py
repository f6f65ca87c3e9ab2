"""An import killed at any moment and started again gives what an undisturbed one gives."""

from __future__ import annotations

import itertools
import os
import random
import select
import signal
import subprocess
import sys
import time
from contextlib import closing, suppress
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.project.project import Project, is_project
from resources import path_of
from tests.earthwork_site import earthwork_site, write_site
from tests.processing.project.drawn import tree_of

# Runs `zuka import` again and again, each time in a process of its own; what takes long to load is
# loaded once. Notes are written at once instead of every ten seconds, after short stretches.
IMPORTING = """
import os, sys
import app.cli.import_drives
from app.__main__ import main
from processing.project.importing import file_recorder, import_journal, import_processes
import_journal.SECONDS = 0.0
file_recorder.CHUNK_POINTS = 9_000
import_processes.FEWEST_POINTS, import_processes.LAZ_CORES = int(sys.argv[1]), 1
print("ready", flush=True)
for line in sys.stdin:
    child = os.fork()
    if child == 0:
        sys.argv = ["zuka", "import", *line.rstrip("\\n").split("\\t")]
        os.close(1)
        os.close(2)
        os.open(os.devnull, os.O_WRONLY)
        os.open(os.devnull, os.O_WRONLY)
        os._exit(main())
    print(child, flush=True)
    print(os.waitpid(child, 0)[1], flush=True)
"""


class Importer:
    """Starts imports, and kills them when asked to."""

    def __init__(self, processes_from: int) -> None:
        command = [sys.executable, "-c", IMPORTING, str(processes_from)]
        self._server = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0
        )
        assert self._server.stdout.readline() == b"ready\n"

    def run(self, *arguments: object, kill_after_s: float = 600.0) -> bool:
        """Import; says whether it came to its end."""
        self._server.stdin.write("\t".join(map(str, arguments)).encode() + b"\n")
        child = int(self._server.stdout.readline())
        if not select.select([self._server.stdout], [], [], kill_after_s)[0]:
            with suppress(ProcessLookupError):  # it came to its end at this very instant
                os.kill(child, signal.SIGKILL)
        status = int(self._server.stdout.readline())
        assert status in (0, signal.SIGKILL), status
        return status == 0

    def close(self) -> None:
        """End the process that starts them."""
        self._server.stdin.close()
        self._server.wait()
        self._server.stdout.close()


def _has_drives(folder: Path) -> bool:
    """Whether the import had come to its end, whatever was killed then."""
    if not is_project(folder):
        return False
    with closing(Project.open(folder, writing=False)) as project:
        return bool(project.drives)


def _sample(scanner: str, points: int) -> laspy.LasData:
    with laspy.open(path_of(f"sample_street/{scanner}.laz")) as reader:
        cloud = reader.read()
    cloud.points = cloud.points[:points]
    return cloud


def _written(folder: Path, cloud: laspy.LasData, records: np.ndarray, files: int) -> list[Path]:
    paths = []
    for number, part in enumerate(np.array_split(records, files)):
        one = laspy.LasData(cloud.header)
        one.points = laspy.ScaleAwarePointRecord(
            part, cloud.header.point_format, cloud.header.scales, cloud.header.offsets
        )
        paths.append(folder / f"通り{number + 1}.laz")
        one.write(paths[-1])
    return paths


def on_another_clock(folder: Path) -> list[Path]:
    """One scanner's drive in four files, on a clock that is not the trajectory's."""
    cloud = _sample("left", 60_000)
    cloud.gps_time = np.asarray(cloud.gps_time) + 1e9
    return _written(folder, cloud, cloud.points.array, 4)


def mixed_without_order(folder: Path) -> list[Path]:
    """Two scanners in each of three files, the points of each file shuffled."""
    left, right = (_sample(scanner, 30_000) for scanner in ("left", "right"))
    points = np.concatenate([left.points.array, right.points.array])
    points["point_source_id"] = np.repeat([1, 2], 30_000)
    points = points[np.argsort(points["gps_time"], kind="stable")]
    random_ = np.random.default_rng(3)
    thirds = [random_.permutation(third) for third in np.array_split(points, 3)]
    return _written(folder, left, np.concatenate(thirds), 3)


def without_times(folder: Path) -> list[Path]:
    """A cloud for the top view."""
    cloud = _sample("left", 60_000)
    cloud.gps_time[:] = np.nan
    return _written(folder, cloud, cloud.points.array, 1)


def of_two_dates(folder: Path) -> list[Path]:
    """A site, twice: on either date a file of two stations with the same numbers."""
    return [
        write_site(earthwork_site(date), folder / f"現場{date}.laz", start_s=3.5e8 + date * 3e6)
        for date in range(2)
    ]


@pytest.mark.parametrize(
    ("delivered", "processes_from", "kills"),
    [
        (on_another_clock, 10**9, 6),
        (mixed_without_order, 10**9, 8),
        (without_times, 10**9, 3),
        (on_another_clock, 0, 3),
        (of_two_dates, 10**9, 2),
    ],
)
def test_killed_at_random_instants_an_import_goes_on_to_the_same_bytes(
    tmp_path, delivered, processes_from, kills
):
    paths = delivered(tmp_path)
    inputs = [*paths, "--trajectory", path_of("sample_street/trajectory.csv")]
    if delivered in (without_times, of_two_dates):
        inputs = paths
    choice = random.Random(kills)  # noqa: S311 - moments, not secrets
    importer = Importer(processes_from)
    try:
        start = time.perf_counter()
        assert importer.run(tmp_path / "undisturbed.zuka", *inputs)
        duration = time.perf_counter() - start
        whole = tree_of(tmp_path / "undisturbed.zuka" / "drives")
        assert whole
        killed, attempts = 0, itertools.count()
        while killed < kills:
            folder = tmp_path / f"{next(attempts)}.zuka"
            for _ in range(4):
                moment = choice.uniform(0, duration)
                killed += not importer.run(folder, *inputs, kill_after_s=moment)
                if _has_drives(folder):
                    break
            else:
                assert importer.run(folder, *inputs)
            Project.open(folder).close()
            assert tree_of(folder / "drives") == whole
            assert list((folder / "tmp").iterdir()) == []
    finally:
        importer.close()
