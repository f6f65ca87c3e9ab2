"""What files that were dropped on the window are: told by their content, not by their names."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.text import Text
from processing.formats.points.point_files import POINT_ENDINGS, TEXT_ENDINGS
from processing.formats.points.pulse_folder import is_pulse_folder
from processing.formats.trajectories.trajectory_files import TRAJECTORY_ENDINGS
from processing.project.importing.importing import ImportRequest

_TRAJECTORY_WORDS = (b"time_s,easting_m", b"heading", b"azimuth")
_IMAGE_WORD = b"omega_deg"
_SBET_RECORD = 136
POINTS, TRAJECTORY, IMAGES = "points", "trajectory", "images"

DELIVERED_ENDINGS = (*POINT_ENDINGS, *TEXT_ENDINGS, *TRAJECTORY_ENDINGS)
"""How the names of files end that may belong to a delivery: points, trajectories, image lists."""


def request_of_files(files: tuple[Path, ...], crs: str) -> ImportRequest:
    """Sort files into points, trajectories and image lists; folders are looked into once.

    Raises
    ------
    MissingInput
        There are no point files among them, or a file can't be read.
    """
    request = additions_of_files(files, crs)
    if not request.inputs:
        raise MissingInput(
            Text("There are no point files among them.", "点群ファイルが含まれていません。"),
            Text.same(", ".join(path.name for path in files)),
            Text(
                "Choose point files (LAS, LAZ, PLY, PCD, E57, PTX, text), with the trajectory "
                "beside them.",
                "点群ファイル（LAS・LAZ・PLY・PCD・E57・PTX・テキスト）を、軌跡ファイルとともに"
                "選んでください。",
            ),
        )
    return request


def additions_of_files(files: tuple[Path, ...], crs: str) -> ImportRequest:
    """As :func:`request_of_files`, for a project with drives: points need not be among them.

    Raises
    ------
    MissingInput
        A file can't be read.
    """
    sorted_out: dict[str, list[Path]] = {POINTS: [], TRAJECTORY: [], IMAGES: []}
    for path in _unfolded(files):
        sorted_out[content_of(path)].append(path)
    points, trajectories, images = sorted_out.values()
    return ImportRequest(tuple(points), tuple(trajectories), tuple(images), crs)


def _unfolded(files: tuple[Path, ...]) -> list[Path]:
    found: list[Path] = []
    for path in files:
        with report_as_user_error(path):
            if is_pulse_folder(path):
                found.append(path)
            elif path.is_dir():
                inside = sorted(path.iterdir())
                found += [one for one in inside if one.suffix.lower() in DELIVERED_ENDINGS]
            else:
                found.append(path)
    return found


def content_of(path: Path) -> str:
    """What a file holds: `POINTS`, `TRAJECTORY` or `IMAGES`.

    Raises
    ------
    MissingInput
        It can't be read.
    """
    if path.suffix.lower() in POINT_ENDINGS or path.is_dir():
        return POINTS
    with report_as_user_error(path):
        size = path.stat().st_size
        with path.open("rb") as file:
            start = file.read(2048)
    first_line = start.splitlines()[0].lower() if start else b""
    if _IMAGE_WORD in first_line:
        return IMAGES
    is_table = any(word in first_line for word in _TRAJECTORY_WORDS)
    is_sbet = b"\0" in start and size % _SBET_RECORD == 0
    return TRAJECTORY if is_table or is_sbet else POINTS
