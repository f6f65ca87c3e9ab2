"""BatchJob: which deliveries, what is done to each, and where the results go; read from TOML.

A step is an operation as a file holds it (:mod:`processing.operations.operation_files`) without
what the delivery gives: its files, its project, its folder of results.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

from processing.core.errors import (
    BadFile,
    MissingInput,
    OutOfRange,
    UserError,
    name_with_type,
    report_as_user_error,
    use_one_of,
)
from processing.core.text import Text
from processing.operations.operation_files import OPERATIONS, OperationKind, rooted
from processing.operations.written_values import Table, table_from_text, table_of, value_from
from processing.project.importing.import_request import ImportRequest

STEP_KINDS = (
    "import",
    "run",
    "extract",
    "learn",
    "number",
    "take-map",
    "compare-map",
    "export",
)
"""Operations that a drive may be put through: done a second time they give the same."""

MOST_MEMORY_GIB = 1024.0
MOST_SETTLED_S = 86_400.0

_KIND, _STEPS = "kind", "steps"
_DRIVE, _RESULTS = "{drive}", "{results}"
_EACH = Literal["each", "one"]


@dataclass(frozen=True)
class BatchJob:
    """A job, as its file says it.

    Attributes
    ----------
    deliveries : tuple of str
        Folders and point files, with ``*`` and ``?`` for any letters; each match is a drive.
    steps : tuple of Mapping
        What is done to each, in this order: operations as files hold them.
    output : Path
        The folder of the results.
    results : "each" or "one"
        A project for each delivery, or one with all of them.
    name : str
        Of the one project, and of the job on its page; empty for the file's own name.
    workers : int
        Drives that are worked on at a time on this machine; 0 for as many as it has cores.
    memory_gib : float
        What the processes of one drive may hold; one that takes more is ended and told.
    settled_s : float
        Of a job that waits for deliveries: how long nothing of one must have changed.
    marker : str
        The same: the name of a file that is put into a delivery when it is whole; empty without.
    """

    deliveries: tuple[str, ...]
    steps: tuple[Mapping[str, Any], ...] = ()  # what TOML holds
    output: Path = Path("results")
    results: _EACH = "each"
    name: str = ""
    workers: int = 0
    memory_gib: float = 4.0
    settled_s: float = 60.0
    marker: str = ""


@dataclass(frozen=True)
class JobFile:
    """A job and where its file stands, from which its relative paths count."""

    path: Path
    job: BatchJob

    @property
    def folder(self) -> Path:
        """The file's folder."""
        return self.path.parent

    @property
    def output(self) -> Path:
        """The folder of the results, whole."""
        return self.folder / self.job.output

    @property
    def name(self) -> str:
        """What the job is called."""
        return self.job.name or self.path.stem


@dataclass(frozen=True)
class StepPlaces:
    """What a step gets from its delivery.

    Attributes
    ----------
    drive : str
        The name of the delivery; in a step's words ``{drive}`` stands for it.
    results : Path
        Its folder of results (``{results}``), from which outputs count.
    project : Path
    request : ImportRequest
        Its files.
    """

    drive: str
    results: Path
    project: Path
    request: ImportRequest


def read_job(path: Path) -> JobFile:
    """Read a job's file and check every step of it, before anything is opened.

    Raises
    ------
    MissingInput, BadFile, OutOfRange
        It can't be read; it names a setting, an operation, a tool or a parameter that there isn't;
        a value can't be. The message says which step.
    """
    path = path.absolute()
    with report_as_user_error(path):
        content = path.read_bytes()
    table = table_from_text(content.decode("utf-8-sig", errors="replace"), str(path))
    steps = _steps_of(table, path)
    _check_order(steps, path)
    with _at(str(path)):
        job = replace(value_from(BatchJob, table), steps=steps)
        _check_values(job)
    file = JobFile(path, job)
    example = StepPlaces(
        "drive", file.output / "drive", file.output / "drive.zuka", ImportRequest((Path("drive"),))
    )
    for number in range(len(steps)):
        operation_of_step(file, number, example)
    return file


def operation_of_step(file: JobFile, number: int, places: StepPlaces) -> Any:  # any kind
    """The operation that a step is for one delivery, checked.

    Raises
    ------
    OutOfRange, MissingInput
        As :func:`read_job`.
    """
    step = dict(file.job.steps[number])
    with _at(f"{file.path}, {_STEPS}[{number + 1}]"):
        kind = _kind_of(step)
        table = _filled(step, places)
        _give_places(kind, table, places)
        operation = rooted(value_from(kind.type, table), file.folder)
        check = getattr(operation, "check", None)
        if check is not None:
            check()
        return operation


def is_import(step: Mapping[str, object]) -> bool:
    """Whether a step takes the delivery's files in."""
    return step.get(_KIND) == "import"


def kind_id_of(step: Mapping[str, object]) -> str:
    """How the file names a step's operation."""
    return str(step.get(_KIND, ""))


def order_of(file: JobFile) -> Table:
    """A job as JSON holds it, for the process that works on one of its drives."""
    job = table_of(replace(file.job, steps=()))
    return {"path": str(file.path), "job": job, _STEPS: [dict(one) for one in file.job.steps]}


def job_of_order(order: Table) -> JobFile:
    """The job that :func:`order_of` wrote."""
    job = value_from(BatchJob, order["job"])
    return JobFile(Path(order["path"]), replace(job, steps=tuple(order[_STEPS])))


