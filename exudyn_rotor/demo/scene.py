"""The scene of the demonstration: a disc on a shaft in two bearings on a sprung foundation.

NGSolve meshes the rotor, Exudyn's ``FEMinterface`` reduces it. A torque spins it up through its
first critical speed; unbalance and gravity act. Every variant is the same script with another call
for the rotor.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import ngsolve
import numpy as np
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from exudyn.itemInterface import MarkerSuperElementPosition, MarkerSuperElementRigid
from exudyn.rigidBodyUtilities import InertiaCuboid
from netgen import occ

from exudyn_rotor.multibody.rotor.rotor_items import Carrier
from exudyn_rotor.solid_rotor import SolidRotor

AddRotor = Callable[[exudyn.MainSystem, FEMinterface], dict]

STEEL = {"steel": {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}}
GRAVITY = [0.0, 0.0, -9.81]
START_SPEED = 180.0  # rad/s, below the first critical speed
TORQUE = 42.0  # N m
BEARINGS = {"left": -0.3, "right": 0.3}  # places on the x axis [m]


def disc_on_shaft(max_element_size: float, safety: float = 2.0) -> ngsolve.Mesh:
    """Return a steel disc (0.24 m × 40 mm) on a shaft (0.6 m × 30 mm) along x, faces named.

    `safety` is the radius of the curves over the length of the elements there.
    """
    shaft = occ.Cylinder(occ.Pnt(-0.3, 0, 0), occ.X, 0.015, 0.6)
    disc = occ.Cylinder(occ.Pnt(0.03, 0, 0), occ.X, 0.12, 0.04)
    solid = shaft + disc
    solid.name = "steel"
    solid.faces.Min(occ.X).name, solid.faces.Max(occ.X).name = BEARINGS
    geometry = occ.OCCGeometry(solid)
    return ngsolve.Mesh(geometry.GenerateMesh(maxh=max_element_size, curvaturesafety=safety))


def unbalanced_model(mode_count: int, max_element_size: float, safety: float = 2.0) -> FEMinterface:
    """Return the FE model with an unbalance of 8 g at the disc's rim, and its free modes."""
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(
        disc_on_shaft(max_element_size, safety),
        materials=STEEL,
        boundaryNamesList=list(BEARINGS),
        meshOrder=2,
    )
    rim = np.array([0.05, 0.0, 0.12])
    node = int(np.argmin(np.linalg.norm(fem.GetNodePositionsAsArray() - rim, axis=1)))
    fem.AddNodeMass(node, 0.008)
    fem.ComputeEigenmodes(mode_count, excludeRigidBodyModes=6)
    return fem


def add_3d_rotor(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
    """Add Exudyn's own flexible body as a user writes it, with markers on all face nodes."""
    return mbs.CreateFFRFReducedOrderObject(
        name="rotor", femInterface=fem, initialAngularVelocity=[START_SPEED, 0, 0], gravity=GRAVITY
    )


def add_3d_rotor_with_virtual_nodes(
    mbs: exudyn.MainSystem, fem: FEMinterface, markers: str = "rigid"
) -> dict:
    """Add Exudyn's own flexible body with the fixed-axis rotor's cheap interface nodes.

    `markers` is 'rigid', on three nodes an interface, or 'position', on one.
    """
    model = SolidRotor.from_fem_interface(fem, "x")
    body = ObjectFFRFreducedOrderInterface(fem)
    modes, places = body.modeBasis, {}
    for name, interface in model.interfaces.items():
        motion = interface.mean_motion(model.node_count) @ modes
        place = Carrier(None, interface.reference, motion, interface.radius)
        points, columns = place.virtual_nodes(markers)
        places[name] = len(body.xRef) // 3 + np.arange(len(points))
        body.xRef = np.append(body.xRef, points)
        body.modeBasis = np.vstack([body.modeBasis, columns])
    items = body.AddObjectFFRFreducedOrder(
        mbs, name="rotor", initialAngularVelocity=[START_SPEED, 0, 0], gravity=GRAVITY
    )
    kind = MarkerSuperElementPosition if markers == "position" else MarkerSuperElementRigid
    made = {"FFRFReducedOrderObjectDict": items}
    for name, nodes in places.items():
        weights = [1.0 / len(nodes)] * len(nodes)
        seen = {"meshNodeNumbers": nodes.tolist(), "weightingFactors": weights}
        made[f"rotor:{name}"] = mbs.AddMarker(kind(bodyNumber=items["oFFRFreducedOrder"], **seen))
    return made


def add_fixed_axis_rotor(translation: str) -> AddRotor:
    """Return a function that adds the fixed-axis rotor by the twin of the call above."""

    def add(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
        return mbs.CreateFixedAxisFFRFReducedOrderObject(
            name="rotor",
            femInterface=fem,
            initialAngularVelocity=[START_SPEED, 0, 0],
            gravity=GRAVITY,
            axis="x",
            translation=translation,
            stiffening="tilt",  # as much as Exudyn's body has
        )

    return add


def add_foundation(mbs: exudyn.MainSystem, rotor: dict) -> None:
    """Put the rotor's bearings on a rigid block, and the block on four springs."""
    block = mbs.CreateRigidBody(
        name="foundation",
        referencePosition=[0, 0, -0.25],
        inertia=InertiaCuboid(density=2500.0, sideLengths=[0.8, 0.4, 0.1]),
        gravity=GRAVITY,
        graphicsDataList=[
            exudyn.graphics.Brick(size=[0.8, 0.4, 0.1], color=[0.6, 0.6, 0.6, 1.0]),
            *(
                exudyn.graphics.Brick([x, 0, 0.14], [0.02, 0.06, 0.18], [0.45, 0.45, 0.5, 1.0])
                for x in BEARINGS.values()
            ),
        ],
    )
    ground = mbs.CreateGround()
    for x in (-0.35, 0.35):
        for y in (-0.18, 0.18):
            mbs.CreateCartesianSpringDamper(
                itemNumbers=[ground, block],
                localPosition0=[x, y, -0.3],
                localPosition1=[x, y, -0.05],
                stiffness=[3e6, 3e6, 4e6],
                damping=[1.5e3, 1.5e3, 1.5e3],
            )
    for interface, x in BEARINGS.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[block, rotor[f"rotor:{interface}"]],
            localPosition0=[x, 0, 0.25],
            stiffness=[2e6, 1.2e6, 1.6e6],
            damping=[200.0, 200.0, 200.0],
        )
    mbs.CreateTorque(itemNumber=rotor["rotor:left"], loadVector=[TORQUE, 0, 0])
