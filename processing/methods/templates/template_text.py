"""Templates as JSON: what a project keeps, what files carry from one project to another."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from processing.core.errors import UNCHANGED, BadFile, OutOfRange, report_as_user_error
from processing.core.text import Text
from processing.methods.templates.profile_template import (
    USUAL_TOLERANCE_M,
    MadeLine,
    ProfilePoint,
    ProfileTemplate,
    TemplateProfile,
)

FORMAT = "zuka-template"
VERSION = 1

_LARGEST_BYTES = 1 << 20
"""A template has some kilobytes; larger files are something else."""

_DIGITS = 4
"""After the point: tenths of a millimetre."""

_QUOTED_LETTERS = 40
"""Of a wrong value, in a message."""

JsonValue = str | int | float | bool | None | list["JsonValue"] | dict[str, "JsonValue"]


def template_text(template: ProfileTemplate) -> str:
    """A template as one JSON object, its vertices to the tenth of a millimetre."""
    return json.dumps(values_of(template), ensure_ascii=False, indent=1, allow_nan=False)


def template_line(template: ProfileTemplate) -> str:
    """The same on one line, its name first: how a run's parameters hold a template."""
    return json.dumps(values_of(template), ensure_ascii=False, allow_nan=False)


def values_of(template: ProfileTemplate) -> dict[str, JsonValue]:
    """What :func:`template_of` reads."""
    return {
        "name": template.name,
        "format": FORMAT,
        "version": VERSION,
        "tolerance_m": template.tolerance_m,
        "shape": [_written(profile) for profile in template.shape],
        "empty": [_written(zone) for zone in template.empty],
        "lines": [{"kind": line.kind, "at": _written((line.at,))[0]} for line in template.lines],
    }


def read_template(path: Path) -> ProfileTemplate:
    """The template of a file.

    Raises
    ------
    MissingInput, BadFile
        There is no such file, or it holds no template.
    """
    with report_as_user_error(path):
        if path.stat().st_size > _LARGEST_BYTES:
            raise _no_template(str(path), "too large")
        content = path.read_bytes()
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise _no_template(str(path), "no UTF-8") from error
    return parse_template(text, str(path))


def parse_template(text: str, where: str) -> ProfileTemplate:
    """The template that a JSON text holds.

    Parameters
    ----------
    where : str
        Named in the refusal.

    Raises
    ------
    BadFile
    """
    try:
        values = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _no_template(where, str(error)) from error
    return template_of(values, where)


def template_of(values: JsonValue, where: str) -> ProfileTemplate:
    """The template that was stored as values.

    Raises
    ------
    BadFile
        They hold none.
    """
    if not isinstance(values, dict) or values.get("format") != FORMAT:
        raise _no_template(where, f"“format” is not “{FORMAT}”")
    if values.get("version") != VERSION:
        raise _no_template(where, f"version {values.get('version')}")
    try:
        return ProfileTemplate(
            name=_text(values, "name"),
            shape=tuple(_profile(one) for one in _list(values, "shape")),
            lines=tuple(_line(one) for one in _list(values, "lines")),
            empty=tuple(_profile(one) for one in _list(values, "empty")),
            tolerance_m=_number(values.get("tolerance_m", USUAL_TOLERANCE_M)),
        )
    except OutOfRange as error:
        raise _no_template(where, error.what.en, error.what.ja) from error
    except (TypeError, ValueError) as error:
        raise _no_template(where, str(error)) from error


def _written(profile: TemplateProfile) -> list[JsonValue]:
    return [[round(offset, _DIGITS), round(height, _DIGITS)] for offset, height in profile]


def _text(values: Mapping[str, Any], key: str) -> str:  # what JSON can hold
    value = values.get(key)
    if not isinstance(value, str):
        message = f"“{key}” is no text"
        raise TypeError(message)
    return value


def _list(values: Mapping[str, Any], key: str) -> list[Any]:  # what JSON can hold
    value = values.get(key, [])
    if not isinstance(value, list):
        message = f"“{key}” is no list"
        raise TypeError(message)
    return value


def _profile(value: JsonValue) -> TemplateProfile:
    if not isinstance(value, list):
        message = f"{str(value)[:_QUOTED_LETTERS]} is no list of places"
        raise TypeError(message)
    return tuple(_position(one) for one in value)


def _position(value: JsonValue) -> ProfilePoint:
    if not isinstance(value, list) or len(value) != 2:
        message = f"{str(value)[:_QUOTED_LETTERS]} is no place [offset, height]"
        raise TypeError(message)
    return _number(value[0]), _number(value[1])


def _line(value: JsonValue) -> MadeLine:
    if not isinstance(value, dict):
        message = f"{str(value)[:_QUOTED_LETTERS]} is no line"
        raise TypeError(message)
    return MadeLine(_text(value, "kind"), _position(value.get("at", [0.0, 0.0])))


def _number(value: JsonValue) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        message = f"{str(value)[:_QUOTED_LETTERS]} is no number"
        raise TypeError(message)
    return float(value)


def _no_template(where: str, reason: str, reason_ja: str = "") -> BadFile:
    return BadFile(
        Text(
            "This is no template: {reason}.", "テンプレートとして読み込めません（{reason}）。"
        ).filled(reason=Text(reason.rstrip("."), (reason_ja or reason).rstrip("。"))),
        Text.same(where),
        Text(
            "Choose a template that this program exported. {unchanged}",
            "本プログラムで書き出したテンプレートを選んでください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
