"""Classes of single scans of a spinning head, whose truth is known; what is one."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.laboratory.class_training.examples import NOISE
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.spinning_head import spinning_scans
from processing.laboratory.simulate.street.styles import style_of
from processing.methods.classes.aerial_cells import density_of, is_from_air
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.recording.columns.source_order import sources_of
from processing.recording.density import is_single_scan, points_a_place, spread_of
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import ConfusionMatrix
from processing.tools.classify import ClassifyParameters
from processing.tools.running.runner import RunRequest, columns_of, run_together


@pytest.fixture(scope="module")
def turns(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Drive, NDArray[np.uint8]]]:
    """Three single scans of a street of a seed that nothing was learnt from."""
    folder = tmp_path_factory.mktemp("turns")
    found = []
    for number, scan in enumerate(spinning_scans(Street(4204, style_of("urban"), 120.0), 3)):
        header = laspy.LasHeader(point_format=6, version="1.4")
        header.offsets, header.scales = scan.xyz.min(axis=0), np.full(3, 0.001)
        points = laspy.LasData(header)
        points.x, points.y, points.z = scan.xyz.T
        points.intensity = scan.intensity
        path = folder / f"一回転{number}.laz"
        points.write(path)
        (drive,) = import_drives(ImportRequest((path,)), folder / str(number), SilentMonitor())
        imported = Drive(drive)
        _, indices = sources_of(
            imported.columns, imported.info.source_runs, 0, imported.count, sources=1
        )
        found.append((imported, scan.labels[indices]))
    return found


def test_single_scans_are_told_from_flights(
    turns: list[tuple[Drive, NDArray[np.uint8]]],
) -> None:
    for drive, _ in turns:
        assert is_single_scan(drive)
        assert density_of([drive]).unevenness > 2
        assert not is_from_air(drive)


def test_single_scans_are_classified_and_the_result_says_by_which_model(
    turns: list[tuple[Drive, NDArray[np.uint8]]], tmp_path: Path
) -> None:
    true, said = [], []
    for number, (drive, codes) in enumerate(turns):
        request = RunRequest("classify", drive, ClassifyParameters())
        result = run_together(request, SilentMonitor(), into=tmp_path / str(number))
        said.append(np.array(columns_of(result.columns[0])["classification"]))
        true.append(codes)
        assert "single scans" in result.note.en
        assert "単独スキャン" in result.note.ja
    truth, found = np.concatenate(true), np.concatenate(said)
    is_asked = ~np.isin(truth, NOISE)
    matrix = ConfusionMatrix.of(truth[is_asked], found[is_asked])
    on_ground = matrix.against_rest((2, 3, 11, 67))
    assert on_ground.f_measure > 0.9
    assert matrix.against_rest((6,)).f_measure > 0.8


def test_places_are_counted_where_there_are_points_alone() -> None:
    cube = np.array([[0.1, 0.1, 0.1]])
    far = cube + np.array([[40.0, 0.0, 0.0]])
    assert points_a_place(np.repeat(cube, 9, axis=0)) == 9
    assert points_a_place(np.concatenate([np.repeat(cube, 9, axis=0), far, far + 4.0])) == 1
    assert np.isinf(points_a_place(np.empty((0, 3))))


def test_points_along_a_path_are_spread_evenly_and_those_of_one_scanner_are_not() -> None:
    along = np.zeros((1001, 3))
    along[:, 0] = np.linspace(-50.0, 50.0, 1001)
    assert spread_of(along) == pytest.approx(0.5 / 0.95, rel=0.01)
    gathered = along**3 / 50.0**2
    assert spread_of(gathered) == pytest.approx((0.5 / 0.95) ** 3, rel=0.02)
    assert spread_of(np.zeros((3, 3))) == 1
    assert spread_of(np.empty((0, 3))) == 1