def _steps_of(table: Table, path: Path) -> tuple[Mapping[str, object], ...]:
    steps = table.pop(_STEPS, [])
    if not isinstance(steps, list) or not steps or not all(isinstance(one, dict) for one in steps):
        raise BadFile(
            Text("The job has no steps.", "ジョブに処理手順がありません。"),
            Text.same(str(path)),
            Text(
                "Write at least one table [[steps]] with a kind.",
                "[[steps]] の表を1つ以上書き、kind を指定してください。",
            ),
        )
    return tuple(steps)


def steps_of_text(text: str, path: Path) -> tuple[Mapping[str, object], ...]:
    """The steps of a file that holds nothing else, or a job's.

    Raises
    ------
    BadFile
        It holds none.
    """
    return _steps_of(table_from_text(text, str(path)), path)


def _check_order(steps: Sequence[Mapping[str, object]], path: Path) -> None:
    if not is_import(steps[0]) or any(is_import(one) for one in steps[1:]):
        raise OutOfRange(
            Text("A job begins with one import.", "ジョブの最初の手順は import です。"),
            Text.same(f"{path}, {_STEPS}[1]"),
            Text(
                'Begin with [[steps]] kind = "import"; the other steps work on its project.',
                '最初の [[steps]] を kind = "import" としてください。',
            ),
        )


def _check_values(job: BatchJob) -> None:
    if not job.deliveries or not all(job.deliveries):
        raise MissingInput(
            Text("The job names no deliveries.", "ジョブに対象のデータがありません。"),
            Text.same("deliveries"),
            Text(
                'Write for instance deliveries = ["drives/*"].',
                'deliveries = ["drives/*"] のように指定してください。',
            ),
        )
    if not 0 <= job.workers <= 256:
        raise OutOfRange(
            Text("There can't be so many workers.", "ワーカー数が範囲外です。"),
            Text.same(f"workers={job.workers}"),
            Text("Use 0 (as many as cores) to 256.", "0（コア数と同じ）～256 としてください。"),
        )
    if not 0.0 <= job.settled_s <= MOST_SETTLED_S:
        raise OutOfRange(
            Text("A delivery can't be waited for so long.", "待ち時間が範囲外です。"),
            Text.same(f"settled_s={job.settled_s:g}"),
            Text("Use for instance 60.", "60 などの値を指定してください。"),
        )
    if not 0.0 < job.memory_gib <= MOST_MEMORY_GIB:
        raise OutOfRange(
            Text("A worker can't have so much memory.", "メモリーの上限が範囲外です。"),
            Text.same(f"memory_gib={job.memory_gib:g}"),
            Text("Use for instance 4.", "4 などの値を指定してください。"),
        )


def _kind_of(step: Table) -> OperationKind:
    name = str(step.pop(_KIND, ""))
    known = {one: OPERATIONS[one] for one in STEP_KINDS}
    return name_with_type(
        known, name, Text("There is no such step.", "そのような手順はありません。")
    )


def _filled(value: Any, places: StepPlaces) -> Any:  # what TOML holds, and the same back
    if isinstance(value, str):
        return value.replace(_DRIVE, places.drive).replace(_RESULTS, str(places.results))
    if isinstance(value, list):
        return [_filled(one, places) for one in value]
    if isinstance(value, dict):
        return {name: _filled(one, places) for name, one in value.items()}
    return value


def _give_places(kind: OperationKind, table: Table, places: StepPlaces) -> None:
    """Give an operation what the delivery has: its project, its files, its folder."""
    names = {field.name for field in fields(kind.type)}
    for own in sorted(names & {"project", "inputs"}):
        if own in table:
            raise OutOfRange(
                Text("A step works on its own drive.", "手順の対象は各走行データです。"),
                Text.same(own),
                Text("Leave it out.", "この指定を外してください。"),
            )
    if "project" in names:
        table["project"] = str(places.project)
    if "inputs" in names:
        table["inputs"] = {"project": str(places.project)}
    if kind.id == "import":
        table["request"] = _import_table(table.get("request", {}), places.request)
    if kind.id == "export":
        table["request"] = {"folder": ".", **_table_at(table, "request")}
        table["request"]["folder"] = str(places.results / table["request"]["folder"])
    if table.get("output"):
        table["output"] = str(places.results / str(table["output"]))


def _table_at(table: Table, name: str) -> Table:
    given = table.get(name, {})
    if not isinstance(given, dict):
        raise OutOfRange(
            Text("The value is not of the right type.", "値の種類が正しくありません。"),
            Text.same(name),
            Text(f"Write {name}.NAME = VALUE.", f"{name}.名前 = 値 の形で記述してください。"),
        )
    return given


def _import_table(given: object, request: ImportRequest) -> Table:
    table = _table_at({"request": given}, "request")
    wrong = sorted({"inputs", "trajectories", "images"} & set(table))
    if wrong:
        raise OutOfRange(
            Text("The files come from the delivery.", "ファイルは納品フォルダから読み込みます。"),
            Text.same(f"request.{wrong[0]}"),
            use_one_of(("request.crs", "request.labels", "request.columns")),
        )
    files = {
        "inputs": [str(one) for one in request.inputs],
        "trajectories": [str(one) for one in request.trajectories],
        "images": [str(one) for one in request.images],
    }
    return {**table, **files}


@contextmanager
def _at(place: str) -> Iterator[None]:
    """Add to a message where it was met."""
    try:
        yield
    except UserError as error:
        where = Text("{place}: {where}", "{place}: {where}").filled(place=place, where=error.where)
        raise type(error)(error.what, where, error.remedy) from error
