"""Responses of several rotors, and two of them in a scene: against closed forms."""

import numpy as np
import pytest
import scipy.linalg as la
from train_models import FIRST, GROUND, SECOND, UNEVEN, at, by_hand, two_discs

from exudyn_rotor import HarmonicForce, Unbalance, harmonic_response, unbalance_response


@pytest.mark.parametrize("ratio", [1.7, -1.3])
@pytest.mark.parametrize("ground", [GROUND[0], UNEVEN], ids=["isotropic", "cross-coupled"])
def test_unbalance_of_either_rotor(ratio, ground):
    """``(K + iωD − ω²M) x = ω²U(1, −i)``, ω the speed of the unbalanced rotor."""
    train, speeds = two_discs(ratio, ground), np.array([90.0, 250.0])
    for name, rate, rotor, half in (("A", 1.0, 0, FIRST[1]), ("B", ratio, 1, SECOND[1])):
        given = train.relative_to(name)
        values = np.sort(rate * speeds)
        found = unbalance_response(
            given, values, Unbalance(f"{name}:b", 1e-4), own=False, allow_negative=True
        )
        for row, omega in enumerate(values):
            M, D, K = by_hand(ratio, omega / rate, ground)
            load = 1e-4 * omega**2 * at(rotor, half).T @ [1.0, -1.0j]
            x = la.solve(K + 1j * omega * D - omega**2 * M, load)
            for place, exact in (("A:a", at(0, -FIRST[1]) @ x), ("B:b", at(1, SECOND[1]) @ x)):
                motion = found.motion[
                    row, found.places.index(place), found.orders.tolist().index(1)
                ]
                np.testing.assert_allclose(motion[:2], exact, rtol=1e-8, atol=1e-16)


def test_loads_that_turn_with_another_rotor_are_refused():
    train = two_discs(1.7)
    with pytest.raises(ValueError, match=r"'B:b': turns with 1\.7 times .*relative_to\('B'\)"):
        unbalance_response(train, [100.0], Unbalance("B:b", 1e-4))
    turning = HarmonicForce("B:b", [1.0, 0.0], frame="rotor")
    with pytest.raises(ValueError, match=r"turns with 1\.7 times"):
        harmonic_response(train, [100.0], turning, speed=50.0)
    still = harmonic_response(train, [100.0], HarmonicForce("B:b", [1.0, 0.0]), speed=50.0)
    M, D, K = by_hand(1.7, 50.0)
    x = la.solve(K + 100j * D - 1e4 * M, at(1, SECOND[1]).T @ [1.0, 0.0])
    np.testing.assert_allclose(still.phasor("A:a"), (at(0, -FIRST[1]) @ x)[0], rtol=1e-8)
