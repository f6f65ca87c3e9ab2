"""The true classes of a drive's points, from the files beside a delivery."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive


def labels_of_drive(drive: Drive, truth: Path) -> NDArray[np.uint8]:
    """(n,) the true classes of a drive's points, from ``FILE.labels.npy`` of its files."""
    files, indices = sources_of(
        drive.columns, drive.info.source_runs, 0, drive.count, sources=len(drive.info.sources)
    )
    labels = np.zeros(drive.count, np.uint8)
    for number, source in enumerate(drive.info.sources):
        own = files == number
        labels[own] = np.load(truth / f"{Path(source.path).stem}.labels.npy")[indices[own]]
    return labels
