"""Checks of runs of full bodies, against those of the same rotor with all its modes."""

import warnings

import exudyn
import numpy as np
import pytest
from run_scenes import solve
from scipy.spatial.transform import Rotation
from soft_bars import bar, run

import exudyn_rotor as er

RUN_UP = er.PrescribedMotion.run_up(0.0, 300.0, 1e-2)
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
OF_MODES = {"unresisted load", "stiffening", "top modes", "residual"}


@pytest.fixture(scope="module")
def solid():
    return bar("z")


@pytest.fixture(scope="module")
def beside():
    return bar("y")


@pytest.mark.parametrize("scene", SCENES)
def test_rows_are_those_of_all_modes(solid, scene):
    """Mass-orthonormal modes, all of them, span the same displacements."""
    whole = er.check_run(run(solid, solid, **SCENES[scene]), warn=False)
    modes = er.check_run(run(solid, solid.reduce(54), **SCENES[scene]), warn=False)
    assert {row.name for row in whole.rows} == {row.name for row in modes.rows} - OF_MODES
    for row in whole.rows:
        if row.name == "axial force":  # there is none, and each measure rounds by itself
            assert row.value < 1e-3
            continue
        assert row.value == pytest.approx(modes[row.name].value, rel=3e-3, abs=1e-15)
        assert row.ok == modes[row.name].ok


SIZE = {"radius": 0.03, "length": 0.02, "viscosity": 0.02}
PADS = [er.Pad(start=-0.5 * np.pi - 1.0, arc=2.0, clearance=1e-4)]
PLACE = np.array([2e-5, -1.1e-4])  # the mean angle of the pad is along -n2
SHORT = er.ShortJournalBearing(interface="left", clearance=1e-4, **SIZE)
PAD = er.JournalBearing(interface="left", film=er.OilFilm(pads=PADS, **SIZE))
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
        trial = er.add_rotor(exudyn.SystemContainer().AddSystem(), model, **options).motion
        start = np.tile(moved, beside.node_count)
        if model is not beside:  # the first three modes are mass-orthonormal translations
            S = trial.invariants.S
            start = np.r_[S[:, :3].T @ moved, np.zeros(S.shape[1] - 3)]
        mbs = exudyn.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, model, modal_coordinates=start, **options)
        er.add_supports(body, film)
        mbs.Assemble()
        row = er.check_run(body, warn=False)["film"]
        assert row.value == pytest.approx(np.linalg.norm(PLACE) / reach, rel=1e-3)
        assert not row.ok


def test_step_and_speed_too_high_are_told(solid):
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, solid, spin=300.0, translation="none")
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 20, 0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        proposal = er.propose(solid.reduce(4), speeds=(0.0, 200.0), supports=[])
    with pytest.warns(er.AssumptionWarning) as caught:
        check = er.check_run(body, proposal=proposal)
    assert {"step", "speed"} <= {row.name for row in check.failed}
    assert len(caught) == len(check.failed)
    assert check["speed"].value == pytest.approx(1.5)
