"""The way from a bare checkout: what is said and done when something is missing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from installer.bootstrap import version_complaint
from installer.commands import compile_modules
from installer.display import has_display, virtual_display
from installer.environment import Environment, was_moved
from installer.steps import InputStamp, Stop, fingerprint, run, status_of
from installer.system_packages import PACKAGES, not_installed
from tests.house_rules.sources import ROOT, text_of


@pytest.mark.parametrize("version", [(3, 11), (3, 12), (3, 13)])
def test_the_supported_versions_are_let_through(version: tuple[int, int]) -> None:
    assert version_complaint(version) == ""


@pytest.mark.parametrize("version", [(2, 7), (3, 10), (3, 14)])
def test_another_version_is_refused_in_one_sentence(version: tuple[int, int]) -> None:
    said = version_complaint(version)
    assert said.startswith("Zuka needs Python 3.11, 3.12 or 3.13")
    assert f"{version[0]}.{version[1]}" in said
    assert "\n" not in said


def test_the_supported_versions_are_those_of_the_project() -> None:
    assert 'requires-python = ">=3.11,<3.14"' in text_of("pyproject.toml")


def test_an_unknown_command_is_bad_input() -> None:
    answer = subprocess.run(
        [sys.executable, str(ROOT / "installer" / "bootstrap.py"), "fly"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.returncode == 2
    assert "invalid choice: 'fly'" in answer.stderr


def test_missing_packages_are_named_in_the_order_asked() -> None:
    listing = "installed|libegl1, \nconfig-files|xvfb, \ninstalled|libgl1, libgl1-glx (= 1.2), x\n"
    assert not_installed(["xvfb", "libegl1", "x", "libgl1-glx", "make"], listing) == (
        "xvfb",
        "make",
    )
    assert not_installed(PACKAGES, "") == PACKAGES


def test_a_renamed_library_that_provides_the_old_name_is_there() -> None:
    listing = "installed|libglib2.0-0t64, libglib2.0-0 (= 2.84.4-3)\n"
    assert not_installed(["libglib2.0-0"], listing) == ()


def test_a_failed_command_stops_with_its_own_status(tmp_path: Path) -> None:
    command = [sys.executable, "-c", "raise SystemExit(7)"]
    assert status_of(command, folder=tmp_path, environment={}) == 7
    with pytest.raises(Stop, match="status 7") as stop:
        run(command, folder=tmp_path, environment={})
    assert stop.value.status == 7
    assert "\n" not in str(stop.value)


def test_a_stamp_fits_only_the_inputs_it_was_set_for(tmp_path: Path) -> None:
    lock = tmp_path / "lock"
    lock.write_text("numpy==1\n")
    stamp = InputStamp(tmp_path / "lock.stamp")
    assert not stamp.fits(fingerprint([lock]))
    stamp.set(fingerprint([lock]))
    assert stamp.fits(fingerprint([lock]))
    lock.write_text("numpy==2\n")
    assert not stamp.fits(fingerprint([lock]))
    stamp.lift()
    stamp.lift()
    assert not stamp.fits(fingerprint([lock]))


def test_an_environment_that_was_moved_is_noticed() -> None:
    note = f"home = /usr/bin\ncommand = /usr/bin/python3 -m venv --clear {Path('/here/.venv')}\n"
    assert not was_moved(Path("/here/.venv"), note)
    assert was_moved(Path("/there/.venv"), note)
    assert was_moved(Path("/e/.venv"), note)
    assert not was_moved(Path("/there/.venv"), "home = /usr/bin\n")


def test_a_virtual_display_is_there_for_the_body_and_gone_after_it() -> None:
    given = {"PATH": "/usr/bin:/bin", "WAYLAND_DISPLAY": "wayland-0"}
    with virtual_display(given) as variables:
        if not sys.platform.startswith("linux"):
            assert variables == given
            return
        socket = Path("/tmp/.X11-unix") / f"X{variables['DISPLAY'].removeprefix(':')}"  # noqa: S108 - where X servers listen
        assert socket.exists()
        assert "WAYLAND_DISPLAY" not in variables
    assert not socket.exists()


def test_a_display_is_recognised_by_the_environment() -> None:
    is_windowed_system = sys.platform in ("win32", "darwin")
    assert has_display({}) == is_windowed_system
    assert has_display({"DISPLAY": ":0"})
    assert has_display({"WAYLAND_DISPLAY": "wayland-0"})


def test_the_lock_pins_every_package_with_hashes_and_names_no_index() -> None:
    lines = text_of("requirements.lock").splitlines()
    packages = [line for line in lines if line and not line.startswith((" ", "#"))]
    assert len(packages) > 50
    assert [line for line in packages if "==" not in line or not line.endswith("\\")] == []
    assert [line for line in lines if "--index" in line or "://" in line] == []


def test_modules_have_their_byte_code_beside_them_where_python_may_not_write_it(
    tmp_path: Path,
) -> None:
    folders = [tmp_path / name for name in ("app", "processing", "resources", "widgets")]
    for folder in folders:
        folder.mkdir()
        (folder / "street.py").write_text("lids = 3\n")
    environment = Environment(tmp_path, {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    python = environment.program("python")
    python.parent.mkdir(parents=True)
    python.symlink_to(sys.executable)
    compile_modules(environment)
    assert all(list(folder.rglob("street.*.pyc")) for folder in folders)
    (folders[0] / "lids.py").write_text("lids =\n")
    with pytest.raises(Stop):
        compile_modules(environment)
