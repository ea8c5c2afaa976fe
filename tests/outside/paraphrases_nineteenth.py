"""The nineteenth grammar for check_text_judge.py: American students labeling robot data and a careful technical editor; Chinese student labelers and an editor of newswire prose. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen "
        "eighteen nineteen").split()
TENS = "zero ten twenty thirty forty fifty sixty seventy eighty ninety".split()
PAST = dict(keep="kept", hold="held", stay="stayed", fly="flew", be="was", turn="turned", take="took", make="made", go="went", do="did",
            stop="stopped", pause="paused", stand="stood", walk="walked", cover="covered", last="lasted", run="ran", look="looked",
            point="pointed", come="came", have="had", move="moved", follow="followed", remain="remained", average="averaged", wear="wore",
            maintain="maintained", amount="amounted", halt="halted", consist="consisted", measure="measured", sit="sat", include="included",
            total="totaled", proceed="proceeded", travel="traveled", leave="left", hang="hung")


def words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" " + words(n % 100) if n % 100 else "")
    return str(n)


def cap(s):
    return s[:1].upper() + s[1:]


def listed(items, last="and"):
    if len(items) < 2:
        return "".join(items)
    if len(items) == 2:
        return f"{items[0]} {last} {items[1]}"
    return ", ".join(items[:-1]) + f", {last} {items[-1]}"


class NineteenthEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls", "with two dogs on a leash", "under a row of palm trees", "past a parked fire truck",
              "while it is snowing", "in the glow of the streetlights", "next to a bus stop", "with an umbrella up", "pushing a stroller",
              "just before sunset", "with a crowd looking on", "across from a gas station", "holding a cup of coffee", "in front of a church",
              "while a helicopter circles overhead", "along a canal", "as a train goes by", "talking on the phone", "with a skateboard under one arm",
              "through a farmers market", "in thick fog", "near a statue of a horse", "with sunglasses on", "as a cyclist passes"]
    persons = ["nurse", "fisherman", "grandmother", "mail carrier", "teenager", "soldier", "schoolboy", "bride", "construction worker", "priest",
               "young woman", "professor"]

    # ---- tools
    def begin(self, flight, tense):
        self.f = flight
        self.tense = tense
        self.student = self.pick(True, False)
        self.spelled = self.rng.random() < .12
        self.unit = self.pick("meters", "meters", "meters", "m") if not self.spelled else "meters"
        self.sign = self.pick("degrees", "degrees", "°") if not self.spelled else "degrees"
        self.short = self.pick("seconds", "seconds", "seconds", "s") if not self.spelled else "seconds"

    def by(self, student, editor):
        return self.rng.choice(student if self.student else editor)

    def n(self, k):
        return words(k) if self.spelled else str(k)

    def m(self, k):
        return f"{self.n(k)} " + ("meter" if k == 1 and self.unit == "meters" else self.unit)

    def s(self, k):
        return f"{self.n(k)} " + ("second" if k == 1 and self.short == "seconds" else self.short)

    def deg(self, k):
        return f"{k}°" if self.sign == "°" else f"{self.n(k)} " + ("degree" if k == 1 else "degrees")

    def ms(self):
        x = f"{self.f.speed:.1f}"
        if self.spelled:
            a, b = x.split(".")
            return f"{words(int(a))} point {ONES[int(b)]} meters per second"
        return self.pick(f"{x} m/s", f"{x} meters per second", f"{x} meters a second")

    def v(self, base, plural=False):
        if self.tense == "past":
            return "were" if base == "be" and plural else PAST[base]
        if self.tense == "future":
            return "will " + base
        if base == "be":
            return "are" if plural else "is"
        if plural:
            return base
        return dict(go="goes", have="has", do="does", fly="flies").get(base, base + "s")

    def subj(self):
        """A short name of the person for a sentence's start: the words and whether the verb is plural."""
        if self.student:
            return self.pick(("they", True), ("they", True), ("the person", False), ("this person", False))
        return self.pick(("the person", False), ("the subject", False), ("this individual", False), ("they", True))

    def them(self):
        return self.by(["them", "them", "the person", "this person"], ["the person", "the subject", "that individual"])

    # ---- who
    def clothes(self):
        if not self.f.wear:
            return ""
        top, legs, bag = self.f.wear
        pants = self.by(["pants", "pants", "trousers"], ["trousers", "trousers", "pants"])
        shirt = self.by(["top", "shirt", "top"], ["top", "top", "upper garment"])
        if bag:
            tail = self.pick(" with a backpack", " and carrying a backpack", " plus a backpack", " with a backpack on")
        else:
            tail = self.pick("", "", "", "", "", " and no backpack", " without a backpack")
        if tail.startswith(" plus") or tail == " and no backpack":
            return self.pick(f"in {an(top)} {shirt}, {legs} {pants}{tail}", f"wearing {an(top)} {shirt}, {legs} {pants}{tail}").replace(
                f"{pants} plus", f"{pants}, plus").replace(f"{pants} and no", f"{pants}, and no")
        options = [f"in {an(top)} {shirt} and {legs} {pants}{tail}", f"wearing {an(top)} {shirt} and {legs} {pants}{tail}",
                   f"dressed in {an(top)} {shirt} and {legs} {pants}{tail}", f"in {legs} {pants} and {an(top)} {shirt}{tail}",
                   f"wearing {legs} {pants} with {an(top)} {shirt}" + (tail if not tail.startswith(" with") else (" and a backpack" if bag else "")),
                   f"with {an(top)} {shirt} and {legs} {pants}" + (" and a backpack" if bag else "")]
        options += self.by([[f"in {top} on top and {legs} {pants}{tail}"]], [[f"clad in {an(top)} {shirt} and {legs} {pants}{tail}"]])
        if not bag:
            options += [f"(top: {top}; {pants}: {legs})"]
        else:
            options += [f"({top} {shirt}, {legs} {pants}, backpack)"]
        if top == legs:
            options += [f"whose {shirt} and {pants} are both {top}" + (" and who has a backpack" if bag else "")]
        return self.rng.choice(options)

    def who(self):
        nouns = self.by(["a person", "someone", "somebody", "one person", "a person"], ["a person", "an individual", "one person", "a single person"])
        if self.f.walks and self.rng.random() < .25:
            nouns = self.pick("a pedestrian", "a pedestrian", "a person on foot")
        return (nouns + " " + self.clothes()).strip()

    def target(self):
        noun = self.by(["the person", "the person", "that person", "whoever is", "the one"], ["the person", "the individual", "the subject", "one person"])
        if not self.f.wear:
            noun = self.by(["the person", "that person", "the person in the frame", "the one person in the shot"],
                           ["the person", "the subject", "the individual in the frame", "the person being filmed"])
            return noun
        if noun == "whoever is":
            c = self.clothes()
            return noun + " " + c if c.startswith(("in", "wearing", "dressed")) else "the person " + c
        return (noun + " " + self.clothes()).strip()

    def outfit(self):
        """A sentence about the clothes, or None."""
        if not self.f.wear:
            return None
        top, legs, bag = self.f.wear
        t = self.tense
        was, were, wore = ("was", "were", "wore") if t == "past" else ("is", "are", "wears")
        tail = (self.pick(", plus a backpack", ", and there " + was + " a backpack too", ", with a backpack", " and carr" + ("ied" if t == "past" else "ies") + " a backpack")
                if bag else "")
        if tail.startswith(" and carr"):
            return f"the person {wore} {an(top)} top and {legs} pants,{tail}"
        return self.pick(f"the top {was} {top} and the pants {were} {legs}{tail}", f"clothing: {top} top, {legs} pants" + (", backpack" if bag else ""),
                         f"the person {wore} {an(top)} top with {legs} trousers{tail}", f"they {were} dressed in {an(top)} top and {legs} pants{tail}",
                         f"for the record: {an(top)} top and {legs} pants{tail}" if not tail.startswith(", and there") else f"the trousers {were} {legs} and the top {was} {top}{tail}")

    # ---- distance
    def far(self):
        d = self.m(self.f.distance)
        return self.by([f"from {d} away", f"from about {d} away", f"{d} away from {self.them()}", f"from {d} out", f"from {d} off", f"always {d} away",
                        f"with {d} between you and them" if self.tense == "order" else f"with {d} between the drone and them"],
                       [f"at a distance of {d}", f"from a distance of {d}", f"at {self.f.distance} meters' distance" if self.f.distance != 1 else "from 1 meter away", f"with a separation of {d}",
                        f"at a slant range of {d}", f"from a range of roughly {d}", f"at a mean distance of {d}", f"at a line-of-sight distance of {d}"])

    def far_order(self):
        d = self.m(self.f.distance)
        k = self.f.distance
        return self.by([f"stay {d} away from {self.them()}", f"keep the drone {d} from {self.them()}", f"leave {d} between the drone and {self.them()}", f"don't lose the {k}-meter gap to {self.them()}",
                        f"try to hold it at {d} from {self.them()}", f"{d} is how far away you want to be", f"you should be {d} from {self.them()} the whole time",
                        f"make sure the drone is {d} away from {self.them()}", f"how far away? {cap(d)}"],
                       [f"maintain a distance of {d} from {self.them()}", f"the distance to {self.them()} should be {d}", f"keep the separation between aircraft and person at {d}",
                        f"hold a {k}-meter slant range", f"a distance of {d} is to be kept throughout", f"fly so that {d} separate the drone from {self.them()}" if k != 1 else "keep one meter from the person",
                        f"the drone is to remain {d} from {self.them()}", f"the line from drone to person should measure {d}"])

    def far_told(self):
        d = self.m(self.f.distance)
        k = self.f.distance
        v = self.v
        return self.by([f"the drone {v('stay')} {d} away from {self.them()}", f"the drone {v('be')} about {d} from {self.them()} on average", f"there {v('be', k != 1)} {d} between the drone and {self.them()}",
                        f"the drone {v('keep')} a {k}-meter gap", f"it {v('be', False)} {d} from the drone to {self.them()}", f"the drone {v('hang')} {d} away from {self.them()}",
                        f"distance-wise, the drone {v('be')} {d} from {self.them()}", f"{d} {v('be')} the distance from drone to person"],
                       [f"the drone {v('maintain')} a distance of {d} from {self.them()}", f"the mean distance between drone and person {v('be')} {d}", f"the separation {v('average')} {d}",
                        f"{self.them()} {v('be')} followed at a distance of {d}" if self.f.walks and not self.tense == "order" else f"{self.them()} {v('be')} filmed from a distance of {d}",
                        f"the slant range from the drone to {self.them()} {v('come')} to {d}", f"a distance of {d} {v('be')} kept between the drone and {self.them()}",
                        f"measured along the line of sight, {self.them()} {v('be')} {d} from the drone", f"the drone's distance from {self.them()} {v('amount')} to {d} on average"]).replace("them was", "they were").replace("them is", "they are")

    def far_note(self):
        d = self.m(self.f.distance)
        return self.pick(f"distance: {d}", f"distance {d}", f"{d} from the person", f"range to person: {d}", f"drone-to-person distance: {d}", f"gap of {d}", f"dist. = {self.f.distance} m",
                         f"{d} away", f"separation, drone to person: {d}", f"slant distance {d}")

    # ---- pitch
    def sides(self):
        p = self.f.pitch
        return (self.deg(abs(p)), "down", "below", "downward") if p > 0 else (self.deg(abs(p)), "up", "above", "upward")

    def view(self):
        if self.f.pitch == 0:
            return self.by(["with the camera dead level", "with no tilt on the camera", "with the camera pointed right at the horizon", "camera level", "with zero tilt", "keeping the camera flat, no up or down tilt",
                            "with the lens straight ahead and level"],
                           ["with the camera level", "with the optical axis horizontal", "with the camera aimed at the horizon", "with a camera pitch of 0 degrees", "the camera being held level",
                            "with the lens kept horizontal", "with the camera neither raised nor lowered from the horizontal"])
        a, d, b, w = self.sides()
        k = abs(self.f.pitch)
        return self.by([f"with the camera tilted {d} {a}", f"with the camera {a} {b} the horizon", f"camera tilted {a} {d}", f"with the lens pointing {a} {d} from level", f"with the camera angled {d} at {a}",
                        f"with a {k}-degree {w} tilt on the camera", f"the camera looking {d} by {a}", f"with {a} of {w} camera tilt"],
                       [f"with the camera pitched {a} {b} the horizon", f"with the camera inclined {w} by {a}", f"with the optical axis {a} {b} the horizontal", f"the camera angled {a} {b} horizontal",
                        f"with the camera aimed {w} at {a} to the horizon", f"with a {w} camera pitch of {a}", f"with the line of sight {a} {b} the horizon", f"the lens directed {a} {b} the horizon"])

    def view_order(self):
        if self.f.pitch == 0:
            return self.by(["keep the camera level", "don't tilt the camera up or down", "leave the camera flat, right at the horizon", "camera stays level", "no camera tilt, please", "just point the lens straight at the horizon",
                            "zero tilt on the gimbal", "the camera shouldn't look up or down"],
                           ["hold the camera level", "the camera should be level with the horizon", "set the camera pitch to 0 degrees", "keep the optical axis horizontal", "aim the camera at the horizon", "the camera is to remain horizontal",
                            "do not pitch the camera either up or down", "let the lens look along the horizontal"])
        a, d, b, w = self.sides()
        k = abs(self.f.pitch)
        return self.by([f"tilt the camera {d} {a}", f"point the camera {a} {b} the horizon", f"the camera needs to look {d} at {a}", f"set the gimbal to {a} {d}", f"angle the lens {d} by {a}", f"you want the camera {a} {b} level",
                        f"give the camera a {k}-degree {w} tilt", f"for the camera, go {a} {d} from the horizon", f"camera goes {a} {d}"],
                       [f"pitch the camera {a} {b} the horizon", f"hold the camera at {a} {b} horizontal", f"the camera should point {a} {b} the horizon", f"incline the camera {w} by {a}", f"set a {w} camera pitch of {a}",
                        f"the optical axis should lie {a} {b} the horizontal", f"keep the lens directed {w} at an angle of {a}", f"the camera is to be tilted {a} {w}", f"let the angle between the line of sight and the horizon be {a}, {w}"])

    def view_told(self):
        v = self.v
        if self.f.pitch == 0:
            return self.by([f"the camera {v('be')} level", f"there {v('be')} no tilt on the camera", f"the camera {v('stay')} flat, looking right at the horizon", f"the camera {v('point')} neither up nor down",
                            f"camera tilt {v('be')} zero", f"the lens {v('point')} straight at the horizon", f"the camera {v('look')} straight ahead with no tilt"],
                           [f"the camera {v('be')} held level", f"the camera {v('be')} aimed at the horizon", f"the camera pitch {v('be')} 0 degrees", f"the optical axis {v('be')} horizontal", f"the lens {v('remain')} horizontal",
                            f"the camera {v('be')} tilted neither up nor down", f"the line of sight {v('run')} along the horizontal"])
        a, d, b, w = self.sides()
        return self.by([f"the camera {v('be')} tilted {d} {a}", f"the camera {v('point')} {a} {b} the horizon", f"the camera {v('look')} {d} at {a}", f"camera tilt {v('be')} {a} {d}", f"the lens {v('point')} {d} by {a}",
                        f"the camera {v('sit')} at {a} {b} level", f"the camera {v('have')} {a} of {w} tilt", f"as for the camera, it {v('be')} angled {a} {d}"],
                       [f"the camera {v('be')} pitched {a} {b} the horizon", f"the camera {v('be')} inclined {w} by {a}", f"the optical axis {v('run')} {a} {b} the horizontal", f"the camera's {w} pitch {v('be')} {a}",
                        f"the lens {v('be')} directed {a} {b} the horizon", f"the camera {v('look')} {w} at an angle of {a}", f"the line of sight {v('point')} {a} {b} the horizontal", f"{a} {b} the horizon {v('be')} the camera angle"])

    def view_note(self):
        if self.f.pitch == 0:
            return self.pick("camera: level", "camera level", "pitch: 0°", "camera tilt: none", "camera angle: horizontal", "camera at the horizon (0°)", "camera pitch 0 degrees", "lens horizontal", "no camera tilt", "gimbal level")
        a, d, b, w = self.sides()
        return self.pick(f"camera: {a} {b} the horizon", f"camera {a} {d}", f"pitch: {a} {d}", f"camera tilt: {a} {d}", f"camera angle: {a} {b} horizontal", f"camera {a} {b} the horizon", f"{w} camera pitch of {a}",
                         f"lens tilted {d} {a}", f"gimbal {a} {d}", f"camera tilted {w}, {a}")

    # ---- altitude (None when 0)
    def high(self):
        if self.f.altitude < 1:
            return ""
        h = self.m(self.f.altitude)
        return self.by([f"{h} up", f"at {h} up", f"{h} above their feet", f"at a height of {h}", f"{h} off the ground", f"at {h} of altitude"],
                       [f"at an altitude of {h}", f"at a height of {h}", f"{h} above the level of the person's feet", f"{h} above the ground", f"at {h} above ground level"])

    def high_order(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        return self.by([f"fly {h} up", f"keep the drone {h} above their feet", f"your height should be {h}", f"stay {h} off the ground", f"you want {h} of altitude", f"go {h} high"],
                       [f"fly at an altitude of {h}", f"hold a height of {h}", f"the altitude should be {h} above the person's feet", f"the drone is to fly {h} above the ground", f"set the altitude to {h}", f"maintain {h} of height above the person's feet"])

    def high_told(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        v = self.v
        return self.by([f"the drone {v('be')} {h} up", f"the drone {v('fly')} {h} above their feet", f"the drone's height {v('be')} {h}", f"the drone {v('stay')} {h} off the ground", f"height-wise, the drone {v('be')} at {h}", f"the drone {v('fly')} {h} high"],
                       [f"the drone {v('fly')} at an altitude of {h}", f"the altitude {v('be')} {h}", f"the aircraft {v('be')} {h} above the person's feet", f"the flying height {v('come')} to {h}", f"a height of {h} {v('be')} maintained",
                        f"the drone {v('remain')} {h} above the level of the person's feet"])

    def high_note(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        return self.pick(f"altitude: {h}", f"height {h}", f"altitude {h}", f"drone height: {h}", f"{h} above the person's feet", f"{h} up", f"flying height: {h}")

    # ---- turns
    def adverbs(self):
        out = []
        for i, t in enumerate(self.f.turns):
            out.append(t + (" again" if i and self.f.turns[i - 1] == t else ""))
        return out

    def chain(self):
        a = self.adverbs()
        if len(a) < 2:
            return a[0]
        return self.pick(", then ".join(a), ", then ".join(a[:-1]) + ", and finally " + a[-1] if len(a) > 2 else " and then ".join(a), "first " + ", then ".join(a))

    def nouns(self):
        u = self.pick("a U-turn", "a U-turn", "an about-face", "a turnaround")
        names = []
        for i, t in enumerate(self.f.turns):
            x = dict(left="a left", right="a right", around=u)[t]
            if i and self.f.turns[i - 1] == t:
                x = x.replace("a left", "another left").replace("a right", "another right") if t != "around" else "another " + u.split(" ", 1)[1]
            names.append(x)
        return names

    def order(self):
        return self.pick(", ".join(self.f.turns), " - ".join(self.f.turns), ", then ".join(self.f.turns)) if len(self.f.turns) > 1 else self.f.turns[0]

    def same(self):
        t = self.f.turns
        to = dict(left="to the left", right="to the right", around="complete reversals")[t[0]]
        return f"{words(len(t))} turns, {'both' if len(t) == 2 else 'all'} {to}"

    def turns_told(self):
        v, (s, p), t = self.v, self.subj(), self.f.turns
        k = len(t)
        if not k:
            return self.by([f"{s} {v('make', p)} no turns", f"there {v('be', True)} no turns", f"{s} {v('do', p)} not turn at all".replace("will do", "will"), f"{s} {v('walk', p)} straight on without turning",
                            f"{s} never {v('turn', p)}" if self.tense != "future" else f"{s} won't turn", f"{s} {v('go', p)} straight, zero turns", f"no lefts, no rights: {s} {v('go', p)} straight"],
                           [f"no turns {v('be', True)} made", f"{s} {v('make', p)} no turn", f"the route {v('include')} no turns", f"{s} {v('proceed', p)} straight ahead, without a turn", f"{s} {v('walk', p)} without turning",
                            f"at no point {'did ' + s + ' turn' if self.tense == 'past' else 'will ' + s + ' turn' if self.tense == 'future' else ('do ' if p else 'does ') + s + ' turn'}", f"the walk {v('have')} no turns"])
        if k > 1 and len(set(t)) == 1 and self.rng.random() < .4:
            return self.pick(f"{s} {v('make', p)} {self.same()}", f"there {v('be', True)} {self.same()}")
        if k == 1:
            x = self.nouns()[0]
            full = dict(left="a left turn", right="a right turn", around="a U-turn")[t[0]]
            return self.by([f"{s} {v('turn', p)} {t[0]} once", f"{s} {v('make', p)} {x}, and that {'was' if self.tense == 'past' else 'is'} the only turn", f"just one turn: {t[0]}", f"{s} {v('turn', p)} {t[0]}, one time",
                            f"the only turn {v('be')} {full}", f"{s} {v('make', p)} one turn ({t[0]})", f"there {v('be')} just {full}, no other turn"],
                           [f"{s} {v('make', p)} a single turn: {full}", f"one turn {v('be')} made, {'a reversal' if t[0] == 'around' else 'to the ' + t[0]}", f"the route {v('include')} one turn, {full}", f"{s} {v('turn', p)} {t[0]} a single time",
                            f"the sole turn {v('be')} {full}", f"{s} {v('turn', p)} once, namely {t[0]}", f"{full} {v('be')} the only turn of the walk"])
        c = words(k)
        return self.by([f"{s} {v('turn', p)} {self.chain()}", f"{s} {v('make', p)} {listed(self.nouns(), 'and then')}", f"turns go like this: {self.order()}", f"{s} {v('make', p)} {c} turns ({self.order()})",
                        f"first {s} {v('turn', p)} {', then '.join(self.adverbs())}", f"{c} turns total: {self.order()}", f"{s} {v('take', p)} {listed(self.nouns())}, in that order", f"it {v('be')} {', then '.join(self.nouns())}"],
                       [f"{s} {v('turn', p)} {self.chain()}", f"{s} {v('make', p)} {c} turns, in this order: {self.order()}", f"{c} turns {v('be', True)} made: {self.order()}", f"the route {v('include')} {c} turns, namely {listed(self.nouns(), 'and then')}",
                        f"the turns {v('be', True)}, in sequence, {self.order()}", f"the walk {v('include')} {listed(self.nouns(), 'and then')}, {c} turns in all", f"in order, the {c} turns {v('be', True)} {listed(self.f.turns)}",
                        f"the sequence of turns {v('run')} as follows: {self.order()}"])

    def turning(self):
        """A participle phrase."""
        t = self.f.turns
        if not t:
            return self.pick("without turning", "making no turns", "without a single turn", "never turning", "with no turns along the way")
        return self.pick(f"turning {self.chain()}", f"making {listed(self.nouns(), 'and then')}", f"with {words(len(t))} turn{'s' if len(t) > 1 else ''} along the way ({self.order()})",
                         f"turning {self.chain()}", f"taking {', then '.join(self.nouns())}")

    def turns_note(self):
        t = self.f.turns
        if not t:
            return self.pick("turns: none", "no turns", "0 turns", "turns: 0", "zero turns")
        k = len(t)
        return self.pick(f"turns: {', '.join(t)}", f"turns ({k}): {', '.join(t)}", f"{k} turn{'s' if k > 1 else ''}: {', then '.join(t)}", "turns: " + " > ".join(t), "turns: " + " -> ".join(t),
                         "turns: " + " ".join(f"{i + 1}) {x}" for i, x in enumerate(t)), f"turns, in order: {listed(t)}" if k > 1 else f"one turn, {t[0]}")

    # ---- stops
    def times(self, k):
        return {1: "once", 2: "twice"}.get(k, f"{words(k)} times")

    def stops_told(self):
        v, (s, p), k, z = self.v, self.subj(), self.f.stops, self.f.standing
        if not k:
            return self.by([f"{s} never {v('stop', p)}" if self.tense != "future" else f"{s} won't stop", f"there {v('be', True)} no stops", f"no stops at all", f"{s} {v('keep', p)} moving the whole time", f"{s} {v('walk', p)} without a single break",
                            f"{s} {v('make', p)} zero stops", f"{s} {v('do', p)} not pause".replace("will do", "will")],
                           [f"no pauses {v('be', True)} made", f"{s} {v('do', p)} not stop".replace("will do", "will"), f"the walk {v('include')} no pauses", f"{s} {v('proceed', p)} without pausing", f"the walk {v('be')} not interrupted",
                            f"at no point {'did ' + s + ' stop' if self.tense == 'past' else 'will ' + s + ' stop' if self.tense == 'future' else ('do ' if p else 'does ') + s + ' stop'}", f"{s} {v('walk', p)} without interruption"])
        n = self.times(k)
        if z < 1:
            return self.pick(f"{s} {v('stop', p)} {n}", f"{s} {v('pause', p)} {n}", f"{s} {v('make', p)} {words(k)} stop{'s' if k > 1 else ''}", f"there {v('be', k > 1)} {words(k)} pause{'s' if k > 1 else ''}")
        z = self.s(z)
        if k == 1:
            return self.by([f"{s} {v('stop', p)} once, for {z}", f"there {v('be')} one stop of {z}", f"{s} {v('take', p)} a single {self.f.standing}-second break", f"{s} {v('stop', p)} one time and just {v('stand', p)} there for {z}",
                            f"one stop, {z} long", f"{s} {v('pause', p)} for {z} one time", f"the only stop {v('last')} {z}"],
                           [f"{s} {v('pause', p)} once, for {z}", f"a single pause of {z} {v('be')} made", f"the walk {v('be')} interrupted once, for {z}", f"there {v('be')} one pause, which {v('last')} {z}", f"one pause {v('last')} {z}",
                            f"{s} {v('halt', p)} one time and {v('remain', p)} standing for {z}", f"the sole pause {v('come')} to {z}"])
        c = words(k)
        return self.by([f"{s} {v('stop', p)} {n}, for {z} total", f"there {v('be', True)} {c} stops adding up to {z}", f"{s} {v('take', p)} {c} breaks, {z} all together", f"{c} stops, {z} combined", f"{s} {v('pause', p)} {n} and {v('stand', p)} there for {z} in all",
                        f"{z} of standing around, split over {c} stops", f"if you add up the {c} stops you get {z}"],
                       [f"{s} {v('pause', p)} {n}, for a total of {z}", f"{c} pauses {v('be', True)} made, lasting {z} altogether", f"the walk {v('be')} interrupted {n}, for {z} in all", f"there {v('be', True)} {c} pauses, which together {v('last', True)} {z}",
                        f"{c} pauses {v('amount', True)} to {z} of standing", f"{s} {v('stand', p)} still {n}, {z} altogether", f"the {c} pauses {v('take', True)} {z} in total"])

    def stopping(self):
        k, z = self.f.stops, self.f.standing
        if not k:
            return self.pick("without stopping", "without a pause", "with no stops", "never stopping", "without any pauses")
        if z < 1:
            return f"stopping {self.times(k)}"
        z = self.s(z)
        if k == 1:
            return self.pick(f"stopping once for {z}", f"with one pause of {z}", f"pausing a single time, for {z}", f"with a single {self.f.standing}-second stop")
        return self.pick(f"stopping {self.times(k)} for {z} in total", f"with {words(k)} pauses totaling {z}", f"pausing {self.times(k)}, {z} altogether", f"with {words(k)} stops that add up to {z}")

    def stops_note(self):
        k, z = self.f.stops, self.f.standing
        if not k:
            return self.pick("stops: none", "no stops", "0 stops", "pauses: 0", "no pauses")
        u = "s" if k > 1 else ""
        if z < 1:
            return f"stops: {k}"
        return self.pick(f"stops: {k} ({self.s(z)}{' total' if k > 1 else ''})", f"{k} stop{u}, {self.s(z)}{' in all' if k > 1 else ''}", f"pauses: {k}, standing time {self.s(z)}", f"{k} pause{u} / {self.s(z)} standing",
                         f"stops: {k}; time standing: {self.s(z)}")

    # ---- way, duration, speed
    def walk_told(self):
        """A sentence with way, duration and speed."""
        v, (s, p) = self.v, self.subj()
        w, d, x = self.m(self.f.way), self.s(self.f.duration), self.ms()
        return self.by([f"{s} {v('walk', p)} {w} at {x}, and the whole flight {v('last')} {d}", f"the flight {v('take', False)} {d}, and in that time {s} {v('cover', p)} {w} at {x}", f"{w} walked, {d} of flight, walking speed {x}",
                        f"{s} {v('walk', p)} {w} total, moving at {x}; the clip {v('be')} {d} long", f"walking at {x}, {s} {v('cover', p)} {w}; the flight {v('last')} {d}", f"{s} {v('go', p)} {w} on foot during the {self.f.duration}-second flight, at a walking speed of {x}",
                        f"walking speed {v('be')} {x}, total walk {v('be')} {w}, and the flight {v('run')} {d}"],
                       [f"over a flight of {d}, {s} {v('walk', p)} {w} at a mean speed of {x}", f"the flight {v('last')} {d}, during which {s} {v('cover', p)} {w} at an average walking speed of {x}",
                        f"a total of {w} {v('be')} walked at {x}; the duration of the flight {v('be')} {d}", f"the length of the walk {v('be')} {w}, the mean walking speed {x}, and the flight time {d}",
                        f"in {d} of flight, {w} {v('be', True)} covered on foot at {x}" if self.f.way != 1 else f"in {d} of flight, {s} {v('walk', p)} one meter at {x}", f"at a mean walking speed of {x}, {s} {v('travel', p)} {w} on foot in the course of the flight, which {v('last')} {d}",
                        f"the recorded flight {v('run')} for {d}; the walk {v('measure')} {w} and the walking speed {v('average')} {x}"])

    def walk_notes(self):
        return [self.pick(f"walked {self.m(self.f.way)}", f"path: {self.m(self.f.way)}", f"length of walk: {self.m(self.f.way)}", f"total walk {self.m(self.f.way)}", f"distance walked: {self.m(self.f.way)}"),
                self.pick(f"flight time {self.s(self.f.duration)}", f"duration: {self.s(self.f.duration)}", f"{self.s(self.f.duration)} long", f"flight length: {self.s(self.f.duration)}", f"clip: {self.s(self.f.duration)}"),
                self.pick(f"walking speed {self.ms()}", f"speed: {self.ms()}", f"pace: {self.ms()}", f"mean walking speed {self.ms()}", f"avg. walking speed: {self.ms()}")]

    def stands(self, timed=True):
        v, (s, p) = self.v, self.subj()
        d = self.s(self.f.duration)
        if not timed:
            return self.pick(f"{s} {v('stand', p)} in one place", f"{s} {v('stay', p)} put", f"{s} {v('stand', p)} on one spot the whole time", f"{s} {v('remain', p)} standing in one place",
                             f"{s} {v('do', p)} not walk".replace("will do", "will"), f"there {v('be')} no walking here, only standing")
        return self.by([f"{s} {v('stand', p)} in one spot for all {d}", f"{s} just {v('stand', p)} there for {d}", f"for {d} {s} {v('stay', p)} put", f"no walking here: {s} {v('stand', p)} in the same place for {d}",
                        f"{s} {v('do', p)} not go anywhere and {v('stand', p)} still for the full {d}".replace("will do", "will"), f"it {v('be')} {d} of somebody standing in one place", f"the whole {self.f.duration}-second flight, {s} {v('stand', p)} on the same spot"],
                       [f"{s} {v('remain', p)} standing on one spot for {d}", f"during the {self.f.duration}-second flight {s} {v('stand', p)} in one place", f"the flight {v('last')} {d}, and {s} {v('stand', p)} in the same place throughout",
                        f"for the entire flight of {d}, {s} {v('stand', p)} still", f"{s} {v('do', p)} not walk but {v('stand', p)} on a single spot for {d}".replace("will do", "will"), f"throughout the flight, {d} in length, {s} {v('stay', p)} on the same spot",
                        f"the person's position {v('be')} unchanged: standing on one spot for {d}"])

    # ---- assembling
    def say(self, parts, joint=None):
        parts = [p for p in parts if p]
        return " ".join(cap(p) + ("" if p[-1] in ".?!" else ".") for p in parts)

    def mix(self, parts):
        """Sentences, some of them joined."""
        parts = [p for p in parts if p]
        out = []
        while parts:
            a = parts.pop(0)
            if parts and self.rng.random() < .35 and not any(c in a + parts[0] for c in (":", ";", "?", " and ")):
                a += self.pick("; ", ", and ", "; also, " if self.student else "; ") + parts.pop(0)
            out.append(a)
        return self.say(out)

    def notes(self, items):
        items = [i for i in items if i]
        style = self.pick("bullets", "stars", "semi", "pipe", "number", "slash", "lines", "fragments")
        if style == "bullets":
            return "\n".join("- " + i for i in items)
        if style == "stars":
            return "\n".join("* " + cap(i) for i in items)
        if style == "semi":
            return cap("; ".join(items)) + "."
        if style == "pipe":
            return " | ".join(items)
        if style == "number":
            return "\n".join(f"{k + 1}. {cap(i)}" for k, i in enumerate(items))
        if style == "lines":
            return "\n".join(cap(i) for i in items)
        if style == "slash":
            return " // ".join(items)
        return " ".join(cap(i) + "." for i in items)

    def extras(self):
        """Things an instruction may announce about the person."""
        f, out = self.f, []
        if not f.walks:
            return [self.pick(None, self.stands(False), self.stands(False))]
        self.tense = self.pick("future", "future", "present")
        if self.rng.random() < .5:
            out.append(self.turns_told())
        if self.rng.random() < .35:
            out.append(self.stops_told())
        if self.rng.random() < .2:
            out.append(self.walk_told())
        elif self.rng.random() < .25:
            s, p = self.subj()
            out.append(self.pick(f"expect the walk to be {self.m(f.way)} long", f"{s} {self.v('cover', p)} {self.m(f.way)} in all", f"the walking speed {self.v('be')} {self.ms()}", f"the flight should take {self.s(f.duration)}",
                                 f"keep this up for {self.s(f.duration)}"))
        self.tense = "order"
        return out

    def film(self):
        if not self.f.walks:
            return self.pick("film", "keep the camera on", "record", "get a shot of", "keep filming")
        return self.pick("follow", "track", "film", "keep following", "keep filming", "accompany") if not self.student else self.pick("follow", "track", "film", "keep up with", "stay with", "follow along with")

    def stand_in(self):
        """' , who stands still' in an instruction for a person on one spot."""
        if self.f.walks:
            return ""
        return self.pick("", ", who is standing in one place", ", who stays on one spot", ", who is just standing there", ", who does not walk")

    def instruction(self, flight):
        self.begin(flight, "order")
        f = flight
        more = self.extras()
        self.tense = "order"
        high = self.high_order() if self.rng.random() < .45 else None
        k = self.rng.randrange(15)
        film, who, st = self.film(), self.target(), self.stand_in()
        if st and more and more[0]:
            st = ""
        up = self.high() if high else ""
        upc = f", {up}" if up else ""
        close = "," if st or f.wear else ""
        if k == 0:
            return self.say([f"{film} {who}{st}{close} {self.far()}{upc}, {self.view()}"] + more)
        if k == 1:
            return self.say([self.pick(f"your target is {who}" if f.wear else f"{film} {who}", f"the one to {('follow' if f.walks else 'film')} is {who}" if f.wear else f"keep the camera on {who}", f"find {who}", f"look for {who}", f"this one is about {who}"), self.far_order(), self.view_order(), high] + more)
        if k == 2:
            return self.notes([self.pick(f"{film} {who}", f"target: {who}", f"who: {who}", f"subject: {who}"), self.far_note(), self.view_note(), self.high_note() if high else None]
                              + ([self.turns_note()] if f.walks and self.pick(True, False) else []) + ([self.stops_note()] if f.walks and self.pick(True, False, False) else [])
                              + ([self.pick("person stands in one place", "person: standing, not walking", "no walking")] if not f.walks else []))
        if k == 3:
            ask = self.pick("could you", "can you", "would you", "would you please", "mind flying so that you")
            return self.say([f"{ask} {film} {who}{st}{close} {self.far()}{upc}, {self.view()}?"] + more)
        if k == 4:
            clause = self.pick("while they walk", "as they walk", "for as long as they keep walking", "as the walk goes on") if f.walks else self.pick("while they stand there", "as they stand in place", "for as long as they stand there")
            return self.say([f"{film} {who}", f"{clause}, {self.far_order()}" if not self.student else f"{clause}, {self.pick('stay', 'be', 'keep the drone')} {self.m(f.distance)} away", self.view_order(), high] + more)
        if k == 5:
            d = self.m(f.distance)
            return self.say([f"{self.pick('from', 'at')} {self.pick('a distance of ' + d, d + ' away')}{upc}, {self.view()}, {film} {who}{st}"] + more)
        if k == 6:
            start = self.by(["what we need here is", "we're looking for", "ok, so we want", "for this one I'd like"], ["what is wanted is", "the assignment is", "please produce", "required:"])
            kind = self.pick("a shot of", "footage of", "a clip of", "a continuous shot of")
            return self.say([f"{start} {kind} {who}{st}{close} {self.pick('taken', 'filmed', 'recorded')} from {self.m(f.distance)} away{upc}, {self.view()}"] + more)
        if k == 7:
            return self.mix([self.view_order(), self.far_order(), high, self.pick(f"the person to {'follow' if f.walks else 'film'} is {who}" if f.wear else f"now {film} {who}", f"that way, {film} {who}", f"with that set, {film} {who}", f"the job is to {film} {who}")] + more)
        if k == 8:
            opening = self.by([f"ok so there's {self.who()}", f"you'll see {self.who()}", f"there's {self.who()}"], [f"the subject of this flight is {self.who()}", f"the flight concerns {self.who()}", f"there will be {self.who()}"])
            return self.say([opening + (self.pick(" who will be walking", "") if f.walks else ""), self.pick("follow them" if f.walks else "film them", "stay on them", "keep the camera on them")] + [self.mix([self.far_order(), self.view_order(), high])] + more)
        if k == 9:
            steps = [f"{self.pick('find', 'pick out', 'locate')} {who}", self.far_order(), self.view_order(), high] + more
            steps = [x for x in steps if x]
            return self.pick("\n", " ").join(f"{self.pick('')}{i + 1}) {cap(x)}" + ("" if x.endswith((".", "?")) else ".") for i, x in enumerate(steps))
        if k == 10:
            return self.say([f"the drone {self.pick('is to', 'should', 'shall', 'needs to')} {film} {who}{st}{close} {self.far().replace('you and', 'itself and')}{upc}, {self.view()}"] + more)
        if k == 11:
            return self.say([self.pick("two numbers matter here", "two settings to remember", "just two things to get right", "two values define the shot") + f": {self.m(f.distance)} to the person and " +
                             (f"{self.sides()[0]} of {self.sides()[3]} camera pitch" if f.pitch else "a camera pitch of zero"), high, f"with those, {film} {who}{st}"] + more)
        if k == 12:
            return self.mix([f"{film} {who}{st}", self.far_order()] + [high] + [self.view_order()] + more)
        if k == 13:
            self.tense = "present"
            a, b, c = self.far_told(), self.view_told(), self.high_told() if high else None
            self.tense = "order"
            return self.say([f"{film} {who}{st} {self.pick('in such a way that', 'so that')} {listed([x for x in (a, b, c) if x])}" if not st and self.pick(True, False) else f"{film} {who}{st}. {cap(self.pick('make sure that', 'see to it that'))} {listed([x for x in (a, b, c) if x])}"] + more)
        intro = self.say([f"{film} {who}, please"] if not st else [f"please {film} {who}{st}"])
        return intro + " " + self.pick("Settings: ", "Parameters: ", "Specs: ", "Setup: ") + "; ".join(x for x in [self.far_note(), self.view_note(), self.high_note() if high else None] if x) + "." + (" " + self.say(more) if any(more) else "")

    def description(self, flight):
        self.begin(flight, self.pick("past", "past", "present"))
        f, walks = flight, flight.walks
        drone = [self.far_told(), self.view_told(), self.high_told()]
        if self.pick(True, False):
            self.rng.shuffle(drone)
        k = self.rng.randrange(14)
        v = self.v
        up = self.high()
        upc = f", {up}" if up else ""
        if walks:
            doing = [self.walk_told(), self.turns_told(), self.stops_told()]
            if self.pick(True, False):
                self.rng.shuffle(doing)
        else:
            doing = [self.stands()]
        lead = self.by([f"this clip {v('be')} of {self.who()}", f"so in this one we {v('have', True)} {self.who()}", f"the drone {v('follow')} {self.who()}" if walks else f"the drone {'filmed' if self.tense == 'past' else 'films'} {self.who()}",
                        f"you can see {self.who()} in the video", f"the person in the video: {self.who()}"],
                       [f"the subject of the recording {v('be')} {self.who()}", f"the recording {'showed' if self.tense == 'past' else 'shows'} {self.who()}", f"{self.who()} {v('be')} {'followed' if walks else 'filmed'} by a drone",
                        f"the drone {v('follow')} {self.who()}" if walks else f"the camera {'recorded' if self.tense == 'past' else 'records'} {self.who()}", f"this flight {'concerned' if self.tense == 'past' else 'concerns'} {self.who()}"])
        if k == 0:
            return self.say([lead] + doing + drone)
        if k == 1:
            return self.mix([lead] + drone + doing)
        if k == 2:
            items = [self.pick(f"person: {self.who()}", f"who: {self.who()}", f"subject: {self.who()}", self.who())]
            rest = (self.walk_notes() + [self.turns_note(), self.stops_note()]) if walks else [self.pick(f"stands in one spot, {self.s(f.duration)}", f"standing still for {self.s(f.duration)}", f"standing the whole time ({self.s(f.duration)})", f"no walking; stands in one place for {self.s(f.duration)}")]
            d = [self.far_note(), self.view_note(), self.high_note()]
            self.rng.shuffle(rest)
            return self.notes(items + (rest + d if self.pick(True, False) else d + rest))
        if k == 3 and walks:
            how = self.pick(f"{self.turning()} and {self.stopping()}", f"{self.stopping()}, {self.turning()}")
            return self.say([f"{self.pick('in', 'over', 'within')} a flight of {self.s(f.duration)}, {self.who()} {v('walk')} {self.m(f.way)} at {self.ms()}, {how}"] + [self.mix(drone)])
        if k == 4 and walks:
            verb = self.pick("walking", "covering", "walking")
            return self.say([f"{self.pick('the footage', 'the clip', 'the recording', 'this flight')}, {self.s(f.duration)} long, {'showed' if self.tense == 'past' else 'shows'} {self.who()} {verb} {self.m(f.way)} at {self.ms()}"] +
                            [self.turns_told(), self.stops_told()] + [f"{self.pick('it was all filmed', 'all of it was shot', 'everything was recorded') if self.tense == 'past' else 'it is all filmed'} from {self.m(f.distance)} away{upc}, {self.view()}"])
        if k in (3, 4):
            return self.say([f"{self.who()} {v('stand')} {self.pick('in one place', 'on one spot', 'in the same spot')} for {self.s(f.duration)} while the drone {'filmed' if self.tense == 'past' else 'films'} them from {self.m(f.distance)} away{upc}, {self.view()}"])
        if k == 5:
            act = f"{v('walk')} {self.m(f.way)} at {self.ms()}" if walks else f"{v('stand')} in one place"
            end = [self.turns_told(), self.stops_told()] if walks else []
            head = f"{self.pick('from', 'keeping')} {self.m(f.distance)} away{upc}, {self.view()}, the drone {v('follow') if walks else ('filmed' if self.tense == 'past' else 'films')} {self.who()} for {self.s(f.duration)}"
            s, p = self.subj()
            mid = (f"{s} {v('walk', p)} {self.m(f.way)} at {self.ms()}" if walks else f"{s} {v('stand', p)} in one place the whole time")
            return self.say([head, mid] + end)
        if k == 6:
            qa = [("Who?", self.who())]
            if walks:
                w = [("How long was the walk?", self.m(f.way)), ("How fast?", self.ms()), ("How long was the flight?", self.s(f.duration)), ("Turns?", self.order() if f.turns else self.pick("no", "zero", "not one")),
                     ("Stops?", (f"{words(f.stops)}" + (f", {self.s(f.standing)} {'altogether' if f.stops > 1 else 'long'}" if f.standing else "")) if f.stops else self.pick("no", "zero", "not one"))]
            else:
                w = [("Doing what?", self.pick("standing in one spot", "just standing in place", "standing, not walking")), ("For how long?", self.s(f.duration))]
            a = self.sides()
            d = [("Drone how far from the person?", self.m(f.distance)), ("Camera?", f"{a[0]} {a[2]} the horizon" if f.pitch else "level")]
            if up:
                d += [("Drone how high?", self.m(f.altitude))]
            return " ".join(f"{q} {cap(x)}." for q, x in qa + w + d)
        if k == 7 and walks:
            return self.say([f"{self.who()} {v('walk')} {self.m(f.way)} {self.turning()}" if f.turns == [] else f"{self.who()} {v('walk')} {self.m(f.way)}, {self.turning()}"] + [self.stops_told()] +
                            [self.pick(f"walking speed: {self.ms()}", f"the walking speed {v('average')} {self.ms()}", f"on the move, the speed {v('be')} {self.ms()}"), self.pick(f"the flight {v('last')} {self.s(f.duration)}", f"flight time {v('be')} {self.s(f.duration)}",
                             f"all this {v('take')} {self.s(f.duration)}", f"the whole thing {v('be')} {self.s(f.duration)} long")] + [listed([x for x in drone if x]) if not any(":" in (x or "") for x in drone) else self.say(drone)])
        if k == 8:
            who = [self.pick(f"the one on camera {v('be')} {self.who()}", f"on camera: {self.who()}", f"on screen there {v('be')} {self.who()}", f"the drone's subject {v('be')} {self.who()}")]
            return self.say(self.pick(drone[:1] + who + doing + drone[1:], doing[:0] + who + drone[:2] + doing + drone[2:], who + [self.mix(doing)] + [self.mix(drone)]))
        if k == 9:
            person = self.outfit()
            first = self.pick("one person on camera", "there " + v("be") + " one person in the shot", "a drone " + ("followed" if self.tense == "past" else "follows") + " one person" if walks else "a drone " + ("filmed" if self.tense == "past" else "films") + " one person")
            return self.say([first, person] + doing + drone)
        if k == 10:
            drones = "; ".join(x for x in [self.far_note(), self.view_note(), self.high_note()] if x)
            if walks:
                walking = "; ".join(self.walk_notes() + [self.turns_note(), self.stops_note()])
            else:
                walking = self.pick(f"stands on one spot; duration {self.s(f.duration)}", f"standing in place for {self.s(f.duration)}", f"no walking, just standing for {self.s(f.duration)}")
            a = (self.pick("Drone", "Drone side", "Aircraft"), drones)
            b = (self.pick("Person", "Walker" if walks else "Person", "Subject"), f"{self.who()}; {walking}")
            pair = self.pick((a, b), (b, a))
            return self.pick("\n", " ").join(f"{x}: {y}." for x, y in pair)
        if k == 11:
            verb = "followed" if walks else "filmed"
            be = "was" if self.tense == "past" else "is"
            head = f"{self.who()} {be} {verb} {self.far()}{upc}, {self.view()}" if self.tense != "order" else ""
            return self.say([head] + doing)
        if k == 12 and walks:
            chron = [f"{self.who()} {v('be')} out walking" if self.student else f"{self.who()} {v('be')} on foot"]
            s, p = self.subj()
            how = self.pick(f"{s} {v('cover', p)} {self.m(f.way)}, {self.turning()}, {self.stopping()}, at {self.ms()}", f"{self.turning()}, {s} {v('cover', p)} {self.m(f.way)} at {self.ms()}, {self.stopping()}")
            return self.say(chron + [how, f"the flight {v('last')} {self.s(f.duration)}"] + [self.mix(drone)])
        return self.say([lead] + [self.mix(drone + doing)])

    # ---- wrong texts
    def add(self, text, tail):
        end = text[-1] if text[-1] in ".?!" else ""
        body = text[:-1] if end else text
        return body + ", " + tail + (end or "")

    def foreign(self, text):
        if self.rng.random() < .65:
            return self.add(text, self.rng.choice(self.things))
        who = self.rng.choice(self.persons)
        end = "" if text[-1] in ".?!" else "."
        return text + end + " " + self.pick(f"The person is {an(who)}.", f"{cap(an(who))} is in the shot too.", f"It is {an(who)}, by the way.", f"The one on camera is {an(who)}.", f"Next to them is {an(who)}.", f"{cap(an(who))} walks by.", f"They're {an(who)}.")

    def heading(self, text, direction):
        end = "" if text[-1] in ".?!" else "."
        d = direction
        return text + end + " " + self.pick(f"The person walks {d}.", f"They're headed {d}.", f"The walk goes toward the {d}.", f"The direction of the walk is {d}.", f"They walk in {an(d)}erly direction.", f"The person is {d}bound.", f"The walker's heading: {d}.",
                                            f"{cap(d)} is the way they walk.", f"The person is walking toward the {d}.", f"Which way do they walk? {cap(d)}.", f"The route leads {d}.")


ZH_DIGITS = "零一二三四五六七八九"


def zh_words(n, two="两"):
    if n == 2:
        return two
    if n < 10:
        return ZH_DIGITS[n]
    if n < 20:
        return "十" + (ZH_DIGITS[n % 10] if n % 10 else "")
    if n < 100:
        return ZH_DIGITS[n // 10] + "十" + (ZH_DIGITS[n % 10] if n % 10 else "")
    if n < 1000:
        r = n % 100
        tail = "" if not r else "零" + ZH_DIGITS[r] if r < 10 else ("一" if r < 20 else "") + zh_words(r, "二")
        return ("两" if n // 100 == 2 else ZH_DIGITS[n // 100]) + "百" + tail
    return str(n)


class NineteenthChinese(Grammar):
    code = "zh"
    things = ["旁边有一座喷泉", "天上打着雷", "身边跟着两条狗", "路边停着一辆消防车", "天正下着雪", "路灯全亮着", "手里撑着一把伞", "推着一辆婴儿车", "正赶上日落", "周围站满了围观的人", "对面是一家加油站",
              "手里端着一杯咖啡", "身后是一座教堂", "沿着一条运河", "一列火车正好开过", "边走边打电话", "四周大雾弥漫", "旁边立着一尊铜像", "鼻梁上架着墨镜", "一位骑车人从旁经过", "穿过一片菜市场", "脚边有一只猫", "头上戴着草帽"]
    persons = ["护士", "渔夫", "老太太", "邮递员", "中学生", "士兵", "小男孩", "新娘", "建筑工人", "神父", "年轻女子", "教授"]

    # ---- tools
    def begin(self, flight):
        self.f = flight
        self.student = self.pick(True, False)
        self.spelled = self.rng.random() < .12
        self.symbols = self.student and not self.spelled and self.rng.random() < .2

    def by(self, student, editor):
        return self.rng.choice(student if self.student else editor)

    def m(self, k):
        return zh_words(k) + "米" if self.spelled else f"{k}m" if self.symbols else f"{k}米"

    def s(self, k):
        return zh_words(k) + self.pick("秒", "秒钟") if self.spelled else f"{k}s" if self.symbols else f"{k}" + self.pick("秒", "秒", "秒钟")

    def deg(self, k):
        return zh_words(k) + "度" if self.spelled else f"{k}°" if self.symbols else f"{k}度"

    def ms(self):
        x = f"{self.f.speed:.1f}"
        if self.spelled:
            a, b = x.split(".")
            return f"每秒{zh_words(int(a), '二')}点{ZH_DIGITS[int(b)]}米"
        if self.symbols:
            return f"{x}m/s"
        return self.pick(f"每秒{x}米", f"{x}米每秒", f"{x}米/秒") if self.student else self.pick(f"每秒{x}米", f"每秒{x}米", f"{x}米/秒")

    def cnt(self, k):
        return self.pick(zh_words(k), str(k)) if self.student else zh_words(k)

    # ---- who
    def col(self, c):
        return ZH_COLOURS[c] + "色"

    def clothes(self):
        if not self.f.wear:
            return ""
        top, legs, bag = self.f.wear
        t, g = self.col(top), self.col(legs)
        if top not in ("orange", "beige", "brown", "pink") and legs not in ("orange", "beige", "brown", "pink") and self.pick(True, False, False):
            t, g = ZH_COLOURS[top], ZH_COLOURS[legs]
        b = self.pick("、背双肩包", "、背着背包", "、背着双肩包", "，还背着背包") if bag else self.pick("", "", "", "", "、没背包")
        opts = [f"穿{t}上衣、{g}裤子{b}", f"身穿{t}上衣、{g}裤子{b}", f"上身穿{t}上衣、下身穿{g}裤子{b}", f"{t}上衣配{g}裤子{b}", f"穿着{t}上衣和{g}裤子{b}"]
        if bag:
            opts += [f"背着背包、穿{t}上衣和{g}裤子", f"背双肩包、上穿{t}上衣下穿{g}裤子"]
        opts += self.by([[f"上面{self.col(top)}衣服、下面{self.col(legs)}裤子{b}", f"上衣{self.col(top)}裤子{self.col(legs)}{b}"]], [[f"身着{t}上衣、{g}长裤{b}".replace("长裤", "裤子"), f"上着{t}衣、下着{g}裤{b}".replace("色衣", "色上衣").replace("色裤", "色裤子")]])
        if top == legs:
            opts += [f"上衣和裤子都是{self.col(top)}{b}"]
        return self.rng.choice(opts)

    def who(self, definite=False):
        c = self.clothes()
        if not c:
            if definite:
                return self.by(["那个人", "画面里那个人", "这个人", "镜头里的人", "要拍的那个人"], ["该人", "画面中人", "目标人物", "画面中的这个人", "被摄者"])
            return self.by(["一个人", "一个人", "一个人"] + (["一个行人", "一个走路的人"] if self.f.walks else []), ["一人", "一个人"] + (["一名行人", "一名步行者"] if self.f.walks else []))
        c = c.replace("，还", "、还")
        if definite:
            return self.by([f"那个{c}的人", f"{c}的那个人", f"{c}的人", f"那位{c}的人"], [f"{c}的人", f"一名{c}的人", f"{c}的被摄者", f"画面中{c}的人"])
        return self.by([f"一个{c}的人", f"一个{c}的人", f"一位{c}的人"], [f"一名{c}的人", f"一个{c}的人"] + ([f"一名{c}的行人"] if self.f.walks else []))

    def him(self):
        return self.by(["人", "这个人", "对方", "人"], ["该人", "被摄者", "目标人物", "此人"])

    def subj(self):
        return self.by(["这个人", "这人", "人", ""], ["此人", "该人", "被摄者", ""])

    # ---- distance
    def far_order(self):
        d, h = self.m(self.f.distance), self.him()
        return self.by([f"离{h}{d}", f"跟{h}保持{d}", f"和{h}隔开{d}", f"飞机离{h}要有{d}", f"距离控制在{d}", f"距离卡在{d}左右就行", f"别贴太近也别太远，就{d}", f"你跟{h}之间留{d}", f"无人机离{h}保持{d}远", f"{d}的距离要一直保持住"],
                       [f"与{h}保持{d}距离", f"无人机距{h}{d}", f"同{h}的间距保持在{d}", f"机身与{h}之间应相距{d}", f"以{d}为距，不远不近", f"拍摄距离定为{d}", f"全程保持{d}的距离", f"距离以{d}为宜", f"把与{h}的距离控制在{d}", f"机与人的间距须为{d}"])

    def far_told(self):
        d, h = self.m(self.f.distance), self.him()
        return self.by([f"无人机离{h}{d}", f"无人机跟{h}差不多一直隔着{d}", f"拍的时候离{h}平均{d}", f"飞机和{h}之间的距离是{d}", f"离人大概{d}", f"从{d}外拍的", f"无人机在{d}外拍着", f"跟人的平均距离是{d}", f"{h}离无人机有{d}", f"机子到{h}的直线距离是{d}"],
                       [f"无人机与{h}保持{d}距离", f"无人机距{h}约{d}", f"机、人平均相距{d}", f"拍摄距离为{d}", f"无人机在{d}外拍摄", f"其间无人机同{h}的平均间距为{d}", f"无人机至{h}的直线距离平均为{d}", f"无人机始终与{h}相距{d}左右", f"飞行中，无人机与{h}相隔{d}", f"镜头距{h}{d}"])

    def far_note(self):
        d = self.m(self.f.distance)
        return self.pick(f"距离{d}", f"距离：{d}", f"离人{d}", f"机人距离：{d}", f"拍摄距离{d}", f"与人相距{d}", f"直线距离{d}", f"人机间距：{d}", f"平均距离：{d}", f"距人{d}")

    def far(self):
        d = self.m(self.f.distance)
        return self.pick(f"在{d}外", f"从{d}外", f"隔着{d}", f"保持{d}的距离", f"离开{d}", f"以{d}的距离", f"在相距{d}处", f"距其{d}" if not self.student else f"在离人{d}的地方")

    # ---- pitch
    def view_order(self):
        p = self.f.pitch
        if p == 0:
            return self.by(["镜头放平", "镜头保持水平", "云台别上下动，平着拍", "镜头不用仰也不用俯", "平视就好", "镜头正对地平线", "俯仰角给0度", "相机端平了拍", "镜头别低也别抬，水平着来", "镜头要平"],
                           ["镜头保持水平", "镜头平视", "相机不俯不仰", "俯仰角置零", "以平视角度拍摄", "镜头对准地平线", "镜头应与地平线齐平", "光轴保持水平", "采用平视视角", "拍摄角度以水平为准"])
        a = self.deg(abs(p))
        if p > 0:
            return self.by([f"镜头往下压{a}", f"镜头朝下{a}", f"云台俯角打到{a}", f"镜头低头{a}", f"相机往下倾{a}", f"俯角{a}", f"镜头从水平往下转{a}", f"俯拍角度给{a}", f"镜头要比地平线低{a}", f"镜头向下{a}拍"],
                           [f"镜头下俯{a}", f"镜头俯角为{a}", f"以{a}俯角拍摄", f"镜头向下倾斜{a}", f"相机俯角保持在{a}", f"镜头指向地平线以下{a}", f"将镜头下压{a}", f"镜头俯角应为{a}", f"光轴低于水平线{a}", f"采用{a}俯拍"])
        return self.by([f"镜头往上抬{a}", f"镜头朝上{a}", f"云台仰角打到{a}", f"镜头抬头{a}", f"相机往上仰{a}", f"仰角{a}", f"镜头从水平往上转{a}", f"仰拍角度给{a}", f"镜头要比地平线高{a}", f"镜头向上{a}拍"],
                       [f"镜头上仰{a}", f"镜头仰角为{a}", f"以{a}仰角拍摄", f"镜头向上倾斜{a}", f"相机仰角保持在{a}", f"镜头指向地平线以上{a}", f"将镜头上抬{a}", f"镜头仰角应为{a}", f"光轴高于水平线{a}", f"采用{a}仰拍"])

    def view_told(self):
        p = self.f.pitch
        if p == 0:
            return self.by(["镜头是平的", "镜头一直保持水平", "相机没有俯仰", "平视拍的", "镜头正对着地平线", "俯仰角是0度", "镜头不仰也不俯", "镜头端得平平的", "拍摄角度是水平的", "镜头没往上也没往下"],
                           ["镜头保持水平", "镜头平视", "相机不俯不仰", "俯仰角为0度", "采用平视角度拍摄", "镜头对准地平线", "镜头与地平线齐平", "光轴水平", "拍摄视角为平视", "镜头始终水平"])
        a = self.deg(abs(p))
        d, x, y, z = ("下", "俯", "以下", "低") if p > 0 else ("上", "仰", "以上", "高")
        return self.by([f"镜头往{d}{'压' if p > 0 else '抬'}了{a}", f"镜头朝{d}{a}", f"镜头{x}角{a}", f"镜头的{x}角是{a}", f"{x}角{a}拍的", f"镜头指着地平线{y}{a}", f"镜头比水平线{z}{a}", f"相机往{d}{'倾' if p > 0 else '仰'}{a}", f"是{a}的{x}拍", f"{x}拍角度是{a}"],
                       [f"镜头{d}{x}{a}", f"镜头{x}角为{a}", f"镜头以{a}{x}角拍摄", f"镜头向{d}倾斜{a}", f"相机{x}角保持在{a}", f"镜头指向地平线{y}{a}", f"镜头呈{a}{x}角", f"光轴{z}于水平线{a}", f"采用{a}{x}拍", f"拍摄{x}角为{a}"])

    def view_note(self):
        p = self.f.pitch
        if p == 0:
            return self.pick("镜头：水平", "镜头水平", "平视", "俯仰角0度", "俯仰：0°", "镜头角度：平视", "视角水平", "云台水平", "镜头放平", "拍摄角度：水平")
        a, x, d = self.deg(abs(p)), "俯" if p > 0 else "仰", "下" if p > 0 else "上"
        return self.pick(f"镜头{x}角{a}", f"{x}角：{a}", f"{x}角{a}", f"镜头：向{d}{a}", f"镜头朝{d}{a}", f"云台{x}角{a}", f"镜头地平线以{d}{a}", f"{x}拍{a}", f"拍摄角度：{x}{a}", f"镜头向{d}倾斜{a}")

    # ---- altitude
    def high_order(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        return self.by([f"飞{h}高", f"高度{h}", f"飞到离地{h}", f"飞机比人脚底高{h}", f"高度保持{h}", f"升到{h}高就行", f"飞行高度给{h}"], [f"飞行高度{h}", f"高度保持在{h}", f"离地{h}飞行", f"飞行高度定为{h}", f"高出人脚下地面{h}", f"飞行高度以{h}为准"])

    def high_told(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        return self.by([f"无人机飞{h}高", f"无人机高度{h}", f"无人机离地{h}", f"无人机比人脚底高{h}", f"高度有{h}", f"无人机飞在{h}高的地方", f"飞行高度是{h}"], [f"飞行高度为{h}", f"无人机离地{h}", f"无人机飞行高度{h}", f"无人机高出人脚下地面{h}", f"飞行高度保持在{h}", f"无人机在{h}高度飞行"])

    def high_note(self):
        if self.f.altitude < 1:
            return None
        h = self.m(self.f.altitude)
        return self.pick(f"高度{h}", f"高度：{h}", f"飞行高度{h}", f"飞行高度：{h}", f"离地{h}", f"无人机高{h}")

    # ---- turns
    def turn_words(self):
        style = self.pick(dict(left="左转", right="右转", around="掉头"), dict(left="左转", right="右转", around="掉头"), dict(left="左拐", right="右拐", around="掉头"),
                          dict(left="向左转", right="向右转", around="向后转"), dict(left="往左拐", right="往右拐", around="掉头往回走")) if self.student else \
            self.pick(dict(left="左转", right="右转", around="掉头"), dict(left="左转", right="右转", around="折返"), dict(left="向左转", right="向右转", around="向后转"), dict(left="左转", right="右转", around="转身折回"))
        return [style[t] for t in self.f.turns]

    def chain(self):
        w = self.turn_words()
        k = len(w)
        if k == 1:
            return w[0]
        a = [("又" if i and w[i - 1] == x else "再" if i else "") + x for i, x in enumerate(w)]
        ways = ["先" + "，".join(["" + a[0]] + a[1:]), "、".join(w), "先" + w[0] + "，然后" + "，接着".join(w[1:]), "，再".join(["先" + w[0]] + w[1:])]
        if k > 2:
            ways += ["先" + w[0] + "，" + "，".join("接着" + ("又" if w[i] == x else "") + x for i, x in enumerate(w[1:-1])) + "，最后" + ("又" if w[-2] == w[-1] else "") + w[-1]]
        else:
            ways += [f"先{w[0]}后{w[1]}"]
        return self.rng.choice(ways)

    def turns_told(self, done=True):
        s, t = self.subj(), self.f.turns
        k = len(t)
        will = "" if done else self.pick("会", "将") if not self.student else "会"
        if not k:
            return self.by([f"{s}全程没拐弯" if done else f"{s}全程不拐弯", f"{s}一个弯都没拐" if done else f"{s}一个弯都不拐", f"{s}一直往前走，没有转弯" if done else f"{s}会一直往前走，不转弯", "路上没有转弯", "转弯0次", f"{s}没转过弯" if done else f"{s}不会转弯",
                            f"{s}直着走，没转弯" if done else f"{s}直着走，不转弯"],
                           [f"{s}途中未转弯" if done else f"{s}途中不转弯", "全程无转弯", f"{s}一路前行，未作转向" if done else f"{s}一路前行，不作转向", "行进中没有转弯", f"{s}径直前行，没有转弯" if done else f"{s}将径直前行，没有转弯", "其间未有转向" if done else "其间没有转向", f"{s}始终未转弯" if done else f"{s}始终不转弯"])
        w = self.turn_words()
        c = self.cnt(k)
        if k == 1:
            return self.by([f"{s}{'就' + w[0] + '了一次' if done else '会' + w[0] + '一次'}", f"只转了一次：{w[0]}" if done else f"只有一次转向：{w[0]}", f"{s}路上{will}{w[0]}一次", f"中间{will}{w[0]}一次，别的弯都没有", f"转弯就一个，{w[0]}", f"{s}{will}转向1次，是{w[0]}", f"一共就一次转向，是{w[0]}"],
                           [f"{s}途中{will}{w[0]}一次", f"其间{will}{w[0]}一次", f"{s}仅{will}转向一次，为{w[0]}", f"途中仅有一次转向：{w[0]}", f"{s}{will}转向一次，即{w[0]}", f"全程唯一一次转向为{w[0]}", f"行进中有一次{w[0]}"])
        if len(set(t)) == 1 and self.rng.random() < .4:
            return self.pick(f"{s}{will}连续{c}次{w[0]}", f"{s}{will}转向{c}次，{'都是' if self.student else '均为'}{w[0]}", f"{s}{will}先后{c}次{w[0]}")
        lst = "、".join(w)
        return self.by([f"{s}{will}{self.chain()}", f"{s}一共{will}转向{c}次：{lst}", f"转弯顺序是{lst}", f"{s}路上{will}{self.chain()}", f"转向{c}次，依次是{lst}", f"{s}{will}依次{lst}", f"{c}次转向：{'→'.join(w)}", f"中间{will}{self.chain()}，总共{c}次转向"],
                       [f"{s}{will}先后{lst}", f"{s}途中{will}{self.chain()}", f"其间{will}转向{c}次，依次为{lst}", f"{s}{will}依次{lst}", f"途中{will}先后{c}次转向，分别为{lst}", f"转向共{c}次，次序为{lst}", f"行进中，{s}{will}{self.chain()}", f"全程转向{c}次：{lst}"])

    def turns_note(self):
        if not self.f.turns:
            return self.pick("转弯：无", "没有转弯", "转弯0次", "无转弯", "不转弯")
        w = self.turn_words()
        k = len(w)
        return self.pick("转向：" + "、".join(w), f"转向{k}次：" + "、".join(w), "路线：" + "→".join(w), f"转弯（{k}次）：" + "，".join(w), "依次" + "、".join(w) if k > 1 else w[0] + "一次", "转向顺序：" + "、".join(w))

    # ---- stops
    def stops_told(self, done=True):
        s, k, z = self.subj(), self.f.stops, self.f.standing
        will = "" if done else "会" if self.student else "将"
        if not k:
            return self.by([f"{s}一路没停" if done else f"{s}一路不停", f"{s}中途没停过" if done else f"{s}中途不会停", f"{s}一次都没停" if done else f"{s}一次都不停", "中间没有停顿", "停留0次", f"{s}{will}一口气走到底，不停" if not done else f"{s}一口气走下来，没停过", f"{s}没站住过" if done else f"{s}不会停下"],
                           [f"{s}途中未作停留" if done else f"{s}途中不停留", "全程无停顿", f"{s}始终未停步" if done else f"{s}始终不停步", "其间没有停留", f"{s}一路未停" if done else f"{s}一路不停", "行进中没有停顿", f"{s}中途未驻足" if done else f"{s}中途不驻足"])
        c = self.cnt(k)
        if z < 1:
            return self.pick(f"{s}{will}停下{c}次", f"途中{will}停了{c}次" if done else f"途中{will}停{c}次", f"中间有{c}次停顿")
        z = self.s(z)
        if k == 1:
            return self.by([f"{s}停过一次，站了{z}" if done else f"{s}会停一次，站{z}", f"中间停了{z}，就这一次" if done else f"中间会停{z}，就一次", f"{s}{will}停1次，时长{z}", f"路上有一次停顿，{z}", f"只有一次停留，共{z}", f"{s}中途{will}停下来一次，停{z}", f"{s}站住了一回，{z}" if done else f"{s}会站住一回，{z}"],
                           [f"{s}途中{will}停留一次，时长{z}", f"其间{will}驻足一次，历时{z}", f"{s}{will}停步一次，时长{z}", f"途中有一次停顿，持续{z}", f"停留一次，计{z}", f"{s}{will}停留一次，为时{z}", f"唯一一次停留为{z}"])
        return self.by([f"{s}停了{c}次，加起来{z}" if done else f"{s}会停{c}次，加起来{z}", f"中间停了{c}次，一共站了{z}" if done else f"中间会停{c}次，一共站{z}", f"{s}{will}停{c}次，总共{z}", f"路上有{c}次停顿，合起来{z}", f"{c}次停留一共{z}", f"{s}前后{will}停下来{c}次，总共停{z}", f"停顿{c}次，累计{z}"],
                       [f"{s}途中{will}停留{c}次，合计{z}", f"其间{will}驻足{c}次，累计{z}", f"{s}{will}先后停步{c}次，共计{z}", f"途中有{c}次停顿，总时长{z}", f"停留{c}次，总计{z}", f"{c}次停留累计{z}", f"{s}{will}{c}次停下，合计停留{z}"])

    def stops_note(self):
        k, z = self.f.stops, self.f.standing
        if not k:
            return self.pick("停留：无", "没有停顿", "停留0次", "无停留", "中途不停")
        if z < 1:
            return f"停留{k}次"
        return self.pick(f"停留{k}次，共{self.s(z)}", f"停留：{k}次，合计{self.s(z)}", f"停{k}次（共{self.s(z)}）", f"停顿{k}次，累计{self.s(z)}", f"站住{k}次，总共{self.s(z)}")

    # ---- way, duration, speed
    def walk_told(self, done=True):
        s = self.subj() or self.by(["这个人", "人"], ["此人", "该人"])
        w, d, x = self.m(self.f.way), self.s(self.f.duration), self.ms()
        if not done:
            return self.by([f"{s}总共会走{w}，速度{x}", f"走路全长{w}，走路速度{x}", f"这一趟要飞{d}，{s}走{w}"], [f"{s}将步行{w}，平均步速{x}", f"步行全长{w}，飞行时长{d}", f"飞行历时{d}，{s}共步行{w}"])
        return self.by([f"{s}一共走了{w}，速度{x}，整段飞行{d}", f"飞了{d}，{s}走了{w}，走路速度{x}", f"{d}里{s}走了{w}，走路的平均速度是{x}", f"{s}以{x}的速度走了{w}，视频长{d}", f"走了{w}，走速{x}，时长{d}", f"步行速度{x}，{s}总共走出{w}，全程飞了{d}", f"这段飞行有{d}，期间{s}走了{w}，步速{x}"],
                       [f"飞行历时{d}，{s}共步行{w}，平均步速{x}", f"在{d}的飞行中，{s}以{x}的平均步速行走{w}", f"{s}步行全长{w}，平均步速为{x}，飞行时长{d}", f"全程飞行{d}，{s}行走{w}，步行速度平均{x}", f"{s}以{x}的速度步行，共走{w}，飞行持续{d}",
                        f"飞行持续{d}，其间{s}累计行走{w}，平均速度{x}", f"步行里程{w}，平均步速{x}，飞行用时{d}"])

    def walk_notes(self):
        return [self.pick(f"步行{self.m(self.f.way)}", f"路程：{self.m(self.f.way)}", f"走了{self.m(self.f.way)}", f"步行总长{self.m(self.f.way)}", f"行走路程{self.m(self.f.way)}"),
                self.pick(f"时长{self.s(self.f.duration)}", f"飞行时长：{self.s(self.f.duration)}", f"飞行{self.s(self.f.duration)}", f"历时{self.s(self.f.duration)}", f"总时长{self.s(self.f.duration)}"),
                self.pick(f"步速{self.ms()}", f"走路速度：{self.ms()}", f"平均步速{self.ms()}", f"步行速度{self.ms()}", f"行走速度：{self.ms()}")]

    def stands(self, timed=True):
        s = self.subj() or self.by(["这个人", "人"], ["此人", "该人"])
        d = self.s(self.f.duration)
        if not timed:
            return self.by([f"{s}站着不走", f"{s}就站在原地", f"{s}不走动，一直站在一个地方", f"{s}原地站着", "人不挪地方"], [f"{s}站立不动", f"{s}始终站在原地", f"{s}在原地站立", f"{s}并不行走，只在原地站立", f"{s}驻足于一处"])
        return self.by([f"{s}就在原地站了{d}", f"整整{d}，{s}一直站在一个地方没走", f"{s}一步没走，站了{d}", f"{d}里{s}都站在原地", f"{s}没走路，在同一个位置站了{d}", f"飞了{d}，{s}全程站着没动地方", f"{s}站着没挪地方，一共{d}"],
                       [f"飞行历时{d}，{s}始终站在原地", f"在{d}的飞行中，{s}一直站立于同一处", f"{s}在原地站立{d}", f"{s}未曾走动，在一处站立{d}", f"飞行持续{d}，其间{s}站立未移", f"{d}内，{s}始终站在同一位置", f"{s}全程站在一处，历时{d}"])

    # ---- assembling
    def say(self, parts):
        parts = [p for p in parts if p]
        return "".join(p + ("" if p[-1] in "。？！" else "。") for p in parts)

    def run_on(self, parts):
        """One long sentence."""
        parts = [p for p in parts if p]
        return "，".join(parts) + "。"

    def mix(self, parts):
        parts = [p for p in parts if p]
        out = ""
        for i, p in enumerate(parts):
            last = i == len(parts) - 1
            sep = "。" if last else self.pick("，", "，", "。", "；")
            out += p + ("" if p[-1] in "。？！" else sep)
        return out

    def notes(self, items):
        items = [i for i in items if i]
        style = self.pick("lines", "bullets", "semi", "bar", "number", "space", "stop")
        if style == "lines":
            return "\n".join(items)
        if style == "bullets":
            return "\n".join("- " + i for i in items)
        if style == "semi":
            return "；".join(items) + "。"
        if style == "bar":
            return " | ".join(items)
        if style == "number":
            return "\n".join(f"{k + 1}. {i}" for k, i in enumerate(items))
        if style == "space":
            return "  ".join(items)
        return "。".join(items) + "。"

    def extras(self):
        f, out = self.f, []
        if not f.walks:
            return [self.pick(None, self.stands(False), self.stands(False))]
        if self.rng.random() < .5:
            out.append(self.turns_told(False))
        if self.rng.random() < .35:
            out.append(self.stops_told(False))
        if self.rng.random() < .2:
            out.append(self.walk_told(False))
        elif self.rng.random() < .2:
            out.append(self.pick(f"拍{self.s(f.duration)}", f"飞行时长{self.s(f.duration)}", f"步行全长{self.m(f.way)}", f"步速{self.ms()}"))
        return out

    def film(self):
        if self.f.walks:
            return self.by(["跟着", "跟住", "跟拍", "追着拍", "一路跟着"], ["跟随", "跟拍", "跟踪拍摄", "随行拍摄"])
        return self.by(["拍", "对着", "盯住", "拍住"], ["拍摄", "对准", "锁定"])

    def instruction(self, flight):
        self.begin(flight)
        f = flight
        more = self.extras()
        high = self.high_order() if self.rng.random() < .45 else None
        who, film = self.who(True), self.film()
        d = self.m(f.distance)
        k = self.rng.randrange(13)
        if k == 0:
            return self.run_on([f"{film}{who}", self.far_order(), self.view_order(), high]) + self.mix(more)
        if k == 1:
            return self.say([f"{self.pick('请', '麻烦', '')}{film}{who}", self.far_order(), self.view_order(), high] + more)
        if k == 2:
            ask = self.by(["能不能", "可以", "能"], ["能否", "可否", "能否请你"])
            end = {"能不能": "", "可以": "吗", "能": "吗"}.get(ask, "")
            return f"{ask}{film}{who}，{self.far_order()}，{self.view_order()}{'，' + high if high else ''}{end}？".replace("，就行吗", "吗").replace("就行吗", "吗").replace("就好吗", "吗") + self.mix(more)
        if k == 3:
            return self.notes([self.pick(f"{'跟拍' if f.walks else '拍摄'}对象：{who}", f"目标：{who}", f"任务：{film}{who}", f"人物：{who}"), self.far_note(), self.view_note(), self.high_note() if high else None]
                              + ([self.turns_note()] if f.walks and self.pick(True, False) else []) + ([self.stops_note()] if f.walks and self.pick(True, False, False) else []) + ([self.pick("人站着不动", "人在原地站立", "不走动")] if not f.walks else []))
        if k == 4:
            return self.run_on([self.view_order(), self.pick(f"离人{d}", f"距离保持{d}", f"距离控制在{d}", f"拍摄距离{d}", f"全程保持{d}的距离", f"与被摄者相距{d}"), high, self.pick(f"就这样{film}{who}", f"{film}{who}", f"照此{film}{who}")]) + self.mix(more)
        if k == 5:
            return self.say([self.pick(f"画面里有{self.who()}", f"这次的主角是{self.who()}", f"你会看到{self.who()}", f"要拍的是{self.who()}"), self.run_on([self.pick("跟上去" if f.walks else "对准拍", "镜头一直对着人", "让人一直留在画面里"), self.far_order(), self.view_order(), high])] + more)
        if k == 6:
            return self.run_on([f"{self.pick('在离', '在距', '在距离')}{who}{d}{self.pick('的地方', '处', '的位置')}{'跟飞' if f.walks else '拍摄'}", self.view_order(), high]) + self.mix(more)
        if k == 7:
            return self.run_on([f"{self.pick('以', '用')}{d}的距离{self.pick('跟拍', '跟随') if f.walks else '拍摄'}{who}", self.view_order(), high]) + self.mix(more)
        if k == 8:
            steps = [x for x in [f"{self.pick('找到', '先找到', '认准')}{who}", self.far_order(), self.view_order(), high] + more if x]
            marks = self.pick("①②③④⑤⑥⑦⑧", None)
            sep = self.pick("\n", "；")
            return sep.join((marks[i] if marks else f"{i + 1}）") + x.rstrip("。") for i, x in enumerate(steps)) + "。"
        if k == 9:
            return self.say([self.pick("拍摄要求", "飞行要求", "要求", "参数") + "：" + "，".join(x for x in [self.far_note().replace("：", ""), self.view_note().replace("：", ""), self.high_note() and self.high_note().replace("：", "") if high else None] if x), f"{self.pick('对象为', '目标是', '拍的是')}{who}"] + more)
        if k == 10:
            if f.walks:
                clause = self.pick(f"{who}走到哪，你就跟到哪", f"{who}往前走，你就跟着飞", f"{who}走动时，无人机随之移动")
            else:
                clause = self.pick(f"{who}站在原地，你对着拍", f"{who}站着不走，请对准拍摄")
                more = []
            return self.say([clause, self.run_on([self.far_order(), self.view_order(), high])] + more)
        if k == 11:
            a = (f"{'向下' if f.pitch > 0 else '向上'}{self.deg(abs(f.pitch))}" if f.pitch else "水平")
            return self.say([self.pick("记住两点", "两个要点", "注意两个数", "要求有二") + f"：一是离人{d}，二是镜头{a}", high, self.pick(f"{film}的是{who}" if film in ("跟拍", "跟随", "跟着", "拍", "拍摄") else f"请{film}{who}", f"然后{film}{who}", f"按这个来，{film}{who}")] + more)
        return self.say([f"{self.pick('把', '请把', '将')}{who}{self.pick('一直留在画面里', '始终留在画面中', '始终保持在画面内')}", self.mix([self.far_order(), high, self.view_order()])] + more)

    def description(self, flight):
        self.begin(flight)
        f, walks = flight, flight.walks
        drone = [self.far_told(), self.view_told(), self.high_told()]
        if self.pick(True, False):
            self.rng.shuffle(drone)
        doing = [self.walk_told(), self.turns_told(), self.stops_told()] if walks else [self.stands()]
        if walks and self.pick(True, False):
            self.rng.shuffle(doing)
        d, k = self.m(f.distance), self.rng.randrange(13)
        lead = self.by([f"视频里是{self.who()}", f"这段拍的是{self.who()}", f"画面里有{self.who()}", f"无人机{'跟着' if walks else '拍'}{self.who()}", f"这条视频的主角是{self.who()}"],
                       [f"无人机{'跟拍' if walks else '拍摄'}{self.who()}", f"画面中可见{self.who()}", f"无人机此次{'跟拍' if walks else '拍摄'}的是{self.who()}", f"镜头记录下{self.who()}", f"拍摄对象为{self.who()}"])
        if k == 0:
            return self.say([lead] + doing + drone)
        if k == 1:
            return self.say([lead, self.run_on(drone), self.mix(doing)])
        if k == 2:
            body = (self.walk_notes() + [self.turns_note(), self.stops_note()]) if walks else [self.pick(f"原地站立{self.s(f.duration)}", f"站着没走，时长{self.s(f.duration)}", f"全程站在原地（{self.s(f.duration)}）", f"未走动，站立{self.s(f.duration)}")]
            self.rng.shuffle(body)
            cam = [self.far_note(), self.view_note(), self.high_note()]
            return self.notes([self.pick(f"人物：{self.who()}", f"对象：{self.who()}", f"被摄者：{self.who()}", self.who())] + (body + cam if self.pick(True, False) else cam + body))
        if k == 3:
            return self.run_on([lead, self.mix(drone)[:-1]]) + self.mix(doing)
        if k == 4 and walks:
            return self.say([f"{self.s(f.duration)}的{self.pick('飞行', '视频', '画面')}里，{self.who()}走了{self.m(f.way)}，{self.pick('步速', '走路速度', '平均步速')}{self.ms()}", self.turns_told(), self.stops_told(), self.run_on(drone)])
        if k == 5 and walks:
            return self.say([f"{self.who()}{self.pick('步行', '走了', '共走了')}{self.m(f.way)}，{self.turns_told()}，{self.stops_told()}", f"{self.pick('步行速度', '平均步速', '走路速度')}{self.ms()}，{self.pick('飞行历时', '飞行时长', '整个飞行')}{self.s(f.duration)}", self.mix(drone)])
        if k in (4, 5):
            return self.say([f"{self.who()}在{self.pick('原地', '同一个地方', '一处')}站了{self.s(f.duration)}，" + self.run_on(drone)[:-1]])
        if k == 6:
            qa = [("拍的是谁？", self.who())]
            if walks:
                stops = (f"{zh_words(f.stops)}次" + (f"，共{self.s(f.standing)}" if f.standing else "")) if f.stops else "没有"
                qa += [("走了多远？", self.m(f.way)), ("走多快？", self.ms()), ("飞了多久？", self.s(f.duration)), ("转弯呢？", "、".join(self.turn_words()) if f.turns else "没有"), ("停过吗？", stops)]
            else:
                qa += [("在干什么？", self.pick("站在原地，没走", "就站着，没挪地方")), ("多久？", self.s(f.duration))]
            qa += [("无人机离人多远？", d), ("镜头呢？", (f"{'俯角' if f.pitch > 0 else '仰角'}{self.deg(abs(f.pitch))}" if f.pitch else "水平"))]
            if f.altitude >= 1:
                qa += [("飞多高？", self.m(f.altitude))]
            return "".join(q + a + "。" for q, a in qa)
        if k == 7:
            return self.say([self.run_on(drone)[:-1], self.pick("拍到的是", "镜头里是", "画面中是", "被拍的是") + self.who()] + doing)
        if k == 8:
            cam = "，".join(x.replace("：", "") for x in [self.far_note(), self.view_note(), self.high_note()] if x)
            if walks:
                per = "；".join([self.who()] + self.walk_notes() + [self.turns_note(), self.stops_note()])
            else:
                per = f"{self.who()}；" + self.pick(f"原地站立{self.s(f.duration)}", f"全程没走，站了{self.s(f.duration)}")
            a, b = f"{self.pick('无人机', '飞行', '机位')}：{cam}。", f"{self.pick('人', '人物', '画面中人')}：{per}。"
            return self.pick("\n", "").join(self.pick((a, b), (b, a)))
        if k == 9:
            return self.say([f"无人机{self.far()}{self.pick('跟拍', '跟随') if walks else '拍摄'}{self.who()}", self.run_on([self.view_told(), self.high_told()])] + doing)
        if k == 10:
            w = f.wear
            dress = None
            if w:
                bag = self.pick("，还背着背包", "，背双肩包") if w[2] else ""
                dress = self.pick(f"上衣{self.col(w[0])}，裤子{self.col(w[1])}{bag}", f"上衣是{self.col(w[0])}的，裤子是{self.col(w[1])}的{bag}", f"裤子{self.col(w[1])}，上衣{self.col(w[0])}{bag}", f"此人身穿{self.col(w[0])}上衣、{self.col(w[1])}裤子{bag}")
            return self.say([self.pick(f"无人机{'跟拍' if walks else '拍摄'}了一个人", "画面里有一个人", "视频里是一个人"), dress, self.mix(doing)] + drone)
        if k == 11:
            return self.mix([self.pick(f"被{'跟拍' if walks else '拍摄'}的是{self.who()}", f"{self.who()}被无人机{'一路跟拍' if walks else '拍下'}")] + doing + drone)
        return self.run_on([lead] + [x.replace("：", "为") if not self.student else x for x in doing]) + self.mix(drone)

    # ---- wrong texts
    def foreign(self, text):
        end = text[-1] if text[-1] in "。？！" else ""
        body = text[:-1] if end else text
        if self.rng.random() < .65:
            return body + ("，" if end != "？" else "？") + self.rng.choice(self.things) + "。"
        who = self.rng.choice(self.persons)
        return body + (end or "。") + self.pick(f"这个人是{who}。", f"画面里还有一位{who}。", f"对方是一位{who}。", f"旁边还有一名{who}。", f"被拍的是{who}。", f"一名{who}从旁边走过。", f"看得出是{who}。")

    def heading(self, text, direction):
        z = ZH_DIRECTIONS[direction]
        end = "" if text[-1] in "。？！" else "。"
        return text + end + self.pick(f"人往{z}走。", f"这个人朝{z}走。", f"行走方向为{z}。", f"此人向{z}行进。", f"走的是{z}边方向。" if len(z) == 1 else f"走的是{z}方向。", f"一路向{z}。", f"步行方向：{z}。", f"是往{z}去的。", f"路线通向{z}方。", f"人朝着{z}面走。" if len(z) == 1 else f"人朝着{z}方向走。")
