"""What the installer for Windows names is there; it can't be built on every machine."""

from __future__ import annotations

import re
import tomllib

from tests.house_rules.sources import ROOT, text_of

SCRIPT = "installer/windows.iss"


def test_every_file_that_the_script_takes_is_there() -> None:
    sources = re.findall(r'^Source: "\.\.\\([^"]+)"', text_of(SCRIPT), flags=re.MULTILINE)
    assert len(sources) >= 9
    for source in sources:
        assert list(ROOT.glob(source.replace("\\", "/"))), source


def test_the_script_has_the_version_of_the_project() -> None:
    version = tomllib.loads(text_of("pyproject.toml"))["project"]["version"]
    assert f'#define Version "{version}"' in text_of(SCRIPT)


def test_every_message_that_the_script_shows_is_there_in_both_languages() -> None:
    text = text_of(SCRIPT)
    for name in set(re.findall(r"CustomMessage\('(\w+)'\)", text)):
        assert re.search(rf"^ja\.{name}=\S", text, flags=re.MULTILINE)
        assert re.search(rf"^en\.{name}=\S", text, flags=re.MULTILINE)
