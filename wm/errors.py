"""The errors of a caller who asked for what cannot be done."""


class InputError(ValueError):
    """A configuration, a floor plan or a furnished room that cannot be used as it is; the command line exits with 2."""


class ArtifactError(InputError):
    """The run folder cannot be used as asked; the message says why and what would help."""
