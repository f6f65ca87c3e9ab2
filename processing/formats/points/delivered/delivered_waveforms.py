"""What a point file brings of waveforms, before any is read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from processing.core.text import Text
from processing.recording.waveform_packets.descriptors import WaveformDescriptor


@dataclass(frozen=True)
class DeliveredWaveforms:
    """The packets that a file's points name.

    Attributes
    ----------
    path : Path
        The file that holds them: the points' own, or one beside it.
    first_byte, size : int
        Where in it they begin, and how many bytes there are; packets are counted from there.
    has_head : bool
        Whether a record's header of 60 bytes stands before the packets and is counted with them.
    descriptors : mapping of int to WaveformDescriptor
        By the number that points name; also those that no packet can have.
    reason : Text
        Why no waveform can be read, to follow "no waveforms: "; empty where they can.
    pack : str
        Where packets are not in the file as they are kept: what writes them from it,
        ``module:function`` of the file, an open file and a monitor. Empty where they are.
    echoes : int
        Points that were made of the waveforms; 0 where points were delivered.
    remark : Text
        What whoever works with the points is to know of how they came from waveforms; may be empty.
    """

    path: Path = Path()
    first_byte: int = 0
    size: int = 0
    has_head: bool = False
    descriptors: Mapping[int, WaveformDescriptor] = field(default_factory=dict)
    reason: Text = Text("", "")
    pack: str = ""
    echoes: int = 0
    remark: Text = Text("", "")

    @property
    def is_readable(self) -> bool:
        """Whether points may have waveforms."""
        return not self.reason.en
