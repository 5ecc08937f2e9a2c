"""Laws that hold for every rotor: random masses, springs, axes, states and formulations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    SolidRotor,
    SpinAxis,
    stability,
)
from exudyn_rotor.theory.stiffening import stiffening

EXACT = 1e-11  # sums of some hundred products of order 1, over gaps between eigenvalues
FLEXIBLE = 3
SPEED = 0.7

seeds = st.integers(0, 2**32 - 1)
counts = st.integers(4, 8)
factors = st.floats(0.05, 20.0)
examples = settings(max_examples=15, deadline=None, derandomize=True)
LEVELS = pytest.mark.parametrize("level", ["none", "tilt"])


# ------------------------------------------------------------------ random rotors


def springs(rng: np.random.Generator, nodes: np.ndarray) -> np.ndarray:
    """Return the stiffness (3n, 3n) of springs between all pairs of nodes."""
    stiffness = np.zeros((nodes.size, nodes.size))
    for i in range(len(nodes)):
        for j in range(i):
            stretch = np.zeros_like(nodes)
            stretch[i] = (nodes[i] - nodes[j]) / np.linalg.norm(nodes[i] - nodes[j])
            stretch[j] = -stretch[i]
            stiffness += rng.uniform(0.5, 3.0) * np.outer(stretch, stretch)
    return stiffness


def arrays_of(seed: int, count: int) -> dict:
    """Return what ``SolidRotor.from_matrices`` takes: point masses with springs and dampers."""
    rng = np.random.default_rng(seed)
    nodes = rng.normal(size=(count, 3))
    return {
        "mass": np.diag(np.repeat(rng.uniform(0.3, 3.0, count), 3)),
        "stiffness": springs(rng, nodes),
        "damping": 0.1 * springs(rng, nodes),
        "nodes": nodes,
        "axis": SpinAxis(rng.normal(size=3), rng.normal(size=3)),
        "check_units": False,
    }


def assert_small(value, scale, tolerance=EXACT):
    assert np.abs(value).max() <= tolerance * np.abs(scale).max()


# ------------------------------------------------------------------ invariants


def frame_free(reduced, level: str) -> np.ndarray:
    """Return numbers that no choice of mesh axes, origin or signs of modes changes."""
    inv = reduced.invariants
    terms = stiffening(inv, level)
    matrices = (inv.K - SPEED**2 * (inv.C - terms.K2), inv.G.T @ inv.G, terms.B)
    values = [np.linalg.eigvalsh(matrix) for matrix in matrices]
    axis = reduced.axis.radial(reduced.center_of_mass)
    return np.concatenate(
        [*values, [inv.mass, inv.Theta, np.linalg.norm(inv.h), np.linalg.norm(axis)]]
    )


@LEVELS
@examples
@given(seeds, counts)
def test_mesh_axes_and_origin_do_not_matter(level, seed, count):
    arrays = arrays_of(seed, count)
    rng = np.random.default_rng([seed, 3])
    turn, shift = Rotation.random(rng=rng).as_matrix(), 5.0 * rng.normal(size=3)
    nodal = np.kron(np.eye(count), turn)
    axis = arrays["axis"].turned(turn)
    moved = arrays | {
        "stiffness": nodal @ arrays["stiffness"] @ nodal.T,
        "damping": nodal @ arrays["damping"] @ nodal.T,
        "nodes": arrays["nodes"] @ turn.T + shift,
        "axis": SpinAxis(axis.direction, axis.point + shift),
    }
    expected, found = (
        frame_free(SolidRotor.from_matrices(**given).reduce(FLEXIBLE), level)
        for given in (arrays, moved)
    )
    assert_small(found - expected, expected, 1e-10)


@pytest.mark.filterwarnings("ignore:the (centre of mass|nearest principal axis) is")
@examples
@given(seeds, counts, factors, factors, factors)
def test_units_do_not_matter(seed, count, length, mass, time):
    arrays = arrays_of(seed, count)
    scaled = arrays | {
        "mass": mass * arrays["mass"],
        "stiffness": mass / time**2 * arrays["stiffness"],
        "damping": mass / time * arrays["damping"],
        "nodes": length * arrays["nodes"],
        "axis": SpinAxis(arrays["axis"].direction, length * arrays["axis"].point),
    }
    first, second = (
        SolidRotor.from_matrices(**given).reduce(FLEXIBLE) for given in (arrays, scaled)
    )
    a, b = first.invariants, second.invariants
    assert_small(second.frequencies * time - first.frequencies, first.frequencies)
    assert_small(b.Theta / (mass * length**2) - a.Theta, a.Theta)
    # the columns are mass-normalised, so a modal coordinate has the unit √kg m
    load = np.linalg.norm(a.h)
    assert_small(np.linalg.norm(b.h) / (np.sqrt(mass) * length) - load, load)
    expected, found = (np.linalg.eigvalsh(stiffening(inv, "tilt").K2) for inv in (a, b))
    assert_small(found - expected, expected)
    speeds = np.array([0.2, SPEED])
    expected, found = stability(first, speeds), stability(second, speeds / time)
    # free rigid motions are double roots, which keep half the digits
    assert_small(found.growth * time - expected.growth, first.frequencies, 1e-6)
