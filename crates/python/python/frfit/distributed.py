"""The runs of a plan on the workers of an executor: ``concurrent.futures``, or a client of dask.distributed.

>>> import frfit.distributed                                            # doctest: +SKIP
>>> client = dask.distributed.Client(SLURMCluster(cores=1, memory="4GB"))     # doctest: +SKIP
>>> frfit.distributed.map(client, "plan.csv", "store", reduced="model.frfit")  # doctest: +SKIP
"""

from __future__ import annotations

import os
from concurrent.futures import Future
from typing import Any, Protocol

from ._arrays import flag, optional_whole
from ._batch import Batch, batch, batch_status

__all__ = ["map"]

_Path = str | os.PathLike[str]


class _Executor(Protocol):
    def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any] | Any: ...


def _share(plan: str, out: str, reduced: str | None, index: int, count: int, retry_failed: bool) -> Batch:
    return batch(plan, out, reduced=reduced, shard=(index, count), jobs=1, retry_failed=retry_failed)


def map(  # noqa: A001 - the name that executors give it
    executor: _Executor,
    plan: _Path,
    out: _Path,
    *,
    reduced: _Path | None = None,
    shares: int = 64,
    retries: int = 2,
    retry_failed: bool = False,
) -> Batch:
    """Does the runs of a plan that are missing on the workers of an executor, each of which writes its own results.

    Plan, cases and results are on a file system that all workers see. The plan is cut into ``shares``, which workers take one
    after the other, on one thread each. A share whose worker is lost is submitted again, at most ``retries`` times; what it had done is kept.
    """
    paths = [os.path.abspath(path) for path in (plan, out)]
    reduced_path = None if reduced is None else os.path.abspath(reduced)
    rows = batch_status(paths[0], paths[1], reduced=reduced_path).rows
    count = min(optional_whole(shares, "shares", 1) or 1, rows)
    more = optional_whole(retries, "retries", 0) or 0
    again = flag(retry_failed, "retry_failed")
    # A client of dask takes equal calls for one, and hands the result of the first to the next.
    options = {"pure": False} if hasattr(executor, "scheduler_info") else {}

    def submit(index: int) -> Any:
        return executor.submit(_share, *paths, reduced_path, index, count, again, **options)

    futures = {index: submit(index) for index in range(1, count + 1)}
    done: list[Batch] = []
    for index, future in futures.items():
        for attempt in range(more + 1):
            try:
                done.append(future.result())
                break
            except Exception:
                if attempt == more:
                    raise
                future = submit(index)
    return Batch(
        rows=sum(one.rows for one in done),
        kept=sum(one.kept for one in done),
        done=sum(one.done for one in done),
        left_failed=sum(one.left_failed for one in done),
        failed=sorted(failure for one in done for failure in one.failed),
        seconds=max((one.seconds for one in done), default=0.0),
    )
