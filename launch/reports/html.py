"""Parts of a page in one file: everything that came from a log is escaped, pictures are within."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from launch.scoring.scores import FAILED, PASSED
from uvf.runtime.messages.validation import escaped

STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1d2430; background: #fff; }
body { margin: 0 auto; padding: 1.5rem 2rem 4rem; max-width: 1320px; }
h1 { font-size: 1.7rem; margin: 0 0 .2rem; } h2 { font-size: 1.25rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid #d9dde5; }
nav { display: flex; flex-wrap: wrap; gap: .3rem 1rem; margin: .8rem 0 0; } a { color: #1559b5; }
table { border-collapse: collapse; font-size: .88rem; } .wide { overflow-x: auto; }
th, td { text-align: left; padding: .22rem .8rem .22rem 0; border-bottom: 1px solid #e7eaf0; vertical-align: top; }
th { color: #525c6b; font-weight: 600; } td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.passed { color: #1b6e34; font-weight: 600; } .FAILED { color: #b3261e; font-weight: 600; }
img { max-width: 100%; height: auto; } pre { background: #f5f6f9; padding: .8rem; overflow-x: auto; font-size: .82rem; }
details > summary { cursor: pointer; margin: .4rem 0; } .about { color: #525c6b; margin: 0; }
"""


def document(title: str, sections: Sequence[tuple[str, str]], head: str) -> str:
    """A whole page. sections: heading and content, named in a list of links below the head; head and contents are HTML."""
    links = "".join(f'<a href="#s{i}">{text(name)}</a>' for i, (name, _) in enumerate(sections))
    body = "".join(f'<section><h2 id="s{i}">{text(name)}</h2>{content}</section>' for i, (name, content) in enumerate(sections))
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{text(title)}</title><style>{STYLE}</style></head><body><header>{head}<nav>{links}</nav></header><main>{body}</main></body></html>\n"
    )


def text(value: object) -> str:
    """Anything as text in a page; control characters are written out."""
    return escape(escaped(str(value)))


def block(value: str) -> str:
    """Text of several lines as it is written."""
    return f"<pre>{'<br>'.join(text(line) for line in value.splitlines())}</pre>"


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; numbers are set to the right, verdicts coloured. Empty without rows."""
    made = "".join(f"<tr>{''.join(_cell(value) for value in row)}</tr>" for row in rows)
    titles = "".join(f'<th scope="col">{text(name)}</th>' for name in head)
    return f'<div class="wide"><table><thead><tr>{titles}</tr></thead><tbody>{made}</tbody></table></div>' if made else ""


def _cell(value: object) -> str:
    if isinstance(value, int | float):
        return f'<td class="number">{value:,.6g}</td>'.replace(",", " ")
    kind = f' class="{value}"' if value in (PASSED, FAILED) else ""
    return f"<td{kind}>{text(value)}</td>"


def picture(path: Path, about: str) -> str:
    """A PNG within the page; about: what it shows, for those who do not see it."""
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<p><img alt="{text(about)}" src="data:image/png;base64,{data}"></p>'


def paragraphs(lines: Iterable[str]) -> str:
    """A paragraph for each line."""
    return "".join(f"<p>{text(line)}</p>" for line in lines)


def folded(summary: str, content: str) -> str:
    """Content that is shown when its summary is clicked."""
    return f"<details><summary>{text(summary)}</summary>{content}</details>" if content else ""
