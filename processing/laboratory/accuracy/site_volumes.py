"""Volumes of earthwork sites against exact truth, and methods on a body whose volume is known.

``python -m processing.laboratory.accuracy.site_volumes --samples FOLDER --markdown
docs/accuracy.md`` simulates sites of seeds that nobody looked at, finds their ground as it comes,
and compares both dates. ``--samples`` adds deliveries with ``truth/``; ``--kept`` keeps what was
simulated in a folder.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

import numpy as np
import shapely

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.known_body import BODY_ABOUT, BODY_HEADING, body_rows
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.site import DATES, simulate_site
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.ground import GROUND_TOOL
from processing.tools.run_shares import mark_all

HEADING = "## Earthwork volumes"
SEEDS = range(1114, 1138)
_STYLES = ("levee", "cutting", "pad")
_SENSORS = ("p40", "vz400i", "zf5016", "p40")
_WORTH = 0.05
_ABOUT = (
    "`python -m processing.laboratory.accuracy.site_volumes --markdown docs/accuracy.md` "
    "simulates sites of "
    "60 m of seeds that nobody looked at, finds the ground of both dates with the tool "
    "`ground` as it comes, and compares them within the site's boundary in cells of {mesh:g} m. "
    "Measured: cut and fill where both dates have points, against the true surfaces over the same "
    "cells; beside it the plain sums of what is positive and negative. Whole: all "
    "of the site with holes filled, against the exact truth; net as a share of what was moved "
    "(cut and fill together). Inside: whether cut, fill and net lie within the stated uncertainty. "
    "The last rows leave out cut or fill of less than 5 % of what was moved."
)
_HEAD = (
    "site", "moved (m³)", "without data (m²)", "measured cut", "measured fill", "plain cut",
    "plain fill", "whole cut", "whole fill", "net of moved", "stated ± (m³)", "± of moved",
    "inside",
)  # fmt: skip


@dataclass(frozen=True)
class ScoredSite:
    """A site's volumes beside the true ones.

    Attributes
    ----------
    truth : mapping
        Of ``volume.json``.
    measured, plain : (float, float)
        Cut and fill over cells that both dates measured, m³: ours, and as plain sums.
    true_measured : (float, float)
        The true ones over these cells.
    """

    name: str
    truth: dict[str, float]
    result: VolumeResult
    measured: tuple[float, float]
    plain: tuple[float, float]
    true_measured: tuple[float, float]

    @property
    def moved_m3(self) -> float:
        """Cut and fill together, truly."""
        return self.truth["cut_m3"] + self.truth["fill_m3"]

    @property
    def is_inside(self) -> bool:
        """Whether the truth lies within what was stated, cut, fill and net each."""
        volumes = self.result.volumes
        told = (volumes.cut_m3, volumes.fill_m3, volumes.net_m3)
        gaps = [
            abs(one - self.truth[name])
            for one, name in zip(told, ("cut_m3", "fill_m3", "net_m3"), strict=True)
        ]
        return max(gaps) <= volumes.uncertainty_m3

    @property
    def net_off(self) -> float:
        """Error of the net volume as a share of what was moved."""
        return (self.result.volumes.net_m3 - self.truth["net_m3"]) / self.moved_m3


def score_site(name: str, folder: Path, parameters: VolumeParameters) -> ScoredSite:
    """Compare both dates of a delivery with its truth.

    Raises
    ------
    UserError
        A file can't be read.
    """
    truth = json.loads((folder / "truth" / "volume.json").read_text("utf-8"))
    boundary = shapely.Polygon(truth["polygon"])
    monitor = SilentMonitor()
    with tempfile.TemporaryDirectory() as scratch:
        before, after = (
            ground_of_drives(_with_ground(folder / "in" / f"{date}.laz", Path(scratch)), monitor)
            for date in DATES
        )
        result = compare(before, after, parameters, monitor, VolumeScope(boundary))
    change = result.change
    counted = change.is_measured & (change.inside > 0)
    own = np.where(counted, change.change_m * change.inside, 0.0) * change.grid.size_m**2
    true_cut, true_fill = _true_sums(folder, change, boundary)
    return ScoredSite(
        name,
        truth,
        result,
        (result.volumes.measured_cut_m3, result.volumes.measured_fill_m3),
        (-float(own[own < 0].sum()), float(own[own > 0].sum())),
        (float(true_cut[counted].sum()), float(true_fill[counted].sum())),
    )


def _with_ground(cloud: Path, scratch: Path) -> tuple[Drive, ...]:
    """A cloud's drives, ground found by the tool as it comes."""
    folders = import_drives(ImportRequest(inputs=(cloud,)), scratch / cloud.stem, SilentMonitor())
    drives = tuple(Drive(folder) for folder in folders)
    mark_all(GROUND_TOOL.id, drives, SilentMonitor(), into=scratch / f"{cloud.stem}-said")
    return drives


def _true_sums(folder: Path, change: ChangeGrid, boundary: shapely.Geometry) -> tuple[Floats, ...]:
    """True cut and fill of each cell within the boundary, m³, over the truth's own fine cells."""
    before, after = (np.load(folder / "truth" / f"terrain_{date}.npz") for date in DATES)
    z = after["z"].astype(np.float64) - before["z"]
    # Two triangles from the lower left to the upper right node: the mean height of a cell.
    middle = (z[:-1, :-1] + z[1:, 1:]) / 3 + (z[1:, :-1] + z[:-1, 1:]) / 6
    res = float(before["res"])
    x = float(before["x0"]) + (np.arange(middle.shape[1]) + 0.5) * res
    y = float(before["y0"]) + (np.arange(middle.shape[0]) + 0.5) * res
    grid = change.grid
    column = np.floor((x - grid.origin[0]) / grid.size_m).astype(np.int64)
    row = np.floor((y - grid.origin[1]) / grid.size_m).astype(np.int64)
    east, north = np.meshgrid(x, y)
    in_grid = (
        (row >= 0)[:, None] & (row < grid.rows)[:, None] & (column >= 0) & (column < grid.columns)
    )
    inside = in_grid & shapely.contains_xy(boundary, east, north)
    cells = (row[:, None] * grid.columns + column)[inside]
    volumes = middle[inside] * res**2
    shape = (grid.rows, grid.columns)
    sums: list[Floats] = [
        np.bincount(cells, np.maximum(sign * volumes, 0.0), shape[0] * shape[1]).astype(np.float64)
        for sign in (-1.0, 1.0)
    ]
    return tuple(one.reshape(shape) for one in sums)


