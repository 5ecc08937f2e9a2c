"""The rotor of the examples in docstrings: two masses on a rod."""

from __future__ import annotations

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.solid_rotor import SolidRotor

_HALF, _ROD = 0.1, 1e8  # half of the length [m], stiffness along the axis [N/m]


def rotor_example(masses: tuple[float, float] = (2.0, 2.0)) -> SolidRotor:
    """Return two point masses on a rod along z: interfaces 'left' and 'right', 0.2 m apart.

    The rod is stiff along the axis alone, so that each mass on its support is an oscillator.

    Parameters
    ----------
    masses : two floats, optional
        Of 'left' and 'right' [kg].

    Raises
    ------
    TypeError, ValueError
        For masses that are not two positive numbers.

    Examples
    --------
    >>> from exudyn_rotor import rotor_example
    >>> rotor = rotor_example()
    >>> rotor.total_mass, sorted(rotor.interfaces)
    (4.0, ['left', 'right'])
    """
    values = checks.one_or_each(masses, "masses", "kg", 2, above=0.0)
    along = np.kron([[1.0, -1.0], [-1.0, 1.0]], np.diag([0.0, 0.0, _ROD]))
    nodes = [[0.0, 0.0, -_HALF], [0.0, 0.0, _HALF]]
    rotor = SolidRotor.from_matrices(np.diag(np.repeat(values, 3)), along, nodes, "z")
    return rotor.with_interface("left", [0]).with_interface("right", [1])
