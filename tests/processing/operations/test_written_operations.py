"""Operations are written as TOML or JSON and read back as they were; what is wrong is refused."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import BadFile, MissingInput, OutOfRange
from processing.core.parameters import Parameter, ParameterValue, parameters_of
from processing.formats.registry import FORMATS
from processing.laboratory.every_operation import EVERY_OPERATION
from processing.laboratory.simulate.simulate_operation import SimulateOperation
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.operations.export import ExportRequest
from processing.operations.import_files import ImportOperation
from processing.operations.inputs import OperationInputs
from processing.operations.map_steps import (
    NumberOperation,
    TakeMapOperation,
    UndoOperation,
    WidthOperation,
)
from processing.operations.operation_files import (
    operation_from_text,
    operation_text,
    read_operation,
    write_operation,
)
from processing.operations.project_export import ExportOperation
from processing.operations.run import RunOperation
from processing.operations.score import ScoreOperation
from processing.operations.volume import VolumeOperation
from processing.operations.volume_sides import VolumeSide
from processing.project.importing.import_request import ImportRequest
from processing.tools.listed.registry import TOOLS

NOISE_TOML = """\
kind = "run"
tool = "noise"
output = "静か.laz"

[inputs]
points = ["左.laz", "右.laz"]
crs = "EPSG:6677"

