"""The local and the global block in torch, and the whole-patch network beside them.

Layers are convolution or shared layer, ReLU, batch norm, dropout, in the order that is published.
The layer over a waveform doesn't depend on the neighbourhood, so it runs once a point; the layer
over a member's features and offset is linear before its ReLU, so features are mapped once a point,
too, and members gather what is mapped. Batch norm of a neighbourhood follows the greatest.

References
----------
Shinohara 2022, section 3.3; Qi et al. 2017, “PointNet” (the whole-patch network of table B.1).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import torch
from torch import Tensor, nn

from processing.laboratory.waveform_networks.neighbourhoods import PatchLevel
from processing.laboratory.waveform_networks.sizes import CLASSES, SAMPLES, NetworkSizes

POOLED = 4
"""Two poolings of two: 40 positions of 160."""


class LocalBlock(nn.Module):  # type: ignore[misc]  # torch is an extra: it may be untyped here
    """Scores of classes by each waveform alone."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        first, second, third = sizes.maps
        drop = sizes.inner_dropout
        self.layers = nn.Sequential(
            *_over_time(1, first, drop),
            nn.MaxPool1d(2),
            *_over_time(first, second, drop),
            nn.MaxPool1d(2),
            *_over_time(second, third, 0.0),
        )
        self.drop = nn.Dropout(sizes.dropout)
        self.classes = nn.Linear(third * (SAMPLES // POOLED), CLASSES)

    def forward(self, _: Tensor, waves: Tensor, _levels: Sequence[PatchLevel]) -> Tensor:
        """(k, 6) scores of (k, 160) waveforms."""
        return self.classes(self.drop(self.layers(waves[:, None]).flatten(1)))


class CoordinateBlock(nn.Module):  # type: ignore[misc]  # as above
    """Scores by each point's coordinates alone: what is left of the local block without waves."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        widths = (3, *sizes.maps)
        steps = itertools.pairwise(widths)
        self.layers = nn.Sequential(*(_shared(into, out) for into, out in steps))
        self.drop = nn.Dropout(sizes.dropout)
        self.classes = nn.Linear(widths[-1], CLASSES)

    def forward(self, xyz: Tensor, _: Tensor, _levels: Sequence[PatchLevel]) -> Tensor:
        """(k, 6) scores of (k, 3) coordinates."""
        return self.classes(self.drop(self.layers(xyz)))


class _WaveFeatures(nn.Module):  # type: ignore[misc]  # as above
    """A vector of maps for each waveform."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        hidden, maps = sizes.hidden_maps, sizes.maps[0]
        self.layers = nn.Sequential(
            *_over_time(1, hidden, 0.0), nn.MaxPool1d(2), *_over_time(hidden, maps, 0.0)
        )

    def forward(self, waves: Tensor) -> Tensor:
        return self.layers(waves[:, None]).amax(2)


class GlobalBlock(nn.Module):  # type: ignore[misc]  # as above
    """Scores by neighbourhoods of neighbourhoods, with waveforms or without."""

    def __init__(self, sizes: NetworkSizes, *, sees_waves: bool) -> None:
        super().__init__()
        first, second, third = sizes.maps
        self.waves = _WaveFeatures(sizes) if sees_waves else None
        told = 3 + (first if sees_waves else 0)
        # Radii are metres; so much of them are one unit of what layers see.
        self.reach_m = sizes.radii_m
        into = (told, first, second)
        self.features = nn.ModuleList(
            nn.Linear(one, out) for one, out in zip(into, sizes.maps, strict=True)
        )
        self.offsets = nn.ModuleList(nn.Linear(3, out, bias=False) for out in sizes.maps)
        self.norms = nn.ModuleList(nn.BatchNorm1d(out) for out in sizes.maps)
        self.decoder = nn.ModuleList(
            [_shared(third + second, third), _shared(third + first, second)]
        )
        self.last = _shared(second + told, first)
        self.drop = nn.Dropout(sizes.dropout)
        self.classes = nn.Linear(first, CLASSES)

    def forward(self, xyz: Tensor, waves: Tensor, levels: Sequence[PatchLevel]) -> Tensor:
        """(k, 6) scores of a patch's points."""
        told = xyz / self.reach_m[-1]
        if self.waves is not None:
            told = torch.cat([told, self.waves(waves)], 1)
        kept = [told]
        for number, level in enumerate(levels):
            kept.append(self._encoded(number, kept[-1], level))
        found = kept[-1]
        steps = (*self.decoder, self.last)
        for layer, level, skipped in zip(steps, levels[::-1], kept[-2::-1], strict=True):
            found = layer(torch.cat([_interpolated(found, level), skipped], 1))
        return self.classes(self.drop(found))

    def _encoded(self, number: int, before: Tensor, level: PatchLevel) -> Tensor:
        mapped = self.features[number](before)
        members = _on(level.members, mapped)
        offsets = _on(level.offsets, mapped) / self.reach_m[number]
        found = (mapped[members] + self.offsets[number](offsets)).relu().amax(1)
        return self.norms[number](found)


class WholePatch(nn.Module):  # type: ignore[misc]  # as above
    """PointNet's way: each point alone, and the greatest of all points beside it."""

    def __init__(self, sizes: NetworkSizes) -> None:
        super().__init__()
        first, second, third = sizes.maps
        self.reach_m = sizes.radii_m[-1]
        self.waves = _WaveFeatures(sizes)
        self.near = _shared(3 + first, first)
        self.far = nn.Sequential(_shared(first, second), _shared(second, third))
        self.last = nn.Sequential(_shared(first + third, second), _shared(second, first))
        self.drop = nn.Dropout(sizes.dropout)
        self.classes = nn.Linear(first, CLASSES)

    def forward(self, xyz: Tensor, waves: Tensor, _levels: Sequence[PatchLevel]) -> Tensor:
        """(k, 6) scores of a patch's points."""
        near = self.near(torch.cat([xyz / self.reach_m, self.waves(waves)], 1))
        whole = self.far(near).amax(0, keepdim=True).expand(len(near), -1)
        return self.classes(self.drop(self.last(torch.cat([near, whole], 1))))


def _over_time(into: int, out: int, drop: float) -> list[nn.Module]:
    layers = [nn.Conv1d(into, out, 3, padding=1), nn.ReLU(), nn.BatchNorm1d(out)]
    return [*layers, nn.Dropout(drop)] if drop else layers


def _shared(into: int, out: int) -> nn.Sequential:
    return nn.Sequential(nn.Linear(into, out), nn.ReLU(), nn.BatchNorm1d(out))


def _interpolated(values: Tensor, level: PatchLevel) -> Tensor:
    weights = _on(level.weights, values)
    return (values[_on(level.nearest, values)] * weights[..., None]).sum(1)


# Any: what torch gives has no types where it is missing.
def _on(values: Any, like: Tensor) -> Tensor:
    return torch.from_numpy(values).to(like.device)
