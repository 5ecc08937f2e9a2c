"""Terms of the spin, equations of motion, invariants, stiffening, axis and kernel."""

from validation.mutations.mutation import mutations

THEORY = [
    *mutations(
        "theory/energy.py",
        "test_energy.py",
        ("Coriolis part of the energy reversed", "+ omega * (terms.g", "- omega * (terms.g"),
        ("eccentric motion with the frame dropped", "+ omega * unbalance)", ")"),
        ("deflection has no weight", "+ A @ (inv.S @ zeta)", ""),
        ("frozen spin ignored", "if form.has_frozen_spin else zeta", "if False else zeta"),
    ),
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
        (
            "stiffness of a static displacement reversed",
            "centrifugal + speed**4 * self.K4",
            "centrifugal - speed**4 * self.K4",
        ),
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
        (
            "static displacement: torque reversed",
            "force[self._spin] += now.omega**3",
            "force[self._spin] -= now.omega**3",
        ),
        (
            "static displacement: torque left out of the drive",
            "torque -= now.omega**3 *",
            "torque -= 0.0 *",
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
    ),
    *mutations(
        "theory/invariants.py",
        "test_stiffening.py",
        (
            "second moments for the tensor of inertia",
            "np.trace(central.J) * np.eye(3) - central.J",
            "central.J",
        ),
    ),
    *mutations(
        "theory/motion.py",
        "test_frozen_spin.py::test_energy_is_conserved",
        (
            "frozen spin with the whole Coriolis torque",
            "-0.5 * coriolis if frozen",
            "-coriolis if frozen",
        ),
        (
            "frozen spin with the torque the wrong way",
            "= -0.5 * coriolis if frozen",
            "= 0.5 * coriolis if frozen",
        ),
    ),
    *mutations(
        "advice/run_measures.py",
        "test_frozen_spin.py::test_the_share_is_that_of_the_momentum",
        ("frozen spin's share without W", "left += np.einsum", "left += 0.0 * np.einsum"),
    ),
    *mutations(
        "theory/kernel.py",
        "test_kernel.py::test_kernel_equals_the_plain_equations",
        ("Coriolis torque halved", "torque = -self._share * omega", "torque = -omega"),
        ("Euler force forwards", "factors[1] = -spin", "factors[1] = spin"),
        ("static displacement: force reversed", "-= factors[0] ** 2 *", "+= factors[0] ** 2 *"),
        ("static displacement: torque reversed", "torque += omega**3", "torque -= omega**3"),
        ("gravity turned the wrong way", '"rb,abv,ca->rcv"', '"rb,bav,ca->rcv"'),
        (
            "deflection's centrifugal force on the frame reversed",
            "np.hstack([-e @ S1, -e @ u])",
            "np.hstack([e @ S1, -e @ u])",
        ),
        (
            "unbalance's centrifugal force on the frame reversed",
            "np.hstack([-e @ S1, -e @ u])",
            "np.hstack([-e @ S1, e @ u])",
        ),
        ("Euler force of the unbalance reversed", "np.hstack([S1, u])", "np.hstack([S1, -u])"),
        (
            "Coriolis force on the frame halved",
            "coriolis.append(2.0 * S1)",
            "coriolis.append(S1)",
        ),
        (
            "torque of the Euler field's second order reversed",
            "torque -= self._rate.dot(self._euler_torque)",
            "torque += self._rate.dot(self._euler_torque)",
        ),
        (
            "coupling of translation and modes reversed",
            "parts[-1][:] = self._turning",
            "parts[-1][:] = -self._turning",
        ),
        (
            "coupling of translation and spin with the Euler row of the modes",
            "self._unbalance = self._products[1, count",
            "self._unbalance = self._products[0, count",
        ),
        (
            "modes' Jacobian, Euler term reversed",
            "(-factor_q * squared, -factor_q * euler,",
            "(-factor_q * squared, factor_q * euler,",
        ),
        (
            "modes' Jacobian by the spin speed, Coriolis term reversed",
            "factor_v * (self._products[2, : self._count] - 2.0",
            "factor_v * (-self._products[2, : self._count] - 2.0",
        ),
        (
            "spin's Jacobian, Coriolis torque by the deflection reversed",
            "row = (share * omega * factor_q)",
            "row = (-share * omega * factor_q)",
        ),
        ("spin's Jacobian by its speed reversed", "corner = share", "corner = -share"),
        ("angle's slope of gravity reversed", "(0.0, -sine, cosine)", "(0.0, sine, -cosine)"),
        (
            "spin's Jacobian, weight of the deflection reversed",
            "row -= factor_q * turning",
            "row += factor_q * turning",
        ),
        (
            "frame's Jacobian, Coriolis term reversed",
            "by_zeta += (factor_v * omega)",
            "by_zeta -= (factor_v * omega)",
        ),
        (
            "frame's Jacobian, Euler term reversed",
            "by_zeta -= (factor_q * euler)",
            "by_zeta += (factor_q * euler)",
        ),
        (
            "frame's Jacobian by the angle reversed",
            "factor_v * by_rate - factor_q * by_angle",
            "factor_v * by_rate + factor_q * by_angle",
        ),
        (
            "frame's Jacobian by the spin speed, centrifugal term reversed",
            "by_rate = products[2] - 2.0",
            "by_rate = products[2] + 2.0",
        ),
    ),
    *mutations(
        "theory/kernel.py",
        "test_kernel.py::test_kernel_knows_what_it_has_evaluated",
        (
            "products of an earlier time kept",
            "if q == self._last and t == self._time:",
            "if q == self._last:",
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
