"""Drives, couplings and gears: their laws."""

from validation.mutations.mutation import mutations

_BOOK = "test_gear_mesh.py::test_forces_are_those_of_a_gear_book"
_ENERGY = "test_gear_mesh.py::test_forces_are_what_energy_and_loss_say"
DRIVES = [
    *mutations(
        "drives/gear_mesh.py",
        _BOOK,
        ("gears pulled together", "+ sin(alpha) * radial", "- sin(alpha) * radial"),
        ("thrust reversed", "normal - flank * sin(base_helix)", "normal + flank * sin(base_helix)"),
        (
            "helix of the pitch circle",
            "tan(self.helix_angle) * cos(alpha)",
            "tan(self.helix_angle)",
        ),
        ("base circle for pitch circle", "normal) / cos(alpha)", "normal)"),
        ("gears turn in the same sense", "second * lever]", "-second * lever]"),
    ),
    *mutations(
        "drives/gear_mesh.py",
        "test_gear_mesh.py::test_flanks_only_push_and_part_in_the_backlash",
        ("whole backlash on each side", "- 0.5 * self.backlash", "- self.backlash"),
        ("damping pulls", "max(0.0, k * depth", "max(-1e9, k * depth"),
    ),
    *mutations(
        "drives/gear_mesh.py",
        _ENERGY,
        ("varying stiffness does work", "-= 0.5 * slope * depth**2", "+= 0.5 * slope * depth**2"),
        ("loss of flanks that let go", "(push - k * depth) * rate", "push * rate"),
    ),
    *mutations(
        "drives/gear_mesh.py",
        "test_gear_mesh.py::test_stiffness_follows_the_teeth",
        ("teeth of no influence", "orders = self.teeth[0] * np", "orders = 1.0 * np"),
    ),
]
