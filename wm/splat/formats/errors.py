"""The one error of everything that reads or writes a file of gaussians."""

from wm.errors import InputError


class SplatFileError(InputError):
    """A file that cannot be read or written as gaussians. The message names the file and what would be right."""
