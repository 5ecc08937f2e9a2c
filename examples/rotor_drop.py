"""A spinning rotor falls into its back-up bearings: does it lie there, or roll around backward?

The magnetic bearings fail at 190 rpm, and the rotor falls through the clearance. With little
friction it comes to swing beside the lowest point, where friction and weight balance, and brakes by
μ m g R. With much friction it climbs the wall and whirls backward, until it rolls without sliding:
the whirl is then Ω R/e against the spin, e the clearance with what the whirling mass adds to it.

Friction decides by much. Along the wall of the clearance c, at the angle φ from the lowest point,
w = v²/2gc follows w' = 2μw + μ cos φ − sin φ. An impact without rebound leaves w = μ², which leads
over the top from μ = 1/2 on. Below, the rebounds decide, and every small change with them.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from exudyn_rotor import plotting

CLEARANCE, RADIUS, STIFFNESS, SPIN, GRAVITY = 5e-4, 0.03, 5e7, 20.0, 9.81  # SI units
STEP, LITTLE, MUCH = 5e-5, 0.1, 0.6
shaft = occ.Cylinder((0, 0, -0.2), occ.Z, RADIUS, 0.4)
solid = shaft + occ.Cylinder((0, 0, -0.02), occ.Z, 0.1, 0.04)
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.08, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = er.SolidRotor.from_ngsolve(mesh, steel, axis="z")
for name, place in (("left", -0.18), ("right", 0.18)):
    rotor = rotor.interface_at(name, place, width=0.04)
reduced = rotor.center_interfaces().reduce(4).without_shapes()
mass, inertia = reduced.invariants.mass, reduced.invariants.Theta  # kg, kg m²


def drop(friction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time [s], place x + iy of the left journal [m] and spin speed [rad/s]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(
        mbs, reduced, initial_speed=SPIN, gravity=[0.0, -GRAVITY, 0.0], markers="position"
    )
    stop = {"radius": RADIUS, "clearance": CLEARANCE, "stiffness": STIFFNESS, "damping": 3e5}
    for end in ("left", "right"):
        er.add_supports(body, er.ClearanceStop(interface=end, friction=friction, **stop))
    place = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    spin = body.add_spin_sensor()
    mbs.Assemble()
    settings = er.recommended_settings(end_time=0.24, step=STEP)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    mbs.SolveDynamic(settings)
    path, speed = mbs.GetSensorStoredData(place), mbs.GetSensorStoredData(spin)[:, 2]
    return path[:, 0], path[:, 1] + 1j * path[:, 2], speed


def slope(values: np.ndarray) -> float:
    """Return the mean rate of what a run recorded, over its last part."""
    late = time > 0.15
    return np.polyfit(time[late], values[late], 1)[0]


runs = {friction: drop(friction) for friction in (LITTLE, MUCH)}
time, path, speed = runs[LITTLE]
contact, fall = time[np.argmax(np.abs(path) > CLEARANCE)], np.sqrt(2.0 * CLEARANCE / GRAVITY)
print(f"contact after {1e3 * contact:.2f} ms, free fall {1e3 * fall:.2f} ms")
assert 0.0 <= contact - fall < 2.0 * STEP

lying = np.degrees(np.angle(1j * path[time > 0.15]).mean())
brake = LITTLE * mass * GRAVITY * RADIUS / (inertia * np.hypot(1.0, LITTLE))
print(f"little friction: lies at {lying:.0f}°, brakes by {-slope(speed):.2f} rad/s², {brake:.2f}")
# it still swings by 20°, which presses more by a quarter of the square
assert abs(lying + np.degrees(np.arctan(LITTLE))) < 4.0
assert 0.99 < -slope(speed) / brake < 1.05

time, path, speed = runs[MUCH]
whirl, spin = slope(np.unwrap(np.angle(path))), speed[time > 0.15].mean()
# e (1 − m ω²/2k) = c and ω e = −Ω R
rolling = np.roots([mass * RADIUS * spin / (2.0 * STIFFNESS), -CLEARANCE, -RADIUS * spin])
print(f"much friction: whirls at {whirl:.0f} rad/s, rolling would be {rolling.min():.0f} rad/s")
assert abs(whirl / rolling.min() - 1.0) < 0.01

figure, panels = plotting.figure(1, 3, size=(12.0, 4.0))
circle = CLEARANCE * np.exp(2j * np.pi * np.linspace(0.0, 1.0, 181))
for ax, (friction, (time, path, speed)) in zip(panels, runs.items(), strict=False):
    ax.plot(1e3 * circle.real, 1e3 * circle.imag, color="0.6", lw=3.0)
    ax.plot(1e3 * path.real, 1e3 * path.imag, lw=0.7)
    ax.set_aspect("equal")
    ax.set_xlabel("journal, n1 [mm]")
    ax.set_ylabel("n2 [mm]")
    ax.set_title(f"friction {friction}")
    panels[2].plot(time, speed, label=f"friction {friction}")
panels[2].set_xlabel("time [s]")
panels[2].set_ylabel("spin speed [rad/s]")
panels[2].legend()
plotting.save(figure, "rotor_drop.png")
