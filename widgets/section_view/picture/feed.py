"""SectionFeed: finds and colours the points of a cut beside the window's thread."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.image.attributes.attributes import colours, most_telling_attribute
from processing.methods.ground.surface_line import SurfaceLine
from processing.project.volumes.epochs import Epoch
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.section.points_in_cut import MOST_POINTS, SectionPoints, section_points
from widgets.section_view.picture.found_ground import FoundGround
from widgets.section_view.picture.section_diagnostics import FoundDiagnostics, diagnostics_at
from widgets.section_view.picture.section_position import SectionPosition
from widgets.section_view.picture.section_waveforms import SectionWaveform, waveforms_in
from widgets.section_view.picture.settings import SectionSettings
from widgets.shared.view_settings import PointStyle

_AT_ONCE = frozenset({"intensity", "toned", "height", "class", "label", "segment"})
"""Attributes that are read, not computed from neighbours or images."""

_PLAIN = "intensity"
_LIFT = 72.0
_BEHIND, _IN_PLANE, _BEFORE = (0, 114, 178), (240, 240, 240), (230, 159, 0)


@dataclass(frozen=True, eq=False)
class SectionRequest:
    """What a pane wants to see.

    Attributes
    ----------
    standing : SectionPosition
        Where the section stands.
    cut : Cut
        Its slab.
    drives : tuple of Drive
    look : PointStyle
    settings : SectionSettings
        Say whether colours tell the distance from the plane instead of the look's attribute, and
        whether the ground and what tools look at are shown.
    parameters : mapping of str to object
        Of the tools that tell what they look at, by their ids.
    """

    standing: SectionPosition
    cut: Cut
    drives: tuple[Drive, ...]
    look: PointStyle
    settings: SectionSettings
    parameters: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class SectionPicture:
    """The points of a cut.

    Attributes
    ----------
    request : SectionRequest
    drive_numbers : (n,) int64
        Into ``request.drives``.
    points : (n,) int64
        Indices in the drives, by rising offset.
    section : (n, 3) float64
        Offset, height, distance from the plane, m.
    colours : (n, 3) uint8
    is_thinned : bool
        Whether there are more points than these.
    is_final : bool
        Whether the colours are those wished for.
    ground : tuple of SurfaceLine
        In the plane of the cut, as the tool “ground” found it.
    epochs : tuple of str
        What the surveys are called to whose numbers lines of the ground refer.
    diagnostics : FoundDiagnostics or None
        None where they aren't shown, or nothing is known as yet.
    waveforms : tuple of SectionWaveform
        Empty where they aren't shown.
    """

    request: SectionRequest
    drive_numbers: NDArray[np.int64]
    points: NDArray[np.int64]
    section: Floats
    colours: NDArray[np.uint8]
    is_thinned: bool
    is_final: bool = True
    ground: tuple[SurfaceLine, ...] = ()
    epochs: tuple[str, ...] = ()
    diagnostics: FoundDiagnostics | None = None
    waveforms: tuple[SectionWaveform, ...] = ()


class SectionFeed(QObject):
    """Works out requests one after the other; the newest is the one that counts.

    What tools look at takes them seconds. It is worked out in a thread of its own, so that the
    points of the next section don't wait for it.

    Signals
    -------
    arrived(picture: SectionPicture)
        Sent from another thread, so received through the window's event queue. Where colours
        take time the points come twice, in plain colours first; what tools look at comes tool by
        tool.
    """

    arrived = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._changed = threading.Condition()
        self._next: SectionRequest | None = None
        self._newest: SectionRequest | None = None
        self._unexplained: SectionPicture | None = None
        self._is_closed = False
        self._ground = FoundGround()
        self._workers = [
            threading.Thread(target=work, name=name, daemon=True)
            for work, name in ((self._work, "section"), (self._explain, "section diagnostics"))
        ]
        for worker in self._workers:
            worker.start()

    def request(self, request: SectionRequest) -> None:
        """Ask for what is to be seen now; replaces what was asked for and isn't begun."""
        with self._changed:
            self._next = self._newest = request
            self._changed.notify_all()

    def close(self) -> None:
        """Stop the workers and wait for them; nothing is told afterwards."""
        with self._changed:
            self._is_closed = True
            self._next = self._newest = None
            self._changed.notify_all()
        for worker in self._workers:
            worker.join()

    def _work(self) -> None:
        while True:
            with self._changed:
                while self._next is None and not self._is_closed:
                    self._changed.wait()
                if self._is_closed:
                    return
                request, self._next = self._next, None
            if request is not None:
                self._fulfil(request)

    def _fulfil(self, request: SectionRequest) -> None:
        parts: list[SectionPoints] = []
        most, hides_noise = MOST_POINTS // max(len(request.drives), 1), request.look.hides_noise
        for drive in request.drives:
            if self._is_outdated():
                return
            try:
                parts.append(section_points(drive, request.cut, most, hides_noise=hides_noise))
            except UserError:  # the image view says why; here its points are just not there
                parts.append(SectionPoints(drive.id, np.empty(0, np.int64), np.empty((0, 3))))
        ground: tuple[SurfaceLine, ...] = ()
        epochs: tuple[str, ...] = ()
        if request.settings.shows_ground:
            ground = self._ground.lines_now(request.drives, request.cut, parts)
            epochs = tuple(map(_epoch_name, self._ground.epochs(request.drives)))
        is_slow = not request.settings.is_by_distance and request.look.attribute not in _AT_ONCE
        if is_slow:
            plain = picture_of(request, parts, _PLAIN)
            self._report(replace(plain, is_final=False, ground=ground, epochs=epochs))
        if is_slow and self._is_outdated():
            return
        picture = picture_of(request, parts, request.look.attribute)
        picture = replace(picture, ground=ground, epochs=epochs)
        if request.settings.shows_waveforms:
            waveforms = waveforms_in(request.drives, parts, request.cut)
            picture = replace(picture, waveforms=waveforms)
        if not request.settings.shows_diagnostics:
            self._report(picture)
            return
        self._report(replace(picture, is_final=False))
        with self._changed:
            self._unexplained = picture
            self._changed.notify_all()

    def _explain(self) -> None:
        while True:
            with self._changed:
                while self._unexplained is None and not self._is_closed:
                    self._changed.wait()
                if self._is_closed:
                    return
                picture, self._unexplained = self._unexplained, None
            if picture is not None:
                self._report_diagnostics(picture)

    def _report_diagnostics(self, picture: SectionPicture) -> None:
        """Tell what tools look at, one after the other, until something else is asked for."""
        asked = picture.request
        found = diagnostics_at(asked.drives, asked.standing, asked.cut, asked.parameters)
        while asked is self._newest and (known := next(found, None)) is not None:
            with self._changed:  # told in the order of requests: the newest picture stays
                if asked is self._newest:
                    self._report(replace(picture, diagnostics=known, is_final=not known.awaited))

    def _report(self, picture: SectionPicture) -> None:
        if not self._is_closed:
            self.arrived.emit(picture)

    def _is_outdated(self) -> bool:
        with self._changed:
            return self._is_closed or self._next is not None


