"""Opens a dataset's page in headless Chromium: no error, nothing loaded from elsewhere, readable by all at any width.

Usage: `check_report.py DATASET [--screenshots FOLDER]`. Needs the package `playwright`, `axe-playwright-python`, and a Chromium: that of playwright,
or one on the PATH."""

from pathlib import Path

from shared import command_line, end_with, in_windows

PARTS = {  # what the page has, and at least how often
    "landmarks": ("header, nav, main, footer", 4), "sections": ("main > section", 8), "maps and charts": ("svg[role=img][aria-label]", 10),
    "pictures": ("img[alt]", 2), "tiles of the statistics table": (".tile", 8), "planners": ("#planners .wide tbody >> nth=0 >> tr", 5),
}

arguments = command_line("dataset", screenshots=Path)
page_file = (arguments.dataset / "report" / "index.html").resolve()
problems = []


def contents(page):
    """What must be there at all."""
    counts = {name: page.locator(selector).count() for name, (selector, _) in PARTS.items()}
    problems.extend(f"{name}: {counts[name]}; at least {least}" for name, (_, least) in PARTS.items() if counts[name] < least)
    missing = page.evaluate("[...document.querySelectorAll('nav a')].filter(it => !document.querySelector(it.hash)).length")
    if missing:
        problems.append(f"{missing} links of the contents lead nowhere")
    return counts


for name, page in in_windows(page_file.as_uri(), problems):
    if arguments.screenshots:
        page.screenshot(path=arguments.screenshots / f"report-{name.replace(' px, ', '-')}.png", full_page=True)
    counts = contents(page)
    broken = page.evaluate("[...document.images].filter(it => !it.complete || it.naturalWidth == 0).length")
    problems += [f"{name}: {broken} pictures are broken"] * (broken > 0)

print(f"report of {page_file.stat().st_size} bytes: " + ", ".join(f"{count} {name}" for name, count in counts.items()))
end_with(problems)
