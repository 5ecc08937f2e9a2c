"""Modules beside the folders: storage, checks, pictures, parameter studies."""

from validation.mutations.mutation import mutations

TOP = [
    *mutations(
        "cached.py",
        "test_threads.py",
        (
            "one lock for a property of all objects",
            "            return instance.__dict__.setdefault",
            "            with __import__('logging')._lock:\n"
            "                return instance.__dict__.setdefault",
        ),
        ("the value not kept", "__dict__.setdefault(", "__dict__.copy().setdefault("),
    ),
    *mutations(
        "cached.py",
        "test_cached.py",
        (
            "results of other objects taken",
            "results.setdefault(each, {})",
            "results.setdefault(known, {})",
        ),
        ("other arguments not looked at", "rest in found", "found"),
        (
            "results never let go",
            "WeakKeyDictionary = WeakKeyDictionary()",
            "WeakKeyDictionary = {}",
        ),
    ),
    *mutations(
        "storage.py",
        "test_results.py::test_arrays_come_back_from_either_memory_order "
        "test_results.py::test_one_changed_value_is_damage",
        ("arrays in Fortran's order read as C's", 'order="F" if fortran else "C"', 'order="C"'),
        (
            "checksum without the values",
            "result.update(np.ascontiguousarray(value)",
            "result.copy().update(np.ascontiguousarray(value)",
        ),
    ),
    *mutations(
        "storage.py",
        "test_export.py::test_a_file_is_replaced_by_a_complete_one_only",
        ("draft left where saving failed", "        draft.unlink(missing_ok=True)", "        pass"),
    ),
    *mutations(
        "html_report.py",
        "test_report.py",
        ("text taken for HTML", '"<p>{escape(item)}</p>"', '"<p>{item}</p>"'),
        ("units of the report forgotten", "return lambda: method(units=units)", "return method"),
        ("usual picture beside one's own", "units, not pictured)", "units, True)"),
    ),
    *mutations(
        "descriptions.py",
        "test_report.py",
        ("transverse moment", "(np.trace(second) + e @", "(np.trace(second) - e @"),
        ("polar moment", "polar = np.trace(second) - e", "polar = np.trace(second) + e"),
    ),
    *mutations(
        "units.py",
        "test_export.py::test_three_thousand_turns_a_minute_are_fifty_hertz",
        ("frequencies in rpm beside speeds", '"rpm": ("rpm", "Hz")', '"rpm": ("rpm", "rpm")'),
    ),
    *mutations(
        "export.py",
        "test_export.py::test_csv_holds_every_number_as_it_is",
        ("first row of a table left out", "zip(*(values.tolist()", "zip(*(values[1:].tolist()"),
    ),
    *mutations(
        "vtk.py",
        "test_pictures.py::test_old_files_for_paraview_have_no_spaces_in_names",
        ("spaces in names of old files", 'if target.suffix == ".vtk":', "if 0:"),
    ),
    *mutations(
        "plotting.py",
        "test_surface.py",
        (
            "body drawn from right to left",
            "(20.0, -75.0, 0.0), (20.0, 15.0, 0.0)",
            "(20.0, 105.0, 0.0), (20.0, 195.0, 0.0)",
        ),
    ),
    *mutations(
        "sweep.py",
        "test_executors.py",
        (
            "last value of a study left out",
            "range(0, len(values), length)",
            "range(0, len(values) - 1, length)",
        ),
    ),
    *mutations(
        "checks/arrays.py",
        "test_checks.py",
        ("mirror taken for a rotation", " or np.linalg.det(result) < 0.0", ""),
        (
            "skew-symmetric taken for symmetric",
            "(result - sign * result.T, result)",
            "(result + sign * result.T, result)",
        ),
        ("a speed twice", "np.any(np.diff(result) <= 0.0)", "np.any(np.diff(result) < 0.0)"),
        ("whole numbers without an upper limit", " | (result > most)]", "]"),
    ),
    *mutations(
        "checks/numbers.py",
        "test_checks.py",
        ("the least number refused", '"≥": operator.ge', '"≥": operator.gt'),
    ),
]
