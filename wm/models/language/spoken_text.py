"""An answer without the reasoning that some models put before it, where their server has not taken it out."""

import re

_HARMONY = re.compile(r"<\|channel\|>\s*final[^<]*<\|message\|>(.*?)(?:<\|(?:return|end|call)\|>|\Z)", re.DOTALL)
"""gpt-oss writes channels: analysis, commentary, and final, which is the answer."""
_THOUGHT = re.compile(r"\A.*</think(?:ing)?>", re.DOTALL)
"""Others close their reasoning with a tag. The one that opens it may stand in the prompt, and not in the answer."""


def spoken_text(text: str) -> str:
    """What a model says, without its reasoning and without white space around it."""
    channels = _HARMONY.findall(text)
    return _THOUGHT.sub("", channels[-1] if channels else text).strip()
