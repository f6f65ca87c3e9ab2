"""Of things that stand too near to each other the surest stay."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from processing.methods.road.objects.standing_apart import stand_apart

place = st.tuples(st.floats(0, 3, width=16), st.floats(0, 3, width=16))


@given(st.lists(place, max_size=30))
def test_a_thing_stays_where_no_surer_one_that_stays_is_near(
    places: list[tuple[float, float]],
) -> None:
    feet = np.array(places, np.float64).reshape(-1, 2)
    kept: list[int] = []
    for number, foot in enumerate(feet):
        if all(np.hypot(*(foot - feet[one])) >= 0.4 for one in kept):
            kept.append(number)
    assert np.flatnonzero(stand_apart(feet, 0.4)).tolist() == kept
