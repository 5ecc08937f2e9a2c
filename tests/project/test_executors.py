"""Sweeps give the same numbers here, on threads, on processes and on a cluster."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager

import pytest
from dask.distributed import Client, LocalCluster

from exudyn_rotor.sweep import sweep


@contextmanager
def dask_cluster():
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client.get_executor()


EXECUTORS = {
    "threads": lambda: ThreadPoolExecutor(2),
    "processes": lambda: ProcessPoolExecutor(2),
    "dask": dask_cluster,
}


@pytest.fixture(params=EXECUTORS)
def executor(request):
    with EXECUTORS[request.param]() as made:
        yield made


def inverse(value: float) -> float:
    if value == 3.0:
        raise ValueError("three is not allowed")
    return 1.0 / value


def test_order_and_numbers(executor):
    values = [float(value) for value in range(4, 204)]
    assert sweep(inverse, values, executor=executor) == [1.0 / value for value in values]
    assert sweep(inverse, [], executor=executor) == []


def test_errors_name_the_value(executor):
    with pytest.raises(ValueError, match=r"inverse at 3\.0: three is not allowed"):
        sweep(inverse, [1.0, 2.0, 3.0], executor=executor, label="inverse")
    with pytest.raises(RuntimeError, match=r"sweep at 0\.0: ZeroDivisionError"):
        sweep(inverse, [1.0, 0.0], executor=executor)
