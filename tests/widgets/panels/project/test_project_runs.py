"""Runs in the project's tree: what was decided, and what can be done to them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QTreeWidget, QTreeWidgetItem
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.map.change import Change, Replacement
from processing.map.feature import Feature, Status
from processing.recording.drive import Drive
from tests.processing.project.candidates import found_lines
from tests.widgets.builders import OpenMap
from widgets.panels.project.project_runs import RUN
from widgets.panels.project.project_tree import ProjectTree
from widgets.panels.tree_items import children_of


@pytest.fixture
def open_map(left_drive: Drive) -> OpenMap:
    return OpenMap((left_drive,))


@pytest.fixture
def panel(qtbot: QtBot, open_map: OpenMap) -> ProjectTree:
    panel = ProjectTree(open_map, open_map.shared, "en")
    qtbot.addWidget(panel)
    panel.resize(260, 400)
    panel.show()
    return panel


def store(open_map: OpenMap, count: int = 6, *, seed: int = 1) -> tuple[str, tuple[Feature, ...]]:
    found = found_lines(count, seed=seed, drive=open_map.drives()[0].id)
    open_map.all_runs = (*open_map.all_runs, found.run)
    open_map.apply(found.run.summary, found.change)
    return found.run.id, found.change.added


def judge(open_map: OpenMap, feature: Feature, status: Status) -> None:
    after = replace(feature, status=status)
    open_map.apply(Text.same("j"), Change(replaced=(Replacement(feature, after),)))


def items_of(panel: ProjectTree) -> list[QTreeWidgetItem]:
    tree = panel.findChild(QTreeWidget)
    assert tree is not None
    folders = {folder.text(0): folder for folder in children_of(tree)}
    return children_of(folders["Runs"]) if "Runs" in folders else []


def actions_of(panel: ProjectTree, item: QTreeWidgetItem) -> dict[str, QAction]:
    tree = panel.findChild(QTreeWidget)
    assert tree is not None
    for menu in tree.findChildren(QMenu):
        menu.hide()  # the one before
    tree.customContextMenuRequested.emit(tree.visualItemRect(item).center())
    (menu,) = (one for one in tree.findChildren(QMenu) if one.isVisible())
    return {action.text(): action for action in menu.actions() if action.text()}


def test_a_run_is_listed_with_its_date_and_what_was_decided(
    panel: ProjectTree, open_map: OpenMap
) -> None:
    _, features = store(open_map)
    (item,) = items_of(panel)
    assert item.text(0).startswith("finder, ")
    assert "Apr" in item.text(0)
    judge(open_map, features[0], Status.ACCEPTED)
    judge(open_map, features[1], Status.REJECTED)
    (counts,) = children_of(item)
    assert counts.text(0) == "4 left  ✓ 1  ✗ 1"
    assert "4 candidates · 1 accepted · 1 rejected" in item.toolTip(0)
    assert open_map.drives()[0].info.name in item.toolTip(0)
    assert "radius_m: 0.2" in item.toolTip(0)
    assert items_of(panel) == [item]  # the same item, not a new one for each decision


def test_a_run_goes_from_the_list_with_its_last_feature(
    panel: ProjectTree, open_map: OpenMap
) -> None:
    _, features = store(open_map)
    open_map.apply(Text.same("d"), Change(removed=features))
    assert items_of(panel) == []


def test_a_run_can_be_reviewed_while_something_waits(
    qtbot: QtBot, panel: ProjectTree, open_map: OpenMap
) -> None:
    run, features = store(open_map, 1)
    (item,) = items_of(panel)
    with qtbot.waitSignal(panel.review_requested) as asked:
        actions_of(panel, item)["Review this run"].trigger()
    assert asked.args == [run]
    judge(open_map, features[0], Status.ACCEPTED)
    (item,) = items_of(panel)
    actions = actions_of(panel, item)
    assert not actions["Review this run"].isEnabled()
    assert not actions["Delete its undecided candidates"].isEnabled()


def test_only_the_undecided_candidates_of_a_run_are_deleted(
    qtbot: QtBot, panel: ProjectTree, open_map: OpenMap
) -> None:
    _, features = store(open_map)
    store(open_map, seed=2)
    judge(open_map, features[0], Status.ACCEPTED)
    judge(open_map, features[1], Status.REJECTED)
    item, _ = items_of(panel)
    with qtbot.waitSignal(panel.change_requested) as asked:
        actions_of(panel, item)["Delete its undecided candidates"].trigger()
    label, change = asked.args
    assert label.en == "Delete 4 undecided candidates"
    assert change == Change(removed=features[2:])


def test_a_hidden_run_is_struck_out_and_its_features_are_not_shown(
    panel: ProjectTree, open_map: OpenMap
) -> None:
    run, features = store(open_map)
    _, others = store(open_map, seed=2)
    settings = open_map.shared.view_settings
    reported = []
    settings.shown_features_changed.connect(lambda: reported.append(True))
    item, _ = items_of(panel)
    actions_of(panel, item)["Hide its features"].trigger()
    assert settings.hidden_runs == {run}
    assert not settings.shows(features[0])
    assert settings.shows(others[0])
    assert reported == [True]
    assert item.font(0).strikeOut()
    assert item.data(0, RUN) == run
    actions_of(panel, item)["Show its features"].trigger()
    assert settings.shows(features[0])
    assert not item.font(0).strikeOut()
