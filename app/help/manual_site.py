"""The manual as a site: its pages in both languages, and one for each tool from its declaration."""

from __future__ import annotations

import html
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

from processing.core.errors import MissingInput, report_as_user_error
from processing.core.parameters import Parameter, parameters_of
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.map.catalogue_file import read_catalogue
from processing.tools.listed.registry import every_tool
from processing.tools.tool import Comparison, NewPoints, NewPointsTogether, Tool
from resources import path_of

_LANGUAGES: tuple[Language, ...] = ("en", "ja")
_PAGES, _PICTURES = "tools", "pictures"
_SVG = "http://www.w3.org/2000/svg"
_MANUAL = Text("Manual", "マニュアル")
_TOOLS = Text("All tools", "すべてのツール")
_OTHER = {"en": ("ja", "日本語"), "ja": ("en", "English")}
_HEADINGS = (
    Text("Setting", "設定"),
    Text("Name", "名前"),
    Text("Usual value", "初期値"),
    Text("From – to", "範囲"),
    Text("Meaning", "説明"),
)
_COLUMNS = Text("What it says about every point", "点ごとの結果")
_FINDS = Text("What it finds", "抽出するもの")
_FOUND = Text("Candidates for review: {kinds}.", "確認が必要な候補: {kinds}")
_CHOSEN = Text("of the kind that is chosen", "選択した種別")
_SETTINGS = Text("Settings", "設定")
_NONE = Text("It has no settings.", "設定はありません。")
_COMMAND = Text("Command line", "コマンドライン")
_VERSION = Text("Version {version} of the method.", "手法の版: {version}")


def write_manual_site(folder: Path) -> tuple[Path, ...]:
    """Write the manual to a new or empty folder; gives the contents page of each language.

    Raises
    ------
    MissingInput
        There is something in the folder, or it can't be made.
    NoSpace
    """
    with report_as_user_error(folder):
        if folder.exists() and any(folder.iterdir()):
            raise MissingInput(
                Text("There is something in the folder.", "フォルダが空ではありません。"),
                Text.same(str(folder)),
                Text("Name a new one.", "新しいフォルダを指定してください。"),
            )
        shutil.copytree(path_of("manual"), folder, dirs_exist_ok=True)
    declared = (one for tool in every_tool().values() for one in parameters_of(tool.parameters))
    for picture in sorted({one.picture for one in declared if one.picture}):
        _write(folder / _PICTURES / _picture_file(picture), picture_of(picture))
    for language in _LANGUAGES:
        pages = folder / language / _PAGES
        _write(pages / "index.html", _contents(language))
        for tool in every_tool().values():
            _write(pages / f"{tool.id}.html", tool_page(tool, language))
    return tuple(folder / language / "index.html" for language in _LANGUAGES)


def tool_page(tool: Tool, language: Language) -> str:
    """The page of one tool in one language."""
    parts = [
        f"<p>{_say(tool.explanation, language)}</p>",
        *_given(tool, language),
        f'<h2 id="settings">{_say(_SETTINGS, language)}</h2>',
        *_settings(tool, language),
        f'<h2 id="command">{_say(_COMMAND, language)}</h2>',
        f"<p><code>{html.escape(command_of(tool))}</code></p>",
        f"<p>{_say(_VERSION.filled(version=str(tool.version)), language)}</p>",
    ]
    return _page(_say(tool.name, language), f"{tool.id}.html", language, parts)


def picture_of(name: str) -> str:
    """What shows a parameter's meaning, as SVG: of the scene's parts only the one that is named."""
    scene, _, part = name.partition("/")
    root = ET.parse(path_of(f"pictures/parameters/{scene}.svg")).getroot()  # noqa: S314 - our own
    for above in list(root.iter()):
        for one in list(above):
            if part and one.get("id") not in (None, part):
                above.remove(one)
    ET.register_namespace("", _SVG)  # some readers know the elements without a prefix only
    return ET.tostring(root, encoding="unicode")


