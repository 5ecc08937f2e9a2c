"""Wrong physics in the equations that turn: Hill, Floquet, harmonic balance."""

from validation.mutations.mutation import mutations

LINEAR_PERIODIC = [
    *mutations(
        "linear/periodic/harmonics.py",
        "test_stability.py",
        ("rate of a harmonic once", "D + 2.0 * M * rate, K", "D + M * rate, K"),
        ("blocks transposed", "places.get(m + n)", "places.get(m - n)"),
        (
            "harmonics left out are not answered",
            "= -_answer(system",
            "= -0.0 * _answer(system",
        ),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_hill.py",
        (
            "copies of a motion taken for others",
            "copy = shapes[:, :, columns[row]], shifted(",
            "copy = 0.0 * shapes[:, :, columns[row]], shifted(",
        ),
        (
            "motions of the smallest truncation not followed",
            "near = np.abs(motions.shifts) <= _NEAR",
            "near = np.abs(motions.shifts) <= 0.0 * _NEAR",
        ),
        (
            "error of what was followed without its inertia",
            "for X in (load, inertia)]",
            "for X in (load, 1e9 * inertia)]",
        ),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_hill.py",
        ("slow motions sought where none lacks harmonics", "if np.all(near):", "if 0:"),
        (
            "harmonics left out are those of the smallest truncation",
            "motions = replace(motions, shapes=_widened(motions, orders), orders=orders)",
            "pass",
        ),
    ),
    *mutations(
        "linear/periodic/eigenvalues.py",
        "test_controlled_trains.py::test_overdamped_motions_are_those_of_the_rotor_alone",
        (
            "both zeros of a free motion count",
            "ranks[i, zeros[kept:]] = -np.inf",
            "pass",
        ),
        ("both of an equal pair count", "        if not once:", "        if True:"),
    ),
    *mutations(
        "linear/periodic/eigenvalues.py",
        "test_campbell_frames.py::test_displaced_free_mass_stands_still_in_space",
        (
            "split copies of an eigenvalue stay apart",
            "in _with_copies(values, resolutions)",
            "in ()",
        ),
    ),
    *mutations(
        "linear/periodic/free_directions.py",
        "test_free_directions.py",
        (
            "damping does not resist",
            "(K[first], D[first])",
            "(K[first],)",
        ),
        (
            "forces on one side alone count",
            "return (X,) if np.array_equal(abs(X), abs(X.T)) else (X, X.T)",
            "return (X,)",
        ),
        ("other motions have a share of the free ones", "shares = -la.solve", "shares = la.solve"),
        (
            "all systems have the free directions of the first",
            "left = np.sort(left[alike]), left[~alike]",
            "left = np.sort(left), left[:0]",
        ),
        ("harmonics of the stiffness do not resist", "        if n > 0:", "        if n > 9:"),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_hill.py::test_a_rotor_that_spins_the_other_way_has_the_same_exponents",
        (
            "copies of motions at a negative speed as at a positive one",
            "_one_of_each_family, speed=system.speed",
            "_one_of_each_family, speed=abs(system.speed)",
        ),
    ),
    *mutations(
        "linear/periodic/truncation.py",
        "test_hill.py",
        (
            "copies that lack their other half taken",
            "ranked = upper[np.argsort((left_out / inertia)[upper])]",
            "ranked = upper[np.argsort(-(left_out / inertia)[upper])]",
        ),
        (
            "motions shifted the wrong way",
            "own.values[columns] - 1j * sides",
            "own.values[columns] + 1j * sides",
        ),
        (
            "copies that rounding mixes told apart",
            "or _is_weak(system):",
            "or False:",
        ),
        (
            "harmonics left out on the other side",
            "below, above = (outer.get(n, nothing) for n in (-3, 3))",
            "below, above = (outer.get(n, nothing) for n in (3, -3))",
        ),
    ),
    *mutations(
        "linear/periodic/families.py",
        "test_hill.py::test_a_mass_that_one_direction_alone_holds",
        (
            "two free copies taken for a motion and its conjugate",
            "known[count + index] = True, not alone[-1]",
            "known[count + index] = True, True",
        ),
    ),
    *mutations(
        "linear/periodic/exponents.py",
        "test_hill.py::test_stiff_dampers_do_not_hide_slow_motions",
        (
            "motions that are gone within a turn waited for",
            "np.where(gone(values, speed), np.inf, np.maximum(-values.real, speed))",
            "np.maximum(-values.real, speed)",
        ),
    ),
    *mutations(
        "linear/periodic/fundamental.py",
        "test_remainder.py",
        (
            "copies of propagated motions shifted the other way",
            "1j * system.base * central",
            "-1j * system.base * central",
        ),
        ("exponents that are not told given", "if np.any(unknown) and", "if False and"),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_remainder.py::test_two_motions_that_turn_half_a_period_are_both_found",
        ("motions mixed that are told apart", "_MIXED = 100.0", "_MIXED = 1e9"),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_campbell_frames.py::test_nearly_circular_motions_are_one_forward_and_one_backward",
        (
            "nearly circular motions ranked as they come",
            "waves[:, :, ascending] = _unmixed(shapes[:, :, ascending], orders)",
            "pass",
        ),
    ),
    *mutations(
        "linear/periodic/fundamental.py",
        "test_hill.py::test_a_multiplier_that_rounding_makes_zero_is_known_from_above",
        ("multipliers of zero without an exponent", "multipliers == 0.0", "multipliers == -1.0"),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_remainder.py::test_more_harmonics_where_the_estimate_of_those_left_out_is_too_small",
        ("no more harmonics the second time", "_TIGHTER * tolerance", "tolerance"),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_hill.py::test_modes_gone_within_a_turn_are_not_waited_for",
        ("modes that are gone within a turn waited for", " | gone(values, speed)", ""),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_hill.py::test_motions_follow_into_truncations_too_large_to_be_solved",
        ("motions follow no further than all are solved", "_FOLLOWED = 4", "_FOLLOWED = 1"),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_stability.py::test_hill_and_floquet_agree",
        (
            "two families that become their own conjugates are one",
            "every = motions.with_conjugates()",
            "every = motions",
        ),
    ),
    *mutations(
        "linear/periodic/exponents.py",
        "test_stability.py::test_hill_and_floquet_agree test_hill.py",
        (
            "motions stand for conjugates that they are not",
            "paired[one], dropped[other] = True, True",
            "paired[one], dropped[one] = True, False",
        ),
        (
            "families that are their own conjugates stand for others",
            "alone[one] = True",
            "alone[one] = False",
        ),
    ),
    *mutations(
        "linear/periodic/inverse_iteration.py",
        "test_hill.py test_basis_error.py",
        ("eigenvalue moved the other way", "-2.0 * c /", "2.0 * c /"),
    ),
    *mutations(
        "linear/periodic/inverse_iteration.py",
        "test_harmonic_chain.py::test_systems_that_stand_still_are_iterated_together",
        ("half the slope by the inertia", "2.0 * rates * inertia", "rates * inertia"),
        ("all eigenvalues are moved", "np.where(wanted, shifted", "np.where(True, shifted"),
    ),
    *mutations(
        "linear/periodic/harmonics.py",
        "test_harmonic_chain.py",
        ("half the slope", "2.0 * rates * shapes, orders)", "rates * shapes, orders)"),
        ("half the slope of the adjoint", "2.0 * rates * convolved", "rates * convolved"),
    ),
    *mutations(
        "linear/periodic/harmonic_chain.py",
        "test_harmonic_chain.py",
        (
            "harmonics further out push",
            "own = own - ports[i] @ outer[0]",
            "own = own + ports[i] @ outer[0]",
        ),
        (
            "left vector of the transpose",
            "loads[:, 1].conj(), result",
            "loads[:, 1], result",
        ),
        ("middle with one side", "(X.sum(axis=1, keepdims=True) for X", "(X[:, :1] for X"),
        (
            "left vector of the matrix itself",
            "np.stack([X, Y.conj().swapaxes(-1, -2)])",
            "np.stack([X, Y.swapaxes(-1, -2)])",
        ),
        (
            "harmonics do not follow inner ones",
            "answer[..., :-1] @ (outwards.pop()",
            "0.0 * answer[..., :-1] @ (outwards.pop()",
        ),
    ),
    *mutations(
        "linear/periodic/periodic_system.py",
        "test_harmonic_chain.py",
        (
            "ports of the first coefficient alone",
            "left = np.abs(sides - found @ (found.T @ sides)).max(axis=(-2, -1))",
            "left = np.zeros(len(sides))",
        ),
        ("ports that only act", "for Y in (X, X.T)", "for Y in (X,)"),
    ),
    *mutations(
        "linear/periodic/harmonics.py",
        "test_hill.py",
        (
            "copies shifted the other way",
            "first, last = max(-steps, 0), max(steps, 0)",
            "first, last = max(steps, 0), max(-steps, 0)",
        ),
    ),
    *mutations(
        "linear/periodic/fundamental.py",
        "test_stability.py::test_magnus_steps_are_of_sixth_order",
        ("commutator with the wrong sign", "- a3 + c1, a2 + c2", "- a3 - c1, a2 + c2"),
        ("second commutator with the wrong sign", "c2 = -_commutator(", "c2 = _commutator("),
    ),
    *mutations(
        "linear/periodic/exponents.py",
        "test_stability.py::test_unreached_tolerances_are_errors",
        ("reason of the other method", "raise unconverged from None  #", "raise  #"),
    ),
    *mutations(
        "linear/periodic/fundamental.py",
        "test_stability.py::test_motions_that_die_within_a_turn_are_not_taken_for_neutral",
        ("small multipliers not known from above", "np.log1p(relative)", "relative"),
    ),
    *mutations(
        "linear/periodic/companion.py",
        "test_growth_by_rounding.py",
        (
            "lengths of states that are no energies",
            "sizes = np.sqrt(np.where(squared > 0.0, squared, scale[..., None] ** 2))",
            "sizes = np.broadcast_to(scale[..., None], squared.shape)",
        ),
        (
            "small eigenvalues as eigh finds them beside large ones",
            "squares = np.sum(turn * (stiffness @ turn), axis=-2)",
            "squares = np.linalg.eigvalsh(stiffness)",
        ),
        (
            "condition of eigenvalues left out",
            "EPSILON * most * condition",
            "1e-3 * EPSILON * most * np.minimum(condition, 1.0)",
        ),
        (
            "errors of double eigenvalues as large as the matrix",
            "double = np.sqrt(2.0 * count * self.rounding) * most",
            "double = most",
        ),
        (
            "errors of inexact stiffnesses left out",
            "self.rounding * (by_stiffness +",
            "self.rounding * (0.0 * by_stiffness +",
        ),
        (
            "errors of inexact entries by those of others",
            "left, moved = (unit[:, None] * np.abs(self.axes @ each)",
            "left, moved = (np.abs(self.axes @ each).max() + unit[:, None]",
        ),
        (
            "rounding of the stiffness left out",
            "solver + stiff * each",
            "solver + damped * each",
        ),
        (
            "rounding of the stiffness without its symmetry",
            "if self.rounding == EPSILON else whole",
            "if self.rounding < 0.0 else whole",
        ),
        (
            "symmetric part of a product",
            "crossed = dot(p, u) ** 2 + dot(q, v) ** 2 -",
            "crossed = dot(p, u) ** 2 + dot(q, v) ** 2 +",
        ),
    ),
    *mutations(
        "linear/periodic/eigenvalues.py",
        "test_campbell_kinds.py",
        (
            "free motions as their copies come",
            "if count < 2:\n        return otherwise",
            "if count >= 0:\n        return otherwise",
        ),
        (
            "free motions of another speed where they are none",
            "forces <= _STILL_NULL * np.linalg.norm(K, axis=(1, 2))",
            "forces >= 0.0",
        ),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_campbell_kinds.py",
        (
            "free motions of periodic equations by rounding",
            "if free_ones is given:",
            "if free_ones is not given:",
        ),
        (
            "free motions without what turns",
            "if n >= 0]",
            "if n == 0]",
        ),
    ),
]
