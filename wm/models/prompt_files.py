"""Prompts as files that a person can read, and replace by files of their own.

    wm/models/prompts/<family>/<name>.md      ours; a family is a path such as "image/nano_banana_pro" or "language/claude"
    wm/models/prompts/<parent of family>/...  what several families share
    <folder>/<name>.md                        a user's own, in the folder that the setting `prompts` of a backend names

A prompt is looked up by its name: in the user's folder, in the folder of its family, in those above. It is a Jinja template, and
its first comment has a line for each of its variables:

    {#
    What the image model is told for one view.

        theme   the scene in words
        sights  the doors and windows in view, a list of texts
    #}
    A photograph of this place: {{ theme }}.{% if sights %} In view: {{ sights | join("; ") }}.{% endif %}

A file of the user's has the variables of ours of the same name. `{% include "NAME.md" %}` puts another prompt in, and is looked
up in the same way. All of a family's files are read and checked when `Prompts` is made, before anything is asked.
"""

import dataclasses
import functools
import pathlib
import re
from collections.abc import Mapping
from typing import Any

import jinja2
import jinja2.meta
import jinja2.sandbox

from wm.bounds import setting
from wm.errors import InputError
from wm.schema import READ

PROMPTS = pathlib.Path(__file__).parent / "prompts"
"""The folder of our own prompts."""
_COMMENT = re.compile(r"\s*\{#(.*?)#\}", re.DOTALL)
_VARIABLE = re.compile(r"^ {4}(\w+)  ", re.MULTILINE)


class PromptError(InputError):
    """A prompt that cannot be read or filled in; the message names its file."""


def prompts_setting() -> Any:
    """The field `prompts` of a backend's Settings."""
    return setting(None, "Folder with prompts of your own, which take the place of ours by their file names; null: ours.", **READ)


@dataclasses.dataclass(frozen=True)
class Prompts:
    """The prompts of one family of models.

    Args:
      family: folder below `wm/models/prompts`, such as "image/nano_banana_pro".
      folder: the user's own prompts; None for none.

    Raises:
      PromptError: the folder or a file in it cannot be read, is no prompt of the family, or uses a variable that ours does not.
    """

    family: str
    folder: str | None = None

    def __post_init__(self) -> None:
        for name in sorted(self._files):
            self._check(name)

    def write(self, name: str, **values: Any) -> str:
        """A prompt with its variables filled in, without white space around it.

        Args:
          name: of the prompt, without ".md".
          values: of all variables that the comment of our file names.

        Raises:
          PromptError: it cannot be filled in.
          ValueError: there is no such prompt in the family, or these are not its variables.
        """
        if f"{name}.md" not in self._files or values.keys() != self.variables(name):
            raise ValueError(f"prompt {self.family}/{name}.md is not there with the variables {', '.join(sorted(values))}")
        try:
            return self._environment.get_template(f"{name}.md").render(values).strip()
        except (jinja2.TemplateError, TypeError, ValueError, ArithmeticError) as error:
            raise PromptError(f"{self._files[f'{name}.md']}: cannot be filled in: {error}") from error

    def variables(self, name: str) -> frozenset[str]:
        """The variables of a prompt, as the comment of our file names them."""
        comment = _COMMENT.match(_read(self._ours[f"{name}.md"]))
        return frozenset(_VARIABLE.findall(comment[1]) if comment else ())

    @functools.cached_property
    def _ours(self) -> Mapping[str, pathlib.Path]:
        """Our file of each name, that of the family before those above it."""
        folders = [PROMPTS / self.family, *(PROMPTS / parent for parent in pathlib.PurePosixPath(self.family).parents)]
        return {file.name: file for folder in reversed(folders[:-1]) for file in folder.glob("*.md")}

    @functools.cached_property
    def _files(self) -> Mapping[str, pathlib.Path]:
        """The file that is used for each name."""
        if self.folder is None:
            return self._ours
        folder = pathlib.Path(self.folder).expanduser()
        if not folder.is_dir():
            raise PromptError(f"{self._setting}: no such folder; a folder with files such as {self._some} would be right")
        theirs = {file.name: file for file in folder.glob("*.md")}
        for name in sorted(theirs.keys() - self._ours.keys()):
            raise PromptError(
                f"{theirs[name]} takes the place of no prompt of {self.family}; it has {', '.join(sorted(self._ours))}"
            )
        if not theirs:
            raise PromptError(f"{self._setting}: no file such as {self._some} is there")
        return {**self._ours, **theirs}

    @functools.cached_property
    def _texts(self) -> dict[str, str]:
        return {name: _read(file).rstrip() + "\n" for name, file in self._files.items()}

    @property
    def _setting(self) -> str:
        return f"{pathlib.PurePosixPath(self.family).parts[0]}.prompts={self.folder}"

    @property
    def _some(self) -> str:
        return next(iter(sorted(self._ours)), "NAME.md")

    @functools.cached_property
    def _environment(self) -> jinja2.Environment:
        return jinja2.sandbox.ImmutableSandboxedEnvironment(
            loader=jinja2.DictLoader(self._texts),
            undefined=jinja2.StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            keep_trailing_newline=True,
        )

    def _check(self, name: str) -> None:
        file = self._files[name]
        try:
            used = jinja2.meta.find_undeclared_variables(self._environment.parse(self._texts[name]))
        except jinja2.TemplateSyntaxError as error:
            raise PromptError(f"{file}, line {error.lineno}: {error.message}") from error
        known = self.variables(name.removesuffix(".md"))
        if unknown := sorted(used - known):
            raise PromptError(f"{file} uses {', '.join(unknown)}; its variables are {', '.join(sorted(known)) or 'none'}")


def _read(file: pathlib.Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise PromptError(f"{file}: cannot be read: {error}") from error
