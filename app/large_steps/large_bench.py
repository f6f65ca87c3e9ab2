"""A window on a large project, used by mouse and keys; how long its frames take.

Run by ``zuka bench large`` in a process of its own: ``python -m app.large_steps.large_bench PROJECT
OUT SHARE``. It prints a line of JSON for each step: what was done, from when to when, and the times
of its frames.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from app.application import build_window, make_application
from app.large_steps import drawing, image, project, scene
from app.large_steps.bench_window import BenchWindow, StepTimings
from app.settings.settings import Settings
from processing.core.output_streams import write_every_character

_SIZE = (1600, 1000)

STEPS: dict[str, Callable[[BenchWindow], StepTimings]] = {
    "baseline": project.start,
    "open": project.open_project,
    "open again": project.open_again,
    "jump": image.jump,
    "pan": image.pan,
    "pan far": image.pan_far,
    "zoom": image.zoom,
    "switch": image.switch_attribute,
    "orbit": scene.orbit,
    "flight": scene.fly,
    "hover": drawing.hover,
    "draw": drawing.draw,
    "undo": drawing.undo,
    "export": project.export,
    "end": project.rest,
}
"""What is done, in this order."""


def main(folder: Path, out: Path, share: float) -> None:
    """Do every step on a project and tell of each.

    Parameters
    ----------
    folder : Path
        The project; features are drawn in it.
    out : Path
        For what is exported.
    share : float
        Of the frames and repetitions.
    """
    make_application()
    with TemporaryDirectory(prefix="zuka-") as scratch:
        parts = build_window(Settings(Path(scratch) / "settings.ini"), Path(scratch))
        try:
            parts.window.resize(*_SIZE)
            parts.window.show()
            # As the program does while nobody waits.
            parts.document.tiles.get_ready()
            # The 3D view begins with the first project.
            parts.document.create(Path(scratch) / "empty.zuka", "")
            window = BenchWindow(parts, folder, out, share)
            for name, step in STEPS.items():
                _report(name, step, window)
        finally:
            parts.window.close()


def _report(name: str, step: Callable[[BenchWindow], StepTimings], window: BenchWindow) -> None:
    window.pulse.take()
    began = time.monotonic()
    found = step(window)
    reported = {
        "step": name,
        "began": began,
        "ended": time.monotonic(),
        "longest_pause_s": window.pulse.take(),
        "times_s": found,
    }
    sys.stdout.write(json.dumps(reported) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    write_every_character()
    main(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
