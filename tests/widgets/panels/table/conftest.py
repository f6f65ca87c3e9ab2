"""The table of features over a map with poles."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from tests.widgets.builders import OpenMap
from tests.widgets.panels.table_user import MapWithPoles
from widgets.panels.table.feature_table import FeatureTable


@pytest.fixture
def open_map() -> OpenMap:
    return MapWithPoles()


@pytest.fixture
def table(qtbot: QtBot, open_map: OpenMap) -> FeatureTable:
    made = FeatureTable(open_map, open_map.shared, "en")
    made.change_requested.connect(open_map.apply)
    qtbot.addWidget(made)
    made.resize(1000, 400)
    made.show()
    return made
