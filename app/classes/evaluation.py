"""Evaluation: how good the runs of the open project were."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from app.document.document import Document
from processing.core.errors import UserError
from processing.map.feature import Feature, Status
from processing.operations.runs.repeated_runs import runs_before
from processing.project.evaluation.mapped_map import mapped_of
from processing.project.evaluation.run_evaluation import RunEvaluation, evaluate_runs, within_drives
from processing.scoring.features.file_scores import FeatureScorer, FileScore
from processing.scoring.features.mapped_features import MappedFile
from processing.tools.listed.registry import scorers


class Evaluation:
    """Compares what runs gave with what became of it.

    What a run gave never changes, so it is read from the history once.

    Parameters
    ----------
    document : Document
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._originals: dict[str, dict[str, Feature]] = {}
        document.closed.connect(self._originals.clear)

    def evaluations(self) -> tuple[RunEvaluation, ...]:
        """All tools and runs as they are judged now; none when nothing is open."""
        project = self._document.project
        if project is None:
            return ()
        runs = self._document.runs()
        try:
            for run in runs:
                if run.id not in self._originals:
                    added = project.history.additions_of(run.id)
                    self._originals[run.id] = {feature.id: feature for feature in added}
        except UserError as error:
            self._document.refused.emit(error)
        originals = {id_: one for known in self._originals.values() for id_, one in known.items()}
        return evaluate_runs(self._document.features(), runs, project.drives, originals)

    def score_maps(self, take: Callable[[Mapping[str, FileScore]], None]) -> None:
        """Hold what each run found against what a person drew or accepted, beside the window.

        Parameters
        ----------
        take : callable
            Gets the scores by the runs' ids, on the window's thread; those alone for which there
            are a scorer and something that a person agreed to. A run isn't asked for what was
            accepted of earlier runs of its tool, since it doesn't propose that again.
        """
        project = self._document.project
        if project is None:
            return
        agreed = [one for one in self._document.features() if one.status is Status.ACCEPTED]
        asked: list[tuple[str, FeatureScorer, MappedFile, MappedFile]] = []
        runs, known_scorers = self._document.runs(), scorers()
        for run in runs:
            scorer = known_scorers.get(run.tool)
            found = self._originals.get(run.id, {}).values()
            before = {one.id for one in runs_before(run, runs)}
            asked_of = [one for one in agreed if one.provenance.run not in before]
            true = within_drives(asked_of, run, project.drives)
            kinds = {one.kind for one in found}
            if isinstance(scorer, FeatureScorer) and kinds & {one.kind for one in true}:
                result = mapped_of(found, project.folder, project.crs)
                truth = mapped_of(true, project.folder, project.crs)
                asked.append((run.id, scorer, result, truth))

        def work() -> dict[str, FileScore]:
            return {
                one[0]: score for one in asked if (score := _score_features(*one[1:])) is not None
            }

        if asked:
            self._document.run_in_background(work, lambda scores: take(_as_scores(scores)))


def _score_features(scorer: FeatureScorer, found: MappedFile, true: MappedFile) -> FileScore | None:
    """None where the map holds what can't be compared: areas drawn as lines."""
    try:
        return scorer.score(found, true)
    except UserError:
        return None


def _as_scores(scores: object) -> Mapping[str, FileScore]:
    return scores if isinstance(scores, dict) else {}
