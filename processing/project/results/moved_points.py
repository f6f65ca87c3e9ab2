"""Points where a correction puts them: the delivered files again, in their order, into a folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from processing.core.monitor import Monitor, PartMonitor
from processing.core.scratch_folder import scratch_folder
from processing.core.text import Text
from processing.formats.points.las_results import MOVED, write_results
from processing.formats.points.waveform_output import copy_packets
from processing.project.results.delivered_order import DeliveredOrder, Values
from processing.project.results.delivered_packets import DeliveredPackets
from processing.project.results.label_export import names_of_outputs
from processing.project.sources.source_check import require_delivered
from processing.recording.drive import Drive

_DEALING = 0.2
_WRITING = Text("Writing {name}", "{name} を書き込み中")


def write_moved_points(drives: Sequence[Drive], folder: Path, monitor: Monitor) -> dict[Path, Path]:
    """Write the points of every delivered file where the drives' corrections put them.

    All else is as delivered, in the delivered order. Files keep their names; those that aren't
    LAS or LAZ become LAZ.

    Parameters
    ----------
    folder : Path
        An empty one.

    Returns
    -------
    dict
        From each delivered file to what was written of it.

    Raises
    ------
    MissingInput, BadFile
        A delivered file is no longer where it was, or is another one now.
    NoSpace, Cancelled
    """
    noted = {
        drive.source_path(one): one for drive in drives for one in drive.info.sources if one.points
    }
    for source, one in noted.items():
        require_delivered(one, source, monitor.check)
    sources = sorted(noted)
    paths = {
        source: folder / name
        for source, name in zip(sources, names_of_outputs(sources), strict=True)
    }
    packets = DeliveredPackets(drives)
    with scratch_folder(folder) as scratch:
        order = DeliveredOrder(drives, _moved, scratch)
        order.prepare(PartMonitor(monitor, 0.0, _DEALING))
        share = (1.0 - _DEALING) / max(1, len(paths))
        for number, (source, path) in enumerate(paths.items()):
            first = _DEALING + number * share
            monitor.report(first, _WRITING.filled(name=path.name))
            part = PartMonitor(monitor, first, first + share)

            def moved(start: int, stop: int, source: Path = source) -> Values:
                return order.values(source, start, stop)

            write_results(source, path, moved, part, columns=noted[source].columns)
            beside = packets.to_copy(source, Path(path.name))
            if beside is not None:
                copy_packets(beside[0], folder / beside[1].name, part)
    return paths


def _moved(drive: Drive, start: int, stop: int) -> Values:
    return {MOVED: drive.coordinates.moved_m(start, stop)}
