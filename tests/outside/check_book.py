"""The book: every link leads somewhere, every page is in the summary once, and what CONTRIBUTING asks of its text. Standard library only.

Usage: `check_book.py BUILT SOURCE [FILE.md ...]` (files beside the book that link into it). Of the text: guides have at most 1,200 words; README,
Getting started and the tutorial have sentences of under 30 words; lines have at most 160 columns but for tables, code and comments;
reference/environment.md names every environment variable that the tree reads."""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

MOST_WORDS_OF_A_GUIDE, MOST_WORDS_OF_A_SENTENCE, MOST_COLUMNS = 1200, 29, 160
# Written by the program from the documentation of keys, columns and codes, which have no line breaks.
GENERATED = {"reference/recipe.md", "reference/tables.md", "reference/codes.md", "reference/plugin-interface.md"}
LINK = re.compile(r"(?:\]\(|^\[[^\]]+\]: )([^)\s]+)", re.M)
READS = re.compile(r"""(?:env::var(?:_os)?|environ\.get|environ\.setdefault|folder)\(\s*"([A-Z][A-Z0-9_]+)"|environ\["([A-Z][A-Z0-9_]+)"\]"""
                   r"""|\benv = "([A-Z][A-Z0-9_]+)"|\b(COSFLY_(?!PLUGIN_|BINARY\b)[A-Z0-9_]+)\b""")


class Page(HTMLParser):
    """Ids, links and text of a page."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.text, self.is_code = set(), [], [], False
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.is_code = tag == "code" or self.is_code
        self.ids.update(attrs[key] for key in ("id", "name") if attrs.get(key))
        self.links += [attrs[key] for key in ("href", "src") if attrs.get(key)]

    def handle_endtag(self, tag):
        self.is_code = self.is_code and tag != "code"

    def handle_data(self, data):
        if not self.is_code:
            self.text.append(data)


def sentences(text):
    """Sentences of the prose of a Markdown page: no fences, tables, headings, targets of links."""
    text = re.sub(r"^(```|<!--).*?(^```|-->)$", "", text, flags=re.S | re.M)
    text = "\n".join("" if re.match(r"\s*(\||#|!\[|\[[^\]]+\]: )", line) else line for line in text.splitlines())
    text = re.sub(r"!?\[([^\]]*)\](\([^)]*\)|\[[^\]]*\])", r"\1", text)
    text = re.sub(r"`[^`]*`", "CODE", text)
    for block in re.split(r"\n\s*\n|\n\s*(?:[*-]|\d+\.) ", text):
        yield from re.split(r"(?<=[.?!])[*)]*\s+", " ".join(block.split()))


def faults_of_text(source, root):
    """Pages that are not in the summary once, long guides, long sentences, long lines."""
    listed = LINK.findall((source / "SUMMARY.md").read_text(encoding="utf-8"))
    pages = {str(path.relative_to(source)): path for path in source.rglob("*.md") if path.name != "SUMMARY.md"}
    for name in sorted({*listed, *pages}):
        if name not in pages or listed.count(name) != 1:
            yield f"SUMMARY.md lists `{name}` {listed.count(name)} times"
    for name, path in [("README.md", root / "README.md"), *sorted(pages.items())]:
        text = path.read_text(encoding="utf-8")
        if name.startswith("guide/") and len(text.split()) > MOST_WORDS_OF_A_GUIDE:
            yield f"{name}: {len(text.split())} words; a guide has at most {MOST_WORDS_OF_A_GUIDE}: move lists to the reference, reasons to concepts"
        if name in ("README.md", "paths.md", "guide/getting-started.md") or name.startswith("tutorial/"):
            for sentence in sentences(text):
                if len(sentence.split()) > MOST_WORDS_OF_A_SENTENCE:
                    yield f"{name}: {len(sentence.split())} words in a sentence: {sentence[:80]} ..."
        if name not in GENERATED:
            is_code = False
            for number, line in enumerate(text.splitlines(), 1):
                is_code ^= line.startswith("```")
                if len(line) > MOST_COLUMNS and not is_code and not line.startswith(("|", "<!--")):
                    yield f"{name}:{number}: {len(line)} columns; {MOST_COLUMNS} at most"


def unnamed_variables(source, root):
    """Environment variables that the tree reads and the reference does not name."""
    named = set(re.findall(r"`([A-Z][A-Z0-9_]+)`", (source / "reference/environment.md").read_text(encoding="utf-8")))
    read = {}
    for folder, endings in [("engine", "rs py"), ("plugins", "rs py"), ("recipes", "py"), ("tests", "rs py"), (".ci", "")]:
        for path in (root / folder).rglob("*"):
            if path.is_file() and path.suffix.strip(".") in endings.split(" ") and "target" not in path.parts:
                for groups in READS.findall(path.read_text(encoding="utf-8", errors="ignore")):
                    read.setdefault("".join(groups), path.relative_to(root))
    for name in sorted(read.keys() - named):
        if not name.startswith("CARGO_"):
            yield f"reference/environment.md does not name `{name}`, which {read[name]} reads"


def main():
    built, source = (Path(argument).resolve() for argument in sys.argv[1:3])
    root = source.parents[1]
    pages = {path.resolve(): Page(path) for path in built.rglob("*.html") if path.name not in ("404.html", "toc.html")}
    problems, links = [*faults_of_text(source, root), *unnamed_variables(source, root)], 0

    def check(place, path, anchor, name):
        if not path.exists():
            problems.append(f"{place}: `{name}` is not there")
        elif anchor and path in pages and anchor not in pages[path].ids:
            problems.append(f"{place}: `{name}`: no heading `#{anchor}`")

    for path, page in pages.items():
        # A link by a name that no line defines is printed as it was written.
        for left in re.findall(r"\[[^\]\n]+\]\[[^\]\n]+\]", "".join(page.text)):
            problems.append(f"{path.relative_to(built)}: `{left}` has no line that says where it leads")
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or (not parts.path and not parts.fragment):
                continue
            links += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if target.is_relative_to(built):
                check(path.relative_to(built), target, unquote(parts.fragment), link)
            else:
                problems.append(f"{path.relative_to(built)}: `{link}` leads out of the book")
    # Files of the repository link to sources; their headings are those of the built pages.
    for name in sys.argv[3:]:
        file = Path(name).resolve()
        for link in LINK.findall(file.read_text(encoding="utf-8")):
            parts = urlsplit(link)
            if parts.scheme or not parts.path:
                continue
            links += 1
            target = (file.parent / unquote(parts.path)).resolve()
            check(name, target, "", link)
            if source in target.parents and target.suffix == ".md" and target.name != "SUMMARY.md":
                check(name, built / target.relative_to(source).with_suffix(".html"), unquote(parts.fragment), link)
    print(*problems, sep="\n", file=sys.stderr)
    print(f"{len(pages)} pages, {links} links, {len(problems)} faults")
    sys.exit(bool(problems) or not pages)


main()
