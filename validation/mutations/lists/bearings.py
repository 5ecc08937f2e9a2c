"""Bearings and supports: their laws."""

from validation.mutations.mutation import mutations

BEARINGS = [
    *mutations(
        "bearings/support.py",
        "test_stability.py::test_internal_damping_sets_in_at_the_closed_form_speed "
        "test_stability.py::test_a_symmetric_rotor_does_not_depend_on_the_frame",
        (
            "circulatory part of a damper reversed",
            "carried = stiffness + speed * damping",
            "carried = stiffness - speed * damping",
        ),
    ),
    *mutations(
        "bearings/support.py",
        "test_linear_input.py::test_tables_and_matrices_are_told_apart "
        "test_linear_input.py::test_a_table_is_not_used_beyond_its_ends_unless_asked_for",
        ("table read at its start", "share = (speed - ", "share = 0.0 * (speed - "),
        ("ends of a table taken for its inside", "if not least <= speed <= most:", "if False:"),
    ),
    *mutations(
        "bearings/support.py",
        "test_critical.py",
        (
            "tilts without stiffness",
            'self._matrix("tilt_stiffness", speed)',
            '0.0 * self._matrix("tilt_stiffness", speed)',
        ),
    ),
    *mutations(
        "bearings/support.py",
        "test_advice_linear.py::test_resonances_are_those_without_damping_and_cross_coupling",
        (
            "skew part kept in place of the symmetric one",
            "0.5 * (values + np.swapaxes",
            "0.5 * (values - np.swapaxes",
        ),
    ),
]
