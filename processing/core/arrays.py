"""Names of the arrays that signatures speak of; their shapes stand in the docstrings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]
Colours = NDArray[np.uint8]
"""Red, green and blue in the last place."""
