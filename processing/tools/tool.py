"""Tool: one processing method, declared once.

The form in the processing panel, ``zuka tools``, ``zuka run``, batch jobs and the manual are made
from this declaration. A tool is a pure function, of a block of points where it says something about
every point, of a drive where it finds things: no project, no view, no global.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.image.rows.grid import PixelGrid
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.recording.columns.columns import Columns, column_path
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive

CandidateValue = str | float | int | bool | None
CandidateGeometry = Literal["point", "line", "area"]


class Needs(Enum):
    """What a tool asks of a cloud."""

    POINTS = "points"
    PIXELS = "pixels"
    REVOLUTIONS = "turns"
    TRAJECTORY = "trajectory"
    IMAGES = "images"


@dataclass(frozen=True)
class PointBlock:
    """A stretch of a recording, as a tool sees it.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS, acquisition order.
    intensity : (n,) uint16
    time : (n,) float64
        Seconds on the trajectory's clock; NaN where a file has none.
    classification : (n,) uint8
    grid : PixelGrid
        The block's pixels: which point is whose neighbour in the acquisition image.
    seen_from : (3,) float64 or None
        Where a standing scanner was, m, project CRS; None for one that moved, and where unknown.
    """

    xyz: NDArray[np.float64]
    intensity: NDArray[np.uint16]
    time: NDArray[np.float64]
    classification: NDArray[np.uint8]
    grid: PixelGrid
    seen_from: NDArray[np.float64] | None = None


@dataclass(frozen=True)
class PointResult:
    """One value or vector per point of the block, by column name.

    Attributes
    ----------
    columns : mapping of str to array
        Each (n,) or (n, k), in the block's order.
    """

    columns: Mapping[str, NDArray[Any]] = field(default_factory=dict)  # dtype is the column's own


@dataclass(frozen=True)
class FinishedColumns:
    """What a tool says about every point of a drive: whole column files in a folder of their own.

    Attributes
    ----------
    folder : Path
        Holds nothing else; whoever got it removes it or hands the columns over.
    names : tuple of str
    count : int
        Points of the drive.
    """

    folder: Path
    names: tuple[str, ...]
    count: int

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Values of the points ``start … stop − 1``: (k,) or (k, width), of the column's dtype."""
        return read_chunk(self.folder, name, start, stop)

    def hand_over(self, columns: Columns) -> None:
        """Make them the columns of a drive on the same disk; the folder is gone afterwards.

        Raises
        ------
        InUse, NoSpace
            A column can't be replaced; it and those behind it stay as they were.
        """
        for name in self.names:
            columns.take_over(name, column_path(self.folder, name))
        self.remove()

    def remove(self) -> None:
        """Remove what is left of the folder; may be called again."""
        remove_folder(self.folder)


@dataclass(frozen=True)
class TogetherResult:
    """What a tool says about every point of drives recorded together.

    Attributes
    ----------
    columns : tuple of FinishedColumns
        In the order of the drives.
    kept : tuple of Path
        Files that each of the drives keeps beside its columns; they may be deleted at any time.
    note : Text
        What the data chose, for the run's summary.
    """

    columns: tuple[FinishedColumns, ...]
    kept: tuple[Path, ...] = ()
    note: Text = Text("", "")


@dataclass(frozen=True)
class Candidate:
    """One thing that a tool believes to have found; a person decides.

    Attributes
    ----------
    kind : str
        Id of a kind of the catalogue.
    geometry : {"point", "line", "area"}
        How ``xyz`` is read: one place, an open line, a ring (its first place not repeated).
    xyz : (n, 3) float64
        m, project CRS.
    points : (n,) int64
        The measured point that each place rests on, by its index in the drive; −1: none.
    confidence : float
        0 to 1: the share of such candidates that is expected to be right.
    attributes : mapping
        By the ids of the kind's attribute fields; others are kept too.
    drives : (n,) int64 or None
        Which drive each of ``points`` is of, by its place among those that the tool got; None: the
        first.
    is_drawing : bool
        Drawn from other candidates, as the outline of a gutter from its lids: it goes on the map
        and into drawings, not into files of what was found.
    """

    kind: str
    geometry: CandidateGeometry
    xyz: NDArray[np.float64]
    points: NDArray[np.int64]
    confidence: float
    attributes: Mapping[str, CandidateValue] = field(default_factory=dict)
    drives: NDArray[np.int64] | None = None
    is_drawing: bool = False


