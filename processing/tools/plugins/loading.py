"""Plug-in tools: a Python file in a folder declares a tool, and the program has one more.

A plug-in says ``TOOL = Tool(...)`` as the program's own tools do. Its faults are its own: one that
can't be loaded is told by name and left out, one that raises fails with its file and line, and one
that loops can be cancelled.
"""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
import time
import traceback
from collections.abc import Callable, Iterable
from dataclasses import fields, replace
from pathlib import Path
from types import FrameType
from typing import Any

from processing.core.errors import (
    BadFile,
    Cancelled,
    UserError,
    report_as_user_error,
)
from processing.core.monitor import Monitor
from processing.core.parameters import parameters_of
from processing.core.text import Text
from processing.tools.listed.registry import every_tool, register
from processing.tools.tool import Finder, PerDrive, PerPoint, SurveyFinder, Together, Tool

_FORBIDDEN = ("PySide6", "shiboken6", "qtpy", "qtawesome", "vtk", "vtkmodules", "pyvista", "app")
_METHODS = (PerPoint, PerDrive, Together, Finder, SurveyFinder)
_ID = re.compile(r"[a-z][a-z0-9_-]*")
_CHECK_S = 0.1
_REMEDY = Text(
    "Correct the plug-in, or take it out of its folder; all else works.",
    "プラグインを修正するか、フォルダから取り除いてください。ほかの機能は使えます。",
)


class PluginFault(BadFile):
    """A plug-in is not what a tool has to be, or fails."""


def load_plugins(files: Iterable[Path]) -> tuple[UserError, ...]:
    """Load plug-ins; gives what stands against those that are left out."""
    faults: list[UserError] = []
    for path in files:
        try:
            register(load_plugin(path))
        except UserError as error:
            faults.append(error)
    return tuple(faults)


def load_plugin(path: Path) -> Tool:
    """The tool that a file declares, guarded.

    Raises
    ------
    PluginFault
        It asks for the window, can't be imported, or declares no tool that can be had.
    UserError
        It can't be read.
    """
    with report_as_user_error(path):
        content = path.read_bytes()
    _refuse_window(content, path)
    return _guarded(_checked(getattr(_imported(path), "TOOL", None), path), path)


def _refuse_window(content: bytes, path: Path) -> None:
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        raise _fault(f"{type(error).__name__}: {error}", path, line) from error
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [one.name for one in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module or ""]
        else:
            continue
        for name in names:
            if name.split(".")[0] in _FORBIDDEN:
                raise PluginFault(
                    Text(
                        f"A tool can't use {name}: it also runs where there is no window.",
                        f"ツールでは {name} を使えません。画面のない環境でも実行されます。",
                    ),
                    _place(path, node.lineno),
                    _REMEDY,
                )


def _imported(path: Path) -> object:
    name = f"zuka_plugin_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise _fault("no module", path, 1)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        raise _fault_of(error, path) from error
    return module


def _checked(tool: object, path: Path) -> Tool:
    if not isinstance(tool, Tool):
        raise _fault("no TOOL = Tool(...)", path, 1)
    if not _ID.fullmatch(tool.id):
        raise _fault(f"id {tool.id!r}", path, 1)
    if tool.id in every_tool():
        raise PluginFault(
            Text("Another tool has this name already.", "同じ名前のツールがすでにあります。"),
            Text.same(f"{path}: {tool.id}"),
            _REMEDY,
        )
    if not isinstance(tool.method, _METHODS):
        allowed = ", ".join(one.__name__ for one in _METHODS)
        raise _fault(f"method {type(tool.method).__name__}, not {allowed}", path, 1)
    try:
        parameters_of(tool.parameters)
        tool.parameters()
    except (TypeError, KeyError) as error:
        raise _fault_of(error, path) from error
    return tool


def _guarded(tool: Tool, path: Path) -> Tool:
    """The same tool whose faults are told as its own, and whose loops can be cancelled."""
    method: Any = tool.method  # one of several dataclasses with one function each
    functions = {
        one.name: _watched(getattr(method, one.name), path)
        for one in fields(method)
        if callable(getattr(method, one.name))
    }
    return replace(tool, method=replace(method, **functions))


def _watched(function: Callable[..., Any], path: Path) -> Callable[..., Any]:
    def watched(*arguments: Any) -> Any:  # as the function
        monitor = next(one for one in arguments if callable(getattr(one, "check", None)))
        before = sys.gettrace()
        sys.settrace(_Watch(monitor, str(path)).entered)
        try:
            return function(*arguments)
        except (UserError, Cancelled):
            raise
        except Exception as error:
            raise _fault_of(error, path) from error
        finally:
            sys.settrace(before)

    return watched


class _Watch:
    """Asks whether to stop while lines of one file run, however they loop."""

    def __init__(self, monitor: Monitor, file: str) -> None:
        self._monitor = monitor
        self._file = file
        self._asked_s = time.monotonic()

    def entered(self, frame: FrameType, _event: str, _value: object) -> Any:  # Python's protocol
        """Follow the lines of the plug-in's own functions."""
        if frame.f_code.co_filename != self._file:
            return None
        # An empty loop passes no line: instructions tell of every one.
        frame.f_trace_opcodes = True
        return self._passed(frame, "", None)

    def _passed(self, _frame: FrameType, _event: str, _value: object) -> Any:  # as above
        now = time.monotonic()
        if now > self._asked_s + _CHECK_S:
            self._asked_s = now
            self._monitor.check()
        return self._passed


def _fault_of(error: Exception, path: Path) -> PluginFault:
    """What was raised, at the last line of the plug-in that led to it."""
    lines = [
        one.lineno or 1
        for one in traceback.extract_tb(error.__traceback__)
        if one.filename == str(path)
    ]
    return _fault(f"{type(error).__name__}: {error}", path, lines[-1] if lines else 1)


def _fault(reason: str, path: Path, line: int) -> PluginFault:
    said = " ".join(reason.split())[:200]
    what = Text(f"A plug-in failed: {said}.", f"プラグインでエラーが発生しました（{said}）。")
    return PluginFault(what, _place(path, line), _REMEDY)


def _place(path: Path, line: int) -> Text:
    return Text(f"{path}, line {line}", f"{path}、{line}行目")
