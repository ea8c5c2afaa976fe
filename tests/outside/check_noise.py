"""Errors of sensors of motion and echoes of lidars against what their cards say: statistics and rays in numpy, without a line of cosfly.

Usage: `check_noise.py DATASET [--dry DATASET --rain DATASET] [--plant FAULT]`. DATASET has flights of `inertial_unit`, `barometer`, `magnetometer` and
`satellite_receiver`: Allan deviations at 1 s and where the bias wanders, noise and drift of pressures, the standard atmosphere, the dipole's field, and
satellites that boxes hide by every ray against every box. `--dry` and `--rain` are one recipe in two weathers, with a `vlp16`: intensities by material
and angle, and echoes that distance and rain leave. `--plant` spoils the readings first: the check must then fail."""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from shared import POINT, Town, allan, command_line, end_with, readings, require, rows, said

# Cards: white noise, unit per root hertz; deviation of the wandering bias, of 300 s.
CARDS = {"rate": (1.92e-4, 7.03e-5), "force": (1.83e-3, 2.45e-3)}
UNITS = {"rate": "rad_s", "force": "mps2"}
TIME_S = 300.0
# Reflectivities of the page on lidars by CARLA's label: roads, pavements, buildings, walls, leaves, cars.
REFLECTED = {1: 0.15, 2: 0.3, 3: 0.4, 4: 0.4, 9: 0.5, 14: 0.5}
RANGE_M, STATED, PRECIPITATION = 100.0, 0.8, {"dry": 0.0, "rain": 100.0}
FAULTS = ["white", "bias", "pressure", "field", "sky", "angle", "distance", "rain"]
wrong = []


def hold(name, is_so, detail):
    said(name, detail)
    if not is_so:
        wrong.append(f"{name}: {detail}")


def expected_variance(card, tau_s):
    """White noise and a Gauss-Markov process of first order."""
    density, deviation = card
    x = tau_s / TIME_S
    return density**2 / tau_s + 2 * deviation**2 / x * (1 - (3 - 4 * np.exp(-x) + np.exp(-2 * x)) / (2 * x))


def inertial(folder):
    pooled = {(kind, tau_s): [] for kind in CARDS for tau_s in (1.0, 200.0)}
    for frame in readings(folder, "inertial_unit").values():
        step_s = frame.time_s.iloc[1] - frame.time_s.iloc[0]
        for kind in CARDS:
            names = [f"{kind}_{axis}_{UNITS[kind]}" for axis in "xyz"]
            errors = frame[names].to_numpy() - frame[[f"true_{it}" for it in names]].to_numpy()
            if given.plant == "white":
                errors *= 1.25
            if given.plant == "bias":
                errors += CARDS[kind][1] * 3 * np.sin(np.arange(len(errors)) * step_s / 100)[:, None]
            for tau_s in (1.0, 200.0):
                if len(errors) * step_s > 5 * tau_s:
                    pooled[kind, tau_s] += list(allan(errors, step_s, tau_s))
    for (kind, tau_s), variances in pooled.items():
        require(variances, "no flight is 1000 s long")
        ratio = np.sqrt(np.mean(variances) / expected_variance(CARDS[kind], tau_s))
        least, most = (0.9, 1.1) if tau_s == 1.0 else (0.55, 1.6)
        hold(f"Allan deviation of {kind} at {tau_s:.0f} s", least < ratio < most, f"{np.sqrt(np.mean(variances)):.3e}, {ratio:.3f} of the card")


def barometer(folder):
    for flight, frame in readings(folder, "barometer").items():
        exact = 1013.25 * (1 - 2.25577e-5 * frame.true_altitude_m) ** 5.25588
        off = np.abs(exact - frame.true_pressure_hpa).max()
        hold("standard atmosphere", off < 2e-3, f"{flight}: {off:.1e} hPa")
        errors = (frame.pressure_hpa - frame.true_pressure_hpa).to_numpy() * (1.5 if given.plant == "pressure" else 1)
        white, drift = np.std(np.diff(errors)) / np.sqrt(2), np.sqrt(np.mean(errors**2))
        hold("noise of pressures", 0.0105 < white < 0.0135 and drift < 0.2, f"{flight}: white {white:.4f} hPa of 0.012, all {drift:.3f}")
        height = (1 - (frame.pressure_hpa / 1013.25) ** (1 / 5.25588)) / 2.25577e-5
        hold("altitudes of pressures", np.abs(height - frame.altitude_m).max() < 0.05, f"{np.abs(height - frame.altitude_m).max():.3f} m")


def geo(flight):
    return {word[1:6]: float(word[7:]) for word in (flight["town_geo_reference"] or "").split() if word.startswith(("+lat_0=", "+lon_0="))}


def degrees(flight):
    """Latitude and longitude of the world's origin, to what satellites and fields notice."""
    found = geo(flight)
    return (found["lat_0"], found["lon_0"]) if len(found) == 2 else (0.0, 0.0)


