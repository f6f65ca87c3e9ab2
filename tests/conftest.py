"""What all tests share: their order, the sample street, and that no window stays behind.

Windows need a display; ``installer/bootstrap.py test`` gives one, and every process of
pytest-xdist (``-n 2``) gets one of its own. Nothing here stands in for a part of the program.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from filelock import FileLock
from hypothesis import HealthCheck, settings

from installer.display import virtual_display
from resources import path_of

if TYPE_CHECKING:
    from execnet import XSpec
    from PySide6.QtWidgets import QWidget

ORDER = (
    "house_rules",
    "installer",
    "processing",
    "properties",
    "broken_files",
    "widgets",
    "app",
    "journeys",
)
TESTS = Path(__file__).parent
SCREENS = pytest.StashKey[ExitStack]()
SCREEN = ("DISPLAY", "QT_QPA_PLATFORM")
THREADS = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
"""What libraries read when they are loaded; test processes share the cores among themselves."""

# The same cases on every machine, however slow it is.
settings.register_profile(
    "zuka",
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow],  # says only that the machine is busy
)
settings.load_profile("zuka")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config: pytest.Config, specs: Sequence[XSpec]) -> None:
    """Give each test process a share of the cores and a screen of its own.

    Focus and clipboard are the screen's. This process, which hands out the tests, keeps the
    screens, so that one whose user died is closed as well.
    """
    screens = config.stash[SCREENS] = ExitStack()
    share = max(1, (os.cpu_count() or 1) // len(specs))
    for spec in specs:
        variables = screens.enter_context(virtual_display(os.environ))
        spec.env.update(dict.fromkeys(THREADS, str(share)))
        spec.env.update((name, variables[name]) for name in SCREEN if name in variables)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Close the screens of the processes."""
    config.stash.get(SCREENS, ExitStack()).close()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the quick tests first, then those with windows, then the journeys."""
    items.sort(key=lambda item: place_in_order(item.path))


def place_in_order(path: Path) -> int:
    """Give the place of a test file; folders that are not named come last."""
    folder = path.relative_to(TESTS).parts[0]
    return ORDER.index(folder) if folder in ORDER else len(ORDER)


@pytest.fixture(scope="session", autouse=True)
def home_of_tests(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Give tests a home of their own, so that no one's settings and log are read or written.

    The cache of the fonts stays where it is: to make it anew takes seconds. The program speaks
    English unless a test asks for Japanese.
    """
    home = tmp_path_factory.mktemp("home")
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", str(home))
        patch.setenv("XDG_CACHE_HOME", cache)
        for name in ("CONFIG", "DATA", "STATE"):
            patch.setenv(f"XDG_{name}_HOME", str(home / name.lower()))
        patch.setenv("ZUKA_LANGUAGE", "en")
        yield home


@pytest.fixture
def sample_street() -> Path:
    """Give the folder of the bundled street; tests read it and write elsewhere."""
    return path_of("sample_street")


@pytest.fixture(scope="session")
def sample_project(
    tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> Path:
    """Give a closed project of that street; tests copy it.

    Importing takes seconds: the first of the test processes does it for all.
    """
    from tests.sample_project import make_sample_project

    shared = tmp_path_factory.getbasetemp()
    if hasattr(request.config, "workerinput"):
        shared = shared.parent
    project = shared / "sample.zuka"
    with FileLock(shared / "sample.lock"):
        if not project.exists():
            make_sample_project(tmp_path_factory.mktemp("sample") / "new.zuka").rename(project)
    return project


@pytest.fixture(autouse=True)
def no_window_left() -> Iterator[None]:
    """Fail a test after which a top-level widget is alive that was not there before."""
    before = set(map(id, top_level_widgets()))
    yield
    left = [widget for widget in top_level_widgets() if id(widget) not in before]
    if left:  # what only a reference cycle holds is gone after this
        left.clear()
        gc.collect()
        left = [widget for widget in top_level_widgets() if id(widget) not in before]
    names = ", ".join(sorted(described(widget) for widget in left))
    for widget in left:
        widget.close()
        widget.deleteLater()
    top_level_widgets()
    assert not names, f"these windows were left behind: {names}"


def top_level_widgets() -> list[QWidget]:
    """List the windows without a parent, once those that are to be deleted are gone."""
    if "PySide6.QtWidgets" not in sys.modules:
        return []
    from PySide6.QtCore import QCoreApplication, QEvent
    from PySide6.QtWidgets import QApplication

    if QApplication.instance() is None:
        return []
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    return [widget for widget in QApplication.topLevelWidgets() if widget.parent() is None]


def described(widget: QWidget) -> str:
    """Name a window by its class, its object name and its title."""
    parts = (type(widget).__name__, widget.objectName(), widget.windowTitle())
    return " ".join(part for part in parts if part)
