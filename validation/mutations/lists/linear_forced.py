"""Forced motions of periodic systems."""

from validation.mutations.mutation import mutations

LINEAR_FORCED = [
    *mutations(
        "linear/response/steady_response.py",
        "test_mirror_images.py::test_response_of_tables_below_zero_is_the_mirror_image",
        (
            "tables asked above zero",
            "space.at(values[np.argmax(np.abs(values))])",
            "space.at(fastest)",
        ),
    ),
    *mutations(
        "linear/response/steady_response.py",
        "test_uneven_inertia.py::test_unbalance_responses_of_elastic_eccentric_rotors_are_alike",
        ("drive gives way", "loads=[load], held=True, residual", "loads=[load], residual"),
    ),
    *mutations(
        "linear/models/full/subspace.py",
        "test_full_response.py",
        (
            "drive's torque is left over",
            "force = self.full.spin.without_torque(force[:, None])[:, 0]",
            "pass",
        ),
    ),
    *mutations(
        "linear/periodic/harmonic_balance.py",
        "test_response.py",
        (
            "damping of a harmonic with the wrong sign",
            "rates = 1j * (self.rate + new",
            "rates = -1j * (self.rate + new",
        ),
    ),
    *mutations(
        "linear/periodic/harmonic_balance.py",
        "test_coupled_harmonics.py",
        (
            "damping that turns with the wrong sign",
            "(K + 1j * self.rate * D - self",
            "(K - 1j * self.rate * D - self",
        ),
        (
            "what couples harmonics acts on a drive",
            "np.where(self.held, 0.0, self.scale)[..., None]",
            "np.where(self.held, self.scale, self.scale)[..., None]",
        ),
        (
            "the inverse of another harmonic",
            "zip([parts[i] for i in new]",
            "zip([parts[i] for i in new[::-1]]",
        ),
        (
            "one factor whatever a load leaves free",
            "if parts not in self.groups",
            "if not self.groups",
        ),
    ),
    *mutations(
        "linear/periodic/coupled_harmonics.py",
        "test_coupled_harmonics.py",
        ("links with the rate of the row", "orders[columns] * system", "orders[rows] * system"),
        ("any residual will do", "<= _RESIDUAL * EPSILON", "<= 1e12 * EPSILON"),
        ("no condition of what couples", "beside).max()", "0.0 * beside).max()"),
        ("condition of the inverse alone", "1.0 / (norm * inverse)", "1.0 / inverse"),
        ("adjoint by the factor itself", "forces, trans=2", "forces, trans=0"),
        ("adjoint of links left out", "self._coupling.conj().T @", "self._coupling @"),
        (
            "norm of the first column alone",
            "last = applied((places == place)",
            "last = applied((places == 0)",
        ),
        ("ends at the first column", "if last >= 0 and", "if last < 0 or"),
        (
            "answer of links with the other sign",
            "return alone - self.inverses @ self._linked",
            "return alone + self.inverses @ self._linked",
        ),
    ),
    *mutations(
        "linear/periodic/harmonic_balance.py",
        "test_peaks.py",
        ("free coordinates mixed with soft motions", "axis=0) <= _ROUNDING", "axis=0) < 0.0"),
        (
            "a soft motion under load is free",
            "relative[columns] <= _ROUNDING",
            "relative[columns] <= _FREE",
        ),
    ),
    *mutations(
        "linear/periodic/harmonic_balance.py",
        "test_structural_damping.py::test_whirl_of_a_turning_rotor",
        (
            "structural damping whatever the sense of the turning",
            "np.where(zero, 0.0, np.sign(frequencies))",
            "np.where(zero, 0.0, 1.0)",
        ),
        (
            "structural damping by the frequency in the inertial frame",
            "1j * sense * self.system.H",
            "1j * np.sign(self.rate) * self.system.H",
        ),
    ),
]
