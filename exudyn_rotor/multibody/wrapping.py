"""The one method of Exudyn's ``MainSystem`` that does more for rotors: ``mbs.Assemble()``.

Markers, loads and connectors are all known when a system is assembled. What happens then stands in
:mod:`exudyn_rotor.multibody.rotor.assembly`, which a scene without rotors does not load.
"""

from __future__ import annotations

from functools import wraps

import exudyn
from exudyn.misc.extensionRegistry import extends, install

from exudyn_rotor.multibody import ENTRY

_OWN = "_knows_fixed_axis_rotors"  # attribute of the wrapped method


def _wrap_assemble() -> None:
    """Let ``mbs.Assemble()`` look after rotors; once, however often the package is imported."""
    original = exudyn.MainSystem.Assemble
    if hasattr(original, _OWN):
        return

    @wraps(original)
    def assemble(mbs: exudyn.MainSystem) -> None:
        if ENTRY not in mbs.sys:
            return original(mbs)
        from exudyn_rotor.multibody.rotor import assembly

        assembly.prepare(mbs)
        original(mbs)
        return assembly.warn_of_lost_connections(mbs, stacklevel=3)

    setattr(assemble, _OWN, True)
    if hasattr(original, "_exudynExtension"):
        # registered, or Exudyn's own would be put back with the next extension
        extends(exudyn.MainSystem, "Assemble")(assemble)
        install()
    else:
        exudyn.MainSystem.Assemble = assemble


_wrap_assemble()
