"""A linear model beside the shapes that the bases of its rotors lack first."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from exudyn_rotor.linear.models.basis.finer_rotor import Basis, FinerRotor, finer_rotor
from exudyn_rotor.linear.models.basis.finer_scene import FinerScene
from exudyn_rotor.linear.models.basis.finer_train import FinerTrain
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.scene.linear_scene import LinearScene
from exudyn_rotor.linear.models.scene.remembering_scene import RememberingScene
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain


class FinerModel(NamedTuple):
    """A model with further coordinates of its rotors.

    Attributes
    ----------
    equations : LinearModel
    lacking : ndarray of bool, shape (k,)
        Which coordinates the given model lacks; the others are its own, in their order.
    bases : tuple of Basis
        Those of the rotors of the given model.
    """

    equations: LinearModel
    lacking: np.ndarray
    bases: tuple[Basis, ...]


def finer_model(model: LinearModel) -> FinerModel | None:
    """Return a model with the shapes that its bases lack first; None where these are not known."""
    if isinstance(model, LinearTrain):
        train = FinerTrain.beside(model)
        return None if train is None else FinerModel(train, train.lacking, train.bases)
    if isinstance(model, ExtendedRotor):
        plain = finer_model(model.held)
        if plain is None:
            return None
        equations = plain.equations.with_supports(model.plain.supports)
        lacking = np.pad(plain.lacking, (0, model.size - model.plain.size))
        return FinerModel(replace(model, plain=equations), lacking, plain.bases)
    if isinstance(model, RememberingScene):
        plain = finer_model(model.plain)
        if plain is None:
            return None
        lacking = np.pad(plain.lacking, (0, model.size - model.plain.size))
        return FinerModel(replace(model, plain=plain.equations), lacking, plain.bases)
    if isinstance(model, LinearScene):
        source = model.body.selection.source
        rotor = finer_rotor(source)
        finer = None if rotor is None else FinerScene.of(model, rotor)
    elif isinstance(model, LinearRotor):
        source, finer = model.rotor, FinerRotor.beside(model)
    else:
        return None
    if finer is None:
        return None
    lacking = np.arange(finer.size) >= model.size
    return FinerModel(finer, lacking, (Basis(source, finer.loaded),))
