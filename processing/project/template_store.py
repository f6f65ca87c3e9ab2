"""The templates of a project: kept by name in its settings, carried to others as files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from processing.core.errors import OutOfRange
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.methods.templates.profile_template import ProfileTemplate
from processing.methods.templates.template_text import (
    read_template,
    template_of,
    template_text,
    values_of,
)
from processing.project.store.project_settings import ProjectSettings

_KEY = "templates"
ENDING = ".json"


class TemplateStore:
    """Templates in the order in which they were made; every change is stored at once.

    Parameters
    ----------
    settings : ProjectSettings
        Of the open project.

    Raises
    ------
    NoSpace, InUse
        From what changes something; the old templates stay.
    """

    def __init__(self, settings: ProjectSettings) -> None:
        self._settings = settings

    def all(self) -> tuple[ProfileTemplate, ...]:
        """All templates.

        Raises
        ------
        BadFile
            What is stored is no template.
        """
        stored = self._settings.get(_KEY)
        values = stored if isinstance(stored, list) else []
        return tuple(template_of(one, f"zuka_settings.{_KEY}") for one in values)

    def get(self, name: str) -> ProfileTemplate | None:
        """The template of a name, or None."""
        return next((one for one in self.all() if one.name == name), None)

    def put(self, template: ProfileTemplate) -> None:
        """Keep a template in place of the one of its name, or as a new one."""
        before = self.all()
        if any(one.name == template.name for one in before):
            self._write(tuple(template if one.name == template.name else one for one in before))
        else:
            self._write((*before, template))

    def remove(self, name: str) -> None:
        """Forget a template."""
        self._write(tuple(one for one in self.all() if one.name != name))

    def rename(self, name: str, new_name: str) -> None:
        """Give a template another name.

        Raises
        ------
        OutOfRange
            Another template has it, or it is none.
        """
        new_name = new_name.strip()
        if new_name == name:
            return
        if self.get(new_name) is not None:
            raise OutOfRange(
                Text(
                    "There is a template of this name already.",
                    "同じ名前のテンプレートがすでにあります。",
                ),
                Text.same(new_name),
                Text("Choose another name.", "別の名前にしてください。"),
            )
        self._write(
            tuple(replace(one, name=new_name) if one.name == name else one for one in self.all())
        )

    def free_name(self, wanted: str) -> str:
        """A name that no template has: the wanted one, or with a number behind it."""
        names = {one.name for one in self.all()}
        if wanted not in names:
            return wanted
        number = 2
        while f"{wanted} {number}" in names:
            number += 1
        return f"{wanted} {number}"

    def import_file(self, path: Path) -> ProfileTemplate:
        """Take in a template from a file, under a name of its own.

        Raises
        ------
        MissingInput, BadFile
            There is none in it.
        """
        template = read_template(path)
        named = replace(template, name=self.free_name(template.name))
        self._write((*self.all(), named))
        return named

    def _write(self, templates: tuple[ProfileTemplate, ...]) -> None:
        self._settings.put(_KEY, [values_of(template) for template in templates])


def export_template(template: ProfileTemplate, path: Path) -> None:
    """Write a template as a file for other projects.

    Raises
    ------
    InUse, NoSpace, MissingInput
        What was there is as it was.
    """
    with write_safely(path) as temporary:
        temporary.write_text(template_text(template) + "\n", encoding="utf-8", newline="\n")
