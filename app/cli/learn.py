"""``zuka learn``: what was painted in a project becomes a model of classes of its own."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_json, print_lines
from app.settings.language import system_language
from processing.operations.learn import LearnOperation, LearntModel, learn_in_project


def command(arguments: argparse.Namespace) -> int:
    """Learn from corrections, and say how much that helps."""
    learnt = learn_in_project(LearnOperation(arguments.project), terminal_monitor())
    if arguments.json:
        print_json(_described(learnt))
    else:
        language = system_language()
        print_lines(*(words.in_language(language) for words in learnt.words))
    return 0


def _described(learnt: LearntModel) -> dict[str, object]:
    facts = learnt.facts
    before, after = facts.gain.mean_f
    return {
        "model": facts.id,
        "points": facts.points,
        "places": facts.gain.places,
        "mean_f_before": before,
        "mean_f_after": after,
        "is_used": facts.gain.helps,
        "classes": {
            str(code): {
                "cells": int(count),
                "f_before": facts.gain.before.against_rest((code,)).f_measure,
                "f_after": facts.gain.after.against_rest((code,)).f_measure,
            }
            for code, count in zip(
                facts.gain.before.codes, facts.gain.before.true_counts.tolist(), strict=True
            )
            if code in facts.gain.classes
        },
    }
