"""An electronic delivery is read back: its tree, its management files, its papers, its metadata."""

from __future__ import annotations

import csv
import re
import xml.etree.ElementTree as ET
import xml.sax
from io import StringIO
from pathlib import Path
from typing import Any

import pypdfium2
import pytest
from lxml import etree

from processing.core.errors import BadFile, OutOfRange, Unsuitable, UserError
from processing.core.text import Text
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.formats.work_facts import WorkFacts
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.app.cli.test_map_comparison import NOW

_WORK = WorkFacts(
    work="市道1号線道路台帳補正業務①",
    place="見本市本町地内",
    client="見本市",
    contractor="見本測量株式会社",
    height_datum="JGD2024",
    version="1.0",
)
_JMP = "{http://zgate.gsi.go.jp/ch/jmp/}"
_NAME = re.compile(r"[A-Z0-9_]{1,8}(\.[A-Z0-9]{2,3})?")


def _delivered(
    folder: Path, features: tuple[Feature, ...] = NOW, crs: str = "EPSG:6677", **options: str
) -> list[Text]:
    notes: list[Text] = []
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    request = ExportRequest(("delivery",), folder, "ja", options)
    export(features, catalogue, crs, request, tell=notes.append, work=_WORK)
    return notes


def _check_points(folder: Path) -> Path:
    path = folder / "points.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["id", "easting_m", "northing_m", "height_m"])
        for number, one in enumerate(NOW[:3]):
            east, north, height = one.vertices[0].xyz
            writer.writerow([f"K-{number}", east + 0.03, north - 0.04, height + 0.02])
    return path


def _xml(path: Path) -> Any:
    """A management file by another parser than the one it was made with: it knows Shift_JIS."""
    words = path.read_bytes().decode("cp932")
    assert words.startswith('<?xml version="1.0" encoding="Shift_JIS"?>\r\n')
    builder = ET.TreeBuilder()
    reader = xml.sax.make_parser()  # noqa: S317 - a file of our own
    reader.setContentHandler(_Handler(builder))
    reader.parse(StringIO(words.split("?>", 1)[1].strip()))
    return builder.close()


class _Handler(xml.sax.ContentHandler):
    def __init__(self, builder: ET.TreeBuilder) -> None:
        super().__init__()
        self._builder = builder

    def startElement(self, name: str, attrs: Any) -> None:  # noqa: N802
        self._builder.start(name, dict(attrs))

    def endElement(self, name: str) -> None:  # noqa: N802
        self._builder.end(name)

    def characters(self, content: str) -> None:
        self._builder.data(content)


def test_the_tree_is_named_by_the_rule_and_listed_whole(tmp_path: Path) -> None:
    out = tmp_path / "out"
    _delivered(out, check_points=str(_check_points(tmp_path)))
    files = [path for path in out.rglob("*") if path.is_file()]
    assert all(_NAME.fullmatch(part) for one in files for part in one.relative_to(out).parts)
    assert {"INDEX_D.XML", "SURVEY"} == {one.name for one in out.iterdir()}
    listed = set()
    for one in _xml(out / "SURVEY/CHIKEI/SURV_CHI.XML").iter("測量成果情報"):
        folder = f"{one.findtext('測量成果区分フォルダ名')}/{one.findtext('測量細区分フォルダ名')}"
        listed |= {f"{folder}/{name.text}" for name in one.iter("測量成果ファイル名")}
    below = out / "SURVEY" / "CHIKEI"
    found = {path.relative_to(below).as_posix() for path in below.rglob("*") if path.is_file()} - {
        "SURV_CHI.XML"
    }
    assert listed == found
    assert "WORK/ZUKA_A/SEIDO001.PDF" in found
    survey = _xml(out / "SURVEY/SURVEY.XML")
    assert survey.findtext("場所情報/区域情報/平面直角座標系") == "09"
    record = survey.findtext("測量情報/測量記録フォルダパス名")
    assert record is not None
    assert (out / record).is_dir()


def test_management_files_say_the_work_and_its_place(tmp_path: Path) -> None:
    _delivered(tmp_path, delivery_start="2026-04-01", delivery_edition="測量202103-01")
    index = _xml(tmp_path / "INDEX_D.XML")
    assert index.findtext("業務件名等/業務名称") == _WORK.work
    assert index.findtext("業務件名等/履行期間-着手") == "2026-04-01"
    assert index.findtext("基礎情報/適用要領基準") == "測量202103-01"
    west = index.findtext("場所情報/境界座標情報/西側境界座標経度")
    assert west is not None
    assert re.fullmatch(r"13942\d\d", west)
    assert "JGD2024" in (index.findtext("業務情報/業務概要") or "")


