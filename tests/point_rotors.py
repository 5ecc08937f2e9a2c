"""Small rotors of point masses, rings and random ones, for tests of the equations."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import rotations, translations
from exudyn_rotor.theory.invariants import Invariants

SKEW_AXIS = np.array([2.0, -1.0, 2.0]) / 3.0


def random_arrays(seed: int, node_count: int = 6) -> dict[str, np.ndarray | sp.csr_array]:
    """Return nodes, a consistent mass matrix and a free stiffness of a random rotor."""
    rng = np.random.default_rng(seed)
    nodes = rng.normal(size=(node_count, 3))
    return {
        "nodes": nodes,
        "mass": random_mass(rng, node_count),
        "stiffness": free_stiffness(nodes, random_spd(rng, 3 * node_count)),
    }


def random_rotor(seed: int, axis: ArrayLike = SKEW_AXIS, **changes) -> SolidRotor:
    """Return a free random rotor of six nodes."""
    return SolidRotor.from_matrices(**random_arrays(seed), axis=axis, **changes)


def random_invariants(
    seed: int, mode_count: int = 4, direction: np.ndarray = SKEW_AXIS
) -> tuple[Invariants, np.ndarray, dict]:
    """Return invariants in random modes without any property, the modes and the FE arrays."""
    arrays = random_arrays(seed)
    rng = np.random.default_rng([seed, 1])
    modes = rng.normal(size=(arrays["mass"].shape[0], mode_count))
    damping = sp.csr_array(0.1 * random_spd(rng, len(modes)))
    arrays["damping"] = damping
    invariants = Invariants.of(**arrays, basis=modes, direction=direction)
    return invariants, modes, arrays


def random_mass(rng: np.random.Generator, node_count: int) -> sp.csr_array:
    """Return a symmetric positive definite mass matrix with blocks of I₃ (24)."""
    return sp.csr_array(sp.kron(random_spd(rng, node_count), np.eye(3)))


def random_spd(rng: np.random.Generator, size: int) -> np.ndarray:
    """Return a well-conditioned symmetric positive definite matrix of order 1."""
    factor = rng.normal(size=(size, size)) / np.sqrt(size)
    return factor @ factor.T + 0.5 * np.eye(size)


def free_stiffness(nodes: np.ndarray, stiffness: np.ndarray) -> sp.csr_array:
    """Return `stiffness` without its resistance to the rigid motions."""
    rigid = np.hstack([translations(len(nodes)), rotations(nodes, nodes.mean(axis=0))])
    elastic = np.eye(len(rigid)) - rigid @ np.linalg.pinv(rigid)
    return sp.csr_array(elastic @ stiffness @ elastic)


def ring_rotor(
    radius: float, half_length: float, mass: float, axis: str | ArrayLike = "z"
) -> SolidRotor:
    """Return two rings of five equal masses in the planes z = ±half_length, axis z.

    ``I_p = m r²`` and ``I_t = m (r²/2 + l²)`` exactly, as for every regular polygon.
    """
    angle = 2.0 * np.pi * np.arange(5) / 5
    circle = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(5)])
    nodes = np.vstack([circle, circle]) + np.repeat([-half_length, half_length], 5)[
        :, None
    ] * np.array([0.0, 0.0, 1.0])
    stiffness = free_stiffness(nodes, 1e8 * np.eye(3 * len(nodes)))
    return SolidRotor.from_matrices(mass / 10 * np.eye(3 * len(nodes)), stiffness, nodes, axis)
