"""The built book: every page, picture and anchor that a page names exists. Standard library only.

usage: check_book.py BUILT SOURCE [FILE.md ...]   (files beside the book that link into it)
"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Ids and links of a page."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.ids.update(attrs[key] for key in ("id", "name") if attrs.get(key))
        self.links += [attrs[key] for key in ("href", "src") if attrs.get(key)]


def main():
    built, source = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    pages = {path.resolve(): Page(path) for path in built.rglob("*.html") if path.name not in ("404.html", "toc.html")}
    problems, links = [], 0

    def check(place, path, anchor, name):
        if not path.exists():
            problems.append(f"{place}: `{name}` is not there")
        elif anchor and path in pages and anchor not in pages[path].ids:
            problems.append(f"{place}: `{name}`: no heading `#{anchor}`")

    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or (not parts.path and not parts.fragment):
                continue
            links += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if built not in target.parents and target != built:
                problems.append(f"{path.relative_to(built)}: `{link}` leads out of the book")
                continue
            check(path.relative_to(built), target, unquote(parts.fragment), link)
    # Files of the repository link to sources; their headings are those of the built pages.
    for name in sys.argv[3:]:
        file = Path(name).resolve()
        for link in re.findall(r"\]\(([^)\s]+)\)", file.read_text(encoding="utf-8")):
            parts = urlsplit(link)
            if parts.scheme or not parts.path:
                continue
            links += 1
            target = (file.parent / unquote(parts.path)).resolve()
            if source in target.parents and target.suffix == ".md" and target.name != "SUMMARY.md":
                html = built / target.relative_to(source).with_suffix(".html")
                check(name, target, "", link)
                check(name, html, unquote(parts.fragment), link)
            else:
                check(name, target, "", link)
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(pages)} pages, {links} links, {len(problems)} of them lead nowhere")
    sys.exit(bool(problems) or not pages)


main()
