"""Flexible parts of the peer scenes, as ``FEMinterface`` objects with free or boundary modes.

Sizes are those of Exudyn's own examples and test models (github.com/jgerstmayr/EXUDYN, under
``main/pythonDev``), which each part names; geometry and meshes are made here, by Netgen.
"""

from __future__ import annotations

import copy
from functools import cache

import netgen.occ as occ
import ngsolve as ngs
import numpy as np
from exudyn.FEM import FEMinterface, HCBstaticModeSelection
from exudyn.rigidBodyUtilities import RotationVector2RotationMatrix

ENDS = ("left", "right")
STEEL = {"youngsModulus": 2e11, "poissonsRatio": 0.3, "density": 7850.0}

# TestModels/testData/rotorDiscTest.inp: a shaft 0.1 m thick and 0.5 m long, a disc at z = 0.1 m
SHAFT_RADIUS, SHAFT_LENGTH = 0.05, 0.5
DISC_RADIUS, DISC_START, DISC_WIDTH = 0.196, 0.1, 0.05
UNBALANCE = 0.01  # kg at the rim: a tenth of that in TestModels/objectFFRFreducedOrderTest.py

# Examples/NGsolveCreateFFRFReducedOrder.py: a bar 1 m long, 0.1 m thick
BAR_LENGTH, BAR_WIDTH = 1.0, 0.1

# Examples/NGsolvePistonEngine.py, one of its throws
CRANK_ARM, PIN_RADIUS, PIN_WIDTH, ARM_WIDTH, ARM_HEIGHT = 0.03, 0.012, 0.012, 0.015, 0.032
END_LENGTH, CONROD_LENGTH, CONROD_HEIGHT = 0.02, 0.08, 0.024

AXES = {"x": np.eye(3)[0], "y": np.eye(3)[1], "z": np.eye(3)[2]}
AXES["skew"] = np.array([2.0, 3.0, 6.0]) / 7.0


@cache
def rotor(
    axis: str = "z", modes: int = 8, maxh: float = 0.1, boundary_modes: bool = False
) -> FEMinterface:
    """Return the disc on its shaft along an axis through the mesh origin, with an unbalance.

    The stiffness is a hundredth of that of steel, as in ``TestModels/objectFFRFreducedOrderTest``.
    The boundaries are 'left' at the mesh origin, and 'right'.
    """
    shaft = occ.Cylinder((0, 0, 0), occ.Z, SHAFT_RADIUS, SHAFT_LENGTH)
    solid = shaft + occ.Cylinder((0, 0, DISC_START), occ.Z, DISC_RADIUS, DISC_WIDTH)
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = ENDS
    turn = turned_to(axis)
    angle = np.degrees(np.arccos(np.clip(turn[2, 2], -1.0, 1.0)))
    if angle:
        about = np.cross([0.0, 0.0, 1.0], AXES[axis])
        solid = solid.Rotate(occ.Axis((0, 0, 0), occ.Vec(*about)), angle)
    fem = _imported(solid, maxh, 1e-2)
    rim = turn @ [0.0, DISC_RADIUS, DISC_START + DISC_WIDTH]
    fem.AddNodeMass(_nearest(fem, rim), UNBALANCE)
    return _with_modes(fem, modes, boundary_modes)


def turned_to(axis: str) -> np.ndarray:
    """Return the smallest rotation that turns z to an axis."""
    about = np.cross([0.0, 0.0, 1.0], AXES[axis])
    sine = np.linalg.norm(about)
    angle = np.arctan2(sine, AXES[axis][2])
    return np.array(RotationVector2RotationMatrix(about * (angle / sine if sine else 0.0)))


@cache
def bar(modes: int = 6, maxh: float = 0.1) -> FEMinterface:
    """Return a bar along x from the mesh origin; the boundaries are its end faces."""
    half = BAR_WIDTH / 2
    solid = occ.Box((0, -half, -half), (BAR_LENGTH, half, half))
    solid.faces.Min(occ.X).name, solid.faces.Max(occ.X).name = ENDS
    return _with_modes(_imported(solid, maxh, 1e-1), modes)


