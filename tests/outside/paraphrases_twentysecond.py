"""The Twenty-second grammar for check_text_judge.py: a large language model asked for varied robot instructions (mission orders, friendly assistants, numbered plans, one long sentence, telegrams), and an engineer's flight reports. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "_ _ twenty thirty forty fifty sixty seventy eighty ninety".split()
ORD = "first second third fourth fifth sixth seventh eighth ninth tenth".split()
PAST = dict(stand="stood", make="made", take="took", come="came", go="went", have="had", keep="kept", hold="held", be="was", stop="stopped", run="ran", lie="lay", fly="flew", amount="amounted", do="did", include="included", contain="contained")
ZHN = "零一二三四五六七八九"


def words(n):
    """612 -> six hundred and twelve"""
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + words(n % 100) if n % 100 else "")
    return str(n)


def times(n):
    return {1: "once", 2: "twice"}.get(n) or words(n) + " times"


def cap(text):
    return text[:1].upper() + text[1:]


def listing(parts, last=" and "):
    parts = list(parts)
    return parts[0] if len(parts) == 1 else ", ".join(parts[:-1]) + last + parts[-1]


def runs(turns):
    """[left, left, right] -> [(left, 2), (right, 1)]"""
    out = []
    for t in turns:
        if out and out[-1][0] == t:
            out[-1][1] += 1
        else:
            out.append([t, 1])
    return out


def zhn(n):
    """Chinese numeral without the measure-word form of two."""
    if n < 10:
        return ZHN[n]
    if n < 20:
        return "十" + (ZHN[n % 10] if n % 10 else "")
    if n < 100:
        return ZHN[n // 10] + "十" + (ZHN[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        tail = "" if not rest else "零" + ZHN[rest] if rest < 10 else ZHN[rest // 10] + "十" + (ZHN[rest % 10] if rest % 10 else "")
        return ("两" if n // 100 == 2 else ZHN[n // 100]) + "百" + tail
    return str(n)


class TwentySecondEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls overhead", "with two dogs on leads", "past a row of parked buses", "under a full moon", "while church bells ring", "in thick fog",
              "next to a stalled tram", "in front of a bakery", "with a child on each hand", "among dozens of tourists", "over freshly fallen snow", "in the light of the setting sun", "alongside a cyclist",
              "holding a bright yellow umbrella", "with a phone pressed to one ear", "near an old stone bridge", "amid honking taxis", "in pouring rain", "at the edge of a market square", "with pigeons scattering all around",
              "under a line of plane trees", "just outside the railway station", "pushing a pram", "while a street band plays"]
    persons = ["nurse", "fisherman", "mail carrier", "schoolboy", "grandmother", "police officer", "waiter", "ballerina", "electrician", "teenage girl", "priest", "old man"]
    us = False
    tense = "past"

    # ---- small tools
    def start(self, tense):
        self.us = self.pick(True, False, False)
        self.wordy = self.pick(True, False, False, False)
        self.short = self.pick(True, False)
        self.tense = tense

    def num(self, n):
        return words(n) if self.wordy and n <= 999 else str(n)

    def metres(self, n):
        unit = ("meter" if self.us else "metre") + ("" if n == 1 else "s")
        if self.wordy:
            return words(n) + " " + unit
        return f"{n} m" if self.short else f"{n} {unit}"

    def secs(self, n):
        unit = "second" if n == 1 else "seconds"
        if self.wordy:
            return words(n) + " " + unit
        return f"{n} s" if self.short else f"{n} {unit}"

    def degs(self, n):
        unit = "degree" if n == 1 else "degrees"
        if self.wordy:
            return words(n) + " " + unit
        return f"{n}°" if self.short else f"{n} {unit}"

    def mps(self, f):
        m = "meters" if self.us else "metres"
        if self.wordy and self.rng.random() < .5:
            whole, tenth = f"{f.speed:.1f}".split(".")
            return f"{words(int(whole))} point {words(int(tenth))} {m} per second"
        return f"{f.speed:.1f} m/s" if self.short else f"{f.speed:.1f} {m} per second"

    def col(self, c):
        return "gray" if c == "grey" and self.us else c

    def trousers(self):
        return "pants" if self.us else "trousers"

    def v(self, base, plural=False):
        """The verb in this text's tense."""
        if self.tense == "fut":
            return "will " + base
        if self.tense == "pres":
            if base == "be":
                return "are" if plural else "is"
            if plural:
                return base
            return {"have": "has", "go": "goes", "do": "does", "fly": "flies"}.get(base) or base + ("es" if base.endswith(("ch", "sh", "ss")) else "s")
        if base == "be":
            return "were" if plural else "was"
        return PAST.get(base) or (base + "d" if base.endswith("e") else base + "ed")

    def subject(self, f):
        return self.pick(("they", True), ("they", True), ("the person", False), ("the subject", False), ("the walker", False) if f.walks else ("this person", False))

    def sv(self, f, base):
        name, plural = self.subject(f)
        return name + " " + self.v(base, plural)

    # ---- the person
    def noun(self, f):
        return self.pick("person", "person", "person", "individual", "subject", *(["pedestrian", "walker"] if f.walks else ["person", "human subject"]))

    def clothes(self, f):
        """A modifier that stands after a noun and needs no comma after it."""
        if f.wear is None:
            return ""
        top, low, pack = f.wear
        a, b, tr = self.col(top), self.col(low), self.trousers()
        if pack:
            return " " + self.pick(f"wearing {an(a)} top, {b} {tr} and a backpack", f"in {an(a)} top and {b} {tr} and carrying a backpack", f"with the {a} top, the {b} {tr} and the backpack",
                                   f"({a} top, {b} {tr}, backpack)", f"with a backpack, {an(a)} top and {b} {tr}", f"dressed in {an(a)} top and {b} {tr} and wearing a backpack",
                                   f"carrying a backpack and dressed in {an(a)} top with {b} {tr}", f"who has {an(a)} top, {b} {tr} and a backpack", f"with {an(a)} top over {b} {tr} and a backpack on the shoulders",
                                   f"wearing a backpack along with {an(a)} top and {b} {tr}", f"(top: {a}; {tr}: {b}; backpack: yes)",
                                   f"in {an(a)} top, {b} {tr} and a backpack")
        if a == b:
            return " " + self.pick(f"in {an(a)} top and {a} {tr}", f"wearing {an(a)} top and {tr} of the same {a}", f"whose top and {tr} are both {a}", f"(top and {tr} both {a})", f"dressed in a top and {tr} that are both {a}", f"in matching {a} top and {tr}")
        return " " + self.pick(f"in {an(a)} top and {b} {tr}", f"wearing {an(a)} top and {b} {tr}", f"dressed in {an(a)} top with {b} {tr}", f"({a} top, {b} {tr}, no backpack)", f"with the {a} top and the {b} {tr}", f"wearing {b} {tr} and {an(a)} top",
                               f"whose top is {a} and whose {tr} are {b}", f"in {b} {tr} and {an(a)} top", f"without a backpack who has {an(a)} top and {b} {tr} on", f"clad in {an(a)} top and {b} {tr}", f"(top: {a}; {tr}: {b})", f"with {an(a)} top over {b} {tr}")

    def who(self, f, article="the"):
        return article + " " + self.noun(f) + self.clothes(f) if article != "a" else an(self.noun(f)) + self.clothes(f)

    def tag(self, f):
        """Notes on the person."""
        if f.wear is None:
            return self.pick("one person", "a single person", "one individual", "the person on foot" if f.walks else "the person standing there")
        top, low, pack = f.wear
        a, b, tr = self.col(top), self.col(low), self.trousers()
        bag = self.pick(", backpack", ", with backpack", " + backpack", ", carrying a backpack") if pack else self.pick("", "", ", no backpack", ", without backpack")
        return self.pick(f"person, {a} top, {b} {tr}{bag}", f"one person in {an(a)} top and {b} {tr}{bag}", f"{a} top, {b} {tr}{bag}", f"person with {a} top / {b} {tr}{bag}", f"individual wearing {a} (top) and {b} ({tr}){bag}")

    def look(self, f):
        """A sentence on the clothes (instruction)."""
        if f.wear is None:
            return ""
        top, low, pack = f.wear
        a, b, tr = self.col(top), self.col(low), self.trousers()
        bag = " and a backpack" if pack else ""
        it = f"{an(a)} top, {b} {tr}{bag}" if pack else f"{an(a)} top and {b} {tr}"
        return self.pick(f"Look for {it}.", f"You can recognise them by {it}." if not self.us else f"You can recognize them by {it}.", f"You'll know them by {it}.", f"Their top is {a}, their {tr} are {b}" + (", and they have a backpack." if pack else "."),
                         f"The identifying features are {it}.", f"The top is {a} and the {tr} are {b}" + ("; there is also a backpack." if pack else self.pick(".", "; there is no backpack.")), f"For identification: {a} top, {b} {tr}" + (", backpack." if pack else "."), f"What they wear is {it}.")

    # ---- distance
    def dist_phrase(self, f):
        m = self.metres(f.distance)
        return self.pick(f"at a distance of {m}", f"from {m} away", f"from a distance of {m}", f"with {m} between the drone and the person", f"at a range of {m}", f"with a separation of {m}", f"at a drone-to-person distance of {m}", f"from about {m} away",
                         f"at a line-of-sight distance of {m}", f"with a gap of {m} between drone and person", f"at a slant range of {m}", f"from a point {m} away")

    def far(self, f):
        """The distance phrase after a noun with clothes."""
        p = self.dist_phrase(f)
        return (", " if p.startswith("with") or self.rng.random() < .5 else " ") + p

    def dist_order(self, f):
        m = self.metres(f.distance)
        return self.pick(f"Stay {m} away from them.", f"Hold a distance of {m} to the person.", f"Leave {m} between the drone and the person.", f"The gap between you and the person should be {m}.", f"{cap(m)} is the distance to keep from the person.", f"Make sure the drone remains {m} from the person.",
                         f"The distance to be held is {m}.", f"Keep the aircraft at a slant range of {m} from the subject.", f"A separation of {m} is to be maintained.", f"As for distance, {m} from the person is what we need.", f"Your range to the subject is {m}; please keep it.", f"Don't drift from a distance of {m} to the person.", f"How far away? Keep to {m}.")

    def dist_report(self, f):
        m = self.metres(f.distance)
        a = self.tense == "past"
        return self.pick(f"The mean distance between drone and person {self.v('be')} {m}.", f"On average, {m} {self.v('separate', True)} the drone from the person.", f"The drone {self.v('keep')} about {m} away from them.", f"A distance of about {m} to the person {self.v('be')} maintained.",
                         f"The slant range to the subject {self.v('average')} {m}.", f"Between the drone and the person there {self.v('be', f.distance != 1)} {m} on average.", f"Measured along the line of sight, the person {self.v('be')} {m} away.", f"The camera {self.v('film')} them from {m} away.",
                         f"Drone and person {self.v('be', True)} {m} apart on average.", f"The separation, averaged over the flight, {self.v('come')} to {m}.", f"The drone {self.v('be')} {m} from the person.", f"The average stand-off {self.v('be')} {m}.")

    # ---- camera pitch
    def pitch_phrase(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"with the camera tilted {d} down", f"with the lens {d} below the horizon", f"with the camera pointing {d} downward", f"with the gimbal pitched down by {d}", f"with a downward camera tilt of {d}", f"with a camera depression angle of {d}", f"with the camera aimed {d} below horizontal",
                             f"with the camera looking down at an angle of {d}", f"with the camera axis lowered {d} from the horizontal", f"with the camera angled down {d}", f"with the lens dipped by {d}", f"with the camera looking {d} below the horizon")
        if f.pitch < 0:
            return self.pick(f"with the camera tilted {d} up", f"with the lens {d} above the horizon", f"with the camera pointing {d} upward", f"with the gimbal pitched up by {d}", f"with an upward camera tilt of {d}", f"with the camera aimed {d} above horizontal", f"with the camera looking up at an angle of {d}",
                             f"with the camera axis raised {d} from the horizontal", f"with the camera angled up {d}", f"with the camera looking {d} above the horizon", f"with the lens raised by {d} above level")
        return self.pick("with the camera level", "with the lens aimed straight at the horizon", "with no camera tilt, neither up nor down", f"with the camera pitch at {self.degs(0)}", "with the gimbal exactly horizontal", "with the camera axis horizontal", "with the camera kept level", "with the camera looking neither up nor down", "with a level line of sight",
                         "with the camera held horizontally", "with the tilt set to zero")

    def pitch_order(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"Tilt the camera {d} downward.", f"Set the gimbal to {d} below the horizon.", f"The camera should point {d} below horizontal.", f"Have the lens look down at {d}.", f"Point the camera down by {d}.", f"The required camera angle is {d} downward.", f"{cap(d)} of downward tilt is right for the camera.",
                             f"Camera pitch is to be held at {d} below the horizon.", f"Lower the view by {d} from level.", f"For the camera, use a depression angle of {d}.", f"The angle of the camera: {d} down.", f"Angle the lens so that it looks {d} under the horizon.")
        if f.pitch < 0:
            return self.pick(f"Tilt the camera {d} upward.", f"Set the gimbal to {d} above the horizon.", f"The camera should point {d} above horizontal.", f"Have the lens look up at {d}.", f"Point the camera up by {d}.", f"The required camera angle is {d} upward.", f"{cap(d)} of upward tilt is right for the camera.",
                             f"Camera pitch is to be held at {d} above the horizon.", f"Raise the view by {d} from level.", f"The angle of the camera: {d} up.", f"Angle the lens so that it looks {d} over the horizon.")
        return self.pick("Keep the camera level.", "Set the gimbal to horizontal.", "The camera should look straight at the horizon.", f"Leave the camera pitch at {self.degs(0)}.", "Do not tilt the camera up or down.", "The required camera angle is zero: a level view.", "Have the lens look out horizontally.", "Camera tilt is to be held at zero.", "Level the lens with the horizon.",
                         "For the camera, use a horizontal line of sight.")

    def pitch_report(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"The camera {self.v('be')} tilted {d} down.", f"The lens {self.v('point')} {d} below the horizon.", f"The gimbal {self.v('be')} pitched {d} downward.", f"A downward tilt of {d} {self.v('be')} used for the camera.", f"The camera {self.v('look')} down at an angle of {d}.", f"The depression angle of the camera {self.v('be')} {d}.",
                             f"At {d} below horizontal, the camera {self.v('look')} down.", f"The optical axis {self.v('lie')} {d} below the horizontal.", f"The view {self.v('be')} directed {d} downward.", f"The camera {self.v('have')} a pitch of {d} below the horizon.", f"The camera's downward angle {self.v('come')} to {d}.")
        if f.pitch < 0:
            return self.pick(f"The camera {self.v('be')} tilted {d} up.", f"The lens {self.v('point')} {d} above the horizon.", f"The gimbal {self.v('be')} pitched {d} upward.", f"An upward tilt of {d} {self.v('be')} used for the camera.", f"The camera {self.v('look')} up at an angle of {d}.", f"At {d} above horizontal, the camera {self.v('look')} up.",
                             f"The optical axis {self.v('lie')} {d} above the horizontal.", f"The view {self.v('be')} directed {d} upward.", f"The camera {self.v('have')} a pitch of {d} above the horizon.", f"The camera's upward angle {self.v('come')} to {d}.")
        return self.pick(f"The camera {self.v('be')} level.", f"The lens {self.v('point')} straight at the horizon.", f"The gimbal {self.v('be')} kept horizontal.", f"No camera tilt {self.v('be')} used.", f"The camera {self.v('look')} neither up nor down.", f"The camera pitch {self.v('be')} {self.degs(0)}.", f"The optical axis {self.v('be')} horizontal.",
                         f"The line of sight of the camera {self.v('be')} level.", f"The camera {self.v('be')} held at zero tilt.", f"The view {self.v('be')} level with the horizon.")

    def pitch_note(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch == 0:
            return self.pick("level", "horizontal", f"{self.degs(0)} (level)", "zero tilt", "at the horizon")
        way, side = ("down", "below") if f.pitch > 0 else ("up", "above")
        return self.pick(f"{d} {way}", f"{d} {side} the horizon", f"{d} {way}ward", f"tilted {way} {d}", f"{way} by {d}", f"{d} {side} horizontal")

    # ---- altitude
    def height_phrase(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"with the drone flying {m} above the person's feet", f"at a height of {m} above the person's feet", f"from {m} up, measured from the person's feet", f"at {m} above the level of the person's feet", f"with the drone {m} higher than the ground at the person's feet", f"at an altitude of {m} over the person's feet", f"with the drone {m} above their feet")

    def height_order(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"Fly {m} above the person's feet.", f"Your height above the person's feet should be {m}.", f"Take the drone to {m} above the level of the person's feet.", f"Hold an altitude of {m}, measured from the person's feet.", f"The flying height is {m} above the person's feet.", f"Stay {m} higher than the ground at the person's feet.",
                         f"An altitude of {m} above their feet is required.", f"As to height, be {m} above the person's feet.", f"{cap(m)} above the person's feet is the right altitude.", f"Keep the aircraft {m} over the level at which the person's feet are.")

    def height_report(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"The drone {self.v('fly')} {m} above the person's feet.", f"The drone's height above the person's feet {self.v('be')} {m}.", f"The drone's altitude {self.v('be')} {m}, measured from the person's feet.", f"Measured from the person's feet, the aircraft {self.v('be')} {m} up.", f"A height of {m} above the person's feet {self.v('be')} flown.",
                         f"The flying height {self.v('be')} {m} above the level of the person's feet.", f"Altitude over the person's feet {self.v('come')} to {m}.", f"The aircraft {self.v('be')} {m} higher than the ground at the person's feet.", f"From the person's feet up to the drone it {self.v('be')} {m}.", f"{cap(m)} above the person's feet {self.v('be')} the drone's altitude.")

    # ---- turns
    def way_word(self, t):
        return t

    def turn_adverbs(self, f):
        """left, then right and finally around"""
        t = f.turns
        n = len(t)
        if n == 1:
            return t[0] + self.pick("", " once", " a single time")
        if len(set(t)) == 1:
            return f"{t[0]} {times(n)}"
        if n == 2:
            return self.pick(f"{t[0]} and then {t[1]}", f"{t[0]}, then {t[1]}", f"first {t[0]} and afterwards {t[1]}", f"{t[0]}, later {t[1]}", f"first {t[0]}, then {t[1]}")
        return self.pick(", then ".join(t), "first " + ", then ".join(t[:-1]) + " and finally " + t[-1], ", ".join(t[:-1]) + " and " + t[-1] + ", in that order",
                         ", then ".join(a if k == 1 else f"{a} {times(k)}" for a, k in runs(t)), "first " + ", next ".join(t[:-1]) + " and last of all " + t[-1])

    def turn_nouns(self, f, tail=True):
        """a left turn, a right turn and a U-turn"""
        uturn = self.pick("U-turn", "turn-around", "about-turn")
        one = dict(left="left turn", right="right turn", around=uturn)

        def name(t, k=1):
            if k > 1:
                return f"{words(k)} {one[t]}s"
            return "an about-turn" if one[t] == "about-turn" else "a " + one[t]
        t = f.turns
        if len(set(t)) == 1:
            return name(t[0], len(t)) if len(t) > 1 else self.pick("one ", "a single ", "just one ") + one[t[0]]
        if len(t) == 2:
            return self.pick(f"{name(t[0])} and then {name(t[1])}", f"{name(t[0])} followed by {name(t[1])}", f"{name(t[0])}, later {name(t[1])}")
        return self.pick(", then ".join(name(x) for x in t), ", ".join(name(x) for x in t[:-1]) + " and finally " + name(t[-1]), ", then ".join(name(a, k) for a, k in runs(t)), listing([name(x) for x in t]) + (", in this order" if tail else ""))

    def turn_note(self, f):
        t = f.turns
        n = len(t)
        if not n:
            return self.pick("none", "no turns", "0", "not one")
        if n == 1:
            return self.pick(f"1 ({t[0]})", f"one, {t[0]}", f"{t[0]} once", f"{t[0]} (only one)")
        sep = self.pick(", ", " - ", " > ", ", then ", " / ", " → ")
        seq = sep.join(t)
        return self.pick(seq, f"{n} ({seq})", f"{words(n)}: {seq}", f"{seq} ({words(n)} in all)", " ".join(f"({i + 1}) {x}" for i, x in enumerate(t)))

    def turns_sentence(self, f):
        n = len(f.turns)
        if not n:
            return cap(self.pick(f"{self.sv(f, 'make')} no turns.", f"there {self.v('be')} no turn anywhere in the walk.", f"the walk {self.v('contain')} no turns.", f"not a single turn {self.v('be')} made.", f"{self.sv(f, 'walk')} without turning anywhere.", f"the route {self.v('have')} no turns in it.",
                                 f"{self.sv(f, 'keep')} going without making a turn.", f"as for turns, there {self.v('be', True)} none.", f"no turns {self.v('be', True)} made on the way.", f"{self.sv(f, 'take')} neither a left nor a right turn and {self.v('do', False) + ' not turn' if self.tense != 'fut' else 'will not turn'} around.".replace("they take neither a left nor a right turn and does", "they take neither a left nor a right turn and do")))
        count = f"{words(n)} turn" + ("" if n == 1 else "s")
        seq = listing(f.turns)
        plain = ", ".join(f.turns)
        forms = [f"{self.sv(f, 'turn')} {self.turn_adverbs(f)}.", f"{self.sv(f, 'make')} {self.turn_nouns(f)}.", f"on the way {self.sv(f, 'turn')} {self.turn_adverbs(f)}.", f"the walk {self.v('include')} {self.turn_nouns(f)}.", f"what the walk {self.v('have')} in the way of turns {self.v('be')} {self.turn_nouns(f)}.",
                 f"along the way, {self.sv(f, 'make')} {self.turn_nouns(f)}.", f"there {self.v('be', n > 1)} {count} in all: {plain}." if n > 1 else f"there {self.v('be')} just one turn: {plain}.", f"during the walk {self.sv(f, 'turn')} {self.turn_adverbs(f)}.", f"{self.sv(f, 'make')} {count} ({plain}).", f"seen from the walker's side, the sequence of turns {self.v('be')} {plain}." if n > 1 else f"the only turn {self.v('be')} to the {f.turns[0]}." if f.turns[0] != "around" else f"the only turn {self.v('be')} a U-turn."]
        if n > 1 and n <= 6:
            forms += ["; ".join(("the " + ORD[i] + " turn " + (self.v("go") + " " if i == 0 else "goes " if self.tense == "pres" else "went " if self.tense == "past" else "")) + x if i == 0 else f"the {ORD[i]} {x}" for i, x in enumerate(f.turns)) + ".",
                      f"{count} {self.v('be', True)} made: {plain}.", f"the turns, in order, {self.v('be', True)} {seq}.", f"{count} {self.v('come', True)} in this order: {plain}."]
        return cap(self.pick(*forms))

    def turns_phrase(self, f):
        if not f.turns:
            return self.pick("making no turns", "without a single turn", "without turning anywhere", "with no turns on the way", "never making a turn")
        return self.pick(f"turning {self.turn_adverbs(f)}", f"making {self.turn_nouns(f, False)}", f"with {self.turn_nouns(f, False)} on the way", f"making {words(len(f.turns))} turn{'s' if len(f.turns) > 1 else ''} ({', '.join(f.turns)})")

    # ---- stops
    def total(self, f):
        s = self.secs(f.standing)
        if f.standing < 1:
            return ""
        if f.stops == 1:
            return self.pick(f" for {s}", f", for {s}", f", lasting {s}", f" ({s})")
        return self.pick(f", for {s} in total", f" for a total of {s}", f" ({s} altogether)", f", {s} in all", f", {s} taken together", f", adding up to {s}")

    def stops_sentence(self, f):
        n = f.stops
        if not n:
            return cap(self.pick(f"{self.sv(f, 'walk')} without stopping.", f"there {self.v('be', True)} no pauses.", f"{self.sv(f, 'make')} no stops.", f"no pause {self.v('be')} made.", f"the walk {self.v('have')} no pauses.", f"at no point {'do they pause' if self.tense == 'pres' else 'did they pause' if self.tense == 'past' else 'will they pause'}.", f"{self.sv(f, 'keep')} walking the whole time.",
                                 f"not one stop {self.v('be')} made on the way.", f"the walk {self.v('go')} on without a break.", f"the number of stops {self.v('be')} zero."))
        c = f"{words(n)} " + self.pick("pause", "stop") + ("" if n == 1 else "s")
        s = self.secs(f.standing)
        forms = [f"{self.sv(f, 'stop')} {times(n)}{self.total(f)}.", f"{self.sv(f, 'pause')} {times(n)}{self.total(f)}.", f"on the way {self.sv(f, 'make')} {c}{self.total(f)}.", f"there {self.v('be', n > 1)} {c}{self.total(f)}.", f"the walk {self.v('be')} interrupted {times(n)}{self.total(f)}."]
        if f.standing >= 1:
            if n == 1:
                forms += [f"one pause of {s} {self.v('be')} made.", f"the only stop {self.v('take')} {s}.", f"{self.sv(f, 'stand')} still once, for {s}.", f"{self.sv(f, 'make')} a single stop of {s}.", f"a single pause {self.v('last')} {s}.", f"the one pause of the walk {self.v('take')} {s}."]
            else:
                forms += [f"{c} together {self.v('take', True)} {s}.", f"{s} of standing still {self.v('be', True)} spread over {c}.", f"in {c} {self.sv(f, 'stand')} still for {s} altogether.", f"{self.sv(f, 'make')} {c}, which {self.v('add', True)} up to {s}.", f"of the whole time, {s} {self.v('be', True)} spent standing, in {c}.", f"the person {self.v('come')} to a halt {times(n)}; together these halts {self.v('take', True)} {s}."]
        return cap(self.pick(*forms))

    def stops_phrase(self, f):
        n = f.stops
        if not n:
            return self.pick("without stopping", "never pausing", "making no stops", "with no pauses", "without a pause")
        t = "" if f.standing < 1 else f" ({self.secs(f.standing)}" + (")" if n == 1 else " in all)")
        return self.pick(f"pausing {times(n)}{t}", f"stopping {times(n)}{t}", f"with {words(n)} {'pause' if n == 1 else 'pauses'}{t}", f"making {words(n)} {'stop' if n == 1 else 'stops'}{t}")

    def stops_note(self, f):
        if not f.stops:
            return self.pick("none", "0", "no stops", "no pauses")
        s = self.secs(f.standing)
        if f.standing < 1:
            return str(f.stops)
        return self.pick(f"{f.stops} ({s} {'long' if f.stops == 1 else 'in total'})", f"{f.stops}, {'lasting' if f.stops == 1 else 'together'} {s}", f"{words(f.stops)}, {'duration' if f.stops == 1 else 'total standing time'} {s}")

    # ---- way, time, speed
    def way_sentence(self, f):
        m = self.metres(f.way)
        pl = f.way != 1
        return cap(self.pick(f"{self.sv(f, 'walk')} {m} in all.", f"the whole walk {self.v('be')} {m} long.", f"{m} {self.v('be', pl)} covered on foot.", f"{self.sv(f, 'cover')} {m}.", f"the length of the walk {self.v('be')} {m}.", f"the way that {self.sv(f, 'take')} {self.v('be')} {m} long.", f"in total, {self.sv(f, 'go')} {m} on foot.", f"the path walked {self.v('measure')} {m}.",
                             f"it {self.v('be')} a walk of {m}.", f"a total of {m} {self.v('be')} walked.", f"the person's path {self.v('add')} up to {m}."))

    def time_sentence(self, f):
        s = self.secs(f.duration)
        return cap(self.pick(f"the flight {self.v('last')} {s}.", f"the whole flight {self.v('take')} {s}.", f"the duration of the flight {self.v('be')} {s}.", f"from start to finish it {self.v('take')} {s}.", f"{s} {self.v('be')} the length of the flight.", f"the recording {self.v('run')} for {s}.", f"flight time {self.v('be')} {s}.", f"the filming {self.v('go')} on for {s}.",
                             f"all this {self.v('take')} {s}.", f"the drone {self.v('film')} for {s}."))

    def time_order(self, f):
        s = self.secs(f.duration)
        return self.pick(f"Keep this up for {s}.", f"The flight should last {s}.", f"Film for {s}.", f"Flight time: {s}.", f"Plan for {s} in the air with the person on camera.", f"After {s} the job is done.", f"The whole flight takes {s}.", f"You will be filming for {s}.", f"Carry on until {s} have passed." if f.duration != 1 else f"Carry on for {s}.", f"Allow {s} for the flight.")

    def speed_sentence(self, f):
        v = self.mps(f)
        return cap(self.pick(f"their mean walking speed {self.v('be')} {v}.", f"on average {self.sv(f, 'move')} at {v}.", f"the walking pace {self.v('average')} {v}.", f"the average speed on foot {self.v('be')} {v}.", f"{self.sv(f, 'do')} {v} on average.", f"the mean pace {self.v('come')} to {v}.", f"an average walking speed of {v} {self.v('be')} " + ("to be expected." if self.tense == "fut" else "recorded.") if self.tense != "fut" else f"expect a mean walking speed of {v}.",
                             f"at an average of {v} {self.sv(f, 'go')} on foot.", f"{self.sv(f, 'move')} at a mean speed of {v}.", f"walking speed, averaged, {self.v('be')} {v}."))

    def length_sentence(self, f):
        """Way, time and speed in one."""
        m, s, v = self.metres(f.way), self.secs(f.duration), self.mps(f)
        return cap(self.pick(f"in {s} {self.sv(f, 'walk')} {m}, at a mean speed of {v}.", f"{self.sv(f, 'cover')} {m} during the {s} of the flight, at {v} on average.", f"the walk {self.v('be')} {m} long, the flight {self.v('last')} {s}, and the average walking speed {self.v('be')} {v}.", f"with a mean walking speed of {v}, {self.sv(f, 'cover')} {m} in {s}.",
                             f"a flight of {s} {self.v('show')} a walk of {m} at an average of {v}.", f"{m} {self.v('be', True)} walked in {s}, the mean walking speed being {v}.", f"it {self.v('take')} {s} for the {m} of the walk; the walking speed {self.v('average')} {v}.", f"during the flight, which {self.v('last')} {s}, {self.sv(f, 'walk')} {m} at an average speed of {v}.",
                             f"{m} of walking, {s} of flying, {v} as the mean walking speed: those {self.v('be', True)} the totals."))

    # ---- standing
    def stands_sentence(self, f, timed=False):
        s = self.secs(f.duration)
        if timed:
            return cap(self.pick(f"{self.sv(f, 'stand')} on one spot for the whole {s} of the flight.", f"for all {s} {self.sv(f, 'stand')} in the same place.", f"{self.sv(f, 'do') + ' not leave' if self.tense != 'fut' else 'they will not leave'} the spot during the {s} of the flight.", f"throughout the flight, which {self.v('last')} {s}, {self.sv(f, 'stand')} still.", f"the flight {self.v('last')} {s}, and all that time {self.sv(f, 'remain')} standing on one spot.",
                                 f"{self.sv(f, 'stand')} there for {s}, without walking a step.", f"without taking a step, {self.sv(f, 'stand')} on one spot for {s}.", f"no walking {self.v('be')} done; {self.sv(f, 'stand')} on the same spot for {s}.", f"from beginning to end, {s} in all, {self.sv(f, 'stand')} on one spot.",
                                 f"for {s} {self.sv(f, 'keep')} standing on one and the same spot.", f"{self.sv(f, 'remain')} standing where {'they are' if self.tense == 'pres' else 'they were' if self.tense == 'past' else 'they are'} for the full {s}."))
        return cap(self.pick(f"{self.sv(f, 'stand')} on one spot the whole time.", f"{self.sv(f, 'stand')} still throughout.", f"there {self.v('be')} no walking: {self.sv(f, 'remain')} standing on one spot.", f"{self.sv(f, 'remain')} standing in the same place from beginning to end.", f"{self.sv(f, 'do') + ' not walk at all' if self.tense != 'fut' else 'they will not walk at all'}; {self.sv(f, 'stand')} still.",
                             f"the person {self.v('be')} standing still the entire time.", f"not a step {self.v('be')} taken; {self.sv(f, 'stand')} in one place.", f"{self.sv(f, 'remain')} on the same spot, standing.", f"standing on one spot {self.v('be')} all that the person {'does' if self.tense != 'past' else 'did'}.", f"{self.sv(f, 'keep')} standing on one and the same spot."))

    # ---- instruction
    def follow(self, f, who):
        if who == "them" and self.rng.random() < .1:
            return "keep them in view"
        if f.walks:
            return self.pick(f"follow {who}", f"track {who}", f"keep the camera on {who}", f"film {who}", f"follow and film {who}", f"fly along with {who}", f"accompany {who}", f"keep in view {who}" if who != "them" else "keep them in view", f"stay with {who}", f"go along with {who}")
        return self.pick(f"film {who}", f"keep the camera on {who}", f"keep in view {who}" if who != "them" else "keep them in view", f"observe {who}", f"record {who}", f"watch {who}", f"take footage of {who}", f"point the camera at {who}", f"shoot {who}", f"stay with {who}")

    def target(self, f):
        who = self.who(f)
        if f.walks or self.rng.random() < .4:
            return who
        return self.pick(who + " who is standing on one spot" if not f.wear else who.replace(" ", " standing ", 1), "the standing " + self.noun(f) + self.clothes(f), "the stationary " + self.noun(f) + self.clothes(f))

    def extras(self, f, limit=5):
        """Some more sentences of an instruction."""
        pool = [self.time_order(f)]
        if f.altitude >= 1:
            pool.append(self.height_order(f))
        if f.walks:
            pool += [self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.speed_sentence(f)]
        else:
            pool += [self.stands_sentence(f)]
        self.rng.shuffle(pool)
        return pool[: self.rng.randint(0, min(limit, len(pool)))]

    def instruction(self, f):
        self.start(self.pick("fut", "fut", "pres"))
        kind = self.pick(self.i_order, self.i_friendly, self.i_numbered, self.i_long, self.i_telegram, self.i_question, self.i_numbers_first, self.i_preview, self.i_need, self.i_bullets, self.i_passive, self.i_plain, self.i_checklist)
        return kind(f)

    def i_order(self, f):
        head = self.pick("Mission order: ", "Tasking: ", "Orders for the aircraft: ", "Mission objective: ", "Assignment: ")
        body = [self.pick(f"The unit will {self.follow(f, self.target(f))}.", f"{cap(self.follow(f, self.target(f)))}.", f"You are to {self.follow(f, self.target(f))}.", f"The aircraft shall {self.follow(f, self.target(f))}."),
                self.pick(f"Maintain a slant range of {self.metres(f.distance)}.", self.dist_order(f)), self.pitch_order(f)]
        return head + " ".join(body + self.extras(f))

    def i_friendly(self, f):
        hello = self.pick("Hi there! ", "Hello, pilot! ", "Sure, here is what I'd like you to do: ", "Hey! ", "Okay, here's the plan. ", "Happy to have you on board! ", "")
        ask = self.pick(f"Please {self.follow(f, self.target(f))}{self.far(f)}.", f"I'd like you to {self.follow(f, self.target(f))}{self.far(f)}.", f"Could you please {self.follow(f, self.target(f))}{self.far(f)}?", f"Let's {self.follow(f, self.target(f))}{self.far(f)}.")
        if hello.endswith(": "):
            ask = f"{self.follow(f, self.target(f))}{self.far(f)}."
        rest = [self.pitch_order(f)] + self.extras(f)
        return hello + ask + " " + " ".join(rest) + self.pick("", " Thank you!", " Thanks a lot!", "")

    def i_numbered(self, f):
        w = self.pick("them", "the person")
        steps = [self.pick(f"Find {self.target(f)}.", f"Identify {self.target(f)}.", f"Locate {self.target(f)}.", f"Pick out {self.target(f)}."),
                 self.dist_order(f), self.pitch_order(f)]
        more = self.extras(f, 4)
        if self.rng.random() < .5:
            steps.append(cap(self.follow(f, w)) + ".")
        steps += more
        mark = self.pick("{}. ", "{}) ", "({}) ", "Step {}: ")
        sep = self.pick("\n", " ", " ")
        return sep.join(mark.format(i + 1) + x for i, x in enumerate(steps))

    def i_long(self, f):
        parts = [self.dist_phrase(f), self.pitch_phrase(f)]
        if f.altitude >= 1 and self.rng.random() < .6:
            parts.insert(self.rng.randint(0, 2), self.height_phrase(f))
        text = cap(self.follow(f, self.target(f))) + (", " if parts[0].startswith("with") else self.pick(" ", ", ")) + ", ".join(parts[:-1]) + self.pick(", ", " and ") + parts[-1]
        if f.walks and self.rng.random() < .7:
            pro = self.pick("as they walk", "while they walk")
            tail = []
            if self.rng.random() < .6:
                tail.append(self.metres(f.way))
            mods = [m for m in (self.turns_phrase(f), self.stops_phrase(f)) if self.rng.random() < .6]
            text += f", {pro} " + ((tail[0] if tail else "on") + (", " if mods else ""))
            text += ", ".join(mods)
        if self.rng.random() < .5:
            text += self.pick(f", for {self.secs(f.duration)} in all", f", and keep doing so for {self.secs(f.duration)}", f", over a flight of {self.secs(f.duration)}")
        return text + "."

    def i_telegram(self, f):
        bits = [self.pick(f"distance {self.metres(f.distance)}", f"range {self.metres(f.distance)}", f"{self.metres(f.distance)} off", f"gap {self.metres(f.distance)}", f"stay {self.metres(f.distance)} away"),
                self.pick("camera ", "gimbal ", "lens ", "view ") + self.pitch_note(f)]
        if f.altitude >= 1 and self.rng.random() < .6:
            bits.append(f"{self.pick('height', 'altitude', 'drone')} {self.metres(f.altitude)} above person's feet")
        if f.walks:
            more = [f"turns: {self.turn_note(f)}", f"stops: {self.stops_note(f)}", f"walk {self.metres(f.way)}", f"mean walking speed {self.mps(f)}"]
            self.rng.shuffle(more)
            bits += more[: self.rng.randint(0, 4)]
        elif self.rng.random() < .6:
            bits.append(self.pick("person stands still", "person stays on one spot", "no walking"))
        if self.rng.random() < .5:
            bits.append(self.pick(f"time {self.secs(f.duration)}", f"duration {self.secs(f.duration)}", f"{self.secs(f.duration)} of flight"))
        sep = self.pick("; ", ". ", ", ")
        lead = self.pick("Follow ", "Track ", "Target: ", "On camera: ") if f.walks else self.pick("Film ", "Watch ", "Target: ", "On camera: ")
        if sep == ", ":
            bits = [b.replace(": ", " ", 1) if b.count(",") == 0 else b for b in bits]
            if any("," in b for b in bits):
                sep = "; "
        return lead + self.tag(f) + self.pick(". ", "; ") + (sep.join(cap(b) for b in bits) if sep == ". " else cap(sep.join(bits))) + "."

    def i_question(self, f):
        q = self.pick(f"Could you {self.follow(f, self.target(f))}{self.far(f)}, {self.pitch_phrase(f)}?", f"Would you mind flying {self.dist_phrase_short(f)} from {self.target(f)}, {self.pitch_phrase(f)}?", f"Can the drone {self.follow(f, self.target(f))}{self.far(f)}, {self.pitch_phrase(f)}?",
                      f"Do you see {self.target(f)}? {cap(self.follow(f, 'them'))} {self.dist_phrase(f)}, {self.pitch_phrase(f)}.", f"May I ask you to {self.follow(f, self.target(f))}{self.far(f)}? {self.pitch_order(f)}", f"Will you {self.follow(f, self.target(f))}{self.far(f)}, {self.pitch_phrase(f)}?")
        more = self.extras(f, 4)
        return " ".join([q] + more)

    def dist_phrase_short(self, f):
        return self.pick(f"{self.metres(f.distance)} away", f"at a distance of {self.metres(f.distance)}")

    def i_numbers_first(self, f):
        m = self.metres(f.distance)
        first = self.pick(f"From {m} away, {self.pitch_phrase(f)}, {self.follow(f, self.target(f))}.", f"{cap(m)} away from the person and {self.pitch_phrase(f)}: that is how to {self.follow(f, self.target(f))}.", f"{cap(self.pitch_phrase(f))}, {self.follow(f, self.target(f))}{self.far(f)}.",
                          f"Distance {m}, camera {self.pitch_note(f)}: {self.follow(f, self.target(f))}.", f"At a distance of {m}, {self.follow(f, self.target(f))}, {self.pitch_phrase(f)}.")
        return " ".join([first] + self.extras(f))

    def i_preview(self, f):
        """What the person will do first, then the orders."""
        if f.walks:
            v = self.v
            a = self.pick(f"{cap(self.who(f))} {v('walk')} {self.metres(f.way)}, {self.turns_phrase(f)}.", f"{cap(self.who(f))} {v('be')} the one to film. {self.turns_sentence(f)}", f"{cap(self.who(f))} {v('walk')} on, {self.stops_phrase(f)}. {self.turns_sentence(f)}", f"You will see {self.who(f, 'a')}. {self.way_sentence(f)}",
                          f"Expect {self.who(f)} to walk {self.metres(f.way)}, {self.stops_phrase(f)}.", f"Somebody is going for a walk: {self.who(f, 'a')}. {self.stops_sentence(f)}")
        else:
            a = self.pick(f"{cap(self.who(f))} {self.v('stand')} on one spot the whole time.", f"{cap(self.who(f))} {self.v('be')} the one to film. {self.stands_sentence(f)}", f"You will see {self.who(f, 'a')}. {self.stands_sentence(f)}", f"Expect {self.who(f)} to stand on one spot for {self.secs(f.duration)}.")
        b = self.pick(f"{cap(self.follow(f, 'them'))} {self.dist_phrase(f)}, {self.pitch_phrase(f)}.", f"Your part: {self.follow(f, 'them')} {self.dist_phrase(f)}, {self.pitch_phrase(f)}.", f"{self.dist_order(f)} {self.pitch_order(f)}", f"{self.pitch_order(f)} {self.dist_order(f)}")
        c = []
        if f.altitude >= 1 and self.rng.random() < .5:
            c.append(self.height_order(f))
        return " ".join([a, b] + c)

    def i_need(self, f):
        a = self.pick(f"We need footage of {self.target(f)}, taken {self.dist_phrase(f)}, {self.pitch_phrase(f)}.", f"The goal is a shot of {self.target(f)}{self.far(f)}. {self.pitch_order(f)}", f"What I want is {self.secs(f.duration)} of video of {self.target(f)}, shot from {self.metres(f.distance)} away, {self.pitch_phrase(f)}.",
                      f"This job calls for filming {self.target(f)}. {self.pitch_order(f)} {self.dist_order(f)}", f"For this recording {self.target(f)} must be on camera, the drone being {self.metres(f.distance)} away and the camera angle {self.pitch_note_of(f)}.", f"The aim: {self.target(f)} on video, {self.metres(f.distance)} away from the drone, {self.pitch_phrase(f)}.")
        return " ".join([a] + [x for x in self.extras(f, 4) if str(f.duration) not in x or str(f.duration) not in a])

    def pitch_note_of(self, f):
        d = self.degs(abs(f.pitch))
        return "level" if f.pitch == 0 else f"{d} below the horizon" if f.pitch > 0 else f"{d} above the horizon"

    def i_bullets(self, f):
        rows = [f"Subject: {self.tag(f)}", f"{self.pick('Distance', 'Range', 'Separation', 'Stand-off')}: {self.metres(f.distance)}", f"{self.pick('Camera', 'Camera angle', 'Gimbal', 'Camera tilt')}: {self.pitch_note(f)}"]
        more = [f"{self.pick('Duration', 'Flight time')}: {self.secs(f.duration)}"]
        if f.altitude >= 1:
            more.append(f"{self.pick('Height', 'Altitude')}: {self.metres(f.altitude)} above the person's feet")
        if f.walks:
            more += [f"Turns: {self.turn_note(f)}", f"{self.pick('Stops', 'Pauses')}: {self.stops_note(f)}", f"Length of the walk: {self.metres(f.way)}", f"Mean walking speed: {self.mps(f)}"]
        else:
            more += [self.pick("Movement: none, the person stands on one spot", "The person does not walk", "Person standing on one spot")]
        self.rng.shuffle(more)
        rows += more[: self.rng.randint(0, len(more))]
        head = self.pick("Flight plan", "Task for the drone", "Camera job", "Briefing", "Follow task" if f.walks else "Filming task")
        if self.rng.random() < .5:
            return head + ":\n" + "\n".join("- " + r for r in rows)
        return head + " - " + "; ".join(rows) + "."

    def i_passive(self, f):
        verb = self.pick("is to be followed", "must be kept on camera", "is to be filmed", "should be tracked by the drone") if f.walks else self.pick("is to be filmed", "must be kept on camera", "should be observed by the drone", "is to be recorded")
        a = f"{cap(self.who(f))} {verb}{self.far(f)}."
        d = self.degs(abs(f.pitch))
        b = self.pick("The camera is to be kept level.", "A horizontal camera is required.") if f.pitch == 0 else self.pick(f"The camera is to be {'lowered' if f.pitch > 0 else 'raised'} {d} from the horizontal.", f"A camera angle of {d} {'below' if f.pitch > 0 else 'above'} the horizon is required.", f"The lens must be tilted {'down' if f.pitch > 0 else 'up'} by {d}.")
        return " ".join([a, b] + self.extras(f))

    def i_plain(self, f):
        parts = [self.dist_order(f), self.pitch_order(f)]
        ex = self.extras(f, 3)
        parts += ex
        self.rng.shuffle(parts)
        return " ".join([cap(self.follow(f, self.pick("the person", "one person", "the " + self.noun(f)))) + "."] + [x for x in [self.look(f)] if x] + parts)

    def i_checklist(self, f):
        a = self.pick("Before you start, note three things.", "Three settings matter.", "Three points, please.")
        b = self.pick(f"First, the target: {self.tag(f)}.", f"First, the one to film is {self.who(f)}.", f"First, the one on camera is {self.who(f)}.")
        c = self.pick(f"Second, the distance: {self.metres(f.distance)}.", f"Second, you stay {self.metres(f.distance)} away.", f"Second, the drone keeps {self.metres(f.distance)} from the person.")
        d = self.pick(f"Third, the camera: {self.pitch_note(f)}.", f"Third, the camera angle, which is {self.pitch_note_of(f)}.")
        e = self.extras(f, 3)
        return " ".join([a, b, c, d] + e)

    # ---- description
    def description(self, f):
        self.start(self.pick("past", "past", "past", "pres"))
        if not f.walks:
            return self.pick(self.s_report, self.s_story, self.s_long, self.s_numbers, self.s_telegram, self.s_qa, self.s_list, self.s_drone_first, self.s_recap)(f)
        return self.pick(self.d_report, self.d_story, self.d_long, self.d_drone_first, self.d_numbers, self.d_telegram, self.d_list, self.d_recap, self.d_qa, self.d_two, self.d_summary, self.d_engineer)(f)

    def geometry(self, f):
        """Sentences on distance, pitch and height."""
        h = f.altitude >= 1
        if self.rng.random() < .45:
            bits = [self.dist_phrase(f), self.pitch_phrase(f)] + ([self.height_phrase(f)] if h else [])
            self.rng.shuffle(bits)
            return [self.pick(f"The drone {self.v('film')} them {', '.join(bits)}.", f"Filming {self.v('be')} done {', '.join(bits)}.", f"The footage {self.v('be')} taken {', '.join(bits)}.", f"The aircraft {self.v('film')} the scene {', '.join(bits)}.")]
        out = [self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if h else [])
        self.rng.shuffle(out)
        return out

    def action(self, f):
        """Sentences on way, duration, speed."""
        if self.rng.random() < .5:
            return [self.length_sentence(f)]
        out = [self.way_sentence(f), self.time_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(out)
        return out

    def opening(self, f):
        who = self.who(f)
        a = self.who(f, "a")
        if f.walks:
            return self.pick(f"The drone {self.v('follow')} {a}.", f"{cap(a)} {self.v('be')} followed by a camera drone.", f"The flight {self.v('show')} {a} on a walk.", f"In this flight {a} {self.v('be')} filmed while walking.", f"The one followed {self.v('be')} {a}.", f"On camera {self.v('be')} {a}.", f"The one filmed {self.v('be')} {a}.", f"It {self.v('be')} {a} that the drone {self.v('follow')}.",
                         f"The camera drone {self.v('keep')} in view {a}.", f"Throughout the flight {who} {self.v('be')} accompanied by the drone.", f"{cap(a)} {self.v('walk')} along, and the drone {self.v('go')} too.")
        return self.pick(f"The drone {self.v('film')} {a}.", f"{cap(a)} {self.v('be')} filmed by a camera drone.", f"The flight {self.v('show')} {a}.", f"On camera {self.v('be')} {a}.", f"The one filmed {self.v('be')} {a}.", f"It {self.v('be')} {a} that the drone {self.v('film')}.", f"The camera drone {self.v('keep')} in view {a}.", f"Throughout the flight {who} {self.v('be')} on camera.")

    def d_report(self, f):
        head = self.pick("Flight report. ", "Post-flight report: ", "Flight summary. ", "Report on the flight. ", "")
        return head + " ".join([self.opening(f)] + self.action(f) + [self.turns_sentence(f), self.stops_sentence(f)] + self.geometry(f))

    def d_story(self, f):
        mid = [self.turns_sentence(f), self.stops_sentence(f)]
        self.rng.shuffle(mid)
        who = self.who(f, "a")
        first = self.pick(f"{cap(who)} {self.v('walk')} {self.metres(f.way)} while a drone {self.v('follow')}.", f"{cap(who)} {self.v('go')} for a walk of {self.metres(f.way)}, with a drone following.", f"Followed by a drone, {who} {self.v('walk')} {self.metres(f.way)}.")
        rest = [self.time_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(rest)
        return " ".join([first] + mid + rest + self.geometry(f))

    def d_long(self, f):
        who = self.who(f, "a")
        mods = [self.turns_phrase(f), self.stops_phrase(f)]
        self.rng.shuffle(mods)
        v = self.v
        geo = [self.dist_phrase(f), self.pitch_phrase(f)] + ([self.height_phrase(f)] if f.altitude >= 1 else [])
        self.rng.shuffle(geo)
        s, m, sp = self.secs(f.duration), self.metres(f.way), self.mps(f)
        return self.pick(f"In a flight of {s}, {who} {v('walk')} {m} at an average of {sp}, {mods[0]}, {mods[1]}, while the drone {v('film')} {', '.join(geo)}.",
                         f"During the {s} of this flight the drone {v('film')} {who}, {', '.join(geo)}, as the person {v('cover')} {m} at a mean speed of {sp}, {mods[0]}, {mods[1]}.",
                         f"{cap(who)} {v('cover')} {m}, {mods[0]}, {mods[1]}, and walking at {sp} on average, all in a flight of {s} that {v('be')} filmed {', '.join(geo)}.",
                         f"While {who} {v('walk')} {m} at a mean speed of {sp}, {mods[0]}, {mods[1]}, the drone {v('follow')} for {s}, filming {', '.join(geo)}.")

    def d_drone_first(self, f):
        d = self.pick(f"A camera drone {self.v('fly')} {self.dist_phrase_short(f)} from {self.who(f, 'a')}, {self.pitch_phrase(f)}.", f"For {self.secs(f.duration)} a drone {self.v('film')} {self.who(f, 'a')}{self.far(f)}, {self.pitch_phrase(f)}.", f"{cap(self.pitch_phrase(f))}, the drone {self.v('follow')} {self.who(f, 'a')}{self.far(f)}.")
        out = [d]
        if f.altitude >= 1:
            out.append(self.height_report(f))
        tail = [self.way_sentence(f), self.speed_sentence(f), self.turns_sentence(f), self.stops_sentence(f)]
        self.rng.shuffle(tail)
        if not d.startswith("For "):
            tail.append(self.time_sentence(f))
        return " ".join(out + tail)

    def d_numbers(self, f):
        s, m, sp = self.secs(f.duration), self.metres(f.way), self.mps(f)
        lead = self.pick(f"{cap(s)} of flight, {m} of walking, {sp} mean walking speed.", f"{cap(m)} on foot in {s}, {sp} on average.", f"Flight {s}, walk {m}, average walking speed {sp}.", f"{cap(s)} in the air over {m} of walking, which {self.v('go')} at {sp} on average.")
        tail = [self.opening(f), self.turns_sentence(f), self.stops_sentence(f)]
        return " ".join([lead] + tail + self.geometry(f))

    def d_telegram(self, f):
        bits = [self.pick("walk ", "way ", "distance walked ") + self.metres(f.way), self.pick("time ", "flight ", "duration ") + self.secs(f.duration), self.pick("mean pace ", "average walking speed ", "mean walking speed ") + self.mps(f),
                "turns: " + self.turn_note(f), self.pick("stops: ", "pauses: ") + self.stops_note(f), self.pick("drone-to-person distance ", "range to person ", "distance to person ") + self.metres(f.distance), self.pick("camera ", "gimbal ", "lens ") + self.pitch_note(f)]
        if f.altitude >= 1:
            bits.append(self.pick("height ", "altitude ", "drone ") + self.metres(f.altitude) + " above person's feet")
        if self.rng.random() < .4:
            self.rng.shuffle(bits)
        sep = self.pick("; ", ". ", " | ")
        lead = self.pick("Followed: ", "Subject: ", "Log. Person: ", "Filmed: ")
        return lead + self.tag(f) + (". " if sep == ". " else sep) + sep.join(cap(b) if sep == ". " else b for b in bits) + "."

    def d_list(self, f):
        rows = [self.opening(f), self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.time_sentence(f), self.speed_sentence(f), self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if f.altitude >= 1 else [])
        first = rows.pop(0)
        if self.rng.random() < .5:
            self.rng.shuffle(rows)
        rows.insert(0, first)
        style = self.pick("- ", "* ", "n")
        if style == "n":
            return self.pick("\n", " ").join(f"{i + 1}. {r}" for i, r in enumerate(rows))
        return "\n".join(style + r for r in rows)

    def d_recap(self, f):
        hi = self.pick("Here is a recap of the flight: ", "Here's what happened: ", "Sure! Here is a summary of the flight. ", "The flight is complete. ", "Done! ", "To sum up the flight: ")
        a = self.opening(f)
        if hi.endswith(": "):
            a = a[:1].lower() + a[1:]
        mid = [self.length_sentence(f), self.turns_sentence(f), self.stops_sentence(f)]
        self.rng.shuffle(mid)
        return hi + " ".join([a] + mid + self.geometry(f))

    def d_qa(self, f):
        past = self.tense == "past"
        did = "did" if past else "does"
        was = "was" if past else "is"
        qs = [f"Who {was} followed? {cap(self.who(f, 'a'))}.", f"How far {did} the person walk? {cap(self.metres(f.way))}.", f"How long {did} the flight last? {cap(self.secs(f.duration))}.", f"How fast {was} the walking on average? {cap(self.mps(f))}.", f"Which turns {'were' if past else 'are'} there? {cap(self.turn_note(f)) if f.turns else 'No turns at all'}.",
              f"Any stops? {'No, none' if not f.stops else 'Yes: ' + self.stops_note(f)}.", f"How far away {was} the drone? {cap(self.metres(f.distance))} from the person.", f"And the camera? {cap(self.pitch_note(f))}."]
        if f.altitude >= 1:
            qs.append(f"How high {did} the drone fly? {cap(self.metres(f.altitude))} above the person's feet.")
        return " ".join(qs)

    def d_two(self, f):
        """A paragraph for the person, one for the drone."""
        mid = [self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(mid)
        p = "The one followed: " + self.tag(f) + ". " + " ".join(mid)
        d = "The drone: " + " ".join([self.time_sentence(f)] + self.geometry(f))
        a, b = self.pick((p, d), (d, p))
        return a + self.pick("\n", " ") + b

    def d_summary(self, f):
        who = self.who(f, "a")
        return " ".join([self.pick(f"The recording {self.v('show')} {who}, {self.turns_phrase(f)}, {self.stops_phrase(f)}.", f"{cap(who)} {self.v('walk')} along, {self.turns_phrase(f)}, {self.stops_phrase(f)}.", f"What the drone {self.v('film')} {self.v('be')} {who}, {self.stops_phrase(f)}, {self.turns_phrase(f)}.")] + self.action(f) + self.geometry(f))

    def d_engineer(self, f):
        rows = ["subject = " + self.tag(f), "walked path = " + self.metres(f.way), "flight duration = " + self.secs(f.duration), "mean walking speed = " + self.mps(f), "turns = " + self.turn_note(f), "pauses = " + self.stops_note(f), "mean slant range = " + self.metres(f.distance), "camera pitch = " + self.pitch_note_of(f)]
        if f.altitude >= 1:
            rows.append("height above the person's feet = " + self.metres(f.altitude))
        return self.pick("Flight log entry: ", "Parameters of the completed flight: ", "Test flight record: ") + "; ".join(rows) + "."

    # descriptions of a person who stands
    def s_report(self, f):
        return self.pick("Flight report. ", "Post-flight report: ", "") + " ".join([self.opening(f), self.stands_sentence(f, True)] + self.geometry(f))

    def s_story(self, f):
        first = self.pick(f"{cap(self.who(f, 'a'))} {self.v('stand')} on one spot for {self.secs(f.duration)}.", f"For {self.secs(f.duration)} {self.who(f, 'a')} {self.v('stand')} in one place.", f"Standing on one spot for {self.secs(f.duration)}, {self.who(f, 'a')} {self.v('be')} filmed by a drone.")
        return " ".join([first] + self.geometry(f))

    def s_long(self, f):
        geo = [self.dist_phrase(f), self.pitch_phrase(f)] + ([self.height_phrase(f)] if f.altitude >= 1 else [])
        self.rng.shuffle(geo)
        s = self.secs(f.duration)
        return self.pick(f"For {s} the drone {self.v('film')} {self.who(f, 'a')} standing on one spot, {', '.join(geo)}.", f"While {self.who(f, 'a')} {self.v('stand')} still for {s}, the drone {self.v('film')} {', '.join(geo)}.", f"In a flight of {s}, {self.who(f, 'a')}, who {self.v('stand')} on the same spot throughout, {self.v('be')} filmed {', '.join(geo)}.")

    def s_numbers(self, f):
        return " ".join([self.pick(f"{cap(self.secs(f.duration))} of flight, no walking.", f"{cap(self.secs(f.duration))} on one spot: the person only {self.v('stand')}.", f"Flight time {self.secs(f.duration)}, steps taken by the person: none."), self.opening(f), self.stands_sentence(f)] + self.geometry(f))

    def s_telegram(self, f):
        bits = [self.pick("stands on one spot for ", "standing still for ", "on one spot, standing, for ") + self.secs(f.duration), self.pick("range to person ", "drone-to-person distance ", "distance to person ") + self.metres(f.distance), self.pick("camera ", "gimbal ") + self.pitch_note(f)]
        if f.altitude >= 1:
            bits.append("height " + self.metres(f.altitude) + " above person's feet")
        return self.pick("Filmed: ", "Subject: ", "Log. Person: ") + self.tag(f) + "; " + "; ".join(bits) + "."

    def s_qa(self, f):
        past = self.tense == "past"
        qs = [f"Who {self.v('be')} filmed? {cap(self.who(f, 'a'))}.", f"What {'did' if past else 'does'} the person do? Stand on one spot for {self.secs(f.duration)}.", f"How far away {self.v('be')} the drone? {cap(self.metres(f.distance))}.", f"And the camera angle? {cap(self.pitch_note(f))}."]
        if f.altitude >= 1:
            qs.append(f"How high {'did' if past else 'does'} it fly? {cap(self.metres(f.altitude))} above the person's feet.")
        return " ".join(qs)

    def s_list(self, f):
        rows = [self.opening(f), self.stands_sentence(f, True), self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if f.altitude >= 1 else [])
        return self.pick("\n".join("- " + r for r in rows), " ".join(f"{i + 1}. {r}" for i, r in enumerate(rows)))

    def s_drone_first(self, f):
        out = self.geometry(f)
        return " ".join([self.pick(f"For this flight the drone {self.v('be')} given a stationary subject.", f"The drone {self.v('have')} one person on camera.")] + out + [self.pick(f"The person on camera {self.v('be')} {self.who(f, 'a')}.", f"It {self.v('be')} {self.who(f, 'a')} that {self.v('be')} on camera."), self.stands_sentence(f, True)])

    def s_recap(self, f):
        return self.pick("Here is a recap of the flight. ", "The flight is complete. ", "Done! ") + " ".join([self.opening(f)] + self.geometry(f) + [self.stands_sentence(f, True)])

    # ---- wrong texts
    def foreign(self, text):
        t = text.rstrip()
        if self.rng.random() < .35:
            p = self.pick(*self.persons)
            for old, new in ((" the person in ", f" the {p} in "), (" the person wearing ", f" the {p} wearing "), ("The drone followed a person", f"The drone followed {an(p)}")):
                if old in t and self.rng.random() < .6:
                    return t.replace(old, new, 1)
            return t + self.pick(f" The person is {an(p)}.", f" The one on camera is {an(p)}.", f" Note that the subject is {an(p)}.", f" By the way, the person on camera is {an(p)}.", f" The person in question: {an(p)}.")
        x = self.pick(*self.things)
        if t.endswith(".") and self.rng.random() < .6:
            return t[:-1] + ", " + x + "."
        return t + self.pick(f" All this {x}.", f" All of it happens {x}.", f" The person is seen {x}.", f" The scene: {x}.")

    def heading(self, text, direction):
        d = direction
        return text.rstrip() + self.pick(f" The person walks {d}.", f" They head {d}.", f" The walk goes towards the {d}.", f" The person's heading is {d}.", f" Direction of the walk: {d}.", f" The person is walking to the {d}.", f" The walk leads {d}ward.", f" It is {d} that the person walks.", f" The walking direction is {d}.", f" The person is on the way to the {d}.")


class TwentySecondChinese(Grammar):
    code = "zh"
    things = ["旁边有一座喷泉", "远处雷声滚滚", "身边跟着两条狗", "路边停着一排公交车", "头顶一轮满月", "教堂的钟声正在响", "四周大雾弥漫", "身旁是一辆抛锚的电车", "正对着一家面包店", "手里牵着一个小孩", "周围挤满了游客", "地上积着新雪", "夕阳正好落下", "有个骑自行车的人同行", "手里撑着一把黄伞",
              "一边走一边打电话", "附近有座老石桥", "出租车喇叭声不断", "当时下着大雨", "就在集市广场边上", "鸽子四处飞散", "两旁种着梧桐树", "就在火车站外面", "推着一辆婴儿车", "街头乐队正在演奏"]
    persons = ["护士", "渔夫", "邮递员", "小学生", "老奶奶", "警察", "服务员", "芭蕾舞演员", "电工", "少女", "神父", "老大爷"]

    # ---- small tools
    def start(self):
        self.wordy = self.pick(True, False, False, False)
        self.short = self.pick(True, False, False)
        self.space = self.pick(True, False, False)
        self.second = self.pick("秒", "秒", "秒钟")
        self.rate = self.rng.randrange(4)

    def q(self, n, unit):
        """A number and its measure word."""
        if self.wordy:
            return ("两" if n == 2 else zhn(n)) + unit
        return f"{n} {unit}" if self.space else f"{n}{unit}"

    def metres(self, n):
        return self.q(n, "米")

    def secs(self, n):
        return self.q(n, self.second)

    def degs(self, n):
        if n == 2:
            return "2度"
        if not self.wordy and self.short:
            return f"{n}°"
        return self.q(n, "度")

    def mps(self, f):
        if self.wordy:
            whole, tenth = f"{f.speed:.1f}".split(".")
            return f"每秒{zhn(int(whole))}点{zhn(int(tenth))}米"
        return (f"每秒{f.speed:.1f}米", f"{f.speed:.1f}米/秒", f"{f.speed:.1f} m/s", f"每秒{f.speed:.1f}米")[self.rate]

    def count(self, n):
        return "一" if n == 1 else "两" if n == 2 else zhn(n)

    def times(self, n):
        return self.count(n) + "次" if self.wordy or self.rng.random() < .6 else f"{n}次"

    # ---- the person
    def noun(self, f):
        return self.pick("人", "人", "人", *(["行人", "步行者"] if f.walks else ["人"]))

    def who(self, f):
        n = self.noun(f)
        if f.wear is None:
            if self.tense_past:
                return self.pick("一名", "一位", "一个") + n if n != "人" else "一个人"
            return self.pick("那位", "那名", "那个", "这位") + n if n != "人" else self.pick("那个人", "这个人", "目标人物", "一个人" if self.tense_past else "那个人")
        t, l, pack = f.wear
        a, b = ZH_COLOURS[t], ZH_COLOURS[l]
        mid = self.pick("背着双肩包", "背着背包", "背双肩包", "带着背包") if pack else ""
        art = self.pick("那个", "那位", "那名", "")
        if n == "人" and art in ("那位", "那名"):
            art = "那个"
        same = [f"一身{a}色衣裤", f"上衣和裤子都是{a}色", f"上下装同为{a}色"] if a == b else []
        brief = [f"{a}衣{b}裤"] if not {a, b} & set("米橙粉棕") and a != b else []
        core = self.pick(f"穿{a}色上衣和{b}色裤子", f"穿着{a}色上衣、{b}色裤子", f"上身穿{a}色、下身穿{b}色裤子", f"身穿{a}色上衣、{b}色裤子", f"{a}色上衣配{b}色裤子", f"上衣{a}色、裤子{b}色", f"身着{a}色上衣和{b}色裤子", f"穿{b}色裤子、{a}色上衣", f"上衣为{a}色、裤子为{b}色", *same, *brief)
        if pack:
            core = self.pick(f"{core}、{mid}", f"{mid}、{core}", f"{core}、{mid}")
        elif self.rng.random() < .15:
            core += self.pick("、没背背包", "、没有背包")
        if n == "人":
            return art + core + "的人"
        return art + core + "的" + n

    def tag(self, f):
        if f.wear is None:
            return self.pick("一个人", "单人", "一名步行者" if f.walks else "一个站着的人")
        t, l, pack = f.wear
        a, b = ZH_COLOURS[t], ZH_COLOURS[l]
        bag = self.pick("，背双肩包", "，有背包", "，背着背包", "，带背包") if pack else self.pick("", "", "，无背包", "，没有背包")
        return self.pick(f"{a}色上衣，{b}色裤子{bag}", f"一人，上衣{a}色，裤子{b}色{bag}", f"单人，{a}上衣、{b}裤子{bag}" if "米" not in (a, b) else f"单人，{a}色上衣、{b}色裤子{bag}", f"上衣{a}色，裤子{b}色{bag}", f"一个人，上身{a}色，裤子{b}色{bag}")

    def look(self, f):
        if f.wear is None:
            return ""
        t, l, pack = f.wear
        a, b = ZH_COLOURS[t], ZH_COLOURS[l]
        bag = "，还背着背包" if pack else ""
        return self.pick(f"这个人穿{a}色上衣、{b}色裤子{bag}。", f"认准{a}色上衣和{b}色裤子" + ("，外加一个背包。" if pack else "。"), f"特征是上衣{a}色、裤子{b}色{bag}。", f"目标上身{a}色、下身{b}色裤子{bag}。", f"怎么认？{a}色上衣，{b}色裤子" + ("，背着包。" if pack else "。"), f"衣着：上衣{a}色，裤子{b}色" + ("，有背包。" if pack else "。"))

    def he(self, f):
        return self.pick("对方", "此人", "这个人", "目标", "该人物", "被拍者")

    # ---- distance
    def dist_phrase(self, f):
        m = self.metres(f.distance)
        return self.pick(f"距离{m}", f"相距{m}", f"在{m}外", f"隔着{m}", f"保持{m}的距离", f"与人保持{m}", f"离人{m}", f"距目标{m}", f"以{m}的间距", f"与目标相隔{m}")

    def dist_order(self, f):
        m = self.metres(f.distance)
        return self.pick(f"与目标保持{m}的距离。", f"飞机离人{m}。", f"请保持{m}的间距。", f"无人机和人之间要隔{m}。", f"距离定在{m}。", f"始终与人相距{m}。", f"跟拍距离为{m}。" if f.walks else f"拍摄距离为{m}。", f"离目标{m}远就行。", f"要求距离{m}。", f"{m}是要保持的距离。", f"飞机到人的斜距控制在{m}。", f"和人的间隔，请控制在{m}。", f"至于远近，离人{m}。")

    def dist_report(self, f):
        m = self.metres(f.distance)
        return self.pick(f"无人机与人平均相距{m}。", f"拍摄距离平均为{m}。", f"机与人之间的斜距平均{m}。", f"无人机离人{m}左右。", f"全程平均距离{m}。", f"飞机到人的距离是{m}。", f"人和无人机之间平均隔着{m}。", f"从{m}外拍摄。", f"平均斜距为{m}。", f"与目标的平均间距为{m}。", f"无人机在离人{m}的地方拍摄。", f"说到距离，平均{m}。")

    # ---- camera pitch
    def pitch_phrase(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"镜头下压{d}", f"镜头朝下{d}", f"镜头向下倾斜{d}", f"俯角{d}", f"以{d}俯角", f"云台下俯{d}", f"相机俯拍{d}", f"镜头低于水平{d}", f"镜头往下压{d}", f"摄像头下倾{d}", f"视线低于地平线{d}")
        if f.pitch < 0:
            return self.pick(f"镜头上仰{d}", f"镜头朝上{d}", f"镜头向上倾斜{d}", f"仰角{d}", f"以{d}仰角", f"云台上仰{d}", f"相机仰拍{d}", f"镜头高于水平{d}", f"镜头往上抬{d}", f"摄像头上抬{d}")
        return self.pick("镜头放平", "镜头保持水平", "相机平视", "镜头不仰不俯", "云台水平", f"俯仰角{self.degs(0)}", "镜头对着地平线", "镜头平直", "视线水平", "摄像头端平")

    def pitch_order(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"镜头向下倾斜{d}。", f"把云台下压{d}。", f"相机俯角设为{d}。", f"请让镜头朝下{d}。", f"俯拍，角度{d}。", f"镜头要低于水平线{d}。", f"镜头往下压{d}即可。", f"云台俯角调到{d}。", f"拍摄角度：俯角{d}。", f"相机的视线要比水平低{d}。", f"镜头从水平位置往下转{d}。")
        if f.pitch < 0:
            return self.pick(f"镜头向上倾斜{d}。", f"把云台上抬{d}。", f"相机仰角设为{d}。", f"请让镜头朝上{d}。", f"仰拍，角度{d}。", f"镜头要高于水平线{d}。", f"镜头往上抬{d}即可。", f"云台仰角调到{d}。", f"拍摄角度：仰角{d}。", f"相机的视线要比水平高{d}。")
        return self.pick("镜头放平。", "镜头保持水平。", "云台调到水平。", f"相机俯仰角设为{self.degs(0)}。", "请平视拍摄。", "镜头不要仰也不要俯。", "相机对准地平线。", "拍摄角度：水平。", "镜头端平就行，不上仰也不下压。", "相机视线与地平线平齐。")

    def pitch_report(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"镜头向下倾斜{d}。", f"相机俯角为{d}。", f"云台下压{d}。", f"画面以{d}的俯角拍成。", f"拍摄时镜头朝下{d}。", f"镜头比水平线低{d}。", f"采用俯拍，角度{d}。", f"镜头下俯{d}。", f"相机光轴在水平线以下{d}。", f"拍摄俯角{d}。")
        if f.pitch < 0:
            return self.pick(f"镜头向上倾斜{d}。", f"相机仰角为{d}。", f"云台上抬{d}。", f"画面以{d}的仰角拍成。", f"拍摄时镜头朝上{d}。", f"镜头比水平线高{d}。", f"采用仰拍，角度{d}。", f"镜头上仰{d}。", f"相机光轴在水平线以上{d}。", f"拍摄仰角{d}。")
        return self.pick("镜头保持水平。", "相机平视。", f"云台俯仰角为{self.degs(0)}。", "镜头是放平的。", "拍摄时镜头不仰不俯。", "相机光轴水平。", "画面是平视拍成的。", "镜头正对地平线。", "采用平拍，镜头没有倾斜。", "镜头既不上仰也不下压。")

    def pitch_note(self, f):
        d = self.degs(abs(f.pitch))
        if f.pitch > 0:
            return self.pick(f"俯角{d}", f"下俯{d}", f"朝下{d}", f"下压{d}", f"低于水平{d}")
        if f.pitch < 0:
            return self.pick(f"仰角{d}", f"上仰{d}", f"朝上{d}", f"上抬{d}", f"高于水平{d}")
        return self.pick("水平", "放平", "平视", f"{self.degs(0)}（水平）", "不仰不俯")

    # ---- altitude
    def height_phrase(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"比人的脚面高出{m}", f"高度为人脚以上{m}", f"从人的脚底算起高{m}", f"飞在人脚面上方{m}处", f"比人脚下的地面高{m}", f"离人脚下地面{m}高")

    def height_order(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"飞行高度比人的脚底高{m}。", f"高度从人的脚底算起，保持{m}。", f"飞机要比人脚下的地面高{m}。", f"飞到人脚底以上{m}的高度。", f"高度{m}，以人的脚底为准。", f"请把飞行高度定在人脚下地面以上{m}。", f"以人脚下的地面为基准，升到{m}。", f"无人机应高出人的脚底{m}。", f"飞行高度：人脚底以上{m}。", f"高度方面，比人的脚底高{m}。")

    def height_report(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"无人机比人的脚底高{m}。", f"飞行高度{m}，从人的脚底算起。", f"以人脚下的地面为基准，飞行高度是{m}。", f"飞机高出人的脚底{m}。", f"无人机飞在人脚下地面以上{m}。", f"从人的脚底量起，机高{m}。", f"高度为人脚底以上{m}。", f"相对人的脚底，飞行高度为{m}。", f"无人机在比人的脚底高{m}的位置飞行。", f"飞行高度比人脚下的地面高{m}。")

    # ---- turns
    def turn_words(self):
        s = self.pick(dict(left="左转", right="右转", around="掉头"), dict(left="向左转", right="向右转", around="掉头"), dict(left="左拐", right="右拐", around="调头"), dict(left="往左拐", right="往右拐", around="掉头往回走"), dict(left="左转", right="右转", around="转身折返"), dict(left="向左拐", right="向右拐", around="转身往回走"))
        return s

    def turn_seq(self, f):
        w = self.turn_words()
        t = [w[x] for x in f.turns]
        n = len(t)
        if n == 1:
            return self.pick(f"{t[0]}一次", f"{t[0]}了一次" if len(t[0]) < 4 and self.tense_past else f"{t[0]}一次")
        if len(set(t)) == 1:
            return f"{t[0]}{self.count(n)}次"
        if n == 2:
            return self.pick(f"先{t[0]}，再{t[1]}", f"先{t[0]}，后{t[1]}", f"先{t[0]}，随后{t[1]}", f"先是{t[0]}，接着{t[1]}", f"{t[0]}之后又{t[1]}")
        both = [f"{a}{self.count(k)}次" if k > 1 else a for a, k in ([w[x], k] for x, k in runs(f.turns))]
        grouped = "先" + "，再".join(both[:-1]) + "，最后" + both[-1] if len(both) > 2 else f"先{both[0]}，再{both[1]}"
        return self.pick("先" + "，再".join(t[:-1]) + "，最后" + t[-1], "依次" + "、".join(t), "先后" + "、".join(t), grouped, "先" + t[0] + "，" + "，".join("接着" + x if i % 2 == 0 else "然后" + x for i, x in enumerate(t[1:])))

    def turn_note(self, f):
        if not f.turns:
            return self.pick("无", "没有", "0次")
        w = self.pick(dict(left="左", right="右", around="掉头"), dict(left="左转", right="右转", around="掉头"))
        t = [w[x] for x in f.turns]
        if len(t) == 1:
            return self.pick(f"{dict(left='左转', right='右转', around='掉头')[f.turns[0]]}一次", f"1次（{t[0]}）")
        seq = self.pick("、", "→", "，").join(t)
        return self.pick(seq, f"{len(t)}次（{seq}）", f"共{self.count(len(t))}次：{seq}", f"{seq}（共{self.count(len(t))}次）")

    def turns_sentence(self, f):
        n = len(f.turns)
        if not n and not self.tense_past:
            return self.pick("途中不转弯。", "一个弯也不转。", "全程不转弯。", "一路上不会拐弯。", f"{self.he(f)}不会转弯。", "既不左转、右转，也不掉头。", "转弯次数为零。", "路上不拐弯，也不掉头。", "从头到尾没有一个弯。", "路线上没有转弯。")
        if not n:
            return self.pick("途中没有转弯。", "一次弯也没有转。", "全程不转弯。", "一路上没有拐弯。", "整段路没有转过弯。", f"{self.he(f)}没有转弯。", "既没有左转或右转，也没有掉头。", "转弯次数为零。", "路上不拐弯，也不掉头。", "从头到尾没有一个弯。")
        w = dict(left="左转", right="右转", around="掉头")
        plain = "、".join(w[x] for x in f.turns)
        c = self.count(n)
        forms = [f"途中{self.turn_seq(f)}。", f"{self.he(f)}{self.turn_seq(f)}。", f"这一路{self.turn_seq(f)}。", f"路上共转向{c}次：{plain}。", f"{self.he(f)}走的时候{self.turn_seq(f)}。", f"行走途中{self.turn_seq(f)}。", f"转向情况：{plain}。", f"全程{self.turn_seq(f)}。", f"总共{'转了' if self.tense_past else '要转'}{c}次方向，{'依次是' if n > 1 else '是'}{plain}。", f"路线上有{c}次转向（{plain}）。"]
        if 1 < n <= 6:
            forms += ["，".join(("第一次转向是" if i == 0 else f"第{zhn(i + 1)}次是") + w[x] for i, x in enumerate(f.turns)) + "。", f"{c}次转向按先后是{plain}。", f"转向的顺序是{plain}。"]
        return self.pick(*forms)

    def turns_phrase(self, f):
        if not f.turns and not self.tense_past:
            return self.pick("途中不转弯", "一路不转弯", "全程不拐弯", "既不转弯也不掉头")
        if not f.turns:
            return self.pick("途中没有转弯", "一路不转弯", "没有拐过弯", "全程没有转向")
        return self.pick(f"途中{self.turn_seq(f)}", f"路上{self.turn_seq(f)}", f"走的时候{self.turn_seq(f)}")

    # ---- stops
    def stops_sentence(self, f):
        n = f.stops
        if not n:
            if not self.tense_past:
                return self.pick("中途不停。", "一路不停。", "全程没有停顿。", "途中一次也不停。", f"{self.he(f)}不会停下来。", "停留次数为零。", "走的过程中不停步。", "路上没有停留。", "从头到尾不停歇。", "中间不会有停顿。")
            return self.pick("中途没有停下。", "一路没停。", "全程没有停顿。", "途中一次也没停。", f"{self.he(f)}没有停下来过。", "停留次数为零。", "走的过程中不停步。", "路上没有停留。", "从头到尾没有停过。", "一次停顿都没有。")
        c, s = self.times(n), self.secs(f.standing)
        if f.standing < 1:
            return self.pick(f"途中停了{c}。", f"{self.he(f)}停下{c}。")
        if not self.tense_past and n == 1:
            return self.pick(f"途中会停一次，停{s}。", f"{self.he(f)}会停下一次，时长{s}。", f"中间要停{s}，仅此一次。", f"会有一次停顿，持续{s}。", f"唯一一次停留为{s}。", f"路上停留一次，为时{s}。", f"预计停一次，共{s}。", f"停顿一次（{s}）。", f"途中要站住一次，站{s}。", f"只停一次，停{s}。")
        if not self.tense_past:
            return self.pick(f"途中会停{c}，合计{s}。", f"{self.he(f)}会停下{c}，加起来{s}。", f"共停{c}，总共{s}。", f"会有{self.count(n)}次停顿，累计{s}。", f"路上停留{c}，总时长{s}。", f"停顿{c}（共{s}）。", f"{self.count(n)}次停留加在一起是{s}。", f"预计停{c}，总计{s}。", f"前后要停{c}，一共停{s}。", f"停留共{c}，停留时间总和为{s}。")
        if n == 1:
            return self.pick(f"途中停了一次，停{s}。", f"{self.he(f)}停下来一次，时长{s}。", f"中间停了{s}，仅此一次。", f"有一次停顿，持续{s}。", f"唯一一次停留用了{s}。", f"路上停留一次，为时{s}。", f"途中站住一次，站了{s}。", f"只停过一次，停了{s}。", f"停顿一次（{s}）。", f"期间停步一次，历时{s}。")
        return self.pick(f"途中停了{c}，合计{s}。", f"{self.he(f)}停下来{c}，加起来{s}。", f"共停{c}，总共站了{s}。", f"有{self.count(n)}次停顿，累计{s}。", f"路上停留{c}，总时长{s}。", f"停顿{c}（共{s}）。", f"{self.count(n)}次停留加在一起是{s}。", f"期间停步{c}，总计{s}。", f"前后停了{c}，一共停了{s}。", f"停留共{c}，停留时间总和为{s}。")

    def stops_phrase(self, f):
        n = f.stops
        if not n:
            return self.pick("中间没有停", "一路不停", "没有停留", "全程不停步")
        if f.standing < 1:
            return f"停了{self.times(n)}"
        s = self.secs(f.standing)
        if not self.tense_past:
            return self.pick(f"会停一次（{s}）", f"停留一次、时长{s}", f"中间停一次，停{s}") if n == 1 else self.pick(f"会停{self.times(n)}（共{s}）", f"停留{self.times(n)}、合计{s}", f"其间停{self.times(n)}，加起来{s}")
        if n == 1:
            return self.pick(f"停了一次（{s}）", f"停留一次、时长{s}", f"中间停了一次，停{s}")
        c = self.times(n)
        return self.pick(f"停了{c}（共{s}）", f"停留{c}、合计{s}", f"停了{c}，加起来{s}")

    def stops_note(self, f):
        if not f.stops:
            return self.pick("无", "没有", "0次")
        if f.standing < 1:
            return f"{f.stops}次"
        return f"{f.stops}次，" + ("" if f.stops == 1 else self.pick("共", "合计", "累计")) + self.secs(f.standing)

    # ---- way, time, speed
    def way_sentence(self, f):
        m = self.metres(f.way)
        return self.pick(f"全程步行{m}。", f"{self.he(f)}一共走了{m}。" if self.tense_past else f"{self.he(f)}一共要走{m}。", f"步行路程为{m}。", f"总路程{m}。", f"走的路共长{m}。", f"这段路长{m}。", f"步行总长{m}。", f"路程合计{m}。", f"整段步行{m}。", f"行走距离总共{m}。")

    def time_sentence(self, f):
        s = self.secs(f.duration)
        return self.pick(f"飞行持续{s}。", f"整个飞行用时{s}。", f"飞行时长{s}。", f"全程历时{s}。", f"拍摄时间为{s}。", f"前后共{s}。", f"这趟飞行{s}。", f"总时长{s}。", f"飞行时间一共{s}。", f"从开始到结束{s}。")

    def time_order(self, f):
        s = self.secs(f.duration)
        return self.pick(f"飞行时长{s}。", f"持续拍摄{s}。", f"拍满{s}。", f"整个任务{s}。", f"时间为{s}。", f"全程{s}。", f"请拍{s}。", f"飞行{s}后结束。", f"计划用时{s}。", f"拍摄时间定为{s}。")

    def speed_sentence(self, f):
        v = self.mps(f)
        return self.pick(f"平均步行速度{v}。", f"步速平均{v}。", f"{self.he(f)}平均步速为{v}。", f"走路的平均速度是{v}。", f"平均速度为{v}（步行）。", f"{self.he(f)}以平均{v}的速度行走。", f"步行均速{v}。", f"平均下来，步行速度是{v}。", f"行走的平均速度：{v}。", f"步速的平均值是{v}。")

    def length_sentence(self, f):
        m, s, v = self.metres(f.way), self.secs(f.duration), self.mps(f)
        return self.pick(f"{s}内步行{m}，平均步速{v}。", f"飞行{s}，人走了{m}，平均速度{v}。", f"以平均{v}的步速走了{m}，飞行持续{s}。", f"飞行历时{s}，人共步行{m}，步行均速{v}。", f"全程{m}，用时{s}，平均步行速度{v}。", f"飞行时间{s}；步行路程{m}；平均步速{v}。", f"路程{m}，平均步速{v}，整个飞行{s}。", f"在{s}的飞行里，人以平均{v}的速度走了{m}。")

    # ---- standing
    def stands_sentence(self, f, timed=False):
        s = self.secs(f.duration)
        if timed:
            return self.pick(f"{self.he(f)}全程站在原地，飞行持续{s}。", f"{s}里{self.he(f)}一直站在原地。", f"{self.he(f)}站在一处不动，共{s}。", f"整整{s}，{self.he(f)}没有离开原地。", f"{self.he(f)}始终站着没走，飞行时长{s}。", f"在{s}的飞行中，{self.he(f)}站在同一个地方。", f"从头到尾{s}，{self.he(f)}都站在原地。", f"{self.he(f)}一步没走，在原地站了{s}。", f"飞行{s}，其间{self.he(f)}一直原地站立。", f"站立不走，持续{s}。")
        return self.pick(f"{self.he(f)}一直站在原地。", f"{self.he(f)}全程站着不走。", f"{self.he(f)}始终站在同一个位置。", "人站在原地，不走动。", f"{self.he(f)}不走路，只是站着。", "从头到尾人都站在一处。", f"{self.he(f)}原地站立。", f"{self.he(f)}站在原地，一步不走。", "人一直站着，不走动。", f"{self.he(f)}不移动位置，一直站着。")

    # ---- instruction
    tense_past = False

    def target(self, f):
        w = self.who(f)
        if f.walks or self.rng.random() < .5:
            return w
        return self.pick("站在原地的" + w.replace("那个", "").replace("那位", "").replace("那名", ""), "那个一直站着的" + self.strip(w), "站着不动的" + self.strip(w))

    def strip(self, w):
        for p in ("那个", "那位", "那名", "这位", "这个"):
            if w.startswith(p):
                return w[len(p):]
        return w

    def follow(self, f, w):
        if f.walks:
            return self.pick(f"跟拍{w}", f"跟随{w}", f"跟着{w}拍", f"跟踪拍摄{w}", f"拍摄{w}", f"跟住{w}", f"一路拍{w}", f"把镜头对着{w}跟拍", f"全程跟拍{w}")
        return self.pick(f"拍摄{w}", f"拍{w}", f"把镜头对着{w}", f"对着{w}拍摄", f"记录{w}", f"拍下{w}", f"盯着{w}拍", f"让{w}留在画面里")

    def extras(self, f, limit=5):
        pool = [self.time_order(f)]
        if f.altitude >= 1:
            pool.append(self.height_order(f))
        if f.walks:
            pool += [self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.speed_sentence(f)]
        else:
            pool += [self.stands_sentence(f)]
        self.rng.shuffle(pool)
        return pool[: self.rng.randint(0, min(limit, len(pool)))]

    def instruction(self, f):
        self.start()
        self.tense_past = False
        kind = self.pick(self.i_order, self.i_friendly, self.i_numbered, self.i_long, self.i_telegram, self.i_question, self.i_first, self.i_preview, self.i_need, self.i_list, self.i_plain, self.i_ba, self.i_three)
        return kind(f)

    def i_order(self, f):
        head = self.pick("任务指令：", "作业命令：", "飞行任务：", "任务下达：")
        return head + self.pick(f"{self.follow(f, self.target(f))}。", f"由你机{self.follow(f, self.target(f))}。", f"无人机{self.follow(f, self.target(f))}。") + self.dist_order(f) + self.pitch_order(f) + "".join(self.extras(f))

    def i_friendly(self, f):
        hi = self.pick("你好！", "好的，安排如下：", "嗨，飞手！", "你好，有个小任务：", "麻烦你啦，", "辛苦了，")
        return hi + self.pick(f"请{self.follow(f, self.target(f))}。", f"请你{self.follow(f, self.target(f))}。", f"想请你{self.follow(f, self.target(f))}。") + self.dist_order(f) + self.pitch_order(f) + "".join(self.extras(f, 4)) + self.pick("", "谢谢！", "多谢啦！")

    def i_numbered(self, f):
        steps = [self.pick(f"找到{self.target(f)}", f"锁定{self.target(f)}", f"认出{self.target(f)}"), self.dist_order(f)[:-1], self.pitch_order(f)[:-1]] + [x[:-1] for x in self.extras(f, 4)]
        if self.rng.random() < .4:
            steps.insert(3, self.pick("开始跟拍", "跟着人拍") if f.walks else self.pick("开始拍摄", "对着人拍"))
        style = self.pick("a", "b", "c", "d")
        if style == "a":
            return "\n".join(f"{i + 1}. {x}。" for i, x in enumerate(steps))
        if style == "b":
            return "；".join(f"（{i + 1}）{x}" for i, x in enumerate(steps)) + "。"
        if style == "c":
            return "\n".join(f"第{zhn(i + 1)}步：{x}。" for i, x in enumerate(steps))
        return "".join(f"{zhn(i + 1)}、{x}。" for i, x in enumerate(steps))

    def i_long(self, f):
        bits = [self.dist_clause(f), self.pitch_phrase_clause(f)]
        if f.altitude >= 1 and self.rng.random() < .5:
            bits.append(self.height_phrase_clause(f))
        self.rng.shuffle(bits)
        text = self.pick("请", "", "你要", "请你") + self.follow(f, self.target(f)) + "，" + "，".join(bits)
        if f.walks and self.rng.random() < .7:
            mods = [m for m in (self.turns_phrase(f), self.stops_phrase(f)) if self.rng.random() < .6]
            text += "，" + self.pick("对方", "这个人", "此人") + self.pick(f"会走{self.metres(f.way)}", f"一共走{self.metres(f.way)}", f"步行{self.metres(f.way)}") + ("，" + "，".join(mods) if mods else "")
        elif not f.walks and self.rng.random() < .5:
            text += "，" + self.pick("人一直站在原地", "对方原地站着不走")
        if self.rng.random() < .5:
            text += self.pick(f"，整个飞行{self.secs(f.duration)}", f"，一共拍{self.secs(f.duration)}", f"，飞行时长{self.secs(f.duration)}")
        return text + "。"

    def dist_clause(self, f):
        m = self.metres(f.distance)
        return self.pick(f"距离保持{m}", f"与其相距{m}", f"和人隔开{m}", f"离人{m}", f"保持{m}的距离", f"无人机与人间隔{m}")

    def pitch_phrase_clause(self, f):
        p = self.pitch_phrase(f)
        return p.replace("以", "采用", 1) if p.startswith("以") else p

    def height_phrase_clause(self, f):
        m = self.metres(f.altitude)
        return self.pick(f"飞行高度比人的脚底高{m}", f"高度从人的脚底算起为{m}", f"比人脚下的地面高{m}")

    def i_telegram(self, f):
        bits = [self.pick(f"距离{self.metres(f.distance)}", f"间距{self.metres(f.distance)}", f"离人{self.metres(f.distance)}", f"斜距{self.metres(f.distance)}"), self.pick("镜头", "云台", "相机") + self.pitch_note(f)]
        if f.altitude >= 1 and self.rng.random() < .6:
            bits.append(f"高度{self.metres(f.altitude)}（从人脚底算）")
        if f.walks:
            more = [f"转向：{self.turn_note(f)}", f"停留：{self.stops_note(f)}", f"步行{self.metres(f.way)}", f"平均步速{self.mps(f)}"]
            self.rng.shuffle(more)
            bits += more[: self.rng.randint(0, 4)]
        elif self.rng.random() < .6:
            bits.append(self.pick("人站着不走", "目标原地站立"))
        if self.rng.random() < .5:
            bits.append(self.pick(f"时长{self.secs(f.duration)}", f"飞行{self.secs(f.duration)}"))
        lead = self.pick("跟拍：", "目标：", "对象：") if f.walks else self.pick("拍摄：", "目标：", "对象：")
        return lead + self.tag(f) + self.pick("。", "；") + self.pick("；", "。", "；").join(bits) + "。"

    def i_question(self, f):
        d, p = self.dist_clause(f), self.pitch_phrase_clause(f)
        q = self.pick(f"能不能{self.follow(f, self.target(f))}，{d}，{p}？", f"可以{self.follow(f, self.target(f))}吗？{self.dist_order(f)}{self.pitch_order(f)}", f"看到{self.target(f)}了吗？{'跟拍这个人' if f.walks else '拍这个人'}，{d}，{p}。", f"麻烦你{self.follow(f, self.target(f))}，好吗？{self.pitch_order(f)}{self.dist_order(f)}", f"能否让无人机{self.follow(f, self.target(f))}，同时{d}、{p}？")
        return q + "".join(self.extras(f, 4))

    def i_first(self, f):
        d, p = self.dist_clause(f), self.pitch_phrase_clause(f)
        a = self.pick(f"{d}，{p}，{self.follow(f, self.target(f))}。", f"{p}，{d}，就这样{self.follow(f, self.target(f))}。", f"在{self.metres(f.distance)}外{self.follow(f, self.target(f))}，{p}。", f"距离{self.metres(f.distance)}、{self.pitch_note_full(f)}：按这个设定{self.follow(f, self.target(f))}。", f"先把镜头角度调好（{self.pitch_note(f)}），再在{self.metres(f.distance)}外{self.follow(f, self.target(f))}。")
        return a + "".join(self.extras(f))

    def pitch_note_full(self, f):
        return self.pick("镜头", "云台") + self.pitch_note(f)

    def i_preview(self, f):
        w = self.who(f)
        if f.walks:
            a = self.pick(f"{w}要走{self.metres(f.way)}，{self.turns_phrase(f)}。", f"{w}是你的拍摄对象。{self.turns_sentence(f)}", f"{w}会走一段路，{self.stops_phrase(f)}。", f"画面里会有{w}。{self.way_sentence(f)}", f"{w}即将步行{self.metres(f.way)}。{self.stops_sentence(f)}")
        else:
            a = self.pick(f"{w}一直站在原地。", f"{w}是你的拍摄对象。{self.stands_sentence(f)}", f"{w}会在原地站{self.secs(f.duration)}。")
        b = self.pick(f"你来拍，{self.dist_clause(f)}，{self.pitch_phrase_clause(f)}。", self.dist_order(f) + self.pitch_order(f), f"你的任务：{'跟拍' if f.walks else '拍摄'}，{self.dist_clause(f)}，{self.pitch_phrase_clause(f)}。", self.pitch_order(f) + self.dist_order(f))
        return a + b + (self.height_order(f) if f.altitude >= 1 and self.rng.random() < .5 else "")

    def i_need(self, f):
        w = self.target(f)
        a = self.pick(f"需要一段{w}的画面，{self.dist_clause(f)}，{self.pitch_phrase_clause(f)}。", f"本次目标是拍下{w}。{self.pitch_order(f)}{self.dist_order(f)}", f"我们想要的镜头是：{w}，离无人机{self.metres(f.distance)}，{self.pitch_phrase_clause(f)}。", f"这次要拍的是{w}，{self.dist_clause(f)}。{self.pitch_order(f)}", f"任务很简单：{self.follow(f, w)}，{self.pitch_phrase_clause(f)}，{self.dist_clause(f)}。")
        return a + "".join(self.extras(f, 4))

    def i_list(self, f):
        rows = [f"对象：{self.tag(f)}", f"{self.pick('距离', '间距', '斜距')}：{self.metres(f.distance)}", f"{self.pick('镜头', '相机角度', '云台')}：{self.pitch_note(f)}"]
        more = [f"{self.pick('时长', '飞行时间')}：{self.secs(f.duration)}"]
        if f.altitude >= 1:
            more.append(f"高度：人脚底以上{self.metres(f.altitude)}")
        if f.walks:
            more += [f"转向：{self.turn_note(f)}", f"{self.pick('停留', '停顿')}：{self.stops_note(f)}", f"步行路程：{self.metres(f.way)}", f"平均步速：{self.mps(f)}"]
        else:
            more += [self.pick("动作：站在原地，不走动", "状态：原地站立")]
        self.rng.shuffle(more)
        rows += more[: self.rng.randint(0, len(more))]
        head = self.pick("飞行计划", "拍摄任务", "任务单", "飞手须知")
        return self.pick(head + "\n" + "\n".join("- " + r for r in rows), head + "｜" + "；".join(rows) + "。", head + "——" + "；".join(rows) + "。")

    def i_plain(self, f):
        parts = [self.dist_order(f), self.pitch_order(f)] + self.extras(f, 3)
        self.rng.shuffle(parts)
        return self.follow(f, self.pick("这个人", "目标人物", "一个人")) + "。" + self.look(f) + "".join(parts)

    def i_ba(self, f):
        d = self.metres(f.distance)
        w = self.target(f)
        return self.pick(f"把{w}一直留在画面里，无人机离人{d}，{self.pitch_phrase_clause(f)}。", f"让无人机与{w}保持{d}的距离，{self.pitch_phrase_clause(f)}。", f"镜头对准{w}，人机相距{d}。{self.pitch_order(f)}", f"将飞机控制在离{w}{d}的位置。{self.pitch_order(f)}", f"对{w}进行{'跟拍' if f.walks else '拍摄'}，{self.pitch_phrase_clause(f)}，距离取{d}。") + "".join(self.extras(f))

    def i_three(self, f):
        return self.pick("注意三点：", "三件事：", "要点有三：") + f"一是对象，{self.who(f)}；" + f"二是距离，{self.metres(f.distance)}；" + f"三是镜头，{self.pitch_note(f)}。" + "".join(self.extras(f, 3))

    # ---- description
    def geometry(self, f):
        if self.rng.random() < .45:
            bits = [self.dist_clause_past(f), self.pitch_phrase_clause(f)] + ([self.height_phrase_clause(f)] if f.altitude >= 1 else [])
            self.rng.shuffle(bits)
            return self.pick("无人机拍摄时", "拍摄时", "飞行中", "无人机方面，") + "，".join(bits) + "。"
        out = [self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if f.altitude >= 1 else [])
        self.rng.shuffle(out)
        return "".join(out)

    def dist_clause_past(self, f):
        m = self.metres(f.distance)
        return self.pick(f"与人平均相距{m}", f"离人{m}", f"平均距离{m}", f"和人隔着{m}", f"人机斜距平均{m}")

    def opening(self, f):
        w = self.who(f)
        if f.walks:
            return self.pick(f"无人机跟拍了{w}。", f"这次飞行拍的是{w}。", f"本次跟拍对象是{w}。", f"{w}在行走，无人机一路跟拍。", f"镜头里是{w}。", f"被跟拍的是{w}。", f"无人机跟随的是{w}。", f"画面记录了{w}走路的过程。", f"跟拍目标为{w}。", f"{w}由无人机全程跟拍。")
        return self.pick(f"无人机拍摄了{w}。", f"这次飞行拍的是{w}。", f"拍摄对象是{w}。", f"镜头里是{w}。", f"被拍的是{w}。", f"画面记录的是{w}。", f"拍摄目标为{w}。", f"{w}由无人机全程拍摄。")

    def description(self, f):
        self.start()
        self.tense_past = True
        if not f.walks:
            return self.pick(self.s_report, self.s_story, self.s_long, self.s_telegram, self.s_qa, self.s_list, self.s_geo, self.s_recap)(f)
        return self.pick(self.d_report, self.d_story, self.d_long, self.d_drone, self.d_numbers, self.d_telegram, self.d_list, self.d_recap, self.d_qa, self.d_two, self.d_engineer, self.d_joined)(f)

    def action(self, f):
        if self.rng.random() < .5:
            return self.length_sentence(f)
        out = [self.way_sentence(f), self.time_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(out)
        return "".join(out)

    def d_report(self, f):
        return self.pick("飞行报告：", "飞行小结：", "任务报告：", "") + self.opening(f) + self.action(f) + self.turns_sentence(f) + self.stops_sentence(f) + self.geometry(f)

    def d_story(self, f):
        w = self.who(f)
        mid = [self.turns_sentence(f), self.stops_sentence(f)]
        self.rng.shuffle(mid)
        rest = [self.time_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(rest)
        return self.pick(f"{w}走了{self.metres(f.way)}，无人机一路跟着拍。", f"在无人机的跟拍下，{w}走了{self.metres(f.way)}。", f"{w}步行{self.metres(f.way)}，由无人机跟拍。") + "".join(mid + rest) + self.geometry(f)

    def d_long(self, f):
        w = self.who(f)
        mods = [self.turns_phrase(f), self.stops_phrase(f)]
        self.rng.shuffle(mods)
        geo = [self.dist_clause_past(f), self.pitch_phrase_clause(f)] + ([self.height_phrase_clause(f)] if f.altitude >= 1 else [])
        self.rng.shuffle(geo)
        s, m, v = self.secs(f.duration), self.metres(f.way), self.mps(f)
        return self.pick(f"在{s}的飞行中，{w}以平均{v}的步速走了{m}，{mods[0]}，{mods[1]}，无人机则{'，'.join(geo)}。", f"{w}走了{m}，{mods[0]}，{mods[1]}，平均步速{v}，无人机跟拍了{s}，{'，'.join(geo)}。", f"无人机跟拍{w}，{'，'.join(geo)}，人走了{m}，{mods[0]}，{mods[1]}，步行均速{v}，飞行共{s}。")

    def d_drone(self, f):
        tail = [self.way_sentence(f), self.speed_sentence(f), self.turns_sentence(f), self.stops_sentence(f), self.time_sentence(f)]
        self.rng.shuffle(tail)
        return self.pick(f"无人机{self.dist_clause_past(f)}，{self.pitch_phrase_clause(f)}，跟拍{self.who(f)}。", f"{self.pitch_phrase_clause(f)}，{self.dist_clause_past(f)}，无人机就这样跟拍了{self.who(f)}。", f"无人机在{self.metres(f.distance)}外跟拍{self.who(f)}，{self.pitch_phrase_clause(f)}。") + (self.height_report(f) if f.altitude >= 1 else "") + "".join(tail)

    def d_numbers(self, f):
        s, m, v = self.secs(f.duration), self.metres(f.way), self.mps(f)
        return self.pick(f"飞行{s}，步行{m}，平均步速{v}。", f"步行{m}，飞行时长{s}，步行均速{v}。", f"{s}的飞行，{m}的步行，{v}的平均步速。") + self.opening(f) + self.turns_sentence(f) + self.stops_sentence(f) + self.geometry(f)

    def d_telegram(self, f):
        bits = [self.pick("步行", "路程") + self.metres(f.way), self.pick("飞行", "时长") + self.secs(f.duration), self.pick("平均步速", "步行均速") + self.mps(f), "转向：" + self.turn_note(f), self.pick("停留：", "停顿：") + self.stops_note(f), self.pick("人机距离", "平均斜距") + self.metres(f.distance), self.pick("镜头", "云台") + self.pitch_note(f)]
        if f.altitude >= 1:
            bits.append("高度" + self.metres(f.altitude) + self.pick("（从人脚底算）", "（相对人的脚底）"))
        if self.rng.random() < .4:
            self.rng.shuffle(bits)
        return self.pick("跟拍对象：", "目标：", "记录。对象：") + self.tag(f) + "；" + self.pick("；", "｜", "；").join(bits) + "。"

    def d_list(self, f):
        rows = [self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.time_sentence(f), self.speed_sentence(f), self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if f.altitude >= 1 else [])
        if self.rng.random() < .5:
            self.rng.shuffle(rows)
        rows.insert(0, self.opening(f))
        return self.pick("\n".join("- " + r for r in rows), "\n".join(f"{i + 1}. {r}" for i, r in enumerate(rows)), "".join(f"（{i + 1}）{r}" for i, r in enumerate(rows)))

    def d_recap(self, f):
        mid = [self.length_sentence(f), self.turns_sentence(f), self.stops_sentence(f)]
        self.rng.shuffle(mid)
        return self.pick("飞行已完成，小结如下：", "这趟飞行回顾一下：", "飞行结束。", "好的，总结如下：", "简单汇报：") + self.opening(f) + "".join(mid) + self.geometry(f)

    def d_qa(self, f):
        qs = [f"拍的是谁？{self.who(f) if f.wear else '一个人'}。", f"走了多远？{self.metres(f.way)}。", f"飞了多久？{self.secs(f.duration)}。", f"走得多快？平均{self.mps(f)}。", f"转过弯吗？{'没有' if not f.turns else '转过：' + self.turn_note(f)}。", f"停过吗？{'没有' if not f.stops else '停过' + self.stops_note(f)}。", f"无人机离人多远？平均{self.metres(f.distance)}。", f"镜头呢？{self.pitch_note(f)}。"]
        if f.altitude >= 1:
            qs.append(f"飞多高？比人的脚底高{self.metres(f.altitude)}。")
        return "".join(qs)

    def d_two(self, f):
        mid = [self.turns_sentence(f), self.stops_sentence(f), self.way_sentence(f), self.speed_sentence(f)]
        self.rng.shuffle(mid)
        p = "人物：" + self.tag(f) + "。" + "".join(mid)
        d = "无人机：" + self.time_sentence(f) + self.geometry(f)
        a, b = self.pick((p, d), (d, p))
        return a + self.pick("\n", "") + b

    def d_engineer(self, f):
        rows = ["对象：" + self.tag(f), "步行路程：" + self.metres(f.way), "飞行时长：" + self.secs(f.duration), "平均步行速度：" + self.mps(f), "转向：" + self.turn_note(f), "停顿：" + self.stops_note(f), "平均斜距：" + self.metres(f.distance), "相机角度：" + self.pitch_note(f)]
        if f.altitude >= 1:
            rows.append("飞行高度（以人的脚底为基准）：" + self.metres(f.altitude))
        return self.pick("飞行记录——", "试飞数据——", "本架次参数——") + "；".join(rows) + "。"

    def d_joined(self, f):
        w = self.who(f)
        mods = [self.turns_phrase(f), self.stops_phrase(f)]
        self.rng.shuffle(mods)
        return self.pick(f"{w}一共走了{self.metres(f.way)}，{mods[0]}，{mods[1]}。", f"画面里，{w}走了{self.metres(f.way)}，{mods[0]}，{mods[1]}。") + self.pick(f"平均步速{self.mps(f)}，飞行时长{self.secs(f.duration)}。", f"飞行共{self.secs(f.duration)}，步行均速{self.mps(f)}。") + self.geometry(f)

    def s_report(self, f):
        return self.pick("飞行报告：", "飞行小结：", "") + self.opening(f) + self.stands_sentence(f, True) + self.geometry(f)

    def s_story(self, f):
        w = self.who(f)
        return self.pick(f"{w}在原地站了{self.secs(f.duration)}。", f"整整{self.secs(f.duration)}，{w}一直站在原地。", f"{w}站着不走，共{self.secs(f.duration)}，无人机全程拍摄。") + self.geometry(f)

    def s_long(self, f):
        geo = [self.dist_clause_past(f), self.pitch_phrase_clause(f)] + ([self.height_phrase_clause(f)] if f.altitude >= 1 else [])
        self.rng.shuffle(geo)
        w, s = self.who(f), self.secs(f.duration)
        return self.pick(f"在{s}的飞行中，{w}始终站在原地，无人机则{'，'.join(geo)}。", f"{w}原地站立{s}，无人机拍摄时{'，'.join(geo)}。", f"无人机拍了{s}，{'，'.join(geo)}，{w}一直站在原地。")

    def s_telegram(self, f):
        bits = [self.pick("原地站立", "站着不走，时长", "站在原地，共") + self.secs(f.duration), self.pick("人机距离", "平均斜距") + self.metres(f.distance), self.pick("镜头", "云台") + self.pitch_note(f)]
        if f.altitude >= 1:
            bits.append("高度" + self.metres(f.altitude) + "（从人脚底算）")
        return self.pick("拍摄对象：", "目标：", "记录。对象：") + self.tag(f) + "；" + "；".join(bits) + "。"

    def s_qa(self, f):
        qs = [f"拍的是谁？{self.who(f) if f.wear else '一个人'}。", f"在做什么？在原地站了{self.secs(f.duration)}，没有走动。", f"无人机离人多远？平均{self.metres(f.distance)}。", f"镜头呢？{self.pitch_note(f)}。"]
        if f.altitude >= 1:
            qs.append(f"飞多高？比人的脚底高{self.metres(f.altitude)}。")
        return "".join(qs)

    def s_list(self, f):
        rows = [self.opening(f), self.stands_sentence(f, True), self.dist_report(f), self.pitch_report(f)] + ([self.height_report(f)] if f.altitude >= 1 else [])
        return self.pick("\n".join("- " + r for r in rows), "".join(f"（{i + 1}）{r}" for i, r in enumerate(rows)), "\n".join(f"{i + 1}. {r}" for i, r in enumerate(rows)))

    def s_geo(self, f):
        return self.geometry(f) + self.opening(f) + self.stands_sentence(f, True)

    def s_recap(self, f):
        return self.pick("飞行已完成，小结如下：", "飞行结束。", "简单汇报：") + self.opening(f) + self.geometry(f) + self.stands_sentence(f, True)

    # ---- wrong texts
    def foreign(self, text):
        t = text.rstrip()
        if self.rng.random() < .35:
            p = self.pick(*self.persons)
            for old in ("的人。", "的人，", "的行人。", "的行人，", "的步行者，"):
                if old in t and self.rng.random() < .5:
                    return t.replace(old, "的" + p + old[-1], 1)
            end = "" if t[-1] in "。！？" else "。"
            return t + end + self.pick(f"这个人是{p}。", f"被拍的是一位{p}。", f"对方是位{p}。", f"镜头里的人是{p}。", f"目标身份：{p}。")
        x = self.pick(*self.things)
        if t.endswith("。"):
            return t[:-1] + "，" + x + "。"
        return t + ("" if t[-1] in "！？" else "。") + self.pick(x + "。", f"另外，{x}。")

    def heading(self, text, direction):
        d = ZH_DIRECTIONS[direction]
        t = text.rstrip()
        t += "" if t[-1] in "。！？" else "。"
        return t + self.pick(f"这个人朝{d}走。", f"对方往{d}走。", f"此人向{d}行走。", f"行走方向是{d}。", f"人是往{d}边走的。" if len(d) == 1 else f"人是往{d}方向走的。", f"步行方向：{d}。", f"目标朝{d}方向前进。", f"这段路是朝{d}走的。", f"走的方向为正{d}。" if len(d) == 1 else f"走的方向为{d}。")
