"""The import contracts of pyproject.toml catch what they are for.

``lint-imports`` itself holds the program to them; here they are tried on small trees.
"""

from __future__ import annotations

import subprocess
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.house_rules.sources import ROOT, text_of

FLOORS = (
    "core",
    "recording",
    "image",
    "cameras",
    "section",
    "labels",
    "map",
    "scoring",
    "methods",
    "tools",
    "formats",
    "project",
    "operations",
    "laboratory",
)
"""The floors of processing from the lowest on."""
MODULES = (
    "app.cli",
    "app.application",
    "widgets.image_view",
    "widgets.scene_view",
    "widgets.section_view",
    "widgets.camera_view",
    "widgets.map_view",
    "widgets.panels",
    *(f"processing.{floor}" for floor in FLOORS),
    "resources",
)
VIOLATIONS = (
    ("Imports go down only", "processing/map/points.py", "import widgets.panels"),
    ("Imports go down only", "resources/door.py", "import processing.tools"),
    (
        "The terminal and the arithmetic never reach Qt",
        "app/cli/late.py",
        "def show() -> None:\n    import PySide6.QtWidgets",
    ),
    (
        "The terminal and the arithmetic never reach Qt",
        "app/cli/around.py",
        "import app.application",
    ),
    ("The arithmetic never reaches VTK", "processing/map/mesh.py", "import vtkmodules"),
    (
        "The floors of processing",
        "processing/tools/noise.py",
        "from processing.formats import las",
    ),
    ("The floors of processing", "processing/map/store.py", "import processing.project"),
    (
        "No circles between files or folders",
        "widgets/panels/__init__.py",
        "import widgets.parts.bar",
    ),
    ("Views know no file format", "widgets/panels/reader.py", "import processing.formats"),
    ("Views don't know each other", "widgets/image_view/v.py", "import widgets.scene_view"),
)


def contracts() -> list[dict[str, object]]:
    """Give the contracts as they stand in pyproject.toml."""
    found = tomllib.loads(text_of("pyproject.toml"))["tool"]["importlinter"]["contracts"]
    return list(found)


def write_tree(folder: Path, more: Mapping[str, str]) -> None:
    """Write a small tree that keeps every contract, then some files on top of it."""
    (folder / "pyproject.toml").write_text(text_of("pyproject.toml"), encoding="utf-8")
    listed = [name for contract in contracts() for name in _modules_in(contract)]
    for module in (*MODULES, *listed):
        path = folder
        for part in module.split("."):
            path /= part
            path.mkdir(exist_ok=True)
            (path / "__init__.py").touch()
    (folder / "processing" / "formats" / "las.py").touch()
    (folder / "widgets" / "parts").mkdir()
    (folder / "widgets" / "parts" / "__init__.py").touch()
    (folder / "widgets" / "parts" / "bar.py").write_text("import widgets.panels\n")
    (folder / "app" / "application" / "__init__.py").write_text("import PySide6.QtCore\n")
    for name, text in more.items():
        (folder / name).write_text(text + "\n", encoding="utf-8")


def _modules_in(contract: Mapping[str, object]) -> list[str]:
    listed = contract.get("source_modules", [])
    assert isinstance(listed, list)
    return [str(name) for name in listed]


def lint(folder: Path) -> str:
    command = Path(sys.executable).with_name("lint-imports")
    answer = subprocess.run(
        [str(command), "--no-cache"], cwd=folder, capture_output=True, text=True, check=False
    )
    return answer.stdout + answer.stderr


def test_a_tree_that_keeps_to_the_layers_passes(tmp_path: Path) -> None:
    write_tree(tmp_path, {"widgets/panels/run.py": "import processing.tools"})
    said = lint(tmp_path)
    assert f"{len(contracts())} kept, 0 broken" in said, said


@pytest.mark.parametrize(("contract", "name", "text"), VIOLATIONS)
def test_an_import_against_the_rules_is_caught(
    tmp_path: Path, contract: str, name: str, text: str
) -> None:
    write_tree(tmp_path, {name: text})
    said = lint(tmp_path)
    assert f"{contract} BROKEN" in said, said


def test_every_contract_has_a_violation_that_it_is_tried_on() -> None:
    assert {contract["name"] for contract in contracts()} == {name for name, _, _ in VIOLATIONS}


def test_every_folder_of_processing_is_a_floor() -> None:
    folders = {path.parent.name for path in (ROOT / "processing").glob("*/__init__.py")}
    assert folders == set(FLOORS)
    (contract,) = (one for one in contracts() if one["name"] == "The floors of processing")
    assert contract["layers"] == list(reversed(FLOORS))
