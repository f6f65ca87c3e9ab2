"""Questions to a list of formats: endings, filters of dialogs, refusals, what a file is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from processing.core.errors import OutOfRange
from processing.core.parameters import Parameter, parameters_of
from processing.core.text import Text
from processing.formats.format import Content, Format, filter_of

_ALL_FILES = Text("All files (*)", "すべてのファイル (*)")


class FormatList:
    """Formats, in the order in which they are recognised and offered.

    Parameters
    ----------
    formats : iterable of Format
        With different ids.
    """

    def __init__(self, formats: Iterable[Format]) -> None:
        self._by_id = {one.id: one for one in formats}

    def __iter__(self) -> Iterator[Format]:
        """Give each format, in their order."""
        return iter(self._by_id.values())

    def __getitem__(self, id_: str) -> Format:
        """Give the format of an id."""
        return self._by_id[id_]

    def including(self, *formats: Format) -> FormatList:
        """These and further ones; one of the same id is replaced."""
        return FormatList((*self, *formats))

    def read(self, content: Content) -> tuple[Format, ...]:
        """Those from which the content can be read."""
        return tuple(one for one in self if content in one.reads)

    def written(self, content: Content) -> tuple[Format, ...]:
        """Those to which the content can be written."""
        return tuple(one for one in self if content in one.writes)

    def endings_read(self, *contents: Content) -> tuple[str, ...]:
        """How the names end of files from which one of the contents can be read."""
        found = (end for content in contents for one in self.read(content) for end in one.endings)
        return tuple(dict.fromkeys(found))

    def endings_written(self, *contents: Content) -> tuple[str, ...]:
        """How names may end to which one of the contents can be written."""
        found = (
            end for content in contents for one in self.written(content) for end in one.endings
        )
        return tuple(dict.fromkeys(found))

    def filter_read(self, *contents: Content, name: Text | None = None) -> Text:
        """What a dialog offers to open: files of the contents, or any.

        Parameters
        ----------
        name : Text
            What they are called together; the first content's own where it is left out.
        """
        shown = filter_of(name or contents[0].value, self.endings_read(*contents))
        return Text(f"{shown.en};;{_ALL_FILES.en}", f"{shown.ja};;{_ALL_FILES.ja}")

    def filter_written(self, content: Content) -> Text:
        """What a dialog offers to save a content as."""
        return filter_of(content.value, self.endings_written(content))

    def format_to_read(self, path: Path, content: Content) -> Format:
        """The format from which a content is read, by the ending of a file's name.

        Raises
        ------
        OutOfRange
            The ending says none; names those that can be read.
        """
        for one in self.read(content):
            if path.suffix.lower() in one.endings:
                return one
        what = Text("{content} are read from {en}.", "{content}は{ja}から読み込みます。")
        remedy = Text("Give a file ending in {en}.", "{ja} のファイルを指定してください。")
        raise OutOfRange(
            _fill_sentence(what, [one.name for one in self.read(content)], content),
            Text.same(str(path)),
            _fill_sentence(remedy, map(Text.same, self.endings_read(content))),
        )

    def format_to_write(self, path: Path, *contents: Content) -> Format:
        """The format to which one of the contents is written, by the ending of a file's name.

        Raises
        ------
        OutOfRange
            The ending says none; names those that can be written.
        """
        for one in self:
            if path.suffix.lower() in one.endings and not one.writes.keys().isdisjoint(contents):
                return one
        written = {one.id: one.name for content in contents for one in self.written(content)}
        what = Text("{content} are written as {en}.", "{content}は{ja}で書き出します。")
        remedy = Text("Give a name ending in {en}.", "{ja} で終わる名前にしてください。")
        raise OutOfRange(
            _fill_sentence(what, written.values(), *contents),
            Text.same(str(path)),
            _fill_sentence(remedy, map(Text.same, self.endings_written(*contents))),
        )

    def recognised(self, start: bytes, *contents: Content) -> tuple[Format, Content] | None:
        """The format that a file begins as, and which of the contents it holds.

        Parameters
        ----------
        start : bytes
            The first 4096 of them, or all of a shorter file.

        Returns
        -------
        (Format, Content) or None
            None where no format can say so for certain.
        """
        for one in self:
            held = next((content for content in contents if content in one.reads), None)
            if held is not None and one.begins(start):
                return one, held
        return None

    def folder_format(self, path: Path) -> Format | None:
        """The format that a folder is of as a whole; None where it just holds files."""
        return next((one for one in self if one.is_folder(path)), None)

    def says_points_alone(self, path: Path) -> bool:
        """Whether a file's name says that it holds points, and nothing else of a delivery."""
        ending = path.suffix.lower()
        others = self.endings_read(Content.TRAJECTORY, Content.IMAGES)
        return ending in self.endings_read(Content.POINTS) and ending not in others

    def maps(self) -> tuple[Format, ...]:
        """Those in which the map can be handed in."""
        return tuple(one for one in self if one.map_title is not None)

    def map_options(self) -> tuple[Parameter, ...]:
        """What can be chosen for maps; an option that several formats have stands there once."""
        found = {
            option.id: option
            for one in reversed(self.maps())
            if one.options is not None
            for option in reversed(parameters_of(one.options))
        }
        return tuple(reversed(found.values()))

    def map_option_owners(self) -> Mapping[str, tuple[str, ...]]:
        """By the id of a format of maps the ids of what can be chosen for it."""
        return {
            one.id: tuple(option.id for option in parameters_of(one.options))
            for one in self.maps()
            if one.options is not None
        }


def _fill_sentence(sentence: Text, choices: Iterable[Text], *contents: Content) -> Text:
    """A sentence about a content with what can be chosen in its place."""
    *first, last = choices
    english = ", ".join(one.en for one in first)
    return sentence.filled(
        content=Text(
            " and ".join(one.value.en for one in contents).capitalize(),
            "・".join(one.value.ja for one in contents),
        ),
        en=f"{english} or {last.en}" if first else last.en,
        ja="・".join(one.ja for one in (*first, last)),
    )
