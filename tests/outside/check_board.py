"""Opens a page of `cosfly leaderboard` in headless Chromium: offline, no script, all entries, links that are links, hostile words as text, readable by
all at any width.

Usage: `check_board.py COSFLY ENTRIES SUITE WORK`. ENTRIES is a folder of sound entries, WORK a folder for a copy of it with hostile words beside.
Needs the package `playwright`, `axe-playwright-python`, and a Chromium: that of playwright, or one on the PATH."""

import json
import shutil
import subprocess

from shared import command_line, end_with, in_windows

HOSTILE = "<img src=x onerror=\\\"document.title='owned'\\\"></td></table><script>document.title='owned'</script>\\u202e&amp;"
arguments = command_line("cosfly entries suite work")
problems = []
entries = arguments.work / "entries"
shutil.copytree(arguments.entries, entries)
first = min(entries.glob("*.jsonl.zst")).name.removesuffix(".jsonl.zst")
(entries / f"{first}.toml").write_text(f'about = "{HOSTILE}"\nlicence = "{HOSTILE}"\nlink = "https://example.org/?a=\\"onmouseover=alert(1)"\nseconds = 1.5\n')
(entries / "cut'\"<b>.jsonl.zst").write_bytes(b"nothing")
page_file = (arguments.work / "index.html").resolve()
command = [arguments.cosfly, "leaderboard", entries, "--suite", arguments.suite, "--store", arguments.work / "store", "--out", page_file]
board = json.loads(subprocess.run([*command, "--json"], stdout=subprocess.PIPE, check=False).stdout)
assert subprocess.run(command, stdout=subprocess.PIPE, check=False).returncode == 1, "a refused entry is told by the code"
files = [it["file"] for suite in board["suites"] for it in suite["ranked"] + suite["knows_world"]]
assert first in files and len(files) == len(list(entries.glob("*.zst"))) - 1, files

for name, page in in_windows(page_file.as_uri(), problems, offline=True):
    if page.title() != "Leaderboard" or page.locator("script, img[onerror]").count():
        problems.append(f"{name}: words of an entry are no text")
    lines = page.locator("tbody tr").count()
    if lines < 2 * len(files):  # scores, groups of episodes
        problems.append(f"{name}: {lines} lines for {len(files)} entries")
    if page.locator("svg").count() < len(files) or page.get_by_text("core-s an episode").count() == 0:
        problems.append(f"{name}: a drawing or a column is missing")
    links = page.eval_on_selector_all("td a, th a", "all => all.map(it => [it.href, it.getAttributeNames().join()])")
    if len(links) != 1 or "onmouseover" in links[0][1] or not links[0][0].startswith("https://example.org/?a="):
        problems.append(f"{name}: links are {links}")

print(f"page of {page_file.stat().st_size} bytes: {len(files)} entries, {len(board['refused'])} refused")
end_with(problems)
