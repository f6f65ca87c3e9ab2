"""What files that were dropped on the window are: told by their content, not by their names."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.text import Text
from processing.formats.format import DELIVERED, Content
from processing.formats.format_list import FormatList
from processing.formats.registry import FORMATS
from processing.project.importing.importing import ImportRequest

_LOOKED_AT = 4096


def request_of_files(
    files: tuple[Path, ...], crs: str, formats: FormatList = FORMATS
) -> ImportRequest:
    """Sort files into points, trajectories and image lists; folders are looked into once.

    Parameters
    ----------
    formats : FormatList
        Those that can be in a delivery.

    Raises
    ------
    MissingInput
        There are no point files among them, or a file can't be read.
    """
    request = additions_of_files(files, crs, formats)
    if not request.inputs:
        raise MissingInput(
            Text("There are no point files among them.", "点群ファイルが含まれていません。"),
            Text.same(", ".join(path.name for path in files)),
            _what_to_choose(formats),
        )
    return request


def additions_of_files(
    files: tuple[Path, ...], crs: str, formats: FormatList = FORMATS
) -> ImportRequest:
    """As :func:`request_of_files`, for a project with drives: points need not be among them.

    Raises
    ------
    MissingInput
        A file can't be read.
    """
    sorted_out: dict[Content, list[Path]] = {content: [] for content in DELIVERED}
    for path in _unfold_folders(files, formats):
        sorted_out[content_of(path, formats)].append(path)
    points, trajectories, images = sorted_out.values()
    return ImportRequest(tuple(points), tuple(trajectories), tuple(images), crs)


def content_of(path: Path, formats: FormatList = FORMATS) -> Content:
    """What a file holds: points, a trajectory or an image list.

    Points where nothing says otherwise: their reader says what it misses.

    Raises
    ------
    MissingInput
        It can't be read.
    """
    if formats.says_points_alone(path) or path.is_dir():
        return Content.POINTS
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LOOKED_AT)
    found = formats.recognised(start, *DELIVERED)
    return Content.POINTS if found is None else found[1]


def is_folder_of_files(path: Path, formats: FormatList = FORMATS) -> bool:
    """Whether a path is a folder of delivered files, and not itself what one format delivers."""
    return path.is_dir() and formats.folder_format(path) is None


def _unfold_folders(files: tuple[Path, ...], formats: FormatList) -> list[Path]:
    endings = formats.endings_read(*DELIVERED)
    found: list[Path] = []
    for path in files:
        with report_as_user_error(path):
            if is_folder_of_files(path, formats):
                inside = sorted(path.iterdir())
                found += [one for one in inside if one.suffix.lower() in endings]
            else:
                found.append(path)
    return found


def _what_to_choose(formats: FormatList) -> Text:
    names = [one.name for one in formats.read(Content.POINTS)]
    return Text(
        "Choose point files ({en}), with the trajectory beside them.",
        "点群ファイル（{ja}）を、軌跡ファイルとともに選んでください。",
    ).filled(en=", ".join(name.en for name in names), ja="・".join(name.ja for name in names))
