"""Advice before a run and checks after it."""

from validation.mutations.mutation import mutations

ADVICE = [
    *mutations(
        "advice/run_measures.py",
        "test_step_phase.py",
        (
            "error of half a period",
            "float(PERIOD_ERROR * solver.step**2",
            "float(0.5 * PERIOD_ERROR * solver.step**2",
        ),
    ),
    *mutations(
        "advice/candidate.py",
        "test_advice_bearings.py",
        (
            "resonances of controllers",
            "alone if alone.size < self.source.size else self.source",
            "self.source",
        ),
        ("scene looked at outside the speeds", "scene.at(speed)", "scene.at(0.0)"),
    ),
    *mutations(
        "advice/run_measures.py",
        "test_full_run_check.py::test_a_journal_out_of_its_film_fails_the_check",
        ("journal in other axes", "place @ axes[:, :2]", "place[:2]"),
        ("local axes turned", "x, y = place[:2] if local else", "x, y ="),
    ),
    *mutations(
        "bearings/bearing.py",
        "test_full_run_check.py::test_a_journal_out_of_its_film_fails_the_check",
        ("the film's end on the other side", "place / distance", "-place / distance"),
    ),
    *mutations(
        "advice/unresisted.py",
        "test_run_check.py::test_loads_at_the_node_and_weight_are_felt",
        (
            "moment about the node, not about the centre of mass",
            "seen @ np.cross(arm, force)",
            "0.0 * seen @ np.cross(arm, force)",
        ),
    ),
    *mutations(
        "advice/energy_balance.py",
        "test_energy_balance.py",
        (
            "dampers of the rotor give energy",
            "zeta_t @ (motion.invariants.D",
            "-zeta_t @ (motion.invariants.D",
        ),
        ("weight counted twice", "works[:, 0] + by_weight", "works[:, 0]"),
        (
            "moment of loads not taken off the drive",
            "q_tt[motion.modes]) - moment)",
            "q_tt[motion.modes]))",
        ),
        (
            "weight at the deflection against the spin",
            "moment += turn @ axis.skew",
            "moment -= turn @ axis.skew",
        ),
        (
            "guide of a locked spin with the wrong sign",
            "held -= place.signs",
            "held += place.signs",
        ),
    ),
    *mutations(
        "advice/run_measures.py",
        "test_measures.py",
        (
            "gyroscopic term of the kinetic energy reversed",
            "kinetic += omega * np",
            "kinetic -= omega * np",
        ),
        (
            "centrifugal term of the kinetic energy doubled",
            "kinetic += 0.5 * omega**2",
            "kinetic += omega**2",
        ),
        (
            "turned into space the wrong way",
            "+ np.sin(angle)[:, None] * np.cross(e, values)",
            "- np.sin(angle)[:, None] * np.cross(e, values)",
        ),
        ("Coriolis forces halved in the divergence", "2.0 * speed * G, 1e-6", "speed * G, 1e-6"),
        (
            "left-out stiffness as a whole change, not a half",
            "float(0.25 * np.abs(work)",
            "float(0.5 * np.abs(work)",
        ),
        (
            "velocity in space without the spin",
            "inertial_rate = rate + speed[:, None] * np.hstack",
            "inertial_rate = rate + 0.0 * speed[:, None] * np.hstack",
        ),
    ),
    *mutations(
        "advice/run_measures.py",
        "test_run_check.py::test_strain_is_that_of_the_static_stretch",
        (
            "strain grows with the speed",
            "return float(self.fastest**2 * growth / inv.Theta)",
            "return float(self.fastest * growth / inv.Theta)",
        ),
    ),
    *mutations(
        "advice/run_measures.py",
        "test_run_check.py::test_unstable_step_of_an_explicit_solver_is_found",
        (
            "frequencies of an explicit step without the spin",
            ".max()) + self.fastest",
            ".max()) + 0.0 * self.fastest",
        ),
    ),
    *mutations(
        "advice/unresisted.py",
        "test_measures.py::test_axial_force_on_a_rotor_off_its_frame_is_felt "
        "test_run_check.py::test_loads_that_the_frame_does_not_take_are_found "
        "test_connections.py::test_weight_of_a_pendulum_is_no_lost_load",
        (
            "second-order moment with the wrong sign",
            "unresisted - tilting @ by_arm",
            "unresisted + tilting @ by_arm",
        ),
        (
            "moments that tilt not compared with the modes'",
            "unresisted = tilting @ (known - modal_moment)",
            "unresisted = 0.0 * tilting @ (known - modal_moment)",
        ),
    ),
    *mutations(
        "advice/stiffening_level.py",
        "test_advice_linear.py::test_change_by_the_full_level_without_supports",
        (
            "whole change for half of it",
            "shift = 0.5 * speed**2 * np.abs",
            "shift = 2.0 * speed**2 * np.abs",
        ),
    ),
    *mutations(
        "advice/candidate.py",
        "test_advice_linear.py::test_resonances_are_those_without_damping_and_cross_coupling",
        ("circulatory stiffness kept", "0.5 * (K + K.conj().T)", "K"),
        ("gyroscopic forces halved", "G = 1j * D", "G = 0.5j * D"),
    ),
    *mutations(
        "advice/mode_choice.py",
        "test_advice_linear.py::test_critical_speeds_of_a_rigid_rotor",
        (
            "slope over the square of the speed",
            "(request.high**2 - middle**2)",
            "(1.0 * request.high**2)",
        ),
    ),
    *mutations(
        "advice/mode_choice.py",
        "test_advice_linear.py::test_what_modes_miss_of_the_response_to_unbalance_is_the_error_of_that",
        ("free spin not held", "used[~np.isin(used % size, given.held)]", "used"),
    ),
    *mutations(
        "advice/mode_choice.py",
        "test_advice.py::test_share_of_flexibility_is_that_of_the_modes",
        (
            "modes left out are doubled",
            "change = rows @ (H[:, places] @ inner)",
            "change = 2.0 * rows @ (H[:, places] @ inner)",
        ),
    ),
    *mutations(
        "advice/step_size.py",
        "test_advice.py::test_steady_orbit_at_the_proposed_step_meets_the_accuracy",
        (
            "frame that follows: forward and backward exchanged",
            "0.5j * (forward - backward)",
            "0.5j * (backward - forward)",
        ),
    ),
    *mutations(
        "advice/residual.py",
        "test_attachment.py::test_estimate_after_a_run_is_what_the_springs_would_bend",
        (
            "flexibility with the frequency, not its square",
            "scaled = motion[:, flexible] / rotor.frequencies[flexible]",
            "scaled = motion[:, flexible] / np.sqrt(rotor.frequencies[flexible])",
        ),
        (
            "centrifugal stretch left out",
            "left_out = np.outer(stretch, record.speed[picked] ** 2)",
            "left_out = np.outer(0.0 * stretch, record.speed[picked] ** 2)",
        ),
        ("stretch of the modes added", ", body) - _stretch(", ", body) + _stretch("),
        (
            "force on the frame left out",
            "np.concatenate([on_modes, on_frame / np.sqrt(mass)])",
            "np.concatenate([on_modes, 0.0 * on_frame])",
        ),
    ),
    *mutations(
        "advice/left_out_fields.py",
        "test_errors_at_nodes.py::test_left_out_is_the_static_solution_of_the_residual",
        ("damping added", "- inv.D @ rate", "+ inv.D @ rate"),
        ("gyroscopic forces reversed", "- 2.0 * (inv.G @", "+ 2.0 * (inv.G @"),
        ("spin softening reversed", "forces += terms.C_hat @", "forces -= terms.C_hat @"),
        ("Euler force reversed", "- terms.W @", "+ terms.W @"),
        ("stiffness of the static stretch reversed", "forces -= terms.K4", "forces += terms.K4"),
        ("stretch by the speed", "np.outer(terms.h, omega**2)", "np.outer(terms.h, omega)"),
        ("stretch of the modes added", "forces[:, count:] -= solid", "forces[:, count:] += solid"),
        ("static stress counted twice", "left - speed**2 * stretch", "left"),
        ("damping hastens the static stretch", "-= np.outer(damping", "+= np.outer(damping"),
        ("delay without the factor of 2", "growth = 2.0 * speed", "growth = speed"),
        (
            "loads at interfaces left out",
            "forces[:, :count] += columns @ values",
            "forces[:, :count] += 0.0 * columns @ values",
        ),
        (
            "work on the modes left in",
            "(columns.T @ forces[:, :count])",
            "(0.0 * columns.T @ forces[:, :count])",
        ),
    ),
    *mutations(
        "advice/residual.py",
        "test_errors_at_nodes.py::test_loads_beside_the_reference_point_have_a_moment",
        ("arm reversed", "row[3:] += skew(arm)", "row[3:] -= skew(arm)"),
    ),
    *mutations(
        "multibody/load_places.py",
        "test_attachment.py::test_estimate_after_a_run_is_what_the_springs_would_bend",
        ("interface far off", "return min(found", "return max(found"),
    ),
    *mutations(
        "multibody/load_places.py",
        "test_errors_at_nodes.py",
        ("moments of springs", "or kind not in _FORCES", "or True"),
        ("axes of the marker body", "[turn.T @ part", "[turn @ part"),
        ("lever of the point reversed", "mean[:3] - skew(arm)", "mean[:3] + skew(arm)"),
    ),
    *mutations(
        "advice/left_out_fields.py",
        "test_errors_at_nodes.py::test_held_rotor_errs_by_its_weight_too",
        ("weight reversed", "forces += inv.S.T", "forces -= inv.S.T"),
    ),
    *mutations(
        "advice/full_measures.py",
        "test_full_run_check.py::test_rows_are_those_of_all_modes",
        ("mean motion left in", "fields - self._rigid @", "fields - 0.0 * self._rigid @"),
        ("relief of the prestress left out", "+ self._by_factors(relief, c)", ""),
        (
            "tilts are in a level without",
            "work += self._by_factors(tilt",
            "work += 0.0 * self._by_factors(tilt",
        ),
        ("kinetic energy of the spin", "+ 0.5 * omega**2 * _sq", "- 0.5 * omega**2 * _sq"),
        (
            "frequency without the frame",
            "return float(lateral + _squares",
            "return float(0.0 * lateral + _squares",
        ),
    ),
    *mutations(
        "advice/full_measures.py",
        "test_full_run_check.py::test_stiffening_of_a_mesh_is_estimated_as_for_modes",
        (
            "estimate left out",
            "inv.M if network is None else network",
            "inv.M",
        ),
    ),
]
