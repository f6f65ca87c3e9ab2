"""A project altered file by file, and every command on it.

``python -m tests.broken_files.mutated_project FOLDER --mutations 1000 --seed 1``: each
mutation is tried in a process of its own, with bounded memory and time. What ends as a defect of
the program, by a signal or not at all is written below FOLDER and printed.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import shutil
import signal
import sys
import time
from collections import Counter
from pathlib import Path

from processing.core.block_sums import SUFFIX
from tests.broken_files.full_project import make_full_project
from tests.broken_files.mutations import copy_of, files_of, mutate
from tests.older_project import forget_all_sums
from tests.reliability.operations import Answer, answer_to

MOST_SECONDS = 180
MOST_BYTES = 3 << 30
_COMMANDS = (
    ("info", "{project}"),
    ("run", "curbs", "{project}"),
    ("run", "ground", "{project}"),
    ("run", "normals", "{project}"),
    ("number", "{project}"),
    ("image", "{project}", "--kind", "trajectory-center", "--attribute", "label", "--output",
     "{out}/i.png"),
    ("image", "{project}", "--kind", "reversible", "--attribute", "normal", "--output",
     "{out}/i.png"),
    ("export", "{project}", "--format", "dxf", "csv", "gpkg", "las", "qa", "--out", "{out}"),
    ("export", "{project}", "--format", "geojson", "xlsx", "dm", "sima", "landxml", "kmz",
     "opendrive", "sections", "sxf", "shp", "--candidates", "--out", "{out}"),
    ("check", "{project}"),
    ("check", "{project}", "--repair"),
    ("info", "{project}"),
)  # fmt: skip


def commands_on(project: Path, out: Path) -> list[tuple[str, Answer]]:
    """The answer to every command on a project."""
    return [
        (" ".join(words[:3]), answer_to([word.format(project=project, out=out) for word in words]))
        for words in _COMMANDS
    ]


def wrong_answers(answers: list[tuple[str, Answer]]) -> list[str]:
    """Answers that are neither work nor one sentence with what, where and remedy."""
    return [
        f"{command}: {answer.status}: {answer.line[:300]}"
        for command, answer in answers
        if not answer.is_right
    ]


def _try(project: Path, work: Path, name: str, seed: int, report: Path) -> int:
    """Alter one file and use the project, in this process; gives how many answers were wrong."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    signal.alarm(MOST_SECONDS)
    report.write_text(f"{seed} {name}\n", encoding="utf-8")
    chance = random.Random(seed)  # noqa: S311 - chance, no secret
    copied = copy_of(project, work / "p.zuka")
    if seed % 2 and not name.endswith(
        SUFFIX
    ):  # as an older version made it: what the files say counts
        forget_all_sums(copied)
    told = mutate(copied / name, chance)
    report.write_text(f"{seed} {name} {told}\n", encoding="utf-8", errors="backslashreplace")
    wrong = wrong_answers(commands_on(copied, work / "out"))
    if wrong:
        with report.open("a", encoding="utf-8", errors="backslashreplace") as file:
            file.writelines(f"  {line}\n" for line in wrong)
    return len(wrong)


def main() -> int:
    """Try as many mutations as are wanted; the exit status says whether all went well."""
    wanted = argparse.ArgumentParser(description=__doc__)
    wanted.add_argument("folder", type=Path)
    wanted.add_argument("--mutations", type=int, default=100)
    wanted.add_argument("--seed", type=int, default=1)
    wanted.add_argument("--only", default="")
    options = wanted.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    os.environ["ZUKA_LANGUAGE"] = "en"
    project = options.folder / "街路.zuka"
    if not project.is_dir():
        make_full_project(options.folder)
    # Kernels that were used before are there for every process that is forked.
    warm = copy_of(project, options.folder / "warm" / "p.zuka")
    for answer in commands_on(warm, options.folder / "warm" / "out"):
        sys.stdout.write(f"{answer}\n")
    names = [name for name in files_of(project) if options.only in name]
    counted: Counter[str] = Counter()
    started = time.monotonic()
    for seed in range(options.seed, options.seed + options.mutations):
        # Small files as often as large ones: the choice is by name.
        name = names[seed * 7919 % len(names)]
        work = options.folder / f"w{options.seed}"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir()
        report = work / "report.txt"
        child = os.fork()
        if child == 0:
            status = 99
            try:
                status = min(_try(project, work, name, seed, report), 50)
            finally:
                os._exit(status)
        ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        counted["tried"] += 1
        if ended != 0:
            counted["wrong" if ended > 0 else "killed"] += 1
            sys.stdout.write(f"ended {ended}: {report.read_text(encoding='utf-8')}")
            sys.stdout.flush()
    sys.stdout.write(f"{dict(counted)} {time.monotonic() - started:.0f} s\n")
    return int(counted["tried"] != counted.total())


if __name__ == "__main__":
    sys.exit(main())
