"""Room on the disk for an import: asked for before, and what is said when it was not enough."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from processing.core.errors import NoSpace, UserError, report_as_user_error
from processing.core.text import Text

_FULL = (errno.ENOSPC, errno.EDQUOT)
_SPARE_BYTES = 16 << 20


def refuse_small_disk(folder: Path, wanted: int) -> None:
    """Refuse to begin what can't be finished.

    Parameters
    ----------
    wanted : int
        Bytes that will be written.

    Raises
    ------
    NoSpace
    """
    with report_as_user_error(folder):
        free = shutil.disk_usage(folder).free
    if wanted + _SPARE_BYTES <= free:
        return
    raise NoSpace(
        Text(
            "The import needs {wanted} on this disk, {free} are free.",
            "インポートにはこのディスクに{wanted}が必要ですが、空き容量は{free}です。",
        ).filled(wanted=size_words(wanted + _SPARE_BYTES), free=size_words(free)),
        Text.same(str(folder)),
        Text(
            "Free some space, or put the project on a larger disk, and import again.",
            "空き容量を増やすか、より大きなディスクにプロジェクトを置いて、"
            "もう一度インポートしてください。",
        ),
    )


@contextmanager
def report_full_disk(wanted_bytes: Callable[[], int], keep: Callable[[], bool]) -> Iterator[None]:
    """Say of a full disk how the import goes on.

    Parameters
    ----------
    wanted_bytes : callable
        Gives how much is still to be written.
    keep : callable
        Keeps what is done; says whether the import can go on.

    Raises
    ------
    NoSpace
        In place of the body's.
    """
    try:
        yield
    except NoSpace as error:
        cause = error.__cause__
        is_full = isinstance(cause, OSError) and cause.errno in _FULL
        is_small = cause is None
        if not (is_full or is_small) or not keep():
            raise
        raise _goes_on(error, size_words(wanted_bytes() + _SPARE_BYTES)) from error


def size_words(size: int) -> str:
    """A size as people read it: ``1.2 GB``, ``35 MB``."""
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(size / 1e6, 1):.0f} MB"


def _goes_on(error: UserError, wanted: str) -> NoSpace:
    return NoSpace(
        error.what,
        error.where,
        Text(
            "Free about {wanted} and import the same files again: it goes on where it stopped.",
            "約{wanted}を空けて、同じファイルをもう一度インポートしてください。"
            "中断したところから再開します。",
        ).filled(wanted=wanted),
    )
