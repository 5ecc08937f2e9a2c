"""What a function finds of an object, kept as long as the object lives."""

import functools
from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")


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
