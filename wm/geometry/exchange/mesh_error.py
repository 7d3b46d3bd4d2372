"""The error of a mesh file that cannot be used."""

from wm.errors import InputError


class MeshError(InputError):
    """A file holds no object that can be used; the message names the file, what is wrong and what would be right."""
