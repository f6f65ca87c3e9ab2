from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from processing.methods.earthwork.as_built import cell_medians as module
from processing.methods.earthwork.as_built.cell_medians import cell_medians


@given(st.data(), st.integers(0, 60))
def test_medians_are_numpy_s(data: st.DataObject, count: int) -> None:
    cells = data.draw(arrays(np.int32, count, elements=st.integers(0, 6)))
    values = data.draw(arrays(np.float32, count, elements=st.floats(-2, 2, width=32)))
    found = cell_medians(cells, values, 7)
    for cell in range(7):
        held = values[cells == cell]
        wanted = np.median(held) if len(held) else np.float32(np.nan)
        np.testing.assert_allclose(found[cell], wanted, atol=1e-6)


def test_kernels_do_as_plain_python_does() -> None:
    cells, values = np.array([2, 0, 2, 2], np.int32), np.array([3, 1, 2, 9], np.float32)
    starts = np.array([0, 1, 1, 4])
    counts = np.zeros(3, np.int64)
    module._count_kernel.py_func(cells, counts)
    assert counts.tolist() == [1, 0, 3]
    gathered, medians = np.zeros(4, np.float32), np.full(3, np.nan, np.float32)
    module._gather_kernel.py_func(cells, values, starts[:-1].copy(), gathered)
    module._median_kernel.py_func(gathered, starts, medians)
    np.testing.assert_array_equal(medians, cell_medians(cells, values, 3))
