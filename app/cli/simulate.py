"""``zuka simulate``: a street or a site made to order with its truth, or a sensor's density."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.cli.set_option import settings_of_words
from app.settings.language import system_language
from processing.core.text import Language, Text
from processing.laboratory.simulate.scanning.density import density_map, survey_of
from processing.laboratory.simulate.scanning.density_files import write_density
from processing.laboratory.simulate.scanning.sensors import sensor_of
from processing.laboratory.simulate.simulate_operation import SimulateOperation, simulate
from processing.laboratory.simulate.simulated import Simulated

_MADE = Text("{folder}: {points:,} points, {crs}", "{folder}: {points:,}点, {crs}")
_TRUTH = Text("truth: {folder}", "正解データ: {folder}")
_OWN_OPTIONS = {"seed": "seed", "length": "length_m", "style": "style", "sensor": "sensor"}


def command(arguments: argparse.Namespace) -> int:
    """Make what is ordered."""
    if arguments.what == "density":
        return _write_density(arguments)
    values = settings_of_words(arguments.set)
    for option, field in _OWN_OPTIONS.items():
        if (given := getattr(arguments, option)) is not None:
            values[field] = given
    made = simulate(SimulateOperation(arguments.what, arguments.out, values), terminal_monitor())
    print_lines(*_lines(made, system_language()))
    return 0


def _write_density(arguments: argparse.Namespace) -> int:
    own = arguments.sensor if arguments.sensor.endswith(".toml") else ""
    sensor = sensor_of(arguments.sensor, "mobile", own)
    survey = survey_of(sensor, arguments.speed)
    title = sensor.name.en.replace("×", "x")
    title += f", {arguments.speed:g} km/h, {survey.between_revolutions_m:.3g} m from line to line"
    write_density(arguments.out, density_map(survey), title)
    print_lines(str(arguments.out))
    return 0


def _lines(made: Simulated, language: Language) -> list[str]:
    """What was made in one line, then its files, as ``zuka import`` takes them."""
    reported = _MADE.filled(folder=made.folder, points=made.count, crs=made.crs)
    files = (*made.points, *made.trajectories, *made.images)
    truth = _TRUTH.filled(folder=made.truth)
    return [
        reported.in_language(language),
        *(str(path) for path in files),
        truth.in_language(language),
    ]
