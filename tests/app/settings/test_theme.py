"""Light, dark, or as the system is; colours, icons, and what is remembered."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtGui import QColor, QIcon, QPalette
from pytestqt.qtbot import QtBot

from app.application import build_window, make_application
from app.settings.settings import Settings
from app.settings.theme import Theme, ThemeChoice, palette_of
from app.window.window_parts import WindowParts

ROLES = (
    (QPalette.ColorRole.WindowText, QPalette.ColorRole.Window),
    (QPalette.ColorRole.Text, QPalette.ColorRole.Base),
    (QPalette.ColorRole.Text, QPalette.ColorRole.AlternateBase),
    (QPalette.ColorRole.ButtonText, QPalette.ColorRole.Button),
    (QPalette.ColorRole.ToolTipText, QPalette.ColorRole.ToolTipBase),
    (QPalette.ColorRole.PlaceholderText, QPalette.ColorRole.Base),
    (QPalette.ColorRole.PlaceholderText, QPalette.ColorRole.Window),
    (QPalette.ColorRole.Link, QPalette.ColorRole.Base),
)


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(tmp_path / "settings.ini")


@pytest.fixture
def parts(qtbot: QtBot, settings: Settings, tmp_path: Path) -> Iterator[WindowParts]:
    parts = build_window(settings, tmp_path / "projects")
    parts.window.show()
    qtbot.waitExposed(parts.window)
    yield parts
    parts.window.close()
    parts.window.deleteLater()
    Theme.of(make_application()).choose(ThemeChoice.SYSTEM)


def brightness(colour: QColor) -> float:
    """Relative luminance after WCAG 2, 0 to 1."""
    shares = [colour.redF(), colour.greenF(), colour.blueF()]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: QColor, other: QColor) -> float:
    low, high = sorted((brightness(one), brightness(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("is_dark", [False, True])
@pytest.mark.parametrize(("text", "ground"), ROLES)
def test_text_is_easily_read_on_its_ground(
    is_dark: bool, text: QPalette.ColorRole, ground: QPalette.ColorRole
) -> None:
    palette = palette_of(is_dark=is_dark)
    assert contrast(palette.color(text), palette.color(ground)) >= 4.5


@pytest.mark.parametrize("is_dark", [False, True])
def test_both_looks_share_the_one_accent(is_dark: bool) -> None:
    palette = palette_of(is_dark=is_dark)
    highlight = palette.color(QPalette.ColorRole.Highlight)
    assert highlight == palette.color(QPalette.ColorRole.Accent)
    assert highlight == palette_of(is_dark=not is_dark).color(QPalette.ColorRole.Highlight)


def test_a_chosen_theme_shows_at_once_and_is_remembered(
    qtbot: QtBot, parts: WindowParts, settings: Settings
) -> None:
    def ground() -> float:
        return brightness(parts.window.palette().window().color())

    actions = parts.window.actions_by_id
    actions["theme-dark"].trigger()
    qtbot.waitUntil(lambda: ground() < 0.1, timeout=30_000)
    assert settings.theme is ThemeChoice.DARK
    assert actions["theme-dark"].isChecked()
    assert not actions["theme-system"].isChecked()
    actions["theme-light"].trigger()
    qtbot.waitUntil(lambda: ground() > 0.7, timeout=30_000)
    assert settings.theme is ThemeChoice.LIGHT


def test_icons_are_drawn_in_the_colours_of_the_theme(qtbot: QtBot, parts: WindowParts) -> None:
    def ink(icon: QIcon) -> float:
        image = icon.pixmap(20, 20).toImage()
        colours = [image.pixelColor(x, y) for x in range(20) for y in range(20)]
        solid = [brightness(colour) for colour in colours if colour.alpha() > 200]
        return sum(solid) / len(solid)

    for theme, is_bright in (("dark", True), ("light", False)):
        parts.window.actions_by_id[f"theme-{theme}"].trigger()
        qtbot.waitUntil(
            lambda is_bright=is_bright: (
                (ink(parts.window.actions_by_id["open"].icon()) > 0.5) is is_bright
            )
        )


def test_the_next_window_has_the_theme_that_was_chosen(
    qtbot: QtBot, settings: Settings, tmp_path: Path
) -> None:
    settings.choose_theme(ThemeChoice.DARK)
    parts = build_window(settings, tmp_path / "projects")
    assert parts.theme.is_dark
    assert parts.window.actions_by_id["theme-dark"].isChecked()
    parts.window.close()
    parts.window.deleteLater()
    parts.theme.choose(ThemeChoice.SYSTEM)


def test_an_unknown_theme_in_the_settings_is_the_systems(tmp_path: Path) -> None:
    (tmp_path / "settings.ini").write_text("[General]\ntheme=pink\n", encoding="utf-8")
    assert Settings(tmp_path / "settings.ini").theme is ThemeChoice.SYSTEM
