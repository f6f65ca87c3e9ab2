"""Columns that somebody named are kept with the drive: its results read the file the same way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.monitor import SilentMonitor
from processing.project.importing.import_request import (
    describe_request,
    digest_of,
    marks_of,
    request_from,
)
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.results.label_export import write_labelled_points
from processing.recording.drive import Drive

VALUES = np.round(np.random.default_rng(3).uniform(0, 30, (800, 4)), 3)


@pytest.fixture
def request_(tmp_path: Path) -> ImportRequest:
    path = tmp_path / "points.txt"
    np.savetxt(path, VALUES, header="x y z", fmt="%.3f")
    return ImportRequest((path,), columns=("-", "y", "x", "z"))


def test_results_read_the_file_as_the_import_did(tmp_path: Path, request_: ImportRequest) -> None:
    (folder,) = import_drives(request_, tmp_path / "drives", SilentMonitor())
    drive = Drive(folder)
    assert drive.info.sources[0].columns == ("-", "y", "x", "z")
    np.testing.assert_allclose(drive.info.lowest, VALUES[:, [2, 1, 3]].min(axis=0), atol=1e-3)
    drive.columns.add("label", np.full(drive.count, 6, np.uint8))
    write_labelled_points([drive], lambda name: tmp_path / name, SilentMonitor())
    written = laspy.read(tmp_path / "points.laz")
    np.testing.assert_allclose(written.xyz, VALUES[:, [2, 1, 3]], atol=1e-3)


def test_an_import_that_goes_on_knows_the_answer(request_: ImportRequest) -> None:
    marks = marks_of(request_)
    assert request_from(describe_request(request_, marks)) == (request_, marks)
    other = replace(request_, columns=("-", "x", "y", "z"))
    assert digest_of(describe_request(other, marks)) != digest_of(describe_request(request_, marks))


def test_a_request_without_an_answer_is_written_down_as_ever(request_: ImportRequest) -> None:
    plain = replace(request_, columns=())
    assert "columns" not in describe_request(plain, marks_of(plain))
