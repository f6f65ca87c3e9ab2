"""The sections of a kept volume as a file of arrays."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine
from processing.project.volumes.volume_facts import damaged
from processing.recording.columns.array_files import read_arrays

SectionSpans = tuple[tuple[float, float], ...]


def write_sections(path: Path, line: SectionedLine, between: SectionSpans) -> None:
    """Write a line with its sections.

    Parameters
    ----------
    between : tuple of (float, float)
        Cut and fill from one section to the next, m³; may be empty.
    """
    sections = line.sections
    with path.open("wb") as file:
        np.savez(
            file,
            name=np.array(line.name),
            xy=line.xy,
            start_m=np.array(line.start_m),
            between=np.array(between, np.float64).reshape(-1, 2),
            station_m=np.array([one.station_m for one in sections]),
            names=np.array([one.name for one in sections], np.str_),
            count=np.array([len(one.offsets) for one in sections], np.int64),
            offsets=_join_parts([one.offsets for one in sections]),
            before=_join_parts([one.before for one in sections]),
            after=_join_parts([one.after for one in sections]),
            has_boundary=np.array([one.is_inside is not None for one in sections], np.bool_),
            is_inside=_join_parts([_inside_of(one) for one in sections]).astype(np.bool_),
            areas=np.array([(one.cut_m2, one.fill_m2) for one in sections]).reshape(-1, 2),
        )


def read_sections(path: Path) -> tuple[SectionedLine, SectionSpans]:
    """What :func:`write_sections` wrote.

    Raises
    ------
    BadFile
        The file is damaged.
    """
    try:
        with report_as_user_error(path):
            arrays = read_arrays(path)
        return _line_of(arrays), tuple((cut, fill) for cut, fill in arrays["between"].tolist())
    except (ValueError, KeyError, IndexError, EOFError, BadZipFile) as error:
        raise damaged(path) from error


def _line_of(arrays: dict[str, NDArray[Any]]) -> SectionedLine:
    ends = np.cumsum(arrays["count"])[:-1]
    steps = np.cumsum(arrays["count"] - 1)[:-1]
    offsets, before, after = (
        np.split(arrays[name], ends) for name in ("offsets", "before", "after")
    )
    inside = np.split(arrays["is_inside"], steps)
    sections = tuple(
        DrawnSection(
            float(arrays["station_m"][number]),
            str(arrays["names"][number]),
            offsets[number],
            before[number],
            after[number],
            float(arrays["areas"][number, 0]),
            float(arrays["areas"][number, 1]),
            inside[number] if arrays["has_boundary"][number] else None,
        )
        for number in range(len(arrays["count"]))
    )
    return SectionedLine(str(arrays["name"]), arrays["xy"], float(arrays["start_m"]), sections)


def _inside_of(section: DrawnSection) -> NDArray[np.bool_]:
    if section.is_inside is None:
        return np.ones(len(section.offsets) - 1, np.bool_)
    return section.is_inside


def _join_parts(parts: list[NDArray[Any]]) -> NDArray[Any]:
    return np.concatenate(parts) if parts else np.empty(0)
