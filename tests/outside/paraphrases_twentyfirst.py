"""The Twenty-first grammar for check_text_judge.py: film crews on set, laconic radio operators and people dictating messages. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen "
        "seventeen eighteen nineteen").split()
TENS = "_ _ twenty thirty forty fifty sixty seventy eighty ninety".split()


def words(n):
    if n < 20: return ONES[n]
    if n < 100: return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000: return ONES[n // 100] + " hundred" + (" and " + words(n % 100) if n % 100 else "")
    return words(n // 1000) + " thousand" + ((" and " if n % 1000 < 100 else " ") + words(n % 1000) if n % 1000 else "")


def cap(text):
    return text[:1].upper() + text[1:]


def art(text):
    return ("an " if text.split("-")[0] in ("11", "18") or text.startswith(("8", "eight", "eleven")) else "a ") + text


def runs(items):
    found = []
    for item in items:
        if found and found[-1][0] == item: found[-1][1] += 1
        else: found.append([item, 1])
    return found


PAST = dict(make="made", take="took", keep="kept", hold="held", stand="stood", go="went", hang="hung", have="had", come="came",
            fly="flew", sit="sat", do="did", put="put", run="ran", stop="stopped", begin="began", leave="left", be="were", get="got", hover="hovered", read="read")


class TwentyFirstEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls", "with two dogs", "under a row of palm trees", "next to a parked van", "while church bells ring",
              "in pouring rain", "past a bakery", "on a wooden bridge", "with an umbrella in hand", "along a canal", "as a tram goes by", "in front of a mural",
              "among market stalls", "by a red mailbox", "through ankle-deep snow", "with a phone at the ear", "just after sunset", "behind a delivery truck",
              "holding a bunch of balloons", "around a statue", "near a bus stop", "with a cyclist alongside", "in thick fog", "under a railway arch", "pushing a stroller"]
    persons = ["nurse", "fisherman", "bride", "postman", "teenager", "policewoman", "grandfather", "waiter", "soldier", "schoolgirl", "plumber", "monk"]
    outs = ["Over.", "Out.", "How copy?", "Cut.", "That's a wrap.", "End of message.", "Message ends.", "Copy?", "Moving on.", "And cut.", "Roger?", "Send it.", "Nothing further.", "That is all."]

    # ---- style, numbers, tense
    def begin(self, tense):
        self.tense = tense
        self.spelled = self.rng.random() < 0.18
        self.unit = self.pick("metres", "meters") if self.spelled else self.pick("m", "m", "metres", "meters")
        self.second = "seconds" if self.spelled else self.pick("s", "seconds", "seconds", "sec")
        self.degree = "degrees" if self.spelled else self.pick("degrees", "degrees", "°", "deg")
        self.uturn, self.turnword = self.pick("a U-turn", "an about-turn", "a one-eighty", "an about-face"), self.pick("", " turn", "")
        self.rate = self.pick("{} per second", "{} a second") if self.unit != "m" else self.pick("m/s", "m/s", "metres per second")

    def n(self, n): return words(n) if self.spelled else str(n)

    def m(self, n):
        if self.unit != "m" and n == 1: return self.n(n) + " " + self.unit[:-1]
        return self.n(n) + " " + self.unit

    def madj(self, n): return self.n(n) + "-" + (self.unit[:-1] if self.unit != "m" else "metre")

    def sec(self, n):
        if self.second == "seconds" and n == 1: return self.n(n) + " second"
        return self.n(n) + " " + self.second

    def secadj(self, n): return self.n(n) + "-second"

    def deg(self, n):
        if self.degree == "°": return f"{n}°"
        if self.degree == "degrees" and n == 1: return self.n(n) + " degree"
        return self.n(n) + " " + self.degree

    def mps(self, speed):
        text = f"{speed:.1f}"
        if self.spelled: text = words(int(text.split(".")[0])) + " point " + words(int(text.split(".")[1]))
        return text + " " + self.rate.format(self.unit)

    def count(self, n): return words(n) if n < 13 and (self.spelled or self.rng.random() < 0.5) else str(n)

    def times(self, n): return {1: "once", 2: self.pick("twice", "two times")}.get(n, self.count(n) + " times")

    def v(self, verb):                    # after "they" or "we"
        if self.tense == "future": return "will " + verb
        if self.tense == "past": return PAST.get(verb, verb + ("d" if verb.endswith("e") else "ed"))
        return "are" if verb == "be" else verb

    def vs(self, verb):                   # after one thing
        if self.tense == "future": return "will " + verb
        if verb == "be": return "was" if self.tense == "past" else "is"
        if self.tense == "past": return self.v(verb)
        return {"do": "does", "go": "goes", "have": "has"}.get(verb, verb + ("es" if verb.endswith(("s", "sh", "ch", "x")) else "s"))

    def do(self): return {"past": "did", "present": "do", "future": "will"}[self.tense]

    def s(self, text):
        text = cap(text.strip())
        return text if text[-1] in ".?!" else text + "."

    def all(self, parts): return " ".join(self.s(p) for p in parts if p)

    # ---- who
    def noun(self, flight):
        return self.pick("person", "person", "subject", "target", "individual") if not flight.walks else self.pick("person", "person", "subject", "walker", "target", "person on foot", "pedestrian")

    def legs(self): return self.pick("trousers", "pants", "trousers")

    def bag(self): return self.pick("backpack", "backpack", "rucksack", "pack on the back")

    def who(self, flight, plain=False):
        noun = self.pick("person", "person", "walker" if flight.walks else "individual") if plain else self.noun(flight)
        if flight.wear is None:
            if plain: return self.pick(f"the {noun}", f"the one {noun} in frame", f"the {noun} on the monitor", f"the {noun} on screen", f"the {noun} in the viewfinder")
            return self.pick(f"the {noun}", f"the {noun}", f"our {noun}", f"that {noun}", f"the one {noun} in frame", f"the {noun} on the monitor", f"the {noun} you see on screen",
                             f"the {noun} in the viewfinder", "the person we're filming" if self.tense != "past" else "the person we filmed", f"this {noun}", f"the {noun} on camera")
        top, low, pack = flight.wear
        legs, bag, shirt = self.legs(), self.bag(), self.pick("top", "top", "shirt")
        if top == low and self.rng.random() < 0.4:
            tail = self.pick(f" who also has a {bag}", f" with a {bag}") if pack else self.pick("", "", " and no backpack")
            return self.pick(f"the {noun} in {top} {shirt} and {top} {legs}{tail}", f"the {noun} with {shirt} and {legs} both {top}" + (f" plus a {bag}" if pack else ""),
                             f"the {noun} whose {shirt} and {legs} are equally {top}" + (f" and who has a {bag}" if pack else ""), f"the {noun} in {top} above and {top} below{tail}")
        if pack:
            return self.pick(
                f"the {noun} in the {top} {shirt} and {low} {legs} with the {bag}",
                f"the {noun} wearing {an(top)} {shirt}, {low} {legs} and a backpack",
                f"the {noun} with the {top} {shirt}, the {low} {legs} and the {bag}",
                f"the {noun} dressed in {top} above and {low} below with a {bag}",
                f"the backpack-carrying {noun} in {an(top)} {shirt} and {low} {legs}",
                f"whoever is wearing the backpack, the {top} {shirt} and the {low} {legs}",
                f"the {noun} whose {shirt} is {top}, whose {legs} are {low} and who has a {bag}",
                f"the {noun} with a backpack on, {an(top)} {shirt} and {low} {legs}",
                f"the {noun} ({top} {shirt}, {low} {legs}, backpack)",
                f"the {noun} in {low} {legs} and {an(top)} {shirt} who has a {bag}",
                f"the {top}-{shirt}, {low}-{legs} {noun} with the {bag}",
                f"the {noun} wearing {low} {legs}, a backpack and {an(top)} {shirt}")
        none = self.pick("", "", "", " and no backpack")
        return self.pick(
            f"the {noun} in the {top} {shirt} and {low} {legs}",
            f"the {noun} wearing {an(top)} {shirt} and {low} {legs}",
            f"the {noun} with the {top} {shirt}, the {low} {legs}{none}" if none else f"the {noun} with the {top} {shirt} and the {low} {legs}",
            f"the {noun} dressed in {top} above and {low} below",
            f"whoever is wearing the {top} {shirt} and the {low} {legs}",
            f"the {noun} whose {shirt} is {top} and whose {legs} are {low}",
            f"the {noun} in {an(top)} {shirt} over {low} {legs}",
            f"the {noun} ({top} {shirt}, {low} {legs})",
            f"the {noun} in {low} {legs} and {an(top)} {shirt}",
            f"the {top}-{shirt}, {low}-{legs} {noun}",
            f"the {noun} in {top} up top and {low} on the legs",
            f"the {noun} in {an(top)} {shirt} and {low} {legs}" + (" without a backpack" if none else ""))

    def label(self, flight):              # for notes
        noun = self.pick("Subject", "Person", "Target", "Who", "In frame", "Filmed")
        if flight.wear is None:
            return self.pick("One person in frame", "Subject: one person", f"{noun}: one person", "Target: one person")
        top, low, pack = flight.wear
        legs, shirt = self.legs(), self.pick("top", "top", "shirt")
        if pack: return self.pick(f"{noun}: {top} {shirt}, {low} {legs}, backpack", f"{noun}: {shirt} {top}, {legs} {low}, backpack yes", f"{noun}: backpack, {low} {legs}, {top} {shirt}", f"{noun}: {top} on top, {low} below, with a backpack",
                                  f"Wardrobe: {top} {shirt}, {low} {legs}, one backpack")
        none = self.pick("", "", ", no backpack")
        return self.pick(f"{noun}: {top} {shirt}, {low} {legs}{none}", f"{noun}: {shirt} {top}, {legs} {low}{none}", f"{noun}: {low} {legs}, {top} {shirt}{none}", f"{noun}: {top} {shirt} over {low} {legs}{none}",
                         f"Wardrobe: {top} {shirt}, {low} {legs}{none}")

    # ---- distance
    def far_how(self, flight):
        d, adj = self.m(flight.distance), self.madj(flight.distance)
        return self.pick(f"from {d} away", f"at {d}", f"{d} out", f"at a range of {d}", f"with {d} in between", f"from {d} off", f"at {art(adj)} distance", f"over a gap of {d}", f"keeping {d} off", f"from {art(adj)} standoff")

    def far_note(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"range {d}", f"range: {d}", f"distance to the person: {d}", f"drone to person, {d}", f"{d} from drone to person", f"standoff {d}", f"{d} off the person", f"separation: {d}",
                         f"camera-to-subject distance {d}", f"gap of {d}", f"{d} out", f"subject distance, {d}")

    def far_say(self, flight):
        d = self.m(flight.distance)
        return self.pick(
            f"the drone {self.vs('keep')} {d} off them", f"distance to them {self.vs('average')} {d}", f"{d} {self.vs('be')} the average gap between drone and person",
            f"there {self.vs('be')} a mean {d} between the lens and them", f"we {self.v('film')} from {d} away", f"the gap {self.vs('be')} {d}, drone to person",
            f"as for range, the drone {self.vs('sit')} {d} from them", f"a distance of {d} {self.vs('be')} kept between the camera and them",
            f"range to the person {self.vs('come')} out at {d} on average", f"how far out? {cap(d)}", f"what {self.vs('separate')} drone and person {self.vs('be')} {d}",
            f"they {self.v('have')} the drone {d} away from them", f"the drone {self.vs('work')} at a range of {d}", f"standoff {self.vs('be')} {d}")

    def far_do(self, flight):
        d, adj = self.m(flight.distance), self.madj(flight.distance)
        return self.pick(
            f"keep {d} between you and them", f"stay {d} off", f"hold {d} from them", f"give them {d}", f"I want {d} between the drone and them", f"can you hold {d} off them?",
            f"your distance is {d}", f"the gap should be {d}", f"let there be {d} of air between you and them", f"{d} out, that's where I need you", f"set your range to {d}",
            f"fly it {d} from them", f"a range of {d} is what we're after", f"range, please: {d}", f"the drone is to be kept {d} away", f"would you sit {d} out?", f"leave {art(adj)} gap", f"make it {d} from lens to person")

    # ---- pitch
    def aim(self, flight):
        p = flight.pitch
        if p == 0: return self.pick("dead level", "level", "level with the horizon", "neither up nor down", "flat at the horizon", "straight at the horizon", "at zero degrees, level", "bang on the horizon")
        side, low, edge = ("down", "below", "downward") if p > 0 else ("up", "above", "upward")
        d = self.deg(abs(p))
        return self.pick(f"{d} {side}", f"{d} {low} the horizon", f"{side} by {d}", f"{edge} at {d}", f"{d} {low} level", f"{side} {d}", f"{d} {side} from level")

    def tilt(self, flight):               # a noun
        p = flight.pitch
        if p == 0: return self.pick("zero tilt", "no tilt", "a level angle", "a flat gimbal", "a dead-level lens", "a tilt of zero")
        d, side = self.deg(abs(p)), "down" if p > 0 else "up"
        return self.pick(f"{d} of {side}-tilt", f"{d} of {side}ward tilt", f"{an(side)}ward tilt of {d}", f"{an(side)}ward angle of {d}", f"a camera angle of {d} {side}", f"{an(side)}-tilt of {d}")

    def tilt_note(self, flight):
        p = flight.pitch
        if p == 0: return self.pick("tilt zero", "tilt: none, level", "camera level", "gimbal at 0, level", "lens on the horizon", "gimbal flat", "camera angle: level", "lens dead level", "pitch zero", "no tilt")
        d, side, low = self.deg(abs(p)), "down" if p > 0 else "up", "below" if p > 0 else "above"
        return self.pick(f"tilt {d} {side}", f"tilt: {d} {side}", f"camera {side} {d}", f"gimbal {d} {side}", f"lens {d} {low} the horizon", f"camera angle: {d} {low} horizon", f"{d} {side} on the gimbal",
                         f"{side}-tilt {d}", f"pitch: {d} {side}ward", f"lens {side}, {d}", f"camera {d} {low} level")

    def tilt_say(self, flight):
        aim, tilt = self.aim(flight), self.tilt(flight)
        return self.pick(
            f"the camera {self.vs('point')} {aim}", f"the gimbal {self.vs('be')} set {aim}", f"we {self.v('have')} the lens {aim}", f"camera-wise, we {self.v('run')} {tilt}", f"the lens {self.vs('be')} pointed {aim}",
            f"the shot {self.vs('use')} {tilt}", f"as to the camera, it {self.vs('be')} aimed {aim}", f"lens? {cap(aim)}", f"{tilt} {self.vs('be')} what the camera {self.vs('have')}",
            f"it {self.vs('be')} framed with {tilt}", f"the camera, aimed {aim}, {self.vs('do')} the filming", f"they {self.v('be')} framed by a camera pointing {aim}")

    def tilt_how(self, flight):
        aim, tilt = self.aim(flight), self.tilt(flight)
        return self.pick(f"camera {aim}", f"with the lens {aim}", f"the gimbal set {aim}", f"with {tilt}", f"the camera pointing {aim}", f"lens {aim}", f"with the camera aimed {aim}", f"on {tilt}" if flight.pitch == 0 else f"using {tilt}", f"the lens pointed {aim}",
                         f"camera aimed {aim}")

    def tilt_do(self, flight):
        aim, tilt, d, p = self.aim(flight), self.tilt(flight), self.deg(abs(flight.pitch)), flight.pitch
        extra = ("level the camera off", "don't tilt the camera", "leave the gimbal flat") if p == 0 else (f"tip the lens {'down' if p > 0 else 'up'} {d}", f"tilt {'down' if p > 0 else 'up'} {d}", f"bring the gimbal {'down' if p > 0 else 'up'} to {d}")
        return self.pick(
            f"point the camera {aim}", f"set the gimbal {aim}", f"lens {aim}, please", f"I want the camera {aim}", f"give me {tilt}", f"can I get {tilt}?", f"the camera should point {aim}", f"the lens is to be aimed {aim}",
            f"frame with {tilt}", f"gimbal goes {aim}", f"could you put the lens {aim}?", f"what we need on the camera is {tilt}", f"have the camera look {aim}" if p else "have the camera sit level", *extra)

    # ---- height
    def high_note(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"height {a}", f"altitude: {a} above their feet", f"{a} up", f"flying height: {a}", f"drone {a} above the person's feet", f"height over the person's feet: {a}", f"alt {a}", f"elevation of the drone over the person's feet: {a}",
                         f"{a} of height", f"drone height {a}")

    def high_say(self, flight):
        a = self.m(flight.altitude)
        return self.pick(
            f"the drone {self.vs('fly')} {a} above their feet" if self.tense != "present" else f"the drone flies {a} above their feet", f"height {self.vs('be')} {a} over the ground at their feet", f"altitude? {cap(a)}",
            f"we {self.v('be')} up at {a}", f"{a} {self.vs('be')} the drone's height over their feet", f"the height we {self.v('hold')} {self.vs('be')} {a}", f"measured from the person's feet, the drone {self.vs('be')} {a} up",
            f"flying height {self.vs('come')} to {a}", f"up top, the altimeter {self.vs('read')} {a} over their feet" if self.tense != "present" else f"the altimeter reads {a} over their feet", f"the drone {self.vs('be')} {a} higher than their feet",
            f"an altitude of {a} {self.vs('be')} flown")

    def high_do(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"fly {a} above their feet", f"take it up to {a}", f"your height is {a}", f"altitude {a}, please", f"hold {a} of height", f"be {a} up", f"keep the drone {a} above the person's feet", f"can you be up at {a}?",
                         f"a flying height of {a} is wanted", f"work from {a} up", f"height: {a} over the ground they're on")

    def high_how(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"{a} up", f"at a height of {a}", f"{a} above their feet", f"flying {a} high", f"from {a} up", f"at {a} of altitude")

    # ---- turns
    def adv(self, turns):                 # left, then right, then around
        if len(turns) == 1: return turns[0]
        if len(turns) > 2 and self.rng.random() < 0.2: return "first " + turns[0] + ", then " + ", then ".join(turns[1:-1]) + ", finally " + turns[-1]
        if self.rng.random() < 0.3:
            pieces = [a if k == 1 else f"{a} {self.times(k)}" for a, k in runs(turns)]
            return ", then ".join(pieces)
        said = [t + " again" if i and turns[i - 1] == t else t for i, t in enumerate(turns)]
        return self.pick(", then ".join(said), ", ".join(said[:-1]) + " and then " + said[-1], ", ".join(said[:-1]) + ", then " + said[-1])

    def naming(self, turn):
        if turn == "around": return self.uturn
        return f"a {turn}{self.turnword}"

    def nouns(self, turns):
        items = [self.naming(t) for t in turns]
        if len(items) == 1: return items[0]
        return self.pick(", ".join(items[:-1]) + " and " + items[-1], ", then ".join(items), ", ".join(items[:-1]) + ", then " + items[-1])

    def arrow(self, turns):
        return self.pick(", ", " - ", ", ", " > ").join(turns)

    def turn_note(self, flight):
        t, n = flight.turns, len(flight.turns)
        if not n: return self.pick("no turns", "turns: none", "turns, zero", "not one turn", "zero turns", "no turn anywhere", "turns: 0", "turning: none")
        if n == 1: return self.pick(f"one turn, {t[0]}", f"turns: one, {t[0]}", f"turns: {t[0]}, once", f"a single turn: {t[0]}", f"1 turn ({t[0]})", f"turning {t[0]} once", f"only turn: {t[0]}")
        extra = [f"{self.count(n)} turns, each of them {self.naming(t[0])}"] if len(set(t)) == 1 else []
        return self.pick(f"turns: {self.arrow(t)}", f"{self.count(n)} turns: {self.arrow(t)}", f"turns in order: {self.arrow(t)}", f"turns ({n}): {self.arrow(t)}", f"{self.nouns(t)}, in that order", f"turning {self.adv(t)}",
                         f"{self.count(n)} turns, {self.adv(t)}", f"sequence of turns: {self.arrow(t)}", *extra)

    def turn_say(self, flight):
        t, n = flight.turns, len(flight.turns)
        if not n:
            return self.pick(f"they {self.v('make')} no turns", f"at no point {self.do()} they turn", f"there {'was' if self.tense == 'past' else 'is'} not one turn", "turns? Not one", f"they {self.v('go')} without turning", f"nowhere {self.do()} they turn",
                             f"not one turn {self.vs('be')} made", f"no left, no right, no U-turn {self.vs('be')} taken", f"they {self.v('do')} it all without a turn", f"of turns there {self.v('be')} none")
        extra = []
        if n == 1:
            extra = [f"they {self.v('turn')} {t[0]} once", f"one turn only: {t[0]}", f"they {self.v('make')} a single turn, {self.naming(t[0])}", f"there {self.vs('be')} one turn, {self.naming(t[0])}", f"their only turn {self.vs('be')} {self.naming(t[0])}",
                     f"just once {self.do()} they turn, and that {self.vs('be')} {self.naming(t[0])}", f"they {self.v('make')} {self.naming(t[0])} and no other turn", f"turns? One: {t[0]}", f"a single turn {self.vs('be')} made, {self.naming(t[0])}",
                     f"the one turn they {self.v('make')} {self.vs('be')} {self.naming(t[0])}"]
            return self.pick(*extra)
        if len(set(t)) == 1:
            extra = [f"they {self.v('turn')} {t[0]} {self.times(n)}", f"of their {self.count(n)} turns, every one {self.vs('be')} {self.naming(t[0])}", f"they {self.v('turn')} {self.times(n)}, each time {t[0]}"]
        ordinal = ["turn " + words(i + 1) + (f" {self.vs('be')}" if i == 0 else "") + " " + self.naming(x) for i, x in enumerate(t)]
        lasts = t[:-1]
        return self.pick(
            f"they {self.v('turn')} {self.adv(t)}", f"they {self.v('make')} {self.count(n)} turns: {self.arrow(t)}", f"{self.count(n)} turns, in this order: {self.arrow(t)}", f"the turns {self.v('go')} {self.arrow(t)}",
            f"{self.nouns(t)}: those {self.v('be')} their turns, in order", ", ".join(ordinal), f"they {self.v('take')} {self.nouns(t)}", f"turns? {cap(words(n))}: {self.arrow(t)}",
            f"in order, they {self.v('make')} {self.nouns(t)}", f"their turning {self.vs('go')} {self.adv(t)}", f"there {self.v('be')} {self.count(n)} turns, namely {self.arrow(t)}",
            f"{self.count(n)} times they {self.v('turn')}: {self.arrow(t)}",
            f"{self.count(n)} turns {self.v('be')} made, {self.adv(t)}", *extra)

    # ---- stops
    def stop_note(self, flight):
        n, z = flight.stops, flight.standing
        if not n: return self.pick("no stops", "stops: none", "no pauses", "not one pause", "zero stops", "never stopping", "pauses: 0", "non-stop")
        if not z: return self.pick(f"stops: {n}", f"pauses: {self.count(n)}")
        if n == 1: return self.pick(f"one stop, {self.sec(z)}", f"one pause of {self.sec(z)}", f"stops: one, lasting {self.sec(z)}", f"{art(self.secadj(z))} pause, just the one", f"a single stop ({self.sec(z)})", f"pausing once, {self.sec(z)}", f"pauses: 1, {self.sec(z)} long")
        return self.pick(f"{self.count(n)} stops, {self.sec(z)} in all", f"stops: {n}, adding up to {self.sec(z)}", f"{self.count(n)} pauses, {self.sec(z)} all told", f"pauses: {n} (together {self.sec(z)})", f"stopping {self.times(n)}, total {self.sec(z)}",
                         f"{self.sec(z)} of standing split over {self.count(n)} stops", f"{self.count(n)} pauses with a combined {self.sec(z)}", f"standing time {self.sec(z)} over {self.count(n)} pauses")

    def stop_say(self, flight):
        n, z = flight.stops, flight.standing
        if not n:
            return self.pick(f"they {self.v('make')} no stops", f"at no time {self.do()} they pause", f"they {self.v('keep')} moving without a single stop", f"not once {self.do()} they stop", "stops? Not one", f"no pause {self.vs('be')} taken", f"there {self.v('be')} no pauses",
                             f"they {self.v('walk')} non-stop", f"of pauses there {self.v('be')} none", f"they {self.v('go')} the whole way without pausing")
        if not z: return self.pick(f"they {self.v('pause')} {self.times(n)}", f"they {self.v('stop')} {self.times(n)}")
        if n == 1:
            return self.pick(f"they {self.v('stop')} once, for {self.sec(z)}", f"one pause of {self.sec(z)} {self.vs('be')} all they {self.v('take')}", f"they {self.v('make')} a single stop of {self.sec(z)}", f"once they {self.v('pause')}, and that {self.vs('last')} {self.sec(z)}",
                             f"stops? One, {self.sec(z)} long", f"there {self.vs('be')} one {self.secadj(z)} pause", f"for {self.sec(z)} they {self.v('stand')} still, one time", f"their only stop {self.vs('last')} {self.sec(z)}", f"a single pause, {self.sec(z)}, {self.vs('be')} taken",
                             f"they {self.v('hold')} still one time, {self.sec(z)} of it")
        return self.pick(
            f"they {self.v('stop')} {self.times(n)}, {self.sec(z)} altogether", f"{self.count(n)} pauses {self.v('add')} up to {self.sec(z)}", f"they {self.v('make')} {self.count(n)} stops that {self.v('total')} {self.sec(z)}" if self.tense != "past" else f"they made {self.count(n)} stops that totalled {self.sec(z)}",
            f"{self.times(n)} they {self.v('pause')}, for a combined {self.sec(z)}", f"stops? {cap(words(n))}, {self.sec(z)} in all", f"there {self.v('be')} {self.count(n)} pauses, together {self.sec(z)}", f"all in all they {self.v('stand')} still for {self.sec(z)}, over {self.count(n)} stops",
            f"standing time {self.vs('come')} to {self.sec(z)} in {self.count(n)} stops", f"their {self.count(n)} stops {self.v('last')} {self.sec(z)} when summed", f"{self.count(n)} breaks in the walk {self.v('eat')} {self.sec(z)} in total" if self.tense != "past" else f"{self.count(n)} breaks in the walk ate up {self.sec(z)} in total",
            f"they {self.v('take')} {self.count(n)} pauses and {self.v('spend')} {self.sec(z)} on them in total" if self.tense != "past" else f"they took {self.count(n)} pauses and spent {self.sec(z)} on them in total")

    # ---- length, duration, speed
    def way_note(self, flight):
        w = self.m(flight.way)
        return self.pick(f"walked: {w}", f"length of the walk {w}", f"{w} on foot", f"walk of {w}", f"ground covered: {w}", f"path length {w}", f"{w} walked", f"walking distance: {w}", f"total walk {w}", f"covers {w} on foot")

    def pace_note(self, flight):
        x = self.mps(flight.speed)
        return self.pick(f"average pace {x}", f"pace: {x}", f"walking speed {x}", f"mean speed on foot: {x}", f"speed of the walk, {x}", f"{x} average walking speed", f"walks at {x}", f"walking pace {x}")

    def time_note(self, flight):
        z = self.sec(flight.duration)
        return self.pick(f"runtime {z}", f"duration: {z}", f"flight time {z}", f"length of the take: {z}", f"{z} in the air", f"take: {z}", f"airtime {z}", f"flight of {z}", f"rolled for {z}" if self.tense == "past" else f"running time {z}")

    def way_say(self, flight):
        w = self.m(flight.way)
        return self.pick(f"they {self.v('cover')} {w} on foot", f"they {self.v('walk')} {w} in all", f"{w} {self.vs('be')} the length of the walk", f"their walk {self.vs('add')} up to {w}", f"all told they {self.v('put')} {w} behind them", f"on foot, {w} {self.vs('be')} covered",
                         f"the path they {self.v('walk')} {self.vs('measure')} {w}", f"how far {self.do()} they walk? {cap(w)}", f"the walk {self.vs('come')} to {w}", f"from first step to last, {w} {self.v('be')} walked")

    def pace_say(self, flight):
        x = self.mps(flight.speed)
        return self.pick(f"they {self.v('do')} {x} on average", f"average pace {self.vs('be')} {x}", f"walking speed {self.vs('average')} {x}", f"{x} {self.vs('be')} their mean speed on foot", f"the pace? {cap(x)}", f"they {self.v('walk')} at {x}", f"on the whole they {self.v('move')} at {x}",
                         f"their steps {self.v('carry')} them along at {x}" if self.tense != "past" else f"their steps carried them along at {x}", f"their mean walking speed {self.vs('come')} out at {x}", f"a walking pace of {x} {self.vs('be')} the average")

    def time_say(self, flight):
        z = self.sec(flight.duration)
        return self.pick(f"the take {self.vs('run')} {z}", f"the flight {self.vs('last')} {z}", f"we {self.v('be')} in the air for {z}", f"flight time {self.vs('be')} {z}", f"{z} {self.vs('be')} the length of the flight", f"we {self.v('roll')} for {z}", f"duration? {cap(z)}",
                         f"from start to end the flight {self.vs('take')} {z}", f"the whole flight {self.vs('come')} to {z}", f"all of it {self.vs('fit')} into {z}" if self.tense != "past" else f"all of it fitted into {z}")

    def walk_say(self, flight):           # two or three facts joined
        w, x, z = self.m(flight.way), self.mps(flight.speed), self.sec(flight.duration)
        return self.pick(
            [f"they {self.v('cover')} {w} at an average of {x}", self.time_say(flight)], [f"they {self.v('walk')} {w}, doing {x} on average, and the flight {self.vs('last')} {z}"], [f"the walk {self.vs('be')} {w} long and {self.vs('average')} {x}", self.time_say(flight)],
            [f"in a flight of {z} they {self.v('cover')} {w}, at {x}"], [f"{w} on foot at {x}, with {z} on the clock"], [self.time_say(flight), f"in that time they {self.v('walk')} {w} at a mean speed of {x}"], [self.way_say(flight), self.pace_say(flight), self.time_say(flight)],
            [self.way_say(flight), self.time_say(flight), self.pace_say(flight)], [f"{w} of walking at {x} {self.v('go')} into {art(self.secadj(flight.duration))} flight"], [f"pace {x}, distance walked {w}, flight time {z}"])

    def stand_say(self, flight):
        z, who = self.sec(flight.duration), "they"
        return self.pick(f"they {self.v('stand')} on one spot for all {z} of the flight", f"for {z}, which {self.vs('be')} the whole flight, they {self.v('stand')} in place", f"in the {z} the flight {self.vs('last')}, they {self.v('stay')} put", f"no walking: they {self.v('stand')} still for the full {z}",
                         f"they {self.v('hold')} one position, standing, until the flight {self.vs('end')} after {z}", f"walk? No, they {self.v('stand')} where they {self.v('be')} for {z}", f"{z} of standing on the same spot, start to finish, {self.vs('be')} what they {self.v('do')}",
                         f"they {self.v('stand')} and never {self.v('leave')} their spot in the {z} of this flight" if self.tense != "future" else f"they will stand and not leave their spot in the {z} of this flight", f"standing still {self.vs('be')} all they {self.v('do')}, for {z}", f"the flight {self.vs('last')} {z} and they {self.v('stand')} in one place throughout")

    def stand_note(self, flight):
        z = self.sec(flight.duration)
        return self.pick(f"standing on one spot, {z}", f"stationary for all {z}", f"stands in place, {z}, whole flight", f"no walking, standing still for {z}", f"static subject, {z}", f"standing throughout, flight time {z}", f"on one spot the whole flight, {z}", f"stays put, duration {z}")

    def stand_do(self, flight):
        z = self.sec(flight.duration)
        return self.pick("they stand on one spot", "they won't be walking, just standing", "the person stays put", f"they'll be standing in one place for {z}", "no walking on this one, they stand", "it's a standing shot: the person doesn't leave the spot",
                         "they hold their spot", "expect them to stand where they are", "they're standing and will keep standing", f"figure on {z} of the person standing in place", "", "")

    # ---- instruction
    def open_do(self):
        return self.pick("Okay.", "Drone, listen up.", "Stand by.", "Quick message for the pilot.", "Voice note:", "Radio check done.", "Next setup.", "Here's the shot.", "Right, dictating.", "Pilot, copy.", "All set?", "Camera ready.", "Brief follows.", "Message for you:", "", "", "", "", "")

    def close(self): return self.pick(*self.outs, "", "", "", "", "", "", "", "", "", "")

    def extras(self, flight):             # optional further facts as sentences
        out = []
        if flight.altitude >= 1 and self.rng.random() < 0.5: out.append(self.high_do(flight))
        if flight.walks:
            if self.rng.random() < 0.4: out.append(self.turn_say(flight))
            if self.rng.random() < 0.35: out.append(self.stop_say(flight))
            if self.rng.random() < 0.2: out.append(self.way_say(flight))
            if self.rng.random() < 0.15: out.append(self.pace_say(flight))
            if self.rng.random() < 0.15: out.append(self.time_say(flight))
        else:
            out.append(self.stand_do(flight))
        return out

    def track(self, flight):
        return self.pick("follow", "track", "stay with", "stay on", "film", "keep the camera on") if flight.walks else self.pick("film", "hold on", "stay on", "keep the camera on", "shoot", "keep in frame")

    def instruction(self, flight):
        self.begin(self.pick("future", "present"))
        k = self.rng.randrange(14)
        who, track, extras = self.who(flight, k in (2, 5, 6)), self.track(flight), self.extras(flight)
        comma = "," if "whose" in who or "whoever" in who else ""
        if k == 0: text = self.all([f"{track} {who}", self.far_do(flight), self.tilt_do(flight)] + extras)
        elif k == 1: text = self.all([f"{track} {who}{comma} {self.far_how(flight)}, {self.tilt_how(flight)}"] + extras)
        elif k == 2: text = self.all([self.far_note(flight), self.tilt_note(flight), self.pick(f"that's on {who}", f"eyes on {who}", f"job: {track} {who}")] + extras)
        elif k == 3: text = self.all([f"can you {track} {who}{comma} {self.far_how(flight)}, {self.tilt_how(flight)}?"] + extras)
        elif k == 4: text = "\n".join(["- " + cap(x) for x in [self.label(flight), self.far_note(flight), self.tilt_note(flight)] + self.short(flight)])
        elif k == 5: text = self.all([self.pick(f"the shot is on {who}", f"subject is {who}", f"picture {who}, that's your frame", f"you're on {who}", f"who you want is {who}"), self.tilt_do(flight), self.far_do(flight)] + extras)
        elif k == 6: text = self.all([self.pick("who?", "on whom?", "your subject?"), who, "range?", self.m(flight.distance), self.pick("lens?", "camera?", "tilt?"), self.aim(flight)] + extras)
        elif k == 7: text = self.all([f"with {self.tilt(flight)} and {self.m(flight.distance)} between you and the subject, {track} {who}"] + extras)
        elif k == 8:
            text = ". New line. ".join([cap(self.label(flight)), cap(self.far_note(flight)), cap(self.tilt_note(flight))] + [cap(x) for x in self.short(flight)]) + "."
        elif k == 9: text = self.all(extras[:1] + [f"what I need is {who}, shot {self.pick('from', 'at')} {self.m(flight.distance)} {self.pick('with', 'using')} {self.tilt(flight)}"] + extras[1:])
        elif k == 10: text = self.all([self.pick(f"{who} is to be filmed {self.far_how(flight)}, {self.tilt_how(flight)}", f"{who} gets filmed {self.far_how(flight)}, {self.tilt_how(flight)}")] + extras)
        elif k == 11: text = self.all([self.pick("tell the drone this:", "take this down:", "shot as follows:") + f" {self.far_note(flight)}, {self.tilt_note(flight)}, on {who}"] + extras)
        elif k == 12: text = self.all([f"{self.tilt_do(flight)}", self.pick("then", "now", "and") + f" {track} {who}{comma} {self.far_how(flight)}"] + extras)
        else: text = self.all([f"once you have {who} in frame, {self.pick('settle at', 'hold', 'work at', 'stay at')} {self.m(flight.distance)} {self.pick('with', 'using')} {self.tilt(flight)}"] + extras)
        if k in (4, 8): return text
        opening = self.open_do()
        if k in (2, 6, 11): opening = opening.replace(":", ".")
        return " ".join(x for x in (opening, text, self.close()) if x)

    def short(self, flight):              # optional notes
        out = []
        if flight.altitude >= 1 and self.rng.random() < 0.5: out.append(self.high_note(flight))
        if flight.walks:
            if self.rng.random() < 0.4: out.append(self.turn_note(flight))
            if self.rng.random() < 0.4: out.append(self.stop_note(flight))
        elif self.rng.random() < 0.8: out.append(self.pick("they stand on one spot", "stationary", "no walking, standing", "standing in place"))
        return out

    # ---- description
    def open_say(self): return self.pick("Cut.", "Log entry.", "Reporting back.", "Okay, that's in the can.", "Voice memo.", "For the record:", "Flight report, dictated.", "Debrief:", "And we're clear.", "Note to file.", "Drone's down. Summary:", "", "", "", "", "", "")

    def is_who(self, flight):
        who = self.who(flight, True)
        if flight.walks: return self.pick(f"we {self.v('follow')} {who}", f"the drone {self.vs('stay')} with {who}", f"filmed: {who}", f"on camera: {who}", f"subject {self.vs('be')} {who}", f"{who} {self.vs('be')} tracked from the air", f"it {self.vs('be')} {who} we {self.v('have')} in frame", f"the shot {self.vs('be')} on {who}",
                                          f"{who} {self.vs('be')} the one on camera", f"the camera {self.vs('be')} on {who}")
        return self.pick(f"we {self.v('film')} {who}", f"the drone {self.vs('hold')} on {who}", f"filmed: {who}", f"on camera: {who}", f"subject {self.vs('be')} {who}", f"{who} {self.vs('be')} filmed from the drone", f"it {self.vs('be')} {who} we {self.v('have')} in frame", f"the shot {self.vs('be')} on {who}")

    def body(self, flight):               # what the person does, sentences
        if not flight.walks: return [self.stand_say(flight)]
        t, s, w = [self.turn_say(flight)], [self.stop_say(flight)], self.walk_say(flight)
        return self.pick(t + s + w, w + t + s, s + t + w, w + s + t, t + w + s, [f"{self.turn_note(flight)}; {self.stop_note(flight)}"] + w)

    def rig(self, flight):                # what the camera does, sentences
        high = [self.high_say(flight)] if flight.altitude >= 1 else []
        far, tilt = [self.far_say(flight)], [self.tilt_say(flight)]
        joined = self.s(f"we {self.v('shoot') if self.tense != 'past' else 'shot'} {self.far_how(flight)}" + (f" and {self.high_how(flight)}" if high else "") + f", {self.tilt_how(flight)}")
        return self.pick(far + tilt + high, high + far + tilt, tilt + high + far, tilt + far + high, [joined])

    def notes(self, flight):
        rig = [self.far_note(flight), self.tilt_note(flight)] + ([self.high_note(flight)] if flight.altitude >= 1 else [])
        if flight.walks:
            body = [self.turn_note(flight), self.stop_note(flight), self.way_note(flight), self.pace_note(flight), self.time_note(flight)]
        else: body = [self.stand_note(flight)]
        self.rng.shuffle(body)
        self.rng.shuffle(rig)
        return self.pick(rig + body, body + rig)

    def one_sentence(self, flight):
        who, far, tilt = self.who(flight), self.far_how(flight), self.tilt_how(flight)
        high = f", {self.high_how(flight)}" if flight.altitude >= 1 else ""
        z = self.sec(flight.duration)
        if not flight.walks:
            return self.pick(f"for {z} the drone {self.vs('film')} {who} {far}{high}, {tilt}, while the person {self.vs('stand')} on one spot", f"{who} {self.vs('stand')} in one place for {z}, filmed {far}{high}, {tilt}",
                             f"the whole {self.secadj(flight.duration)} flight {self.vs('be')} spent {far}{high}, {tilt}, on {who}, who never {self.vs('move') if self.tense == 'past' else 'moves'} from the spot")
        turns, stops, w, x = self.turn_note(flight), self.stop_note(flight), self.m(flight.way), self.mps(flight.speed)
        return self.pick(
            f"for {z} the drone {self.vs('follow')} {who} {far}{high}, {tilt}, over {w} of walking at {x} ({turns}; {stops})",
            f"filmed {far}{high}, {tilt}, {who} {self.vs('cover')} {w} at {x} in a flight of {z}: {turns}; {stops}",
            f"{z} of flight; {w} on foot at {x}; {turns}; {stops}; and {who} seen {far}{high}, {tilt}",
            f"while {who} {self.vs('walk')} {w} at an average {x} ({stops}; {turns}), the drone {self.vs('film')} for {z} {far}{high}, {tilt}")

    def description(self, flight):
        self.begin(self.pick("past", "past", "past", "present"))
        k = self.rng.randrange(13)
        body, rig, who = self.body(flight), self.rig(flight), self.is_who(flight)
        if k == 0: text = self.all([who] + rig + body)
        elif k == 1: text = self.all([who] + body + rig)
        elif k == 2: text = self.all([self.one_sentence(flight)])
        elif k == 3: return "\n".join(["- " + cap(x) for x in [self.label(flight)] + self.notes(flight)])
        elif k == 4: return ". New line. ".join([cap(x) for x in [self.label(flight)] + self.notes(flight)]) + "."
        elif k == 5: text = self.all([self.label(flight)] + self.notes(flight))
        elif k == 6: text = self.all([self.label(flight) + "; " + "; ".join(self.notes(flight))])
        elif k == 7: text = self.all(rig[:1] + [who] + body + rig[1:])
        elif k == 8: text = self.all([self.pick("Our end:", "Camera side:", "Drone side:")[:-1] + ": " + self.low(rig[0])] + rig[1:] + [self.pick("Their end", "On the ground", "The person's side") + ": " + self.who(flight)] + body)
        elif k == 9: text = self.all([self.time_say(flight) if flight.walks else who] + ([who, self.turn_say(flight), self.stop_say(flight), f"they {self.v('cover')} {self.m(flight.way)} at a mean {self.mps(flight.speed)}"] if flight.walks else body) + rig)
        elif k == 10:
            ask = [("Subject?", self.who(flight, True)), ("Range?", self.m(flight.distance)), ("Camera?", self.aim(flight))]
            if flight.altitude >= 1: ask.append(("Height?", self.m(flight.altitude)))
            ask += [("Turns?", self.bare(self.turn_note(flight))), ("Pauses?", self.bare(self.stop_note(flight))), ("Ground covered on foot?", self.m(flight.way)), ("Walking speed?", self.mps(flight.speed)), ("Flight time?", self.sec(flight.duration))] if flight.walks else [("Movement?", self.stand_note(flight))]
            text = " ".join(q + " " + self.s(a) for q, a in ask)
        elif k == 11:
            lines = [self.s(x) for x in [who] + body + rig]
            text = self.pick(" Break. ", " Next. ", " ").join(lines)
        else:
            high = f", {self.high_how(flight)}" if flight.altitude >= 1 else ""
            first = f"{self.far_how(flight)}{high}, {self.tilt_how(flight)}: that {self.vs('be')} how {self.pick('the drone', 'the camera')} {self.pick(self.vs('film'), self.vs('frame'))} {self.who(flight)}"
            text = self.all([first] + body)
        opening = self.open_say()
        if k in (5, 6, 8, 10): opening = opening.replace(":", ".")
        return " ".join(x for x in (opening, text, self.close()) if x)

    def bare(self, note):
        if note in ("turns: none", "turning: none", "stops: none"): return "zero"
        return note.split(": ", 1)[1] if note.split(": ")[0].split()[0] in ("turns", "sequence", "stops", "pauses", "turning") and ": " in note else note

    def low(self, text): return text if text[:2].isupper() else text[:1].lower() + text[1:]

    # ---- wrong texts
    def tail(self, text):
        for out in self.outs:
            if text.endswith(" " + out): return text[:-len(out) - 1], " " + out
        return text, ""

    def foreign(self, text):
        body, out = self.tail(text)
        if self.rng.random() < 0.4:
            who = self.pick(*self.persons)
            extra = self.pick(f"The person is {an(who)}.", f"For what it's worth, that's {an(who)}.", f"Also in frame: {an(who)}.", f"Next to them, {an(who)}.", f"Note: subject is {an(who)}.", f"It's {an(who)} we're talking about.")
        else:
            thing = self.pick(*self.things)
            if body.endswith(".") and "\n" not in body and "New line" not in body and self.rng.random() < 0.5: return body[:-1] + ", " + thing + "." + out
            extra = self.pick(f"All of it {thing}.", f"That's {thing}, by the way.", f"Add to that: {thing}.", f"One more note, {thing}.", f"The person is {thing}." if thing.split()[0] in "beside under next in on along among by near behind holding pushing with".split() else f"This, {thing}.")
        return (body + "\n- " + extra[:-1] if "\n" in body else body + (" New line. " if ". New line. " in body else " ") + extra) + out

    def heading(self, text, direction):
        body, out = self.tail(text)
        extra = self.pick(f"Direction of the walk: {direction}.", f"The person is heading {direction}.", f"Course on foot, {direction}.", f"They're bound {direction}.", f"It's a walk to the {direction}.", f"Heading {direction}, the person.", f"The walk goes {direction}.",
                          f"Person's heading: {direction}.", f"The person makes for the {direction}.", f"Which way on foot? {cap(direction)}.", f"Movement is {direction}ward.")
        return (body + "\n- " + extra[:-1] if "\n" in body else body + (" New line. " if ". New line. " in body else " ") + extra) + out


DIGITS = "零一二三四五六七八九"


def zh_words(n, liang=True):
    if n == 0: return "零"
    text, zero = "", False
    for size, name in ((1000, "千"), (100, "百"), (10, "十"), (1, "")):
        d = n // size % 10
        if d == 0:
            zero = bool(text)
            continue
        if zero: text += "零"
        zero = False
        if size == 10 and d == 1 and not text: text += "十"
        elif d == 2 and size >= 100 and liang: text += "两" + name
        elif d == 2 and size == 1 and n == 2 and liang: text += "两"
        else: text += DIGITS[d] + name
    return text


class TwentyFirstChinese(Grammar):
    code = "zh"
    things = ["旁边有个喷泉", "远处打着雷", "带着两条狗", "身后是一排梧桐树", "路边停着一辆面包车", "教堂的钟正在响", "下着大雨", "经过一家面包店", "走在木桥上", "手里撑着伞", "沿着运河", "有电车开过", "背后是一面涂鸦墙", "周围全是菜摊", "挨着邮筒", "踩着积雪",
              "耳边贴着手机", "太阳刚下山", "前面有辆卡车", "手里拿着一束气球", "旁边有座雕像", "靠近公交站", "有人骑车跟着", "雾很大", "头顶是铁路桥", "推着婴儿车"]
    persons = ["护士", "渔夫", "新娘", "邮递员", "中学生", "女警察", "老爷爷", "服务员", "士兵", "小姑娘", "水管工", "和尚"]
    outs = ["完毕。", "收到请回。", "过。", "停机。", "收工。", "通话结束。", "就这些。", "先这样。", "抄收请回复。", "没了。", "发送。"]

    # ---- style and numbers
    def begin(self, past):
        self.past = past
        self.spelled = self.rng.random() < 0.2
        self.unit = "米" if self.spelled else self.pick("米", "米", "米", "m")
        self.second = "秒" if self.spelled else self.pick("秒", "秒", "秒", "秒钟")
        self.degree = "度" if self.spelled else self.pick("度", "度", "°")
        self.gap = "" if self.unit != "m" else self.pick("", " ")
        self.le = "了" if past else ""
        left, right = self.pick(("左转", "右转"), ("左拐", "右拐"), ("向左转", "向右转"), ("往左拐", "往右拐"))
        self.say = {"left": left, "right": right, "around": self.pick("掉头", "掉头", "回头折返", "转身往回走")}

    def n(self, n): return zh_words(n) if self.spelled else str(n)

    def m(self, n): return self.n(n) + self.gap + self.unit

    def sec(self, n): return self.n(n) + self.second

    def deg(self, n): return zh_words(n, False).replace("两", "二") + "度" if self.spelled else f"{n}{self.degree}"

    def mps(self, speed):
        text = f"{speed:.1f}"
        if self.spelled:
            a, b = text.split(".")
            return self.pick("每秒{}米", "{}米每秒").format(zh_words(int(a), False) + "点" + DIGITS[int(b)])
        return self.pick(f"每秒{text}米", f"{text}米每秒", f"{text}m/s", f"{text}米/秒", f"每秒钟{text}米")

    def count(self, n): return zh_words(n) if self.spelled or self.rng.random() < 0.5 else str(n)

    def lines(self, parts, mark="。"):
        parts = [p for p in parts if p]
        text = ""
        for p in parts: text += p if p[-1] in "。？！：" else p + mark
        return text[:-1] + "。" if mark != "。" and text.endswith(mark) else text

    def mix(self, parts):                 # some commas, some full stops
        parts, text = [p for p in parts if p], ""
        for i, p in enumerate(parts):
            if p[-1] in "。？！": text += p
            else: text += p + ("。" if i == len(parts) - 1 else self.pick("，", "。", "。", "；" if "：" not in p else "。"))
        return text

    # ---- who
    def colour(self, c, noun):
        z = ZH_COLOURS[c]
        return z + noun if z in "黑灰白红黄绿蓝紫" and self.rng.random() < 0.5 else z + "色" + noun

    def noun(self, flight): return self.pick("人", "人", "目标", "拍摄对象", "跟拍对象", "被摄人", "步行者") if flight.walks else self.pick("人", "人", "目标", "拍摄对象", "被摄人")

    def pack(self): return self.pick("背双肩包", "背着包", "背着背包", "背着双肩包", "肩上背着背包", "背上有个背包")

    def who(self, flight, plain=False):
        noun = self.noun(flight) if not plain else self.pick("人", "人", "步行者") if flight.walks else "人"
        if flight.wear is None:
            if plain: return self.pick("那个人", "一个人", "一位被摄者", "这个人", "取景框里的人", "监视器里的那个人", "屏幕上那个人")
            return self.pick(f"那个{noun}" if noun == "人" else noun, "画面里那个人", "监视器里的那个人", "镜头里那个人", "目标", "拍摄对象", "这个人", "取景框里的人", "咱们要拍的那个人" if not self.past else "咱们拍的那个人", "屏幕上那个人", "被拍的人", "画面中的目标")
        a, b, pack = flight.wear
        za, zb = ZH_COLOURS[a] + "色", ZH_COLOURS[b] + "色"
        top, low = self.colour(a, self.pick("上衣", "上衣", "上装")), self.colour(b, self.pick("裤子", "裤子", "长裤"))
        if a == b and self.rng.random() < 0.45:
            p = f"、{self.pack()}" if pack else self.pick("", "", "、没背包")
            return self.pick(f"上衣裤子都是{za}{p}的那个人", f"上下身都穿{za}{p}的{noun}", f"从上衣到裤子一律{za}{p}的{noun}", f"{za}上衣搭{za}裤子{p}的那个人")
        if pack:
            p = self.pack()
            return self.pick(f"穿{top}、{low}，{p}的那个人", f"{top}{low}、{p}的那位", f"上身{za}、下身{zb}、{p}的{noun}", f"{p}、穿{top}和{low}的{noun}", f"那个{p}、{top}配{low}的{noun}",
                             f"穿着{low}、{top}，还{p}的那个人", f"身着{top}与{low}、{p}的{noun}", f"上面穿{za}、下面穿{zb}、{p}的那个人", f"{'那个人' if noun == '人' else noun}（{top}，{low}，有背包）", f"上衣{za}、裤子{zb}、{p}的那位", f"{p}的那个人（{za}上衣、{zb}裤子）", f"{low}搭{top}、{p}的{noun}")
        none = self.pick("", "", "", "、没背包")
        return self.pick(f"穿{top}、{low}{none}的那个人", f"{top}{low}{none}的那位", f"上身{za}、下身{zb}{none}的{noun}", f"穿{top}和{low}{none}的{noun}", f"那个{top}配{low}{none}的{noun}", f"穿着{low}、{top}{none}的那个人", f"身着{top}与{low}{none}的{noun}", f"上面穿{za}、下面穿{zb}{none}的那个人",
                         f"{'那个人' if noun == '人' else noun}（{top}，{low}）", f"上衣{za}、裤子{zb}{none}的那位", f"下身{zb}、上身{za}{none}的那个人", f"{low}搭{top}{none}的{noun}")

    def label(self, flight):
        head = self.pick("目标", "对象", "人物", "拍的是", "拍谁", "被摄人")
        if flight.wear is None: return self.pick("目标：一个人", "人物：单人", "拍摄对象：一人", f"{head}：一个人")
        a, b, pack = flight.wear
        za, zb = ZH_COLOURS[a] + "色", ZH_COLOURS[b] + "色"
        p = self.pick("，背包", "，有双肩包", "，背着包", "，带背包") if pack else self.pick("", "", "", "，无背包")
        return self.pick(f"{head}：{za}上衣，{zb}裤子{p}", f"{head}：上{za}下{zb}{p}", f"{head}：上衣{za}，裤子{zb}{p}", f"{head}：{zb}长裤，{za}上衣{p}", f"服装：{za}上装，{zb}长裤{p}", f"穿着：{za}上衣配{zb}裤子{p}")

    # ---- distance
    def far_how(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"隔着{d}", f"在{d}外", f"保持{d}的距离", f"离人{d}", f"隔{d}远", f"以{d}的间距", f"从{d}外", f"相距{d}", f"留着{d}的空当")

    def far_note(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"距离{d}", f"离人{d}", f"机到人{d}", f"人机距离：{d}", f"镜头到人{d}", f"间距{d}", f"和人隔{d}", f"拍摄距离{d}", f"距目标{d}", f"距离：{d}", f"相距{d}", f"无人机离目标{d}")

    def far_say(self, flight):
        d, le = self.m(flight.distance), self.le
        return self.pick(f"飞机跟人平均隔着{d}", f"无人机离人{d}", f"人和飞机之间是{d}", f"距离平均下来{d}", f"拍的时候离人{d}", f"我们在{d}外拍的" if self.past else f"我们在{d}外拍", f"离多远？{d}", f"和目标的距离是{d}", f"镜头离目标有{d}", f"{d}，这是飞机到人的平均距离",
                         f"飞机跟目标拉开{le}{d}", f"机位设在离人{d}的地方", f"人机间距保持在{d}")

    def far_do(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"跟人保持{d}", f"离人{d}", f"距离给我控制在{d}", f"和目标隔开{d}", f"能不能拉到{d}远？", f"我要{d}的距离", f"你就待在离人{d}的位置", f"飞机到人，{d}", f"机位离人{d}", f"距离就{d}", f"中间留出{d}", f"请保持{d}间距", f"麻烦把距离定在{d}", f"隔{d}跟着拍" if flight.walks else f"隔{d}拍", f"飞机别凑近也别跑远，{d}")

    # ---- pitch
    def tilt_how(self, flight):
        p, d = flight.pitch, self.deg(abs(flight.pitch))
        if p == 0: return self.pick("镜头放平", "云台水平", "镜头平视", "不俯不仰", "镜头对准水平线", "水平机位", "俯仰归零", "镜头端平", "以水平视角")
        if p > 0: return self.pick(f"镜头下压{d}", f"云台俯{d}", f"以{d}俯角", f"镜头朝下{d}", f"下俯{d}", f"镜头比水平低{d}", f"俯拍{d}", f"云台往下打{d}", f"镜头向下倾{d}", f"用{d}的俯角")
        return self.pick(f"镜头上抬{d}", f"云台仰{d}", f"以{d}仰角", f"镜头朝上{d}", f"上仰{d}", f"镜头比水平高{d}", f"仰拍{d}", f"云台往上打{d}", f"镜头向上扬{d}", f"用{d}的仰角")

    def tilt_note(self, flight):
        p, d = flight.pitch, self.deg(abs(flight.pitch))
        if p == 0: return self.pick("俯仰：0" + ("°" if self.degree == "°" else "度"), "镜头水平", "云台放平", "镜头平视", "无俯仰", "角度：水平", "云台归零，水平", "镜头不俯不仰", "拍摄角度水平")
        if p > 0: return self.pick(f"俯角{d}", f"俯角：{d}", f"云台向下{d}", f"镜头下俯{d}", f"镜头低于水平{d}", f"下倾{d}", f"角度：俯{d}", f"镜头往下{d}", f"镜头低于地平线{d}", f"俯拍{d}")
        return self.pick(f"仰角{d}", f"仰角：{d}", f"云台向上{d}", f"镜头上仰{d}", f"镜头高于水平{d}", f"上扬{d}", f"角度：仰{d}", f"镜头往上{d}", f"镜头高于地平线{d}", f"仰拍{d}")

    def tilt_say(self, flight):
        p, d = flight.pitch, self.deg(abs(flight.pitch))
        if p == 0: return self.pick("镜头是放平的", "云台打的水平", "镜头既不俯也不仰", "俯仰角是零", "镜头对着水平方向", "拍摄角度是水平的", "镜头呢？水平", "云台没有俯仰", "画面是平视拍的" if self.past else "画面是平视的", "镜头跟地平线齐平", "相机处于水平状态")
        side, verb, comp, word = ("俯", "压", "低", "下") if p > 0 else ("仰", "抬", "高", "上")
        return self.pick(f"镜头往{word}{verb}{self.le}{d}", f"云台{word}{side}{d}", f"{side}角是{d}", f"镜头比地平线{comp}{d}", f"相机朝{word}{d}", f"角度？{side}{d}", f"拍摄用的是{d}{side}角", f"云台朝{word}打{self.le}{d}", f"{d}的{side}角，镜头就这么架着", f"镜头{word}{'倾' if p > 0 else '扬'}{d}",
                         f"镜头相对水平往{word}偏{d}")

    def tilt_do(self, flight):
        p, d = flight.pitch, self.deg(abs(flight.pitch))
        if p == 0: return self.pick("镜头放平", "云台打平", "俯仰归零", "镜头别俯也别仰", "给我一个水平角度", "能把镜头放平吗？", "镜头要水平的", "请用平视角度拍", "相机保持水平", "麻烦云台归零", "镜头对着地平线", "角度不用压，水平就行")
        side, verb, comp, word = ("俯", "压", "低", "下") if p > 0 else ("仰", "抬", "高", "上")
        return self.pick(f"镜头往{word}{verb}{d}", f"云台{word}{side}{d}", f"给个{d}{side}角", f"{side}角要{d}", f"把镜头{verb}到水平以{word}{d}", f"能{side}{d}拍吗？", f"请把云台朝{word}打{d}", f"镜头朝{word}，{d}", f"麻烦镜头{word}{'倾' if p > 0 else '扬'}{d}", f"我要{d}的{side}角", f"{side}角就{d}", f"镜头比地平线{comp}{d}", f"相机朝{word}{d}拍")

    # ---- height
    def high_note(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"高度{a}", f"飞高{a}", f"飞行高度：{a}", f"高出人脚底{a}", f"离人脚下地面高{a}", f"机高{a}", f"比人的脚高{a}", f"高度：{a}", f"飞机在人脚底以上{a}", f"相对人脚高度{a}")

    def high_say(self, flight):
        a, le = self.m(flight.altitude), self.le
        return self.pick(f"飞机比人脚底高{a}", f"高度是{a}", f"飞{le}{a}高", f"飞行高度{a}", f"多高？{a}", f"从人脚下算，飞机高{a}", f"飞机挂在{a}的高度", f"高度维持在{a}", f"以人脚为准，高出{a}", f"机位高{a}", f"无人机升到{le}{a}高")

    def high_do(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"飞{a}高", f"高度{a}", f"拉到{a}高", f"比人脚底高{a}", f"高度给到{a}", f"请升到{a}", f"飞机高{a}就行", f"能飞到{a}高吗？", f"高度要{a}", f"高度控制在人脚上方{a}", f"机位高度定{a}")

    def high_how(self, flight):
        a = self.m(flight.altitude)
        return self.pick(f"{a}高", f"高度{a}", f"飞高{a}", f"高出脚底{a}", f"机高{a}")

    # ---- turns
    def one(self, t): return self.say[t]

    def bare(self, t): return {"left": "左", "right": "右", "around": "掉头"}[t]

    def seq(self, turns):
        items = [self.one(t) for t in turns]
        if len(items) == 1: return items[0]
        if len(items) == 2: return self.pick(f"先{items[0]}，再{items[1]}", f"{items[0]}，然后{items[1]}", f"{items[0]}、{items[1]}")
        return self.pick("、".join(items), "先" + items[0] + "，再" + "，再".join(items[1:-1]) + "，最后" + items[-1], "，".join([items[0]] + ["然后" + x for x in items[1:]]), "，接着".join(items))

    def list(self, turns): return self.pick("、", "、", "—", "→").join(self.bare(t) for t in turns)

    def group(self, turns):
        pieces = []
        for t, k in runs(turns):
            verb = {"left": "左转", "right": "右转", "around": "掉头"}[t]
            pieces.append(verb if k == 1 else f"连着{verb}{self.count(k)}次")
        if len(pieces) == 1: return pieces[0]
        return "先" + "，再".join(pieces)

    def turn_note(self, flight):
        t, n = flight.turns, len(flight.turns)
        if not n: return self.pick("没有转弯", "转弯：无", "零转向", "一次弯没拐", "转向0次", "不拐弯", "未转向", "转弯0次")
        if n == 1: return self.pick(f"转向一次：{self.bare(t[0])}", f"{self.one(t[0])}一次", f"转向：{self.bare(t[0])}（1次）", f"只有一次转向，{self.one(t[0])}", f"转向1次，{self.one(t[0])}", f"唯一的转向是{self.one(t[0])}")
        extra = [f"{self.count(n)}次转向全是{self.one(t[0])}"] if len(set(t)) == 1 else []
        return self.pick(f"转向{self.count(n)}次：{self.list(t)}", f"转向顺序：{self.list(t)}", f"转向依次为{self.list(t)}", f"{self.count(n)}次转向，{self.seq(t)}", f"转向（{n}次）：{self.list(t)}", f"依次{'、'.join(self.one(x) for x in t)}", f"转向：{self.list(t)}，共{self.count(n)}次", self.group(t), *extra)

    def turn_say(self, flight):
        t, n, le = flight.turns, len(flight.turns), self.le
        if not n:
            return self.pick("一路没拐弯", "路上没有转过弯" if self.past else "路上不转弯", "一个弯也没有", "转弯？没有", "从头到尾没转向" if self.past else "从头到尾不转向", "没拐弯也没掉头" if self.past else "不拐弯也不掉头", "中间没有任何转向", "左转右转掉头，一个都没有", "转弯次数为零", "一次转向都没有")
        if n == 1:
            o = self.one(t[0])
            return self.pick(f"只转{le}一次，{o}", f"路上{o}{le}一次" if self.past else f"路上{o}一次", f"就一次转向：{self.bare(t[0])}", f"转向？一次，{o}", f"中间有一次{o}", f"唯一一次转向是{o}", f"{o}一次，再没别的转向", f"途中{o}一回，仅此一回", f"总共一次转向，{o}", f"转向只有一次，是{o}")
        extra = [f"转{le}{self.count(n)}次，次次都是{self.one(t[0])}", f"{self.count(n)}次转向全部是{self.one(t[0])}"] if len(set(t)) == 1 else []
        ordinal = "，".join(f"第{zh_words(i + 1, False)}次{self.one(x)}" for i, x in enumerate(t))
        return self.pick(f"途中{self.seq(t)}", f"一共转向{self.count(n)}次：{self.list(t)}", f"转向依次是{self.list(t)}", f"转{le}{self.count(n)}次向，{self.seq(t)}", f"{self.count(n)}次转向，顺序是{self.list(t)}", f"人{self.group(t)}", f"转向的情况：{ordinal}", f"转向？{self.count(n)}次，{self.list(t)}",
                         f"按先后，{'、'.join(self.one(x) for x in t)}", f"路上要转{self.count(n)}次：{self.list(t)}" if not self.past else f"路上转了{self.count(n)}次：{self.list(t)}", f"走着走着{self.group(t)}", *extra)

    # ---- stops
    def stop_note(self, flight):
        n, z = flight.stops, flight.standing
        if not n: return self.pick("无停顿", "停顿：无", "中途不停", "停0次", "没有停步", "零停留", "停留0次")
        if not z: return f"停顿{self.count(n)}次"
        if n == 1: return self.pick(f"停一次，{self.sec(z)}", f"停顿1次，{self.sec(z)}", f"停步一回共{self.sec(z)}", f"仅停一次，停{self.sec(z)}", f"停留：一次{self.sec(z)}", f"有一次{self.sec(z)}的停顿")
        return self.pick(f"停{self.count(n)}次，共{self.sec(z)}", f"停顿{self.count(n)}次，合计{self.sec(z)}", f"停步{self.count(n)}回，加起来{self.sec(z)}", f"停留：{self.count(n)}次，总计{self.sec(z)}", f"{self.count(n)}次停顿总共{self.sec(z)}", f"站住{self.count(n)}次（累计{self.sec(z)}）")

    def stop_say(self, flight):
        n, z, le = flight.stops, flight.standing, self.le
        if not n: return self.pick("中间没停过" if self.past else "中间不停", "一步没歇" if self.past else "中途不歇", "路上没有停顿", "停没停？没停" if self.past else "停顿？没有", "一次也没站住" if self.past else "一次也不站住", "没有任何停留", "一路没停" if self.past else "一路不停", "停步次数为零", "全程不带停的", "始终没有停下脚步" if self.past else "始终不停下脚步")
        if not z: return f"路上停{le}{self.count(n)}次"
        if n == 1: return self.pick(f"路上停{le}一次，{self.sec(z)}", f"停下来过一回，站了{self.sec(z)}" if self.past else f"会停下来一回，站{self.sec(z)}", f"中间有一次停顿，时长{self.sec(z)}", f"停几次？一次，{self.sec(z)}", f"只停{le}一次，一停{self.sec(z)}", f"唯一一次停步，{self.sec(z)}", f"途中站住{le}一次，时间是{self.sec(z)}", f"有个{self.sec(z)}的停顿，就一次", f"{self.sec(z)}的停留，一次", f"歇{le}一次脚，{self.sec(z)}")
        return self.pick(f"路上停{le}{self.count(n)}次，加起来{self.sec(z)}", f"中间有{self.count(n)}次停顿，一共{self.sec(z)}", f"停几次？{self.count(n)}次，合计{self.sec(z)}", f"{self.count(n)}次停步，总共站{le}{self.sec(z)}", f"前后站住{le}{self.count(n)}次，累计{self.sec(z)}", f"停顿总时长{self.sec(z)}，分{self.count(n)}次", f"途中停下{self.count(n)}回，一共耗{le}{self.sec(z)}", f"前前后后停{le}{self.count(n)}次，合起来{self.sec(z)}",
                         f"总共站着不动{self.sec(z)}，分在{self.count(n)}次停顿里", f"停{le}{self.count(n)}次，几次相加是{self.sec(z)}")

    # ---- length, duration, speed
    def way_note(self, flight):
        w = self.m(flight.way)
        return self.pick(f"步行{w}", f"走{self.le}{w}", f"路程{w}", f"步行总长：{w}", f"人走的路：{w}", f"行走距离{w}", f"走路全长{w}", f"步行路程：{w}")

    def pace_note(self, flight):
        x = self.mps(flight.speed)
        return self.pick(f"步速{x}", f"平均步速{x}", f"走路速度：{x}", f"人的步速{x}", f"步行均速{x}", f"步行速度平均{x}", f"均速：{x}（步行）")

    def time_note(self, flight):
        z = self.sec(flight.duration)
        return self.pick(f"时长{z}", f"飞行{z}", f"飞行时间：{z}", f"这条{z}", f"片长{z}", f"空中{z}", f"航时{z}", f"总时长：{z}")

    def way_say(self, flight):
        w, le = self.m(flight.way), self.le
        return self.pick(f"一共走{le}{w}", f"步行总长{w}", f"人走{le}{w}", f"走多远？{w}", f"脚下这段路{w}", f"走过的路加起来{w}", f"步行路程是{w}", f"从头走到尾，{w}", f"整段路走下来是{w}", f"前后走{le}{w}")

    def pace_say(self, flight):
        x = self.mps(flight.speed)
        return self.pick(f"平均步速{x}", f"走路速度是{x}", f"步速平均下来{x}", f"走多快？{x}", f"人走路的均速为{x}", f"平均走{x}" if x.startswith("每秒") else f"平均以{x}的速度走", f"走起来平均是{x}", f"步行速度{x}", f"{x}，这是平均步速", f"按{x}的均速走")

    def time_say(self, flight):
        z, le = self.sec(flight.duration), self.le
        return self.pick(f"这条{z}", f"飞{le}{z}", f"全程{z}", f"飞行时间是{z}", f"多久？{z}", f"从起到收{z}", f"整个飞行持续{z}", f"前后飞行{z}", f"一条拍{le}{z}", f"飞行总时长{z}")

    def walk_say(self, flight):
        w, x, z, le = self.m(flight.way), self.mps(flight.speed), self.sec(flight.duration), self.le
        return self.pick([f"人以{x}的均速走{le}{w}", self.time_say(flight)], [f"{z}的飞行里，人走{le}{w}，均速{x}"], [f"步行{w}，步速{x}，飞行{z}"], [self.way_say(flight), self.pace_say(flight), self.time_say(flight)], [self.time_say(flight), f"这段时间里人走{le}{w}，平均{x}"], [f"{w}的路，平均步速{x}", self.time_say(flight)],
                         [self.pace_say(flight), self.way_say(flight), self.time_say(flight)], [f"全程{z}，其间步行{w}，平均步速{x}"], [self.time_say(flight), self.way_say(flight), self.pace_say(flight)])

    def stand_say(self, flight):
        z, le = self.sec(flight.duration), self.le
        return self.pick(f"人在原地站{le}{z}，整条都没挪窝", f"{z}里人一直站在原地", f"全程{z}，人没走动，就站着" if self.past else f"全程{z}，人不走动，就站着", f"人站着不动，前后{z}", f"飞{le}{z}，人始终待在同一个位置站着", f"走没走？没走，原地站了{z}" if self.past else f"走不走？不走，原地站{z}", f"整个{z}飞行，目标原地站立", f"从起到收{z}，人都站在一个点上", f"目标没有移动，原地站立{z}", f"站桩，{z}，一步没走" if self.past else f"原地站着，{z}，一步不走")

    def stand_note(self, flight):
        z = self.sec(flight.duration)
        return self.pick(f"原地站立，{z}", f"站着不动，全程{z}", f"静止站立{z}", f"不走动，站{z}", f"人在原地站着，时长{z}", f"定点站立，飞行{z}", f"全程{z}，原地站着")

    def stand_do(self, flight):
        z = self.sec(flight.duration)
        return self.pick("人站着不动", "人就在原地站着", "目标不走动", "这条人不走，站着", f"人会在原地站{z}", "目标站在原地，不会走", "人不挪地方，原地站", "是个站着的镜头，人不走", "对方原地站立", f"人原地站着，{z}", "", "")

    # ---- instruction
    def open_do(self): return self.pick("飞手注意，", "无人机，", "来，", "准备，", "语音留言：", "听我说，", "这条这么拍：", "呼叫飞手，", "下一条：", "开机，", "记一下：", "好，", "就位，", "", "", "", "", "", "")

    def close(self): return self.pick(*self.outs, "", "", "", "", "", "", "", "", "", "")

    def extras(self, flight):
        out = []
        if flight.altitude >= 1 and self.rng.random() < 0.5: out.append(self.high_do(flight))
        if flight.walks:
            if self.rng.random() < 0.4: out.append(self.turn_say(flight))
            if self.rng.random() < 0.35: out.append(self.stop_say(flight))
            if self.rng.random() < 0.2: out.append(self.way_say(flight))
            if self.rng.random() < 0.15: out.append(self.pace_say(flight))
            if self.rng.random() < 0.15: out.append(self.time_say(flight))
        else: out.append(self.stand_do(flight))
        return out

    def short(self, flight):
        out = []
        if flight.altitude >= 1 and self.rng.random() < 0.5: out.append(self.high_note(flight))
        if flight.walks:
            if self.rng.random() < 0.4: out.append(self.turn_note(flight))
            if self.rng.random() < 0.4: out.append(self.stop_note(flight))
        elif self.rng.random() < 0.8: out.append(self.pick("人站在原地", "不走动", "原地站立", "站着不动"))
        return out

    def track(self, flight): return self.pick("跟住", "跟拍", "跟着", "咬住", "盯住") if flight.walks else self.pick("拍", "对准", "盯住", "锁定")

    def shoot(self, flight): return self.pick("跟拍", "跟着拍") if flight.walks else self.pick("拍", "拍摄")

    def instruction(self, flight):
        self.begin(False)
        k = self.rng.randrange(14)
        who, track, extras = self.who(flight, k in (2, 5, 6)), self.track(flight), self.extras(flight)
        if k == 0: text = self.mix([f"{track}{who}", self.far_do(flight), self.tilt_do(flight)] + extras)
        elif k == 1: text = self.mix([f"{self.far_how(flight)}{track}{who}", self.tilt_how(flight)] + extras)
        elif k == 2: text = self.mix([self.far_note(flight), self.tilt_note(flight), self.pick(f"拍的是{who}", f"目标是{who}", f"镜头给{who}")] + extras)
        elif k == 3: text = f"{self.pick('能不能', '可不可以', '方不方便')}{self.far_how(flight)}{track}{who}，镜头{self.angle(flight)}？" + self.mix(extras)
        elif k == 4: return "\n".join(self.pick("- ", "· ") + x for x in [self.label(flight), self.far_note(flight), self.tilt_note(flight)] + self.short(flight))
        elif k == 5: text = self.mix([self.pick(f"看见{who}了吧", f"这条的主体是{who}", f"你要拍的是{who}", f"镜头里要有{who}", f"把{who}放进画面"), self.tilt_do(flight), self.far_do(flight)] + extras)
        elif k == 6:
            text = f"{self.pick('拍谁？', '目标？')}{who}。{self.pick('多远？', '距离？')}{self.m(flight.distance)}。{self.pick('角度？', '镜头？')}{self.angle(flight)}。" + self.mix(extras)
        elif k == 7: text = self.mix([f"{self.tilt_how(flight)}，{self.far_how(flight)}，{self.pick('就这么', '这样')}{track}{who}"] + extras)
        elif k == 8: return "。另起一行。".join([self.label(flight), self.far_note(flight), self.tilt_note(flight)] + self.short(flight)) + "。"
        elif k == 9: text = self.mix(extras[:1] + [f"把{who}{self.pick('框住', '框进画面', '锁在画面里')}，{self.far_note(flight)}，{self.tilt_note(flight)}"] + extras[1:])
        elif k == 10: text = self.mix([f"{who}，{self.far_how(flight)}{self.shoot(flight)}", self.tilt_do(flight)] + extras)
        elif k == 11: text = self.mix([f"{self.pick('参数', '要求', '要领')}：{self.far_note(flight)}，{self.tilt_note(flight)}，{track}{who}"] + extras)
        elif k == 12: text = self.mix([f"先把{self.pick('角度', '云台')}调好，{self.tilt_how(flight)}，再飞到离人{self.m(flight.distance)}的位置，{track}{who}"] + extras)
        else: text = self.mix([f"等{who}进了画面，就{self.pick('保持', '稳在', '定在')}{self.m(flight.distance)}的距离上{self.shoot(flight)}".replace("保持" + self.m(flight.distance) + "的距离上", "保持" + self.m(flight.distance) + "的距离"), self.tilt_do(flight)] + extras)
        opening = self.open_do()
        if k in (6, 11) and opening: opening = opening.rstrip("，：") + "。"
        return opening + text + self.close()

    def plain(self, note): return note.split("：", 1)[1] if "：" in note and note[0] in "转停" else note

    def angle(self, flight):
        p, d = flight.pitch, self.deg(abs(flight.pitch))
        if p == 0: return self.pick("水平", "放平", "平视", "不俯不仰")
        return self.pick(f"俯{d}", f"朝下{d}", f"下压{d}", f"水平以下{d}") if p > 0 else self.pick(f"仰{d}", f"朝上{d}", f"上抬{d}", f"水平以上{d}")

    # ---- description
    def open_say(self): return self.pick("这条过了。", "收机汇报：", "报告，", "语音备忘：", "场记：", "落地了，说一下：", "记录：", "口述一下，", "飞完了。", "拍完了，", "", "", "", "", "", "")

    def is_who(self, flight):
        who = self.who(flight, True)
        if flight.walks: return self.pick(f"跟拍的是{who}", f"拍的是{who}", f"画面里是{who}", f"飞机跟着{who}", f"镜头跟的是{who}", f"目标为{who}", f"被跟拍的是{who}", f"这条跟的是{who}", f"无人机跟拍{self.le}{who}", f"主体是{who}")
        return self.pick(f"拍的是{who}", f"画面里是{who}", f"镜头对着{who}", f"目标为{who}", f"这条拍的是{who}", f"无人机拍{self.le}{who}", f"主体是{who}", f"飞机对着{who}拍")

    def body(self, flight):
        if not flight.walks: return [self.stand_say(flight)]
        t, s, w = [self.turn_say(flight)], [self.stop_say(flight)], self.walk_say(flight)
        return self.pick(t + s + w, w + t + s, s + t + w, w + s + t, t + w + s, [f"{self.turn_note(flight)}；{self.stop_note(flight)}"] + w)

    def rig(self, flight):
        high = [self.high_say(flight)] if flight.altitude >= 1 else []
        far, tilt = [self.far_say(flight)], [self.tilt_say(flight)]
        joined = f"{self.far_how(flight)}，" + (f"{self.high_how(flight)}，" if high else "") + f"{self.tilt_how(flight)}，{self.pick('就是这么拍的', '机位就是这样', '镜头这边是这个情况')}"
        return self.pick(far + tilt + high, high + far + tilt, tilt + high + far, tilt + far + high, [joined])

    def notes(self, flight):
        rig = [self.far_note(flight), self.tilt_note(flight)] + ([self.high_note(flight)] if flight.altitude >= 1 else [])
        body = [self.turn_note(flight), self.stop_note(flight), self.way_note(flight), self.pace_note(flight), self.time_note(flight)] if flight.walks else [self.stand_note(flight)]
        self.rng.shuffle(body)
        self.rng.shuffle(rig)
        return self.pick(rig + body, body + rig)

    def one_sentence(self, flight):
        who, far, tilt, le = self.who(flight), self.far_how(flight), self.tilt_how(flight), self.le
        high = f"，{self.high_how(flight)}" if flight.altitude >= 1 else ""
        z = self.sec(flight.duration)
        if not flight.walks:
            return self.pick(f"{z}里，无人机{far}拍{who}{high}，{tilt}，人一直站在原地", f"{who}原地站{le}{z}，飞机{far}拍{high}，{tilt}", f"飞机{far}{high}，{tilt}，对着站在原地不动的目标，也就是{who}，拍{le}{z}")
        turns, stops, w, x = self.turn_note(flight), self.stop_note(flight), self.m(flight.way), self.mps(flight.speed)
        return self.pick(f"{z}里，无人机{far}跟拍{who}{high}，{tilt}，人走{le}{w}，均速{x}，{turns}；{stops}", f"{who}以平均{x}的速度走{le}{w}（{turns}；{stops}），飞机{far}跟{le}{z}{high}，{tilt}", f"飞机{far}{high}，{tilt}，跟着{who}飞{le}{z}，{turns}；{stops}，步行{w}，步速{x}",
                         f"在{z}的飞行中，{who}走{le}{w}，步速{x}，{stops}；{turns}，镜头{far}拍{high}，{tilt}")

    def description(self, flight):
        self.begin(self.rng.random() < 0.8)
        k = self.rng.randrange(13)
        body, rig, who = self.body(flight), self.rig(flight), self.is_who(flight)
        if k == 0: text = self.mix([who] + rig + body)
        elif k == 1: text = self.mix([who] + body + rig)
        elif k == 2: text = self.one_sentence(flight) + "。"
        elif k == 3:
            mark = self.pick("- ", "· ", "* ")
            return "\n".join(mark + x for x in [self.label(flight)] + self.notes(flight))
        elif k == 4: return "。另起一行。".join([self.label(flight)] + self.notes(flight)) + "。"
        elif k == 5: text = self.lines([self.label(flight)] + self.notes(flight))
        elif k == 6: text = "；".join([self.label(flight)] + self.notes(flight)) + "。"
        elif k == 7: text = self.mix(rig[:1] + [who] + body + rig[1:])
        elif k == 8: text = self.pick("机器这边：", "先说飞机：", "镜头方面：") + self.mix(rig) + self.pick("人那边：", "再说人：", "人物方面：") + self.mix([who] + body)
        elif k == 9: text = self.mix(([self.time_say(flight), who, self.turn_say(flight), self.stop_say(flight), f"人走{self.le}{self.m(flight.way)}，{self.pace_note(flight)}"] if flight.walks else [who] + body) + rig)
        elif k == 10:
            ask = [("拍的谁？", self.who(flight, True)), ("离多远？", self.m(flight.distance)), ("镜头？", self.angle(flight))]
            if flight.altitude >= 1: ask.append(("飞多高？", self.m(flight.altitude)))
            ask += [("转向？", self.plain(self.turn_note(flight))), ("停顿？", self.plain(self.stop_note(flight))), ("人走了多远？", self.m(flight.way)), ("步速？", self.mps(flight.speed)), ("飞了多久？", self.sec(flight.duration))] if flight.walks else [("人动没动？", self.stand_note(flight))]
            text = "".join(q + a + "。" for q, a in ask)
        elif k == 11:
            joint = self.pick("。下一项，", "。还有，", "。", "。再记，")
            text = joint.join([who] + body + rig) + "。"
        else:
            high = f"，{self.high_how(flight)}" if flight.altitude >= 1 else ""
            text = self.mix([f"{self.far_how(flight)}{high}，{self.tilt_how(flight)}，{self.pick('机位是这么架的', '是这么拍的', '镜头就这么对着')}。{who}"] + body)
        opening = self.open_say()
        if k in (5, 6, 8, 10) and opening: opening = opening.rstrip("，：。") + "。"
        return opening + text + self.close()

    # ---- wrong texts
    def tail(self, text):
        for out in self.outs:
            if text.endswith("。" + out) or text.endswith("？" + out): return text[:-len(out)], out
        return text, ""

    def add(self, body, extra, out):
        if "\n" in body: return body + "\n- " + extra
        if "。另起一行。" in body: return body + "另起一行。" + extra + "。"
        return body + extra + "。" + out

    def foreign(self, text):
        body, out = self.tail(text)
        if self.rng.random() < 0.4:
            who = self.pick(*self.persons)
            extra = self.pick(f"这人是个{who}", f"对了，拍的是个{who}", f"画面里还有个{who}", f"旁边跟着一个{who}", f"备注：目标是{who}", f"补一句，那是{who}")
        else:
            thing = self.pick(*self.things)
            if body.endswith("。") and "\n" not in body and "另起一行" not in body and self.rng.random() < 0.5: return body[:-1] + "，" + thing + "。" + out
            extra = self.pick(thing, f"补充：{thing}", f"对了，{thing}", f"另外，{thing}", f"还有一点，{thing}", f"顺带说一句，{thing}")
        return self.add(body, extra, out)

    def heading(self, text, direction):
        body, out = self.tail(text)
        z = ZH_DIRECTIONS[direction]
        extra = self.pick(f"人往{z}走", f"行进方向：{z}", f"目标朝{z}去", f"走的方向是{z}", f"是向{z}走的", f"人是冲着{z}边走的" if len(z) == 1 else f"人是冲着{z}方向走的", f"步行方向{z}", f"往哪儿走？{z}", f"一路向{z}", f"{z}向行走")
        return self.add(body, extra, out)
