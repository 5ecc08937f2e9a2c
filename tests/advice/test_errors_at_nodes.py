"""Errors of reduced runs at mesh nodes: what `check_run` estimates, against full runs."""

import numpy as np
import pytest
from soft_bars import STEPS, bar, run

from exudyn_rotor import (
    PrescribedMotion,
    StressField,
    check_run,
    craig_bampton_modes,
)
from exudyn_rotor.advice.left_out import left_out_at_nodes
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.solid.tensor import von_mises

RUN_UP = PrescribedMotion.run_up(0.0, 300.0, 1e-2)


@pytest.fixture(scope="module")
def upright():
    rotor = bar("z")
    return rotor.with_prestress(rotor.prestress(initial_displacement=True, euler=True))


@pytest.fixture(scope="module")
def eccentric():
    rotor = bar("y")
    return rotor.with_prestress(rotor.prestress())


@pytest.fixture(scope="module")
def ran(upright):
    """A run-up with four modes."""
    reduced = upright.reduce(4, stress=True)
    return reduced, run(upright, reduced, **SCENES["run-up"])


def recorded(body, reduced):
    """Return record, modal coordinates (m, s) and displacements of the nodes (3n, s)."""
    record = body.recorded()
    zeta = record.q[:, body.layout.unknowns][:, body.motion.modes].T
    return record, zeta, reduced.shapes.matrix @ body.selection.T @ zeta


SCENES = {
    "run-up": {"translation": "none", "spin": RUN_UP},
    "free": {"translation": "free", "spin": "free", "initial_speed": 300.0},
    "tilt": {"translation": "in-plane", "spin": 300.0, "stiffening": "tilt"},
}


@pytest.mark.parametrize(
    ("rotor", "scene"), [("upright", "run-up"), ("eccentric", "free"), ("upright", "tilt")]
)
def test_errors_are_those_of_the_full_run(rotor, scene, request):
    """The estimate is the first correction, without the inertia of the modes that are left out.

    After a quarter of the run: ringing of the start at speed is not in the estimate.
    """
    solid, options = request.getfixturevalue(rotor), SCENES[scene]
    full = run(solid, solid, **options).recorded()
    for modes in (4, craig_bampton_modes(solid, 4, coupling="RBE3")):
        reduced = solid.reduce(modes, stress=True)
        body = run(solid, reduced, **options)
        record, zeta, moved = recorded(body, reduced)
        off = np.linalg.norm(moved.T.reshape(STEPS + 1, -1, 3) - full.displacement, axis=2)
        stress = StressField.of(reduced, body).history(zeta.T, record.speed, slice(None))
        wrong = von_mises(stress - full.stress)
        left_out = at_nodes(body, reduced, solid)
        for truth, name in ((off, "displacement"), (wrong, "stress")):
            ratio = left_out[name][0].max() / truth[STEPS // 4 :].max()
            assert 0.5 < ratio < 3.0


def at_nodes(body, reduced, solid, nodes=None):
    nodes = np.arange(solid.node_count) if nodes is None else np.array(nodes)
    return left_out_at_nodes(Measures(body, body.recorded(), reduced), solid, nodes)


def test_rows_are_the_largest_of_the_nodes_asked_for(ran, upright):
    reduced, body = ran
    for nodes in (None, [3, 7]):
        found = at_nodes(body, reduced, upright, nodes)
        check = check_run(body, reduced=reduced, solid=upright, nodes=nodes, warn=False)
        for name, (part, whole) in found.items():
            assert check[name].value == pytest.approx(part.max() / whole.max(), rel=1e-12)
            worst = (nodes or range(upright.node_count))[part.max(axis=0).argmax()]
            assert check[name].meaning.endswith(f"at node {worst}")
            assert not check[name].ok
    assert "stress" not in str(check_run(body, reduced=reduced, warn=False))
    bare = upright.reduce(4)
    rows = check_run(
        run(upright, bare, **SCENES["run-up"]), reduced=bare, solid=upright, warn=False
    )
    assert rows["displacement"].value > 0.0
    assert "stress" not in {row.name for row in rows.rows}
