"""How a loop over points becomes machine code: one typed door to numba.

Kernels take arrays and scalars, write into arrays that the caller allocated, release the
interpreter, and are compiled once per machine (``installer/warm_kernels.py``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

FunctionT = TypeVar("FunctionT", bound=Callable[..., object])


def kernel(function: FunctionT) -> FunctionT:
    """Compile a function for one core; ``function.py_func`` is the plain one."""
    return cast("FunctionT", njit(cache=True, nogil=True)(function))
