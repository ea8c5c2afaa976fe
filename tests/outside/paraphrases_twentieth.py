"""The twentieth grammar for check_text_judge.py: a large language model asked for a thousand diverse paraphrases (neutral, fluent, complete). Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


ONES = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen "
        "seventeen eighteen nineteen").split()
TENS = "zero ten twenty thirty forty fifty sixty seventy eighty ninety".split()
ORDINALS = "zeroth first second third fourth fifth sixth seventh eighth ninth tenth".split()


def words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + words(n % 100) if n % 100 else "")
    return str(n)


def cap(text):
    return text[:1].upper() + text[1:]


def article(n):
    return "an" if n in (8, 11, 18) or 80 <= n <= 89 or 800 <= n <= 899 else "a"


def comma_and(items):
    if len(items) == 1:
        return items[0]
    if len(items) == 2:
        return items[0] + " and " + items[1]
    return ", ".join(items[:-1]) + ", and " + items[-1]


def runs(turns):
    out = []
    for t in turns:
        if out and out[-1][0] == t:
            out[-1][1] += 1
        else:
            out.append([t, 1])
    return out


class TwentiethEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls", "with two dogs", "under a cloudless sky", "past a row of cafes", "in light rain", "next to a parked van",
              "while church bells ring", "at sunset", "near a construction site", "with a child on a scooter", "along a canal", "among market stalls",
              "in front of a brick warehouse", "during the morning rush hour", "with fresh snow on the ground", "behind a delivery truck", "holding an umbrella",
              "wearing a straw hat", "talking on the phone", "pushing a stroller", "through a crowd of tourists", "with cyclists passing by", "beneath blooming cherry trees",
              "in dense fog", "over a stone bridge"]
    persons = ["nurse", "fisherman", "schoolgirl", "police officer", "retired teacher", "young man", "waitress", "courier", "elderly woman", "businessman", "street musician", "construction worker"]

    # ---- numbers and units
    def begin(self, past=None):
        self.us = self.pick(True, False)
        self.abbr = self.pick(True, False, False)
        self.sign = self.pick(True, False, False)
        self.spell = self.pick(True, False, False, False, False, False)
        self.past = self.pick(True, True, True, False) if past is None else past
        self.uturn = self.pick("a U-turn", "a U-turn", "an about-turn", "a 180-degree turn")

    def n(self, x):
        return words(x) if self.spell else str(x)

    def m(self, x):
        unit = "meter" if self.us else "metre"
        if self.abbr and not self.spell:
            return f"{x} m"
        return f"{self.n(x)} {unit}" + ("" if x == 1 else "s")

    def am(self, x, noun):
        unit = "meter" if self.us else "metre"
        if self.spell and x >= 100:
            return f"{article(x)} {x}-{unit} {noun}"
        return f"{article(x)} {self.n(x)}-{unit} {noun}"

    def deg(self, x):
        x = abs(x)
        if self.sign and not self.spell:
            return f"{x}°"
        return f"{self.n(x)} degree" + ("" if x == 1 else "s")

    def adeg(self, x, noun):
        x = abs(x)
        if self.sign and not self.spell:
            return f"{article(x)} {x}° {noun}"
        return f"{article(x)} {self.n(x)}-degree {noun}"

    def sec(self, x):
        if self.abbr and not self.spell:
            return f"{x} s"
        return f"{self.n(x)} second" + ("" if x == 1 else "s")

    def asec(self, x, noun):
        return f"{article(x)} {x if self.spell and x >= 100 else self.n(x)}-second {noun}"

    def ms(self, s):
        if self.abbr and not self.spell:
            return f"{s} m/s"
        unit = "meters" if self.us else "metres"
        if self.spell and not str(s).endswith(".0"):
            whole, part = str(s).split(".")
            return f"{words(int(whole))} point {words(int(part))} {unit} per second"
        return f"{s} {unit} per second"

    def times(self, k):
        return {1: "once", 2: "twice"}.get(k) or self.pick(words(k), words(k), str(k)) + " times"

    def v(self, past, present):
        return past if self.past else present

    # ---- the person
    def colour(self, c):
        return "gray" if c == "grey" and self.us else c

    def who(self, flight, definite=None, noun=None):
        definite = self.pick(True, False) if definite is None else definite
        the = "the" if definite else "a"
        noun = noun or self.pick("person", "person", "individual", *(["pedestrian", "walker"] if flight.walks else ["person", "subject"]))
        head = "an individual" if noun == "individual" and not definite else f"{the} {noun}"
        if not flight.wear:
            return self.pick(head, head, "someone") if not definite else head
        top, low = self.colour(flight.wear[0]), self.colour(flight.wear[1])
        pants = "pants" if self.us else "trousers"
        if top == low and self.pick(True, False):
            clothes = self.pick(f"in {an(top)} top and matching {low} {pants}", f"wearing {top} both on top and on the legs", f"whose top and {pants} are both {top}",
                                f"wearing a top and {pants} that are both {top}")
        else:
            clothes = self.pick(
                f"in {an(top)} top and {low} {pants}", f"wearing {an(top)} top and {low} {pants}", f"dressed in {an(top)} top and {low} {pants}",
                f"with {an(top)} top and {low} {pants}", f"whose top is {top} and whose {pants} are {low}", f"wearing {low} {pants} and {an(top)} top",
                f"in {low} {pants} and {an(top)} top", f"in {an(top)} top over {low} {pants}", f"clad in {low} {pants} and {an(top)} upper garment",
                f"who {self.pick('is wearing', 'has on')} {an(top)} top with {low} {pants}", f"in {an(top)} top paired with {low} {pants}",
                f"wearing {top} on the upper body and {low} {pants}")
        if flight.wear[2]:
            if clothes.startswith("with "):
                bag = self.pick(" and a backpack", " plus a backpack")
            elif clothes.startswith("wearing "):
                bag = self.pick(" and carrying a backpack", " with a backpack", " with a backpack on their back")
            else:
                bag = self.pick(" and carrying a backpack", " with a backpack", " with a backpack on their back")
            if clothes.startswith("whose") or clothes.startswith("who "):
                bag = self.pick(" and who carries a backpack", " and who has a backpack") if clothes.startswith("whose") else " and is carrying a backpack"
            if self.pick(0, 0, 0, 1):
                return f"{head if definite else 'someone'} carrying a backpack and wearing {an(top)} top and {low} {pants}"
        else:
            bag = self.pick("", "", "", " without a backpack", " with no backpack") if clothes.startswith(("in ", "wearing ", "with ", "dressed")) else ""
        if not flight.wear[2] and (" with " in clothes or " matching " in clothes or "both" in clothes):
            bag = ""
        if not flight.wear[2] and clothes.startswith("with ") and bag:
            bag = " but no backpack"
        return head + " " + clothes + bag

    def ref(self):
        return self.pick("the person", "the person", "the subject", "the individual", "the target")

    def refo(self):
        return self.pick("them", "them", "the person", "the subject", "the target", "the person being filmed")

    def wear_note(self, flight):
        if not flight.wear:
            return self.pick("one person", "a person", "a single person")
        top, low = self.colour(flight.wear[0]), self.colour(flight.wear[1])
        pants = "pants" if self.us else "trousers"
        bag = ", backpack" if flight.wear[2] else self.pick("", "", ", no backpack")
        return self.pick(f"person, {top} top, {low} {pants}{bag}", f"one person ({top} top, {low} {pants}{bag})", f"person in {an(top)} top and {low} {pants}{bag.replace(', ', ', with a ').replace('a no', 'no')}")

    # ---- distance
    def d_np(self, f):
        d = f.distance
        return self.pick(f"a distance of {self.m(d)}", f"a distance of {self.m(d)}", f"a gap of {self.m(d)}", f"a separation of {self.m(d)}", self.am(d, "gap"), self.am(d, "distance"),
                         f"a line-of-sight distance of {self.m(d)}", f"a straight-line distance of {self.m(d)}", self.am(d, "separation"), f"a slant range of {self.m(d)}", self.am(d, "standoff distance"))

    def d_adv(self, f):
        d = f.distance
        return self.pick(f"from {self.m(d)} away", f"from {self.m(d)} away", f"at a distance of {self.m(d)}", f"from a distance of {self.m(d)}", "at " + self.am(d, "distance"),
                         f"at a range of {self.m(d)}", "from " + self.d_np(f).replace("a gap", "a distance").replace("-meter gap", "-meter distance").replace("-metre gap", "-metre distance"),
                         f"at a straight-line distance of {self.m(d)}", f"while staying {self.m(d)} away", f"while keeping {self.d_np(f)}", f"while maintaining {self.d_np(f)}")

    def d_imp(self, f):
        d, r = self.m(f.distance), self.refo()
        dist = f.distance
        return self.pick(
            f"Maintain {self.d_np(f)} throughout.", f"Stay {d} away from {r}.", f"Keep the drone {d} from {r}.", f"The drone should be {d} away from {r}.",
            f"Leave {d} between the drone and {r}.", f"{cap(d)} is the distance to hold.", f"I want {d} between the drone and {r}.", f"Hold {self.d_np(f)} from {r}.",
            f"{cap(self.ref())} should be {d} away from the camera.", f"Fly so that the straight-line distance to {r} is {d}.", f"The required distance to {r} is {d}.",
            f"Make sure that {d} {'separates' if dist == 1 else 'separate'} the drone and {r}.", f"Position the aircraft {d} from {r} and hold that distance.",
            f"Distance to the person: {d}.", f"How far away? {cap(d)}, please.", f"Please keep to {self.d_np(f)}.", f"As for the distance, {d} is what we need.")

    def d_s(self, f):
        d, r = self.m(f.distance), self.ref()
        was, v = self.v("was", "is"), self.v
        return self.pick(
            f"The drone {v('stayed', 'stays')} {d} away from {r} on average.", f"The average distance between the drone and {r} {was} {d}.",
            f"On average, {d} {v('separated', 'separate')} the drone and {r}.", f"The drone {v('kept', 'keeps')} {self.d_np(f)} from {r}.",
            f"{cap(self.ref())} {was} {d} away from the drone.", f"On average, {self.ref()} {was} filmed from {d} away.", f"The line-of-sight distance {v('averaged', 'averages')} {d}.",
            f"Between the drone and {r} there {was} {self.d_np(f)}.", f"{cap(self.d_np(f))} {was} maintained between the drone and {r}.", f"The mean slant distance to {r} {was} {d}.",
            f"Measured in a straight line, the drone {was} {d} from {r}.", f"The filming distance {was} {d}.",
            f"Throughout the flight, the drone {v('held', 'holds')} {self.d_np(f)} on average.")

    # ---- pitch
    def sense(self, f):
        return ("down", "downward", "below", "lower") if f.pitch > 0 else ("up", "upward", "above", "raise")

    def p_np(self, f):
        if f.pitch == 0:
            return self.pick("the camera level", "the camera held horizontal", "the lens aimed at the horizon", "the camera level with the horizon", "no camera tilt", "a perfectly level camera",
                             "the camera neither tilted up nor down", "the camera at 0 degrees of tilt", "a horizontal camera angle", "the optical axis horizontal", "the gimbal set to horizontal")
        down, ward, below, _ = self.sense(f)
        g = self.deg(f.pitch)
        return self.pick(
            f"the camera tilted {g} {ward}", f"the camera tilted {down} by {g}", f"the lens pointing {g} {below} the horizon", f"the camera angled {g} {below} the horizon", f"the camera pitched {down} {g}",
            f"{an(ward)} camera angle of {g}", f"{an(ward)} tilt of {g}", f"the gimbal set {g} {below} the horizontal", f"the optical axis {g} {below} the horizontal", self.adeg(f.pitch, f"{ward} tilt"),
            f"the camera looking {down} at {self.adeg(f.pitch, 'angle')}", f"the camera aimed {g} {below} horizontal", f"a camera pitch of {g} {below} the horizon", self.adeg(f.pitch, f"{ward} camera angle"))

    def p_imp(self, f):
        if f.pitch == 0:
            return self.pick(
                "Keep the camera level.", "The camera should stay horizontal.", "Do not tilt the camera up or down.", "Set the gimbal to 0 degrees so the camera looks straight at the horizon.", "Point the lens horizontally.",
                "The camera must be level with the horizon.", "No camera tilt is needed; keep it horizontal.", "Use a level camera angle.", "Camera: horizontal.", "Please leave the camera level.",
                "As for the camera, it should be pointed horizontally.", "I want the camera to look neither up nor down.")
        down, ward, below, _ = self.sense(f)
        g = self.deg(f.pitch)
        return self.pick(
            f"Tilt the camera {g} {down}.", f"Tilt the camera {down} by {g}.", f"Set the gimbal to {g} {below} the horizon.", f"The camera should point {g} {below} the horizon.", f"Angle the lens {ward} by {g}.",
            f"Please keep the camera angled {g} {ward}.", f"Make sure the camera's {ward} tilt is {g}.", f"Camera angle: {g} {below} the horizon.", f"{cap(an(ward))} tilt of {g} is required.",
            f"I want the camera to look {down} at {self.adeg(f.pitch, 'angle')}.", f"Use a camera pitch of {g} {below} horizontal.", f"As for the camera, it should be pitched {down} {g}.",
            f"The lens has to be aimed {g} {below} the horizontal.", f"Have the camera look {g} {ward}.", f"{cap(g)} {below} the horizon is where the camera should point.", f"Shoot with {self.p_np(f)}.")

    def p_s(self, f):
        v, was = self.v, self.v("was", "is")
        if f.pitch == 0:
            return self.pick(
                f"The camera {was} level.", f"The camera {v('pointed', 'points')} straight at the horizon.", f"The camera {was} held horizontal.", f"There {was} no camera tilt.", f"The lens {was} tilted neither up nor down.",
                f"The camera pitch {was} 0 degrees, level with the horizon.", f"The gimbal {was} kept horizontal.", f"The footage {was} shot with a level camera.", f"The camera's line of sight {was} horizontal.",
                f"The camera {v('looked', 'looks')} neither up nor down.", f"The optical axis {was} horizontal.")
        down, ward, below, _ = self.sense(f)
        g = self.deg(f.pitch)
        return self.pick(
            f"The camera {was} tilted {g} {ward}.", f"The camera {v('pointed', 'points')} {g} {below} the horizon.", f"The lens {was} angled {down} by {g}.", f"The gimbal {was} set {g} {below} the horizontal.",
            f"The camera's {ward} tilt {was} {g}.", f"The camera {v('looked', 'looks')} {down} at {self.adeg(f.pitch, 'angle')}.", f"The footage {was} shot with {self.p_np(f)}.",
            f"The camera pitch {was} {g} {below} the horizon.", f"{cap(an(ward))} camera angle of {g} {was} used.", f"The optical axis {was} {g} {below} horizontal.", f"Filming {was} done with {self.p_np(f)}.",
            f"At {g} {below} the horizon, the camera {was} pitched {ward}.", f"The camera {was} pitched {down}, {g} {below} the horizontal.")

    # ---- height
    def h_np(self, f):
        a = f.altitude
        return self.pick(f"an altitude of {self.m(a)}", f"a height of {self.m(a)}", f"a height of {self.m(a)} above the person's feet", self.am(a, "altitude"), f"an altitude {self.m(a)} above the person's feet",
                         f"a flight height of {self.m(a)}", f"{self.m(a)} above the ground on which the person {self.v('stood', 'stands')}")

    def h_imp(self, f):
        a = self.m(f.altitude)
        return self.pick(f"Fly {a} above the person's feet.", f"Hold an altitude of {a}.", f"Keep the drone at a height of {a}.", f"The flight altitude should be {a}.", f"Altitude: {a}.", f"Stay {a} higher than the person's feet.",
                         f"The drone should be {a} above the level of the person's feet.", f"Please fly at a height of {a}.", f"Set the flying height to {a}.", f"As for the altitude, go with {a}.", f"A height of {a} is required.")

    def h_s(self, f):
        a, v, was = self.m(f.altitude), self.v, self.v("was", "is")
        return self.pick(f"The drone {v('flew', 'flies')} at an altitude of {a}.", f"The drone's altitude {was} {a}.", f"The aircraft {was} {a} above the person's feet.", f"The flight altitude {was} {a}.",
                         f"The drone {v('remained', 'remains')} {a} higher than the person's feet.", f"The flight {was} flown at a height of {a}.", f"A height of {a} {was} held.",
                         f"The drone's height above the person's feet {was} {a}.", f"In terms of height, the drone {was} {a} above the person's feet.", f"{cap(a)} {was} the drone's height above the person's feet.",
                         f"The aircraft {v('kept', 'keeps')} to an altitude of {a}.", f"Relative to the person's feet, the drone {was} {a} up.")

    # ---- turns
    def t_vp(self, turns, form):
        """verb phrase; form: 'past', 'pres' or 'base'"""
        w = lambda past, pres, base: {"past": past, "pres": pres, "base": base}[form]
        turn, make = w("turned", "turns", "turn"), w("made", "makes", "make")
        around = self.pick(f"{turn} around", f"{turn} around", f"{make} {self.uturn}", w("reversed", "reverses", "reverse") + " direction", w("doubled", "doubles", "double") + " back")
        one = lambda t: around if t == "around" else f"{turn} {t}"
        if not turns:
            return self.pick(f"{make} no turns", f"never {turn}" if form != "base" else "not turn at all", f"{make} no turns at all", w("did not turn", "does not turn", "not turn") + " at any point",
                             f"{make} not a single turn")
        n = len(turns)
        if n == 1:
            t = turns[0]
            if t == "around":
                return self.pick(f"{turn} around once", f"{make} {self.uturn}", f"{turn} around a single time", f"{make} one single turn, {self.uturn}", w("doubled", "doubles", "double") + " back once")
            return self.pick(f"{turn} {t} once", f"{make} one {t} turn", f"{make} a single turn, to the {t}", f"{make} a single {t} turn", f"{w('took', 'takes', 'take')} one turn to the {t}", f"{turn} only once, to the {t}")
        if len(set(turns)) == 1:
            t, k = turns[0], self.times(n)
            if t == "around":
                return self.pick(f"{turn} around {k}", f"{w('reversed', 'reverses', 'reverse')} direction {k}", f"{make} {words(n)} U-turns", f"{w('doubled', 'doubles', 'double')} back {k}")
            return self.pick(f"{turn} {t} {k}", f"{make} {words(n)} {t} turns", f"{make} {words(n)} turns, {'both' if n == 2 else 'all'} to the {t}", f"{turn} {k}, always to the {t}", f"{make} {words(n)} consecutive {t} turns")
        clauses = []
        for i, t in enumerate(turns):
            c = one(t) + (" again" if i and turns[i - 1] == t else "")
            clauses.append(c)
        style = self.pick(0, 0, 1, 2, 3, 4, 5)
        if style == 0:
            mid = [("then " if i % 2 else "next ") + c if 0 < i < n - 1 else c for i, c in enumerate(clauses)]
            return clauses[0] + " and then " + clauses[1] if n == 2 else ", ".join(mid[:-1]) + self.pick(", and finally ", ", and lastly ") + clauses[-1]
        if style == 1:
            return ", then ".join(clauses)
        if style == 2:
            return f"{make} " + self.t_nouns(turns) + self.pick(", in that order", ", in this order", ", one after another")
        if style == 3:
            return f"{make} {words(n)} turns: " + self.t_list(turns)
        if style == 4:
            return f"{make} " + self.t_runs(turns)
        return f"first {clauses[0]}, " + ", ".join(f"then {c}" for c in clauses[1:])

    def t_nouns(self, turns):
        return comma_and([self.uturn if t == "around" else f"a {t} turn" for t in turns])

    def t_runs(self, turns):
        parts = []
        for t, k in runs(turns):
            if k == 1:
                parts.append(self.uturn if t == "around" else f"a {t} turn")
            else:
                parts.append(f"{words(k)} " + ("U-turns" if t == "around" else f"{t} turns") + self.pick("", " in a row"))
        if len(parts) == 1:
            return parts[0]
        return parts[0] + "".join(self.pick(", followed by ", ", then ", ", and then ") + p for p in parts[1:])

    def t_list(self, turns):
        back = self.pick("around", "around", "U-turn")
        items = [back if t == "around" else t for t in turns]
        return self.pick(", ", ", then ", " → ", ", ").join(items)

    def t_ordinals(self, turns):
        was = self.v("was", "is")
        return "; ".join(f"the {ORDINALS[i + 1] if i < 10 else str(i + 1) + 'th'} turn {was} " + (self.uturn if t == "around" else f"to the {t}") for i, t in enumerate(turns))

    def form(self):
        return self.v("past", "pres")

    def t_s(self, f):
        turns, was, v = f.turns, self.v("was", "is"), self.v
        who = cap(self.ref()) if not self.past else self.pick("They", "They", cap(self.ref()))
        if not turns:
            return self.pick(f"{who} {self.t_vp(turns, self.form())}.", f"There {v('were', 'are')} no turns along the way.", f"No turns {v('were', 'are')} made.", f"The route {v('contained', 'contains')} no turns.", f"Not a single turn {was} made.",
                             f"{who} {v('walked', 'walks')} without turning.", f"The walk {v('involved', 'involves')} no turns whatsoever.", f"At no point {v('did', 'does')} {self.ref()} turn.", f"{who} {v('took', 'takes')} no turns.", f"The number of turns {was} zero.")
        n = len(turns)
        lead = self.pick("Along the way, ", "On the way, ", "During the walk, ", "Over the course of the flight, ", "")
        base = f"{lead}{(who if not lead else who[:1].lower() + who[1:])} {self.t_vp(turns, self.form())}."
        single = ("around" if turns[0] == "around" else f"to the {turns[0]}")
        if n == 1:
            noun = self.uturn if turns[0] == "around" else f"a {turns[0]} turn"
            return self.pick(base, base, base, f"The only turn {was} {noun}.", f"{cap(noun)} {was} the only turn.", f"There {was} exactly one turn: {noun}.", f"The route {v('included', 'includes')} one turn, {noun}.", f"The walk {v('contained', 'contains')} a single turn, namely {noun}.")
        noun = words(n)
        return self.pick(base, base, base, f"{cap(self.t_ordinals(turns))}.", f"There {v('were', 'are')} {noun} turns in total: {self.t_list(turns)}.", f"The {noun} turns, in order, {v('were', 'are')}: {self.t_list(turns)}.",
                         f"The route {v('consisted of', 'consists of')} {noun} turns, in this order: {self.t_list(turns)}.", f"In sequence, the turns {v('were', 'are')} {self.t_list(turns)}.", f"{cap(noun)} turns {v('were', 'are')} made: {self.t_runs(turns)}.",
                         f"The walk {v('included', 'includes')} {self.t_runs(turns)}.", f"The turn sequence {was} {self.t_list(turns)}.")

    def t_will(self, f):
        t = f.turns
        r = self.pick("They", "The person", "The subject", "The target")
        return self.pick(f"{r} will {self.t_vp(t, 'base')}.", f"Expect {self.t_runs(t) if t else 'no turns'}." if len(t) != 1 else f"Expect one turn: {self.t_list(t)}.",
                         f"{r} will {self.t_vp(t, 'base')} along the way.", f"Turns to expect: {self.t_list(t) if t else 'none'}.", f"Be prepared: {r.lower()} will {self.t_vp(t, 'base')}.")

    # ---- stops
    def s_vp(self, f, form):
        k, w = f.stops, lambda past, pres, base: {"past": past, "pres": pres, "base": base}[form]
        stop, pause, stand = w("stopped", "stops", "stop"), w("paused", "pauses", "pause"), w("stood", "stands", "stand")
        make, take = w("made", "makes", "make"), w("took", "takes", "take")
        if k == 0:
            return self.pick(f"never {stop}" if form != "base" else "not stop at all", f"{make} no stops", w("did not pause", "does not pause", "not pause"), w("did not stop at any point", "does not stop at any point", "not stop at any point"),
                             w("walked", "walks", "walk") + " without a pause", w("kept", "keeps", "keep") + " walking without any stops")
        s = self.sec(f.standing)
        if not f.standing:
            return f"{stop} {self.times(k)}"
        if k == 1:
            return self.pick(f"{stop} once for {s}", f"{pause} once, for {s}", f"{make} one stop of {s}", f"{make} a single stop lasting {s}", f"{pause} once, standing still for {s}", f"{take} one pause of {s}", f"{stand} still once, for {s}",
                             f"{stop} a single time, remaining still for {s}")
        return self.pick(f"{stop} {self.times(k)}, for a total of {s}", f"{pause} {self.times(k)}, standing still for {s} in total", f"{make} {words(k)} stops totaling {s}" if self.us else f"{make} {words(k)} stops totalling {s}",
                         f"{stop} {self.times(k)}, with {s} of standing time altogether", f"{make} {words(k)} stops that together {w('lasted', 'last', 'last')} {s}", f"{pause} {self.times(k)} for a combined {s}", f"{take} {words(k)} pauses adding up to {s}",
                         f"{stand} still {self.times(k)}, for {s} altogether")

    def s_s(self, f):
        v, was, k = self.v, self.v("was", "is"), f.stops
        who = cap(self.ref()) if not self.past else self.pick("They", "They", cap(self.ref()))
        base = f"{who} {self.s_vp(f, self.form())}."
        if k == 0:
            return self.pick(base, base, f"There {v('were', 'are')} no stops.", f"No pauses {v('were', 'are')} made.", f"The walk {was} uninterrupted by any stops.", f"At no point {v('did', 'does')} {self.ref()} stop.", f"The person {v('kept', 'keeps')} going without stopping.",
                             f"Not one stop {was} made along the way.", f"The number of stops {was} zero.")
        s = self.sec(f.standing)
        if not f.standing:
            return base
        if k == 1:
            return self.pick(base, base, f"There {was} one stop, lasting {s}.", f"A single pause of {s} {was} made.", f"The only stop {v('lasted', 'lasts')} {s}.", f"For {s}, {self.ref()} {v('stood', 'stands')} still during a single stop.", f"The walk {was} interrupted once, for {s}.",
                             f"One pause {v('took', 'takes')} up {s}.", f"{cap(self.asec(f.standing, 'pause'))} {was} the only interruption.")
        return self.pick(base, base, f"There {v('were', 'are')} {words(k)} stops, lasting {s} in total.", f"{cap(words(k))} pauses {v('were', 'are')} made, adding up to {s}.", f"The {words(k)} stops together {v('lasted', 'last')} {s}.",
                         f"In all, {self.ref()} {v('stood', 'stands')} still for {s}, spread over {words(k)} stops.", f"The walk {was} interrupted {self.times(k)}, for {s} in all.", f"A total of {s} {was} spent standing still, across {words(k)} stops.",
                         f"Standing time {v('came', 'comes')} to {s}, divided among {words(k)} pauses.")

    def s_will(self, f):
        r = self.pick("They", "The person", "The subject", "The target")
        if f.stops == 0:
            return self.pick(f"{r} will {self.s_vp(f, 'base')}.", "Expect no stops.", f"{r} will keep walking without stopping.", "No stops are planned.")
        k = f.stops
        plan = "one stop" if k == 1 else f"{words(k)} stops"
        return self.pick(f"{r} will {self.s_vp(f, 'base')}.", f"{r} will {self.s_vp(f, 'base')}.", f"Expect {plan}" + (f", lasting {self.sec(f.standing)}" + ("" if k == 1 else " in total") if f.standing else "") + ".")

    # ---- way, duration, speed
    def dur_s(self, f):
        t, v, was = self.sec(f.duration), self.v, self.v("was", "is")
        return self.pick(f"The flight {v('lasted', 'lasts')} {t}.", f"Flight time {was} {t}.", f"The duration of the flight {was} {t}.", f"The whole flight {v('took', 'takes')} {t}.", f"The recording {v('ran', 'runs')} for {t}.", f"In total, the drone {was} filming for {t}.",
                         f"After {t}, the flight {v('ended', 'ends')}.", f"This {was} {self.asec(f.duration, 'flight')}.", f"{cap(t)} {was} the length of the flight.", f"The flight {was} over in {t}.", f"The total flight duration {v('came', 'comes')} to {t}.")

    def way_s(self, f):
        w, v, was = self.m(f.way), self.v, self.v("was", "is")
        who = cap(self.ref())
        return self.pick(f"{who} {v('walked', 'walks')} {w} in total.", f"A total of {w} {was} walked.", f"{who} {v('covered', 'covers')} {w} on foot.", f"The walk {was} {w} long.", f"The total walking distance {was} {w}.", f"In all, {self.ref()} {v('walked', 'walks')} {w}.",
                         f"The length of the walk {was} {w}.", f"The path {v('measured', 'measures')} {w} from start to end.", f"Altogether, {w} of ground {was} covered on foot.", f"{cap(w)} {was} the length of the route walked.")

    def speed_s(self, f):
        s, v, was = self.ms(f.speed), self.v, self.v("was", "is")
        return self.pick(f"The average walking speed {was} {s}.", f"{cap(self.ref())} {v('walked', 'walks')} at {s} on average.", f"On average, {self.ref()} {v('walked', 'walks')} at {s}.", f"The mean walking speed {v('came', 'comes')} to {s}.", f"The walking pace {v('averaged', 'averages')} {s}.",
                         f"{cap(self.ref())} {v('moved', 'moves')} on foot at an average of {s}.", f"Average walking speed: {s}.", f"{cap(s)} {was} the average walking speed.", f"An average walking speed of {s} {was} recorded.", f"When walking, {self.ref()} {v('averaged', 'averages')} {s}.")

    def length(self, f):
        """a list of sentences that say way, duration and speed"""
        w, t, s, v, was, r = self.m(f.way), self.sec(f.duration), self.ms(f.speed), self.v, self.v("was", "is"), self.ref()
        walked, covered = v("walked", "walks"), v("covered", "covers")
        kind = self.pick(*range(12))
        if kind < 3:
            out = [self.dur_s(f), self.way_s(f), self.speed_s(f)]
            self.rng.shuffle(out)
            return out
        return [[f"The flight {v('lasted', 'lasts')} {t}, during which {r} {walked} {w} at an average speed of {s}."],
                [f"Over the {t} of the flight, {r} {covered} {w} at an average walking speed of {s}."],
                [f"In total, {r} {walked} {w} at {s} on average, and the flight {v('took', 'takes')} {t}."],
                [f"The walk {v('measured', 'measures')} {w}; the mean walking speed {was} {s} and the recording {v('ran', 'runs')} for {t}."],
                [f"{cap(r)} {covered} {w} during {self.asec(f.duration, 'flight')}, averaging {s} while walking."],
                [f"At an average walking speed of {s}, {r} {covered} {w}.", self.dur_s(f)],
                [f"By the end of the flight, which {v('lasted', 'lasts')} {t}, {r} {v('had walked', 'has walked')} {w}.", self.speed_s(f)],
                [f"Walking speed {v('averaged', 'averages')} {s} over a total path of {w}, with a flight time of {t}."],
                [self.way_s(f), f"The average walking speed {was} {s}, and the flight {v('lasted', 'lasts')} {t}."]][kind - 3]

    # ---- standing
    def stand_imp(self, f):
        return self.pick("The person is standing still.", "They will stay on one spot the whole time.", "The person does not move from the spot.", "Note that the subject remains standing in one place.", "The person will simply stand there, so no following movement is needed.",
                         "The subject is stationary.", "They are standing in one place throughout.", "The person stays put for the whole shot.", "Expect no walking: the person stands still.", "The target remains standing on the same spot.")

    def stand_s(self, f):
        t, v = self.sec(f.duration), self.v
        r, was = cap(self.ref()), self.v("was", "is")
        return self.pick(
            f"{r} {v('stood', 'stands')} on one spot for the entire {t} of the flight.", f"For all {t}, {r.lower()} {v('remained', 'remains')} standing in the same place.", f"The flight {v('lasted', 'lasts')} {t}, and {r.lower()} {v('stood', 'stands')} still the whole time.",
            f"{r} {v('did not walk', 'does not walk')} at all but {v('stood', 'stands')} in place for {t}.", f"During the whole {self.n(f.duration) if f.duration < 100 else f.duration}-second flight, {r.lower()} {v('stayed', 'stays')} standing on the spot.", f"{r} {v('kept', 'keeps')} standing in one place throughout the flight, which {v('took', 'takes')} {t}.",
            f"{r} {was} standing still from start to finish, a period of {t}.", f"Over {t}, {r.lower()} {v('stood', 'stands')} still on one spot.", f"{r} never {v('left', 'leaves')} the spot, standing there for the full {t} of the flight.",
            f"No walking {v('took', 'takes')} place: {r.lower()} {v('stood', 'stands')} on one spot during the {t} of filming.")

    # ---- instruction
    def verb(self, f, who, form="base"):
        if f.walks:
            return self.pick(f"follow {who}", f"follow {who}", f"track {who}", f"keep following {who}", f"film {who}", f"keep {who} in view", f"stay with {who}", f"accompany {who}", f"keep the camera on {who}", f"shadow {who}", f"keep track of {who}")
        return self.pick(f"film {who}", f"observe {who}", f"keep {who} in view", f"keep the camera on {who}", f"record {who}", f"watch {who}", f"keep {who} in frame", f"monitor {who}")

    def stander(self, f, who):
        """sometimes lets a standing person stand inside the noun phrase"""
        if f.walks or " " not in who:
            return who
        for noun in ("person", "individual", "subject"):
            head, sep, tail = who.partition(" " + noun)
            if sep and head in ("the", "a", "an"):
                return self.pick(who, who, {"an": "a"}.get(head, head) + " stationary " + noun + tail, f"{head} {noun} standing still" + tail if tail.startswith(" in ") or not tail else who)
        return who

    def extras(self, f, limit=2):
        opts = []
        if f.altitude >= 1:
            opts += [self.h_imp(f), self.h_imp(f)]
            opts = opts[:1]
        if f.walks:
            opts += [self.t_will(f), self.s_will(f), self.pick(f"The walk will be {self.m(f.way)} long.", f"In total, {self.m(f.way)} will be walked.", f"They will walk {self.m(f.way)} in all."),
                     self.pick(f"They will walk at {self.ms(f.speed)} on average.", f"The average walking speed will be {self.ms(f.speed)}.")]
        opts.append(self.pick(f"The flight should last {self.sec(f.duration)}.", f"Film for {self.sec(f.duration)}.", f"Plan for {self.asec(f.duration, 'flight')}.", f"Duration: {self.sec(f.duration)}."))
        self.rng.shuffle(opts)
        return opts[:self.pick(0, 0, 0, 1, 1, limit)]

    def instruction(self, flight):
        self.begin(past=False)
        f = flight
        who = self.stander(f, self.who(f))
        act = self.verb(f, who)
        more = self.extras(f)
        if not f.walks and "stationary" not in who and "standing" not in who and self.pick(True, True, False):
            more.insert(0, self.stand_imp(f))
        tail = "".join(" " + x for x in more)
        d, p = self.d_adv(f), self.p_np(f)
        lead = self.pick("", "", "Please ", "For this shot, ", "Throughout the flight, ", "Your task: ")
        k = self.pick(*range(17))
        if k == 0:
            return cap(f"{lead}{act} {d}, with {p}.") + tail
        if k == 1:
            parts = [self.d_imp(f), self.p_imp(f)]
            self.rng.shuffle(parts)
            return cap(f"{lead}{act}.") + " " + " ".join(parts) + tail
        if k == 2:
            return f"With {p}, {act} {d}." + tail
        if k == 3:
            return self.pick("Could you", "Can you", "Would you", "Could the drone please") + f" {act} {d}, with {p}?" + tail
        if k == 4:
            return self.pick("Your task is to", "The goal is to", "The assignment is to", "I'd like you to", "You are asked to", "The drone needs to", "The drone should") + f" {act}. {self.p_imp(f)} {self.d_imp(f)}" + tail
        if k == 5:
            rows = [f"Distance: {self.m(f.distance)}", f"Camera: {self.p_note(f)}"]
            self.rng.shuffle(rows)
            rows = [self.pick("Target", "Subject", "Who to film") + f": {self.wear_note(f)}" + ("" if f.walks else self.pick(", standing still", ", stationary"))] + rows
            if f.altitude >= 1 and self.pick(True, False):
                rows.append(f"Altitude: {self.m(f.altitude)}")
            return self.pick("; ".join(rows) + ".", "\n".join("- " + r for r in rows), ". ".join(rows) + ".", " | ".join(rows))
        if k == 6:
            return self.pick("I need footage of", "We need a continuous shot of", "Requested: a drone shot of", "I would like a video of") + f" {who}, taken {self.pick('from', 'at')} a distance of {self.m(f.distance)}, with {p}." + tail
        if k == 7:
            ing = self.pick("While following", "When tracking", "As you follow") if f.walks else self.pick("While filming", "When recording", "As you observe")
            return f"{ing} {who}, " + self.pick(f"maintain {self.d_np(f)} and shoot with {p}.", f"hold {self.d_np(f)} and use {p}." if p.startswith("a ") or p.startswith("an ") else f"hold {self.d_np(f)} and fly with {p}.") + tail
        if k == 8:
            return f"Position the drone {self.m(f.distance)} from {who}. {self.p_imp(f)} Then {self.verb(f, self.pick('them', 'the person'))}." + tail
        if k == 9:
            steps = [cap(act) + ".", self.d_imp(f), self.p_imp(f)] + more
            return self.pick(" ", "\n").join(f"{i + 1}{self.pick('.')} {s}" for i, s in enumerate(steps))
        if k == 10:
            return cap(f"{who} is to be " + (self.pick("followed", "tracked", "filmed") if f.walks else self.pick("filmed", "observed", "recorded")) + f" {d}, with {p}.") + tail
        if k == 11:
            if f.altitude < 1:
                return f"{self.p_imp(f)} {cap(act)}. {self.d_imp(f)}" + tail
            return cap(f"{act} from {self.h_np(f)} and at a distance of {self.m(f.distance)}, with {p}.") if "from" not in act else cap(f"{act}. {self.d_imp(f)}")
        if k == 12:
            return self.pick(f"Distance {self.m(f.distance)}, camera {self.p_note(f)}: {act}.", f"{cap(self.m(f.distance))} away, camera {self.p_note(f)}: {act}.") + tail
        if k == 13:
            shot = self.pick("a tracking shot", "a follow shot") if f.walks else "a shot"
            return f"Give me {shot} of {who}, with {self.d_np(f)} between camera and subject. {self.p_imp(f)}" + tail
        if k == 14:
            return f"The shot calls for {self.p_np2(f)} and {self.d_np(f)} to {who}." + tail
        if k == 15:
            return f"Keep {self.d_np(f)} from {who}, and fly with {p} as you {self.verb(f, 'them')}." + tail
        return f"Find {who} and " + self.verb(f, "them") + f" {d}; " + self.low(self.p_imp(f)) + tail

    def low(self, s):
        return s if s.startswith("I ") else s[:1].lower() + s[1:]

    def p_np2(self, f):
        if f.pitch == 0:
            return self.pick("a level camera", "a horizontal camera", "a camera that is not tilted at all")
        down, ward, below, _ = self.sense(f)
        return self.pick(f"a camera tilted {self.deg(f.pitch)} {ward}", f"{an(ward)} camera angle of {self.deg(f.pitch)}", f"a camera pointing {self.deg(f.pitch)} {below} the horizon", f"a lens angled {self.deg(f.pitch)} {down}")

    def p_note(self, f):
        if f.pitch == 0:
            return self.pick("level", "horizontal", "0° tilt (level)", "no tilt")
        down, ward, below, _ = self.sense(f)
        g = self.deg(f.pitch)
        return self.pick(f"{g} {ward}", f"tilted {down} {g}", f"{g} {below} the horizon", f"{g} {below} horizontal", f"angled {g} {down}", f"pitched {g} {ward}")

    # ---- description
    def t_note(self, f):
        return self.t_list(f.turns) if f.turns else self.pick("none", "no turns", "0")

    def s_note(self, f):
        if not f.stops:
            return self.pick("none", "no stops", "0")
        s = self.sec(f.standing)
        if not f.standing:
            return str(f.stops)
        if f.stops == 1:
            return self.pick(f"1 ({s})", f"one, lasting {s}", f"one stop of {s}")
        return self.pick(f"{f.stops} ({s} in total)", f"{words(f.stops)}, {s} altogether", f"{f.stops}, standing still for {s} in total")

    def notes(self, f):
        rows = []
        if f.walks:
            rows = [self.pick("Turns", "Turns in order", "Turn sequence", "Changes of direction") + f": {self.t_note(f)}" if len(f.turns) != 1 else "Turns: one, " + self.t_list(f.turns), self.pick("Stops", "Pauses") + f": {self.s_note(f)}",
                    self.pick("Distance walked", "Walking distance", "Length of walk", "Path length") + f": {self.m(f.way)}", self.pick("Duration", "Flight time", "Flight duration") + f": {self.sec(f.duration)}",
                    self.pick("Average walking speed", "Mean walking speed", "Walking speed (mean)") + f": {self.ms(f.speed)}"]
        else:
            rows = [self.pick("Movement: none, the person stands on one spot", "Activity: standing in one place the whole time", "The person: standing still throughout"), self.pick("Duration", "Flight time", "Flight duration") + f": {self.sec(f.duration)}"]
        rows += [self.pick("Distance from drone to person", "Drone-to-person distance", "Mean distance to the person", "Filming distance") + f": {self.m(f.distance)}", self.pick("Camera angle", "Camera pitch", "Camera") + f": {self.p_note(f)}"]
        if f.altitude >= 1:
            rows.append(self.pick("Altitude", "Flight height", "Height above the person's feet") + f": {self.m(f.altitude)}")
        if self.pick(True, False):
            self.rng.shuffle(rows)
        return [self.pick("Subject", "Person filmed", "Target") + f": {self.wear_note(f)}"] + rows

    def drone_sents(self, f):
        kind = self.pick(0, 0, 1, 2, 3)
        h = f.altitude >= 1
        if kind == 0 or not h and kind == 3:
            out = [self.d_s(f), self.p_s(f)] + ([self.h_s(f)] if h else [])
            self.rng.shuffle(out)
            return out
        stay = self.v("stayed", "stays")
        if kind == 1:
            return [f"The drone {stay} {self.m(f.distance)} from {self.refo()}" + (f" at {self.h_np(f)}" if h and self.pick(1, 1) else "") + f", with {self.p_np(f)}."]
        if kind == 2:
            return [f"Filming {self.v('took', 'takes')} place {self.pick('from', 'at')} a distance of {self.m(f.distance)}, with {self.p_np(f)}."] + ([self.h_s(f)] if h else [])
        return [f"Flying at {self.h_np(f)}, the drone {self.v('kept', 'keeps')} {self.d_np(f)} from {self.refo()}.", self.p_s(f)]

    def walk_sents(self, f):
        out = self.length(f)
        ts = [self.t_s(f), self.s_s(f)]
        if self.pick(0, 0, 1):
            ts.reverse()
        if self.pick(0, 0, 0, 1):
            subj = cap(self.ref()) if not self.past else self.pick("They", cap(self.ref()))
            short_turn = self.t_vp(f.turns, self.form())
            ts = [f"{subj} {self.s_vp(f, self.form())}" + ("; there " + self.v("were", "are") + " no turns." if not f.turns else f"; as for turns, {self.v('they', 'the person')} {short_turn}.")]
        return self.pick(out + ts, ts + out)

    def acted(self, f):
        v = self.v
        return self.pick(v("followed", "follows"), v("tracked", "tracks"), v("filmed", "films"), v("accompanied", "accompanies")) if f.walks else self.pick(v("filmed", "films"), v("observed", "observes"), v("recorded", "records"))

    def description(self, flight):
        self.begin()
        f = flight
        k = self.pick(*range(11))
        if k in (0, 1):
            rows = self.notes(f)
            head = self.pick("", "", "Flight summary", "Flight log", "Summary of the flight")
            if k == 0:
                return (head + ":\n" if head else "") + "\n".join("- " + r for r in rows)
            sep = self.pick("; ", "; ", ". ", " | ")
            return (head + ": " if head else "") + sep.join(rows) + ("" if sep == " | " else ".")
        if not f.walks:
            return self.standing_description(f, k)
        who = self.who(f)
        h = f.altitude >= 1
        v = self.v
        drone = self.drone_sents(f)
        if k in (2, 3):
            opening = self.pick(f"The drone {self.acted(f)} {who}.", f"In this flight, the drone {self.acted(f)} {who}.", f"{cap(who)} {v('was', 'is')} {self.pick('followed', 'tracked', 'filmed')} by the drone.",
                                f"The footage {v('showed', 'shows')} {who}.", f"This flight {v('was', 'is')} about following {who}.", f"The subject of the flight {v('was', 'is')} {who}.", f"On this flight, {who} {v('was', 'is')} filmed from the air.")
            body = self.pick(drone + self.walk_sents(f), self.walk_sents(f) + drone)
            return " ".join([opening] + body)
        if k == 4:
            opening = f"The drone {self.acted(f)} {who} {self.d_adv(f)}, with {self.p_np(f)}."
            return " ".join([opening] + self.pick([self.h_s(f)] + self.walk_sents(f), self.walk_sents(f) + [self.h_s(f)])) if h else " ".join([opening] + self.walk_sents(f))
        if k == 5:
            opening = self.pick(f"{cap(who)} {v('walked', 'walks')} {self.m(f.way)} at an average of {self.ms(f.speed)}, while the drone {v('filmed', 'films')} for {self.sec(f.duration)}.",
                                f"During {self.asec(f.duration, 'flight')}, {who} {v('walked', 'walks')} {self.m(f.way)} at an average speed of {self.ms(f.speed)}.",
                                f"Over {self.sec(f.duration)}, {who} {v('covered', 'covers')} {self.m(f.way)} with a mean walking speed of {self.ms(f.speed)}.")
            ts = [self.t_s(f), self.s_s(f)]
            return " ".join([opening] + self.pick(ts + drone, drone + ts, [ts[0]] + drone + [ts[1]]))
        if k == 6:
            opening = f"With {self.p_np(f)}" + (f" and the drone at {self.h_np(f)}" if h else "") + f", {who} {v('was', 'is')} {self.pick('filmed', 'followed', 'tracked')} {self.pick('from', 'at')} a distance of {self.m(f.distance)}."
            return " ".join([opening] + self.walk_sents(f))
        if k == 7:
            # one long sentence
            stop = ("without a single stop" if f.stops == 0 else (f"with {words(f.stops)} stop" + ("" if f.stops == 1 else "s") + (f" ({self.sec(f.standing)}" + ("" if f.stops == 1 else " in total") + ")" if f.standing else "")))
            turn = "without any turns" if not f.turns else "with " + ("one turn" if len(f.turns) == 1 else f"{words(len(f.turns))} turns") + f" ({self.t_list(f.turns)})"
            parts = self.pick(f"{stop} and {turn}", f"{turn} and {stop}")
            return (f"Over {self.sec(f.duration)}, the drone {self.acted(f)} {who} {self.d_adv(f)}, with {self.p_np(f)}" + (f" and at {self.h_np(f)}" if h else "") +
                    f", as {self.pick('the person', 'the subject')} {v('walked', 'walks')} {self.m(f.way)} at an average of {self.ms(f.speed)}, {parts}.")
        if k == 8:
            qa = [f"Who {v('was', 'is')} filmed? {cap(who)}.", f"How far away {v('was', 'is')} the drone? {cap(self.m(f.distance))} on average.", f"How {v('was', 'is')} the camera angled? {cap(self.p_note(f))}.",
                  f"How far {v('did', 'does')} the person walk? {cap(self.m(f.way))}, at an average of {self.ms(f.speed)}.", f"How long {v('did', 'does')} the flight last? {cap(self.sec(f.duration))}.",
                  f"Which turns {v('were', 'are')} made? {cap(self.t_list(f.turns)) if f.turns else 'There ' + v('were', 'are') + ' no turns'}.", f"Any stops? {cap(self.s_note(f)) if f.stops else 'No stops at all'}."]
            if h:
                qa.append(f"How high {v('was', 'is')} the drone? {cap(self.m(f.altitude))} above the person's feet.")
            return " ".join(qa)
        if k == 9:
            self.past = True
            opening = self.pick(f"I flew the drone {self.m(f.distance)} from {who}, with {self.p_np(f)}.", f"With the drone, I {self.pick('followed', 'tracked')} {who}, keeping {self.d_np(f)}. {self.p_s(f)}", f"My drone followed {who} {self.d_adv(f)}. {self.p_s(f)}")
            return " ".join([opening] + ([self.h_s(f)] if h else []) + self.walk_sents(f))
        opening = self.pick("Flight summary:", "What the footage shows:", "Summary:", "Flight report:")
        first = self.pick(f"{self.asec(f.duration, 'flight')} in which the drone {self.acted(f)} {who}.", f"{self.sec(f.duration)} of footage of {who}.")
        rest = [f"{cap(self.m(f.way))} walked, {self.ms(f.speed)} on average.", self.t_s(f), self.s_s(f)]
        return " ".join([opening, first] + self.pick(rest + drone, drone + rest))

    def standing_description(self, f, k):
        who, v, h = self.who(f), self.v, f.altitude >= 1
        drone = self.drone_sents(f)
        s = self.stand_s(f)
        t = self.sec(f.duration)
        return self.pick(
            " ".join([f"The drone {self.acted(f)} {who}.", s] + drone),
            " ".join([f"{cap(who)} {v('stood', 'stands')} in one place for {t} while the drone {v('filmed', 'films')}."] + drone),
            " ".join([f"{cap(who)} {v('was', 'is')} {self.pick('filmed', 'observed', 'recorded')} by the drone."] + drone + [s]),
            " ".join([f"With {self.p_np(f)}, the drone {self.acted(f)} {who} {self.pick('from', 'at')} a distance of {self.m(f.distance)}."] + ([self.h_s(f)] if h else []) + [s]),
            f"For {t}, the drone {self.acted(f)} {who} {self.d_adv(f)}, with {self.p_np(f)}" + (f" and at {self.h_np(f)}" if h else "") + f"; {self.pick('the person', 'the subject')} {v('stood', 'stands')} still on one spot the whole time.",
            " ".join(["Flight summary:", f"{self.sec(f.duration)} of footage of {who}, standing still from beginning to end."] + drone),
            " ".join([f"The footage {v('showed', 'shows')} {who}."] + drone + [s]),
            f"Who {v('was', 'is')} filmed? {cap(who)}. What {v('did', 'does')} the person do? Stand on one spot for the full {t} of the flight. How far away {v('was', 'is')} the drone? {cap(self.m(f.distance))}. How {v('was', 'is')} the camera angled? {cap(self.p_note(f))}." +
            (f" At what height? {cap(self.m(f.altitude))} above the person's feet." if h else ""))

    # ---- wrong texts
    def foreign(self, text):
        thing, person = self.pick(*self.things), an(self.pick(*self.persons))
        cut = text.rstrip(".")
        if cut.endswith("?"):
            return self.pick(f"{cut} All of this {thing}.", f"{cut} The person is {person}.", f"{cut} Also in view is {person}.")
        return self.pick(f"{cut}, {thing}.", f"{cut}, {thing}.", f"{cut}, all of it {thing}.", f"{cut}. All of this {thing}.", f"{text} The person is {person}.", f"{text} The subject is clearly {person}.", f"{text} Also in view is {person}.",
                         f"{cut}, together with {person}.", f"Subject: {person}. {text}", f"{text} (The person in question is {person}.)")

    def heading(self, text, direction):
        d = direction
        return self.pick(f"{text} The person is heading {d}.", f"{text} Direction of travel: {d}.", f"{text} The person walks toward the {d}.", f"Walking direction: {d}. {text}", f"{text} The walk leads {d}.", f"{text} Overall, the person moves in {an(d + 'erly')} direction.",
                         f"{text.rstrip('.?')}, with the person walking {d}.", f"{text} The route goes to the {d}.", f"{text} (Heading: {d}.)", f"{text.rstrip('.')}, walking towards the {d}." if not text.rstrip().endswith("?") else f"{text} They walk {d}.")


# ====================================================================================================================

DIGITS = "零一二三四五六七八九"


def hanzi(n):
    if n < 10:
        return DIGITS[n]
    if n < 20:
        return "十" + (DIGITS[n % 10] if n % 10 else "")
    if n < 100:
        return DIGITS[n // 10] + "十" + (DIGITS[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        return DIGITS[n // 100] + "百" + ("" if not rest else "零" + DIGITS[rest] if rest < 10 else ("一" if rest < 20 else "") + hanzi(rest))
    return str(n)


class TwentiethChinese(Grammar):
    code = "zh"
    things = ["旁边有一座喷泉", "远处传来雷声", "还牵着两条狗", "天空飘着小雨", "路边停着一辆货车", "街角有家咖啡馆", "夕阳正好", "手里撑着一把雨伞", "头上戴着草帽", "一边走一边打电话", "周围挤满了游客", "地上积着薄雪",
              "身后跟着一个骑滑板车的孩子", "沿途樱花盛开", "河边有人钓鱼", "早高峰车流不断", "雾很大", "旁边是一栋红砖仓库", "耳边响着教堂的钟声", "身旁不时有自行车经过", "推着一辆婴儿车", "前面是一座石桥", "集市上人声鼎沸", "风刮得很大"]
    persons = ["护士", "渔夫", "女学生", "警察", "退休教师", "小伙子", "服务员", "快递员", "老太太", "商人", "街头艺人", "建筑工人"]

    def begin(self):
        self.spell = self.pick(True, False, False, False, False, False)
        self.sign = self.pick(True, False, False)
        self.space = self.pick("", "", " ")
        self.unit = self.pick("米", "米", "米", "m")
        self.back = self.pick("掉头", "掉头", "调头", "转身折返", "掉头往回走", "转身往回走")

    def n(self, x):
        return ("两" if x == 2 else hanzi(x)) if self.spell else self.space + str(x) + self.space

    def m(self, x):
        return self.n(x) + ("米" if self.spell else self.unit)

    def sec(self, x):
        return self.n(x) + self.pick("秒", "秒", "秒钟")

    def deg(self, x):
        x = abs(x)
        return f"{x}°" if self.sign and not self.spell else self.n(x) + "度"

    def ms(self, s):
        if self.spell:
            whole, part = str(s).split(".")
            return f"每秒{DIGITS[int(whole)]}点{DIGITS[int(part)]}米"
        return self.pick(f"每秒{self.space}{s}{self.space}米", f"{self.space}{s}{self.space}米/秒", f"{self.space}{s}{self.space}米每秒", f"{self.space}{s}{self.space}m/s")

    def k(self, x):
        return "两" if x == 2 else hanzi(x) if self.pick(True, True, False) else str(x)

    def finish(self, text):
        """full-width punctuation; no space beside it"""
        for half, whole in zip(",:;?()", "\uff0c\uff1a\uff1b\uff1f\uff08\uff09"):
            text = text.replace(half, whole)
        while "  " in text:
            text = text.replace("  ", " ")
        for mark in "\uff0c\uff1a\uff1b\uff1f\uff08\uff09\u3002\u3001\n":
            text = text.replace(mark + " ", mark).replace(" " + mark, mark)
        return text.strip()

    def instruction(self, flight):
        return self.finish(self.write_instruction(flight))

    def description(self, flight):
        return self.finish(self.write_description(flight))

    # ---- 人
    def who(self, f, definite=None):
        definite = self.pick(True, False) if definite is None else definite
        nouns = ["人", "人", "目标人物", "行人"] if f.walks else ["人", "人", "目标人物"]
        noun = self.pick(*nouns)
        if not definite:
            noun = "人" if noun == "目标人物" else noun
            one = self.pick("一个", "一位", "一名") if noun == "行人" else "一个"
        else:
            one = self.pick("那个", "那位") if noun == "行人" else "那个" if noun == "人" else ""
        if not f.wear:
            return one + noun
        top, low, bag = ZH_COLOURS[f.wear[0]], ZH_COLOURS[f.wear[1]], f.wear[2]
        if top == low and self.pick(True, False):
            clothes = self.pick(f"上衣和裤子都是{top}色", f"穿着{top}色上衣和同样是{top}色的裤子", f"上下身都穿{top}色", f"上衣、裤子均为{top}色")
        else:
            clothes = self.pick(f"穿{top}色上衣、{low}色裤子", f"穿着{top}色上衣和{low}色裤子", f"身穿{top}色上衣、{low}色裤子", f"上身穿{top}色、下身穿{low}色裤子", f"上衣{top}色、裤子{low}色",
                                f"身着{top}色上衣搭配{low}色裤子", f"穿{low}色裤子、{top}色上衣", f"上衣为{top}色、裤子为{low}色", f"穿{top}上衣{low}裤子" if top not in "橙粉棕米" and low not in "橙粉棕米" else f"穿{top}色上衣配{low}色裤子", f"身上是{top}色上衣和{low}色裤子")
        if bag:
            clothes = self.pick(clothes + "、背着背包", clothes + "、背着双肩包", clothes + "并背着背包", "背着背包、" + clothes, clothes + "、背了个背包", clothes + "、背上有背包")
        else:
            clothes += self.pick("", "", "", "、没有背包", "、没背包")
        style = self.pick(0, 0, 1) if definite else 0
        if style == 1 and noun == "人":
            return f"那个{clothes}的人"
        return self.pick(f"{one}{clothes}的{noun}", f"{clothes}的{one}{noun}" if definite and one else f"{one}{clothes}的{noun}", f"{clothes}的{noun}" if definite else f"{one}{clothes}的{noun}")

    def ref(self):
        return self.pick("对方", "此人", "目标", "这个人", "被拍摄者", "该人物", "目标人物")

    def wear_note(self, f):
        if not f.wear:
            return self.pick("一人", "一个人", "单人")
        top, low, bag = ZH_COLOURS[f.wear[0]], ZH_COLOURS[f.wear[1]], f.wear[2]
        return self.pick(f"{top}色上衣、{low}色裤子", f"一人,上衣{top}色,裤子{low}色".replace(",", ","), f"上身{top}色,下身{low}色裤子", f"穿{top}色上衣和{low}色裤子的人") + (self.pick(",背着背包", ",有背包", "(背着背包)") if bag else self.pick("", "", ",无背包"))

    # ---- 距离
    def d_adv(self, f):
        """状语,放在动词前"""
        d = self.m(f.distance)
        return self.pick(f"在{d}外", f"在距离{d}的位置", f"隔着{d}的距离", f"以{d}的距离", f"保持{d}的距离", f"在相距{d}处", f"从{d}远的地方", f"在{d}远处", f"以{d}的直线距离", f"始终保持{d}的间距")

    def d_imp(self, f):
        d, r = self.m(f.distance), self.ref()
        return self.pick(f"与{r}保持{d}的距离", f"距离保持在{d}", f"无人机离{r}{d}", f"和{r}之间隔{d}", f"跟{r}拉开{d}的距离", f"直线距离为{d}", f"请把距离控制在{d}", f"距{r}{d}飞行", f"人机距离设为{d}", f"{d}的间距要一直保持住", f"飞机到{r}的直线距离应为{d}",
                         f"拍摄距离{d}", f"离{r}{d}远就行", f"距离方面,要求是{d}")

    def d_s(self, f):
        d, r = self.m(f.distance), self.ref()
        return self.pick(f"无人机与{r}平均相距{d}", f"无人机和{r}之间的平均距离是{d}", f"全程平均距离为{d}", f"无人机离{r}平均{d}远", f"拍摄距离平均为{d}", f"两者之间的直线距离平均为{d}".replace("两者", "无人机和人"), f"{r}距无人机{d}", f"无人机与{r}保持着{d}的距离",
                         f"无人机在距{r}{d}的地方拍摄", f"平均而言,无人机到{r}的直线距离是{d}", f"人机之间隔着{d}", f"{d}是无人机与{r}的平均距离", f"跟拍距离为{d}" if f.walks else f"拍摄距离为{d}")

    # ---- 俯仰
    def p_s(self, f):
        """小句,指令和描述通用"""
        if f.pitch == 0:
            return self.pick("镜头保持水平", "镜头平视前方", "相机不俯不仰", "镜头水平朝前", "相机俯仰角为0度", "云台保持水平", "镜头与地平线齐平", "相机水平拍摄", "镜头没有任何俯仰", "采用平视角度拍摄", "拍摄角度为平视")
        g = self.deg(f.pitch)
        if f.pitch > 0:
            return self.pick(f"镜头向下倾斜{g}", f"镜头下俯{g}", f"相机俯角为{g}", f"俯拍角度{g}", f"镜头朝下{g}", f"云台下压{g}", f"镜头指向地平线以下{g}", f"相机低于水平线{g}", f"镜头往下压{g}", f"以{g}俯角拍摄", f"相机光轴位于水平线下方{g}", f"镜头以{g}的角度向下俯拍", f"摄像头的俯角是{g}", f"镜头从水平方向向下偏{g}")
        return self.pick(f"镜头向上倾斜{g}", f"镜头上仰{g}", f"相机仰角为{g}", f"仰拍角度{g}", f"镜头朝上{g}", f"云台上抬{g}", f"镜头指向地平线以上{g}", f"相机高于水平线{g}", f"镜头往上抬{g}", f"以{g}仰角拍摄", f"相机光轴位于水平线上方{g}", f"摄像头的仰角是{g}", f"镜头从水平方向向上偏{g}")

    def p_imp(self, f):
        if f.pitch == 0:
            return self.pick(self.p_s(f), "请让镜头保持水平", "把镜头放平", "镜头不要上仰也不要下俯", "将云台调到水平", "相机要保持平视")
        g, down = self.deg(f.pitch), f.pitch > 0
        if down:
            return self.pick(self.p_s(f), f"把镜头往下压{g}", f"将云台向下调{g}", f"请将镜头下俯{g}", f"镜头需要向下倾斜{g}", f"相机俯角设为{g}", f"让镜头对准水平线以下{g}", f"镜头要朝下俯{g}")
        return self.pick(self.p_s(f), f"把镜头往上抬{g}", f"将云台向上调{g}", f"请将镜头上仰{g}", f"镜头需要向上倾斜{g}", f"相机仰角设为{g}", f"让镜头对准水平线以上{g}", f"镜头要朝上仰{g}")

    def p_note(self, f):
        if f.pitch == 0:
            return self.pick("水平", "平视", "0度(水平)")
        g = self.deg(f.pitch)
        return self.pick(f"俯角{g}", f"下俯{g}", f"向下{g}", f"水平线以下{g}") if f.pitch > 0 else self.pick(f"仰角{g}", f"上仰{g}", f"向上{g}", f"水平线以上{g}")

    # ---- 高度
    def h_s(self, f):
        a = self.m(f.altitude)
        return self.pick(f"飞行高度{a}", f"飞行高度为{a}", f"无人机比人的脚底高{a}", f"无人机飞在{a}的高度", f"高度保持在{a}", f"无人机高出人脚下地面{a}", f"机身离人脚下的地面有{a}高", f"无人机的高度是{a}", f"相对人脚的高度为{a}", f"以脚底为基准,无人机高{a}", f"飞行高度维持在{a}")

    def h_imp(self, f):
        a = self.m(f.altitude)
        return self.pick(f"飞行高度{a}", f"高度保持{a}", f"请飞在{a}的高度", f"飞行高度设为{a}", f"无人机要比人的脚底高{a}", f"高度控制在{a}", f"飞到高出人脚下地面{a}的位置")

    # ---- 转弯
    def t_word(self, t):
        return self.back if t == "around" else {"left": "左转", "right": "右转"}[t]

    def t_list(self, turns):
        back = "掉头" if self.back not in ("调头",) else "调头"
        items = [back if t == "around" else {"left": "左转", "right": "右转"}[t] for t in turns]
        return self.pick("、", "、", " → ", ",", ",再", ",然后").join(items)

    def t_clause(self, turns):
        """不带主语的谓语"""
        if not turns:
            return self.pick("没有转弯", "一次弯也没转", "途中没有转过弯", "全程没有转弯", "从头到尾没拐过弯", "一个弯都没转")
        n, w = len(turns), [self.t_word(t) for t in turns]
        if n == 1:
            t = turns[0]
            if t == "around":
                return self.pick("掉了一次头", "转身折返了一次", "掉头一次", "调头一次", "只掉过一次头")
            s = "左" if t == "left" else "右"
            return self.pick(f"向{s}转了一次弯", f"{s}转一次", f"{s}转了一次", f"往{s}拐了一次", f"只转过一次弯,是向{s}", f"拐了一次弯,往{s}")
        if len(set(turns)) == 1:
            t, k = turns[0], self.k(n)
            if t == "around":
                return self.pick(f"掉了{k}次头", f"{k}次掉头", f"先后{k}次转身折返", f"一共掉头{k}次")
            s = "左" if t == "left" else "右"
            return self.pick(f"{s}转了{k}次", f"连续{k}次{s}转", f"向{s}转了{k}次弯", f"转了{k}次弯,都是向{s}", f"往{s}拐了{k}次", f"共{s}转{k}次")
        style = self.pick(0, 0, 1, 2, 3, 4)
        if style == 0:
            if n == 2:
                return self.pick(f"先{w[0]},再{w[1]}", f"先{w[0]}后{w[1]}", f"{w[0]}之后又{w[1]}")
            mid = "".join(f",{self.pick('再', '接着', '然后', '随后')}{x}" for x in w[1:-1])
            return f"先{w[0]}{mid},最后{w[-1]}"
        if style == 1:
            return f"依次{'、'.join(w)}"
        if style == 2:
            return f"转向{self.k(n)}次,依次是{'、'.join(w)}"
        if style == 3:
            parts = []
            for t, c in runs(turns):
                parts.append(self.t_word(t) if c == 1 else f"连续{self.k(c)}次{'掉头' if t == 'around' else self.t_word(t)}")
            return "先" + parts[0] + "".join(f",{self.pick('再', '接着', '然后', '之后')}{p}" for p in parts[1:])
        return f"按先后顺序{'、'.join(w)}"

    def t_s(self, f):
        t, r = f.turns, self.ref()
        if not t:
            return self.pick(f"{r}{self.t_clause(t)}", "途中没有任何转弯", "转弯次数为零", "一路上没有转弯", f"整段路{r}都没转弯", "全程无转弯")
        n, lst = len(t), self.t_list(t)
        base = self.pick("途中", "一路上", "行走过程中", "", "") + r + self.t_clause(t)
        if n == 1:
            w = "掉头" if t[0] == "around" else self.t_word(t[0])
            return self.pick(base, base, f"全程只有一次转向,即{w}", f"途中有一次{w}", f"唯一一次转向是{w}", f"共转向一次:{w}", f"转向:{w}一次")
        nums = "".join(f"{',' if i else ''}第{hanzi(i + 1)}次{'掉头' if x == 'around' else self.t_word(x)}" for i, x in enumerate(t))
        return self.pick(base, base, base, f"一共转向{self.k(n)}次,依次为{lst}", f"转向顺序:{lst}", f"路线中共有{self.k(n)}次转向:{lst}", f"{self.k(n)}次转向分别是:{nums}", f"{self.k(n)}次转向的先后顺序是{lst}", f"转向依次为{lst}")

    # ---- 停留
    def s_clause(self, f):
        k = f.stops
        if not k:
            return self.pick("没有停下", "一次也没停", "中途没有停留", "全程没有停步", "从未停下来", "一路没停过", "没有停顿")
        s = self.sec(f.standing)
        if not f.standing:
            return f"停了{self.k(k)}次"
        if k == 1:
            return self.pick(f"停了一次,站了{s}", f"停留一次,时长{s}", f"中途停下一次,停了{s}", f"停下来一次,原地站了{s}", f"停顿一次,历时{s}", f"只停过一次,持续{s}", f"途中停了一回,站立{s}")
        q = self.k(k)
        return self.pick(f"停了{q}次,共{s}", f"停留{q}次,合计{s}", f"中途停下{q}次,一共站了{s}", f"停过{q}次,加起来{s}", f"停顿{q}次,总时长{s}", f"先后停了{q}次,总共站立{s}", f"停下来{q}次,累计{s}", f"停步{q}次,累计站立{s}")

    def s_s(self, f):
        k, r = f.stops, self.ref()
        base = r + self.s_clause(f)
        if not k:
            return self.pick(base, base, "途中没有停留", "停留次数为零", "一路走下来,没有停过", "全程无停顿")
        s = self.sec(f.standing)
        if not f.standing:
            return base
        if k == 1:
            return self.pick(base, base, f"途中有一次停留,时长{s}", f"停留共一次,停了{s}", f"唯一的一次停留持续了{s}", f"其间站住一次,共{s}", f"中间有一次停顿,长{s}")
        q = self.k(k)
        return self.pick(base, base, f"途中有{q}次停留,总共{s}", f"{q}次停留加起来{s}", f"站立时间合计{s},分{q}次", f"停留共{q}次,累计{s}", f"总共有{s}站着不动,分散在{q}次停留中", f"中途停了{q}回,总计{s}")

    # ---- 路程、时长、速度
    def length(self, f):
        w, t, s, r = self.m(f.way), self.sec(f.duration), self.ms(f.speed), self.ref()
        walk = self.pick(f"{r}一共走了{w}", f"行走总长{w}", f"步行路程为{w}", f"{r}总共走了{w}路", f"全程步行{w}", f"{r}走过的路程是{w}", f"共走{w}", f"行走距离为{w}", f"步行里程合计{w}", f"路线长度{w}", f"{r}走完了{w}")
        speed = self.pick(f"平均步行速度{s}", f"步行速度平均为{s}", f"{r}以平均{s}的速度行走", f"走路的平均速度是{s}", f"平均步速为{s}", f"步速平均{s}", f"平均行走速度为{s}", f"行走时的平均速度是{s}", f"步行均速{s}")
        dur = self.pick(f"飞行持续{t}", f"飞行时长{t}", f"整个飞行历时{t}", f"这次飞行用时{t}", f"飞行时间共{t}", f"全程飞行{t}", f"飞行总时长为{t}", f"录像时长{t}", f"飞行一共{t}", f"拍摄共持续{t}")
        k = self.pick(*range(10))
        if k < 4:
            out = [walk, speed, dur]
            self.rng.shuffle(out)
            return out
        return [[f"在{t}的飞行中,{r}以平均{s}的速度走了{w}"], [f"{r}一共走了{w},平均步行速度{s},飞行历时{t}"], [f"飞行持续{t},其间{r}步行{w},平均速度{s}"], [f"{t}内,{r}走了{w},步行均速{s}"],
                [f"以平均{s}的步速,{r}走了{w}", dur], [f"整段路程{w},飞行用时{t},步行均速为{s}"]][k - 4]

    # ---- 站着不动
    def stand_imp(self, f):
        return self.pick("目标站在原地不动", "人一直站着不走动", "目标人物全程站立", "对方不会移动", "这个人只是站在一处", "人站着,不走路", "目标始终停在同一个地方", "对方会一直站在原地", "注意,人是静止站立的", "目标原地站立,无需跟着移动")

    def stand_s(self, f):
        t, r = self.sec(f.duration), self.ref()
        return self.pick(f"{r}一直站在原地,共{t}", f"整个飞行的{t}里,{r}始终站着没动", f"飞行历时{t},{r}全程站在同一处", f"{r}原地站立了{t}", f"在{t}的飞行过程中,{r}没有走动,一直站着", f"{t}内{r}始终站在一个地方", f"{r}从头到尾站在原地,时长{t}", f"{r}站着不动,飞行持续{t}", f"全程{t},{r}都没有离开过原地", f"{r}没有行走,站立时间与飞行时间一样,都是{t}")

    # ---- 指令
    def verb(self, f):
        return self.pick("跟着", "跟随", "跟拍", "追踪", "跟住", "持续跟随") if f.walks else self.pick("拍摄", "对准", "观察", "盯着拍", "守着拍", "持续拍摄")

    def extras(self, f, no_height=False):
        opts = []
        if f.altitude >= 1 and not no_height:
            opts.append(self.h_imp(f))
        if f.walks:
            t = f.turns
            opts += [self.pick("对方会", "目标将", "这个人会", "目标会") + (self.t_future(t)),
                     ("途中不会停留" if not f.stops else f"途中会停{self.k(f.stops)}次" + (f",{'停' if f.stops == 1 else '一共'}{self.sec(f.standing)}" if f.standing else "")),
                     self.pick(f"对方一共要走{self.m(f.way)}", f"步行总长{self.m(f.way)}", f"全程要走{self.m(f.way)}"), f"对方平均步行速度为{self.ms(f.speed)}"]
        opts.append(self.pick(f"飞行时长{self.sec(f.duration)}", f"拍{self.sec(f.duration)}", f"整个任务持续{self.sec(f.duration)}"))
        self.rng.shuffle(opts)
        return opts[:self.pick(0, 0, 0, 1, 1, 2)]

    def t_future(self, turns):
        if not turns:
            return self.pick("一直不转弯", "全程不转弯")
        n, w = len(turns), [self.t_word(t) for t in turns]
        if n == 1:
            return self.pick(f"{w[0]}一次", f"只{w[0]}一次")
        if len(set(turns)) == 1:
            return f"{self.pick('连续', '一共')}{w[0]}{self.k(n)}次"
        return self.pick(f"依次{'、'.join(w)}", f"先{w[0]},再{',再'.join(w[1:])}", f"先{w[0]}{''.join(',然后' + x for x in w[1:])}", f"转向{self.k(n)}次:{'、'.join(w)}")

    def write_instruction(self, flight):
        self.begin()
        f = flight
        who, v = self.who(f), self.verb(f)
        more = self.extras(f)
        if not f.walks and self.pick(True, True, False):
            more.insert(0, self.stand_imp(f))
        tail = "".join(x + "。" for x in more)
        d, p = self.d_adv(f), self.p_s(f)
        parts = [self.d_imp(f), self.p_imp(f)]
        self.rng.shuffle(parts)
        k = self.pick(*range(16))
        film = "盯" if not f.walks else "跟"
        if k == 0:
            return f"{self.pick('请', '', '麻烦', '请你')}{v}{who},{parts[0]},{parts[1]}。" + tail
        if k == 1:
            return f"{v}{who}。{parts[0]}。{parts[1]}。" + tail
        if k == 2:
            return f"{self.pick('能不能', '可以', '能否', '可否')}{d}{v}{who},{p}?".replace("可以", "可不可以") + tail
        if k == 3:
            return f"请{d}{v}{who},同时{self.p_imp(f).replace('请', '')}。" + tail
        if k == 4:
            rows = [f"距离:{self.m(f.distance)}", f"{self.pick('镜头', '相机角度', '云台')}:{self.p_note(f)}"]
            self.rng.shuffle(rows)
            rows = [f"{self.pick('目标', '拍摄对象', '对象')}:{self.wear_note(f)}" + ("" if f.walks else self.pick(",原地站立", ",站着不动"))] + rows
            if f.altitude >= 1 and self.pick(True, False):
                rows.append(f"高度:{self.m(f.altitude)}")
            return self.pick(";".join(rows) + "。", "\n".join("- " + r for r in rows), "。".join(rows) + "。", " | ".join(rows))
        if k == 5:
            return f"{self.pick('本次任务是', '你的任务是', '任务:', '这次要做的是')}{v}{who}。{self.pick('要求', '拍摄要求', '具体要求')}:{parts[0]},{parts[1]}。" + tail
        if k == 6:
            return f"把无人机{self.pick('飞到', '停在') if not f.walks else '飞到'}离{who}{self.m(f.distance)}的位置,{self.p_imp(f).replace('请', '')},然后{v}{self.pick('对方', '目标', '这个人')}。" + tail
        if k == 7:
            return f"{self.p_imp(f)},{d}{v}{who}。" + tail
        if k == 8:
            return f"我想要一段{self.pick('拍', '拍到', '记录')}{who}的画面,{parts[0]},{parts[1]}。" + tail
        if k == 9:
            steps = [v + who, *parts] + more
            return self.pick("", "\n").join(f"{i + 1}. {s}。" for i, s in enumerate(steps)) if self.pick(1, 0) else ";".join(f"{'一二三四五六七'[i]}、{s}" for i, s in enumerate(steps)) + "。"
        if k == 10:
            return f"{v}{who}的时候,{parts[0]},{parts[1]}。" + tail
        if k == 11:
            return f"无人机{self.pick('应', '需要', '要')}{d}{v}{who},{p}。" + tail
        if k == 12:
            return f"{self.m(f.distance)}距离,镜头{self.p_note(f)},{v}{who}。" + tail
        if k == 13:
            return f"看到{self.who(f, True)}{'了吧' if f.walks else '了吗'}?{self.pick('跟上去', '跟着拍') if f.walks else self.pick('就拍这个人', '对准拍')},{parts[0]},{parts[1]}。" + tail
        if k == 14:
            if f.altitude >= 1:
                return f"{self.pick('保持', '以')}{self.m(f.altitude)}的飞行高度{v}{who},{parts[0]},{parts[1]}。" + "".join(x + "。" for x in (more if not any("高" in x for x in more) else []))
            return f"目标是{who},{parts[0]},{parts[1]},{film}住别丢。" + tail
        return f"请让{who}一直留在画面里,{parts[0]},{parts[1]}。" + tail

    # ---- 描述
    def drone(self, f):
        h = f.altitude >= 1
        out = [self.d_s(f), self.p_s(f)] + ([self.h_s(f)] if h else [])
        k = self.pick(0, 0, 0, 1, 2)
        if k == 1:
            return [f"无人机{self.pick('在', '始终在')}距{self.ref()}{self.m(f.distance)}处" + (f"、{self.m(f.altitude)}的高度上" if h else "") + f"飞行,{self.p_s(f)}"]
        if k == 2 and h:
            return [f"飞行高度{self.m(f.altitude)},{self.p_s(f)},{self.d_s(f)}"]
        self.rng.shuffle(out)
        return out

    def glue(self, sents):
        """把小句连成句子,标点有变化"""
        text = ""
        for i, s in enumerate(sents):
            last = i == len(sents) - 1
            text += s + ("。" if last else self.pick("。", "。", ",", ";"))
        return text

    def full(self, sents):
        return "".join(s + "。" for s in sents)

    def join(self, sents):
        return self.pick(self.full, self.full, self.glue)(sents)

    def walk(self, f):
        ts = self.pick([self.t_s(f), self.s_s(f)], [self.s_s(f), self.t_s(f)], [f"{self.ref()}{self.t_clause(f.turns)};{self.s_s(f)}"])
        return self.pick(self.length(f) + ts, ts + self.length(f))

    def notes(self, f):
        if f.walks:
            if not f.stops:
                s = self.pick("无", "0次", "没有")
            else:
                s = f"{f.stops}次" + (f",{'共' if f.stops > 1 else '时长'}{self.sec(f.standing)}" if f.standing else "")
            rows = [f"{self.pick('转弯', '转向', '转向顺序')}:" + (self.t_list(f.turns) + ("(1次)" if len(f.turns) == 1 and self.pick(1, 0) else "") if f.turns else self.pick("无", "没有")), f"{self.pick('停留', '停顿', '停步')}:{s}", f"{self.pick('步行距离', '行走路程', '步行里程')}:{self.m(f.way)}",
                    f"{self.pick('飞行时长', '飞行时间', '时长')}:{self.sec(f.duration)}", f"{self.pick('平均步行速度', '平均步速', '步行均速')}:{self.ms(f.speed)}"]
        else:
            rows = [self.pick("动作:站在原地不动", "状态:全程原地站立", "人物状态:一直站着,没有走动"), f"{self.pick('飞行时长', '飞行时间', '时长')}:{self.sec(f.duration)}"]
        rows += [f"{self.pick('人机距离', '无人机与人的距离', '拍摄距离', '平均直线距离')}:{self.m(f.distance)}", f"{self.pick('镜头', '相机角度', '镜头俯仰')}:{self.p_note(f)}"]
        if f.altitude >= 1:
            rows.append(f"{self.pick('飞行高度', '高度', '相对人脚的高度')}:{self.m(f.altitude)}")
        if self.pick(True, False):
            self.rng.shuffle(rows)
        return [f"{self.pick('拍摄对象', '目标', '人物')}:{self.wear_note(f)}"] + rows

    def write_description(self, flight):
        self.begin()
        f = flight
        k = self.pick(*range(11))
        if k in (0, 1):
            rows = self.notes(f)
            head = self.pick("", "", "飞行小结", "飞行记录", "航拍摘要")
            if k == 0:
                return (head + ":\n" if head else "") + "\n".join("- " + r for r in rows)
            sep = self.pick(";", ";", "。", " | ")
            return (head + ":" if head else "") + sep.join(rows) + ("" if sep == " | " else "。")
        who, drone, h = self.who(f), self.drone(f), f.altitude >= 1
        v = self.pick("跟拍了", "跟随了", "追踪了", "拍摄了") if f.walks else self.pick("拍摄了", "观察了", "记录了", "对准了")
        opening = self.pick(f"无人机{v}{who}", f"这次飞行中,无人机{v}{who}", f"{self.pick('画面中是', '视频里是', '拍摄对象是', '跟拍对象是' if f.walks else '镜头里是')}{who}", f"{who}被无人机{self.pick('一路跟拍', '全程跟拍', '持续追踪') if f.walks else self.pick('全程拍摄', '持续拍摄')}",
                            f"本次航拍的主角是{who}", f"镜头对着{who}" if not f.walks else f"镜头一路跟着{who}")
        if not f.walks:
            s = self.stand_s(f)
            t = self.sec(f.duration)
            return self.pick(
                self.join([opening, s] + drone), self.join([opening] + drone + [s]),
                self.join([f"{who}在原地站了{t},无人机全程拍摄"] + drone),
                f"无人机{self.d_adv(f)}拍摄了{who},{self.p_s(f)}" + (f",{self.h_s(f)}" if h else "") + f"。{s}。",
                f"{self.p_s(f)},无人机{self.d_adv(f)}对着{who}拍了{t},{self.pick('对方', '此人')}一直站在原地" + (f"。{self.h_s(f)}。" if h else "。"),
                f"拍的是谁?{who}。在做什么?一直站在原地。拍了多久?{t}。距离多远?{self.m(f.distance)}。镜头角度?{self.p_note(f)}。" + (f"飞多高?{self.m(f.altitude)}。" if h else ""),
                f"飞行小结:{t}的画面里,{who}始终站着不动。" + self.join(drone),
                self.join(drone) + f"{opening}。{s}。")
        if k in (2, 3):
            return self.join([opening] + self.pick(drone + self.walk(f), self.walk(f) + drone))
        if k == 4:
            return f"无人机{self.d_adv(f)}{self.pick('跟拍', '跟随', '追踪')}{who},{self.p_s(f)}" + (f",{self.h_s(f)}" if h else "") + "。" + self.join(self.walk(f))
        if k == 5:
            first = self.pick(f"{who}在{self.sec(f.duration)}的飞行中走了{self.m(f.way)},步行均速{self.ms(f.speed)}", f"在{self.sec(f.duration)}的飞行时间里,{who}以平均{self.ms(f.speed)}的速度走了{self.m(f.way)}", f"{who}步行{self.m(f.way)},平均步行速度{self.ms(f.speed)},飞行历时{self.sec(f.duration)}")
            ts = [self.t_s(f), self.s_s(f)]
            return self.join([first] + self.pick(ts + drone, drone + ts, [ts[1]] + drone + [ts[0]]))
        if k == 6:
            return f"{self.p_s(f)}" + (f",飞行高度{self.pick('', '为')}{self.m(f.altitude)}" if h else "") + f",无人机{self.d_adv(f)}{self.pick('跟拍', '追踪', '跟随')}{who}。" + self.join(self.walk(f))
        if k == 7:
            turn = "没有转弯" if not f.turns else f"转向{self.k(len(f.turns))}次({self.t_list(f.turns)})"
            return (f"在{self.sec(f.duration)}的飞行中,无人机{self.d_adv(f)}{self.pick('跟拍', '跟随')}{who},{self.p_s(f)}" + (f",{self.h_s(f)}" if h else "") +
                    f";{self.ref()}以平均{self.ms(f.speed)}的速度走了{self.m(f.way)},途中{self.pick(turn + ',' + self.s_clause(f).replace('全程', '').replace('中途', '').replace('途中', '').replace('一路', ''), self.s_clause(f).replace('全程', '').replace('中途', '').replace('途中', '').replace('一路', '') + ',' + turn)}。")
        if k == 8:
            stops = "没有" if not f.stops else f"{self.k(f.stops)}次" + (f",{'共' if f.stops > 1 else ''}{self.sec(f.standing)}" if f.standing else "")
            return (f"拍的是谁?{who}。离多远?平均{self.m(f.distance)}。镜头角度?{self.p_note(f)}。" + (f"飞多高?{self.m(f.altitude)}。" if h else "") +
                    f"走了多远?{self.m(f.way)},步行均速{self.ms(f.speed)}。飞了多久?{self.sec(f.duration)}。怎么转弯的?{self.t_list(f.turns) if f.turns else '没有转弯'}。停过吗?{stops}。")
        if k == 9:
            first = self.pick(f"我用无人机跟拍了{who},{self.d_s(f)},{self.p_s(f)}", f"这一趟我{self.d_adv(f)}跟着{who}飞,{self.p_s(f)}")
            return self.join([first] + ([self.h_s(f)] if h else []) + self.walk(f))
        return self.pick("飞行小结:", "总结一下:", "航拍概述:", "画面概要:") + self.join(self.pick([opening] + self.walk(f) + drone, drone + [opening] + self.walk(f)))

    # ---- 错误的文字
    def write_foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        cut = text.rstrip("。?\uff1f")
        return self.pick(f"{cut},{thing}。", f"{cut},{thing}。", f"{cut};{thing}。", f"{text}此时{thing}。" if text.endswith("。") else f"{cut},{thing}。", f"{text} 这个人是{person}。", f"{cut},这个人是{self.pick('一名', '一位')}{person}。",
                         f"{cut},画面里还有一位{person}。", f"{cut},目标的身份是{person}。", f"(对象是一位{person})" + text)

    def write_heading(self, text, direction):
        z = ZH_DIRECTIONS[direction]
        cut = text.rstrip("。?\uff1f")
        return self.pick(f"{cut},此人向{z}走。", f"{cut},目标朝{z}前进。", f"{text} 行进方向:{z}。", f"{cut},整体往{z}边走。", f"{cut},对方走向{z}方。", f"行走方向为{z}。{text}", f"{cut},一路向{z}。", f"{cut},这个人正朝{z}面走去。", f"{cut},路线通往{z}方。", f"{cut};人是往{z}走的。")

    def foreign(self, text):
        return self.finish(self.write_foreign(text))

    def heading(self, text, direction):
        return self.finish(self.write_heading(text, direction))
