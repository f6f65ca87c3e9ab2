"""ShownDrives: which drives are in the scene, and from where one looks at them."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.scene_view.rendering import overviews
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.shared.map_source import MapSource
from widgets.shared.view_settings import ViewSettings


class ShownDrives:
    """The document's drives, but for hidden ones, as they were when it was asked last.

    Parameters
    ----------
    source : MapSource
    settings : ViewSettings

    Attributes
    ----------
    origin : (3,) float64
        The view's local origin, m, project CRS.
    with_kinds : tuple of (Drive, ImageKind)
        With the kind of image whose tiles are drawn: the image view's, where a drive has it.
    """

    def __init__(self, source: MapSource, settings: ViewSettings) -> None:
        self._source = source
        self._settings = settings
        self.origin: Floats = np.zeros(3)
        self.with_kinds: tuple[tuple[Drive, ImageKind], ...] = ()
        self._ways: dict[str, Floats | None] = {}

    def read(self) -> bool:
        """Ask the document again; says whether other tiles are to be drawn."""
        before = self.with_kinds, self.origin.tolist()
        wanted = self._settings.image_kind
        self.origin = self._source.origin()
        self.with_kinds = tuple(
            (drive, wanted if wanted in drive.image_kinds else drive.image_kinds[0])
            for drive in self._source.drives()
            if drive.count and drive.id not in self._settings.hidden_drives
        )
        is_other = before != (self.with_kinds, self.origin.tolist())
        if is_other:
            self._ways.clear()
        return is_other

    def overview(self) -> SceneCamera | None:
        """Along the drive from its beginning; where no trajectory is, obliquely at everything."""
        vehicle_path = self._way()
        if vehicle_path is not None:
            return overviews.along_path(vehicle_path)
        return overviews.oblique((drive for drive, _ in self.with_kinds), self.origin)

    def along(self, near: Floats) -> SceneCamera | None:
        """Along the drive to a place, metres from the origin; None without trajectory."""
        vehicle_path = self._way()
        return None if vehicle_path is None else overviews.along_path(vehicle_path, near)

    def above_ground(self, camera: SceneCamera) -> SceneCamera:
        """The camera that somebody wants, but not below the road of the drive."""
        vehicle_path = self._way()
        return camera if vehicle_path is None else overviews.above_ground(camera, vehicle_path)

    def course_deg(self, near: Floats) -> float:
        """Direction of the drive at a place, clockwise from grid north; north if unknown."""
        vehicle_path = self._way()
        return 0.0 if vehicle_path is None else overviews.course_deg(vehicle_path, near)

    def _way(self) -> Floats | None:
        """Where the vehicle of the main drive was."""
        drive = self._main()
        if drive is None:
            return None
        if drive.id not in self._ways:
            self._ways[drive.id] = overviews.path_of_drive(drive, self.origin)
        return self._ways[drive.id]

    def _main(self) -> Drive | None:
        """The drive that the image view shows, or else the first one."""
        drives = {drive.id: drive for drive, _ in self.with_kinds}
        return drives.get(self._settings.drive_id, next(iter(drives.values()), None))
