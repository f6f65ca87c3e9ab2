"""What the system must let the program have: one sentence where it is less, not an abort."""

from __future__ import annotations

from processing.core.errors import NoSpace
from processing.core.text import Text

_LEAST_ADDRESSES = 1024**3
"""Bytes: below it libraries that the program stands on abort, or wait for ever, while they load."""
_LEAST_FILES = 64
"""Libraries, the files of a drive and a project's database are open at the same time."""


def refuse_tight_limits() -> None:
    """Go on where the limits of this process leave room to work.

    Raises
    ------
    NoSpace
        ``ulimit``, a container or a batch system allows too little memory or too few open files.
    """
    try:
        import resource
    except ModuleNotFoundError:  # Windows has no such limits
        return
    addresses, _ = resource.getrlimit(resource.RLIMIT_AS)
    if resource.RLIM_INFINITY != addresses < _LEAST_ADDRESSES:
        allowed = f"{addresses / 1024**3:.1f} GB"
        raise NoSpace(
            Text(
                f"The system lets this program have {allowed} of memory, and that is too little.",
                f"このプログラムに許可されたメモリー（{allowed}）が不足しています。",
            ),
            Text.same("ulimit -v"),
            Text(
                "Allow at least 1 GB, better 4 GB and more, and start it again.",
                "1 GB以上（できれば4 GB以上）を許可してから起動し直してください。",
            ),
        )
    files, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    if resource.RLIM_INFINITY != files < _LEAST_FILES:
        raise NoSpace(
            Text(
                f"The system lets this program open {files} files at a time, and that is too few.",
                f"同時に開けるファイルの数（{files}）が不足しています。",
            ),
            Text.same("ulimit -n"),
            Text(
                f"Allow at least {_LEAST_FILES} and start it again.",
                f"{_LEAST_FILES}以上を許可してから起動し直してください。",
            ),
        )
