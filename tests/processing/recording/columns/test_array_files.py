"""Arrays are read whole from many threads at once, and damage is told."""

from __future__ import annotations

import ast
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from processing.recording.columns.array_files import read_array, read_arrays


def test_threads_that_read_and_parse_at_once_all_get_their_arrays(tmp_path: Path) -> None:
    one, many = tmp_path / "one.npy", tmp_path / "many.npz"
    np.save(one, np.arange(5.0))
    np.savez(many, a=np.arange(3), b=np.ones((2, 2)))

    def read(number: int) -> float:
        ast.parse("[" * 20 + "1" + "]" * 20)
        return float(read_array(one).sum() + read_arrays(many)["b"].sum() + number * 0)

    with ThreadPoolExecutor(max_workers=8) as pool:
        assert set(pool.map(read, range(400))) == {14.0}


def test_what_is_no_array_is_told(tmp_path: Path) -> None:
    path = tmp_path / "broken.npz"
    path.write_bytes(b"PK\x03\x04 broken")
    with pytest.raises((ValueError, OSError, zipfile.BadZipFile)):
        read_arrays(path)
    with pytest.raises(FileNotFoundError):
        read_array(tmp_path / "missing.npy")
