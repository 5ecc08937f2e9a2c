"""Campbell diagrams in both frames, critical speeds, and few modes against many.

First a point mass whose frequencies everyone knows, beside what Exudyn's own
``FEMinterface.ComputeCampbellDiagram`` gives for it; then a disc on a shaft in two bearings.
"""

import exudyn.FEM
import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    SolidRotor,
    Support,
    campbell,
    craig_bampton_modes,
    critical_speed_map,
    critical_speeds,
    plotting,
)

HERTZ = 2.0 * np.pi

# ------------------------------------------------------------------ a mass on springs of 100 Hz
point = SolidRotor.from_matrices(
    np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"mass": [0]}
)
springs = (HERTZ * 100.0) ** 2 * np.eye(3)
given = {"supports": [Support("mass", springs)], "frame": "rotor"}
result = campbell(point, HERTZ * np.array([0.0, 50.0]), **given)
print(result.table())
assert np.allclose(result.frequencies_rotor[1] / HERTZ, [50, 100, 150], rtol=1e-12)
assert np.allclose(result.frequencies_inertial / HERTZ, 100.0, rtol=1e-12)

fem = exudyn.FEM.FEMinterface()
fem.nodes = {"Position": np.zeros((1, 3))}
fem.massMatrix = np.array([[i, i, 1.0] for i in range(3)])  # sparse: row, column, value
fem.stiffnessMatrix = np.array([[i, i, (HERTZ * 100.0) ** 2] for i in range(3)])
for corotational, exact in ((True, "50, 100, 150"), (False, "100, 100, 100")):
    _, found = fem.ComputeCampbellDiagram(
        50.0, 5, frequencySteps=1, useCorotationalFrame=corotational
    )
    shown = ", ".join(f"{f:.1f}" for f in found[-1])
    print(f"Exudyn at 50 Hz, useCorotationalFrame={corotational}: {shown} Hz, exact: {exact} Hz")

# ------------------------------------------------------------------ a disc on a shaft
shaft = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, 0.02, 0.5)
solid = shaft + occ.Cylinder(occ.Pnt(0, 0, 0.35), occ.Z, 0.15, 0.03)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.08, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
held = np.diag([2e7, 2e7, 1e7])  # across, across, along the axis [N/m]
bearings = [Support("left", held, 500.0), Support("right", 2e7, 500.0)]
uneven = [Support(b.interface, np.diag([2e7, 0.5e7]), 500.0) for b in bearings]

speeds = HERTZ * np.linspace(0.0, 400.0, 41)
reduced = rotor.reduce(craig_bampton_modes(rotor, 20, coupling="RBE3"))
even_diagram = campbell(reduced, speeds, supports=bearings)
uneven_diagram = campbell(reduced, speeds[::4], supports=uneven, modes=8)
critical = critical_speeds(reduced, supports=bearings, max_speed=HERTZ * 500.0)
print(critical.table())

made, axes = plotting.figure(1, 2, size=(12.0, 4.8))
for ax, frame in zip(axes, ("inertial", "rotor"), strict=True):
    even_diagram.plot(ax, frame)
    ax.set_ylim(0.0, 800.0)
plotting.save(made, "campbell_diagram.png")
ax = uneven_diagram.plot()
ax.set_ylim(0.0, 500.0)
plotting.save(ax, "campbell_uneven_bearings.png")
stiffnesses = np.geomspace(1e5, 1e10, 16)
found = critical_speed_map(reduced, ["left", "right"], stiffnesses, max_speed=HERTZ * 1500.0)
plotting.save(found.plot(), "critical_speed_map.png")

# ------------------------------------------------------------------ few modes against many
few_speeds = HERTZ * np.array([0.0, 100.0, 200.0])
full = campbell(
    rotor.reduce(craig_bampton_modes(rotor, 40, coupling="RBE3")),
    few_speeds,
    supports=bearings,
    modes=8,
    accuracy=None,
)
print("\nlargest deviation of the inertial frequencies from those of 40 Craig–Bampton modes")
print("flexible modes   " + "".join(f"mode {j + 1:<6d}" for j in range(1, 8)))
deviations = []
for count in (4, 10, 20, 41):
    given = {"supports": bearings, "modes": 8, "accuracy": None}  # the error is known here
    approximate = campbell(rotor.reduce(count), few_speeds, **given)
    ratio = approximate.frequencies_inertial[:, 1:] / full.frequencies_inertial[:, 1:]
    deviations.append(np.abs(ratio - 1.0).max(axis=0))
    print(f"{count:14d}   " + "".join(f"{d:<11.1e}" for d in deviations[-1]))
assert np.all(deviations[-1] < deviations[0])
assert deviations[-1][:4].max() < 0.01
