"""Stress of a running rotor against disc theory, Exudyn's own stress sensor and superposition."""

import exudyn as exu
import ngsolve as ngs
import numpy as np
import pytest
from exudyn.itemInterface import SensorNode
from models import STEEL, block_beam
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import (
    Formulation,
    SolidRotor,
    StressField,
    StressHistory,
    add_rotor,
    load_result,
    select_modes,
    stress_history,
)
from exudyn_rotor.solid.tensor import principal, von_mises

INNER, OUTER, SPEED = 0.05, 0.2, 1000.0
KINDS = exu.OutputVariableType


@pytest.fixture(scope="module")
def ring():
    solid = Cylinder(Pnt(0, 0, 0), Z, OUTER, 0.02) - Cylinder(Pnt(0, 0, -1), Z, INNER, 3)
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.04))
    return SolidRotor.from_ngsolve(mesh, STEEL, "z").reduce(8, stress=True, prestress=True)


@pytest.fixture(scope="module")
def beam():
    return SolidRotor.from_ngsolve(block_beam(), STEEL, "z").reduce(6, stress=True, prestress=True)


def steady_state(reduced, speed):
    """Return the field of a free rotor at constant speed, and its static modal coordinates."""
    selection = select_modes(reduced, Formulation("none", speed))
    stiffness, load = np.diag(selection.invariants.K), selection.invariants.h
    zeta = np.where(stiffness > 1.0, speed**2 * load / np.maximum(stiffness, 1.0), 0.0)
    return StressField.of(reduced, selection), zeta


def test_scalars_of_the_stress_tensor():
    """Uniaxial tension s: s, (s, 0, 0). Pure shear t: √3 t, (t, 0, −t). Pressure: no von Mises."""
    states = np.array([[5, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 2], [-3, -3, -3, 0, 0, 0]], dtype=float)
    assert von_mises(states) == pytest.approx([5.0, 2.0 * np.sqrt(3.0), 0.0])
    expected = [[5, 0, 0], [2, 0, -2], [-3, -3, -3]]
    assert principal(states) == pytest.approx(np.array(expected, dtype=float), abs=1e-12)


def test_static_stress_is_that_of_a_rotating_disc(ring):
    """Hoop stress at the bore of a plane annulus (Timoshenko, Goodier, Theory of Elasticity).

    ``ρω²(3 + ν)/4 (b² + (1 − ν)/(3 + ν) a²)``; the mesh has two elements over the bore's radius,
    and stress is averaged at the nodes: 3 %. Eight modes alone show a thousandth of it.
    """
    ratio, density = STEEL["poissonsRatio"], STEEL["density"]
    hoop = OUTER**2 + (1 - ratio) / (3 + ratio) * INNER**2
    hoop *= density * SPEED**2 * (3 + ratio) / 4
    field, zeta = steady_state(ring, SPEED)
    bore = np.abs(np.hypot(*ring.shapes.nodes[:, :2].T) - INNER) < 1e-6
    stress = field.at(zeta, SPEED)
    assert principal(stress[bore])[:, 0].mean() == pytest.approx(hoop, rel=0.03)
    assert von_mises((field.modes @ zeta)[bore]).max() < 0.02 * hoop
    assert stress == pytest.approx(ring.static_stress(SPEED), abs=1e-9 * hoop)


def test_history_is_the_superposition_and_finds_the_peak(beam):
    field, zeta = steady_state(beam, 300.0)
    time = np.linspace(0.0, 1.0, 41)
    shake = np.zeros((time.size, zeta.size))
    shake[:, -1] = 1e-4 * np.sin(7.0 * time)
    history = stress_history(field, time, zeta + shake, 300.0, count=4)
    everywhere = von_mises(field.history(zeta + shake, np.full(41, 300.0), slice(None)))
    node = int(np.argmax(everywhere.max(axis=0)))
    assert history.hottest == history.nodes[0] == node
    assert history.peak == pytest.approx(everywhere.max(axis=0), rel=1e-12)
    assert history.peak_time[node] == time[np.argmax(everywhere[:, node])]
    assert history.von_mises[:, 0] == pytest.approx(everywhere[:, node])
    assert history.principal.shape == (41, 4, 3)
    assert str(node) in history.table()
    chosen = stress_history(field, time, zeta + shake, 300.0, nodes=[3, node])
    assert chosen.nodes.tolist() == [node, 3]


def test_dynamic_part_is_what_exudyn_s_own_sensor_says(beam):
    """A native sensor records the modes; Exudyn's stress sensor has the modes' part of the same."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, beam, spin=300.0, translation="none", stiffening="full")
    modes = mbs.AddSensor(
        SensorNode(
            nodeNumber=body.nodes["modes"],
            outputVariableType=KINDS.Coordinates,
            storeInternal=True,
            writeToFile=False,
        )
    )
    node = 17
    native = body.add_node_sensor(node, KINDS.StressLocal)
    mbs.CreateForce(itemNumber=body.marker("right"), loadVector=[50.0, 20.0, 0.0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 30, 1e-3
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    record, expected = (mbs.GetSensorStoredData(sensor) for sensor in (modes, native))
    field = StressField.of(beam, body.selection)
    history = stress_history(field, record[:, 0], record[:, 1:], 300.0, nodes=[node])
    static = 300.0**2 * field.rest[node]
    scale = np.abs(expected[:, 1:]).max()
    assert scale > 1e3
    assert history.stress[:, 0] - static == pytest.approx(expected[:, 1:], abs=1e-9 * scale)
    assert np.abs(static).max() > 1e-3 * scale


def test_pictures_and_storage(beam, tmp_path):
    field, zeta = steady_state(beam, 300.0)
    history = stress_history(field, [0.0, 1.0], np.stack([0 * zeta, zeta]), [0.0, 300.0], count=2)
    history.save(tmp_path / "stress.npz")
    again = load_result(tmp_path / "stress.npz")
    assert isinstance(again, StressHistory)
    assert np.array_equal(again.stress, history.stress)
    bar = history.plot_peak().axes[1]
    assert bar.get_ylim()[1] == pytest.approx(1e-6 * history.peak.max(), rel=0.3)
    line = history.plot().axes[0].lines[0]
    assert line.get_ydata() == pytest.approx(1e-6 * history.von_mises[:, 0])
    assert len(field.plot(zeta, 300.0).axes) == 2


def test_bad_input_is_refused(beam):
    field, zeta = steady_state(beam, 300.0)
    rows = np.stack([zeta, zeta])
    with pytest.raises(ValueError, match="needs one row of"):
        stress_history(field, [0.0, 1.0], rows[:, :-1], 300.0)
    with pytest.raises(ValueError, match="zeta: has values that are not finite"):
        stress_history(field, [0.0, 1.0], rows * np.nan, 300.0)
    with pytest.raises(ValueError, match="nodes: needs node numbers"):
        stress_history(field, [0.0, 1.0], rows, 300.0, nodes=[10**6])
    bare = SolidRotor.from_ngsolve(block_beam(), STEEL, "z").reduce(1)
    with pytest.raises(ValueError, match="without stress modes"):
        StressField.of(bare, select_modes(bare, Formulation("none", 1.0)))
