"""The Debian packages that the window, the 3D view and the tests need besides Python's own.

Qt's and VTK's wheels bring nearly everything; what is listed here they take from the system.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from installer.steps import Stop, run, tell

PACKAGES = (
    "libegl1",
    "libgl1",
    "libopengl0",
    "libgl1-mesa-dri",
    "libx11-6",
    "libxcb-cursor0",
    "libxcb-icccm4",
    "libxcb-image0",
    "libxcb-keysyms1",
    "libxcb-render-util0",
    "libxcb-shape0",
    "libxcb-xinerama0",
    "libxcb-xkb1",
    "libxkbcommon-x11-0",
    "libglib2.0-0",
    "libfontconfig1",
    "libdbus-1-3",
    "libgomp1",
    "libusb-1.0-0",
    "fonts-noto-cjk",
    "xvfb",
)


def provide(environment: Mapping[str, str]) -> None:
    """Install the missing packages; does nothing off Linux or when all are there.

    Raises
    ------
    Stop
        When packages are missing and may not, or cannot, be installed from here: one line
        that says exactly what to install.
    """
    if not sys.platform.startswith("linux"):
        return
    if shutil.which("dpkg-query") is None or shutil.which("apt-get") is None:
        _check_without_apt()
        return
    missing = missing_packages()
    if not missing:
        return
    rights = _rights(environment)
    if rights is None:
        raise Stop(
            "these packages are missing; install them and run the command again: "
            f"sudo apt-get install {' '.join(missing)}"
        )
    _install(missing, rights, environment)


def missing_packages() -> tuple[str, ...]:
    """Name the listed Debian packages that are not installed, in the list's order."""
    asked = PACKAGES if _has_ensurepip() else ("python3-venv", *PACKAGES)
    answer = subprocess.run(
        ["dpkg-query", "--show", "--showformat", "${db:Status-Status}|${Package}, ${Provides}\n"],
        capture_output=True,
        text=True,
        check=True,
    )
    return not_installed(asked, answer.stdout)


def not_installed(asked: Sequence[str], listing: str) -> tuple[str, ...]:
    """Name what lines of ``STATUS|PACKAGE, PROVIDED, PROVIDED (= VERSION)`` don't have.

    Newer releases rename libraries (``libglib2.0-0t64``) and provide the old name.
    """
    there: set[str] = set()
    for line in listing.splitlines():
        status, _, names = line.partition("|")
        if status == "installed":
            there.update(name.split()[0] for name in names.split(",") if name.strip())
    return tuple(name for name in asked if name not in there)


def _install(names: Sequence[str], rights: Sequence[str], environment: Mapping[str, str]) -> None:
    tell(f"installing system packages: {' '.join(names)}")
    apt = [*rights, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q"]
    folder = Path("/")
    run([*apt, "update"], folder=folder, environment=environment)
    install = [*apt, "install", "--yes", "--no-install-recommends", *names]
    run(install, folder=folder, environment=environment)


def _rights(environment: Mapping[str, str]) -> tuple[str, ...] | None:
    """Give the words to put before apt-get; None when it may not be run."""
    if os.geteuid() == 0:
        return ()
    if shutil.which("sudo") is None:
        return None
    asked = subprocess.run(
        ["sudo", "-n", "true"], env=dict(environment), capture_output=True, check=False
    )
    return ("sudo", "-n") if asked.returncode == 0 else None


def _check_without_apt() -> None:
    """Let another Linux go on when it has what can be seen missing from here."""
    if _has_ensurepip() and shutil.which("Xvfb") is not None:
        return
    raise Stop(
        "this Linux has no apt-get: install Python's venv module, Xvfb, EGL, OpenGL and DRI from "
        "Mesa, the xcb libraries (cursor, icccm, image, keysyms, render-util, shape, xinerama, "
        "xkb), xkbcommon-x11, GLib, fontconfig, D-Bus, libgomp, libusb and Noto Sans CJK, then "
        "run again"
    )


def _has_ensurepip() -> bool:
    return importlib.util.find_spec("ensurepip") is not None
