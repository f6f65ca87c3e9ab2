"""What a tool found, as candidates of the map with the run they come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime

import numpy as np
from numpy.typing import NDArray

from processing.core.parameters import parameters_of
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import (
    AttributeValue,
    Feature,
    PointReference,
    Provenance,
    Status,
    Vertex,
    new_feature_id,
)
from processing.map.own_points import OwnPoints, own_points
from processing.project.photos import FIELD as PHOTO
from processing.project.photos import photo_name
from processing.project.store.runs import Run, new_run_id
from processing.tools.tool import Candidate, CandidateResult, Tool

_FOUND = Text("{tool}: {count} candidates", "{tool}: 候補{count}件")
_FOUND_ONE = Text("{tool}: 1 candidate", "{tool}: 候補1件")
_NOTHING = Text("{tool}: nothing found", "{tool}: 何も見つかりませんでした")
_NOTHING_NEW = Text("{tool}: nothing new", "{tool}: 新しい候補はありません")
_REPLACED = Text(
    "{count} earlier undecided ones were replaced", "以前の未判定候補{count}件を置き換え"
)
_REPLACED_ONE = Text("1 earlier undecided one was replaced", "以前の未判定候補1件を置き換え")
_COMPARED = Text(
    "{replaced}: {kept} found again, {new} new, {gone} gone",
    "{replaced}: 同じ位置{kept}件・新規{new}件・消失{gone}件",
)
_DECIDED = Text("{count} places had been decided", "判定済みの{count}か所を除外")
_DECIDED_ONE = Text("1 place had been decided", "判定済みの1か所を除外")
_BESIDE = Text("{summary}; {told}", "{summary}（{told}）")
_BOTH = Text("{replaced}, {decided}", "{replaced}、{decided}")
_NO_NOTE = Text("", "")
_NOTED = Text("{summary}. {note}", "{summary}。{note}")
_LEAST = {"point": 1, "line": 2, "area": 3}


@dataclass(frozen=True)
class FoundFeatures:
    """One run and its candidates, to be stored in one step.

    Attributes
    ----------
    run : Run
        Its ``summary`` is the step's line in the undo menu.
    change : Change
        Adds the candidates; empty when nothing was found.
    tool : Tool
        What ran.
    note : Text
        What the summary says beside the count; empty where nothing is to be said.
    pictures : mapping of str to (h, w, 3) uint8
        Of candidates, by the names that they have in the project.
    """

    run: Run
    change: Change
    tool: Tool
    note: Text = _NO_NOTE
    pictures: Mapping[str, NDArray[np.uint8]] = field(default_factory=dict)


@dataclass(frozen=True)
class Beside:
    """What became of a run beside what it put on the map.

    Attributes
    ----------
    replaced : int
        Undecided candidates of earlier runs that went.
    decided : int
        Candidates left out, since a person had decided about their places.
    kept : int
        Of those that went, how many were found again at the same place.
    new : int
        Candidates where the earlier runs had none.
    """

    replaced: int = 0
    decided: int = 0
    kept: int = 0
    new: int = 0


_ALONE = Beside()


def found_features(
    result: CandidateResult,
    tool: Tool,
    parameters: object,
    drives: Sequence[str],
    *,
    started: datetime,
    finished: datetime,
) -> FoundFeatures:
    """Candidates as features with status *candidate*, and the run that is their provenance.

    Parameters
    ----------
    parameters : object
        An instance of the tool's own parameter class.
    drives : sequence of str
        Ids of the drives that the tool got, in its order.
    started, finished : datetime
        With their time zone.

    Raises
    ------
    ValueError
        A candidate has a coordinate that is no number, or too few places: a defect of the tool.
    """
    given = parameter_values(tool, parameters)
    run = Run(
        id=new_run_id(),
        tool=tool.id,
        version=tool.version,
        parameters=given,
        drives=tuple(drives),
        started=started,
        finished=finished,
        summary=summary_of(tool, len(result.candidates), result.note),
    )
    features = []
    pictures = {}
    for number, one in enumerate(result.candidates, 1):
        name = "" if one.picture is None else photo_name(run.id, number)
        features.append(_feature(one, run, drives, name))
        if one.picture is not None:
            pictures[name] = one.picture
    return FoundFeatures(run, Change(added=tuple(features)), tool, result.note, pictures)


def parameter_values(tool: Tool, parameters: object) -> Mapping[str, AttributeValue]:
    """A tool's parameters by name, as they are stored."""
    declared = parameters_of(tool.parameters)
    return {parameter.id: getattr(parameters, parameter.id) for parameter in declared}


def summary_of(tool: Tool, count: int, note: Text = _NO_NOTE, beside: Beside = _ALONE) -> Text:
    """What came of a run: “Curbs: 214 candidates”, and why there are no more."""
    nothing = _NOTHING_NEW if beside.decided else _NOTHING
    text = _FOUND if count > 1 else (_FOUND_ONE if count else nothing)
    summary = text.filled(tool=tool.name, count=f"{count:,}")
    replaced = _write_count(beside.replaced, _REPLACED_ONE, _REPLACED)
    if replaced is not None:
        replaced = _COMPARED.filled(
            replaced=replaced,
            kept=f"{beside.kept:,}",
            new=f"{beside.new:,}",
            gone=f"{beside.replaced - beside.kept:,}",
        )
    decided = _write_count(beside.decided, _DECIDED_ONE, _DECIDED)
    reported = _BOTH.filled(replaced=replaced, decided=decided) if replaced and decided else None
    if reported := reported or replaced or decided:
        summary = _BESIDE.filled(summary=summary, told=reported)
    return _NOTED.filled(summary=summary, note=note) if note.en else summary


def _write_count(count: int, one: Text, many: Text) -> Text | None:
    """None where there is nothing to count."""
    return (one if count == 1 else many).filled(count=f"{count:,}") if count else None


def _feature(candidate: Candidate, run: Run, drives: Sequence[str], photo: str) -> Feature:
    xyz = np.asarray(candidate.xyz, np.float64)
    if len(xyz) < _LEAST[candidate.geometry] or not np.isfinite(xyz).all():
        message = f"{run.tool} gave a candidate without a place: {candidate.geometry} {xyz}"
        raise ValueError(message)
    numbers = np.zeros(len(xyz), np.int64) if candidate.drives is None else candidate.drives
    vertices = tuple(
        Vertex((x, y, z), PointReference(drives[number], point) if point >= 0 else None)
        for (x, y, z), point, number in zip(
            xyz.tolist(), candidate.points.tolist(), numbers.tolist(), strict=True
        )
    )
    confidence = min(max(float(candidate.confidence), 0.0), 1.0)
    return Feature(
        id=new_feature_id(),
        kind=candidate.kind,
        geometry=Geometry(candidate.geometry),
        vertices=vertices,
        attributes={**candidate.attributes, **({PHOTO: photo} if photo else {})},
        status=Status.CANDIDATE,
        provenance=Provenance(run.tool, run.version, run.parameters, confidence, run.id),
        own_points=_own_points(candidate, drives),
    )


def _own_points(candidate: Candidate, drives: Sequence[str]) -> tuple[OwnPoints, ...]:
    """Those of a candidate, for each drive that has some."""
    points, numbers = candidate.own_points, candidate.own_drives
    if points is None:
        return ()
    of = np.zeros(len(points), np.int64) if numbers is None else numbers
    return tuple(
        own_points(drive, points[of == number])
        for number, drive in enumerate(drives)
        if (of == number).any()
    )
