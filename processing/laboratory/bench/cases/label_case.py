"""Benchmark of labels: a million points labelled, taken back and labelled again."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.laboratory.bench.case import BenchmarkOptions, Measurement
from processing.laboratory.bench.large_street import write_large_street
from processing.laboratory.bench.timing import seconds_of
from processing.map.change import Change
from processing.map.label_change import label_changes
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.project import Project

_POINTS = 3_000_000
_LABELLED = 1_000_000
_REPEATS = 5
_CLASS = 2


def measure_labels(options: BenchmarkOptions) -> tuple[Measurement, ...]:
    """Undo of a lasso over a million points of three; every third one, the worst case on disk."""
    with tempfile.TemporaryDirectory(prefix="zuka-bench-") as name:
        folder = Path(name)
        cloud, trajectory = write_large_street(folder, options.limited(_POINTS))
        with closing(Project.create(folder / "street.zuka", "EPSG:6677")) as project:
            request = ImportRequest((cloud,), (trajectory,))
            made = import_drives(request, project.temporary_folder(), SilentMonitor())
            (drive,) = project.adopt_drives(made)
            count = drive.count
            points = np.arange(0, count, 3)[:_LABELLED]
            change = Change(
                labels=label_changes(drive.id, points, labels_of(drive, points), _CLASS)
            )
            applied_s = seconds_of(_applying(project, change))
            undone, redone = [], []
            for _ in range(_REPEATS):
                undone.append(seconds_of(project.features.undo))
                redone.append(seconds_of(project.features.redo))
    row = Measurement(
        "labels",
        Text(
            "Undo of a lasso over {labelled} of {points} points, every third one",
            "{points}点中{labelled}点（3点に1点）の投げ縄ラベルの取り消し",
        ).filled(labelled=f"{points.size:,}", points=f"{count:,}"),
        sorted(undone)[_REPEATS // 2],
        "s",
        1.0,
        is_at_most=True,
        detail=f"applied {applied_s:.3f} s, done again {sorted(redone)[_REPEATS // 2]:.3f} s",
    )
    return (row,)


def _applying(project: Project, change: Change) -> Callable[[], object]:
    label = Text("Label points", "点のラベル")
    return lambda: project.features.apply(label, change)
