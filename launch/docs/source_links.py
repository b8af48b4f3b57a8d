"""Hook of the documentation site: links to files of the repository that are no pages become their paths.

In the repository ``[the table](../../schemas/topics.py)`` is a link; the site, which holds pages alone, shows the words and the path.
A path that is not there is a warning, which ends a strict build.
"""

import logging
import posixpath
import re
from pathlib import Path
from typing import Any

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((?!\w+:|#|/)([^()\s#]+)(?:#[^()\s]*)?\)")
CODE = re.compile(r"(```.*?```|`[^`\n]*`(?!\]))", re.DOTALL)
log = logging.getLogger("mkdocs.hooks.source_links")


def on_page_markdown(markdown: str, *, page: Any, config: Any, files: Any) -> str:
    """Called by MkDocs with the text of each page; returns the text that is rendered."""
    del files
    return shown(markdown, page.file.src_uri, Path(config["docs_dir"]))


def shown(markdown: str, page: str, docs: Path) -> str:
    """The Markdown of a page with links to sources rewritten; page: path of the page below ``docs``."""
    parts = CODE.split(markdown)
    return "".join(part if i % 2 else LINK.sub(lambda m: _shown(m, page, docs), part) for i, part in enumerate(parts))


def _shown(link: re.Match[str], page: str, docs: Path) -> str:
    words, target = link.group(1), link.group(2)
    path = posixpath.normpath(posixpath.join(docs.name, posixpath.dirname(page), target))
    if path.startswith(f"{docs.name}/"):
        return link.group(0)
    if not (docs.parent / path).exists():
        log.warning("%s: link to '%s', which is not in the repository", page, path)
    return f"`{path}`" if words.strip("`") in (path, posixpath.basename(path)) else f"{words} (`{path}`)"
