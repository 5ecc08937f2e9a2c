"""Terms of the spin, equations of motion, invariants, stiffening, axis and kernel."""

from validation.mutations.mutation import mutations

THEORY = [
    *mutations(
        "theory/spin_terms.py",
        "test_motion.py",
        ("Coriolis forces halved", "return 2.0 * speed * self.G", "return speed * self.G"),
        ("spin softening as stiffening", "centrifugal = -(speed**2)", "centrifugal = speed**2"),
        (
            "stiffening of the Euler field dropped",
            "W=invariants.G + second",
            "W=invariants.G + 0.0 * second",
        ),
        ("Euler load forwards", "- acceleration * self.g", "+ acceleration * self.g"),
    ),
    *mutations(
        "theory/motion.py",
        "test_motion.py",
        (
            "Coriolis torque halved",
            "coriolis = 2.0 * now.omega * (self",
            "coriolis = now.omega * (self",
        ),
        (
            "centrifugal force of the frame reversed",
            "now.omega**2 * (self._e @ unbalance)",
            "-(now.omega**2) * (self._e @ unbalance)",
        ),
        (
            "h once in the moment of inertia",
            "(self.spin_terms.h + self._centrifugal(zeta)) @ zeta",
            "self._centrifugal(zeta) @ zeta",
        ),
        ("gravity turned with the rotor", "rotation.T @ acceleration", "rotation @ acceleration"),
        (
            "frame acceleration with the sign of gravity",
            "acceleration = acceleration - np.asarray(",
            "acceleration = acceleration + np.asarray(",
        ),
        (
            "static unbalance left out of the drive torque",
            "torque -= self._unbalance(now.zeta) @ now",
            "torque -= 0.0 * self._unbalance(now.zeta) @ now",
        ),
    ),
    *mutations(
        "theory/invariants.py",
        "test_invariants.py::test_moved_equals_recomputed "
        "test_invariants.py::test_contracted_matrices_of_exudyn",
        ("parallel axis term dropped", "cross.T + self.mass * np.outer(shift, shift)", "cross.T"),
        (
            "g with the sign of the other sense of spin",
            'np.einsum("ba,abk->k"',
            'np.einsum("ab,abk->k"',
        ),
    ),
    *mutations(
        "theory/stiffening.py",
        "test_stiffening.py",
        (
            "centrifugal field inwards",
            "K2=-_work_hessian(split, -e @ e)",
            "K2=-_work_hessian(split, e @ e)",
        ),
        (
            "second moments for the tensor of inertia",
            "np.trace(central.J) * np.eye(3) - central.J",
            "central.J",
        ),
    ),
    *mutations(
        "theory/kernel.py",
        "test_kernel.py::test_kernel_equals_the_plain_equations",
        ("Coriolis torque halved", "torque = -2.0 * omega *", "torque = -omega *"),
        (
            "Euler force forwards",
            "self._modal_force -= acceleration * self.spin_coupling",
            "self._modal_force += acceleration * self.spin_coupling",
        ),
        (
            "gravity turned the wrong way",
            "np.eye(3) - along, -skew(e)]",
            "np.eye(3) - along, skew(e)]",
        ),
    ),
    *mutations(
        "theory/axis.py",
        "test_appendix_b.py test_motion.py",
        ("rotation the other way round", "np.sin(angle) * self.skew", "np.sin(-angle) * self.skew"),
    ),
    *mutations(
        "theory/formulation.py",
        "test_formulation.py::test_run_up_has_the_rates_that_it_says",
        (
            "angle of a run-up off by its rounded start",
            "0.5 * s**2 + (math.cos",
            "0.5 * s**2 - (math.cos",
        ),
    ),
]
