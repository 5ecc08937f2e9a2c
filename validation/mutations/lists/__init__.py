"""All mutations, by folder of the package."""

from validation.mutations.lists.advice import ADVICE
from validation.mutations.lists.bearings import BEARINGS
from validation.mutations.lists.drives import DRIVES
from validation.mutations.lists.energy import ENERGY
from validation.mutations.lists.evaluation import EVALUATION
from validation.mutations.lists.foundations import FOUNDATIONS
from validation.mutations.lists.linear import LINEAR
from validation.mutations.lists.linear_exponents import LINEAR_EXPONENTS
from validation.mutations.lists.linear_forced import LINEAR_FORCED
from validation.mutations.lists.linear_models import LINEAR_MODELS
from validation.mutations.lists.linear_periodic import LINEAR_PERIODIC
from validation.mutations.lists.linear_spin import LINEAR_SPIN
from validation.mutations.lists.linear_stability import LINEAR_STABILITY
from validation.mutations.lists.linear_steady import LINEAR_STEADY
from validation.mutations.lists.multibody import MULTIBODY
from validation.mutations.lists.multibody_rotor import MULTIBODY_ROTOR
from validation.mutations.lists.pictures import PICTURES
from validation.mutations.lists.prestress import PRESTRESS
from validation.mutations.lists.reduction import REDUCTION
from validation.mutations.lists.rolling_bearings import ROLLING_BEARINGS
from validation.mutations.lists.solid import SOLID
from validation.mutations.lists.solvers import SOLVERS
from validation.mutations.lists.strength import STRENGTH
from validation.mutations.lists.theory import THEORY
from validation.mutations.lists.top import TOP
from validation.mutations.lists.trains import TRAINS

ALL = (
    *THEORY,
    *SOLVERS,
    *SOLID,
    *PRESTRESS,
    *REDUCTION,
    *BEARINGS,
    *ROLLING_BEARINGS,
    *DRIVES,
    *FOUNDATIONS,
    *MULTIBODY_ROTOR,
    *MULTIBODY,
    *ENERGY,
    *LINEAR_MODELS,
    *LINEAR_PERIODIC,
    *LINEAR_EXPONENTS,
    *LINEAR_FORCED,
    *LINEAR,
    *LINEAR_SPIN,
    *LINEAR_STABILITY,
    *LINEAR_STEADY,
    *TRAINS,
    *EVALUATION,
    *PICTURES,
    *STRENGTH,
    *ADVICE,
    *TOP,
)
