"""Completion at TAB for bash: scenes, flags, choices and keys, in a script that asks no Python.

    eval "$(wm --completion bash)"

Hydra has a completion of its own (`wm -sc install=bash`), which knows its overrides alone and composes the configuration at each
TAB.
"""

from collections.abc import Iterator, Sequence

from wm.cli.command_line import FLAGS, OWN_ANSWERS
from wm.cli.keys import Choices, Section
from wm.validate import ConfigError

_SCRIPT = """\
_wm() {
    local line=${COMP_LINE:0:COMP_POINT} word before
    word=${line##* } before=${line% *} before=${before##* }
    case $before in
        --plan | --output | --config-dir) return ;;
        --theme | --rooms | --name | --seed) return ;;
        --preset) COMPREPLY=($(compgen -W "@PRESETS@" -- "$word")); return ;;
    esac
    case $word in
        *.*) COMPREPLY=($(compgen -W "@KEYS@" -- "$word")) ;;
        *) COMPREPLY=($(compgen -W "@WORDS@" -- "$word")) ;;
    esac
    case ${COMPREPLY[0]} in *= | *.) compopt -o nospace ;; esac
    # where readline takes '=' for the end of a word, it wants only what comes after
    case $COMP_WORDBREAKS in *=*) case $word in *=*) COMPREPLY=("${COMPREPLY[@]#"${word%=*}="}") ;; esac ;; esac
}
complete -o default -F _wm wm
"""


def completion(shells: Sequence[str], sections: Sequence[Section], choices: Choices) -> str:
    """The script for a shell.

    Raises:
      ConfigError: there is no completion for this shell.
    """
    if list(shells) != ["bash"]:
        raise ConfigError("--completion is there for bash: write --completion bash")
    groups = [section for section in sections if section.name]
    words = [*choices["scene"], *FLAGS, *OWN_ANSWERS, "-m"]
    words += [f"{group}={name}" for group, files in choices.items() if group != "scene" for name in files]
    words += [f"{key}=" for key in sections[0].keys if key not in choices]
    words += [f"{section.name}." for section in groups if section.keys]
    keys = [word for section in groups for word in _assignments(section)]
    made = {"@WORDS@": words, "@KEYS@": keys, "@PRESETS@": list(choices["preset"])}
    script = _SCRIPT
    for mark, names in made.items():
        script = script.replace(mark, " ".join(names))
    return script.rstrip()


def _assignments(section: Section) -> Iterator[str]:
    """KEY= of each key, or KEY=VALUE of each value where there are few."""
    for key, field in section.keys.items():
        values = field.metadata.get("options") or (("true", "false") if isinstance(field.default, bool) else ("",))
        yield from (f"{section.name}.{key}={value}" for value in values)
