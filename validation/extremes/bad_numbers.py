"""Numbers that are none: NaN, infinities, and floats at the ends of their range."""

from __future__ import annotations

from collections.abc import Callable

import exudyn as exu
import numpy as np

from exudyn_rotor import (
    BaseAcceleration,
    ConstantSpeed,
    HarmonicForce,
    PrescribedMotion,
    SolidRotor,
    SpinAxis,
    Support,
    Unbalance,
    add_rotor,
    campbell,
    critical_speed_map,
    critical_speeds,
    harmonic_response,
    permissible_unbalance,
    stability,
    stability_threshold,
    unbalance_response,
    unstable_ranges,
)
from exudyn_rotor.solid.units import materials_by_region
from validation.extremes.rotors import cloud, held, two_rings
from validation.extremes.rows import EPS, Row, breaking_point, message
from validation.extremes.runs import bare_rotor, run

Inputs = dict[str, Callable[[float], object]]


def _added(**options) -> object:
    mbs = exu.SystemContainer().AddSystem()
    return add_rotor(mbs, two_rings().reduce(0), **options)


def _matrices(**changes) -> SolidRotor:
    return SolidRotor.from_matrices(**(cloud(1) | {"axis": "z", "check_units": False} | changes))


def _with(matrix: np.ndarray, value: float) -> np.ndarray:
    spoiled = np.array(matrix, dtype=float)
    spoiled[-1, -1] = value
    return spoiled


def _path(value: float, size: int | None = 3) -> PrescribedMotion:
    entry = value if size is None else np.full(size, value)
    return PrescribedMotion(*([lambda t: entry] * 3))


def solid_inputs() -> Inputs:
    """Return calls that put a number into the FE model, the axis or the modes."""
    arrays = cloud(1)
    steel = {"youngsModulus": 2e11, "poissonsRatio": 0.3, "density": 7850.0}
    rotor = _matrices()
    nodal = np.diag(arrays["mass"])[::3]
    return {
        "axis direction": lambda v: SpinAxis([0.0, 0.0, v]),
        "axis point": lambda v: SpinAxis([0.0, 0.0, 1.0], [v, 0.0, 0.0]),
        "youngsModulus": lambda v: materials_by_region(["a"], steel | {"youngsModulus": v}),
        "poissonsRatio": lambda v: materials_by_region(["a"], steel | {"poissonsRatio": v}),
        "density": lambda v: materials_by_region(["a"], steel | {"density": v}),
        "mass matrix": lambda v: _matrices(mass=np.diag(np.repeat([*nodal[:-1], v], 3))),
        "stiffness matrix": lambda v: _matrices(stiffness=_with(arrays["stiffness"], v)),
        "damping matrix": lambda v: _matrices(damping=_with(np.zeros((18, 18)), v)),
        "nodes": lambda v: _matrices(nodes=_with(arrays["nodes"], v)),
        "point mass": lambda v: rotor.add_point_mass([0.0, 0.0, 0.0], v),
        "point mass position": lambda v: rotor.add_point_mass([0.0, v, 0.0], 1.0),
        "interface weight": lambda v: rotor.with_interface("i", [0, 1], [1.0, v]),
        "columns": lambda v: rotor.reduce(_with(np.ones((18, 2)), v)),
        "rank_tolerance": lambda v: rotor.reduce(2, rank_tolerance=v),
    }


def body_inputs() -> Inputs:
    """Return calls that put a number into a scene."""
    turn = np.eye(3)
    return {
        "ConstantSpeed speed": lambda v: ConstantSpeed(v),
        "ConstantSpeed angle": lambda v: ConstantSpeed(1.0, v),
        "spin": lambda v: _added(spin=v),
        "θ(t)": lambda v: _added(spin=_path(v, None)),
        "τ(t)": lambda v: _added(translation=_path(v)),
        "run_up start_speed": lambda v: PrescribedMotion.run_up(v, 1.0, 1.0),
        "run_up end_speed": lambda v: PrescribedMotion.run_up(0.0, v, 1.0),
        "run_up duration": lambda v: PrescribedMotion.run_up(0.0, 1.0, v),
        "run_up angle": lambda v: PrescribedMotion.run_up(0.0, 1.0, 1.0, v),
        "position": lambda v: _added(position=[v, 0.0, 0.0]),
        "rotation": lambda v: _added(rotation=_with(turn, v)),
        "initial_velocity": lambda v: _added(initial_velocity=[v, 0.0, 0.0]),
        "initial_angle": lambda v: _added(initial_angle=v),
        "initial_speed": lambda v: _added(initial_speed=v),
        "modal_coordinates": lambda v: _added(modal_coordinates=[v, 0.0]),
        "modal_velocities": lambda v: _added(modal_velocities=[v, 0.0]),
        "gravity": lambda v: _added(gravity=[0.0, v, 0.0]),
        "mass_damping": lambda v: _added(mass_damping=v),
        "stiffness_damping": lambda v: _added(stiffness_damping=v),
        "marker_offsets": lambda v: _added(marker_offsets={"all": [v, 0.0, 0.0]}),
        "color": lambda v: _added(color=[v, 0.0, 0.0, 1.0]),
    }


