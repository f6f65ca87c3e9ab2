"""The pictures of features are handed in beside the files that name them."""

from __future__ import annotations

import csv
import json
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import MissingInput
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.change import Change
from processing.map.feature import Feature, Status, Vertex
from processing.operations.export import ExportRequest, export
from processing.operations.project_export import ExportOperation, export_project
from processing.project.photos import photo_folder, photo_name, write_photos
from processing.project.project import Project
from resources import path_of

PICTURE = np.arange(3 * 4 * 3, dtype=np.uint8).reshape(3, 4, 3)
RUN = "f00"


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def sign(id_: str, photo: str = "", status: Status = Status.ACCEPTED) -> Feature:
    attributes = {"photo": photo} if photo else {}
    vertices = (Vertex((1.0, 2.0, 3.0)),)
    return Feature(id_, "sign_warning", Geometry.POINT, vertices, attributes, status)


SIGNS = (
    sign("seen", photo_name(RUN, 1)),
    sign("unseen"),
    sign("lost", photo_name(RUN, 7)),
    sign("typed", "P1010023.jpg"),
    sign("rejected", photo_name(RUN, 2), Status.REJECTED),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A project's folder with two pictures."""
    folder = tmp_path / "台帳 案件.zuka"
    photos = folder / photo_folder(RUN)
    photos.mkdir(parents=True)
    write_photos({photo_name(RUN, number): PICTURE for number in (1, 2)}, photos)
    return folder


def files_in(folder: Path) -> list[str]:
    return sorted(one.relative_to(folder).as_posix() for one in folder.rglob("*") if one.is_file())


def test_the_ledger_names_the_picture_that_lies_beside_it(
    tmp_path: Path, folder: Path, catalogue: Catalogue
) -> None:
    out = tmp_path / "納品 成果"
    request = ExportRequest(("csv", "geojson"), out, "ja")
    paths = export(SIGNS, catalogue, "EPSG:6677", request, project=folder)
    with (out / "ledger_sign_warning.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {row["地物ID"]: row["写真"] for row in csv.DictReader(file)}
    assert rows == {"seen": "photos/seen.png", "unseen": "", "lost": "", "typed": "P1010023.jpg"}
    copied, own = out / "photos" / "seen.png", folder / photo_name(RUN, 1)
    assert copied.read_bytes() == own.read_bytes()
    assert [one for one in files_in(out) if one.endswith(".png")] == ["photos/seen.png"]
    assert copied in paths
    told = json.loads((out / f"{folder.stem}.geojson").read_text("utf-8"))["features"]
    assert {one["id"]: one["properties"].get("photo") for one in told} == {
        "seen": "photos/seen.png",
        "unseen": None,
        "lost": None,
        "typed": "P1010023.jpg",
    }


def test_points_alone_have_no_pictures_beside_them(
    tmp_path: Path, folder: Path, catalogue: Catalogue
) -> None:
    request = ExportRequest(("las",), tmp_path / "out")
    export(SIGNS, catalogue, "EPSG:6677", request, project=folder)
    assert not (tmp_path / "out" / "photos").exists()


def test_a_picture_that_cannot_be_read_leaves_nothing_half(
    tmp_path: Path, folder: Path, catalogue: Catalogue, monkeypatch: pytest.MonkeyPatch
) -> None:
    def gone(source: Path, _to: Path) -> None:
        raise FileNotFoundError(2, "No such file", str(source))

    monkeypatch.setattr("processing.operations.export.shutil.copyfile", gone)
    request = ExportRequest(("csv",), tmp_path / "out")
    with pytest.raises(MissingInput, match=r"00001\.png"):
        export(SIGNS, catalogue, "EPSG:6677", request, project=folder)
    assert files_in(tmp_path / "out") == []


def test_a_project_hands_in_its_pictures_and_keeps_its_own(tmp_path: Path, folder: Path) -> None:
    here = tmp_path / "道路.zuka"
    with closing(Project.create(here, "EPSG:6677")) as project:
        project.features.apply(Text("Signs", "標識"), Change(added=SIGNS))
    own = here / "results"
    (folder / "results").rename(own)
    before = {name: (own / name).read_bytes() for name in files_in(own)}
    request = ExportRequest(("csv",), tmp_path / "out")
    for language in ("ja", "en"):  # the second one writes over the files of the first one
        asked = replace(request, language=language)
        export_project(ExportOperation(here, asked), SilentMonitor())
    assert files_in(tmp_path / "out" / "photos") == ["seen.png"]
    assert {name: (own / name).read_bytes() for name in files_in(own)} == before
    with closing(Project.open(here, writing=False)) as project:
        photos = {one.id: one.attributes.get("photo") for one in project.features.all()}
    assert photos["seen"] == photo_name(RUN, 1)
