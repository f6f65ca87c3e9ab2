"""A process that reads delivered files into columns for an import; ends with its parent.

Jobs come as lines of JSON on standard input, what becomes of them goes out on standard output.
"""

from __future__ import annotations

import dataclasses
import json
import os
import sys
import threading
from queue import SimpleQueue
from typing import Any

from processing.core.errors import UserError
from processing.core.output_streams import write_every_character
from processing.project.importing.file_record import FileRecord, job_from, record_from
from processing.project.importing.file_recorder import NotAsPlanned, record_file

TOLD, WHOLE, REFUSED, MIXED = "reported", "whole", "refused", "mixed"


def describe_error(error: UserError) -> dict[str, object]:
    """An error as JSON."""
    cause = error.__cause__
    return {
        "kind": type(error).__name__,
        "texts": [dataclasses.asdict(one) for one in (error.what, error.where, error.remedy)],
        "errno": cause.errno if isinstance(cause, OSError) else None,
    }


def main() -> None:
    """Do what is asked until nobody asks any more."""
    asked: SimpleQueue[str] = SimpleQueue()
    threading.Thread(target=_listen, args=(asked,), daemon=True).start()
    while True:
        values = json.loads(asked.get())
        _do(values)


def _do(values: dict[str, Any]) -> None:
    job, record = job_from(values["job"]), record_from(values["record"])

    def reported(so_far: FileRecord) -> None:
        _say(TOLD, job.number, so_far.to_json())

    try:
        _say(WHOLE, job.number, record_file(job, record, reported).to_json())
    except UserError as error:
        _say(REFUSED, job.number, describe_error(error))
    except NotAsPlanned:
        _say(MIXED, job.number, {})


def _say(what: str, number: int, facts: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps([what, number, facts]) + "\n")
    sys.stdout.flush()


def _listen(asked: SimpleQueue[str]) -> None:
    for line in sys.stdin:
        asked.put(line)
    # The parent is gone, killed perhaps; what was noted by then is all that counts.
    os._exit(0)


if __name__ == "__main__":
    write_every_character()
    main()
