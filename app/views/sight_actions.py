"""Sight actions: which way images run, what stands beside them, what views leave out."""

from __future__ import annotations

from dataclasses import replace

from app.window.action import Action, grouped
from app.window.window_parts import WindowParts
from processing.core.text import Text
from widgets.scene_view.clipping import ClipChoice

_CLIPS = {
    ClipChoice.EVERYTHING: Text("All points", "すべての点"),
    ClipChoice.DRIVE: Text("Around the drive", "走行軌跡の周囲"),
    ClipChoice.SELECTION: Text("Around what is chosen", "選択した地物の周囲"),
    ClipChoice.SECTION: Text("Within the section", "断面の範囲"),
}

_NOISE_HIDDEN = Text("Noise is hidden in all views.", "すべてのビューでノイズを隠しています。")
_NOISE_SHOWN = Text("Noise is shown again.", "ノイズを再び表示しています。")


def sight_actions(parts: WindowParts) -> tuple[Action, ...]:
    """What images and 3D show of the recording."""
    return grouped(
        (*_orientations(parts), *_beside(parts), *_clips(parts)),
        (_hide_noise(parts),),
    )


def _orientations(parts: WindowParts) -> tuple[Action, ...]:
    settings = parts.document.shared.view_settings
    fields = {
        "image-upwards": ("is_vertical", Text("Street upwards", "道路を上向きに表示")),
        "image-mirrored": (
            "is_mirrored_across",
            Text("Exchange left and right sides", "左右を反転"),
        ),
        "image-reversed": (
            "is_reversed_along",
            Text("Against the direction of travel", "進行方向を反転"),
        ),
    }

    def turning(id_: str) -> Action:
        field, text = fields[id_]

        def turn() -> None:
            orientation = settings.image_orientation
            settings.orient_image(replace(orientation, **{field: not getattr(orientation, field)}))

        return Action(
            id_,
            text,
            turn,
            "view/image",
            is_checkable=True,
            is_checked=getattr(settings.image_orientation, field),
            needs_project=True,
        )

    return tuple(map(turning, fields))


def _beside(parts: WindowParts) -> tuple[Action, ...]:
    images = parts.image_views

    def lock() -> None:
        images.lock(parts.window.actions_by_id["lock-scrolling"].isChecked())

    return (
        Action(
            "another-image",
            Text("Another image beside", "別の画像を並べる"),
            images.add,
            "view/image",
            hint=Text(
                "The other scanner, another kind or attribute of the same place.",
                "同じ場所の別のスキャナ・画像の種類・表示属性を並べて表示します。",
            ),
            needs_project=True,
        ),
        Action(
            "lock-scrolling",
            Text("Images scroll together", "画像を連動してスクロール"),
            lock,
            "view/image",
            is_checkable=True,
            is_checked=images.is_locked,
            needs_project=True,
        ),
    )


def _hide_noise(parts: WindowParts) -> Action:
    settings = parts.document.shared.view_settings

    def toggle() -> None:
        hides_noise = not settings.look.hides_noise
        settings.change_look(hides_noise=hides_noise)
        parts.status_line.show_message(_NOISE_HIDDEN if hides_noise else _NOISE_SHOWN)

    return Action(
        "hide-noise",
        Text("Hide noise", "ノイズを隠す"),
        toggle,
        "view",
        ("Shift+N",),
        "mdi6.blur-off",
        toolbar=2,
        is_checkable=True,
        is_checked=settings.look.hides_noise,
        hint=Text(
            "Points whose class is noise are neither drawn nor picked, in any view.",
            "クラスがノイズの点を、すべてのビューで表示せず、選択もできないようにします。",
        ),
        needs_project=True,
    )


def _clips(parts: WindowParts) -> tuple[Action, ...]:
    scene = parts.scene_view

    def clipping(choice: ClipChoice) -> Action:
        def choose() -> None:
            scene.clipping.choose(choice)
            chosen = scene.clipping.choice.value
            parts.window.actions_by_id[f"clip-{chosen}"].setChecked(True)

        return Action(
            f"clip-{choice.value}",
            _CLIPS[choice],
            choose,
            "view/clip",
            is_checkable=True,
            is_checked=scene.clipping.choice is choice,
            group="clip",
            needs_project=True,
        )

    return tuple(clipping(choice) for choice in ClipChoice)
