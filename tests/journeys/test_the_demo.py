"""The README's main command: what it promises lies in the folder and can be read."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from pathlib import Path

import cv2
import ezdxf
import numpy as np
import pyogrio

_LONGEST_S = 280


def test_the_demo_does_the_main_job_and_leaves_what_the_readme_promises(tmp_path: Path) -> None:
    out = tmp_path / "出力"
    ended = subprocess.run(
        [sys.executable, "-m", "app", "demo", "--headless", "--out", str(out)],
        capture_output=True,
        text=True,
        encoding="utf-8",
        env={**os.environ, "ZUKA_LANGUAGE": "ja"},
        timeout=_LONGEST_S,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr[-2_000:]
    assert "地物を作図しました" in ended.stdout
    drawing = ezdxf.readfile(out / "export" / "sample_street.dxf")
    assert not drawing.audit().has_errors
    assert len(drawing.modelspace()) > 0
    layers = pyogrio.list_layers(out / "export" / "sample_street.gpkg")
    assert len(layers) > 0
    with (out / "export" / "features.csv").open(encoding="utf-8-sig", newline="") as file:
        assert len(list(csv.reader(file))) > 1
    for picture in (out / "window.png", *(out / "images").glob("*.png")):
        # imread takes no Japanese paths on Windows.
        pixels = cv2.imdecode(np.fromfile(picture, np.uint8), cv2.IMREAD_COLOR)
        assert pixels is not None
        assert pixels.std() > 1.0
    assert len(list((out / "images").glob("*.png"))) > 8
