"""Compiles every kernel once, so that no one waits for a compiler in the program.

A module of ``processing`` that holds kernels may define ``warm_up()``, which runs them once on
tiny arrays of the dtypes they get in earnest; numba keeps the machine code on disk. Any error
ends the set-up: a kernel that does not compile here fails in the program too.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys
import time
from collections.abc import Callable, Iterator
from types import FunctionType, ModuleType

WARM_UP = "warm_up"


def modules_below(package: ModuleType) -> Iterator[ModuleType]:
    """Import and give every module of a package, in the order of their names."""
    yield package
    found = pkgutil.walk_packages(package.__path__, f"{package.__name__}.", onerror=_fail)
    for name in sorted(information.name for information in found):
        yield importlib.import_module(name)


def warm_up_of(module: ModuleType) -> Callable[[], object] | None:
    """Give the warm-up that a module itself defines; one that it imported is not its own."""
    function: object = vars(module).get(WARM_UP)
    if isinstance(function, FunctionType) and function.__module__ == module.__name__:
        return function
    return None


def warm(package: ModuleType) -> tuple[str, ...]:
    """Run the warm-ups of a package; gives the names of the modules that have one."""
    warmed = []
    for module in modules_below(package):
        warm_up = warm_up_of(module)
        if warm_up is not None:
            warm_up()
            warmed.append(module.__name__)
    return tuple(warmed)


def _fail(name: str) -> None:
    raise ImportError(f"{name} cannot be imported") from sys.exc_info()[1]


def main() -> int:
    """Warm the kernels of `processing` and say how long it took."""
    start = time.perf_counter()
    warmed = warm(importlib.import_module("processing"))
    seconds = time.perf_counter() - start
    sys.stderr.write(f"zuka: kernels of {len(warmed)} modules are ready after {seconds:.0f} s\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
