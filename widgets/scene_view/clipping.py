"""Clipping: which part of space the 3D view shows, as the user chose it."""

from __future__ import annotations

from enum import Enum

import numpy as np
from PySide6.QtCore import QObject, Signal

from processing.core.arrays import Floats
from processing.image.search.clip import Clip
from processing.image.search.corridor import Corridor, CorridorExtent
from processing.recording.drive import Drive
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

MARGIN_M = 2.0
"""How much is shown around what is chosen."""


class ClipChoice(Enum):
    """What the shown part of space belongs to."""

    EVERYTHING = "everything"
    DRIVE = "drive"
    SELECTION = "selection"
    SECTION = "section"


class Clipping(QObject):
    """Makes a clip of the user's choice, and makes it anew when what it belongs to changes.

    A clip around the selection stays where it was made.

    Parameters
    ----------
    source : MapSource
    shared : SharedState

    Signals
    -------
    changed()
        Another part of space is to be shown.
    """

    changed = Signal()

    def __init__(
        self, source: MapSource, shared: SharedState, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._shared = shared
        self._choice = ClipChoice.EVERYTHING
        self._slab = CorridorExtent()
        self._section: Floats | None = None
        self._clip: Clip | None = None
        shared.view_settings.image_changed.connect(self._on_settings_image_changed)
        shared.map_changes.drives_changed.connect(self.show_everything)

    @property
    def clip(self) -> Clip | None:
        """What is shown; None: everything."""
        return self._clip

    @property
    def choice(self) -> ClipChoice:
        """What was chosen."""
        return self._choice

    @property
    def slab(self) -> CorridorExtent:
        """How far the shown part reaches around the drive."""
        return self._slab

    def can_choose(self, choice: ClipChoice) -> bool:
        """Whether there is something to clip to."""
        if choice is ClipChoice.DRIVE:
            return self._drive() is not None
        if choice is ClipChoice.SELECTION:
            return self._chosen_positions() is not None
        return choice is ClipChoice.EVERYTHING or self._section is not None

    def choose(self, choice: ClipChoice) -> None:
        """Clip to this; without effect where there is nothing to clip to."""
        if not self.can_choose(choice):
            return
        drive, positions, section = self._drive(), self._chosen_positions(), self._section
        clip = None
        if choice is ClipChoice.DRIVE and drive is not None:
            clip = Clip(corridor=Corridor(drive, self._slab))
        elif choice is ClipChoice.SELECTION and positions is not None:
            clip = Clip.around(positions, MARGIN_M)
        elif choice is ClipChoice.SECTION and section is not None:
            clip = Clip.upright(section)
        self._take(choice, clip)

    def show_everything(self) -> None:
        """Clip nothing off."""
        self._take(ClipChoice.EVERYTHING, None)

    def set_slab(self, slab: CorridorExtent) -> None:
        """Reach so far around the drive, from now on."""
        if slab != self._slab:
            self._slab = slab
            if self._choice is ClipChoice.DRIVE:
                self.choose(ClipChoice.DRIVE)

    def know_section(self, outline: Floats | None) -> None:
        """Tell where the section is; None when there is none.

        Parameters
        ----------
        outline : (k, 2) float64 or None
            Easting and northing of its corners, m, anticlockwise.
        """
        self._section = outline
        if self._choice is ClipChoice.SECTION:
            self.choose(ClipChoice.SECTION if outline is not None else ClipChoice.EVERYTHING)

    def _take(self, choice: ClipChoice, clip: Clip | None) -> None:
        before = self._choice, self._clip
        self._choice, self._clip = choice, clip
        if before != (choice, clip):
            self.changed.emit()

    def _on_settings_image_changed(self) -> None:
        if self._choice is ClipChoice.DRIVE:
            self.choose(ClipChoice.DRIVE if self._drive() is not None else ClipChoice.EVERYTHING)

    def _drive(self) -> Drive | None:
        """The drive that the image shows, if it has a trajectory, or else the first that has."""
        drives = [drive for drive in self._source.drives() if drive.trajectory is not None]
        wanted = self._shared.view_settings.drive_id
        return next((drive for drive in drives if drive.id == wanted), next(iter(drives), None))

    def _chosen_positions(self) -> Floats | None:
        """(n, 3): vertices of the chosen features, or chosen points, or the cursor."""
        selection, cursor = self._shared.selection, self._shared.cursor.position
        features = [self._source.feature(id_) for id_ in selection.features]
        positions = [vertex.xyz for one in features if one is not None for vertex in one.vertices]
        if positions:
            return np.array(positions)
        drives = {drive.id: drive for drive in self._source.drives()}
        measured = [
            drives[id_].xyz(points)
            for id_, points in selection.points.items()
            if id_ in drives and points.size
        ]
        if measured:
            return np.concatenate(measured)
        return None if cursor is None else np.array([cursor.xyz])
