"""Undo and redo, for any sequence of changes, in memory, on disk and across a restart."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, PointReference, Status, Vertex
from processing.map.own_points import own_points
from processing.project.project import Project

LABEL = Text("Step", "操作")
NUMBERS = st.floats(-1e7, 1e7)
VERTICES = st.builds(
    Vertex,
    st.tuples(NUMBERS, NUMBERS, NUMBERS),
    st.none() | st.builds(PointReference, st.text(max_size=5), st.integers(0, 2**40)),
)
ATTRIBUTES = st.dictionaries(
    st.text(max_size=5), st.text(max_size=5) | NUMBERS | st.integers(-9, 9) | st.booleans()
)
OWN_POINTS = st.lists(
    st.builds(own_points, st.text(max_size=5), st.lists(st.integers(0, 2**40), min_size=1)),
    max_size=2,
    unique_by=lambda one: one.drive,
).map(tuple)
STEPS = st.lists(
    st.tuples(
        st.sampled_from(["add", "replace", "remove", "undo", "redo", "reopen"]),
        st.lists(VERTICES, min_size=3, max_size=4),
        ATTRIBUTES,
        OWN_POINTS,
    ),
    max_size=12,
)


def _change(request, shape, own, number, features) -> Change:
    vertices, attributes = shape
    if request == "add" or not features:
        geometry = list(Geometry)[number % 3]
        kept = tuple(vertices[:1] if geometry is Geometry.POINT else vertices)
        made = Feature(f"f{number}", "kind", geometry, kept, attributes, own_points=own)
        return Change(added=(made,))
    chosen = features[number % len(features)]
    if request == "remove":
        return Change(removed=(chosen,))
    moved = chosen.with_vertices(tuple(vertices[: len(chosen.vertices)]))
    after = Feature(moved.id, "other", moved.geometry, moved.vertices, attributes, Status.CANDIDATE)
    after = replace(after, own_points=own)
    return Change(replaced=(Replacement(chosen, after),))


@settings(max_examples=40)
@given(STEPS)
def test_undo_and_redo_give_every_state_back_also_across_a_restart(steps):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "街路.zuka"
        project = Project.create(path, "EPSG:6677")
        states, position = [{}], 0
        for number, (request, vertices, attributes, own) in enumerate(steps):
            if request == "reopen":
                project.close()
                project = Project.open(path)
            elif request == "undo":
                assert (project.features.undo() is not None) == (position > 0)
                position = max(0, position - 1)
            elif request == "redo":
                assert (project.features.redo() is not None) == (position + 1 < len(states))
                position = min(len(states) - 1, position + 1)
            else:
                features = tuple(project.features.all())
                change = _change(request, (vertices, attributes), own, number, features)
                project.features.apply(LABEL, change)
                states = [*states[: position + 1], {f.id: f for f in project.features.all()}]
                position += 1
            assert {f.id: f for f in project.features.all()} == states[position]
        project.close()
