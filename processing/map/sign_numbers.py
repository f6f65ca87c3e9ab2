"""Legal numbers of road signs, with the plates that carry them: what is chosen from.

Numbers and names: 道路標識、区画線及び道路標示に関する命令, 別表第一; shapes, colours: 別表第二.
Variants of one number (-A, -B) are listed where they mean different things; what isn't listed can
be typed.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal, cast

from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from resources import path_of

SignClass = Literal["guide", "warning", "regulation", "instruction", "supplement"]
SignColour = Literal["blue", "green", "yellow", "red", "white"]

FIELD = "sign_number"
"""Attribute that holds the number."""

SUPPLEMENT: SignClass = "supplement"

_CODES: Mapping[SignClass, str] = {
    "guide": "2242",
    "warning": "2243",
    "regulation": "2244",
    "instruction": "2244",
}
"""Codes of road signs (公共測量標準図式, 2242-2244). Instruction signs share the code of regulatory
ones; supplementary plates go with the sign above them and have none."""

_UNCONFIRMED = "sign"
"""Kind of a sign whose number nobody has confirmed: shape alone doesn't tell its class."""


@dataclass(frozen=True)
class SignNumber:
    """A kind of road sign.

    Attributes
    ----------
    number : str
        As the order writes it: "330", "108の2", "201-A".
    sign_class : str
        Which part of the order it is in.
    shapes : tuple of str
        Of its plate, as the tool ``signs`` names them.
    colour : str
        Of the plate's ground, of its face for signs with a rim.
    name : Text
        The Japanese one is the order's.
    """

    number: str
    sign_class: SignClass
    shapes: tuple[str, ...]
    colour: SignColour
    name: Text


@cache
def sign_numbers() -> tuple[SignNumber, ...]:
    """All of them, by number."""
    lines = path_of("catalogue/sign_numbers.csv").read_text(encoding="utf-8").splitlines()
    return tuple(
        SignNumber(
            row["number"],
            cast("SignClass", row["class"]),
            tuple(row["shapes"].split()),
            cast("SignColour", row["colour"]),
            Text(row["en"], row["ja"]),
        )
        for row in csv.DictReader(lines)
    )


def numbers_for(shape: str, *, is_supplement: bool) -> Sequence[SignNumber]:
    """The signs whose plates have a shape, by number.

    Parameters
    ----------
    shape : str
        Of the plate.
    is_supplement : bool
        Whether it hangs below another sign, as only supplementary plates do; a rectangle that
        hangs alone may be any rectangular sign.
    """
    return tuple(
        one
        for one in sign_numbers()
        if shape in one.shapes and (one.sign_class == SUPPLEMENT) == is_supplement
    )


def kind_of_sign(sign_class: SignClass, catalogue: Catalogue) -> FeatureKind | None:
    """The kind of signs of a class; None where the catalogue has none with its code."""
    code = _CODES.get(sign_class)
    signs = (one for one in catalogue if code is not None and one.dm_code == code)
    return next((one for one in signs if one.geometry is Geometry.POINT), None)


def is_kind_of_signs(kind: FeatureKind) -> bool:
    """Whether features of a kind are signs whose number says their kind."""
    return kind.id == _UNCONFIRMED or kind.dm_code in _CODES.values()
