"""Image lists give oriented images whose paths lie beside the list."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import BadFile
from processing.formats.trajectories.image_list import read_image_list

_HEADER = (
    "path,time_s,easting_m,northing_m,height_m,omega_deg,phi_deg,kappa_deg,"
    "focal_px,cx_px,cy_px,width_px,height_px"
)
_ROW = "images/前方_0001.jpg,10.5,1,2,3,90,0,-30,500,399.5,299.5,800,600"


def test_paths_are_relative_to_the_list(tmp_path: Path) -> None:
    path = tmp_path / "images.csv"
    path.write_bytes(f"{_HEADER}\r\n{_ROW}\r\n".encode("cp932"))
    (image,) = read_image_list(path)
    assert image.path == tmp_path / "images" / "前方_0001.jpg"
    assert (image.time_s, image.xyz) == (10.5, (1.0, 2.0, 3.0))
    assert (image.omega_deg, image.phi_deg, image.kappa_deg) == (90.0, 0.0, -30.0)
    assert (image.width_px, image.height_px, image.focal_px) == (800, 600, 500.0)
    assert image.projection == "perspective"
    assert not any(image.distortion)


def test_distortion_and_projection_are_optional_columns(tmp_path: Path) -> None:
    path = tmp_path / "images.csv"
    path.write_text(f"{_HEADER},projection,k1,p2\n{_ROW},Equirectangular,0.1,0.002\n")
    (image,) = read_image_list(path)
    assert image.projection == "equirectangular"
    assert image.distortion == (0.1, 0.0, 0.0, 0.002, 0.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (_HEADER.replace("focal_px", "focal") + f"\n{_ROW}\n", "focal_px"),
        (f"{_HEADER}\n" + _ROW.replace("500", "0"), "focal_px"),
        (f"{_HEADER}\n" + _ROW.replace("10.5", "正午"), "time_s"),
        (f"{_HEADER},projection\n{_ROW},fisheye\n", "fisheye"),
        (f"{_HEADER}\n" + _ROW.replace("images/前方_0001.jpg", " "), "path"),
        ("", "empty"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "images.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(BadFile) as refusal:
        read_image_list(path)
    assert words in refusal.value.what.en
    assert f"{path}, line " in refusal.value.where.en
