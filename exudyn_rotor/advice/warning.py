"""The warning about an assumption that does not hold."""


class AssumptionWarning(UserWarning):
    """An assumption of the model does not hold, or its error exceeds what was asked for."""
