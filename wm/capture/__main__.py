"""The command line: python -m wm.capture RUN."""

import sys
from collections.abc import Sequence

from wm import console
from wm.capture.capturing import capture
from wm.capture.request import KEYS, parse_request
from wm.errors import InputError

BAD_INPUT = 2
USAGE = "usage: python -m wm.capture RUN [key=value ...]"


def main(words: Sequence[str] | None = None) -> int:
    """Captures a trajectory and prints where. Returns 0, or 2 where that cannot be; the reason is a line on stderr."""
    words = sys.argv[1:] if words is None else words
    if {"-h", "--help"} & set(words):
        says = "Posed images, depth, normals and labels along a trajectory through a finished run."
        console.say("\n".join([USAGE, "", says, "", *(f"  {key:<11} {what}" for key, what in KEYS.items())]))
        return 0
    try:
        request = parse_request(words)
        count = capture(request)
    except (InputError, OSError) as error:
        console.warn(f"wm.capture: {error}")
        return BAD_INPUT
    console.say(f"{count} frames as {', '.join(request.formats)}: {request.folder}")
    return 0


if __name__ == "__main__":
    console.end(main)
