"""A model that a project learnt, as a folder of its own: the trees, and what is known of them."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.errors import BadFile, Unsuitable, report_as_user_error
from processing.core.stored_json import json_of
from processing.core.text import Text
from processing.methods.classes.class_models import ClassModels, shipped_models, shipped_version
from processing.methods.classes.learning import Gain
from processing.methods.noise.tree_files import Forest, read_forest, write_forest
from processing.scoring.points.confusion_matrix import ConfusionMatrix

_TREES, _FACTS = "again.onnx", "model.json"
_FORMAT = 1

_LEARN_AGAIN = Text(
    "Learn from the corrections again; until then the program's own model is used.",
    "もう一度「修正から学習」を実行してください。それまでは付属のモデルを使います。",
)


@dataclass(frozen=True)
class ModelFacts:
    """What is known of a model that was learnt.

    Attributes
    ----------
    id : str
        The name of its folder.
    made : datetime
        With its time zone.
    points : int
        So many were painted.
    gain : Gain
        At places left out in turn.
    """

    id: str
    made: datetime
    points: int
    gain: Gain


def write_own_model(facts: ModelFacts, forest: Forest, folder: Path) -> None:
    """Write a model into a folder that is there and empty.

    Raises
    ------
    NoSpace
    """
    shipped = shipped_models()
    columns = shipped.again_columns
    with report_as_user_error(folder):
        write_forest(forest, folder / _TREES, columns)
        table = {
            "format": _FORMAT,
            "shipped": shipped_version(),
            "sum": _sum_of(folder / _TREES),
            "made": facts.made.isoformat(),
            "points": facts.points,
            "places": facts.gain.places,
            "classes": sorted(facts.gain.classes),
            "before": _table_of(facts.gain.before),
            "after": _table_of(facts.gain.after),
        }
        (folder / _FACTS).write_text(json.dumps(table), encoding="utf-8")


def read_facts(folder: Path) -> ModelFacts:
    """What is known of a model.

    Raises
    ------
    MissingInput, BadFile
    """
    return _facts_of(_read_table(folder), folder)


def read_own_model(folder: Path) -> tuple[ModelFacts, ClassModels]:
    """A model that was learnt, with what it stands on.

    Raises
    ------
    MissingInput, BadFile
        It is gone or damaged.
    Unsuitable
        It was learnt on top of other shipped models than these.
    """
    table = _read_table(folder)
    facts = _facts_of(table, folder)
    if (table["format"], table["shipped"]) != (_FORMAT, shipped_version()):
        raise Unsuitable(
            Text(
                "The model was learnt by another version of the program.",
                "このモデルは別のバージョンで学習されました。",
            ),
            Text.same(str(folder)),
            _LEARN_AGAIN,
        )
    path = folder / _TREES
    with report_as_user_error(path):
        if _sum_of(path) != table["sum"]:
            raise _damaged(path)
        return facts, replace(shipped_models(), again=read_forest(path), is_own=True)


def _read_table(folder: Path) -> dict[str, Any]:
    path = folder / _FACTS
    with report_as_user_error(path):
        content = path.read_bytes()
    try:
        table = json_of(content)
        if not {"format", "shipped", "sum"} <= set(table):
            raise _damaged(path)
    except (ValueError, TypeError) as error:
        raise _damaged(path) from error
    return dict(table)


def _facts_of(table: dict[str, Any], folder: Path) -> ModelFacts:
    try:
        before, after = (_matrix_of(table[name]) for name in ("before", "after"))
        classes = frozenset(int(code) for code in table["classes"])
        gain = Gain(before, after, int(table["places"]), classes)
        made = datetime.fromisoformat(table["made"])
        return ModelFacts(folder.name, made, int(table["points"]), gain)
    except (KeyError, TypeError, ValueError) as error:
        raise _damaged(folder / _FACTS) from error


def _table_of(matrix: ConfusionMatrix) -> dict[str, object]:
    return {"codes": list(matrix.codes), "counts": matrix.counts.tolist()}


def _matrix_of(table: dict[str, Any]) -> ConfusionMatrix:
    codes = tuple(int(code) for code in table["codes"])
    return ConfusionMatrix(codes, np.array(table["counts"], np.int64).reshape(2 * (len(codes),)))


def _sum_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _damaged(path: Path) -> BadFile:
    return BadFile(
        Text("The model is damaged.", "モデルのファイルが壊れています。"),
        Text.same(str(path)),
        _LEARN_AGAIN,
    )
