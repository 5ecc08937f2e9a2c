"""Linear analyses: models of rotors on supports, in scenes and in trains."""

from validation.mutations.mutation import mutations

LINEAR_MODELS = [
    *mutations(
        "linear/models/rotor/own_coordinates.py",
        "test_magnetic_bearing.py::test_rigid_rotor_has_the_eigenvalues_of_its_state_space",
        ("controllers turn without Coriolis", "2.0 * rate * own", "0.0 * rate * own"),
        ("controllers pulled inwards", "= -(rate**2) * np.diag", "= rate**2 * np.diag"),
    ),
    *mutations(
        "linear/models/rotor/controlled_rotor.py",
        "test_magnetic_bearing.py::test_rigid_rotor_has_the_eigenvalues_of_its_state_space",
        (
            "damping of what stands still carries nothing",
            "(1.0, 1.0, speed), strict",
            "(1.0, 1.0, 0.0), strict",
        ),
    ),
    *mutations(
        "linear/models/rotor/own_coordinates.py",
        "test_tilting_pad.py::test_scene_and_linear_analyses_agree",
        ("films do not see their pads", "- np.outer(turned, row)", "- 0.0 * np.outer(turned, row)"),
    ),
    *mutations(
        "linear/models/basis/left_out.py",
        "test_basis_error.py::test_estimates_are_the_errors_against_the_full_model",
        (
            "left-out shapes take no part",
            "used = self._used(modes, system.step)",
            "used = modes.orders == 0",
        ),
    ),
    *mutations(
        "linear/models/basis/critical_shift.py",
        "test_basis_on_foundations.py test_basis_error.py::test_estimates_of_critical_speeds",
        (
            "dynamic stiffness changes half as fast with the speed",
            "at_rest + speed**2 * B, 2.0 * speed * B",
            "at_rest + speed**2 * B, speed * B",
        ),
        ("one of a close pair taken for the other", "_CLOSE = 1e-2", "_CLOSE = 0.0"),
    ),
    *mutations(
        "linear/models/basis/critical_shift.py",
        "test_basis_on_foundations.py::test_what_the_rotor_does_not_feel_has_no_error",
        (
            "a motion at its own critical speed taken for a free one",
            "np.maximum(np.abs(given.H), center * np.abs(given.slope))",
            "np.abs(given.H)",
        ),
    ),
    *mutations(
        "linear/models/scene/own_spin.py",
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
        "linear/models/scene/scene_checks.py",
        "test_steady_state.py",
        ("rounding beside a wall is a load", "* scene.mass + rounding:", "* scene.mass:"),
    ),
    *mutations(
        "linear/models/rotor/eccentricity.py",
        "test_growth_by_rounding.py::test_uneven_rotor_held_by_dampers_alone_does_not_grow",
        (
            "product of inertia does not couple spin and tilts",
            "couple @ couple / inv.Theta**2 +",
            "1e-6 * couple @ couple / inv.Theta**2 +",
        ),
    ),
    *mutations(
        "linear/stability/growth.py",
        "test_growth_by_rounding.py::test_uneven_rotor_held_by_dampers_alone_does_not_grow",
        (
            "every motion drifts",
            "np.where(np.min(np.abs(turning)",
            "np.where(0.0 * np.min(np.abs(turning)",
        ),
    ),
    *mutations(
        "linear/periodic/harmonic_balance.py",
        "test_response.py::test_soft_direction_beside_a_rigid_one",
        ("rounding is smaller than it is", "EPSILON / min(self", "1e-6 * EPSILON / min(self"),
    ),
    *mutations(
        "linear/models/scene/differences.py",
        "test_differences.py",
        ("steps of differences beyond the contact", "_KINK = 1e-4", "_KINK = 1e4"),
    ),
    *mutations(
        "linear/models/basis/finer_scene.py",
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
        "linear/models/basis/basis_error.py",
        "test_basis_error.py::test_errors_are_in_the_table_and_above_the_accuracy_in_a_warning",
        (
            "warning at any error",
            "worst <= self.accuracy",
            "worst <= 1.0",
        ),
    ),
    *mutations(
        "linear/models/rotor/rotor_on_supports.py",
        "test_campbell_frames.py",
        (
            "Coriolis forces left out",
            "D[0] + self.spin_terms.damping(speed)",
            "D[0] + self.spin_terms.damping(0.0)",
        ),
        (
            "centrifugal stiffness grows with the speed",
            "K[0] = K[0] + self.spin_terms.stiffness(speed)",
            "K[0] = K[0] + self._spin_terms.stiffness(abs(speed) ** 0.5)",
        ),
    ),
    *mutations(
        "linear/models/rotor/rotor_on_supports.py",
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
        "linear/models/full/subspace.py",
        "test_structural_damping.py::test_a_full_model_is_that_of_all_its_coordinates",
        (
            "structural damping drives in the residual",
            "force = force + 1j * sense * (H @",
            "force = force - 1j * sense * (H @",
        ),
    ),
    *mutations(
        "linear/models/full/full_equations.py",
        "test_full_stiffening.py::test_full_equations_hold_the_change_of_shape",
        (
            "stiffness per fourth power of the speed subtracted in the full model",
            "force + speed**4 * (K4 @ Y)",
            "force - speed**4 * (K4 @ Y)",
        ),
    ),
    *mutations(
        "linear/models/full/full_equations.py",
        "test_full_response.py::test_unbalance_response_is_that_of_all_modes",
        (
            "Coriolis forces halved in the full model",
            "(inv.D @ X + speed * self._coriolis(X))",
            "(inv.D @ X + 0.5 * speed * self._coriolis(X))",
        ),
    ),
    *mutations(
        "linear/models/rotor/spin.py",
        "test_annular_seal.py::test_what_repels_does_not_hold_the_spin",
        (
            "springs that repel taken for some that hold the spin",
            "max(0.5 * np.trace(each[index][:2, :2]), 0.0)",
            "0.5 * np.trace(each[index][:2, :2])",
        ),
    ),
    *mutations(
        "linear/models/rotor/spin.py",
        "test_annular_seal.py::test_springs_hold_the_spin_by_their_distance",
        (
            "springs far from each other are not asked",
            "0.5 * distances.max(initial=0.0) ** 2 <=",
            "0.2 * distances.max(initial=0.0) ** 2 <=",
        ),
    ),
    *mutations(
        "linear/models/waves.py",
        "test_nodal_diameters.py",
        ("few waves along the axis", "_AXIAL_TERMS = (10, 6, 2)", "_AXIAL_TERMS = (6, 6, 2)"),
        ("no nodal circles", "_AXIAL_TERMS = (10, 6, 2)", "_AXIAL_TERMS = (10, 6)"),
        ("fields of noise", "_NEW_SHARE = 3e-2", "_NEW_SHARE = 1e-3"),
        ("waves that few nodes cannot tell", "_DEPENDENT = 1e-2", "_DEPENDENT = 1e-12"),
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
        "linear/models/rotor/rotor_on_supports.py",
        "test_campbell_frames.py::test_anisotropic_support_of_a_point_mass",
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
        "linear/models/scene/scene_coordinates.py",
        "test_initial_angle.py",
        ("rotor not turned back", "body.motion.free_directions.T @ turned", "0.0"),
        ("angle of a node that counts backwards", "made.spin_sign * rest", "rest"),
    ),
    *mutations(
        "linear/models/scene/scene_coordinates.py",
        "test_steady_state.py",
        (
            "velocity of the turning axes reversed",
            "T @ y_t + speed * T1 @ y",
            "T @ y_t - speed * T1 @ y",
        ),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_uneven_inertia.py::test_loads_of_short_films_are_those_of_the_lever_rule",
        ("friction whirls eccentric rotors", "brakes and not self._rests", "brakes"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_uneven_inertia.py::test_eccentric_rotors_with_a_free_translation_begin_in_the_middle",
        ("friction tilts with the journal", "begins or self._point is None", "True"),
    ),
    *mutations(
        "multibody/supports/magnetic_connectors.py",
        "test_uneven_inertia.py::test_saturating_magnets_are_taken_at_their_mean_place_and_current",
        ("magnets by their places", "self._slopes or self._actuator", "self._actuator"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_journal_bearing.py::test_films_in_a_scene_are_linearised_as_in_a_list",
        ("a held film pushes the other way", "fx -= a * x + b * y", "fx += a * x + b * y"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_kinds_in_scenes_and_lists.py::test_every_kind_has_the_exponents_of_its_list",
        ("cages stand in lists", "self.bearing.clearance < 0.0 or", "False and"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_bearings_in_scenes_and_lists.py",
        ("films under an uneven mesh go with it", "one.moved > _STILL", "one.moved > 1e9 * _STILL"),
        ("rest under the load the other way", "load = -np.sum", "load = np.sum"),
    ),
    *mutations(
        "linear/models/scene/probe.py",
        "test_bearings_in_scenes_and_lists.py::test_friction_on_a_block_changes_no_exponent",
        (
            "pads turn with the base",
            "        if self._carried is not None:\n            total",
            "        if False:\n            total",
        ),
    ),
    *mutations(
        "multibody/supports/held_tilts.py",
        "test_kinds_in_scenes_and_lists.py::test_static_moments_on_a_block_leave_the_exponents",
        ("static moments turn with the block", "if not self._held:", "if True:"),
        ("tilts of the block forgotten", "first - second", "first"),
        ("rates of tilts the other way", "+ 2.0 * speed", "- 2.0 * speed"),
        ("moments stay held", "_FUNCTION, function)", "_FUNCTION, each.torque)"),
    ),
    *mutations(
        "multibody/supports/linear_laws.py",
        "test_rolling_bearing.py::test_a_run_at_a_speed_starts_near_and_turns_its_cage",
        ("cages stay held", "        let(False)", "        let(True)"),
    ),
    *mutations(
        "linear/models/scene/linear_scene.py",
        "test_rolling_bearing.py::test_a_run_at_rest_starts_in_the_equilibrium_and_stays",
        (
            "cages held at another angle",
            "cage=spin_at_start(self.body)[0])",
            "cage=spin_at_start(self.body)[0] + 1.0)",
        ),
    ),
    *mutations(
        "linear/models/scene/probe.py",
        "test_journal_bearing.py::test_scene_and_linear_rotor_agree",
        (
            "films differentiated by large steps",
            "_VELOCITY_STEPS = (1e-3, 1e-4, 1e-5, 1e-6)",
            "_VELOCITY_STEPS = (1e-3,)",
        ),
    ),
    *mutations(
        "linear/models/scene/linear_scene.py",
        "test_rolling_bearing.py::test_cages_stand_in_the_linear_equations_of_a_scene",
        (
            "cages turn with the rotor",
            'with self._probing(checks.number(speed, "speed", "rad/s")) as probe:\n'
            "            system",
            "with probing(self, speed) as probe:\n            system",
        ),
    ),
]
