"""What a function finds of an object, kept as long as the object lives."""

import functools
from collections.abc import Callable
from typing import TypeVar
from weakref import WeakKeyDictionary

Value = TypeVar("Value")


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
