"""One file of a project altered by chance, in the ways that its form invites."""

from __future__ import annotations

import io
import json
import random
import shutil
import sqlite3
import zipfile
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

# Any: whatever JSON and arrays can hold.
_Json = Any

_DEEP = 20_000
_BOMB_BYTES = 6 << 30
_SPARSE_BYTES = 3 << 30


def files_of(project: Path) -> list[str]:
    """The files of a project that can be altered, by their names in it."""
    return sorted(
        str(path.relative_to(project))
        for path in project.rglob("*")
        if path.is_file() and path.name != "lock"
    )


def mutate(path: Path, chance: random.Random) -> str:
    """Alter a file; says how."""
    ways: list[Callable[[Path, random.Random], object]] = [_flip, _cut, _grow, _fill, _empty]
    ways += [_become_folder, _go]
    of_form = {
        ".json": [_alter_json] * 9,
        ".npz": [_alter_array_of_archive] * 6 + [_bomb] * 2,
        ".npy": [_alter_array_file] * 6 + [_huge_array],
        ".gpkg": [_alter_cell] * 20,
        ".bin": [_flip] * 6 + [_alter_values] * 6,
    }
    way = chance.choice(ways + of_form.get(path.suffix, [_flip] * 4))
    told = way(path, chance)
    return f"{way.__name__} {told or ''}".strip()


def _flip(path: Path, chance: random.Random) -> str:
    data = bytearray(path.read_bytes())
    if not data:
        return "nothing"
    reach = len(data) if chance.random() < 0.7 else min(len(data), 300)
    places = [chance.randrange(reach) for _ in range(chance.choice((1, 1, 2, 20)))]
    for place in places:
        data[place] ^= 1 << chance.randrange(8)
    path.write_bytes(data)
    return str(places[:3])


def _cut(path: Path, chance: random.Random) -> str:
    size = int(path.stat().st_size * chance.random())
    with path.open("rb+") as file:
        file.truncate(size)
    return str(size)


def _grow(path: Path, chance: random.Random) -> str:
    size = path.stat().st_size + chance.choice((1, 100, _SPARSE_BYTES))
    with path.open("rb+") as file:
        file.truncate(size)
    return str(size)


def _fill(path: Path, chance: random.Random) -> str:
    size = path.stat().st_size
    start = chance.randrange(size + 1)
    with path.open("rb+") as file:
        file.seek(start)
        byte = chance.choice((b"\0", b"\xff", b"[", b"\x7f"))
        file.write(byte * min(size - start, chance.choice((8, 4096, 1 << 20))))
    return str(start)


def _empty(path: Path, _chance: random.Random) -> None:
    path.write_bytes(b"")


def _become_folder(path: Path, _chance: random.Random) -> None:
    path.unlink()
    path.mkdir()


def _go(path: Path, _chance: random.Random) -> None:
    path.unlink()


def odd_value(chance: random.Random) -> _Json:
    """A value that nobody expects where it stands."""
    makers: list[Callable[[], _Json]] = [
        lambda: None,
        lambda: True,
        lambda: "",
        lambda: "\0/../../etc\n",
        lambda: "../../outside",
        lambda: "//server/share/file",
        lambda: -1,
        lambda: 0,
        lambda: 1e308,
        lambda: float("nan"),
        lambda: float("-inf"),
        lambda: 1 << 63,
        lambda: 10**400,
        lambda: -(1 << 40),
        list,
        dict,
        lambda: [[[]]],
        lambda: {"en": 1},
        lambda: [1, "2", None],
        lambda: "é" * 100_000,
        lambda: _nested(chance.choice((60, 900, _DEEP))),
    ]
    return chance.choice(makers)()


class _Raw(str):
    """Text that is put into JSON as it is."""


def _nested(depth: int) -> _Raw:
    return _Raw("[" * depth + "]" * depth)


def altered_json(text: str, chance: random.Random) -> tuple[str, str]:
    """JSON with one of its values, keys or entries another; and which."""
    whole = json.loads(text)
    places = list(_places(whole, ()))
    place = chance.choice(places)
    value = odd_value(chance)
    marked = "\u0001raw\u0001" if isinstance(value, _Raw) else value
    if not place:
        whole = marked
    else:
        holder = whole
        for step in place[:-1]:
            holder = holder[step]
        way = chance.random()
        if way < 0.15:
            del holder[place[-1]]
        elif way < 0.25 and isinstance(holder, dict):
            holder[chance.choice(("new", "", "kind"))] = marked
        elif way < 0.35 and isinstance(holder, list):
            holder.extend(holder[:1] * 1000)
        else:
            holder[place[-1]] = marked
    made = json.dumps(whole, ensure_ascii=False)
    if isinstance(value, _Raw):
        made = made.replace(json.dumps(marked), value)
    return made, f"{place} {str(value)[:30]!r}"


def _places(value: _Json, above: tuple[_Json, ...]) -> list[tuple[_Json, ...]]:
    found = [above]
    if isinstance(value, dict):
        for key, one in value.items():
            found += _places(one, (*above, key))
    elif isinstance(value, list):
        for number, one in enumerate(value[:20]):
            found += _places(one, (*above, number))
    return found


def _alter_json(path: Path, chance: random.Random) -> str:
    text, told = altered_json(path.read_text(encoding="utf-8"), chance)
    path.write_text(text, encoding="utf-8")
    return told


