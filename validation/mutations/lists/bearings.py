"""Bearings and supports: their laws."""

from validation.mutations.mutation import mutations

BEARINGS = [
    *mutations(
        "bearings/support.py",
        "test_cached.py",
        ("first coefficients at all speeds", "at != speed and self.varies", "False"),
        ("coefficients anew at each force", "at != speed and self.varies", "True"),
        ("kept coefficients may be changed", "return found[0].copy()", "return found[0]"),
    ),
    *mutations(
        "bearings/support.py",
        "test_stability.py::test_internal_damping_sets_in_at_the_closed_form_speed "
        "test_stability.py::test_a_symmetric_rotor_does_not_depend_on_the_frame",
        ("circulatory part of a damper reversed", "damping @ axial_skew", "-damping @ axial_skew"),
        ("rotor's frame taken for the inertial one", '== "rotor"', '== "other"'),
    ),
    *mutations(
        "bearings/support.py",
        "test_supports_in_scenes.py::test_scene_and_linear_rotor_have_the_same_exponents",
        (
            "circulatory part of a table's damper reversed",
            "both = {n: speed * X for n, X in carried.items()}",
            "both = {n: -speed * X for n, X in carried.items()}",
        ),
        ("tilts not turned", "axial_skew(6)", "np.diag([1, 1, 1, 0, 0, 0]) @ axial_skew(6)"),
    ),
    *mutations(
        "bearings/support.py",
        "test_linear_input.py::test_coefficients_stand_in_their_blocks "
        "test_linear_input.py::test_tables_and_matrices_are_told_apart "
        "test_linear_input.py::test_a_table_is_not_used_beyond_its_ends_unless_asked_for",
        (
            "tilts without damping",
            'damping[3:, 3:] = self._matrix("tilt_damping", speed)',
            'damping[3:, 3:] = 0.0 * self._matrix("tilt_damping", speed)',
        ),
        ("table read at the speed above", "(1.0 - share) * values[above - 1] +", "0.0 +"),
        ("table read at its start", "share = (speed - ", "share = 0.0 * (speed - "),
        ("ends of a table taken for its inside", "if not least <= speed <= most:", "if False:"),
    ),
    *mutations(
        "bearings/support.py",
        "test_critical.py",
        (
            "tilts without stiffness",
            'self._matrix("tilt_stiffness", speed)',
            '0.0 * self._matrix("tilt_stiffness", speed)',
        ),
    ),
    *mutations(
        "bearings/support.py",
        "test_linear_input.py::test_an_undamped_support_keeps_what_stores_energy",
        (
            "skew part kept in place of the symmetric one",
            "0.5 * (values + np.swapaxes",
            "0.5 * (values - np.swapaxes",
        ),
        ("tables keep their skew part", "value[0], _symmetric_matrix(value[1])", "value"),
        ("functions keep their skew part", "return _SymmetricPart(value)", "return value"),
        ("tilt dampers kept", "damping=0.0, tilt_damping=0.0)", "damping=0.0)"),
    ),
    *mutations(
        "bearings/film/grid.py",
        "test_film.py::test_profile_is_integrated_along_the_axis",
        ("parabola's square wrong", "4.0 / 15.0 * half**5", "8.0 / 15.0 * half**5"),
        ("profile's mass without its slope", "mass = weight - stiffness", "mass = weight"),
    ),
    *mutations(
        "bearings/film/reynolds.py",
        "test_film.py::test_long_full_film_is_sommerfelds "
        "test_film.py::test_squeezed_short_film_is_damped_as_computed "
        "test_film.py::test_coefficients_are_derivatives_of_the_force "
        "test_film.py::test_oil_is_balanced_and_nowhere_pulled",
        ("surface's speed in place of its half", "gain = 0.5 * self.speed", "gain = self.speed"),
        (
            "squeeze reversed",
            "(gain + growth)",
            "(gain - growth)",
        ),
        (
            "cube of the thickness not differentiated",
            "3.0 * equation.heights**2 * heights",
            "equation.heights**2 * heights",
        ),
        ("voids keep their pressure's change", "self.empty | (", "False & ("),
        (
            "void carried by no surface",
            'carried = self.cavitation == "mass-conserving"',
            "carried = False",
        ),
    ),
    *mutations(
        "bearings/film/reynolds.py",
        "test_mass_conserving.py::test_coefficients_are_those_of_small_whirl_in_time "
        "test_mass_conserving.py::test_oil_is_balanced_over_a_cycle_of_large_motion",
        ("voids of the last step forgotten", "if self.voids is not None", "if False"),
        ("voids grow at once", "kept = self.grid.step * self.void_rate", "kept = 0.0"),
        (
            "voids change no thickness",
            "- self.void_rate * void * heights",
            "- 0.0 * void * heights",
        ),
    ),
    *mutations(
        "bearings/film/state.py",
        "test_mass_conserving.py",
        ("voids follow at once", "u[:, 0], 1j * whirl)", "u[:, 0], 0.0j)"),
        (
            "whirl at half of its frequency",
            "whirl = whirl_ratio * abs",
            "whirl = 0.5 * whirl_ratio * abs",
        ),
        (
            "limit where a mode is damped least",
            "values[np.argmin(values.imag)]",
            "values[np.argmax(values.imag)]",
        ),
    ),
    *mutations(
        "bearings/film/void_states.py",
        "test_void_states.py::test_states_have_the_force_of_the_film "
        "test_void_states.py::test_states_decay_and_those_that_are_not_needed_do_nothing "
        "test_void_states.py::test_exponents_are_those_of_the_film",
        ("states driven the other way", "@ B), -unit * driven", "@ B), unit * driven"),
        ("states felt without the journal's own rate", "-= rate @ driven", "+= rate @ driven"),
        ("states that grow", "-unit * by_rate", "unit * by_rate"),
        ("voids that come back at once", "pairs = -(ahead", "pairs = (ahead"),
    ),
    *mutations(
        "linear/models/rotor/own_coordinates.py",
        "test_void_states.py::test_trains_processes_and_speeds_give_the_same",
        (
            "films of a rotor at another's speed",
            "matrices(self.rates[index] * speed)",
            "matrices(speed)",
        ),
    ),
    *mutations(
        "linear/models/scene/remembering_scene.py",
        "test_uneven_films.py",
        ("foundation moves against the film", "- R @ base", "+ R @ base"),
        (
            "films about one angle of a revolution",
            "forces.mean(axis=0)",
            "forces[-1]",
        ),
        ("films about the mean place", "in range(_STEPS)", "in range(0)"),
        ("journals that move as if at rest", "if moved > MOST_MOTION", "if False"),
    ),
    *mutations(
        "linear/models/scene/probe.py",
        "test_uneven_films.py",
        (
            "slow tangents of films beside their states",
            "film.stiff, film.seen = False",
            "_, film.seen = 0",
        ),
    ),
    *mutations(
        "bearings/journal_bearing.py",
        "test_mass_conserving.py::test_small_motion_in_a_scene_decays_as_the_linear_film_says "
        "test_mass_conserving.py::test_a_run_that_begins_again_forgets "
        "test_mass_conserving.py::test_oil_is_balanced_over_a_cycle_of_large_motion",
        ("an earlier run is remembered", " and time > self._begun[0]", ""),
        (
            "steps of another length",
            "self._duration = now - time",
            "self._duration = 2 * (now - time)",
        ),
    ),
    *mutations(
        "bearings/film/state.py",
        "test_film_tables.py::test_losses_are_those_of_someyas_table "
        "test_film.py::test_power_that_goes_in_is_dissipated "
        "test_film.py::test_supply_pressure_pushes_the_journal_away_from_its_groove "
        "test_film.py::test_rigid_mass_is_at_the_limit_of_whirl",
        ("pressure's torque reversed", "lift = -(slope @ excess)", "lift = slope @ excess"),
        (
            "side flow of one end",
            "@ slope / (6.0 * film.viscosity)",
            "@ slope / (12.0 * film.viscosity)",
        ),
        ("pressure in the grooves left out", "return supply + self", "return 0.0 * supply + self"),
        (
            "cross stiffness left out of the limit",
            "square = ((k11 - k) * (k22 - k) - k12 * k21)",
            "square = ((k11 - k) * (k22 - k))",
        ),
    ),
    *mutations(
        "bearings/film/pads.py",
        "test_film.py::test_preload_brings_the_pads_to_the_journal",
        ("preload opens the film", "-preload * clearance", "preload * clearance"),
    ),
    *mutations(
        "bearings/film/pads.py",
        "test_film.py::test_bad_input_is_refused",
        ("a groove without width is none", "and groove_width == 0.0", "and groove_width < 0.0"),
    ),
    *mutations(
        "bearings/short_film.py",
        "test_journal_bearing.py::test_film_is_the_integral_of_its_pressure",
        ("oil carried around at the journal's speed", "vx + 0.5 * speed * y", "vx + speed * y"),
        ("film on the wrong half", "beta = 0.5 * pi + atan", "beta = 0.5 * pi - atan"),
        (
            "force across with the wrong sign",
            "return across * b - along * a",
            "return -across * b - along * a",
        ),
    ),
    *mutations(
        "bearings/short_journal.py",
        "test_bearing_energy.py::test_films_brake_a_free_spin_as_petroff_says "
        "test_journal_bearing.py::test_power_that_goes_into_a_short_film_is_dissipated",
        ("film drives the journal", "return fx, fy, -shear", "return fx, fy, shear"),
        ("pressure's moment reversed", "- 0.5 * (x * fy - y * fx)", "+ 0.5 * (x * fy - y * fx)"),
    ),
    *mutations(
        "bearings/journal_bearing.py",
        "test_bearing_energy.py::test_films_brake_a_free_spin_as_petroff_says",
        ("film drives the journal", "(-state.torque,)", "(state.torque,)"),
    ),
    *mutations(
        "bearings/short_journal.py",
        "test_journal_bearing.py",
        ("cross damping reversed", "s**5, -2.0 * ratio / s2**2],", "s**5, 2.0 * ratio / s2**2],"),
        (
            "attitude on the other side",
            "c, s = radial / size, -tangential / size",
            "c, s = radial / size, tangential / size",
        ),
        ("a slow film carries all", "size = self._size * abs(speed)\n", "size = self._size\n"),
    ),
    *mutations(
        "bearings/short_film.py",
        "test_kinds_in_scenes_and_lists.py::test_tangents_of_a_short_film_are_those_of_its_force",
        ("slopes turn the other way", "slopes @ (v, -u) +", "slopes @ (-v, u) +"),
        ("film's second slope dropped", "w * turn @ slopes", "0.0 * turn @ slopes"),
    ),
    *mutations(
        "bearings/short_film.py",
        "test_kinds_in_scenes_and_lists.py::test_small_harmonic_motions_off_the_centre",
        ("damping off the centre alike", "+ 3.0 * np.outer(", "- 3.0 * np.outer("),
    ),
    *mutations(
        "bearings/short_journal.py",
        "test_mirror_images.py::test_equilibrium_and_coefficients",
        ("backwards on the wrong side", "if speed < 0.0:", "if speed < -1e9:"),
        ("coefficients of one sense", "sense = -1.0 if speed < 0.0", "sense = 1.0 if speed < 0.0"),
    ),
    *mutations(
        "bearings/film/reynolds.py",
        "test_mirror_images.py::test_equilibrium_and_coefficients",
        ("voids carried one way", "        if self.speed >= 0.0:", "        if True:"),
    ),
    *mutations(
        "bearings/held_law.py",
        "test_unloaded_bearings.py::test_contacts_are_linear_by_their_stiffness_once_held",
        ("held contacts push", "return stiffness, self", "return -stiffness, self"),
        ("held bearings undamped", "self.bearing.damping * np.eye(2)", "0.0 * np.eye(2)"),
    ),
    *mutations(
        "linear/models/scene/unloaded.py",
        "test_unloaded_bearings.py",
        ("films with a supply ask for a load", "given.supply_pressure == 0.0", "True"),
        ("films in tension ask for a load", 'given.cavitation != "none" and', "True and"),
        ("loads move no journal", "point.K, -residual)[0]", "point.K, 0.0 * residual)[0]"),
        ("loose elements are pressed", "bearing.clearance >= 0.0", "bearing.clearance < 0.0"),
    ),
    *mutations(
        "linear/models/scene/journal_start.py",
        "test_unloaded_bearings.py",
        ("bearings' own loads forgotten", "weight if np.any(weight) else load", "weight"),
    ),
    *mutations(
        "bearings/squeeze_film.py",
        "test_dampers_and_stops.py",
        (
            "journal turns in the damper",
            "self._film(x, y, vx, vy, 0.0)",
            "self._film(x, y, vx, vy, speed)",
        ),
        ("film's stiffness halved", "film = 2.0 * size", "film = size"),
        (
            "spring pushes away",
            "- self.centring_stiffness * place",
            "+ self.centring_stiffness * place",
        ),
    ),
    *mutations(
        "bearings/clearance_stop.py",
        "test_dampers_and_stops.py::test_stop_pushes_back_and_rubs",
        ("friction drives", "return drag * ny - normal * nx", "return -drag * ny - normal * nx"),
        ("contact holds the journal back", "normal = max(0.0, ", "normal = max(-1e9, "),
        ("sliding without the orbit", "speed + vy * nx - vx * ny", "speed"),
        ("friction drives the spin", "-self.radius * drag", "self.radius * drag"),
    ),
    *mutations(
        "bearings/bearing.py",
        "test_journal_bearing.py::test_a_film_too_thin_goes_on_by_its_tangent",
        ("tangent pulls outwards", "(eccentricity - most) / step", "(most - eccentricity) / step"),
    ),
    *mutations(
        "bearings/annular_seal.py",
        "test_annular_seal.py::test_coefficients_are_those_of_the_perturbed_bulk_flow",
        ("inlet's loss wrong", "(7.0 + 4.0 * xi) / 3.0", "(7.0 + 6.0 * xi) / 3.0"),
        ("leakage's inertia with the wrong sign", "(2.0 * xi - 1.0)", "(1.0 - 2.0 * xi)"),
        ("leakage turns as fast as the rotor", "0.5 * speed\n", "speed\n"),
        ("leakage does not turn", "+ half * d * turn", "+ 0.0 * d * turn"),
        ("friction without the spin", "(7.0 * around", "(0.0 * around"),
    ),
    *mutations(
        "bearings/actuator.py",
        "test_magnetic_bearing.py::test_magnets_pull_by_the_square_of_current_over_gap",
        ("both magnets pull the same way", "** 2 - (push / far)", "** 2 + (push / far)"),
        ("magnets that push", "min(max(bias + current, 0.0), limit)", "min(bias + current, limit)"),
        (
            "gap widens on the near side",
            "max(self.gap - place, least)",
            "max(self.gap + place, least)",
        ),
        ("slope by place of a constant current", "current**2 / gap**3", "current**2 / gap**2"),
    ),
    *mutations(
        "bearings/pid_controller.py",
        "test_magnetic_bearing.py::test_realisation_is_the_transfer_function",
        ("delay that leads", "damping[1, 0] = tau", "damping[1, 0] = -tau"),
        ("proportional part without the derivative's", "[0.0, P / w_a - D]", "[0.0, P / w_a]"),
        ("integral after the amplifier", "self.integral / w_a]", "self.integral]"),
        ("extra pole seen", "[0.0, 0.5 * (P / w_a - D)]", "[0.0, P / w_a - D]"),
    ),
    *mutations(
        "bearings/magnetic.py",
        "test_magnetic_bearing.py::test_flexible_rotor_with_sensors_elsewhere "
        "test_magnetic_bearing.py::test_magnets_pull_by_the_square_of_current_over_gap "
        "test_magnetic_bearing.py::test_magnets_under_weight_are_stiffer_in_one_direction",
        ("magnets centre the rotor", "= -by_place", "= by_place"),
        ("controller measures nothing", "stiffness[4:, 2:4] = -", "stiffness[4:, 2:4] = 0.0 * "),
        (
            "sensors where the magnets are",
            "return self.interface if self.sensor is None else self.sensor",
            "return self.interface",
        ),
        ("weight left out of the slopes", "states = self._states(None)", "pass"),
        (
            "control axes turned the other way",
            "np.array([[c, s], [-s, c]])",
            "np.array([[c, -s], [s, c]])",
        ),
    ),
    *mutations(
        "multibody/supports/tilting_pads.py",
        "test_tilting_pad.py::test_a_run_stays_in_the_equilibrium",
        ("pads of a scene go the other way", "= -radius * seat.axes", "= radius * seat.axes"),
    ),
    *mutations(
        "bearings/film/film.py",
        "test_film_properties.py",
        (
            "journal sought on one side",
            "for ratio, turn in _STARTS",
            "for ratio, turn in _STARTS[:1]",
        ),
    ),
    *mutations(
        "bearings/tilting_pad.py",
        "test_tilting_pad_limits.py",
        ("pads overshoot", "> -0.5 * ahead", "> -np.inf"),
        ("nothing goes where no pad holds", "_HELD * max(", "1e-300 * max("),
    ),
    *mutations(
        "bearings/pad_tilt.py",
        "test_tilting_pad_limits.py",
        ("pads pressed too thin absent", "if thin_end > small:", "if False:"),
        ("light pads absent", "if low < even < high else tried", "if False else tried"),
    ),
    *mutations(
        "bearings/tilting_pad.py",
        "test_tilting_pad.py",
        ("pads held", "total += Z - np.outer(Z @ t, t @ Z) /", "total += Z + 0.0 * t @ t /"),
        ("pads eliminated at rest", "Z = K + 1j * whirl * C", "Z = K + 0j * whirl * C"),
        ("pads tilt the other way", "return -self._state", "return self._state"),
        ("pivots in the middle", "pad.start + self.pivot * pad.arc", "pad.start + 0.5 * pad.arc"),
        (
            "pads of another inertia",
            "(self.pad_inertia or 0.0) / self.film.radius**2",
            "self.pad_inertia",
        ),
    ),
]
