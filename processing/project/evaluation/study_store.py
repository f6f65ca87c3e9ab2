"""The parameter studies of a project: kept in its settings with the truth they were judged by."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from uuid import uuid4

from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.project.evaluation.parameter_study import ParameterStudy, StudyCell, VariedParameter
from processing.project.store.project_settings import JsonValue, ProjectSettings
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix

MOST_KEPT = 50
"""The oldest ones go first; a study of twenty by twenty is some 20 kB."""

_KEY = "studies"


@dataclass(frozen=True)
class KeptStudy:
    """A study and where it comes from.

    Attributes
    ----------
    id : str
    study : ParameterStudy
    truth : Text
        Name of the truth.
    where : str
        The drive's name.
    is_part : bool
        Whether only the surroundings of the points with a known truth were looked at.
    made : datetime
        With its time zone.
    """

    id: str
    study: ParameterStudy
    truth: Text
    where: str
    is_part: bool
    made: datetime


def new_study_id() -> str:
    """An id that no other study has."""
    return uuid4().hex


class StudyStore:
    """The studies of a project, the first one first.

    Parameters
    ----------
    settings : ProjectSettings
        Of the open project.
    """

    def __init__(self, settings: ProjectSettings) -> None:
        self._settings = settings

    def all(self) -> tuple[KeptStudy, ...]:
        """All studies; an entry that isn't one is left out."""
        stored = self._settings.get(_KEY)
        found = (_study_of(one) for one in (stored if isinstance(stored, list) else []))
        return tuple(one for one in found if one is not None)

    def add(self, kept: KeptStudy) -> None:
        """Keep one more study.

        Raises
        ------
        NoSpace, InUse
            The others stay.
        """
        self._put((*self.all(), kept)[-MOST_KEPT:])

    def remove(self, id_: str) -> None:
        """Forget a study.

        Raises
        ------
        NoSpace, InUse
            It stays.
        """
        self._put(tuple(one for one in self.all() if one.id != id_))

    def _put(self, kept: tuple[KeptStudy, ...]) -> None:
        self._settings.put(_KEY, [_values_of(one) for one in kept])


def _values_of(kept: KeptStudy) -> JsonValue:
    study = kept.study
    fixed: dict[str, JsonValue] = dict(study.fixed)
    varied: list[JsonValue] = [
        {"parameter": one.parameter, "values": list(one.values)} for one in study.varied
    ]
    cells: list[JsonValue] = []
    for cell in study.cells:
        counts = cell.counts
        numbers = [counts.hits, counts.false_alarms, counts.misses, counts.rejections]
        cells.append([list(cell.values), list(numbers)])
    return {
        "id": kept.id,
        "truth": {"en": kept.truth.en, "ja": kept.truth.ja},
        "where": kept.where,
        "is_part": kept.is_part,
        "made": kept.made.isoformat(),
        "tool": study.tool,
        "version": study.version,
        "fixed": fixed,
        "varied": varied,
        "cells": cells,
    }


def _study_of(values: JsonValue) -> KeptStudy | None:
    if not isinstance(values, dict):
        return None
    fixed, varied, cells = values.get("fixed"), values.get("varied"), values.get("cells")
    if not (isinstance(fixed, dict) and isinstance(varied, list) and isinstance(cells, list)):
        return None
    version, truth = values.get("version"), values.get("truth")
    if not isinstance(truth, dict):
        return None
    try:
        study = ParameterStudy(
            tool=str(values.get("tool")),
            version=version if isinstance(version, int) else 1,
            fixed={name: _value(one) for name, one in fixed.items()},
            varied=tuple(_varied_of(one) for one in varied),
            cells=tuple(_cell_of(one) for one in cells),
        )
        made = datetime.fromisoformat(str(values.get("made")))
    except (ValueError, TypeError):
        return None
    return KeptStudy(
        id=str(values.get("id")),
        study=study,
        truth=Text(str(truth.get("en")), str(truth.get("ja"))),
        where=str(values.get("where")),
        is_part=values.get("is_part") is True,
        made=made,
    )


def _varied_of(stored: JsonValue) -> VariedParameter:
    if not isinstance(stored, dict) or not isinstance(stored.get("values"), list):
        raise TypeError(stored)
    values = stored["values"]
    return VariedParameter(
        str(stored.get("parameter")), tuple(_value(one) for one in _list(values))
    )


def _cell_of(stored: JsonValue) -> StudyCell:
    values, numbers = _list(stored)
    counts = [one for one in _list(numbers) if isinstance(one, int)]
    return StudyCell(tuple(_value(one) for one in _list(values)), BinaryConfusionMatrix(*counts))


def _list(stored: JsonValue) -> list[JsonValue]:
    if not isinstance(stored, list):
        raise TypeError(stored)
    return stored


def _value(stored: JsonValue) -> ParameterValue:
    if not isinstance(stored, (str, int, float, bool)):
        raise TypeError(stored)
    return stored
