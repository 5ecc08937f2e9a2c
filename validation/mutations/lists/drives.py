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
    *mutations(
        "drives/motors.py",
        "test_drives.py::test_start_and_coast_down_in_closed_form",
        ("Kloss without the square", "(slip * slip + most**2)", "(slip + most**2)"),
        (
            "constant torque at all speeds",
            "(forward + corner + (beyond",
            "(corner + corner + 0.0 * (beyond",
        ),
        ("torque that does not fall", "(1.0 - speed / self.no_load_speed)", "(1.0 - 0.0 * speed)"),
    ),
    *mutations(
        "drives/motors.py",
        "test_drives.py::test_torques_backwards_are_those_forwards",
        (
            "backwards forgotten",
            "return 2.0 * sense * self.breakdown_torque",
            "return 2.0 * self.breakdown_torque",
        ),
    ),
    *mutations(
        "drives/drive.py",
        "test_drives.py::test_start_and_coast_down_in_closed_form",
        ("drag drives", "return -(dry + self", "return (dry + self"),
        ("quadratic drag linear", "self.quadratic * speed * square**0.5", "self.quadratic * speed"),
        ("dry friction grows", "(square + self.smooth_speed**2) ** 0.5", "1.0"),
    ),
    *mutations(
        "drives/coupling.py",
        "test_couplings.py::test_loads_of_misalignment "
        "test_couplings.py::test_forces_are_what_energy_and_loss_say",
        ("misalignment reversed", "x[:6] + self._fixed", "x[:6] - self._fixed"),
        (
            "runout stands still",
            "return R.T @ apart - self._turning",
            "return R.T @ (apart - self._turning)",
        ),
        ("no torque by turning axes", "by_motion[:, 5] -= R.T", "by_motion[:, 5] -= 0.0 * R.T"),
        ("loss halved", "return float(rate @ (self._D", "return float(0.5 * rate @ (self._D"),
    ),
    *mutations(
        "drives/cardan.py",
        "test_couplings.py::test_forces_are_what_energy_and_loss_say "
        "test_couplings.py::test_cardan_joint_turns_unevenly "
        "test_couplings.py::test_cardan_joint_bends_its_shafts",
        ("second shaft turns evenly", "atan2((k - 1.0) * s * c", "atan2(0.0 * s * c"),
        ("bending the other way", "axis + q * across / share", "axis - q * across / share"),
        ("work of the turning normal", "by_motion[5] += slope", "by_motion[5] -= slope"),
    ),
    *mutations(
        "drives/cardan.py",
        "test_couplings.py::test_cardan_joint_turns_unevenly",
        (
            "ratio of the other fork",
            "(sin(self.joint_angle) * sin(alpha))",
            "(sin(self.joint_angle) * cos(alpha))",
        ),
    ),
]
