"""What is known of a file's points while they go into columns: small enough to be noted often."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from processing.project.importing.import_request import Labels
from processing.recording.columns.quantisation import Quantisation

Integers3 = tuple[int, int, int]
PointRun = tuple[int, int, int]

NO_LOWEST: Integers3 = (2**62,) * 3
NO_HIGHEST: Integers3 = (-(2**62),) * 3


@dataclass
class Stream:
    """The points of one scanner in a file, in the file's order.

    Attributes
    ----------
    names : tuple of str
        Its columns.
    count : int
        Points so far.
    lowest, highest : tuple of int
        Extent, integers of the quantisation they are written on.
    first_time, last_time : float
        NaN before the first point with a time.
    has_times : bool
        Whether every point has one, or had one before it to take.
    is_in_time_order : bool
        Whether times never went back.
    runs : list of (int, int, int)
        Start in the stream, points, index of the first in the file: points that are consecutive
        in both.
    is_indexed : bool
        Whether the column ``source_index`` says it instead.
    """

    scanner: int
    names: tuple[str, ...]
    count: int = 0
    lowest: Integers3 = NO_LOWEST
    highest: Integers3 = NO_HIGHEST
    first_time: float = float("nan")
    last_time: float = float("nan")
    has_times: bool = True
    is_in_time_order: bool = True
    runs: list[PointRun] = field(default_factory=list)
    is_indexed: bool = False


@dataclass
class FileRecord:
    """How far a file is.

    Attributes
    ----------
    done : int
        Points of the file that are in columns.
    streams : list of Stream
        In the order of their first points.
    sha256 : str
        Checksum of the file; empty until it is read to its end.
    in_parts : bool
        Whether its columns are folders of its own, one for each stream.
    """

    in_parts: bool
    done: int = 0
    streams: list[Stream] = field(default_factory=list)
    sha256: str = ""

    @property
    def is_whole(self) -> bool:
        """Whether the file was read to its end."""
        return bool(self.sha256)

    def to_json(self) -> dict[str, Any]:
        """For :func:`record_from`; the values are JSON's."""
        return asdict(self)


def record_from(values: dict[str, Any]) -> FileRecord:
    """A record as it was noted.

    Raises
    ------
    TypeError, KeyError, ValueError
        It is no record.
    """
    streams = []
    for one in values["streams"]:
        runs = [(int(a), int(b), int(c)) for a, b, c in one["runs"]]
        low, high = ((int(v[0]), int(v[1]), int(v[2])) for v in (one["lowest"], one["highest"]))
        given = {**one, "names": tuple(one["names"]), "runs": runs, "lowest": low, "highest": high}
        streams.append(Stream(**given))
    return FileRecord(**{**values, "streams": streams})


@dataclass(frozen=True)
class FilePlacement:
    """Where the points of a file go if they are what its header and its ends promise.

    Attributes
    ----------
    folder : str
        Of the columns.
    first : int
        Points of other files before these.
    scanner : int
        Of all points.
    names : tuple of str
        Columns of all points.
    quantisation : Quantisation
        To which coordinates are moved.
    """

    folder: str
    first: int
    scanner: int
    names: tuple[str, ...]
    quantisation: Quantisation


@dataclass(frozen=True)
class FileJob:
    """A file to be read into columns.

    Attributes
    ----------
    number : int
        Of the file in the import.
    format : str
        As :class:`processing.formats.points.delivered.point_chunk.PointFileInfo` names it.
    count : int
        Points it is said to have.
    size, modified_ns : int
        What it was like when the import began.
    quantisation : Quantisation
        Its own.
    scanner_column : str
        The column that tells scanners apart.
    keeps_angles, has_labels : bool
        Whether scan angles are wanted; whether any file has labels.
    columns : tuple of str
        What the columns of text are taken for; empty where the file says it.
    position : FilePlacement or None
        None: each scanner's points go to a folder of their own below ``parts``.
    """

    number: int
    path: str
    format: str
    count: int
    size: int
    modified_ns: int
    quantisation: Quantisation
    scanner_column: str
    keeps_angles: bool
    has_labels: bool
    labels: Labels
    parts: str
    position: FilePlacement | None = None
    columns: tuple[str, ...] = ()


def job_from(values: dict[str, Any]) -> FileJob:
    """A job that came as JSON from ``dataclasses.asdict``."""
    position = values["position"]
    if position is not None:
        kept = {
            "names": tuple(position["names"]),
            "quantisation": _quantisation(position["quantisation"]),
        }
        position = FilePlacement(**{**position, **kept})
    made = {
        "quantisation": _quantisation(values["quantisation"]),
        "columns": tuple(values["columns"]),
    }
    return FileJob(**{**values, **made, "position": position})


def _quantisation(values: dict[str, Any]) -> Quantisation:
    (a, b, c), (d, e, f) = values["scale"], values["offset"]
    return Quantisation((a, b, c), (d, e, f))
