"""Linear analyses: models, periodic systems, modes, responses, stability."""

from validation.mutations.mutation import mutations

LINEAR = [
    *mutations(
        "linear/models/controlled_rotor.py",
        "test_magnetic_bearing.py::test_rigid_rotor_has_the_eigenvalues_of_its_state_space",
        ("controllers turn without Coriolis", "+= 2.0 * speed * own", "+= 0.0 * speed * own"),
        ("controllers pulled inwards", "-= speed**2 * np.diag(own)", "+= speed**2 * np.diag(own)"),
        (
            "damping of what stands still carries nothing",
            "factor = speed if",
            "factor = 0.0 if",
        ),
    ),
    *mutations(
        "linear/stability/sensitivity.py",
        "test_magnetic_bearing.py::test_sensitivity_of_a_spinning_rotor_is_that_of_both_senses",
        ("complementary in place of the sensitivity", "append(1.0 + place", "append(place"),
        ("signal with the wrong sign", "(-one.stiffness[4:, 2:4]", "(one.stiffness[4:, 2:4]"),
    ),
    *mutations(
        "linear/models/left_out.py",
        "test_basis_error.py::test_estimates_are_the_errors_against_the_full_model",
        (
            "left-out shapes take no part",
            "np.abs(modes.orders) <= system.step",
            "np.abs(modes.orders) < system.step",
        ),
        (
            "slope of the dynamic stiffness halved",
            "shifted * D + K, 2.0 * shifted * M + D",
            "shifted * D + K, shifted * M + D",
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
        (
            "centrifugal terms grow with the speed",
            "X + share**2 * (fast.K[n] - X)",
            "X + share * (fast.K[n] - X)",
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
        "linear/response/basis_check.py",
        "test_basis_error.py::test_errors_of_unbalance_responses",
        (
            "errors of motions doubled",
            "finer[order] - given.get(order, 0.0)",
            "2.0 * (finer[order] - given.get(order, 0.0))",
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
            "abs(motions.shifts) <= _NEAR",
            "abs(motions.shifts) <= 0.0 * _NEAR",
        ),
        (
            "error of what was followed without its inertia",
            "slopes = 2.0 * values[lacking]",
            "slopes = 1e9 * values[lacking]",
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
        "linear/periodic/inverse_iteration.py",
        "test_hill.py test_basis_error.py",
        ("left vector of the transposed matrix", "left, trans=2)", "left, trans=1)"),
        (
            "inverse iteration with half the slope",
            "linear = 2.0 * shifted * M + D",
            "linear = shifted * M + D",
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
        "theory/rotating_axes.py",
        "test_response.py test_stability.py",
        (
            "support seen from the rotor the wrong way",
            "products = (R.transpose(0, 2, 1) @ matrix)[:, None] @ R  #",
            "products = (R @ matrix)[:, None] @ R.transpose(0, 2, 1)  #",
        ),
        ("loads turn against the rotor", "turned = {-n: R @ vector", "turned = {n: R @ vector"),
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
        "linear/modal/whirl.py",
        "test_campbell_frames.py",
        (
            "forward and backward exchanged",
            "seen = nu + (orders[:, None, None] + n) * speed",
            "seen = nu + (orders[:, None, None] - n) * speed",
        ),
    ),
    *mutations(
        "linear/models/waves.py",
        "test_campbell_frames.py",
        (
            "waves of the other sense",
            "np.sqrt(0.5) * (u1 + 1j * u2), np.sqrt(0.5) * (u1 - 1j * u2)",
            "np.sqrt(0.5) * (u1 - 1j * u2), np.sqrt(0.5) * (u1 + 1j * u2)",
        ),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_critical.py::test_asymmetric_masses_order_1",
        (
            "damping for half the rate",
            "rate * system.D.get(n, 0.0)",
            "0.5 * rate * system.D.get(n, 0.0)",
        ),
        (
            "waves counted against the spin",
            "seen = multiples[:, None] + content.orders[None, :]",
            "seen = multiples[:, None] - content.orders[None, :]",
        ),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_critical.py::test_a_free_rotor_is_the_limit_of_soft_supports",
        ("free motions do not follow by inertia", "basis = W - R @", "basis = W - 0.0 * R @"),
    ),
    *mutations(
        "linear/response/harmonic_loads.py",
        "test_response.py",
        (
            "force pulls at the rotation",
            "wrench = np.concatenate([self.force, self.moment])",
            "wrench = np.concatenate([self.moment, self.force])",
        ),
        (
            "ground's acceleration pulls along",
            "np.where(standing, 0.0, loads @ a)",
            "np.where(standing, 0.0, -loads @ a)",
        ),
    ),
    *mutations(
        "linear/response/steady_response.py",
        "test_response.py",
        (
            "unbalance pulls in proportion to the speed",
            "loads = {0: speed**2 * self.load + 0j}",
            "loads = {0: speed * self.load + 0j}",
        ),
        (
            "harmonics folded to the wrong sense",
            "(a if n > 0 else a.conj())",
            "(a.conj() if n > 0 else a)",
        ),
    ),
    *mutations(
        "linear/response/places.py",
        "test_response.py",
        (
            "motion in the inertial frame as in the rotor frame",
            'if frame == "rotor":',
            'if frame == "inertial":',
        ),
    ),
    *mutations(
        "linear/response/response.py",
        "test_response.py",
        (
            "forward and backward whirl exchanged",
            "return 0.5 * (a + 1j * b), 0.5 * (a - 1j * b).conj()",
            "return 0.5 * (a - 1j * b), 0.5 * (a + 1j * b).conj()",
        ),
    ),
    *mutations(
        "linear/response/responses.py",
        "test_response.py",
        (
            "harmonic of the spin at the wrong side of the force",
            'return self.frequencies + checks.whole_number(order, "order") * self.speed',
            'return self.frequencies - checks.whole_number(order, "order") * self.speed',
        ),
    ),
    *mutations(
        "linear/response/run_start.py",
        "test_run_start.py",
        ("rates of a steady motion reversed", "(1j * rates[:, None]", "(-1j * rates[:, None]"),
        (
            "harmonics turned against the angle",
            "np.exp(1j * orders * angle)",
            "np.exp(-1j * orders * angle)",
        ),
        (
            "frame of an eccentric rotor left on the axis",
            "(A - motion.orientation) @ across",
            "0.0 * across",
        ),
        (
            "frame of an eccentric rotor without its velocity",
            "q_t[places] += speed *",
            "q_t[places] += 0.0 *",
        ),
        (
            "rigid translation not scaled by the mass",
            "@ f[: len(held)] / source.invariants.mass",
            "@ f[: len(held)]",
        ),
    ),
    *mutations(
        "linear/response/refinement.py",
        "test_peaks.py",
        (
            "peak on the other side of its point",
            "place = float(np.clip(-0.5",
            "place = float(np.clip(0.5",
        ),
        ("size at a peak falls", "size[1] / np.sqrt(max(least", "size[1] * np.sqrt(max(least"),
        (
            "phase of neighbours not compared",
            "phasors[1:] * phasors[:-1].conj()",
            "phasors[1:] * phasors[1:].conj()",
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
        "linear/modal/tracking.py",
        "test_campbell_frames.py::test_a_line_breaks_where_it_would_join_different_modes",
        (
            "other shapes taken for the same mode",
            "likeness @ together) >= _LEAST_LIKENESS",
            "likeness @ together) >= -_LEAST_LIKENESS",
        ),
    ),
    *mutations(
        "linear/response/unbalance.py",
        "test_response.py",
        (
            "angle of an unbalance against the spin",
            "np.sin(self.angle), 0.0]",
            "-np.sin(self.angle), 0.0]",
        ),
        (
            "grade in metres per second",
            "return 1e-3 * grade * mass / speed",
            "return grade * mass / speed",
        ),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_campbell_kinds.py",
        (
            "phases of a pair told apart against the harmonics",
            "seen = np.add.outer(entry.multiples, content.orders)",
            "seen = np.subtract.outer(entry.multiples, content.orders)",
        ),
        (
            "any two close critical speeds are a pair",
            "return bool(mean.min() < -CIRCULAR * size.min() and",
            "return bool(mean.min() < CIRCULAR + size.min() and",
        ),
    ),
    *mutations(
        "linear/modal/campbell.py",
        "test_campbell_kinds.py",
        (
            "overdamped motions in front of the others",
            "order = np.lexsort((key, ~moves &",
            "order = np.lexsort((key, moves |",
        ),
    ),
    *mutations(
        "linear/modal/campbell.py",
        "test_campbell_frames.py",
        (
            "order in the other frame",
            "key = _ranks(inertial) if seen else",
            "key = _ranks(inertial) if not seen else",
        ),
        (
            "a large rotor is not solved for more modes",
            "lowest.max() + abs(speed) or",
            "lowest.max() - abs(speed) or",
        ),
    ),
    *mutations(
        "linear/stability/thresholds.py",
        "test_basis_error.py::test_errors_of_limits_where_modes_meet test_threshold_search.py",
        (
            "limits of the other sense are taken",
            "if on == onset]",
            "if on != onset]",
        ),
        (
            "limit of the finer model on the other side",
            "return found[0][0] - value",
            "return value - found[0][0]",
        ),
        (
            "limit of the finer model searched on the wrong side",
            "== onset else 1.0",
            "!= onset else 1.0",
        ),
    ),
    *mutations(
        "linear/stability/stability_map.py",
        "test_basis_error.py::test_errors_of_a_map_of_stability_are_those_of_its_points",
        (
            "error of the most stable motion",
            "value = growth.values[[growth.least_stable]]",
            "value = growth.values[[-1]]",
        ),
    ),
    *mutations(
        "linear/response/basis_check.py",
        "test_basis_error.py::test_motions_with_harmonics_are_looked_at_at_all_peaks",
        (
            "valleys for peaks",
            "(sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:])",
            "(sizes[1:-1] < sizes[:-2]) & (sizes[1:-1] <= sizes[2:])",
        ),
    ),
    *mutations(
        "linear/modal/mesh_pairs.py",
        "test_mesh_pairs.py",
        ("the upper mode of a pair stands for both", "= split, -split", "= -split, split"),
        (
            "motions of one sense taken for a pair",
            "mean.max() > CIRCULAR * size.min() > 0.0",
            "mean.max() < CIRCULAR * size.min()",
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
        "linear/stability/growth.py",
        "test_stability.py test_stability_names.py test_linear_properties.py",
        (
            "least growth for the largest",
            "return float(np.max(excess[moving] if np.any(moving) else excess))",
            "return float(np.min(excess[moving] if np.any(moving) else excess))",
        ),
        (
            "names of folded exponents",
            "content.named(modes, speed)",
            "content.named(replace(modes, values=fold(values, abs(system.base))), speed)",
        ),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_stability.py test_stability_names.py",
        (
            "modes that meet are not followed",
            "if gaps[0] * gaps[1] < 0.0 and near:",
            "if gaps[0] * gaps[1] > 0.0 and near:",
        ),
        (
            "no gap between two unstable samples",
            "self._search(low, high, lambda growth, _: growth.excess)",
            "self._search(low, high, lambda growth, _: -growth.excess)",
        ),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_threshold_search.py",
        (
            "a limit without a secant is no number",
            "if np.isnan(root):",
            "if False:",
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
        "linear/stability/thresholds.py",
        "test_basis_error.py",
        (
            "limit of the full model to the other side",
            "float(-shifts[0].real / slope)",
            "float(shifts[0].real / slope)",
        ),
        (
            "limits where modes meet estimated like others",
            "or meets or slope",
            "or slope",
        ),
    ),
    *mutations(
        "linear/stability/thresholds.py",
        "test_stability.py test_stability_names.py",
        (
            "mode of a threshold from its stable side",
            "away = search.span if onset else -search.span",
            "away = -search.span if onset else search.span",
        ),
        (
            "ranges in the wrong order of their ends",
            "edges = [values[0]] if unstable[0] else []",
            "edges = [values[0]] if not unstable[0] else []",
        ),
    ),
    *mutations(
        "linear/stability/stability.py",
        "test_stability.py",
        (
            "multipliers over half a period",
            "multipliers = np.exp(2.0 * np.pi * exponents / periodic[:, None])",
            "multipliers = np.exp(np.pi * exponents / periodic[:, None])",
        ),
    ),
    *mutations(
        "linear/stability/stability_map.py",
        "test_stability.py",
        (
            "parameters exchanged in the map",
            "points = [(a, b) for a in grid[0] for b in grid[1]]",
            "points = [(a, b) for b in grid[1] for a in grid[0]]",
        ),
        (
            "damping taken for growth",
            "return growth.values.real.max(), growth.excess",
            "return -growth.values.real.min(), growth.excess",
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
        "linear/modal/excitation.py",
        "test_export.py",
        ("crossings of the spin speed for all orders", "line = order * np", "line = 1.0 * np"),
        ("broken lines crossed", "np.nonzero(crossed & continued[1:])", "np.nonzero(crossed)"),
        (
            "crossing on the wrong side",
            "speeds[rows] + share * np.diff(speeds)[rows]",
            "speeds[rows + 1] - share * np.diff(speeds)[rows]",
        ),
        (
            "margin on the wrong side",
            "((1.0 - margins[0]) * low, low)",
            "(low, (1.0 + margins[0]) * low)",
        ),
    ),
    *mutations(
        "linear/models/journal_start.py",
        "test_journal_bearing.py::test_steady_state_is_the_equilibrium_of_the_journals",
        ("journals begin in the centre", "if np.any(load) and speed", "if False and speed"),
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
