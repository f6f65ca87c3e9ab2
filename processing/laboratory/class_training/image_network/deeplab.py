"""DeepLabv3+ on MobileNetV2, for any number of channels, for CPUs.

The thesis names the network, not what it stands on, and didn't train it before; MobileNetV2 is the
smallest of those that its authors offer, and the only one that learns here within the hour.

References
----------
Chen et al. 2018, “Encoder-Decoder with Atrous Separable Convolution for Semantic Image
Segmentation”, ECCV; Sandler et al. 2018, “MobileNetV2: Inverted Residuals and Linear Bottlenecks”,
CVPR, table 2.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

FEATURES = 256
"""Channels before the layer that maps to classes (Takahashi 2022, section 4.6.2)."""

_LOW = 48
"""Channels of the finer image that the decoder joins (Chen et al., section 4.1)."""

_RATES = (6, 12, 18)
"""Of the atrous convolutions where the encoder has a sixteenth of the pixels (Chen et al.)."""

_STEM = 32
_STAGES = (
    (1, 16, 1, 1, 1),
    (6, 24, 2, 2, 1),
    (6, 32, 3, 2, 1),
    (6, 64, 4, 2, 1),
    (6, 96, 3, 1, 1),
    (6, 160, 3, 1, 2),
    (6, 320, 1, 1, 2),
)
"""Expansion, channels, blocks, stride of the first, and rate: table 2 of Sandler et al., with the
last stride made a rate, so that a sixteenth of the pixels stays."""

_LOW_STAGES = 2
"""Stages whose output, a quarter of the pixels, the decoder joins."""


class DeepLab(nn.Module):  # type: ignore[misc]  # torch is an extra: it may be untyped here
    """Scores of classes for every pixel.

    Parameters
    ----------
    channels, classes : int
    """

    def __init__(self, channels: int, classes: int) -> None:
        super().__init__()
        low, high = _encoder(channels)
        self.low, self.high = low, high
        last, fine = _STAGES[-1][1], _STAGES[_LOW_STAGES - 1][1]
        self.looks = nn.ModuleList([_one(last, FEATURES)])
        self.looks.extend(_separable(last, FEATURES, rate) for rate in _RATES)
        self.whole = nn.Sequential(nn.Conv2d(last, FEATURES, 1), nn.ReLU(inplace=True))
        self.join = _one(FEATURES * (len(_RATES) + 2), FEATURES)
        self.fine = _one(fine, _LOW)
        self.decoder = nn.Sequential(
            _separable(FEATURES + _LOW, FEATURES, 1), _separable(FEATURES, FEATURES, 1)
        )
        self.classes = nn.Conv2d(FEATURES, classes, 1)

    def features(self, images: Tensor) -> Tensor:
        """(n, 256, m, m) what the decoder holds before classes, m a quarter of the pixels."""
        fine = self.low(images)
        deep = self.high(fine)
        whole = self.whole(deep.mean((2, 3), keepdim=True)).expand(-1, -1, *deep.shape[2:])
        joined = self.join(torch.cat([*(look(deep) for look in self.looks), whole], 1))
        upsampled = _resized(joined, (fine.shape[2], fine.shape[3]))
        return self.decoder(torch.cat([upsampled, self.fine(fine)], 1))

    def forward(self, images: Tensor) -> Tensor:
        """(n, classes, rows, columns) scores."""
        return _resized(self.classes(self.features(images)), (images.shape[2], images.shape[3]))


class _Inverted(nn.Module):  # type: ignore[misc]  # as above
    """An inverted residual: wide, by channel, narrow."""

    def __init__(self, into: int, out: int, stride: int, rate: int, expansion: int) -> None:
        super().__init__()
        wide = into * expansion
        self.is_residual = stride == 1 and into == out
        self.layers = nn.Sequential(
            *(_one(into, wide) if expansion > 1 else ()),
            nn.Conv2d(wide, wide, 3, stride, rate, rate, groups=wide, bias=False),
            nn.BatchNorm2d(wide),
            nn.ReLU6(inplace=True),
            nn.Conv2d(wide, out, 1, bias=False),
            nn.BatchNorm2d(out),
        )

    def forward(self, images: Tensor) -> Tensor:
        found = self.layers(images)
        return images + found if self.is_residual else found


def _encoder(channels: int) -> tuple[nn.Sequential, nn.Sequential]:
    low = nn.Sequential(
        nn.Conv2d(channels, _STEM, 3, 2, 1, bias=False),
        nn.BatchNorm2d(_STEM),
        nn.ReLU6(inplace=True),
    )
    high = nn.Sequential()
    into = _STEM
    for number, (expansion, out, blocks, stride, rate) in enumerate(_STAGES):
        part = low if number < _LOW_STAGES else high
        for block in range(blocks):
            part.append(_Inverted(into, out, stride if block == 0 else 1, rate, expansion))
            into = out
    return low, high


def _one(into: int, out: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(into, out, 1, bias=False), nn.BatchNorm2d(out), nn.ReLU(inplace=True)
    )


def _separable(into: int, out: int, rate: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(into, into, 3, 1, rate, rate, groups=into, bias=False),
        nn.BatchNorm2d(into),
        nn.ReLU(inplace=True),
        *_one(into, out),
    )


def _resized(images: Tensor, size: tuple[int, int]) -> Tensor:
    return functional.interpolate(images, size=size, mode="bilinear", align_corners=True)
