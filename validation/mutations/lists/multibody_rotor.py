"""The rotor in a scene: frame, locks, equations, markers, sensors, records."""

from validation.mutations.mutation import mutations

_SCENES = "test_body_scenes.py::test_directions_of_mesh_and_scene_change_nothing_else"
_MARKERS = "test_body_native.py::test_position_and_rigid_markers_agree_and_take_loads"

MULTIBODY_ROTOR = [
    *mutations(
        "multibody/rotor/plan.py",
        "test_initial_angle.py::test_rotor_starts_on_its_axis",
        ("rotor turned back", "+ np.sin(angle) * axis.skew", "- np.sin(angle) * axis.skew"),
        ("turned about its centre of mass", "place.translation + turned", "place.translation"),
    ),
    *mutations(
        "multibody/rotor/add_reduced.py",
        "test_initial_angle.py::test_rotor_starts_on_its_axis",
        (
            "translation of bare coordinates",
            "*(motion.free_directions.T @ start.translation)",
            "*(motion.free_directions.T @ (0.0 * start.translation))",
        ),
    ),
    *mutations(
        "multibody/full/add_full.py",
        "test_initial_angle.py::test_rotor_starts_on_its_axis",
        (
            "translation of bare coordinates",
            "*(motion.free_directions.T @ place.translation)",
            "*(motion.free_directions.T @ (0.0 * place.translation))",
        ),
    ),
    *mutations(
        "multibody/rotor/node_markers.py",
        "test_full_bodies.py::test_numbers_of_mesh_nodes_mean_nothing_to_the_marker_body",
        (
            "virtual nodes of a full body taken for those of the mesh",
            "and place.marker_body == number",
            "and place.marker_body != number",
        ),
    ),
    *mutations(
        "multibody/rotor/node_markers.py",
        "test_mean_axis.py::test_force_and_sensor_at_the_node_are_on_exudyns_frame",
        (
            "frame of Exudyn's body taken for the mean axes",
            "columns = columns + held @",
            "columns = columns + 0.0 * held @",
        ),
    ),
    *mutations(
        "multibody/rotor/node_markers.py",
        "test_node_markers.py::test_marker_and_sensors_have_the_mean_rigid_motion",
        ("lever of tilts reversed", "/ inv.mass - skew(arm)", "/ inv.mass + skew(arm)"),
        (
            "translation by the modes left out",
            "inv.S[:, :rigid] / inv.mass",
            "0.0 * inv.S[:, :rigid] / inv.mass",
        ),
        (
            "shift of a local frame without its lever",
            "u = self.motion[:3] - skew(shift)",
            "u = self.motion[:3] - 0.0 * skew(shift)",
        ),
        (
            "shift of a local frame in axes of the flexible body",
            "place.nodes(mbs, rigid, place.axes @ local[:3, 3])",
            "place.nodes(mbs, rigid, local[:3, 3])",
        ),
        (
            "local frame turned the wrong way",
            "turn[:3, :3] = place.axes @",
            "turn[:3, :3] = place.axes.T @",
        ),
    ),
    *mutations(
        "multibody/rotor/frame.py",
        "test_node_markers.py::test_place_of_the_node_changes_nothing_else",
        (
            "frame moved the wrong way to the node",
            "origin - direction * (direction @ origin)",
            "origin + direction * (direction @ origin)",
        ),
    ),
    *mutations(
        "multibody/rotor/marker_body.py",
        "test_run_check.py::test_loads_at_the_node_and_weight_are_felt",
        (
            "weight in the origin of the frame",
            "centerOfMass=frame.points(center)",
            "centerOfMass=0.0 * center",
        ),
    ),
    *mutations(
        "multibody/rotor/connections.py",
        "test_connections.py",
        (
            "coordinates of a node off the centre of mass taken for right",
            "if index < 3 and self.apart:",
            "if index < 3 and not self.apart:",
        ),
        (
            "damping about the axis taken for that of tilts",
            "across @ first @ damping, 2",
            "first @ damping, 2",
        ),
    ),
    *mutations(
        "multibody/rotor/frame.py",
        _SCENES,
        (
            "origin of the mesh not turned",
            "mesh_position + orientation @ origin",
            "mesh_position + origin",
        ),
        (
            "mesh turned the wrong way into the frame",
            "(np.asarray(mesh_points) - self.origin) @ self.B.T",
            "(np.asarray(mesh_points) - self.origin) @ self.B",
        ),
        (
            "modes turned the wrong way into the frame",
            'np.einsum("ab,nbk->nak", self.B',
            'np.einsum("ba,nbk->nak", self.B',
        ),
    ),
    *mutations(
        "multibody/rotor/frame.py",
        "test_spin_angles.py",
        (
            "second angle with the wrong sign of the mesh axis",
            "np.arctan2(sign * e[0], sign * e[1])",
            "np.arctan2(-sign * e[0], sign * e[1])",
        ),
        (
            "first angle counted the wrong way",
            "FIRST, int(np.sign(n[0]))",
            "FIRST, -int(np.sign(n[0]))",
        ),
    ),
    *mutations(
        "multibody/rotor/more_markers.py",
        "test_spin_angles.py",
        (
            "lever of an added marker with the wrong sign",
            "motion[:3] - skew(shift)",
            "motion[:3] + skew(shift)",
        ),
    ),
    *mutations(
        "multibody/rotor/equations.py",
        "test_kernel.py::test_jacobian_for_the_solver_is_the_derivative_of_its_forces",
        (
            "Jacobian with its factors exchanged",
            "t, q, q_t, factor_q, factor_v\n",
            "t, q, q_t, factor_v, factor_q\n",
        ),
    ),
    *mutations(
        "multibody/rotor/equations.py",
        "test_kernel.py::test_mass_matrix_for_the_solver",
        (
            "one triangle of the mass matrix left at its start",
            "one[:], mirrored[:] = values, values[skipped:]",
            "one[:] = values",
        ),
    ),
    *mutations(
        "multibody/rotor/equations.py",
        "test_body_solvers.py::test_solvers_agree",
        (
            "constant matrices without locks",
            "rest), layout.lock_mass),\n        **_constant_items",
            "rest), 0.0 * layout.lock_mass + 1.0),\n        **_constant_items",
        ),
    ),
    *mutations(
        "multibody/rotor/locking.py",
        "test_body_solvers.py::test_constraints_and_servo_give_the_same_prescribed_motion",
        (
            "servo without damping's lead",
            "+ place.lock_damping[index] * motion.rate(t)",
            "+ 0.0 * place.lock_damping[index] * motion.rate(t)",
        ),
    ),
    *mutations(
        "multibody/rotor/locking.py",
        "test_body_solvers.py::test_static_solution_is_the_steady_state_in_the_rotating_frame",
        (
            "spin guide without its start",
            "start, slope = stiffness * motion.angle,",
            "start, slope = 0.0,",
        ),
    ),
    *mutations(
        "multibody/rotor/locking.py",
        _SCENES,
        ("plane constraint along an axis of the scene", "row[0, :3] = normal", "row[0, 2] = 1.0"),
    ),
    *mutations(
        "multibody/rotor/marker_body.py",
        _MARKERS,
        (
            "nodes of a marker turn the wrong way",
            "motion[:3] + np.cross(motion[3:], arm, axisa=0, axisc=0)",
            "motion[:3] - np.cross(motion[3:], arm, axisa=0, axisc=0)",
        ),
    ),
    *mutations(
        "multibody/rotor/marker_body.py",
        f"test_body_native.py::test_gravity_lets_the_rotor_fall {_SCENES}",
        (
            "momentum of the modes in mesh axes",
            "mPhitTPsi=frame.B @ S",
            "mPhitTPsi=frame.B.T @ S",
        ),
    ),
    *mutations(
        "multibody/rotor/record.py",
        "test_measures.py::test_recorded_speed_of_a_free_spin",
        (
            "spin of the first translation's rate",
            "return q_t[:, body.locks.spin if",
            "return q_t[:, 0 if",
        ),
    ),
    *mutations(
        "multibody/rotor/sensors.py",
        "test_body_solvers.py::test_work_of_the_drive_is_change_of_energy_plus_losses",
        (
            "external moment added to the drive",
            "needed - external(t, configuration)",
            "needed + external(t, configuration)",
        ),
        (
            "weight on the deflection forgotten",
            "- _deflected_weight(body, t, q[modes])",
            "- 0.0 * _deflected_weight(body, t, q[modes])",
        ),
    ),
]
