"""Opens a dataset's page in headless Chromium: no error, nothing loaded from elsewhere, readable by all at any width.

Usage: `check_report.py DATASET [--screenshots FOLDER]`. Needs the package `playwright`, `axe-playwright-python`, and a Chromium: that of playwright,
or one on the PATH."""

from pathlib import Path

from playwright.sync_api import sync_playwright
from shared import chromium_of, command_line, end_with, faults_of_page, watch

WIDTHS = (1280, 400)
SCHEMES = ("light", "dark")

arguments = command_line("dataset", screenshots=Path)
page_file = (arguments.dataset / "report" / "index.html").resolve()
address = page_file.as_uri()
problems = []


def contents(page):
    """What must be there at all."""
    counts = {
        "landmarks": page.locator("header, nav, main, footer").count(),
        "sections": page.locator("main > section").count(),
        "maps and charts": page.locator("svg[role=img][aria-label]").count(),
        "pictures": page.locator("img[alt]").count(),
        "tiles of the statistics table": page.locator(".tile").count(),
        "planners": page.locator("#planners .wide tbody").first.locator("tr").count(),
    }
    least = {"landmarks": 4, "sections": 8, "maps and charts": 10, "pictures": 2, "tiles of the statistics table": 8, "planners": 5}
    problems.extend(f"{name}: {counts[name]}; at least {least[name]}" for name in least if counts[name] < least[name])
    missing = page.evaluate("[...document.querySelectorAll('nav a')].filter(it => !document.querySelector(it.hash)).length")
    if missing:
        problems.append(f"{missing} links of the contents lead nowhere")
    return counts


with sync_playwright() as playwright:
    browser = chromium_of(playwright)
    for width in WIDTHS:
        for scheme in SCHEMES:
            name = f"{width} px, {scheme}"
            page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
            watch(page, name, problems, address)
            page.goto(address)
            if arguments.screenshots:
                arguments.screenshots.mkdir(parents=True, exist_ok=True)
                page.screenshot(path=arguments.screenshots / f"report-{width}-{scheme}.png", full_page=True)
            counts = contents(page)
            problems.extend(faults_of_page(page, name))
            broken = page.evaluate("[...document.images].filter(it => !it.complete || it.naturalWidth == 0).length")
            problems += [f"{name}: {broken} pictures are broken"] * (broken > 0)
    browser.close()

print(f"report of {page_file.stat().st_size} bytes: " + ", ".join(f"{count} {name}" for name, count in counts.items()))
end_with(problems)
