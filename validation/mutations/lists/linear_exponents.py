"""Checks of exponents that do not see what is wrong."""

from validation.mutations.mutation import mutations

LINEAR_EXPONENTS = [
    *mutations(
        "linear/periodic/remainder.py",
        "test_remainder.py",
        ("exponents that are wrong given", "if not rest.share <= 1.0:", "if False:"),
        ("directions that do not come back after a turn", "-shares[:, None", "shares[:, None"),
        ("rest of the wrong sign", "harmonics[0]), 0.0)", "-harmonics[0]), 0.0)"),
        ("changes of coordinates backwards", "self.values[:, None]\n", "-self.values[:, None]\n"),
    ),
    *mutations(
        "linear/periodic/remainder.py",
        "test_hill.py::test_stiff_dampers_do_not_hide_slow_motions",
        ("motions gone within a turn as Hill finds them", "if frozen.share < rest.share:", "if 0:"),
    ),
    *mutations(
        "linear/periodic/first_bound.py",
        "test_remainder.py",
        (
            "factors of balancing overflow",
            "_LEAST_BALANCED = 1e-16, 1e-24",
            "_LEAST_BALANCED = 1e-16, 0.0",
        ),
    ),
    *mutations(
        "linear/periodic/first_bound.py",
        "test_first_bound.py",
        ("square of a rest left out", "rest = f @ g +", "rest = 0.0 * f @ g +"),
        ("change of exponents left out", "share + float(changed.max())", "share"),
        ("what is left to the rest left out", "g * np.abs(mean) + left", "g * np.abs(mean)"),
        ("change without an inverse", "if not np.all(solved[:, 0] > 0.0):", "if False:"),
        ("conjugates do not act", "swapped[:, :count] = 0.0", "swapped[:] = 0.0"),
        ("rows of conjugates exchanged", "0.5 * (real - 1j * im", "0.5 * (real + 1j * im"),
        (
            "rates of shared motions backwards",
            "= rates * group.speeds +",
            "= -rates * group.speeds +",
        ),
        ("slips of shared motions left out", "seen(slips)", "0.0 * seen(slips)"),
        ("real motions with their factor", "* np.exp(-0.5j", "* np.exp(-0.0j"),
        ("motions without forces", "forced += accelerations(", "forced -= accelerations("),
        (
            "changes between exponents that are one",
            "| (sizes <= ENOUGH * radii)",
            "| (sizes <= 0.0 * radii)",
        ),
    ),
    *mutations(
        "linear/periodic/shared_motions.py",
        "test_uneven_supports.py",
        ("motions given twice as they come", "if inside.size:", "if False:"),
        ("shift of the wrong sign", "(shift * larger - x)", "(shift * larger + x)"),
    ),
    *mutations(
        "linear/periodic/shared_motions.py",
        "test_first_bound.py",
        ("copies brought the other way", "-steps[i])", "steps[i])"),
        ("exponents shared as they come", "apart / told[:, None]", "apart"),
    ),
    *mutations(
        "linear/periodic/first_bound.py",
        "test_first_bound.py::test_singular_states_tell_nothing_and_do_not_warn",
        (
            "infinite products of singular states",
            "np.full_like(P, np.nan)",
            "np.full_like(P, np.inf)",
        ),
    ),
    *mutations(
        "linear/periodic/remainder.py",
        "test_first_bound.py::test_singular_states_tell_nothing_and_do_not_warn",
        ("decay of infinite rests", "if not np.all(np.isfinite(self.F)):", "if False:"),
    ),
    *mutations(
        "linear/periodic/hill.py",
        "test_hill.py",
        ("harmonics left out of a part", "n: basis @ X for n, X", "n: X for n, X"),
    ),
    *mutations(
        "linear/periodic/remainder.py",
        "test_uneven_supports.py",
        (
            "motions that fail the check not chosen again",
            "check(choose(False))",
            "check(choose(True))",
        ),
    ),
]