def test_the_map_and_its_metadata_are_read_back(tmp_path: Path) -> None:
    _delivered(tmp_path, delivery_advice="R08A0001")
    data = tmp_path / "SURVEY/CHIKEI/DATA/ZUKA_A"
    (sheet,) = data.glob("*.DM")
    assert len(read_mapped(sheet).features) > 3
    root = etree.parse(data / "R08A0001.XML").getroot()
    assert root.tag == f"{_JMP}MD_Metadata"
    assert root.findtext(f".//{_JMP}citation/{_JMP}title").startswith(_WORK.work)
    west, east = (
        float(root.findtext(f".//{_JMP}{name}"))
        for name in ("westBoundLongitude", "eastBoundLongitude")
    )
    assert 139.70 < west < east < 139.72
    assert "JGD2024" in root.findtext(f".//{_JMP}lineage/{_JMP}statement")


def test_the_papers_name_the_work_and_judge_the_accuracy(tmp_path: Path) -> None:
    out = tmp_path / "out"
    _delivered(out, check_points=str(_check_points(tmp_path)))
    below = out / "SURVEY" / "CHIKEI"
    for path, expected in (
        (below / "WORK/ZUKA_A/SEIDO001.PDF", ("精度管理表", "制限内", "0.050", "見本測量")),
        (below / "DATA/ZUKA_A/HINSH001.PDF", ("品質評価表", "見本市", "JGD2024")),
    ):
        words = pypdfium2.PdfDocument(path)[0].get_textpage().get_text_bounded()
        for one in expected:
            assert one in words


def _dtds(folder: Path, *, demands: str) -> Path:
    folder.mkdir()
    rules = '<?xml version="1.0" encoding="Shift_JIS"?>\n<!ELEMENT gyomudata ({})>\n'
    members = "基礎情報,業務件名等,場所情報,発注者情報,受注者情報,業務情報"
    names = set(re.findall(r"[^(),\s]+", members)) | set(demands.split())
    more = "".join(f"<!ELEMENT {name} ANY>\n" for name in sorted(names))
    inner = (
        "メディア番号 メディア総枚数 適用要領基準 測量データフォルダ名 業務名称 履行期間-着手"
        " 履行期間-完了 測地系 境界座標情報 西側境界座標経度 東側境界座標経度 北側境界座標緯度"
        " 南側境界座標緯度 発注者機関事務所名 受注者名 業務概要"
    )
    more += "".join(f"<!ELEMENT {name} ANY>\n" for name in inner.split())
    more += "<!ATTLIST gyomudata DTD_version CDATA #FIXED '05'>\n"
    whole = rules.format(",".join([members, *demands.split()])) + more
    path = folder / "INDE_D05.DTD"
    path.write_bytes(whole.encode("cp932"))
    return path


def test_the_ministrys_dtds_are_put_in_and_checked_by(tmp_path: Path) -> None:
    good = _dtds(tmp_path / "good", demands="")
    notes = _delivered(tmp_path / "out", delivery_dtds=str(good))
    assert (tmp_path / "out/INDE_D05.DTD").read_bytes() == good.read_bytes()
    assert not [one for one in notes if "not yet as" in one.en]
    words = (tmp_path / "out/INDEX_D.XML").read_bytes().decode("cp932")
    assert '<!DOCTYPE gyomudata SYSTEM "INDE_D05.DTD">' in words
    assert 'DTD_version="05"' in words
    strict = _dtds(tmp_path / "strict", demands="発注者コード")
    (fault,) = [
        one
        for one in _delivered(tmp_path / "more", delivery_dtds=str(strict))
        if "not yet as" in one.en
    ]
    assert "INDEX_D.XML" in fault.en


def _no_dtd(folder: Path) -> Path:
    path = folder / "readme.txt"
    path.write_text("no rules")
    return path


def _damaged_dtd(folder: Path) -> Path:
    path = folder / "INDE_D05.DTD"
    path.write_text("<!ELEMENT")
    return path


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"delivery_start": "1 April"}, OutOfRange),
        ({"delivery_end": "2026-13-01"}, OutOfRange),
        ({"delivery_folder": "図化A"}, OutOfRange),
        ({"delivery_folder": "TOOLONG_A1"}, OutOfRange),
        ({"delivery_advice": "助言1"}, OutOfRange),
        ({"delivery_dtds": "nowhere/INDE_D05.DTD"}, UserError),
        ({"delivery_dtds": _no_dtd}, BadFile),
        ({"delivery_dtds": _damaged_dtd}, BadFile),
    ],
)
def test_what_the_rule_forbids_leaves_nothing_behind(
    tmp_path: Path, options: dict[str, object], error: type[UserError]
) -> None:
    given = {
        name: value if isinstance(value, str) else str(value(tmp_path))  # type: ignore[operator]
        for name, value in options.items()
    }
    with pytest.raises(error):
        _delivered(tmp_path / "out", **given)
    assert not [path for path in (tmp_path / "out").rglob("*") if path.is_file()]


def test_a_map_without_codes_or_plane_system_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unsuitable):
        _delivered(tmp_path / "out", features=NOW[3:5])  # lids have no code
    with pytest.raises(Unsuitable):
        _delivered(tmp_path / "out", crs="EPSG:32654")
    assert not [path for path in (tmp_path / "out").rglob("*") if path.is_file()]
