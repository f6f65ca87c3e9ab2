"""What is remembered between starts; what other versions wrote is read, damage is passed over."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QSettings

from app.layout.view_area import AreaLayout
from app.settings.settings import Settings, WindowLayout


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "settings.ini"


def again(file: Path) -> Settings:
    """The settings as the next start reads them."""
    return Settings(file)


def folders(settings: Settings) -> list[str]:
    return [one.folder.name for one in settings.recent_projects]


def test_projects_are_listed_by_when_they_were_opened_last(file: Path, tmp_path: Path) -> None:
    settings = Settings(file)
    for name in ("A.zuka", "国道, 16号.zuka", "A.zuka"):
        (tmp_path / name).mkdir(exist_ok=True)
        settings.remember_project(tmp_path / name)
    assert folders(again(file)) == ["A.zuka", "国道, 16号.zuka"]
    assert all(one.opened_at is not None for one in again(file).recent_projects)


def test_a_project_that_is_gone_stays_listed_as_missing_until_it_is_taken_off(
    file: Path, tmp_path: Path
) -> None:
    settings = Settings(file)
    (tmp_path / "A.zuka").mkdir()
    settings.remember_project(tmp_path / "A.zuka")
    settings.remember_project(tmp_path / "gone.zuka")
    assert [one.is_missing for one in again(file).recent_projects] == [True, False]
    again(file).forget_project(tmp_path / "gone.zuka")
    assert folders(again(file)) == ["A.zuka"]
    again(file).forget_project(tmp_path / "A.zuka")
    assert folders(again(file)) == []


def test_the_list_of_the_version_before_has_no_days(file: Path, tmp_path: Path) -> None:
    before = QSettings(str(file), QSettings.Format.IniFormat)
    before.setValue("recent", [str(tmp_path / "A.zuka"), str(tmp_path / "B.zuka")])
    before.sync()
    assert folders(Settings(file)) == ["A.zuka", "B.zuka"]
    assert [one.opened_at for one in Settings(file).recent_projects] == [None, None]


def test_a_damaged_day_is_no_day(file: Path, tmp_path: Path) -> None:
    Settings(file).remember_project(tmp_path / "A.zuka")
    store = QSettings(str(file), QSettings.Format.IniFormat)
    store.setValue("recent_opened_at", ["yesterday"])
    store.sync()
    assert Settings(file).recent_projects[0].opened_at is None


def test_at_most_ten_projects_are_kept(file: Path, tmp_path: Path) -> None:
    for number in range(12):
        Settings(file).remember_project(tmp_path / f"{number}.zuka")
    assert folders(again(file)) == [f"{number}.zuka" for number in range(11, 1, -1)]


def test_keys_are_kept_with_their_commas_and_their_absence(file: Path) -> None:
    chosen = {"open": ("Ctrl+,", "Volume Up"), "export": (), "curb": ("1",)}
    Settings(file).keep_shortcuts(chosen)
    assert again(file).shortcuts == chosen
    again(file).keep_shortcuts({"curb": ("2",)})
    assert again(file).shortcuts == {"curb": ("2",)}


def test_what_was_used_last_comes_first(file: Path) -> None:
    for name in ("open", "export", "open"):
        Settings(file).remember_use(name)
    assert again(file).last_used == ("open", "export")


def test_a_layout_of_the_version_before_is_read(file: Path) -> None:
    assert Settings(file).layout is None
    before = QSettings(str(file), QSettings.Format.IniFormat)
    before.setValue("geometry", QByteArray(b"g"))
    before.setValue("state", QByteArray(b"s"))
    before.sync()
    kept = Settings(file).layout
    assert kept == WindowLayout(QByteArray(b"g"), QByteArray(b"s"), AreaLayout())
