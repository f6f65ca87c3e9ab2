"""Where noted files are now, by the text of their paths, for both families of systems."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.recording.file_locations import (
    FolderMove,
    below,
    beside,
    folder_of,
    name_of,
    path_now,
)


@pytest.mark.parametrize(
    ("path", "folder", "name"),
    [
        ("/data/ward/left 1.laz", "/data/ward", "left 1.laz"),
        ("/left.laz", "/", "left.laz"),
        ("/data/back\\slash.laz", "/data", "back\\slash.laz"),
        (r"D:\納品\左.laz", r"D:\納品", "左.laz"),
        ("D:/deliveries/left.laz", "D:/deliveries", "left.laz"),
        ("D:\\left.laz", "D:\\", "left.laz"),
        (r"\\server\share\left.laz", r"\\server\share", "left.laz"),
    ],
)
def test_a_path_is_divided_as_the_system_that_noted_it_would(path, folder, name):
    assert (folder_of(path), name_of(path)) == (folder, name)


@pytest.mark.parametrize(
    ("folder", "home", "found"),
    [
        ("/jobs/7/delivery", "/jobs/7/street.zuka", "/new/delivery"),
        ("/jobs/7/street.zuka/in", "/jobs/7/street.zuka", "/new/street.zuka/in"),
        (r"C:\Jobs\7\delivery\left", r"c:\jobs\7\street.zuka", "/new/delivery/left"),
        (r"D:\delivery", r"C:\jobs\street.zuka", None),
        ("/delivery", r"C:\jobs\street.zuka", None),
    ],
)
def test_what_lay_beside_a_project_lies_beside_it_on_another_machine(folder, home, found):
    assert beside(folder, home, Path("/new/street.zuka")) == (
        None if found is None else Path(found)
    )


def test_a_chosen_folder_is_searched_from_the_whole_way_down_to_itself():
    assert below(r"D:\ward\day 2", Path("/mnt")) == (
        Path("/mnt/ward/day 2"),
        Path("/mnt/day 2"),
        Path("/mnt"),
    )


def test_only_files_of_a_moved_folder_itself_are_elsewhere():
    moves = (FolderMove(r"D:\ward", "/mnt/ward"),)
    assert path_now(r"D:\ward\left.laz", moves) == Path("/mnt/ward/left.laz")
    assert path_now(r"D:\ward\2\left.laz", moves) == Path(r"D:\ward\2\left.laz")
