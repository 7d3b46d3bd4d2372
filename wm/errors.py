"""The error of an input that cannot be used."""


class InputError(ValueError):
    """A configuration, a floor plan or a furnished room that cannot be used as it is; the command line exits with 2."""
