"""Learning of the blocks, and what they say of patches.

torch is asked for only when a network is made or used: the rest runs without the extra ``train``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.laboratory.waveform_networks.neighbourhoods import levels_of
from processing.laboratory.waveform_networks.patches import UNKNOWN, Patch
from processing.laboratory.waveform_networks.sizes import CLASSES, NetworkSizes
from processing.methods.waveforms.local_network import LAYERS, LocalNetwork

F32 = NDArray[np.float32]

LOCAL, LOCAL_POINTS = "local, waveforms", "local, points"
GLOBAL, GLOBAL_POINTS = "global, points and waveforms", "global, points"
WHOLE_PATCH = "whole patch"

_NEIGHBOURS = (GLOBAL, GLOBAL_POINTS)

_RATE, _HALVED_AFTER = 1e-3, 10
"""Adam's, and epochs after which it is halved (Shinohara 2022, section 3.4)."""

_ALPHA = 1.2
"""Keeps the logarithm of a class's weight above 0; its value isn't published."""

_MOST_NOISE, _CLEAR_SIGMAS = 0.02, 3.0
"""Of the flight's middle peak, standard deviation at most; less than so many is set to 0, as it is
where recorded waveforms are cleaned."""


@dataclass(frozen=True)
class Lesson:
    """How a network learns.

    Attributes
    ----------
    epochs : int
        How often each patch is seen.
    say : callable
        Told each epoch's loss.
    waves : int, optional
        Points of a patch that a step of the local block sees, by chance: it knows no neighbours,
        and is by far the slowest. None for all.
    """

    epochs: int
    say: Callable[[str], None]
    waves: int | None = None


def class_weights(patches: Iterable[Patch]) -> Floats:
    """(6,) 1 / ln(1.2 + share), by the classes of what is learnt from (equation 3.5)."""
    counts = np.zeros(CLASSES)
    for one in patches:
        counts += np.bincount(one.classes[one.classes >= 0], minlength=CLASSES)
    return np.asarray(1.0 / np.log(_ALPHA + counts / max(counts.sum(), 1.0)))


def as_recorded(patch: Patch, rng: Generator) -> Patch:
    """The patch turned about the vertical, its waveforms as cleaned from some noise."""
    sigma = rng.uniform(0, _MOST_NOISE)
    waves = patch.waves + rng.normal(0, sigma, patch.waves.shape).astype(np.float32)
    waves[waves < _CLEAR_SIGMAS * sigma] = 0
    return replace(patch.turned(rng.uniform(0, 2 * np.pi)), waves=waves)


# Any: torch is an extra; what it gives has no types where it is missing.
def trained_network(
    kind: str, sizes: NetworkSizes, patches: Sequence[Patch], lesson: Lesson
) -> Any:
    """A network of a kind that learnt from patches, one a step."""
    import torch
    from torch.nn import functional

    torch.manual_seed(0)
    rng = np.random.default_rng(0)
    device = "cuda" if torch.cuda.is_available() else "cpu"
    network = _network(kind, sizes).to(device).train()
    weights = torch.from_numpy(class_weights(patches).astype(np.float32)).to(device)
    optimizer = torch.optim.Adam(network.parameters(), _RATE)
    schedule = torch.optim.lr_scheduler.StepLR(optimizer, _HALVED_AFTER, 0.5)
    for epoch in range(lesson.epochs):
        losses = []
        for number in rng.permutation(len(patches)).tolist():
            seen = patches[number]
            if kind == LOCAL and lesson.waves is not None:
                seen = seen.some(rng.permutation(len(seen.xyz))[: lesson.waves])
            patch = as_recorded(seen, rng)
            first = int(rng.integers(len(patch.xyz)))
            targets = torch.from_numpy(patch.classes).to(device)
            scores = network(*_told(kind, sizes, patch, first, device))
            loss = functional.cross_entropy(scores, targets, weights, ignore_index=UNKNOWN)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            losses.append(float(loss.detach()))
        schedule.step()
        lesson.say(f"{kind}, epoch {epoch + 1} of {lesson.epochs}: loss {np.mean(losses):.3f}")
    return network.eval()


def patch_shares(network: Any, kind: str, sizes: NetworkSizes, patch: Patch) -> F32:
    """(k, 6) float32 how likely each class is at a patch's points."""
    import torch

    device = next(network.parameters()).device
    with torch.no_grad():
        scores = network(*_told(kind, sizes, patch, 0, device))
        return np.asarray(torch.softmax(scores, 1).cpu().numpy(), np.float32)


def as_local_network(network: Any) -> LocalNetwork:
    """The weights of a `LocalBlock`, as the program carries them."""
    kept = {name: one.cpu().numpy() for name, one in network.state_dict().items()}
    numbers = sorted({int(name.split(".")[1]) for name in kept if name.startswith("layers.")})
    weights = {"classes.weight": kept["classes.weight"], "classes.bias": kept["classes.bias"]}
    for layer in range(LAYERS):
        conv, norm = (f"layers.{one}" for one in numbers[2 * layer : 2 * layer + 2])
        weights[f"conv{layer}.weight"] = kept[f"{conv}.weight"]
        weights[f"conv{layer}.bias"] = kept[f"{conv}.bias"]
        weights[f"norm{layer}.scale"] = kept[f"{norm}.weight"]
        weights[f"norm{layer}.bias"] = kept[f"{norm}.bias"]
        weights[f"norm{layer}.mean"] = kept[f"{norm}.running_mean"]
        weights[f"norm{layer}.variance"] = kept[f"{norm}.running_var"]
    return LocalNetwork(weights)


def write_trained(network: Any, path: Any) -> None:
    """Keep a network's weights."""
    import torch

    torch.save(network.state_dict(), path)


def read_trained(kind: str, sizes: NetworkSizes, path: Any) -> Any:
    """What :func:`write_trained` kept."""
    import torch

    network = _network(kind, sizes)
    network.load_state_dict(torch.load(path, weights_only=True))
    return network.eval()


def _network(kind: str, sizes: NetworkSizes) -> Any:
    from processing.laboratory.waveform_networks.networks import (
        CoordinateBlock,
        GlobalBlock,
        LocalBlock,
        WholePatch,
    )

    if kind == LOCAL:
        return LocalBlock(sizes)
    if kind == LOCAL_POINTS:
        return CoordinateBlock(sizes)
    if kind == WHOLE_PATCH:
        return WholePatch(sizes)
    return GlobalBlock(sizes, sees_waves=kind == GLOBAL)


def _told(
    kind: str, sizes: NetworkSizes, patch: Patch, first: int, device: Any
) -> tuple[Any, Any, Any]:
    """What a network is given of a patch."""
    import torch

    levels = levels_of(patch.xyz, sizes, first) if kind in _NEIGHBOURS else []
    xyz, waves = torch.from_numpy(patch.xyz), torch.from_numpy(patch.waves)
    return xyz.to(device), waves.to(device), levels
