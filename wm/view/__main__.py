"""The command line: python -m wm.view RUN serves a run's page until Ctrl-C; folder=OUT writes the page for any web host."""

import dataclasses
import pathlib
import sys
import threading
import webbrowser
from collections.abc import Sequence

from wm import console
from wm.errors import InputError
from wm.export.words import help_text, run_and_words
from wm.finished import open_finished
from wm.view.server import serve
from wm.view.site import Site, build_site, write_site

BAD_INPUT = 2
_USAGE = "python -m wm.view RUN [folder=OUT] [port=N] [browser=false]"
_SAYS = "Opens a page on which a finished run is walked through. Nothing is loaded from the network."
_KEYS = {
    "folder": "write the page into a new or empty folder instead, for any web host",
    "port": "port of the page on this machine; by default one that is free",
    "browser": "false: only print the address",
}


class ViewError(InputError):
    """A value on the command line that is none of its key; the message names what would be right."""


@dataclasses.dataclass(frozen=True)
class Asked:
    """What the command line asks for."""

    run: pathlib.Path
    folder: pathlib.Path | None = None
    port: int = 0
    browser: bool = True


def main(arguments: Sequence[str] | None = None) -> int:
    """Serves or writes the page. Returns 0, or 2 where that cannot be done; the reason is a line on standard error."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if {"-h", "--help"} & set(words):
        console.say(help_text(_USAGE, _SAYS, _KEYS))
        return 0
    try:
        asked = parsed(words)
        site = build_site(open_finished(asked.run))
        if asked.folder is not None:
            write_site(site, asked.folder)
            console.say(
                f"{asked.folder}: {len(site)} files; open it from any web host, such as python -m http.server -d {asked.folder}"
            )
        else:
            _served(site, asked)
    except (InputError, OSError) as error:
        console.warn(f"wm.view: {error}")
        return BAD_INPUT
    return 0


def parsed(words: Sequence[str]) -> Asked:
    """The words of a command line, as a record. Raises: ViewError, WordsError."""
    run, told = run_and_words(words, _KEYS)
    port, browser = told.get("port", "0"), told.get("browser", "true")
    if not (port.isascii() and port.isdigit() and int(port) < 1 << 16):
        raise ViewError(f"port={port}: a number from 0 (any that is free) to 65535")
    if browser not in ("true", "false"):
        raise ViewError(f"browser={browser}: true or false")
    folder = told.get("folder")
    if folder == "":
        raise ViewError("folder=: name a folder")
    return Asked(run, None if folder is None else pathlib.Path(folder), int(port), browser == "true")


def _served(site: Site, asked: Asked) -> None:
    with serve(site, asked.port) as address:
        console.say(f"{asked.run}: walk through it at {address} (for this machine only; Ctrl-C ends it)")
        if asked.browser:
            webbrowser.open(address)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            console.say("")


if __name__ == "__main__":
    console.end(main)
