"""Files of one import that were measured on several dates: no drive mixes them."""

from __future__ import annotations

import json
from contextlib import closing
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, Interrupted
from processing.core.monitor import SilentMonitor
from processing.operations.export import ExportRequest, export
from processing.project.importing import import_journal, import_processes
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.importing.unfinished_imports import import_folder, unfinished_imports
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.recording.vehicle_path.clock import DAY_S, WEEK_S
from tests.earthwork_site import EarthworkSite, earthwork_site, write_site
from tests.processing.project.drawn import tree_of
from tests.processing.project.labelled import all_labels, paint, project_of

_FIRST_DATE = 3.5e8
_STANDARD = 1.35e9
_OLD = -1e8
_LONG_S = 3_600.0


@pytest.fixture(scope="module")
def sites() -> tuple[EarthworkSite, EarthworkSite]:
    return earthwork_site(1), earthwork_site(2)


@pytest.fixture(scope="module")
def delivery(
    sites: tuple[EarthworkSite, EarthworkSite], tmp_path_factory: pytest.TempPathFactory
) -> ImportRequest:
    """The scans of either date in a file, by the same two stations; the later one named first."""
    folder = tmp_path_factory.mktemp("納品")
    before = write_site(sites[0], folder / "施工前.laz", start_s=_FIRST_DATE)
    after = write_site(sites[1], folder / "施工後.laz", start_s=_FIRST_DATE + 30 * DAY_S)
    return ImportRequest((after, before))


def _imported(request: ImportRequest, into: Path) -> list[Drive]:
    return [Drive(folder) for folder in import_drives(request, into, SilentMonitor())]


def _piece(path: Path, start_s: float) -> Path:
    """A file of one scanner over an hour."""
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales = np.full(3, 0.001)
    cloud = laspy.LasData(header)
    cloud.xyz = np.random.default_rng(3).uniform(0.0, 20.0, (300, 3))
    cloud.gps_time = start_s + np.linspace(0.0, _LONG_S, 300)
    cloud.point_source_id = np.ones(300, np.uint16)
    cloud.write(str(path))
    return path


@pytest.mark.parametrize(
    ("starts_s", "drives"),
    [
        ([_FIRST_DATE, _FIRST_DATE + 30 * DAY_S], [[0], [1]]),
        ([_STANDARD, _STANDARD + 30 * DAY_S], [[0], [1]]),
        ([_OLD, _OLD + 30 * DAY_S], [[0], [1]]),
        ([_FIRST_DATE + 30 * DAY_S, _FIRST_DATE, _FIRST_DATE + _LONG_S], [[1, 2], [0]]),
        # Over midnight, and three days of work with nights between.
        ([578 * WEEK_S - 3_000.0, 578 * WEEK_S + 600.0], [[0, 1]]),
        ([_FIRST_DATE + number * 0.8 * DAY_S for number in range(4)], [[0, 1, 2, 3]]),
        # Seconds of a week: the same day of two weeks, the week's end, and Monday and Thursday.
        ([100_000.0, 110_000.0], [[0, 1]]),
        ([WEEK_S - 1.5 * _LONG_S, 600.0], [[1, 0]]),
        ([100_000.0, 100_000.0 + 3 * DAY_S], [[0], [1]]),
    ],
)
def test_files_of_one_scanner_are_one_drive_until_a_day_lies_between(tmp_path, starts_s, drives):
    paths = [_piece(tmp_path / f"{at}.las", start) for at, start in enumerate(starts_s)]
    made = _imported(ImportRequest(tuple(paths)), tmp_path / "made")
    sources = [[paths.index(Path(one.path)) for one in drive.info.sources] for drive in made]
    assert sources == drives
    assert [drive.info.name for drive in made] == [str(first) for first, *_ in drives]


