"""Checks of input: every refusal names the argument, shows the value and says what is expected.

A wrong kind of value (text for a number, a list for a rotor) is a TypeError, a value out of its
range a ValueError. Arrays that are kept are copies and read-only.
"""

from exudyn_rotor.checks.arrays import (
    array,
    ascending,
    matrix,
    read_only,
    rotation,
    symmetric,
    vector,
    whole_numbers,
)
from exudyn_rotor.checks.messages import shown
from exudyn_rotor.checks.numbers import count, flag, keep_numbers, number, tolerance, whole_number
from exudyn_rotor.checks.objects import (
    executor,
    function,
    instance,
    instances,
    items,
    path,
    read_only_mapping,
)
from exudyn_rotor.checks.words import choice, different, label, labels, mapping

__all__ = [
    "array",
    "ascending",
    "choice",
    "count",
    "different",
    "executor",
    "flag",
    "function",
    "instance",
    "instances",
    "items",
    "keep_numbers",
    "label",
    "labels",
    "mapping",
    "matrix",
    "number",
    "path",
    "read_only",
    "read_only_mapping",
    "rotation",
    "shown",
    "symmetric",
    "tolerance",
    "vector",
    "whole_number",
    "whole_numbers",
]
