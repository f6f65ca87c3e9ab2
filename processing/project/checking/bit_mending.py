"""A single bit that turned over, found again by the checksums of its block.

CRC-32 is linear: what it says of a block with a wrong bit differs from what it should say by a
value that depends on the bit's place alone, and no two places of a block give the same. What is
mended by it must fit Adler-32 as well, which other damage does not.

References
----------
Peterson & Brown 1961, "Cyclic codes for error detection", on single errors.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import BlockSum, sum_of
from processing.core.kernels import kernel

_POLYNOMIAL = 0xEDB88320
_BITS = 8


def with_bit_mended(block: bytes, known: BlockSum) -> bytes | None:
    """A block with the one bit turned back that turned over; None where that is not all.

    Parameters
    ----------
    known : BlockSum
        Of the block as it was written.
    """
    place = np.zeros(2, np.int64)
    if not _flipped_bit_kernel(sum_of(block).crc ^ known.crc, len(block), _table(), place):
        return None
    mended = bytearray(block)
    mended[int(place[0])] ^= 1 << int(place[1])
    return bytes(mended) if sum_of(mended) == known else None


def _table() -> NDArray[np.uint32]:
    """CRC-32 of each byte, bits reflected."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(_BITS):
        table = np.where(table & 1, (table >> 1) ^ np.uint32(_POLYNOMIAL), table >> 1)
    return table.astype(np.uint32)


@kernel
def _flipped_bit_kernel(
    difference: int, size: int, table: NDArray[np.uint32], place: NDArray[np.int64]
) -> bool:
    """The byte and the bit whose error makes the checksum differ so; whether there is one."""
    states = np.empty(8, np.uint32)
    for bit in range(8):
        states[bit] = table[1 << bit]
    wanted = np.uint32(difference)
    for back in range(size):
        for bit in range(8):
            if states[bit] == wanted:
                place[0], place[1] = size - 1 - back, bit
                return True
            # One more byte without an error stands behind it.
            states[bit] = (states[bit] >> np.uint32(8)) ^ table[states[bit] & np.uint32(0xFF)]
    return False
