"""``zuka batch``: the same operations over many drives, on this machine or on a cluster."""

from __future__ import annotations

import argparse

from app.cli.opened import terminal_monitor
from app.cli.output import print_lines
from app.cli.terminal import BAD_INPUT, DEFECT, DONE, say
from app.settings.language import system_language
from processing.operations.batch.batch import BatchOperation, BatchOutcome, run_batch
from processing.operations.batch.watch import watch


def command(arguments: argparse.Namespace) -> int:
    """Do a job; drives that failed are told at the end by name."""
    operation = BatchOperation(arguments.job, arguments.scheduler, system_language())
    if arguments.watch:
        watch(operation, terminal_monitor(), _tell)
    return report(run_batch(operation, terminal_monitor()))


def _tell(outcome: BatchOutcome) -> None:
    report(outcome)


def report(outcome: BatchOutcome) -> int:
    """Tell what came of a job; gives the exit status."""
    language = system_language()
    print_lines(*(words.in_language(language) for words in outcome.words))
    for error in outcome.errors:
        say(error.line(language))
    if outcome.has_defect:
        return DEFECT
    return BAD_INPUT if outcome.failed else DONE
