"""Kinds across catalogues: what a pasted feature's kind is called in the project it comes into."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from processing.core.errors import UNCHANGED, Unsuitable
from processing.core.text import Text
from processing.formats.vectors.geojson_shapes import WHERE, JsonObject, short
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import Feature

_SHAPES = {
    Geometry.POINT: Text("points", "点"),
    Geometry.LINE: Text("lines", "線"),
    Geometry.AREA: Text("areas", "面"),
}


@dataclass(frozen=True)
class KindDescription:
    """What a clip says of a kind, for a catalogue that may not know its id."""

    name: Text
    dm_code: str
    layer: str


def describe_kinds(features: Iterable[Feature], catalogue: Catalogue) -> JsonObject:
    """The kinds of features as JSON, by id; those that the catalogue knows."""
    used = dict.fromkeys(feature.kind for feature in features)
    return {
        id_: {
            "en": catalogue[id_].name.en,
            "ja": catalogue[id_].name.ja,
            "dm_code": catalogue[id_].dm_code,
            "layer": catalogue[id_].layer,
        }
        for id_ in used
        if id_ in catalogue
    }


def read_descriptions(kinds: object) -> dict[str, KindDescription]:
    """The kinds of :func:`describe_kinds`; what is no description is left out."""
    read = {}
    for id_, words in kinds.items() if isinstance(kinds, dict) else ():
        match words:
            case {"en": str(en), "ja": str(ja), "dm_code": str(code), "layer": str(layer)}:
                read[id_] = KindDescription(Text(short(en), short(ja)), code, layer)
    return read


class KindTally:
    """Finds the kind for each pasted feature, and counts what had to be altered.

    Parameters
    ----------
    described : mapping of str to KindDescription
        The kinds of the catalogue that features come from.
    kind_for : mapping of Geometry to str
        What shapes without a kind become.
    """

    def __init__(
        self,
        catalogue: Catalogue,
        described: Mapping[str, KindDescription],
        kind_for: Mapping[Geometry, str],
    ) -> None:
        self._catalogue = catalogue
        self._described = described
        self._kind_for = kind_for
        self._altered: Counter[tuple[str, str]] = Counter()
        self._unknown: Counter[str] = Counter()

    def kind_of(self, kind: str, geometry: Geometry) -> str:
        """The kind in the catalogue for a kind of another one; empty stands for none.

        Raises
        ------
        Unsuitable
            It has none, and none is given for its geometry.
        """
        if not kind:
            return self._choose_kind(geometry)
        if kind in self._catalogue and self._catalogue[kind].geometry is geometry:
            return kind
        nearest = self._nearest(kind, geometry)
        if nearest is None:
            self._unknown[kind] += 1
            return kind
        self._altered[kind, nearest.id] += 1
        return nearest.id

    def notes(self) -> tuple[Text, ...]:
        """What was altered, and what the catalogue doesn't know."""
        altered = [
            Text(
                "{count} features of the kind “{old}” became “{new}”, which has the same DM code "
                "{code}.",
                "種別「{old}」の地物{count}個を、同じ分類コード {code} の「{new}」にしました。",
            ).filled(
                count=f"{count:,}",
                old=self._name(old),
                new=self._catalogue[new].name,
                code=self._catalogue[new].dm_code,
            )
            for (old, new), count in self._altered.items()
        ]
        unknown = [
            Text(
                "{count} features keep their kind “{kind}”, which this project's catalogue does "
                "not have in this shape.",
                "地物{count}個の種別「{kind}」は、このプロジェクトのカタログに該当する形状では"
                "ありません。種別はそのまま残しました。",
            ).filled(count=f"{count:,}", kind=self._name(kind))
            for kind, count in self._unknown.items()
        ]
        return (*altered, *unknown)

    def _choose_kind(self, geometry: Geometry) -> str:
        chosen = self._kind_for.get(geometry)
        if chosen is None:
            raise Unsuitable(
                Text("There are {shapes} without a kind.", "種別のない{shapes}があります。").filled(
                    shapes=_SHAPES[geometry]
                ),
                WHERE,
                Text(
                    "Choose a kind drawn as {shapes} and paste again. {unchanged}",
                    "{shapes}の種別を選んでから、もう一度貼り付けてください。{unchanged}",
                ).filled(shapes=_SHAPES[geometry], unchanged=UNCHANGED),
            )
        return chosen

    def _nearest(self, kind: str, geometry: Geometry) -> FeatureKind | None:
        """Of the kinds with the same code and geometry, one of the same layer or name if any."""
        said = self._described.get(kind)
        if said is None or not said.dm_code:
            return None
        fitting = [
            one
            for one in self._catalogue
            if one.dm_code == said.dm_code and one.geometry is geometry
        ]
        return max(
            fitting,
            key=lambda one: (one.layer == said.layer, one.name.ja == said.name.ja),
            default=None,
        )

    def _name(self, kind: str) -> Text:
        said = self._described.get(kind)
        if said is not None:
            return said.name
        return self._catalogue[kind].name if kind in self._catalogue else Text.same(short(kind))
