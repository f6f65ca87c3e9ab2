"""An operator who does anything that is valid, in any order: nothing breaks, nothing is lost.

``python -m tests.properties.long_session`` does thousands of such actions; here are a few hundred,
the same ones each time.
"""

from __future__ import annotations

import random
from contextlib import ExitStack
from pathlib import Path

from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule, run_state_machine_as_test
from typing_extensions import override

from tests.properties.operator_actions import EDITING, LOOKING, OFTEN, SELDOM, OperatorAction
from tests.properties.operator_session import Session, check_whole_history

CHANCE = st.randoms(use_true_random=False)

# Making a failing session shorter would take longer than the session: the long one tells the
# number of the action that failed.
BRIEF = settings(
    max_examples=3,
    stateful_step_count=60,
    deadline=None,
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)


def days_of_an_operator(street: Path, home: Path) -> type[RuleBasedStateMachine]:
    """A machine that opens a window on a copy of a street for each session."""
    numbers = iter(range(10**6))

    class OperatorDay(RuleBasedStateMachine):
        def __init__(self) -> None:
            super().__init__()
            self._open = ExitStack()
            self._home = home / str(next(numbers))
            self._session = self._open.enter_context(Session.on(street, self._home))

        @rule(action=st.sampled_from(OFTEN), choice=CHANCE)
        def draw(self, action: OperatorAction, choice: random.Random) -> None:
            self._session.do(action, choice)

        @rule(action=st.sampled_from(EDITING), choice=CHANCE)
        def edit(self, action: OperatorAction, choice: random.Random) -> None:
            self._session.do(action, choice)

        @rule(action=st.sampled_from(LOOKING), choice=CHANCE)
        def look(self, action: OperatorAction, choice: random.Random) -> None:
            self._session.do(action, choice)

        @rule(action=st.sampled_from(SELDOM), choice=CHANCE)
        def do_something_rare(self, action: OperatorAction, choice: random.Random) -> None:
            self._session.do(action, choice)

        @override
        def teardown(self) -> None:
            self._open.close()
            check_whole_history(self._session.operator.project)

    return OperatorDay


def test_hundreds_of_actions_in_any_order_break_nothing_and_lose_nothing(
    sample_project: Path, tmp_path: Path
) -> None:
    run_state_machine_as_test(days_of_an_operator(sample_project, tmp_path), settings=BRIEF)
