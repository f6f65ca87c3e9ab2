"""An archive classified from points alone, through estimated waveforms, and by its own ones.

Each goes the way of ``zuka run``: ``waveform-estimate`` writes LAS with packets, which is imported
and given to ``waveform-classify``.

References
----------
Shinohara 2022, algorithm 5: waveforms are estimated, then classes are told from them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError
from processing.core.monitor import SilentMonitor
from processing.formats.points.waveform_output import WaveformLas
from processing.laboratory.accuracy.archives.archive_points import (
    CLASS,
    ArchivePoints,
    in_same_order,
)
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.results.made_waveforms import write_made_waveforms
from processing.recording.drive import Drive
from processing.recording.waveforms import waveforms_of
from processing.tools.running.run_shares import mark_all
from processing.tools.tool import MadePoints, NewPointsTogether
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY, WaveformClassifyParameters
from processing.tools.waveform_points import (
    WAVEFORM_ESTIMATE,
    WaveformEstimateParameters,
    make_waveforms,
)

ALONE, ESTIMATED, REAL = "points alone", "estimated waveforms", "real waveforms"


class FoundCodes(NamedTuple):
    """What was found from an input: a code for each chosen point, or why there is none."""

    codes: NDArray[np.uint8] | None
    reason: str = ""


def codes_of_inputs(
    archive: ArchivePoints, scratch: Path, pulse: Path | None = None
) -> dict[str, FoundCodes]:
    """The classes of an archive's chosen points by each input that there is.

    Parameters
    ----------
    scratch : Path
        A folder for the time of the work.
    pulse : Path, optional
        The scanner's, as ``waveform-estimate`` takes it.
    """
    asked = WaveformEstimateParameters(pulse=str(pulse or ""))
    found = {
        ALONE: _told(lambda: codes_by_points(archive, scratch / "alone")),
        ESTIMATED: _told(
            lambda: codes_through(
                archive,
                scratch / "estimated",
                make_waveforms(archive.drives, asked, SilentMonitor()),
            )
        ),
    }
    if any(waveforms_of(one) is not None for one in archive.drives):
        found[REAL] = _told(lambda: codes_by_waveforms(archive.drives, scratch / "real"))
    return found


def _told(work: Callable[[], NDArray[np.uint8]]) -> FoundCodes:
    """An input that the data refuse leaves the others their rows."""
    try:
        return FoundCodes(work())
    except UserError as error:
        return FoundCodes(None, error.line("en"))


def codes_by_points(archive: ArchivePoints, scratch: Path) -> NDArray[np.uint8]:
    """(n,) codes from points and their intensity; waveforms are left aside."""
    asked = WaveformClassifyParameters(uses_waveforms=False)
    return _classified(archive.drives, scratch, asked)


def codes_by_waveforms(drives: Sequence[Drive], scratch: Path) -> NDArray[np.uint8]:
    """(n,) codes from the waveforms that drives have, drive after drive."""
    return _classified(drives, scratch, WaveformClassifyParameters())


def codes_through(
    archive: ArchivePoints, scratch: Path, made: Iterable[MadePoints]
) -> NDArray[np.uint8]:
    """(n,) codes from waveforms that were made of the drives, written and imported again."""
    scratch.mkdir(parents=True)
    method, info = WAVEFORM_ESTIMATE.method, archive.drives[0].info
    if not isinstance(method, NewPointsTogether):
        raise TypeError(WAVEFORM_ESTIMATE.id)
    description = WaveformLas(info.crs, info.scale, info.offset, method.descriptor)
    file = scratch / "estimated.las"
    write_made_waveforms(file, made, description, SilentMonitor())
    imported = import_drives(ImportRequest((file,)), scratch / "drives", SilentMonitor())
    drives = [Drive(one) for one in imported]
    codes = codes_by_waveforms(drives, scratch / "classes")
    places = np.concatenate([one.xyz(slice(0, one.count)) for one in drives])
    return codes[in_same_order(archive.xyz, places)]


def _classified(
    drives: Sequence[Drive], scratch: Path, asked: WaveformClassifyParameters
) -> NDArray[np.uint8]:
    scratch.mkdir(parents=True, exist_ok=True)
    mark_all(WAVEFORM_CLASSIFY.id, drives, SilentMonitor(), into=scratch, parameters=asked)
    return np.concatenate([np.array(one.columns[CLASS], np.uint8) for one in drives])
