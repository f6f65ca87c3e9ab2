"""The views go to a second screen and come back, with all that they show."""

from __future__ import annotations

from pathlib import Path

from app.layout.view_docks import ViewLayout
from tests.journeys.conftest import WAIT_MS, Surveyor


def test_the_3d_view_goes_to_another_window_and_comes_back(
    surveyor: Surveyor, tmp_path: Path
) -> None:
    surveyor.open_sample_street(tmp_path / "street.zuka")
    scene, bot = surveyor.parts.scene_view, surveyor.bot
    bot.waitUntil(lambda: scene.cloud is not None and scene.is_settled, timeout=WAIT_MS)
    picture = scene.picture
    assert picture is not None
    for layout in (ViewLayout.TWO_SCREENS, ViewLayout.CHECKING):
        with bot.waitSignal(picture.frame_painted, timeout=WAIT_MS):
            surveyor.parts.window.area.place(layout)
        bot.waitUntil(lambda: scene.is_settled, timeout=WAIT_MS)
        is_apart = layout is ViewLayout.TWO_SCREENS
        assert (scene.window() is not surveyor.parts.window) == is_apart
        colours = picture.grab().toImage()
        middle = colours.height() // 2
        assert len({colours.pixel(x, middle) for x in range(colours.width())}) > 10
