"""Jobs and deliveries for tests: small clouds in folders, and a file that names them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.delivered_files import make_las

HEAD = 'deliveries = ["drives/*"]\noutput = "out"\nworkers = 2\n'
IMPORT = '[[steps]]\nkind = "import"\n'
NOISE = '[[steps]]\nkind = "run"\ntool = "noise"\noutput = "noise.las"\n'
NOISE_OF_TWO = f"{NOISE}parameters.neighbours = 2\n"
EXPORT = '[[steps]]\nkind = "export"\nrequest.formats = ["las"]\nrequest.candidates = true\n'


def write_job(folder: Path, text: str = HEAD + IMPORT + NOISE) -> Path:
    """A job's file."""
    path = folder / "job.toml"
    path.write_text(text, encoding="utf-8")
    return path


def deliver(folder: Path, names: Sequence[str]) -> None:
    """Folders below ``drives`` with a cloud each; no two are alike."""
    for number, name in enumerate(names):
        into = folder / "drives" / name
        into.mkdir(parents=True)
        make_las(into / "cloud.las", count=300 + number)
