"""The manual promises what the program does: its actions, keys, words, kinds, commands, tools."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from app.application import build_window, make_application
from app.cli.parser import read_arguments
from app.drawing.tool_entries import TOOL_ENTRIES
from app.keys.shortcuts import FIXED
from app.settings.settings import Settings
from app.volumes.volume_exports import VOLUME_EXPORTS
from app.window.action import MENUS, SUBMENUS, Action
from processing.core.text import Language, Text
from processing.formats.format import Format
from processing.formats.registry import FORMATS
from processing.map.catalogue_file import read_catalogue
from processing.recording.columns.point_features import POINT_FEATURES
from processing.tools.listed.registry import TOOLS
from resources import path_of
from tests.house_rules.manual_pages import LANGUAGES, MANUAL, Page, pages, read_page
from tests.house_rules.sources import python_files, text_of

MODIFIERS = {"Shift", "Ctrl", "Alt"}
_MARKS = re.compile(r"\(&\w\)|&(?=\w)")
NONE = Text("", "")
NEEDS_SYSTEM = Text(" (needs the reference system)", "（座標参照系が必要）")
_LEAST_WORDS = {"en": 20, "ja": 12}
COMMANDS = (
    "open", "demo", "info", "import", "image", "tools", "run", "score", "study", "export", "bench",
    "simulate", "extract", "learn", "number", "widths", "road", "map", "batch", "check", "macro",
    "replay", "manual",
)  # fmt: skip


@pytest.fixture(scope="module")
def actions(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Action]]:
    """Give everything that the window can do, by id."""
    make_application()
    folder = tmp_path_factory.mktemp("window")
    parts = build_window(Settings(folder / "settings.ini"), folder)
    yield {entry.action.id: entry.action for entry in parts.window.actions_made.entries}
    parts.window.close()
    parts.window.deleteLater()
    QApplication.processEvents()


@cache
def all_pages(language: str) -> tuple[Page, ...]:
    return tuple(pages(language))


def every_page() -> tuple[Page, ...]:
    return tuple(page for language in LANGUAGES for page in all_pages(language))


def page_of(language: str, stem: str) -> Page:
    return read_page(MANUAL / language / f"{stem}.html")


def bare(name: str) -> str:
    return _MARKS.sub("", name).rstrip("…")


def steps_to(action: Action, language: Language) -> tuple[str, ...]:
    """Menu, submenu and name of an action, as they are read in the window."""
    menus = dict(MENUS)
    top, _, below = action.menu.partition("/")
    steps = [menus[top].in_language(language)] if top else []
    if below:
        steps.append(SUBMENUS[action.menu].in_language(language))
    return tuple(bare(step) for step in (*steps, action.text.in_language(language)))


def ends_in(steps: tuple[str, ...], quoted: str) -> bool:
    """Whether a quoted way through the menus leads to an action, all of it or its last steps."""
    said = tuple(quoted.split(" ▸ "))
    return steps[-len(said) :] == said


def words_of_the_program() -> str:
    """All texts in which a word of the window may stand: sources and translations."""
    sources = [text_of(name) for name in python_files("app", "widgets", "processing")]
    for language in LANGUAGES:
        path = path_of(f"translations/zuka_{language}.ts")
        sources.append(path.read_text(encoding="utf-8"))
    sources.append(path_of("catalogue/level500.toml").read_text(encoding="utf-8"))
    sources += [word for one in VOLUME_EXPORTS for word in (one.name.en, one.name.ja)]
    return "\n".join(sources).replace("&apos;", "'").replace("&amp;", "&")


def test_both_languages_have_the_same_pages_with_the_same_sections() -> None:
    en, ja = ({page.path.name: page.ids for page in all_pages(one)} for one in LANGUAGES)
    assert en == ja


def test_both_languages_name_the_same_actions() -> None:
    for page in all_pages("en"):
        other = page_of("ja", page.path.stem)
        assert {one.action for one in page.names} == {one.action for one in other.names}
        assert sorted(one.action for one in page.keys) == sorted(one.action for one in other.keys)


def test_every_page_is_whole_and_says_its_language() -> None:
    for page in every_page():
        assert page.unclosed == [], page.path
        assert page.language == page.path.parent.name


def test_every_link_leads_somewhere() -> None:
    broken = []
    for page in every_page():
        for link in page.links:
            name, _, position = link.partition("#")
            path = (page.path.parent / name).resolve() if name else page.path
            is_there = path.is_file() and (not position or position in read_page(path).ids)
            if not is_there:
                broken.append((page.path.name, link))
    assert broken == []


def test_every_page_is_in_the_contents() -> None:
    for language in LANGUAGES:
        linked = set(page_of(language, "index").links)
        assert {page.path.name for page in all_pages(language)} <= linked


def test_every_action_that_is_named_exists_under_that_name(actions: dict[str, Action]) -> None:
    wrong = []
    for page in every_page():
        language: Language = "ja" if page.language == "ja" else "en"
        for name in page.names:
            if not name.action:
                continue
            action = actions.get(name.action)
            if action is None or not ends_in(steps_to(action, language), name.words):
                wrong.append((page.path.name, name))
    assert wrong == []


def test_every_key_that_is_named_does_what_is_said(actions: dict[str, Action]) -> None:
    fixed = {key for one in FIXED for key in one.keys} | MODIFIERS | {"Delete"}
    wrong = []
    for page in every_page():
        for key in page.keys:
            action = actions.get(key.action)
            keys = fixed if not key.action else set() if action is None else set(action.keys)
            if key.words not in keys:
                wrong.append((page.path.name, key))
    assert wrong == []


def test_every_other_word_of_the_window_is_in_the_program() -> None:
    program = _MARKS.sub("", words_of_the_program())
    wrong = [
        (page.path.name, name.words)
        for page in every_page()
        for name in page.names
        if not name.action and name.words not in program
    ]
    assert wrong == []


def test_every_mouse_tool_has_its_paragraph() -> None:
    missing = []
    for language in LANGUAGES:
        told = {id_: text for page in all_pages(language) for id_, text in page.paragraphs.items()}
        missing += [
            (language, entry.name)
            for entry in TOOL_ENTRIES
            if len(told.get(f"tool-{entry.name}", "").strip()) < _LEAST_WORDS[language]
        ]
    assert missing == []


def test_every_command_of_the_menus_is_listed_with_its_keys(actions: dict[str, Action]) -> None:
    for language in LANGUAGES:
        page = page_of(language, "shortcuts")
        named = {name.action for name in page.names}
        keys = {(key.action, key.words) for key in page.keys}
        for action in actions.values():
            is_kind = action.menu == "draw/kinds"
            assert not action.menu or is_kind or action.id in named, action.id
            assert {(action.id, key) for key in action.keys} <= keys, action.id


def test_every_fixed_key_is_listed() -> None:
    for language in LANGUAGES:
        told = page_of(language, "shortcuts").paragraphs["in-views"]
        for one in FIXED:
            assert one.gesture.in_language(language) in told
            assert one.name.in_language(language) in told


def test_the_number_keys_choose_the_kinds_that_are_listed() -> None:
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    keyed = {kind.id: kind for kind in catalogue if kind.key}
    for language in LANGUAGES:
        page = page_of(language, "kinds")
        assert page.kinds == {id_: kind.name.in_language(language) for id_, kind in keyed.items()}
        listed = [key.words for key in page.keys if key.action.startswith("kind-key")]
        assert listed == [keyed[id_].key for id_ in page.kinds]


def test_every_processing_tool_is_explained() -> None:
    for language in LANGUAGES:
        named = {name.action for name in page_of(language, "processing").names}
        assert {f"process-{tool}" for tool in TOOLS} <= named


def test_every_feature_of_points_is_listed_with_its_formula() -> None:
    for language in LANGUAGES:
        page = (MANUAL / language / "processing.html").read_text(encoding="utf-8")
        for column in POINT_FEATURES.values():
            scale = column.group.partition("_")[2]
            plain = column.id == "neighbours_best" or not scale
            size = "_大きさ" if language == "ja" else "_SIZE"
            name = column.id if plain else column.id.removesuffix(f"_{scale}") + size
            (row,) = [line for line in page.splitlines() if f"<th><code>{name}</code>" in line]
            assert f"<td>{column.formula}</td><td>{column.source}</td>" in row


def format_row(one: Format, language: Language) -> str:
    """A line of the manual's table of formats."""
    between = "、" if language == "ja" else ", "
    system = (
        Text(" (needs the reference system)", "（座標参照系が必要）") if one.needs_crs else NONE
    )
    endings = between.join(f"<code>{ending}</code>" for ending in one.endings)
    read, written = (
        between.join(content.value.in_language(language) for content in contents)
        for contents in (one.reads, one.writes)
    )
    map_id = f"<code>{one.id}</code>" if one.map_title is not None else ""
    cells = (endings, read and read + system.in_language(language), written, map_id)
    told = "".join(f"<td>{cell or '–'}</td>" for cell in cells)
    return f"<tr><th>{one.name.in_language(language)}</th>{told}</tr>"


