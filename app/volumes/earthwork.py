"""Earthwork: the volumes of the open project, computed, kept, shown and removed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.document.document import Document
from app.document.job_results import JobResultApplier
from app.jobs.jobs import JobLane, JobQueue
from app.volumes.volume_exports import VolumeExport
from app.volumes.volume_reports import ExportedVolume
from app.volumes.volume_work import (
    LoadedMap,
    contours_of,
    map_work,
    volume_work,
)
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Language, Text
from processing.map.change import Change
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.operations.project_volumes import (
    MadeVolume,
    remove_volume,
    sides_reader,
    store_volume,
)
from processing.project.project import Project
from processing.project.volumes.epochs import Epoch, epochs_of, has_ground
from processing.project.volumes.volume import ChosenSide, KeptVolume, SideKind, VolumeRequest
from processing.project.volumes.volume_store import VolumeStore
from processing.project.work_store import WorkStore
from processing.recording.drive import Drive
from processing.tools.ground import GROUND_TOOL
from widgets.shared.shown_volume import ContourOf

_TOLD = Text(
    "Cut {cut} m³, fill {fill} m³, uncertainty ± {sure} m³",
    "切土量 {cut} m³、盛土量 {fill} m³、不確かさ ± {sure} m³",
)
_WROTE = Text("Wrote {path}.", "{path} を書き出しました。")
_CONTOURS = Text("Contours", "等高線")
_LOADING = Text("Heat map", "ヒートマップ")


@dataclass(frozen=True)
class _Site:
    """Surveys of a site, and which drives have ground."""

    epochs: tuple[Epoch, ...]
    with_ground: Mapping[str, bool]


class Earthwork(QObject):
    """Volumes of the open project; the one that is shown.

    Parameters
    ----------
    document : Document
    jobs : JobQueue

    Signals
    -------
    volumes_changed()
        There are others now, or another one is shown; also when a project was opened or closed.
    epochs_changed()
        There are others now, or their ground was found.
    """

    volumes_changed = Signal()
    epochs_changed = Signal()

    def __init__(self, document: Document, jobs: JobQueue, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._job_results = JobResultApplier(jobs, self)
        self._job_results.refused.connect(document.refused)
        self._volumes: tuple[KeptVolume, ...] = ()
        self._shown = ""
        self._result: VolumeResult | None = None
        self._epochs: tuple[Epoch, ...] = ()
        self._with_ground: dict[str, bool] = {}
        self._contoured: tuple[ChangeGrid | None, tuple[ContourOf, float] | None] = None, None
        document.about_to_close.connect(self._job_results.give_up)
        document.opened.connect(self._on_document_opened)
        document.closed.connect(self._on_document_closed)
        changes = document.shared.map_changes
        changes.drives_changed.connect(self._on_drives_changed)
        changes.labels_changed.connect(self._on_labels_changed)
        changes.volumes_changed.connect(self._on_volumes_changed)
        document.step_coming.connect(self._on_document_step_coming)
        document.shared.volume.changed.connect(self._draw_contours)
        document.shared.volume.look_changed.connect(self._draw_contours)
        document.shared.cursor.hovered.connect(document.shared.volume.hover_over_point)

    # What there is.

    @property
    def volumes(self) -> tuple[KeptVolume, ...]:
        """All volumes, the first one first."""
        return self._volumes

    @property
    def shown(self) -> KeptVolume | None:
        """The volume whose map is shown, or is being read; None without one."""
        return next((one for one in self._volumes if one.id == self._shown), None)

    @property
    def epochs(self) -> tuple[Epoch, ...]:
        """The surveys of the site, older ones first."""
        return self._epochs

    def lacks_ground(self, side: ChosenSide | None) -> bool:
        """Whether the ground of an epoch is still to be found."""
        if side is None or side.kind is not SideKind.EPOCH:
            return False
        return any(not self._with_ground.get(id_, True) for id_ in side.drives)

    def others_than(self, sides: Sequence[ChosenSide]) -> tuple[ChosenSide, ...]:
        """Epochs whose ground is known besides those that are compared."""
        every = tuple(epoch.side for epoch in self._epochs)
        return tuple(one for one in every if one not in sides and not self.lacks_ground(one))

    # What is done.

    def find_ground(self, sides: Sequence[ChosenSide | None]) -> None:
        """Run the tool ``ground`` on those epochs whose ground is not known yet."""
        for side in sides:
            if side is not None and self.lacks_ground(side):
                # It takes all that was recorded together.
                self._document.start_run(GROUND_TOOL.id, side.drives[0], GROUND_TOOL.parameters())

    def compute(self, request: VolumeRequest) -> str:
        """Compare two grounds in the background and show what comes of it; the job's id."""
        project = self._document.project
        if project is None:
            return ""
        into = project.temporary_folder()
        title, work = volume_work(request, project.drives, project.crs, into)

        def take(made: MadeVolume) -> None:
            if not self._document.do_step(lambda project: store_volume(project, made)):
                return
            volumes = made.kept.volumes
            reported = _TOLD.filled(
                cut=f"{volumes.cut_m3:,.1f}",
                fill=f"{volumes.fill_m3:,.1f}",
                sure=f"{volumes.uncertainty_m3:,.1f}",
            )
            self._document.reported.emit(reported)

        return self._job_results.start(project, title, work, take)

    def show(self, id_: str) -> None:
        """Show the map of a volume in all views; empty: of none."""
        project = self._document.project
        self._shown = id_
        self.volumes_changed.emit()
        kept = self.shown
        if project is None or kept is None:
            self._shown, self._result = "", None
            self._document.shared.volume.show(None)
            return

        def take(loaded: LoadedMap) -> None:
            if self._shown == id_:
                self._result = loaded.result
                self._document.shared.volume.show(loaded.result.change, loaded.limit_m)

        def fail() -> None:
            if self._shown == id_:
                self.show("")

        self._in_background(project, map_work(VolumeStore(project.folder), kept), take, fail)

    def remove(self, id_: str) -> None:
        """Remove a volume as one undoable step; the newest of the others is shown."""
        kept = next((one for one in self._volumes if one.id == id_), None)
        if kept is None:
            return
        self._let_go()
        if not self._document.do_step(lambda project: remove_volume(project, kept)):
            self.show(id_)

    def export(self, kind: VolumeExport, path: Path, language: Language) -> str:
        """Write the volume that is shown to a file in the background; the job's id."""
        project, kept, result = self._document.project, self.shown, self._result
        shown = self._document.shared.volume
        if project is None or kept is None or result is None:
            return ""
        try:
            store = WorkStore(project.settings)
            details, limits = store.details(), store.limits()
        except UserError as error:
            self._document.refused.emit(error)
            return ""
        given = ExportedVolume(
            details=replace(details, work=details.work or project.name),
            kept=kept,
            result=result,
            drives=project.drives,
            limit_m=shown.look.limit_m,
            contours=shown.contours,
            language=language,
            limits=limits,
            sides=sides_reader(kept.request, project.drives, project.crs),
            never=(*_given_files(kept), *_delivered_files(project)),
        )

        def work(monitor: Monitor) -> Path:
            kind.write(path, given, monitor)
            return path

        def take(written: Path) -> None:
            self._document.reported.emit(_WROTE.filled(path=written.name))

        return self._job_results.start(project, kind.name, work, take)

    def _draw_contours(self) -> None:
        """Find beside the window the contours that are wished now, unless they are there."""
        project, volume = self._document.project, self._document.shared.volume
        change, look = volume.drawn, volume.look
        request = None if change is None else (look.contours, look.interval_m)
        if project is None or (change is self._contoured[0] and request == self._contoured[1]):
            return
        self._contoured = change, request
        if change is None:
            return

        def take(lines: tuple[LevelLine, ...]) -> None:
            if self._contoured[0] is change and self._contoured[1] == request:
                volume.take_contours(change, lines)

        def work(monitor: Monitor) -> tuple[LevelLine, ...]:
            return contours_of(change, look, monitor)

        self._job_results.start(
            project, _CONTOURS, work, take, lane=JobLane.INTERACTIVE, otherwise=lambda: take(())
        )

    # What is done in more than one place.

    def _in_background(
        self,
        project: Project,
        work: Callable[[], object],
        take: Callable[[Any], None],  # each work's own result
        otherwise: Callable[[], None],
    ) -> None:
        def watched(_monitor: Monitor) -> object:
            return work()

        self._job_results.start(
            project, _LOADING, watched, take, lane=JobLane.INTERACTIVE, otherwise=otherwise
        )

    def _read(self, project: Project) -> None:
        self._volumes = VolumeStore(project.folder).all()

    def _on_document_opened(self) -> None:
        project = self._document.project
        if project is None:
            return
        self._read(project)
        self._on_drives_changed()
        self.show(self._volumes[-1].id if self._volumes else "")

    def _on_document_step_coming(self, change: Change) -> None:
        if change.files is not None and change.files.names_of(""):
            self._let_go()

    def _let_go(self) -> None:
        """Let go of the map that is shown before its files move."""
        self.show("")

    def _on_volumes_changed(self) -> None:
        """Show what came; where the volume that was shown is gone, the newest of the others."""
        project = self._document.project
        if project is None:
            return
        before = {one.id for one in self._volumes}
        self._read(project)
        new = [one.id for one in self._volumes if one.id not in before]
        self.show((new or [one.id for one in self._volumes] or [""])[-1])

    def _on_document_closed(self) -> None:
        self._volumes = ()
        self._on_drives_changed()
        self.show("")

    def _on_drives_changed(self) -> None:
        """Look beside the window which drives are one survey: of many drives it takes a while."""
        project, drives = self._document.project, self._document.drives()
        self._take_site(_Site((), {}))
        if project is not None and drives:
            self._in_background(project, lambda: _site_of(drives), self._take_site, lambda: None)

    def _take_site(self, site: _Site) -> None:
        self._epochs, self._with_ground = site.epochs, dict(site.with_ground)
        self.epochs_changed.emit()

    def _on_labels_changed(self, drive_id: str, _points: object) -> None:
        if not self._with_ground.get(drive_id, True):
            self._with_ground[drive_id] = _has_ground(self._document.drive(drive_id))
            self.epochs_changed.emit()


def _given_files(kept: KeptVolume) -> tuple[Path, ...]:
    """The designs that a volume was had from; no export overwrites what was delivered."""
    return tuple(Path(side.path) for side in (kept.request.before, kept.request.after) if side.path)


def _delivered_files(project: Project) -> tuple[Path, ...]:
    return tuple(file for drive in project.drives for file in drive.delivered_files)


def _site_of(drives: Sequence[Drive]) -> _Site:
    return _Site(epochs_of(drives), {drive.id: _has_ground(drive) for drive in drives})


def _has_ground(drive: Drive) -> bool:
    try:
        return has_ground(drive)
    except UserError:  # whoever computes with a damaged drive is told
        return True
