"""A parameter study: a tool that gives classes, run over a grid of one or two parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable, use_one_of
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.parameters import Parameter, ParameterValue, fill_parameters, parameters_of
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix, is_one_of
from processing.tools.listed.registry import asked_classes
from processing.tools.running.run_shares import run_shares
from processing.tools.running.runner import run_together, tool_of
from processing.tools.tool import FinishedColumns

MOST_PARAMETERS = 2
MOST_CELLS = 400
MOST_STEPS = 100

_CLASS = "classification"
_AT_ONCE = 1 << 20

TruthOf = Callable[[Drive, int, int], NDArray[np.uint8]]
"""True codes of the points ``start … stop − 1`` of a drive, 0 where nobody knows: (k,) uint8."""


@dataclass(frozen=True)
class VariedParameter:
    """One parameter and the values that it takes.

    Attributes
    ----------
    parameter : str
        Its id.
    values : tuple
        At least one; each once.
    """

    parameter: str
    values: tuple[ParameterValue, ...]


@dataclass(frozen=True)
class StudyCell:
    """What one setting gave.

    Attributes
    ----------
    values : tuple
        Of the varied parameters, in their order.
    counts : BinaryConfusionMatrix
        Positive are the points that the tool looks for.
    """

    values: tuple[ParameterValue, ...]
    counts: BinaryConfusionMatrix


@dataclass(frozen=True)
class StudyRequest:
    """What to study.

    Attributes
    ----------
    tool : str
        A key of :func:`processing.tools.listed.registry.asked_classes`.
    drives : tuple of Drive
        Counted together.
    fixed : mapping
        Values of the tool's other parameters; those not named have their defaults.
    varied : tuple of VariedParameter
        One or two.
    beside : tuple of Drive
        Others of the same street, which some tools look at too; not counted.
    """

    tool: str
    drives: tuple[Drive, ...]
    fixed: Mapping[str, ParameterValue]
    varied: tuple[VariedParameter, ...]
    beside: tuple[Drive, ...] = ()


@dataclass(frozen=True)
class ParameterStudy:
    """A finished study.

    Attributes
    ----------
    cells : tuple of StudyCell
        Row by row: the last parameter changes from one to the next.
    """

    tool: str
    version: int
    fixed: Mapping[str, ParameterValue]
    varied: tuple[VariedParameter, ...]
    cells: tuple[StudyCell, ...]

    @property
    def best(self) -> StudyCell | None:
        """The first of those with the greatest F of what the tool looks for; None without any."""
        scored = [cell for cell in self.cells if not math.isnan(cell.counts.f_measure)]
        return max(scored, key=lambda cell: cell.counts.f_measure, default=None)


def study(request: StudyRequest, truth: TruthOf, monitor: Monitor, into: Path) -> ParameterStudy:
    """Run the tool with every setting and count what it did, where the truth is known.

    Parameters
    ----------
    into : Path
        A new folder for what runs write meanwhile; each run's columns are removed when counted.

    Raises
    ------
    OutOfRange
        The tool gives no classes that can be judged, or a value isn't allowed; before any run.
    Unsuitable
        A drive lacks what the tool needs, or the truth of no point is known.
    NoSpace, Cancelled
        Nothing is kept.
    """
    tool = tool_of(request.tool)
    settings = settings_of(request)
    for setting in settings:
        fill_parameters(tool.parameters, setting)
    _require_known(request, truth, monitor)
    cells = []
    for number, setting in enumerate(settings):
        part = PartMonitor(monitor, number / len(settings), (number + 1) / len(settings))
        counts = _try_setting(request, setting, truth, part, into / str(number))
        cells.append(StudyCell(tuple(setting[one.parameter] for one in request.varied), counts))
    names = {one.parameter for one in request.varied}
    fixed = {name: value for name, value in request.fixed.items() if name not in names}
    return ParameterStudy(tool.id, tool.version, fixed, request.varied, tuple(cells))


def _try_setting(
    request: StudyRequest,
    setting: Mapping[str, ParameterValue],
    truth: TruthOf,
    monitor: Monitor,
    into: Path,
) -> BinaryConfusionMatrix:
    """What one setting does to all drives of a study."""
    tool, codes = tool_of(request.tool), asked_classes()[request.tool].codes
    parameters = fill_parameters(tool.parameters, setting)
    counts, beside = BinaryConfusionMatrix(0, 0, 0, 0), request.beside
    for share in run_shares(tool.id, request.drives, parameters, monitor, beside=beside):
        try:
            found = run_together(share.request, share.monitor, into=into)
            for drive, columns in zip(share.drives, found.columns, strict=True):
                if drive in request.drives:
                    counts += _count_result(columns, drive, truth, codes, monitor)
        finally:
            remove_folder(into)
    return counts


def settings_of(request: StudyRequest) -> tuple[dict[str, ParameterValue], ...]:
    """Every setting of a study: the fixed values and one combination of the varied.

    Raises
    ------
    OutOfRange
        There is nothing to vary, or too much.
    """
    if request.tool not in asked_classes():
        raise _gives_no_classes(request.tool)
    names = [one.parameter for one in request.varied]
    cells = math.prod(len(one.values) for one in request.varied)
    if not 1 <= len(set(names)) == len(names) <= MOST_PARAMETERS or not 1 <= cells <= MOST_CELLS:
        raise OutOfRange(
            Text(
                "A study varies one or two parameters, with at most {most} settings together.",
                "検討できるのは1つか2つのパラメータで、組み合わせは{most}通りまでです。",
            ).filled(most=MOST_CELLS),
            Text.same(", ".join(f"{one.parameter} × {len(one.values)}" for one in request.varied)),
            Text("Choose fewer values.", "値の数を減らしてください。"),
        )
    return tuple(
        {**request.fixed, **dict(zip(names, values, strict=True))}
        for values in product(*(one.values for one in request.varied))
    )


def steps_of(parameter: Parameter, low: float, high: float, steps: int) -> VariedParameter:
    """Evenly spaced values of a number or a count, both ends among them; all words of a choice."""
    if parameter.kind == "choice":
        return VariedParameter(parameter.id, tuple(one.value for one in parameter.choices))
    if parameter.kind == "switch":
        return VariedParameter(parameter.id, (False, True))
    values = [float(f"{one:.6g}") for one in np.linspace(low, high, max(1, steps)).tolist()]
    if parameter.kind == "count":
        values = [round(one) for one in values]
    return VariedParameter(parameter.id, tuple(dict.fromkeys(values)))


def usual_range(parameter: Parameter) -> tuple[float, float]:
    """Where to look at first: from half of the default to twice of it, within the limits."""
    default = float(parameter.default) if parameter.kind in ("number", "count") else 0.0
    if default <= 0:
        return parameter.low, parameter.high
    return max(parameter.low, default / 2), min(parameter.high, default * 2)


def can_vary(tool: str) -> tuple[Parameter, ...]:
    """The parameters of a tool that a study can go through."""
    return tuple(one for one in parameters_of(tool_of(tool).parameters) if not one.is_typed)


def varied_of(tool: str, words: Sequence[str]) -> tuple[VariedParameter, ...]:
    """What the command line says to vary: ``name=from:to:steps``, or ``name`` for a choice.

    Raises
    ------
    OutOfRange
        It isn't of this form, or there is no such parameter.
    """
    known = {one.id: one for one in can_vary(tool)}
    return tuple(_varied_of(known, one) for one in words)


def _varied_of(known: Mapping[str, Parameter], words: str) -> VariedParameter:
    name, _, span = words.partition("=")
    parts = span.split(":")
    parameter = known.get(name)
    if parameter is not None and not span and parameter.kind in ("choice", "switch"):
        return steps_of(parameter, 0, 0, 0)
    if parameter is not None and parameter.kind in ("number", "count") and len(parts) == 3:
        try:
            low, high, steps = float(parts[0]), float(parts[1]), int(parts[2])
        except ValueError:
            steps = 0
        if 1 <= steps <= MOST_STEPS and math.isfinite(low) and math.isfinite(high):
            return steps_of(parameter, low, high, steps)
    raise OutOfRange(
        Text("What is to be varied can't be read.", "変化させるパラメータを解釈できません。"),
        Text.same(f"--vary {words}"),
        Text(
            "Write --vary NAME=FROM:TO:STEPS with 1 to {most} steps, or the name of a choice; "
            "names are: {names}.",
            "--vary 名前=開始:終了:個数（1～{most}個）、または選択肢の名前を指定してください。"
            "使える名前: {names}",
        ).filled(most=MOST_STEPS, names=", ".join(known) or "-"),
    )


def _count_result(
    result: FinishedColumns,
    drive: Drive,
    truth: TruthOf,
    codes: frozenset[int],
    monitor: Monitor,
) -> BinaryConfusionMatrix:
    counts = BinaryConfusionMatrix(0, 0, 0, 0)
    for start in range(0, drive.count, _AT_ONCE):
        monitor.check()
        stop = min(start + _AT_ONCE, drive.count)
        known = truth(drive, start, stop)
        is_known = known > 0
        found = result.read(_CLASS, start, stop)[is_known]
        counts += BinaryConfusionMatrix.of(
            is_one_of(known[is_known], codes), is_one_of(found, codes)
        )
    return counts


def _require_known(request: StudyRequest, truth: TruthOf, monitor: Monitor) -> None:
    for drive in request.drives:
        for start in range(0, drive.count, _AT_ONCE):
            monitor.check()
            if truth(drive, start, min(start + _AT_ONCE, drive.count)).any():
                return
    raise Unsuitable(
        Text("The truth of no point is known there.", "真値の分かる点がありません。"),
        Text.same(", ".join(drive.info.name for drive in request.drives)),
        Text("Choose another truth or drive.", "別の真値か走行データを選んでください。"),
    )


def _gives_no_classes(tool: str) -> OutOfRange:
    return OutOfRange(
        Text(
            "There is no truth to judge this tool by.", "このツールは真値による評価の対象外です。"
        ),
        Text.same(tool),
        use_one_of(asked_classes()),
    )
