"""All mutations, by folder of the package."""

from mutations.lists.advice import ADVICE
from mutations.lists.linear import LINEAR
from mutations.lists.multibody import MULTIBODY
from mutations.lists.prestress import PRESTRESS
from mutations.lists.reduction import REDUCTION
from mutations.lists.solid import SOLID
from mutations.lists.solvers import SOLVERS
from mutations.lists.strength import STRENGTH
from mutations.lists.theory import THEORY
from mutations.lists.top import TOP

ALL = (
    *THEORY,
    *SOLVERS,
    *SOLID,
    *PRESTRESS,
    *REDUCTION,
    *MULTIBODY,
    *LINEAR,
    *STRENGTH,
    *ADVICE,
    *TOP,
)
