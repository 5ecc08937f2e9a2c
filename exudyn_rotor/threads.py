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
    """Return what is loaded; the search takes as long as two eigenvalue problems.

    MKL beside another one is Pardiso's, not numpy's.
    """
    loaded = ThreadpoolController().select(user_api="blas")
    names = {each.internal_api for each in loaded.lib_controllers}
    return loaded.select(internal_api=sorted(names - {"mkl"} or names))


class _Limit:
    """One thread as long as anyone holds it, also where several threads of Python do."""

    def __init__(self) -> None:
        self._lock, self._holders = Lock(), 0

    def take(self) -> None:
        with self._lock:
            if self._holders == 0:
                libraries = _libraries().lib_controllers
                self._before = [(each, each.num_threads) for each in libraries]
                for library in libraries:
                    library.set_num_threads(1)
            self._holders += 1

    def leave(self) -> None:
        with self._lock:
            self._holders -= 1
            if self._holders == 0:
                for library, count in self._before:
                    library.set_num_threads(count)


_LIMIT = _Limit()


@contextmanager
def one_thread() -> Iterator[None]:
    """Let BLAS and LAPACK use one thread meanwhile; also a decorator."""
    _LIMIT.take()
    try:
        yield
    finally:
        _LIMIT.leave()
