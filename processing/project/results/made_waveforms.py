"""Points that a tool made with waveforms, as LAS with a ``.wdp`` beside it."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path

import numpy as np

from processing.core.monitor import Monitor
from processing.formats.points.waveform_output import (
    WaveformLas,
    WaveformRecords,
    write_waveform_las,
)
from processing.tools.tool import MadePoints


def write_made_waveforms(
    output: Path,
    made: Iterable[MadePoints],
    description: WaveformLas,
    monitor: Monitor,
    *,
    never: Collection[Path] = (),
) -> None:
    """Write points and their packets, part by part as the tool makes them.

    Parameters
    ----------
    output : Path
        ``.las``; the packets go into a ``.wdp`` of the same name.
    made : iterable of MadePoints
        All with packets.
    never : collection of Path
        Delivered files, which are not to be overwritten.

    Raises
    ------
    TypeError
        Points came without packets.
    UserError, Cancelled
        Nothing was written.
    """
    records = (_records_of(one, description) for one in made)
    write_waveform_las(output, records, description, monitor, never=never)


def _records_of(made: MadePoints, description: WaveformLas) -> WaveformRecords:
    packets = made.packets
    if packets is None:
        raise TypeError(description)
    steps = (made.xyz - np.asarray(description.offset)) / np.asarray(description.scale)
    columns = {"xyz": np.rint(steps).astype(np.int64), **made.columns}
    return WaveformRecords(
        columns, packets.packet, packets.location_ps, packets.direction, packets.samples
    )
