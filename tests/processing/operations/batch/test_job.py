"""A job's file says everything that is wrong with it before any drive is opened."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import BadFile, MissingInput, OutOfRange, UserError
from processing.operations.batch.deliveries import deliveries_of, named
from processing.operations.batch.job import (
    StepPlaces,
    job_of_order,
    operation_of_step,
    order_of,
    read_job,
)
from processing.operations.project_export import ExportOperation
from processing.operations.run import RunOperation
from processing.project.importing.import_request import ImportRequest
from tests.processing.operations.batch.job_files import (
    EXPORT,
    HEAD,
    IMPORT,
    NOISE,
    deliver,
    write_job,
)


@pytest.mark.parametrize(
    ("text", "kind", "said"),
    [
        ("deliveries = [", BadFile, "neither TOML nor JSON"),
        (HEAD, BadFile, "no steps"),
        (HEAD + NOISE, OutOfRange, "begins with one import"),
        (HEAD + IMPORT + IMPORT, OutOfRange, "begins with one import"),
        (HEAD + IMPORT + '[[steps]]\nkind = "rum"\n', OutOfRange, "steps[2]"),
        (HEAD + IMPORT + '[[steps]]\nkind = "undo"\n', OutOfRange, "no such step"),
        (HEAD + IMPORT + NOISE.replace("noise", "nose", 1), OutOfRange, "no such tool"),
        (HEAD + IMPORT + NOISE + "parameters.radius = 1\n", OutOfRange, "steps[2]: radius"),
        (HEAD + IMPORT + NOISE + "parameters.radius_m = 99\n", OutOfRange, "steps[2]"),
        (HEAD + IMPORT + NOISE + "colour = 1\n", OutOfRange, "steps[2]: colour"),
        (HEAD + IMPORT + NOISE + 'inputs.project = "x"\n', OutOfRange, "steps[2]: inputs"),
        (HEAD + IMPORT + 'request.inputs = ["x.las"]\n', OutOfRange, "come from the delivery"),
        (HEAD + IMPORT + EXPORT.replace('"las"', '"dwg"'), OutOfRange, "steps[2]"),
        (
            HEAD + IMPORT + EXPORT.split("request.")[0] + 'request = "las"\n',
            OutOfRange,
            "right type",
        ),
        ("worker = 3\n" + HEAD + IMPORT, OutOfRange, "job.toml: worker"),
        (HEAD.replace("= 2", "= 300") + IMPORT, OutOfRange, "so many workers"),
        ("memory_gib = 0.0\n" + HEAD + IMPORT, OutOfRange, "so much memory"),
        ('deliveries = []\noutput = "out"\n' + IMPORT, MissingInput, "no deliveries"),
        ('results = "both"\n' + HEAD + IMPORT, OutOfRange, "results=both"),
    ],
)
def test_what_is_wrong_with_a_job_is_said_with_its_place(
    tmp_path: Path, text: str, kind: type[UserError], said: str
) -> None:
    with pytest.raises(kind) as met:
        read_job(write_job(tmp_path, text))
    assert said in met.value.line("en")
    assert "job.toml" in met.value.line("ja")


def test_a_missing_job_is_named(tmp_path: Path) -> None:
    with pytest.raises(MissingInput, match=r"job\.toml"):
        read_job(tmp_path / "job.toml")


def test_a_pattern_that_matches_nothing_is_named(tmp_path: Path) -> None:
    file = read_job(write_job(tmp_path))
    with pytest.raises(MissingInput, match=r"deliveries, drives/\*"):
        deliveries_of(file)


def test_every_match_is_a_delivery_and_results_are_none(tmp_path: Path) -> None:
    deliver(tmp_path, ["北", "a b"])
    (tmp_path / "out").mkdir()
    file = read_job(write_job(tmp_path, HEAD.replace("drives/*", "*") + IMPORT))
    assert [one.name for one in deliveries_of(file)] == ["drives"]
    file = read_job(write_job(tmp_path, HEAD.replace('*"', '*", "drives/a b"') + IMPORT))
    assert [one.name for one in deliveries_of(file)] == ["a b", "北"]


def test_deliveries_of_one_name_are_told_apart_by_their_paths_alone(tmp_path: Path) -> None:
    paths = [tmp_path / "a" / "x.las", tmp_path / "b" / "x.las", tmp_path / "y.las"]
    names = [one.name for one in named(paths)]
    assert len(set(names)) == 3
    assert names[2] == "y"
    assert [one.name for one in named(paths[1::-1])] == names[1::-1]


def test_outputs_of_a_step_count_from_the_results_and_its_inputs_from_the_job(
    tmp_path: Path,
) -> None:
    text = HEAD + IMPORT + NOISE + EXPORT.replace("true", 'true\nrequest.folder = "papers-{drive}"')
    file = read_job(write_job(tmp_path, text))
    results = tmp_path / "out" / "北"
    places = StepPlaces("北", results, results / "北.zuka", ImportRequest((tmp_path / "x.las",)))
    run, export = (operation_of_step(file, number, places) for number in (1, 2))
    assert isinstance(run, RunOperation)
    assert run.output == results / "noise.las"
    assert run.inputs.project == results / "北.zuka"
    assert isinstance(export, ExportOperation)
    assert export.request.folder == results / "papers-北"


def test_a_job_goes_to_another_process_as_it_is(tmp_path: Path) -> None:
    file = read_job(write_job(tmp_path, HEAD + IMPORT + NOISE + EXPORT))
    assert job_of_order(order_of(file)) == file
