"""Training of the image network, and its intermediate features at points.

torch is asked for only when a network is made or used: the rest runs without the extra ``train``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.laboratory.class_training.image_network.augmenting import LearntImage, random_crop
from processing.laboratory.class_training.image_network.street_rasters import (
    CHANNELS,
    StreetRaster,
)
from processing.laboratory.class_training.image_network.tiles import (
    at_pixels,
    cut_out,
    tiles_of,
)

CLASSES = (3, 4, 5, 6, 11, 14, 64, 65, 66, 67)
"""The thesis' ten (section 4.2): ground and road are one."""

_GROUND, _ROAD = 2, 11

_ABSOLUTE = "height"
"""Belongs to the place that was learnt from: with it forests lose half of F elsewhere."""

IMAGE_CHANNELS = tuple(at for at, name in enumerate(CHANNELS) if name != _ABSOLUTE)

_FARTHEST = 5.0
"""Spreads from the middle of a channel beyond which nothing is told apart."""

_NORMAL_QUARTERS = 1.349
"""Between the quartiles of a normal distribution of spread 1."""

_SAMPLE = 20_000
"""Pixels of a street that the middle and spread of its channels are taken of."""

_RATE, _DECAY, _POWER = 1e-3, 1e-4, 0.9
"""AdamW; the rate falls by the power of what is left to do (Chen et al. 2018, “poly”)."""

_BATCH = 4

_FIRST_LAYER = "low.0.weight"
"""Of `DeepLab`: its second axis are the channels of the image."""


@dataclass(frozen=True)
class ChannelScale:
    """Middle and spread of each channel, (channels,) float32.

    Channels are `IMAGE_CHANNELS`, and red, green and blue where rasters have them.
    """

    middle: NDArray[np.float32]
    spread: NDArray[np.float32]

    @staticmethod
    def of(rasters: Sequence[StreetRaster]) -> ChannelScale:
        """By median and quartiles of the filled pixels of streets, each street as much."""
        rng = np.random.default_rng(0)
        parts = []
        for one in rasters:
            rows, columns = np.nonzero(one.filled)
            some = rng.integers(rows.size, size=_SAMPLE)
            at = rows[some], columns[some]
            own = one.values[:, *at][list(_channels_of(one))]
            if one.is_coloured:
                own[len(IMAGE_CHANNELS) :, ~one.is_seen[at]] = np.nan
            parts.append(own)
        quarters = np.stack([_quarters(one) for one in np.concatenate(parts, axis=1)], axis=1)
        spread = np.maximum((quarters[2] - quarters[0]) / _NORMAL_QUARTERS, 1e-3)
        return ChannelScale(quarters[1].astype(np.float32), spread.astype(np.float32))

    def image_of(self, raster: StreetRaster) -> LearntImage:
        """A street with its channels scaled, and masks: of colours, and last of filled pixels."""
        channels = _channels_of(raster)
        masks = [raster.is_seen, raster.filled] if raster.is_coloured else [raster.filled]
        values = np.zeros((len(channels) + len(masks), *raster.filled.shape), np.float16)
        for at, channel in enumerate(channels):
            own = raster.values[channel].astype(np.float32)
            scaled = np.clip((own - self.middle[at]) / self.spread[at], -_FARTHEST, _FARTHEST)
            values[at] = np.where(masks[-1] if at < len(IMAGE_CHANNELS) else masks[0], scaled, 0)
        values[len(channels) :] = masks
        return LearntImage(values, targets_of(raster.codes))


def _channels_of(raster: StreetRaster) -> tuple[int, ...]:
    """Those that are scaled."""
    colours = range(len(CHANNELS), raster.values.shape[0])
    return (*IMAGE_CHANNELS, *colours[:-1])  # the last one is a mask


def _quarters(values: NDArray[np.float16]) -> Floats:
    """(3,) a quarter, the half and three quarters of a channel; 0 where nothing is known."""
    known = values[~np.isnan(values)]
    return np.percentile(known, (25, 50, 75)) if known.size else np.zeros(3)


