"""Centrifugal stiffening against exact rotations and the exact conical modes of rigid rotors."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la
from bodies import MASS, moments
from point_rotors import SKEW_AXIS, random_invariants, ring_rotor

from exudyn_rotor import Formulation, Motion, select_modes
from exudyn_rotor.theory.axis import rotations, skew, translations
from exudyn_rotor.theory.stiffening import stiffening

DISC, SHAFT = (0.3, 0.02), (0.1, 0.4)  # radius, half length of two rings
BODIES = pytest.mark.parametrize("shape", [DISC, SHAFT], ids=["disc", "shaft"])


def rigid_rotor(shape: tuple[float, float]):
    """Return the reduced rotor with its six rigid motions only."""
    return ring_rotor(*shape, MASS).reduce(0)


# ------------------------------------------------------------------ work on exact displacements


def work_of_exact_displacement(arrays: dict, modes: np.ndarray, field: np.ndarray):
    """Return the work of the forces ``M F x`` as a function of modal coordinates.

    A modal displacement is split by least squares in the mass norm into a rigid translation,
    a rotation φ about the centre of mass and a rest; the rotation turns body and rest by
    exp(φ) exactly.
    """
    nodes, mass = arrays["nodes"], arrays["mass"].toarray()
    weights = arrays["mass"].toarray()[::3, ::3].sum(axis=1)
    center = weights @ nodes / weights.sum()
    rigid = np.hstack([translations(len(nodes)), rotations(nodes, center)])
    parts = np.linalg.solve(rigid.T @ mass @ rigid, rigid.T @ mass @ modes)
    rest = modes - rigid @ parts
    force = (mass @ (nodes @ field.T).ravel()).reshape(-1, 3)

    def work(zeta: np.ndarray) -> float:
        shift, phi = np.split(parts @ zeta, 2)
        turn = la.expm(skew(phi))
        bent = nodes - center + (rest @ zeta).reshape(-1, 3)
        return float(np.sum(force * (shift + bent @ turn.T - (nodes - center))))

    return work


def second_derivatives(function, size: int, step: float = 0.02) -> np.ndarray:
    """Return the Hessian at zero from sixth-order central differences along lines."""
    weights = np.array([2, -27, 270, -490, 270, -27, 2]) / 180

    def along(direction: np.ndarray) -> float:
        values = [function(k * step * direction) for k in range(-3, 4)]
        return float(weights @ values) / step**2

    unit = np.eye(size)
    own = np.array([along(unit[i]) for i in range(size)])
    hessian = np.diag(own)
    for i in range(size):
        for j in range(i):
            mixed = along(unit[i] + unit[j]) - own[i] - own[j]
            hessian[i, j] = hessian[j, i] = mixed / 2
    return hessian


@pytest.mark.parametrize("seed", range(3))
def test_terms_are_second_derivatives_of_the_work(seed):
    invariants, modes, arrays = random_invariants(seed)
    e = skew(SKEW_AXIS)
    terms = stiffening(invariants, "tilt")
    centrifugal = work_of_exact_displacement(arrays, modes, -e @ e)
    euler = work_of_exact_displacement(arrays, modes, -e)  # the Euler field is −ω̇ ẽx
    # halving and doubling the step shows 5e-12 of truncation and 3e-12 of round-off
    limit = 1e-10 * np.abs(terms.K2).max()
    np.testing.assert_allclose(terms.K2, -second_derivatives(centrifugal, 4), rtol=0, atol=limit)
    np.testing.assert_allclose(terms.B, -second_derivatives(euler, 4), rtol=0, atol=limit)
    assert np.abs(terms.B).max() > 0.1  # a random rotor is far from axisymmetric


# ------------------------------------------------------------------ rigid rotor on tilt springs


def conical_frequencies(shape, stiffness: float, speed: float) -> np.ndarray:
    """Return |ν − ω| of both roots of ``I_t λ² − i I_p ω λ + k = 0`` with λ = iν, ascending."""
    polar, transverse = moments(shape)
    roots = np.roots([-transverse, polar * speed, stiffness])
    return np.sort(np.abs(roots - speed))


def eigenvalues_on_springs(shape, stiffness: float, speed: float, level: str) -> np.ndarray:
    """Return the eigenvalues of the tilts of a rigid rotor, one of each pair."""
    _, transverse = moments(shape)
    selection = select_modes(rigid_rotor(shape), Formulation("free", speed))
    assert selection.labels == ("tilt 1", "tilt 2")
    held = replace(selection.invariants, K=stiffness / transverse * np.eye(2))
    motion = Motion(held, Formulation("none", speed), stiffening(held, level))
    assert motion.is_constant
    rest = np.zeros(2)
    by_q, by_v = motion.jacobian(0.0, rest, rest)
    state = np.block([[np.zeros((2, 2)), np.eye(2)], [by_q, by_v]])  # the mass matrix is I
    values = np.linalg.eigvals(state)
    return values[np.argsort(values.imag)][2:]


@BODIES
@pytest.mark.parametrize("speed", [0.0, 40.0, 400.0, 4000.0])
def test_conical_modes_are_exact(shape, speed):
    stiffness = 1e4
    values = eigenvalues_on_springs(shape, stiffness, speed, "tilt")
    expected = conical_frequencies(shape, stiffness, speed)
    np.testing.assert_allclose(values.imag, expected, rtol=1e-9)
    np.testing.assert_allclose(values.real, 0.0, atol=1e-9 * expected[-1])
