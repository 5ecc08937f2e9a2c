"""Properties, and functions of an object, that are computed once for each object."""

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar
from weakref import WeakKeyDictionary

Value = TypeVar("Value")


class cached_property(functools.cached_property[Value]):  # noqa: N801, TID251
    """As :class:`functools.cached_property` is from Python 3.12 on: without a lock.

    Before, all objects share the lock of a property. A thread that holds it and waits, for its turn
    to run in Python or for other threads, would wait for good where another one that has the turn,
    or is waited for, needs the property of another object. Threads that compute the value of one
    object at once all get the first one.
    """

    if not TYPE_CHECKING:  # the types are those of functools

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            return instance.__dict__.setdefault(self.attrname, self.func(instance))


def kept(function: Callable[..., Value]) -> Callable[..., Value]:
    """Keep what a function finds of an object as long as the object lives.

    Its other arguments have to be hashable; the result must not refer to the object.
    """
    results: WeakKeyDictionary = WeakKeyDictionary()

    @functools.wraps(function)
    def known(each: object, *rest: object) -> Value:
        found = results.setdefault(each, {})
        return found[rest] if rest in found else found.setdefault(rest, function(each, *rest))

    return known
