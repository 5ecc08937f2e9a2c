"""Two rings of masses about any axis, with interfaces, for scenes with drives and gears."""

import numpy as np
from numpy.typing import ArrayLike
from point_rotors import ring_rotor

from exudyn_rotor import SolidRotor, SpinAxis, recommended_settings
from exudyn_rotor.theory.rotating_axes import axes_of

J = 0.05  # m r² of the rings [kg m²]
Z = [0.0, 0.0, 1.0]


def rings(axis: ArrayLike = Z, heavy: float = 0.0) -> SolidRotor:
    """Return two rings of 5 kg together, radius 0.1 m, 'left' and 'right', 0.3 m apart.

    `heavy` [kg] is a point mass on the right ring, along n1.
    """
    upright = ring_rotor(0.1, 0.15, 5.0)
    turn = axes_of(SpinAxis(axis))
    whole = np.kron(np.eye(10), turn)
    stiffness = whole @ upright.stiffness @ whole.T
    rotor = SolidRotor.from_matrices(upright.mass, stiffness, upright.nodes @ turn.T, axis)
    if heavy:
        rotor = rotor.add_point_mass(turn @ [0.1, 0.0, 0.15], heavy)
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))


def run(mbs, end_time, steps, body=None, accuracy=1e-6):
    """Assemble and run a scene, sensors at every step."""
    mbs.Assemble()
    settings = recommended_settings(end_time, end_time / steps, accuracy=accuracy, body=body)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.adaptiveStep = False  # a step that fails is an error at once
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = end_time / steps
    assert mbs.SolveDynamic(settings)


def speed_of(body):
    """Return the spin speed of a rotor with a free spin [rad/s]."""
    return float(body.coordinates()[1][body.formulation.translation_count])
