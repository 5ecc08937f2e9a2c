"""Tables of results for other programs: CSV files, and pandas, which is optional."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np

from exudyn_rotor.storage import write_text


def write_csv(path: str | PathLike, columns: Mapping[str, np.ndarray]) -> None:
    """Write columns of one length to a CSV file (RFC 4180, UTF-8), numbers so that none is lost.

    A file of that name is replaced only by a complete one.

    Raises
    ------
    TypeError, OSError
        See :func:`exudyn_rotor.storage.write_arrays`.
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(columns)
    writer.writerows(zip(*(values.tolist() for values in columns.values()), strict=True))
    write_text(path, text.getvalue())


def data_frame(columns: Mapping[str, np.ndarray]) -> Any:
    """Return columns of one length as a ``pandas.DataFrame``.

    Raises
    ------
    ImportError
        Without pandas.
    """
    try:
        import pandas
    except ImportError as error:
        raise ImportError(
            'to_dataframe: needs pandas, which is not installed: pip install "exudyn-rotor[pandas]"'
            "; to_csv needs nothing more"
        ) from error
    return pandas.DataFrame(dict(columns))
