"""Dense problems of some hundred coordinates on one thread of the linear algebra library.

Many of them, one after the other, take up to fifty times longer on several threads, which wait
for one another. Eigenproblems of one stack are shared out instead, each to one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from threading import Lock

import numpy as np
from threadpoolctl import ThreadpoolController

_WORTH = 30_000  # entries of matrices from which on their eigenproblems are shared out


@cache
def _libraries() -> ThreadpoolController:
    """Return what is loaded; the search takes as long as two eigenvalue problems."""
    return ThreadpoolController().select(user_api="blas")


class _Limit:
    """One thread as long as anyone holds it, also where several threads of Python do."""

    def __init__(self) -> None:
        self._lock, self._holders = Lock(), 0

    def take(self) -> int:
        """Return how many threads there were before anyone held it."""
        with self._lock:
            if self._holders == 0:
                self._before = max((each["num_threads"] for each in _libraries().info()), default=1)
                self._limiter = _libraries().limit(limits=1)
            self._holders += 1
            return self._before

    def leave(self) -> None:
        with self._lock:
            self._holders -= 1
            if self._holders == 0:
                self._limiter.restore_original_limits()


_LIMIT = _Limit()


@contextmanager
def one_thread() -> Iterator[int]:
    """Let BLAS and LAPACK use one thread meanwhile; also a decorator.

    As a context it gives the number of threads that they use otherwise.
    """
    before = _LIMIT.take()
    try:
        yield before
    finally:
        _LIMIT.leave()


def eig(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`numpy.linalg.eig` does, a stack (s, k, k) shared out among threads.

    As many as BLAS may use. Each problem is one thread's, so that their number changes no digit.
    """
    with one_thread() as count:
        if matrices.ndim < 3 or matrices.size < _WORTH or count == 1:
            return np.linalg.eig(matrices)
        with ThreadPoolExecutor(count) as executor:
            found = executor.map(np.linalg.eig, np.array_split(matrices, count))
            values, vectors = zip(*found, strict=True)
    return np.concatenate(values), np.concatenate(vectors)
