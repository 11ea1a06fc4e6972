"""A Dask cluster as executor, by the address of its scheduler."""

import asyncio
from concurrent.futures import CancelledError, Future, ThreadPoolExecutor
from types import TracebackType
from typing import Any, Self

from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.work import Chunk, Report, run_chunk

PATIENCE = 10.0
"""How long to wait for a scheduler, and then for its first worker (s)."""


class Cluster:
    """The workers of a Dask scheduler.

    They need this package in the same versions, and, for results that are the same to the last bit, processors of the
    same make. Workers come and go as they like: Dask gives the chunk of a lost worker to another.

    Args:
        address: of the scheduler, such as ``tcp://10.0.0.1:8786``.

    Raises:
        SweepError: Dask is not installed, or this is no address.
    """

    blocking = False

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client
            from distributed.scheduler import KilledWorker
        except ImportError as error:
            raise SweepError(
                "a cluster needs Dask, which is not installed: pip install 'drake-formation[dask]'"
            ) from error
        _require_address(address)
        self.deaths: tuple[type[BaseException], ...] = (KilledWorker,)
        self._address = address
        self._client_type: Any = Client

    @property
    def slots(self) -> int:
        """Two chunks a worker: one to run, and one to go on with.

        Raises:
            SweepStoppedError: the scheduler does not answer.
        """
        try:
            return 2 * max(1, len(self._client.nthreads()))
        except OSError as error:
            raise self._lost() from error

    def submit(self, chunk: Chunk) -> "Future[Report]":
        """Hand out a chunk."""
        future: Future[Report] = self._executor.submit(run_chunk, chunk)
        return future

    def __enter__(self) -> Self:
        """Connect.

        Raises:
            SweepError: there is no scheduler, or it has no workers.
        """
        _greet(self._address)
        self._client = self._client_type(self._address, timeout=PATIENCE, set_as_default=False)
        try:
            self._client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError as error:
            self._client.close()
            message = f"the Dask scheduler at {self._address} has no workers, and none came within {PATIENCE:g} s"
            raise SweepError(message) from error
        # Chunks are never equal, so there is no result to be found again by a hash of its arguments.
        self._executor = self._client.get_executor(pure=False)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.shutdown(wait=False)
        self._client.close()
        if kind is CancelledError:  # so ends what the scheduler was to do, when it is gone
            raise self._lost() from error

    def _lost(self) -> SweepStoppedError:
        return SweepStoppedError(f"the connection to the Dask scheduler at {self._address} was lost")


def _greet(address: str) -> None:
    """Connect once and hang up: a Client that cannot be made would leave threads and messages behind."""
    import distributed

    dask: Any = distributed

    async def greet() -> None:
        security = dask.Security().get_connection_args("client")
        comm = await dask.comm.connect(address, timeout=PATIENCE, **security)
        comm.abort()

    def run() -> None:  # in a thread of its own, as a notebook has an event loop already
        asyncio.run(asyncio.wait_for(greet(), PATIENCE + 1.0))

    try:
        with ThreadPoolExecutor(1) as thread:
            thread.submit(run).result()
    except TimeoutError as error:
        raise SweepError(f"no Dask scheduler at {address} answered within {PATIENCE:g} s") from error
    except Exception as error:  # whatever it is that listens there
        raise SweepError(f"no Dask scheduler at {address}: {error}") from error


def _require_address(address: str) -> None:
    """Refuse what could not be an address, for which Dask would look in vain."""
    from distributed.comm.addressing import parse_address, parse_host_port
    from distributed.comm.registry import get_backend

    try:
        scheme, location = parse_address(address)
        get_backend(scheme)
        host, port = parse_host_port(location)
    except Exception as error:
        raise _no_address(address, str(error)) from error
    if scheme == "inproc":
        raise _no_address(address, "a scheduler in this very process has no processors of its own")
    if not host or not 0 < port < 2**16:
        raise _no_address(address, f"no host and port in {location!r}")


def _no_address(address: str, why: str) -> SweepError:
    return SweepError(f"scheduler {address!r}: {why}; give an address such as tcp://10.0.0.1:8786")
