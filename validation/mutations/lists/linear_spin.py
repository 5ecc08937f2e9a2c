"""Linear analyses: the free spin of eccentric rotors, and of those with skew principal axes."""

from validation.mutations.mutation import mutations

LINEAR_SPIN = [
    *mutations(
        "linear/models/rotor/spin.py",
        "test_uneven_inertia.py",
        (
            "rest of a free spin orthogonal to the rotation about the axis",
            "motion, momentum = rotations.mean",
            "motion, momentum = rotations.about_axis",
        ),
        ("Coriolis torque of rigid motions reversed", "whirling = -MR @", "whirling = MR @"),
        ("free spin by its tilt moves supports", "np.r_[-u[:5], 0.0]", "np.r_[-u[:3], 0, 0, 0]"),
        (
            "mean rotation of a solid rotor about a principal axis",
            "np.linalg.pinv(inertia, rcond=_NO_INERTIA, hermitian=True)[:, 0]",
            "np.linalg.pinv(inertia * np.eye(3), rcond=_NO_INERTIA)[:, 0]",
        ),
    ),
    *mutations(
        "linear/models/scene/mean_inertia.py",
        "test_uneven_inertia.py",
        ("tilts about the other side of the axis", "motion[:3] += skew(", "motion[:3] -= skew("),
        ("tilts about the centre of mass", "motion[:3] += skew(", "motion[:3] += 0.0 * skew("),
        ("rigid motions whirl by 2Ω", "@ [1.0, 1.0j]", "@ [1.0, -1.0j]"),
        ("translations by the Coriolis force reversed", "2.0j * T1 - T)", "-2.0j * T1 - T)"),
        ("modes by the Coriolis force reversed", "(T1 + 1.0j * T) +", "(T1 - 1.0j * T) +"),
    ),
    *mutations(
        "linear/models/scene/steady_motion.py",
        "test_uneven_inertia.py",
        ("mean inertia of a rotor twice", "return found - (self", "return found + (self"),
    ),
    *mutations(
        "linear/models/rotor/eccentricity.py",
        "test_uneven_inertia.py",
        ("a free spin changes tilts twice as much", "0.5 * max(1.0 -", "max(1.0 -"),
    ),
    *mutations(
        "linear/models/whole_space.py",
        "test_uneven_inertia.py",
        ("drive's torque in one coordinate", "        if T is None:\n", "        if True:\n"),
    ),
    *mutations(
        "linear/models/full/full_equations.py",
        "test_uneven_inertia.py",
        (
            "Coriolis torque of rigid motions on a free spin in the residual",
            "force - 2.0 * self.spin.unturned(X)",
            "force + 0.0 * self.spin.unturned(X)",
        ),
    ),
]