[parameters]
method = "radius"
radius_m = 0.4
"""
NOISE = RunOperation(
    "noise",
    OperationInputs(points=(Path("左.laz"), Path("右.laz")), crs="EPSG:6677"),
    {"method": "radius", "radius_m": 0.4},
    Path("静か.laz"),
)

# Names as disks have them: whatever is a character, but for the end of a string of C.
names = st.text(st.characters(exclude_categories=("Cs",), exclude_characters="\0"), min_size=1)
paths = names.map(Path)
many_paths = st.lists(paths, max_size=3).map(tuple)
words = st.lists(names, max_size=3).map(tuple)


def values(parameter: Parameter) -> st.SearchStrategy[ParameterValue]:
    """What a parameter may be."""
    if parameter.kind == "number":
        return st.floats(parameter.low, parameter.high)
    if parameter.kind == "count":
        return st.integers(int(parameter.low), int(parameter.high))
    if parameter.kind == "choice":
        return st.sampled_from([one.value for one in parameter.choices])
    return st.booleans() if parameter.kind == "switch" else st.just("名前")


def some_of(parameters: type[object]) -> st.SearchStrategy[Mapping[str, ParameterValue]]:
    """Some parameters of a class, with values that they may have."""
    optional = {one.id: values(one) for one in parameters_of(parameters)}
    return st.fixed_dictionaries({}, optional=optional)


runs = st.sampled_from(sorted(TOOLS)).flatmap(
    lambda tool: st.builds(
        RunOperation,
        st.just(tool),
        st.builds(OperationInputs, project=paths, drives=words),
        some_of(TOOLS[tool].parameters),
        accept_above=st.floats(0, 1) if TOOLS[tool].gives_candidates else st.none(),
    )
)
imports = st.builds(
    ImportOperation,
    paths,
    st.builds(
        ImportRequest,
        many_paths,
        many_paths,
        many_paths,
        names,
        st.sampled_from(["label", "classification"]),
        words,
    ),
    words,
)
exports = st.builds(
    ExportOperation,
    paths,
    st.builds(
        ExportRequest,
        st.lists(st.sampled_from([one.id for one in FORMATS.maps()]), min_size=1).map(tuple),
        paths,
        st.sampled_from(["en", "ja"]),
        candidates=st.booleans(),
        options=st.fixed_dictionaries({"digits": st.integers(0, 9)}),
    ),
)
scores = st.builds(ScoreOperation, st.sampled_from(["noise", "curbs", "volume"]), paths, paths)
simulations = st.builds(
    SimulateOperation,
    st.just("site"),
    paths,
    some_of(EVERY_OPERATION["simulate"].type("site", Path()).parameter_class),
)
sides = st.one_of(
    st.builds(VolumeSide, paths, names, words),
    st.floats(allow_nan=False, allow_infinity=False).map(lambda level: VolumeSide(level_m=level)),
)
volumes = st.builds(
    VolumeOperation,
    sides,
    sides,
    st.just(Path("土量.json")),
    some_of(VolumeParameters),
    names,
    words,
    st.sampled_from(["en", "ja"]),
)
undos = st.builds(UndoOperation, paths)
numberings = st.builds(NumberOperation, paths)
widths = st.builds(WidthOperation, paths, st.floats(1, 1000))
takings = st.builds(TakeMapOperation, paths, paths)
operations = st.one_of(
    runs, imports, exports, scores, volumes, simulations, undos, numberings, widths, takings
)


@given(operations, st.booleans())
def test_an_operation_is_read_back_as_it_was_written(operation: object, is_json: bool) -> None:
    text = operation_text(operation, EVERY_OPERATION, is_json=is_json)
    read = operation_from_text(text, EVERY_OPERATION)
    assert read == operation
    assert type(read) is type(operation)


def test_a_file_says_what_a_person_would_write() -> None:
    assert operation_text(NOISE) == NOISE_TOML
    assert operation_from_text(NOISE_TOML) == NOISE


def test_words_of_the_command_line_are_values_too() -> None:
    text = NOISE_TOML.replace("radius_m = 0.4", 'radius_m = "0.4"')
    read = operation_from_text(text)
    assert isinstance(read, RunOperation)
    assert read.parameters["radius_m"] == "0.4"


def test_paths_of_a_file_count_from_its_folder(tmp_path: Path) -> None:
    path = tmp_path / "静か.toml"
    path.write_text(NOISE_TOML, "utf-8")
    read = read_operation(path)
    assert isinstance(read, RunOperation)
    assert read.inputs.points == (tmp_path / "左.laz", tmp_path / "右.laz")
    assert read.output == tmp_path / "静か.laz"


def test_files_that_parameters_name_count_from_the_folder_too(tmp_path: Path) -> None:
    path = tmp_path / "ground.json"
    path.write_text(
        '{"kind": "run", "tool": "ground", "inputs": {"project": "a.zuka"},'
        ' "parameters": {"surface": "ground.tif"}}',
        "utf-8",
    )
    read = read_operation(path)
    assert isinstance(read, RunOperation)
    assert read.parameters["surface"] == str(tmp_path / "ground.tif")


def test_a_written_file_has_whole_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for ending in (".toml", ".json"):
        path = tmp_path / "elsewhere" / f"a{ending}"
        write_operation(path, NOISE)
        read = read_operation(path)
        assert isinstance(read, RunOperation)
        assert read.output == tmp_path / "静か.laz"


@pytest.mark.parametrize(
    ("wrong", "error", "named"),
    [
        ("kind = run", BadFile, "operation"),
        ("{", BadFile, "operation"),
        ('kind = "dance"', OutOfRange, "dance"),
        (NOISE_TOML.replace("noise", "nois"), OutOfRange, "nois"),
        (NOISE_TOML.replace("0.4", "-1"), OutOfRange, "radius_m"),
        (NOISE_TOML.replace("radius_m", "radius"), OutOfRange, "radius"),
        (NOISE_TOML.replace("crs", "csr"), OutOfRange, "inputs.csr"),
        (NOISE_TOML.replace('"EPSG:6677"', "6677"), OutOfRange, "inputs.crs"),
        (NOISE_TOML.replace(".laz", ".geojson"), OutOfRange, "静か.geojson"),
        (NOISE_TOML.replace('output = "静か.laz"', ""), MissingInput, "左.laz"),
        (NOISE_TOML.replace('tool = "noise"', ""), OutOfRange, "tool"),
        (NOISE_TOML.replace("[parameters]", "[[parameters]]"), OutOfRange, "parameters"),
        ('kind = "run"\ntool = "noise"\n[inputs]', MissingInput, "noise"),
        ('kind = "score"\ntool = "dance"\nresult = "a"\ntruth = "b"', OutOfRange, "dance"),
    ],
)
def test_what_is_wrong_is_named(wrong: str, error: type[Exception], named: str) -> None:
    with pytest.raises(error) as refused:
        operation_from_text(wrong)
    assert named in str(refused.value)


def test_only_candidates_that_a_project_stores_are_accepted_at_once() -> None:
    inputs = OperationInputs(project=Path("a.zuka"))
    for operation in (
        RunOperation("noise", inputs, accept_above=0.5),
        RunOperation("curbs", inputs, output=Path("a.geojson"), accept_above=0.5),
        RunOperation("curbs", inputs, accept_above=1.5),
    ):
        with pytest.raises(OutOfRange):
            operation.check()
    RunOperation("curbs", inputs, accept_above=1.0).check()
