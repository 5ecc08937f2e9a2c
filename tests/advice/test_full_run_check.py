"""Checks of runs of full bodies, against those of the same rotor with all its modes."""

import warnings

import exudyn
import numpy as np
import pytest
from models import disc_rotor
from run_scenes import solve
from scipy.spatial.transform import Rotation
from soft_bars import STEP, STEPS, bar, run

from exudyn_rotor import (
    AssumptionWarning,
    JournalBearing,
    OilFilm,
    Pad,
    PrescribedMotion,
    ShortJournalBearing,
    SolidRotor,
    add_rotor,
    add_supports,
    check_run,
    propose,
)
from exudyn_rotor.multibody.full.full_record import recorded_states
from exudyn_rotor.solid.tensor import von_mises

RUN_UP = PrescribedMotion.run_up(0.0, 300.0, 1e-2)
SCENES = {
    "run-up": {"translation": "none", "spin": RUN_UP, "stiffening": "none"},
    "free": {"translation": "free", "spin": "free", "initial_speed": 300.0, "stiffening": "tilt"},
    "frozen": {
        "translation": "free",
        "spin": "free",
        "initial_speed": 300.0,
        "spin_coupling": "frozen",
        "stiffening": "full",
    },
}
OF_MODES = {"unresisted load", "top modes", "residual", "divergence"}


@pytest.fixture(scope="module")
def solid():
    return bar("z")


@pytest.fixture(scope="module")
def beside():
    return bar("y")


@pytest.mark.parametrize("scene", SCENES)
def test_rows_are_those_of_all_modes(solid, scene):
    """Mass-orthonormal modes, all of them, span the same displacements."""
    whole = check_run(run(solid, solid, **SCENES[scene]), warn=False)
    modes = check_run(run(solid, solid.reduce(54), **SCENES[scene]), warn=False)
    assert {row.name for row in whole.rows} == {row.name for row in modes.rows} - OF_MODES
    for row in whole.rows:
        assert row.value == pytest.approx(modes[row.name].value, rel=3e-3, abs=1e-15)
        assert row.ok == modes[row.name].ok


SIZE = {"radius": 0.03, "length": 0.02, "viscosity": 0.02}
PADS = [Pad(start=-0.5 * np.pi - 1.0, arc=2.0, clearance=1e-4)]
PLACE = np.array([2e-5, -1.1e-4])  # the mean angle of the pad is along -n2
SHORT = ShortJournalBearing(interface="left", clearance=1e-4, **SIZE)
PAD = JournalBearing(interface="left", film=OilFilm(pads=PADS, **SIZE))
FILMS = {"short": (SHORT, 0.99e-4), "pad": (PAD, 1e-4 - PAD.film.thinnest)}


@pytest.mark.parametrize("spin", [300.0, "free"])
@pytest.mark.parametrize("kind", FILMS)
def test_a_journal_out_of_its_film_fails_the_check(beside, kind, spin):
    """Its mean displacement, in whatever axes the rotor lies, for full and reduced bodies."""
    film, reach = FILMS[kind]
    options = {"translation": "none", "spin": spin, "stiffening": "none"}
    options["rotation"] = Rotation.from_rotvec([0.3, -0.7, 0.4]).as_matrix()
    moved = beside.axis.plane @ PLACE
    for model in (beside, beside.reduce(2)):
        trial = add_rotor(exudyn.SystemContainer().AddSystem(), model, **options).motion
        start = np.tile(moved, beside.node_count)
        if model is not beside:  # the first three modes are mass-orthonormal translations
            S = trial.invariants.S
            start = np.r_[S[:, :3].T @ moved, np.zeros(S.shape[1] - 3)]
        mbs = exudyn.SystemContainer().AddSystem()
        body = add_rotor(mbs, model, modal_coordinates=start, **options)
        add_supports(body, film)
        mbs.Assemble()
        row = check_run(body, warn=False)["film"]
        assert row.value == pytest.approx(np.linalg.norm(PLACE) / reach, rel=1e-3)
        assert not row.ok


def test_stiffening_of_a_mesh_is_estimated_as_for_modes():
    """The same displacement, in modes and in nodes, so large that the static one is no matter."""
    solid = disc_rotor(order=1)  # without its elements nothing but the matrices is known
    rotor = SolidRotor.from_matrices(solid.mass, solid.stiffness, solid.nodes, "z")
    reduced = rotor.reduce(6)
    values = []
    for model in (rotor, reduced):
        options = {"spin": 300.0, "translation": "none", "stiffening": "tilt"}
        amounts = np.zeros(11)
        amounts[[5, 7]] = 0.02, 0.01
        start = reduced.shapes.matrix[:, 6:] @ amounts[5:] if model is rotor else amounts
        mbs = exudyn.SystemContainer().AddSystem()
        body = add_rotor(mbs, model, modal_coordinates=start, **options)
        mbs.Assemble()
        values.append(check_run(body, warn=False)["stiffening"].value)
    assert values[0] == pytest.approx(values[1], rel=1e-3)


def test_step_and_speed_too_high_are_told(solid):
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, solid, spin=300.0, translation="none")
    body.start_recording(1e-3 * np.arange(21))
    mbs.Assemble()
    solve(mbs, 20, 0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        proposal = propose(solid.reduce(4), speeds=(0.0, 200.0), supports=[])
    with pytest.warns(AssumptionWarning) as caught:
        check = check_run(body, proposal=proposal)
    assert {"step", "spin step", "speed"} <= {row.name for row in check.failed}
    assert len(caught) == len(check.failed)
    assert check["spin step"].value == pytest.approx(0.3, rel=1e-9)
    assert check["speed"].value == pytest.approx(1.5)


def test_without_instants_the_end_alone_is_known(solid):
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, solid, spin=100.0, translation="none")
    mbs.Assemble()
    solve(mbs, 20, 0.02)
    with pytest.warns(AssumptionWarning, match="for a full body with instants"):
        check = check_run(body, limits={"tilt": 1.0, "adrift": 10.0, "travel": 1.0, "strain": 1.0})
    assert check.instants == 1
    assert check["deflection"].value > 0.0
    for given in ({"reduced": solid.reduce(2)}, {"solid": solid}, {"nodes": [0]}):
        with pytest.raises(ValueError, match="is a full body, without an error of modes"):
            check_run(body, **given)


def test_stress_of_the_run_is_over_the_yield_stress(solid):
    """The von Mises stress of all displacements, the static ones by the spin among them."""
    carried = solid.with_prestress(solid.prestress(yield_stress=1e6))
    body = run(carried, carried, **SCENES["run-up"])
    peak = von_mises(body.recorded().stress).max()
    assert check_run(body, warn=False)["yield"].value == pytest.approx(peak / 1e6, rel=1e-9)


def test_rates_are_those_of_the_displacements(solid):
    """Generalised alpha keeps the displacement's step beside the mean rate, to second order."""
    states = recorded_states(run(solid, solid, **SCENES["free"]))
    mean = 0.5 * (states.q_t[1:] + states.q_t[:-1])
    steps = np.diff(states.q, axis=0) / STEP
    assert len(states.time) == STEPS + 1
    assert np.abs(steps - mean)[10:].max() < 0.1 * np.abs(mean).max()
    np.testing.assert_array_equal(states.speed, states.q_t[:, 5])
