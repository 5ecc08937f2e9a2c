"""Linear analyses: models, and equations that turn."""

from validation.mutations.mutation import mutations

LINEAR_MODELS = [
    *mutations(
        "linear/models/controlled_rotor.py",
        "test_magnetic_bearing.py::test_rigid_rotor_has_the_eigenvalues_of_its_state_space",
        ("controllers turn without Coriolis", "+= 2.0 * speed * own", "+= 0.0 * speed * own"),
        ("controllers pulled inwards", "-= speed**2 * np.diag(own)", "+= speed**2 * np.diag(own)"),
        (
            "damping of what stands still carries nothing",
            "(1.0, 1.0, speed), strict",
            "(1.0, 1.0, 0.0), strict",
        ),
    ),
    *mutations(
        "linear/models/controlled_rotor.py",
        "test_tilting_pad.py::test_scene_and_linear_analyses_agree",
        ("films do not see their pads", "- np.outer(t, row)", "- 0.0 * np.outer(t, row)"),
    ),
    *mutations(
        "linear/models/left_out.py",
        "test_basis_error.py::test_estimates_are_the_errors_against_the_full_model",
        (
            "left-out shapes take no part",
            "used = self._used(modes, system.step)",
            "used = modes.orders == 0",
        ),
    ),
    *mutations(
        "linear/models/left_out.py",
        "test_basis_error.py::test_estimates_of_critical_speeds",
        (
            "dynamic stiffness changes twice as fast with the speed",
            "slope, square = (high - low)",
            "slope, square = 2.0 * (high - low)",
        ),
    ),
    *mutations(
        "linear/models/own_spin.py",
        "test_steady_state.py",
        (
            "bearings off the axis hold the own spin",
            "_MARGIN * lacking + rounding",
            "0.0 * lacking + rounding",
        ),
        (
            "springs do not hold the own spin",
            "_MARGIN * lacking + rounding * held",
            "_MARGIN * lacking + 1e9 * rounding * held",
        ),
    ),
    *mutations(
        "linear/models/steady_motion.py",
        "test_steady_state.py",
        (
            "own spin is not kept",
            "change = change - torque * twist",
            "change = change + 0.0 * twist",
        ),
    ),
    *mutations(
        "linear/models/finer_scene.py",
        "test_basis_in_scenes.py::test_a_scene_errs_as_a_rotor_on_the_same_supports",
        (
            "rotor's own terms counted twice",
            "T.T @ (X - own[:k, :k]) @ T + own",
            "T.T @ X @ T + own",
        ),
        (
            "connectors see static responses with the other sign",
            "np.linalg.pinv(seen[:, :k], rcond=_DEPENDENT)",
            "-np.linalg.pinv(seen[:, :k], rcond=_DEPENDENT)",
        ),
    ),
    *mutations(
        "linear/models/basis_error.py",
        "test_basis_error.py::test_errors_are_in_the_table_and_above_the_accuracy_in_a_warning",
        (
            "warning at any error",
            "worst <= self.accuracy",
            "worst <= 1.0",
        ),
    ),
    *mutations(
        "linear/models/rotor_on_supports.py",
        "test_campbell_frames.py",
        (
            "Coriolis forces left out",
            "D[0] + self.terms.damping(speed)",
            "D[0] + self.terms.damping(0.0)",
        ),
        (
            "centrifugal stiffness grows with the speed",
            "K[0] = K[0] + self.spin_terms.stiffness(speed)",
            "K[0] = K[0] + self._spin_terms.stiffness(abs(speed) ** 0.5)",
        ),
    ),
    *mutations(
        "linear/models/rotor_on_supports.py",
        "test_eccentric.py",
        (
            "steady forces of the supports forgotten",
            "return float(sum(f @ bend for",
            "return 0.0 * float(sum(f @ bend for",
        ),
        (
            "spin displaces the supports",
            "U + np.outer(shift, self.spin.momentum)",
            "U + 0.0 * np.outer(shift, self.spin.momentum)",
        ),
    ),
    *mutations(
        "linear/models/subspace.py",
        "test_structural_damping.py::test_a_full_model_is_that_of_all_its_coordinates",
        (
            "structural damping drives in the residual",
            "force = force + 1j * sense * (H @",
            "force = force - 1j * sense * (H @",
        ),
    ),
    *mutations(
        "linear/models/full_equations.py",
        "test_full_stiffening.py::test_full_equations_hold_the_change_of_shape",
        (
            "stiffness per fourth power of the speed subtracted in the full model",
            "force + speed**4 * (K4 @ Y)",
            "force - speed**4 * (K4 @ Y)",
        ),
    ),
    *mutations(
        "linear/models/full_equations.py",
        "test_full_response.py::test_unbalance_response_is_that_of_all_modes",
        (
            "Coriolis forces halved in the full model",
            "(inv.D @ X + speed * (coriolis @ X))",
            "(inv.D @ X + 0.5 * speed * (coriolis @ X))",
        ),
    ),
    *mutations(
        "linear/periodic/harmonics.py",
        "test_stability.py",
        ("rate of a harmonic once", "D + 2.0 * M * rate, K", "D + M * rate, K"),
        ("blocks transposed", "terms.get(int(n - m))", "terms.get(int(m - n))"),
        (
            "harmonics left out are not answered",
            "answer = -np.linalg.solve(dynamic",
            "answer = -0.0 * np.linalg.solve(dynamic",
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
            "shifts <= _NEAR",
            "shifts <= 0.0 * _NEAR",
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
        (
            "harmonics left out are those of the smallest truncation",
            "motions = replace(motions, shapes=_widened(motions, orders), orders=orders)",
            "pass",
        ),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_hill.py::test_a_rotor_that_spins_the_other_way_has_the_same_exponents",
        (
            "copies of motions at a negative speed as at a positive one",
            "partial(_one_of_each_pair, speed=system.speed)",
            "partial(_one_of_each_pair, speed=abs(system.speed))",
        ),
    ),
    *mutations(
        "linear/models/spin.py",
        "test_annular_seal.py::test_a_seal_that_repels_at_high_speed_does_not_hold_the_spin",
        (
            "springs that repel taken for some that hold the spin",
            "max(0.5 * np.trace(each[index][:2, :2]), 0.0)",
            "0.5 * np.trace(each[index][:2, :2])",
        ),
    ),
    *mutations(
        "linear/periodic/floquet_modes.py",
        "test_hill.py::test_a_mass_that_one_direction_alone_holds",
        (
            "two free copies taken for a motion and its conjugate",
            "[mode] if own_pair else [mode, other]",
            "[mode, other]",
        ),
    ),
    *mutations(
        "linear/periodic/exponents.py",
        "test_hill.py::test_stiff_dampers_do_not_hide_slow_motions",
        (
            "motions that are gone within a turn waited for",
            "np.where(decay > _GONE * speed, np.inf, decay)",
            "decay",
        ),
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
            "force.conj())[0].conj()",
            "force)[0]",
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
        "linear/periodic/harmonic_balance.py",
        "test_response.py",
        ("damping with the wrong sign", "A = K + 1j * self.rate * D", "A = K - 1j * self.rate * D"),
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
            "np.diag(senses), self.system.H",
            "np.sign(self.rate) * np.eye(len(orders)), self.system.H",
        ),
    ),
    *mutations(
        "linear/models/waves.py",
        "test_campbell_frames.py",
        (
            "waves of the other sense",
            "np.sqrt(0.5) * (u1 + 1j * u2), np.sqrt(0.5) * (v1 - 1j * v2)",
            "np.sqrt(0.5) * (u1 - 1j * u2), np.sqrt(0.5) * (v1 + 1j * v2)",
        ),
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
            "solver = 2.0 * count * self.rounding * most * condition",
            "solver = 1e-3 * self.rounding * most * np.minimum(condition, 1.0)",
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
        "linear/models/rotor_on_supports.py",
        "test_campbell.py",
        (
            "stiffness by damping that stands still, against the spin",
            "K.get(n, 0.0) + speed * X",
            "K.get(n, 0.0) - speed * X",
        ),
    ),
    *mutations(
        "linear/models/waves.py",
        "test_campbell_frames.py",
        (
            "waves with the amplitudes of the other sense",
            "forward = np.sqrt(0.5) * (cosine - 1j * sine)",
            "forward = np.sqrt(0.5) * (cosine + 1j * sine)",
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
            "left <= _STILL_NULL * np.linalg.norm(K)",
            "left >= 0.0",
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
    *mutations(
        "linear/models/scene_coordinates.py",
        "test_steady_state.py",
        (
            "velocity of the turning axes reversed",
            "T @ y_t + speed * T1 @ y",
            "T @ y_t - speed * T1 @ y",
        ),
    ),
    *mutations(
        "linear/models/journal_start.py",
        "test_journal_bearing.py::test_steady_state_is_the_equilibrium_of_the_journals",
        ("journals begin in the centre", "elif np.any(load) and speed", "elif False and speed"),
    ),
    *mutations(
        "multibody/support_connectors.py",
        "test_rolling_bearing.py::test_a_run_at_a_speed_starts_near_and_turns_its_cage",
        ("cages stay held", "        let(turning)", "        let(held)"),
    ),
    *mutations(
        "linear/models/linear_scene.py",
        "test_rolling_bearing.py::test_a_run_at_rest_starts_in_the_equilibrium_and_stays",
        (
            "cages held at another angle",
            "spin_at_start(self.body)[0])",
            "spin_at_start(self.body)[0] + 1.0)",
        ),
    ),
    *mutations(
        "linear/models/probe.py",
        "test_journal_bearing.py::test_scene_and_linear_rotor_agree",
        (
            "films differentiated by large steps",
            "_VELOCITY_STEPS = (1e-3, 1e-4, 1e-5, 1e-6)",
            "_VELOCITY_STEPS = (1e-3,)",
        ),
    ),
]
