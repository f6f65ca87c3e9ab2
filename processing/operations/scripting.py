"""Zuka for scripts: the operations by their names, on projects and delivered files.

What a script does is what window and command line do: the same values go to the same functions.
Paths may be text. Errors are :class:`processing.core.errors.UserError`, with what is wrong, where
and what to do; nothing is half done then.

>>> from processing.operations import scripting as zuka
>>> "noise" in zuka.tools() and "export" in zuka.operations()
True
>>> zuka.run("nose", "street.zuka")
Traceback (most recent call last):
...
processing.core.errors.OutOfRange: There is no such tool. | nose | Use one of: ...

A street from its files to its drawing::

    zuka.import_files("street.zuka", "delivery/left.laz", trajectories=["delivery/path.csv"])
    zuka.run("noise", "street.zuka", radius_m=0.4)
    zuka.extract("street.zuka", "curbs", "signs", accept_above=0.9)
    zuka.export("street.zuka", "papers", "dxf", "csv")
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.parameters import ParameterValue
from processing.operations.export import ExportRequest
from processing.operations.extraction import ExtractOperation, Extractor, ExtractOutcome
from processing.operations.extraction import extract as do_extract
from processing.operations.import_files import ImportOperation, ImportOutcome
from processing.operations.import_files import import_files as do_import
from processing.operations.inputs import inputs_of_paths
from processing.operations.operation_files import OPERATIONS, operation_from_text, perform
from processing.operations.project_export import ExportOperation, WrittenFiles, export_project
from processing.operations.run import RunOperation, RunOutcome, run_operation
from processing.operations.written_values import json_text
from processing.project.importing.import_request import ImportRequest
from processing.tools.listed.registry import every_tool

Place = str | Path
_QUIET = SilentMonitor()


def tools() -> tuple[str, ...]:
    """The ids of all processing tools."""
    return tuple(every_tool())


def operations() -> tuple[str, ...]:
    """The names of all operations that :func:`do` takes."""
    return tuple(OPERATIONS)


def do(kind: str, *, monitor: Monitor = _QUIET, **settings: object) -> object:
    """Do any operation, with the settings that its file would have; gives its outcome.

    >>> do("number", project="nowhere.zuka")
    Traceback (most recent call last):
    ...
    processing.core.errors.MissingInput: There is no project here. | nowhere.zuka | ...

    Raises
    ------
    UserError, Cancelled
        As the operation.
    """
    text = json_text({"kind": kind, **settings})
    return perform(operation_from_text(text, where=kind), monitor)


def import_files(
    project: Place,
    *points: Place,
    trajectories: Sequence[Place] = (),
    images: Sequence[Place] = (),
    crs: str = "",
    monitor: Monitor = _QUIET,
) -> ImportOutcome:
    """Make delivered files a project's drives; the project is made if there is none.

    Raises
    ------
    UserError, Cancelled
    """
    request = ImportRequest(_paths(points), _paths(trajectories), _paths(images), crs)
    return do_import(ImportOperation(Path(project), request), monitor)


def run(
    tool: str,
    *inputs: Place,
    output: Place | None = None,
    accept_above: float | None = None,
    monitor: Monitor = _QUIET,
    **parameters: ParameterValue,
) -> RunOutcome:
    """Run a tool on a project or on files; without output the project stores the result.

    Raises
    ------
    UserError, Cancelled
    """
    into = None if output is None else Path(output)
    given = inputs_of_paths(_paths(inputs))
    return run_operation(RunOperation(tool, given, parameters, into, accept_above), monitor)


def extract(
    project: Place,
    *only: str,
    accept_above: float | None = None,
    monitor: Monitor = _QUIET,
) -> ExtractOutcome:
    """Run every tool that finds things along a street, or those named.

    Raises
    ------
    UserError, Cancelled
    """
    chosen = tuple(Extractor(tool) for tool in only)
    inputs = inputs_of_paths((Path(project),))
    return do_extract(ExtractOperation(inputs, chosen, accept_above=accept_above), monitor)


def export(
    project: Place,
    folder: Place,
    *formats: str,
    candidates: bool = False,
    monitor: Monitor = _QUIET,
) -> WrittenFiles:
    """Write a project's map in each of some formats.

    Raises
    ------
    UserError, Cancelled
    """
    request = ExportRequest(formats, Path(folder), candidates=candidates)
    return export_project(ExportOperation(Path(project), request), monitor)


def _paths(places: Sequence[Place]) -> tuple[Path, ...]:
    return tuple(Path(one) for one in places)
