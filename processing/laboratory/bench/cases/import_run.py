"""Imports files into a new project, or only decodes them, in a process that can be watched.

``python -m processing.laboratory.bench.cases.import_run import PROJECT TRAJECTORY CLOUD...`` (no
trajectory: ``-``) or ``… decode CLOUD...``. It says "ready" once its modules are loaded, and "done"
at the end, each with the moment on the clock that all processes share.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

import laspy

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project

_DECODED_AT_ONCE = 1_000_000
_CRS = "EPSG:6677"


def import_into(folder: Path, trajectories: tuple[Path, ...], clouds: tuple[Path, ...]) -> None:
    """Make a project of delivered files."""
    with closing(Project.create(folder, _CRS)) as project:
        request = ImportRequest(clouds, trajectories)
        made = import_drives(request, project.temporary_folder(), SilentMonitor())
        project.adopt_drives(made)


def decode(clouds: Sequence[Path]) -> None:
    """Read every point of LAZ files as laspy gives it, and keep nothing."""
    for cloud in clouds:
        with laspy.open(cloud) as reader:
            for _ in reader.chunk_iterator(_DECODED_AT_ONCE):
                pass


def _report(word: str) -> None:
    sys.stdout.write(f"{word} {time.monotonic()}\n")
    sys.stdout.flush()


def main(what: str, names: Sequence[str]) -> None:
    """Do one of the two, and tell when."""
    _report("ready")
    if what == "decode":
        decode([Path(name) for name in names])
    else:
        project, trajectory, *clouds = names
        trajectories = () if trajectory == "-" else (Path(trajectory),)
        import_into(Path(project), trajectories, tuple(map(Path, clouds)))
    _report("done")


if __name__ == "__main__":
    write_every_character()
    main(sys.argv[1], sys.argv[2:])
