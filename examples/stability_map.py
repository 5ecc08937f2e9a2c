"""A shaft with two flats: where is it unstable, and how much damping in the bearings helps?

On isotropic bearings the matrices are constant in the rotor frame, and the shaft is unstable
between the speeds at which its stiffness there becomes singular, a small eigenvalue problem.
These bearings, however, are softer sideways than upright, so the equations are periodic and the
growth is that of Floquet's theory: there are three narrower ranges, two at the critical speeds of
each direction and a combination resonance between them. Damping closes them one by one. Two
flexible modes are enough for the picture: its limits are about 1 % too high.
"""

import ngsolve
import numpy as np
import scipy.linalg
from netgen import occ

from exudyn_rotor import (
    LinearModel,
    SolidRotor,
    Support,
    linear_model,
    plotting,
    stability_map,
    unstable_ranges,
)
from exudyn_rotor.reduction.reduced_rotor import ModeKind

UPRIGHT, SIDEWAYS, ALONG = 6e6, 3e6, 1e7  # stiffness of a bearing [N/m]

shaft = occ.Cylinder(occ.Pnt(0, 0, -0.3), occ.Z, 0.02, 0.6)
shaft = shaft * occ.Box(occ.Pnt(-0.02, -0.0185, -0.3), occ.Pnt(0.02, 0.0185, 0.3))
solid = shaft + occ.Cylinder(occ.Pnt(0, 0, -0.015), occ.Z, 0.12, 0.03)
solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z").center_interfaces()
reduced = rotor.reduce(2).without_shapes()


def bearings(sideways: float, upright: float, damping: float) -> list[Support]:
    """Return two equal bearings; stiffness [N/m] and damping [N s/m]."""
    stiffness = np.diag([sideways, upright, ALONG])
    return [Support(name, stiffness, np.eye(3) * damping) for name in ("left", "right")]


def damped(speed: float, damping: float) -> tuple[LinearModel, float]:
    """Return the rotor on bearings softer sideways, and the speed [rad/s]."""
    model = linear_model(reduced, supports=bearings(SIDEWAYS, UPRIGHT, damping), axes="rotor")
    return model, speed


speeds = np.linspace(440.0, 580.0, 29)
isotropic = bearings(UPRIGHT, UPRIGHT, 0.0)
given = {"axes": "rotor", "accuracy": None}  # it is uneven by its flats; the basis is off by 1 %
found = unstable_ranges(reduced, speeds, supports=isotropic, **given)
keep = [i for i, kind in enumerate(reduced.kinds) if kind is not ModeKind.SPIN]
model = linear_model(reduced, supports=isotropic)
at_rest, turning = (model.at(speed).K[0][np.ix_(keep, keep)] for speed in (0.0, 1.0))
squares = scipy.linalg.eigvals(at_rest, at_rest - turning).real
expected = np.sqrt(np.sort(squares[squares > 0.0])[:2])
print(f"isotropic bearings: unstable from {found[0, 0]:.4f} to {found[0, 1]:.4f} rad/s")
print(f"  stiffness singular at {expected[0]:.4f} and {expected[1]:.4f} rad/s")

for damping in (20.0, 400.0):
    uneven = bearings(SIDEWAYS, UPRIGHT, damping)
    ranges = unstable_ranges(reduced, speeds, supports=uneven, **given)
    listed = ", ".join(f"{low:.2f} to {high:.2f}" for low, high in ranges) or "nowhere"
    print(f"softer sideways, {damping:3.0f} N s/m: unstable {listed} rad/s")

result = stability_map(
    damped,
    speeds,
    np.linspace(0.0, 400.0, 5),
    labels=("spin speed [rad/s]", "damping of a bearing [N s/m]"),
    tolerance=1e-6,
    accuracy=None,
)
ax = result.plot()
ax.set_title("shaft with two flats on bearings softer sideways; black: limit of stability")
plotting.save(ax, "stability_map.png")

assert np.allclose(found[0], expected, rtol=1e-6)
assert len(ranges) == 0  # with the largest damping
