"""Compiles every kernel once, so that no one waits for a compiler in the program.

A module of ``processing`` that holds kernels may define ``warm_up()``, which runs them once on
tiny arrays of the dtypes they get in earnest; numba keeps the machine code on disk. Then every tool
runs once on the bundled street, which compiles what no warm-up names. Any error ends the set-up: a
kernel that does not compile here fails in the program too.
"""

from __future__ import annotations

import argparse
import importlib
import io
import multiprocessing
import os
import pkgutil
import shutil
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FunctionType, ModuleType

WARM_UP = "warm_up"
LATER = (
    "processing.laboratory",
    "processing.methods.earthwork",
    "processing.methods.road",
    "processing.methods.templates",
)
"""What the demo doesn't use; numba compiles a kernel at its first use where nobody did before."""

DEMO_TOOLS = ("classify", "curbs", "gutters", "noise", "ground")
"""What the demo runs; the slowest first, so that no process waits for another at the end."""

TOOLS = (
    *DEMO_TOOLS,
    *("wires", "signs", "trees", "markings", "barriers", "walls"),
    *("edges", "covers", "clearance"),
    *("segments", "normals"),
)
"""Tools with kernels that run on a drive as it is."""

TRAINING = (
    "processing.laboratory.class_training.image_network",
    "processing.laboratory.waveform_networks.networks",
    "processing.laboratory.waveform_training.response_learner",
)
"""What asks for the extra ``train``, and has no kernels."""


def folders_of(package: ModuleType, without: Sequence[str] = ()) -> tuple[tuple[str, ...], ...]:
    """Give the names of a package's modules by folder, those with the most kernels first.

    Kernels of a folder call each other: two processes would compile the same ones.

    Parameters
    ----------
    without : Sequence[str]
        Packages in it that are left out.
    """
    names: dict[str, list[str]] = defaultdict(list)
    kernels: dict[str, int] = defaultdict(int)
    for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}.", onerror=_fail):
        folder, _, leaf = found.name.rpartition(".")
        if any(f"{found.name}.".startswith(f"{left}.") for left in without):
            continue
        names[folder].append(found.name)
        if not found.ispkg:
            source = Path(getattr(found.module_finder, "path", ""), f"{leaf}.py")
            kernels[folder] += source.read_text(encoding="utf-8").count("@kernel")
    ordered = sorted(names, key=lambda folder: (-kernels[folder], folder))
    return tuple(tuple(sorted(names[folder])) for folder in ordered)


def remove_stale_code(folder: Path) -> int:
    """Remove machine code that is older than its source, or whose source is gone.

    Numba leaves it on the disk, and reads what it says of its arguments before it sees that it is
    stale: a record of arguments that has another name by then ends the program.

    Returns
    -------
    int
        How many files were removed.
    """
    stale = [
        code
        for code in folder.rglob("__pycache__/*.nb[ic]")
        if not _is_newer(code, code.parent.parent / f"{code.name.partition('.')[0]}.py")
    ]
    for code in stale:
        code.unlink(missing_ok=True)
    return len(stale)


def _is_newer(code: Path, source: Path) -> bool:
    return source.is_file() and code.stat().st_mtime >= source.stat().st_mtime


def warm_up_of(module: ModuleType) -> Callable[[], object] | None:
    """Give the warm-up that a module itself defines; one that it imported is not its own."""
    function: object = vars(module).get(WARM_UP)
    if isinstance(function, FunctionType) and function.__module__ == module.__name__:
        return function
    return None


def warm(modules: Sequence[str]) -> tuple[str, ...]:
    """Import modules and run their warm-ups; gives the names of those that have one."""
    warmed = []
    for name in modules:
        warm_up = warm_up_of(importlib.import_module(name))
        if warm_up is not None:
            warm_up()
            warmed.append(name)
    return tuple(warmed)


def warm_beside(folders: Sequence[Sequence[str]], processes: int) -> tuple[str, ...]:
    """Do the same in several processes, a folder at a time; one process is this one."""
    if processes == 1:
        return warm([name for names in folders for name in names])
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, mp_context=fresh) as pool:
        done = pool.map(warm, folders)
        return tuple(name for names in done for name in names)


def import_street(folder: Path) -> Path:
    """Import one scanner of the bundled street; gives the project."""
    from resources import path_of

    street, project = path_of("sample_street"), folder / "street.zuka"
    _do("import", project, street / "left.laz", "--trajectory", street / "trajectory.csv")
    return project


def run_tool(tool: str, project: Path, folder: Path) -> None:
    """Run a tool on a copy of a project."""
    copied = shutil.copytree(project, folder / f"{tool}.zuka")
    _do("run", tool, copied)


def fly(folder: Path) -> None:
    """Simulate a small flight with waveforms, and find and classify its returns."""
    _do("simulate", "flight", "--length", 40, "--seed", 1, "--out", folder / "flight")
    flight = folder / "flight" / "in" / "flight.las"
    for tool in ("waveform-decompose", "waveform-classify"):
        _do("run", tool, flight, "--output", folder / f"{tool}.las")


def run_tools_beside(tools: Sequence[str], processes: int, *, flying: bool = False) -> None:
    """Run tools on the bundled street, each in one of several processes.

    Parameters
    ----------
    flying : bool
        Simulate a flight with waveforms as well, and run the tools of flights on it.
    """
    fresh = multiprocessing.get_context("spawn")
    with (
        TemporaryDirectory(prefix="zuka-kernels-") as name,
        ProcessPoolExecutor(processes, mp_context=fresh) as pool,
    ):
        folder = Path(name)
        project = pool.submit(import_street, folder).result()
        running = [pool.submit(run_tool, tool, project, folder) for tool in tools]
        running += [pool.submit(fly, folder)] if flying else []
        for done in running:
            done.result()


def _do(*words: object) -> None:
    from app.cli.terminal import run_in_terminal

    said = io.StringIO()
    with redirect_stdout(said), redirect_stderr(said):
        status = run_in_terminal([str(word) for word in words])
    if status != 0:
        message = f"zuka {' '.join(map(str, words))} ended with {status}: {said.getvalue()}"
        raise RuntimeError(message)


def _fail(name: str) -> None:
    raise ImportError(f"{name} cannot be imported") from sys.exc_info()[1]


def main() -> int:
    """Warm the kernels of `processing` and say how long it took."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--demo", action="store_true", help="only what the demo uses")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    without = LATER if options.demo else TRAINING
    start = time.perf_counter()
    remove_stale_code(Path(__file__).resolve().parent.parent / "processing")
    folders = folders_of(importlib.import_module("processing"), without)
    warmed = warm_beside(folders, options.processes)
    tools = DEMO_TOOLS if options.demo else TOOLS
    run_tools_beside(tools, options.processes, flying=not options.demo)
    seconds = time.perf_counter() - start
    sys.stderr.write(f"zuka: kernels of {len(warmed)} modules are ready after {seconds:.0f} s\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
