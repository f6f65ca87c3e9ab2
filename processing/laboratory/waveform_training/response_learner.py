"""The network of :mod:`response_network` as torch learns it; layers have the same names."""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn import functional

from processing.methods.waveforms.estimation.response_network import (
    PULSE_BEFORE_NS,
    PULSE_BEHIND_NS,
    RESPONSE_SCALE,
)


class ResponseLearner(nn.Module):  # type: ignore[misc]  # torch is an extra: it may be untyped here
    """Waveforms of packets, in units of each packet's strongest return.

    Parameters
    ----------
    channels, width : int
        What it sees of each ns, and maps of its layers.
    middle, spread : (f,) Tensor
        Of the facts.
    """

    def __init__(self, channels: int, width: int, middle: Tensor, spread: Tensor) -> None:
        super().__init__()
        self.register_buffer("mu", middle)
        self.register_buffer("sd", spread)
        self.sc = nn.Linear(middle.numel(), width)
        self.s2 = nn.Linear(width, width)
        self.a = nn.Conv1d(channels, width, 9, padding=4, bias=False)
        self.b = nn.Conv1d(width, width, 7, padding=6, dilation=2)
        self.c = nn.Conv1d(width, width, 7, padding=12, dilation=4)
        self.d = nn.Conv1d(width, width, 5, padding=2)
        self.e = nn.Conv1d(width, 1, 5, padding=2)
        # So learning begins at the plain estimate.
        nn.init.zeros_(self.e.weight)
        nn.init.zeros_(self.e.bias)

    def forward(self, channels: Tensor, facts: Tensor, plain: Tensor, pulse: Tensor) -> Tensor:
        """(n, SAMPLES); ``pulse`` (n, p) by ns."""
        known = self.sc((facts - self.mu) / self.sd)
        again = self.s2(functional.relu(known))[:, :, None]
        seen = functional.relu(self.a(channels) + known[:, :, None])
        seen = functional.relu(self.b(seen) + again)
        seen = seen + functional.relu(self.c(seen))
        seen = seen + functional.relu(self.d(seen))
        response = RESPONSE_SCALE * self.e(seen)[:, 0]
        padded = functional.pad(response, (PULSE_BEHIND_NS, PULSE_BEFORE_NS))[None]
        turned = functional.conv1d(padded, pulse.flip(1)[:, None], groups=len(response))
        return functional.relu(plain + turned[0])
