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
    add_rotor,
    load_result,
    select_modes,
    stress_history,
)
from exudyn_rotor.solid.elements import principal, von_mises

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


def test_stress_in_a_run_is_the_static_one_and_what_exudyn_s_own_sensor_adds(beam):
    """Exudyn's stress sensor has the modes' part alone, here from the static state on.

    Then the stress is the static one of the prestress, found without modes, and what the sensor
    has changed since.
    """
    mbs = exu.SystemContainer().AddSystem()
    static = steady_state(beam, 300.0)[1]
    options = {"spin": 300.0, "translation": "none", "stiffening": "full"}
    body = add_rotor(mbs, beam, modal_coordinates=static, **options)
    modes = mbs.AddSensor(
        SensorNode(
            nodeNumber=body.nodes["modes"],
            outputVariableType=KINDS.Coordinates,
            storeInternal=True,
            writeToFile=False,
        )
    )
    node = 17
    with pytest.warns(UserWarning, match="stress of the modes alone") as caught:
        native = body.add_node_sensor(node, KINDS.StressLocal)
    assert caught[0].filename == __file__
    mbs.CreateForce(itemNumber=body.marker("right"), loadVector=[50.0, 20.0, 0.0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 30, 1e-3
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write, settings.solution.sensors.writePeriod = False, 1e-3 / 30
    mbs.SolveDynamic(settings)
    record, sensed = (mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in (modes, native))
    field = StressField.of(beam, body)
    history = stress_history(field, np.arange(len(record)), record, 300.0, nodes=[node])
    expected = beam.static_stress(300.0)[node] + sensed - sensed[0]
    scale = np.abs(sensed - sensed[0]).max()
    assert scale > 1e3
    # sums of some ten modal stresses of the size of the static one: eps × 1e3, far below 1e-9
    assert history.stress[:, 0] == pytest.approx(expected, abs=1e-9 * scale)
    # what the modes do not show of the static stress would be missed
    assert np.abs(expected[0] - sensed[0]).max() > 1e-3 * scale


def test_a_field_is_stored_and_tabulated(beam, tmp_path):
    field, zeta = steady_state(beam, 300.0)
    field.save(tmp_path / "field.npz")
    again = load_result(tmp_path / "field.npz")
    assert np.array_equal(again.at(zeta, 9.0), field.at(zeta, 9.0))
    rows = field.table().splitlines()
    assert len(rows) == 1 + zeta.size
    index, size, node = rows[-1].split()[:3]
    expected = von_mises(field.modes[int(node), :, int(index)])
    assert float(size) == pytest.approx(expected, rel=1e-5)  # six digits are shown


def test_stress_at_speed_without_the_static_part_warns():
    rotor = SolidRotor.from_ngsolve(block_beam(), STEEL, "z")
    field, zeta = steady_state(rotor.reduce(4, stress=True, prestress=False), 300.0)
    rows = np.stack([zeta, zeta])
    advice = r"up to 300 rad/s without .* reduce\(…, stress=True, prestress=True\)"
    with pytest.warns(UserWarning, match=advice) as caught:
        stress_history(field, [0.0, 1.0], rows, [0.0, -300.0])
    with pytest.warns(UserWarning, match=advice) as drawn:
        field.plot(zeta, 300.0)
    assert [w.filename for w in (*caught, *drawn)] == [__file__] * 2
    stress_history(field, [0.0, 1.0], rows, 0.0)  # at rest there is no such part
    field.plot(zeta, 0.0)


def test_bad_input_is_refused(beam):
    field, zeta = steady_state(beam, 300.0)
    rows, form = np.stack([zeta, zeta]), Formulation("none", 300.0)
    bare = SolidRotor.from_ngsolve(block_beam(), STEEL, "z").reduce(1)
    own, chosen = select_modes(bare, form), select_modes(beam, form)
    for call, match in (
        (lambda: stress_history(field, [0, 1], rows[:, :-1], 1.0), r"needs .* of shape \(2, 11\)"),
        (lambda: stress_history(field, [0, 1], rows * np.nan, 1.0), "modal_coordinates: needs fin"),
        (lambda: stress_history(field, [0, 1], rows, [1.0] * 3), r"speed: needs .* shape \(2,\)"),
        (lambda: field.at(zeta[:-1], 1.0), r"needs .* shape \(11,\), got .* the shape \(10,\)"),
        (lambda: stress_history(beam, [0, 1], rows, 1.0), "field: needs StressField, got Reduced"),
        (lambda: StressField.of(beam, None), "selection: needs Selection or RotorBody, got None"),
        (lambda: StressField.of(beam, form), "selection: needs Selection or RotorBody, got Form"),
        (lambda: StressField.of(beam, own), "selection: it is of another rotor"),
        (lambda: StressField.of(field, chosen), "reduced: needs ReducedRotor, got StressField"),
        (lambda: StressField.of(bare, own), "without stress modes"),
    ):
        with pytest.raises((TypeError, ValueError), match=match):
            call()