def simulated_sites(seeds: Sequence[int], kept: Path | None) -> Iterator[tuple[str, Path]]:
    """Deliveries of seeds, each made when it is asked for; a folder that has one stays.

    Without a folder to keep them in each is gone when the next is asked for.
    """
    with _folder(kept) as root:
        for number, seed in enumerate(seeds):
            style = _STYLES[number % len(_STYLES)]
            sensor = _SENSORS[number % len(_SENSORS)]
            folder = root / f"{style}_{sensor}_{seed}"
            if not folder.exists():
                options = SiteRequest(seed=seed, style=style, sensor=sensor)
                simulate_site(options, folder, SilentMonitor())
            yield f"{style}, {sensor}, {seed}", folder
            if kept is None:
                shutil.rmtree(folder)


@contextmanager
def _folder(kept: Path | None) -> Iterator[Path]:
    if kept is not None:
        yield kept
        return
    with tempfile.TemporaryDirectory() as folder:
        yield Path(folder)


def rows_of(sites: Sequence[ScoredSite]) -> list[list[str]]:
    """A table of sites, and what they are together."""
    rows = [list(_HEAD), *(_row(site) for site in sites)]
    measured = np.array([_offs(site.measured, site.true_measured) for site in sites])
    plain = np.array([_offs(site.plain, site.true_measured) for site in sites])
    whole = np.array([_offs(_cut_fill(site), _true(site)) for site in sites])
    net = np.array([site.net_off for site in sites])
    stated = np.array([_read_stated_volume(site) for site in sites])
    # A share of next to nothing says nothing: half a cubic metre on a site of a thousand.
    worth = np.array([[part >= _WORTH * site.moved_m3 for part in _true(site)] for site in sites])
    columns = [
        one[held]
        for kind in (measured, plain, whole)
        for one, held in zip(kind.T, worth.T, strict=True)
    ]
    columns.append(net)
    spread = [_percent_of(one, lambda off: float(np.sqrt(np.mean(off**2)))) for one in columns]
    middle = [_percent_of(one, lambda off: float(np.median(np.abs(off)))) for one in columns]
    inside = f"{sum(site.is_inside for site in sites)} of {len(sites)}"
    share = f"{100 * np.median(stated):.1f} %"
    rows.append(["median", "", "", *middle, "", share, inside])
    rows.append(["root mean square", "", "", *spread, "", "", ""])
    near = [f"{int((np.abs(one) <= 0.02).sum())} of {len(one)}" for one in columns]
    rows.append(["within 2 %", "", "", *near, "", "", ""])
    return rows


def _percent_of(offs: Floats, told: Callable[[Floats], float]) -> str:
    return f"{100 * told(offs):.1f} %" if offs.size else "–"


def _row(site: ScoredSite) -> list[str]:
    volumes = site.result.volumes
    shares = [
        *_offs(site.measured, site.true_measured),
        *_offs(site.plain, site.true_measured),
        *_offs(_cut_fill(site), _true(site)),
        site.net_off,
    ]
    return [
        site.name,
        f"{site.moved_m3:,.0f}",
        f"{volumes.unmeasured_area_m2:,.0f} of {volumes.area_m2:,.0f}",
        *(f"{100 * share:+.1f} %" for share in shares),
        f"{volumes.uncertainty_m3:.1f}",
        f"{100 * _read_stated_volume(site):.1f} %",
        "yes" if site.is_inside else "no",
    ]


def _offs(told: tuple[float, float], true: tuple[float, float]) -> tuple[float, float]:
    return told[0] / true[0] - 1.0, told[1] / true[1] - 1.0


def _cut_fill(site: ScoredSite) -> tuple[float, float]:
    return site.result.volumes.cut_m3, site.result.volumes.fill_m3


def _true(site: ScoredSite) -> tuple[float, float]:
    return site.truth["cut_m3"], site.truth["fill_m3"]


def _read_stated_volume(site: ScoredSite) -> float:
    return site.result.volumes.uncertainty_m3 / site.moved_m3


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the tables to a page, or to standard output."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--seeds", type=int, nargs="*", default=list(SEEDS))
    parser.add_argument("--kept", type=Path)
    parser.add_argument("--mesh", type=float, default=VolumeParameters().grid_m)
    options = parser.parse_args(arguments)
    parameters = VolumeParameters(grid_m=options.mesh)
    scenes = [(folder.name, folder) for folder in options.samples]
    sites = []
    for name, folder in chain(scenes, simulated_sites(options.seeds, options.kept)):
        sites.append(score_site(name, folder, parameters))
        sys.stderr.write(f"{' | '.join(_row(sites[-1]))}\n")
    sections = {
        HEADING: (_ABOUT.format(mesh=options.mesh), rows_of(sites)),
        BODY_HEADING: (BODY_ABOUT, body_rows()),
    }
    tables = {
        head: f"{about}\n\n{markdown_table(rows)}" for head, (about, rows) in sections.items()
    }
    write_sections(options.markdown, tables)
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
