"""Every word that a user sees is there in Japanese and in English."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from installer.environment import Environment
from installer.translations import ENGLISH, FOLDER, JAPANESE, collect
from tests.house_rules.shown_text import shown_literals
from tests.house_rules.sources import ROOT, python_files, text_of

TranslationEntry = tuple[str, str, str]


def entries(path: Path) -> dict[TranslationEntry, bool]:
    """Give context, source and comment of each entry of a ``.ts`` file: is it translated?"""
    found = {}
    for context in ET.parse(path).getroot().iter("context"):  # noqa: S314 - our own file
        for message in context.iter("message"):
            key = (
                context.findtext("name", ""),
                message.findtext("source", ""),
                message.findtext("comment", ""),
            )
            found[key] = _is_translated(message)
    return found


def _is_translated(message: ET.Element) -> bool:
    translation = message.find("translation")
    if translation is None or translation.get("type") is not None:
        return False
    forms = translation.findall("numerusform") or [translation]
    return all((form.text or "").strip() for form in forms)


def unfinished(path: Path) -> list[TranslationEntry]:
    return [entry for entry, is_translated in entries(path).items() if not is_translated]


@pytest.fixture(scope="module")
def collected(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a folder of ``.ts`` files made from the sources as they are now."""
    folder = tmp_path_factory.mktemp("translations")
    collect(Environment(ROOT, os.environ), folder)
    return folder


@pytest.mark.parametrize("name", [JAPANESE, ENGLISH])
def test_the_translations_hold_just_the_texts_of_the_sources(collected: Path, name: str) -> None:
    kept, wanted = set(entries(ROOT / FOLDER / name)), set(entries(collected / name))
    assert wanted - kept == set(), "run `make translations` and translate these"
    assert kept - wanted == set(), "run `make translations`: these are no longer used"


def test_the_sources_hold_texts_to_translate(collected: Path) -> None:
    assert len(entries(collected / JAPANESE)) > 20


@pytest.mark.parametrize("name", [JAPANESE, ENGLISH])
def test_no_translation_is_unfinished(name: str) -> None:
    assert unfinished(ROOT / FOLDER / name) == []


def test_unfinished_and_empty_translations_are_caught(tmp_path: Path) -> None:
    texts = tmp_path / "some.ts"
    texts.write_text(
        """<?xml version="1.0" encoding="utf-8"?><!DOCTYPE TS><TS version="2.1" language="ja_JP">
        <context><name>Window</name>
        <message><source>Open</source><translation>開く</translation></message>
        <message><source>Close</source><translation type="unfinished">x</translation></message>
        <message><source>Undo</source><translation></translation></message>
        <message numerus="yes"><source>%n curb(s)</source>
        <translation><numerusform></numerusform></translation></message>
        </context></TS>""",
        encoding="utf-8",
    )
    sources = [source for _, source, _ in unfinished(texts)]
    assert sources == ["Close", "Undo", "%n curb(s)"]


def test_no_words_are_shown_past_the_translator() -> None:
    files = [name for name in python_files("widgets", "app") if not name.startswith("app/cli/")]
    assert files
    found = {name: shown_literals(text_of(name)) for name in files}
    assert {name: literals for name, literals in found.items() if literals} == {}


@pytest.mark.parametrize(
    "line",
    [
        'QLabel("Open a project")',
        'QLabel("点群")',
        'label.setText(f"{count} points")',
        'label.setText("Points: " + str(count))',
        'label.setText("one" if count == 1 else self.tr("many"))',
        'menu.addAction(icon, "Open")',
        'tabs.addTab(page, "Review")',
        'QGroupBox(title="Kinds")',
        'view.setHeaderLabels(["Name", "Count"])',
        'QMessageBox.warning(self, self.tr("No"), "The disk is full")',
        'bar.showMessage("{} points".format(count))',
        'QtWidgets.QPushButton("Apply")',
    ],
)
def test_words_shown_past_the_translator_are_caught(line: str) -> None:
    assert len(shown_literals(line)) >= 1


@pytest.mark.parametrize(
    "line",
    [
        'QLabel(self.tr("Open a project"))',
        'QLabel(QCoreApplication.translate("Start", "Open"))',
        'label.setText(Text("Kind", "種類").spoken(language))',
        'label.setText(f"{height:.3f} m")',
        'label.setText("EPSG:6677")',
        'box.addItem(kind.name, "curb")',
        'label.setText(names["curb"])',
        'label.setObjectName("state")',
        'label.setText("")',
        'label.setText("<b>%1</b>")',
    ],
)
def test_translated_words_units_and_ids_are_let_through(line: str) -> None:
    assert shown_literals(line) == []
