"""Benchmark of a large project: imported, opened, looked at, drawn upon and exported."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.large_import import import_watched, measure_large_import
from processing.laboratory.bench.cases.large_window import window_rows
from processing.laboratory.bench.cases.start_case import no_window
from processing.laboratory.bench.large_street import write_long_delivery
from processing.laboratory.bench.watched_run import run_watched
from processing.project.store.project_lock import LOCK_FILES

_CHANGING = "label.bin"
_COMPUTED = "tile_bounds_*.npy"

_POINTS = 300_000_000
_POINTS_PER_FILE = 30_000_000
_REHEARSED = 100_000
_DISPLAY = "display"


def measure_large(options: BenchmarkOptions, *, window: str) -> tuple[Measurement, ...]:
    """A project of 300 M points from the delivered files to the drawing that is handed in.

    Parameters
    ----------
    options : BenchmarkOptions
    window : str
        The module that uses a window: run by ``python -m`` with the project, a folder for what
        is exported and the share of the work, it prints a line of JSON for each step.

    Raises
    ------
    MissingInput
        The window can't be shown, mostly for want of a display.
    """
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        project, out = folder / "street.zuka", folder / "out"
        out.mkdir()
        rows: tuple[Measurement, ...] = ()
        if options.project is not None:
            link_project(options.project, project)
        else:
            points = options.points or options.limited(_POINTS)
            files = max(2, points // _POINTS_PER_FILE)
            delivery = write_long_delivery(folder, points, scanners=("left",), files=files)
            if options.share == 1.0:  # what isn't judged needs no rehearsal
                rehearsal = write_long_delivery(folder, _REHEARSED, scanners=("left",))
                import_watched(rehearsal, folder / "rehearsal.zuka")
            rows = measure_large_import(delivery, project, points)
        run = run_watched(window, [str(project), str(out), str(options.share)])
        if run.status != 0:
            if _DISPLAY in run.complaints:
                raise no_window(run.complaints)
            raise RuntimeError(run.complaints)
        steps = [json.loads(line) for line in run.lines if line.startswith("{")]
        return rows + window_rows(run, steps)


def link_project(folder: Path, copy: Path) -> None:
    """Make a project beside another one, which stays as it is.

    Columns are hard links where the disk allows it, otherwise symbolic ones; nothing writes into
    a column. Facts on tiles are left out, so that the copy is opened as if for the first time.

    Parameters
    ----------
    folder : Path
        The project.
    copy : Path
        Does not exist.
    """

    def ignored(_: str, names: list[str]) -> list[str]:
        return [name for name in names if name in LOCK_FILES or Path(name).match(_COMPUTED)]

    shutil.copytree(folder, copy, ignore=ignored, copy_function=_link_or_copy)


def _link_or_copy(source: str, target: str) -> None:
    path, new = Path(source).resolve(), Path(target)
    if path.suffix != ".bin" or path.name == _CHANGING:
        shutil.copy2(path, new)
        return
    try:
        new.hardlink_to(path)
    except OSError:  # another disk, or one that knows no hard links
        new.symlink_to(path)
