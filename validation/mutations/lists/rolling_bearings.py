"""Rolling bearings, and steady motions on them."""

from validation.mutations.mutation import mutations

ROLLING_BEARINGS = [
    *mutations(
        "bearings/rolling.py",
        "test_cached.py",
        ("kept stiffness may be changed", "return stiffness.copy()", "return stiffness"),
        (
            "first load's stiffness kept",
            "bearing.equilibrium(0.0, load, angle)",
            "bearing.equilibrium(0.0, np.array([500.0, 0.0]), angle)",
        ),
    ),
    *mutations(
        "bearings/rolling.py",
        "test_rolling_bearing.py",
        ("cage as fast as for a turning outer ring", "0.5 * (1.0 - self", "0.5 * (1.0 + self"),
        ("cage drives the ring", "self.cage_ratio * (x * py", "-self.cage_ratio * (x * py"),
        ("elements pull", "np.maximum(x * c + y * s - self.clearance, 0.0)", "x * c + y * s - 0.0"),
        ("tangent without its exponent", "slopes = exponent * bearing", "slopes = bearing"),
    ),
    *mutations(
        "bearings/rolling.py",
        "test_rolling_bearing_response.py",
        ("cage of a grid stands", "turn = bearing.cage_ratio *", "turn = 0.0 *"),
        ("contacts at a grid pull", "force = -(across @", "force = (across @"),
    ),
    *mutations(
        "linear/response/contact_balance.py",
        "test_rolling_bearing_response.py",
        ("spring k₀ left in", "+ springs * q", "+ 0.5 * springs * q"),
        ("a clearance holds", "- H @ mean, -2) > _FREE", "- H @ mean, -2) > -1.0"),
        ("harmonics left out on springs k₀", "- H @ slopes, q)", "- 0.0 * H @ slopes, q)"),
        (
            "uneven rotor answers in another harmonic",
            "index[k, n + p], col",
            "index[k, n - p], col",
        ),
    ),
    *mutations(
        "linear/response/contact_rest.py",
        "test_rolling_bearing_response.py",
        ("constant load of a seat doubled", "(2.0 if k else 1.0) * g", "2.0 * g"),
        ("every load presses", "return bool(moved[:, :2].max() >", "return bool(moved.max() >"),
        ("contacts pull the foundation along", "sign * pair, np.zeros(4)", "pair, np.zeros(4)"),
        ("outer rings move with inner ones", "[sign for _, sign in seat]", "[1.0 for _ in seat]"),
    ),
    *mutations(
        "linear/response/contact_stability.py",
        "test_rolling_stability.py",
        (
            "mean contacts twice",
            "self._of_contacts(passed, theta) - self._mean",
            "self._of_contacts(passed, theta)",
        ),
        ("contacts harden what they hold", "2 * j + 2] = -block", "2 * j + 2] = block"),
        ("bearings of a rotor stand", "else turned", "else still"),
        ("outer rings go with the inner ones", "[sign * (still", "[(still"),
        ("ball pass slower by the spin's change", "2.0 * np.pi * n / period", "2.0 * rest.speed"),
        ("supports of uneven rotors are even", "found += (np.exp", "found += 0.0 * (np.exp"),
    ),
    *mutations(
        "linear/periodic/impulses.py",
        "test_rolling_stability.py",
        ("impulses push away", "return -step * np.c", "return step * np.c"),
        ("dampers drive", "both = -step", "both = step"),
        ("exponent of two periods", "+ log) / period", "+ log) / (2.0 * period)"),
        ("impulse at the end of a step", "steps)) + 0.5)", "steps)) + 1.0)"),
    ),
    *mutations(
        "linear/response/rolling_motion.py",
        "test_rolling_bearing_response.py",
        ("unbalance grows with the speed", "speed**2 * self.unbalance", "speed * self.unbalance"),
        ("small unbalances stay doubled", "arange(6.0, -0.5, -0.5)", "arange(6.0, 0.5, -0.5)"),
        ("sweep goes on with harmonics at rest", "rest.speed == 0.0:", "rest.speed < 0.0:"),
    ),
    *mutations(
        "linear/response/rolling_response.py",
        "test_rolling_bearing_response.py",
        ("weight lifts", "BaseAcceleration(-across)", "BaseAcceleration(across)"),
        ("folded harmonics turn the other way", "a.conj() if turned else a", "a"),
        ("balanced rotors are not strained", "else own * np.array", "else 0.0 * np.array"),
    ),
]