def targets_of(codes: NDArray[np.uint8]) -> NDArray[np.int16]:
    """Numbers of classes in `CLASSES`; −1 for all others."""
    number_of = np.full(256, -1, np.int16)
    number_of[list(CLASSES)] = np.arange(len(CLASSES))
    number_of[_GROUND] = number_of[_ROAD]
    numbers: NDArray[np.int16] = number_of[codes]
    return numbers


# torch is an extra; what it gives has no types where it is missing.
def train_network(
    images: Sequence[LearntImage],
    steps: int,
    say: Callable[[str], None],
    start: Any = None,
) -> Any:
    """A network that learnt from random crops of streets.

    Parameters
    ----------
    steps : int
        Batches of four crops.
    start : DeepLab, optional
        A network that goes on learning; else one that knows nothing.
    """
    import torch
    from torch.nn import functional

    from processing.laboratory.class_training.image_network.deeplab import DeepLab

    torch.manual_seed(0)
    rng = np.random.default_rng(0)
    network = DeepLab(images[0].values.shape[0], len(CLASSES)) if start is None else start
    network.to(memory_format=torch.channels_last).train()
    weights = torch.from_numpy(_weights(images))
    optimizer = torch.optim.AdamW(network.parameters(), _RATE, weight_decay=_DECAY)
    schedule = torch.optim.lr_scheduler.PolynomialLR(optimizer, steps, _POWER)
    losses = []
    for step in range(steps):
        crops = [random_crop(images[int(rng.integers(len(images)))], rng) for _ in range(_BATCH)]
        values = torch.from_numpy(np.stack([one for one, _ in crops]))
        targets = torch.from_numpy(np.stack([one for _, one in crops]))
        scores = network(values.contiguous(memory_format=torch.channels_last))
        loss = functional.cross_entropy(scores, targets, weights, ignore_index=-1)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        losses.append(float(loss.detach()))
        if (step + 1) % 50 == 0:
            say(f"step {step + 1} of {steps}: loss {np.mean(losses[-50:]):.3f}")
    return network


def _weights(images: Sequence[LearntImage]) -> NDArray[np.float32]:
    """One over the root of a class's share: between as frequent as it is and all alike."""
    counts = np.zeros(len(CLASSES))
    for one in images:
        counts += np.bincount(one.targets[one.targets >= 0], minlength=len(CLASSES))
    weights = 1 / np.sqrt(np.maximum(counts, 1) / counts.sum())
    weights[counts == 0] = 0
    scaled: NDArray[np.float32] = (weights / weights[counts > 0].mean()).astype(np.float32)
    return scaled


def intermediate_features(
    network: Any, image: LearntImage, rows: Integers, columns: Integers
) -> NDArray[np.float32]:
    """(n, 256) what the network holds before classes at pixels; 0 at column −1."""
    import torch

    from processing.laboratory.class_training.image_network.deeplab import FEATURES

    network.eval()
    found = np.zeros((rows.size, FEATURES), np.float32)
    for tile in tiles_of(*image.targets.shape):
        is_own = (rows >= tile.own_rows.start) & (rows < tile.own_rows.stop)
        is_own &= (columns >= tile.own_columns.start) & (columns < tile.own_columns.stop)
        own = np.flatnonzero(is_own)
        if not own.size:
            continue
        with torch.no_grad():
            values = torch.from_numpy(cut_out(image.values, tile))[None]
            coarse = network.features(values.contiguous(memory_format=torch.channels_last))[0]
        found[own] = at_pixels(coarse.numpy(), rows[own] - tile.row, columns[own] - tile.column)
    return found


def write_network(network: Any, scale: ChannelScale, path: Path) -> None:
    """Keep a network with the scale of its channels."""
    import torch

    torch.save(
        {
            "network": network.state_dict(),
            "middle": torch.from_numpy(scale.middle),
            "spread": torch.from_numpy(scale.spread),
        },
        path,
    )


def read_network(path: Path) -> tuple[Any, ChannelScale]:
    """What :func:`write_network` kept."""
    import torch

    from processing.laboratory.class_training.image_network.deeplab import DeepLab

    kept = torch.load(path, weights_only=True)
    channels = kept["network"][_FIRST_LAYER].shape[1]
    network = DeepLab(channels, len(CLASSES))
    network.load_state_dict(kept["network"])
    return network, ChannelScale(kept["middle"].numpy(), kept["spread"].numpy())
