"""Files altered by chance, led by which lines of the readers they reach, at every door.

``python -m tests.reliability.fuzzing FOLDER --inputs 20000``: for each door so many inputs are
made from its small file and from those that reached new lines, which are kept below FOLDER. What
ends otherwise than with a result or with one sentence is kept in ``FOLDER/found`` and printed;
``tests/reliability/found`` holds those of earlier runs, which a test reads again. Atheris leads
where it is installed (Linux); elsewhere inputs are altered blindly.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.reliability.doors import Door

_MOST_BYTES = 6 << 30
_MOST_SECONDS = 20
_LONGEST_INPUT = 1 << 16
_TOLD_EVERY = 100
_WATCHED = [f"processing.{part}" for part in ("formats", "recording", "project", "map", "core")]


class TooSlow(Exception):
    """Reading an input took longer than any small file may."""


class OpenedDoor:
    """Inputs given to one door; what is no result and no sentence is kept.

    Parameters
    ----------
    door : Door
    folder : Path
        Where findings and counts lie.
    work : Path
        An empty folder, in memory where there is one.
    """

    def __init__(self, door: Door, folder: Path, work: Path) -> None:
        self._door = door
        self._found = folder / "found" / door.name
        self._told = folder / "corpus" / f"{door.name}.json"
        self._path = work / door.file
        self._seen: set[str] = set()
        self.counted: Counter[str] = Counter()
        signal.signal(signal.SIGALRM, _too_slow)

    def seed(self) -> bytes:
        """The small good file."""
        self._door.write(self._path)
        return self._path.read_bytes()

    def __call__(self, data: bytes) -> None:
        """Read these bytes as the door's file."""
        from processing.core.errors import UserError

        self._path.write_bytes(data)
        self.counted["tried"] += 1
        signal.setitimer(signal.ITIMER_REAL, _MOST_SECONDS)
        try:
            self._door.read(self._path)
            self.counted["read"] += 1
        except UserError as error:
            self.counted["refused"] += 1
            if "\n" in error.line("en"):
                self._keep(data, error)
        except Exception as error:  # noqa: BLE001 - whatever it is, it is a finding
            self._keep(data, error)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        if self.counted["tried"] % _TOLD_EVERY == 0:
            self.tell()

    def tell(self) -> None:
        """Write down how many inputs were tried: libFuzzer ends the process without a word."""
        self._told.write_text(json.dumps(dict(self.counted)), encoding="utf-8")

    def _keep(self, data: bytes, error: Exception) -> None:
        frames = traceback.extract_tb(error.__traceback__)
        ours = [one for one in frames if "processing" in one.filename] or list(frames)
        name = f"{type(error).__name__} {Path(ours[-1].filename).name}:{ours[-1].lineno}"
        self.counted["wrong"] += 1
        if name in self._seen:
            return
        self._seen.add(name)
        self._found.mkdir(parents=True, exist_ok=True)
        (self._found / hashlib.sha256(data).hexdigest()[:12]).write_bytes(data)
        sys.stdout.write(f"  {self._door.name}: {name}: {str(error)[:200]}\n")
        sys.stdout.flush()


def _too_slow(_signal: int, _frame: FrameType | None) -> None:
    raise TooSlow("reading it did not end")


def altered(data: bytes, chance: random.Random) -> bytes:
    """The same bytes with some others written, put in, taken out or doubled."""
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4, 16))):
        place = chance.randrange(len(changed) + 1)
        end = min(len(changed), place + chance.choice((1, 2, 4, 8, 64)))
        written = chance.choice((b"\0", b"\xff", b"-", b"9", b"\n", chance.randbytes(1)))
        ways = (
            written * (end - place),
            b"",
            changed[place:end] * 2,
            chance.randbytes(end - place),
            written,
        )
        changed[place:end] = chance.choice(ways)
    return bytes(changed)


def _fuzz(opened: OpenedDoor, corpus: Path, inputs: int, seed: int) -> None:
    """Give a door its inputs; with atheris this does not return."""
    start = opened.seed()
    if "atheris" not in sys.modules:
        chance = random.Random(seed)  # noqa: S311 - chance, no secret
        for _ in range(inputs):
            opened(altered(start, chance))
        opened.tell()
        return
    import atheris

    corpus.mkdir(parents=True, exist_ok=True)
    (corpus / "good").write_bytes(start)
    words = [
        sys.argv[0],
        f"-runs={inputs}",
        f"-seed={seed}",
        f"-max_len={max(_LONGEST_INPUT, 2 * len(start))}",
        "-rss_limit_mb=0",
        f"-artifact_prefix={corpus.parent}/",
        "-verbosity=0",
        str(corpus),
    ]
    atheris.Setup(words, opened)
    atheris.Fuzz()


def _in_child(door: Door, folder: Path, inputs: int, seed: int) -> str:
    """Try a door in a child process, whose modules are loaded; gives how it ended."""
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=_memory()) as work:
        child = os.fork()
        if child == 0:
            status = 99
            try:
                resource.setrlimit(resource.RLIMIT_AS, (_MOST_BYTES, _MOST_BYTES))
                sys.stdout.flush()
                opened = OpenedDoor(door, folder, Path(work))
                _fuzz(opened, folder / "corpus" / door.name, inputs, seed)
                status = 0
            finally:
                os._exit(status)
        ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return "" if ended == 0 else f"ended {ended}"


def _memory() -> str | None:
    return "/dev/shm" if Path("/dev/shm").is_dir() else None  # noqa: S108 - files of an input each


def main() -> int:
    """Try every door; the exit status says whether all went well."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("folder", type=Path)
    wanted.add_argument("--inputs", type=int, default=1000, help="for each door")
    wanted.add_argument("--seed", type=int, default=1)
    wanted.add_argument("--only", default="", help="doors whose name holds this")
    wanted.add_argument("--blind", action="store_true", help="without looking at coverage")
    options = wanted.parse_args()
    watching: AbstractContextManager[object] = nullcontext()
    if find_spec("atheris") and not options.blind:
        import atheris

        watching = atheris.instrument_imports(include=_WATCHED)
    with watching:
        from tests.broken_files.full_project import make_full_project
        from tests.reliability.doors import delivered_doors, project_doors
    whole = options.folder / "whole"
    (options.folder / "corpus").mkdir(parents=True, exist_ok=True)
    if not whole.is_dir():
        whole.mkdir()
        make_full_project(whole)
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=_memory()) as copies:
        doors = {**delivered_doors(), **project_doors(whole / "街路.zuka", Path(copies))}
        return _try_all(doors, options)


def _try_all(doors: Mapping[str, Door], options: argparse.Namespace) -> int:
    """Try each door that was asked for; the exit status."""
    wrong = 0
    total: Counter[str] = Counter()
    for name, door in doors.items():
        if options.only not in name:
            continue
        started = time.monotonic()
        ended = _in_child(door, options.folder, options.inputs, options.seed)
        told = options.folder / "corpus" / f"{name}.json"
        counts = Counter(json.loads(told.read_text(encoding="utf-8")) if told.is_file() else {})
        total += counts
        wrong += bool(ended or counts["wrong"])
        seconds = time.monotonic() - started
        sys.stdout.write(f"{name}: {dict(counts)} {ended} {seconds:.0f} s\n")
        sys.stdout.flush()
    sys.stdout.write(f"{dict(total)}\n")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
