"""What stands on every paper of a work: names, dates, reference system, heights, software."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date
from functools import lru_cache

from processing.core.text import Text

SOFTWARE = "Zuka"
PASS, FAIL = Text("Pass", "合格"), Text("Fail", "不合格")
NOTHING = Text.same("—")

_ROMAN = {"I": 1, "V": 5, "X": 10}
_ZONE = re.compile(r"(.+) / Japan Plane Rectangular CS ([IVX]+)")


@dataclass(frozen=True)
class WorkFacts:
    """A work as its papers name it; what is empty leaves a blank to be filled in by hand.

    Attributes
    ----------
    work, place : str
        Name of the work (工事名), and which part of it is meant (測点, 施工箇所).
    client, contractor, surveyor : str
        発注者, 受注者, 測定者.
    crs : str
        ``EPSG:n``, or empty when unknown.
    height_datum : str
        What heights count from: JGD2011, JGD2024 …
    version : str
        Of the software.
    made_on : date
        The day on the paper.
    """

    work: str = ""
    place: str = ""
    client: str = ""
    contractor: str = ""
    surveyor: str = ""
    crs: str = ""
    height_datum: str = ""
    version: str = ""
    made_on: date = date.min

    @property
    def software(self) -> str:
        """Name and version."""
        return f"{SOFTWARE} {self.version}".strip()


@dataclass(frozen=True)
class SideFacts:
    """One of two surfaces, or the design: where it comes from.

    Attributes
    ----------
    name : str
        What people call it.
    source : str
        Name of its file, or of its files.
    measured_on : date or None
        None for a design, or where it is not known.
    count : int or None
        Points of the ground, or triangles.
    counts_triangles : bool
        Whether ``count`` is of triangles.
    """

    name: str
    source: str = ""
    measured_on: date | None = None
    count: int | None = None
    counts_triangles: bool = False


def day(value: date | None) -> Text:
    """A date as forms write it; a dash where there is none."""
    if value is None or value == date.min:
        return NOTHING
    return Text(value.isoformat(), f"{value.year}年{value.month}月{value.day}日")


def format_count(side: SideFacts) -> Text:
    """How many points or triangles a surface has."""
    if side.count is None:
        return NOTHING
    if side.counts_triangles:
        return Text(f"{side.count:,} triangles", f"三角形 {side.count:,} 面")
    return Text(f"{side.count:,} points", f"{side.count:,} 点")


@lru_cache(maxsize=8)
def crs_words(crs: str) -> Text:
    """A reference system as people name it; a dash where it is unknown."""
    if not crs:
        return NOTHING
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        name = CRS.from_user_input(crs).name
    except CRSError:
        return Text.same(crs)
    found = _ZONE.fullmatch(name)
    if found is None:
        return Text.same(f"{name} ({crs})")
    zone = _number(found[2])
    return Text(f"{name} ({crs})", f"平面直角座標系 第{zone}系（{found[1]}、{crs}）")


def format_signed(value: float, digits: int) -> str:
    """A number with its sign, with a true minus; zero has none."""
    words = f"{value:+,.{digits}f}"
    if float(words.replace(",", "")) == 0.0:
        return words[1:]
    return words.replace("-", "−")


def _number(roman: str) -> int:
    values = [_ROMAN[letter] for letter in roman]
    return sum(
        -value if any(value < later for later in values[position + 1 :]) else value
        for position, value in enumerate(values)
    )
