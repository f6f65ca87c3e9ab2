"""Large libraries are imported by one thread at a time.

Open3D and pyvista both bring IPython. Two threads that import them at once wait for each other's
modules in circles, and Python ends one import with an error.
"""

from __future__ import annotations

import threading

LIBRARY_LOADING = threading.Lock()
"""Held while a thread other than the first imports a library that brings many others."""
