"""Runs of one tool held against each other: what both found, what one alone, and one be kept."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from processing.map.change import Change
from processing.map.feature import Feature, Status
from processing.operations.runs.repeated_runs import are_known
from processing.project.evaluation.run_evaluation import was_corrected
from processing.project.project import Project
from processing.project.store.runs import Run


@dataclass(frozen=True)
class ComparedRun:
    """One of two runs, with what it found.

    Attributes
    ----------
    candidates : tuple of Feature
        As the tool gave them.
    in_both : tuple of bool
        For each of them whether the other run found it too.
    """

    run: Run
    candidates: tuple[Feature, ...]
    in_both: tuple[bool, ...]


def runs_to_compare(project: Project, run: str) -> tuple[Run, ...]:
    """Runs of the same tool over drives of a run, itself among them, the newest first.

    Those whose candidates the project no longer knows are left out.

    Raises
    ------
    BadFile
        The project's history is damaged.
    """
    every = {one.id: one for one in project.runs.all()}
    asked = every.get(run)
    if asked is None:
        return ()
    alike = (
        one
        for one in reversed(every.values())
        if one.tool == asked.tool and set(one.drives) & set(asked.drives)
    )
    return tuple(one for one in alike if project.history.additions_of(one.id))


def compare_runs(project: Project, first: Run, second: Run) -> tuple[ComparedRun, ComparedRun]:
    """What two runs found, as they gave it, whatever became of it since.

    Raises
    ------
    BadFile
        The project's history is damaged.
    """
    found = [project.history.additions_of(run.id) for run in (first, second)]
    known = are_known(found[0], found[1]), are_known(found[1], found[0])
    return (
        ComparedRun(first, found[0], tuple(known[0])),
        ComparedRun(second, found[1], tuple(known[1])),
    )


def keep_run(project: Project, run: Run) -> Change:
    """The step after which the candidates of a run wait, and undecided ones of the others don't.

    What was accepted, rejected or corrected stays, and nothing is proposed at its place.

    Raises
    ------
    BadFile
        The project's history is damaged.
    """
    others = {one.id for one in runs_to_compare(project, run.id)} - {run.id}
    on_map = [one for one in project.features.all() if one.provenance.run in {run.id, *others}]
    originals = _originals(project, (run.id, *others))
    untouched = {
        one.id
        for one in on_map
        if one.status is Status.CANDIDATE and not was_corrected(one, originals.get(one.id))
    }
    decided = [one for one in on_map if one.id not in untouched]
    decided += [originals[one.id] for one in decided if one.id in originals]
    there = {one.id for one in on_map}
    coming = [one for one in project.history.additions_of(run.id) if one.id not in there]
    known = are_known(coming, decided)
    return Change(
        added=tuple(one for one, is_known in zip(coming, known, strict=True) if not is_known),
        removed=tuple(
            one for one in on_map if one.id in untouched and one.provenance.run in others
        ),
    )


def _originals(project: Project, runs: Iterable[str]) -> dict[str, Feature]:
    return {one.id: one for run in runs for one in project.history.additions_of(run)}
