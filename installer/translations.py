"""Texts for translation: collected from the sources, compiled for the program.

The ``.ts`` files are kept in git; the ``.qm`` files that Qt loads are built by the set-up.
"""

from __future__ import annotations

from pathlib import Path

from installer.environment import Environment

FOLDER = Path("resources", "translations")
SOURCES = ("app", "widgets")
JAPANESE, ENGLISH = "zuka_ja.ts", "zuka_en.ts"


def source_files(root: Path) -> list[Path]:
    """List the files that hold texts for translation, in a fixed order."""
    return sorted(path for part in SOURCES for path in (root / part).rglob("*.py"))


def collect(environment: Environment, into: Path) -> None:
    """Bring the ``.ts`` files of a folder up to date with the sources.

    English needs entries for plural forms only: its other texts are the sources' own.
    """
    into.mkdir(parents=True, exist_ok=True)
    files = source_files(environment.root)
    common = ("-silent", "-no-obsolete", "-locations", "none", "-source-language", "en")
    for name, more in (
        (JAPANESE, ("-target-language", "ja")),
        (ENGLISH, ("-target-language", "en", "-pluralonly")),
    ):
        environment.run("pyside6-lupdate", *common, *more, *files, "-ts", into / name)


def compile_all(environment: Environment) -> None:
    """Build the ``.qm`` beside every ``.ts`` of the resources."""
    for path in sorted((environment.root / FOLDER).glob("*.ts")):
        compiled = path.with_suffix(".qm")
        environment.run("pyside6-lrelease", "-silent", path, "-qm", compiled)
