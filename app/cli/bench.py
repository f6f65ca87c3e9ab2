"""``zuka bench``: the project's own benchmarks, each as a figure against its target."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import asdict

from app.cli.output import print_json, print_lines
from app.language import system_language
from processing.bench.case import BenchWish, Case, Measurement
from processing.bench.image_cases import measure_image, measure_switch
from processing.bench.import_cases import measure_import, measure_import_memory
from processing.bench.label_case import measure_labels
from processing.bench.large_case import measure_large
from processing.bench.review_case import measure_review
from processing.bench.start_case import measure_start
from processing.errors import OutOfRange
from processing.text import Text

CASES: Mapping[str, Case] = {
    "import": measure_import,
    "image": measure_image,
    "switch": measure_switch,
    "start": measure_start,
    "review": measure_review,
    "labels": measure_labels,
    "memory": measure_import_memory,
    "large": measure_large,
}
"""Benchmarks by name, quick ones first."""


def command(arguments: argparse.Namespace) -> int:
    """Run the named benchmarks, or all of them."""
    for name in arguments.names:
        if name not in CASES:
            raise OutOfRange(
                Text("There is no such benchmark.", "そのようなベンチマークはありません。"),
                Text.same(name),
                Text("Use one of: {names}.", "次のいずれかを指定してください: {names}").filled(
                    names=", ".join(CASES)
                ),
            )
    wish = BenchWish(arguments.points, arguments.most_points, arguments.project)
    found: list[Measurement] = []
    for name in arguments.names or CASES:
        rows = CASES[name](wish)
        found += rows
        if not arguments.json:
            print_lines(*map(_line, rows))
    if arguments.json:
        print_json([_described(measurement) for measurement in found])
    return 0


def _line(measurement: Measurement) -> str:
    what = measurement.what.spoken(system_language())
    told = [f"{measurement.name}: {what}:"]
    if measurement.value is not None:
        told.append(f"{measurement.value:.3g} {measurement.unit}")
    if measurement.target is not None:
        sign = "<=" if measurement.is_at_most else ">="
        told.append(f"({sign} {measurement.target:g})")
    if measurement.is_met is not None:
        told.append("ok;" if measurement.is_met else "NOT REACHED;")
    return " ".join([*told, measurement.detail])


def _described(measurement: Measurement) -> dict[str, object]:
    return {**asdict(measurement), "is_met": measurement.is_met}
