"""Component modes, orthonormal bases, selection for a formulation, truncation."""

from validation.mutations.mutation import mutations

REDUCTION = [
    *mutations(
        "reduction/mode_pairs.py",
        "test_mode_pairs.py",
        ("pairs by their frequency alone", "_ALIKE = 0.7", "_ALIKE = 0.0"),
        ("pairs must not differ at all", "_ALIKE = 0.7", "_ALIKE = 0.99999"),
    ),
    *mutations(
        "reduction/inertial_modes.py",
        "test_basis_error.py::test_inertia_forces_along_the_axis_bend_a_blade_across_its_mode",
        ("loads along the axis forgotten", "speed * along]", "0.0 * along]"),
    ),
    *mutations(
        "reduction/inertial_modes.py",
        "test_basis_error.py::test_static_responses_to_inertia_forces_are_complete",
        (
            "gyroscopic loads forgotten",
            "[speed * gyroscopic, speed",
            "[0.0 * gyroscopic, speed",
        ),
        (
            "loads of static modes forgotten",
            "loads.append(forces / frequencies)",
            "loads.append(0.0 * forces)",
        ),
    ),
    *mutations(
        "reduction/reduce.py",
        "test_reduction.py::test_mode_mass_is_the_mass_of_the_modes_alone",
        ("mass of what the rigid motions took", "own + share.T @ share", "own - share.T @ share"),
    ),
    *mutations(
        "reduction/attached.py",
        "test_damping.py::test_factors_add_up_and_reach_the_attachment_modes",
        (
            "attachments without damping",
            "self.rotor.with_damping(**factors)",
            "self.rotor",
        ),
    ),
    *mutations(
        "reduction/spinning.py",
        "test_rotating_blade.py::test_modes_at_speed_of_a_mass_on_a_string_and_oblique_springs",
        (
            "modes at rest for modes at speed",
            "rotor.stiffness + terms.stiffness(speed)",
            "rotor.stiffness + terms.stiffness(0.0)",
        ),
        (
            "Coriolis force of the other sense",
            "forces = terms.G @ modes",
            "forces = terms.G.T @ modes",
        ),
    ),
    *mutations(
        "reduction/mean_axis.py",
        "test_mean_axis.py",
        ("momentum left in the modes", "modes - rigid @ shares", "modes - 0.5 * rigid @ shares"),
        ("missing stiffness reversed", "scaled.T @ matrix @ scaled", "-scaled.T @ matrix @ scaled"),
    ),
    *mutations(
        "reduction/basis.py",
        "test_reduction.py",
        (
            "spin and tilt exchanged",
            "np.column_stack([e, first, second])",
            "np.column_stack([first, e, second])",
        ),
        (
            "modes not orthogonal to the rigid motions",
            "gram_schmidt((self.matrix, self.momenta), modes.matrix",
            "gram_schmidt((self.matrix[:, :0], self.momenta[:, :0]), modes.matrix",
        ),
    ),
    *mutations(
        "reduction/basis.py",
        "test_orthonormal_basis.py",
        ("one pass of Gram and Schmidt", "for _ in range(2):", "for _ in range(1):"),
        ("one pass of Cholesky", "for step in range(2):", "for step in range(1):"),
        (
            "shares of columns that are nearly alike by Cholesky",
            "_EVEN = 1e-5",
            "_EVEN = 1e-9",
        ),
        ("shares in earlier columns with the other sign", "earlier = -self", "earlier = self"),
    ),
    *mutations(
        "reduction/mean_axis.py",
        "test_mean_axis.py::test_what_the_modes_move_exudyns_frame_by",
        (
            "frame moved the wrong way by modes that hold it",
            "return -G[:rigid] @",
            "return G[:rigid] @",
        ),
    ),
    *mutations(
        "reduction/selection.py",
        "test_reduction.py",
        (
            "origin in the centre of mass where the axis is fixed",
            "origin = reduced.axis.project(reduced.center_of_mass)",
            "origin = reduced.center_of_mass",
        ),
        (
            "modes with the rotation that is held",
            "np.outer(held, overlap[touched])",
            "0.0 * np.outer(held, overlap[touched])",
        ),
        (
            "modes without angular momentum about the axis, not without mean rotation",
            "reduced.axis.direction @ reduced.invariants.mean_rotation",
            "reduced.invariants.g",
        ),
    ),
    *mutations(
        "reduction/attachment.py",
        "test_attachment.py",
        (
            "moments alone load the interfaces",
            "one.mean_motion(rotor.node_count).T.toarray()",
            "one.mean_motion(rotor.node_count)[3:].T.toarray()",
        ),
    ),
    *mutations(
        "reduction/craig_bampton.py",
        "test_component_modes.py",
        (
            "static modes pushed the wrong way",
            "static[inner] = -inverse.solve",
            "static[inner] = inverse.solve",
        ),
        (
            "interfaces turn about their centre",
            "rotations(interface.positions, interface.reference)",
            "rotations(interface.positions, 0.0 * interface.reference)",
        ),
    ),
    *mutations(
        "reduction/fields.py",
        "test_full_stiffening.py::test_static_fields_grow_with_the_square_of_the_speed",
        (
            "static stress grows with the speed",
            "by_spin = speed**2 * self.stress",
            "by_spin = speed * self.stress",
        ),
    ),
]
