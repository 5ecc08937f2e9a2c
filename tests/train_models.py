"""Trains of rotors that several tests share, and the equations of two rigid ones."""

from functools import cache

import numpy as np
import scipy.linalg as la
from point_rotors import free_stiffness, ring_rotor

from exudyn_rotor import Link, ReducedRotor, RotorTrain, SolidRotor, Support

LATERAL = ("forward", "backward", "mixed")
AXIS = {"x": [1.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0]}
# radius, half length and mass of two rigid rotors; stiffness and damping of springs
FIRST, SECOND = (0.2, 0.05, 4.0), (0.15, 0.05, 3.0)
GROUND, BETWEEN = (3e5, 20.0), (2e5, 15.0)
UNEVEN = np.array([[3e5, 2e4], [-1e4, 2e5]])


def rings(radius: float, half: float, mass: float, axis: str = "z") -> SolidRotor:
    """Return two rings of masses with the interfaces 'a' (lower) and 'b'."""
    made = ring_rotor(radius, half, mass)
    turned = np.roll(np.array(made.nodes), 1 if axis == "x" else 0, axis=1)
    made = SolidRotor.from_matrices(
        made.mass, free_stiffness(turned, 1e8 * np.eye(30)), turned, axis
    )
    along = turned @ AXIS[axis]
    return made.with_interface("a", np.flatnonzero(along < 0)).with_interface(
        "b", np.flatnonzero(along > 0)
    )


@cache
def rigid(*dimensions: float, axis: str = "z") -> ReducedRotor:
    """Return a rigid rotor."""
    return rings(*dimensions, axis).reduce(0)


def at(rotor: int, z: float) -> np.ndarray:
    """Return displacement at z, x + βz and y − αz, by the coordinates of both rotors."""
    rows = np.zeros((2, 8))
    rows[:, 4 * rotor : 4 * rotor + 4] = [[1.0, 0.0, 0.0, z], [0.0, 1.0, -z, 0.0]]
    return rows


def two_discs(ratio: float, ground=GROUND[0], axis: str = "z", **changes) -> RotorTrain:
    """Return two rigid rotors, the second on the first and softly on the ground."""
    k, c = BETWEEN
    links = [Link(f"A:{n}", f"B:{n}", Support(n, f * k, c)) for n, f in (("a", 1.0), ("b", 1.5))]
    stiff = np.asarray(ground) * np.ones((2, 2)) if np.ndim(ground) else ground * np.eye(2)
    supports = {
        "A": [Support("a", stiff, GROUND[1]), Support("b", 1.3 * stiff, GROUND[1])],
        "B": [Support("b", 5e4)],
    }
    rotors = {"A": rigid(*FIRST), "B": rigid(*SECOND, axis=axis)}
    return RotorTrain(rotors, {"A": 1.0, "B": ratio}, supports, links, **changes)


def by_hand(
    ratio: float, speed: float, ground=GROUND[0], damped: bool = True
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, D and K of two rigid rotors: per rotor x, y and the tilts α, β about them.

    ``I_t α̈ + I_p Ω β̇ = M_α, I_t β̈ − I_p Ω α̇ = M_β``.
    """
    M, D, K = np.zeros((8, 8)), np.zeros((8, 8)), np.zeros((8, 8))
    for o, (r, half, m), rate in ((0, FIRST, speed), (4, SECOND, ratio * speed)):
        polar, transverse = m * r**2, m * (0.5 * r**2 + half**2)
        M[range(o, o + 4), range(o, o + 4)] = m, m, transverse, transverse
        D[o + 2, o + 3], D[o + 3, o + 2] = polar * rate, -polar * rate
    stiff = ground if np.ndim(ground) else ground * np.eye(2)
    (za, zb), (k, c) = (FIRST[1], SECOND[1]), BETWEEN
    for rows, spring, damper in (
        (at(0, -za), stiff, GROUND[1]),
        (at(0, za), 1.3 * stiff, GROUND[1]),
        (at(1, zb), 5e4 * np.eye(2), 0.0),
        (at(0, -za) - at(1, -zb), k * np.eye(2), c),
        (at(0, za) - at(1, zb), 1.5 * k * np.eye(2), c),
    ):
        K += rows.T @ spring @ rows
        D += damped * damper * rows.T @ rows
    return M, D, K


def exponents_of(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return the exponents with Im λ > 0."""
    zero, one = np.zeros_like(M), np.eye(len(M))
    values = la.eigvals(np.block([[zero, one], [-la.solve(M, K), -la.solve(M, D)]]))
    return values[values.imag > 0.0]


def lateral(result, row: int = -1) -> np.ndarray:
    """Return growth + i inertial frequency of lateral modes, ascending in frequency."""
    chosen = np.isin(result.whirl[row], LATERAL)
    values = result.growth[row, chosen] + 1j * result.frequencies_inertial[row, chosen]
    return values[np.argsort(values.imag)]


def bar() -> ReducedRotor:
    """Return a rigid rotor whose transverse moments differ: four masses on two bars."""
    nodes = np.array([[0.2, 0, -0.05], [-0.2, 0, -0.05], [0.2, 0, 0.05], [-0.2, 0, 0.05]])
    K = free_stiffness(nodes, 1e8 * np.eye(12))
    made = SolidRotor.from_matrices(np.eye(12), K, nodes, "z")
    return made.with_interface("a", [0, 1]).with_interface("b", [2, 3]).reduce(0)
