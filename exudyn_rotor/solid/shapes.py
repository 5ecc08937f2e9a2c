"""Shape functions and integration points of solid elements, by the names of meshio."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import ngsolve
import numpy as np

# Corners, and faces by corners, outward, in the order of the faces S1, S2, … of Abaqus.
_TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
_WEDGE = np.array(
    [[0, 0, -1], [1, 0, -1], [0, 1, -1], [0, 0, 1], [1, 0, 1], [0, 1, 1]], dtype=float
)
_HEXAHEDRON = np.array(
    [
        *([-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]),
        *([-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]),
    ],
    dtype=float,
)
_FACES = {
    4: ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    6: ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    8: (
        *((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4)),
        *((1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    ),
}
# Edges in the order of their mid nodes.
_EDGES = {
    4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    6: (
        *((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)),
        *((0, 3), (1, 4), (2, 5)),
    ),
    8: (
        *((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
}
Rule = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class ElementKind:
    """One kind of element: corners and mid nodes, shape functions, integration points.

    `order` is 2 with a mid node on every edge, else 1. Rules are points (q, 3) and weights (q,).
    """

    corners: np.ndarray
    order: int
    stiffness_rule: Rule
    mass_rule: Rule

    @property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """Corners of every face."""
        return _FACES[len(self.corners)]

    @property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """Corners of the edge of every mid node."""
        return _EDGES[len(self.corners)] if self.order == 2 else ()

    @property
    def powers(self) -> np.ndarray:
        """Exponents (n, 3) of the monomials that the shape functions are made of."""
        return _POWERS[len(self.corners), self.order]

    @cached_property
    def points(self) -> np.ndarray:
        """Positions of the nodes in the reference element, shape (n, 3)."""
        mids = [self.corners[list(edge)].mean(axis=0) for edge in self.edges]
        return np.vstack([self.corners, *mids])

    @cached_property
    def _coefficients(self) -> np.ndarray:
        return np.linalg.inv(_monomials(self.points, self.powers))

    def values(self, points: np.ndarray) -> np.ndarray:
        """Return the shape functions N_j at points (q, 3), shape (q, n)."""
        return _monomials(points, self.powers) @ self._coefficients

    def slopes(self, points: np.ndarray) -> np.ndarray:
        """Return ∂N_j/∂ξ_c at points (q, 3), shape (q, n, 3)."""
        columns = []
        for direction in range(3):
            lower = self.powers.copy()
            lower[:, direction] = np.maximum(lower[:, direction] - 1, 0)
            derivative = self.powers[:, direction] * _monomials(points, lower)
            columns.append(derivative @ self._coefficients)
        return np.stack(columns, axis=2)

    @cached_property
    def to_nodes(self) -> np.ndarray:
        """What makes values at the points of the stiffness linear ones at the nodes, (n, q)."""
        points = self.stiffness_rule[0]
        if len(points) == 1:
            return np.ones((len(self.points), 1))
        powers = _POWERS[len(self.corners), 1]
        return _monomials(self.points, powers) @ np.linalg.pinv(_monomials(points, powers))


def _monomials(points: np.ndarray, powers: np.ndarray) -> np.ndarray:
    return np.prod(points[:, None] ** powers, axis=2)


def _powers(corners: int, order: int) -> np.ndarray:
    """Return the exponents of an element's monomials, one for every node."""
    grid = [(i, j, k) for i in range(3) for j in range(3) for k in range(3)]
    if corners == 4:
        chosen = [p for p in grid if sum(p) <= order]
    elif corners == 6:  # of first order across and along, or one of the two squared
        chosen = [p for p in grid if p[0] + p[1] <= 1 and p[2] <= 1]
        if order == 2:
            chosen = [p for p in grid if p[0] + p[1] + max(p[2] - 1, 0) <= 2]
    else:  # serendipity: one square at most
        chosen = [p for p in grid if p.count(2) < order]
    return np.array(chosen)


_POWERS = {(corners, order): _powers(corners, order) for corners in (4, 6, 8) for order in (1, 2)}


def _cube(count: int) -> Rule:
    points, weights = np.polynomial.legendre.leggauss(count)
    grid = np.stack(np.meshgrid(points, points, points, indexing="ij"), axis=-1)
    return grid.reshape(-1, 3), np.prod(np.meshgrid(weights, weights, weights), axis=0).ravel()


def _prism(triangle: Rule, count: int) -> Rule:
    (places, shares), (heights, weights) = triangle, np.polynomial.legendre.leggauss(count)
    points = [(*place, height) for height in heights for place in places]
    return np.array(points), np.outer(weights, shares).ravel()


def _rule(shape: ngsolve.ET, degree: int) -> Rule:
    """Return NGSolve's points and weights for polynomials of a degree on the unit simplex."""
    rule = ngsolve.IntegrationRule(shape, degree)
    return np.array(rule.points), np.array(rule.weights)


# the points inside the triangle, where NGSolve takes the middles of its edges
_THREE = (np.array([[1, 1], [4, 1], [1, 4]]) / 6.0, np.full(3, 1.0 / 6.0))
_ONE, _FOUR, _FOURTEEN = (_rule(ngsolve.TET, degree) for degree in (1, 2, 5))
KINDS = {
    "tetra": ElementKind(_TETRAHEDRON, 1, _ONE, _FOUR),
    "tetra10": ElementKind(_TETRAHEDRON, 2, _FOUR, _FOURTEEN),
    "wedge": ElementKind(_WEDGE, 1, _prism(_THREE, 2), _prism(_THREE, 2)),
    "wedge15": ElementKind(_WEDGE, 2, _prism(_THREE, 3), _prism(_rule(ngsolve.TRIG, 5), 3)),
    "hexahedron": ElementKind(_HEXAHEDRON, 1, _cube(2), _cube(2)),
    "hexahedron20": ElementKind(_HEXAHEDRON, 2, _cube(3), _cube(3)),
    # as CalculiX integrates C3D20R where it looks for frequencies, and ANSYS SOLID186
    "hexahedron20 reduced": ElementKind(_HEXAHEDRON, 2, _cube(2), _cube(2)),
    "hexahedron20 reduced stiffness": ElementKind(_HEXAHEDRON, 2, _cube(2), _cube(3)),
}
