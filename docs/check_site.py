"""Links and search of the built site: ``python docs/check_site.py docs/_build/html``.

Every link within the site must lead to a file and an anchor that are there, nothing may be loaded
from elsewhere, and the questions of ``questions.txt`` must find their pages.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from sphinx.search.en import SearchEnglish

QUESTIONS = Path(__file__).with_name("questions.txt")
_LOADING = {"script": "src", "img": "src", "link": "href"}


class Page(HTMLParser):
    """Anchors of a page, its links, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what the tag names and where it leads."""
        values = {name: value or "" for name, value in attrs}
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif values.get(_LOADING.get(tag, "")):
            self.loaded.append(values[_LOADING[tag]])


def broken_links(site: Path) -> Iterator[str]:
    """Yield what is wrong with the links of a site."""
    pages = {
        path: Page(path.read_text(encoding="utf-8"))
        for path in site.rglob("*.html")
        if "_static" not in path.parts
    }
    for path, page in sorted(pages.items()):
        place = path.relative_to(site)
        for link in {*page.links, *page.loaded}:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loaded and parts.scheme != "data":
                    yield f"{place}: loads {link}"
                elif parts.scheme not in ("https", "mailto", "data") or " " in link:
                    yield f"{place}: {link} is no address"
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                yield f"{place}: {link} leads to no file"
            elif target in pages and unquote(parts.fragment) not in pages[target].anchors | {""}:
                yield f"{place}: {link} leads to no anchor"


def found(index: dict, question: str) -> set[str]:
    """Return the pages that hold all words of a question, as the site's own search does."""
    language = SearchEnglish({})
    words = [word for word in re.findall(r"\w+", question.lower()) if len(word) > 1]
    hits = None
    for word in words:
        if word in language.stopwords:
            continue
        pages: set[int] = set()
        for table in ("terms", "titleterms"):
            places = index[table].get(language.stem(word), [])
            pages |= {places} if isinstance(places, int) else set(places)
        hits = pages if hits is None else hits & pages
    return {index["docnames"][page] for page in hits or ()}


def unanswered(site: Path) -> Iterator[str]:
    """Yield questions that do not find their page."""
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text[text.index("(") + 1 : text.rindex(")")])
    for line in QUESTIONS.read_text(encoding="utf-8").splitlines():
        question, page = line.split(" → ")
        if page not in found(index, question):
            yield f"search: {question!r} does not find {page}"


def main() -> int:
    """Print what is wrong; the exit code is 1 then."""
    site = Path(sys.argv[1]).resolve()
    wrong = [*broken_links(site), *unanswered(site)]
    print(*wrong, sep="\n")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
