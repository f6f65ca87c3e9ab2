"""``zuka run volume --before A --after B``: earth between two grounds, as JSON and on paper."""

from __future__ import annotations

import argparse

from app.cli.opened import columns_of, terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.settings.language import system_language
from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.operations.volume import VolumeOperation, compare_grounds
from processing.operations.volume_sides import VolumeSide


def command(arguments: argparse.Namespace) -> int:
    """Compare two sides and write what lies between them."""
    written = compare_grounds(operation_of(arguments), terminal_monitor())
    print_lines(*(str(path) for path in written.paths))
    return 0


def operation_of(arguments: argparse.Namespace) -> VolumeOperation:
    """The operation that a command's arguments ask for.

    Raises
    ------
    MissingInput, OutOfRange
        A side or the output is missing, or a setting has no value.
    """
    settings = settings_of_words(arguments.set)
    if arguments.before is None or arguments.after is None or arguments.inputs:
        raise MissingInput(
            Text("A volume lies between two grounds.", "土量の計算には2つの地盤が必要です。"),
            Text.same("zuka run volume"),
            Text(
                "Give --before A and --after B: points, a LandXML design or a level.",
                "--before A と --after B に、点群・設計面（LandXML）・標高を指定してください。",
            ),
        )
    if arguments.output is None:
        raise MissingInput(
            Text("A volume is written to a file.", "土量はファイルに書き出します。"),
            Text.same("zuka run volume"),
            Text("Name it with --output.", "--output でファイルを指定してください。"),
        )
    before, after = (VolumeSide.of_words(str(one)) for one in (arguments.before, arguments.after))
    return VolumeOperation(
        before,
        after,
        arguments.output,
        settings,
        arguments.crs,
        columns_of(arguments),
        system_language(),
        tuple(VolumeSide.of_words(str(one)) for one in arguments.also),
    )
