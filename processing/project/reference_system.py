"""Reference systems as users name them."""

from __future__ import annotations

import re

from processing.errors import OutOfRange
from processing.text import Text


def reference_system(words: str) -> str:
    """A reference system's code in one spelling.

    Parameters
    ----------
    words : str
        ``EPSG:6677``, ``epsg:6677`` or ``6677``.

    Returns
    -------
    str
        ``EPSG:6677``.

    Raises
    ------
    OutOfRange
        It is no code, or there is no such projected system in metres.
    """
    found = re.fullmatch(r"(?:EPSG:)?\s*(\d{4,6})", words.strip(), flags=re.IGNORECASE)
    if found is None:
        raise _unknown(words)
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    code = f"EPSG:{found.group(1)}"
    try:
        CRS.from_user_input(code)
    except CRSError as error:
        raise _unknown(words) from error
    return code


def _unknown(words: str) -> OutOfRange:
    return OutOfRange(
        Text("There is no such reference system.", "そのような座標参照系はありません。"),
        Text.same(words),
        Text(
            "Give an EPSG code such as EPSG:6677.",
            "EPSG:6677 のようなEPSGコードを指定してください。",
        ),
    )
