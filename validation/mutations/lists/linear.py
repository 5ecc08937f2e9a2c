"""Linear analyses: modes and responses."""

from validation.mutations.mutation import mutations

LINEAR = [
    *mutations(
        "linear/modal/campbell.py",
        "test_void_states.py::test_motions_of_voids_take_no_place_of_a_shafts",
        ("motions of voids take places of a shaft's", "own > _MOSTLY", "own < 0.0 * _MOSTLY"),
    ),
    *mutations(
        "linear/modal/tracking.py",
        "test_equal_motions.py",
        ("waves expected the wrong way", "else -waves(", "else waves("),
    ),
    *mutations(
        "linear/modal/listing.py",
        "test_equal_motions.py",
        ("forward waves before backward ones", "FORWARD, 1, np.where", "FORWARD, -2, np.where"),
    ),
    *mutations(
        "linear/periodic/eigenvalues.py",
        "test_equal_motions.py",
        (
            "half of the displacements of waves",
            "turning > least) != count",
            "turning > least) == count",
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
        "linear/modal/whirl.py",
        "test_campbell_frames.py",
        (
            "forward and backward exchanged",
            "seen = nu + (orders[:, None, None] + n) * speed",
            "seen = nu + (orders[:, None, None] - n) * speed",
        ),
    ),
    *mutations(
        "linear/periodic/harmonics.py",
        "test_critical.py::test_asymmetric_masses_order_1",
        ("gyroscopic terms without a rate", "K + D * rate + M", "K + D + M"),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_critical.py::test_asymmetric_masses_order_1",
        (
            "waves counted against the spin",
            "self.multiples[:, None] + self.content.shifts[None, :]",
            "self.multiples[:, None] - self.content.shifts[None, :]",
        ),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_critical.py",
        ("harmonics that do not settle are kept", "if change <= tolerance * last:", "if True:"),
        ("gyroscopic terms left out", "rate = system.D[n], 0.5j * speed", "rate = system.D[n], 0j"),
        (
            "free motions without inertia move",
            "moving = np.abs(inertia) > _NO_INERTIA",
            "moving = np.abs(inertia) >= 0.0 * _NO_INERTIA",
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
        "linear/response/steady_tasks.py",
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
            "np.exp(1j * phases * angle)",
            "np.exp(-1j * phases * angle)",
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
        ("a neighbour without motion", "np.maximum(size, STILL", "np.maximum(size, 0.0 * STILL"),
        ("size at a peak falls", "size[1] / np.sqrt(max(least", "size[1] * np.sqrt(max(least"),
        (
            "phase of neighbours not compared",
            "phasors[1:] * phasors[:-1].conj()",
            "phasors[1:] * phasors[1:].conj()",
        ),
    ),
    *mutations(
        "linear/modal/tracking.py",
        "test_campbell_frames.py::test_a_line_breaks_where_it_would_join_different_modes",
        (
            "other shapes taken for the same mode",
            "same = (alike >= _LEAST_LIKENESS)",
            "same = (alike >= -_LEAST_LIKENESS)",
        ),
    ),
    *mutations(
        "linear/modal/tracking.py",
        "test_nodal_diameters.py::test_waves_that_take_turns_are_not_joined",
        ("waves of a standing mode are joined", "joined[1:] &= jump", "joined[1:] |= jump"),
        ("ν never passes zero", "passes = together <= 2.0", "passes = together <= 0.0"),
        ("the spin does not move waves", "change + steepest + _ROUGH", "change + _ROUGH"),
    ),
    *mutations(
        "linear/modal/tracking.py",
        "test_nodal_diameters.py::test_waves_of_blades_that_take_turns_are_not_joined",
        ("waves of unknown n are joined", "~unknown | _stays", "True | _stays"),
        ("p keeps its sign at ν = 0", "(passes & (first == -second))", "(passes & False)"),
        ("p of untold waves counts", "| ~(every[1:] & every[:-1])", ""),
    ),
    *mutations(
        "linear/modal/whirl.py",
        "test_nodal_diameters.py",
        (
            "modes with many nodal diameters named by what little is fitted",
            "unseen |= self._not_fitted(vectors, energy, total) & ~stands",
            "pass",
        ),
        ("fields that cancel each other count", "np.maximum(whole, fitted)", "whole"),
    ),
    *mutations(
        "linear/modal/tracking.py",
        "test_campbell_frames.py::test_columns_ascend_and_tracked_columns_follow_the_modes",
        (
            "conjugate motions are not looked at",
            "(vectors[:-1].conj(), vectors[:-1])",
            "(vectors[:-1].conj(),) * 2",
        ),
    ),
    *mutations(
        "linear/models/rotor/rotor_on_supports.py",
        "test_campbell_frames.py",
        (
            "dampers that stand still carry at rest",
            "K = K + carried * speed",
            "K = K + carried",
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
        "linear/modal/whirl.py",
        "test_seen_from_outside.py",
        ("of two equal frequencies any one", "(1.0 - _EVEN)", "(1.0 + _EVEN)"),
        (
            "copies of a defective eigenvalue as waves",
            "_DEPENDENT * lengths[:, 0])",
            "0.0 * lengths[:, 0])",
        ),
        ("both senses of waves alike", "_gram(moved, seen) +", "_gram(moved, abs(seen)) +"),
        (
            "of two equal frequencies that against the spin",
            "np.where(speed < 0.0, -1, 1)",
            "np.where(speed < 0.0, 1, -1)",
        ),
    ),
    *mutations(
        "linear/modal/one_sense.py",
        "test_seen_from_outside.py test_campbell_frames.py",
        (
            "slow growth is a copy of a free motion",
            "in (group[zero], group[~zero])",
            "in (group,)",
        ),
        (
            "repeated modes as they come",
            "for index, columns in each:",
            "for index, columns in each[:0]:",
        ),
    ),
    *mutations(
        "linear/modal/damping.py",
        "test_campbell_kinds.py",
        (
            "motions that are over at once oscillate with the spin",
            "~oscillates(growth, nu) & gone",
            "oscillates(growth, nu) & gone",
        ),
    ),
    *mutations(
        "linear/modal/campbell.py",
        "test_campbell_kinds.py",
        (
            "overdamped motions in front of the others",
            "last=~moves & decays",
            "last=moves | ~decays",
        ),
    ),
    *mutations(
        "linear/modal/campbell.py",
        "test_campbell.py",
        ("rounding as damping", "np.where(told, growth, 0.0)", "growth"),
    ),
    *mutations(
        "linear/modal/campbell.py",
        "test_campbell_frames.py test_campbell_full.py",
        ("order in the other frame", ", seen=seen)", ", seen=not seen)"),
        (
            "a large rotor is not solved for more modes",
            "lowest.max() + abs(speed) or",
            "lowest.max() - abs(speed) or",
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
        ("the upper mode of a pair stands for both", "= split, -split /", "= -split, split /"),
    ),
    *mutations(
        "linear/modal/whirl.py",
        "test_mesh_pairs.py test_campbell_kinds.py",
        (
            "phases of a pair told apart against the harmonics",
            "        seen = np.add.outer(orders, self.orders)\n        mean, size",
            "        seen = np.subtract.outer(orders, self.orders)\n        mean, size",
        ),
        ("any two close motions are a pair", "sign * _CIRCULAR * size", "sign * 0.0 * size"),
        ("motions of one sense taken for a pair", "np.max(determinants", "np.min(determinants"),
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
]
