"""Evaluations of classes and parameter studies as tables for spreadsheets.

Two studies call opposite classes positive, so the columns name theirs: ``found`` is what the tool
looks for (noise points; ground), ``other`` all else, by
:mod:`processing.scoring.points.asked_classes`.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from processing.core.parameters import ParameterValue
from processing.core.safe_write import write_safely
from processing.project.evaluation.class_evaluation import ClassEvaluation
from processing.project.evaluation.parameter_study import ParameterStudy
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.listed.registry import asked_classes

_DIGITS = 6


def write_class_evaluations(
    path: Path,
    evaluations: Sequence[ClassEvaluation],
    truth: str,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write evaluations as CSV, UTF-8 with its mark: a row for each run.

    Parameters
    ----------
    truth : str
        Name of the truth that all were judged by.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    rows = []
    for one in evaluations:
        run = one.run
        facts = {"tool": one.tool, "truth": truth, "run": "" if run is None else run.id}
        facts["started"] = "" if run is None else run.started.isoformat()
        parameters = {} if run is None else run.parameters
        rows.append({**facts, **_scores(one.tool, one.counts), **_name_parameters(parameters)})
    _write(path, rows, never)


def write_study(path: Path, study: ParameterStudy, *, never: Iterable[Path] = ()) -> None:
    """Write a study as CSV, UTF-8 with its mark: a row for each setting.

    Parameters
    ----------
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    names = [one.parameter for one in study.varied]
    rows = [
        {
            "tool": study.tool,
            **_name_parameters(dict(zip(names, cell.values, strict=True))),
            **_scores(study.tool, cell.counts),
            **_name_parameters(study.fixed),
        }
        for cell in study.cells
    ]
    _write(path, rows, never)


def _scores(tool: str, counts: BinaryConfusionMatrix) -> dict[str, str]:
    asked, turned = asked_classes()[tool], counts.turned()
    found, other = _id(asked.found.en), _id(asked.other.en)
    return {
        "points": str(counts.count),
        f"{found}_right": str(counts.hits),
        f"{found}_missed": str(counts.misses),
        f"{other}_called_{found}": str(counts.false_alarms),
        f"{other}_right": str(counts.rejections),
        f"{found}_precision": _number(counts.precision),
        f"{found}_recall": _number(counts.recall),
        f"{found}_f": _number(counts.f_measure),
        f"{other}_precision": _number(turned.precision),
        f"{other}_recall": _number(turned.recall),
        f"{other}_f": _number(turned.f_measure),
        "kappa": _number(counts.kappa),
        "total_error": _number(counts.total_error),
    }


def _name_parameters(parameters: Mapping[str, ParameterValue | None]) -> dict[str, str]:
    return {name: "" if value is None else str(value) for name, value in parameters.items()}


def _id(name: str) -> str:
    return name.replace(" ", "_")


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}f}" if math.isfinite(value) else ""


def _write(path: Path, rows: Sequence[Mapping[str, str]], never: Iterable[Path]) -> None:
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding="utf-8-sig", newline="") as file,
    ):
        table = csv.DictWriter(file, columns or ["tool"], restval="")
        table.writeheader()
        table.writerows(rows)
