"""One small object of every class that can be saved, with everything that a file can hold."""

from dataclasses import replace

import numpy as np
from point_rotors import SKEW_AXIS, random_rotor

from exudyn_rotor import (
    BaseResponse,
    Campbell,
    CriticalSpeedMap,
    CriticalSpeeds,
    HarmonicResponse,
    MotionShapes,
    PeriodicResponse,
    ReducedRotor,
    Sensitivity,
    SeparationMargins,
    Spectra,
    SpinAxis,
    Stability,
    StabilityLevelOne,
    StabilityMap,
    StabilityThresholds,
    StaticResponse,
    StressField,
    StressHistory,
    UnbalanceResponse,
)
from exudyn_rotor.reduction.reduced_rotor import Centrifugal

RNG = np.random.default_rng(3)
TRIANGLES = [[0, 1, 2], [1, 2, 3]]


def rotor(attached: bool) -> ReducedRotor:
    """Return a rotor with everything that a file can hold; attachment modes only if `attached`."""
    made = random_rotor(
        11, SpinAxis(SKEW_AXIS, [0.3, -0.2, 0.5]), interfaces={"left": [0, 1], "right": [4, 5]},
        triangles=TRIANGLES,
    ).reduce(3)  # fmt: skip
    count, size = len(made.shapes.nodes), made.size
    square = RNG.normal(size=(size, size))
    return replace(
        made,
        invariants=replace(
            made.invariants,
            K2=square + square.T,
            H=0.1 * made.invariants.K,
            K0=square + square.T,
        ),
        shapes=replace(made.shapes, stress=RNG.normal(size=(count, 6, size))),
        centrifugal=Centrifugal(
            displacement=RNG.normal(size=3 * count),
            stress=RNG.normal(size=(count, 6)),
            yield_stress=3e8,
        ),
        dropped=("column 7",),
        attached=made.attached if attached else None,
    )


def results() -> list:
    """Return one small result of every class."""
    speeds, table = np.array([10.0, 20.0, 30.0]), RNG.uniform(1.0, 2.0, size=(3, 2))
    codes = np.array([[0, 1], [1, 0], [2, 3]])
    motion = RNG.normal(size=(3, 2, 1, 6)) + 1j
    return [
        Campbell(speeds, *[table] * 5, codes, codes, RNG.normal(size=(3, 4, 2)) + 0j,
                 np.array([[0, 1], [1, 0], [0, 1]]), codes < 2,
                 ("spin",), stiffening="full"),
        CriticalSpeeds(1.0, speeds, speeds, ("forward", "backward", "mixed"), np.array([1, 1, -1]),
                       RNG.normal(size=(4, 3)) + 0j, stiffening="tilt"),
        CriticalSpeedMap(speeds, table, codes, 1.0, stiffening="none"),
        UnbalanceResponse(("left", "node 2"), np.array([1]), motion, "inertial", speeds),
        HarmonicResponse(("left", "node 2"), np.array([0]), motion, "rotor", speeds, 90.0),
        PeriodicResponse(
            ("left", "node 2"), speeds, [0, 0, 1], ("value", "fold", "computed"), speeds,
            np.column_stack([speeds, 0.5 * speeds]), [[0, 0], [1, -1]],
            np.repeat(motion, 2, axis=2), ("left", "right"), table, table, table,
            speeds, -speeds, speeds + 1j, 2, "spin speed [rad/s]", [[0, 1], [2, -3]],
            coordinates=RNG.normal(size=(3, 2, 5)) + 1j),
        BaseResponse(("left", "node 2"), speeds, motion[:, :, 0].real, 90.0),
        Stability(speeds, table + 1j, speeds, speeds > 15.0, speeds, table, codes, codes),
        StabilityThresholds([20.0], [True], [9.0], [0], [1], 10.0, 30.0, False),
        StabilityMap(speeds, speeds[:2], table, table > 1.5, table, codes, codes, table,
                     ("k [N/m]", "speed [rad/s]"), least_stable_growth=table - 3.0),
        SeparationMargins(("left",), [20.0], [1e-5], [[19.0, np.nan]], [10.0], [0.15], [0.2],
                          [25.0, 30.0], ("left", "right"), speeds, table.T),
        StabilityLevelOne(speeds - 10.0, 0.3 - 0.01 * speeds, speeds, 10.0, 90.0, "centrifugal",
                          15.0, 2.0, 40.0),
        MotionShapes(RNG.normal(size=(4, 3)), np.array(TRIANGLES), [0.0, 0.0, 1.0], np.zeros(3),
                     speeds, ("a", "b", "c"), speeds, speeds, np.array([-2, 0]),
                     RNG.normal(size=(3, 2, 4, 3)) + 1j),
        StaticResponse(
            ("left", "node 2"), motion[:2, 0, 0].real, ("left", "right"),
            *RNG.normal(size=(2, 2, 6)), *RNG.normal(size=(2, 2)), np.eye(3), 90.0,
            basis_errors=np.zeros(2), nodes=RNG.normal(size=(4, 3)),
            displacement=RNG.normal(size=(4, 3)), stress=RNG.normal(size=(4, 6))),
        Sensitivity(("left, 1", "left, 2"), speeds, table.T + 1j, 90.0),
        Spectra(speeds, speeds, speeds[:2], table),
        StressField(RNG.normal(size=(4, 3)), np.array(TRIANGLES), RNG.normal(size=(4, 6, 2)),
                    RNG.normal(size=(4, 6)), True),
        StressHistory(speeds, speeds, np.array([2, 0]), RNG.normal(size=(3, 2, 6)), np.ones(4),
                      np.ones(4), RNG.normal(size=(4, 3)), np.array(TRIANGLES)),
    ]  # fmt: skip


STORED = {
    "ReducedRotor": rotor(attached=False),
    **{type(item).__name__: item for item in results()},
}
