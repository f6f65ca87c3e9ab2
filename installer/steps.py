"""What every step of the set-up shares: a told command, a stop with one line, a stamp."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path


class Stop(Exception):
    """The set-up cannot go on.

    Parameters
    ----------
    reason : str
        One line: what is missing and what to do.
    status : int
        The exit status: 2 for what the user can mend, a failed command's own status else.
    """

    def __init__(self, reason: str, status: int = 2) -> None:
        self.status = status
        super().__init__(reason)


def tell(words: str) -> None:
    """Say on stderr what is being done."""
    sys.stderr.write(f"zuka: {words}\n")
    sys.stderr.flush()


def run(command: Sequence[str | Path], *, folder: Path, environment: Mapping[str, str]) -> None:
    """Run a command to its end.

    Raises
    ------
    Stop
        When it fails, with its status.
    """
    status = status_of(command, folder=folder, environment=environment)
    if status != 0:
        words = " ".join(Path(word).name for word in command[:4])
        raise Stop(f"{words} … failed with status {status}; what it said stands above", status)


def status_of(
    command: Sequence[str | Path], *, folder: Path, environment: Mapping[str, str]
) -> int:
    """Give a command's exit status; a signal counts as 128 and its number, as in a shell."""
    words = [str(word) for word in command]
    status = subprocess.run(words, cwd=folder, env=dict(environment), check=False).returncode
    return status if status >= 0 else 128 - status


def fingerprint(files: Iterable[Path], *more: str) -> str:
    """Give the SHA-256 of some files' names and contents, and of some words."""
    digest = hashlib.sha256()
    for path in sorted(files):
        content = path.read_bytes()
        digest.update(f"{path.as_posix()} {len(content)}\n".encode())
        digest.update(content)
    for word in more:
        digest.update(f"\n{word}".encode())
    return digest.hexdigest()


class InputStamp:
    """Remembers for what inputs a step was done, so that it is done again only for others."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def fits(self, mark: str) -> bool:
        """Tell whether the step was finished with just these inputs."""
        return self._path.is_file() and self._path.read_text(encoding="ascii") == mark

    def lift(self) -> None:
        """Forget the last time: called before the step begins."""
        self._path.unlink(missing_ok=True)

    def set(self, mark: str) -> None:
        """Note that the step is finished for these inputs."""
        self._path.write_text(mark, encoding="ascii")
