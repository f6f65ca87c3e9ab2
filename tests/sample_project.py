"""The sample street as a project: imported once for all test processes, and copied by each test."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.project.importing.dropped_files import request_of_files
from processing.project.importing.importing import import_drives
from processing.project.project import Project
from processing.tools.features import FEATURES
from processing.tools.listed.registry import point_tools
from processing.tools.running.runner import RunRequest, run
from processing.tools.tool import FinishedColumns
from resources import path_of


def make_sample_project(folder: Path) -> Path:
    """A closed project with the sample street, and what tools that mark its points found.

    The features of points are left out: they take longer than all else, and are made where a
    test looks at them.
    """
    with closing(Project.create(folder, "")) as project:
        request = request_of_files((path_of("sample_street"),), "")
        found = import_drives(request, project.temporary_folder(), SilentMonitor())
        for drive in project.adopt_drives(found):
            for tool in point_tools().values():
                if tool.id == FEATURES.id:
                    continue
                request = RunRequest(tool.id, drive, tool.parameters())
                result = run(request, SilentMonitor(), into=project.temporary_folder())
                assert isinstance(result, FinishedColumns)
                result.hand_over(drive.columns)
    return folder
