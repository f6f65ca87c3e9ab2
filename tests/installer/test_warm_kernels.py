"""Every kernel is compiled at set-up, and one that cannot be is noticed there."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from installer.warm_kernels import warm


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
    assert warm(street) == ("street.below.lids", "street.curbs")
    assert street.warmed == ["lids", "curbs"]


def test_a_warm_up_that_fails_ends_the_set_up(package: Path) -> None:
    write_warm_up(package / "curbs.py", "raise TypeError('no such kernel')")
    with pytest.raises(TypeError, match="no such kernel"):
        warm(importlib.import_module("street"))


def test_a_module_that_cannot_be_imported_ends_the_set_up(package: Path) -> None:
    (package / "curbs.py").write_text("import street.nowhere\n")
    with pytest.raises(ModuleNotFoundError):
        warm(importlib.import_module("street"))
