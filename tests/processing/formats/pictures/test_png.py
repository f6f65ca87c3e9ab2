"""Pictures written by strips are what any reader of PNG sees."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.formats.pictures.png import write_png


@given(rows=st.integers(1, 40), columns=st.integers(1, 40), strip=st.integers(1, 50))
def test_a_picture_by_strips_is_read_as_it_was(
    tmp_path_factory: pytest.TempPathFactory, rows: int, columns: int, strip: int
) -> None:
    path = tmp_path_factory.mktemp("p") / "p.png"
    colours = np.random.default_rng(rows).integers(0, 256, (rows, columns, 3), dtype=np.uint8)
    write_png(path, (rows, columns), (colours[at : at + strip] for at in range(0, rows, strip)))
    np.testing.assert_array_equal(cv2.imread(str(path))[:, :, ::-1], colours)


def test_nothing_is_left_of_a_picture_whose_rows_are_missing(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="1 rows of a picture of 2"):
        write_png(tmp_path / "p.png", (2, 3), [np.zeros((1, 3, 3), np.uint8)])
    assert not list(tmp_path.iterdir())
