"""Fits the network to examples; torch is asked for only here, and only when it is called."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from processing.laboratory.waveform_training.flight_examples import FlightExamples
from processing.methods.waveforms.estimation.packet_inputs import F32

_BATCH = 256
_RATE, _DECAY = 2e-3, 1e-4
"""AdamW; the rate rises over the first steps and falls by a cosine to nothing."""

_RISING_STEPS = 200
_MEAN_STEPS, _MEAN_AT_FIRST = 200, 20
"""Steps that the weights handed over are a moving mean of, later and in the first ones."""

_FIRST_STEPS = 400
_MOST_BRIGHT = 3.0
"""A packet counts by its brightness, as it does in counts, but no mirror for more than three."""

_LEAST_SPREAD = 1e-3
_LONGEST_STEP = 1.0
"""Of the gradient: a packet that is told wholly wrong doesn't undo what was learnt."""

_PERCENT = 100.0
_SAY_EVERY = 200


@dataclass(frozen=True)
class FitRequest:
    """How a network is to be fitted: maps of its layers, and how often each example is seen."""

    width: int
    epochs: float


def fit_network(
    flights: Sequence[FlightExamples], request: FitRequest, say: Callable[[str], None]
) -> Mapping[str, F32]:
    """Weights as :class:`ResponseNetwork` takes them, learnt by the mean absolute error."""
    import torch

    from processing.laboratory.waveform_training.response_learner import ResponseLearner

    torch.manual_seed(0)
    rng = np.random.default_rng(0)
    flight = np.repeat(np.arange(len(flights)), [one.label.size for one in flights])
    pulses = np.stack([one.pulse for one in flights])
    channels = np.concatenate([one.channels for one in flights])
    facts = np.concatenate([one.facts for one in flights])
    plain = np.concatenate([one.plain for one in flights])
    true = np.concatenate([one.true for one in flights])
    weight = np.minimum(np.concatenate([one.bright for one in flights]), _MOST_BRIGHT)
    middle, spread = (torch.from_numpy(one) for one in _scale_of(facts))
    network = ResponseLearner(channels.shape[1], request.width, middle, spread)
    mean = {name: one.clone() for name, one in network.state_dict().items()}
    optimizer = torch.optim.AdamW(network.parameters(), _RATE, weight_decay=_DECAY)
    steps = max(1, round(request.epochs * flight.size / _BATCH))
    losses = []
    for step in range(steps):
        some = rng.integers(0, flight.size, _BATCH)
        for group in optimizer.param_groups:
            group["lr"] = _rate(step, steps)
        seen = channels[some].astype(np.float32), facts[some], plain[some], pulses[flight[some]]
        found = network(*(torch.from_numpy(one) for one in seen))
        error = (found - torch.from_numpy(true[some])).abs().mean(1)
        loss = _PERCENT * (error * torch.from_numpy(weight[some])).mean()
        optimizer.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), _LONGEST_STEP)
        optimizer.step()
        over = _MEAN_STEPS if step >= _FIRST_STEPS else _MEAN_AT_FIRST
        for name, one in network.state_dict().items():
            mean[name].lerp_(one, 1.0 / over)
        losses.append(float(loss.detach()))
        if (step + 1) % _SAY_EVERY == 0 or step + 1 == steps:
            say(f"step {step + 1} of {steps}: loss {np.mean(losses[-_SAY_EVERY:]):.4f} %")
    return {name: one.numpy().astype(np.float32) for name, one in mean.items()}


def _scale_of(facts: F32) -> tuple[F32, F32]:
    """Middle and spread of each fact."""
    spread = facts.std(axis=0) + np.float32(_LEAST_SPREAD)
    return facts.mean(axis=0), spread.astype(np.float32)


def _rate(step: int, steps: int) -> float:
    rising = min(1.0, (step + 1) / _RISING_STEPS)
    return _RATE * rising * 0.5 * (1.0 + math.cos(math.pi * step / steps))


def write_network(weights: Mapping[str, F32], path: Path) -> None:
    """Keep weights as the program reads them."""
    # Any: numpy declares an option of another type among the arrays.
    kept: dict[str, Any] = dict(weights)
    np.savez_compressed(path, **kept)
