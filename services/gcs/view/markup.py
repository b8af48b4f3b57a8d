"""HTML and SVG as a type of its own: ``html`` is the one place where text becomes markup, and it escapes all that is not markup yet.

Whatever shows markup takes ``Html``, so a string put together otherwise (an f-string, ``+``, ``str.join``) does not pass
the type checker; where it gets by, it is escaped as a whole and seen as text.
"""

from collections.abc import Iterable
from html import escape
from numbers import Real


class Html(str):
    """Text that is safe to send to a browser as markup."""

    __slots__ = ()


def html(template: str, *values: object, **named: object) -> Html:
    """The template, a literal of this program, with ``{}`` filled as by ``str.format``; values are escaped, quotes too."""
    return Html(template.format(*map(_safe, values), **{name: _safe(value) for name, value in named.items()}))


def joined(parts: Iterable[object], between: str = "") -> Html:
    """The parts one after the other; what is no markup is escaped."""
    return Html(str(_safe(between)).join(str(_safe(part)) for part in parts))


def trusted(text: str) -> Html:
    """Marks text as markup without escaping: only for what this program itself provides."""
    return Html(text)


def _safe(value: object) -> object:
    """Numbers stay numbers, for their formats."""
    return value if isinstance(value, Html | Real) else Html(escape(str(value)))
