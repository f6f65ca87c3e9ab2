"""Catalogue: the list of feature kinds that a map may hold, how they are drawn and handed in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Literal

from processing.core.text import Text


class Geometry(Enum):
    """The shape of a feature."""

    POINT = "point"
    LINE = "line"
    AREA = "area"


AttributeType = Literal["text", "number", "count", "choice", "date"]

LINE_TYPES: Mapping[str, tuple[float, ...]] = {
    "continuous": (),
    "dashed": (1.5, -0.75),
    "short_dashed": (0.7, -0.6),
    "gutter_dashed": (1.6, -0.55),
    "long_dashed": (2.5, -0.6),
    "boundary": (1.3, -1.15),
    "dotted": (0.25, -0.25),
    "dash_dot": (2.0, -0.5, 0.25, -0.5),
    "dash_two_dots": (2.0, -0.5, 0.25, -0.5, 0.25, -0.5),
}
"""Patterns of lines: dash and gap (negative) in metres on the ground, drawn for 1:500."""

CHANGE_KIND = "map_change"
"""The kind as which changes since the last map are drawn: about the map, and no part of it."""

RESERVED_ATTRIBUTES = frozenset(
    {"id", "kind", "status", "confidence", "tool", "fid", "geom", "geometry"}
)
"""Names that every feature has anyway, or that a file format needs for itself."""


@dataclass(frozen=True)
class AttributeField:
    """What a feature of a kind can say about itself.

    Attributes
    ----------
    id : str
        Key in ``Feature.attributes``; carries its unit (``height_m``).
    type : {"text", "number", "count", "choice", "date"}
        ``number`` is a float, ``count`` an int from 0, ``choice`` one of ``choices``, ``date`` a
        text ``YYYY-MM-DD``.
    unit : str
        As it is printed; empty without one.
    choices : tuple of str
        The values of a ``choice`` as they are stored.
    choice_names : tuple of Text
        What each of ``choices`` is called; as long as they are.
    """

    id: str
    name: Text
    type: AttributeType
    unit: str = ""
    choices: tuple[str, ...] = ()
    choice_names: tuple[Text, ...] = ()

    def name_of_choice(self, value: str) -> Text:
        """What a value is called; the value itself where it is none of the choices."""
        names = dict(zip(self.choices, self.choice_names, strict=False))
        return names.get(value, Text.same(value))


@dataclass(frozen=True)
class FeatureKind:
    """What a feature is, and how such features are drawn.

    Attributes
    ----------
    dm_code : str
        Class code of the extended DM, four digits; empty where the standard has none.
    layer : str
        Layer of the DXF, ``2101_道路縁``.
    colour : str
        ``#rrggbb``.
    aci : int
        The AutoCAD colour index nearest to ``colour``, 1 to 255.
    line_type : str
        Key of :data:`LINE_TYPES`.
    symbol : str
        Name of ``resources/symbols/<symbol>.svg`` for points; empty without one.
    key : str
        The number key that chooses the kind, or empty.
    thickness_m : float
        Of areas that are the top of a body, such as lids: what is usual; 0 for areas without one.
    """

    id: str
    name: Text
    geometry: Geometry
    dm_code: str
    layer: str
    colour: str
    aci: int
    line_type: str = "continuous"
    symbol: str = ""
    attributes: tuple[AttributeField, ...] = ()
    key: str = ""
    thickness_m: float = 0.0

    def attribute(self, id: str) -> AttributeField | None:  # noqa: A002 (the field's own name)
        """The attribute with this id, or None."""
        return next((one for one in self.attributes if one.id == id), None)


@dataclass(frozen=True)
class Catalogue:
    """The kinds in the order of the file; looked up by id.

    Raises
    ------
    KeyError
        From ``catalogue[id]`` for an id that no kind has.
    """

    kinds: tuple[FeatureKind, ...]
    _by_id: Mapping[str, FeatureKind] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_by_id", {kind.id: kind for kind in self.kinds})

    def __getitem__(self, id: str) -> FeatureKind:  # noqa: A002 (what it is)
        return self._by_id[id]

    def __contains__(self, id: object) -> bool:  # noqa: A002 (what it is)
        return id in self._by_id

    def __iter__(self) -> Iterator[FeatureKind]:
        return iter(self.kinds)

    def __len__(self) -> int:
        return len(self.kinds)

    def of_layer(self, layer: str) -> tuple[FeatureKind, ...]:
        """The kinds drawn on a layer."""
        return tuple(kind for kind in self.kinds if kind.layer == layer)

    def of_key(self, key: str) -> FeatureKind | None:
        """The kind that a number key chooses, or None."""
        return next((kind for kind in self.kinds if key and kind.key == key), None)
