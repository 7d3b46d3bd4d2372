"""The error of a caller who asked for what cannot be done."""


class InputError(ValueError):
    """A configuration, a floor plan or a furnished room that cannot be used as it is; the command line exits with 2."""
