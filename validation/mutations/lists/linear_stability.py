"""Stability, its limits and maps."""

from validation.mutations.mutation import mutations

LINEAR_STABILITY = [
    *mutations(
        "linear/periodic/fundamental.py",
        "test_near_exponents.py",
        (
            "bound of the tolerance, not of the error",
            "_MORE / 63.0 * np.linalg.norm(change)",
            "tolerance * np.linalg.norm(scaled)",
        ),
        (
            "error of a fundamental matrix left out",
            "_MORE / 63.0 * np.linalg.norm(change)",
            "0.0 * np.linalg.norm(change)",
        ),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_near_exponents.py",
        ("distance of exponents left out", "_OF_DISTANCE * distances", "1e9 * distances"),
    ),
    *mutations(
        "linear/periodic/near_copies.py",
        "test_near_exponents.py",
        (
            "near copies as far out as motions",
            "np.abs(steps) * system.step + outermost",
            "0 * system.step + outermost",
        ),
    ),
    *mutations(
        "linear/stability/sensitivity.py",
        "test_magnetic_bearing.py::test_sensitivity_of_a_spinning_rotor_is_that_of_both_senses",
        ("complementary in place of the sensitivity", "append(1.0 + place", "append(place"),
        ("signal with the wrong sign", "(-one.stiffness[4:, 2:4]", "(one.stiffness[4:, 2:4]"),
    ),
    *mutations(
        "linear/stability/growth_over.py",
        "test_between_samples.py",
        ("kinks of tables are no samples", "return self.table_speeds", "return np.zeros(0)"),
    ),
    *mutations(
        "linear/models/links.py",
        "test_between_samples.py",
        (
            "tables of a train over its own speed alone",
            "self.connection.table_speeds / self.rate",
            "self.connection.table_speeds * self.rate",
        ),
    ),
    *mutations(
        "linear/stability/thresholds.py",
        "test_basis_error.py::test_errors_of_limits_where_modes_meet test_threshold_search.py",
        ("a step over a narrow range", "0.5 * abs(width)", "abs(width) + 1.0"),
        (
            "limits of the other sense are taken",
            "if on == onset]",
            "if on != onset]",
        ),
        (
            "limit of the finer model on the other side",
            "return found[0][0] - value",
            "return value - found[0][0]",
        ),
        (
            "limit of the finer model searched on the wrong side",
            "== onset else 1.0",
            "!= onset else 1.0",
        ),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_threshold_search.py::test_the_limit_of_a_motion_on_uneven_supports_takes_few_solutions",
        ("no other motion grows at a limit", "if self.unstable(beyond):", "if False:"),
    ),
    *mutations(
        "linear/stability/growth.py",
        "test_threshold_search.py::test_the_limit_of_a_motion_on_uneven_supports_takes_few_solutions",
        ("secants away from the limit", "here - excess / rise", "here + excess / rise"),
        ("the most stable motion is followed", "int(np.argmax(growth", "int(np.argmin(growth"),
    ),
    *mutations(
        "linear/stability/stability_map.py",
        "test_basis_error.py::test_errors_of_a_map_of_stability_are_those_of_its_points",
        (
            "error of the most stable motion",
            "value = growth.values[[growth.least_stable]]",
            "value = growth.values[[-1]]",
        ),
    ),
    *mutations(
        "linear/stability/growth.py",
        "test_stability.py test_stability_names.py test_linear_properties.py",
        (
            "least growth for the largest",
            "return float(np.max(excess[moving] if np.any(moving) else excess))",
            "return float(np.min(excess[moving] if np.any(moving) else excess))",
        ),
        (
            "names of folded exponents",
            "names = () if content is None else content.named(modes, system.speed)[1:]",
            "folded = fold(modes.values, abs(system.base))\n"
            "    modes = FloquetModes(folded, modes.vectors, modes.orders, 0.0, modes.bounds)\n"
            "    names = () if content is None else content.named(modes, system.speed)[1:]",
        ),
    ),
    *mutations(
        "linear/periodic/fundamental.py",
        "test_between_samples.py::test_growths_of_a_scan_are_those_of_the_exponents",
        ("commutator of fourth order added", "- np.sqrt(3.0) / 12.0", "+ np.sqrt(3.0) / 12.0"),
    ),
    *mutations(
        "linear/stability/growth_scan.py",
        "test_between_samples.py::test_growths_of_a_scan_are_those_of_the_exponents",
        ("exponential of second order", "X @ X / 12.0", "0.0 * X"),
        ("waves that turn backwards", "*-2.0 * np.sin(turned)", "*2.0 * np.sin(turned)"),
        (
            "damping with the wrong sign",
            "else unit_state_matrix(**at)",
            'else unit_state_matrix(-at["D"], at["K"])',
        ),
        ("growth of a turn", "self.step * self.speeds(values)", "self.speeds(values)"),
    ),
    *mutations(
        "linear/stability/between_samples.py",
        "test_between_samples.py",
        ("peaks are not seen closer", "_NEARER, _TIMES = 8, 2", "_NEARER, _TIMES = 8, 0"),
        (
            "lows of unstable ranges are not seen closer",
            "np.where(growths > 0.0, -growths, growths)",
            "growths",
        ),
        ("ranges known are looked at", "if not known.keys()", "if known.keys()"),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_between_samples.py::test_ranges_between_samples_are_those_of_monodromy_matrices",
        ("no scan between samples", "if GrowthScan.can(systems):", "if False:"),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_stability.py test_stability_names.py",
        (
            "modes that meet are not followed",
            "if gaps[0] * gaps[1] < 0.0 and near:",
            "if gaps[0] * gaps[1] > 0.0 and near:",
        ),
        (
            "no gap between two unstable samples",
            "self._search(low, high, lambda growth, _: growth.excess)",
            "self._search(low, high, lambda growth, _: -growth.excess)",
        ),
    ),
    *mutations(
        "linear/stability/growth.py",
        "test_threshold_search.py",
        (
            "rates of other copies",
            "- 1j * (modes.values - growth.values).imag / speed",
            "- 0.0j * (modes.values - growth.values).imag / speed",
        ),
    ),
    *mutations(
        "linear/stability/threshold_search.py",
        "test_threshold_search.py",
        (
            "a limit without a secant is no number",
            "if np.isnan(root):",
            "if False:",
        ),
    ),
    *mutations(
        "linear/stability/thresholds.py",
        "test_basis_error.py",
        (
            "limit of the full model to the other side",
            "float(-shifts[0].real / slope)",
            "float(shifts[0].real / slope)",
        ),
        (
            "limits where modes meet estimated like others",
            "or meets or slope",
            "or slope",
        ),
    ),
    *mutations(
        "linear/stability/thresholds.py",
        "test_stability.py test_stability_names.py",
        (
            "mode of a threshold from its stable side",
            "place + 1 if onset else place - 1] - value",
            "place - 1 if onset else place + 1] - value",
        ),
        (
            "ranges in the wrong order of their ends",
            "edges = [values[0]] if unstable[0] else []",
            "edges = [values[0]] if not unstable[0] else []",
        ),
    ),
    *mutations(
        "linear/stability/stability.py",
        "test_stability.py",
        (
            "multipliers over half a period",
            "multipliers = np.exp(2.0 * np.pi * exponents / base[:, None])",
            "multipliers = np.exp(np.pi * exponents / base[:, None])",
        ),
    ),
    *mutations(
        "linear/stability/stability_map.py",
        "test_stability.py",
        (
            "parameters exchanged in the map",
            "points = [(a, b) for a in grid[0] for b in grid[1]]",
            "points = [(a, b) for b in grid[1] for a in grid[0]]",
        ),
        (
            "damping taken for growth",
            "return growth.values.real.max(), growth.excess",
            "return -growth.values.real.min(), growth.excess",
        ),
    ),
]
