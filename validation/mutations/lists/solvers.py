"""Inertia relief, constrained solutions, eigenvalue iteration, factors."""

from validation.mutations.mutation import mutations

SOLVERS = [
    *mutations(
        "solvers/inertia_relief.py",
        "test_prestress.py::test_displacement_is_in_equilibrium_with_the_balanced_load",
        (
            "load not balanced by inertia",
            "return load - self._momentum @ (self.rigid.T @ load)",
            "return 1.0 * load",
        ),
        (
            "rigid part left in the answer",
            "return displacement - self.rigid @ (self._momentum.T @ displacement)",
            "return displacement",
        ),
        (
            "springs at the first coordinates, whichever they are",
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
            "self._correction(self._constraints @ elastic, resultant)",
            "self._correction(self._constraints @ elastic, 0.0 * resultant)",
        ),
    ),
    *mutations(
        "solvers/constrained.py",
        "test_close_interfaces.py::test_static_modes_are_those_of_the_saddle_matrix",
        (
            "rounding of the sum, not of its terms",
            "elastic = np.linalg.norm",
            "elastic = 0.0 * np.linalg.norm",
        ),
        ("rounding of reactions that cancel", "@ np.abs(reaction)", "@ reaction"),
    ),
    *mutations(
        "solvers/lanczos.py",
        "test_lanczos.py",
        (
            "directions of unequal length in a block",
            "(X @ (turn / lengths) for X in (columns, weighted))",
            "(X @ turn for X in (columns, weighted))",
        ),
        (
            "rounding taken for a direction",
            "new = squares > max(_DEPENDENT**2 * np.sum(shares**2), _ALIKE * squares[-1])",
            "new = squares > -1.0",
        ),
        (
            "Ritz vectors of a restart mixed up",
            "array[:, : self._count] @ turn[:, :kept]",
            "array[:, : self._count] @ turn[:, -kept:]",
        ),
        (
            "shares of the first pass forgotten",
            "shares[some] += share",
            "shares[some] = share",
        ),
        (
            "motions that the basis has no part of not looked for",
            "turn[:, values > least]",
            "turn[:, values > 2.0 * values[0]]",
        ),
        (
            "every look from the same vectors",
            "self._others.standard_normal",
            "np.random.default_rng(_SEED + 1).standard_normal",
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
            "iteration for a problem without mass",
            "weighted = _product(self._mass, columns)",
            "weighted = columns",
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
    *mutations(
        "solvers/constrained.py",
        "test_component_modes.py::test_the_mean_motion_of_all_nodes_holds_no_deformation",
        ("flexibility that is rounding", "np.maximum(own, _STIFF", "np.minimum(own, _STIFF"),
    ),
    *mutations(
        "solvers/constrained.py",
        "test_iterative.py::test_craig_bampton_modes_are_those_of_the_factor",
        (
            "reactions left in the load of the cycle",
            "load = load - self._constraints.T @ reaction",
            "load = 1.0 * load",
        ),
    ),
    *mutations(
        "solvers/two_level.py",
        "test_iterative.py::test_cycle_is_symmetric_definite_and_near_the_inverse",
        (
            "no smoothing after the linear elements",
            "+ linear + after[0] + after[1])",
            "+ linear)",
        ),
        (
            "linear elements see the whole load, not the rest",
            "self._restriction @ rest.astype(float)",
            "self._restriction @ load.astype(float)",
        ),
    ),
    *mutations(
        "solvers/two_level.py",
        "test_iterative.py::test_smoothing_is_two_steps_of_chebyshev_iteration",
        (
            "second Chebyshev step forgets the first",
            "return first, again * first + new",
            "return first, 0.0 * first + new",
        ),
        (
            "one stiffness for all directions of a node",
            "blocks[:, row, column] = blocks[:, column, row] = diagonals[column - row][:, row]",
            "blocks[:, row, column] = blocks[:, column, row] = "
            "(row == column) * diagonals[0].max(axis=1)",
        ),
    ),
    *mutations(
        "solvers/conjugate_gradients.py",
        "test_iterative.py::test_static_solutions_are_those_of_the_factor",
        (
            "directions that are not conjugate",
            "step += (work / earlier[open_]) * change[:, open_]",
            "step += 0.3 * (work / earlier[open_]) * change[:, open_]",
        ),
        (
            "stops at three digits",
            "limit = tolerance * sizes[left] + allowed",
            "limit = 1e-3 * sizes[left] + allowed",
        ),
    ),
    *mutations(
        "solvers/davidson.py",
        "test_iterative.py::test_modes_are_those_of_the_factor",
        (
            "orthogonal without the mass",
            "weighted = self._mass @ columns",
            "weighted = 1.0 * columns",
        ),
        (
            "stops at a residual of some per cent",
            "share = min(_RESIDUAL, np.sqrt(tolerance))",
            "share = 0.03",
        ),
        (
            "restarts with another energy",
            "energy = kept.T @ self._energy[: self._count, : self._count] @ kept",
            "energy = self._energy[: kept.shape[1], : kept.shape[1]].copy()",
        ),
    ),
    *mutations(
        "solvers/lanczos.py",
        "test_pardiso.py::test_modes_by_wide_blocks",
        ("bare Ritz vectors", "self.basis @ turn + self._block @ (", "self.basis @ turn + 0.0 * ("),
    ),
    *mutations(
        "solvers/pardiso.py",
        "test_pardiso.py::test_ordering_tells_what_the_factor_takes",
        ("operations in other units", "1e6 * million", "1e3 * million"),
    ),
    *mutations(
        "solvers/choice.py",
        "test_pardiso.py::test_choice_with_pardiso",
        ("operations for nothing", "_PARDISO_PER_OPERATION * ordered.operations +", "0.0 +"),
    ),
    *mutations(
        "solvers/fill.py",
        "test_iterative.py::test_fill_is_estimated",
        ("separators without the earlier ones", "own * (own + 2 * border)", "own * own"),
        ("operations of the separators alone", "own**2 * border + own * border**2", "0 * own"),
    ),
    *mutations(
        "solid/ngsolve_model.py",
        "test_iterative.py::test_linear_elements_hold_linear_displacements",
        (
            "mid nodes on other edges",
            "zip(tetrahedra.T[4:], EDGES",
            "zip(tetrahedra.T[:3:-1], EDGES",
        ),
    ),
]
