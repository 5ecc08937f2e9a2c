"""Jump and hysteresis of a rotor on two squeeze-film dampers: branches, and runs on them.

The branch of steady orbits over the speed has a fold: above it there are two stable orbits and an
unstable one between them. Runs begin 2 % beside each orbit. Those beside a stable one come back to
it; those beside an unstable one go to one of the two others. So a rotor that runs up keeps the
large orbit, one that runs down the small one, until the fold ends it and the rotor jumps.
"""

import exudyn
import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er
from exudyn_rotor import plotting

solid = occ.Cylinder((0, 0, -0.2), occ.Z, 0.045, 0.4)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.1, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = er.SolidRotor.from_ngsolve(mesh, steel, axis="z")
for z in (-0.2, 0.2):  # 1 kg mm in all
    rotor = rotor.add_point_mass([0.045, 0.0, z], 0.0111)
reduced = rotor.center_interfaces().reduce(0)
CLEARANCE = 1.5e-4
dampers = [
    er.SqueezeFilmDamper(
        interface=end, radius=0.06, length=0.02, clearance=CLEARANCE, viscosity=0.0018,
        centring_stiffness=5e5,
    )
    for end in ("left", "right")
]  # fmt: skip
thrust = er.Support("left", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 1e3]))
supports = [*dampers, thrust]
SPEEDS = np.array([420.0, 480.0, 560.0])  # rad/s
found = er.periodic_response(reduced, np.r_[350.0, SPEEDS, 650.0], supports=supports)


def run(point: int) -> float:
    """Return the amplitude of the left journal after a run that begins near a point [m]."""
    speed = found.speeds[point]
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, spin=speed, translation="none", markers="position")
    er.add_supports(body, supports)
    sensor = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    start = found.state(point, body)
    body.start_from(er.StartState(1.02 * start.q, start.q_t, start.angle, start.speed))
    turn = 2.0 * np.pi / speed
    settings = er.recommended_settings(end_time=30 * turn, step=turn / 40)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = turn / 40
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)[-40:, 1:3]
    return float(np.linalg.norm(path - path.mean(axis=0), axis=1).max())


points = np.concatenate([found.at(speed) for speed in SPEEDS])
ends = np.array([run(int(point)) for point in points])
amplitudes = found.amplitudes("left")
print(found.table("left"))
for point, end in zip(points, ends, strict=True):
    near = [p for p in found.at(found.values[point]) if found.stable[p]]
    reached = near[np.argmin(np.abs(amplitudes[near] / end - 1.0))]
    assert abs(amplitudes[reached] / end - 1.0) < 0.02
    assert (reached == point) == found.stable[point]  # a run leaves an unstable orbit

ax = found.plot("left")
for stable, marker, label in (
    (True, "o", "run, from a stable orbit"),
    (False, "x", "from another"),
):
    at = found.stable[points] == stable
    ax.plot(30.0 / np.pi * found.values[points[at]], 1e6 * ends[at], marker, color="k", mfc="none",
            label=label)  # fmt: skip
ax.legend()
plotting.save(ax, "damper_jump.png")
