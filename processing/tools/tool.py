"""Tool: one processing method, declared once.

The form in the processing panel, its button, ``zuka tools``, ``zuka run``, ``zuka score``, batch
jobs and the manual are made from this declaration. What a tool computes is a pure function of one
of a few kinds (:data:`ToolMethod`): no project, no view, no global.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import keep_sums
from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.image.rows.grid import PixelGrid
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import Side
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.methods.registration.control_points import ControlPoint
from processing.methods.registration.registration import SurveyRegistration
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.columns.columns import Columns, column_path
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.recording.waveform_packets.descriptors import WaveformDescriptor
from processing.scoring.points.asked_classes import AskedClass
from processing.scoring.scorers import Scorer

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
    note : Text
        What the data chose, for the run's summary.
    """

    folder: Path
    names: tuple[str, ...]
    count: int
    note: Text = Text("", "")

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Values of the points ``start … stop − 1``: (k,) or (k, width), of the column's dtype."""
        return read_chunk(self.folder, name, start, stop)

    def keep_sums(self) -> None:
        """Write the checksums of the columns, which then come with them.

        Raises
        ------
        NoSpace
        """
        for name in self.names:
            path = column_path(self.folder, name)
            with report_as_user_error(path):
                keep_sums(path)

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
    picture : (h, w, 3) uint8 or None
        What a camera image shows of it, red, green, blue; a project keeps it with the feature.
    own_points : (k,) int64 or None
        The measured points that it consists of, by their index in the drive; None: not told.
    own_drives : (k,) int64 or None
        Which drive each of them is of, as in ``drives``.
    """

    kind: str
    geometry: CandidateGeometry
    xyz: NDArray[np.float64]
    points: NDArray[np.int64]
    confidence: float
    attributes: Mapping[str, CandidateValue] = field(default_factory=dict)
    drives: NDArray[np.int64] | None = None
    is_drawing: bool = False
    picture: NDArray[np.uint8] | None = None
    own_points: NDArray[np.int64] | None = None
    own_drives: NDArray[np.int64] | None = None

    @classmethod
    def at_foot(
        cls,
        kind: str,
        foot: NDArray[np.float64],
        confidence: float,
        attributes: Mapping[str, CandidateValue],
        *,
        own_points: NDArray[np.int64],
        own_drives: NDArray[np.int64],
    ) -> Candidate:
        """Something upright as a point at its foot, (3,), which lies on no measured point."""
        return cls(
            kind,
            "point",
            foot[None],
            np.array([-1], np.int64),
            confidence,
            attributes,
            own_drives[:1],
            own_points=own_points,
            own_drives=own_drives,
        )


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


@dataclass(frozen=True)
class OutputColumn:
    """A per-point result: its name in files, type, width and words for people."""

    name: str
    dtype: str
    width: int
    title: Text


# A tool's parameters are its own frozen dataclass, so nobody here can know their type.
PointComputer = Callable[[PointBlock, Any, Monitor], PointResult]
# A drive, the other drives of its street, the tool's parameters, whom to tell what is lacking.
PointComputerFactory = Callable[[Drive, tuple[Drive, ...], Any, Monitor], PointComputer]
# A drive, the tool's parameters, an empty folder for the columns, points to hold at a time.
PointMarker = Callable[[Drive, Any, Path, int, Monitor], FinishedColumns]
# Drives recorded together, the tool's parameters, an empty folder, points to hold at a time: the
# columns of the first drive come to lie in it, and folders for those of the others.
JointPointMarker = Callable[[tuple[Drive, ...], Any, Path, int, Monitor], TogetherResult]
CandidateFinder = Callable[[Drive, Any, Monitor], CandidateResult]
# Drives of one survey, the first being the one asked for, the tool's parameters.
JointCandidateFinder = Callable[[tuple[Drive, ...], Any, Monitor], CandidateResult]
# Two grounds, the earlier first, the tool's parameters, whom to tell, and what the volume is
# limited to.
VolumeComparer = Callable[[Side, Side, Any, Monitor, VolumeScope], VolumeResult]
# What a person should know before the tool is run on a drive.
RemarkFinder = Callable[[Drive], Text | None]
# A place with the scanline through it, the tool's parameters.
DiagnosticMaker = Callable[[RequestedPosition, Any], tuple[Diagnostic, ...]]


@dataclass(frozen=True)
class PerPoint:
    """A method that says something about every point of a block.

    Attributes
    ----------
    compute : callable
        Columns of a block's points.
    outputs : tuple of OutputColumn
        What ``compute`` gives per point.
    overlap_rows : int
        Rows of the image that a block needs beyond its own on either side; −1: the method can't be
        cut into blocks and gets the recording whole.
    """

    compute: PointComputer
    outputs: tuple[OutputColumn, ...]
    overlap_rows: int = 0


@dataclass(frozen=True)
class PerPointOfDrive:
    """The same where a block needs more than its own points: images, or what stands around them.

    Attributes
    ----------
    computer_of : callable
        Makes ``compute`` of :class:`PerPoint` for one drive.
    outputs, overlap_rows
        As of :class:`PerPoint`.
    """

    computer_of: PointComputerFactory
    outputs: tuple[OutputColumn, ...]
    overlap_rows: int = 0


@dataclass(frozen=True)
class PerDrive:
    """A method that says something about every point and reads the drive in an order of its own.

    For what needs the neighbours in space whenever they were measured. It reports its own progress.

    Attributes
    ----------
    mark : callable
        Columns of a drive; they don't depend on how many points are held at a time.
    outputs : tuple of OutputColumn
    """

    mark: PointMarker
    outputs: tuple[OutputColumn, ...]


@dataclass(frozen=True)
class Together:
    """The same on all drives recorded together, for what needs all that any of them measured.

    Attributes
    ----------
    mark_together : callable
        Columns of each of the drives.
    outputs : tuple of OutputColumn
    """

    mark_together: JointPointMarker
    outputs: tuple[OutputColumn, ...]


@dataclass(frozen=True)
class Finder:
    """A method that finds things on a drive. It reads a chunk at a time and reports its progress.

    Attributes
    ----------
    find : callable
        Candidates on a whole drive.
    """

    find: CandidateFinder


@dataclass(frozen=True)
class SurveyFinder:
    """The same on all drives of a survey, where several heads and passes give one result.

    Attributes
    ----------
    find_together : callable
        Candidates on all the drives.
    """

    find_together: JointCandidateFinder


@dataclass(frozen=True)
class Comparison:
    """A method that says what lies between two grounds; it runs on no drive.

    Attributes
    ----------
    compare : callable
        The volume between them.
    """

    compare: VolumeComparer


@dataclass(frozen=True, eq=False)
class MadePoints:
    """Points that were not delivered.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, project CRS.
    columns : mapping
        (n,) each, by the names that LAS gives them: ``gps_time``, ``intensity``, …
    extra : mapping
        (n,) each, by names of their own; the same in all parts of a result.
    packets : MadePackets or None
        Their waveforms, where the method makes some.
    """

    xyz: NDArray[np.float64]
    columns: Mapping[str, NDArray[Any]]
    extra: Mapping[str, NDArray[Any]]
    packets: MadePackets | None = None


@dataclass(frozen=True, eq=False)
class MadePackets:
    """The waveforms of made points, several of which may lie in one packet.

    Attributes
    ----------
    packet : (n,) int64
        Row in ``samples`` of each point's packet.
    location_ps : (n,) float32
        The point's time after the packet's first sample.
    direction : (n, 3) float32
        m/ps, to the sensor.
    samples : (k, m) unsigned
        Counts; m as the method's descriptor says.
    """

    packet: NDArray[np.int64]
    location_ps: NDArray[np.float32]
    direction: NDArray[np.float32]
    samples: NDArray[Any]


# A drive, the tool's parameters, whom to tell: its points, some at a time.
PointMaker = Callable[[Drive, Any, Monitor], Iterator[MadePoints]]
# The same of all drives of its inputs.
JointPointMaker = Callable[[tuple[Drive, ...], Any, Monitor], Iterator[MadePoints]]


@dataclass(frozen=True)
class NewPoints:
    """A method that makes points of its own from a drive; they go into a file.

    Attributes
    ----------
    make : callable
        The points, some at a time.
    """

    make: PointMaker


@dataclass(frozen=True)
class NewPointsTogether:
    """A method that makes points with waveforms from all drives together; they go into a file.

    Attributes
    ----------
    make : callable
        The points, some at a time.
    descriptor : WaveformDescriptor
        How their waveforms are coded.
    """

    make: JointPointMaker
    descriptor: WaveformDescriptor


# Drives of one survey, control points, whom to tell.
SurveyRegistrar = Callable[[Sequence[Drive], Sequence[ControlPoint], Monitor], SurveyRegistration]


@dataclass(frozen=True)
class SurveyCorrection:
    """A method that says how the drives of a survey are to be moved.

    Attributes
    ----------
    register : callable
        The corrections of all drives.
    """

    register: SurveyRegistrar


PointMethod = PerPoint | PerPointOfDrive | PerDrive | Together
"""Says something about every point."""

FindingMethod = Finder | SurveyFinder
"""Finds things, which a person accepts or rejects."""

ToolMethod = (
    PointMethod | FindingMethod | Comparison | NewPoints | NewPointsTogether | SurveyCorrection
)
"""How a tool works; :mod:`processing.tools.running.runner` knows what each needs."""


@dataclass(frozen=True)
class ToolButton:
    """The button of a tool that is run by one click or key, as its form stands.

    Attributes
    ----------
    text : Text
    key : str
        As Qt names it: ``F9``, ``Shift+F9``.
    icon : str
        Name in the icon font.
    """

    text: Text
    key: str
    icon: str


def nothing_to_remark(_drive: Drive) -> Text | None:
    """The ``remark`` of a tool that runs on any drive as its parameters stand."""
    return None


@dataclass(frozen=True)
class Tool:
    """One processing method, with all that the program has to know of it.

    Attributes
    ----------
    id : str
        The name on the command line and in provenance.
    name, explanation, group : Text
        What the panel and ``zuka tools`` show.
    needs : Needs
        What a drive must have.
    parameters : type
        A frozen dataclass of fields from :mod:`processing.core.parameters`.
    method : ToolMethod
        What it computes, and on what.
    version : int
        Raised when the same input and parameters give another result.
    gives_classes : tuple of int
        The codes that a tool with the output ``classification`` may give; a new run in a project
        takes back those of an earlier one.
    makes : tuple of str
        Ids of the catalogue's kinds that it finds; empty where somebody chooses them.
    sought : tuple of str
        Names of the parameters that say what is looked for, and where: runs of a project that
        differ in them find different things, so that none replaces what another found.
    remark : callable
        What must be given so that it can run on a drive; None where nothing must.
    button : ToolButton or None
        None where it is run from the panel alone.
    diagnostics : callable or None
        What it makes of the places about one that somebody points at in a section: of all places
        on the scanline there that it would look at with some parameters.
    scorer : Scorer or None
        How its results are held against a truth.
    asked : AskedClass or None
        The question with two answers that a tool for points is asked, and so judged by.
    """

    id: str
    name: Text
    explanation: Text
    group: Text
    needs: Needs
    parameters: type[Any]  # each tool has its own
    method: ToolMethod
    version: int = 1
    gives_classes: tuple[int, ...] = ()
    makes: tuple[str, ...] = ()
    sought: tuple[str, ...] = ()
    remark: RemarkFinder = nothing_to_remark
    button: ToolButton | None = None
    diagnostics: DiagnosticMaker | None = None
    scorer: Scorer | None = None
    asked: AskedClass | None = None

    @property
    def gives_candidates(self) -> bool:
        """Whether it finds things instead of saying something about every point."""
        return isinstance(self.method, FindingMethod)

    @property
    def outputs(self) -> tuple[OutputColumn, ...]:
        """What it says about every point; empty for a tool that says something else."""
        return self.method.outputs if isinstance(self.method, PointMethod) else ()
