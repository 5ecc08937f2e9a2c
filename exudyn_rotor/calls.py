"""Around calls of functions: what is kept of an object, whose line a warning points at, one thread.

Dense problems of some hundred coordinates, many of them one after the other, take up to fifty
times longer on several threads of the linear algebra library, which wait for one another.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from typing import TypeVar

from threadpoolctl import ThreadpoolController

Value = TypeVar("Value")
# what stands between functions of the package: decorators, cached properties
_WITHIN = "exudyn_rotor.", "contextlib", "functools"


def kept(function: Callable[..., Value]) -> Callable[..., Value]:
    """Keep what a function finds of an object as long as the object lives, within the object.

    Its other arguments have to be hashable.
    """
    name = f"{function.__module__}.{function.__qualname__}"

    @functools.wraps(function)
    def known(each: object, *rest: object) -> Value:
        found = vars(each).setdefault("_kept", {})
        key = name, *rest
        return found[key] if key in found else found.setdefault(key, function(each, *rest))

    return known


def user_level() -> int:
    """Return the stack level of the first caller outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(_WITHIN):
        frame, level = frame.f_back, level + 1
    return level


@functools.cache
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
