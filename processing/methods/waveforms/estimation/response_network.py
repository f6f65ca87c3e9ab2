"""A small network that says what a pulse met besides the returns that were delivered.

1. It sees, for each nanosecond of a packet, the pulse's own returns, what the plain estimate makes
   of them and what neighbouring pulses met, all in units of the packet's strongest return.
2. Five convolutions over time give the energy that is lacking, or too much, at each nanosecond:
   a return broadened by a slope loses at its place and gains beside it.
3. The system's pulse makes waveform of it. So the network need not know the pulse's shape, and
   what it learnt with one holds for another.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.methods.waveforms.estimation.pulse_returns import SAMPLES
from resources import path_of

PULSE_BEFORE_NS, PULSE_BEHIND_NS = 24, 40
"""How far a pulse reaches before and behind its place."""

RESPONSE_SCALE = 0.1
"""Of what the last layer gives, in packet maxima per ns: so learning begins at the plain estimate,
with steps that are small beside it."""

_AT_ONCE = 256
"""Packets: some 30 MB of intermediate values."""

F32 = NDArray[np.float32]


class ResponseNetwork:
    """The network's weights, and what it answers.

    Parameters
    ----------
    weights : mapping of str to float32 array
        As the training writes them: ``mu`` and ``sd`` of the facts, and of each layer ``weight``
        and ``bias``.
    """

    def __init__(self, weights: Mapping[str, F32]) -> None:
        self._weights = {name: np.asarray(weights[name], np.float32) for name in weights}

    def waves(self, channels: F32, facts: F32, plain: F32, pulse: F32) -> F32:
        """Waveforms, in units of each packet's strongest return.

        Parameters
        ----------
        channels : (n, c, SAMPLES) float32
            What :func:`channels_of` makes.
        facts : (n, f) float32
            What holds for the packet as a whole.
        plain : (n, SAMPLES) float32
            The plain estimate: the pulse at each return.
        pulse : (PULSE_BEFORE_NS + PULSE_BEHIND_NS + 1,) float32
            By ns, maximum 1.
        """
        found = np.empty_like(plain)
        for begin in range(0, len(plain), _AT_ONCE):
            some = slice(begin, begin + _AT_ONCE)
            response = self._responses(channels[some], facts[some])
            found[some] = plain[some] + _with_pulse(response, pulse)
        return np.maximum(found, 0.0)

    def _responses(self, channels: F32, facts: F32) -> F32:
        """(n, SAMPLES) energy per ns that is lacking."""
        get = self._weights
        known = (facts - get["mu"]) / get["sd"] @ get["sc.weight"].T + get["sc.bias"]
        again = np.maximum(known, 0.0) @ get["s2.weight"].T + get["s2.bias"]
        seen = np.ascontiguousarray(channels.transpose(0, 2, 1))
        seen = np.maximum(self._layer(seen, "a") + known[:, None], 0.0)
        seen = np.maximum(self._layer(seen, "b", apart=2) + again[:, None], 0.0)
        seen = seen + np.maximum(self._layer(seen, "c", apart=4), 0.0)
        seen = seen + np.maximum(self._layer(seen, "d"), 0.0)
        return np.asarray(RESPONSE_SCALE * self._layer(seen, "e")[:, :, 0], np.float32)

    def _layer(self, seen: F32, name: str, apart: int = 1) -> F32:
        """A convolution over time; nothing lies beyond the packet's ends.

        Parameters
        ----------
        seen : (n, SAMPLES, c) float32
        apart : int
            Samples between the values that it takes together.
        """
        weight = self._weights[f"{name}.weight"]
        wide = weight.shape[2]
        reach = apart * (wide // 2)
        padded = np.pad(seen, ((0, 0), (reach, reach), (0, 0)))
        taken = np.concatenate(
            [padded[:, apart * at : apart * at + seen.shape[1]] for at in range(wide)], axis=2
        )
        by = weight.transpose(2, 1, 0).reshape(-1, weight.shape[0])
        bias = self._weights.get(f"{name}.bias", np.float32(0.0))
        return np.asarray(taken @ by + bias, np.float32)


def channels_of(impulses: F32, plain: F32, profiles: F32) -> F32:
    """What the network sees of packets.

    Parameters
    ----------
    impulses, plain : (n, SAMPLES) float32
        Returns by ns, and the plain estimate, in units of each packet's strongest return.
    profiles : (n, 2 r, SAMPLES) float32
        As :mod:`ray_kernels` makes them; energies in the same units, 0 where unknown. Their square
        roots, for a few strong neighbours else outweigh what many weak ones tell.
    """
    parts = (impulses[:, None], plain[:, None], np.sqrt(np.maximum(profiles, 0.0)))
    return np.concatenate(parts, axis=1).astype(np.float32)


def _with_pulse(response: F32, pulse: F32) -> F32:
    """The convolution of responses with the pulse, over the same samples."""
    length = SAMPLES + pulse.size
    turned = np.fft.rfft(response, length, axis=1) * np.fft.rfft(pulse, length)
    waves = np.fft.irfft(turned, length, axis=1)
    return np.asarray(waves[:, PULSE_BEFORE_NS : PULSE_BEFORE_NS + SAMPLES], np.float32)


def read_network(path: Path) -> ResponseNetwork:
    """A network from the file that its training left."""
    with np.load(path) as kept:
        return ResponseNetwork({name: kept[name] for name in kept})


@cache
def shipped_network(*, knows_intensity: bool) -> ResponseNetwork:
    """The network that comes with the program, for returns with or without intensities."""
    name = "all" if knows_intensity else "positions"
    return read_network(path_of(f"models/waveforms/{name}.npz"))
