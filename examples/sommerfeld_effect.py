"""Sommerfeld effect: a weak motor that stays at the critical speed, and the jump of a stronger one.

Near the critical speed an unbalanced rotor takes power for its whirl, and so brakes its motor. At a
steady speed Ω the dampers c of both bearings take 2 c Ω² r² of power, r the radius of the whirl, so
the mean torque of the vibration is

    V(Ω) = 2 c Ω r²,   in one mode V = c_m Ω r²,  r = U Ω²/√((k_m − m Ω²)² + c_m² Ω²),

U the unbalance (V. O. Kononenko, Vibrating Systems with a Limited Power Supply, 1969; I. I.
Blekhman, Vibrational Mechanics, 2000). The motor's torque T = T_0 (1 − Ω/Ω_0) meets it at one speed
or at three, of which the lower two vanish at a torque T_0*. Runs from rest stay below the critical
speed or pass it. Others raise T_0 slowly: their speed follows V, and jumps where T_0 reaches T_0*.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from exudyn_rotor import plotting

NO_LOAD, STIFFNESS, DAMPING, STEP = 260.0, 6e4, 35.0, 2.5e-3
ENDS = ("left", "right")
solid = occ.Cylinder((0, 0, -0.2), occ.Z, 0.012, 0.4) + occ.Cylinder(
    (0, 0, -0.03), occ.Z, 0.06, 0.06
)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = ENDS
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.05, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = er.SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
rotor = rotor.add_point_mass([0.06, 0.0, 0.0], 0.04)  # unbalance 2.4e-3 kg m
reduced = rotor.reduce(6).without_shapes()
across = np.diag([STIFFNESS, STIFFNESS, 0.0])
supports = [er.Support(name, across, np.diag([DAMPING, DAMPING, 0.0])) for name in ENDS]
supports.append(er.Support("left", np.diag([0.0, 0.0, 1e7]), np.diag([0.0, 0.0, 1e4])))


def run(motor: er.TorqueCurve, end_time: float, speed: float = 0.0) -> np.ndarray:
    """Return time [s], spin angle and speed [rad/s] of a run."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, translation="none", initial_speed=speed, markers="position")
    er.add_supports(body, supports)
    er.add_drive(body, motor)
    sensor = body.add_spin_sensor()
    mbs.Assemble()
    settings = er.recommended_settings(end_time=end_time, step=STEP)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 4 * STEP
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)


# averaged theory: the torque T_0 at which each speed is steady, and its largest near resonance
speeds = np.linspace(115.0, 160.0, 361)
response = er.unbalance_response(reduced, speeds, supports=supports, at=ENDS)
radii = np.array([np.abs(response.phasor(name, "n1")) for name in ENDS])
vibration = DAMPING * speeds * np.sum(radii**2, axis=0)
stall = vibration / (1.0 - speeds / NO_LOAD)
fold = np.argmax(stall)
limit, critical = stall[fold], speeds[fold]


def steady_speed(share: float | np.ndarray) -> np.ndarray:
    """Return the speed below resonance at a share of the limit."""
    return np.interp(share * limit, stall[: fold + 1], speeds[: fold + 1])


from_rest = {
    share: run(er.DirectCurrentMotor(stall_torque=share * limit, no_load_speed=NO_LOAD), 20.0)
    for share in (0.8, 1.1)
}
caught, passed = (data[-1, 2] for data in from_rest.values())
print(f"from rest: {caught:.2f} rad/s, theory {steady_speed(0.8):.2f}; or {passed:.0f} rad/s")
assert abs(caught / steady_speed(0.8) - 1.0) < 1e-3
assert passed > 240.0


def slow_rise(rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Return T_0 over its limit, rising by `rate` [1/s] from 0.95 on, and the speed."""
    times, shares = [0.0, 6.0, 6.0 + 0.1 / rate], [0.5, 0.95, 1.05]

    def torque(speed: float, time: float) -> float:
        return np.interp(time, times, shares) * limit * (1.0 - speed / NO_LOAD)

    data = run(er.TorqueCurve(torque), times[-1], float(steady_speed(0.5)))
    return np.interp(data[:, 0], times, shares), data[:, 2]


# a jump is late by the 2/3 power of the rate, as of every fold that is passed slowly
rates = np.array([0.01, 0.005])
rises = [slow_rise(rate) for rate in rates]
jumps = np.array([share[np.argmax(speed > 1.02 * critical)] for share, speed in rises])
late = rates ** (2.0 / 3.0)
jump = jumps[1] - late[1] * (jumps[0] - jumps[1]) / (late[0] - late[1])
print(f"jumps at {jumps.round(4)} T_0*, of an infinitely slow rise at {jump:.4f} T_0*")
assert abs(jump - 1.0) < 0.005

made, (left, right) = plotting.figure(1, 2, size=(9.0, 3.8))
for (share, data), line in zip(from_rest.items(), plotting.LINES, strict=False):
    left.plot(data[:, 0], data[:, 2], line, label=f"$T_0$ = {share:g} $T_0^*$")
left.set_xlabel("time [s]")
left.set_ylabel("spin speed [rad/s]")
left.set_title("from rest")
left.legend()
right.plot(stall / limit, speeds, "0.6", lw=3, label="averaged theory")
right.plot(*rises[1], lw=1.2, label=f"run, {100 * rates[1]:g} % per second")
right.axis((0.45, 1.07, 126.0, 150.0))
right.set_xlabel("torque $T_0/T_0^*$")
right.set_title("slow rise")
right.legend()
plotting.save(made, "sommerfeld_effect.png")
