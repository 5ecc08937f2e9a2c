"""Responses of several rotors, and two of them in a scene: against closed forms."""

import exudyn
import numpy as np
import pytest
import scipy.linalg as la
from train_models import (
    BETWEEN,
    FIRST,
    GROUND,
    SECOND,
    UNEVEN,
    at,
    by_hand,
    rigid,
    two_discs,
)

from exudyn_rotor import (
    HarmonicForce,
    Support,
    Unbalance,
    add_rotor,
    add_supports,
    harmonic_response,
    recommended_settings,
    unbalance_response,
)


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


def test_inter_shaft_bearings_in_a_scene():
    """Two bodies of different speeds under a step of force: the solution of the linear equations.

    The integrator errs by h²: by 2e-4 of the motion with 500 steps, by 5e-5 with 1000.
    """
    speed, ratio, end = 300.0, 1.7, 0.02
    mbs = exudyn.SystemContainer().AddSystem()
    a, b = (
        add_rotor(mbs, rigid(*d), spin=rate * speed, name=name)
        for name, d, rate in (("A", FIRST, 1.0), ("B", SECOND, ratio))
    )
    k, c = BETWEEN
    add_supports(a, [Support("a", GROUND[0], GROUND[1]), Support("b", 1.3 * GROUND[0], GROUND[1])])
    add_supports(b, Support("b", 5e4))
    links = [Support("a", k, c), Support("b", 1.5 * k, c)]
    add_supports(a, links, base={n: b.marker(n) for n in "ab"})
    mbs.AddLoad(exudyn.itemInterface.Force(markerNumber=a.marker("a"), loadVector=[100.0, 0, 0]))
    sensors = [
        mbs.AddSensor(exudyn.itemInterface.SensorMarker(
            markerNumber=marker, storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Displacement,
        ))
        for marker in (a.marker("a"), b.marker("b"))
    ]  # fmt: skip
    mbs.Assemble()
    mbs.SolveDynamic(recommended_settings(end_time=end, step=end / 1000))
    M, D, K = by_hand(ratio, speed)
    steady = la.solve(K, at(0, -FIRST[1]).T @ [100.0, 0.0])
    companion = np.block([[np.zeros((8, 8)), np.eye(8)], [-la.solve(M, K), -la.solve(M, D)]])
    x = steady + (la.expm(end * companion) @ np.r_[-steady, np.zeros(8)])[:8]
    for sensor, rows in zip(sensors, (at(0, -FIRST[1]), at(1, FIRST[1])), strict=True):
        found = mbs.GetSensorStoredData(sensor)[-1, 1:3]
        np.testing.assert_allclose(found, rows @ x, atol=1e-4 * np.abs(rows @ x).max())
