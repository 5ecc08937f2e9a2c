"""Static solution at speed, hubs, stress at rest."""

from validation.mutations.mutation import mutations

PRESTRESS = [
    *mutations(
        "prestress/static_solution.py",
        "test_prestress.py::test_displacement_is_in_equilibrium_with_the_balanced_load "
        "test_prestress.py::test_stress_turned_with_a_rotation_is_the_load_turned",
        (
            "centrifugal load along the axis, too",
            "rotor.axis.radial(rotor.nodes).ravel()",
            "(rotor.nodes - rotor.axis.point).ravel()",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_prestress.py::test_initial_displacement_is_added_when_asked_for",
        (
            "initial displacement where it is not asked for",
            "if initial_displacement:",
            "if not initial_displacement:",
        ),
    ),
    *mutations(
        "prestress/estimate.py",
        "test_level_by_default.py::test_estimate_is_near_the_stiffness_of_the_elements",
        ("truss: tension as compression", "sp.csr_array((-tension,", "sp.csr_array((tension,"),
        ("truss: bars not held", "np.where(held > _GROUNDED", "0.0 * np.where(held > _GROUNDED"),
    ),
    *mutations(
        "theory/stiffening.py",
        "test_level_by_default.py",
        (
            "level by default always 'tilt'",
            '"full" if stress_is_known',
            '"tilt" if stress_is_known',
        ),
    ),
    *mutations(
        "solid/elements.py",
        "test_prestress.py::test_turned_static_state_is_not_strained",
        (
            "static gradient transposed in the term of second order",
            "ngs.Sym(static.trans * ngs.Grad(function))",
            "ngs.Sym(static * ngs.Grad(function))",
        ),
    ),
    *mutations(
        "reduction/reduce.py",
        "test_static_displacement.py",
        (
            "static displacement not turned with the rotor",
            "component = _with_turned_displacement(rotor, component)",
            "component = component",
        ),
        (
            "stiffness per fourth power dropped",
            "relief_rotations(rotor), K4)",
            "relief_rotations(rotor))",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_prestress.py::test_stress_of_bending_springs_back",
        (
            "springback added to the stress at rest",
            "return stress - unbalanced",
            "return stress + unbalanced",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_rotating_blade.py::test_euler_stress_of_a_blade_is_that_of_its_load",
        ("Euler load forwards", "return -rotor.mass @ np.cross(", "return rotor.mass @ np.cross("),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_prestress_checks.py::test_hub_gives_no_stiffness_to_rigid_rotations_of_a_disc "
        "test_prestress_checks.py::test_a_disc_turned_with_its_hub_feels_the_load_turned "
        "test_prestress_checks.py::test_hub_acts_as_a_light_and_stiff_one_in_the_mesh",
        (
            "hub: trace term dropped",
            "direct = np.trace(moments) * np.eye(3) - 0.5",
            "direct = -0.5",
        ),
        (
            "hub: mixed term with the other sign",
            "@ turn - mixed - mixed.T",
            "@ turn + mixed + mixed.T",
        ),
        (
            "hub: reactions of the wrong sign",
            "forces = self.stiffness @ displacement - load",
            "forces = load - self.stiffness @ displacement",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_prestress_checks.py::test_rigid_rotations_feel_what_the_level_tilt_gives",
        (
            "hub: net force works on translations",
            "couple = couple - sp.csr_array(skew(forces.sum(axis=0))) @ shift",
            "couple = couple + sp.csr_array(skew(forces.sum(axis=0))) @ shift",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_prestress_import.py",
        (
            "stress at rest plays no part in the load by rotation",
            "self.supported.stiffness + free",
            "self.supported.stiffness + 0.0 * free",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_full_stiffening.py test_stiffening.py",
        (
            "moments of the relief dropped",
            "inertia = turns.T @ (rotor.mass @ turns)",
            "inertia = 2.0 * turns.T @ (rotor.mass @ turns)",
        ),
    ),
    *mutations(
        "prestress/static_solution.py",
        "test_sections.py::test_disc_whirls_as_a_meshed_stiff_one",
        (
            "forces of a rigid disc with the wrong sign",
            "disc.nodes, -(springs @ displacement)",
            "disc.nodes, springs @ displacement",
        ),
    ),
]
