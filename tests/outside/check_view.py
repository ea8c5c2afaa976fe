"""Opens `cosfly view` in headless Chromium: worst flight, filter, scrubbing, hostile texts, broken logs, narrow windows, the exported page.

Usage: `check_view.py COSFLY DATASET WORK [--results FOLDER] [--screenshots FOLDER] [--many COUNT] [--timed]`. WORK is a folder for copies of
DATASET, `--results` a folder of `cosfly fly` with several policies. With `--many`, first view and scrubbing are timed with that many copies of its
flights, and with `--timed`, on an idle machine, times are held, too. Needs `playwright`, `axe-playwright-python`, `pyarrow`, and a Chromium: that
of playwright, or one on the PATH."""

import contextlib
import itertools
import re
import shutil
import subprocess
import time
from collections import defaultdict
from pathlib import Path

import pyarrow as pa
import pyarrow.compute
import pyarrow.parquet as pq
from playwright.sync_api import sync_playwright
from shared import chromium_of, command_line, end_with, faults_of_page, rows, watch, with_column

FIRST_VIEW_S = 2.0
PAINTED_MS = 100.0
MOST_SERVER_MB = 500
HOSTILE = "<img src=x onerror=\"document.title='owned'\">"
CHINESE = "晴朗的夜晚"
CHINESE_LETTERS = re.compile("[\u4e00-\u9fff]{4}")

arguments = command_line("cosfly dataset work", results=Path, screenshots=Path, many=int, timed=False)
problems = []


def expect(is_so, words):
    """Notes what is wrong."""
    if not is_so:
        problems.append(words)


