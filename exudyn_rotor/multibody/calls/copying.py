"""``mbs.GetDictionary()`` of a scene whose rotors have Python user functions.

Exudyn refuses to put objects with user functions into a dictionary, unless
``exudyn.special.exceptions.dictionaryNonCopyable`` is False. Those of a rotor hold nothing that
belongs to one ``mbs``, so that ``SetDictionary`` of another one in the same process gives the same
motion. ``GetDictionary`` therefore puts that setting aside where rotors of this
package alone have user functions. Other objects are refused as before, and so is pickling:
functions that are made at run time cannot go to another process.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn

from exudyn_rotor.multibody.mark import mark_of
from exudyn_rotor.multibody.wrapping import wraps_method


def _only_rotors_have_functions(mbs: exudyn.MainSystem) -> bool:
    for number in range(mbs.systemData.NumberOfObjects()):
        functions = (
            value
            for name, value in mbs.GetObject(number).items()
            if name.endswith("UserFunction") and not name.startswith("V")  # V: drawing
        )
        if mark_of(mbs, number) is None and any(value != 0 for value in functions):
            return False
    return True


@wraps_method("GetDictionary")
def _get_dictionary(get_dictionary: Callable, mbs: exudyn.MainSystem) -> dict:
    """Return all data of the system as Exudyn does; the functions of rotors are no obstacle."""
    exceptions = exudyn.special.exceptions
    refused = exceptions.dictionaryNonCopyable
    exceptions.dictionaryNonCopyable = refused and not _only_rotors_have_functions(mbs)
    try:
        return get_dictionary(mbs)
    finally:
        exceptions.dictionaryNonCopyable = refused
