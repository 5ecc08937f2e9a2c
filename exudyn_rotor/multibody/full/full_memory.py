"""Whether a scene with a full body fits into memory, before it is added.

Exudyn factorises the Jacobian of an implicit step by Eigen's ``SparseLU``, ordered by columns
(COLAMD), which fills it several times as much as nested dissection and takes no notice of symmetry.
"""

from __future__ import annotations

from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.choice import estimated_fill
from exudyn_rotor.solvers.memory import TooLittleMemoryError, available_memory

# coordinates below which a step takes less memory than any machine has
_QUICK = 20_000
_QUICK_MEMORY = 2e9
# bytes for every entry of the stiffness matrix, which Exudyn holds many times, and for every
# estimated entry of a factor; peaks of runs of a disc on a shaft with 10,000 to 70,000 coordinates
_PER_ENTRY, _PER_FACTOR_ENTRY = 300.0, 22.0


def needed_bytes(rotor: SolidRotor) -> float:
    """Return about what a full body takes in an implicit run, beside the rotor itself [bytes]."""
    fill = estimated_fill(3 * rotor.node_count)
    return _PER_ENTRY * rotor.stiffness.nnz + _PER_FACTOR_ENTRY * fill.entries


def check_memory(rotor: SolidRotor) -> None:
    """Raise TooLittleMemoryError where an implicit run with a full body would not fit."""
    size, available = 3 * rotor.node_count, available_memory()
    if size < _QUICK and available > _QUICK_MEMORY:
        return
    needed = needed_bytes(rotor)
    if needed > available:
        raise TooLittleMemoryError(
            f"rotor: a full body with {size} displacements needs about {needed / 1e9:.2g} GB in a "
            f"step of Exudyn's sparse solver, and {available / 1e9:.2g} GB of memory are "
            "available; add the reduced rotor, rotor.reduce(…), or use a coarser mesh"
        )
