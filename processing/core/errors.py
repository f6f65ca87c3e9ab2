"""What can go wrong through no fault of the program: said once, the same words everywhere.

The window, the terminal and the log print the same three parts: what, where, what to do.
"""

from __future__ import annotations

import errno
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from processing.core.text import Language, Text

ValueT = TypeVar("ValueT")


class UserError(Exception):
    """A fact that stops the work and that the user can do something about.

    Parameters
    ----------
    what, where, remedy : Text
        One sentence each without line breaks: what is wrong; the file and the place in it;
        what to do, and what became of the project.
    """

    def __init__(self, what: Text, where: Text, remedy: Text) -> None:
        self.what = what
        self.where = where
        self.remedy = remedy
        super().__init__(self.line("en"))

    def line(self, language: Language) -> str:
        """The whole message on one line, its three parts divided by bars."""
        parts = (self.what, self.where, self.remedy)
        return " | ".join(" ".join(part.in_language(language).split()) for part in parts)


class BadFile(UserError):
    """A file's content is not what its format says."""


class MissingInput(UserError):
    """Something needed is not there: a file, a trajectory, a reference system."""


class OutOfRange(UserError):
    """A value lies outside what is allowed or outside what the data cover."""


class NoSpace(UserError):
    """The disk is full, read-only or refuses the write."""


class InUse(UserError):
    """Another window or program holds what is asked for."""


class Unsuitable(UserError):
    """The data lack what a tool, an image or a view needs."""


class Cancelled(Exception):
    """The user stopped the work; nothing of it is kept."""


class Interrupted(Cancelled):
    """The program ends or the project is closed; work that can go on one day keeps what is done."""


UNCHANGED = Text("The project is unchanged.", "プロジェクトは変更されていません。")


def use_one_of(names: Iterable[str]) -> Text:
    """The remedy for a word that isn't known."""
    return Text("Use one of: {names}.", "次のいずれかを指定してください: {names}").filled(
        names=", ".join(names) or "-"
    )


def name_with_type(known: Mapping[str, ValueT], name: str, what: Text) -> ValueT:
    """What has a name.

    Parameters
    ----------
    what : Text
        Said where nothing has it.

    Raises
    ------
    OutOfRange
        Nothing has it; tells the names that are known.
    """
    if name not in known:
        raise OutOfRange(what, Text.same(name), use_one_of(known))
    return known[name]


@contextmanager
def report_as_user_error(path: Path) -> Iterator[None]:
    """Turn what the operating system says about a file into the sentence a user can act on.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        In place of the ``OSError`` of the body, and of the ``UnicodeEncodeError`` where the
        file's name is no text and the body needs one.
    """
    try:
        yield
    except OSError as error:
        raise _from_os_error(error, Path(error.filename or path)) from error
    except UnicodeEncodeError as error:
        if _is_text(str(path.absolute())):
            raise
        raise BadFile(
            Text(
                "The name of the file or of a folder above it is not text in UTF-8.",
                "ファイル名、またはその上のフォルダ名がUTF-8の文字になっていません。",
            ),
            Text.same(str(path)),
            Text("Rename it, then try again.", "名前を変更してから、もう一度実行してください。"),
        ) from error


def _is_text(name: str) -> bool:
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def _from_os_error(error: OSError, path: Path) -> UserError:
    where = Text.same(str(path))
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return NoSpace(
            Text("The disk is full.", "ディスクの空き容量がありません。"),
            where,
            Text(
                "Free some space or choose another disk, then try again; nothing is half written.",
                "空き容量を増やすか別のディスクを選んで、もう一度実行してください。"
                "書きかけのファイルは残りません。",
            ),
        )
    if error.errno in (errno.EROFS, errno.EACCES, errno.EPERM):
        return NoSpace(
            Text("Access is not allowed here.", "この場所へのアクセスが許可されていません。"),
            where,
            Text(
                "Choose a place that you may use, or ask for the rights.",
                "利用できる場所を選ぶか、アクセス権を設定してください。",
            ),
        )
    if isinstance(error, FileNotFoundError):
        return MissingInput(
            Text("There is no such file.", "ファイルが見つかりません。"),
            where,
            Text("Check the name and the folder.", "ファイル名とフォルダを確認してください。"),
        )
    if isinstance(error, IsADirectoryError):
        return BadFile(
            Text(
                "This is a folder, and a file is asked for.", "フォルダではなくファイルが必要です。"
            ),
            where,
            Text(
                "Name a file, or move the folder away.",
                "ファイルを指定するか、フォルダを移動してください。",
            ),
        )
    reason = error.strerror or str(error)
    return BadFile(
        Text(
            f"The operating system refuses: {reason}.",
            f"オペレーティングシステムが処理を拒否しました（{reason}）。",
        ),
        where,
        Text("Check the file and the disk.", "ファイルとディスクを確認してください。"),
    )
