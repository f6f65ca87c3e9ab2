"""A disk that fills at every page of what an operation writes, one after the other.

``python -m tests.reliability.full_disk FOLDER``: each operation is done on a copy of a project on
a disk in memory, which has room for one page more each time, until it is through. Every time it
must end with one sentence or with its work; the project opens and holds the map it had before or
the one the operation makes; with room, the operation is then done as if nothing had been. The
disk is a tmpfs of a namespace of its own (Linux), for which ``unshare`` needs no rights of an
administrator.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

from tests.broken_files.full_project import make_full_project
from tests.reliability.forked import answer_of_child, silence
from tests.reliability.operations import LATER, OPERATIONS, Answer, answer_to, do
from tests.reliability.project_state import State, state_of

PAGE_BYTES = 4096
_NAMESPACE = ("unshare", "--user", "--map-root-user", "--mount")
_PLENTY_BYTES = 1 << 30


def can_make_disks() -> bool:
    """Tell whether this machine lets a user mount a disk in memory."""
    if shutil.which("unshare") is None:
        return False
    tried = subprocess.run([*_NAMESPACE, "mount", "-t", "tmpfs", "none", "/mnt"], check=False,
                           capture_output=True)  # fmt: skip
    return tried.returncode == 0


class Disk:
    """A disk in memory of a size that can be changed.

    Parameters
    ----------
    folder : Path
        Where it is mounted.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        _mount("-t", "tmpfs", "-o", f"size={_PLENTY_BYTES}", "none", str(folder))

    @property
    def used_bytes(self) -> int:
        """What its files take."""
        room = os.statvfs(self.folder)
        return (room.f_blocks - room.f_bfree) * room.f_frsize

    def leave(self, free_bytes: int) -> None:
        """Leave this much room beside what is there."""
        _mount("-o", f"remount,size={self.used_bytes + free_bytes}", str(self.folder))

    def clear(self) -> None:
        """Remove everything, and give it room."""
        _mount("-o", f"remount,size={_PLENTY_BYTES}", str(self.folder))
        for one in self.folder.iterdir():
            shutil.rmtree(one)


def _mount(*words: str) -> None:
    subprocess.run(["mount", *words], check=True)


class Filling:
    """One operation, done again and again on a disk with ever more room.

    Parameters
    ----------
    whole : Path
        The project that is copied, with the delivered files beside it.
    disk : Disk
        Where it is done.
    operation : str
        One of :data:`OPERATIONS`.
    """

    def __init__(self, whole: Path, disk: Disk, operation: str) -> None:
        self._whole = whole
        self._disk = disk
        self._operation = operation
        self._project = disk.folder / "街路.zuka"
        self._out = disk.folder / "out"
        self._before: State = {}
        self._after: State = {}

    def measure(self) -> int:
        """Do it with room for all; gives how many bytes the disk must have for it, at most."""
        # Once in this process, so that those that are forked find its kernels and modules.
        self._fresh()
        with silence():
            self._do()
            answer_to(["check", str(self._project)])
        self._fresh()
        self._before = state_of(self._project)
        start = self._disk.used_bytes
        self._disk.leave(_PLENTY_BYTES)
        done = answer_of_child(self._do)
        if done is None or done.status != 0:
            raise AssertionError(f"{self._operation} does not work: {done}")
        self._after = state_of(self._project)
        return self._disk.used_bytes - start

    def wrong_at(self, free_bytes: int) -> tuple[bool, list[str]]:
        """Do it with so much room; gives whether it was through, and what was wrong."""
        self._fresh()
        self._disk.leave(free_bytes)
        done = answer_of_child(self._do)
        wrong = []
        if done is None:
            wrong.append("did not end by itself")
        elif not done.is_right:
            wrong.append(f"{done.status}: {done.line[:300]}")
        through = done is not None and done.status == 0
        seen = state_of(self._project)  # with no room left
        if seen not in (self._before, self._after):
            wrong.append("holds what nobody made")
        self._disk.leave(_PLENTY_BYTES)
        if not through:
            again = answer_of_child(self._do)
            if again is None or again.status != 0:
                wrong.append(f"with room: {again}")
        if state_of(self._project) != self._after and not wrong:
            wrong.append("with room other than without a full disk")
        checked = answer_of_child(lambda: answer_to(["check", str(self._project)]))
        if checked is None or checked.status != 0:
            wrong.append(f"check: {checked}")
        return through, wrong

    def _do(self) -> Answer:
        return do(self._operation, self._project, self._whole.parent, self._out)

    def _fresh(self) -> None:
        self._disk.clear()
        shutil.copytree(self._whole, self._project)


def fill_at_every_page(filling: Filling, most_tries: int) -> Counter[str]:
    """Do an operation with ever more room; prints what was wrong, and gives the counts."""
    needed = filling.measure()
    step = max(1, needed // (PAGE_BYTES * most_tries)) * PAGE_BYTES
    counted: Counter[str] = Counter()
    free = 0
    while True:
        through, wrong = filling.wrong_at(free)
        counted["tried"] += 1
        counted["through"] += through
        if wrong:
            counted["wrong"] += 1
            for line in wrong:
                sys.stdout.write(f"  {free} bytes: {line}\n")
                sys.stdout.flush()
        if through and free >= needed:
            return counted
        free += step


def main() -> int:
    """Try every operation; the exit status says whether all went well."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("folder", type=Path)
    wanted.add_argument("--only", default="", help="operations whose name holds this")
    wanted.add_argument("--tries", type=int, default=1 << 20, help="about so many an operation")
    options = wanted.parse_args()
    os.environ["ZUKA_LANGUAGE"] = "en"
    whole = options.folder / "街路.zuka"
    if not whole.is_dir():
        options.folder.mkdir(parents=True, exist_ok=True)
        make_full_project(options.folder)
    if not (whole.parent / LATER).is_file():
        raise SystemExit(f"{LATER} lacks beside the project")
    disk = Disk(options.folder / "disk")
    total: Counter[str] = Counter()
    for operation in OPERATIONS:
        if options.only not in operation:
            continue
        started = time.monotonic()
        counted = fill_at_every_page(Filling(whole, disk, operation), options.tries)
        total += counted
        sys.stdout.write(f"{operation}: {dict(counted)} {time.monotonic() - started:.0f} s\n")
        sys.stdout.flush()
    sys.stdout.write(f"{dict(total)}\n")
    return int(total["wrong"] > 0)


if __name__ == "__main__":
    if "--inside" not in sys.argv:
        words = [sys.executable, "-m", "tests.reliability.full_disk", *sys.argv[1:], "--inside"]
        sys.exit(subprocess.run([*_NAMESPACE, *words], check=False).returncode)
    sys.argv.remove("--inside")
    sys.exit(main())