def command_of(tool: Tool) -> str:
    """How a tool is called."""
    settings = " [--set NAME=VALUE]..." if parameters_of(tool.parameters) else ""
    if isinstance(tool.method, Comparison):
        return f"zuka run {tool.id} --before A --after B{settings} --output OUT.json"
    if isinstance(tool.method, NewPoints | NewPointsTogether):
        return f"zuka run {tool.id} INPUT...{settings} --output OUT.las"
    ending = "geojson" if tool.gives_candidates else "laz"
    return f"zuka run {tool.id} INPUT...{settings} [--output OUT.{ending}]"


def _given(tool: Tool, language: Language) -> list[str]:
    if tool.outputs:
        rows = "".join(
            f"<tr><th><code>{one.name}</code></th><td>{_say(one.title, language)}</td></tr>"
            for one in tool.outputs
        )
        return [f'<h2 id="columns">{_say(_COLUMNS, language)}</h2>', f"<table>{rows}</table>"]
    if tool.gives_candidates:
        catalogue = read_catalogue(path_of("catalogue/level500.toml"))
        names = [catalogue[one].name.in_language(language) for one in tool.makes]
        kinds = ", ".join(names) or _CHOSEN.in_language(language)
        found = _say(_FOUND.filled(kinds=kinds), language)
        return [f'<h2 id="finds">{_say(_FINDS, language)}</h2>', f"<p>{found}</p>"]
    return []


def _settings(tool: Tool, language: Language) -> list[str]:
    declared = parameters_of(tool.parameters)
    if not declared:
        return [f"<p>{_say(_NONE, language)}</p>"]
    headings = "".join(f"<th>{_say(one, language)}</th>" for one in _HEADINGS)
    rows = "\n".join(_setting(one, language) for one in declared)
    return [f"<table>\n<tr>{headings}</tr>\n{rows}\n</table>"]


def _setting(one: Parameter, language: Language) -> str:
    limits = ""
    if one.kind in ("number", "count"):
        limits = f"{one.low:g} – {one.high:g}"
    elif one.choices:
        limits = "<br>".join(
            f"<code>{html.escape(option.value)}</code> {_say(option.name, language)}"
            for option in one.choices
        )
    source = f"../../{_PICTURES}/{_picture_file(one.picture)}"
    shown = f'<br><img src="{source}" alt="">' if one.picture else ""
    usual = html.escape(f"{one.default} {one.unit}".strip())
    cells = (
        _say(one.name, language),
        usual,
        limits,
        _say(one.explanation, language) + shown,
    )
    told = "".join(f"<td>{cell or '–'}</td>" for cell in cells)
    return f"<tr><th><code>{one.id}</code></th>{told}</tr>"


def _picture_file(picture: str) -> str:
    return f"{picture.replace('/', '-')}.svg"


def _contents(language: Language) -> str:
    rows = "\n".join(
        f'<tr><th><a href="{tool.id}.html">{_say(tool.name, language)}</a></th>'
        f"<td>{_say(tool.explanation, language)}</td></tr>"
        for tool in every_tool().values()
    )
    return _page(
        _TOOLS.in_language(language), "index.html", language, [f"<table>\n{rows}\n</table>"]
    )


def _page(title: str, name: str, language: Language, parts: list[str]) -> str:
    other, other_name = _OTHER[language]
    manual = _MANUAL.in_language(language)
    body = "\n".join(parts)
    return (
        f'<!doctype html>\n<html lang="{language}"><head><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width"><title>{title} – Zuka</title>'
        '<link rel="stylesheet" href="../../style.css"></head><body>\n'
        f'<nav><a href="../index.html">{manual}</a> '
        f'<a href="index.html">{_TOOLS.in_language(language)}</a> '
        f'<a class="other" href="../../{other}/{_PAGES}/{name}" hreflang="{other}"'
        f' lang="{other}">{other_name}</a></nav>\n'
        f"<main>\n<h1>{title}</h1>\n{body}\n</main>\n</body></html>\n"
    )


def _say(text: Text, language: Language) -> str:
    return html.escape(text.in_language(language), quote=False)


def _write(path: Path, text: str) -> None:
    with write_safely(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
