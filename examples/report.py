"""From a STEP file to a report: Campbell diagram, critical speeds, unbalance, stability, API."""

import warnings

import ngsolve
import numpy as np
from netgen import occ

import exudyn_rotor as er

RPM, ENDS = np.pi / 30.0, ("drive end", "free end")
RANGE = np.array([6500.0, 9000.0]) * RPM  # of operation [rad/s]
shaft = occ.Cylinder((0, 0, 0), occ.Z, 50, 1200)  # a compressor with three wheels [mm]
shaft = sum((occ.Cylinder((0, 0, z), occ.Z, 160, 60) for z in (450, 570, 690)), shaft)
shaft.WriteStep("compressor.step")
with warnings.catch_warnings(record=True) as raised:
    drawn = occ.OCCGeometry("compressor.step").shape.Scale(occ.Pnt(0, 0, 0), 1e-3)  # mm to m
    mesh = ngsolve.Mesh(occ.OCCGeometry(drawn).GenerateMesh(maxh=0.12))
    steel = {"youngsModulus": 2.05e11, "poissonsRatio": 0.3, "density": 7830.0}
    solid = er.SolidRotor.from_ngsolve(mesh, steel, axis="z")
    for name, place in (("drive end", 0.06), ("midspan", 0.6), ("free end", 1.14)):
        solid = solid.interface_at(name, place, width=0.08)
    rotor = solid.reduce(er.craig_bampton_modes(solid, 9, coupling="RBE3"))
    bearings = [er.Support(end, np.diag([2e7, 3e7, 2e7]), 3e4 * np.eye(3)) for end in ENDS]
    model, speeds = er.linear_model(rotor, supports=bearings), np.linspace(0.0, 14e3, 29) * RPM
    diagram, growth = er.campbell(model, speeds[::4], modes=8), er.stability(model, speeds[::4])
    critical = er.critical_speed_map(rotor, ENDS, np.geomspace(1e6, 1e10, 9), max_speed=3e4 * RPM)
    masses = np.linalg.norm(er.bearing_loads(rotor, ENDS, [0, -9.81, 0]), axis=1) / 9.81
    unbalances = er.standard_unbalances("first bending", ["midspan"], masses, RANGE[1])
    response = er.unbalance_response(model, speeds[1:], unbalances, own=False, refine=True)
    margins = er.separation_margins(response, RANGE)
    stage = er.anticipated_cross_coupling(3e5, RANGE[1], 0.32, 0.02, density_ratio=1.4)
    level_one = er.stability_level_one(rotor, RANGE[1], 3.0 * stage, "midspan", supports=bearings)
picture = diagram.plot(units="rpm", orders=[1, 2])
picture.axvspan(RANGE[0] / RPM, RANGE[1] / RPM, color="green", alpha=0.15)
contents = {"Rotor": [solid, rotor], "Bearings": model, "Campbell diagram": [picture, diagram]}
contents |= {"Critical speeds over the stiffness": critical, "Unbalance response": response}
contents |= {"Margins by API": margins, "Stability": growth, "Stability by API": level_one}
er.report("report.html", contents, title="Compressor rotor", raised=raised)
assert abs(masses.sum() / 176.08 - 1.0) < 1e-3  # 7830 π (0.05² 1.2 + 3 (0.16² − 0.05²) 0.06) kg
assert np.allclose(margins.peaks / RPM, 4175.0, rtol=0.01)
assert all([*margins.accepted, *growth.stable, not level_one.needs_level_two])
