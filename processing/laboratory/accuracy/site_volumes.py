"""Volumes of earthwork sites against exact truth, and methods on a body whose volume is known.

``python -m processing.laboratory.accuracy.site_volumes --samples FOLDER... --markdown
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
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.known_body import BODY_ABOUT, BODY_HEADING, body_rows
from processing.laboratory.simulate.requests import SiteRequest
from processing.laboratory.simulate.site import DATES, simulate_site
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.surfaces.epoch_ground import ground_of_drives
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.tools.ground import GROUND_TOOL
from processing.tools.running.run_shares import mark_all

Floats = NDArray[np.float64]

HEADING = "## Earthwork volumes"
SEEDS = range(1140, 1156)
_STYLES = ("levee", "cutting", "pad", "hillside")
_SENSORS = ("p40", "vz400i", "zf5016", "p40", "zf5016")
_LENGTHS_M = (90.0, 120.0, 60.0, 150.0, 105.0, 135.0)
_SPACING_M = 0.06
_CM = 100
_ABOUT = (
    "`python -m processing.laboratory.accuracy.site_volumes --samples FOLDER... --markdown "
    "docs/accuracy.md` simulates sites of 60 to 150 m of seeds that nobody looked at, with a point "
    "every {spacing:g} cm 10 m from a scanner, finds the ground of both dates with the tool "
    "`ground` as it comes, and compares them within the site's boundary in cells of {mesh:g} m. "
    "All errors of volumes are shares of what was moved, cut and fill together: of a cut of a "
    "cubic metre on a site of a thousand a share of its own says nothing. Measured: cut and fill "
    "where both dates have points, against the true surfaces over the same cells. Whole: all of "
    "the site, what was hidden filled in, against the exact truth, what was left out included. "
    "Hidden ground: by how much the filled ground of each date lies too high in the mean. Inside: "
    "whether cut, fill and net lie within the stated uncertainty. Development seeds, which chose "
    "what was to be chosen, are others (2301 to 2314, 2401 to 2414)."
)
_HEAD = (
    "site", "moved (m³)", "area (m²)", "not measured", "left out (m²)", "measured cut",
    "measured fill", "whole cut", "whole fill", "whole net", "hidden ground before (cm)",
    "after (cm)", "stated ±", "inside",
)  # fmt: skip


@dataclass(frozen=True)
class ScoredSite:
    """A site's volumes beside the true ones.

    Attributes
    ----------
    truth : mapping
        Of ``volume.json``.
    true_measured : (float, float)
        True cut and fill over cells that both dates measured, m³.
    bias_m : (float, float)
        By how much filled ground of each date lies too high in the mean; NaN where none was.
    """

    name: str
    truth: dict[str, float]
    result: VolumeResult
    true_measured: tuple[float, float]
    bias_m: tuple[float, float]

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
    def errors(self) -> tuple[float, ...]:
        """Measured cut and fill, whole cut, fill and net: errors as shares of what was moved."""
        volumes, truth = self.result.volumes, self.truth
        gaps = (
            volumes.measured_cut_m3 - self.true_measured[0],
            volumes.measured_fill_m3 - self.true_measured[1],
            volumes.cut_m3 - truth["cut_m3"],
            volumes.fill_m3 - truth["fill_m3"],
            volumes.net_m3 - truth["net_m3"],
        )
        return tuple(gap / self.moved_m3 for gap in gaps)

    @property
    def stated(self) -> float:
        """The stated uncertainty as a share of what was moved."""
        return self.result.volumes.uncertainty_m3 / self.moved_m3


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
    true_cut, true_fill = _true_sums(folder, change, boundary)
    return ScoredSite(
        name,
        truth,
        result,
        (float(true_cut[counted].sum()), float(true_fill[counted].sum())),
        _biases(folder, change),
    )


def _with_ground(cloud: Path, scratch: Path) -> tuple[Drive, ...]:
    """A cloud's drives, ground found by the tool as it comes."""
    folders = import_drives(ImportRequest(inputs=(cloud,)), scratch / cloud.stem, SilentMonitor())
    drives = tuple(Drive(folder) for folder in folders)
    mark_all(GROUND_TOOL.id, drives, SilentMonitor(), into=scratch / f"{cloud.stem}-said")
    return drives


def _biases(folder: Path, change: ChangeGrid) -> tuple[float, float]:
    """How far filled ground of each date lies above the true one in the mean, m."""
    grid = change.grid
    row, column = np.nonzero((change.inside > 0) & ~change.is_measured)
    x, y = (np.stack([column, row]) + 0.5) * grid.size_m + grid.origin[:2, None]
    means = []
    for date, heights in zip(DATES, (change.before, change.after), strict=True):
        terrain = np.load(folder / "truth" / f"terrain_{date}.npz")
        truth = HeightGrid(terrain["z"], float(terrain["res"]))
        off = heights[row, column] + grid.origin[2]
        off = off - truth.height(x - float(terrain["x0"]), y - float(terrain["y0"]))
        known = off[np.isfinite(off)]
        means.append(float(known.mean()) if known.size else float("nan"))
    return means[0], means[1]


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
            length_m = _LENGTHS_M[number % len(_LENGTHS_M)]
            folder = root / f"{style}_{sensor}_{seed}"
            if not folder.exists():
                options = SiteRequest(
                    seed=seed,
                    style=style,
                    sensor=sensor,
                    length_m=length_m,
                    spacing_m=_SPACING_M,
                )
                simulate_site(options, folder, SilentMonitor())
            yield f"{style}, {length_m:g} m, {sensor}, {seed}", folder
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
    errors = np.array([site.errors for site in sites])
    biases = np.array([site.bias_m for site in sites])
    stated = np.array([site.stated for site in sites])
    inside = f"{sum(site.is_inside for site in sites)} of {len(sites)}"
    for name, told in _TOGETHER.items():
        row = [name, "", "", "", ""]
        row += [f"{100 * told(one):.1f} %" for one in np.abs(errors).T]
        row += [f"{_CM * told(one):.1f}" for one in np.abs(biases).T]
        rows.append([*row, f"{100 * told(stated):.1f} %", inside])
    return rows


def _root_mean_square(values: Floats) -> float:
    return float(np.sqrt(np.nanmean(np.square(values))))


_TOGETHER: dict[str, Callable[[Floats], float]] = {
    "median": lambda values: float(np.nanmedian(values)),
    "root mean square": _root_mean_square,
    "worst": lambda values: float(np.nanmax(values)),
}


def _row(site: ScoredSite) -> list[str]:
    volumes = site.result.volumes
    return [
        site.name,
        f"{site.moved_m3:,.0f}",
        f"{volumes.area_m2:,.0f}",
        f"{100 * volumes.unmeasured_area_m2 / volumes.area_m2:.0f} %",
        f"{volumes.left_out_area_m2:,.0f}",
        *(f"{100 * share:+.1f} %" for share in site.errors),
        *(f"{_CM * bias:+.1f}" for bias in site.bias_m),
        f"{100 * site.stated:.1f} %",
        "yes" if site.is_inside else "no",
    ]


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
        HEADING: (_ABOUT.format(mesh=options.mesh, spacing=_CM * _SPACING_M), rows_of(sites)),
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
