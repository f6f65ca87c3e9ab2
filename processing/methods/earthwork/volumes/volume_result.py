"""What a volume is stated by: cut, fill, areas, how sure they are, and how the epochs fit."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.text import Text
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.sections.drawing_parts import SectionedLine


@dataclass(frozen=True)
class Volumes:
    """Earth between two grounds within a boundary.

    Attributes
    ----------
    cut_m3, fill_m3 : float
        What was taken away and what was put there; neither is negative.
    area_m2 : float
        Of what was compared, seen from above.
    unmeasured_area_m2 : float
        Part of it where a ground was not measured on a date: filled in, or left out.
    uncertainty_m3 : float
        Cut, fill and net are each expected within it in 95 of 100 cases.
    measured_cut_m3, measured_fill_m3 : float
        Parts of cut and fill where both grounds were measured.
    left_out_area_m2 : float
        Part of what was not measured that counts nothing: beyond the last points of a date, or
        where a design has no ground.
    """

    cut_m3: float
    fill_m3: float
    area_m2: float
    unmeasured_area_m2: float
    uncertainty_m3: float
    measured_cut_m3: float
    measured_fill_m3: float
    left_out_area_m2: float = 0.0

    @property
    def net_m3(self) -> float:
        """Fill less cut: positive where the later ground is higher."""
        return self.fill_m3 - self.cut_m3


@dataclass(frozen=True)
class Registration:
    """How the later epoch lies to the earlier one, found from ground that did not change.

    Attributes
    ----------
    shift_m : (float, float, float)
        East, north and up by which the later epoch lies off, m.
    sure_m : (float, float, float)
        Standard deviation of each, m.
    stable_area_m2 : float
        Ground that is taken to be unchanged.
    is_significant : bool
        More than chance, and more than the volume bears.
    is_corrected : bool
        The later epoch was moved back by it.
    """

    shift_m: tuple[float, float, float]
    sure_m: tuple[float, float, float]
    stable_area_m2: float
    is_significant: bool
    is_corrected: bool


@dataclass(frozen=True)
class VolumeResult:
    """A volume, how it was had, and the map it was had from.

    Attributes
    ----------
    method : str
        ``grid``, ``tin``, ``end-area`` or ``prismoidal``.
    grid_m : float
        Side of a cell of the map; also the mesh where the method is ``grid``.
    change : ChangeGrid
        The map: of each method, since it shows where earth was moved.
    registration : Registration or None
        None where only one side is an epoch, or nothing is stable enough to tell.
    notes : tuple of Text
        What a reader of the number has to know, a sentence each.
    line : SectionedLine or None
        Sections of the methods along a line.
    between : tuple of (float, float)
        Cut and fill stated at each section but the first, m³; NaN at one that is halfway only.
    """

    volumes: Volumes
    method: str
    grid_m: float
    change: ChangeGrid
    registration: Registration | None = None
    notes: tuple[Text, ...] = ()
    line: SectionedLine | None = None
    between: tuple[tuple[float, float], ...] = ()
