"""A turbine rotor on a flexible steel foundation: modes of the table, and how far the rotor moves.

Two finite-element models, one that turns and one that stands: a shaft with three discs, and a steel
table on six legs, clamped to the floor. The Campbell diagram holds the modes of both. On the
ground the turbine at 50 Hz is 12 Hz above its critical speeds; on the table a mode of the
foundation is 0.7 Hz beside it, and the unbalance that grade G 2.5 allows moves the journals 18
times as far. Component modes hold the static shapes at the bearings; with eight free modes of the
table instead, that mode is at 51.8 Hz.
"""

import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    Foundation,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    craig_bampton_modes,
    critical_speeds,
    linear_model,
    permissible_unbalance,
    plotting,
    unbalance_response,
)

HERTZ, RUNNING = 2.0 * np.pi, 50.0  # rad/s per Hz, Hz
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SEATS = {"left": [0.0, 0.0, -0.9], "right": [0.0, 0.0, 0.9]}

# ------------------------------------------------------------------ the turbine, axis along z
shaft = occ.Cylinder((0, 0, -0.9), occ.Z, 0.07, 1.8)
for z, radius in ((-0.25, 0.28), (0.0, 0.32), (0.25, 0.36)):
    shaft = shaft + occ.Cylinder((0, 0, z - 0.04), occ.Z, radius, 0.08)
shaft.faces.Min(occ.Z).name, shaft.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(shaft).GenerateMesh(maxh=0.3, curvaturesafety=1.0))
rotor = SolidRotor.from_ngsolve(mesh, STEEL, axis="z").center_interfaces()
reduced = rotor.reduce(craig_bampton_modes(rotor, 10, coupling="RBE3"), prestress=False)

# ------------------------------------------------------------------ the table, y upwards
table = occ.Box((-0.45, -0.75, -1.1), (0.45, -0.65, 1.1))
for z in (-0.9, 0.9):
    pedestal = occ.Box((-0.12, -0.65, z - 0.08), (0.12, -0.15, z + 0.08))
    pedestal.faces.Max(occ.Y).name = "left" if z < 0.0 else "right"
    table = table + pedestal
for z in (-1.0, 0.0, 1.0):
    for x in (-0.38, 0.38):
        leg = occ.Box((x - 0.05, -1.75, z - 0.05), (x + 0.05, -0.75, z + 0.05))
        leg.faces.Min(occ.Y).name = "floor"
        table = table + leg
frame = ngsolve.Mesh(occ.OCCGeometry(table).GenerateMesh(maxh=0.6))
structure = SolidRotor.from_ngsolve(frame, STEEL, axis="z").clamped(["floor"])
modes = craig_bampton_modes(structure, 10, coupling="RBE3")
structure = structure.reduce(modes, prestress=False)
foundation = Foundation.from_solid(structure, SEATS).with_damping_ratio(0.01)
print(reduced, foundation, sep="\n")

# ------------------------------------------------------------------ modes of both, over the speed
held = np.diag([2e8, 3e8, 1e8])  # across, upwards, along the axis [N/m]
bearings = [Support(name, held, 1e5 * np.eye(3)) for name in SEATS]
given = {"supports": bearings, "stiffening": "tilt"}
models = {
    "on the ground": linear_model(reduced, **given),
    "on the table": linear_model(reduced, foundation=foundation, **given),
}
diagram = campbell(models["on the table"], HERTZ * np.linspace(0.0, 80.0, 5), modes=9)
names = diagram.whirl[-1]
print(diagram.table())
for where, model in models.items():
    table_speeds = (
        critical_speeds(model, nodal_diameters=[1], max_speed=HERTZ * 120.0).speeds / HERTZ
    )
    print(f"critical speeds {where} up to 120 Hz:", table_speeds[table_speeds < 120.0].round(2))

# ------------------------------------------------------------------ unbalance of grade G 2.5
mass = reduced.invariants.mass
unbalance = Unbalance([0.32, 0.0, 0.0], permissible_unbalance(2.5, mass, HERTZ * RUNNING))
speeds = HERTZ * np.arange(20.0, 66.0, 1.5)
responses = {
    where: unbalance_response(model, speeds, unbalance, own=False, refine=True, accuracy=0.1)
    for where, model in models.items()
}
journal = {w: 1e6 * r.semi_axes("left")[0] for w, r in responses.items()}
at_speed = {
    where: amplitude[np.argmin(np.abs(responses[where].speeds - HERTZ * RUNNING))]
    for where, amplitude in journal.items()
}
for where, amplitude in at_speed.items():
    print(f"journal {where} at {RUNNING:g} Hz: {amplitude:.3g} µm")
pedestal = responses["on the table"]
shaking = 1e3 * pedestal.speeds * pedestal.semi_axes("left (foundation)")[0]
print(f"pedestal at most {shaking.max():.3g} mm/s, while it passes its resonances")

made, (left, right) = plotting.figure(1, 2, size=(11.0, 4.5))
diagram.plot(ax=left)
for where, amplitude in journal.items():
    right.semilogy(responses[where].speeds / HERTZ, amplitude, label=where)
right.axvline(RUNNING, color="0.6", lw=0.8)
right.set_xlabel("spin speed [Hz]")
right.set_ylabel("amplitude of the left journal [µm]")
right.legend()
plotting.save(made, "steel_foundation.png")

ratio = at_speed["on the table"] / at_speed["on the ground"]
assert np.sum(names == "foundation") >= 3
assert abs(table_speeds[4] - 49.3) < 0.3, table_speeds
assert 15.0 < ratio < 20.0, ratio
