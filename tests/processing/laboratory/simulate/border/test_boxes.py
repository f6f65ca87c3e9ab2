"""Boxes on walks: people still pass, nothing stands in something else."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.border.boxes import (
    add_boxes,
    bench,
    letter_box,
    planter,
    shelter,
    switch_box,
)
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePosition, FreePositions
from processing.laboratory.simulate.street.styles import URBAN


@pytest.mark.parametrize("make", [switch_box, letter_box, planter, bench, shelter])
def test_a_piece_is_as_long_and_deep_as_it_says(make: object) -> None:
    for number in range(10):
        assert callable(make)
        piece = make(chance(number, "test"))
        vertices = np.concatenate([shape[0] for shape, _ in piece.parts])
        assert np.ptp(vertices[:, 0]) <= piece.long_m + 1e-9
        assert np.ptp(vertices[:, 1]) <= piece.deep_m + 1e-9
        assert vertices[:, 2].min() < 0, "it reaches into the ground"


def test_a_metre_of_the_walk_stays_free_beside_each_box() -> None:
    boxes = 0
    for seed in range(3):
        street = Street(seed, URBAN, 100.0)
        for row in street.within(0.0, 100.0):
            section = street.bare_section(row)
            positions, built = FreePositions(section), SectionBuilder(1)
            add_boxes(positions, built)
            boxes += len(built.things)
            for side in (1, -1):
                walk = section.plan.side(side).band("walk")
                if walk is None:
                    continue
                for low, high, near, far in positions._blocked:
                    if np.sign(near) != side:
                        continue
                    inner, outer = sorted((abs(near), abs(far)))
                    assert walk.inner_m < inner
                    assert outer < walk.outer_m
                    assert max(inner - walk.inner_m, walk.outer_m - outer) > 0.99
                    assert not positions.is_free(
                        FreePosition((low + high) / 2, (near + far) / 2), 0.1
                    )
    assert boxes > 5
