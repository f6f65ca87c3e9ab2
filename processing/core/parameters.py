"""The typed fields of a tool's parameters: a unit, limits, a default and words for people.

A tool's parameters are a frozen dataclass whose fields are made here. The form in the window, the
command line, the tool list and the manual are all drawn from these fields; nothing repeats them.

A field may name a picture that shows what is meant: ``picture="curb_heights"`` is
``resources/pictures/parameters/curb_heights.svg`` (the list is in the README beside it), and
``picture="curb_heights/lowest"`` the same with the part named ``lowest`` in the accent colour.
"""

from __future__ import annotations

import dataclasses
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, cast

from processing.core.errors import OutOfRange, use_one_of
from processing.core.text import Text

ParameterKind = Literal["number", "count", "choice", "switch", "file", "text"]
ParameterValue = float | int | str | bool
ParametersT = TypeVar("ParametersT")

MOST_LETTERS = 100
"""Of a text: papers have room for as much, and not for much more."""

_KEY = "zuka"
_BREAKING = ("Cc", "Cs", "Zl", "Zp")
_NONE = Text("", "")


@dataclass(frozen=True)
class ParameterChoice:
    """One of a field's allowed words."""

    value: str
    name: Text


@dataclass(frozen=True)
class Parameter:
    """What the program knows of one field.

    Attributes
    ----------
    id : str
        The field's name, as the command line writes it (``--set id=value``).
    kind : {"number", "count", "choice", "switch", "file", "text"}
        ``number`` is a float, ``count`` an int, ``switch`` a bool, the others are str.
    low, high : float
        Limits, both allowed; only numbers and counts have them.
    picture : str
        What shows its meaning, ``NAME`` or ``NAME/PART``; empty without one.
    zero : Text
        What 0 stands for and is shown as, where it stands for something else than a number.
    """

    id: str
    kind: ParameterKind
    default: ParameterValue
    name: Text
    explanation: Text = _NONE
    unit: str = ""
    low: float = 0.0
    high: float = 0.0
    choices: tuple[ParameterChoice, ...] = ()
    picture: str = ""
    zero: Text = _NONE

    @property
    def is_typed(self) -> bool:
        """Whether any words will do: a file, or a text."""
        return self.kind in ("file", "text")


# The return type is Any so that a field can be annotated with its value's type, as
# dataclasses.field itself is typed.
def _declare_field(parameter: Parameter) -> Any:
    return dataclasses.field(default=parameter.default, metadata={_KEY: parameter})


def length(
    default: float,
    *,
    low: float,
    high: float,
    name: Text,
    explanation: Text = _NONE,
    picture: str = "",
    zero: Text = _NONE,
) -> Any:
    """A length in metres."""
    return _declare_field(
        Parameter(
            "", "number", default, name, explanation, "m", low, high, picture=picture, zero=zero
        )
    )


def angle(
    default: float,
    *,
    low: float,
    high: float,
    name: Text,
    explanation: Text = _NONE,
    picture: str = "",
) -> Any:
    """An angle in degrees."""
    return _declare_field(
        Parameter("", "number", default, name, explanation, "°", low, high, picture=picture)
    )


def ratio(
    default: float,
    *,
    low: float,
    high: float,
    name: Text,
    explanation: Text = _NONE,
    picture: str = "",
) -> Any:
    """A number without a unit."""
    return _declare_field(
        Parameter("", "number", default, name, explanation, "", low, high, picture=picture)
    )


def least_confidence(default: float, explanation: Text) -> Any:
    """From which confidence on a tool that finds things shows them."""
    return ratio(
        default,
        low=0.0,
        high=1.0,
        name=Text("Least confidence", "信頼度の下限"),
        explanation=explanation,
        picture="confidence/least",
    )


def count(
    default: int,
    *,
    low: int,
    high: int,
    name: Text,
    explanation: Text = _NONE,
    picture: str = "",
) -> Any:
    """A whole number."""
    return _declare_field(
        Parameter("", "count", default, name, explanation, "", low, high, picture=picture)
    )


def choice(
    default: str,
    *,
    choices: tuple[ParameterChoice, ...],
    name: Text,
    explanation: Text = _NONE,
    picture: str = "",
) -> Any:
    """One word of a list."""
    return _declare_field(
        Parameter("", "choice", default, name, explanation, choices=choices, picture=picture)
    )


