"""Cost of linear responses beside the dense solutions of the same equations, in one process.

    python -m validation linear_cost

Unbalance responses over 200 speeds and harmonic responses over 200 frequencies of random round
rotors with 8 to 60 flexible modes, on isotropic and on uneven supports. The floor is one call of
``numpy.linalg.solve`` for each value: of the equations in the rotor's axes on isotropic supports,
and of five harmonics of them on uneven ones, fewer than which give no answer.
"""

from __future__ import annotations

import warnings
from time import process_time

import numpy as np

from exudyn_rotor import (
    HarmonicForce,
    LinearModel,
    SolidRotor,
    Support,
    Unbalance,
    harmonic_response,
    linear_model,
    unbalance_response,
)

SPEEDS = np.linspace(20.0, 1500.0, 200)
HARMONICS = 5


def shaft(count: int) -> SolidRotor:
    """Return masses on a round shaft, two coordinates across for each and one along."""
    bend = np.zeros((count, count))
    for i in range(count - 2):
        bend[i : i + 3, i : i + 3] += np.outer([1.0, -2.0, 1.0], [1.0, -2.0, 1.0])
    rod = 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)
    rod[0, 0] = rod[-1, -1] = 1.0
    stiffness = np.kron(bend, np.diag([1e7, 1e7, 0.0])) + np.kron(rod, np.diag([0.0, 0.0, 1e9]))
    nodes = np.column_stack([np.zeros((count, 2)), np.linspace(0.0, 1.0, count)])
    rotor = SolidRotor.from_matrices(np.eye(3 * count), stiffness, nodes, "z")
    return rotor.with_interface("left", [1]).with_interface("right", [count - 2])


def seconds(call, repeats: int = 3) -> float:
    """Return the least processor time of some calls [s]."""
    times = []
    for _ in range(repeats):
        start = process_time()
        call()
        times.append(process_time() - start)
    return min(times)


def floor(size: int) -> float:
    """Return the time of dense solutions, one for each speed [s]."""
    rng = np.random.default_rng(1)
    A = rng.normal(size=(size, size)) + 1j * rng.normal(size=(size, size)) + 9.0 * np.eye(size)
    b = rng.normal(size=size) + 0j
    return seconds(lambda: [np.linalg.solve(A, b) for _ in SPEEDS])


def main() -> None:
    """Print the ratios."""
    print("coordinates  supports   unbalance  harmonic  (times the dense solutions)")
    for modes in (8, 20, 40, 60):
        rotor = shaft(modes // 2 + 8).reduce(modes)
        for name, stiffness in (("isotropic", 1e6), ("uneven", np.diag([1e6, 2e6]))):
            supports = [Support(place, stiffness, 500.0) for place in ("left", "right")]
            model = linear_model(rotor, supports=supports)
            size = model.size * (1 if name == "isotropic" else HARMONICS)
            times = unbalance(model), harmonic(model)
            shown = "  ".join(f"{one / floor(size):9.2f}" for one in times)
            print(f"{model.size:11}  {name:9}  {shown}")


def unbalance(model: LinearModel) -> float:
    """Return the time of an unbalance response [s]."""
    given = {"accuracy": None}
    return seconds(lambda: unbalance_response(model, SPEEDS, Unbalance("left", 1e-4), **given))


def harmonic(model: LinearModel) -> float:
    """Return the time of a harmonic response for one of its three harmonics of the load [s]."""
    force, given = HarmonicForce("left", (1.0, 0.0)), {"speed": 300.0, "accuracy": None}
    return seconds(lambda: harmonic_response(model, SPEEDS, force, **given)) / 3.0


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
