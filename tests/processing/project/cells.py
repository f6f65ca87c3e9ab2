"""A drive as an import leaves it where it finds no revolutions: by cells of the top view."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.recording.columns.ordering import sort_points
from processing.recording.drive import Drive
from processing.recording.drive_info import write_drive_info
from processing.recording.without_revolutions.top_view import top_view_of
from tests.older_project import forget_all_sums


def order_by_cells(folder: Path) -> None:
    """Order a finished drive folder, whose points have rows, for the top view."""
    drive = Drive(folder)
    view = top_view_of(
        drive.xyz(slice(None)),
        drive.count,
        np.array(drive.info.lowest),
        np.array(drive.info.highest),
    )
    files, indices = drive.sources(0, drive.count)
    forget_all_sums(folder)
    cells = view.cells_of(drive.xyz(slice(None)))
    files.astype("<u2").tofile(folder / "source_file.bin")
    indices.astype("<i8").tofile(folder / "source_index.bin")
    cells.astype("<i8").tofile(folder / "pulse.bin")
    names = tuple(path.stem for path in folder.glob("*.bin"))

    def by_cell(columns):
        return columns["pulse"], -columns["xyz"][:, 2].astype(np.int64)

    sort_points(folder, names, drive.count, by_cell, SilentMonitor())
    (folder / "revolutions.npz").unlink()
    for path in folder.glob("image_rows_*"):
        path.unlink()
    write_drive_info(
        folder,
        replace(
            drive.info,
            rows_by="top-view",
            rows_reason=Text.same("no turns"),
            cell_m=view.cell_m,
            cells_per_row=view.cells_per_row,
            source_runs=(),
        ),
    )
