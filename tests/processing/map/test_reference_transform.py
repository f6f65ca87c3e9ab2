"""Places between the Japanese plane zones, against the national formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from processing.core.errors import OutOfRange, Unsuitable
from processing.map.reference_transform import MOST_ERROR_M, reference_transform

# EPSG code of JGD2011: latitude and longitude of the zone's origin, degrees.
_ZONES = {
    6669: (33, 129.5),
    6673: (36, 134 + 20 / 60),
    6674: (36, 136),
    6675: (36, 137 + 10 / 60),
    6676: (36, 138.5),
    6677: (36, 139 + 50 / 60),
    6678: (40, 140 + 50 / 60),
    6680: (44, 142.25),
    6683: (26, 127.5),
}
_SEMI_MAJOR_M, _FLATTENING, _SCALE = 6_378_137.0, 1 / 298.257222101, 0.9999


def _plane(latitude: float, longitude: float, zone: int) -> tuple[float, float]:
    """Easting and northing of a place of JGD2011, by Kawase's series to the fifth power of n.

    References
    ----------
    K. Kawase (2011): A general formula for calculating meridian arc length and its application
    to coordinate conversion in the Gauss-Krüger projection. Bulletin of the GSI 59.
    """
    n = _FLATTENING / (2 - _FLATTENING)
    series = (
        n / 2 - 2 * n**2 / 3 + 5 * n**3 / 16 + 41 * n**4 / 180 - 127 * n**5 / 288,
        13 * n**2 / 48 - 3 * n**3 / 5 + 557 * n**4 / 1440 + 281 * n**5 / 630,
        61 * n**3 / 240 - 103 * n**4 / 140 + 15061 * n**5 / 26880,
        49561 * n**4 / 161280 - 179 * n**5 / 168,
        34729 * n**5 / 80640,
    )
    radius = _SCALE * _SEMI_MAJOR_M / (1 + n) * (1 + n**2 / 4 + n**4 / 64)

    def projected(latitude: float, from_meridian: float) -> tuple[float, float]:
        sine, k = math.sin(latitude), 2 * math.sqrt(n) / (1 + n)
        t = math.sinh(math.atanh(sine) - k * math.atanh(k * sine))
        xi = math.atan2(t, math.cos(from_meridian))
        eta = math.atanh(math.sin(from_meridian) / math.hypot(1, t))
        east = eta + sum(
            a * math.cos(2 * j * xi) * math.sinh(2 * j * eta) for j, a in enumerate(series, 1)
        )
        north = xi + sum(
            a * math.sin(2 * j * xi) * math.cosh(2 * j * eta) for j, a in enumerate(series, 1)
        )
        return radius * east, radius * north

    origin = _ZONES[zone]
    _, below = projected(math.radians(origin[0]), 0.0)
    east, north = projected(math.radians(latitude), math.radians(longitude - origin[1]))
    return east, north - below


@given(
    here=st.sampled_from(sorted(_ZONES)),
    there=st.sampled_from(sorted(_ZONES)),
    latitude=st.floats(26, 44),
    share=st.floats(0, 1),
)
def test_a_place_comes_where_the_national_formulas_put_it(
    here: int, there: int, latitude: float, share: float
) -> None:
    longitude = _ZONES[here][1] * share + _ZONES[there][1] * (1 - share)
    position = np.array([[*_plane(latitude, longitude, here), 12.5]])
    expected = np.array([[*_plane(latitude, longitude, there), 12.5]])
    moved = reference_transform(f"EPSG:{here}", f"EPSG:{there}").apply(position)
    assert np.abs(moved - expected).max() < 1e-4


@given(
    zones=st.tuples(st.integers(6669, 6687), st.integers(6669, 6687)),
    easting=st.floats(-130_000, 130_000),
    northing=st.floats(-200_000, 200_000),
    height=st.floats(-100, 4000),
)
def test_there_and_back_is_exact_to_a_tenth_of_a_millimetre(
    zones: tuple[int, int], easting: float, northing: float, height: float
) -> None:
    here, there = (f"EPSG:{zone}" for zone in zones)
    position = np.array([[easting, northing, height]])
    moved = reference_transform(here, there).apply(position)
    back = reference_transform(there, here).apply(moved)
    assert np.abs(back - position).max() < 1e-4
    assert moved[0, 2] == height


def test_what_is_given_is_not_written_to() -> None:
    position = np.array([[1.0, 2.0, 3.0]])
    reference_transform("EPSG:6677", "EPSG:6676").apply(position)
    assert position.tolist() == [[1.0, 2.0, 3.0]]


def test_the_heights_of_a_compound_system_do_not_count() -> None:
    way = reference_transform("EPSG:6677+5773", "EPSG:6676")
    assert way.apply(np.array([[0.0, 0.0, 50.0]]))[0, 2] == 50.0
    assert "heights were kept" in way.note.en


@pytest.mark.parametrize(
    ("here", "there", "said"),
    [
        ("EPSG:30169", "EPSG:6677", "tky2jgd.gsb"),  # Tokyo datum
        ("EPSG:6677", "EPSG:30169", "tky2jgd.gsb"),
        ("EPSG:2451", "EPSG:6677", "1.00 m"),  # JGD2000: the earthquake of 2011 lies between
        ("EPSG:4326", "EPSG:6677", "1.00 m"),
        ("EPSG:6677", "EPSG:27700", "known accuracy"),
    ],
)
def test_a_way_that_is_not_exact_enough_is_refused_with_the_reason(
    here: str, there: str, said: str
) -> None:
    assert MOST_ERROR_M == 0.05
    with pytest.raises(Unsuitable) as refusal:
        reference_transform(here, there)
    assert said in refusal.value.line("en")
    assert "\n" not in refusal.value.line("ja")


@pytest.mark.parametrize("code", ["EPSG:999999", "nowhere", ""])
def test_a_reference_system_that_there_is_not_is_refused(code: str) -> None:
    with pytest.raises(OutOfRange):
        reference_transform("EPSG:6677", code)
