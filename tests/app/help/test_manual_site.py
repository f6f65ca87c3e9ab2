"""The manual as a site has a page for every tool, in both languages, and every link leads on."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from app.help.manual_site import command_of
from processing.core.parameters import parameters_of
from processing.tools.listed.registry import every_tool
from tests.house_rules.manual_pages import LANGUAGES, read_page


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site") / "マニュアル"
    assert run_in_terminal(["manual", "--out", str(folder)]) == DONE
    return folder


def test_every_tool_has_its_page_with_all_its_settings(site: Path) -> None:
    for language in LANGUAGES:
        for tool in every_tool().values():
            page = read_page(site / language / "tools" / f"{tool.id}.html")
            text = page.path.read_text(encoding="utf-8")
            assert page.language == language
            assert page.unclosed == []
            assert command_of(tool) in page.code
            for one in parameters_of(tool.parameters):
                assert one.id in page.code
                assert one.name.in_language(language) in text


def test_every_link_and_picture_of_the_tools_is_there(site: Path) -> None:
    pages = sorted(site.glob("*/tools/*.html"))
    assert len(pages) == 2 * (len(every_tool()) + 1)
    for path in pages:
        for link in read_page(path).links:
            assert (path.parent / link).resolve().is_file(), (path, link)
        text = path.read_text(encoding="utf-8")
        for piece in text.split('<img src="')[1:]:
            assert (path.parent / piece.split('"')[0]).resolve().is_file(), (path, piece[:60])


def test_a_picture_shows_only_the_part_that_is_meant(site: Path) -> None:
    lowest = (site / "pictures" / "curb-lowest.svg").read_text(encoding="utf-8")
    assert lowest.startswith("<svg ")
    assert 'id="lowest"' in lowest
    assert 'id="highest"' not in lowest


def test_a_folder_that_holds_something_is_left_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine.txt").touch()
    assert run_in_terminal(["manual", "--out", str(tmp_path)]) == BAD_INPUT
    assert "something in the folder" in capsys.readouterr().err
    assert [one.name for one in tmp_path.iterdir()] == ["mine.txt"]
