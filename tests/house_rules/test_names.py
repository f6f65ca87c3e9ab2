"""Things are found by their names: no drawers for leftovers, no name that another project has."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import packages_distributions
from pathlib import PurePosixPath

from tests.house_rules.imports import program
from tests.house_rules.sources import PARTS, python_files, text_of, tracked, tree_of

FORMER_WORDS = {
    *("wish", "wishes", "doubts", "tails", "trial", "trials", "darkroom", "pilot", "likings"),
    *("lay", "lays", "guides", "adopter"),
}
"""Words of our own that standard terms replaced: request, diagnostics, orientation …"""
_FORMER = re.compile(
    rf"((?<![A-Za-z])({'|'.join(FORMER_WORDS)})|{'|'.join(w.capitalize() for w in FORMER_WORDS)})"
    "(?![a-z])"
)
ALLOWED_PARTS = ("lay_out", "lay_stones", "what_lay_beside")  # the verb
_TYPED = re.compile(r"^\s*\w[\w, ]* : (.*[^.\n])$", re.MULTILINE)
_QUOTED = re.compile(r'"[^"]*"')
DRAWERS = {"utils", "util", "helpers", "helper", "misc", "common", "manager", "managers"}


def drawers(names: Iterable[str]) -> list[str]:
    """Give the paths of which a folder or file name holds a forbidden word."""
    return [name for name in names if DRAWERS & set(re.split(r"[^a-z]+", name.lower()))]


def former_words(source: str) -> list[str]:
    """Give the names of a source, of any kind, that hold a word which was replaced."""
    if _FORMER.search(source) is None:  # most sources, and sooner than by their trees
        return []
    names = {name for node in ast.walk(tree_of(source)) for name in _names_in(node)}
    return sorted(name for name in names if _words_of(name) & FORMER_WORDS)


def documented_types(source: str) -> set[str]:
    """Give the classes that docstrings name as types of parameters and attributes."""
    nodes = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    docs = [
        ast.get_docstring(one) or "" for one in ast.walk(tree_of(source)) if isinstance(one, nodes)
    ]
    types = (said[1] for doc in docs for said in _TYPED.finditer(doc))
    words = (word for said in types for word in re.findall(r"\b[A-Z]\w+", _QUOTED.sub("", said)))
    return {word for word in words if not word.isupper()}


def _names_in(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name) | ast.arg(arg=name):
            yield name
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name


def _words_of(name: str) -> set[str]:
    for part in ALLOWED_PARTS:
        name = name.replace(part, "")
    return set(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower().split("_"))


def public_classes(sources: Mapping[str, str]) -> dict[str, list[str]]:
    """Give the public classes that stand in several modules, with these."""
    found: dict[str, list[str]] = {}
    for path, source in sources.items():
        for node in tree_of(source).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found.setdefault(node.name, []).append(path)
    return {name: paths for name, paths in found.items() if len(paths) > 1}


def is_front_matter_only(source: str) -> bool:
    """Tell whether a module holds nothing but its docstring."""
    body = tree_of(source).body
    return len(body) == 1 and ast.get_docstring(tree_of(source)) is not None


def shared_names(distributions: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    """Give our top-level names that some other installed distribution has too."""
    others = {part: sorted(set(distributions.get(part, ())) - {"zuka"}) for part in PARTS}
    return {part: names for part, names in others.items() if names}


def test_no_file_or_folder_is_a_drawer_for_leftovers() -> None:
    assert drawers(tracked()) == []


def test_a_drawer_is_caught_wherever_the_word_stands() -> None:
    caught = ["app/utils.py", "widgets/misc/x.py", "app/jobs_manager.py", "tests/common_data.py"]
    assert drawers(caught) == caught
    assert drawers(["processing/commons.py", "app/commands.py"]) == []


def test_no_name_holds_a_word_that_was_replaced() -> None:
    found = {name: former_words(text_of(name)) for name in python_files()}
    assert {name: names for name, names in found.items() if names} == {}
    files = (name for name in python_files() if _words_of(PurePosixPath(name).stem) & FORMER_WORDS)
    assert list(files) == []


def test_a_word_that_was_replaced_is_caught() -> None:
    assert former_words("class RunWish:\n    def trials(self, a_lay): ...") == [
        "RunWish",
        "a_lay",
        "trials",
    ]
    assert former_words("class Layer:\n    def _lay_out(self): ...") == []


def test_types_that_docstrings_name_are_there() -> None:
    files = python_files("app", "widgets", "processing", "installer")
    known = {word for name in files for word in re.findall(r"\w+", _code_of(text_of(name)))}
    said = {name: documented_types(text_of(name)) - known for name in files}
    assert {name: types for name, types in said.items() if types} == {}


def _code_of(source: str) -> str:
    """A source without its texts and comments."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return " ".join(token.string for token in tokens if token.type == tokenize.NAME)


def test_a_type_that_a_docstring_names_is_read() -> None:
    lines = ('"""Do it.', "", "one : Track", 'form : {"LandXML"}', "two : The end.", '"""')
    doc = "def f():\n" + "\n".join(f"    {line}" for line in lines)
    assert documented_types(doc) == {"Track"}
    assert _code_of("one = Track  # Path") == "one Track"


def test_no_public_class_stands_for_two_things() -> None:
    assert public_classes(program()) == {}


def test_a_class_of_two_modules_is_caught() -> None:
    sources = {"app/a.py": "class Run: ...\nclass _Part: ...", "app/b.py": "class Run: ..."}
    assert public_classes(sources) == {"Run": ["app/a.py", "app/b.py"]}


def test_package_files_hold_a_docstring_only() -> None:
    fronts = {"resources/__init__.py"}
    files = [name for name in python_files() if PurePosixPath(name).name == "__init__.py"]
    assert files
    full = {name for name in files if not is_front_matter_only(text_of(name))}
    assert full <= fronts, "only a part's front page may hold code"


def test_code_in_a_package_file_is_caught() -> None:
    assert not is_front_matter_only('"""Words."""\nfrom app import jobs\n')
    assert not is_front_matter_only("")
    assert is_front_matter_only('"""Words."""\n')


def test_our_top_level_names_belong_to_no_other_installed_distribution() -> None:
    installed = packages_distributions()
    assert "numpy" in installed
    assert shared_names(installed) == {}


def test_a_top_level_name_that_another_distribution_has_is_caught() -> None:
    assert shared_names({"app": ["zuka", "appdirs"], "numpy": ["numpy"]}) == {"app": ["appdirs"]}
    assert shared_names({"app": ["zuka"], "tests": ["zuka"]}) == {}


def test_the_version_is_the_same_wherever_it_is_written() -> None:
    version = re.search(r'^version = "(.+)"$', text_of("pyproject.toml"), re.MULTILINE)
    assert version is not None
    assert f'#define Version "{version[1]}"' in text_of("installer/windows.iss")
    assert text_of("installer/macos.plist").count(f"<string>{version[1]}</string>") == 2
