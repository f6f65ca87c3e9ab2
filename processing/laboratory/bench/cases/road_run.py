"""Runs curbs and gutters on drives in a process that can be watched.

``python -m processing.laboratory.bench.cases.road_run FOLDER DRIVE_FOLDER...`` (the first one for
what tools write) says "ready" once its modules are loaded, and "done" at the end, each with the
moment on the clock that all processes share.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, run

ROAD_TOOLS = ("curbs", "gutters")


@dataclass
class StageWatch(SilentMonitor):
    """A monitor that takes the time between what it is told.

    Attributes
    ----------
    seconds : dict of str to float
        By the stage that was told, in the order in which they began.
    longest_s : float
        Between two moments at which the work could have been stopped.
    """

    seconds: dict[str, float] = field(default_factory=dict)
    longest_s: float = 0.0
    _stage: str = "begin"
    _since: float = field(default_factory=time.perf_counter)
    _checked: float = field(default_factory=time.perf_counter)

    def report(self, fraction: float, text: Text | None = None) -> None:
        """Begin a stage where another one is told."""
        del fraction
        if text is not None and text.en != self._stage:
            self._end()
            self._stage = text.en

    def check(self) -> None:
        """Note how long nobody could stop the work."""
        now = time.perf_counter()
        self.longest_s = max(self.longest_s, now - self._checked)
        self._checked = now

    def close(self) -> None:
        """The last stage is over."""
        self._end()
        self.check()

    def _end(self) -> None:
        now = time.perf_counter()
        self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
        self._since = now


def run_tools(drives: Sequence[Drive], into: Path) -> dict[str, StageWatch]:
    """Run each of `ROAD_TOOLS` on all drives together; how long their stages took."""
    watches = {}
    for tool in ROAD_TOOLS:
        request = RunRequest(tool, drives[0], TOOLS[tool].parameters(), tuple(drives[1:]))
        watches[tool] = StageWatch()
        run(request, watches[tool], into=into / tool)
        watches[tool].close()
    return watches


def main(arguments: Sequence[str]) -> None:
    """Run both, and tell when."""
    sys.stdout.write(f"ready {time.monotonic()}\n")
    sys.stdout.flush()
    into, *folders = map(Path, arguments)
    run_tools([Drive(folder) for folder in folders], into)
    sys.stdout.write(f"done {time.monotonic()}\n")


if __name__ == "__main__":
    write_every_character()
    main(sys.argv[1:])
