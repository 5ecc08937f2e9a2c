"""Rayleigh damping of a rotor's own material: one formula in scenes and linear analyses."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import random_rotor

from exudyn_rotor import Formulation, Motion, add_rotor, select_modes
from exudyn_rotor.theory.stiffening import stiffening

FACTORS = {"mass": 0.3, "stiffness": 2e-3}


@pytest.fixture(scope="module")
def rotor():
    return random_rotor(5)


@pytest.fixture(scope="module")
def reduced(rotor):
    return rotor.reduce(4)


def test_free_modes_decay_as_rayleigh_says(reduced):
    """Every flexible mode decays with (α + β ω²)/2, no rigid motion does (textbook)."""
    damped = reduced.with_damping(**FACTORS)
    form = Formulation("none", 0.0, drive="elastic")
    basis = select_modes(damped, form).invariants
    motion = Motion(basis, form, stiffening(basis, "none"))
    by_q, by_v = motion.jacobian(0.0, np.zeros(motion.size), np.zeros(motion.size))
    zero, unit = np.zeros_like(by_q), np.eye(motion.size)
    values = np.linalg.eigvals(np.block([[zero, unit], [by_q, by_v]]))
    omega = reduced.frequencies[6:]
    assert omega.size == 4
    decay = 0.5 * (FACTORS["mass"] + FACTORS["stiffness"] * omega**2)
    expected = -decay + 1j * np.sqrt(omega**2 - decay**2 + 0j)
    found = values[np.argsort(-np.abs(values))[: 2 * omega.size]]
    # the matrix is of order 10, its eigenvectors are well conditioned: 1e-15 · 10 · 100
    for value in expected:
        assert np.abs(found - value).min() < 1e-12
    # rigid motions: double zeros that rounding ε splits by √ε = 1.5e-8, times the order 10
    assert np.abs(np.sort(np.abs(values))[:12]).max() < 1e-6


def test_factors_add_up_and_reach_the_attachment_modes(reduced):
    once = reduced.with_damping(**FACTORS)
    twice = once.with_damping(mass=1.0)
    inv = reduced.invariants
    np.testing.assert_array_equal(once.invariants.D, inv.D + 0.3 * reduced.mode_mass + 2e-3 * inv.K)
    np.testing.assert_array_equal(twice.invariants.D, once.invariants.D + reduced.mode_mass)
    added = reduced.with_attachments
    expected = 0.3 * added.mode_mass + 2e-3 * added.invariants.K
    np.testing.assert_array_equal(once.with_attachments.invariants.D, expected)
    assert not np.any(reduced.invariants.D)


@pytest.mark.parametrize("spin", ["free", 40.0])
def test_a_body_with_factors_is_that_of_a_damped_rotor(reduced, spin):
    """The twelve products of each entry round alike, but in another order: 12 ε of the largest."""
    given, damped = (
        add_rotor(exu.SystemContainer().AddSystem(), rotor, spin=spin, **factors).motion.invariants
        for rotor, factors in (
            (reduced, {"mass_damping": 0.3, "stiffness_damping": 2e-3}),
            (reduced.with_damping(**FACTORS), {}),
        )
    )
    for name in ("M", "K", "D", "G", "C"):
        matrix = getattr(damped, name)
        np.testing.assert_allclose(
            getattr(given, name), matrix, rtol=0.0, atol=3e-15 * np.abs(matrix).max()
        )
    assert np.any(given.D)


@pytest.mark.parametrize(
    ("factors", "kind", "message"),
    [
        ({"mass": -1.0}, ValueError, r"mass: needs a finite number \[1/s\] ≥ 0, got -1.0"),
        ({"stiffness": "low"}, TypeError, r"stiffness: needs a finite number \[s\].* got 'low'"),
        ({"loss": -0.1}, ValueError, "loss: needs a finite number ≥ 0, got -0.1"),
    ],
)
def test_wrong_factors_are_refused(reduced, factors, kind, message):
    with pytest.raises(kind, match=message):
        reduced.with_damping(**factors)
