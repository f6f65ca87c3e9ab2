"""The checkout's own environment: ``.venv`` with the locked packages and the project."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from collections.abc import Mapping
from pathlib import Path

from installer.steps import InputStamp, fingerprint, run, tell


class Environment:
    """The virtual environment of a checkout.

    Parameters
    ----------
    root : Path
        The checkout.
    variables : Mapping[str, str]
        The process environment that every command gets; pip's configuration comes with it.
    """

    def __init__(self, root: Path, variables: Mapping[str, str]) -> None:
        self.root = root
        self.folder = root / ".venv"
        self.variables = dict(variables)
        self._programs = self.folder / ("Scripts" if sys.platform == "win32" else "bin")

    def program(self, name: str) -> Path:
        """Give the path of a program that is installed in the environment."""
        return self._programs / (f"{name}.exe" if sys.platform == "win32" else name)

    def stamp(self, name: str) -> InputStamp:
        """Give the stamp of a set-up step; it is gone with the environment."""
        return InputStamp(self.folder / f"{name}.stamp")

    def run(self, program: str, *arguments: str | Path) -> None:
        """Run a program of the environment in the checkout; `Stop` when it fails."""
        run([self.program(program), *arguments], folder=self.root, environment=self.variables)

    def prepare(self) -> None:
        """Make the environment and install into it whatever changed since the last time."""
        if not self._works():
            tell("making the environment .venv")
            venv.create(self.folder, clear=True, with_pip=True, symlinks=sys.platform != "win32")
        self._install_lock()
        self._install_project()

    def _works(self) -> bool:
        python, note = self.program("python"), self.folder / "pyvenv.cfg"
        if not python.is_file() or not note.is_file() or was_moved(self.folder, note.read_text()):
            return False
        question = "import sys, pip; print(*sys.version_info[:2])"
        try:
            answer = subprocess.run(
                [str(python), "-c", question], capture_output=True, text=True, check=False
            )
        except OSError:
            return False  # the interpreter it was made with is gone
        return answer.stdout.split() == [str(part) for part in sys.version_info[:2]]

    def _install_lock(self) -> None:
        lock = self.root / "requirements.lock"
        stamp, mark = self.stamp("lock"), fingerprint([lock])
        if stamp.fits(mark):
            return
        stamp.lift()
        tell("installing the locked packages (about 1 GB; some minutes)")
        self._pip("--require-hashes", "-r", lock)
        stamp.set(mark)

    def _install_project(self) -> None:
        stamp = self.stamp("project")
        mark = fingerprint([self.root / "pyproject.toml"], str(self.root))
        if stamp.fits(mark) and self.program("zuka").is_file():
            return
        stamp.lift()
        self._pip("--no-deps", "--no-build-isolation", "-e", self.root)
        stamp.set(mark)

    def _pip(self, *arguments: str | Path) -> None:
        quiet = ("--quiet", "--disable-pip-version-check", "--no-input")
        self.run("python", "-m", "pip", "install", *quiet, *arguments)


def was_moved(folder: Path, note: str) -> bool:
    """Tell from an environment's note (``pyvenv.cfg``) whether it was made in another folder.

    Its programs hold the path of their interpreter, so a moved one must be made anew.
    """
    made = [line for line in note.splitlines() if line.startswith("command = ")]
    position = os.path.normcase(str(folder))
    return any(not os.path.normcase(line.rstrip()).endswith(f" {position}") for line in made)
