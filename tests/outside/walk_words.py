"""What a walk does by the places of the feet alone, and whether a description of it says so: turns, times, length and pace.

Shares no code with cosfly. At every quarter of a metre of the way, the chord of the 3 m (5 m) before it and the chord of the 3 m (5 m) behind it have
an angle: the way turns there as far as both say, and somebody may call it a turn where one of them says so."""

import re
from functools import cache

import numpy as np
from shared import turned

STEP_M = 0.25
CHORDS_M = (3.0, 5.0)


class Way:
    """The way of a target from its feet (frames x 2, metres) and whether it walks in each frame."""

    def __init__(self, feet, walks, dt):
        self.dt, self.count = dt, len(feet)
        steps = np.hypot(*np.diff(feet[:, :2], axis=0).T) if len(feet) > 1 else np.zeros(0)
        self.along = np.concatenate([[0.0], np.cumsum(steps)])
        self.walked = np.cumsum(walks) * dt
        self.length = self.along[-1]
        self.feet = feet[:, :2]
        self.places = np.arange(0.0, self.length + 1e-9, STEP_M)
        self.angles = np.array([[self.angle(place, place, chord) for chord in CHORDS_M] for place in self.places]).reshape(-1, 2)

    def at(self, along):
        return np.array([np.interp(along, self.along, self.feet[:, axis]) for axis in (0, 1)])

    def direction(self, start, end):
        start, end = max(start, 0.0), min(end, self.length)
        chord = self.at(end) - self.at(start)
        return np.degrees(np.arctan2(chord[1], chord[0])) if end - start >= 0.5 and np.hypot(*chord) > 0.1 else None

    def angle(self, end, begin, chord):
        before, after = self.direction(end - chord, end), self.direction(begin, begin + chord)
        return 0.0 if before is None or after is None else turned(after, before)

    def of_frame(self, frame):
        return self.along[min(max(frame, 0), self.count - 1)]

    def frame_of(self, along):
        """Last frame at a place: who stands at a corner turns when walking on."""
        return min(int(np.searchsorted(self.along, along + 0.05, side="right")), self.count - 1)

    def leads_back(self, start, end, least):
        """Whether the way goes back within 3.5 m and 7 s of walking between two places."""
        for begin in np.arange(start, end + 1e-9, STEP_M):
            for to in np.arange(begin, min(begin + 3.5, end) + 1e-9, STEP_M):
                seconds = np.interp(to, self.along, self.walked) - np.interp(begin, self.along, self.walked)
                if seconds <= 7 and abs(self.angle(begin, to, 3.0)) >= least:
                    return True
        return False

    def turns_to(self, side, frame):
        """Whether the way turns to a side, or around, near a frame."""
        here = self.of_frame(frame)
        near = np.abs(self.places - here) <= 4
        if side == "around":
            return self.leads_back(max(here - 4, 0), min(here + 4, self.length), 140)
        angles = self.angles[near] * {"left": -1, "right": 1}[side]
        return bool(((angles[:, 0] >= 27) & (angles[:, 1] >= 40)).any())

    def sharpest(self, start, end):
        """Largest angle by either chord in frames, degrees."""
        inside = (self.places >= self.of_frame(start)) & (self.places <= self.of_frame(end - 1))
        return float(np.abs(self.angles[inside]).max(initial=0.0))

    @cache
    def events(self):
        """Turns in order of the way: place, what it may be called, whether nobody can overlook it."""
        runs, last = [], None
        for at, angles in enumerate(self.angles):
            if np.abs(angles).max() < 41:
                continue
            sign = np.sign(angles.sum())
            sharp = np.abs(angles).max() > 120
            if runs and last[0] == at - 1 and (sign == last[1] or sharp or last[2]):
                runs[-1].append(at)
            else:
                runs.append([at])
            last = (at, sign, sharp)
        found = []
        for run in runs:
            angles = self.angles[run]
            peak = run[int(np.abs(angles).sum(1).argmax())]
            place = self.places[peak]
            kinds = {kind for kind, sign in (("left", -1), ("right", 1)) if (sign * angles >= 41).any()}
            is_inside = min(place, self.length - place) >= 3
            back = self.leads_back(self.places[run[0]], self.places[run[-1]], 140)
            if back or np.abs(angles).max() > 120:
                kinds.add("around")
            if self.leads_back(self.places[run[0]], self.places[run[-1]], 165):
                kinds = {"around"}
            long = (run[-1] - run[0]) * STEP_M > 13
            is_side = (np.abs(self.angles[peak]) >= (32, 49)).all() and np.abs(angles).max() <= 120
            clear = is_inside and not long and bool(is_side or kinds == {"around"})
            found += [(place, kinds, clear)] if not long else [(place, kinds, False)] * 4
        return found

    def are_turns(self, said):
        """Whether turns in order are those of the way, with none left out that nobody can overlook."""
        reached = {0}
        for _, kinds, clear in self.events():
            taken = {at + 1 for at in reached if at < len(said) and said[at] in kinds}
            reached = taken if clear else taken | reached
        return len(said) in reached

    def clear_turns(self):
        return sum(clear for _, _, clear in self.events())

    @cache
    def is_straight(self):
        whole = self.direction(0, self.length)
        ways = [self.direction(place, place + 3) for place in self.places]
        return self.length < 3 or whole is not None and all(way is None or abs(turned(way, whole)) < 30 for way in ways)

    def first_turn_s(self):
        """Spans of time in which the first turn may be, seconds: a metre before it to a metre behind it, with a stop at the corner."""
        spans = []
        for place, _, clear in self.events():
            spans.append([self.frame_of(at) * self.dt for at in (max(place - 1, 0), min(place + 1, self.length))])
            if clear:
                break
        return spans


