"""Appendix B of the paper: two masses on springs in a rotating, massless cylinder.

Zwölfer, Rasmussen, Santos, "Rotordynamics Local Frame Formulations for 3D Continuum Finite
Elements", SSRN 4830498, Eqs. (116–129) and Fig. 2.
"""

import numpy as np

from exudyn_rotor import SolidRotor, campbell, plotting
from exudyn_rotor.theory.nodal import block_diagonal, tilde, translations

nodes = [[1.0, 0.0, 0.0], [1.75, 0.0, 0.0]]
mass = np.eye(6)
stiffness = 1e4 * np.diag([272.0, 196.0, 100.0, 272.0, 196.0, 100.0])
stiffness[0, 3] = stiffness[3, 0] = -128e4
rotor = SolidRotor.from_matrices(mass, stiffness, nodes, axis="x")

print("x (116):", rotor.nodes.ravel())
print("x̃ (117):\n", tilde(rotor.nodes))
print("e (118):", rotor.axis.direction)
print("ẽ (119):\n", rotor.axis.skew)
print("ẽ_bd (120):\n", block_diagonal(rotor.axis.skew, 2).toarray())
print("N (121):\n", rotor.axis.plane)
print("Φ (128):\n", translations(2))

at_rest, at_300 = campbell(rotor, [0.0, 300.0]).frequencies_rotor
print("ν at rest (125):", at_rest)
print("ν at 300 rad/s (129):", at_300)
assert np.allclose(at_rest, [1000, 1000, 1200, 1400, 1400, 2000], rtol=1e-12)
whirl = [834.497940852066, 1563.206060221641]
expected = [whirl[0], whirl[0], 1200.0, whirl[1], whirl[1], 2000.0]
assert np.allclose(at_300, expected, rtol=1e-12)
assert np.allclose(campbell(rotor.reduce(6), [300.0]).frequencies_rotor[0], expected, rtol=1e-12)

result = campbell(rotor, np.linspace(0.0, 900.0, 91))
made, ax = plotting.figure()
ax.plot(result.speeds, result.frequencies_rotor, color=plotting.COLORS[0])
ax.set_xlabel("spin speed [rad/s]")
ax.set_ylabel("frequency in the rotor frame [rad/s]")
plotting.save(made, "appendix_b.png")
