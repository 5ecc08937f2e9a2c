"""Geared rotors in linear analyses: against constant equations at rest and closed forms."""

import numpy as np
import pytest
from train_models import FIRST, SECOND, exponents_of, rings

from exudyn_rotor import GearMesh, Link, RotorTrain, Support, campbell, stability


def gears(lines: float = 0.3) -> GearMesh:
    """Return a mesh of ratio −0.5 with a helix, its line of action askew."""
    angles = {"line_angle": lines, "helix_angle": 0.2, "pressure_angle": 0.35}
    return GearMesh(radii=[0.1, 0.2], stiffness=3e6, damping=30.0, **angles)


def test_geared_rotors_are_those_of_constant_equations_at_rest():
    """In axes at rest everything is constant, and six coordinates a rotor give the exponents."""
    mesh, speed = gears(), 200.0
    v, (k, c) = mesh.direction, (mesh.stiffness, mesh.damping)
    held = np.diag([3e5, 2e5, 1e5])
    supports = {n: [Support(p, held, 10.0 * np.eye(3)) for p in "ab"] for n in "AB"}
    M, D, K = np.zeros((12, 12)), c * np.outer(v, v), k * np.outer(v, v)
    for o, (r, half, m), rate in ((0, FIRST, speed), (6, SECOND, -0.5 * speed)):
        polar, transverse = m * r**2, m * (0.5 * r**2 + half**2)
        M[range(o, o + 6), range(o, o + 6)] = m, m, m, transverse, transverse, polar
        D[o + 3, o + 4] += polar * rate
        D[o + 4, o + 3] -= polar * rate
        for z in (-half, half):
            rows = np.zeros((3, 12))
            rows[:, o : o + 6] = np.eye(3, 6)
            rows[0, o + 4], rows[1, o + 3] = z, -z
            K += rows.T @ held @ rows
            D += 10.0 * rows.T @ rows
    # the mesh is at the middle of both rotors
    rotors = {n: rings(*d).with_interface("gear", range(10)).reduce(0)
              for n, d in (("A", FIRST), ("B", SECOND))}  # fmt: skip
    links = [Link("A:gear", "B:gear", mesh)]
    train = RotorTrain(rotors, {"A": 1.0, "B": -0.5}, supports, links)
    found = campbell(train, [0.0, speed])
    exact = exponents_of(M, D, K)
    exact = exact[exact.imag > 1.0]  # without the common spin, which is free
    assert len(exact) == 11
    values = found.growth[-1] + 1j * found.frequencies_inertial[-1]
    assert np.abs(exact[:, None] - values).min(axis=1).max() < 1e-6
    assert sum("spin" in motion for motion in found.free_motions) == 1
    assert stability(train, [speed]).exponents.shape == (1, 11)  # without the free spin
    with pytest.raises(ValueError, match=r"turn with 1 and -0.5, not 0.5, times"):
        RotorTrain(rotors, {"A": 1.0, "B": 0.5}, supports, links)
