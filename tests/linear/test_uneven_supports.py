"""Isotropic rotors on uneven supports: periodic in axes that turn, constant in axes at rest.

Point masses in a row with lateral springs in between: exponents are the eigenvalues of a constant
system, whatever the speed. Motions that share an exponent, free ones, and stiff dampers beside
light damping are what checks and choices of motions have to bear.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.modal.campbell import campbell
from exudyn_rotor.solid_rotor import SolidRotor


@dataclass(frozen=True)
class Row:
    """Masses in a row; supports ``(kx, ky, dx, dy)`` and cross-coupling at its ends."""

    speed: float
    masses: tuple[float, ...]
    springs: tuple[float, ...]
    supports: tuple[tuple[float, float, float, float, float], ...]
    axial: float = 1.0

    @property
    def _along(self) -> np.ndarray:
        result = np.zeros((len(self.masses), len(self.masses)))
        for i, k in enumerate(self.springs):
            result[i : i + 2, i : i + 2] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
        return result

    @property
    def on_supports(self) -> tuple[SolidRotor, list[Support]]:
        count = len(self.masses)
        K = np.kron(self._along, np.diag([1.0, 1.0, self.axial]))
        nodes = [[0.0, 0.0, 0.1 * i] for i in range(count)]
        rotor = SolidRotor.from_matrices(np.kron(np.diag(self.masses), np.eye(3)), K, nodes, "z")
        supports = []
        for place, given in zip(dict.fromkeys([0, count - 1]), self.supports, strict=True):
            rotor = rotor.with_interface(f"at {place}", [place])
            supports.append(Support(f"at {place}", *_matrices(given)))
        return rotor, supports

    @property
    def exact(self) -> np.ndarray:
        """Lateral exponents, and zero of the motion along the axis."""
        count, M = len(self.masses), np.kron(np.diag(self.masses), np.eye(2))
        K, D = np.kron(self._along, np.eye(2)), np.zeros((2 * count, 2 * count))
        for place, given in zip(dict.fromkeys([0, count - 1]), self.supports, strict=True):
            at = slice(2 * place, 2 * place + 2)
            for X, part in zip((K, D), _matrices(given), strict=True):
                X[at, at] += part
        none, one = np.zeros_like(K), np.eye(2 * count)
        A = np.block([[none, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        return np.linalg.eigvals(A)


def _matrices(given: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    kx, ky, dx, dy, cross = given
    return np.array([[kx, cross], [-cross, ky]]), np.diag([dx, dy])


ROWS = {
    # frequencies of 200 and 141 rad/s are copies at 100 rad/s, as ±200 differ by twice 2Ω
    "a mass on two undamped springs": Row(100.0, (0.5,), (), ((2e4, 1e4, 0, 0, 0),)),
    "twice the speed": Row(200.0, (1.0,), (), ((4e4, 2e4, 0, 0, 0),)),
    "four times the speed": Row(50.0, (0.5,), (), ((2e4, 4e4, 0, 0, 0),)),
    "the speed, beside damping": Row(200.0, (1.0, 1.0), (1e8,), ((4e4, 6e4, 10, 10, 0),) * 2),
    "free one way": Row(100.0, (1.0,), (), ((2e4, 0, 1e6, 0, 0),)),
    "free one way, undamped": Row(50.0, (0.5,), (), ((4e4, 0, 0, 0, 0),)),
    "stiff dampers": Row(
        100.0, (0.5, 1.0, 2.0), (1e6, 1e4), ((2e4, 1e4, 1e6, 1, 0), (1e6, 4e4, 0, 1e6, 0))
    ),
    "a stiff support one way": Row(
        50.0, (2.0, 2.0), (1e4,), ((1e12, 1e4, 1e3, 1e3, 0), (1e12, 1e4, 1, 0, 0))
    ),
    "free one way at low speed": Row(
        0.3, (2.0, 0.5), (1e8,), ((4e4, 0, 10, 1e3, 0), (1e6, 0, 0, 0, 0))
    ),
    "low speed": Row(
        0.3, (1.0, 2.0, 0.5), (1e6, 1e8), ((2e4, 4e4, 0, 0, 0), (1e4, 1e6, 0, 10, 0)), 1e4
    ),
    "axial frequency twice the speed": Row(  # at which a matrix of harmonics left out is singular
        5.0, (2.0, 2.0), (100.0,), ((4e4, 1e4, 1, 1e3, 0), (2e4, 4e4, 0, 0, 1e4))
    ),
    "low speed, swirl": Row(0.3, (1.0, 1.0), (1e6,), ((2e4, 2e4, 1, 10, 1e3), (1e4, 4e4, 0, 1, 0))),
}


@pytest.mark.parametrize("name", ROWS)
def test_diagram_has_all_frequencies(name):
    rotor, supports = ROWS[name].on_supports
    speed, exact = ROWS[name].speed, np.abs(ROWS[name].exact.imag)
    diagram = campbell(rotor, [speed], supports=supports, stiffening="none")
    seen = np.abs(diagram.frequencies_inertial[0])
    # a frequency of just the speed is zero in axes that turn, as is the motion along the axis
    for w in exact[np.abs(exact - speed) > 1e-6 * speed]:
        assert np.nanmin(np.abs(seen - w)) <= 1e-6 * max(w, speed)
