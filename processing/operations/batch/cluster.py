"""The drives of a job on a Dask cluster: each a task, worked on beside its worker.

Machines of the cluster have the program installed and see the same folders. What a worker or the
scheduler takes with it when it dies is the running task of each drive; the rest stands in the
drives' states.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Any

from processing.core.errors import MissingInput, Unsuitable
from processing.core.text import Text
from processing.operations.batch.unit_process import STOP_FILE, work_apart
from processing.operations.batch.unit_state import UnitState
from processing.operations.written_values import (
    Table,
    json_text,
    table_from_text,
    table_of,
    value_from,
)

_TIMEOUT_S = 10
_AGAIN = Text(
    "Start it, then run the job again: it goes on where it was.",
    "起動してから、ジョブをもう一度実行してください。続きから処理します。",
)


class Cluster:
    """A connection to a scheduler; closed by :meth:`close`.

    Parameters
    ----------
    address : str
        Such as ``tcp://host:8786``.

    Raises
    ------
    MissingInput
        The packages for clusters are not installed, or nobody answers.
    Unsuitable
        A worker has another version of the program, or none.
    """

    def __init__(self, address: str) -> None:
        try:
            distributed: Any = import_module("distributed")  # a library without types
        except ModuleNotFoundError as error:
            raise MissingInput(
                Text(
                    "The packages for clusters are not installed.",
                    "クラスター用のパッケージがインストールされていません。",
                ),
                Text.same(f"--scheduler {address}"),
                Text(
                    "Install them: pip install 'zuka[cluster]'.",
                    "pip install 'zuka[cluster]' でインストールしてください。",
                ),
            ) from error
        # The library writes pages when a scheduler goes; what a user has to know is told here.
        logging.getLogger("distributed").setLevel(logging.CRITICAL + 1)
        self._address = address
        self._futures: dict[str, Any] = {}  # of a library without types
        try:
            self._client = distributed.Client(address, timeout=_TIMEOUT_S, set_as_default=False)
        except (TimeoutError, OSError, ValueError) as error:
            raise self._no_answer() from error
        try:
            self._check_versions()
        except BaseException:
            self._client.close()
            raise

    @property
    def dashboard(self) -> str:
        """The address of the cluster's own page."""
        return str(self._client.dashboard_link)

    @property
    def workers(self) -> int:
        """How many processes of the cluster take tasks."""
        return len(self._client.scheduler_info(n_workers=-1)["workers"])

    def begin(self, orders: Sequence[Table], stop_folder: Path) -> None:
        """Hand all drives over; workers take one at a time for each of their threads."""
        for order in orders:
            self._futures[str(order["name"])] = self._client.submit(
                work_on_cluster, order, str(stop_folder / STOP_FILE), pure=False
            )

    def ended(self) -> Mapping[str, UnitState | str]:
        """Drives that are over since it was asked last, by name; or why one could not be worked on.

        Raises
        ------
        MissingInput
            The scheduler is gone.
        """
        if self._client.status != "running":
            raise self._no_answer()
        found: dict[str, UnitState | str] = {}
        for name, future in list(self._futures.items()):
            if not future.done():
                continue
            if future.status in ("cancelled", "lost"):
                raise self._no_answer()
            del self._futures[name]
            error = future.exception() if future.status == "error" else None
            found[name] = state_of(future.result()) if error is None else str(error)
        return found

    def close(self) -> None:
        """Give back what was handed over and is not over, and leave."""
        if self._client.status == "running":
            self._client.cancel(list(self._futures.values()))
        self._client.close()

    def _check_versions(self) -> None:
        own = version("zuka")
        theirs = self._client.run(version_of_worker)
        if not theirs:
            raise MissingInput(
                Text("The cluster has no workers.", "クラスターにワーカーがありません。"),
                Text.same(self._address),
                Text(
                    "Start some: dask worker {address} --nthreads 1.",
                    "dask worker {address} --nthreads 1 で起動してください。",
                ).filled(address=self._address),
            )
        for worker, other in sorted(theirs.items()):
            if other != own:
                raise Unsuitable(
                    Text(
                        f"A worker has Zuka {other}, this program is {own}.",
                        f"ワーカーのZukaは {other}、このプログラムは {own} です。",
                    ),
                    Text.same(str(worker)),
                    Text("Install the same version.", "同じ版をインストールしてください。"),
                )

    def _no_answer(self) -> MissingInput:
        return MissingInput(
            Text("The scheduler does not answer.", "スケジューラーが応答しません。"),
            Text.same(self._address),
            _AGAIN,
        )


def version_of_worker() -> str:
    """The version of the program where this runs."""
    return version("zuka")


def work_on_cluster(order: Table, stop: str) -> str:
    """What a worker of the cluster does: one drive; gives its state, written down."""
    path = Path(stop)
    return json_text(table_of(work_apart(order, path.exists)))


def state_of(text: str) -> UnitState:
    """The state that :func:`work_on_cluster` gave."""
    return value_from(UnitState, table_from_text(text, "worker"))
