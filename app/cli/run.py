"""``zuka run``: a processing tool on a project or on delivered files."""

from __future__ import annotations

import argparse

from app.cli.opened import check_inputs, inputs_of, terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.settings.language import system_language
from processing.operations.new_points import NewPointsOperation, make_points
from processing.operations.registration.register import RegisterOperation, register
from processing.operations.run import RunOperation, run_operation
from processing.tools.listed.registry import COMPARISONS, POINT_MAKERS, REGISTRATIONS


def command(arguments: argparse.Namespace) -> int:
    """Run a tool on every drive of the input; write its result, or store it in the project."""
    if arguments.tool in COMPARISONS:
        # What papers need is imported for them alone.
        from app.cli import volume

        return volume.command(arguments)
    if arguments.tool in POINT_MAKERS:
        print_lines(str(make_points(points_operation_of(arguments), terminal_monitor())))
        return 0
    if arguments.tool in REGISTRATIONS:
        return _register(arguments)
    outcome = run_operation(operation_of(arguments), terminal_monitor())
    print_lines(*(words.in_language(system_language()) for words in outcome.words))
    return 0


def _register(arguments: argparse.Namespace) -> int:
    """Register the drives of the input and write corrected points with a report."""
    check_inputs(arguments)
    operation = RegisterOperation(
        inputs_of(arguments), arguments.output, settings_of_words(arguments.set)
    )
    done = register(operation, terminal_monitor())
    print_lines(*(words.in_language(system_language()) for words in done.words))
    return 0


def operation_of(arguments: argparse.Namespace) -> RunOperation:
    """The operation that a command's arguments ask for.

    Raises
    ------
    MissingInput, OutOfRange
        They name no input, or a setting without a value.
    """
    given = vars(arguments)
    check_inputs(arguments)
    return RunOperation(
        arguments.tool,
        inputs_of(arguments),
        settings_of_words(arguments.set),
        arguments.output,
        given.get("accept_above"),
        given.get("language"),
    )


def points_operation_of(arguments: argparse.Namespace) -> NewPointsOperation:
    """The operation of a tool that makes points, as a command's arguments ask for it.

    Raises
    ------
    MissingInput, OutOfRange
        They name no input, or a setting without a value.
    """
    check_inputs(arguments)
    return NewPointsOperation(
        arguments.tool, inputs_of(arguments), arguments.output, settings_of_words(arguments.set)
    )
