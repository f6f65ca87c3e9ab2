"""Change: what becomes of features and of points' labels, as a value with an inverse.

Every edit is one, undo is the inverse sent the same way, and history is a list of them.
"""

from __future__ import annotations

from dataclasses import dataclass

from processing.map.feature import Feature
from processing.map.filed_labels import FiledLabels
from processing.map.label_change import LabelChange
from processing.map.step_files import StepFiles


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
class SystemChange:
    """The project's reference system before and after: ``EPSG:n``, or empty when unknown."""

    before: str
    after: str


@dataclass(frozen=True)
class Change:
    """Features, labels, drives and files of a project that become others in one step.

    A feature is named at most once in a change, and a point too.

    Attributes
    ----------
    filed : FiledLabels or None
        Labels of many points, in place of ``labels``.
    removed_drives, restored_drives : tuple of ListedDrive
        Drives that leave the project, and that come or come back. One that gets another folder is
        in both. Folders of drives stay until the project is closed, and longer where a step that
        was taken back could bring them again.
    files : StepFiles or None
        Columns of drives, lists of images, volumes.
    system : SystemChange or None
        What the first drive says of all coordinates.
    """

    added: tuple[Feature, ...] = ()
    replaced: tuple[Replacement, ...] = ()
    removed: tuple[Feature, ...] = ()
    labels: tuple[LabelChange, ...] = ()
    filed: FiledLabels | None = None
    removed_drives: tuple[ListedDrive, ...] = ()
    restored_drives: tuple[ListedDrive, ...] = ()
    files: StepFiles | None = None
    system: SystemChange | None = None

    @property
    def is_empty(self) -> bool:
        """Whether nothing changes."""
        is_labelling = self.labels or (self.filed is not None and self.filed.parts)
        is_on_map = self.added or self.replaced or self.removed
        return not (is_on_map or is_labelling or self.drive_ids or self.files)

    @property
    def drive_ids(self) -> tuple[str, ...]:
        """The ids of all drives that come, go or get another folder."""
        listed = (*self.removed_drives, *self.restored_drives)
        return tuple(dict.fromkeys(one.id for one in listed))

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
            files=None if self.files is None else self.files.inverse(),
            system=None
            if self.system is None
            else SystemChange(self.system.after, self.system.before),
        )
