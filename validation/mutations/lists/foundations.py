"""Foundations and motions of the ground, in scenes and linear analyses."""

from validation.mutations.mutation import mutations

_SCENE = "test_foundations.py::test_scene_and_linear_model_have_the_same_exponents"

FOUNDATIONS = [
    *mutations(
        "linear/models/rotor/rotor_on_foundation.py",
        _SCENE,
        ("the foundation turns with the rotor", "{-n: np.hstack", "{n: np.hstack"),
        (
            "damping does not see the rotor turn",
            "{n: speed * X for n, X in carried",
            "{n: 0.0 * X for n, X in carried",
        ),
        ("supports on the ground as well", "X[:6, :6] = 0.0", "X[:6, :6] *= 1.0"),
    ),
    *mutations(
        "linear/models/rotor/rotor_on_foundation.py",
        "test_foundations.py::test_unbalance_response_is_that_of_two_masses",
        ("supports push the foundation the other way", "np.eye(6), -R]", "np.eye(6), R]"),
    ),
    *mutations(
        "linear/models/fourier_terms.py",
        _SCENE,
        (
            "motion of the foundation not carried into the rotor's frame",
            "turning_congruence(U, parts[0], rate_of(U))",
            "turning_congruence(U, parts[0], {})",
        ),
        ("cross-coupling lost", "for sign in (1.0, -1.0):", "for sign in (1.0,):"),
    ),
    *mutations(
        "linear/models/rotor/controlled_rotor.py",
        "test_magnetic_on_foundation.py",
        (
            "sensors on the ground",
            "sensed = [self.sensed(index) for",
            "sensed = [{0: self.sensed(index)[0]} for",
        ),
    ),
    *mutations(
        "linear/response/run_start.py",
        "test_start_beside.py::test_run_about_a_skew_axis_begins_at_an_angle",
        ("controllers start turned back", "[[c, s], [-s, c]]", "[[c, -s], [s, c]]"),
        ("controllers start without the rate of their turning", " + pairs @ R_t", ""),
        ("a foundation starts at rest", "T @ x[:first], T @ x_t", "T @ x[:first], 0.0 * T @ x_t"),
    ),
    *mutations(
        "linear/models/basis/finer_model.py",
        "test_basis_on_foundations.py",
        (
            "controllers held by their static stiffness beside a finer basis",
            "plain.equations.with_supports(model.plain.supports)",
            "plain.equations",
        ),
    ),
    *mutations(
        "linear/stability/sensitivity.py",
        "test_magnetic_on_foundation.py::test_sensitivity_is_that_of_the_state_space",
        ("sensors do not see the foundation", "in sensed.items()", "in [(0, sensed[0])]"),
    ),
    *mutations(
        "linear/models/scene/linear_scene.py",
        "test_magnetic_on_foundation.py::test_public_analyses_take_scene_and_list_alike",
        (
            "controllers have no sense of whirl in a scene",
            "with_pairs(given, self.N[self.pairs.ravel()])",
            "given",
        ),
    ),
    *mutations(
        "linear/models/rotor/rotor_on_foundation.py",
        "test_foundations.py::test_loads_on_the_foundation_and_its_ground",
        (
            "the ground shakes the foundation the other way",
            "-self.foundation.participation]",
            "self.foundation.participation]",
        ),
    ),
    *mutations(
        "linear/response/harmonic_loads.py",
        "test_foundations.py::test_loads_on_the_foundation_and_its_ground",
        (
            "loads that turn with the rotor turn against it on a foundation",
            "{-n: amplitude for n",
            "{n: amplitude for n",
        ),
        (
            "the ground does not shake the foundation",
            "np.where(standing, loads @ self",
            "0.0 * np.where(standing, loads @ self",
        ),
    ),
    *mutations(
        "linear/response/places.py",
        "test_foundations.py::test_unbalance_response_is_that_of_two_masses",
        (
            "motions of a foundation turned",
            "into_inertial_frame, ~stands",
            "into_inertial_frame, stands",
        ),
    ),
    *mutations(
        "linear/modal/whirl.py",
        "test_foundations.py::test_a_mode_is_named_by_what_moves",
        ("foundations are not named", "code[stands] = FOUNDATION", "code[stands] = UNKNOWN"),
    ),
    *mutations(
        "linear/modal/resonance.py",
        "test_foundations.py::test_critical_speeds_are_resonances_of_the_response",
        ("unbalance does not shake foundations", "turning += answers", "turning += 0.0 * answers"),
    ),
    *mutations(
        "foundations/foundation.py",
        "test_foundations.py::test_a_block_is_exudyns_rigid_body",
        ("arms of a rigid block point the other way", "= -skew(arm)", "= skew(arm)"),
        (
            "mounts without damping",
            "D + U.T @ mount.damping @ U",
            "D + 0.0 * U.T @ mount.damping @ U",
        ),
    ),
    *mutations(
        "foundations/foundation.py",
        "test_foundation_kinds.py::test_a_stiff_solid_is_a_rigid_block",
        (
            "arms of a structure point the other way",
            "_of_rigid(place - solid.interfaces[name].reference)",
            "_of_rigid(solid.interfaces[name].reference - place)",
        ),
    ),
    *mutations(
        "foundations/foundation.py",
        "test_foundation_kinds.py::test_modes_of_a_block_are_the_block",
        ("damping ratios halved", "2.0 * zeta * omega * m", "zeta * omega * m"),
    ),
    *mutations(
        "foundations/foundation.py",
        "test_foundations.py::test_axes_change_nothing",
        (
            "motions not turned with the axes",
            "np.kron(np.eye(2), rotation) @ U for",
            "np.kron(np.eye(2), rotation.T) @ U for",
        ),
    ),
    *mutations(
        "multibody/supports/foundation_body.py",
        _SCENE,
        (
            "scenes without the foundation's damping",
            "dampingMatrix=placed.damping",
            "dampingMatrix=0.0 * placed.damping",
        ),
    ),
    *mutations(
        "foundations/record.py",
        "test_base_motion.py::test_baseline_and_integrals",
        (
            "displacement of the ground by half its slope",
            "s**3 / 6.0 * slope",
            "s**3 / 3.0 * slope",
        ),
        ("slope of the drift halved", "- 2.0 * np.outer(t, drift[1])", "- np.outer(t, drift[1])"),
    ),
    *mutations(
        "multibody/supports/base_motion.py",
        "test_base_motion.py::test_loads_are_a_base_that_moves",
        (
            "bodies follow the ground twice",
            "(-record.accelerations).tolist()",
            "record.accelerations.tolist()",
        ),
    ),
    *mutations(
        "theory/motion.py",
        "test_base_motion.py::test_a_full_body_is_shaken_as_a_reduced_one",
        (
            "the ground turns with the rotor",
            "rotation(theta)).T @ accel",
            "rotation(0.0)).T @ accel",
        ),
    ),
    *mutations(
        "theory/motion.py",
        "test_base_motion.py::test_a_constant_acceleration_is_gravity",
        (
            "unbalance does not feel the ground",
            "self._add_body_force(q[self.modes], local, force)",
            "self._add_body_force(q[self.modes], 0.0 * local, force)",
        ),
    ),
    *mutations(
        "theory/motion.py",
        "test_base_motion.py::test_ground_shaken_below_a_free_rotor",
        (
            "translations do not feel the ground",
            "* (self.free_directions.T @ accel",
            "* (0.0 * self.free_directions.T @ accel",
        ),
    ),
    *mutations(
        "linear/response/shaken_rotor.py",
        "test_base_motion.py",
        ("ground turns with the rotor", "R.transpose(0, 2, 1) + self", "R + self"),
        ("first moment of the record left out", "12.0 * moment", "0.0 * moment"),
        ("Gauss points exchanged", "for turn in turns)", "for turn in turns[::-1])"),
    ),
]
