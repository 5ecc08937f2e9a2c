"""Damping dropped, or with the wrong sign, in all that takes energy in a scene."""

from itertools import chain

from validation.mutations.mutation import mutations

_BALANCE = "test_element_energy.py::test_balance_errs_by_the_square_of_the_step"
_SHAKEN = "test_element_energy.py::test_a_shaken_block_and_its_mounts"
_CONNECTORS = "multibody/supports/support_connectors.py"
_OF_KINDS = (
    (
        "linear",
        _CONNECTORS,
        ("dampers dropped", "_sum(_times(K, u), _times(D, v))", "_times(K, u)"),
        ("dampers of tilts dropped", "_times(D, _tilt", "_times(0.0 * D, _tilt"),
        ("moments across drive the spin", "about + b * angles[0] - a * angles[1]", "about"),
        ("native rates taken for those of tilts", "- 2.0 * omega[2] * tilt[1]", ""),
    ),
    (
        "tilt-springs",
        _CONNECTORS,
        (
            "uneven springs drive the spin",
            "if not np.any(D) and np.array_equal(K[:2, :2], K[0, 0] * np.eye(2)):",
            "if not np.any(D):",
        ),
    ),
    (
        "table",
        _CONNECTORS,
        (
            "moments of a table drive the spin",
            "moment[2] += moment[1]",
            "moment[2] += 0.0 * moment[1]",
        ),
        ("damper of a table drives", "into @ (K @ x + D @ x_t)", "into @ (K @ x - D @ x_t)"),
    ),
    (
        "rotor-frame",
        _CONNECTORS,
        ("damper in the rotor stands still", "x_t -= speed * np", "x_t -= 0.0 * speed * np"),
    ),
    (
        "seal",
        "bearings/annular_seal.py",
        (
            "damping halved",
            "return stiffness, d * np.eye(2)",
            "return stiffness, 0.5 * d * np.eye(2)",
        ),
    ),
    (
        "short-film",
        "bearings/short_journal.py",
        ("shear without the eccentricity", "/ sqrt(1.0 - ratio**2)", ""),
        ("pressure takes nothing from the spin", "- 0.5 * (x * fy", "- 0.0 * (x * fy"),
    ),
    (
        "squeeze-film",
        "bearings/short_film.py",
        ("squeeze along n1 dropped", "a, b = vx + 0.5 *", "a, b = 0.0 * vx + 0.5 *"),
    ),
    (
        "finite-film",
        "bearings/film/reynolds.py",
        ("squeeze dropped", "(gain + growth)", "(gain + 0.0 * growth)"),
    ),
    (
        "pads",
        "multibody/supports/tilting_pads.py",
        ("pads tilt the other way", "= -radius * seat", "= radius * seat"),
        (
            "inertia of pads doubled",
            "bearing.pad_inertia * np.eye",
            "2.0 * bearing.pad_inertia * np.eye",
        ),
    ),
    (
        "stop",
        "bearings/clearance_stop.py",
        ("damping dropped", "self.damping * approach", "0.0 * approach"),
        ("spin does not feel friction", "-self.radius * drag", "0.0 * drag"),
    ),
    (
        "balls",
        "bearings/rolling.py",
        ("damper across dropped", "-py - d * vy", "-py"),
        ("contacts turn the cage alone", "self.cage_ratio * (x * py", "0.0 * (x * py"),
    ),
    (
        "magnets",
        "bearings/pid_controller.py",
        ("derivative reversed", "[0.0, P / w_a - D]", "[0.0, P / w_a + D]"),
    ),
    (
        "magnets",
        "bearings/actuator.py",
        (
            "magnets hold by their gap",
            "self.force_current * current + self",
            "self.force_current * current - self",
        ),
    ),
)
ENERGY = [
    *chain.from_iterable(
        mutations(file, f"{_BALANCE}[{kind}]", *changes) for kind, file, *changes in _OF_KINDS
    ),
    *mutations(
        "foundations/foundation.py",
        _SHAKEN,
        ("mounts without damping", "D + U.T @ mount.damping @ U", "D"),
    ),
    *mutations(
        "multibody/supports/foundation_body.py",
        _SHAKEN,
        ("foundation drives", "dampingMatrix=placed.damping", "dampingMatrix=-placed.damping"),
        ("ground does not shake it", "if S is None else S,", "if S is None else 0.0 * S,"),
    ),
    *mutations(
        "multibody/solver_settings.py",
        "test_scaled_scenes.py",
        ("small rotors iterate as large ones", "*= min(1.0, mass * length)", "*= 1.0"),
    ),
    *mutations(
        "multibody/solver_settings.py",
        "test_far_scenes.py",
        ("iterated below rounding", "newton.absoluteTolerance, _rounding(body)", "0.0, 1e-12"),
        ("rounding at the origin alone", "place.position + place.rotation @ end", "end"),
        ("rounding of tilts left out", "max(far * across, about)", "far * across"),
    ),
    *mutations(
        "multibody/supports/turning_base.py",
        "test_friction_on_bases.py",
        ("a turning bore leaves the spin", "angle, speed - w)", "angle, speed)"),
        ("journal moves by minus the bore", "vx + w * y", "vx - w * y"),
    ),
    *mutations(
        "multibody/supports/turning_base.py",
        "test_inter_shaft.py",
        ("casings stand still for a prescribed spin", "!= _LINEAR", "== _LINEAR"),
        ("elements stay with the ground", "angle - turn, speed - w", "angle, speed - w"),
        ("a bore on a rotor leaves the spin", "turn, speed - w", "turn, speed"),
        ("journal moves by minus the rotor's bore", "w * y + vx", "vx - w * y"),
        ("forces turn back with the bore", "c * fx - s * fy", "c * fx + s * fy"),
        ("rotors of opposite axes turn alike", "(sense * value for", "(value for"),
    ),
    *mutations(
        "multibody/supports/support_connectors.py",
        "test_inter_shaft.py",
        ("voids begin on a bore at rest", "seen is None else seen(motion)[1]", "True else ()"),
        ("tables over the own speed alone", "speed - against(mbs)", "speed"),
        ("tables between opposite axes", "sense * rotor.spin", "rotor.spin"),
    ),
    *mutations(
        "multibody/supports/turning_base.py",
        "test_uneven_films.py",
        ("forces tilt twice with the base", "(loads @ turn)", "(loads @ turn.T)"),
        ("forces tilt with the base", "(loads @ turn).r", "loads.r"),
    ),
    *mutations(
        "bearings/tilting_pad.py",
        "test_tilting_pad.py",
        ("mass of pads as a spring", "- mass * whirl**2", "+ mass * whirl**2"),
        ("critical speeds of slow pads", "self.whirl_ratio * abs(speed), mass", "0.0, mass"),
    ),
    *mutations(
        "multibody/supports/tilting_pads.py",
        "test_friction_on_bases.py",
        ("pads brake by the ground", "turns = body.form", "turns = False and body.form"),
    ),
    *mutations(
        "multibody/supports/base_motion.py",
        _SHAKEN,
        ("ground held at its samples", "a + share * (b - a)", "a"),
    ),
    *mutations(
        "drives/gear_mesh.py",
        "test_geared_rotors.py::test_energy_goes_into_drives_springs_and_losses",
        ("mesh without damping", "rate, k * depth + self.damping * rate", "rate, k * depth"),
        ("flanks without damping", "max(0.0, k * depth + self", "max(0.0, k * depth + 0.0 * self"),
    ),
    *mutations(
        "drives/coupling.py",
        "test_couplings.py::test_energy_is_kept_but_for_the_loss[flexible]",
        ("coupling without damping", "self._K * xi + self._D * (B @ x_t)", "self._K * xi"),
    ),
    *mutations(
        "drives/cardan.py",
        "test_couplings.py::test_energy_is_kept_but_for_the_loss[cardan]",
        ("joint without damping", "eta + self.damping * float", "eta + 0.0 * float"),
    ),
    *mutations(
        "drives/drive.py",
        f"{_BALANCE}[linear]",
        ("linear drag halved", "self.linear * speed", "0.5 * self.linear * speed"),
    ),
    *mutations(
        "theory/kernel.py",
        "test_energy_balance.py::test_run_up_by_a_torque",
        ("material without damping", "= inv.K, inv.D", "= inv.K, 0.0 * inv.D"),
    ),
    *mutations(
        "theory/full_motion.py",
        "test_full_bodies.py::test_a_swinging_rotor_without_torque_keeps_energy_and_momentum",
        ("material without damping", "stiffness = inv.D, inv.K", "stiffness = 0.0 * inv.D, inv.K"),
    ),
]  # fmt: skip
