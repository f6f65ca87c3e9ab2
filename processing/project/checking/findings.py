"""What a check of a project says: a file, what is wrong with it, and the remedy."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from processing.core.errors import UserError
from processing.core.text import Text


class FindingState(Enum):
    """What became of a damaged file."""

    DAMAGED = "damaged"
    """It is as it was found."""
    REPAIRED = "repaired"
    """It is what it was when it was written, or will be made again when it is needed."""
    NOTED = "noted"
    """Nothing is wrong with it, as far as anybody can tell."""


@dataclass(frozen=True)
class FileFinding:
    """One file of a project.

    Attributes
    ----------
    file : str
        Its name in the project's folder.
    what, remedy : Text
        What is wrong; what to do about it, or what was done.
    """

    file: str
    what: Text
    remedy: Text
    state: FindingState = FindingState.DAMAGED

    @property
    def words(self) -> Text:
        """File, fault and remedy on a line."""
        return Text("{file} | {what} | {remedy}", "{file} | {what} | {remedy}").filled(
            file=self.file, what=self.what, remedy=self.remedy
        )


@dataclass(frozen=True)
class CheckReport:
    """What a check found.

    Attributes
    ----------
    findings : tuple of FileFinding
    files : int
        Files that were checked.
    """

    findings: tuple[FileFinding, ...]
    files: int

    @property
    def damaged(self) -> tuple[FileFinding, ...]:
        """What is still damaged."""
        return tuple(one for one in self.findings if one.state is FindingState.DAMAGED)

    @property
    def repaired(self) -> tuple[FileFinding, ...]:
        """What was damaged."""
        return tuple(one for one in self.findings if one.state is FindingState.REPAIRED)


def finding_of(file: str, error: UserError) -> FileFinding:
    """What somebody who uses a file would be told."""
    return FileFinding(file, error.what, error.remedy)
