"""Every kernel is compiled at set-up, and one that cannot be is noticed there."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from typing_extensions import override

from installer import commands
from installer.environment import Environment
from installer.warm_kernels import (
    DEMO_TOOLS,
    LATER,
    TOOLS,
    folders_of,
    remove_stale_code,
    run_tools_beside,
    warm,
    warm_beside,
)
from processing.tools.listed.registry import tools_of_drives


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Give a package folder ``street`` that can be imported; it is forgotten afterwards."""
    folder = tmp_path / "street"
    folder.mkdir()
    (folder / "__init__.py").write_text("warmed = []\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield folder
    for name in [name for name in sys.modules if name.split(".")[0] == "street"]:
        del sys.modules[name]


def write_warm_up(path: Path, body: str) -> None:
    path.write_text(f"import street\n\n\ndef warm_up():\n    {body}\n")


def test_every_warm_up_runs_once_where_it_is_defined(package: Path) -> None:
    write_warm_up(package / "curbs.py", "street.warmed.append('curbs')")
    (package / "trees.py").write_text("from street.curbs import warm_up\n")
    (package / "below").mkdir()
    (package / "below" / "__init__.py").touch()
    write_warm_up(package / "below" / "lids.py", "street.warmed.append('lids')")
    street = importlib.import_module("street")
    names = [name for folder in folders_of(street) for name in folder]
    assert sorted(names) == ["street.below", "street.below.lids", "street.curbs", "street.trees"]
    assert warm(sorted(names)) == ("street.below.lids", "street.curbs")
    assert street.warmed == ["lids", "curbs"]


def test_the_folder_with_most_kernels_comes_first_and_what_the_demo_leaves_out_not_at_all(
    package: Path,
) -> None:
    for folder, kernels in (("curbs", 1), ("noise", 3), ("noise_maps", 2), ("trees", 0)):
        (package / folder).mkdir()
        (package / folder / "__init__.py").touch()
        (package / folder / "one.py").write_text("# @kernel\n" * kernels)
    street = importlib.import_module("street")
    assert [folder[0] for folder in folders_of(street)[:3]] == [
        "street.noise.one",
        "street.noise_maps.one",
        "street.curbs.one",
    ]
    names = [name for folder in folders_of(street, ["street.noise"]) for name in folder]
    assert sorted(names) == [
        "street.curbs",
        "street.curbs.one",
        "street.noise_maps",
        "street.noise_maps.one",
        "street.trees",
        "street.trees.one",
    ]


def test_processes_beside_run_every_warm_up(package: Path) -> None:
    for name in ("curbs", "lids", "trees"):
        write_warm_up(package / f"{name}.py", "open(__file__ + '.warm', 'x').close()")
    street = importlib.import_module("street")
    assert warm_beside(folders_of(street), 2) == ("street.curbs", "street.lids", "street.trees")
    assert len(list(package.glob("*.warm"))) == 3


def test_a_warm_up_that_fails_beside_ends_the_set_up(package: Path) -> None:
    write_warm_up(package / "curbs.py", "raise TypeError('no such kernel')")
    with pytest.raises(TypeError, match="no such kernel"):
        warm_beside(folders_of(importlib.import_module("street")), 2)


def test_a_warm_up_that_fails_ends_the_set_up(package: Path) -> None:
    write_warm_up(package / "curbs.py", "raise TypeError('no such kernel')")
    with pytest.raises(TypeError, match="no such kernel"):
        warm(["street.curbs"])


def test_a_module_that_cannot_be_imported_ends_the_set_up(package: Path) -> None:
    (package / "curbs.py").write_text("import street.nowhere\n")
    with pytest.raises(ModuleNotFoundError):
        warm(["street.curbs"])


NOTES_ITS_ARGUMENTS = """
import sys
from pathlib import Path

with Path("runs.txt").open("a") as notes:
    notes.write(f"{' '.join(sys.argv[1:])};")
"""


class OwnPython(Environment):
    """An environment whose programs are those of the tests."""

    @override
    def program(self, name: str) -> Path:
        return Path(sys.executable)


@pytest.fixture
def checkout(tmp_path: Path) -> Environment:
    """Give a set-up checkout whose compiler of kernels only notes how it is called."""
    for name in (".venv", "installer", "processing"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "installer" / "warm_kernels.py").write_text(NOTES_ITS_ARGUMENTS)
    (tmp_path / "processing" / "curbs.py").touch()
    (tmp_path / "requirements.lock").touch()
    return OwnPython(tmp_path, os.environ)


def noted(checkout: Environment) -> list[str]:
    return (checkout.root / "runs.txt").read_text().split(";")[:-1]


def test_kernels_of_the_demo_are_compiled_alone_and_kept_for_the_tests(
    checkout: Environment,
) -> None:
    for only_for_demo in (True, True, False, False, True):
        commands._warm_kernels(checkout, only_for_demo=only_for_demo)
    assert noted(checkout) == ["--demo", ""]
    (checkout.root / "processing" / "curbs.py").write_text("STEP_M = 0.15\n")
    commands._warm_kernels(checkout, only_for_demo=True)
    assert noted(checkout) == ["--demo", "", "--demo"]


def test_the_other_kernels_are_compiled_beside_the_window_once(checkout: Environment) -> None:
    for _ in range(2):
        with commands._other_kernels_beside(checkout) as compiler:
            if compiler is not None:
                compiler.wait()
    commands._warm_kernels(checkout, only_for_demo=False)
    assert noted(checkout) == ["--processes 1"]


def test_machine_code_that_is_older_than_its_source_is_removed(tmp_path: Path) -> None:
    cache = tmp_path / "curbs" / "__pycache__"
    cache.mkdir(parents=True)
    for name in ("fresh", "changed", "gone"):
        (cache / f"{name}.loop-3.py311.nbi").touch()
        (cache / f"{name}.loop-3.py311.1.nbc").touch()
    os.utime(cache / "changed.loop-3.py311.nbi", (1_000, 1_000))
    os.utime(cache / "changed.loop-3.py311.1.nbc", (1_000, 1_000))
    for name in ("fresh", "changed"):
        (tmp_path / "curbs" / f"{name}.py").touch()
        os.utime(tmp_path / "curbs" / f"{name}.py", (2_000, 2_000))
    assert remove_stale_code(tmp_path) == 4
    assert sorted(path.name for path in cache.iterdir()) == [
        "fresh.loop-3.py311.1.nbc",
        "fresh.loop-3.py311.nbi",
    ]


def test_what_the_demo_leaves_out_is_there() -> None:
    for name in LATER:
        assert importlib.util.find_spec(name) is not None


def test_tools_run_on_the_bundled_street_and_one_that_fails_ends_the_set_up() -> None:
    run_tools_beside(["curbs"], 1)
    with pytest.raises(RuntimeError, match="nothing"):
        run_tools_beside(["nothing"], 1)


def test_what_runs_at_set_up_are_tools() -> None:
    assert set(TOOLS) <= tools_of_drives().keys()
    assert set(DEMO_TOOLS) < set(TOOLS)
