"""The frequency that a motion has for an observer at rest."""

from dataclasses import replace

import numpy as np
import pytest
from models import disc_rotor

from exudyn_rotor import Support
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent
from exudyn_rotor.linear.models.linear_model import linear_model
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes

NU, SPEED = 1000.0, 300.0


def ring_content(*waves):
    """Axial motions ``cos nα`` and ``sin nα`` of 24 points on a circle, for each n."""
    angle = 2.0 * np.pi * np.arange(24) / 24
    points = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(24)])
    axial = np.column_stack([f(n * angle) for n in waves for f in (np.cos, np.sin)])
    motion = np.kron(axial, [[0.0], [0.0], [1.0]])
    return WhirlContent.from_points(PointMotions(points, motion, None, True))


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
@pytest.mark.parametrize("sense", [1, -1])
def test_motion_that_stands_in_the_rotor_frame_is_seen_with_the_spin(speed, sense):
    """Both waves of ``cos 3α`` have the same energy but for what mesh and rounding leave."""
    vector = np.array([[[1.0], [0.005j * sense]]])
    seen, codes, diameters = ring_content(3).classify(vector, np.array([0]), np.array([NU]), speed)
    assert seen[0] == pytest.approx(NU + 3 * SPEED, rel=1e-12)
    assert (WHIRLS[codes[0]], diameters[0]) == ("mixed", 3)


@pytest.mark.parametrize("sense", [1, -1])
def test_clear_waves_are_seen_at_their_own_frequency(sense):
    """``exp(i(νt − nα))`` has n = ±3; half the amplitude of the other wave leaves the first."""
    vector = np.array([[[1.0], [-1j * sense / 3.0]]])  # amplitudes 2/3 and 1/3
    seen, _, _ = ring_content(3).classify(vector, np.array([0]), np.array([NU]), SPEED)
    assert seen[0] == pytest.approx(NU + sense * 3 * SPEED, rel=1e-12)


def test_waves_of_one_frequency_seen_from_outside_count_together():
    """n = −1 and, with the harmonic −2, n = 1 are seen at ν − Ω; n = −3 alone is weaker."""
    content, orders = ring_content(1, 3), np.array([-2, 0, 2])
    vector = np.zeros((3, 4, 1), dtype=complex)
    vector[0, :2, 0] = 0.9 * np.array([1.0, -1j])
    vector[1, :2, 0] = 0.9 * np.array([1.0, 1j])
    vector[1, 2:, 0] = np.array([1.0, 1j])
    seen, _, _ = content.classify(vector, orders, np.array([NU]), SPEED)
    assert seen[0] == pytest.approx(NU - SPEED, rel=1e-12)


def test_energies_of_waves_do_not_depend_on_how_a_mesh_numbers_its_nodes():
    """A sample of them would: by a per cent, enough to choose between two frequencies."""
    reduced = disc_rotor().reduce(6)
    shapes = reduced.shapes
    other = np.random.default_rng(1).permutation(len(shapes.nodes))
    assert len(other) > 800
    rows = (3 * other[:, None] + np.arange(3)).ravel()
    moved = replace(
        reduced, shapes=replace(shapes, nodes=shapes.nodes[other], matrix=shapes.matrix[rows])
    )
    supports = [Support(name, 1e7) for name in reduced.interfaces]
    vectors = np.eye(len(shapes.matrix[0]))[None].astype(complex)
    one, two = (
        WhirlContent.of(linear_model(rotor, supports=supports)).energies(vectors)
        for rotor in (reduced, moved)
    )
    np.testing.assert_allclose(two, one, rtol=1e-8, atol=1e-10 * one.max())


def test_slow_growth_beside_a_free_motion_keeps_its_name():
    """Closer to zero than two copies of a free motion may be, but not zero to rounding."""
    vectors = np.zeros((1, 6, 3))
    vectors[0, 0, 0] = vectors[0, 2, 1] = vectors[0, 3, 2] = 1.0
    modes = FloquetModes(np.array([0.0, 1e-4, -1e-4], complex), vectors, np.array([0]), 1e-3)
    _, _, codes, diameters = ring_content(0, 1, 2).named(modes, SPEED)
    assert [WHIRLS[code] for code in codes] == ["axial", "forward", "forward"]
    assert diameters.tolist() == [0, 1, 1]


def test_repeated_modes_of_each_group_become_waves_of_one_sense():
    """Planes of ``cos nα`` and ``sin nα`` become ``exp(±inα)``, −n first; one shape stays one."""
    rng, content = np.random.default_rng(3), ring_content(0, 1, 2)
    waves = np.zeros((2, 6, 2), dtype=complex)
    for n, wave in enumerate(waves, start=1):
        wave[2 * n : 2 * n + 2] = np.array([[1.0, 1.0], [1j, -1j]]) / np.sqrt(2.0)
    single = np.repeat(waves[0, :, :1], 2, axis=1)
    mixed = waves @ rng.normal(size=(2, 2, 2))
    defective = single + 1e-6 * rng.normal(size=single.shape)
    given = np.stack([mixed[0], single, defective, mixed[1]])[:, None]
    given /= np.linalg.norm(given, axis=2, keepdims=True)
    first, same, near, last = content.polarised(given, np.array([0]))[:, 0]
    for found, wave in zip((first, last), waves, strict=True):
        np.testing.assert_allclose(np.abs(wave.conj().T @ found), np.eye(2), atol=1e-12)
    np.testing.assert_allclose(np.abs(single.conj().T @ same), 1.0, atol=1e-12)
    np.testing.assert_array_equal(near, given[2, 0])
