"""What a tool looks at is told whichever tool is asked first of a drive."""

from __future__ import annotations

from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from processing.image.scan_lines.scanlines import ScanlineSettings, scanline_through
from processing.methods.road.diagnostics import Diagnostic
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from tests.processing.methods.road.bad_recordings import (
    HEAD_45,
    ORIGIN,
    DrivenRecording,
    delivered,
    facing_along,
    imported,
    road_along,
    straight,
)

LENGTH_M = 12.0
LONGEST_S = 120.0
ASKED = sorted(id_ for id_, tool in TOOLS.items() if tool.diagnostics is not None)


@pytest.fixture(scope="module")
def street(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of a drive along a bare road."""
    way, folder = straight(LENGTH_M), tmp_path_factory.mktemp("road")
    driven = DrivenRecording(
        way, facing_along(way), (road_along(LENGTH_M),), head=HEAD_45, pulses=800
    )
    return imported(folder, delivered(driven, folder))[0].folder


@pytest.mark.parametrize("tool", ASKED)
def test_a_tool_that_is_asked_first_answers(street: Path, tool: str) -> None:
    drive = Drive(street)
    place = np.array([LENGTH_M / 2, 0.0, 0.0]) + ORIGIN
    scanlines = scanline_through(drive, place, ScanlineSettings())
    assert scanlines is not None
    told: list[tuple[Diagnostic, ...]] = []

    def ask() -> None:
        asked = TOOLS[tool]
        assert asked.diagnostics is not None
        position = RequestedPosition(drive, place, scanlines)
        told.append(tuple(asked.diagnostics(position, asked.parameters())))

    asking = Thread(target=ask, daemon=True)
    asking.start()
    asking.join(LONGEST_S)
    assert len(told) == 1
