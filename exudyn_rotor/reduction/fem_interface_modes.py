"""Modes that Exudyn's ``FEMinterface`` has computed."""

from __future__ import annotations

import numpy as np
from exudyn.FEM import FEMinterface

from exudyn_rotor import checks
from exudyn_rotor.reduction.component import ModeBasis, check_rotor
from exudyn_rotor.solid.matrices import check_same_mesh
from exudyn_rotor.solid.rotor import FiniteElementRotor


def fem_interface_modes(rotor: FiniteElementRotor, fem: FEMinterface) -> ModeBasis:
    """Return the modal basis of a ``FEMinterface`` for a rotor made from the same mesh.

    Parameters
    ----------
    rotor : SolidRotor
    fem : exudyn.FEM.FEMinterface
        With ``modeBasis`` and, for stress, ``postProcessingModes`` of type StressLocal.

    Returns
    -------
    ModeBasis
        Frequencies are NaN, because a ``FEMinterface`` does not say which modes are static.

    Raises
    ------
    TypeError, ValueError
        If there is no basis, it belongs to another mesh, or the stress to another basis.
    """
    check_rotor(rotor)
    checks.instance(fem, "fem", FEMinterface)
    if "matrix" not in fem.modeBasis:
        raise ValueError(
            "the FEMinterface holds no modes; call fem.ComputeEigenmodes(…) or "
            "fem.ComputeHurtyCraigBamptonModes(…) first"
        )
    matrix = checks.matrix(fem.modeBasis["matrix"], "fem: its modes")
    check_same_mesh(rotor.nodes, np.asarray(fem.nodes.get("Position", ()), dtype=float))
    if matrix.shape[0] != rotor.nodes.size:
        raise ValueError(
            f"modal basis from another mesh: the rotor has {len(rotor.nodes)} nodes, the modes "
            f"{matrix.shape[0]} rows"
        )
    labels = tuple(f"FEMinterface mode {number}" for number in range(1, matrix.shape[1] + 1))
    return ModeBasis(matrix, labels, rotor.nodes, stress=_stress(fem, matrix))


def _stress(fem: FEMinterface, matrix: np.ndarray) -> np.ndarray | None:
    """Return the stress modes (n, 6, k); FEMinterface stores six columns for every mode."""
    recovered = fem.postProcessingModes
    if not str(recovered.get("outputVariableType", "")).endswith("StressLocal"):
        return None
    stress = np.asarray(recovered["matrix"], dtype=float)
    node_count, mode_count = matrix.shape[0] // 3, matrix.shape[1]
    if stress.shape != (node_count, 6 * mode_count):
        raise ValueError(
            f"the FEMinterface's stress modes have the shape {stress.shape}, but {node_count} "
            f"nodes and {mode_count} modes need {(node_count, 6 * mode_count)}; compute them "
            "after the modes, with fem.ComputePostProcessingModesNGsolve(…)"
        )
    return stress.reshape(node_count, mode_count, 6).transpose(0, 2, 1)