def test_the_table_of_formats_is_that_of_the_program() -> None:
    for language in LANGUAGES:
        expected = "\n".join(format_row(one, language) for one in FORMATS)
        page = (MANUAL / language / "start.html").read_text(encoding="utf-8")
        assert expected in page, f"{language}/start.html lacks:\n{expected}"


def test_every_format_of_maps_is_named_with_the_command() -> None:
    for language in LANGUAGES:
        page = (MANUAL / language / "command_line.html").read_text(encoding="utf-8")
        (line,) = [one for one in page.splitlines() if "<code>zuka export " in one]
        assert all(f"<code>{one.id}</code>" in line for one in FORMATS.maps())


def test_every_command_is_listed_with_its_options(capsys: pytest.CaptureFixture[str]) -> None:
    for command in COMMANDS:
        with pytest.raises(SystemExit):
            read_arguments([command, "--help"])
        known = set(re.findall(r"--[a-z-]+", capsys.readouterr().out)) - {"--help"}
        for language in LANGUAGES:
            code = page_of(language, "command_line").code
            (told,) = [line for line in code if line.startswith(f"zuka {command} ")]
            # Some options of several commands are told at one of them.
            own = set(re.findall(r"--[a-z-]+", told))
            assert own <= known, command
            assert known - own <= {"--images", "--crs", "--trajectory", "--columns"}, command


def test_no_command_is_forgotten(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        read_arguments(["--help"])
    listed = re.findall(r"^    (\w+) +\S", capsys.readouterr().out, flags=re.MULTILINE)
    assert sorted(listed) == sorted(COMMANDS)


def test_a_wrong_key_and_a_wrong_name_are_caught(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_text(
        '<html lang="en"><body><main><h2 id="here">Here</h2><p><kbd>Q</kbd>'
        '<i data-action="undo">Edit ▸ Undo all</i><a href="#there">there</a></main></body></html>',
        encoding="utf-8",
    )
    page = read_page(path)
    assert [key.words for key in page.keys] == ["Q"]
    assert not ends_in(("Edit", "Undo"), page.names[0].words)
    assert page.names[0].action == "undo"
    assert page.ids == ("here",)
    assert page.unclosed != []
