"""What is computed once for each object, and let go with it."""

import gc
import weakref

from exudyn_rotor.cached import kept


class Thing:
    """An object that can be forgotten."""


def test_results_are_kept_for_each_object_and_argument_as_long_as_it_lives():
    calls, released = [], []

    @kept
    def found(each: Thing, level: str = "") -> object:
        """Return an object of its own."""
        calls.append((id(each), level))
        result = Thing()
        weakref.finalize(result, released.append, level)
        return result

    one, other = Thing(), Thing()
    assert found(one, "tilt") is found(one, "tilt")
    assert found(one, "full") is not found(one, "tilt")
    assert found(other, "tilt") is not found(one, "tilt")
    assert len(calls) == 3
    assert found.__doc__ == "Return an object of its own."
    del one
    gc.collect()
    assert sorted(released) == ["full", "tilt"]