def odd_array(values: np.ndarray, chance: random.Random) -> np.ndarray:
    """An array in the place of another: of another shape, type or content."""
    makers: list[Callable[[], np.ndarray]] = [
        lambda: values[:0],
        lambda: np.array(5),
        lambda: values.reshape(-1)[:1],
        lambda: np.concatenate([values.reshape(-1)] * 3),
        lambda: values[None],
        lambda: values.astype(str),
        lambda: values.astype(np.complex128),
        lambda: values.astype(np.float16),
        lambda: np.full_like(values, -1 if values.dtype.kind in "if" else 0),
        lambda: values[::-1],
        lambda: np.zeros(values.shape, "M8[s]"),
        lambda: _some_altered(values, chance),
        lambda: _some_altered(values, chance),
        lambda: _some_altered(values, chance),
    ]
    return chance.choice(makers)()


def _some_altered(values: np.ndarray, chance: random.Random) -> np.ndarray:
    made = np.array(values, order="C")
    flat = made.reshape(-1)
    if flat.size and flat.dtype.kind in "iufb":
        for _ in range(chance.choice((1, 30))):
            place = chance.randrange(flat.size)
            raw = flat[place : place + 1].view(np.uint8)
            raw[chance.randrange(raw.size)] = chance.randrange(256)
    return made


def _alter_array_of_archive(path: Path, chance: random.Random) -> str:
    with np.load(path) as kept:
        arrays = {one: kept[one] for one in kept.files}
    name = chance.choice(sorted(arrays))
    if chance.random() < 0.15:
        del arrays[name]
    else:
        arrays[name] = odd_array(arrays[name], chance)
    np.savez(path, **arrays)
    return name


def _alter_array_file(path: Path, chance: random.Random) -> None:
    made = odd_array(np.load(path), chance)
    np.save(path, made)


def _header(shape: tuple[int, ...]) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": "<f8", "fortran_order": False, "shape": shape}
    )
    return file.getvalue()


def _huge_array(path: Path, chance: random.Random) -> None:
    path.write_bytes(_header((chance.choice((1 << 29, 1 << 40)), 7)))


def _bomb(path: Path, chance: random.Random) -> str:
    """An archive whose arrays are said to be, or are, far larger than the file."""
    with np.load(path) as kept:
        names = kept.files
    chosen = chance.choice(names)
    with zipfile.ZipFile(path) as old:
        contents = {one.filename: old.read(one) for one in old.infolist()}
    is_real = chance.random() < 0.5
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as new:
        for name, data in contents.items():
            if name != f"{chosen}.npy":
                new.writestr(name, data)
                continue
            with new.open(name, "w", force_zip64=True) as file:
                file.write(_header((_BOMB_BYTES // 8,)))
                if is_real:
                    block = bytes(1 << 24)
                    for _ in range(40):
                        file.write(block)
    return chosen


def _alter_values(path: Path, chance: random.Random) -> None:
    data = np.fromfile(path, np.uint8)
    width = chance.choice((1, 4, 8))
    usable = data[: data.size // width * width].reshape(-1, width)
    for _ in range(chance.choice((1, 50, 2000))):
        if usable.size:
            usable[chance.randrange(len(usable))] = [chance.randrange(256) for _ in range(width)]
    data.tofile(path)


def _alter_cell(path: Path, chance: random.Random) -> str:
    """One value of the database becomes another, of any type."""
    with closing(sqlite3.connect(path, isolation_level=None)) as database:
        names = database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        tables = [name for (name,) in names if not name.startswith(("sqlite_", "rtree_"))]
        own = [name for name in tables if name.startswith("zuka_") or name == "features"]
        table = chance.choice(own * 3 + tables)
        rows = database.execute(f'SELECT rowid, * FROM "{table}"').fetchall()  # noqa: S608
        if not rows:
            return f"{table} is empty"
        columns = [one[1] for one in database.execute(f'PRAGMA table_info("{table}")')]
        column = chance.choice(columns)
        row = chance.choice(rows)
        value = row[1 + columns.index(column)]
        new = _odd_cell(value, chance)
        database.execute("PRAGMA ignore_check_constraints = 1")
        try:
            if chance.random() < 0.05:
                database.execute(f'DELETE FROM "{table}" WHERE rowid = ?', (row[0],))  # noqa: S608
            else:
                database.execute(
                    f'UPDATE "{table}" SET "{column}" = ? WHERE rowid = ?',  # noqa: S608
                    (new, row[0]),
                )
        except sqlite3.Error as error:
            return f"{table}.{column}: {error}"
        return f"{table}.{column} row {row[0]} {str(row[1])[:20]} = {str(new)[:60]!r}"


def _odd_cell(value: object, chance: random.Random) -> object:
    if isinstance(value, str) and value[:1] in "[{" and value[:1] and chance.random() < 0.8:
        return altered_json(value, chance)[0]
    if isinstance(value, bytes) and value and chance.random() < 0.6:
        made = bytearray(value)
        for _ in range(chance.choice((1, 5))):
            made[chance.randrange(len(made))] = chance.randrange(256)
        return bytes(made[: chance.choice((len(made), len(made) // 2))])
    odd = (
        None, "", "x", b"\0\xff", -1, 0, 1 << 62, 1e308, -1e308, "null", "[]", "{}", "[[1]]",
        "../..", '{"a":' * 2000, "\udcff".encode("utf-8", "surrogatepass"), 3.7, "1e999",
        "９", "NaN",
    )  # fmt: skip
    return chance.choice(odd)


def copy_of(project: Path, folder: Path) -> Path:
    """A fresh copy to be altered."""
    shutil.rmtree(folder, ignore_errors=True)
    return Path(shutil.copytree(project, folder))