def magnetometer(folder, flights):
    inertial_rows = readings(folder, "inertial_unit")
    for flight, frame in readings(folder, "magnetometer").items():
        latitude = np.radians(degrees(flights[flight])[0])
        unit = inertial_rows[flight]
        turns = unit[["true_qx", "true_qy", "true_qz", "true_qw"]].to_numpy()[np.searchsorted(unit.time_s, frame.time_s - 1e-6)]
        # Rows of the matrix that turns vectors of the sensor into the world: y to the south, z up.
        _, south, up = np.moveaxis(Rotation.from_quat(turns).as_matrix(), 1, 0)
        field = 31.2 * (-np.cos(latitude) * south - 2 * np.sin(latitude) * up) * (1.02 if given.plant == "field" else 1)
        names = [f"field_{axis}_ut" for axis in "xyz"]
        off = np.abs(field - frame[[f"true_{it}" for it in names]].to_numpy()).max()
        hold("field of a dipole", off < 0.05, f"{flight}: {off:.1e} uT")
        errors = frame[names].to_numpy() - frame[[f"true_{it}" for it in names]].to_numpy()
        white, constant = errors.std(0).mean(), np.abs(errors.mean(0)).max()
        hold("noise of fields", 0.37 < white < 0.43 and constant < 2.0, f"{flight}: {white:.3f} uT of 0.4, constant {constant:.2f}")


def sky(latitude_deg, longitude_deg, day_s):
    """Directions to 24 satellites of six planes at 55 degrees in the left-handed world (x east, y south, z up), for each second of the day."""
    day = np.atleast_1d(day_s)[:, None]
    number = np.arange(24)
    plane, place = number % 6, number // 6
    node = 2 * np.pi * plane / 6 - 7.292115e-5 * day
    along = 2 * np.pi * (place / 4 + plane / 24) + 1.458423e-4 * day
    tilt = np.radians(55)
    orbit = 26_559_700 * np.stack([
        np.cos(along) * np.cos(node) - np.sin(along) * np.cos(tilt) * np.sin(node),
        np.cos(along) * np.sin(node) + np.sin(along) * np.cos(tilt) * np.cos(node),
        np.sin(along) * np.sin(tilt) * np.ones_like(node),
    ], -1)
    a, o = np.radians(latitude_deg), np.radians(longitude_deg)
    above = np.array([np.cos(a) * np.cos(o), np.cos(a) * np.sin(o), np.sin(a)])
    east, north = np.array([-np.sin(o), np.cos(o), 0]), np.array([-np.sin(a) * np.cos(o), -np.sin(a) * np.sin(o), np.cos(a)])
    way = orbit - 6_371_000 * above
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    return np.stack([way @ east, -(way @ north), way @ above], -1)


def hidden(town, eye, rays):
    """Whether each ray meets a box: every ray against every box."""
    which = np.flatnonzero(np.linalg.norm(town.center[:, :2] - eye[:2], axis=1) - town.reach < 2000)
    near, leaves, _ = town.span(which, eye, rays[:, None])
    enters = near.max(-1)
    return ((enters <= leaves) & (leaves > 0) & (enters < 2000)).any(-1)


def view(town, eye, rays):
    """Number of satellites and horizontal dilution of the directions that are seen."""
    high = rays[rays[:, 2] >= np.sin(np.radians(10))]
    seen = high[~hidden(town, eye, high)]
    if len(seen) < 4:
        return len(seen), np.nan
    inverse = np.linalg.inv((matrix := np.c_[-seen, np.ones(len(seen))]).T @ matrix)
    return len(seen), np.sqrt(inverse[0, 0] + inverse[1, 1])


def receiver(folder, flights):
    towns = Town.all_of(folder)
    for flight, frame in readings(folder, "satellite_receiver").items():
        town, place = towns[flights[flight]["town"]], degrees(flights[flight])
        eyes = frame[["true_east_m", "true_north_m", "true_up_m"]].to_numpy() * [1, -1, 1] + [0, 0, 40.0 if given.plant == "sky" else 0]
        chosen = np.linspace(0, len(frame) - 1, 40).astype(int)
        counts, dilutions, times = (frame[name].to_numpy()[chosen] for name in ("satellites", "horizontal_dilution", "time_s"))
        # The time of day is the flight's own: it is the one whose sky fits the first readings.
        days, off = np.arange(0, 86164, 60.0), None
        for row in (0, 13, 26, 39):
            rays = sky(*place, days + times[row])
            found = np.array([view(town, eyes[chosen[row]], it) for it in rays])
            fits = (found[:, 0] != counts[row]) * 1.0 + np.nan_to_num(np.minimum(np.abs(found[:, 1] - dilutions[row]), 1), nan=0.0)
            off = fits if off is None else off + fits
            days, off = days[off < off.min() + 0.2], off[off < off.min() + 0.2]
        first = days[np.argmin(off)]
        fine = np.arange(first - 60, first + 60, 1.0)
        row = np.argmax(dilutions > 0)
        misfit = [abs(view(town, eyes[chosen[row]], sky(*place, day + times[row])[0])[1] - dilutions[row]) for day in fine]
        first = fine[np.nanargmin(misfit)]
        found = np.array([view(town, eye, sky(*place, first + time)[0]) for eye, time in zip(eyes[chosen], times)])
        same = np.mean(found[:, 0] == counts)
        is_fix = (counts >= 4) & (dilutions > 0) & (found[:, 0] == counts)
        apart = np.abs(found[is_fix, 1] - dilutions[is_fix]).max() if is_fix.any() else np.nan
        hold("satellites that the town leaves", same >= 0.95 and apart < 0.02,
             f"{flight}: {100 * same:.0f} % of {len(chosen)} counts ({counts.min():.0f} to {counts.max():.0f}), dilutions within {apart:.4f}")


