"""What a project's papers say of its work, and by which limits they judge: kept in its settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from processing.core.errors import BadFile, UserError
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.core.toml_lines import toml_content
from processing.methods.earthwork.as_built.limits import AsBuiltLimits
from processing.methods.earthwork.as_built.limits_file import BUNDLED, as_built_limits, limits_of
from processing.project.store.project_settings import JsonValue, ProjectSettings
from processing.project.work_details import WorkDetails, details_of
from resources import path_of

_DETAILS, _LIMITS = "work_details", "as_built_limits"


@dataclass(frozen=True)
class ChosenLimits:
    """By what a measured ground is judged.

    Attributes
    ----------
    table : AsBuiltLimits
    file_name : str
        Of the office's own table; empty for the one that comes with the program.
    work_type : str
        Id of the work type of the table that was chosen; empty before one was.
    """

    table: AsBuiltLimits
    file_name: str = ""
    work_type: str = ""

    @property
    def shown_work_type(self) -> str:
        """The chosen work type, before one was the table's first."""
        return self.work_type or self.table.work_types[0].id


class WorkStore:
    """The details of a project's work, and the limits that count in it.

    A table of limits is copied into the project: what was judged by it can be judged by it again,
    wherever the project is taken and whatever becomes of the file.

    Parameters
    ----------
    settings : ProjectSettings
        Of the open project.

    Raises
    ------
    NoSpace, InUse
        From what changes something; all is as it was.
    """

    def __init__(self, settings: ProjectSettings) -> None:
        self._settings = settings

    def details(self) -> WorkDetails:
        """What was entered; empty before anything was.

        Raises
        ------
        BadFile
            What is stored is none.
        """
        stored = self._read_stored(_DETAILS)
        try:
            return details_of({name: _text(value) for name, value in stored.items()})
        except (UserError, TypeError) as error:
            raise _make_damage_error(_DETAILS) from error

    def keep_details(self, details: WorkDetails) -> None:
        """Keep these in place of those before."""
        self._settings.put(_DETAILS, {**asdict(details)})

    def limits(self) -> ChosenLimits:
        """The table that counts and the work type in it.

        Raises
        ------
        BadFile
            What is stored is none.
        """
        stored = self._read_stored(_LIMITS)
        try:
            name = _text(stored.get("file_name", ""))
            content = _text(stored.get("content", ""))
            work_type = _text(stored.get("work_type", ""))
            table = limits_of(content.encode(), Path(name)) if name else as_built_limits()
        except (UserError, TypeError) as error:
            raise _make_damage_error(_LIMITS) from error
        return ChosenLimits(table, name, _key_of(table, work_type))

    def adopt_limits(self, path: Path) -> None:
        """Judge by an office's own table from now on; a work type that it has too stays chosen.

        Raises
        ------
        MissingInput, NoSpace, BadFile
            The file can't be read, or is no table of limits; names the line.
        """
        content = toml_content(path)
        table = limits_of(content, path)
        chosen = {
            "file_name": path.name,
            "content": content.decode("utf-8-sig"),
            "work_type": _key_of(table, self._work_type),
        }
        self._settings.put(_LIMITS, {**chosen})

    def write_limits(self, path: Path, *, never: Iterable[Path] = ()) -> None:
        """Write the table that counts to a file, for an office to start its own from.

        Parameters
        ----------
        never : iterable of Path
            Delivered files, which must not be overwritten.

        Raises
        ------
        InUse
            The path is one of those, or the program's own table.
        NoSpace, MissingInput, BadFile
        """
        bundled = path_of(BUNDLED)
        stored = self._read_stored(_LIMITS)
        content = bundled.read_bytes()
        if self.limits().file_name:
            content = _text(stored["content"]).encode()
        with write_safely(path, never=(bundled, *never)) as temporary:
            temporary.write_bytes(content)

    def drop_limits(self) -> None:
        """Judge by the table that comes with the program."""
        self._settings.put(_LIMITS, {"work_type": _key_of(as_built_limits(), self._work_type)})

    def choose_work_type(self, work_type: str) -> None:
        """Let the limits of a work type count.

        Raises
        ------
        OutOfRange
            The table has none of that id.
        BadFile
            What is stored is no table.
        """
        stored = self._read_stored(_LIMITS)
        chosen = self.limits().table[work_type]
        self._settings.put(_LIMITS, {**stored, "work_type": chosen.id})

    @property
    def _work_type(self) -> str:
        """What was chosen, whatever became of the table."""
        with suppress(BadFile):
            chosen = self._read_stored(_LIMITS).get("work_type")
            return chosen if isinstance(chosen, str) else ""
        return ""

    def _read_stored(self, key: str) -> Mapping[str, JsonValue]:
        stored = self._settings.get(key)
        if stored is not None and not isinstance(stored, dict):
            raise _make_damage_error(key)
        return stored or {}


def _key_of(table: AsBuiltLimits, work_type: str) -> str:
    return work_type if any(one.id == work_type for one in table.work_types) else ""


def _text(value: JsonValue) -> str:
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def _make_damage_error(key: str) -> BadFile:
    return BadFile(
        Text(
            "What the project keeps for its papers is damaged.",
            "プロジェクトに保存された帳票用の情報が壊れています。",
        ),
        Text.same(f"zuka_settings.{key}"),
        Text(
            "Enter the work details, or choose the table of limits, once more.",
            "工事情報を入力し直すか、規格値表を選び直してください。",
        ),
    )
