"""Few labels are told tile by tile, very many drive by drive: every view hears of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from app.document import label_news
from processing.image.attributes.tile_cache import TileCache
from processing.map.label_change import LabelChange
from tests.widgets.builders import imported_drive
from widgets.shared.map_changes import MapChanges


@pytest.mark.parametrize("are_many", [False, True])
def test_a_change_of_labels_is_told_to_views(
    qapp: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, are_many: bool
) -> None:
    drive = imported_drive(tmp_path / "street")
    points = np.arange(40)
    parts = [points[:20], points[20:]]
    changes = tuple(
        (drive, LabelChange.of(drive.id, one, np.zeros(20, np.uint8), np.full(20, 2, np.uint8)))
        for one in parts
    )
    monkeypatch.setattr(label_news, "_MANY_POINTS", 39 if are_many else 40)
    map_changes, tiles = MapChanges(), TileCache()
    reported: list[tuple[str, int]] = []
    columns: list[str] = []
    map_changes.labels_changed.connect(lambda id_, some: reported.append((id_, some.size)))
    map_changes.drive_columns_changed.connect(columns.append)
    label_news.report_labels(changes, (), tiles, map_changes)
    tiles.close()
    assert reported == ([(drive.id, 0)] if are_many else [(drive.id, 20), (drive.id, 20)])
    assert columns == ([drive.id] if are_many else [])
