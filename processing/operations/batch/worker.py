"""A process that works on one drive of a job; ends with its parent.

The order comes as a line of JSON on standard input, which stays open; how far the work is goes out
on standard output. What comes of it stands in the drive's state.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from pathlib import Path

from processing.core.errors import UserError
from processing.core.output_streams import write_every_character
from processing.core.process_memory import MemoryPeak
from processing.core.text import Text
from processing.operations.batch.deliveries import BatchDelivery
from processing.operations.batch.job import job_of_order
from processing.operations.batch.unit_state import ErrorWords, TaskState, with_trouble
from processing.operations.batch.unit_work import BatchUnit, work_on
from processing.operations.written_values import Table
from processing.tools.plugins.folders import plugin_files, plugin_folders
from processing.tools.plugins.loading import load_plugins

_EVERY_S = 0.1
_PREPARING = Text("Preparation", "準備")


class _Telling:
    """A monitor that tells its parent; it is ended by the parent, so nothing asks it to stop."""

    def __init__(self) -> None:
        self._text = Text("", "")
        self._told_s = 0.0

    def report(self, fraction: float, text: Text | None = None) -> None:
        is_new = text is not None and text != self._text
        self._text = self._text if text is None else text
        now = time.monotonic()
        if is_new or now > self._told_s + _EVERY_S:
            self._told_s = now
            said = {"fraction": fraction, "en": self._text.en, "ja": self._text.ja}
            sys.stdout.write(json.dumps(said) + "\n")
            sys.stdout.flush()

    def check(self) -> None:
        """Go on."""


def unit_of_order(order: Table) -> BatchUnit:
    """The unit that an order names."""
    deliveries = tuple(BatchDelivery(name, Path(path)) for name, path in order["deliveries"])
    return BatchUnit(order["name"], Path(order["folder"]), deliveries)


def main() -> None:
    """Work on the drive that is asked for."""
    order = json.loads(sys.stdin.readline())
    threading.Thread(target=_end_with_parent, daemon=True).start()
    load_plugins(plugin_files(plugin_folders()))  # what stands against one was told by the parent
    file, unit = job_of_order(order), unit_of_order(order)
    try:
        work_on(file, unit, _Telling(), MemoryPeak().taken)
    except UserError as error:
        trouble = TaskState("", _PREPARING, "failed", error=ErrorWords.of(error))
        with_trouble(unit.folder, unit.name, trouble)


def _end_with_parent() -> None:
    sys.stdin.read()
    # The parent is gone, killed perhaps; what was noted by then is all that counts.
    os._exit(0)


if __name__ == "__main__":
    write_every_character()
    main()
