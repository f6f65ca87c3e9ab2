"""A Python file in a folder is a tool; its faults are its own, and are told by name."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, UserError
from processing.operations import scripting
from processing.tools.listed.registry import TOOLS, every_tool
from processing.tools.plugins.folders import FOLDERS, plugin_files
from processing.tools.plugins.loading import load_plugin, load_plugins
from tests.delivered_files import make_las
from tests.house_rules.sources import ROOT
from tests.monitors import CancelledAfter

PLUGIN = """
from dataclasses import dataclass
import numpy as np
from processing.core.parameters import length
from processing.core.text import Text
from processing.tools.tool import Needs, OutputColumn, PerPoint, PointResult, Tool

@dataclass(frozen=True)
class Parameters:
    above_m: float = length(2.0, low=-1000.0, high=1000.0, name=Text("Height", "高さ"))

def mark(block, parameters, monitor):
    {body}
    high = block.xyz[:, 2] > parameters.above_m
    return PointResult({{"classification": np.where(high, 5, 1).astype(np.uint8)}})

TOOL = Tool(
    "{id}", Text("Own", "独自"), Text("Marks.", "分類します。"), Text("Points", "点群"),
    Needs.POINTS, Parameters,
    PerPoint(mark, outputs=(OutputColumn("classification", "uint8", 1, Text("C", "ク")),)),
    gives_classes=(5, 1),
)
"""


def write_plugin(folder: Path, name: str = "own", body: str = "pass", text: str = PLUGIN) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{name}.py"
    path.write_text(text.format(body=body, id=name), encoding="utf-8")
    return path


@pytest.fixture(autouse=True)
def registry() -> Iterator[None]:
    """Forget the plug-ins of a test."""
    before = set(TOOLS)
    yield
    for id_ in set(TOOLS) - before:
        TOOLS.pop(id_)  # type: ignore[attr-defined] # a dict that only the registry may change


@pytest.fixture
def cloud(tmp_path: Path) -> Path:
    make_las(tmp_path / "cloud.las")
    return tmp_path / "cloud.las"


def test_a_file_in_a_folder_is_a_tool(cloud: Path, tmp_path: Path) -> None:
    write_plugin(tmp_path / "プラグイン 1")
    write_plugin(tmp_path / "プラグイン 1", "_part")
    assert load_plugins(plugin_files([tmp_path / "プラグイン 1", tmp_path / "none"])) == ()
    assert "own" in every_tool()
    assert "_part" not in every_tool()
    scripting.run("own", cloud, output=tmp_path / "out.las", above_m=100.5)
    points = laspy.read(tmp_path / "out.las")
    expected = np.where(np.asarray(points.z) > 100.5, 5, 1)
    np.testing.assert_array_equal(points.classification, expected)


@pytest.mark.parametrize(
    ("text", "said", "line"),
    [
        ("import nothing_of_that_name", "No module named", 1),
        ("x = 1\n1 / 0", "ZeroDivisionError", 2),
        ("def (", "SyntaxError", 1),
        ("x = 1", "no TOOL", 1),
        ("TOOL = 3", "no TOOL", 1),
        ("\n\ndef f():\n    from PySide6.QtWidgets import QLabel", "PySide6", 4),
        ("import vtkmodules.all", "vtkmodules", 1),
        (PLUGIN.replace('"{id}"', '"noise"'), "this name already", 0),
        (PLUGIN.replace('"{id}"', '"My Tool"'), "My Tool", 1),
        (PLUGIN.replace("Parameters,\n", "int,\n"), "TypeError", 1),
    ],
)
def test_one_that_can_not_be_loaded_is_named_and_all_others_are(
    tmp_path: Path, text: str, said: str, line: int
) -> None:
    folder = tmp_path / "plugins"
    write_plugin(folder, "bad", text=text)
    write_plugin(folder, "good")
    (error,) = load_plugins(plugin_files([folder]))
    assert said in error.what.en + error.where.en
    assert "bad.py" in error.where.ja
    assert not line or error.where.en.endswith(f"line {line}")
    assert "good" in every_tool()


def test_one_that_raises_fails_with_its_line(cloud: Path, tmp_path: Path) -> None:
    path = write_plugin(tmp_path / "plugins", body="[][7]")
    load_plugins([path])
    with pytest.raises(UserError, match="IndexError") as met:
        scripting.run("own", cloud, output=tmp_path / "out.las")
    line = path.read_text(encoding="utf-8").splitlines().index("    [][7]") + 1
    assert met.value.where.en == f"{path}, line {line}"
    assert not (tmp_path / "out.las").exists()


def test_one_that_loops_can_be_cancelled(cloud: Path, tmp_path: Path) -> None:
    load_plugins([write_plugin(tmp_path / "plugins", body="while True: pass")])
    before = sys.gettrace()

    class Patient(CancelledAfter):
        """Lets the import through, and nothing that takes for ever."""

    with pytest.raises(Cancelled):
        scripting.run("own", cloud, output=tmp_path / "out.las", monitor=Patient(60))
    assert sys.gettrace() is before
    assert not (tmp_path / "out.las").exists()


def test_a_plugin_is_a_tool_of_the_command_line(tmp_path: Path) -> None:
    write_plugin(tmp_path / "plugins")
    write_plugin(tmp_path / "plugins", "bad", text="1 / 0")
    environment = {**os.environ, FOLDERS: str(tmp_path / "plugins"), "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "app", "tools", "own", "--json"],
        capture_output=True,
        check=True,
        env=environment,
    )
    assert json.loads(done.stdout)["parameters"][0]["id"] == "above_m"
    assert b"bad.py, line 1" in done.stderr


def test_a_tool_that_was_loaded_keeps_what_it_declares(tmp_path: Path) -> None:
    tool = load_plugin(write_plugin(tmp_path / "plugins"))
    assert (tool.id, tool.gives_classes, tool.gives_candidates) == ("own", (5, 1), False)
