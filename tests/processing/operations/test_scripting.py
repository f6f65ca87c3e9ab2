"""Scripts do what the program does, by the same names; their examples are true."""

from __future__ import annotations

import doctest
from pathlib import Path

from processing.operations import scripting as zuka
from processing.operations.operation_files import OPERATIONS
from processing.tools.listed.registry import every_tool
from tests.delivered_files import make_las


def test_the_examples_are_true() -> None:
    options = doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL
    tried = doctest.testmod(zuka, optionflags=options)
    assert (tried.failed, tried.attempted) == (0, 4)


def test_every_tool_and_operation_has_its_name() -> None:
    assert zuka.tools() == tuple(every_tool())
    assert zuka.operations() == tuple(OPERATIONS)


def test_a_script_does_a_job_from_files_to_files(tmp_path: Path) -> None:
    make_las(tmp_path / "cloud.las")
    project = tmp_path / "street.zuka"
    imported = zuka.import_files(project, str(tmp_path / "cloud.las"))
    assert [drive.count for drive in imported.drives] == [500]
    written = zuka.run("noise", project, output=tmp_path / "noise.las", radius_m=0.3)
    assert written.paths == (tmp_path / "noise.las",)
    assert zuka.export(project, tmp_path / "papers", "las", candidates=True).paths
    outcome = zuka.do("run", tool="noise", inputs={"project": str(project)})
    assert getattr(outcome, "stored", None)