def switch(*, default: bool, name: Text, explanation: Text = _NONE, picture: str = "") -> Any:
    """Yes or no."""
    return _declare_field(Parameter("", "switch", default, name, explanation, picture=picture))


def file(*, name: Text, explanation: Text = _NONE, picture: str = "") -> Any:
    """A path to a file; empty means none."""
    return _declare_field(Parameter("", "file", "", name, explanation, picture=picture))


def text(*, name: Text, explanation: Text = _NONE) -> Any:
    """A line of words, of at most `MOST_LETTERS` letters; empty means none."""
    return _declare_field(Parameter("", "text", "", name, explanation))


def parameters_of(parameters: type[object]) -> tuple[Parameter, ...]:
    """The declared fields of a parameter class, in their order."""
    fields = dataclasses.fields(cast("Any", parameters))  # a dataclass type, by construction
    return tuple(dataclasses.replace(field.metadata[_KEY], id=field.name) for field in fields)


def fill_parameters(
    parameters: type[ParametersT], values: Mapping[str, ParameterValue | str]
) -> ParametersT:
    """Parameters with some values replaced, each read and checked against its field.

    Parameters
    ----------
    values : mapping of str to value
        Field name to value; text is read as the field's type (``"0.5"``, ``"yes"``).

    Raises
    ------
    OutOfRange
        For a name the tool doesn't have, a text that isn't the field's type, a value outside its
        limits.
    """
    known = {parameter.id: parameter for parameter in parameters_of(parameters)}
    checked = {}
    for name, value in values.items():
        if name not in known:
            raise OutOfRange(
                Text("There is no such parameter.", "そのようなパラメータはありません。"),
                Text.same(name),
                use_one_of(known),
            )
        checked[name] = _check_value(known[name], value)
    return parameters(**checked)


_YES = {"yes": True, "true": True, "1": True, "on": True}
_NO = {"no": False, "false": False, "0": False, "off": False}


def _check_value(parameter: Parameter, value: ParameterValue) -> ParameterValue:
    read = _read(parameter, value)
    if read is None:
        raise OutOfRange(
            Text("The value is not of the right type.", "値の種類が正しくありません。"),
            Text.same(f"{parameter.id}={value}"),
            _describe_allowed(parameter),
        )
    is_number = parameter.kind in ("number", "count")
    inside = parameter.low <= float(read) <= parameter.high if is_number else True
    if parameter.kind == "choice":
        inside = any(option.value == read for option in parameter.choices)
    if parameter.kind == "text":
        inside = _is_a_line(str(read))
    if not inside:
        raise OutOfRange(
            Text("The value is outside its limits.", "値が許容範囲の外です。"),
            Text.same(f"{parameter.id}={value}"),
            _describe_allowed(parameter),
        )
    return read


def _read(parameter: Parameter, value: ParameterValue) -> ParameterValue | None:
    try:
        if parameter.kind == "number":
            return float(value)
        if parameter.kind == "count":
            return value if isinstance(value, int) else int(str(value))
        if parameter.kind == "switch":
            return value if isinstance(value, bool) else ({**_YES, **_NO}).get(str(value).lower())
    except ValueError:
        return None
    return str(value)


def _is_a_line(words: str) -> bool:
    # Tables and papers take no control characters, and a line has no breaks.
    is_plain = all(unicodedata.category(letter) not in _BREAKING for letter in words)
    return is_plain and len(words) <= MOST_LETTERS


def _describe_allowed(parameter: Parameter) -> Text:
    if parameter.kind == "text":
        return Text(
            "Use one line of up to {count} letters.", "{count}文字以内の1行で指定してください。"
        ).filled(count=MOST_LETTERS)
    if parameter.kind == "choice":
        return use_one_of(option.value for option in parameter.choices)
    if parameter.kind == "switch":
        return Text("Use yes or no.", "yes または no を指定してください。")
    return Text(
        "Use {low:g} to {high:g} {unit}.", "{low:g} ～ {high:g} {unit} の値を指定してください。"
    ).filled(low=parameter.low, high=parameter.high, unit=parameter.unit)
