"""What a review decides: the changes of the map, their names, and what belongs to one line."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

from processing.core.text import Text
from processing.map.catalogue import Catalogue
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Status

_LINE = "run"
"""The attribute by which lids of one gutter, and the two edges of one curb, belong together."""

_ONE = {
    Status.ACCEPTED: Text("Accept {kind}", "「{kind}」を採用"),
    Status.REJECTED: Text("Reject {kind}", "「{kind}」を却下"),
}
_ALL_OF_LINE = {
    Status.ACCEPTED: Text("Accept {kind}: {count} of one line", "一連の「{kind}」{count}件を採用"),
    Status.REJECTED: Text("Reject {kind}: {count} of one line", "一連の「{kind}」{count}件を却下"),
}
_ACCEPT_ABOVE = Text(
    "Accept {count} candidates from confidence {least} up", "信頼度{least}以上の候補{count}件を採用"
)


class FeatureLines:
    """Which features a tool gave as one line.

    Parameters
    ----------
    features : iterable of Feature
    """

    def __init__(self, features: Iterable[Feature] = ()) -> None:
        self._members: dict[tuple[str, object], list[str]] = defaultdict(list)
        self._lines: dict[str, tuple[str, object]] = {}
        for feature in features:
            number = feature.attributes.get(_LINE)
            if number is not None:
                line = feature.provenance.run, number
                self._members[line].append(feature.id)
                self._lines[feature.id] = line

    def beside(self, id_: str) -> tuple[str, ...]:
        """Ids of all of a feature's line, itself among them; none where it is of no line."""
        line = self._lines.get(id_)
        return () if line is None else tuple(self._members[line])


def change_status(features: Iterable[Feature], status: Status) -> Change:
    """The change by which features get a status from somebody who looks at them."""
    return Change(replaced=tuple(Replacement(one, one.with_status(status)) for one in features))


def accept_unseen(features: Iterable[Feature]) -> Change:
    """The change by which features are accepted for their confidence, which they go on saying."""
    return Change(
        replaced=tuple(
            Replacement(one, one.with_status(Status.ACCEPTED, unseen=True)) for one in features
        )
    )


def label_of_one(catalogue: Catalogue, feature: Feature, status: Status) -> Text:
    """What the undo menu calls the decision about one feature."""
    return _ONE[status].filled(kind=_name(catalogue, feature))


def label_of_line(catalogue: Catalogue, feature: Feature, count: int, status: Status) -> Text:
    """What it calls the decision about a feature and its line."""
    return _ALL_OF_LINE[status].filled(kind=_name(catalogue, feature), count=f"{count:,}")


def label_of_many(count: int, least: float) -> Text:
    """What it calls agreeing to all from a confidence up."""
    return _ACCEPT_ABOVE.filled(count=f"{count:,}", least=f"{least:.2f}")


def _name(catalogue: Catalogue, feature: Feature) -> Text:
    kind = feature.kind
    return catalogue[kind].name if kind in catalogue else Text.same(kind)
