"""Shapes of motions, spectra and orbits."""

from validation.mutations.mutation import mutations

PICTURES = [
    *mutations(
        "plotting.py",
        "test_pictures.py::test_captions_tell_the_extents_of_the_rotor_at_rest",
        (
            "the caption tells the size of the picture",
            "low, high = body.min(axis=0), body.max(axis=0)",
            "low, high = points.min(axis=0), points.max(axis=0)",
        ),
        (
            "the caption tells the size of the displaced rotor",
            "body = body[np.unique(corners)]",
            "body = points",
        ),
    ),
    *mutations(
        "pictures/motion_shapes.py",
        "test_pictures.py::test_orbits_of_whirl_are_circles_of_their_sense "
        "test_pictures.py::test_pictures_colour_forward_and_backward",
        (
            "forward and backward amplitude swapped",
            "a = 0.5 * (local[:, 0] + 1j * local[:, 1])",
            "a = 0.5 * (local[:, 0] - 1j * local[:, 1])",
        ),
        (
            "backward where it is forward",
            "ahead = (abs(forward) > abs(backward))",
            "ahead = (abs(forward) < abs(backward))",
        ),
    ),
    *mutations(
        "pictures/motion_shapes.py",
        "test_pictures.py::test_orbits_are_those_of_the_response",
        (
            "harmonics that do not turn",
            "turns = self.rates[index] + self.orders * self.speeds[index]\n        values",
            "turns = self.rates[index] + 0.0 * self.orders\n        values",
        ),
        (
            "the frame's turn left out",
            "np.concatenate([turns + speed, speed - turns])",
            "np.concatenate([turns + 0.0 * speed, 0.0 * speed - turns])",
        ),
    ),
    *mutations(
        "pictures/spectra.py",
        "test_pictures.py::test_amplitude_of_one_signal "
        "test_pictures.py::test_spectra_part_forward_from_backward",
        ("one side of two", "2.0 * lines[:, shown]", "lines[:, shown]"),
        ("backward for forward", "values[:, 0] + 1j * values", "values[:, 0] - 1j * values"),
        ("weights of another sum", "weights = weights / weights.sum()", "weights = weights / size"),
    ),
    *mutations(
        "pictures/spectra.py",
        "test_pictures.py::test_keyphasor_marks_stand_at_whole_turns",
        ("marks at radians", "turns = angle[order] / (2.0 * np.pi)", "turns = angle[order]"),
    ),
    *mutations(
        "strength/field.py",
        "test_pictures.py::test_stress_in_the_order_of_paraview",
        ("the package's own order", "[0, 1, 2, 5, 3, 4]", "[0, 1, 2, 3, 4, 5]"),
    ),
]
