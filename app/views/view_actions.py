"""View actions: what is shown and how."""

from __future__ import annotations

from collections.abc import Callable

from app.settings.theme import ThemeChoice
from app.window.action import Action, grouped
from app.window.window_parts import WindowParts
from processing.core.text import Language, Text
from processing.image.attributes.attributes import ATTRIBUTES
from processing.image.attributes.waveform_values import WAVEFORM_ATTRIBUTES
from processing.recording.columns.point_features import POINT_FEATURES
from processing.recording.kinds import ImageKind

_THEMES = {
    ThemeChoice.SYSTEM: Text("As the system is", "システムに合わせる"),
    ThemeChoice.LIGHT: Text("Light", "ライト"),
    ThemeChoice.DARK: Text("Dark", "ダーク"),
}
_LANGUAGES: dict[Language, Text] = {"ja": Text.same("日本語"), "en": Text.same("English")}


def view_actions(parts: WindowParts, speak: Callable[[Language], None]) -> tuple[Action, ...]:
    """The view menu, from top to bottom; panels follow.

    Parameters
    ----------
    speak : callable
        Changes the language of the window.
    """
    return grouped(
        _positions(parts),
        (*_standings(parts), *_sections(parts)),
        (*_themes(parts), *_languages(parts, speak)),
        _looks(parts),
    )


def _positions(parts: WindowParts) -> tuple[Action, ...]:
    def show_everything() -> None:
        for view in parts.views:
            view.show_everything()

    def center() -> None:
        for view in parts.views:
            view.center_on_selection()

    return (
        Action(
            "everything",
            Text("Show everything", "全体を表示"),
            show_everything,
            "view",
            ("Home",),
            "mdi6.fit-to-page-outline",
            hint=Text(
                "The whole recording in every view.",
                "すべてのビューに走行データの全体を表示します。",
            ),
            needs_project=True,
        ),
        Action(
            "center",
            Text("Centre on the selection", "選択位置を中央に表示"),
            center,
            "view",
            ("F",),
            hint=Text(
                "Brings what is chosen, or else the cursor, into the middle of every view.",
                "選択した地物（なければカーソル）を各ビューの中央に表示します。",
            ),
            needs_project=True,
        ),
    )


def _standings(parts: WindowParts) -> tuple[Action, ...]:
    """How the views stand to each other, and from where 3D looks."""

    def toggle_beside() -> None:
        action = parts.window.actions_by_id["side-by-side"]
        parts.window.area.stand_side_by_side(beside=action.isChecked())

    return (
        Action(
            "side-by-side",
            Text("Views side by side", "ビューを左右に並べる"),
            toggle_beside,
            "view",
            is_checkable=True,
            is_checked=parts.window.area.is_beside,
            hint=Text(
                "The image and 3D beside each other instead of one above the other.",
                "画像と3Dを上下ではなく左右に並べます。",
            ),
            needs_project=True,
        ),
        Action(
            "top-view",
            Text("3D from above", "3Dを真上から表示"),
            parts.scene_view.look_from_above,
            "view",
            ("Ctrl+T",),
            hint=Text("Looks straight down, north up.", "北を上にして真上から見ます。"),
            needs_project=True,
        ),
        Action(
            "along-view",
            Text("3D along the drive", "3Dを走行方向に表示"),
            parts.scene_view.look_along_drive,
            "view",
            ("Ctrl+L",),
            hint=Text(
                "Looks from behind and above, as the vehicle drove.",
                "車両の進行方向に、後方の上から見ます。",
            ),
            needs_project=True,
        ),
    )


def _sections(parts: WindowParts) -> tuple[Action, ...]:
    """Where the section stands."""
    section = parts.section_view

    def stepping(id_: str, text: Text, key: str, count: int) -> Action:
        def step() -> None:
            parts.view_docks.show_view("section")
            section.step(count)

        return Action(id_, text, step, "view/section", (key,), needs_project=True)

    def pin() -> None:
        parts.view_docks.show_view("section")
        section.set_pinned(not section.is_pinned)

    return (
        stepping("section-back", Text("Step back", "1つ戻る"), "Q", -1),
        stepping("section-forward", Text("Step forward", "1つ進む"), "W", 1),
        stepping("section-far-back", Text("Ten steps back", "10戻る"), "Shift+Q", -10),
        stepping("section-far-forward", Text("Ten steps forward", "10進む"), "Shift+W", 10),
        Action(
            "section-pin",
            Text("Hold as two windows, across and along", "横断と縦断の2画面に固定"),
            pin,
            "view/section",
            ("I",),
            hint=Text(
                "Cuts across and along the line at this place, until it is released.",
                "この位置の横断面と縦断面を並べて固定します。もう一度押すと解除します。",
            ),
            needs_project=True,
        ),
    )


def _themes(parts: WindowParts) -> tuple[Action, ...]:
    """Light, dark, or as the system is; the views of points stay dark in each."""

    def looking(choice: ThemeChoice) -> Action:
        def choose() -> None:
            parts.settings.choose_theme(choice)
            parts.theme.choose(choice)

        return Action(
            f"theme-{choice.value}",
            _THEMES[choice],
            choose,
            "view/theme",
            is_checkable=True,
            is_checked=parts.settings.theme is choice,
            group="theme",
        )

    return tuple(looking(choice) for choice in ThemeChoice)


def _languages(parts: WindowParts, speak: Callable[[Language], None]) -> tuple[Action, ...]:
    def speaking(language: Language) -> Action:
        def choose() -> None:
            speak(language)

        return Action(
            f"language-{language}",
            _LANGUAGES[language],
            choose,
            "view/language",
            is_checkable=True,
            is_checked=parts.language == language,
            group="language",
            hint=Text(
                "The window speaks this language at once.", "画面の言語をすぐに切り替えます。"
            ),
        )

    return tuple(speaking(language) for language in _LANGUAGES)


def _looks(parts: WindowParts) -> tuple[Action, ...]:
    """What points and images show: by name in the palette, in no menu."""
    settings = parts.document.shared.view_settings

    def shown_as(attribute: str) -> Action:
        def show() -> None:
            settings.change_look(attribute=attribute)

        title = ATTRIBUTES[attribute].title
        text = Text("Colour points by: {title}", "点の表示: {title}").filled(title=title)
        return Action(f"show-{attribute}", text, show, needs_project=True)

    def image_as(kind: ImageKind) -> Action:
        def show() -> None:
            drive_id = settings.drive_id
            if drive_id and kind in parts.document.drive(drive_id).image_kinds:
                settings.show_image(drive_id, kind)

        text = Text("Kind of image: {title}", "画像の種類: {title}").filled(title=kind.title)
        return Action(f"image-{kind.value}", text, show, needs_project=True)

    # Features and waveforms are chosen above the image, where those are listed that a drive has.
    listed_there = {**POINT_FEATURES, **WAVEFORM_ATTRIBUTES}
    shown = (name for name in ATTRIBUTES if name not in listed_there)
    return (*map(shown_as, shown), *map(image_as, ImageKind))
