"""Which key does what: by default, by choice, and when two want the same."""

from __future__ import annotations

import pytest

from app.keys.shortcuts import FIXED, Shortcuts

KEYS = Shortcuts(
    {
        "open": ("Ctrl+O",),
        "export": ("Ctrl+E",),
        "redo": ("Ctrl+Y", "Ctrl+Shift+Z"),
        "curb": (),
        "everything": ("Home",),
    }
)


def test_an_action_has_its_own_keys_until_another_is_chosen() -> None:
    assert KEYS.keys_of("redo") == ("Ctrl+Y", "Ctrl+Shift+Z")
    changed = KEYS.with_key("redo", "Ctrl+K")
    assert changed.keys_of("redo") == ("Ctrl+K",)
    assert changed.is_changed("redo")
    assert not KEYS.is_changed("redo")


def test_a_key_that_is_in_use_names_who_would_lose_it() -> None:
    conflict = KEYS.conflict("curb", "Ctrl+E")
    assert conflict is not None
    assert conflict.owner == "export"
    assert KEYS.conflict("export", "Ctrl+E") is None
    assert KEYS.conflict("curb", "Ctrl+B") is None


def test_who_had_a_key_loses_it_and_gets_it_back_with_the_defaults() -> None:
    given = KEYS.with_key("curb", "Ctrl+E")
    assert given.keys_of("curb") == ("Ctrl+E",)
    assert given.keys_of("export") == ()
    assert given.is_changed("export")
    assert given.with_default("curb").all_keys() == KEYS.all_keys()


def test_one_of_two_keys_may_be_given_away() -> None:
    assert KEYS.with_key("curb", "Ctrl+Y").keys_of("redo") == ("Ctrl+Shift+Z",)


def test_a_chosen_key_that_is_given_away_again_leaves_none_behind() -> None:
    twice = KEYS.with_key("curb", "Ctrl+K").with_key("open", "Ctrl+K")
    assert twice.keys_of("curb") == ()
    assert twice.keys_of("open") == ("Ctrl+K",)


def test_an_action_may_have_no_key() -> None:
    without = KEYS.with_key("open", "")
    assert without.keys_of("open") == ()
    assert without.conflict("curb", "Ctrl+O") is None


def test_choosing_the_default_again_is_no_choice() -> None:
    assert KEYS.with_key("open", "Ctrl+K").with_key("open", "Ctrl+O").chosen == {}


def test_a_default_that_another_was_given_stays_there_when_one_is_reset() -> None:
    given = KEYS.with_key("export", "Ctrl+K").with_key("curb", "Ctrl+E")
    reset = given.with_default("export")
    assert reset.keys_of("curb") == ("Ctrl+E",)
    assert reset.keys_of("export") == ()
    assert reset.with_defaults().all_keys() == KEYS.all_keys()


@pytest.mark.parametrize("key", [key for fixed in FIXED for key in fixed.keys])
def test_keys_of_the_views_can_not_be_given_away(key: str) -> None:
    conflict = KEYS.conflict("curb", key)
    assert conflict is not None
    assert conflict.owner == ""
    assert conflict.fixed is not None


def test_a_view_key_belongs_to_the_action_that_does_the_same() -> None:
    assert KEYS.conflict("everything", "Home") is None


def test_keys_kept_for_an_action_that_is_gone_take_nothing_away() -> None:
    kept = Shortcuts(KEYS.defaults, {"removed-in-this-version": ("Ctrl+O",)})
    assert kept.keys_of("open") == ("Ctrl+O",)