def test_stations_that_share_numbers_are_drives_of_their_date_named_after_their_file(
    tmp_path, delivery, sites
):
    made = _imported(delivery, tmp_path / "made")
    names = ["施工前 (1)", "施工前 (2)", "施工後 (1)", "施工後 (2)"]
    assert [drive.info.name for drive in made] == names
    for drive, site in zip(made, np.repeat(np.array(sites, object), 2), strict=True):
        (source,) = drive.info.sources
        assert drive.info.name.startswith(Path(source.path).stem)
        _, points = drive.sources(0, drive.count)
        np.testing.assert_allclose(drive.xyz(slice(None)), site.xyz[points], atol=1e-6)
        assert (site.station[points] == drive.info.scanner).all()
        assert drive.count == source.points == (site.station == drive.info.scanner).sum()


def test_labels_painted_on_either_date_are_exported_in_the_order_of_its_file(tmp_path, delivery):
    folder = project_of(tmp_path / "現場.zuka", delivery)
    with closing(Project.open(folder)) as project:
        wanted = {path: np.zeros(len(laspy.read(path)), np.uint8) for path in delivery.inputs}
        for number, drive in enumerate(project.drives):
            paint(project, np.arange(number, drive.count, 7), 64 + number, number)
            (source,) = drive.info.sources
            wanted[Path(source.path)][drive.sources(0, drive.count)[1]] = all_labels(drive)
        request = ExportRequest(("las",), tmp_path / "out", never=delivery.inputs)
        written = export((), project.catalogue, project.crs, request, drives=project.drives)
    assert sorted(path.name for path in written) == ["施工前.laz", "施工後.laz"]
    for path in delivery.inputs:
        cloud, before = laspy.read(tmp_path / "out" / path.name), laspy.read(path)
        np.testing.assert_array_equal(cloud.gps_time, before.gps_time)
        np.testing.assert_array_equal(np.asarray(cloud["label"]), wanted[path])
        assert set(np.unique(wanted[path])) > {0}


class _EndsAt:
    """Ends the work once it has come so far."""

    def __init__(self, fraction: float) -> None:
        self._fraction = fraction
        self._is_there = False

    def report(self, fraction, text=None):
        self._is_there |= fraction >= self._fraction

    def check(self):
        if self._is_there:
            raise Interrupted


@pytest.mark.parametrize(("fraction", "fewest_points"), [(0.2, 0), (0.8, 10**9)])
def test_an_import_of_two_dates_that_ended_half_way_goes_on_to_the_same_bytes(
    tmp_path, delivery, monkeypatch, fraction, fewest_points
):
    monkeypatch.setattr(import_processes, "FEWEST_POINTS", fewest_points)
    monkeypatch.setattr(import_journal, "SECONDS", 0.0)
    whole = import_drives(delivery, tmp_path / "whole", SilentMonitor())
    with closing(Project.create(tmp_path / "現場.zuka", "")) as project:
        into = import_folder(project.folder, delivery)
        with pytest.raises(Cancelled):
            import_drives(delivery, into, _EndsAt(fraction))
        (unfinished,) = unfinished_imports(project.folder)
        assert unfinished.folder == into
        made = import_drives(unfinished.request, into, SilentMonitor())
        assert [folder.name for folder in made] == [folder.name for folder in whole]
        assert [tree_of(folder) for folder in made] == [tree_of(folder) for folder in whole]


def test_an_import_begun_when_files_were_dealt_otherwise_is_begun_anew(
    tmp_path, delivery, monkeypatch
):
    monkeypatch.setattr(import_journal, "SECONDS", 0.0)
    with closing(Project.create(tmp_path / "現場.zuka", "")) as project:
        into = import_folder(project.folder, delivery)
        with pytest.raises(Cancelled):
            import_drives(delivery, into, _EndsAt(0.2))
        path = into / import_journal.PLAN
        plan = json.loads(path.read_text(encoding="utf-8"))
        del plan["grouping"]
        path.write_text(json.dumps(plan), encoding="utf-8")
        assert unfinished_imports(project.folder) == ()
        project.close()
        with closing(Project.open(project.folder)) as again:
            assert not into.exists()
            assert again.is_empty
