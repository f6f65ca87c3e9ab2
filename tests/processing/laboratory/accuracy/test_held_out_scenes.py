"""The table of scenes that nobody looked at."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.accuracy.filters.held_out_scenes import unseen_rows
from processing.laboratory.noise_training import recordings


def test_every_scene_has_a_row_and_each_kind_of_knowledge_its_middle(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recordings, "_PULSES", (60_000, 60_001))
    head, *rows = list(unseen_rows((902, 914), tmp_path))
    assert {len(row) for row in rows} == {len(head)}
    assert [row[0] for row in rows] == ["beams"] * 3 + ["places"] * 3
    assert [row[1] for row in rows if row[2]][1:3] == ["standing 914", "airborne 902"]
    middle = head.index("**F**")
    for group in (rows[:3], rows[3:]):
        assert group[-1][1] == "**middle**"
        of_scenes = [float(row[middle]) for row in group[:-1]]
        assert abs(float(group[-1][middle]) - np.median(of_scenes)) < 0.002
