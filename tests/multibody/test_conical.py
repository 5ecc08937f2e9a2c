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
