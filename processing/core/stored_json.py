"""JSON that the program stored: whatever is wrong with it is one kind of error.

Python's reader raises errors of its own for text that is no UTF-8 and for values nested deeper
than its stack; who reads a file that somebody may have altered wants to know only that it is no
such JSON.
"""

from __future__ import annotations

import json
from typing import Any


# Any: whatever JSON can hold.
def json_of(content: bytes | str) -> Any:
    """The value of a JSON text.

    Parameters
    ----------
    content : bytes or str
        Bytes are UTF-8.

    Raises
    ------
    ValueError
        It is no JSON, no text, or nested too deeply to be read.
    """
    text = content.decode("utf-8") if isinstance(content, bytes) else content
    try:
        return json.loads(text)
    except RecursionError as error:
        message = "nested too deeply"
        raise ValueError(message) from error
