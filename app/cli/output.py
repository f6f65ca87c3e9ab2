"""Results on standard output: lines of text, or one JSON document."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence


def print_lines(*lines: str) -> None:
    """Write lines to standard output."""
    sys.stdout.write("".join(f"{line}\n" for line in lines))


def print_notes(*lines: str) -> None:
    """Write lines about a result to standard error, where they are in no script's way."""
    sys.stderr.write("".join(f"{line}\n" for line in lines))


def print_json(value: Mapping[str, object] | Sequence[Mapping[str, object]]) -> None:
    """Write one JSON document to standard output; in ASCII where its encoding lacks a character."""
    text = json.dumps(value, ensure_ascii=False, indent=1)
    try:
        text.encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:
        text = json.dumps(value, indent=1)
    sys.stdout.write(text + "\n")
