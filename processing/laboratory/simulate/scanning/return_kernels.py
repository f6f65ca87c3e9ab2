"""What comes back of each beam: range, strength, later returns; one pass over the pulses.

All chance comes from numbers made of the pulse's number and a key, so that a pulse returns the same
whatever is recorded together with it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# Columns of a surface's numbers.
REFLECTANCE, SPREAD, ROUGHNESS, GRAIN, SHINE, RETRO, STANDS, OPEN = range(8)
# Numbers of a scanner.
(
    NOISE,
    EXIT,
    DIVERGENCE,
    TURN_RAD,
    MOST_RETURNS,
    IS_PHASE,
    WEAKEST,
    LEVELLED,
    WETNESS,
    LENGTH,
    GROWTH,
    PASSED,
    FLATTEST,
) = range(13)

TRUE, MIXED = 0, 1
_BASE_M = 10.0
# Grains of the surface within a beam make its echo stronger or weaker.
_LEAST_SPECKLE, _MOST_SPECKLE, _SPECKLE_PER_M = 0.05, 0.2, 80.0
_NEAR_M = 8.0  # nearer than this a receiver sees its own beam only in part
_SLOPE_OF = 0.1  # of a grain on either side: over so much a surface's slope is told
_LENGTHS_AS_ONE = 4.0  # of a pulse, within which a receiver of one return takes one range
_OWN_LIKE_M = 0.05  # a range so near to what a beam met is of that, as in `scanner_noise`


@kernel
def mix_bits(number: int, salt: int) -> np.uint64:
    """64 bits that look like chance (splitmix64)."""
    bits = np.uint64(number) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(salt) * np.uint64(
        0xD1B54A32D192ED03
    )
    bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> np.uint64(31))


@kernel
def share_of(number: int, salt: int) -> float:
    """A number from 0 to 1 that belongs to ``number`` and ``salt``."""
    return float(mix_bits(number, salt) >> np.uint64(11)) / 9007199254740992.0


@kernel
def normal_of(number: int, salt: int) -> float:
    """A normally distributed number that belongs to ``number`` and ``salt``."""
    bits = mix_bits(number, salt)
    one = (float(bits >> np.uint64(40)) + 0.5) / 16777216.0
    other = float(bits & np.uint64(0xFFFFFF)) / 16777216.0
    return math.sqrt(-2.0 * math.log(one)) * math.cos(6.283185307179586 * other)


@kernel
def _corner(x: int, y: int, salt: int) -> float:
    return share_of(x * 73856093 + y * 19349663, salt) * 2.0 - 1.0


@kernel
def relief(x: float, y: float, salt: int) -> float:
    """A smooth surface of heights between −1 and 1 over a raster of width 1."""
    column, row = math.floor(x), math.floor(y)
    u, v = x - column, y - row
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    i, j = int(column), int(row)
    low = _corner(i, j, salt) * (1 - u) + _corner(i + 1, j, salt) * u
    high = _corner(i, j + 1, salt) * (1 - u) + _corner(i + 1, j + 1, salt) * u
    return low * (1 - v) + high * v


@kernel
def _spreading(reach: float) -> float:
    """How much less light comes back from a range than from 10 m."""
    spread: float = (reach * reach + _NEAR_M * _NEAR_M) / (_BASE_M * _BASE_M + _NEAR_M * _NEAR_M)
    return spread


@kernel
def _strength(surface: Floats, reach: float, cosine: float, light: tuple[float, float]) -> float:
    """Power that comes back, 1 being that of a white surface 10 m away at right angles."""
    spread, wet = light
    part = surface[REFLECTANCE] * max(0.05, 1.0 + surface[SPREAD] * 1.7 * spread)
    part *= 1.0 - 0.75 * wet
    shine = min(0.95, surface[SHINE] + 0.5 * wet)
    diffuse = part * (1.0 - shine) * cosine
    mirrored: float = shine * cosine**60
    back = surface[RETRO] * math.sqrt(cosine)
    power: float = (diffuse + mirrored + back) / _spreading(reach)
    return power


@kernel
def _lies_off(x: float, y: float, z: float, surface: Floats) -> float:
    """How far a surface stands off its triangles at a place, m."""
    u, v = (x + 0.37 * z) / surface[GRAIN], (y + 0.61 * z) / surface[GRAIN]
    off: float = surface[ROUGHNESS] * 2.0 * relief(u, v, 7)
    return off


@kernel
def mirrored_ways(
    beams: tuple[Floats, Floats],
    met: tuple[Floats, NDArray[np.uint8]],
    surfaces: Floats,
    out: Floats,
) -> None:
    """Ways on of beams that surfaces mirror, bent by how those lie off their triangles.

    ``beams``: places on the surfaces, and ways there. ``met``: normals of the triangles, materials.
    """
    positions, ways = beams
    normals, materials = met
    across, tilted = np.empty((2, 3)), np.empty(3)
    for ray in range(positions.shape[0]):
        surface, normal = surfaces[materials[ray]], normals[ray]
        least = np.argmin(np.abs(normal))
        for axis in range(3):
            across[0, axis] = (1.0 if axis == least else 0.0) - normal[least] * normal[axis]
        across[0] /= math.sqrt(np.sum(across[0] ** 2))
        across[1, 0] = normal[1] * across[0, 2] - normal[2] * across[0, 1]
        across[1, 1] = normal[2] * across[0, 0] - normal[0] * across[0, 2]
        across[1, 2] = normal[0] * across[0, 1] - normal[1] * across[0, 0]
        tilted[:] = normal
        step = _SLOPE_OF * surface[GRAIN]
        for one in range(2):
            low, high = positions[ray] - step * across[one], positions[ray] + step * across[one]
            rise = _lies_off(high[0], high[1], high[2], surface)
            rise -= _lies_off(low[0], low[1], low[2], surface)
            tilted -= rise / (2 * step) * across[one]
        tilted /= math.sqrt(np.sum(tilted**2))
        out[ray] = ways[ray] - 2.0 * np.sum(ways[ray] * tilted) * tilted


@kernel
def first_returns(
    beams: tuple[int, Floats, Floats],
    met: tuple[Floats, Floats, NDArray[np.uint8]],
    surfaces: Floats,
    scanner: Floats,
    key: int,
    out: tuple[Floats, Floats, Floats],
) -> None:
    """Ranges and strengths of what each beam met first.

    ``beams``: number of the first pulse, origins and ways. ``met``: ranges (infinite: nothing),
    cosines, materials. ``out``: measured ranges (NaN where nothing came back), true ranges, and
    strengths.
    """
    first, origins, directions = beams
    reaches, cosines, materials = met
    ranges, truths, strengths = out
    for ray in range(reaches.size):
        ranges[ray], truths[ray], strengths[ray] = np.nan, np.nan, 0.0
        reach = reaches[ray]
        if not math.isfinite(reach):
            continue
        number = first + ray
        surface = surfaces[materials[ray]]
        cosine = max(cosines[ray], 0.01)
        x = origins[ray, 0] + reach * directions[ray, 0]
        y = origins[ray, 1] + reach * directions[ray, 1]
        z = origins[ray, 2] + reach * directions[ray, 2]
        u, v = x + 0.37 * z, y + 0.61 * z
        spread = relief(u / 0.35, v / 0.35, 3) + 0.5 * relief(u / 0.04, v / 0.04, 5)
        high = _lies_off(x, y, z, surface)
        if surface[STANDS] > 0.0:
            grown = 0.5 + 0.5 * relief(u / 1.3, v / 1.3, 11)
            blade = share_of(number, key + 1)
            high += surface[STANDS] * (0.25 + 1.5 * grown) * blade**1.5
            high *= scanner[GROWTH]
        # Nearer by what stands up, but never by more than a beam just over the ground would be.
        truth = reach - high / max(cosine, scanner[FLATTEST])
        wet = 0.0
        if scanner[WETNESS] > 0.0:
            wet = relief(x / 2.7, y / 2.7, 13) + 0.4 * relief(x / 0.5, y / 0.5, 17)
            wet = min(1.0, max(0.0, (wet - 1.0 + 1.4 * scanner[WETNESS]) * 3.0))
        power = scanner[PASSED] * _strength(surface, reach, cosine, (spread, wet))
        weak = scanner[WEAKEST]
        if power < weak * (0.5 + share_of(number, key + 2)):
            continue
        width = scanner[EXIT] + scanner[DIVERGENCE] * reach
        tilted = width * math.sqrt(max(0.0, 1.0 - cosine * cosine)) / cosine
        fuzz = scanner[NOISE] * min(6.0, max(0.7, (0.15 / power) ** 0.35))
        fuzz = math.sqrt(fuzz * fuzz + (0.05 * tilted) ** 2)
        truths[ray] = truth
        ranges[ray] = truth + fuzz * normal_of(number, key + 3)
        power *= _spreading(reach) ** scanner[LEVELLED]
        speckle = _LEAST_SPECKLE + min(_MOST_SPECKLE, _SPECKLE_PER_M * surface[ROUGHNESS])
        strengths[ray] = power * math.exp(speckle * normal_of(number, key + 4))


@kernel
def edge_returns(
    first: int,
    met: tuple[Floats, Integers],
    scanner: Floats,
    key: int,
    out: tuple[Floats, Floats, Floats, Integers, NDArray[np.uint8]],
) -> None:
    """Let beams that meet an edge also return from what is beside it, or from in between.

    ``met``: true ranges (NaN: none) and bodies of the beams. ``out``: measured ranges and
    strengths, changed in place; ranges of second returns (NaN: none) and the beams that met what
    they are of; kinds, `MIXED` where the range is of no surface. The neighbour in the turn tells
    what is beside. Leaves of one tree are one body, yet ranges between them are of none of them.
    """
    truths, bodies = met
    ranges, strengths, seconds, others, kinds = out
    for ray in range(truths.size):
        seconds[ray], others[ray], kinds[ray] = np.nan, ray, TRUE
        other = ray + 1 if share_of(first + ray, key + 5) < 0.5 else ray - 1
        if other < 0 or other >= truths.size:
            continue
        here, beside = truths[ray], truths[other]
        if math.isnan(here) or math.isnan(beside) or math.isnan(ranges[ray]):
            continue
        gap = beside - here
        near = min(here, beside)
        is_single = scanner[IS_PHASE] < 0.5 and scanner[MOST_RETURNS] < 1.5
        is_body = bodies[ray] == bodies[other] and not is_single
        if abs(gap) < 0.04 + 3 * scanner[TURN_RAD] * near or is_body:
            continue
        width = scanner[EXIT] + scanner[DIVERGENCE] * near
        if share_of(first + ray, key + 6) > min(0.9, width / (scanner[TURN_RAD] * near)):
            continue
        part = share_of(first + ray, key + 7)
        if scanner[IS_PHASE] > 0.5:
            ranges[ray] = here + part * gap
            kinds[ray] = MIXED
        elif is_single and abs(gap) < _LENGTHS_AS_ONE * scanner[LENGTH]:
            # A receiver that tells one range of a pulse takes the middle of all that came back.
            ranges[ray] = here + part * gap
            kinds[ray] = MIXED if min(part, 1.0 - part) * abs(gap) > _OWN_LIKE_M else TRUE
        elif abs(gap) < scanner[LENGTH]:
            # Two echoes within the pulse's length become one, nearer to the first of them.
            low = near + 0.6 * part * part * abs(gap)
            ranges[ray] = low
            kinds[ray] = MIXED if abs(low - here) > 0.03 else TRUE
        elif gap > 0 and scanner[MOST_RETURNS] > 1.5:
            seconds[ray] = beside + 2 * scanner[NOISE] * normal_of(first + ray, key + 8)
            others[ray] = other
        strengths[ray] *= 0.25 + 0.75 * part


@kernel
def intensities(strengths: Floats, damping: float, out: NDArray[np.uint16]) -> None:
    """Strengths as a scanner writes them: 16 bits, the far made stronger by some makers."""
    for one in range(strengths.size):
        value = 26_000.0 * max(strengths[one], 1e-9) ** damping
        out[one] = np.uint16(min(65_535.0, max(1.0, value)))


def warm_up() -> None:
    """Compile the kernels."""
    one, three = np.ones(1), np.ones((1, 3))
    bytes_, body = np.zeros(1, np.uint8), np.zeros(1, np.int64)
    surfaces, scanner = np.ones((1, 8)), np.ones(FLATTEST + 1)
    out = np.ones(1), np.ones(1), np.ones(1)
    start, key = 0, 1
    mirrored_ways((three, three), (three, bytes_), surfaces, three.copy())
    first_returns((start, three, three), (one, one, bytes_), surfaces, scanner, key, out)
    echoes = one.copy(), one.copy(), one.copy(), body.copy(), bytes_
    edge_returns(start, (one, body), scanner, key, echoes)
    intensities(one, 0.5, np.zeros(1, np.uint16))
