"""The order in which a window's modules are loaded.

Once PySide6 is there it reads the source of every module that is imported (for its switchable
names of Qt's properties), so what needs no Qt comes first. On the machine of the benchmarks that is
0.2 s of a start of 2 s.
"""

from __future__ import annotations


def load_without_qt() -> None:
    """Load what the window stands on and what needs no Qt."""
    # Each brings most of its part of the program along.
    import processing.image.search.clip
    import processing.operations.extraction
    import processing.project.additions
    import processing.project.evaluation.class_evaluation  # noqa: F401 - loading is the purpose
