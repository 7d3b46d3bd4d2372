"""CompareError."""

from wm.errors import InputError


class CompareError(InputError):
    """What a comparison was given cannot be used: the message names the method, the file and what would be right."""
