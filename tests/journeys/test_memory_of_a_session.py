"""What is opened and closed again and again leaves nothing behind in the window."""

from __future__ import annotations

import gc
import random
from pathlib import Path

import pytest
from PySide6.QtCore import QObject

from tests.properties import operator_actions as actions
from tests.properties.operator_session import Session

TIMES = 6
FEW = 25
"""A form or a menu may be there the second time and not the first; a palette has a hundred."""


@pytest.mark.parametrize(
    "action",
    [
        actions.open_palette,
        actions.press_right,
        actions.change_language,
        actions.reopen,
        actions.draw_some,
    ],
)
def test_what_is_done_again_and_again_leaves_no_objects_in_the_window(
    sample_project: Path, tmp_path: Path, action: actions.OperatorAction
) -> None:
    choice = random.Random(1)  # noqa: S311 - chance, no secret
    with Session.on(sample_project, tmp_path / "day") as session:
        window = session.operator.parts.window
        session.do(actions.draw_some, choice)
        session.do(action, choice)
        gc.collect()
        before = len(window.findChildren(QObject))
        for _ in range(TIMES):
            session.do(action, choice)
        gc.collect()
        assert len(window.findChildren(QObject)) < before + FEW
