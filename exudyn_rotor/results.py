"""Results of analyses: small immutable objects, stored without pickle.

A result is a frozen dataclass of arrays, numbers, words and tuples of words. It says of every
array, by :func:`numbers`, which type and shape it has; the constructor checks that, when a result
is made and when it is loaded. Its class is made storable by a decorator; a file names its class,
and only registered classes are made from it, so loading never executes code from the file.
"""

from __future__ import annotations

import csv
import io
import sys
from collections.abc import Mapping
from dataclasses import fields
from os import PathLike
from typing import Any, TypeVar

import numpy as np

from exudyn_rotor.checks import Checked
from exudyn_rotor.checks import numbers as numbers
from exudyn_rotor.checks import words as words
from exudyn_rotor.storage import RESULT, plain, read_arrays, write_arrays, write_bytes

_REGISTERED: dict[str, type[Result]] = {}

Class = TypeVar("Class", bound=type)


def storable(cls: Class) -> Class:
    """Register a result class under its name for :meth:`Result.save` and :func:`load_result`.

    To be put above ``@dataclass(frozen=True, eq=False)``. Fields may be arrays of numbers, numbers,
    flags, words, tuples of words, and None.
    """
    _REGISTERED[cls.__name__] = cls
    return cls


class Result(Checked):
    """Base of result classes: checked, read-only, saved by a method, see :func:`load_result`.

    Examples
    --------
    >>> from exudyn_rotor import Result, StabilityMap
    >>> issubclass(StabilityMap, Result)
    True
    """

    def save(self, path: str | PathLike) -> None:
        """Write the result to an ``.npz`` file, lossless and without pickle.

        A file of that name is replaced only by a complete one.

        Raises
        ------
        TypeError
            If `path` is no path, or the class is not registered.
        OSError
            If the folder does not exist, `path` is a folder or read-only, or the disk is full.
        """
        name = type(self).__name__
        if _REGISTERED.get(name) is not type(self):
            raise TypeError(f"a {name} cannot be stored; its class needs the decorator storable")
        data: dict[str, object] = {"class": name}
        for item in fields(self):
            value = getattr(self, item.name)
            if value is not None:
                row = isinstance(value, tuple)
                data[f"field.{item.name}"] = np.array(value, dtype=str) if row else value
        write_arrays(path, RESULT, data)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns of one length, named with their units.

        Parameters
        ----------
        units : {'SI', 'Hz', 'rpm'}
            Of speeds and frequencies; see :meth:`exudyn_rotor.units.Units.of`.

        Raises
        ------
        TypeError
            If the class has no such table.
        """
        raise TypeError(f"columns: a {type(self).__name__} has none; give its class this method")

    def table(self, *, units: str = "rpm") -> str:
        """Return the table as text; `units` are those of :meth:`columns`."""
        return "\n".join(text_table(self.columns(units)))

    def to_dataframe(self, units: str = "SI") -> Any:
        """Return the table as a ``pandas.DataFrame``; see :meth:`columns`.

        Raises
        ------
        ImportError
            Without pandas, which ``pip install "exudyn-rotor[pandas]"`` brings.
        """
        try:
            import pandas
        except ImportError as error:
            raise ImportError(
                "to_dataframe: needs pandas, which is not installed: pip install "
                '"exudyn-rotor[pandas]"; to_csv needs nothing more'
            ) from error
        return pandas.DataFrame(self.columns(units))

    def to_csv(self, path: str | PathLike, units: str = "SI") -> None:
        """Write the table to a CSV file (RFC 4180, UTF-8), numbers so that none is lost.

        See :meth:`columns`. A file of that name is replaced only by a complete one.

        Raises
        ------
        TypeError, OSError
            As :meth:`save`.
        """
        text, columns = io.StringIO(), self.columns(units)
        writer = csv.writer(text)
        writer.writerow(columns)
        writer.writerows(zip(*(values.tolist() for values in columns.values()), strict=True))
        write_bytes(path, text.getvalue().encode())


def text_table(columns: Mapping[str, np.ndarray]) -> list[str]:
    """Return columns of a table as lines of text, the first of names.

    Numbers have six digits and stand to the right; what is not known, NaN or a whole number below
    zero, is '-'. Columns that hold nothing else are left out.

    Examples
    --------
    >>> import numpy as np
    >>> print("\\n".join(text_table({"Ω": np.array([1.0, np.nan]), "n": np.array([1, -1])})))
    Ω  n
    1  1
    -  -
    """
    shown = []
    for name, values in columns.items():
        kind = values.dtype.kind
        if kind == "f":
            cells = ["-" if np.isnan(value) else f"{value:.6g}" for value in values.tolist()]
        elif kind in "iu":
            cells = ["-" if value < 0 else str(value) for value in values.tolist()]
        else:
            cells = [{True: "yes", False: "no"}.get(value, value) for value in values.tolist()]
        if len(values) and set(cells) == {"-"}:
            continue
        width = max(map(len, [name, *cells]))
        shown.append([f"{cell:{'<' if kind == 'U' else '>'}{width}}" for cell in [name, *cells]])
    return ["  ".join(row).rstrip() for row in zip(*shown, strict=True)]


def load_result(path: str | PathLike) -> Result:
    """Read a result written by its method ``save``; never executes code from the file.

    Returns
    -------
    Result
        Of the class that was saved: Campbell, UnbalanceResponse, ...

    Raises
    ------
    OSError
        When there is no such file.
    ValueError
        When the file holds no result of a known class, is damaged, was written by another version,
        or its entries do not make a result.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from exudyn_rotor import StabilityMap, load_result
    >>> motion = {"frequencies_inertial": [[60.0, 70.0]], "log_decrement": [[0.05, -0.04]]}
    >>> motion |= {"whirl_codes": [[0, 0]], "nodal_diameters": [[1, 1]], "labels": ("Ω", "d")}
    >>> growth, stable = [[-0.1, 0.2]], [[True, False]]
    >>> result = StabilityMap([100.0], [0.0, 50.0], growth, stable, **motion)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result.save(Path(folder, "map.npz"))
    ...     load_result(Path(folder, "map.npz"))
    StabilityMap(x=array(1,), y=array(2,), growth=array(1, 2), stable=array(1, 2), ...)
    """
    data = read_arrays(path, RESULT)
    name, package = str(data.pop("class", None)), sys.modules[__package__]
    if name in package.__all__:
        getattr(package, name)  # its module registers it
    cls = _REGISTERED.get(name)
    if cls is None:
        raise ValueError(f"{path}: holds a {name}, which is no result of this package")
    values = {key.removeprefix("field."): plain(value) for key, value in data.items()}
    try:
        return cls(**values)
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{path}: describes no {name}, or was written by another version ({error})"
        ) from error
