"""Conical frequencies of rigid rotors on springs, measured in a transient.

A rigid rotor with polar and transverse inertia I_p, I_t on an isotropic tilt stiffness k has, in
the inertial frame, the two conical modes of ``I_t λ² − i I_p ω λ + k = 0``: one forward, one
backward. The fixed-axis body lives in the rotating frame, where the same modes come out only if
the centrifugal field stiffens as much as it should.

The rotor gets a tilting impulse, and the complex tilt ``φx + iφy`` of its axis is a sum of two
rotating arrows. Prony's method finds both frequencies to many digits from a short motion. What
the integrator does to them is known in closed form, and it is the tolerance.

Run ``python -m validation conical``, with ``--quick`` for fewer speeds, ``--json FILE`` to keep the
numbers.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import numpy as np
from tqdm import tqdm

from validation.exudyn_3d.against_3d import false_threshold
from validation.exudyn_3d.scenes import Bearings, Model, Start, cylinder, fixed_axis_orbits
from validation.rows import Row, print_rows, verdict, write_json

SHAPES = {"shaft": (0.05, 0.3, 0.03), "disc": (0.15, 0.1, 0.04)}
BEARINGS = Bearings((1e6, 1e6, 1e6))


def rigid_model(radius: float, length: float, maxh: float) -> Model:
    """Return a cylinder with no modes but the rigid ones, markers on its axis."""
    model = Model.of(cylinder(radius, length, maxh), 1)
    rotor = model.rotor.center_interfaces()
    return Model(model.fem, rotor, rotor.reduce(np.zeros((3 * rotor.node_count, 0))))


def conical_frequencies(model: Model, speed: float) -> np.ndarray:
    """Return the exact conical frequencies, backward (negative) and forward [rad/s]."""
    polar, transverse = model.inertia
    stiffness = BEARINGS.tilt_stiffness(model.rotor)
    return np.sort(np.roots([transverse, -1j * polar * speed, stiffness]).imag)


def prony_frequencies(signal: np.ndarray, interval: float, count: int = 2) -> np.ndarray:
    """Return the frequencies of a sum of `count` complex exponentials, ascending [rad/s].

    The signal obeys a linear recursion; the roots of its polynomial are ``exp(iν Δt)``. The
    interval must resolve the fastest: ``|ν| Δt < π``.
    """
    history = np.column_stack([signal[i : i - count] for i in range(count)])
    recursion = np.linalg.lstsq(history, -signal[count:], rcond=None)[0]
    roots = np.roots([1.0, *recursion[::-1]])
    return np.sort(np.angle(roots) / interval)


def measured_frequencies(
    model: Model, speed: float, step: float, stiffening: str, periods: float = 6.0
) -> np.ndarray:
    """Return the frequencies of the tilt after an impulse [rad/s]; NaN if the tilt must grow."""
    exact = conical_frequencies(model, speed)
    rigid = (*model.inertia, BEARINGS.tilt_stiffness(model.rotor))
    if stiffening == "none" and speed > false_threshold(*rigid):
        return np.full(2, np.nan)
    fastest = max(np.abs(exact).max(), speed)
    interval = step * max(1, int(2 * np.pi / fastest / 8 / step))
    samples = int(np.ceil(periods * 2 * np.pi / np.abs(exact).min() / interval))
    orbits = fixed_axis_orbits(
        model,
        Start(speed, 1e-3 * np.abs(exact).min()),
        BEARINGS,
        samples * interval,
        step,
        samples,
        translation="none",
        constant_speed=True,
        stiffening=stiffening,
        spectral_radius=1.0,
    )
    # the unbalance of the mesh itself turns with the spin: this difference has none of it
    free = orbits.tilt[1:] - np.exp(1j * speed * interval) * orbits.tilt[:-1]
    return prony_frequencies(free, interval)


def integrated_frequencies(exact: np.ndarray, speed: float, step: float) -> np.ndarray:
    """Return what the integrator makes of frequencies: ``tan(ν'h/2) = ν'_exact h/2``.

    Valid for the trapezoidal rule in the rotating frame, ``ν' = ν − ω``.
    """
    return speed + 2 / step * np.arctan((exact - speed) * step / 2)


def conical_table(speeds: Sequence[float], step: float = 1e-4) -> list[Row]:
    """Return exact and measured frequencies of both shapes at all speeds."""
    models = {name: rigid_model(*shape) for name, shape in SHAPES.items()}
    rows = []
    cases = [(name, speed) for name in models for speed in speeds]
    for name, speed in tqdm(cases, desc="conical frequencies"):
        model = models[name]
        polar, transverse = model.inertia
        exact = conical_frequencies(model, speed)
        expected = integrated_frequencies(exact, speed, step)
        found = {
            level: measured_frequencies(model, speed, step, level) for level in ("tilt", "none")
        }
        row = {"rotor": name, "I_p/I_t": polar / transverse, "speed": speed}
        for i, sense in enumerate(("backward", "forward")):
            row |= {
                sense: exact[i],
                f"{sense} 'tilt' error": found["tilt"][i] / exact[i] - 1,
                f"{sense} beyond integrator": found["tilt"][i] / expected[i] - 1,
                f"{sense} 'none' error": found["none"][i] / exact[i] - 1,
            }
        rows.append({key: float(v) if key != "rotor" else v for key, v in row.items()})
    return rows


def main() -> int:
    """Print the table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer speeds")
    parser.add_argument("--json", metavar="FILE", help="write the table to FILE")
    options = parser.parse_args()
    speeds = (300.0,) if options.quick else (50.0, 150.0, 300.0, 600.0, 1200.0)
    rows = conical_table(speeds)
    print_rows("Conical frequencies [rad/s] and relative errors; nan: the tilt grows", rows)
    if options.json:
        write_json(options.json, {"conical frequencies": rows})
    names = [f"{sense} beyond integrator" for sense in ("backward", "forward")]
    worst = max(abs(row[name]) for row in rows for name in names)
    return verdict({"error beyond the integrator's": (worst, 5e-6)})
