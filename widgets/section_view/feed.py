"""SectionFeed: finds and colours the points of a cut beside the window's thread."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from processing.errors import UserError
from processing.image.attributes import colours, telling_attribute
from processing.points.drive import Drive
from processing.section.cut import Cut
from processing.section.points_in_cut import MOST_POINTS, SectionPoints, section_points
from processing.section.surface_line import SurfaceLine
from widgets.section_view.found_ground import FoundGround
from widgets.section_view.found_trials import SectionTrials, trials_at
from widgets.section_view.settings import SectionSettings
from widgets.section_view.standing import Standing
from widgets.shared.view_settings import PointLook

Floats = NDArray[np.float64]

_AT_ONCE = frozenset({"intensity", "height", "class", "label", "segment"})
"""Attributes that are read, not computed from neighbours or images."""

_PLAIN = "intensity"
_LIFT = 72.0
_BEHIND, _IN_PLANE, _BEFORE = (0, 114, 178), (240, 240, 240), (230, 159, 0)


@dataclass(frozen=True, eq=False)
class SectionWish:
    """What a pane wants to see.

    Attributes
    ----------
    standing : Standing
        Where the section stands.
    cut : Cut
        Its slab.
    drives : tuple of Drive
    look : PointLook
    settings : SectionSettings
        Say whether colours tell the distance from the plane instead of the look's attribute, and
        whether the ground and what tools look at are shown.
    parameters : mapping of str to object
        Of the tools that tell what they look at, by their ids.
    """

    standing: Standing
    cut: Cut
    drives: tuple[Drive, ...]
    look: PointLook
    settings: SectionSettings
    parameters: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class SectionPicture:
    """The points of a cut.

    Attributes
    ----------
    wish : SectionWish
    drive_numbers : (n,) int64
        Into ``wish.drives``.
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
    trials : tuple of SectionTrials or None
        None where they aren't shown, or aren't known as yet.
    """

    wish: SectionWish
    drive_numbers: NDArray[np.int64]
    points: NDArray[np.int64]
    section: Floats
    colours: NDArray[np.uint8]
    is_thinned: bool
    is_final: bool = True
    ground: tuple[SurfaceLine, ...] = ()
    trials: tuple[SectionTrials, ...] | None = None


class SectionFeed(QObject):
    """Works out wishes one after the other; the newest is the one that counts.

    Signals
    -------
    arrived(picture: SectionPicture)
        Sent from another thread, so received through the window's event queue. Where colours
        take time the points come twice, in plain colours first.
    """

    arrived = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._changed = threading.Condition()
        self._next: SectionWish | None = None
        self._is_closed = False
        self._ground = FoundGround()
        self._worker = threading.Thread(target=self._work, name="section", daemon=True)
        self._worker.start()

    def wish(self, wish: SectionWish) -> None:
        """Ask for what is to be seen now; replaces what was asked for and isn't begun."""
        with self._changed:
            self._next = wish
            self._changed.notify()

    def close(self) -> None:
        """Stop the worker and wait for it; nothing is told afterwards."""
        with self._changed:
            self._is_closed = True
            self._next = None
            self._changed.notify()
        self._worker.join()

    def _work(self) -> None:
        while True:
            with self._changed:
                while self._next is None and not self._is_closed:
                    self._changed.wait()
                if self._is_closed:
                    return
                wish, self._next = self._next, None
            if wish is not None:
                self._fulfil(wish)

    def _fulfil(self, wish: SectionWish) -> None:
        parts: list[SectionPoints] = []
        most, hides_noise = MOST_POINTS // max(len(wish.drives), 1), wish.look.hides_noise
        for drive in wish.drives:
            if self._is_outdated():
                return
            try:
                parts.append(section_points(drive, wish.cut, most, hides_noise=hides_noise))
            except UserError:  # the image view says why; here its points are just not there
                parts.append(SectionPoints(drive.id, np.empty(0, np.int64), np.empty((0, 3))))
        ground: tuple[SurfaceLine, ...] = ()
        if wish.settings.shows_ground:
            ground = self._ground.lines_now(wish.drives, wish.cut, parts)
        is_slow = not wish.settings.is_by_distance and wish.look.attribute not in _AT_ONCE
        if is_slow:
            plain = picture_of(wish, parts, _PLAIN)
            self._tell(replace(plain, is_final=False, ground=ground))
        if is_slow and self._is_outdated():
            return
        picture = replace(picture_of(wish, parts, wish.look.attribute), ground=ground)
        if not wish.settings.shows_trials or wish.standing.is_along:
            self._tell(picture)
            return
        self._tell(replace(picture, is_final=False))
        if not self._is_outdated():
            trials = trials_at(wish.drives, wish.standing, wish.cut, wish.parameters)
            self._tell(replace(picture, trials=trials))

    def _tell(self, picture: SectionPicture) -> None:
        if not self._is_closed:
            self.arrived.emit(picture)

    def _is_outdated(self) -> bool:
        with self._changed:
            return self._is_closed or self._next is not None


def picture_of(wish: SectionWish, parts: Sequence[SectionPoints], attribute: str) -> SectionPicture:
    """The points of all drives in one picture, coloured by an attribute or as wished."""
    section = np.concatenate([np.empty((0, 3)), *(part.section for part in parts)])
    points = np.concatenate([np.empty(0, np.int64), *(part.points for part in parts)])
    numbers = np.repeat(np.arange(len(parts)), [part.points.size for part in parts])
    if wish.settings.is_by_distance:
        painted = distance_colours(section[:, 2], wish.cut.width_m / 2)
    else:
        shown = [
            _colours_of(drive, part.points, attribute, wish.look)
            for drive, part in zip(wish.drives, parts, strict=True)
        ]
        painted = _lifted(np.concatenate([np.empty((0, 3), np.uint8), *shown]))
    order = np.argsort(section[:, 0], kind="stable")
    most = MOST_POINTS // max(len(wish.drives), 1)
    return SectionPicture(
        wish,
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


def _lifted(shown: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Lighter: a dark road is a surface in other views, but a thin line on dark ground here."""
    return np.asarray(_LIFT + shown * (1.0 - _LIFT / 255.0), dtype=np.uint8)


def _colours_of(
    drive: Drive, points: NDArray[np.int64], attribute: str, look: PointLook
) -> NDArray[np.uint8]:
    try:
        shown = telling_attribute(drive, attribute)
        return colours(drive, points, shown, look.low_percent, look.high_percent)
    except UserError:  # camera images can't be read; the image view says so
        return colours(drive, points, _PLAIN, look.low_percent, look.high_percent)
