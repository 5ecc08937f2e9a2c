"""Every warning of the package fires: one test per place, and none without a test."""

import ast
import warnings
from pathlib import Path

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate
from models import STEEL, block_beam, disc_rotor
from point_rotors import ring_rotor

import exudyn_rotor
import exudyn_rotor as er

LAMINAR = {
    "radius": 0.1, "length": 0.05, "clearance": 3e-4, "pressure_drop": 1.2e6, "density": 1000.0,
    "viscosity": 0.1,
}  # fmt: skip
PACKAGE = Path(exudyn_rotor.__file__).parent


@pytest.fixture(scope="module")
def beam():
    return er.SolidRotor.from_ngsolve(block_beam(), STEEL, "z", order=2)


def mass_on_balls(speed, tolerance=1e-2, **bearing):
    mass = er.SolidRotor.from_matrices(20.0 * np.eye(3), np.zeros((3, 3)), [[0.0, 0.0, 0.0]], "z")
    balls = er.RollingBearing(
        interface="seat", count=8, pitch_radius=0.0326, element_radius=0.006, stiffness=7e9,
        **bearing,
    )  # fmt: skip
    given = {"supports": balls, "gravity": [0.0, -9.81, 0.0], "tolerance": tolerance}
    rotor = mass.with_interface("seat", [0]).reduce(0)
    er.periodic_response(rotor, [speed], follow=False, **given)


def unstable_motion_on_rolling_bearings(_):
    mass_on_balls(680.0, clearance=1e-5, damping=600.0)


def ring():
    return ring_rotor(0.1, 0.1, 2.0).with_interface("all", list(range(10)))


def proposal_beyond_the_formulation(_):
    er.propose(disc_rotor().reduce(2), speeds=1e4)


def run_beyond_its_assumptions(beam):
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, ring().reduce(0), spin=10.0, modal_coordinates=[0.1, 0.0])
    mbs.Assemble()
    er.check_run(body)


def native_stress_of_a_prestressed_rotor(beam):
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, beam.reduce(1, prestress=True, stress=True), spin=10.0)
    body.add_node_sensor(0, exu.OutputVariableType.StressLocal)


def stress_at_speed_without_prestress(beam):
    reduced = beam.reduce(1, stress=True, prestress=False)
    field = er.StressField.of(reduced, er.select_modes(reduced, er.Formulation("none", 10.0)))
    er.stress_history(field, [0.0], np.zeros((1, field.modes.shape[2])), 10.0)


def scene_of_a_full_lossy_rotor(_):
    rotor = ring_rotor(0.1, 0.1, 2.0).with_damping(loss=0.01)
    er.add_rotor(exu.SystemContainer().AddSystem(), rotor, spin=4.0)


def steady_motion_on_a_stop_that_opens(_):
    rotor = ring_rotor(0.1, 0.1, 20.0).add_point_mass([0.1, 0.0, -0.1], 0.01)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=300.0, translation="none", gravity=[0.0, -9.81, 0.0])
    stop = er.ClearanceStop(interface="left", radius=0.05, clearance=1e-5, stiffness=3e7)
    er.add_supports(body, [*(er.Support(name, 1e6, 3e3) for name in ("left", "right")), stop])
    mbs.Assemble()
    er.steady_state(body)


def torque_on_a_tilt_of_the_node(beam, source=None):
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, source or ring_rotor(0.1, 0.1, 2.0).reduce(0))
    tilt = MarkerNodeCoordinate(nodeNumber=body.nodes["rigid"], coordinate=3)
    mbs.AddLoad(LoadCoordinate(markerNumber=mbs.AddMarker(tilt), load=1.0))
    mbs.Assemble()
    return body


def asked_for_connections(beam, source=None):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        body = torque_on_a_tilt_of_the_node(beam, source)
    body.check_connections()


def run_of_a_full_body_with_a_dense_solver(_):
    mbs = exu.SystemContainer().AddSystem()
    er.add_rotor(mbs, disc_rotor(1), spin=1.0, translation="none")
    mbs.Assemble()
    settings = er.recommended_settings(1e-4, 1e-4)
    settings.timeIntegration.verboseMode = 0
    mbs.SolveDynamic(settings)


def full_body_asked_for_connections(beam):
    asked_for_connections(beam, ring_rotor(0.1, 0.1, 2.0))


