"""The templates of the report (Jinja): what they are given is text and is escaped, unless it is Markup."""

import functools

import jinja2
from markupsafe import Markup


def fill(template: str, **values: object) -> Markup:
    """A template of `wm/report/templates` with these values in it. Raises: jinja2.UndefinedError for a value that is missing."""
    return Markup(_environment().get_template(template).render(values))


@functools.cache
def _environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.PackageLoader("wm.report"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
