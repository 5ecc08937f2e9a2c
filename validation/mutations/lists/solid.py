"""Finite-element model: stress, geometric stiffness, interfaces, masses, rigid motions."""

from validation.mutations.mutation import mutations

SOLID = [
    *mutations(
        "solid/places.py",
        "test_places.py",
        (
            "any distance is a mesh's",
            "if np.all(np.abs(parts) <= lengths[known]) else",
            "if True else",
        ),
        ("no distance is a mesh's", "apart - parts @ axes", "apart"),
    ),
    *mutations(
        "solid/units.py",
        "test_warnings.py::test_warning_fires",
        ("small rotors in mm", "total_mass > USUAL_MASS", "total_mass > LARGEST_MASS"),
    ),
    *mutations(
        "solid/tensor.py",
        "test_strength.py::test_scalars_of_a_stress_with_all_six_components",
        (
            "yz and xz swapped in the tensor",
            "((0, 5, 4), (5, 1, 3), (4, 3, 2))",
            "((0, 5, 3), (5, 1, 4), (3, 4, 2))",
        ),
        ("shear once in von Mises", "3.0 * (yz**2", "1.5 * (yz**2"),
    ),
    *mutations(
        "solid/stress_recovery.py",
        "test_stress_recovery.py",
        (
            "stress of integration points given to corners",
            "corners = np.linalg.inv(_POINTS)",
            "corners = np.eye(4)",
        ),
        ("points elsewhere than their values", "np.eye(4) / np.sqrt(5.0)", "np.eye(4) / 2.0"),
        ("mid nodes without their mean", "(corners[a] + corners[b]) / 2 for", "corners[a] for"),
    ),
    *mutations(
        "solid/stress_recovery.py",
        "test_solid.py::test_stress_of_linear_displacements_is_hookes_law",
        ("shear strain halved", "shear = [second * (", "shear = [0.5 * second * ("),
        (
            "yz and xz swapped",
            "pairs = ((1, 2), (0, 2), (0, 1))",
            "pairs = ((0, 2), (1, 2), (0, 1))",
        ),
        (
            "nodes get the sum of their elements",
            "entries = (1.0 / counts[where]",
            "entries = (1.0 + 0.0 * counts[where]",
        ),
    ),
    *mutations(
        "solid/elements.py",
        "test_prestress.py::test_nodal_stress_gives_the_matrix_of_its_displacement "
        "test_prestress.py::test_both_parts_are_the_derivative_of_the_tangent",
        (
            "normal stress without 2μ",
            "return 2 * second * strain + first",
            "return second * strain + first",
        ),
        (
            "gradient of the static displacement transposed",
            "ngs.Sym(static.trans * v)",
            "ngs.Sym(static * v)",
        ),
    ),
    *mutations(
        "solid/interface.py",
        "test_solid.py::test_mean_motion_is_exact_for_a_rigid_motion "
        "test_solid.py::test_interfaces_are_centred_on_the_axis",
        (
            "mean motion not referred to the reference point",
            "shift = shift - skew(self.reference - self.center) @ turn",
            "shift = shift + skew(self.reference - self.center) @ turn",
        ),
        (
            "unequal areas taken as equal",
            "center = checks.read_only(weights @ positions)",
            "center = checks.read_only(np.mean(positions, axis=0))",
        ),
    ),
    *mutations(
        "solid/point_mass.py",
        "test_solid.py::test_a_point_mass_moves_the_centre_of_mass "
        "test_solid.py::test_mass_can_be_taken_away_only_while_the_matrix_stays_positive_definite",
        ("point mass in one direction only", "np.full(3, mass)", "mass * np.eye(3)[0]"),
        (
            "more mass taken away than there is",
            "available = 1.0 / spsolve(scalar, unit)[node]",
            "available = 2.0 / spsolve(scalar, unit)[node]",
        ),
    ),
    *mutations(
        "solid/rigid.py",
        "test_solid.py::test_an_assembled_rotor_is_free "
        "test_solid.py::test_springs_at_one_node_hold_the_three_translations "
        "test_solid.py::test_springs_on_both_ends_hold_all_motions",
        (
            "rotations about the mesh origin, unscaled",
            "rotations(nodes, center) / radius",
            "rotations(nodes, 0.0 * center)[:, :2] / radius",
        ),
    ),
    *mutations(
        "solid/damping.py",
        "test_solid_damping.py",
        (
            "rigid motions damped, too",
            "flexible.T @ (rotor.mass_damping @ flexible)",
            "rotor.mass_damping.toarray()",
        ),
        (
            "factors of one material act on all",
            "by_name.get(region, none)",
            "by_name.get(region, [*by_name.values()][0])",
        ),
    ),
    *mutations(
        "solid/section.py",
        "test_sections.py::test_interface_at_takes_the_outer_surface_of_a_band",
        ("bores belong to the surface", "result[part] = distance <=", "result[part] = distance >="),
        (
            "a band of twice the width",
            "low, high = position - 0.5 * width",
            "low, high = position - width",
        ),
        ("faces across the axis count", "_RADIAL = 0.7", "_RADIAL = 2.0"),
    ),
    *mutations(
        "solid/rigid_disc.py",
        "test_sections.py::test_disc_adds_its_mass_and_moments",
        (
            "moments of inertia for second moments",
            "return 0.5 * np.trace(self.inertia) * np.eye(3) - self.inertia",
            "return np.trace(self.inertia) * np.eye(3) - self.inertia",
        ),
        ("mass twice", "scalar = self.mass *", "scalar = 2.0 * self.mass *"),
    ),
    *mutations(
        "solid/rigid_disc.py",
        "test_sections.py::test_disc_whirls_as_a_meshed_stiff_one",
        ("a soft section", "_STIFF = 1e2", "_STIFF = 1e-2"),
        (
            "polar and transverse moments swapped",
            "polar, transverse = values",
            "transverse, polar = values",
        ),
    ),
    *mutations(
        "solid/clamp.py",
        "test_sections.py::test_clamps_hold_the_named_directions "
        "test_sections.py::test_waves_in_a_bar_held_in_one_direction",
        (
            "radial and tangential swapped",
            "np.stack([radial, np.cross(along, radial), along]",
            "np.stack([np.cross(along, radial), radial, along]",
        ),
    ),
    *mutations(
        "solid/rotor.py",
        "test_sections.py::test_waves_in_a_bar_held_in_one_direction",
        (
            "held directions keep their springs to others",
            "free @ self.stiffness @ free + spring",
            "self.stiffness + 1e-12 * spring",
        ),
    ),
]
