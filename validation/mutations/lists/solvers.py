"""Inertia relief, constrained solutions, eigenvalue iteration, factors."""

from validation.mutations.mutation import mutations

SOLVERS = [
    *mutations(
        "solvers/inertia_relief.py",
        "test_prestress.py::test_displacement_is_in_equilibrium_with_the_balanced_load",
        (
            "load not balanced by inertia",
            "balanced = load - self._momentum @ (self.rigid.T @ load)",
            "balanced = 1.0 * load",
        ),
        (
            "rigid part left in the answer",
            "return displacement - self.rigid @ (self._momentum.T @ displacement)",
            "return displacement",
        ),
        (
            "first coordinates pinned, whichever they are",
            "return order[: rigid.shape[1]]",
            "return np.arange(rigid.shape[1])",
        ),
    ),
    *mutations(
        "solvers/inertia_relief.py",
        "test_component_modes.py::test_modes_of_supported_rotors",
        (
            "stiffest combinations of rigid motions taken as free",
            "(stiffness @ motions))[1][:, :moving]",
            "(stiffness @ motions))[1][:, 6 - moving :]",
        ),
    ),
    *mutations(
        "solvers/constrained.py",
        "test_component_modes.py::test_craig_bampton_spans_that_of_fem_interface",
        (
            "reactions pull the wrong way",
            "@ rigid - self._flexibility @ reaction",
            "@ rigid + self._flexibility @ reaction",
        ),
        (
            "resultant of the load forgotten",
            "self._correction(gap, self._relief.rigid.T @ load)",
            "self._correction(gap, 0.0 * self._relief.rigid.T @ load)",
        ),
    ),
    *mutations(
        "solvers/lanczos.py",
        "test_component_modes.py::test_free_modes_are_those_of_fem_interface "
        "test_component_modes.py::test_direct_and_iterative_modes_agree",
        (
            "lowest modes not left out",
            "wanted = slice(skip, skip + count)",
            "wanted = slice(0, count)",
        ),
        (
            "iteration for a generalised problem without mass",
            "stiffness, count, mass, sigma",
            "stiffness, count, None, sigma",
        ),
    ),
    *mutations(
        "solvers/factor.py",
        "test_component_modes.py::test_free_modes_are_those_of_fem_interface",
        (
            "strictly lower triangle",
            "sp.coo_array(sp.tril(matrix))",
            "sp.coo_array(sp.tril(matrix, -1) + sp.eye_array(*matrix.shape))",
        ),
    ),
]
