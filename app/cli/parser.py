"""The command line's words; one file beside this per command, imported when it is wanted."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import NoReturn, cast

from app.cli.window_request import WindowRequest
from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.formats.registry import FORMATS

Command = Callable[[argparse.Namespace], int | WindowRequest]


class _Parser(argparse.ArgumentParser):
    """Says what is wrong with the arguments in one sentence, like everything else."""

    def error(self, message: str) -> NoReturn:
        raise OutOfRange(
            Text(
                f"The command can't be read: {message}.", f"コマンドを解釈できません（{message}）。"
            ),
            Text.same(self.prog),
            Text(f"See “{self.prog} --help”.", f"「{self.prog} --help」を参照してください。"),
        )


class _OrderParser(_Parser):
    """Tells in its help what else can be set; the fields are looked up only then."""

    what = ""

    def format_help(self) -> str:
        """What argparse tells, and the settings of what is made."""
        if not self.what:
            return super().format_help()
        from app.cli.parameter_lines import parameter_lines
        from app.settings.language import system_language
        from processing.laboratory.simulate.simulations import SIMULATIONS

        lines = parameter_lines(SIMULATIONS[self.what].request, system_language())
        return "\n".join([super().format_help(), "settings:", *lines, ""])


def read_arguments(arguments: Sequence[str]) -> tuple[Command, argparse.Namespace]:
    """The command that is wanted, and its arguments.

    Raises
    ------
    OutOfRange
        The arguments are not of the contract.
    """
    parser = _Parser(prog="zuka", description="Road maps and ledgers from laser recordings.")
    parser.add_argument("--version", action="version", version=f"zuka {version('zuka')}")
    parser.set_defaults(module="open_window", paths=[])
    commands = parser.add_subparsers(metavar="COMMAND", parser_class=_Parser)
    for add in (
        _add_window_commands,
        _add_reading_commands,
        _add_working_commands,
        _add_map,
        _add_run,
        _add_extract,
        _add_batch,
        _add_manual,
        _add_simulate,
    ):
        add(commands)
    namespace = parser.parse_args(arguments)
    module = import_module(f"app.cli.{namespace.module}")
    return cast("Command", module.command), namespace


# argparse keeps the type of its sub-parsers' action private.
_Commands = argparse._SubParsersAction  # noqa: SLF001 - it has no public name


def _add_window_commands(commands: _Commands[_Parser]) -> None:
    opening = commands.add_parser("open", help="the window, with a project or files open")
    opening.add_argument("paths", nargs="+", type=Path, metavar="PROJECT|FILE")
    opening.set_defaults(module="open_window")
    showing = commands.add_parser("demo", help="the main job on the sample street")
    showing.add_argument("--headless", action="store_true", help="do it without a person")
    showing.add_argument("--out", type=Path, default=Path("demo-output"), metavar="DIR")
    showing.set_defaults(module="demo")


def _add_reading_commands(commands: _Commands[_Parser]) -> None:
    telling = commands.add_parser("info", help="what a cloud or a project holds")
    telling.add_argument("input", type=Path, metavar="INPUT")
    telling.add_argument("--json", action="store_true")
    _add_columns(telling)
    telling.set_defaults(module="info")
    listing = commands.add_parser("tools", help="every processing tool and its parameters")
    listing.add_argument("name", nargs="?", metavar="NAME")
    listing.add_argument("--json", action="store_true")
    listing.set_defaults(module="tools")
    scoring = commands.add_parser("score", help="a tool's result against a truth")
    scoring.add_argument("tool", metavar="TOOL")
    scoring.add_argument("result", type=Path, metavar="RESULT")
    scoring.add_argument("truth", type=Path, metavar="TRUTH")
    scoring.add_argument("--json", action="store_true")
    scoring.add_argument("--picture", type=Path, metavar="FILE.svg")
    scoring.set_defaults(module="score")
    measuring = commands.add_parser("bench", help="the project's own benchmarks")
    measuring.add_argument("names", nargs="*", metavar="NAME")
    measuring.add_argument("--json", action="store_true")
    measuring.add_argument("--markdown", type=Path, metavar="FILE", help="a table as well")
    measuring.add_argument("--points", type=int, metavar="N", help="of the large project")
    measuring.add_argument("--most-points", type=int, metavar="N", help="of any benchmark")
    measuring.add_argument("--project", type=Path, metavar="PROJECT", help="the large project")
    measuring.set_defaults(module="bench")


def _add_route_commands(commands: _Commands[_Parser]) -> None:
    numbering = commands.add_parser("number", help="number what ledgers list along the routes")
    numbering.add_argument("project", type=Path, metavar="PROJECT")
    numbering.set_defaults(module="maps.number")
    widths = commands.add_parser("widths", help="draw how wide roads are across them")
    widths.add_argument("project", type=Path, metavar="PROJECT")
    widths.add_argument("--pitch", type=float, metavar="M", help="from station to station (20)")
    widths.set_defaults(module="maps.widths")
    road = commands.add_parser("road", help="widths, falls, slopes and clearance of the roads")
    road.add_argument("project", type=Path, metavar="PROJECT")
    road.add_argument("--out", type=Path, metavar="DIR", help="where tables and plot are written")
    road.add_argument("--pitch", type=float, metavar="M", help="from station to station (20)")
    road.add_argument("--draw", action="store_true", help="draw centre lines between the edges")
    road.set_defaults(module="maps.road")


def _add_import(commands: _Commands[_Parser]) -> None:
    importing = commands.add_parser("import", help="make delivered files a project's drives")
    importing.add_argument("project", type=Path, metavar="PROJECT")
    _add_inputs(importing, least="*")
    importing.add_argument(
        "--labels",
        choices=["label", "classification"],
        default="label",
        help="where labels of points come from: an extra dimension, or the delivered classes",
    )
    importing.add_argument(
        "--replace",
        action="append",
        default=[],
        metavar="DRIVE",
        help="a drive, by name, whose place the new files take; the map stays",
    )
    importing.set_defaults(module="import_drives")


def _add_working_commands(commands: _Commands[_Parser]) -> None:
    _add_import(commands)
    checking = commands.add_parser("check", help="what is damaged in a project")
    checking.add_argument("project", type=Path, metavar="PROJECT")
    checking.add_argument(
        "--repair", action="store_true", help="make again what the delivered files give"
    )
    checking.add_argument("--json", action="store_true")
    checking.set_defaults(module="projects.check")
    _add_route_commands(commands)
    learning = commands.add_parser("learn", help="a model of classes from what was painted")
    learning.add_argument("project", type=Path, metavar="PROJECT")
    learning.add_argument("--json", action="store_true")
    learning.set_defaults(module="learn")
    studying = commands.add_parser("study", help="a tool with many settings, judged by a truth")
    studying.add_argument("tool", metavar="TOOL")
    _add_inputs(studying)
    studying.add_argument("--truth", action="append", required=True, type=Path, metavar="T")
    studying.add_argument(
        "--vary",
        action="extend",
        nargs="+",
        required=True,
        metavar="NAME=FROM:TO:STEPS",
        help="once or twice",
    )
    studying.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    studying.add_argument("--output", type=Path, required=True, metavar="OUT.csv")
    studying.set_defaults(module="study")
    picturing = commands.add_parser("image", help="a point-cloud image as PNG")
    _add_inputs(picturing)
    picturing.add_argument("--kind", required=True, metavar="KIND")
    picturing.add_argument("--attribute", required=True, metavar="NAME")
    picturing.add_argument("--output", type=Path, required=True, metavar="OUT.png")
    picturing.set_defaults(module="image")
    exporting = commands.add_parser("export", help="write a project's map to files")
    exporting.add_argument("project", type=Path, metavar="PROJECT")
    exporting.add_argument("--format", action="extend", nargs="+", required=True, metavar="F")
    exporting.add_argument("--out", type=Path, required=True, metavar="DIR")
    for option in FORMATS.map_options():
        exporting.add_argument(
            f"--{option.id.replace('_', '-')}",
            choices=[one.value for one in option.choices] or None,
            metavar=None if option.choices else option.id.upper(),
            help=option.name.en,
        )
    exporting.add_argument("--candidates", action="store_true", help="unchecked ones as well")
    exporting.set_defaults(module="export")


def _add_map(commands: _Commands[_Parser]) -> None:
    taking = commands.add_parser("map", help="take an existing map into a project")
    taking.add_argument("project", type=Path, metavar="PROJECT")
    taking.add_argument("file", type=Path, metavar="FILE")
    taking.add_argument(
        "--crs", default="", metavar="EPSG:n", help="where the file does not say it"
    )
    taking.add_argument("--kind", default="", metavar="KIND", help="of what says no known kind")
    taking.add_argument(
        "--compare", action="store_true", help="store what is new, moved and gone for review"
    )
    taking.add_argument(
        "--tolerance", type=float, metavar="M", help="what lies nearer has not moved"
    )
    taking.add_argument(
        "--search", type=float, metavar="M", help="what lies farther is another thing"
    )
    taking.set_defaults(module="maps.take")


def _add_run(commands: _Commands[_Parser]) -> None:
    running = commands.add_parser("run", help="run a processing tool on files or a project")
    running.add_argument("tool", metavar="TOOL")
    _add_inputs(running, least="*")
    running.add_argument("--before", type=Path, metavar="A", help="of a volume: points, design")
    running.add_argument(
        "--after", type=Path, metavar="B", help="(.xml, .xml#SURFACE), or a level in m"
    )
    running.add_argument(
        "--also",
        type=Path,
        action="append",
        default=[],
        metavar="C",
        help="of a volume: points of another date, for ground that A or B did not show",
    )
    running.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    running.add_argument(
        "--output", type=Path, metavar="OUT", help="without it the project stores the result"
    )
    running.add_argument(
        "--accept-above",
        type=float,
        metavar="CONFIDENCE",
        help="of what the project stores: candidates that need no review",
    )
    running.add_argument(
        "--language", choices=["en", "ja"], help="of a CSV table's headers; without it ids"
    )
    running.set_defaults(module="run")


def _add_extract(commands: _Commands[_Parser]) -> None:
    extracting = commands.add_parser("extract", help="find all: every extractor, one after another")
    _add_inputs(extracting)
    extracting.add_argument(
        "--tools", default="", metavar="TOOL,TOOL...", help="without it all that find things"
    )
    extracting.add_argument("--set", action="append", default=[], metavar="TOOL.NAME=VALUE")
    extracting.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="a GeoJSON file of each tool; without it the project stores the results",
    )
    extracting.add_argument("--accept-above", type=float, metavar="CONFIDENCE")
    extracting.set_defaults(module="extract")


def _add_batch(commands: _Commands[_Parser]) -> None:
    working = commands.add_parser("batch", help="the same operations over many drives")
    working.add_argument("job", type=Path, metavar="JOB.toml")
    working.add_argument(
        "--scheduler", default="", metavar="ADDRESS", help="of a Dask cluster, tcp://HOST:8786"
    )
    working.add_argument(
        "--watch", action="store_true", help="wait for deliveries; until it is ended"
    )
    working.set_defaults(module="automation.batch")
    recording = commands.add_parser("macro", help="write what a project was put through as steps")
    recording.add_argument("project", type=Path, metavar="PROJECT")
    recording.add_argument("--output", type=Path, required=True, metavar="MACRO.toml")
    recording.set_defaults(module="automation.macro")
    replaying = commands.add_parser("replay", help="do the steps of a macro to another project")
    replaying.add_argument("macro", type=Path, metavar="MACRO.toml")
    replaying.add_argument("project", type=Path, metavar="PROJECT")
    replaying.set_defaults(module="automation.replay")


def _add_manual(commands: _Commands[_Parser]) -> None:
    writing = commands.add_parser("manual", help="the manual as a site, a page for each tool")
    writing.add_argument("--out", type=Path, required=True, metavar="DIR")
    writing.set_defaults(module="automation.manual")


def _add_simulate(commands: _Commands[_Parser]) -> None:
    simulating = commands.add_parser(
        "simulate",
        help="a street, a site or a flight with its truth",
        epilog="street, site and flight take --seed N --length M --style S --sensor S "
        "--set NAME=VALUE --out DIR; each tells more by its own --help",
    )
    whats = simulating.add_subparsers(
        metavar="street|site|flight|density", required=True, parser_class=_OrderParser
    )
    for what, reported in (
        ("street", "a street, recorded by a vehicle"),
        ("site", "an earthwork site of two dates, scanned from tripods"),
        ("flight", "a full-waveform flight over a landscape"),
    ):
        making = whats.add_parser(what, help=reported)
        making.what = what
        making.add_argument("--seed", metavar="N", help="the same number gives the same")
        making.add_argument("--length", metavar="M")
        making.add_argument("--style", metavar="S")
        making.add_argument("--sensor", metavar="S")
        making.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
        making.add_argument("--out", type=Path, required=True, metavar="DIR")
        making.set_defaults(module="simulate", what=what)
    foretelling = whats.add_parser("density", help="points/m² beside a vehicle, before it drives")
    foretelling.add_argument("--sensor", required=True, metavar="S")
    foretelling.add_argument("--speed", required=True, type=float, metavar="KMH")
    foretelling.add_argument("--out", type=Path, required=True, metavar="OUT.png|OUT.csv")
    foretelling.set_defaults(module="simulate", what="density")


def _add_inputs(parser: argparse.ArgumentParser, least: str = "+") -> None:
    parser.add_argument("inputs", nargs=least, type=Path, metavar="INPUT")
    parser.add_argument("--trajectory", action="append", default=[], type=Path, metavar="T")
    parser.add_argument("--images", action="append", default=[], type=Path, metavar="I")
    parser.add_argument("--crs", default="", metavar="EPSG:n")
    _add_columns(parser)


def _add_columns(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--columns",
        default="",
        metavar="NAME,NAME...",
        help="of text files: x,y,z and intensity, red, green, blue, time, class; - passes one over",
    )
