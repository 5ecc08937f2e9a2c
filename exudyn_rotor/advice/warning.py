"""The warning about an assumption that does not hold."""


class AssumptionWarning(UserWarning):
    """An assumption of the model does not hold, or its error exceeds what was asked for.

    Examples
    --------
    An error instead:

    >>> import warnings
    >>> from exudyn_rotor import AssumptionWarning
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", AssumptionWarning)
    """
