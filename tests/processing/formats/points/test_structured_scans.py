"""Scans that are grids keep their grid through the readers: PTX, E57, PCD, PLY and LAS."""

import laspy
import numpy as np
import pytest

from processing.core.errors import BadFile
from processing.formats.points.point_files import read_chunks, read_info
from tests.structured_scans import SphereScan, ptx_text, sphere_scan, write_e57


def _read(path, chunk_points=1_000_000):
    info = read_info(path)
    chunks = [chunk.columns for chunk in read_chunks(path, chunk_points)]
    columns = {name: np.concatenate([c[name] for c in chunks]) for name in chunks[0]}
    columns["xyz"] = columns["xyz"] * np.array(info.scale) + np.array(info.offset)
    return info, columns


def _is_scan(columns: dict, scan: SphereScan) -> bool:
    order = np.lexsort(columns["grid"].T[::-1])
    return np.array_equal(columns["grid"][order], scan.cells) and np.allclose(
        columns["xyz"][order], scan.xyz, atol=2e-4
    )


def test_points_of_a_ptx_know_their_cells_and_where_the_scanner_stood(tmp_path):
    scan, path = sphere_scan(), tmp_path / "room.ptx"
    path.write_text(ptx_text(scan))
    info, columns = _read(path, chunk_points=100)
    assert _is_scan(columns, scan)
    assert info.scanner_positions == ((1, tuple(scan.position)),)
    assert not columns["scanner"].any()


def test_scans_of_one_ptx_have_numbers_and_places_of_their_own(tmp_path):
    scans = [sphere_scan(9 + k, 8, position=(10.0 * k, 0.0, 1.0)) for k in range(40)]
    path = tmp_path / "rooms.ptx"
    path.write_text(ptx_text(*scans))
    info, columns = _read(path)
    assert [number for number, _ in info.scanner_positions] == list(range(1, 41))
    assert info.scanner_positions[17][1] == (170.0, 0.0, 1.0)
    for number in (1, 18, 40):
        own = columns["scanner"] == number
        assert _is_scan({name: values[own] for name, values in columns.items()}, scans[number - 1])


def test_a_line_of_a_late_scan_is_named_by_its_number_in_the_file(tmp_path):
    lines = ptx_text(sphere_scan(4, 5), sphere_scan(4, 5)).splitlines()
    lines[10 + 20 + 10 + 7] = "1.0 2.0 oops 0.5"
    path = tmp_path / "rooms.ptx"
    path.write_text("\n".join([*lines[:10], "", *lines[10:], ""]))
    with pytest.raises(BadFile) as refused:
        read_info(path)
    assert "line 49" in refused.value.where.en


@pytest.mark.parametrize("by", ["columnIndex", "rowIndex"])
def test_points_of_an_e57_know_their_cells_whichever_index_numbers_the_sweeps(tmp_path, by):
    scans, path = (
        (sphere_scan(), sphere_scan(21, 11, position=(3.0, 4.0, 5.0))),
        tmp_path / "room.e57",
    )
    write_e57(path, *scans, by=by)
    info, columns = _read(path)
    assert info.scanner_positions == ((1, (100.0, 200.0, 10.0)), (2, (3.0, 4.0, 5.0)))
    for number, scan in enumerate(scans, start=1):
        own = columns["scanner"] == number
        assert _is_scan({name: values[own] for name, values in columns.items()}, scan)


@pytest.mark.parametrize("data", ["ascii", "binary"])
def test_a_pcd_with_a_height_is_an_image(tmp_path, data):
    width, height = 7, 5
    xyz = np.arange(width * height * 3, dtype=np.float32).reshape(-1, 3)
    xyz[11] = np.nan
    header = (
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        f"WIDTH {width}\nHEIGHT {height}\nPOINTS {width * height}\nDATA {data}\n"
    )
    rows = "\n".join(" ".join(f"{v}" for v in row) for row in xyz.tolist()) + "\n"
    path = tmp_path / "image.pcd"
    path.write_bytes(header.encode() + (rows.encode() if data == "ascii" else xyz.tobytes()))
    _, columns = _read(path)
    kept = np.delete(np.arange(width * height), 11)
    assert columns["grid"].tolist() == [[k % width, k // width] for k in kept]
    path.write_bytes(path.read_bytes().replace(b"HEIGHT 5", b"HEIGHT 1"))
    assert "grid" not in _read(path)[1]


def test_fields_of_a_ply_and_dimensions_of_a_las_that_name_row_and_column_are_the_grid(tmp_path):
    scan = sphere_scan()
    rows = np.column_stack([scan.xyz, scan.cells[:, 1], scan.cells[:, 0]])
    lines = [" ".join(f"{value:.5f}" for value in row) for row in rows.tolist()]
    names = ("double x", "double y", "double z", "int rowIndex", "int columnIndex")
    header = ["ply", "format ascii 1.0", f"element vertex {len(lines)}"]
    ply = tmp_path / "room.ply"
    head = [*header, *(f"property {name}" for name in names), "end_header"]
    ply.write_text("\n".join([*head, *lines, ""]))
    assert _is_scan(_read(ply)[1], scan)

    las = laspy.LasData(laspy.LasHeader(point_format=6, version="1.4"))
    las.header.scales, las.header.offsets = [1e-4] * 3, scan.position
    las.add_extra_dims(
        [laspy.ExtraBytesParams("Row", "u2"), laspy.ExtraBytesParams("Column", "u4")]
    )
    las.x, las.y, las.z = scan.xyz.T
    las.Column, las.Row = scan.cells.T
    for name in ("room.las", "room.laz"):
        las.write(tmp_path / name)
        assert _is_scan(_read(tmp_path / name)[1], scan)
