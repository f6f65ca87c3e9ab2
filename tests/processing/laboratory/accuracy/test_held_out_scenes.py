"""The table of scenes that nobody looked at."""

from __future__ import annotations

import numpy as np

from processing.laboratory.accuracy.filters.held_out_scenes import unseen_rows


def test_every_scene_has_a_row_and_each_kind_of_knowledge_its_middle() -> None:
    head, *rows = list(unseen_rows((902, 903), 30_000))
    assert {len(row) for row in rows} == {len(head)}
    assert [row[0] for row in rows] == ["beams"] * 3 + ["places"] * 3
    assert [row[1] for row in rows if row[2]][:2] == ["standing 902", "mobile 903"]
    middle = head.index("**F**")
    for group in (rows[:3], rows[3:]):
        assert group[-1][1] == "**middle**"
        of_scenes = [float(row[middle]) for row in group[:-1]]
        assert abs(float(group[-1][middle]) - np.median(of_scenes)) < 0.002
