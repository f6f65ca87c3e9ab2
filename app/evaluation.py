"""Evaluation: how good the runs of the open project were."""

from __future__ import annotations

from app.document import Document
from processing.errors import UserError
from processing.project.feature import Feature
from processing.project.run_evaluation import RunEvaluation, evaluate_runs


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