TIMES = {"twice": 2, "两": 2, "三": 3, "四": 4}
KINDS = {"左": "left", "右": "right", "掉": "around"}
HEDGES = r"(?:about|roughly|around|approximately) $"


def said_turns(text, language):
    """Turns that a description lists, or their numbers by kind where it counts them; none where it names none."""
    if language == "en":
        counted = re.search(r"(\d+) turns \(([^)]*)\)", text)
        if counted:
            return int(counted[1]), {kind: int(times) for times, kind in re.findall(r"(\d+) (left|right|around)", counted[2])}
        part = re.search(r"\bturns ((?:left|right|around)\b[^.;]*)", text)
        found = re.findall(r"\b(left|right|around)(?: (twice|\d+ times))?", part[1]) if part else []
        return [kind for kind, times in found for _ in range(TIMES.get(times) or int((times or "1").split()[0]))]
    counted = re.search(r"转弯(\d+|[一两三四五六七八九十])次（([^）]*)）", text)
    if counted:
        kinds = {KINDS[kind]: int(times) for kind, times in re.findall(r"(左|右|掉)[转头](\d+)次", counted[2])}
        return sum(kinds.values()), kinds
    found = re.findall(r"(?:连续([两三四])次)?(左转|右转|掉头)", text)
    return [KINDS[kind[0]] for times, kind in found for _ in range(TIMES.get(times, 1))]


def when_said(text):
    soon = re.search(r"\bsoon\b|before long|shortly|不久|没走多远", text, re.I)
    late = re.search(r"\blater\b|good while|at the end|好一阵|最后", text)
    return "soon" if soon else "late" if late else None


def numbers(text, language):
    """Length, time and pace as a description states them; none where it does not."""
    end, stated, patterns = {
        "en": (r"(?<=[.])\s", (r"\d m\b(?!/s)", r"\d seconds?"), (r"([\d.]+) m(?![/\w])", r"(\d+) seconds?", r"([\d.]+) m/s")),
        "zh": ("。", (r"\d米(?!/)", r"\d秒"), (r"([\d.]+)米(?!/)", r"(\d+)秒", r"(?:每秒[^\d]*([\d.]+)米|([\d.]+)米/秒)")),
    }[language]
    sentence = next((it for it in re.split(end, text) if all(re.search(pattern, it) for pattern in stated)), None)
    if sentence is None:
        return None, None, None, ""
    pace = re.search(patterns[2], sentence)
    rest = re.sub(patterns[2], "", sentence) if language == "zh" else sentence
    way, time = (re.search(pattern, rest) for pattern in patterns[:2])
    return float(way[1]), float(time[1]), float(next(filter(None, pace.groups()))) if pace else None, sentence


def wrongs(text, language, way, standing_s):
    """What a description says that the walk is not, one line each."""
    said = said_turns(text, language)
    if isinstance(said, tuple):
        doubtful = len(way.events()) - way.clear_turns()
        if not way.clear_turns() <= said[0] <= way.clear_turns() + doubtful:
            yield f"{said[0]} turns; {way.clear_turns()} are clear and {doubtful} may be"
    elif said and not way.are_turns(said):
        yield f"turns {said}; the way has {[(round(float(place)), sorted(kinds), clear) for place, kinds, clear in way.events()]}"
    if not said and re.search(r"sharp turn|急转弯", text) and way.clear_turns():
        yield "no sharp turn"
    if re.search(r"straight|直行|笔直|沿直线|直走|径直", text) and not way.is_straight():
        yield "straight"
    when, total = when_said(text), (way.count - 1) * way.dt
    if when == "soon" and not any(begin <= min(0.2 * total, 6) + 2 for begin, _ in way.first_turn_s()):
        yield f"soon; the first turn is at {way.first_turn_s()} of {total} s"
    if when == "late" and not any(end >= max(0.5 * total, 10) - 2 for _, end in way.first_turn_s()):
        yield f"late; the first turn is at {way.first_turn_s()} of {total} s"
    if re.search(r"gently|slowly|缓缓|慢慢", text):
        yield "a word of speed"
    length, time, pace, sentence = numbers(text, language)
    if length is None:
        return
    step = 1 if way.length < 30 else 5 if way.length < 100 else 10
    if abs(length - way.length) > step / 2 + 0.01 or abs(time - total) > (0.51 if total < 30 else 2.51):
        yield f"{length} m in {time} s; the way is {way.length:.1f} m in {total} s"
    is_walking = re.search("while walking|while they walk|走动时|行走时", sentence)
    if pace and abs(length / (time - (round(standing_s) if is_walking else 0)) / pace - 1) > 0.105:
        yield f"{length} m in {time} s at {pace} m/s"
    for number in re.finditer(r"\d+(?:\.\d+)?", sentence):
        before, behind = sentence[: number.start()].lower(), sentence[number.end() :]
        hedged = re.search(HEDGES, before) if language == "en" else before.endswith(("约", "大概")) or re.match("(?:米/秒|米|秒)左右", behind)
        if not hedged:
            yield f"{number[0]} without `about`"
