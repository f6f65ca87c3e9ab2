"""``zuka bench``: the project's own benchmarks, each as a figure against its target."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import partial

from app.cli.output import print_json, print_lines
from app.settings.language import system_language
from processing.core.errors import OutOfRange, use_one_of
from processing.core.text import Text
from processing.laboratory.bench.case import BenchmarkCase, BenchmarkOptions, Measurement
from processing.laboratory.bench.cases.extraction_case import measure_extraction
from processing.laboratory.bench.cases.extraction_growth import measure_extraction_growth
from processing.laboratory.bench.cases.ground_cases import measure_ground
from processing.laboratory.bench.cases.image_cases import measure_image, measure_switch
from processing.laboratory.bench.cases.import_cases import measure_import, measure_import_memory
from processing.laboratory.bench.cases.label_case import measure_labels
from processing.laboratory.bench.cases.large_case import measure_large
from processing.laboratory.bench.cases.noise_cases import measure_noise
from processing.laboratory.bench.cases.peer_cases import measure_normals, measure_searchable
from processing.laboratory.bench.cases.review_case import measure_review
from processing.laboratory.bench.cases.road_case import measure_road
from processing.laboratory.bench.cases.simulate_case import measure_simulate
from processing.laboratory.bench.cases.start_case import measure_start
from processing.laboratory.bench.cases.volume_cases import (
    measure_volume,
    measure_volume_tin,
    measure_volume_view,
)
from processing.laboratory.bench.growth import measure_growth
from processing.laboratory.bench.table import (
    Circumstances,
    describe_row,
    load_now,
    number,
    write_table,
)

CASES: Mapping[str, BenchmarkCase] = {
    "import": measure_import,
    "searchable": measure_searchable,
    "image": measure_image,
    "switch": measure_switch,
    "start": partial(measure_start, window="app.large_steps.start_bench"),
    "review": partial(measure_review, window="app.large_steps.review_bench"),
    "labels": measure_labels,
    "normals": measure_normals,
    "noise": measure_noise,
    "ground": measure_ground,
    "simulate": measure_simulate,
    "road": measure_road,
    "extraction": measure_extraction,
    "volume": measure_volume,
    "volume-tin": measure_volume_tin,
    "volume-view": measure_volume_view,
    "memory": measure_import_memory,
    "growth": measure_growth,
    "extraction-growth": measure_extraction_growth,
    "large": partial(measure_large, window="app.large_steps.large_bench"),
}
"""Benchmarks by name, quick ones first.

Those of the window are told by its name which module shows one, in a process of its own: Qt is
loaded neither here nor in `processing`.
"""

_LEAST_POINTS = 10_000


def command(arguments: argparse.Namespace) -> int:
    """Run the named benchmarks, or all of them."""
    for name in arguments.names:
        if name not in CASES:
            raise OutOfRange(
                Text("There is no such benchmark.", "そのようなベンチマークはありません。"),
                Text.same(name),
                use_one_of(CASES),
            )
    for points in (arguments.points, arguments.most_points):
        if points is not None and points < _LEAST_POINTS:
            raise OutOfRange(
                Text("That is too few points to measure.", "計測には点数が少なすぎます。"),
                Text.same(f"{points}"),
                Text("Ask for {least} or more.", "{least}以上を指定してください。").filled(
                    least=_LEAST_POINTS
                ),
            )
    request = BenchmarkOptions(arguments.points, arguments.most_points, arguments.project)
    load = load_now()
    found: list[Measurement] = []
    for name in arguments.names or CASES:
        rows = CASES[name](request)
        found += rows
        if not arguments.json:
            print_lines(*map(_line, rows))
    if arguments.json:
        print_json([describe_row(measurement) for measurement in found])
    if arguments.markdown is not None:
        write_table(arguments.markdown, Circumstances.of(_write_command(arguments), load), found)
    return 0


def _write_command(arguments: argparse.Namespace) -> str:
    """The command, without where its results go and without folders of this machine."""
    words = ["zuka bench", *arguments.names]
    if arguments.points is not None:
        words.append(f"--points {arguments.points}")
    if arguments.most_points is not None:
        words.append(f"--most-points {arguments.most_points}")
    if arguments.project is not None:
        words.append(f"--project {arguments.project.name}")
    return " ".join(words)


def _line(measurement: Measurement) -> str:
    what = measurement.what.in_language(system_language())
    reported = [f"{measurement.name}: {what}:"]
    if measurement.value is not None:
        reported.append(f"{number(measurement.value)} {measurement.unit}")
    if measurement.target is not None:
        sign = "<=" if measurement.is_at_most else ">="
        reported.append(f"({sign} {measurement.target:g})")
    if measurement.is_met is not None:
        reported.append("ok;" if measurement.is_met else "NOT REACHED;")
    return " ".join([*reported, measurement.detail])
