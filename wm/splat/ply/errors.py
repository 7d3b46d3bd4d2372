"""The one error of everything that reads a PLY file."""


class PlyError(ValueError):
    """A file that cannot be read as gaussians. The message names the file, the place in it, and what would be right."""
