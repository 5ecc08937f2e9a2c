"""How far do the journals of a rotor move that just meets its balance quality grade?

A disc on a shaft runs on two bearings that are stiffer upwards than sideways. It is balanced to
grade G 6.3 of ISO 21940-11, what is left shared by the two faces of the shaft. On the way up it
passes two critical speeds. Between them it whirls backward, against its own spin, although nothing
but its own unbalance drives it.
"""

import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    HarmonicForce,
    SolidRotor,
    Support,
    Unbalance,
    harmonic_response,
    permissible_unbalance,
    plotting,
    unbalance_response,
)

SIDEWAYS, UPWARDS, DAMPING = 4e5, 8e5, 250.0  # of one bearing [N/m], [N s/m]
GRADE, SERVICE = 6.3, 6000.0 * np.pi / 30.0  # [mm/s], [rad/s]

# a disc on a stiff shaft along z; x (n1) is sideways, y (n2) upwards
shaft = occ.Cylinder(occ.Pnt(0, 0, -0.25), occ.Z, 0.03, 0.5)
solid = shaft + occ.Cylinder(occ.Pnt(0, 0, -0.02), occ.Z, 0.12, 0.04)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces().reduce(21)
mass = rotor.invariants.mass
bearings = [
    Support(name, np.diag([SIDEWAYS, UPWARDS]), DAMPING * np.eye(2)) for name in rotor.interfaces
]

# what the grade permits, half of it at either end
permitted = permissible_unbalance(GRADE, mass, SERVICE)
unbalances = [
    Unbalance.from_grade(name, GRADE, mass, SERVICE, share=0.5) for name in rotor.interfaces
]
speeds = np.linspace(0.0, SERVICE, 211)
response = unbalance_response(rotor, speeds, unbalances, own=False, supports=bearings)

# a stiff rotor is a mass on two springs: x = U Ω² / (k − mΩ² + i c Ω), U/c · Ω at resonance
print(f"{mass:.2f} kg, G {GRADE}: {1e6 * permitted:.0f} g mm at {SERVICE * 30 / np.pi:.0f} rpm")
for direction, stiffness in (("n1", SIDEWAYS), ("n2", UPWARDS)):
    amplitude = np.abs(response.phasor("left", direction))
    critical = np.sqrt(2 * stiffness / mass)
    expected = permitted * critical / (2 * DAMPING)
    found = speeds[amplitude.argmax()]
    print(
        f"{direction}: {1e6 * amplitude.max():.1f} µm at {found * 30 / np.pi:.0f} rpm; of a rigid "
        f"rotor {1e6 * expected:.1f} µm at {critical * 30 / np.pi:.0f} rpm"
    )
    assert abs(found / critical - 1.0) < 0.03  # the shaft gives way a little
    assert abs(amplitude.max() / expected - 1.0) < 0.05

# between the critical speeds the minor axis is negative: the journal turns backward
_, minor = response.semi_axes("left")
backward = speeds[minor < -1e-9]
between = 0.5 * (np.sqrt(2 * SIDEWAYS / mass) + np.sqrt(2 * UPWARDS / mass))
print(f"backward whirl from {backward[0] * 30 / np.pi:.0f} to {backward[-1] * 30 / np.pi:.0f} rpm")
assert backward[0] < between < backward[-1]

figure, (size, phase) = plotting.figure(2, 1, size=(7.0, 5.5), sharex=True)
response.plot("left", ax=(size, phase))
plotting.save(figure, "unbalance_bode.png")
figure, panels = plotting.figure(1, 3, size=(11.0, 4.2))
for ax, speed in zip(panels, (0.6 * between, between, 1.7 * between), strict=True):
    response.plot_orbit(speed, ax=ax, places=["left"])
plotting.save(figure, "unbalance_orbits.png")

# at service speed: a shaker pushes the left journal sideways, over frequency; close steps where
# the resonance is sharp
sweep = np.union1d(np.linspace(5.0, 800.0, 54), np.linspace(150.0, 230.0, 33))
shaken = harmonic_response(
    rotor, sweep, HarmonicForce("left", (1.0, 0.0)), speed=SERVICE, supports=bearings
)
figure, panels = plotting.figure(2, 1, size=(7.0, 5.5), sharex=True)
shaken.plot("left", directions=("forward", "backward"), ax=tuple(panels))
plotting.save(figure, "shaker_bode.png")
plotting.save(shaken.plot_polar("left"), "shaker_polar.png")
