"""Lids and gratings as 3D faces beside the map's lines, read back and audited."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from processing.formats.drawings.dxf_document import APP_ID, DxfVersion
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Status, Vertex
from resources import path_of
from tests.processing.formats.audited_dxf import audited_dxf

_LID = (
    (-11394.608, -35139.915, 25.682),
    (-11394.008, -35139.915, 25.682),
    (-11394.008, -35139.535, 25.682),
    (-11394.608, -35139.535, 25.682),
)
_ELBOW = ((0, 0, 1), (2, 0, 1), (2, 1, 1), (1, 1, 1), (1, 2, 1), (0, 2, 1))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(
    kind: str,
    geometry: Geometry,
    positions: tuple[Position, ...],
    status: Status = Status.ACCEPTED,
    **own: Any,
) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own, status)


def _lid(status: Status = Status.ACCEPTED, **own: Any) -> Feature:
    return _feature("gutter_lid", Geometry.AREA, _LID, status, **own)


def _faces(doc: Any) -> list[Any]:
    return list(doc.modelspace().query("3DFACE"))


def _corners(face: Any) -> np.ndarray:
    return np.array([tuple(face.dxf.get(f"vtx{at}")) for at in range(4)])


@pytest.mark.parametrize("version", ["R2000", "R2018"])
def test_a_lid_is_an_outline_and_five_faces_on_a_layer_of_their_own(
    tmp_path: Path, catalogue: Catalogue, version: DxfVersion
) -> None:
    doc = audited_dxf(tmp_path / "lid.dxf", catalogue, _lid(type="lid"), version=version)
    (outline,) = doc.modelspace().query("POLYLINE")
    faces = _faces(doc)
    assert outline.dxf.layer == "側溝蓋"
    assert {face.dxf.layer for face in faces} == {"側溝蓋_立体"}
    assert doc.layers.get("側溝蓋_立体").dxf.color == catalogue["gutter_lid"].aci
    assert len(faces) == 5
    top = _corners(faces[0])
    assert {tuple(corner) for corner in top} == set(_LID)
    heights = np.unique(np.round(np.concatenate([_corners(face) for face in faces])[:, 2], 6))
    assert heights.tolist() == [25.582, 25.682]
    # Whoever picks a face finds the lid it belongs to.
    assert {face.get_xdata(APP_ID)[0].value for face in faces} == {"id-gutter_lid"}
    assert doc.header["$EXTMIN"][2] == pytest.approx(25.582)


def test_a_grating_is_as_thick_as_it_says_and_on_its_own_layer(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    grating = _feature("gutter_grating", Geometry.AREA, _LID, thickness_m=0.075)
    faces = _faces(audited_dxf(tmp_path / "grating.dxf", catalogue, grating))
    assert {face.dxf.layer for face in faces} == {"グレーチング_立体"}
    lowest = min(_corners(face)[:, 2].min() for face in faces)
    assert lowest == pytest.approx(25.682 - 0.075)


def test_candidates_have_bodies_on_layers_of_candidates(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    doc = audited_dxf(tmp_path / "both.dxf", catalogue, _lid(), _lid(Status.CANDIDATE))
    layers = {face.dxf.layer for face in _faces(doc)}
    assert layers == {"側溝蓋_立体", "側溝蓋_候補_立体"}
    assert not _faces(audited_dxf(tmp_path / "none.dxf", catalogue, _lid(Status.REJECTED)))


def test_edges_inside_a_bent_top_are_invisible(tmp_path: Path, catalogue: Catalogue) -> None:
    bent = _feature("gutter_lid", Geometry.AREA, _ELBOW)
    faces = _faces(audited_dxf(tmp_path / "bent.dxf", catalogue, bent))
    tops = [face for face in faces if np.ptp(_corners(face)[:, 2]) == 0.0]
    drawn = []
    for face in tops:
        corners = _corners(face)
        ends = [(0, 1), (1, 2), (2, 3), (3, 0)]
        for bit, (start, end) in enumerate(ends):
            if not face.dxf.invisible_edges & 1 << bit and (corners[start] != corners[end]).any():
                drawn.append(frozenset({tuple(corners[start]), tuple(corners[end])}))
    ring = [tuple(map(float, corner)) for corner in _ELBOW]
    rim = {frozenset({ring[at - 1], ring[at]}) for at in range(len(ring))}
    assert len(tops) == 4
    assert sorted(map(sorted, drawn)) == sorted(map(sorted, rim))


def test_other_areas_and_the_gutters_outline_stay_lines(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    outline = _feature("gutter_covered", Geometry.LINE, _LID[:2])
    pit = _feature("tree_pit", Geometry.AREA, _LID)
    flat = _feature("gutter_lid", Geometry.AREA, (_LID[0], _LID[1], _LID[0]))
    doc = audited_dxf(tmp_path / "lines.dxf", catalogue, outline, pit, flat)
    layers = [line.dxf.layer for line in doc.modelspace().query("POLYLINE")]
    assert layers == ["2232_側溝U字溝有蓋", "2236_並木桝", "側溝蓋"]
    assert not _faces(doc)
