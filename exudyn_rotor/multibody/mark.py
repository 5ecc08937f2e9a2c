"""A mark on an item of an ``mbs``, by which it is known again.

Numbers and names do not say whether an item is still the one that was added: after ``mbs.Reset()``
another rotor may have the same. The mark is the colour of an object that is never drawn.
"""

from __future__ import annotations

from itertools import count

import exudyn

_BASE = 2**23  # single precision holds whole numbers up to twice that
_SIGN = -2.0  # no opacity of a colour
_numbers = count(1)

Mark = tuple[float, float]
ENTRY = "exudyn_rotor"  # the package's one entry of mbs.sys


def entry(mbs: exudyn.MainSystem) -> dict:
    """Return the package's own entry of ``mbs.sys``."""
    return mbs.sys.setdefault(ENTRY, {})


def mark_of(mbs: exudyn.MainSystem, item: exudyn.ObjectIndex) -> Mark | None:
    """Return the mark of an object; None where it has none, or there is no such object."""
    if int(item) >= mbs.systemData.NumberOfObjects():
        return None
    try:
        color = mbs.GetObjectParameter(item, "Vcolor")
    # an item of another kind; Exudyn's errors have no common base but this
    except Exception:
        return None
    return (color[0], color[1]) if len(color) == 4 and color[3] == _SIGN else None


def set_mark(mbs: exudyn.MainSystem, item: exudyn.ObjectIndex) -> Mark | None:
    """Put a new mark on an object that has none, and return its mark; None if it takes none."""
    known = mark_of(mbs, item)
    if known is None and int(item) < mbs.systemData.NumberOfObjects():
        high, low = divmod(next(_numbers), _BASE)
        mbs.SetObjectParameter(item, "Vcolor", [float(high), float(low), 0.0, _SIGN])
        known = mark_of(mbs, item)
    return known
