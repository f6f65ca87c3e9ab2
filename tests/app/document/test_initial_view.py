"""A project is first shown by what its points have, and the next one by what was wanted."""

from pathlib import Path

import numpy as np

from app.document.initial_view import InitialView
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import small_drive
from widgets.shared.view_settings import ViewSettings


def _drive(folder: Path, *, has_intensity: bool) -> Drive:
    drive, _ = small_drive(folder)
    values = np.arange(drive.count) % 200 if has_intensity else np.zeros(drive.count)
    drive.columns.add("intensity", values)
    return drive


def test_a_cloud_without_intensity_is_shown_by_height_and_the_next_one_by_toned_intensity_again(
    tmp_path: Path,
) -> None:
    settings = ViewSettings()
    first = InitialView(settings)
    first.show([_drive(tmp_path / "bare", has_intensity=False)])
    assert settings.look.attribute == "height"
    settings.show_image("", settings.image_kind)  # the project is closed
    first.show([_drive(tmp_path / "full", has_intensity=True)])
    assert settings.look.attribute == "toned"


def test_what_a_hand_chose_stays(tmp_path: Path) -> None:
    settings = ViewSettings()
    first = InitialView(settings)
    settings.change_look(attribute="normal")
    first.show([_drive(tmp_path / "bare", has_intensity=False)])
    assert settings.look.attribute == "normal"
    assert settings.image_kind is ImageKind.TRAJECTORY_CENTER
