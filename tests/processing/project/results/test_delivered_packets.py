"""Waveforms go with the points that are handed in, byte for byte."""

from __future__ import annotations

from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import InUse
from processing.core.monitor import SilentMonitor
from processing.formats.points.las.las_header import read_header
from processing.operations.inputs import OperationInputs
from processing.operations.run import RunOperation, run_operation
from processing.project.results.label_export import write_labelled_points
from tests.waveform_flight import SAMPLES, import_flight, put_packets_inside, write_flight

_FIELDS = ("wavepacket_index", "wavepacket_offset", "wavepacket_size")
_PLACES = ("return_point_wave_location", "x_t", "y_t", "z_t")


def _assert_same_waveforms(written: Path, delivered: Path) -> None:
    new, old = laspy.read(written), laspy.read(delivered)
    assert new.header.point_format.id == 9
    for name in (*_FIELDS, *_PLACES, "gps_time"):
        np.testing.assert_array_equal(np.asarray(new[name]), np.asarray(old[name]))


def test_labelled_points_are_written_with_their_packets_beside_them(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    drive = import_flight(flight.path, tmp_path / "into")
    out = tmp_path / "out"
    out.mkdir()
    write_labelled_points([drive], lambda name: out / name, SilentMonitor())
    _assert_same_waveforms(out / "a.las", flight.path)
    assert (out / "a.wdp").read_bytes() == flight.path.with_suffix(".wdp").read_bytes()


def test_the_drives_own_packets_serve_where_the_delivered_ones_are_gone(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    drive = import_flight(flight.path, tmp_path / "into")
    packets = flight.path.with_suffix(".wdp").read_bytes()
    flight.path.with_suffix(".wdp").unlink()
    out = tmp_path / "out"
    out.mkdir()
    write_labelled_points([drive], lambda name: out / name, SilentMonitor())
    assert (out / "a.wdp").read_bytes() == packets


def test_packets_inside_the_file_stay_inside(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    put_packets_inside(flight.path)
    drive = import_flight(flight.path, tmp_path / "into")
    out = tmp_path / "out"
    out.mkdir()
    write_labelled_points([drive], lambda name: out / name, SilentMonitor())
    assert [path.name for path in out.iterdir()] == ["a.las"]
    _assert_same_waveforms(out / "a.las", flight.path)
    start = read_header(out / "a.las").waveforms_at
    first = (out / "a.las").read_bytes()[start + 60 :][:SAMPLES]
    np.testing.assert_array_equal(np.frombuffer(first, np.uint8), flight.counts[0])


@pytest.mark.parametrize("ending", ["las", "laz"])
def test_a_tools_points_keep_their_waveforms(tmp_path: Path, ending: str) -> None:
    flight = write_flight(tmp_path / "a.las")
    output = tmp_path / "out" / f"b.{ending}"
    run_operation(
        RunOperation("noise", OperationInputs(points=(flight.path,)), output=output),
        SilentMonitor(),
    )
    _assert_same_waveforms(output, flight.path)
    packets = (tmp_path / "out" / "b.wdp").read_bytes()
    assert packets == flight.path.with_suffix(".wdp").read_bytes()


def test_points_beside_the_delivered_ones_take_the_packets_that_are_there(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    before = flight.path.with_suffix(".wdp").stat().st_mtime_ns
    output = tmp_path / "a.laz"
    run_operation(
        RunOperation("noise", OperationInputs(points=(flight.path,)), output=output),
        SilentMonitor(),
    )
    assert flight.path.with_suffix(".wdp").stat().st_mtime_ns == before


def test_the_packets_of_other_points_are_never_overwritten(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    other = write_flight(tmp_path / "b.las", 30)
    packets = other.path.with_suffix(".wdp").read_bytes()
    wanted = RunOperation(
        "noise", OperationInputs(points=(flight.path,)), output=tmp_path / "b.laz"
    )
    with pytest.raises(InUse):
        run_operation(wanted, SilentMonitor())
    assert other.path.with_suffix(".wdp").read_bytes() == packets
    assert not (tmp_path / "b.laz").exists()
