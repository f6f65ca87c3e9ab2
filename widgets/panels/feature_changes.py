"""What panels ask for features chosen together: a change, and its line in the undo menu."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.change import Change, Replacement
from processing.map.drafting.line_edits import with_kind
from processing.map.feature import AttributeValue, Feature, Status

_STATUS_LABELS = {
    Status.ACCEPTED: (
        Text("Accept a feature", "地物を採用"),
        Text("Accept {count} features", "{count}個の地物を採用"),
    ),
    Status.REJECTED: (
        Text("Reject a feature", "地物を却下"),
        Text("Reject {count} features", "{count}個の地物を却下"),
    ),
    Status.CANDIDATE: (
        Text("Make a feature a candidate", "地物を候補に戻す"),
        Text("Make {count} features candidates", "{count}個の地物を候補に戻す"),
    ),
}
_KIND_LABELS = (
    Text("Change a feature to {kind}", "地物の種別を「{kind}」に変更"),
    Text("Change {count} features to {kind}", "{count}個の地物の種別を「{kind}」に変更"),
)
_ATTRIBUTE_LABELS = (
    Text("Change {name}", "「{name}」の変更"),
    Text("Change {name} of {count} features", "{count}個の地物の「{name}」を変更"),
)


def status_change(features: Iterable[Feature], status: Status) -> tuple[Text, Change]:
    """Features judged alike; those that are so already are left out."""
    change = _change_of(features, lambda one: one.with_status(status))
    return _label(_STATUS_LABELS[status], change), change


def kind_change(features: Iterable[Feature], kind: FeatureKind) -> tuple[Text, Change]:
    """Features made another kind of the same geometry; those that are so already are left out.

    Raises
    ------
    Unsuitable
        A feature's geometry is not that of the kind.
    """
    others = [one for one in features if one.kind != kind.id]
    change = _change_of(others, lambda one: with_kind(one, kind))
    return _label(_KIND_LABELS, change, kind=kind.name), change


def attribute_change(
    features: Iterable[Feature],
    id_: str,
    name: Text,
    value: AttributeValue,
    *,
    implied: Mapping[str, AttributeValue] | None = None,
    implied_kind: FeatureKind | None = None,
) -> tuple[Text, Change]:
    """An attribute set to one value, and what it implies; None takes it away."""

    def changed(feature: Feature) -> Feature:
        attributes = {**feature.attributes, **(implied or {}), id_: value}
        if value is None:
            del attributes[id_]
        said = replace(feature, attributes=attributes)
        return said if implied_kind is None else with_kind(said, implied_kind)

    change = _change_of(features, changed)
    return _label(_ATTRIBUTE_LABELS, change, name=name), change


def kinds_for(features: Iterable[Feature], catalogue: Catalogue) -> tuple[FeatureKind, ...]:
    """The kinds that all of the features can be; none for features of several geometries."""
    geometries: set[Geometry] = {feature.geometry for feature in features}
    return tuple(kind for kind in catalogue if {kind.geometry} == geometries)


def _change_of(features: Iterable[Feature], changed: Callable[[Feature], Feature]) -> Change:
    pairs = ((feature, changed(feature)) for feature in features)
    return Change(replaced=tuple(Replacement(a, b) for a, b in pairs if a != b))


def _label(labels: tuple[Text, Text], change: Change, **words: object) -> Text:
    count = len(change.replaced)
    return labels[count != 1].filled(count=f"{count:,}", **words)
