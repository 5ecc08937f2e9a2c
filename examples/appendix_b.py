"""Appendix B of the paper: two masses on springs in a rotating, massless cylinder.

Zwölfer, Rasmussen, Santos, "Rotordynamics Local Frame Formulations for 3D Continuum Finite
Elements", SSRN 4830498: prints Eqs. (116–129) and draws Fig. 2.
"""

import numpy as np

from exudyn_rotor import SolidRotor, campbell, plotting
from exudyn_rotor.theory.axis import block_diagonal, skew, translations

nodes = [[1.0, 0.0, 0.0], [1.75, 0.0, 0.0]]
mass = np.eye(6)
stiffness = 1e4 * np.diag([272.0, 196.0, 100.0, 272.0, 196.0, 100.0])
stiffness[0, 3] = stiffness[3, 0] = -128e4
rotor = SolidRotor.from_matrices(mass, stiffness, nodes, axis="x")
modes = np.array(  # as printed; twice the same frequency leaves their order open
    [
        [0, 0, 1, 0, 0, -1],
        [0, 0, 0, 0, 1, 0],
        [1, 0, 0, 0, 0, 0],
        [0, 0, 1, 0, 0, 1],
        [0, 0, 0, 1, 0, 0],
        [0, 1, 0, 0, 0, 0],
    ]
)
along = np.kron(np.eye(6), rotor.axis.direction[:, None])
frequencies = [1000.0, 1000.0, 1200.0, 1400.0, 1400.0, 2000.0]
assert np.array_equal(rotor.stiffness @ modes, rotor.mass @ modes * np.square(frequencies))

at_rest, at_300 = campbell(rotor, [0.0, 300.0], frame="rotor").frequencies_rotor
printed = {
    "x (116)": rotor.nodes.ravel(),
    "x̃ (117)": np.vstack([skew(x) for x in rotor.nodes]),
    "e (118)": rotor.axis.direction,
    "ẽ (119)": rotor.axis.skew,
    "ẽ_bd (120)": block_diagonal(rotor.axis.skew, 2).toarray(),
    "N (121)": rotor.axis.plane,
    "M (122)": rotor.mass.toarray(),
    "K (123)": rotor.stiffness.toarray(),
    "Ψ (124)": modes,
    "ν at rest (125)": at_rest,
    "Ψ̃ (126)": sum(np.kron(modes[i::3], skew(e)) for i, e in enumerate(np.eye(3))),
    "(I_ζ ⊗ e)ᵀ (127)": along.T,
    "Φ (128)": translations(2),
    "ν at 300 rad/s (129)": at_300,
}
with np.printoptions(linewidth=120, precision=15, suppress=True):
    for name, value in printed.items():
        # whole numbers as the paper has them, and no −0
        whole = np.array_equal(value, np.round(value))
        print(f"{name}:\n{value.astype(int) if whole else value + 0.0}\n")

assert np.allclose(at_rest, frequencies, rtol=1e-12)
whirl = [834.497940852066, 1563.206060221641]
expected = [whirl[0], whirl[0], 1200.0, whirl[1], whirl[1], 2000.0]
assert np.allclose(at_300, expected, rtol=1e-12)
assert np.allclose(
    campbell(rotor.reduce(6), [300.0], frame="rotor").frequencies_rotor[0], expected, rtol=1e-12
)

result = campbell(rotor, np.linspace(0.0, 900.0, 91), frame="rotor")
made, ax = plotting.figure()
ax.plot(result.speeds, result.frequencies_rotor, color=plotting.COLORS[0])
ax.plot(300.0 * np.ones(6), expected, "o", color=plotting.COLORS[1], label="Eq. (129)")
ax.set_xlabel("rotation speed $\\dot\\vartheta$ [rad/s]")
ax.set_ylabel("angular eigenfrequency $\\nu$ [rad/s]")
ax.legend()
plotting.save(made, "appendix_b.png")