# place of every ``warnings.warn`` (file:function): what makes it fire, kind, part of its text
PLACES = {
    "bearings/annular_seal.py:__post_init__": (
        lambda _: er.AnnularSeal(interface="a", **LAMINAR),
        UserWarning, "may be laminar"),
    "multibody/rotor/rotor_body.py:_warn_of_static_stress": (
        native_stress_of_a_prestressed_rotor, UserWarning, "stress of the modes alone"),
    "reduction/component.py:lowest_with_pairs": (
        lambda _: disc_rotor().reduce(1), UserWarning, "one of a pair in two planes"),
    "strength/field.py:warn_without_static": (
        stress_at_speed_without_prestress, UserWarning, "without the static centrifugal stress"),
    "advice/proposal.py:propose": (
        proposal_beyond_the_formulation, er.AssumptionWarning, "flexible modes given lie in the"),
    "nonlinear/periodic_response.py:warn_of": (
        unstable_motion_on_rolling_bearings, UserWarning, "values .* the motion is unstable"),
    "multibody/add_rotor.py:add_rotor": (
        scene_of_a_full_lossy_rotor, UserWarning, "A scene runs without it"),
    "multibody/rotor/rotor_body.py:check_connections": (
        asked_for_connections, er.ConnectionWarning, "does not tilt"),
    "multibody/rotor/assembly.py:watch": (
        run_of_a_full_body_with_a_dense_solver, UserWarning, "EigenSparse"),
    "multibody/rotor/assembly.py:warn_of_lost_connections": (
        torque_on_a_tilt_of_the_node, er.ConnectionWarning, "does not tilt"),
    "advice/run_check.py:check_run": (
        run_beyond_its_assumptions, er.AssumptionWarning, "tilt .* exceeds"),
    "linear/response/steady_state.py:steady_state": (
        steady_motion_on_a_stop_that_opens, UserWarning, "is left to higher harmonics"),
}  # fmt: skip
# part of the text of warnings that the tests of their analyses make fire
ELSEWHERE = {
    "linear/modal/basis_error.py:warn": "errs by about",
    "static/static_response.py:static_response": "errs by about",
    "linear/response/steady_response.py:over": "errs by about",
    "linear/model/linear_model.py:warn_of_refused": "no values at .* which are NaN",
    "linear/modal/resonance.py:warn": "none are looked for",
    "linear/response/steady_response.py:_warn_of_missing": "no values at",
    "linear/response/response.py:warn_of_coarse_peaks": "too far apart to give its size and width",
    "evaluation/separation.py:_warn_of_speeds_left_out": "count, and the response is known from",
    "linear/model/build.py:warn_of_omissions": "campbell finds modes without it",
    "linear/model/build.py:_warn_of_mesh": "counts as uneven",
    "solvers/factor.py:_tell_of_mkl": "exudyn-rotor\\[mkl\\]",
    "solid/meshes/mesh_model.py:import_model": "taken as",
    "theory/stiffening.py:warn_of_left_out": "beyond 'tilt' is left out",
    "ross.py:_check_held": "of shaft elements are left out",
    "linear/own_frequency.py:own_motions": "do not settle at their own frequency",
    "linear/model/linear_model.py:warn_beyond": "keeps its ends for motions of",
    "linear/over.py:warn_of": "do not converge for all motions",
    "multibody/supports/add_supports.py:values": "of its connector was changed; the force",
}
TEXTS = {place: text for place, (_, _, text) in PLACES.items()} | ELSEWHERE
# places that several kinds of bodies reach
TRIGGERS = PLACES | {
    "multibody/rotor/rotor_body.py:check_connections, full": (
        full_body_asked_for_connections, er.ConnectionWarning, "does not tilt"),
}  # fmt: skip


_CALLS = ("warn", "warn_explicit")


def calls_of_warn(source: str, file: str) -> list[str]:
    """Return file:function of every call of ``warn`` in a module."""
    found = []

    def visit(node: ast.AST, function: str) -> None:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            function = node.name
        called = node.func if isinstance(node, ast.Call) else None
        of_warnings = getattr(getattr(called, "value", None), "id", "") == "warnings"
        if (called.attr if of_warnings else getattr(called, "id", "")) in _CALLS:
            found.append(f"{file}:{function}")
        for child in ast.iter_child_nodes(node):
            visit(child, function)

    visit(ast.parse(source), "module")
    return found


@pytest.mark.parametrize("place", TRIGGERS)
def test_warning_fires(place, beam):
    """Once, and the line that a user sees is that of the call, not of the package."""
    trigger, kind, text = TRIGGERS[place]
    with pytest.warns(kind, match=text) as caught:
        trigger(beam)
    assert [Path(w.filename).name for w in caught] == [Path(__file__).name]


def test_every_warning_has_a_test():
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        found += calls_of_warn(path.read_text(encoding="utf-8"), file)
    assert sorted(found) == sorted(TEXTS)
