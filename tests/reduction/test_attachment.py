"""What modes leave out: attachment modes against a pseudo-inverse, and estimates against runs."""

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg as la
from models import STEEL, block_beam, centered_disc
from run_scenes import scene, solve

import exudyn_rotor as er
from exudyn_rotor.theory.axis import rotations, translations


@pytest.fixture(scope="module")
def beam():
    return er.SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1)


@pytest.fixture(scope="module")
def rotor():
    return centered_disc()


@pytest.fixture(scope="module")
def lopsided(rotor):
    return rotor.add_point_mass([0.15, 0, 0.215], 0.005)


def flexibility(reduced: er.ReducedRotor) -> np.ndarray:
    """Return the flexibility of the flexible modes at the interfaces, (6n, 6n)."""
    flexible = slice(len(reduced.rigid), None)
    motion = np.vstack([one.motion[:, flexible] for one in reduced.interfaces.values()])
    return (motion / reduced.frequencies[flexible] ** 2) @ motion.T


def exact_flexibility(rotor: er.SolidRotor) -> np.ndarray:
    """Return the same of all flexible modes, by dense eigenvectors."""
    values, modes = la.eigh(rotor.stiffness.toarray(), rotor.mass.toarray())
    operators = [one.mean_motion(rotor.node_count) for one in rotor.interfaces.values()]
    motion = np.vstack([each @ modes[:, 6:] for each in operators])
    return (motion / values[6:]) @ motion.T


@pytest.mark.parametrize("count", [0, 2, 6])
def test_flexibility_is_complete_with_attachment_modes(beam, count):
    exact, reduced = exact_flexibility(beam), beam.reduce(count)
    error = np.abs(flexibility(reduced.with_attachments) - exact).max() / np.abs(exact).max()
    assert error < 1e-8
    assert np.abs(flexibility(reduced) - exact).max() > 0.01 * np.abs(exact).max()


def test_truncation_and_files_keep_them(rotor, tmp_path):
    reduced = rotor.reduce(6)
    fewer = er.keep_modes(reduced, [0, 1])
    assert fewer.with_attachments is reduced.with_attachments
    for each in (reduced, fewer):  # the columns of the rotor in the basis with attachments
        found = each.with_attachments.invariants.in_basis(each.in_attached)
        np.testing.assert_allclose(found.M, np.eye(each.size), atol=1e-9)
        scale = each.invariants.K.max()
        np.testing.assert_allclose(found.K, each.invariants.K, atol=1e-9 * scale)
        for name, interface in each.with_attachments.interfaces.items():
            expected = each.interfaces[name].motion
            np.testing.assert_allclose(interface.motion @ each.in_attached, expected, atol=1e-8)
    reduced.save(tmp_path / "rotor.npz")
    loaded = er.ReducedRotor.load(tmp_path / "rotor.npz")
    np.testing.assert_array_equal(loaded.in_attached, reduced.in_attached)
    loaded = loaded.with_attachments
    given = reduced.with_attachments
    assert np.array_equal(flexibility(loaded), flexibility(given))
    assert loaded.rigid == given.rigid
    assert loaded.with_attachments is None


# ------------------------------------------------------------------ advice


def spring_forces(reduced: er.ReducedRotor, **options):
    """Return the body after a run under its weight and unbalance at 200 rad/s.

    And the displacements of both interfaces (s, 6), and the forces and moments (s, 12) of springs
    and dampers on them, rotor frame.
    """
    mbs, body = scene(reduced, gravity=[0.0, -9.81, 0.0], **options)
    kinds = exu.OutputVariableType.Displacement, exu.OutputVariableType.Velocity
    sensors = [
        [body.add_interface_sensor(name, kind) for name in ("left", "right")] for kind in kinds
    ]
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 100, 0.01)
    moved, rates = (
        np.stack([mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in pair], axis=1)
        for pair in sensors
    )
    c, s = np.cos(200.0 * np.linspace(0, 0.01, 101)), np.sin(200.0 * np.linspace(0, 0.01, 101))
    turn = np.zeros((101, 3, 3))
    turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1], turn[:, 2, 2] = c, s, -s, c, 1.0
    loads = np.zeros((101, 2, 6))
    loads[:, :, :3] = np.einsum("sij,snj->sni", turn, -2e6 * moved - 500.0 * rates)
    return body, moved.reshape(101, 6), loads.reshape(101, 12)


def static_motion(rotor: er.SolidRotor, speed: float) -> np.ndarray:
    """Return the motion (12,) of both interfaces by the static centrifugal displacement."""
    static = rotor.reduce(0, prestress=True).static_displacement(speed).reshape(-1)
    rigid = np.hstack(
        [translations(rotor.node_count), rotations(rotor.nodes, rotor.center_of_mass)]
    )
    moments = rigid.T @ (rotor.mass @ static)
    static = static - rigid @ np.linalg.solve(rigid.T @ (rotor.mass @ rigid), moments)
    parts = (rotor.interfaces[name].mean_motion(rotor.node_count) for name in ("left", "right"))
    return np.concatenate([part @ static for part in parts])


@pytest.fixture(scope="module")
def whole(lopsided):
    """Return the whole flexibility at the interfaces, and their static motion at 200 rad/s."""
    return flexibility(lopsided.reduce(0).with_attachments), static_motion(lopsided, 200.0)


def modal_stretch(reduced: er.ReducedRotor, speed: float) -> np.ndarray:
    """Return the share of it that the flexible modes show."""
    modes = np.arange(reduced.size) >= len(reduced.rigid_kinds)
    origin = reduced.axis.project(reduced.center_of_mass) - reduced.center_of_mass
    amounts = reduced.invariants.moved(origin).h[modes] / reduced.frequencies[modes] ** 2
    parts = (reduced.interfaces[name].motion[:, modes] for name in ("left", "right"))
    return speed**2 * np.concatenate([part @ amounts for part in parts])


@pytest.mark.parametrize(
    ("count", "options"),
    [
        (0, {"translation": "none", "spin": 200.0}),
        (8, {"translation": "none", "spin": 200.0}),
        (4, {"translation": "free", "initial_speed": 200.0}),
        (4, {"translation": "in-plane", "initial_speed": 200.0}),
    ],
)
def test_estimate_after_a_run_is_what_the_springs_would_bend(lopsided, whole, count, options):
    """Forces of the springs on the flexibility that the modes lack, over the displacement.

    And the static centrifugal displacement that they lack, from the whole solid's prestress.
    The estimate knows the loads from the equations of motion alone, to Newton's tolerance: springs
    exert no moments, so that rigid motions tell the forces across the axis at both ends.
    """
    reduced = lopsided.reduce(count)
    body, moved, loads = spring_forces(reduced, **options)
    missing, stretch = whole[0] - flexibility(reduced), whole[1] - modal_stretch(reduced, 200.0)
    bent = (loads @ missing + stretch).reshape(-1, 2, 6)[1:, :, :3].reshape(100, 6)
    expected = np.linalg.norm(bent, axis=1).max() / np.linalg.norm(moved, axis=1).max()
    row = er.check_run(body, warn=False)["residual"]
    assert row.value == pytest.approx(expected, rel=1e-5)
    assert not row.ok
    assert er.check_run(body, accuracy=min(1.01 * expected, 0.9), warn=False)["residual"].ok
