"""``zuka score`` against what an operator drew: exported from a project, or the project itself."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.cli.terminal import DONE, run_in_terminal
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Provenance, Status, Vertex, new_feature_id
from processing.project.project import Project
from processing.project.store.runs import Run
from processing.scoring.features.mapped_features import MappedFile
from tests.app.score_answers import refused, scored
from tests.processing.project.drawn import sign
from tests.processing.scoring.small_maps import curb_pair, gutter, map_of, moved, street_curbs

CURBS, GUTTER = street_curbs(), gutter()


def drawn(file: MappedFile, tool: str, provenance: Provenance | None = None) -> list[Feature]:
    """As a person draws it: kinds, and no attributes."""
    features = []
    for one in file.features:
        word = one.facts["edge" if tool == "curbs" else "type"]
        features.append(
            Feature(
                new_feature_id(),
                f"curb_{word}" if tool == "curbs" else f"gutter_{word}",
                Geometry(one.shape),
                tuple(Vertex((x, y, z)) for x, y, z in one.xyz.tolist()),
                status=Status.ACCEPTED if provenance is None else Status.CANDIDATE,
                provenance=provenance or Provenance(),
            )
        )
    return features


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Curbs, lids and a sign drawn by hand; a run of each tool that found some of them."""
    folder = tmp_path / "図化.zuka"
    with closing(Project.create(folder, "EPSG:6677")) as made:
        by_hand = [*drawn(CURBS, "curbs"), *drawn(GUTTER, "gutters"), sign("a sign")]
        made.features.apply(Text("Draw", "作図"), Change(added=tuple(by_hand)))
        elsewhere = moved(map_of(curb_pair(0, 6, 9)), north=5.0).features
        found = map_of([*CURBS.features[:-2], *elsewhere])
        for tool, file in (("curbs", found), ("gutters", map_of(GUTTER.features[2:]))):
            now = datetime.now(UTC)
            run = Run(f"run-{tool}", tool, 1, {}, (), now, now, Text.same(tool))
            reported = Provenance(tool, 1, {}, 0.8, run.id)
            change = Change(added=tuple(drawn(file, tool, reported)))
            made.features.apply(run.summary, change, run=run)
        rejected = next(one for one in made.features.all() if one.status is Status.CANDIDATE)
        turned_down = Replacement(rejected, replace(rejected, status=Status.REJECTED))
        made.features.apply(Text("Reject", "棄却"), Change(replaced=(turned_down,)))
    return folder


@pytest.mark.parametrize("form", ["geojson", "gpkg"])
def test_an_exported_map_is_a_truth_without_runs_sections_or_types(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], form: str
) -> None:
    out = tmp_path / "out"
    assert run_in_terminal(["export", str(project), "--format", form, "--out", str(out)]) == DONE
    capsys.readouterr()
    (truth,) = out.glob(f"*.{form}")
    curbs = scored(capsys, "curbs", project, truth)["classes"]
    whole = scored(capsys, "curbs", truth, truth)["classes"]
    assert whole["all"]["f"] == 1.0
    missed = whole["all"]["tp"] - curbs["all"]["tp"]
    assert (missed, curbs["all"]["fp"], curbs["all"]["fn"]) == (missed, 6, missed)
    assert missed > 0
    covers = scored(capsys, "gutters", project, truth)["classes"]
    assert covers["lids"]["fp"] == 0
    assert covers["pieces"]["fn"] == 2
    assert scored(capsys, "gutters", truth, truth)["classes"]["slots"]["f"] == 1.0


def test_a_project_is_both_what_was_found_and_what_was_drawn(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    curbs = scored(capsys, "curbs", project, project)["classes"]
    # What was rejected had been found all the same.
    assert curbs["all"]["fp"] == 6
    assert curbs["all"]["fn"] > 0
    assert "not run in this project" in refused(capsys, "trees", project, project)