@cache
def crank(modes: int = 8, maxh: float = 0.02) -> FEMinterface:
    """Return a crank with one throw towards x, spinning about z; 'left', 'right' and 'pin'."""
    start = ARM_WIDTH + PIN_WIDTH / 2
    arm = occ.Box((-0.025, -ARM_HEIGHT / 2, 0), (CRANK_ARM + 0.016, ARM_HEIGHT / 2, ARM_WIDTH))
    pin = occ.Cylinder((CRANK_ARM, 0, -PIN_WIDTH / 2), occ.Z, PIN_RADIUS, PIN_WIDTH)
    pin.faces[0].name = "pin"
    end = occ.Cylinder((0, 0, 0), occ.Z, PIN_RADIUS, END_LENGTH)
    solid = (
        pin
        + arm.Move((0, 0, PIN_WIDTH / 2))
        + arm.Move((0, 0, -start))
        + end.Move((0, 0, start))
        + end.Move((0, 0, -start - END_LENGTH))
    )
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = ENDS
    return _with_modes(_imported(solid, maxh, 1e-1, (*ENDS, "pin")), modes)


@cache
def conrod(modes: int = 6, maxh: float = 0.02) -> FEMinterface:
    """Return a connecting rod along x about the mesh origin; 'left' and 'right' are its ends."""
    half, thick = CONROD_LENGTH / 2, PIN_WIDTH / 2
    solid = occ.Box((-half, -CONROD_HEIGHT / 2, -thick), (half, CONROD_HEIGHT / 2, thick))
    solid.faces.Min(occ.X).name, solid.faces.Max(occ.X).name = ENDS
    return _with_modes(_imported(solid, maxh, 1e-1), modes)


@cache
def bed(modes: int = 6, maxh: float = 0.2) -> FEMinterface:
    """Return a plate under the rotor, along z; 'left' and 'right' are its pedestals' faces."""
    plate = occ.Box((-0.3, -0.45, -0.1), (0.3, -0.35, SHAFT_LENGTH + 0.1))
    solid = plate
    for start in (-0.05, SHAFT_LENGTH - 0.05):
        solid = solid + occ.Box((-0.06, -0.36, start), (0.06, -0.1, start + 0.1))
    tops = [face for face in solid.faces if abs(face.center.y + 0.1) < 1e-6]
    for name, face in zip(ENDS, sorted(tops, key=lambda face: face.center.z), strict=True):
        face.name = name
    return _with_modes(_imported(solid, maxh, 1e-1), modes)


def mean_position(fem: FEMinterface, boundary: str) -> np.ndarray:
    """Return the centre of a boundary as its marker sees it, mesh axes [m]."""
    nodes, weights = nodes_of(fem, boundary)
    return weights @ fem.GetNodePositionsAsArray()[nodes]


def nodes_of(fem: FEMinterface, boundary: str) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and weights of a boundary, for a script's own markers."""
    found = next(entry for entry in fem.nodeSets if entry["Name"] == boundary)
    return np.array(found["NodeNumbers"]), np.array(found["NodeWeights"])


def _imported(solid, maxh: float, softness: float, names=ENDS) -> FEMinterface:
    solid.mat("steel")
    mesh = ngs.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=maxh, curvaturesafety=2.0))
    material = {**STEEL, "youngsModulus": softness * STEEL["youngsModulus"]}
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(
        mesh, materials={"steel": material}, boundaryNamesList=list(names), meshOrder=1
    )
    return fem


def _nearest(fem: FEMinterface, point: np.ndarray) -> int:
    return int(np.linalg.norm(fem.GetNodePositionsAsArray() - point, axis=1).argmin())


def _with_modes(fem: FEMinterface, modes: int, boundary_modes: bool = False) -> FEMinterface:
    if boundary_modes:
        nodes, weights = fem.GetBoundaryNodeSetsAsLists()
        fem.ComputeHurtyCraigBamptonModes(
            boundaryNodesList=nodes,
            nEigenModes=modes,
            boundaryNodesWeights=weights,
            computationMode=HCBstaticModeSelection.RBE2,
        )
    else:
        fem.ComputeEigenmodes(modes, excludeRigidBodyModes=6, useSparseSolver=True)
    return copy.copy(fem)