def swept(folder):
    """Points by sweep, time and ring; ranges, and the places of the lidar."""
    found = {}
    for row in rows(folder, "vlp16"):
        found[row["trajectory_id"], row["row"]] = (row, np.frombuffer(row["cloud"], POINT))
    return found


def loss(precipitation):
    return 1.076 * (50 * precipitation / 100) ** 0.67 * 1e-4 * np.log(10)


def power(intensity, range_m, loss_per_m):
    return intensity / STATED * (RANGE_M / range_m) ** 2 * np.exp(-2 * loss_per_m * range_m)


def intensities(folder):
    """Points on boxes: the reflectivity of the label times the cosine between the ray and the face."""
    towns, flights = Town.all_of(folder), {row["trajectory_id"]: row for row in rows(folder, "trajectories")}
    compared, off = 0, []
    for (flight, _), (row, points) in list(swept(folder).items())[:6]:
        town = towns[flights[flight]["town"]]
        turn = Rotation.from_quat([row[f"true_q{axis}"] for axis in "xyzw"]).as_matrix()
        early = points[(points["time"] < 0.02) & np.isin(points["label"], [3, 4])]
        range_m = np.linalg.norm(early["place"], axis=1)
        rays = (early["place"] / range_m[:, None]) @ turn.T
        eye = np.array([row[f"true_{axis}_m"] for axis in "xyz"])
        for point, ray, far in zip(early, rays, range_m):
            which = np.flatnonzero(town.instance == point["instance"])
            enters, leaves, along = town.span(which, eye, ray)
            near = enters.max(1)
            hit = np.flatnonzero((near <= leaves) & (np.abs(near - far) < 0.5))
            if len(hit):
                cosines = np.abs(along[hit, enters[hit].argmax(1)]) * (1.1 if given.plant == "angle" else 1)
                off.append(np.abs(REFLECTED[point["label"]] * cosines - point["intensity"]).min())
                compared += 1
    require(compared > 300, f"only {compared} points of walls were compared")
    hold("intensities of walls", np.quantile(off, 0.97) < 0.01, f"{compared} points, 97 % within {np.quantile(off, 0.97):.4f}")


def echoes(dry, rain):
    """Points by power: all are heard that have more than that of the weakest echo, and none with less; rain takes the light of its law."""
    least, lost, kept, gone = [], 0, 0, 0
    rain_loss = loss(PRECIPITATION["rain"]) * (0.5 if given.plant == "rain" else 1)
    sweeps = swept(rain)
    for key, (_, points) in swept(dry).items():
        range_m = np.linalg.norm(points["place"].astype(float), axis=1) * (1.1 if given.plant == "distance" else 1)
        least.append(power(points["intensity"], range_m, 0.0).min())
        there = sweeps[key][1]
        heard = {(time, ring) for time, ring in zip(there["time"], there["ring"])}
        is_heard = np.array([(time, ring) in heard for time, ring in zip(points["time"], points["ring"])])
        strength = power(points["intensity"], range_m, rain_loss)
        lost += (~is_heard & (strength > 1.5)).sum()
        kept += (is_heard & (strength < 0.6)).sum()
        gone += (~is_heard & (strength <= 1.5)).sum()
        all_heard = power(there["intensity"], np.linalg.norm(there["place"].astype(float), axis=1), rain_loss)
        least.append(all_heard.min())
    # The threshold has 10 % of noise that ends at 3.47 deviations.
    hold("weakest echoes", 0.65 < min(least) < 0.9, f"power {min(least):.3f} of the threshold")
    hold("drop-outs in rain", lost <= 2 and kept <= 2 and gone > 20, f"{gone} echoes gone that rain weakens; {lost} strong ones gone, {kept} weak ones kept")


given = command_line("folder", dry=Path, rain=Path, plant=str)
require(given.plant in [None, *FAULTS], f"--plant `{given.plant}` is none of {FAULTS}")
flights = {row["trajectory_id"]: row for row in rows(given.folder, "trajectories")}

inertial(given.folder)
barometer(given.folder)
magnetometer(given.folder, flights)
receiver(given.folder, flights)
if given.dry and given.rain:
    intensities(given.dry)
    echoes(given.dry, given.rain)
end_with(wrong)
