"""Operations as files: written down as TOML or JSON, read back, and done.

A file says its kind and what the operation's own value says; see
:mod:`processing.operations.written_values`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from typing import Any, cast

from processing.core.errors import OutOfRange, name_with_type, report_as_user_error, use_one_of
from processing.core.monitor import Monitor
from processing.core.parameters import ParameterValue, parameters_of
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.operations.extraction import ExtractOperation, extract
from processing.operations.import_files import ImportOperation, import_files
from processing.operations.learn import LearnOperation, learn_in_project
from processing.operations.map_steps import (
    CentreLineOperation,
    CompareMapOperation,
    NumberOperation,
    TakeMapOperation,
    UndoOperation,
    WidthOperation,
    compare_map,
    draw_centre_lines,
    draw_widths,
    number_features,
    take_map,
    undo_step,
)
from processing.operations.project_export import ExportOperation, export_project
from processing.operations.project_volumes import KeepVolumeOperation, keep_volume
from processing.operations.run import RunOperation, run_operation
from processing.operations.score import ScoreOperation, score_result
from processing.operations.volume import VolumeOperation, compare_grounds
from processing.operations.written_values import (
    json_text,
    table_from_text,
    table_of,
    toml_text,
    value_from,
)

_KIND, _PARAMETERS = "kind", "parameters"
_JSON, _ENDINGS = ".json", (".toml", ".json")


@dataclass(frozen=True)
class OperationKind:
    """One kind of operation.

    Attributes
    ----------
    id : str
        How a file names it.
    type : type
        Its frozen dataclass.
    perform : callable
        Does it; gives its own kind of outcome.
    """

    id: str
    type: type[Any]  # each kind has a dataclass of its own
    perform: Callable[[Any, Monitor], object]


Kinds = Mapping[str, OperationKind]

OPERATIONS: Kinds = {
    one.id: one
    for one in (
        OperationKind("import", ImportOperation, import_files),
        OperationKind("run", RunOperation, run_operation),
        OperationKind("extract", ExtractOperation, extract),
        OperationKind("learn", LearnOperation, learn_in_project),
        OperationKind("number", NumberOperation, number_features),
        OperationKind("widths", WidthOperation, draw_widths),
        OperationKind("centre-lines", CentreLineOperation, draw_centre_lines),
        OperationKind("take-map", TakeMapOperation, take_map),
        OperationKind("compare-map", CompareMapOperation, compare_map),
        OperationKind("undo", UndoOperation, undo_step),
        OperationKind("export", ExportOperation, export_project),
        OperationKind("score", ScoreOperation, score_result),
        OperationKind("volume", VolumeOperation, compare_grounds),
        OperationKind("keep-volume", KeepVolumeOperation, keep_volume),
    )
}
"""What can be done to projects and files, by the name that a file gives it."""


def perform(operation: object, monitor: Monitor, kinds: Kinds = OPERATIONS) -> object:
    """Do what an operation says; gives its outcome.

    Raises
    ------
    UserError, Cancelled
        As its kind's own function.
    """
    return kind_of(operation, kinds).perform(operation, monitor)


def kind_of(operation: object, kinds: Kinds = OPERATIONS) -> OperationKind:
    """The kind of an operation; ValueError for what is none."""
    for kind in kinds.values():
        if isinstance(operation, kind.type):
            return kind
    message = f"{operation} is no operation"
    raise ValueError(message)


def operation_text(operation: object, kinds: Kinds = OPERATIONS, *, is_json: bool = False) -> str:
    """An operation written down.

    Raises
    ------
    OutOfRange
        The name of a file can't be written.
    """
    table = {_KIND: kind_of(operation, kinds).id, **table_of(operation)}
    return json_text(table) if is_json else toml_text(table)


def operation_from_text(
    text: str, kinds: Kinds = OPERATIONS, *, where: str = "operation"
) -> object:
    """The operation that a text says, checked as the command line's words are.

    Parameters
    ----------
    where : str
        What the text is called in messages.

    Raises
    ------
    BadFile
        It is neither TOML nor JSON.
    OutOfRange, MissingInput
        There is no such kind, setting, tool or value.
    """
    table = table_from_text(text, where)
    name = table.pop(_KIND, "")
    kind = name_with_type(
        kinds, str(name), Text("There is no such operation.", "そのような操作はありません。")
    )
    operation = value_from(kind.type, table)
    check = getattr(operation, "check", None)
    if check is not None:
        check()
    return operation


def write_operation(path: Path, operation: object, kinds: Kinds = OPERATIONS) -> None:
    """Write an operation to a file; its paths are whole there.

    Parameters
    ----------
    path : Path
        Ends in ``.toml`` or ``.json``.

    Raises
    ------
    OutOfRange
        It has another ending, or a name can't be written.
    NoSpace, InUse
    """
    _check_ending(path)
    whole = rooted(operation, Path.cwd())
    text = operation_text(whole, kinds, is_json=path.suffix.lower() == _JSON)
    with write_safely(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def read_operation(path: Path, kinds: Kinds = OPERATIONS) -> object:
    """The operation of a file; its relative paths count from the file's folder.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read.
    OutOfRange
        As :func:`operation_from_text`.
    """
    _check_ending(path)
    with report_as_user_error(path):
        content = path.read_bytes()
    text = content.decode("utf-8-sig", errors="replace")
    return rooted(operation_from_text(text, kinds, where=str(path)), path.parent.absolute())


def rooted(operation: Any, folder: Path) -> Any:  # any kind of operation, and the same back
    """An operation whose relative paths count from a folder, those of parameters too."""
    changed: dict[str, Any] = {
        field.name: _rooted(getattr(operation, field.name), folder)
        for field in fields(cast("Any", operation))
    }
    parameters = changed.get(_PARAMETERS)
    declaring = getattr(operation, "parameter_class", None)
    if parameters and declaring is not None:
        declared = {one.id: one for one in parameters_of(declaring)}
        changed[_PARAMETERS] = {
            name: _rooted_words(value, folder)
            if name in declared and declared[name].kind == "file"
            else value
            for name, value in parameters.items()
        }
    return replace(operation, **changed)


def _rooted(value: object, folder: Path) -> object:
    if isinstance(value, Path):
        return folder / value
    if isinstance(value, tuple):
        return tuple(_rooted(one, folder) for one in value)
    if is_dataclass(value):
        return rooted(value, folder)
    return value


def _rooted_words(value: ParameterValue, folder: Path) -> ParameterValue:
    # An empty name is none. What stands behind a “#”, a layer's name, stays where it is.
    return str(folder / str(value)) if value else value


def _check_ending(path: Path) -> None:
    if path.suffix.lower() not in _ENDINGS:
        raise OutOfRange(
            Text("An operation is a TOML or JSON file.", "操作のファイルはTOMLかJSONです。"),
            Text.same(str(path)),
            use_one_of(_ENDINGS),
        )