@dataclass(frozen=True)
class CandidateResult:
    """What a tool found on a drive, or on drives of one survey.

    Attributes
    ----------
    candidates : tuple of Candidate
        In the order of the street, where there is one.
    note : Text
        Why there is little or nothing, in a sentence; empty where nothing is to be said.
    """

    candidates: tuple[Candidate, ...] = ()
    note: Text = Text("", "")


# A tool's parameters are its own frozen dataclass, so the runner can't know their type.
PointComputer = Callable[[PointBlock, Any, Monitor], PointResult]
CandidateFinder = Callable[[Drive, Any, Monitor], CandidateResult]
# Drives of one survey, the first being the one asked for, the tool's parameters.
JointCandidateFinder = Callable[[tuple[Drive, ...], Any, Monitor], CandidateResult]
# A drive, the tool's parameters, an empty folder for the columns, points to hold at a time.
PointMarker = Callable[[Drive, Any, Path, int, Monitor], FinishedColumns]
# Drives recorded together, the tool's parameters, an empty folder, points to hold at a time: the
# columns of the first drive come to lie in it, and folders for those of the others.
JointPointMarker = Callable[[tuple[Drive, ...], Any, Path, int, Monitor], TogetherResult]
# A drive, the other drives of its street, the tool's parameters, whom to tell what is lacking.
PointComputerFactory = Callable[[Drive, tuple[Drive, ...], Any, Monitor], PointComputer]


# Two grounds, the earlier first, the tool's parameters, whom to tell, and what the volume is
# limited to.
VolumeComparer = Callable[[Side, Side, Any, Monitor, VolumeScope], VolumeResult]


# What a person should know before the tool is run on a drive.
RemarkFinder = Callable[[Drive], Text | None]


def nothing_to_remark(_drive: Drive) -> Text | None:
    """The ``remark`` of a tool that runs on any drive as its parameters stand."""
    return None


def nothing_per_point(_block: PointBlock, _parameters: object, _monitor: Monitor) -> PointResult:
    """The ``compute`` of a tool that finds candidates."""
    return PointResult()


@dataclass(frozen=True)
class OutputColumn:
    """A per-point result: its name in files, type, width and words for people."""

    name: str
    dtype: str
    width: int
    title: Text


@dataclass(frozen=True)
class Tool:
    """One processing method: it says something about every point, or it finds candidates.

    Attributes
    ----------
    id : str
        The name on the command line and in provenance.
    version : int
        Raised when the same input and parameters give another result.
    compute : callable
        Columns of a block's points.
    outputs : tuple of OutputColumn
        What ``compute`` gives per point.
    overlap_rows : int
        Rows of the image that a block needs beyond its own on either side; −1: the tool can't be
        cut into blocks and gets the recording whole.
    compute_of : callable or None
        Makes ``compute`` for one drive, where a block needs more than its own points: camera
        images, or what stands around them.
    mark : callable or None
        Says something about every point in place of ``compute``, for a tool that needs the
        neighbours in space whenever they were measured, and so reads a drive in an order of its
        own. Its ``outputs`` don't depend on how many points it holds at a time. It reports its own
        progress.
    mark_together : callable or None
        The same for all drives recorded together, for a tool that needs what any of them measured.
    gives_classes : tuple of int
        The codes that a tool with the output ``classification`` may give; a new run in a project
        takes back those of an earlier one.
    find : callable or None
        Candidates on a whole drive, of which it reads a chunk at a time; None for a tool that
        says something about points. It reports its own progress.
    find_together : callable or None
        The same on all drives of one survey at once, for a tool that gives one result for what
        several heads and passes measured.
    compare : callable or None
        What lies between two grounds, for a tool that needs two of them and no drive.
    remark : callable
        What must be given so that it can run on a drive; None where nothing must.
    sought : tuple of str
        Names of the parameters that say what is looked for, and where: runs of a project that
        differ in them find different things, so that none replaces what another found.
    """

    id: str
    name: Text
    explanation: Text
    group: Text
    needs: Needs
    parameters: type[Any]  # a frozen dataclass of fields from processing.core.parameters
    compute: PointComputer = nothing_per_point
    outputs: tuple[OutputColumn, ...] = ()
    overlap_rows: int = 0
    version: int = 1
    compute_of: PointComputerFactory | None = None
    mark: PointMarker | None = None
    mark_together: JointPointMarker | None = None
    gives_classes: tuple[int, ...] = ()
    find: CandidateFinder | None = None
    find_together: JointCandidateFinder | None = None
    compare: VolumeComparer | None = None
    remark: RemarkFinder = nothing_to_remark
    sought: tuple[str, ...] = ()

    @property
    def gives_candidates(self) -> bool:
        """Whether it finds things instead of saying something about every point."""
        return self.find is not None or self.find_together is not None