def linear_inputs() -> Inputs:
    """Return calls that put a number into a linear analysis."""
    rotor, springs = two_rings(unbalance=0.1).reduce(0), held(1e5)
    push = HarmonicForce("all", [1.0, 0.0, 0.0])
    on = {"supports": springs}
    return {
        "Support stiffness": lambda v: Support("all", v),
        "Support damping": lambda v: Support("all", damping=np.diag([v, 1.0])),
        "Support tilt_stiffness": lambda v: Support("all", tilt_stiffness=v),
        "Support tilt_damping": lambda v: Support("all", tilt_damping=v),
        "Support table speeds": lambda v: Support("all", ([0.0, v, 2.0], [1.0, 2.0, 3.0])),
        "Support table values": lambda v: Support("all", ([0.0, 1.0, 2.0], [1.0, v, 3.0])),
        "Support callable": lambda v: campbell(
            rotor, [1.0], supports=[Support("all", lambda s: v)]
        ),
        "Unbalance amount": lambda v: Unbalance("all", v),
        "Unbalance angle": lambda v: Unbalance("all", 1.0, v),
        "Unbalance place": lambda v: unbalance_response(
            rotor, [1.0], [Unbalance([v, 0.0, 0.0], 1.0)], **on
        ),
        "Unbalance.from_grade share": lambda v: Unbalance.from_grade("all", 2.5, 1, 1, share=v),
        "grade": lambda v: permissible_unbalance(v, 1.0, 1.0),
        "HarmonicForce force": lambda v: HarmonicForce("all", [v, 0.0]),
        "HarmonicForce moment": lambda v: HarmonicForce("all", moment=[v, 0.0]),
        "BaseAcceleration": lambda v: BaseAcceleration([v, 0.0]),
        "campbell speeds": lambda v: campbell(rotor, [v], **on, allow_negative=True),
        "critical_speeds order": lambda v: critical_speeds(rotor, **on, order=v),
        "critical_speeds max_speed": lambda v: critical_speeds(rotor, **on, max_speed=v),
        "critical_speed_map": lambda v: critical_speed_map(rotor, "all", [1.0, v]),
        "unbalance_response speeds": lambda v: unbalance_response(rotor, [v], **on),
        "unbalance_response tolerance": lambda v: unbalance_response(
            rotor, [1.0], tolerance=v, **on
        ),
        "harmonic_response frequencies": lambda v: harmonic_response(rotor, [v], [push], **on),
        "harmonic_response speed": lambda v: harmonic_response(rotor, [1.0], [push], speed=v, **on),
        "stability speeds": lambda v: stability(rotor, [v], **on),
        "stability tolerance": lambda v: stability(rotor, [1.0], tolerance=v, **on),
        "stability_threshold": lambda v: stability_threshold(rotor, 1.0, v, **on),
        "unstable_ranges": lambda v: unstable_ranges(rotor, [1.0, v], **on),
    }


def accepted(inputs: Inputs, values: tuple[float, ...] = (np.nan, np.inf, -np.inf)) -> list[str]:
    """Return which inputs take one of the values, or refuse it by another error than Value/Type."""
    found = []
    for name, call in inputs.items():
        for value in values:
            try:
                with np.errstate(all="ignore"):
                    call(value)
            except (ValueError, TypeError):
                continue
            except Exception as error:
                found.append(f"{name}={value} ({type(error).__name__})")
            else:
                found.append(f"{name}={value}")
    return found


# finite values that each input takes, where 2 is none
FINITE = {
    "poissonsRatio": 0.4,
    "rank_tolerance": 0.1,
    "rotation": 1.0,
    "color": 0.5,
    "Unbalance.from_grade share": 0.5,
    "Support table speeds": 1.0,
    "unbalance_response tolerance": 0.01,
    "stability tolerance": 0.01,
}
# needs a rotor that is unstable somewhere
NEVER_TAKEN = ("stability_threshold",)


