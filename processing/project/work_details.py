"""Who does which work for whom: what stands at the head of a work's papers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from datetime import date
from pathlib import Path

from processing.core.errors import OutOfRange
from processing.core.parameters import MOST_LETTERS, fill_parameters, parameters_of, text
from processing.core.text import Text
from processing.core.toml_lines import line_error, short, toml_content, toml_of
from processing.formats.work_facts import WorkFacts

_CORRECT = Text(
    "Correct this line of the file and try again; nothing was written.",
    "ファイルのこの行を修正して、やり直してください。何も書き込まれていません。",
)


@dataclass(frozen=True)
class WorkDetails:
    """What an office knows of a work; what is empty leaves a blank to be filled in by hand."""

    work: str = text(
        name=Text("Work", "工事名"),
        explanation=Text(
            "Name of the work on its papers. Empty: the project's name.",
            "帳票に記載する工事名です。空欄ではプロジェクト名とします。",
        ),
    )
    place: str = text(
        name=Text("Part", "測点・範囲"),
        explanation=Text(
            "Which part of the work is meant: stations, place.",
            "工事のどの部分かを示します（測点、施工箇所）。",
        ),
    )
    client: str = text(name=Text("Client", "発注者"))
    contractor: str = text(name=Text("Contractor", "受注者"))
    surveyor: str = text(name=Text("Surveyor", "測定者"))
    height_datum: str = text(
        name=Text("Heights", "標高の基準"),
        explanation=Text(
            "What heights count from: JGD2024, JGD2011, T.P. or another.",
            "標高の基準です（JGD2024、JGD2011、T.P. など）。",
        ),
    )

    def facts(self, crs: str, version: str, made_on: date) -> WorkFacts:
        """What papers say of the work.

        Parameters
        ----------
        crs : str
            ``EPSG:n``, or empty when unknown.
        version : str
            Of the software.
        made_on : date
            The day on the paper.
        """
        return WorkFacts(**asdict(self), crs=crs, version=version, made_on=made_on)


def details_of(values: Mapping[str, str]) -> WorkDetails:
    """Details by the names of their fields, without blanks around them.

    Raises
    ------
    OutOfRange
        There is no such field, or a value is too long or no single line.
    """
    return fill_parameters(WorkDetails, {name: value.strip() for name, value in values.items()})


def read_work_details(path: Path) -> WorkDetails:
    """Read details from TOML: ``client = "…"``, each of the fields at most once.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; it is not TOML in UTF-8; an entry is unknown, or no line of text: the
        line is named.
    """
    lines, values = toml_of(toml_content(path), path, _CORRECT)
    for key, value in values.items():
        fault = _fault_of(key, value)
        if fault is not None:
            raise line_error(fault, path, _line_of(key, lines), _CORRECT)
    return details_of(values)


def _fault_of(key: str, value: object) -> Text | None:
    """What is wrong with an entry; None where nothing is."""
    known = [one.id for one in parameters_of(WorkDetails)]
    if key not in known:
        return Text(
            "There is no entry “{key}”; known are: {known}.",
            "「{key}」という項目はありません。使える項目: {known}",
        ).filled(key=short(key), known=", ".join(known))
    try:
        details_of({key: _words(value)})
    except (OutOfRange, TypeError):
        return Text(
            "The entry “{key}” must be one line of up to {count} letters in quotes.",
            "項目「{key}」は引用符で囲んだ{count}文字以内の1行にしてください。",
        ).filled(key=key, count=MOST_LETTERS)
    return None


def _words(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def _line_of(key: str, lines: list[str]) -> int:
    setting = re.compile(rf'\s*\[*\s*["\']?{re.escape(key)}["\']?\s*[=.\]]')
    return next((number for number, line in enumerate(lines, 1) if setting.match(line)), 1)
