"""Legal numbers of road signs, with the plates that carry them: what is chosen from.

Numbers and names: 道路標識、区画線及び道路標示に関する命令, 別表第一; shapes, colours: 別表第二.
Variants of one number (-A, -B) are listed where they mean different things; what isn't listed can
be typed.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, cast

from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.plate_colours import SignColour
from resources import path_of

SignClass = Literal["guide", "warning", "regulation", "instruction", "supplement"]
RimColour = Literal["red", "black", "white", "blue"]

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

_LARGEST_M: Mapping[str, float] = {
    "circle": 1.2,
    "square": 1.8,
    "rectangle": 1.8,
    "triangle": 1.6,
    "pentagon": 1.2,
    "diamond": 1.2,
}
"""Diameter or side at the largest scale, 2.0 (Takahashi 2022, Table 8-1; 別表第二)."""

_SIZE_WITHIN = 1.1
"""Sizes are measured within a tenth."""

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
    rim : str or None
        Colour of the rim; None where it has the ground's.
    name : Text
        The Japanese one is the order's.
    """

    number: str
    sign_class: SignClass
    shapes: tuple[str, ...]
    colour: SignColour
    rim: RimColour | None
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
            cast("RimColour", row["rim"]) if row["rim"] else None,
            Text(row["en"], row["ja"]),
        )
        for row in csv.DictReader(lines)
    )


@dataclass(frozen=True)
class PlateLook:
    """What is known of a plate whose number is asked for.

    Attributes
    ----------
    shape : str
        Empty where it isn't known: any.
    is_supplement : bool
        Whether it hangs below another sign, as only supplementary plates do; a rectangle that
        hangs alone may be any rectangular sign.
    size_m : float
        Diameter or side; NaN where it isn't known.
    colour : SignColour or None
        Of the ground; None where it isn't known.
    """

    shape: str = ""
    is_supplement: bool = False
    size_m: float = math.nan
    colour: SignColour | None = None


@dataclass(frozen=True)
class OfferedNumbers:
    """Signs that a plate may be, each by number.

    Attributes
    ----------
    likely : tuple of SignNumber
        Of its shape, size and colour.
    unlikely : tuple of SignNumber
        Of its shape alone: colours fade, and sizes are measured.
    others : tuple of SignNumber
        Of other shapes.
    """

    likely: tuple[SignNumber, ...]
    unlikely: tuple[SignNumber, ...] = ()
    others: tuple[SignNumber, ...] = ()


def offered_numbers(look: PlateLook) -> OfferedNumbers:
    """All signs, those first that look like a plate; all are likely where no shape is known."""
    if not look.shape:
        return OfferedNumbers(sign_numbers())
    of_shape = numbers_for(look.shape, is_supplement=look.is_supplement)
    others = tuple(one for one in sign_numbers() if one not in of_shape)
    likely = tuple(one for one in of_shape if _is_of_size(one, look) and _is_of_colour(one, look))
    if not likely:
        return OfferedNumbers(of_shape, others=others)
    return OfferedNumbers(likely, tuple(one for one in of_shape if one not in likely), others)


def _is_of_size(sign: SignNumber, look: PlateLook) -> bool:
    """Only guide signs are of any size; others have a largest one (別表第二: at most doubled)."""
    largest = math.inf if sign.sign_class == "guide" else _LARGEST_M[look.shape]
    return math.isnan(look.size_m) or look.size_m <= largest * _SIZE_WITHIN


def _is_of_colour(sign: SignNumber, look: PlateLook) -> bool:
    return look.colour is None or sign.colour == look.colour


def numbers_for(shape: str, *, is_supplement: bool) -> tuple[SignNumber, ...]:
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
