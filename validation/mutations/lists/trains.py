"""Several rotors in linear analyses."""

from validation.mutations.mutation import mutations

_TESTS, _DUAL = "test_rotor_trains.py::", "test_dual_spool.py::"
_DISCS = _TESTS + "test_two_rigid_discs_are_those_of_the_closed_form"
_REFUSED = _TESTS + "test_what_does_not_repeat_is_refused"
TRAINS = [
    *mutations(
        "linear/models/trains/turned_rotor.py",
        _DISCS,
        (
            "drift of turned coordinates reversed",
            "return self.ratio - self.frame",
            "return self.frame - self.ratio",
        ),
        ("Coriolis term at the common speed", "2.0 * r * speed * X", "2.0 * speed * X"),
        ("centrifugal term at the common speed", "-((r * speed) ** 2) * X", "-(speed**2) * X"),
        (
            "Coriolis of turned coordinates reversed",
            "-2.0 * w * speed * MG",
            "2.0 * w * speed * MG",
        ),
        (
            "centripetal of turned coordinates reversed",
            "(w * speed) ** 2 * MG",
            "-((w * speed) ** 2) * MG",
        ),
        ("damping of turned coordinates reversed", "-w * speed * X @ G", "w * speed * X @ G"),
    ),
    *mutations(
        "linear/models/trains/uneven_space.py",
        "test_uneven_trains.py",
        ("what the mean leaves out is no error", "left_out**2 *", "0.0 *"),
        ("growth of an asymmetric rotor as an error", "left_out**2 *", "left_out *"),
        ("growth counts by itself in no rotor", "np.minimum(change, error)", "error"),
    ),
    *mutations(
        "linear/models/links.py",
        _DISCS,
        ("links without reaction", "[[1.0, -1.0], [-1.0, 1.0]]", "[[1.0, -1.0], [0.0, 0.0]]"),
        ("damping of supports turned back", "turning = self.drift", "turning = -self.drift"),
    ),
    *mutations(
        "linear/models/links.py",
        _REFUSED,
        (
            "supports in the rotor's frame stand still",
            "turns = ratio if support",
            "turns = 0.0 if support",
        ),
    ),
    *mutations(
        "linear/models/trains/turning.py",
        _DISCS,
        ("waves turn back", "(1j * self.waves)", "(-1j * self.waves)"),
        ("places turn with the waves", "n - self.waves[None, :]", "n + self.waves[None, :]"),
    ),
    *mutations(
        "linear/models/trains/turning.py",
        _DUAL + "test_axisymmetric_part_and_what_is_left",
        ("unevenness of fast motions", "1.0 + (omega / first) ** 2", "1.0 + 0.0 * omega"),
    ),
    *mutations(
        "linear/models/links.py",
        "test_train_responses.py::test_unbalance_of_either_rotor",
        ("links push as they pull", "[[1.0, -1.0], [-1.0, 1.0]]", "[[1.0, 1.0], [1.0, 1.0]]"),
    ),
    *mutations(
        "linear/models/fourier_terms.py",
        _TESTS + "test_uneven_rotor_at_a_whole_ratio_against_the_monodromy_matrix",
        ("damping where places turn with a rotor", "1j * n * X", "-1j * n * X"),
    ),
    *mutations(
        "linear/models/trains/linear_train.py",
        "test_train_responses.py::test_loads_that_turn_with_another_rotor_are_refused",
        ("unbalance of any rotor at the common speed", "if ratio != 1.0:", "if False:"),
    ),
    *mutations(
        "linear/models/trains/linear_train.py",
        "test_geared_trains.py::test_geared_rotors_are_those_of_constant_equations_at_rest",
        ("free spins of geared rotors held", "values <= _HELD", "values < -_HELD"),
    ),
    *mutations(
        "linear/models/trains/standing_space.py",
        _TESTS + "test_modes_from_axes_at_rest_hold_in_turning_ones",
        ("waves turn back", "- 1j * strongest * speed", "+ 1j * strongest * speed"),
        ("harmonics of the wrong wave", "+ strongest - n", "- strongest + n"),
    ),
    *mutations(
        "linear/models/trains/turning.py",
        _DUAL + "test_estimates_are_the_errors_against_more_modes",
        (
            "shapes that lack stand still",
            "np.r_[self.waves, waves]",
            "np.r_[self.waves, 0 * waves]",
        ),
    ),
    *mutations(
        "linear/models/basis/left_out.py",
        _DUAL + "test_estimates_are_the_errors_against_more_modes",
        (
            "shapes that lack count in the central harmonics only",
            "max(highest, step)",
            "step",
        ),
        ("a large shift is found once", "move(found, shapes, far) - values", "found - values"),
    ),
    *mutations(
        "linear/models/trains/link_places.py",
        "test_rotor_trains.py::test_links_are_where_their_ends_are",
        ("rotors put on the wrong side", "at[first] - apart", "at[first] + apart"),
        ("rotors put back on the wrong side", "at[second] + apart", "at[second] - apart"),
    ),
    *mutations(
        "linear/models/trains/link_places.py",
        "test_geared_trains.py::test_gears_are_apart_by_their_centre_distance",
        ("centres the other way", "places[1] - places[0] - expected", "places[1] - places[0]"),
    ),
    *mutations(
        "linear/models/rotor/own_coordinates.py",
        "test_controlled_trains.py::test_rotors_without_links_are_those_alone",
        ("films at the common speed", "film, 0.0, self.rates[index]", "film, 0.0, 1.0"),
        (
            "controllers turn in axes at rest",
            "self.frame * speed, self.turning",
            "speed, self.turning",
        ),
    ),
    *mutations(
        "linear/models/trains/turning.py",
        "test_controlled_trains.py::test_motions_of_controllers_and_pads_hold_in_turning_axes",
        ("controllers' pairs stand still", "np.tile([1, -1], pairs)", "np.tile([0, 0], pairs)"),
    ),
    *mutations(
        "linear/models/trains/linear_train.py",
        "test_controlled_trains.py::test_critical_speeds_and_free_motions_have_the_stiffness_of_one_rotor",
        (
            "films not undamped",
            "element.undamped() for element in self.held.elements",
            "element for element in self.held.elements",
        ),
    ),
    *mutations(
        "linear/models/trains/standing_space.py",
        _TESTS + "test_critical_speeds_on_uneven_supports_are_zeros_in_axes_at_rest",
        (
            "waves turn the wrong way at critical speeds",
            "self._waves(motions)[::-1]",
            "self._waves(motions)",
        ),
    ),
    *mutations(
        "linear/models/trains/scene_train.py",
        "test_scene_trains.py",
        ("all rotors at one speed", "spin_at_start(body)[1] / speed", "1.0"),
        ("what stands in the scene beside", "number not in known and", "False and"),
        (
            "prescribed spins left free",
            "return not body.formulation.has_spin and",
            "return False and",
        ),
        (
            "a shaft without its torsion",
            "Support(one.at, **{n: X @",
            "Support(one.at, **{n: 0.0 * X @",
        ),
    ),
    *mutations(
        "reduction/driven.py",
        "test_scene_trains.py",
        ("another motion than the spin left out", "kind is not ModeKind.SPIN]", "i != 0]"),
    ),
]