def picture_of(
    request: SectionRequest, parts: Sequence[SectionPoints], attribute: str
) -> SectionPicture:
    """The points of all drives in one picture, coloured by an attribute or as wished."""
    section = np.concatenate([np.empty((0, 3)), *(part.section for part in parts)])
    points = np.concatenate([np.empty(0, np.int64), *(part.points for part in parts)])
    numbers = np.repeat(np.arange(len(parts)), [part.points.size for part in parts])
    if request.settings.is_by_distance:
        painted = distance_colours(section[:, 2], request.cut.width_m / 2)
    else:
        shown = [
            _colours_of(drive, part.points, attribute, request.look)
            for drive, part in zip(request.drives, parts, strict=True)
        ]
        painted = _lighten_colours(np.concatenate([np.empty((0, 3), np.uint8), *shown]))
    order = np.argsort(section[:, 0], kind="stable")
    most = MOST_POINTS // max(len(request.drives), 1)
    return SectionPicture(
        request,
        numbers[order],
        points[order],
        section[order],
        painted[order],
        is_thinned=any(part.points.size >= most for part in parts),
    )


def distance_colours(distances_m: Floats, half_width_m: float) -> NDArray[np.uint8]:
    """Bluer behind the plane, more orange in front of it, nearly white in it: (n, 3) uint8."""
    share = np.clip(distances_m / half_width_m, -1.0, 1.0)[:, None]
    ends = np.where(share > 0, np.array(_BEHIND), np.array(_BEFORE))
    blend = np.abs(share) * ends + (1.0 - np.abs(share)) * np.array(_IN_PLANE)
    return np.asarray(np.rint(blend), dtype=np.uint8)


def _lighten_colours(shown: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Lighter: a dark road is a surface in other views, but a thin line on dark ground here."""
    return np.asarray(_LIFT + shown * (1.0 - _LIFT / 255.0), dtype=np.uint8)


def _colours_of(
    drive: Drive, points: NDArray[np.int64], attribute: str, look: PointStyle
) -> NDArray[np.uint8]:
    try:
        shown = most_telling_attribute(drive, attribute)
        return colours(drive, points, shown, look.low_percent, look.high_percent)
    except UserError:  # camera images can't be read; the image view says so
        return colours(drive, points, _PLAIN, look.low_percent, look.high_percent)


def _epoch_name(epoch: Epoch) -> str:
    """The day of a survey, by which one knows it; its name where no time tells the day."""
    return epoch.name if epoch.measured_on is None else epoch.measured_on.isoformat()
