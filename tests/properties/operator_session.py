"""A day of an operator in a real window: actions by chance, and what has to hold after each."""

from __future__ import annotations

import random
import shutil
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from processing.map.catalogue import Geometry
from processing.map.drafting.crossings import crosses_itself
from processing.map.feature import Feature
from processing.project.project import Project
from processing.recording.drive import Drive
from tests.properties.operator_actions import OperatorAction
from tests.properties.operator_input import Operator
from tests.properties.watched import watched
from widgets.mouse_tools.drawing.drawing_tool import LEAST_VERTICES

_BESIDE_M = 0.15
"""A vertex on a fitted edge names the measured point beside it."""


@dataclass
class Session:
    """An operator at work on a copy of a project.

    Attributes
    ----------
    troubles : list of str
        What went wrong unseen; see :func:`tests.properties.watched.watched`.
    done : Counter of str
        How often each action was done.
    """

    operator: Operator
    troubles: list[str]
    done: Counter[str] = field(default_factory=Counter)
    _checked: dict[str, Feature] = field(default_factory=dict)

    @staticmethod
    @contextmanager
    def on(street: Path, home: Path) -> Iterator[Session]:
        """A window on a copy of an imported street; closed and judged at the end."""
        shutil.copytree(street, home / "通り.zuka")
        with watched() as troubles:
            session = Session(Operator(home, home / "通り.zuka"), troubles)
            try:
                yield session
                session.check_all()
                seen = session.stored()
            finally:
                session.operator.close()
            assert not troubles, "\n".join(troubles)
        assert _read(session.operator.project) == seen

    def do(self, action: OperatorAction, choice: random.Random) -> None:
        """Do one thing and look whether all is well."""
        self.done[action.__name__] += 1
        action(self.operator, choice)
        self.operator.settle()
        self.check()

    def stored(self) -> tuple[dict[str, Feature], int]:
        """The features and how many changes are done, as the window has them."""
        project = self.operator.parts.document.project
        assert project is not None
        return {one.id: one for one in self.operator.features()}, project.history.position

    def check(self) -> None:
        """What holds after every action."""
        assert not self.troubles, "\n".join(self.troubles)
        parts, document = self.operator.parts, self.operator.parts.document
        features, _ = self.stored()
        for feature in features.values():
            if self._checked.get(feature.id) is not feature:
                self._check_feature(feature)
        self._checked = features
        assert document.shared.selection.features <= features.keys(), "chosen, but not there"
        history, actions = document.project.history, parts.window.actions_by_id
        if not parts.toolbox.current_tool.is_busy:
            assert document.shared.sketch.drawing is None, f"left by {parts.toolbox.name}"
            assert actions["undo"].isEnabled() == history.can_undo
        assert actions["redo"].isEnabled() == history.can_redo
        assert actions[f"tool-{parts.toolbox.name}"].isChecked()

    def check_all(self) -> None:
        """What takes longer to see: panels, what is on disk, back and forth again."""
        operator = self.operator
        features, _ = seen = self.stored()
        kinds = Counter(feature.kind for feature in features.values())
        assert operator.parts.layers_panel._tally.by_kind == kinds
        table = operator.parts.feature_table
        if table.isVisible():
            assert table._model.rows.total == len(features)
        assert operator.view._positions._features == features
        assert _read(operator.project) == seen
        operator.parts.toolbox.current_tool.put_down()
        self._check_back_and_forth()

    def _check_back_and_forth(self) -> None:
        before, position = self.stored()
        document = self.operator.parts.document
        steps = 0
        # Without its street the operator has nothing to work on.
        while steps < 5 and position - steps > 1 and document.undo():
            steps += 1
        assert self.stored()[1] == position - steps
        for _ in range(steps):
            assert document.redo()
        assert self.stored() == (before, position)

    def _check_feature(self, feature: Feature) -> None:
        document = self.operator.parts.document
        what = f"{feature.kind} {feature.geometry.value} of {len(feature.vertices)}"
        kind = document.catalogue()[feature.kind]
        assert kind.geometry is feature.geometry, what
        assert len(feature.vertices) >= LEAST_VERTICES[feature.geometry], what
        positions = [vertex.xyz for vertex in feature.vertices]
        assert np.isfinite(positions).all(), what
        if feature.geometry is Geometry.AREA:
            assert crosses_itself(positions, is_closed=True) is None, f"{what} crosses itself"
        for drive in document.drives():
            self._check_measured(feature, drive, what)

    @staticmethod
    def _check_measured(feature: Feature, drive: Drive, what: str) -> None:
        """A vertex that names a point is there, or on the edge beside it."""
        own = [
            (one.measured.point, one.xyz)
            for one in feature.vertices
            if one.measured is not None and one.measured.drive == drive.id
        ]
        if own:
            points, positions = zip(*own, strict=True)
            off = np.abs(drive.xyz(np.array(points)) - np.array(positions)).max()
            assert off < _BESIDE_M, f"{what} is {off} m off its points"


def _read(folder: Path) -> tuple[dict[str, Feature], int]:
    """The features and the history's position as another program reads them."""
    with closing(Project.open(folder, writing=False)) as project:
        return {one.id: one for one in project.features.all()}, project.history.position


def check_whole_history(folder: Path) -> int:
    """Undo everything there ever was and do it again; gives the number of steps."""
    with closing(Project.open(folder)) as project:
        last = {one.id: one for one in project.features.all()}, project.history.position
        while project.features.undo():
            pass
        assert len(project.features) == 0
        for _ in range(last[1]):
            assert project.features.redo()
        assert ({one.id: one for one in project.features.all()}, project.history.position) == last
        return last[1]
