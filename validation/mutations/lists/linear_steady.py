"""Search for steady motions: steps, free motions, upright rotors, what rounding leaves."""

from validation.mutations.mutation import mutations

LINEAR_STEADY = [
    *mutations(
        "theory/rotating_axes.py",
        "test_upright_rotors.py",
        ("rounding across a skew axis is a load", "_ROUNDING = 1e-12", "_ROUNDING = 0.0"),
        ("slight loads are rounding", "_ROUNDING = 1e-12", "_ROUNDING = 1e-9"),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_search_for_steady_motions.py",
        (
            "steps are not shortened",
            "change, halvings = 0.5 * change",
            "change, halvings = 0.0 * change",
        ),
        (
            "what is unbalanced does not tell",
            "<= _RISE * before:\n                break",
            "<= 0.0 * before:\n                break",
        ),
        ("steps in vain go on", "(2.0**tries - 1.0) < left", "(2.0**tries - 1.0) < 0.0 * left"),
    ),
    *mutations(
        "linear/models/scene/equilibrium.py",
        "test_rolling_bearings_at_rest.py",
        ("nothing presses what nothing holds", "point.K + soft, -", "point.K, -"),
    ),
    *mutations(
        "linear/models/scene/probe.py",
        "test_search_for_steady_motions.py",
        (
            "forces alone point the other way",
            "turn(theta)[0].T @ _state(",
            "turn(theta)[0].T @ -_state(",
        ),
        ("refusals of films are Exudyn's", " | MovingJournalError):", "):"),
    ),
    *mutations(
        "linear/models/scene/differences.py",
        "test_differences.py",
        ("steps of 2h are added", "near + (near - far) / 3.0", "near + (far - near) / 3.0"),
        ("curved forces count as straight", "error > _STRAIGHT", "error > 1.0"),
        ("motions of a place cancel", "shape[1]) * _GOLDEN", "shape[1]) * 0.0"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_upright_rotors.py",
        ("elements touch by rounding", "_ROUNDED = 1e-14", "_ROUNDED = 0.0"),
    ),
    *mutations(
        "bearings/short_journal.py",
        "test_upright_rotors.py",
        ("slight loads have no equilibrium", "brentq(carried, 0.0,", "brentq(carried, 1e-9,"),
    ),
    *mutations(
        "linear/models/scene/along_axis.py",
        "test_motion_along_the_axis.py",
        ("loads along the axis are left", "abs(load) > UNHELD", "abs(load) > 1e9 * UNHELD"),
        ("stops behind a gap hold nothing", "(1e-6, 1e-4, 1e-2, 1.0)", "(1e-6, 1e-4)"),
        ("springs along the axis hold nothing", "[0]) > least:", "[0]) > 1e15 * least:"),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_steady_state.py",
        (
            "own spin is not kept",
            "change = change - torque * twist",
            "change = change + 0.0 * twist",
        ),
        (
            "shares of a load that nothing holds are tried",
            "_HOPELESS = 2.0**10",
            "_HOPELESS = 1e30",
        ),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_dampers_and_stops.py::test_small_orbits_in_dampers_have_the_same_equations_in_all_"
        "coordinates",
        ("equations of the way count", 'or scene.about == "given":\n', "or True:\n"),
    ),
    *mutations(
        "linear/models/scene/equilibrium.py",
        "test_journal_bearing.py::test_films_in_a_scene_are_linearised_as_in_a_list",
        (
            "rounding holds what nothing holds",
            "> _ROUNDING * sizes.max()",
            ">= 0.0 * _ROUNDING * sizes.max()",
        ),
    ),
    *mutations(
        "linear/models/scene/equilibrium.py",
        "test_dampers_and_stops.py::test_rotor_at_rest_lies_in_its_stops",
        (
            "what nothing holds does not move with its load",
            "point.K + soft, -point.residual)[0]",
            "point.K, -point.residual)[0]",
        ),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_dampers_and_stops.py::test_uneven_rotor_that_lifts_off_its_stop_starts_in_its_steady_motion",
        (
            "angles see another motion",
            "@ np.array(left) / self.samples",
            "@ np.array(left[::-1]) / self.samples",
        ),
    ),
    *mutations(
        "linear/models/scene/journal_start.py",
        "test_journal_bearing.py::test_films_in_a_scene_are_linearised_as_in_a_list",
        ("journals begin in the centre", "elif np.any(load) and speed", "elif False and speed"),
        (
            "journals begin beside their places",
            "into_rotor_frame(-apart)",
            "into_rotor_frame(apart)",
        ),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_journal_bearing.py::test_films_in_a_scene_are_linearised_as_in_a_list",
        (
            "unbalance stays",
            "+= self.probe.speed**2 * self.scene",
            "+= 0.0 * self.probe.speed**2 * self.scene",
        ),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_bearings_in_scenes_and_lists.py::test_friction_on_a_block_changes_no_exponent",
        (
            "what nothing holds drifts by rounding",
            "(balanced and iteration",
            "(False and iteration",
        ),
    ),
]
