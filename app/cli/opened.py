"""Inputs of a command: what its arguments name, as operations take it."""

from __future__ import annotations

import argparse
from contextlib import AbstractContextManager

from app.settings.language import system_language
from processing.core.monitor import Monitor, TerminalMonitor
from processing.operations.inputs import (
    OpenedInputs,
    OperationInputs,
    inputs_of_paths,
    opened_inputs,
)
from processing.operations.run import no_single_input
from processing.project.importing.dropped_files import is_folder_of_files, request_of_files
from processing.project.importing.import_request import ImportRequest


def terminal_monitor() -> Monitor:
    """Progress on standard error, in the user's language."""
    return TerminalMonitor(language=system_language())


def opened_input(
    arguments: argparse.Namespace, monitor: Monitor
) -> AbstractContextManager[OpenedInputs]:
    """What ``arguments.inputs`` name; what is imported for it is removed afterwards.

    It is imported to the disk of ``arguments.output``.

    Raises
    ------
    UserError
        For inputs that can't be read, or a project among several inputs.
    """
    return opened_inputs(inputs_of(arguments), monitor, beside=arguments.output.parent)


def inputs_of(arguments: argparse.Namespace) -> OperationInputs:
    """What a command's arguments name.

    Raises
    ------
    MissingInput
        A project is among several inputs.
    """
    return inputs_of_paths(
        arguments.inputs,
        trajectories=arguments.trajectory,
        images=arguments.images,
        crs=arguments.crs,
        columns=columns_of(arguments),
    )


def request_of(arguments: argparse.Namespace) -> ImportRequest:
    """The import that a command's arguments ask for; of a folder what was delivered in it.

    Raises
    ------
    MissingInput
        A folder holds no points.
    """
    folders = tuple(one for one in arguments.inputs if is_folder_of_files(one))
    found = request_of_files(folders, arguments.crs) if folders else ImportRequest(())
    return ImportRequest(
        inputs=(*(one for one in arguments.inputs if one not in folders), *found.inputs),
        trajectories=(*arguments.trajectory, *found.trajectories),
        images=(*arguments.images, *found.images),
        crs=arguments.crs,
        columns=columns_of(arguments),
    )


def columns_of(arguments: argparse.Namespace) -> tuple[str, ...]:
    """What ``--columns`` says of the columns of text files; nothing without it."""
    return tuple(name.strip() for name in arguments.columns.split(",")) if arguments.columns else ()


def check_inputs(arguments: argparse.Namespace) -> None:
    """Refuse a command that names no input, or sides of a comparison.

    Raises
    ------
    MissingInput
    """
    given = vars(arguments)
    if not arguments.inputs or any(given.get(name) for name in ("before", "after", "also")):
        raise no_single_input(arguments.tool)