@contextlib.contextmanager
def served(subject):
    """The address of a running server and its process, which must end well."""
    process = subprocess.Popen([arguments.cosfly, "view", str(subject), "--no-open"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        yield process.stdout.readline().strip(), process
    finally:
        process.terminate()
        process.wait(timeout=30)
    expect(process.returncode == 0, f"the server ended with {process.returncode}")


@contextlib.contextmanager
def opened(browser, address, name, **options):
    """A page that notes errors and requests to others."""
    page = browser.new_page(**{"viewport": {"width": 1360, "height": 900}, **options})
    watch(page, name, problems, address.split("?")[0], lambda it: it.type == "error" and "422" not in it.text)  # a wrong filter
    page.goto(address)
    page.wait_for_selector("#flight:not([hidden]) #map[data-frame]")
    yield page
    page.close()


def shoot(page, name):
    """A screenshot, and what must hold in every window."""
    if arguments.screenshots:
        arguments.screenshots.mkdir(parents=True, exist_ok=True)
        page.screenshot(path=arguments.screenshots / f"view-{name}.png")
    problems.extend(faults_of_page(page, name))


def painted(page, frame):
    """Waits until all pictures show a frame."""
    page.wait_for_function(
        "frame => document.querySelector('#map').dataset.frame == frame"
        " && [...document.querySelectorAll('#pictures canvas')].every(it => it.dataset.frame == frame)",
        arg=str(frame),
    )


def all_painted(page):
    """Waits until every picture, also that of the flight beside, shows the frame of the map."""
    page.wait_for_function(
        "() => { const panes = [...document.querySelectorAll('#pictures canvas')], { frame } = document.querySelector('#map').dataset;"
        " return state.beside && panes.length > 3 && panes.every(it => it.dataset.frame !== undefined) && frame !== undefined; }"
    )


def longest_losses():
    """Of each flight the longest stretch of frames without a pixel of the target, by the tables alone: seconds, first frame, end."""
    steps = {row["trajectory_id"]: row["dt_s"] for row in rows(arguments.dataset, "trajectories", ["trajectory_id", "dt_s"])}
    seen = defaultdict(dict)
    for row in rows(arguments.dataset, "frames", ["trajectory_id", "frame", "visible_pixels"]):
        seen[row["trajectory_id"]][row["frame"]] = row["visible_pixels"] > 0
    found = {}
    for id, of_flight in seen.items():
        frames = [frame for frame in sorted(of_flight) if not of_flight[frame]]
        stretches = [list(group) for _, group in itertools.groupby(enumerate(frames), lambda it: it[1] - it[0])]
        longest = max(stretches, key=len, default=[])
        found[id] = (len(longest) * steps[id], longest[0][1] if longest else 0, longest[-1][1] + 1 if longest else 0)
    return found


def check_whole(browser):
    """Worst flight first, its reason and its frame; filters; keys; links."""
    with served(arguments.dataset) as (address, _), opened(browser, address, "whole") as page:
        expect("token" not in page.url, "the token stays in the address")
        page.wait_for_selector("#pictures canvas[data-frame]")
        first = page.locator(".row").first
        expect(first.get_attribute("aria-selected") == "true", "the worst flight is not chosen")
        reason = page.locator("#reason").inner_text()
        expect(reason and reason in first.inner_text(), "the reason of the worst flight is not told")
        losses = page.evaluate("state.index.columns.find(it => it.name == 'losses_s').numbers")
        chosen = page.evaluate("state.flight.number")
        expect(losses[chosen] == max(losses), f"flight {chosen} loses its target for {losses[chosen]} s, another one for {max(losses)} s")
        truth = longest_losses()
        lost_s, begin, end = truth[page.evaluate("state.flight.name")]
        expect(lost_s == max(it[0] for it in truth.values()), f"by the tables another flight loses its target for longer than {lost_s} s")
        expect(not lost_s or f"for {lost_s:.1f} s from frame {begin}" in reason, f"by the tables it is lost for {lost_s} s from frame {begin}, not `{reason}`")
        expect(not lost_s or begin <= page.evaluate("state.frame") < end, "the page does not open within the worst loss")
        shoot(page, "whole")
        for query, is_lost in (("losses_s > 0.5", True), ("losses over 0.5 s", True), ("not losses_s > 0.5", False)):
            page.fill("#query", query)
            shown = page.evaluate("list.order")
            expect(sorted(shown) == [at for at, loss_s in enumerate(losses) if (loss_s > 0.5) == is_lost], f"`{query}` shows {shown}")
        for query, words in (("at night facing the sun (experts or twins)", "flight"), ("speed > 3", "no column `speed`"), ("losses_s >", "needs a value"),
                             ("nothing-is-called-so", "no flight is like this"), ("(experts", "not closed"), ("losses_s = high", "with a number"), ("constructor", "no flight is like this")):
            page.fill("#query", query)
            expect(words in page.locator("#matches").inner_text(), f"`{query}`: {page.locator('#matches').inner_text()}")
        page.fill("#query", "")
        page.locator("#map").focus()
        for key in ("Home", "ArrowRight", "Shift+ArrowRight"):
            page.keyboard.press(key)
        painted(page, 11)
        page.wait_for_function("() => location.hash.includes('frame=11')")
        page.keyboard.press("ArrowDown")
        page.wait_for_function(f"() => state.flight.number != {chosen}")
        link = page.evaluate("`#flight=${encodeURIComponent(state.index.columns[0].texts[0])}&frame=3`")
        page.evaluate("link => { location.hash = link; }", link)
        page.wait_for_function("() => state.flight.number == 0 && state.frame == 3")
        expect(page.locator("#beside option").count() >= 2, "no twin stands beside the expert")


def check_places(browser):
    """All flights of a town on the map, of which a click chooses one; the town in 3-D."""
    with served(arguments.dataset) as (address, _), opened(browser, address, "places") as page:
        page.click("#all")
        page.wait_for_function("() => map.paths")
        index = "name => state.index.columns.find(it => it.name == name).texts"
        town = page.evaluate(f"({index})('town')[state.flight.number]")
        count = page.evaluate(f"({index})('town')").count(town)
        expect(page.evaluate("map.paths.length") == count, f"the map has not all {count} flights of {town}")
        shoot(page, "all-flights")
        found = page.evaluate("""() => {
            // A flight, and a place of the map around which a click chooses it.
            const chosen = [];
            map.choose = number => chosen.push(number);
            const around = [[0, 0], [2, 0], [-2, 0], [0, 2], [0, -2]];
            const isOf = (number, [left, top]) => around.every(([right, down]) => {
                map.clicked(left + right, top + down);
                return chosen.pop() === number;
            });
            const canvas = [map.canvas.clientWidth, map.canvas.clientHeight];
            const places = map.paths.filter(([number]) => number !== state.flight.number).flatMap(([number, points]) =>
                points.map((_, at) => at).filter(at => at % 3 === 0).map(at => [number, [0, 1].map(axis =>
                    Math.round((points[at + axis] - [map.view.x, map.view.y][axis]) * map.view.scale + canvas[axis] / 2))]));
            const found = places.find(([number, place]) => isOf(number, place));
            map.choose = number => choose(number);
            return found;
        }""")
        expect(found, "no place of the map chooses another flight")
        if found:
            other, (left, top) = found
            page.locator("#map").click(position={"x": left, "y": top})
            page.wait_for_function(f"() => state.flight.number == {other}")
        if page.locator("#solid").is_visible():
            page.click("#solid")
            page.wait_for_selector("#scene:not([hidden])[data-frame]")
            expect(page.locator("#map").is_hidden(), "the map stands beside the 3-D view")
            expect(page.evaluate("scene.gl.getError()") == 0 and page.evaluate("scene.still.count") > 100, "the 3-D view draws nothing")
            page.mouse.move(*(page.locator("#scene").bounding_box()[side] + 100 for side in "xy"))
            page.mouse.down()
            page.mouse.move(*(page.locator("#scene").bounding_box()[side] + 130 for side in "xy"))
            page.mouse.up()
            colours = page.evaluate("""() => {
                scene.draw(state.frame);
                const [width, height] = [scene.canvas.width, scene.canvas.height];
                const pixels = new Uint8Array(4 * width * height);
                scene.gl.readPixels(0, 0, width, height, scene.gl.RGBA, scene.gl.UNSIGNED_BYTE, pixels);
                return new Set(new Uint32Array(pixels.buffer)).size;
            }""")
            expect(colours > 8, f"the 3-D view has {colours} colours")
            shoot(page, "solid")
        else:
            print("no WebGL in this browser: the 3-D view is not checked")


def check_empty(browser):
    """A dataset without flights, such as one that is not finished, is shown with words."""
    folder = copy("empty")
    for table in ("trajectories", "frames", "bodies", "captions", "goals", "windows", "crossings"):
        for path in folder.glob(f"data/{table}/*.parquet"):
            pq.write_table(pq.read_table(path)[:0], path)
    with served(folder) as (address, _):
        page = browser.new_page(viewport={"width": 1360, "height": 900})
        page.on("pageerror", lambda it: problems.append(f"empty: error: {it}"))
        page.goto(address)
        page.wait_for_function("() => document.getElementById('matches').textContent")
        words = page.locator("#matches").inner_text()
        expect("no table `trajectories`" in words and "cosfly run" in words, f"an empty dataset is told by `{words}`")
        shoot(page, "empty")
        page.close()


def check_one(browser):
    """A single flight, in a folder with a Chinese name and a Chinese title, in a narrow window."""
    folder = copy("一次飞行")
    for table in ("trajectories", "frames", "captions"):
        for path in folder.glob(f"data/{table}/*.parquet"):
            table_of_all = pq.read_table(path)
            pq.write_table(table_of_all.filter(pa.compute.equal(table_of_all["trajectory_id"], "expert-p00000")), path)
    with served(folder) as (address, _), opened(browser, address, "one", viewport={"width": 360, "height": 740}) as page:
        page.wait_for_selector("#pictures canvas[data-frame]")
        expect("1 flight" in page.locator("#matches").inner_text() or page.locator(".row").count() == 1, "a single flight is not the only one")
        expect(page.evaluate("state.flight.name") == "expert-p00000", "the only flight is not chosen")
        expect(CHINESE_LETTERS.search(page.locator("#words").inner_text()), "Chinese captions are not shown")
        for key in ("ArrowDown", "ArrowUp", "l", "End"):
            page.keyboard.press(key)
        shoot(page, "one-narrow")


def check_results(browser):
    """Policy beside policy: the worst episode, its reason and its frame."""
    with served(arguments.results) as (address, _), opened(browser, address, "results") as page:
        page.wait_for_function("() => state.beside")
        rates = page.evaluate("state.index.columns.find(it => it.name == 'tracking_rate').numbers")
        number = page.evaluate("state.flight.number")
        expect(rates[number] == min(rates), f"episode {number} with {rates[number]} is shown first, another one has {min(rates)}")
        reason, losses = page.locator("#reason").inner_text(), page.evaluate("state.flight.losses")
        longest = max(losses, key=lambda it: it["end"] - it["from"])
        expect(f"from frame {longest['from']}" in reason and f"(frame {page.evaluate('state.flight.x.length') - 1})" in reason, f"frames are not in `{reason}`")
        expect(page.evaluate("state.frame") == longest["from"], "the page does not open with the longest loss")
        policies = page.evaluate("[state.flight.facts, state.beside.facts].map(it => Object.fromEntries(it).policy)")
        expect(len(set(policies)) == 2, f"beside stands {policies}")
        shoot(page, "results")


def copy(name):
    """A copy of the dataset."""
    folder = arguments.work / name
    shutil.copytree(arguments.dataset, folder)
    return folder


def check_hostile(browser):
    """Texts of a stranger are shown as texts; broken logs are told; narrow and dark windows."""
    folder = copy("hostile")
    for path in folder.glob("data/trajectories/*.parquet"):
        table = pq.read_table(path)
        for name, text in (("town", HOSTILE), ("weather_preset", CHINESE), ("pedestrian_id", HOSTILE)):
            table = with_column(table, name, [text] * len(table))
        pq.write_table(table, path)
    for path in folder.glob("data/captions/*.parquet"):
        table = pq.read_table(path)
        pq.write_table(with_column(table, "text", [HOSTILE + CHINESE] * len(table)), path)
    for path in sorted(folder.glob("mcap/**/*.mcap")):
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    narrow_and_dark = {"viewport": {"width": 400, "height": 900}, "color_scheme": "dark"}
    with served(folder) as (address, _), opened(browser, address, "hostile", **narrow_and_dark) as page:
        page.wait_for_selector("#problem:not([hidden])")
        expect("damaged" in page.locator("#problem").inner_text(), "a broken log is not told")
        expect(HOSTILE in page.locator("#facts").inner_text(), "the town's name is not shown as it is")
        expect(CHINESE in page.locator("#facts").inner_text(), "Chinese is not shown")
        expect(page.locator("main img").count() == 0 and page.title() != "owned", "a text became an element")
        shoot(page, "hostile-narrow-dark")


def check_exported(browser):
    """The page in one file."""
    path = arguments.work / "page.html"
    subprocess.run([arguments.cosfly, "view", str(arguments.dataset), "--export", str(path)], check=True, stdout=subprocess.DEVNULL)
    expect(path.stat().st_size <= 50_000_000, "the exported page is too large")
    with opened(browser, path.resolve().as_uri(), "exported") as page:
        page.wait_for_selector("#pictures canvas[data-frame]")
        expect("exported" in page.locator("#about").inner_text(), "the exported page does not say so")
        held = "pictures.panes.every(pane => pane.flight.x.every((_, at) => source.picture(pane.flight.number, pictures.place(pane, at), pane.channel)))"
        expect(page.evaluate(held), "boxes of the exported page are of frames without a picture")
        shoot(page, "exported")


def multiplied(count):
    """A dataset with the flights of DATASET again and again, under other names, with the same logs."""
    folder = copy("many")
    for table_name in ("trajectories", "frames"):
        paths = sorted(folder.glob(f"data/{table_name}/*.parquet"))
        tables = [pq.read_table(path) for path in paths]
        names = [name for name in tables[0].column_names if "preview" not in name]
        table = pa.concat_tables([it.select(names) for it in tables])
        flights = len(set(table["trajectory_id"].to_pylist()))
        with pq.ParquetWriter(paths[0], table.schema) as writer:
            for begin in range(0, -(-count // flights), 100):  # row groups as large as those of real datasets
                parts = []
                for number in range(begin, min(begin + 100, -(-count // flights))):
                    again = table
                    for name in {"trajectory_id", "flight_id", "expert_id"} & set(names):
                        again = with_column(again, name, [it and f"{it}-{number:05}" for it in table[name].to_pylist()])
                    parts.append(again)
                writer.write_table(pa.concat_tables(parts).combine_chunks())
        for path in paths[1:]:
            path.unlink()
    return folder


def check_many(browser):
    """Times of first view and scrubbing, memory of the server."""
    folder = multiplied(arguments.many)
    began = time.monotonic()
    with served(folder) as (address, process):
        ready_s, began = time.monotonic() - began, time.monotonic()
        with opened(browser, address, "many") as page:
            all_painted(page)
            first_s = time.monotonic() - began
            shoot(page, "many")
            frames = page.evaluate("state.flight.x.length")
            for frame in range(frames):
                page.evaluate("frame => setFrame(frame)", frame)
                painted(page, frame)
            times = page.evaluate(
                """async frames => {
                    const times = [];
                    for (let at = 0; at < 200; at += 1) {
                        const [frame, began] = [(at * 7) % frames, performance.now()];
                        setFrame(frame);
                        await new Promise(done => {
                            const look = () => [...document.querySelectorAll('#pictures canvas')].every(it => it.dataset.frame == frame)
                                ? done() : requestAnimationFrame(look);
                            requestAnimationFrame(look);
                        });
                        times.push(performance.now() - began);
                    }
                    return times.sort((a, b) => a - b);
                }""",
                frames,
            )
            status = Path(f"/proc/{process.pid}/status").read_text()
            peak_mb, size = int(status.split("VmHWM:")[1].split()[0]) / 1024, page.evaluate("state.flight.size")
            late_ms = times[int(0.95 * len(times))]
            flights = page.evaluate("state.index.flights")
            print(f"{flights} flights: server ready after {ready_s:.2f} s, first view {first_s:.2f} s; of 200 inputs at {size[0]} x {size[1]} "
                  f"95 % painted within {late_ms:.0f} ms; server {peak_mb:.0f} MB")
            expect(not arguments.timed or first_s <= FIRST_VIEW_S, f"the first view takes {first_s:.2f} s")
            expect(not arguments.timed or late_ms <= PAINTED_MS, f"95 % of inputs are painted within {late_ms:.0f} ms")
            expect(peak_mb <= MOST_SERVER_MB, f"the server takes {peak_mb:.0f} MB")


with sync_playwright() as playwright:
    chromium = chromium_of(playwright)
    arguments.work.mkdir(parents=True, exist_ok=True)
    checks = [check_whole, check_places, check_empty, check_one, check_hostile, check_exported]
    for check in checks + [check_results] * bool(arguments.results) + [check_many] * bool(arguments.many):
        check(chromium)
    chromium.close()

end_with(problems)