def all_inputs() -> Inputs:
    """Return all calls."""
    return solid_inputs() | body_inputs() | linear_inputs()


def refused_finite(inputs: Inputs) -> list[str]:
    """Return which inputs refuse an ordinary number: their refusal of others would say nothing."""
    found = []
    for name, call in inputs.items():
        if name in NEVER_TAKEN:
            continue
        try:
            call(FINITE.get(name, 2.0))
        except (ValueError, TypeError) as error:
            found.append(f"{name}: {error}")
    return found


def not_finite(quick: bool = False) -> Row:
    """Put NaN and both infinities into every public input."""
    inputs = all_inputs()
    taken, useless = accepted(inputs), refused_finite(inputs)
    return Row(
        "NaN, inf, −inf",
        f"{len(inputs)} inputs",
        "inputs that take one, or that refuse an ordinary number; limit: 0",
        len(taken) + len(useless),
        0.0,
        ", ".join(taken + useless) or "each is refused",
        "input",
        "ValueError or TypeError that names the input",
    )


def later_nan(quick: bool = False) -> Row:
    """Let a prescribed angle turn into NaN in the middle of a run."""
    path = PrescribedMotion(
        lambda t: 0.0, lambda t: 0.0, lambda t: 0.0 if t < 5e-3 else float("nan")
    )
    rotor = two_rings(unbalance=0.2).reduce(0)
    body = bare_rotor(rotor, spin=path, gravity=[0.0, 1.0, 0.0])
    text = message(lambda: run(body, 1e-3, 10))
    return Row(
        "prescribed motion that turns into NaN later",
        "at half of a run",
        "1 if the run ends without an error; limit: 0",
        0.0 if text else 1.0,
        0.0,
        "at once",
        "input",
        f"the run stops: {text}",
    )


def axis_error(length: float) -> float:
    """Return how far the direction made of a vector of that length is from a unit vector."""
    with np.errstate(all="ignore"):
        try:
            return abs(float(np.linalg.norm(SpinAxis([0.0, length, length]).direction)) - 1.0)
        except ValueError:
            return np.inf


def axis_length(quick: bool = False) -> Row:
    """Give the direction of the axis by vectors of any length, to the ends of the floats."""
    reach = [10.0**d for d in (-300, -150, 0, 149)]
    high = breaking_point(lambda v: axis_error(v) < 1e-9, 1.0, 1e300, 1.1)
    low = breaking_point(lambda v: axis_error(v) < 1e-9, 1.0, 1e-300, 1.1)
    return Row(
        "length of the axis vector",
        "1e-300 to 1e149",
        "length of the direction less 1; limit: round-off × 4",
        max(axis_error(v) for v in reach),
        4.0 * EPS,
        f"{high:.1g}, and below {low:.1g}" if np.isfinite(low) else f"{high:.1g}",
        "input",
        message(lambda: SpinAxis([0.0, 1e200, 0.0])),
    )


def denormals(quick: bool = False) -> Row:
    """Put the smallest float, which is nearly zero, where zero is allowed."""
    tiny = 5e-324
    rotor = two_rings().reduce(0)
    runs = [
        np.abs(run(bare_rotor(rotor, **options), 1e-3, 10)[0]).max()
        for options in (
            {"spin": tiny},
            {"initial_speed": tiny},
            {"spin": 1.0, "gravity": [tiny, 0.0, 0.0]},
        )
    ]
    soft, none = (
        campbell(rotor, [1.0], supports=supports).frequencies_rotor for supports in (held(tiny), [])
    )
    at_rest = message(lambda: campbell(rotor, [0.0], supports=held(tiny)))
    return Row(
        "denormal numbers",
        "5e-324 as speed, gravity, support stiffness",
        "largest motion, and change of frequencies; limit: what zero gives, 0",
        max(*runs, np.abs(soft - none).max()),
        0.0,
        "such a support, Campbell at rest" if at_rest else "not reached",
        "numerics" if at_rest else "",
        at_rest,
    )


def overflow(quick: bool = False) -> Row:
    """Spin so fast that Ω² leaves the floats."""
    rotor = two_rings().reduce(0)
    with np.errstate(all="ignore"):
        text = message(lambda: campbell(rotor, [1e160], supports=held(1e5)))
        told = message(lambda: run(bare_rotor(rotor, spin=1e160), 1e-3, 2))
    return Row(
        "overflow of Ω²",
        "1e160 rad/s",
        "calls that end without an error; limit: 0",
        2.0 - bool(text) - bool(told),
        0.0,
        "1.3e154 rad/s",
        "numerics",
        f"Campbell: {text}; run: {told}",
    )
