"""Another catalogue for a map: what changes, and what keeps it from losing a kind it uses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from processing.core.errors import UNCHANGED, Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.feature import Feature

_MOST_KINDS_TOLD = 8


@dataclass(frozen=True)
class CatalogueComparison:
    """What a new catalogue changes for a map.

    Attributes
    ----------
    added, removed : tuple of FeatureKind
        Kinds that only the new one, only the old one has.
    changed : tuple of FeatureKind
        Kinds that both have and that differ, as the new one has them.
    used_missing : mapping of str to int
        Ids of removed kinds that features use, with the number of these features.
    used_reshaped : mapping of str to int
        Ids of kinds whose geometry in the new catalogue is not that of features which it fits
        now, or which no catalogue knew; with their number.
    """

    added: tuple[FeatureKind, ...]
    removed: tuple[FeatureKind, ...]
    changed: tuple[FeatureKind, ...]
    used_missing: Mapping[str, int]
    used_reshaped: Mapping[str, int]

    @property
    def loses_nothing(self) -> bool:
        """Whether the new catalogue can be taken as it is."""
        return not self.used_missing and not self.used_reshaped

    def texts(self) -> tuple[Text, ...]:
        """What is to be said, a line for each thing; empty when nothing changes."""
        lines = (
            (
                _name_kinds(self.added),
                Text("New kinds: {kinds}", "追加される種別: {kinds}"),
            ),
            (
                _name_kinds(self.changed),
                Text("Changed kinds: {kinds}", "変更される種別: {kinds}"),
            ),
            (
                _name_kinds(kind for kind in self.removed if kind.id not in self.used_missing),
                Text("Kinds that go, used by nothing: {kinds}", "なくなる未使用の種別: {kinds}"),
            ),
            (
                self._missing(),
                Text(
                    "Missing kinds that features use: {kinds}",
                    "使用中で新カタログにない種別: {kinds}",
                ),
            ),
            (
                self._describe_reshaped(),
                Text(
                    "Kinds of another geometry than their features: {kinds}",
                    "地物と形状の種類が異なる種別: {kinds}",
                ),
            ),
        )
        return tuple(line.filled(kinds=kinds) for kinds, line in lines if kinds is not None)

    def refuse_losses(self, path: Path, *, keep_used: bool) -> None:
        """Refuse a catalogue that features of the map would lose their kind with.

        Parameters
        ----------
        path : Path
            Of the new catalogue, for the message.
        keep_used : bool
            Missing kinds will be kept.

        Raises
        ------
        Unsuitable
            Names the kinds with the number of features of each.
        """
        where = Text.same(str(path))
        reshaped = self._describe_reshaped()
        if reshaped is not None:
            raise Unsuitable(
                Text(
                    "The catalogue gives another geometry to kinds that are drawn: {kinds}.",
                    "使用中の種別の形状（点・線・面）が変わっています: {kinds}。",
                ).filled(kinds=reshaped),
                where,
                Text(
                    "Give these kinds their geometry back, or a new kind another id. {unchanged}",
                    "形状を元に戻すか、別のidで新しい種別を作ってください。{unchanged}",
                ).filled(unchanged=UNCHANGED),
            )
        missing = self._missing()
        if missing is not None and not keep_used:
            raise Unsuitable(
                Text(
                    "The catalogue lacks kinds that are drawn: {kinds}.",
                    "使用中の種別がカタログにありません: {kinds}。",
                ).filled(kinds=missing),
                where,
                Text(
                    "Keep these kinds in this project, or add them to the file. {unchanged}",
                    "これらの種別をこのプロジェクトに残すか、ファイルに追加してください。"
                    "{unchanged}",
                ).filled(unchanged=UNCHANGED),
            )

    def _missing(self) -> Text | None:
        return _write_counts(self.used_missing, {kind.id: kind.name for kind in self.removed})

    def _describe_reshaped(self) -> Text | None:
        names = {kind.id: kind.name for kind in (*self.added, *self.changed)}
        return _write_counts(self.used_reshaped, names)


def compare(old: Catalogue, new: Catalogue, features: Iterable[Feature]) -> CatalogueComparison:
    """What a new catalogue changes for a map.

    Parameters
    ----------
    features : iterable of Feature
        All of the map, rejected ones too.
    """
    used = Counter((feature.kind, feature.geometry) for feature in features)
    missing: Counter[str] = Counter()
    reshaped: Counter[str] = Counter()
    for (kind, geometry), count in used.items():
        if kind not in new:
            # A kind that the old one lacks too is no worse off.
            missing[kind] += count if kind in old else 0
        elif new[kind].geometry is not geometry:
            was_as_unfit = kind in old and old[kind].geometry is new[kind].geometry
            reshaped[kind] += 0 if was_as_unfit else count
    return CatalogueComparison(
        added=tuple(kind for kind in new if kind.id not in old),
        removed=tuple(kind for kind in old if kind.id not in new),
        changed=tuple(kind for kind in new if kind.id in old and old[kind.id] != kind),
        used_missing=dict(+missing),
        used_reshaped=dict(+reshaped),
    )


def keep_used_kinds(new: Catalogue, comparison: CatalogueComparison) -> Catalogue:
    """The new catalogue and, behind its own kinds, those of the old one that features use.

    A number key that the new one gives to a kind of its own stays there.
    """
    taken = {kind.key for kind in new}
    kept = [
        replace(kind, key="" if kind.key in taken else kind.key)
        for kind in comparison.removed
        if kind.id in comparison.used_missing
    ]
    return Catalogue((*new.kinds, *kept)) if kept else new


def _name_kinds(kinds: Iterable[FeatureKind]) -> Text | None:
    return _list_names([kind.name for kind in kinds])


def _write_counts(counts: Mapping[str, int], names: Mapping[str, Text]) -> Text | None:
    """``Curb (214), Sign (3)``, most first; None for nothing."""
    ordered = sorted(counts, key=lambda id_: (-counts[id_], id_))
    return _list_names(
        [
            Text("{name} ({count})", "{name}（{count}）").filled(
                name=names.get(id_, Text.same(id_)), count=f"{counts[id_]:,}"
            )
            for id_ in ordered
        ]
    )


def _list_names(names: list[Text]) -> Text | None:
    if not names:
        return None
    reported, rest = names[:_MOST_KINDS_TOLD], len(names) - _MOST_KINDS_TOLD
    en, ja = ", ".join(name.en for name in reported), "、".join(name.ja for name in reported)
    return Text(f"{en} and {rest} more", f"{ja} ほか{rest}種別") if rest > 0 else Text(en, ja)
