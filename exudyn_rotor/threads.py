"""Dense problems of some hundred coordinates on one thread of the linear algebra library.

Many of them, one after the other, take up to fifty times longer on several threads, which wait
for one another. Eigenproblems of one stack are shared out instead, each to one thread.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache, partial
from threading import Lock, RLock, local
from typing import TypeVar

import numpy as np
from threadpoolctl import ThreadpoolController

Item, Result = TypeVar("Item"), TypeVar("Result")
_HERE = local()  # of each thread

_WORTH = 30_000  # entries of matrices from which on their eigenproblems are shared out
_PARTS = 4  # for each thread, as not all of them begin at once


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

    def take(self) -> int:
        """Return how many threads there were before anyone held it."""
        with self._lock:
            if self._holders == 0:
                libraries = _libraries().lib_controllers
                self._before = [(each, each.num_threads) for each in libraries]
                for library in libraries:
                    library.set_num_threads(1)
            self._holders += 1
            return max((count for _, count in self._before), default=1)

    def leave(self) -> None:
        with self._lock:
            self._holders -= 1
            if self._holders == 0:
                for library, count in self._before:
                    library.set_num_threads(count)


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


@cache
def _helpers() -> ThreadPoolExecutor:
    """Return threads that stay: to start one takes as long as a solution on a busy machine."""
    return ThreadPoolExecutor(os.cpu_count(), initializer=setattr, initargs=(_HERE, "helps", True))


if hasattr(os, "register_at_fork"):  # a forked process has none of the threads
    os.register_at_fork(after_in_child=_helpers.cache_clear)


def shared(
    function: Callable[[Item], Result],
    items: Sequence[Item],
    first: Callable[[], object] | None = None,
) -> list[Result]:
    """Return ``[function(item) for item in items]``, on as many threads as BLAS may use.

    Each call has one thread of BLAS. It is quicker only where the function spends its time outside
    of Python. This thread calls `first` before it takes items.
    """
    results, left = [None] * len(items), iter(range(len(items)))

    def work() -> None:
        for place in left:
            results[place] = function(items[place])

    with one_thread() as count:
        more = 0 if hasattr(_HERE, "helps") else min(count, len(items)) - 1
        helping = [_helpers().submit(work) for _ in range(more)]
        try:
            if first is not None:
                first()
            work()
        finally:
            for each in helping:
                if not each.cancel():  # one that has not begun may wait for this thread
                    each.result()
    return results


def in_turns(function: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """Return what :func:`shared` does, of a function that mostly runs in Python.

    One thread at a time does; others solve their eigenproblems by :func:`eig` meanwhile. If all ran
    in Python, they would wait for one another at every call of numpy. What calls :func:`eig` must
    hold no lock that another item needs, as a property of ``functools`` does before Python 3.12.
    """
    turn = RLock()  # which knows its owner

    def work(item: Item) -> Result:
        before = getattr(_HERE, "turn", None)
        try:
            turn.acquire()
            _HERE.turn = turn
            return function(item)
        finally:
            _HERE.turn = before
            with suppress(RuntimeError):  # interrupted while it waited, here or in eig
                turn.release()

    return shared(work, items)


@contextmanager
def meanwhile(
    function: Callable[..., Result], *arguments: object
) -> Iterator[Callable[[], Result]]:
    """Let a function run in Python while other threads solve eigenproblems by :func:`eig`.

    What the context gives returns the result, which is computed then where no others did. In
    contexts within one another the outer function runs before.
    """
    result, before = cache(partial(function, *arguments)), getattr(_HERE, "first", None)

    def first() -> None:
        if before is not None:
            before()
        with suppress(Exception):  # which comes up where the result is asked for
            result()

    _HERE.first = first
    try:
        yield result
    finally:
        _HERE.first = before


def eig(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`numpy.linalg.eig` does, a stack (s, k, k) shared out among threads.

    As many as BLAS may use. Each problem is one thread's, so that their number changes no digit.
    """
    with one_thread() as count:
        turn = getattr(_HERE, "turn", None)
        if turn is not None:
            turn.release()
            try:
                return np.linalg.eig(matrices)
            finally:
                turn.acquire()
        if matrices.ndim < 3 or matrices.size < _WORTH or count == 1:
            return np.linalg.eig(matrices)
        parts = np.array_split(matrices, _PARTS * count)
        found = shared(np.linalg.eig, parts, getattr(_HERE, "first", None))
    values, vectors = zip(*found, strict=True)
    return np.concatenate(values), np.concatenate(vectors)
