"""Scenes around the rotor in modes: full bodies, supports, drives, calls of Exudyn, twins."""

from validation.mutations.mutation import mutations

MULTIBODY = [
    *mutations(
        "multibody/drives/connect_rotors.py",
        "test_prescribed_speeds.py",
        ("sense of the second axis lost", "expected = sense * connection", "expected = connection"),
        ("speeds unchecked", "abs(other.speed - expected) >", "-1.0 >"),
    ),
    *mutations(
        "drives/gear_mesh.py",
        "test_prescribed_speeds.py",
        (
            "gears of the same sense",
            "return -float(self.radii[0] / self.radii[1])",
            "return float(self.radii[0] / self.radii[1])",
        ),
    ),
    *mutations(
        "multibody/supports/seats.py",
        "test_places.py",
        (
            "markers of bases shifted the wrong way",
            "self.orientation.T @ (self.place - self.origin)",
            "self.orientation.T @ (self.origin - self.place)",
        ),
        ("a rotor carries itself", "_refuse_own(body, name, base)\n", "pass\n"),
    ),
    *mutations(
        "multibody/supports/magnetic_connectors.py",
        "test_magnetic_runs.py::test_a_foundation_carries_magnets_and_sensors "
        "test_magnetic_bearing.py::test_scene_and_list_have_the_same_exponents "
        "test_magnetic_bearing.py::test_magnets_under_weight_are_stiffer_in_one_direction "
        "test_magnetic_bearing.py::test_slopes_are_exact_where_a_magnet_is_all_but_without_current",
        ("sensors on the ground", "- read(base, _KINDS.Position)", "- seat.place"),
        ("offset of the sensors left out", "apart @ across + offset", "apart @ across"),
        ("controller drives the rotor away", "first(-i, x)", "first(i, x)"),
        ("slope by the current", "+ by_current * (current", "- by_current * (current"),
        ("slope by the place", "+ by_place * (place", "- by_place * (place"),
        ("differences of forces", "= held, None", "= False, None"),
    ),
    *mutations(
        "multibody/supports/magnetic_connectors.py",
        "test_clearances.py",
        ("magnets note nothing", "note(item, x, y)", "pass"),
        ("magnets not looked at", "watch_clearance(body, bearing, connector)", "pass"),
    ),
    *mutations(
        "bearings/magnetic.py",
        "test_clearances.py",
        ("rotors leave the air gap unseen", "gap = self.actuator.gap if", "gap = inf if"),
    ),
    *mutations(
        "multibody/full/ties.py",
        "test_full_bodies.py",
        (
            "interfaces move the wrong way",
            "sp.hstack([-self.rows, select])",
            "sp.hstack([self.rows, select])",
        ),
        (
            "stiffness of mean motions on other coordinates",
            "_shifted(sp.csr_array(ties.stiffness), width, size)",
            "_shifted(sp.csr_array(ties.stiffness), width - 1, size)",
        ),
    ),
    *mutations(
        "multibody/full/add_full.py",
        "test_full_bodies.py",
        (
            "gravity on half of the mass",
            "plan.motion.invariants.mass * directions",
            "0.5 * plan.motion.invariants.mass * directions",
        ),
        ("low-rank stiffening per Ω", "spin.speed**2 * values", "spin.speed * values"),
    ),
    *mutations(
        "multibody/full/full_equations.py",
        "test_full_bodies.py",
        (
            "coupling of spin and displacements dropped",
            "table[count + 1 :, 2] = row",
            "table[count + 1 :, 2] = 0.0 * row",
        ),
    ),
    *mutations(
        "multibody/full/full_markers.py",
        "test_full_bodies.py::test_full_and_reduced_stand_on_the_same_supports",
        (
            "supports of a full body in axes of the mesh",
            "np.kron(np.eye(2), body.frame.B), interface.radius",
            "np.eye(6), interface.radius",
        ),
    ),
    *mutations(
        "multibody/full/full_record.py",
        "test_full_bodies.py::test_one_run_stores_displacement_and_stress_at_instants",
        (
            "instants stored a step late",
            "t >= self.instants[done] * (1.0 - _ROUNDING)",
            "t > self.instants[done] * (1.0 + _ROUNDING)",
        ),
        ("runs not told apart", "if t < self.latest:", "if False:"),
    ),
    *mutations(
        "multibody/full/full_memory.py",
        "test_full_bodies.py::test_too_little_memory_is_said_before_anything_is_added",
        ("memory of the factor not checked", "if needed > available:", "if False:"),
    ),
    *mutations(
        "multibody/spatial_body.py",
        "test_spatial_body.py",
        ("frame in the mesh origin", "place + turn @ rotor.center_of_mass", "place"),
        (
            "mean rotation not held",
            "translations(len(local)), tilde(local)",
            "translations(len(local)), 0.0 * tilde(local)",
        ),
        ("mean axes by geometry", "rows = (rotor.mass @ motions).T", "rows = motions.T"),
        ("weight left out", "if np.any(gravity):", "if False:"),
    ),
    *mutations(
        "multibody/calls/static_check.py",
        "test_static_solutions.py",
        ("forces left, of any size", "if not left <= _SLACK * asked:", "if left < 0.0:"),
        ("forces left in any equilibrium", "<= _SLACK * asked", "<= 1e-9 * asked"),
        ("reactions of constraints no loads", "loads = max(loads, reactions)", "loads += 0.0"),
        ("full bodies sent to steady_state", "if rotor.full else", "if False else"),
    ),
    *mutations(
        "multibody/calls/static_check.py",
        "test_steady_state.py",
        (
            "static solution looked at from one angle only",
            "moved[spin] = q[spin] + turn",
            "moved[spin] = q[spin]",
        ),
    ),
    *mutations(
        "multibody/calls/assembly.py",
        "test_connections.py",
        ("each item told at every assembly", "known.told.add(sentence)", "pass"),
        (
            "items of a rotor that is gone",
            'mark is None or mark_of(mbs, known.objects["physics"]) != mark',
            "mark is None",
        ),
    ),
    *mutations(
        "multibody/twins/swapped_body.py",
        "test_mesh_axes.py::test_offset_of_a_marker_of_the_call_turns_with_the_mean_rotation",
        (
            "offset turns with the interface",
            'rigid = more.markers == "rigid"',
            "rigid = False",
        ),
    ),
    *mutations(
        "multibody/supports/differenced_law.py",
        "test_film_differences.py",
        ("tangent of an earlier Jacobian", "if formed != self._formed:", "if not self._formed:"),
        ("damping of a film's tangent reversed", "+ c * dvx + d * dvy", "- c * dvx - d * dvy"),
        ("tangent far from its place", "near = abs(dx)", "near = True or abs(dx)"),
        ("tangent at another speed", "speed != speed0 or ", ""),
    ),
    *mutations(
        "bearings/film/state.py",
        "test_film_differences.py",
        (
            "voids of a step at once in its tangent",
            "self._gradient_of(self.solution, heights, rates)",
            "self._gradient(heights, rates)",
        ),
        ("film of another velocity", "np.array_equal(velocity, self.velocity)", "True"),
        ("film of other voids", "            and voids is equation.voids\n", ""),
    ),
    *mutations(
        "bearings/journal_bearing.py",
        "test_film_differences.py",
        ("tangent of no film", "if hypot(x, y) <= self._to_the_edge(x, y) else", "if True else"),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_film_differences.py::test_a_film_has_the_rotors_speed_whatever_way_its_node_counts",
        ("speed counted as the node does", "return 0.0, sign * float(", "return 0.0, float("),
    ),
    *mutations(
        "multibody/supports/differences.py",
        "test_film_differences.py",
        ("a Jacobian without an end", "self.formed = 0\n", "pass\n"),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_supports_in_scenes.py::test_scene_and_linear_rotor_have_the_same_exponents",
        (
            "damper in the rotor's frame feels the spin",
            "x_t -= speed * np.array([-x[1], x[0], 0.0])",
            "x_t -= 0.0 * np.array([-x[1], x[0], 0.0])",
        ),
        (
            "tilts damped by Exudyn's angular velocity",
            "omega[0] - 2.0 * omega[2] * tilt[1]",
            "omega[0] - omega[2] * tilt[1]",
        ),
        ("torsion spring against the ground", "(angles[2] - angle + np.pi)", "(angles[2] + np.pi)"),
        (
            "rotor's frame turned the wrong way",
            "into = axes @ axial_rotation(angle) if",
            "into = axes @ axial_rotation(-angle) if",
        ),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_supports_in_scenes.py::test_axes_and_formulations_change_nothing",
        ("matrix not turned into the scene", "turned = axes @ matrix @ axes.T", "turned = matrix"),
        (
            "spin counted as the node does",
            "return sign * float(angle), sign * float(rate)",
            "return angle, sign * rate",
        ),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_mass_conserving.py::test_voids_in_a_scene_are_those_of_accepted_steps",
        (
            "voids of trial states",
            "[mbs.GetMarkerOutput(each, kind, _START) for",
            "[mbs.GetMarkerOutput(each, kind) for",
        ),
        ("spin of the trial state", "spin_reader(body, _START), []", "lambda _: (0.0, 0.0), []"),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_bearing_energy.py::test_a_stop_brakes_a_free_spin_by_coulombs_friction",
        ("bearings drive a free spin", "0.0, 0.0, 0.0, -torque]", "0.0, 0.0, 0.0, torque]"),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_supports_in_scenes.py::test_a_foundation_feels_the_forces",
        (
            "tilt of the base forgotten",
            "rate += omega[2] * np.array([-b, a, 0.0])",
            "rate += 0.0 * np.array([-b, a, 0.0])",
        ),
    ),
    *mutations(
        "bearings/short_film.py",
        "test_clearances.py",
        (
            "journals leave a short film unseen",
            "        return self.clearance\n",
            "        return 2e3 * self.clearance\n",
        ),
    ),
    *mutations(
        "bearings/annular_seal.py",
        "test_clearances.py",
        (
            "journals leave a seal unseen",
            "        return self.clearance\n",
            "        return 2e3 * self.clearance\n",
        ),
    ),
    *mutations(
        "bearings/journal_bearing.py",
        "test_clearances.py",
        (
            "journals leave a film unseen",
            "self.film.reach_along(direction, 0.0)",
            "self.film.reach_along(direction, -1.0)",
        ),
    ),
    *mutations(
        "multibody/calls/clearances.py",
        "test_clearances.py",
        (
            "journals looked at in axes that turned",
            "_KINDS.Displacement) @ self.across",
            "_KINDS.Displacement)[:2] * 0.0",
        ),
    ),
    *mutations(
        "multibody/calls/clearances.py",
        "test_clearances.py",
        (
            "a stop beside a seal forgotten",
            "if isinstance(each.bearing, ClearanceStop)",
            "if False",
        ),
    ),
    *mutations(
        "multibody/calls/clearances.py",
        "test_clearances.py",
        ("a script's own function left out", "(own is None or own(mbs, t))", "True"),
    ),
    *mutations(
        "multibody/calls/clearances.py",
        "test_clearances.py",
        ("every step looked at", "            noted.clear()\n", ""),
        (
            "all beyond the least clearance noted",
            "if distance >= bearing.clearance_along(",
            "if bearing.clearance_along(",
        ),
        (
            "initial state not looked at",
            "noted.update(int(each.number) for each in watched)",
            "pass",
        ),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_clearances.py",
        ("journals outside across a line unseen", "x * x + y * y >= least", "x * x >= least"),
        (
            "journals that brake outside unseen",
            "u[0] * u[0] + u[1] * u[1] >= least",
            "u[0] * u[0] >= least",
        ),
        (
            "a hundred clearances looked at as one",
            "bearing.clearance_along() ** 2",
            "bearing.clearance_along()",
        ),
    ),
    *mutations(
        "multibody/supports/seats.py",
        "test_supports_in_scenes.py::test_a_foundation_feels_the_forces",
        (
            "place in axes of the scene",
            "self.orientation.T @ (self.place - self.origin)",
            "self.place - self.origin",
        ),
    ),
    *mutations(
        "multibody/drives/interface_coordinates.py",
        "test_geared_rotors.py::test_axes_and_senses_change_nothing "
        "test_geared_rotors.py::test_energy_goes_into_drives_springs_and_losses "
        "test_couplings.py::test_what_holds_the_frame_has_the_reaction",
        ("node's sense of the spin", "theta = self.sign * q[self.spin]", "theta = q[self.spin]"),
        ("arm without the spin", "self.sign * (skew @ arm)", "0.0 * (skew @ arm)"),
        ("modes do not turn", "R @ self.modes[:3], R @", "self.modes[:3], R @"),
        ("reaction without its arm", "-skew_matrix(arm) @ tilting", "0.0 * tilting"),
        ("tilts that turn stand still", "np.array(tilts) > spin", "np.array(tilts) < spin"),
    ),
    *mutations(
        "multibody/drives/connect_rotors.py",
        "test_geared_rotors.py::test_axes_and_senses_change_nothing",
        ("second rotor in its own axes", "np.concatenate([x, into @ y])", "np.concatenate([x, y])"),
        ("forces in axes of the second", "own, into @ others", "own, others"),
    ),
    *mutations(
        "multibody/drives/add_drive.py",
        "test_drives.py::test_axes_change_nothing "
        "test_drives.py::test_energy_is_what_the_drives_give",
        ("spin counted as the node does", "return -sign * law(sign * v, t)", "return -law(v, t)"),
        ("torque brakes", "0.0, -law(omega[2], t)]", "0.0, law(omega[2], t)]"),
        ("power without the speed", "[torque, torque * speed]", "[torque, torque]"),
        ("sensor counts as the node does", "speed = sign * float(", "speed = float("),
    ),
]
