"""Rotors of a few point masses whose motions are known in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import SolidRotor, Support
from exudyn_rotor.theory.axis import rotations, translations


def deformations(nodes: np.ndarray, soft: np.ndarray) -> np.ndarray:
    """Return a projector (3n, 3n) on all that is neither a rigid motion nor in `soft` (3n, s)."""
    kept = np.hstack([translations(len(nodes)), rotations(nodes, nodes.mean(axis=0)), soft])
    return np.eye(len(kept)) - kept @ np.linalg.pinv(kept)


def polygon(count: int, radius: float, height: float) -> np.ndarray:
    """Return the corners (count, 3) of a regular polygon across z."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)])


def two_rings(
    mass: float = 2.0,
    radius: float = 0.1,
    half_length: float = 0.06,
    *,
    count: int = 4,
    spring: float = 1e8,
    axis: ArrayLike | str = "z",
    offset: ArrayLike = (0.0, 0.0, 0.0),
    unbalance: float = 0.0,
) -> SolidRotor:
    """Return two rings of `count` equal masses at z = ±half_length, interface 'all'.

    ``I_p = m r²`` and ``I_t = m (r²/2 + l²)``. `spring` resists every deformation alike [N/m].
    `unbalance` shifts this share of the mass of one point of each ring to its opposite, at the two
    rings in opposite directions, which leaves ``I_p`` and the centre of mass as they are (even
    `count`).
    """
    nodes = np.vstack([polygon(count, radius, side * half_length) for side in (1.0, -1.0)])
    shares = np.full(2 * count, 1.0)
    for point, sign in ((0, 1.0), (count // 2, -1.0), (count, -1.0), (count + count // 2, 1.0)):
        shares[point] += sign * unbalance
    stiffness = spring * deformations(nodes, np.zeros((nodes.size, 0)))
    return SolidRotor.from_matrices(
        np.diag(np.repeat(mass / (2 * count) * shares, 3)),
        stiffness,
        nodes + np.asarray(offset, dtype=float),
        axis,
        interfaces={"all": range(2 * count)},
        check_units=False,
    )


def shaft_rotor(
    disc: float = 10.0,
    end: float = 1.0,
    bending: tuple[float, float] = (4e5, 4e5),
    *,
    length: float = 0.4,
    radius: float = 0.1,
) -> SolidRotor:
    """Return a disc of four points between two end masses on the axis, interfaces 'left', 'right'.

    `bending` are the springs between disc and the mean of the ends in the rotor's x and y [N/m];
    all else is some thousand times stiffer.
    """
    ends = np.array([[0.0, 0.0, -0.5 * length], [0.0, 0.0, 0.5 * length]])
    nodes = np.vstack([polygon(4, radius, 0.0), ends])
    relative = np.array([0.25] * 4 + [-0.5] * 2)  # mean of the disc less mean of the ends
    soft = np.kron(relative[:, None], np.eye(3)[:, :2])
    stiffness = soft @ np.diag(bending) @ soft.T + 1e4 * max(bending) * deformations(nodes, soft)
    return SolidRotor.from_matrices(
        np.diag(np.repeat([disc / 4] * 4 + [end] * 2, 3)),
        stiffness,
        nodes,
        "z",
        interfaces={"left": [4], "right": [5]},
        check_units=False,
    )


def shaft_frequencies(disc: float, end: float, bending: float, bearing: float) -> np.ndarray:
    """Return both lateral frequencies of :func:`shaft_rotor`, each end on a spring [rad/s].

    Disc and mean of the ends are a chain of two masses; the springs add up, as the ends do.
    """
    stiffness = np.array([[bending, -bending], [-bending, bending + 2.0 * bearing]])
    scale = 1.0 / np.sqrt([disc, 2.0 * end])
    return np.sqrt(np.linalg.eigvalsh(scale[:, None] * stiffness * scale))


def held(stiffness: float, *names: str, damping: float = 0.0) -> list[Support]:
    """Return equal springs in all three directions at interfaces, 'all' by default."""
    return [
        Support(name, np.diag([stiffness] * 3), np.diag([damping] * 3)) for name in names or ["all"]
    ]
