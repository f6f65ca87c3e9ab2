"""Memory is watched from outside; a project is measured on a copy that can't change it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from processing.laboratory.bench.cases.large_case import link_project
from processing.laboratory.bench.memory_watch import MemorySample, MemoryWatch, memory_of_tree
from processing.project.project import Project

HOLDING = (
    "import subprocess, sys; held = bytearray(64 << 20);"
    "child = subprocess.Popen([sys.executable, '-c', sys.argv[1]], stdin=subprocess.PIPE);"
    "print('held', flush=True); sys.stdin.readline(); child.communicate(); "
)


def test_what_a_process_and_its_children_hold_is_seen() -> None:
    if sys.platform != "linux":  # others don't tell, and nothing is made up
        assert memory_of_tree(os.getpid()) == (0, 0)
        return
    child = "import sys; held = bytearray(64 << 20); sys.stdin.readline()"
    with subprocess.Popen(
        [sys.executable, "-c", HOLDING, child],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        own = 64 << 20
        while memory_of_tree(process.pid)[1] < 2 * own:  # until the child holds its part as well
            assert process.poll() is None
        resident, anonymous = memory_of_tree(process.pid)
        assert 2 * own <= anonymous <= resident < 5 * own
        process.communicate("\n")
    assert memory_of_tree(process.pid) == (0, 0)


def test_a_peak_is_that_between_two_moments() -> None:
    watch = MemoryWatch(0)
    watch.samples += [MemorySample(1.0, 50, 9), MemorySample(2.0, 80, 5), MemorySample(3.0, 20, 1)]
    assert watch.at(2.5) == MemorySample(2.0, 80, 5)
    assert watch.at(0.5) is None
    assert watch.peak(0.0, 2.5) == MemorySample(2.0, 80, 9)
    assert watch.peak(3.5, 3.6) == MemorySample(3.0, 20, 1)


def test_a_linked_project_opens_beside_the_open_one_and_leaves_it_as_it_is(tmp_path: Path) -> None:
    folder, copy = tmp_path / "one.zuka", tmp_path / "two.zuka"
    project = Project.create(folder, "EPSG:6677")
    column = folder / "drives" / "a" / "xyz.bin"
    column.parent.mkdir(parents=True)
    column.write_bytes(b"measured")
    (column.parent / "tile_bounds_x.npy").write_bytes(b"computed")
    label = column.with_name("label.bin")
    label.write_bytes(b"painted")
    link_project(folder, copy)
    assert (copy / "drives" / "a" / "xyz.bin").samefile(column)
    assert not (copy / "drives" / "a" / "label.bin").samefile(label)
    assert not (copy / "drives" / "a" / "tile_bounds_x.npy").exists()
    project.close()
    assert column.read_bytes() == b"measured"
