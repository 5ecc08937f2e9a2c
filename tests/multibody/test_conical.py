"""Conical frequencies of rigid rotors on springs against the closed form in the inertial frame."""

import numpy as np
import pytest

from validation.exudyn_3d import conical

STEP = 1e-4


@pytest.fixture(scope="module", params=["shaft", "disc"])
def model(request):
    return conical.rigid_model(*conical.SHAPES[request.param])


@pytest.mark.parametrize("speed", [150.0, 300.0])
def test_stiffened_body_has_the_exact_conical_frequencies(model, speed):
    exact = conical.conical_frequencies(model, speed)
    expected = conical.integrated_frequencies(exact, speed, STEP)
    measured = conical.measured_frequencies(model, speed, STEP, "tilt")
    # Prony's method resolves 1e-7 where no other frequency is close
    np.testing.assert_allclose(measured, expected, rtol=1e-6)


def test_frequency_error_is_the_integrators(model):
    speed = 300.0
    exact = conical.conical_frequencies(model, speed)
    errors = [
        np.abs(conical.measured_frequencies(model, speed, step, "tilt") - exact)
        for step in (STEP, STEP / 2)
    ]
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, rtol=0.02)


def test_papers_terms_miss_the_conical_frequencies(model):
    speed = 150.0
    exact = conical.conical_frequencies(model, speed)
    measured = conical.measured_frequencies(model, speed, STEP, "none")
    assert np.all(np.abs(measured / exact - 1.0) > 2e-3)


def test_prony_finds_two_known_frequencies():
    time = 0.01 * np.arange(200)
    signal = 2.0 * np.exp(-31.4j * time) + (0.3 + 0.1j) * np.exp(95.2j * time)
    np.testing.assert_allclose(conical.prony_frequencies(signal, 0.01), [-31.4, 95.2], rtol=1e-10)
