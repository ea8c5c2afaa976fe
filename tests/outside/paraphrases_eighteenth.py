"""The eighteenth grammar for check_text_judge.py: annotators of vision-language-navigation data sets, LLM paraphrases ("rewrite this in ten ways") and careful writers. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "0 10 twenty thirty forty fifty sixty seventy eighty ninety".split()
ORDINALS = "first second third fourth fifth sixth seventh eighth ninth tenth".split()
PAST = dict(make="made", travel="travelled", take="took", swing="swung", go="went", stand="stood", keep="kept", come="came", have="had", do="did", hold="held", leave="left",
            lie="lay", see="saw", fly="flew", sit="sat", hang="hung", halt="halted", stop="stopped", stay="stayed", spend="spent", accompany="accompanied")


def words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + words(n % 100) if n % 100 else "")
    return str(n)


def upper(text):
    return text[:1].upper() + text[1:]


def lower(text):
    return text[:1].lower() + text[1:]


def runs(turns):
    out = []
    for t in turns:
        if out and out[-1][0] == t:
            out[-1][1] += 1
        else:
            out.append([t, 1])
    return out


def times(n):
    return {1: "once", 2: "twice"}.get(n) or words(n) + " times"


def series(items, last=" and "):
    return items[0] if len(items) == 1 else ", ".join(items[:-1]) + last + items[-1]


class EighteenthEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls", "with two dogs", "past a row of parked taxis", "under a string of paper lanterns", "next to a closed bakery",
              "while church bells ring", "in thick fog", "at sunset", "along a canal", "in front of a petrol station", "with a stroller", "under an open umbrella",
              "through falling snow", "by the tram stop", "between two delivery vans", "holding an ice cream", "in a crowd of tourists", "across a zebra crossing",
              "beneath a railway bridge", "near a statue of a horse", "talking on the phone", "on a windy morning", "beside a red mailbox", "with a skateboard under one arm",
              "in front of a hotel entrance", "while a cyclist overtakes"]
    persons = ["plumber", "schoolgirl", "policeman", "old lady", "courier", "waiter", "young mother", "jogger", "monk", "tourist", "bride", "mechanic", "grandfather", "teenager"]

    # -- small tools --
    def odds(self, percent):
        return self.pick(*range(100)) < percent

    def shuffled(self, items):
        items, out = list(items), []
        while items:
            out.append(items.pop(self.pick(*range(len(items)))))
        return out

    def begin(self, flight, tense):
        self.tense, self.plural, self.over, self.name = tense, False, False, None
        self.spelt = self.odds(10)
        self.metre = self.pick("m", "m", "nospace", "metre", "metre", "meter", "meter")
        self.degree = self.pick("°", "°", " degrees", " degrees", " degrees", " deg")
        self.second = self.pick("s", "seconds", "seconds", "sec")
        self.vague = self.pick("", "", "", "", "about ", "roughly ", "approximately ", "some ")

    def num(self, n):
        return words(n) if self.spelt else str(n)

    def count(self, n):
        return self.pick(words(n), words(n), str(n))

    def m(self, n, vague=False):
        q = self.vague if vague else ""
        if self.spelt or self.metre in ("metre", "meter"):
            unit = self.metre if self.metre in ("metre", "meter") else "metre"
            return f"{q}{self.num(n)} {unit}{'' if n == 1 else 's'}"
        return f"{q}{n}m" if self.metre == "nospace" else f"{q}{n} m"

    def m_adj(self, n):
        return f"{self.num(n)}-" + ("meter" if self.metre == "meter" else "metre") if self.spelt or self.metre in ("metre", "meter") else f"{n} m"

    def d(self, n):
        n = abs(n)
        if self.spelt:
            return words(n) + (" degree" if n == 1 else " degrees")
        unit = " degree" if n == 1 and self.degree == " degrees" else self.degree
        return f"{n}{unit}"

    def s(self, n):
        if self.spelt:
            return words(n) + (" second" if n == 1 else " seconds")
        if self.second == "seconds":
            return f"{n} second" + ("" if n == 1 else "s")
        return f"{n} {self.second}"

    def rate(self, flight):
        v = f"{flight.speed:.1f}"
        if self.spelt:
            a, b = v.split(".")
            return f"{words(int(a))} point {words(int(b))} metres per second"
        unit = "meters" if self.metre == "meter" else "metres"
        return self.pick(f"{v} m/s", f"{v} m/s", f"{v} {unit} per second", f"{v} {unit} a second")

    def vb(self, verb, adv=""):
        adv = adv + " " if adv else ""
        if self.tense == "future":
            return f"will {adv}{verb}"
        if self.tense == "past":
            return adv + (PAST.get(verb) or verb + ("d" if verb.endswith("e") else "ed"))
        if self.plural:
            return adv + verb
        if verb == "have":
            return adv + "has"
        return adv + ((verb[:-1] + "ies") if verb in ("fly", "accompany") else verb + ("es" if verb in ("go", "do") or verb.endswith(("ch", "sh", "ss")) else "s"))

    def neg(self, verb):
        if self.tense == "future":
            return "will not " + verb
        if self.tense == "past":
            return "did not " + verb
        return ("do not " if self.plural else "does not ") + verb

    def be(self, plural=False):
        if self.tense == "future":
            return "will be"
        if self.tense == "past":
            return "were" if plural else "was"
        return "are" if plural else "is"

    def sub(self, flight):
        """One name for the person within a text, or a pronoun."""
        self.name = self.name or self.pick("the person", "the subject", "the target", "this person", "they", *(["the walker", "the pedestrian"] if flight.walks else []))
        s = self.pick("they", "they", self.name)
        self.plural = s == "they"
        return s

    # -- the person --
    def pack(self, flight, yes, no=("", "", "", " without a backpack", " but no backpack")):
        return self.pick(*(yes if flight.wear[2] else no))

    def who(self, flight, the=True):
        nouns = ["person", "person", "person", "individual", "figure"] + (["walker", "pedestrian"] if flight.walks else [])
        noun = self.pick(*nouns)
        if flight.wear is None:
            if the:
                return self.pick("the " + noun, "that " + noun, "the " + noun + " in view", "the target person", "this " + noun, "the subject", "the target", "the one person you are assigned")
            return self.pick(an(noun), an(noun), "one person", "a single person", "someone", "somebody")
        top, legs, bag = flight.wear
        up, down = self.pick(("top", "trousers"), ("shirt", "pants"), ("top", "pants"), ("shirt", "trousers"))
        head = (self.pick("the ", "the ", "that ") + noun) if the else self.pick(an(noun), an(noun), "someone", "somebody")
        withbag = [" and a backpack"]
        k = self.pick(*range(14))
        if top == legs and self.odds(50):
            look = self.pick(f"in {an(top)} {up} and matching {top} {down}", f"whose {up} and {down} are both {top}", f"dressed in {top}, {up} and {down} alike,", f"with {top} {up} and {down}")
            if look.endswith("alike,"):
                return f"{head} whose {up} is {top}, just like the {down}" if not bag else f"{head} with a backpack whose clothes are {top}, {up} and {down} alike"
            return f"{head} {look}" + (self.pick(" who carries a backpack", " and who has a backpack on") if bag and look.startswith("whose") else " with a backpack" if bag and look.startswith("in") else " plus a backpack" if bag else "")
        if k == 0:
            return f"{head} in {an(top)} {up} and {legs} {down}" + self.pack(flight, [" with a backpack", " who carries a backpack", " wearing a backpack"])
        if k == 1:
            return f"{head} wearing " + (f"{an(top)} {up}, {legs} {down} and a backpack" if bag else f"{an(top)} {up} and {legs} {down}")
        if k == 2:
            return f"{head} whose {up} is {top} and whose {down} are {legs}" + self.pack(flight, [" and who has a backpack", " and who carries a backpack"], ("", "", " and who has no backpack"))
        if k == 3:
            return f"{head} with " + (f"the {top} {up}, the {legs} {down} and the backpack" if bag else f"the {top} {up} and the {legs} {down}")
        if k == 4:
            base = self.pick(*nouns)
            return f"{'the' if the else 'a'} {top}-{'shirted' if up == 'shirt' else 'topped'} {base} in {legs} {down}".replace("a orange", "an orange") + self.pack(flight, [" with a backpack on", " with a backpack"], ("", " without a backpack"))
        if k == 5:
            return f"{head} ({top} {up}, {legs} {down}" + self.pack(flight, [", backpack", ", wears a backpack"], ("", ", no backpack")) + ")"
        if k == 6:
            return f"{head} in {legs} {down} and {an(top)} {up}" + self.pack(flight, [" with a backpack", " carrying a backpack"])
        if k == 7:
            return f"{head} dressed in {an(top)} {up} and {legs} {down}" + self.pack(flight, [" with a backpack on their back", " and carrying a backpack"], ("", "", " without a backpack"))
        if k == 8:
            bagged = self.pick("backpack-carrying ", "backpacked ") if bag else ""
            base = self.pick(*nouns)
            return f"{('the ' if the else 'a ') + bagged + base if bag else ('the ' if the else '') + (base if the else an(base))} who wears {an(top)} {up} with {legs} {down}"
        if k == 9:
            return f"{head} who has {an(top)} {up} on" + f" and {legs} {down}" + (" and who carries a backpack" if bag else "")
        if k == 10:
            return f"{head} who is wearing {legs} {down} below {an(top)} {up}" + self.pack(flight, [" and has a backpack on", " and carries a backpack"], ("", ""))
        if k == 11:
            return f"{head} wearing {top} on top and {legs} {down}" + self.pack(flight, [" and carrying a backpack", " with a backpack"], ("", "", " but no backpack"))
        if k == 12:
            return (f"{head} with a backpack, {an(top)} {up} and {legs} {down}" if bag else f"{head} with {an(top)} {up}, {legs} {down} and no backpack")
        return f"{head} clothed in {top} ({up}) and {legs} ({down})" + self.pack(flight, [" with a backpack"], ("", ""))

    def clothes_note(self, flight):
        top, legs, bag = flight.wear
        tail = self.pick(", backpack", ", with backpack", " + backpack") if bag else self.pick("", ", no backpack")
        return self.pick(f"{top} top, {legs} trousers", f"top {top}, pants {legs}", f"{legs} pants, {top} shirt", f"{top} shirt / {legs} pants") + tail

    # -- distance --
    def at(self, flight):
        pp = self.distance_pp(flight, True)
        return (", " if pp.startswith(("staying", "keeping")) else " ") + pp

    def distance_pp(self, flight, active=False):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        if active and self.odds(20):
            return self.pick(f"staying {x} away", f"keeping {x} off", f"keeping a distance of {x}", f"staying {x} from them")
        return self.pick(f"from {x} away", f"at a distance of {x}", f"from a distance of {x}", f"with {x} between drone and person", f"with a gap of {x}", f"at a slant range of {y}",
                         f"from {x} off", f"with {y} separating the drone from them", f"at a {self.m_adj(flight.distance)} distance".replace("a eight", "an eight").replace("a eleven", "an eleven"), f"from {y} out, measured in a straight line") \
            .replace("at a 8", "at an 8").replace("at a 11 ", "at an 11 ").replace("at a 11-", "at an 11-").replace("at a 18", "at an 18")

    def distance_imp(self, flight):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"keep {x} away", f"leave a gap of {x}", f"stay {x} from them", f"hold a separation of {x}", f"put {x} between the drone and the person", f"maintain a distance of {x}", f"be no closer and no farther than {y}",
                         f"position the drone {x} away from them", f"keep the distance at {y}", f"hold the range at {y}", f"fly {y} away from them")

    def pitch_imp(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("keep the camera level", "hold the lens horizontal", "look straight at the horizon", "leave the gimbal at zero tilt", f"set the camera pitch to {a}", "aim the lens at the horizon", "point the camera neither up nor down")
        w, b, v = ("down", "below", "lower") if p > 0 else ("up", "above", "raise")
        return self.pick(f"tilt the camera {w} by {a}", f"point the lens {a} {b} the horizon", f"{v} the camera {a} from level", f"angle your camera {w}ward {a}", f"set the gimbal {a} {b} horizontal", f"hold the camera at {a} {b} the horizon",
                         f"have the camera facing {a} {w}", f"aim the camera {a} {b} level", f"pitch the camera {w} by {a}")

    def distance_do(self, flight):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"keep {x} away", f"leave a gap of {x}", f"stay {x} from them", f"hold a separation of {x}", f"make sure {x} separate the drone from the person".replace("1 metre separate", "1 metre separates"),
                         f"put {x} between the drone and the person", f"maintain a distance of {x}", f"be no closer and no farther than {y}", f"don't let the range become anything but {y}", f"the drone should be {x} from the person",
                         f"the gap between the drone and them should be {x}", f"{y} is the distance to keep", f"your distance to them must be {y}", f"position the drone {x} away from them")

    def distance_clause(self, flight):
        self.plural = False
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"the drone {self.vb('stay')} {x} away", f"{x} {self.vb('lie') if self.tense != 'present' else 'lie'} between drone and person", f"the distance from drone to person {self.vb('average')} {y}",
                         f"the gap between the two {self.be()} {x}", f"on average the drone {self.be()} {y} away", f"the person {self.be()} {x} from the drone", f"the drone {self.vb('keep')} {x} from them",
                         f"{y} {self.be()} how far the drone {self.be()} from them, in a straight line", f"the aircraft {self.vb('maintain')} a distance of {x}", f"a mean distance of {y} {self.be()} kept", f"as for the distance, it {self.be()} {x}",
                         f"drone and person {self.be(True)} {x} apart")

    # -- pitch --
    def pitch_abs(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        cam = self.pick("the camera", "the camera", "the lens", "its camera" if self.over else "your camera")
        if p > 0:
            return self.pick(f"{cam} tilted {a} down", f"{cam} pitched {a} below the horizon", f"{cam} pointing {a} below horizontal", f"{cam} angled downward by {a}", f"{cam} looking down at an angle of {a}",
                             f"the gimbal lowered {a} from level", f"the view inclined {a} downwards", f"{cam} dipped by {a}", f"{cam} aimed {a} under the horizon", f"{cam} facing down by {a}", f"the line of sight {a} below the horizontal")
        if p < 0:
            return self.pick(f"{cam} tilted {a} up", f"{cam} pitched {a} above the horizon", f"{cam} pointing {a} above horizontal", f"{cam} angled upward by {a}", f"{cam} looking up at an angle of {a}",
                             f"the gimbal raised {a} from level", f"the view inclined {a} upwards", f"{cam} raised by {a}", f"{cam} aimed {a} over the horizon", f"{cam} facing up by {a}", f"the line of sight {a} above the horizontal")
        return self.pick(f"{cam} level", f"{cam} looking straight at the horizon", f"{cam} horizontal", f"{cam} tilted neither up nor down", f"{cam} at zero tilt", f"the gimbal level", f"{cam} pitched at {a}",
                         f"the view level with the horizon", f"{cam} set at {a} to the horizon", f"the line of sight horizontal", f"{cam} pointing neither above nor below the horizon")

    def pitch_do(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("keep the camera level", "hold the lens horizontal", "do not tilt the camera up or down", "look straight at the horizon", "the camera must stay level", "leave the gimbal at zero tilt", f"set the camera pitch to {a}",
                             "the camera should point neither up nor down", "aim the lens at the horizon", "let the camera look out horizontally", f"camera tilt should be {a}")
        w, b, v = ("down", "below", "lower") if p > 0 else ("up", "above", "raise")
        return self.pick(f"tilt the camera {w} by {a}", f"point the lens {a} {b} the horizon", f"{v} the camera {a} from level", f"the camera should look {a} {w}", f"angle your camera {w}ward {a}", f"set the gimbal {a} {b} horizontal",
                         f"hold the camera at {a} {b} the horizon", f"have the camera facing {a} {w}", f"the viewing angle must be {a} {b} horizontal", f"{an(w)}ward tilt of {a} is what the camera needs", f"aim the camera {a} {b} level",
                         f"make the camera look {w} at an angle of {a}")

    def pitch_clause(self, flight):
        self.plural = False
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick(f"the camera {self.be()} level", f"the lens {self.vb('look')} straight at the horizon", f"the camera {self.be()} tilted neither up nor down", f"the camera tilt {self.be()} {a}", f"the gimbal {self.vb('stay')} level",
                             f"the view {self.be()} level with the horizon", f"no camera tilt {self.be()} used, neither up nor down", f"the shot {self.be()} taken with a level camera", f"the line of sight {self.be()} horizontal", f"horizontal {self.be()} the way the camera {self.vb('point')}")
        w, b, v = ("down", "below", "lowered") if p > 0 else ("up", "above", "raised")
        return self.pick(f"the camera {self.vb('look')} {a} {w}", f"the lens {self.be()} aimed {a} {b} the horizon", f"the camera {self.be()} {v} by {a} from level", f"the camera pitch {self.be()} {a} {b} horizontal", f"the view {self.be()} tilted {w} {a}",
                         f"{a} {self.be()} the {w}ward tilt of the camera", f"the gimbal {self.vb('hold')} the camera {a} {b} the horizon", f"the camera {self.vb('point')} {w} at an angle of {a}", f"the line of sight {self.be()} {a} {b} the horizontal",
                         f"camera tilt {self.be()} {a} {w}", f"the shot {self.be()} taken with {an(w)}ward tilt of {a}")

    def pitch_note(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("level", "horizontal", f"{a} (level)", "no tilt", f"{a}, on the horizon")
        return self.pick(f"{a} down", f"{a} below the horizon", f"down {a}", f"{a} downward") if p > 0 else self.pick(f"{a} up", f"{a} above the horizon", f"up {a}", f"{a} upward")

    # -- height --
    def height_pp(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"{h} above their feet", f"at an altitude of {h}", f"from a height of {h}", f"at a height of {h} above the person's feet", f"{h} higher than their feet", f"flying {h} up", f"at {h} of height", f"{h} above the ground at their feet")

    def height_do(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"fly at a height of {h}", f"fly {h} above the person's feet", f"keep an altitude of {h}", f"height over the person's feet should be {h}", f"stay at a height of {h}", f"the drone should be {h} up", f"hold the drone {h} above their feet",
                         f"use a flying height of {h}", f"your altitude is {h}", f"remain {h} higher than their feet")

    def height_clause(self, flight):
        self.plural = False
        h = self.m(flight.altitude)
        return self.pick(f"the drone {self.vb('fly')} {h} above the person's feet", f"the flying height {self.be()} {h}", f"the altitude {self.be()} {h}", f"the aircraft {self.be()} {h} up", f"the drone's height over the person's feet {self.be()} {h}",
                         f"{h} {self.be()} the height of the drone above their feet", f"the drone {self.be()} {h} higher than the feet of the person", f"the drone {self.vb('keep')} a height of {h}", f"measured from the person's feet, the drone {self.be()} {h} high", f"the flight {self.be()} at {h} of altitude")

    # -- turns --
    def sequence(self, turns):
        w = [t for t in turns]
        forms = [", then ".join(w), ", ".join(w[:-1]) + " and then " + w[-1], " and then ".join(w) if len(w) < 4 else ", then ".join(w)]
        if len(w) == 2:
            forms += [f"first {w[0]} and then {w[1]}", f"first {w[0]}, later {w[1]}"]
        else:
            forms += [f"first {w[0]}, " + "".join(f"then {x}, " for x in w[1:-1]) + f"and finally {w[-1]}", f"first {w[0]}, then {', then '.join(w[1:])}"]
        again = [w[0]] + [x + (" again" if x == y else "") for x, y in zip(w[1:], w)]
        forms.append(", then ".join(again))
        g = [x + ("" if n == 1 else " " + times(n)) for x, n in runs(w)]
        if len(g) < len(w):
            forms += [", then ".join(g)] * 2
        return self.pick(*forms)

    def noun_turn(self, t, style):
        if t == "around":
            return ("a U-turn", "a U-turn", "an about-face", "a U-turn")[style]
        return (f"{an(t)} turn", f"a {t}", f"a turn to the {t}", f"a {t}-hand turn")[style]

    def turns_np(self, flight):
        t = flight.turns
        k = self.pick(0, 1, 2, 3)
        if not t:
            return self.pick("no turns", "not a single turn", "no turn at all", "zero turns")
        if len(t) == 1:
            return self.pick(self.noun_turn(t[0], k), "one turn" + {"left": " to the left", "right": " to the right", "around": " (a U-turn)"}[t[0]], "just one turn" + {"left": " (to the left)", "right": " (to the right)", "around": " (a U-turn)"}[t[0]])
        n = [self.noun_turn(x, k) for x in t]
        if set(t) == {t[0]} and self.odds(60):
            c = self.count(len(t))
            return f"{c} U-turns" if t[0] == "around" else self.pick(f"{c} {t[0]} turns", f"{c} turns, all to the {t[0]}", f"{c} lefts in a row" if t[0] == "left" else f"{c} rights in a row")
        c = self.count(len(t))
        plain = [x if x != "around" else "U-turn" for x in t]
        return self.pick(", then ".join(n), series(n) + ", in that order", f"{c} turns ({', '.join(plain)})", f"{c} turns in this order: {', '.join(plain)}", n[0] + " followed by " + (n[1] if len(n) == 2 else series(n[1:], " and then ")))

    def turns_vp(self, flight):
        t = flight.turns
        if not t:
            return self.pick(f"{self.vb('make')} no turns", f"{self.neg('turn')} at all", f"{self.vb('turn', 'never')}", f"{self.vb('go')} straight on without any turn", f"{self.neg('take')} a single turn", f"{self.vb('keep')} going without turning",
                             f"{self.neg('turn')} left, right or around", f"{self.vb('take')} no turn", f"{self.vb('walk')} on without a turn", f"{self.neg('change')} direction anywhere")
        if len(t) == 1:
            if t[0] == "around":
                return self.pick(f"{self.vb('turn')} around once", f"{self.vb('make')} one U-turn", f"{self.vb('make')} an about-face once", f"{self.vb('turn')} back the other way once", f"{self.vb('reverse')} direction once", f"{self.vb('turn')} only once, and that {self.be()} a U-turn",
                                 f"{self.vb('do')} a single U-turn", f"{self.vb('turn')} around a single time", f"{self.vb('make')} just one turn, an about-face", f"{self.vb('double')} back once")
            w = t[0]
            return self.pick(f"{self.vb('turn')} {w} once", f"{self.vb('make')} a single {w} turn", f"{self.vb('take')} one {w}", f"{self.vb('turn')} just once, to the {w}", f"{self.vb('make')} a {w}", f"{self.vb('turn')} to the {w} one time", f"{self.vb('hang')} a {w}",
                             f"{self.vb('make')} one turn, which {self.be()} to the {w}", f"{self.vb('swing')} {w} once", f"{self.vb('turn')} {w}", f"{self.vb('make')} only one turn, {an(w)}-hand one")
        opts = [f"{self.vb('turn')} {self.sequence(t)}", f"{self.vb('turn')} {self.sequence(t)}", f"{self.vb('make')} {self.turns_np(flight)}", f"{self.vb('take')} {self.turns_np(flight)}", f"{self.vb('turn')} {times(len(t))}: {self.sequence(t)}",
                f"{self.vb('turn')} {self.sequence(t)}, {self.count(len(t))} turns in all"]
        if len(t) == 2 and "around" not in t:
            opts += [f"{self.vb('turn')} {t[0]} before turning {t[1]}" + (" again" if t[0] == t[1] else ""), f"{self.vb('hang')} a {t[0]} and then a {t[1]}", f"{self.vb('turn')} {t[1]} after an earlier turn to the {t[0]}"]
        if set(t) == {t[0]}:
            opts += [f"{self.vb('turn')} {t[0]} {times(len(t))}"] * 3
            if t[0] != "around":
                opts += [f"{self.vb('turn')} {times(len(t))}, each time to the {t[0]}"] * 2
        return self.pick(*opts)

    def turns_clause(self, flight):
        t, k = flight.turns, self.pick(0, 1, 2, 3)
        if len(t) > 1 and self.odds(40):
            self.plural = False
            n = [self.noun_turn(x, k) for x in t]
            return self.pick(f"the first turn {self.be()} " + ", ".join([n[0]] + [f"the {ORDINALS[i]} {n[i]}" for i in range(1, len(n))]),
                             f"there {self.be(True)} {words(len(t))} turns: {', then '.join(n)}",
                             f"the turns, in order, {self.be(True)} {series([x if x != 'around' else 'U-turn' for x in t])}",
                             f"after {n[0]} {self.vb('come') if len(n) == 2 or self.tense != 'present' else 'come'} {series(n[1:], ' and then ')}",
                             f"{n[0]} {self.be()} followed by {series(n[1:], ' and then ')}",
                             f"the order of turns {self.be()} {' – '.join(x if x != 'around' else 'U-turn' for x in t)}")
        if not t and self.odds(30):
            return self.pick(f"there {self.be(True)} no turns", f"no turns {self.be(True)} made", f"not one turn {self.be()} made")
        return f"{self.sub(flight)} {self.turns_vp(flight)}"

    def turns_note(self, flight):
        t = flight.turns
        if not t:
            return self.pick("none", "no turns", "0")
        back = self.pick("U-turn", "around")
        return self.pick(", ", " > ", " → ", ", then ", " / ").join(back if x == "around" else x for x in t)

    # -- stops --
    def stops_vp(self, flight):
        n, s = flight.stops, self.s(flight.standing)
        if n == 0:
            return self.pick(f"{self.vb('stop', 'never')}", f"{self.neg('pause')} at all", f"{self.vb('make')} no stops", f"{self.vb('keep')} walking without a pause", f"{self.neg('stop')} once", f"{self.vb('pause', 'never')}", f"{self.vb('take')} no breaks",
                             f"{self.vb('keep')} moving all the time", f"{self.neg('stand')} still at any point", f"{self.neg('come')} to a halt anywhere")
        if flight.standing < 1:
            return self.pick(f"{self.vb('stop')} {times(n)}", f"{self.vb('pause')} {times(n)}")
        if n == 1:
            return self.pick(f"{self.vb('pause')} once, for {s}", f"{self.vb('stop')} one time and {self.vb('stand')} still for {s}", f"{self.vb('make')} a single stop of {s}", f"{self.vb('take')} one break that {self.vb2('last')} {s}", f"{self.vb('halt')} once for {s}",
                             f"{self.vb('stand')} still for {s} during the only stop", f"{self.vb('come')} to a halt once ({s})", f"{self.vb('spend')} {s} standing, in one pause", f"{self.vb('have')} one pause, {s} long", f"{self.vb('stop')} just once and {self.vb('wait')} {s}")
        return self.pick(f"{self.vb('pause')} {times(n)}, for {s} in total", f"{self.vb('stop')} {self.count(n)} times and {self.vb('stand')} still for {s} altogether", f"{self.vb('make')} {self.count(n)} stops totalling {s}", f"{self.vb('take')} {self.count(n)} breaks that add up to {s}",
                         f"{self.vb('halt')} {times(n)} (together {s})", f"{self.vb('spend')} {s} standing, split over {self.count(n)} pauses", f"{self.vb('come')} to a halt {times(n)}, {s} all told", f"{self.vb('have')} {self.count(n)} pauses with a combined length of {s}",
                         f"{self.vb('stand')} still on {self.count(n)} occasions, {s} overall", f"{self.vb('stop')} {times(n)}, and all stops together {'lasted' if self.tense == 'past' else 'last'} {s}")

    def vb2(self, verb):
        keep, self.plural = self.plural, False
        out = self.vb(verb)
        self.plural = keep
        return out

    def stops_np(self, flight):
        n, s = flight.stops, self.s(flight.standing)
        if n == 0:
            return self.pick("no pauses", "no stops", "not a single stop", "no break at all", "zero stops")
        if flight.standing < 1:
            return f"{self.count(n)} {'stop' if n == 1 else 'stops'}"
        if n == 1:
            return self.pick(f"one pause of {s}", f"a single stop ({s})", f"one stop lasting {s}", f"1 break, {s} long", f"one halt of {s}")
        c = self.count(n)
        return self.pick(f"{c} pauses, {s} in total", f"{c} stops ({s} altogether)", f"{c} breaks adding up to {s}", f"{c} halts that together last {s}" if self.tense != "past" else f"{c} halts that together lasted {s}", f"{c} stops with {s} of standing in all")

    def stops_there(self, flight):
        np = self.stops_np(flight)
        many = flight.stops != 1 and not np.startswith(("not a", "no break"))
        return self.pick(f"there {self.be(many)} {np}", f"along the way there {self.be(many)} {np}")

    def stops_clause(self, flight):
        if self.odds(35):
            return self.stops_there(flight)
        return f"{self.sub(flight)} {self.stops_vp(flight)}"

    # -- length of the walk, time, speed --
    def length_vp(self, flight):
        w, s, v = self.m(flight.way), self.s(flight.duration), self.rate(flight)
        return self.pick(f"{self.vb('cover')} {w} in {s}, averaging {v}", f"{self.vb('walk')} {w} in all over {s}, at a mean speed of {v}", f"{self.vb('walk')} at {v} on average for a total of {w} in {s}", f"{self.vb('go')} {w} altogether within {s}; mean walking speed: {v}",
                         f"{self.vb('need')} {s} for a walk of {w}, with a mean speed of {v}", f"{self.vb('walk')} a total of {w} at {v} during the {s} of the flight", f"{self.vb('move')} at an average {v} and {self.vb('cover')} {w} in {s}",
                         f"{self.vb('travel')} {w} on foot in {s} (average speed {v})", f"{self.vb('walk')} for a total length of {w}, at {v} on average, in a flight of {s}",
                         f"{self.vb('cover')} {w} altogether at an average walking speed of {v}, in {s}", f"{self.vb('complete')} {w} of walking in {s}, {v} being the mean speed")

    def length_clause(self, flight):
        w, s, v = self.m(flight.way), self.s(flight.duration), self.rate(flight)
        if self.odds(45):
            self.plural = False
            return self.pick(f"the walk {self.be()} {w} long, {self.vb('last')} {s} and {self.vb('have')} a mean speed of {v}", f"the whole route of {w} {self.be()} walked in {s} at an average of {v}", f"{s} {self.be()} enough for {w} at a mean walking speed of {v}",
                             f"walking speed {self.vb('average')} {v}, and the walk of {w} {self.vb('take')} {s}", f"a total of {w} {self.be()} covered in {s}, {v} being the average speed", f"the path {self.vb('measure')} {w}, the flight {self.vb('last')} {s} and the walking speed {self.be()} {v} on average",
                             f"total walking length {self.be()} {w}, average speed {v}, duration {s}")
        return f"{self.sub(flight)} {self.length_vp(flight)}"

    # -- the person who stands --
    def stand_vp(self, flight, long=True):
        s = self.s(flight.duration)
        all_ = self.pick(f" for all {s}", f" during the whole flight of {s}", f" for the full {s}", f", and the flight {self.vb2('last')} {s}", f" for {s}, which is the whole flight", f" throughout the {s} of the flight") if long else self.pick("", " the whole time", " throughout", " from start to finish")
        return self.pick(f"{self.vb('stand')} on one spot", f"{self.vb('stay')} in one place", f"{self.neg('move')} from the spot", f"{self.vb('stand')} still", f"{self.vb('remain')} standing in the same place", f"{self.neg('walk')} anywhere but {self.vb('stand')} on one spot",
                         f"{self.neg('take')} a step", f"{self.vb('keep')} standing where they {'were' if self.tense == 'past' else 'are'}", f"{self.vb('stand')} without walking", f"{self.neg('leave')} the spot") + all_

    def stand_clause(self, flight, long=True):
        return f"{self.sub(flight)} {self.stand_vp(flight, long)}"

    # -- texts --
    def sentences(self, clauses):
        return " ".join(upper(c) + ("" if c.endswith("?") else ".") for c in clauses)

    def extras(self, flight, most=3):
        """Some true facts beyond distance and pitch, as clauses."""
        if not flight.walks:
            out = [self.stand_clause(flight, self.odds(40))] if self.odds(70) else []
        else:
            out = []
            if self.odds(55):
                out.append(self.turns_clause(flight))
            if self.odds(40):
                out.append(self.stops_clause(flight))
            if self.odds(35):
                out.append(self.length_clause(flight))
        return out[:most]

    def sloppy(self, text):
        text = text.lower()
        for a, b in self.pick((), ((" and ", " n "),), ((" with a ", " w/ "),), (("please ", "pls "),), (("camera", "cam"),)):
            text = text.replace(a, b)
        return text.rstrip(".")

    def shot(self, flight):
        """A verb of following (the person walks) or of filming."""
        return self.pick(*(["follow", "follow", "track", "keep up with", "accompany", "shadow", "stay with", "keep filming", "keep tracking"] if flight.walks else ["film", "watch", "keep watching", "observe", "record", "keep the camera on", "monitor", "keep an eye on"]))

    def instruction(self, flight):
        self.begin(flight, self.pick("future", "present", "present"))
        tall = flight.altitude >= 1 and self.odds(60)
        go, x = self.shot(flight), self.who(flight)
        k = self.pick(*range(16))
        end = self.extras(flight)
        if k == 0:
            text = f"{go} {x}{self.at(flight)}, with {self.pitch_abs(flight)}"
            parts = [text] + ([self.height_do(flight)] if tall else []) + end
            return self.sentences(parts)
        if k == 1:
            ask = self.pick("could you", "would you please", "can you", "would you mind if I asked you to", "may I ask you to")
            h = f" {self.height_pp(flight)}," if tall else ""
            return self.sentences([f"{ask} {go} {x},{h} {self.distance_pp(flight)} and with {self.pitch_abs(flight)}?"] + end)
        if k == 2:
            see = self.pick(f"see {x}?", f"do you see {x}?", f"spot {x}?", f"can you find {x}?")
            do = self.pick(f"that is who you {'follow' if flight.walks else 'film'}", f"{'follow' if flight.walks else 'film'} them", f"{'stay with' if flight.walks else 'keep the camera on'} that person")
            return self.sentences([see, do] + self.shuffled([self.distance_do(flight), self.pitch_do(flight)] + ([self.height_do(flight)] if tall else [])) + end)
        if k == 3:
            rows = [f"distance: {self.m(flight.distance)}", f"camera: {self.pitch_note(flight)}"] + ([f"height: {self.m(flight.altitude)}"] if tall else [])
            if flight.walks and self.odds(50):
                rows.append(f"turns: {self.turns_note(flight)}")
            if flight.walks and self.odds(30):
                rows.append(f"pauses: {self.stops_np(flight)}")
            if not flight.walks and self.odds(70):
                rows.append(self.pick("movement: none, stands on one spot", "the person stands still"))
            mark = self.pick("- ", "* ", "• ")
            return f"{self.pick('Target', 'Subject', 'Person to film', 'Who')}: {x}\n" + "\n".join(mark + r for r in self.shuffled(rows))
        if k == 4:
            steps = [f"find {x}", self.distance_do(flight), self.pitch_do(flight)] + ([self.height_do(flight)] if tall else []) + [f"{go} them" if go != "keep the camera on" else "film them"]
            sep = self.pick("\n", " ")
            return sep.join(f"{i}. {upper(c)}." for i, c in enumerate(steps, 1)) + ((sep + self.sentences(end)) if end else "")
        if k == 5:
            need = self.pick("I need footage of", "what I want is a shot of", "please get me a video of", "I'd like a drone video of", "we are after a recording of")
            h = f", {self.height_pp(flight)}" if tall else ""
            return self.sentences([f"{need} {x}, taken {self.distance_pp(flight)}{h}, with {self.pitch_abs(flight)}"] + end)
        if k == 6:
            v = self.pick("followed", "tracked", "accompanied") if flight.walks else self.pick("filmed", "watched", "recorded")
            h = self.pick(f"; the flying height is {self.m(flight.altitude)}", f", and the drone is to be {self.m(flight.altitude)} above their feet") if tall else ""
            return self.sentences([f"{x} {self.pick('is to be', 'should be', 'must be')} {v} {self.distance_pp(flight)}, {self.pitch_abs(flight)}{h}"] + end)
        if k == 7:
            c = [self.distance_do(flight), self.pitch_do(flight)] + ([self.height_do(flight)] if tall else [])
            return f"{self.pick('Task', 'Goal', 'Mission', 'Your job')}: {go} {x}. {self.pick('Constraints', 'Rules', 'Requirements', 'How')}: {'; '.join(self.shuffled(c))}." + (" " + self.sentences(end) if end else "")
        if k == 8:
            bag = f"{go} {x} {self.pick('stay', 'keep')} {self.m(flight.distance)} away {self.pick('cam', 'camera')} {self.pitch_note(flight)}" if self.odds(40) else f"{self.pick('pls ', 'ok ', '')}{go} {x}, {self.distance_do(flight)}, {self.pitch_do(flight)}"
            if tall:
                bag += f", height {self.m(flight.altitude)}"
            return self.sloppy(", ".join([bag] + [e.replace(";", ",") for e in end[:1]]))
        if k == 9:
            h = f" and {self.height_pp(flight)}" if tall else ""
            return self.sentences([f"with {self.pitch_abs(flight)}, {go} {x}{self.at(flight)}{h}"] + end)
        if k == 10 and flight.walks:
            a = self.pick(f"wherever {x} goes, {self.distance_do(flight)}", f"as {x} walks, {self.distance_do(flight)}", f"while {x} is walking, {self.distance_do(flight)}", f"no matter which way {x} goes, {self.distance_do(flight)}")
            return self.sentences([a, self.pitch_do(flight)] + ([self.height_do(flight)] if tall else []) + end)
        if k == 11:
            return self.sentences([self.pick("you are piloting a drone", "imagine you are the drone pilot", "you control a camera drone"), self.pick(f"your target is {x}", f"the one to {'follow' if flight.walks else 'film'} is {x}", f"{x} is your subject")]
                                  + self.shuffled([self.distance_do(flight), self.pitch_do(flight)] + ([self.height_do(flight)] if tall else [])) + end)
        if k == 12:
            head = self.pick("Formal version", "Shorter", "In other words", "Rephrased", "Casual version", "Option with more detail")
            return f"{head}: " + lower(self.sentences([f"{self.pick('kindly ', 'please ', '')}{go} {x}, and while doing so {self.distance_imp(flight)} and {self.pitch_imp(flight)}"] + ([self.height_do(flight)] if tall else []) + end))
        if k == 13:
            late = end if any(c.startswith(("they", "along")) for c in end) else []
            end = end if not late else []
            return self.sentences(end + [f"{self.pick('your task is to', 'the pilot is asked to', 'you are to', 'the drone should')} {go} {x}, {self.pick('ensuring', 'taking care', 'making sure')} that the distance is {self.m(flight.distance)} and that the camera {self.camera_is(flight)}"] + ([self.height_do(flight)] if tall else []) + late)
        if k == 14:
            return self.sentences([f"{upper(self.m(flight.distance))} away, {self.pick('camera', 'cam', 'lens')} {self.pitch_note(flight)}" + (f", {self.m(flight.altitude)} high" if tall else "") + f": {self.pick('that is how I want you to', 'this is how you should', 'like that, please')} {go} {x}"] + end)
        c = self.shuffled([self.distance_imp(flight), self.pitch_imp(flight)]) + ([self.height_do(flight)] if tall else [])
        return self.sentences([f"{go} {x}", " and ".join(c[:2])] + c[2:] + end)

    def camera_is(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("is level", "looks straight at the horizon", "is tilted neither up nor down")
        w, b = ("down", "below") if p > 0 else ("up", "above")
        return self.pick(f"looks {w} by {a}", f"is tilted {a} {w}", f"points {a} {b} the horizon", f"is pitched {a} {b} level")

    def walk_clauses(self, flight):
        """Turns, stops and length as clauses in varied order, some of them joined."""
        if not flight.walks:
            return [self.stand_clause(flight)]
        k = self.pick(*range(7))
        if k == 0:
            return self.shuffled([self.turns_clause(flight), self.stops_clause(flight), self.length_clause(flight)])
        if k == 1:
            s = self.sub(flight)
            return [f"{s} {self.length_vp(flight)}", f"on this walk {self.sub(flight)} {self.turns_vp(flight)}; {self.sub(flight)} {self.stops_vp(flight)}"]
        if k == 2:
            s = self.sub(flight)
            return [f"{s} {self.length_vp(flight)}", f"the walk {self.vb2('have')} {self.turns_np(flight)}; {self.stops_there(flight)}"]
        if k == 3:
            w, s, v = self.m(flight.way), self.s(flight.duration), self.rate(flight)
            return [f"over a total of {w}, {self.sub(flight)} {self.turns_vp(flight)}", self.stops_clause(flight), self.pick(f"this {self.vb2('take')} {s}, at a mean walking speed of {v}", f"average walking speed {self.be()} {v}, duration {s}", f"all in all {s} {self.be(True)} needed; the walking speed {self.vb2('average')} {v}")]
        if k == 4:
            w, s, v = self.m(flight.way), self.s(flight.duration), self.rate(flight)
            return [f"in {s} {self.sub(flight)} {self.vb('walk')} {w} in all", f"{self.sub(flight)} {self.stops_vp(flight)}" , self.turns_clause(flight), self.pick(f"the mean walking speed {self.be()} {v}", f"{v} {self.be()} the average speed", f"on average {self.sub(flight)} {self.vb('walk')} at {v}")]
        if k == 5:
            w, s, v = self.m(flight.way), self.s(flight.duration), self.rate(flight)
            return [f"{self.pick('a walk', 'a route', 'a path')} of {w} with {self.turns_np(flight)} and with {self.stops_np(flight)} {self.be()} completed in {s}, the mean walking speed being {v}"]
        return [f"{self.sub(flight)} {self.turns_vp(flight)}", f"{self.length_clause(flight)}; {self.stops_clause(flight)}"]

    def description(self, flight):
        self.begin(flight, self.pick("past", "past", "present"))
        self.over = True
        tall = flight.altitude >= 1
        x, y = self.who(flight), self.who(flight, False)
        v = lambda *w: self.vb2(self.pick(*w))
        verb = v("follow", "track", "accompany", "shadow") if flight.walks else v("film", "watch", "record", "observe")
        done = self.pick("followed", "tracked", "accompanied") if flight.walks else self.pick("filmed", "watched", "recorded")
        k = self.pick(*range(15))
        walk = self.walk_clauses(flight)
        hp = [self.height_clause(flight)] if tall else []
        if k == 0:
            return self.sentences([f"{self.pick('a drone', 'a camera drone', 'the drone', 'a quadcopter')} {verb} {y}{self.at(flight)}, {self.pitch_abs(flight)}"] + hp + walk)
        if k == 1:
            return self.sentences([f"{y} {self.be()} {done} by a drone {self.distance_pp(flight)}"] + walk + [self.pitch_clause(flight)] + hp)
        if k in (2, 3):
            rows = [f"{self.pick('distance', 'distance to person', 'range', 'separation')}: {self.m(flight.distance)}", f"{self.pick('camera', 'camera angle', 'tilt', 'view')}: {self.pitch_note(flight)}"]
            if tall:
                rows.append(f"{self.pick('height', 'altitude', 'height above feet')}: {self.m(flight.altitude)}")
            if flight.walks:
                rows += [f"turns: {self.turns_note(flight)}", f"{self.pick('pauses', 'stops')}: {self.stops_np(flight)}", f"{self.pick('length of walk', 'way walked', 'walked')}: {self.m(flight.way)}", f"{self.pick('mean walking speed', 'speed', 'average speed')}: {self.rate(flight)}"]
            else:
                rows.append(self.pick("movement: none", "walking: no, stands on one spot", "stands still the whole time"))
            rows.append(f"{self.pick('duration', 'time', 'flight time')}: {self.s(flight.duration)}")
            who = self.pick(f"{self.pick('person', 'subject', 'target')}: {self.clothes_note(flight)}" if flight.wear else f"target: {y}", f"{self.pick('subject', 'who')}: {y}")
            rows = [who] + (self.shuffled(rows) if self.odds(60) else rows)
            if k == 2:
                mark = self.pick("- ", "* ", "")
                return self.pick("Flight log\n", "Summary:\n", "", "Notes on the clip\n") + "\n".join(mark + upper(r) for r in rows)
            return upper(self.pick("; ", " | ").join(rows)) + self.pick("", ".")
        if k == 4:
            return self.sentences([f"the one {self.pick('on camera', 'in the video', 'being filmed')} {self.be()} {y}"] + self.shuffled(walk[:1] + [self.distance_clause(flight), self.pitch_clause(flight)] + hp) + walk[1:])
        if k == 5:
            self.tense = "past"
            walk = self.walk_clauses(flight)
            h = f" I flew {self.m(flight.altitude)} above their feet." if tall else ""
            lead = self.pick("I flew the drone and kept", "as the pilot I had", "I was flying and had", "with my drone I kept", "from my drone I had")
            return upper(f"{lead} {x} in frame from {self.pick('a distance of ' + self.m(flight.distance), self.m(flight.distance) + ' away')}, with {self.pick('my camera', 'the camera')} {self.tilted(flight)}.") + h + " " + self.sentences(walk)
        if k == 6:
            shot = self.pick("footage", "drone video", "video", "drone footage", "recording")
            h = f" and {self.height_pp(flight)}" if tall else ""
            return self.sentences([f"{shot} of {y}, filmed {self.distance_pp(flight)}{h} with {self.pitch_abs(flight)}"] + walk)
        if k == 7:
            t = self.sentences([f"drone {verb} {y}", self.distance_clause(flight), self.pitch_clause(flight)] + hp + walk)
            return self.sloppy(t)
        if k == 8:
            mid = f"who {self.rel(self.turns_vp, flight)} and who {self.rel(self.stops_vp, flight)}" if flight.walks else f"who {self.rel(self.stand_vp, flight)}"
            w = f", the walk being {self.m(flight.way)} long in {self.s(flight.duration)} at {self.rate(flight)} on average" if flight.walks else ""
            h = f" and its height {self.m(flight.altitude)}" if tall else ""
            return self.sentences([f"{self.pick('the flight', 'this flight')} {verb} {y}, {mid}{w}", f"the drone's distance {self.be()} {self.m(flight.distance)}{h}, {self.pitch_abs(flight)}"])
        if k == 9:
            if flight.walks:
                q = [("Who?", y), ("How far away was the drone?", self.m(flight.distance)), ("Camera?", self.pitch_note(flight)), ("Turns?", self.turns_np(flight)), ("Stops?", self.stops_np(flight)),
                     ("How far did they walk?", self.m(flight.way) + f" in {self.s(flight.duration)}"), ("How fast?", self.rate(flight) + " on average")]
            else:
                q = [("Who?", y), ("How far away was the drone?", self.m(flight.distance)), ("Camera?", self.pitch_note(flight)), ("Did they walk?", "no, they stood on one spot"), ("How long?", self.s(flight.duration))]
            if tall:
                q.insert(2, ("How high?", self.m(flight.altitude)))
            return self.pick(" ", "\n").join(f"{a} {upper(b)}." for a, b in q)
        if k == 10:
            lead = self.pick("In summary", "In short", "To sum up", "Paraphrase", "Put differently", "Caption")
            colon = ":" if lead in ("Paraphrase", "Caption") else ","
            return f"{lead}{colon} " + lower(self.sentences([f"{y} {self.be()} {self.pick('captured', 'filmed', done)} {self.distance_pp(flight)} by a drone with {self.pitch_abs(flight).replace('the camera', 'a camera').replace('its camera', 'a camera').replace('the lens', 'a lens')}"] + hp + walk))
        if k == 11:
            a = self.distance_clause(flight)
            return self.sentences([f"{self.pick('this clip shows', 'the clip shows', 'the video shows', 'what we see is', 'on screen is')} {y}"] + walk + [f"{a}, and {self.pitch_clause(flight)}"] + hp)
        if k == 12:
            return self.sentences([f"the drone's target {self.be()} {y}"] + [self.pick(f"while {self.pitch_clause(flight)}, {self.distance_clause(flight)}", f"{self.distance_clause(flight)} while {self.pitch_clause(flight)}")] + hp + walk)
        if k == 13:
            h = f", {self.m(flight.altitude)} high" if tall else ""
            about = f" {upper(self.pick('the person in question', 'the one concerned', 'the subject of all this'))} {self.be()} {y}." if flight.wear else f" {upper(self.be_filmed(flight))}."
            return self.sentences(walk) + about + f" Drone: {self.m(flight.distance)} away{h}, camera {self.pitch_note(flight)}."
        c = self.shuffled([self.distance_clause(flight), self.pitch_clause(flight)] + hp)
        return self.sentences([f"a drone {verb} {y}"] + walk + [", ".join(c[:-1]) + f" and {c[-1]}"])

    def be_filmed(self, flight):
        return f"a drone {self.vb2('film')} {self.pick('all of it', 'this', 'the whole of it')}"

    def rel(self, vp, flight):
        self.plural = False
        return vp(flight)

    def tilted(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        return self.pick("held level", "kept horizontal", "aimed straight at the horizon") if p == 0 else self.pick(f"tilted {a} {'down' if p > 0 else 'up'}", f"pitched {a} {'below' if p > 0 else 'above'} the horizon", f"pointing {a} {'downward' if p > 0 else 'upward'}")

    # -- wrong texts --
    def foreign(self, text):
        body = text.rstrip(" .")
        end = ""
        if body.endswith("?"):
            body, end = body[:-1], "?"
        if self.odds(60):
            return f"{body}, {self.pick(*self.things)}{end or '.'}"
        p = self.pick(*self.persons)
        last = text if text.rstrip().endswith((".", "?")) else text.rstrip() + "."
        return last + " " + self.pick(f"The person is {an(p)}.", f"It is {an(p)} who can be seen.", f"By the way, the target is {an(p)}.", f"This is {an(p)}.", f"In fact they are {an(p)}.", f"{upper(an(p))} is who the drone has in view.")

    def heading(self, text, direction):
        last = text if text.rstrip().endswith((".", "?")) else text.rstrip() + "."
        return last + " " + self.pick(f"The person walks {direction}.", f"They head {direction}.", f"The walk leads {direction}.", f"Their heading is {direction}.", f"The direction of the walk is {direction}.", f"Overall the person goes {direction}.", f"They are walking towards the {direction}.",
                                      f"Walking direction: {direction}.", f"It is {direction} that the person walks.", f"From the start the person walks to the {direction}.")


# ---------------------------------------------------------------- Chinese
WIDE = str.maketrans(",;:?()", "\uff0c\uff1b\uff1a\uff1f\uff08\uff09")
NARROW = str.maketrans("\uff0c\uff1b\uff1a\uff1f\uff08\uff09", ",;:?()")
HAN = "零一二三四五六七八九"


def han(n, measure=True):
    if n == 2 and measure:
        return "两"
    if n < 10:
        return HAN[n]
    if n < 20:
        return "十" + (HAN[n % 10] if n % 10 else "")
    if n < 100:
        return HAN[n // 10] + "十" + (HAN[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        tail = "" if not rest else "零" + HAN[rest] if rest < 10 else HAN[rest // 10] + "十" + (HAN[rest % 10] if rest % 10 else "")
        return HAN[n // 100] + "百" + tail
    return str(n)


class EighteenthChinese(Grammar):
    code = "zh"
    things = ["旁边有座喷泉", "身边跟着两条狗", "天上打着雷", "路过一家关了门的面包店", "头顶挂着一串灯笼", "沿着运河边", "当时正下着雪", "四周雾很大", "夕阳西下", "手里推着婴儿车", "撑着一把伞", "对面驶来一辆公交车", "旁边停着一排出租车", "手里拿着冰淇淋",
              "周围全是游客", "正好经过斑马线", "从铁路桥下穿过", "一边走一边打电话", "身后有个骑自行车的人", "街角立着一尊铜像", "远处传来钟声", "风很大", "旁边是加油站", "酒店门口人来人往", "胳膊下夹着滑板"]
    persons = ["水管工", "女学生", "警察", "老太太", "快递员", "服务员", "年轻妈妈", "跑步爱好者", "和尚", "外国游客", "新娘", "修车师傅", "老爷爷", "中学生"]

    def odds(self, percent):
        return self.pick(*range(100)) < percent

    def shuffled(self, items):
        items, out = list(items), []
        while items:
            out.append(items.pop(self.pick(*range(len(items)))))
        return out

    def begin(self, flight, past):
        self.past, self.name = past, None
        self.spelt = self.odds(12)
        self.gap = self.pick("", "", "", " ")
        self.metre = self.pick("米", "米", "米", "m")
        self.degree = self.pick("度", "度", "°")
        self.second = self.pick("秒", "秒", "秒", "秒钟")
        self.vague = self.pick("", "", "", "", "约", "大约", "大概")

    @property
    def le(self):
        return "了" if self.past else ""

    @property
    def none(self):
        return self.pick("没有", "没") if self.past else "不"

    def num(self, n, unit):
        return han(n) + unit if self.spelt else f"{n}{self.gap}{unit}"

    def m(self, n, vague=False):
        return (self.vague if vague else "") + self.num(n, "米" if self.spelt else self.metre)

    def d(self, n):
        n = abs(n)
        return han(n, False) + "度" if self.spelt else f"{n}{self.degree}"

    def s(self, n):
        return self.num(n, self.second)

    def c(self, n):
        return self.pick(han(n), han(n), str(n))

    def rate(self, flight):
        v = f"{flight.speed:.1f}"
        if self.spelt:
            a, b = v.split(".")
            return f"每秒{HAN[int(a)]}点{HAN[int(b)]}米"
        return self.pick(f"每秒{v}米", f"{v}米/秒", f"{v} m/s", f"{v}米每秒")

    def sub(self, flight):
        """One name for the person within a text."""
        self.name = self.name or self.pick("此人", "这个人", "对方", "目标", "这人", "该人物", "被拍的人", *(["步行者", "行人"] if flight.walks else []))
        return self.pick(self.name, self.name, "此人")

    # -- 人 --
    def who(self, flight, the=True):
        nouns = ["人", "人", "人"] + (["目标"] if the else []) + (["步行者", "行人"] if flight.walks else [])
        if flight.wear is None:
            if the:
                return self.pick("那个人", "这个人", "目标人物", "画面里的那个人", "指定的那个人", "那位", "该目标", "目标")
            return self.pick("一个人", "一名行人", "一位行人") if flight.walks else self.pick("一个人", "一个站着的人")
        top, legs, bag = ZH_COLOURS[flight.wear[0]], ZH_COLOURS[flight.wear[1]], flight.wear[2]
        art = self.pick("那个", "那个", "", "那位") if the else self.pick("一个", "一位", "一名")
        noun = self.pick(*nouns)
        if art in ("一名", "一位") and noun == "人":
            art = "一个"
        k = self.pick(*range(13))
        if art == "那位" and (noun == "目标" or k == 4):
            art = "那个"
        up, down = self.pick(("上衣", "裤子"), ("上衣", "裤子"), ("上装", "裤子"))
        b = self.pick("背着背包", "背着双肩包", "背了个包", "带着背包") if bag else self.pick("", "", "没背包")
        bb = "、" + b if b else ""
        bc = ",".replace(",", ",") + b if b else ""
        if flight.wear[0] == flight.wear[1] and self.odds(50):
            look = self.pick(f"上衣和裤子都是{top}色", f"上下身都穿{top}色", f"{top}上衣配{top}裤子")
            return f"{art}{look}{bb}的{noun}"
        if k == 0:
            return f"{art}穿{top}色{up}、{legs}色{down}{bb}的{noun}"
        if k == 1:
            return f"{art}{top}衣{legs}裤{bb}的{noun}"
        if k == 2:
            return f"{art}上身{top}色、下身{legs}色{bb}的{noun}"
        if k == 3:
            return f"{art}穿着{top}上衣和{legs}裤子{bb}的{noun}"
        if k == 4:
            return f"{art}{noun}({top}色上衣,{legs}色裤子{',有背包' if bag else ''})"
        if k == 5:
            return f"{art}身穿{top}色上衣、{legs}色裤子{bb}的{noun}"
        if k == 6:
            return (f"{art}背着包、穿{top}上衣和{legs}裤子的{noun}" if bag else f"{art}穿{legs}裤子、{top}上衣的{noun}")
        if k == 7:
            return f"{art}{top}上衣配{legs}裤子{bb}的{noun}"
        if k == 8:
            return f"{art}上衣{top}色、裤子{legs}色{bb}的{noun}"
        if k == 9:
            return f"{art}下身穿{legs}色裤子、上身穿{top}色上衣{bb}的{noun}"
        if k == 10:
            return f"{art}身着{top}色上衣与{legs}色裤子{'并背有背包' if bag else ''}的{noun}"
        if k == 11:
            return f"{art}{top}上衣{legs}裤子{'还背个包' if bag else ''}的{noun}"
        return f"{art}裤子是{legs}色、上衣是{top}色{bb}的{noun}"

    def clothes_note(self, flight):
        top, legs, bag = ZH_COLOURS[flight.wear[0]], ZH_COLOURS[flight.wear[1]], flight.wear[2]
        return self.pick(f"{top}色上衣、{legs}色裤子", f"上衣{top},裤子{legs}", f"{top}衣{legs}裤", f"{legs}裤子,{top}上衣") + (self.pick(",有背包", ",背双肩包") if bag else self.pick("", ",无背包"))

    # -- 距离 --
    def distance_pp(self, flight):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"在{x}外", f"隔着{x}", f"保持{x}距离", f"从{x}远处", f"以{y}的距离", f"在距其{x}处", f"隔{x}远", f"在相距{x}处", f"在离人{x}的地方", f"以{x}的间隔")

    def distance_do(self, flight):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"距离保持{x}", f"跟人隔开{x}", f"离对方{x}", f"无人机与人相距{x}", f"让飞机离人{x}", f"中间留出{x}", f"别近也别远,就{y}", f"直线距离定在{y}", f"与目标的间距要求是{y}", f"人机之间隔{x}", f"不要超过也不要小于{y}的距离", f"要保持的距离是{y}", f"把距离控制在{x}")

    def distance_clause(self, flight):
        x, y = self.m(flight.distance, True), self.m(flight.distance)
        return self.pick(f"无人机离人{x}", f"人机相距{x}", f"无人机与人的平均距离为{y}", f"飞机到人的直线距离平均{y}", f"两者之间隔着{x}", f"拍摄距离是{x}", f"平均下来,无人机离人{y}", f"机位距人{x}", f"无人机一直在{x}远的地方", f"与目标的间隔平均是{y}", f"人与无人机隔{x}")

    # -- 俯仰 --
    def pitch_pp(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("镜头平视", "镜头保持水平", "相机水平朝前", "镜头不俯不仰", "云台放平", "相机对准地平线", "镜头俯仰角为" + a, "机头相机放平", "视线与地平线平齐", "镜头既不朝上也不朝下")
        if p > 0:
            return self.pick(f"镜头下俯{a}", f"镜头朝下{a}", f"相机俯角{a}", f"镜头向下倾斜{a}", f"云台下压{a}", f"以{a}俯角拍摄", f"相机低于地平线{a}", f"镜头往下压{a}", f"视线俯{a}", f"镜头与水平面成{a}俯角", f"俯视角{a}")
        return self.pick(f"镜头上仰{a}", f"镜头朝上{a}", f"相机仰角{a}", f"镜头向上倾斜{a}", f"云台上抬{a}", f"以{a}仰角拍摄", f"相机高于地平线{a}", f"镜头往上抬{a}", f"视线仰{a}", f"镜头与水平面成{a}仰角", f"仰视角{a}")

    def pitch_do(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("镜头放平", "相机保持水平", "镜头别抬也别压", "用平视的角度拍", "让镜头正对地平线", "云台俯仰角设为" + a, "镜头要求水平", "不要让镜头上仰或下俯", "保持平视", "把相机摆成水平的")
        w, k, v = ("下", "俯", "压") if p > 0 else ("上", "仰", "抬")
        return self.pick(f"镜头往{w}{v}{a}", f"把相机{k}角设成{a}", f"让镜头朝{w}倾斜{a}", f"{k}角保持{a}", f"用{a}的{k}角拍", f"云台{w}{v}{a}", f"相机要朝{w}{a}", f"镜头{w}{k}{a}就行", f"将镜头{'降到地平线以下' if p > 0 else '抬到地平线以上'}{a}", f"镜头{k}角要求{a}")

    def pitch_clause(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        if p == 0:
            return self.pick("镜头是平视的", "相机保持水平", "镜头正对地平线", "用的是平视角度", "镜头没有上仰也没有下俯", f"相机俯仰角为{a}", "云台放平了拍", "视线是水平的", "画面为水平视角", "镜头始终水平")
        w, k, v = ("下", "俯", "压") if p > 0 else ("上", "仰", "抬")
        return self.pick(f"镜头朝{w}{a}", f"相机{k}角为{a}", f"镜头向{w}倾斜{a}", f"用{a}的{k}角拍摄", f"云台{w}{v}{a}", f"镜头{w}{k}{a}", f"画面是{a}{k}角", f"相机对着地平线{'以下' if p > 0 else '以上'}{a}", f"拍摄角度是{k}{a}", f"镜头{k}角{a}")

    def pitch_note(self, flight):
        p, a = flight.pitch, self.d(flight.pitch)
        return self.pick("平视", "水平", f"{a}(水平)") if p == 0 else self.pick(f"俯{a}", f"向下{a}", f"俯角{a}", f"下压{a}") if p > 0 else self.pick(f"仰{a}", f"向上{a}", f"仰角{a}", f"上抬{a}")

    # -- 高度 --
    def height_do(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"飞行高度{h}", f"飞在{h}高", f"离地{h}飞", f"高度取{h}", f"高出人脚下{h}", f"比人脚下的地面高{h}", f"把高度定在{h}", f"保持{h}的高度", f"离人所站地面{h}高", f"飞高{h}")

    def height_clause(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"飞行高度{h}", f"无人机飞在{h}高处", f"无人机离地{h}", f"高度为{h}", f"无人机比人的脚下高{h}", f"相对人脚下的高度是{h}", f"飞机高出人脚下地面{h}", f"航高{h}", f"机身在{h}高的空中", f"无人机保持{h}高")

    # -- 转弯 --
    T = {"left": ("左转", "往左拐", "向左转", "左拐"), "right": ("右转", "往右拐", "向右转", "右拐"), "around": ("掉头", "掉头往回走", "转身掉头", "调头")}

    def turns_vp(self, flight):
        t, k = flight.turns, self.pick(0, 1, 2, 3)
        le = self.le
        if not t:
            return self.pick(self.none + "转弯", self.none + "拐过弯" if self.past else "全程不拐弯", "一次弯也" + ("没拐" if self.past else "不拐"), "全程" + ("没有转向" if self.past else "不转向"), "一个弯都" + ("没转" if self.past else "不转"), "既" + ("没" if self.past else "不") + "左转也" + ("没" if self.past else "不") + "右转,更" + ("没" if self.past else "不") + "掉头",
                             "途中" + ("没有" if self.past else "不会") + "拐弯", "一路直行,不转弯" if not self.past else "一路直行,没转弯", "从头到尾" + ("没有" if self.past else "不会") + "转弯")
        if k == 2 and not any(x == "around" for x in t):
            k = self.pick(0, 1, 2, 3)
        n = [self.T[x][k] for x in t]
        if len(t) == 1:
            x, dir_ = n[0], {"left": "左", "right": "右"}.get(t[0])
            if not dir_:
                return self.pick(f"掉{le}一次头", f"掉头一次", f"中途掉{le}一次头", f"转身掉头{le}一次", f"只掉{le}一次头", f"有一次掉头", f"途中调头一次", f"做{le}一次掉头")
            return self.pick(f"{x}{le}一次", f"往{dir_}拐{le}一个弯", f"只转一次弯,向{dir_}" if not self.past else f"只转了一次弯,是向{dir_}的", f"中途{x}一次", f"有一次{dir_}转", f"拐{le}个{dir_}弯", f"{dir_}拐一次", f"转{le}一个弯,方向向{dir_}", f"途中向{dir_}转{le}一次弯", f"{x}一次")
        g = [self.T[x][k] + ("" if c == 1 else f"{han(c)}次") for x, c in runs(t)]
        opts = ["先" + n[0] + ",再" + n[1] if len(n) == 2 else "先" + n[0] + ",再" + n[1] + "".join(",接着" + x for x in n[2:-1]) + ",最后" + n[-1],
                f"依次{'、'.join(n)}", f"一共转{le}{self.c(len(t))}次弯,依次是{'、'.join(n)}", ",然后".join(n) if len(n) < 4 else f"按顺序{'、'.join(n)}", f"共转向{self.c(len(t))}次:{'、'.join(n)}", f"{n[0]}之后{n[1]}" + "".join(",再" + x for x in n[2:])]
        if len(g) < len(n) and len(g) > 1:
            opts += ["先" + g[0] + "".join(",再" + x for x in g[1:])] * 3
        if len(g) == 1:
            x = t[0]
            opts = [f"连续{self.T[x][k]}{self.c(len(t))}次", f"{self.c(len(t))}次转弯都是{self.T[x][0]}", f"{self.T[x][k]}{le}{self.c(len(t))}次", f"前后{self.T[x][k]}{self.c(len(t))}次", f"{self.T[x][0]}一共{self.c(len(t))}次", f"转{le}{self.c(len(t))}次弯,每次都是{self.T[x][0]}"] if k != 1 or x != "around" else [f"掉{le}{self.c(len(t))}次头", f"先后掉头{self.c(len(t))}次"]
        return self.pick(*opts)

    def turns_clause(self, flight):
        t = flight.turns
        if len(t) > 1 and self.odds(35):
            n = [self.T[x][0] for x in t]
            return self.pick("第一个弯是" + n[0] + "".join(f",第{han(i + 2, False)}个是{x}" for i, x in enumerate(n[1:])), f"转弯顺序为{'—'.join(n)}", f"途中有{self.c(len(t))}次转向,顺序是{'、'.join(n)}", f"先是{n[0]}," + "".join(f"随后{x}," for x in n[1:-1]) + f"末了{n[-1]}", f"转向记录:{'→'.join(n)}")
        if not t and self.odds(25):
            return self.pick("没有任何转弯", "全程无转弯", "途中不见转弯")
        return self.sub(flight) + self.turns_vp(flight)

    def turns_note(self, flight):
        t = flight.turns
        if not t:
            return self.pick("无", "没有", "0次")
        return self.pick("、", "→", ",", "-").join(self.T[x][0] for x in t)

    # -- 停 --
    def stops_vp(self, flight):
        n, s, le, c = flight.stops, self.s(flight.standing), self.le, self.c(flight.stops)
        if n == 0:
            return self.pick("一次也" + ("没停" if self.past else "不停"), "中途" + ("没有停过" if self.past else "不停"), "全程" + ("没停下" if self.past else "不停步"), "一直走,没停顿" if self.past else "一直走,不停顿", "路上" + ("没有停留" if self.past else "不停留"), "没有停下来过" if self.past else "不会停下来", "一路" + ("未停" if self.past else "不停"), "从头到尾" + ("没停步" if self.past else "不停步"), "途中不做停留" if not self.past else "途中没做停留", "没有停顿" if self.past else "不停顿")
        if flight.standing < 1:
            return self.pick(f"停{le}{c}次", f"中途停下{c}次")
        if n == 1:
            return self.pick(f"停{le}一次,{s}", f"中途停下一次,站{le}{s}", f"只停{le}一回,时长{s}", f"途中停顿一次,历时{s}", f"停下来{s},就这一次", f"站住一次,停{le}{s}", f"有一次停留,{s}", f"停{le}1次,共{s}", f"歇{le}一次脚,前后{s}", f"驻足一次,时间是{s}", f"停留一次,持续{s}")
        return self.pick(f"停{le}{c}次,共{s}", f"中途停下{c}次,加起来{s}", f"先后停{le}{c}回,总计{s}", f"途中停顿{c}次,合计{s}", f"停{c}次,一共站{le}{s}", f"驻足{c}次,累计{s}", f"有{c}次停留,总时长{s}", f"站住{c}次,前后合起来{s}", f"停留{c}次,总共持续{s}", f"一共停{le}{c}次,全部停留时间{s}")

    def stops_clause(self, flight):
        if self.odds(20):
            return self.pick("全程无停顿", "途中没有停留") if flight.stops == 0 else f"停顿{self.c(flight.stops)}次" + (f",合计{self.s(flight.standing)}" if flight.standing else "")
        return self.sub(flight) + self.stops_vp(flight)

    def stops_note(self, flight):
        if flight.stops == 0:
            return self.pick("无", "0次", "没有")
        return f"{self.c(flight.stops)}次" + (self.pick(f",共{self.s(flight.standing)}", f"(合计{self.s(flight.standing)})") if flight.standing else "")

    # -- 路程、时间、速度 --
    def length_clause(self, flight):
        w, s, v, le = self.m(flight.way), self.s(flight.duration), self.rate(flight), self.le
        u = self.sub(flight)
        return self.pick(f"{u}{s}走{le}{w},平均速度{v}", f"{u}以{v}的平均速度走{le}{w},用时{s}", f"全程步行{w},历时{s},均速{v}", f"{u}总共走{le}{w},花{le}{s},平均{v}", f"{s}内{u}走完{w},步速平均{v}", f"步行路程{w},时长{s},平均步速为{v}", f"{u}的平均步行速度是{v},{s}走{le}{w}",
                         f"一段{w}的路,{u}用{s}走完,均速{v}", f"{u}一共走{w},耗时{s},平均下来{v}", f"走完{w}的路程{u}用{le}{s},平均步速{v}", f"步速平均{v},走{le}{w},飞行{s}")

    # -- 站着 --
    def stand_clause(self, flight, long=True):
        u, s = self.sub(flight), self.s(flight.duration)
        a = self.pick(f"{u}站在原地没动", f"{u}一直站着不走", f"{u}原地站立", f"{u}站在一处未曾挪步", f"{u}没有走动,只是站着", f"{u}始终站在同一个地方", f"{u}一步没走,站在原处", f"{u}立在原地", f"{u}待在原地站着", f"{u}站着,没有移动位置") if self.past \
            else self.pick(f"{u}站在原地不动", f"{u}一直站着", f"{u}原地站立", f"{u}站在一处不挪步", f"{u}不走动,只是站着", f"{u}始终站在同一个地方", f"{u}不走路,站在原处", f"{u}立在原地", f"{u}待在原地站着", f"{u}站着,不移动位置")
        return a + (self.pick(f",全程{s}", f",整个飞行持续{s}", f",前后{s}", f",时长{s}", f",这样过{self.le}{s}" if self.past else f",共{s}", f",飞行时间{s}") if long else "")

    # -- 整段 --
    def marks(self, text):
        """Full-width marks as Chinese print has them; some annotators type the narrow ones."""
        return text if self.odds(8) else text.translate(WIDE)

    def sentences(self, clauses):
        out = ""
        for c in clauses:
            out += c + ("" if c.endswith(("?", "。")) else "。")
        return out

    def chain(self, clauses):
        """Commas within, a full stop at the end; now and then broken in two."""
        return "".join(c + self.pick(",", ",", "。", ";") for c in clauses[:-1]) + clauses[-1] + "。"

    def walk_clauses(self, flight):
        if not flight.walks:
            return [self.stand_clause(flight)]
        return self.pick(lambda: self.shuffled([self.turns_clause(flight), self.stops_clause(flight), self.length_clause(flight)]),
                         lambda: [self.length_clause(flight), f"途中{self.turns_vp(flight)}".replace("途中途中", "途中").replace("途中中途", "途中"), self.stops_clause(flight)],
                         lambda: [f"{self.sub(flight)}在{self.s(flight.duration)}里走{self.le}{self.m(flight.way)}", self.turns_clause(flight), self.stops_clause(flight), f"平均步速{self.rate(flight)}"],
                         lambda: [self.turns_clause(flight), self.stops_clause(flight), f"总路程{self.m(flight.way)},时长{self.s(flight.duration)},平均步行速度{self.rate(flight)}"])()

    def extras(self, flight):
        if not flight.walks:
            return [self.stand_clause(flight, self.odds(40))] if self.odds(65) else []
        out = []
        if self.odds(55):
            out.append(self.turns_clause(flight))
        if self.odds(40):
            out.append(self.stops_clause(flight))
        if self.odds(35):
            out.append(self.length_clause(flight))
        return out

    def shot(self, flight):
        return self.pick("跟拍", "跟着", "跟住", "追踪", "跟踪拍摄", "跟随") if flight.walks else self.pick("拍摄", "拍", "盯住", "对准", "一直拍")

    def instruction(self, flight):
        return self.marks(self.instruction_(flight))

    def instruction_(self, flight):
        self.begin(flight, False)
        tall = flight.altitude >= 1 and self.odds(60)
        x, go = self.who(flight), self.shot(flight)
        end = self.extras(flight)
        hd = [self.height_do(flight)] if tall else []
        dp = [self.distance_do(flight), self.pitch_do(flight)]
        k = self.pick(*range(14))
        if k == 0:
            return self.sentences([",".join([f"{self.pick('请', '', '麻烦')}{self.distance_pp(flight)}{go}{x}", self.pitch_pp(flight)] + hd)] + end)
        if k == 1:
            body = ",".join([f"{go}{x}"] + self.shuffled(dp) + hd)
            ask = self.pick(f"麻烦你{body}," + self.pick("行吗?", "可以吗?", "好不好?"), f"能不能{body}?", f"可不可以{body}?", f"请{body},可以吗?", None)
            return self.sentences(([ask] if ask else [f"你能{go}{x}吗?", ",".join(self.shuffled(dp + hd))]) + end)
        if k == 2:
            return self.sentences([self.pick(f"看到{x}了吗?", f"找到{x}没有?", f"看见{x}了吧?"), self.pick("就是此人,", "目标就是这个,") + ("跟上去" if flight.walks else "拍下来"), ",".join(self.shuffled(dp + hd))] + end)
        if k == 3:
            rows = [f"距离:{self.m(flight.distance)}", f"{self.pick('镜头', '相机角度', '拍摄角度')}:{self.pitch_note(flight)}"] + ([f"高度:{self.m(flight.altitude)}"] if tall else [])
            if flight.walks and self.odds(50):
                rows.append(f"转弯:{self.turns_note(flight)}")
            if flight.walks and self.odds(30):
                rows.append(f"停留:{self.stops_note(flight)}")
            if not flight.walks and self.odds(60):
                rows.append("动作:原地站立")
            mark = self.pick("- ", "· ", "")
            return f"{self.pick('目标', '拍摄对象', '跟拍对象' if flight.walks else '对象')}:{self.clothes_note(flight) if flight.wear and self.odds(50) else x}\n" + "\n".join(mark + r for r in self.shuffled(rows))
        if k == 4:
            steps = [f"找到{x}"] + self.shuffled(dp + hd) + [f"{'一路跟拍' if flight.walks else '持续拍摄'}"]
            sep = self.pick("\n", "")
            dot = self.pick("、", ".")
            return sep.join(f"{i}{dot}{c}" + ("" if sep else ";") for i, c in enumerate(steps, 1)).rstrip(";") + ("" if sep else "。") + ((sep + self.sentences(end)) if end else "")
        if k == 5:
            need = self.pick("我要一段", "需要一段", "帮我拍一段", "想要一条", "给我来一段")
            return self.sentences([f"{need}{x}的{'跟拍' if flight.walks else ''}{self.pick('视频', '画面', '录像')}," + ",".join(self.shuffled(dp + hd))] + end)
        if k == 6:
            return self.sentences([f"{self.pick('对', '针对')}{x}{self.pick('进行', '实施')}{'跟拍' if flight.walks else '拍摄'},{self.distance_do(flight)}", ",".join([self.pitch_do(flight)] + hd)] + end)
        if k == 7:
            return f"{self.pick('任务', '目标', '指令')}:{go}{x}。{self.pick('要求', '条件', '规则')}:" + ";".join(self.shuffled(dp + hd)) + "。" + (self.sentences(end) if end else "")
        if k == 8:
            bag = self.pick(" ", ",").join([f"{go}{x}", self.pick(f"离{self.m(flight.distance)}", f"隔{self.m(flight.distance)}"), f"镜头{self.pitch_note(flight)}"] + ([f"高{self.m(flight.altitude)}"] if tall else []))
            return bag + ("," + end[0] if end else "")
        if k == 9:
            return self.sentences([",".join([self.pitch_pp(flight), f"{self.distance_pp(flight)}{go}{x}"] + hd)] + end)
        if k == 10 and flight.walks:
            return self.sentences([f"{self.pick(f'{x}走到哪,你就跟到哪', f'不管{x}往哪走,都要跟上', f'{x}走动时请一直跟着')}," + ",".join(self.shuffled(dp))] + ([",".join(hd)] if hd else []) + end)
        if k == 11:
            x = "那个人" if x in ("目标", "该目标", "目标人物") else "那个人" + x[2:] if x.startswith("目标") else "那个人" + x[4:] if x.startswith("那个目标") else x[:-2] + "人" if x.endswith("的目标") else x
            return self.sentences([self.pick("你是无人机飞手", "假设你在操控一架无人机", "现在由你来飞无人机"), self.pick(f"目标是{x}", f"要{'跟' if flight.walks else '拍'}的是{x}", f"你的{'跟拍' if flight.walks else '拍摄'}对象是{x}"), ",".join(self.shuffled(dp + hd))] + end)
        if k == 12:
            head = self.pick("换个说法", "正式版", "简洁版", "口语版", "改写")
            return f"{head}:" + self.sentences([f"{self.pick('请', '务必', '')}{go}{x},同时{self.distance_do(flight)},并且{self.pitch_do(flight)}"] + hd + end)
        return self.sentences([f"你要做的是{go}{x},{self.pick('注意', '记住', '期间')}{self.distance_do(flight)},{self.pitch_do(flight)}"] + hd + end)

    def description(self, flight):
        return self.marks(self.description_(flight))

    def description_(self, flight):
        self.begin(flight, self.odds(75))
        tall = flight.altitude >= 1
        x, y = self.who(flight), self.who(flight, False)
        done = self.pick("跟拍", "追踪", "跟踪拍摄", "跟随") if flight.walks else self.pick("拍摄", "航拍", "观察")
        k = self.pick(*range(14))
        walk = self.walk_clauses(flight)
        hp = [self.height_clause(flight)] if tall else []
        dist, pit = self.distance_clause(flight), self.pitch_clause(flight)
        if k == 0:
            return self.sentences([f"一架无人机{self.distance_pp(flight)}{done}{self.le}{y}", ",".join([pit] + hp)] + walk)
        if k == 1:
            return self.sentences([f"{y}被无人机{done}", ",".join(walk), ",".join(self.shuffled([dist, pit] + hp))])
        if k in (2, 3):
            rows = [f"{self.pick('距离', '与人距离', '拍摄距离')}:{self.m(flight.distance)}", f"{self.pick('镜头', '相机', '拍摄角度')}:{self.pitch_note(flight)}"]
            if tall:
                rows.append(f"{self.pick('高度', '飞行高度', '离人脚下高度')}:{self.m(flight.altitude)}")
            rows += [f"转弯:{self.turns_note(flight)}", f"{self.pick('停留', '停顿')}:{self.stops_note(flight)}", f"{self.pick('步行路程', '走路总长')}:{self.m(flight.way)}", f"{self.pick('平均速度', '步速', '均速')}:{self.rate(flight)}"] if flight.walks else [self.pick("状态:原地站立", "走动:无,一直站着")]
            rows.append(f"{self.pick('时长', '用时', '飞行时间')}:{self.s(flight.duration)}")
            who = f"{self.pick('目标', '人物', '拍摄对象')}:{self.clothes_note(flight) if flight.wear and self.odds(60) else y}"
            rows = [who] + (self.shuffled(rows) if self.odds(60) else rows)
            return self.pick("飞行记录\n", "小结:\n", "") + "\n".join(self.pick("- ") + r for r in rows) if k == 2 else ";".join(rows) + self.pick("。", "")
        if k == 4:
            return self.sentences([f"{self.pick('画面里', '镜头里', '视频中')}是{y}"] + walk + [",".join(self.shuffled([dist, pit] + hp))])
        if k == 5:
            self.past = True
            return f"我操控无人机{done}{x},{self.distance_pp(flight)}拍的,{self.pitch_clause(flight)}"  + ("," + hp[0] if hp else "") + "。" + self.sentences(self.walk_clauses(flight))
        if k == 6:
            return self.sentences([f"这是一段{self.distance_pp(flight)}{'跟拍' if flight.walks else '拍摄'}{y}的{self.pick('视频', '影像', '航拍画面')}", pit] + hp + walk)
        if k == 7:
            return self.chain([f"无人机{done}{y}"] + walk + self.shuffled([dist, pit] + hp)).rstrip("。")
        if k == 8:
            return self.sentences([f"本次飞行的{self.pick('对象', '目标')}是{y}", ",".join([dist, pit] + hp), ";".join(walk)])
        if k == 9:
            if flight.walks:
                q = [("拍的是谁?", y), ("隔多远?", self.m(flight.distance)), ("镜头呢?", self.pitch_note(flight)), ("转弯?", self.turns_note(flight) if flight.turns else "没有转弯"), ("停过吗?", self.stops_note(flight) if flight.stops else "没停过"), ("走了多远?", f"{self.m(flight.way)},用了{self.s(flight.duration)}"), ("多快?", "平均" + self.rate(flight))]
            else:
                q = [("拍的是谁?", y), ("隔多远?", self.m(flight.distance)), ("镜头呢?", self.pitch_note(flight)), ("人走了吗?", "没走,一直站在原地"), ("多久?", self.s(flight.duration))]
            if tall:
                q.insert(2, ("飞多高?", self.m(flight.altitude)))
            return "".join(f"{a}{b}。" for a, b in q)
        if k == 10:
            return f"{self.pick('总的来说', '简而言之', '概括一下', '一句话概括')}," + self.chain([f"无人机{self.distance_pp(flight)}{done}{self.le}{y}", pit] + hp + walk)
        if k == 11:
            return self.sentences([",".join(self.shuffled([dist, pit] + hp)) + f",{self.pick('拍的是', '镜头对着', '拍摄对象为')}{y}"] + walk)
        if k == 12:
            return self.chain(walk) + self.sentences([f"以上说的是{y},{self.pick('由', '全程由')}无人机{done}", ",".join(self.shuffled([dist, pit] + hp))])
        y = "有一个人" if flight.wear is None else y
        return self.sentences([f"{y}," + (f"{self.m(flight.way)}的路走了{self.s(flight.duration)},均速{self.rate(flight)}" if flight.walks else f"在原地站了{self.s(flight.duration)}")] + ([f"{self.turns_clause(flight)},{self.stops_clause(flight)}"] if flight.walks else []) + [f"{self.pick('拍摄方面', '无人机这边', '至于拍摄')},{dist},{pit}"] + hp)

    # -- 错 --
    def foreign(self, text):
        narrow = any(c in text for c in ",;:?(")
        text = self.foreign_(text.translate(NARROW))
        return text if narrow else text.translate(WIDE)

    def foreign_(self, text):
        body = text.rstrip(" 。")
        end = "。"
        if body.endswith("?"):
            body, end = body[:-1], "?"
        if self.odds(60):
            return f"{body},{self.pick(*self.things)}{end}"
        p = self.pick(*self.persons)
        last = text if text.endswith(("。", "?")) else text + "。"
        return last + self.pick(f"这个人是{p}。", f"画面里的是个{p}。", f"顺便一提,目标是一位{p}。", f"其实对方是{p}。", f"被拍的是一名{p}。", f"此人看上去就是{p}。")

    def heading(self, text, direction):
        narrow = any(c in text for c in ",;:?(")
        text = self.heading_(text.translate(NARROW), direction)
        return text if narrow else text.translate(WIDE)

    def heading_(self, text, direction):
        z = ZH_DIRECTIONS[direction]
        last = text if text.endswith(("。", "?")) else text + "。"
        return last + self.pick(f"此人朝{z}走。", f"这个人往{z}走。", f"目标一路向{z}行走。", f"行走方向为{z}。", f"人是朝着{z}边走的。".replace("边", "面") if len(z) == 1 else f"人是朝着{z}方向走的。", f"对方向{z}而行。", f"走的是{z}方向。", f"步行朝向:{z}。", f"从一开始就往{z}去。")
