"""BuildSteps: which steps of building a drive are done, so that none is done to its own result."""

from __future__ import annotations

from pathlib import Path

from processing.core.errors import report_as_user_error
from processing.project.importing.import_journal import ImportJournal, JournalEntries
from processing.recording.columns.replacing import finish_replacing

CLOCK, SHIFTED, NAMED = "clock", "shifted", "named"


class BuildSteps:
    """The steps of one drive.

    Parameters
    ----------
    number : int
        Of the drive in the import.
    folder : Path
        Of its columns until it is finished.
    """

    def __init__(self, journal: ImportJournal, number: int, folder: Path) -> None:
        self._journal = journal
        self._name = f"drive {number}"
        self.folder = folder

    @property
    def home(self) -> Path:
        """Where finished drives are."""
        return self._journal.folder

    @property
    def is_on_disk(self) -> bool:
        """Whether notes are on the disk, so that what they rest on must be there as well."""
        return self._journal.is_begun

    @property
    def final(self) -> Path | None:
        """The finished drive's folder, if it was finished before."""
        known = self.known(NAMED)
        if known is None:
            return None
        final = self.home / str(known["id"])
        if not final.is_dir():
            with report_as_user_error(final):
                self.folder.rename(final)
        return final

    def known(self, step: str) -> JournalEntries | None:
        """What was noted of a step; None when it was not done."""
        return self._journal.known(f"{self._name} {step}")

    def note(self, step: str, facts: JournalEntries) -> None:
        """Note that a step is done, before anything rests on it.

        Raises
        ------
        NoSpace
        """
        self._journal.note(f"{self._name} {step}", facts, (self.folder,))
        self._journal.settle()

    def note_shifted(self) -> None:
        """Note that the times are on the trajectory's clock."""
        self.note(SHIFTED, {})

    def go_on(self) -> None:
        """Bring the columns into one state after a kill that came while they were replaced.

        Raises
        ------
        NoSpace
        """
        clock = self.known(CLOCK)
        is_shifting = clock is not None and clock["offset_s"] and self.known(SHIFTED) is None
        if is_shifting:
            finish_replacing(self.folder, self.note_shifted)
        else:
            finish_replacing(self.folder)
