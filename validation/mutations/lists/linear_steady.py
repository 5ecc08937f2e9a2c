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
]
