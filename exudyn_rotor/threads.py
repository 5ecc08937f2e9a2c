"""Dense problems of some hundred coordinates on one thread of the linear algebra library.

Many of them, one after the other, take up to fifty times longer on several threads, which wait
for one another.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock

from threadpoolctl import ThreadpoolController


@cache
def _libraries() -> ThreadpoolController:
    """Return what is loaded; the search takes as long as two eigenvalue problems."""
    return ThreadpoolController()


class _Limit:
    """One thread as long as anyone holds it, also where several threads of Python do."""

    def __init__(self) -> None:
        self._lock, self._holders = Lock(), 0

    def take(self) -> None:
        with self._lock:
            if self._holders == 0:
                self._limiter = _libraries().limit(limits=1, user_api="blas")
            self._holders += 1

    def leave(self) -> None:
        with self._lock:
            self._holders -= 1
            if self._holders == 0:
                self._limiter.restore_original_limits()


_LIMIT = _Limit()


@contextmanager
def one_thread() -> Iterator[None]:
    """Let BLAS and LAPACK use one thread meanwhile; also a decorator."""
    _LIMIT.take()
    try:
        yield
    finally:
        _LIMIT.leave()
