"""Messages of Protocol Buffers, as far as model files need them, read and written field by field.

References
----------
Protocol Buffers, “Encoding”: a key of number and wire type before each value.
"""

from __future__ import annotations

from collections.abc import Iterator

_VARINT, _EIGHT_BYTES, _BYTES, _FOUR_BYTES = 0, 1, 2, 5
_ALL_BITS = (1 << 64) - 1


def fields_of(message: bytes, wanted: int) -> list[bytes]:
    """The contents of a message's fields of one number, bytes as they stand.

    Raises
    ------
    ValueError
        This is no such message.
    """
    return list(_each_field(message, wanted))


def first_field(message: bytes, wanted: int) -> bytes:
    """The contents of the first of them; StopIteration without one."""
    return next(_each_field(message, wanted))


def _each_field(message: bytes, wanted: int) -> Iterator[bytes]:
    position = 0
    while position < len(message):
        key, position = _varint_at(message, position)
        start = position
        wire = key & 7
        if wire == _VARINT:
            _, position = _varint_at(message, position)
        elif wire == _BYTES:
            size, start = _varint_at(message, position)
            position = start + size
        elif wire in (_EIGHT_BYTES, _FOUR_BYTES):
            position += 8 if wire == _EIGHT_BYTES else 4
        else:
            raise ValueError(f"wire type {wire} at byte {start}")
        if key >> 3 == wanted:
            yield message[start:position]


def _varint_at(message: bytes, position: int) -> tuple[int, int]:
    value, shift = 0, 0
    while True:
        byte = message[position]
        position += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, position
        shift += 7


def varint(value: int) -> bytes:
    """A whole number, seven bits a byte, the lowest first."""
    value &= _ALL_BITS
    parts = bytearray()
    while value >= 0x80:
        parts.append(value & 0x7F | 0x80)
        value >>= 7
    parts.append(value)
    return bytes(parts)


def number_field(field: int, value: int) -> bytes:
    """A field with a whole number."""
    return varint(field << 3 | _VARINT) + varint(value)


def block_field(field: int, content: bytes) -> bytes:
    """A field with bytes: a text, packed numbers or another message."""
    return varint(field << 3 | _BYTES) + varint(len(content)) + content
