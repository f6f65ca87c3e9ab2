"""ViewSettings: how points and features are shown, shared by all views."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from processing.image.attributes.attributes import SHOWS_LABELS
from processing.map.feature import Feature, Status
from processing.recording.kinds import ImageKind
from widgets.shared.image_orientation import ImageOrientation


@dataclass(frozen=True)
class PointStyle:
    """How points are coloured.

    Attributes
    ----------
    attribute : str
        A key of :data:`processing.image.attributes.attributes.ATTRIBUTES`.
    low_percent, high_percent : float
        Percentiles of the drive that become the dark and the bright end.
    point_size_px : float
        Size of a point in 3D.
    hides_noise : bool
        Points whose class is noise are not there: they are neither drawn nor picked.
    """

    attribute: str = "toned"
    low_percent: float = 2.0
    high_percent: float = 98.0
    point_size_px: float = 2.0
    hides_noise: bool = False

    @property
    def follows_labels(self) -> bool:
        """Whether what is drawn depends on the labels of points."""
        return self.hides_noise or self.attribute in SHOWS_LABELS


class ViewSettings(QObject):
    """What is shown and how; setting what is already set emits nothing."""

    look_changed = Signal(object)  # PointStyle
    image_changed = Signal()  # another drive or another kind of image
    image_orientation_changed = Signal()
    hidden_kinds_changed = Signal()
    hidden_runs_changed = Signal()
    hidden_drives_changed = Signal()
    shows_rejected_changed = Signal()
    shown_features_changed = Signal()  # what `shows` says, for whichever reason

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._look = PointStyle()
        self._drive_id = ""
        self._image_kind = ImageKind.TRAJECTORY_CENTER
        self._hidden_kinds: frozenset[str] = frozenset()
        self._hidden_runs: frozenset[str] = frozenset()
        self._hidden_drives: frozenset[str] = frozenset()
        self._shows_rejected = False
        self._image_orientation = ImageOrientation()

    @property
    def look(self) -> PointStyle:
        """How points are coloured."""
        return self._look

    @property
    def drive_id(self) -> str:
        """The drive that the image view shows; empty when none."""
        return self._drive_id

    @property
    def image_kind(self) -> ImageKind:
        """The kind of point-cloud image shown."""
        return self._image_kind

    @property
    def image_orientation(self) -> ImageOrientation:
        """Which way the street runs in the image."""
        return self._image_orientation

    @property
    def hidden_kinds(self) -> frozenset[str]:
        """Feature kinds that are not drawn."""
        return self._hidden_kinds

    @property
    def hidden_runs(self) -> frozenset[str]:
        """Ids of runs whose features are not drawn."""
        return self._hidden_runs

    @property
    def hidden_drives(self) -> frozenset[str]:
        """Ids of drives that views of all drives leave out; an image shows its own in any case."""
        return self._hidden_drives

    @property
    def shows_rejected(self) -> bool:
        """Whether rejected features are drawn, thin and grey."""
        return self._shows_rejected

    def shows(self, feature: Feature) -> bool:
        """Whether a feature is drawn: not if its kind or run is hidden, or it was rejected."""
        if feature.kind in self._hidden_kinds or feature.provenance.run in self._hidden_runs:
            return False
        return self._shows_rejected or feature.status is not Status.REJECTED

    def change_look(
        self,
        *,
        attribute: str | None = None,
        low_percent: float | None = None,
        high_percent: float | None = None,
        point_size_px: float | None = None,
        hides_noise: bool | None = None,
    ) -> None:
        """Set some fields of the look; None leaves one as it is."""
        old = self._look
        look = PointStyle(
            old.attribute if attribute is None else attribute,
            old.low_percent if low_percent is None else low_percent,
            old.high_percent if high_percent is None else high_percent,
            old.point_size_px if point_size_px is None else point_size_px,
            old.hides_noise if hides_noise is None else hides_noise,
        )
        if look != self._look:
            self._look = look
            self.look_changed.emit(look)

    def show_image(self, drive_id: str, kind: ImageKind) -> None:
        """Show one drive's image of one kind."""
        if (drive_id, kind) != (self._drive_id, self._image_kind):
            self._drive_id, self._image_kind = drive_id, kind
            self.image_changed.emit()

    def orient_image(self, orientation: ImageOrientation) -> None:
        """Let the street run this way in the image."""
        if orientation != self._image_orientation:
            self._image_orientation = orientation
            self.image_orientation_changed.emit()

    def hide_kinds(self, kinds: frozenset[str]) -> None:
        """Hide exactly these feature kinds."""
        if kinds != self._hidden_kinds:
            self._hidden_kinds = kinds
            self.hidden_kinds_changed.emit()
            self.shown_features_changed.emit()

    def hide_drives(self, drives: frozenset[str]) -> None:
        """Leave exactly these drives out of the views that show all of them."""
        if drives != self._hidden_drives:
            self._hidden_drives = drives
            self.hidden_drives_changed.emit()

    def set_shows_rejected(self, wanted: bool) -> None:  # noqa: FBT001 - a slot of a checked action
        """Draw rejected features, or don't."""
        if wanted != self._shows_rejected:
            self._shows_rejected = wanted
            self.shows_rejected_changed.emit()
            self.shown_features_changed.emit()

    def hide_runs(self, runs: frozenset[str]) -> None:
        """Hide the features of exactly these runs."""
        if runs != self._hidden_runs:
            self._hidden_runs = runs
            self.hidden_runs_changed.emit()
            self.shown_features_changed.emit()
