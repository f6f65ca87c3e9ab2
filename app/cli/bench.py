"""``zuka bench``: the project's own benchmarks, each as a figure against its target."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import asdict

from app.cli.output import print_json, print_lines
from app.language import system_language
from processing.bench.case import Measurement
from processing.bench.image_cases import measure_image, measure_switch
from processing.bench.import_cases import measure_import, measure_import_memory
from processing.bench.label_case import measure_labels
from processing.bench.review_case import measure_review
from processing.bench.start_case import measure_start
from processing.errors import OutOfRange
from processing.text import Text

CASES: Mapping[str, Callable[[], Measurement]] = {
    "import": measure_import,
    "image": measure_image,
    "switch": measure_switch,
    "start": measure_start,
    "review": measure_review,
    "labels": measure_labels,
    "memory": measure_import_memory,
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
    found = []
    for name in arguments.names or CASES:
        measurement = CASES[name]()
        found.append(measurement)
        if not arguments.json:
            print_lines(_line(measurement))
    if arguments.json:
        print_json([_described(measurement) for measurement in found])
    return 0


def _line(measurement: Measurement) -> str:
    sign = "<=" if measurement.is_at_most else ">="
    verdict = "ok" if measurement.is_met else "NOT REACHED"
    what = measurement.what.spoken(system_language())
    value = f"{measurement.value:.3g} {measurement.unit}"
    target = f"{sign} {measurement.target:g}"
    return f"{measurement.name}: {what}: {value} ({target}) {verdict}; {measurement.detail}"


def _described(measurement: Measurement) -> dict[str, object]:
    return {**asdict(measurement), "is_met": measurement.is_met}
