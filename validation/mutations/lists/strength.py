"""Stress of a running rotor."""

from validation.mutations.mutation import mutations

_STATIC = "test_strength.py::test_static_stress_of_a_blade_beside_the_axis"
_RUN = "test_strength.py::test_stress_in_a_run_is_the_static_one_and_what_exudyn_s_own_sensor_adds"

STRENGTH = [
    *mutations(
        "strength/field.py",
        f"{_STATIC} {_RUN}",
        (
            "static share not moved to the axis",
            "reduced.invariants.moved(offset).h",
            "reduced.invariants.h",
        ),
        (
            "static share moved the wrong way",
            "project(reduced.center_of_mass) - reduced.center_of_mass",
            "project(-reduced.center_of_mass) + reduced.center_of_mass",
        ),
        ("static stress counted twice", "static - columns @ _static_share(reduced)", "static"),
        (
            "static stress grows with the speed",
            "+ speed**2 * self.rest[nodes] + self.modes",
            "+ speed * self.rest[nodes] + self.modes",
        ),
        (
            "static stress in a run grows with the speed",
            "(speed**2)[:, None, None]",
            "speed[:, None, None]",
        ),
    ),
    *mutations(
        "strength/field.py",
        "test_strength.py::test_stress_at_rest_is_in_the_field_once",
        (
            "stress at rest left out of a run",
            "return dynamic + self.constant[nodes] +",
            "return dynamic +",
        ),
    ),
    *mutations(
        "strength/history.py",
        "test_strength.py::test_history_is_the_superposition_and_finds_the_peak",
        (
            "smallest instead of largest stress",
            "peak[rows] = values.max(axis=0)",
            "peak[rows] = values.min(axis=0)",
        ),
        ("coolest nodes first", "np.argsort(peak)[::-1][:count]", "np.argsort(peak)[:count]"),
    ),
]
