"""What is said of delivered files that are missing or are others now."""

from __future__ import annotations

from collections.abc import Sequence

from processing.core.errors import BadFile, MissingInput, UserError
from processing.core.text import Language, Text
from processing.project.sources.source_check import FileState
from processing.project.sources.source_survey import FileProblem

_MISSING = Text("{path} is missing.", "{path} が見つかりません。")
_CHANGED = Text(
    "{path} is another file than the one imported.", "{path} はインポート時と異なるファイルです。"
)
_IMAGES = Text(
    "{count} camera images are missing: {path}", "カメラ画像{count}枚が見つかりません: {path}"
)
_GOES_ON = Text(
    "Drawing and tools on points go on without; results in the delivered order, labels and camera"
    " images need them. Choose the folder where they are now.",
    "作図と点群処理はそのまま続けられます。納品順の結果・ラベルの書き出しとカメラ画像に必要なため、"
    "現在のフォルダを指定してください。",
)
_ALL_FOUND = Text(
    "All delivered files and camera images are there.",
    "納品ファイルとカメラ画像はすべて見つかりました。",
)


def describe_file_problems(troubles: Sequence[FileProblem]) -> UserError | None:
    """The one sentence for all of them; None when there is nothing to say."""
    if not troubles:
        return None
    missing = [one for one in troubles if one.state is FileState.MISSING]
    where = Text.same(str((missing or list(troubles))[0].path))
    if missing:
        what = Text(
            "Delivered files or camera images are not where they were: {count}.",
            "納品ファイルまたはカメラ画像{count}個が元の場所にありません。",
        ).filled(count=f"{len(missing):,}")
        return MissingInput(what, where, _GOES_ON)
    what = Text(
        "Delivered files have changed since they were imported: {count}.",
        "納品ファイル{count}個がインポート後に変更されています。",
    ).filled(count=f"{len(troubles):,}")
    return BadFile(what, where, _GOES_ON)


def describe_found_files(before: int, troubles: Sequence[FileProblem]) -> Text | None:
    """What is said where the user has chosen a folder; None where much is still missing."""
    if not troubles:
        return _ALL_FOUND
    if len(troubles) < before:
        return Text(
            "Files found: {found}; still missing: {count}.",
            "{found}個が見つかりました。残り{count}個が見つかりません。",
        ).filled(found=f"{before - len(troubles):,}", count=f"{len(troubles):,}")
    return None


def words_by_drive(
    troubles: Sequence[FileProblem], language: Language
) -> dict[str, tuple[str, ...]]:
    """Lines for tooltips, by drive; images are counted, there are thousands of them."""
    lines: dict[str, list[str]] = {}
    images: dict[str, list[FileProblem]] = {}
    for one in troubles:
        for drive in one.drives:
            if one.is_image:
                images.setdefault(drive, []).append(one)
                continue
            words = _MISSING if one.state is FileState.MISSING else _CHANGED
            lines.setdefault(drive, []).append(words.filled(path=one.path).in_language(language))
    for drive, gone in images.items():
        words = _IMAGES.filled(count=f"{len(gone):,}", path=gone[0].path.parent)
        lines.setdefault(drive, []).append(words.in_language(language))
    return {drive: tuple(said) for drive, said in lines.items()}
