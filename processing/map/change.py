"""Change: what becomes of features and of points' labels, as a value with an inverse.

Every edit is one, undo is the inverse sent the same way, and history is a list of them.
"""

from __future__ import annotations

from dataclasses import dataclass

from processing.map.feature import Feature
from processing.map.filed_labels import FiledLabels
from processing.map.label_change import LabelChange


@dataclass(frozen=True)
class Replacement:
    """A feature before and after; both have the same id."""

    before: Feature
    after: Feature


@dataclass(frozen=True)
class ListedDrive:
    """A drive as the project lists it.

    Attributes
    ----------
    id : str
    position : int
        By which drives are in their order.
    folder : str
        Name of its folder.
    """

    id: str
    position: int
    folder: str


@dataclass(frozen=True)
class Change:
    """Features added, replaced and removed, points labelled, drives removed, in one step.

    A feature is named at most once in a change, and a point too.

    Attributes
    ----------
    filed : FiledLabels or None
        Labels of many points, in place of ``labels``.
    removed_drives, restored_drives : tuple of ListedDrive
        Drives that leave the project, or come back; their folders stay until it is closed.
    """

    added: tuple[Feature, ...] = ()
    replaced: tuple[Replacement, ...] = ()
    removed: tuple[Feature, ...] = ()
    labels: tuple[LabelChange, ...] = ()
    filed: FiledLabels | None = None
    removed_drives: tuple[ListedDrive, ...] = ()
    restored_drives: tuple[ListedDrive, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether nothing changes."""
        is_labelling = self.labels or (self.filed is not None and self.filed.parts)
        lists_drives = self.removed_drives or self.restored_drives
        return not (self.added or self.replaced or self.removed or is_labelling or lists_drives)

    @property
    def feature_ids(self) -> tuple[str, ...]:
        """The ids of all features it touches."""
        return (
            *(feature.id for feature in self.added),
            *(pair.after.id for pair in self.replaced),
            *(feature.id for feature in self.removed),
        )

    def inverse(self) -> Change:
        """The change that takes this one back."""
        return Change(
            added=self.removed,
            replaced=tuple(Replacement(pair.after, pair.before) for pair in self.replaced),
            removed=self.added,
            labels=tuple(one.inverse() for one in self.labels),
            filed=None if self.filed is None else self.filed.inverse(),
            removed_drives=self.restored_drives,
            restored_drives=self.removed_drives,
        )
