"""``mbs.GetDictionary()`` of a scene whose rotors have Python user functions.

Exudyn refuses to put objects with user functions into a dictionary, unless
``exudyn.special.exceptions.dictionaryNonCopyable`` is False. Those of a rotor hold nothing that
belongs to one ``mbs``, so that ``SetDictionary`` of another one in the same process gives the same
motion. :func:`install` therefore lets ``GetDictionary`` put that setting aside where rotors of this
package alone have user functions. Other objects are refused as before, and so is pickling:
functions that are made at run time cannot go to another process.
"""

from __future__ import annotations

from functools import wraps

import exudyn

from exudyn_rotor.multibody.mark import mark_of

_get_dictionary = exudyn.MainSystem.GetDictionary


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


@wraps(_get_dictionary)
def GetDictionary(self: exudyn.MainSystem) -> dict:
    """Return all data of the system as Exudyn does; the functions of rotors are no obstacle."""
    exceptions = exudyn.special.exceptions
    refused = exceptions.dictionaryNonCopyable
    exceptions.dictionaryNonCopyable = refused and not _only_rotors_have_functions(self)
    try:
        return _get_dictionary(self)
    finally:
        exceptions.dictionaryNonCopyable = refused


def install() -> None:
    """Put :func:`GetDictionary` in the place of Exudyn's."""
    exudyn.MainSystem.GetDictionary = GetDictionary
