"""The sixteenth grammar for check_text_judge.py: working drone pilots, film crew and a crowd annotator; Chinese hobbyists and annotators. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = ("zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen "
        "eighteen nineteen").split()
TENS = "_ _ twenty thirty forty fifty sixty seventy eighty ninety".split()


def in_words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + in_words(n % 100) if n % 100 else "")
    return str(n)


def cap(text):
    return text[:1].upper() + text[1:]


def runs(turns):
    out = []
    for turn in turns:
        if out and out[-1][0] == turn:
            out[-1][1] += 1
        else:
            out.append([turn, 1])
    return out


# verb: (third person, past)
VERBS = dict(walk=("walks", "walked"), cover=("covers", "covered"), do=("does", "did"), turn=("turns", "turned"), go=("goes", "went"),
             take=("takes", "took"), hang=("hangs", "hung"), make=("makes", "made"), stop=("stops", "stopped"), pause=("pauses", "paused"),
             stand=("stands", "stood"), stay=("stays", "stayed"), keep=("keeps", "kept"), move=("moves", "moved"), average=("averages", "averaged"),
             sit=("sits", "sat"), hold=("holds", "held"), fly=("flies", "flew"), look=("looks", "looked"), point=("points", "pointed"),
             last=("lasts", "lasted"), run=("runs", "ran"), spend=("spends", "spent"), have=("has", "had"), be=("is", "was"),
             double=("doubles", "doubled"), swing=("swings", "swung"), rack=("racks", "racked"), come=("comes", "came"), get=("gets", "got"),
             add=("adds", "added"), work=("works", "worked"), start=("starts", "started"), put=("puts", "put"), film=("films", "filmed"),
             follow=("follows", "followed"), track=("tracks", "tracked"), hover=("hovers", "hovered"), wait=("waits", "waited"))


class SixteenthEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "as thunder rolls", "with two dogs on a lead", "past a row of parked vans", "next to the bakery", "in pouring rain",
              "under a pink sunset", "with a crowd cheering", "while a tram rattles by", "just after midnight", "across a wooden bridge",
              "pushing a pram", "holding an umbrella", "with snow on the rooftops", "by the church steps", "while kids kick a ball about",
              "talking on the phone", "eating an ice cream", "through thick fog", "with a bike being wheeled alongside", "in front of the fire station",
              "with seagulls all over the place", "between market stalls", "with strong wind from the side", "around a statue of a horse"]
    persons = ["nurse", "fisherman", "schoolgirl", "grandfather", "postman", "bride", "police officer", "teenager", "waiter", "businesswoman", "soldier", "toddler"]

    # ---- words, numbers, tenses
    def begin(self, tense):
        self.t = tense
        self.us = self.pick(True, False)
        self.mstyle = self.pick("m", " m", "long", "long", "long")
        self.sstyle = self.pick("s", " s", " sec", "long", "long", "long")
        self.dstyle = self.pick("°", " deg", "long", "long", "long")
        self.spelled = self.pick(True, False, False, False, False, False)
        self.uturn = self.pick("U-turn", "U-turn", "about-turn")
        self.uword = self.pick(self.uturn, self.uturn, "around")
        self.pants = self.pick("pants", "pants", "bottoms") if self.us else self.pick("trousers", "trousers", "bottoms")

    def num(self, n):
        return in_words(n) if self.spelled else str(n)

    def metre(self):
        return "meter" if self.us else "metre"

    def m(self, n):
        if self.spelled or self.mstyle == "long":
            return f"{self.num(n)} {self.metre()}{'' if n == 1 else 's'}"
        return f"{n}{self.mstyle}"

    def madj(self, n):
        if self.spelled or self.mstyle == "long":
            return f"{self.num(n)}-{self.metre()}".replace(" ", "-")
        return f"{n}{self.mstyle}"

    def s(self, n):
        if self.spelled or self.sstyle == "long":
            return f"{self.num(n)} second{'' if n == 1 else 's'}"
        return f"{n}{self.sstyle}"

    def sadj(self, n):
        if self.spelled or self.sstyle == "long":
            return f"{self.num(n)}-second".replace(" ", "-")
        return f"{n}{self.sstyle}"

    def d(self, n):
        if self.spelled or self.dstyle == "long":
            return f"{self.num(n)} degree{'' if n == 1 else 's'}"
        return f"{n}{self.dstyle}"

    def kmps(self, v):
        if self.spelled:
            whole, tenth = f"{v:.1f}".split(".")
            return f"{in_words(int(whole))} point {in_words(int(tenth))} {self.metre()}s {self.pick('a', 'per')} second"
        return self.pick(f"{v:.1f} m/s", f"{v:.1f}m/s", f"{v:.1f} {self.metre()}s per second", f"{v:.1f} {self.metre()}s a second")

    def v(self, verb, plural=False):
        third, past = VERBS[verb]
        if self.t == "past":
            return "were" if verb == "be" and plural else past
        if self.t == "pres":
            return ("are" if verb == "be" else verb) if plural else third
        return "will " + verb

    def they(self, verb):
        return ("they'll " + verb) if self.t == "fut" else "they " + self.v(verb, True)

    def dont(self, verb, plural=True):
        if self.t == "past":
            return "didn't " + verb
        if self.t == "fut":
            return "won't " + verb
        return ("don't " if plural else "doesn't ") + verb

    def never(self, verb, plural=True):
        return "never " + (verb if self.t == "pres" and plural else self.v(verb)) if self.t != "fut" else "won't ever " + verb

    def times(self, n):
        return {1: "once", 2: "twice"}.get(n) or self.pick(f"{in_words(n)} times", f"{n} times")

    def count(self, n):
        return self.pick(in_words(n), in_words(n), str(n))

    # ---- the person
    def noun(self, flight):
        return self.pick(*(("person", "person", "subject", "walker", "pedestrian", "figure") if flight.walks else ("person", "person", "subject", "figure")))

    def who(self, flight, definite=True):
        """A noun phrase without commas outside brackets, fit to be a subject or an object."""
        noun = self.noun(flight)
        the = self.pick("the", "the", "that") if definite else self.pick("a", "the", "a")
        if not flight.wear:
            if definite:
                return self.pick(f"{the} {noun}", f"{the} {noun}", "the person on camera", "the person on screen", "the target", "the person we're on", "the one person we're after")
            return self.pick(f"{the} {noun}", f"{the} {noun}", "the person in the clip", "the person on camera", "the target", "someone")
        top, low, bag = flight.wear
        pants = self.pants
        tail = self.pick(" with a backpack", " with a backpack on", " carrying a backpack", " plus a backpack", " and a backpack") if bag else self.pick("", "", "", "", " and no backpack", " without a backpack")
        brief = self.pick(", backpack", ", with backpack", ", backpack on", " + backpack") if bag else self.pick("", "", "", ", no backpack")
        also = self.pick(" and who has a backpack on", " and who's carrying a backpack") if bag else ""
        forms = [f"{the} {noun} in {an(top)} top and {low} {pants}{tail}",
                 f"{the} {noun} in {low} {pants} and {an(top)} top{tail}",
                 f"{the} {noun} wearing {an(top)} top with {low} {pants}{tail}",
                 f"{the} {noun} with {low} {pants} and {an(top)} top{tail if bag is False or 'with' not in tail else ' plus a backpack'}",
                 f"{the} {noun} who's got {an(top)} top on over {low} {pants}{tail}",
                 f"{the} {noun} whose top is {top} and whose {pants} are {low}{also}",
                 f"{the} {noun} ({top} top, {low} {pants}{brief})",
                 f"{the} {noun} ({low} {pants}, {top} top{brief})",
                 f"{the} {noun} dressed in {top} up top and {low} from the waist down{tail}",
                 f"{'that' if definite else 'the'} {noun} in the {top} top and the {low} {pants}{tail}",
                 f"the one in the {top} top and {low} {pants}{tail}",
                 f"whoever's in the {top} top and {low} {pants}{tail}" if definite else f"someone in {an(top)} top and {low} {pants}{tail}",
                 f"the {top}-top-{low}-{pants} person" + (" with a backpack" if bag else "")]
        if bag:
            forms += [f"{the} {noun} with the backpack ({top} top, {low} {pants})", f"{the} {noun} with a backpack on and {an(top)} top over {low} {pants}"]
        if top == low:
            forms += [f"{the} {noun} in {top} top and {top} {pants}{tail}", f"{the} {noun} in {an(top)} top and {pants} of the same colour{tail}".replace("colour", "color" if self.us else "colour"),
                      f"{the} {noun} who's {top} top and bottom{tail}"]
        return self.pick(*forms)

    def who_note(self, flight):
        if not flight.wear:
            return self.pick("one person", "the person", "a person", "single subject") if not flight.walks else self.pick("one person", "a person on foot", "a pedestrian", "one walker")
        top, low, bag = flight.wear
        pack = self.pick("backpack", "has a backpack", "backpack on", "wearing a backpack") if bag else self.pick(None, None, "no backpack")
        parts = self.pick([f"{top} top", f"{low} {self.pants}"], [f"{low} {self.pants}", f"{top} top"], [f"top {top}", f"{self.pants} {low}"])
        if pack:
            parts.append(pack)
        return self.pick(", ", " / ", ", ").join(parts)

    def point_out(self, flight, film=True):
        """A sentence that introduces the person."""
        who, note = self.who(flight), self.who_note(flight)
        if flight.wear:
            return self.pick(f"Subject: {note}.", f"You want {who}.", f"Your subject's {who}.", f"Look for {who}.", f"{cap(note)} - that's who we're on.", f"See {who}?", f"It's {who} we need.",
                             f"Pick up {who}.", f"Got {who} in view?", f"The one to watch: {note}.")
        return self.pick(f"You want {who}.", "One subject, one person.", f"Pick up {who}.", f"Eyes on {who}.", f"Got {who} in view?", f"See {who}?", f"It's all about {who}.")

    def intro(self, flight):
        """The same for a flight that is over."""
        who, note = self.who(flight, False), self.who_note(flight)
        was = self.v("be")
        if flight.wear:
            return self.pick(f"Subject {was} {who}.", f"Subject: {note}.", f"This one's of {who}.", f"Drone footage of {who}.", f"Who's in it: {note}.", f"On camera: {note}.", f"We {self.v('be', True)} on {who}.",
                             f"Clip shows {who}.", f"{cap(note)}: that's the person in the clip.", f"You see {who}.")
        return self.pick(f"Drone footage of {who}.", f"Clip shows {who}.", f"This one's of {who}.", f"We {self.v('be', True)} on {who}.", f"You see {who}.")

    # ---- distance
    def distance_imp(self, flight):
        n, a = self.m(flight.distance), self.madj(flight.distance)
        return self.pick(f"keep {n} off them", f"stay {n} out", f"hold a {a} gap", f"sit {n} away", f"leave {n} between you and them", f"fly {n} from them", f"don't let the gap drift from {n}",
                         f"keep the drone {n} away", f"make your range {n}", f"hold your distance at {n}", f"maintain {n} of separation", f"give them {n} of space", f"stay {n} off, measured straight to them",
                         f"keep your slant range at {n}").replace("a 8", "an 8").replace("a 11", "an 11").replace("a 18", "an 18").replace("a eight", "an eight").replace("a eleven", "an eleven")

    def distance_frag(self, flight):
        n, a = self.m(flight.distance), self.madj(flight.distance)
        return self.pick(f"{n} away", f"{n} off", f"{n} out", f"at a distance of {n}", f"{n} from the subject", f"at {n} range", f"{n} between drone and person", f"{n} clear of the person", f"with the gap at {n}",
                         f"{n} line of sight from the person")

    def distance_note(self, flight):
        n = self.m(flight.distance)
        return self.pick(f"distance {n}", f"range: {n}", f"gap {n}", f"dist = {n}", f"{n} away", f"slant range {n}", f"drone to person: {n}", f"{n} from the person", f"standoff {n}", f"distance to subject {n}", f"{n} drone-to-person")

    def distance_clause(self, flight):
        n, was = self.m(flight.distance), self.v("be")
        return self.pick(f"the drone {self.v('stay')} {n} off", f"the gap {was} {n}", f"there {was} {n} between the drone and the person", f"distance {self.v('average')} {n}", f"the drone {self.v('keep')} a distance of {n}",
                         f"a distance of {n} {was} kept", f"{n} {was} the gap from drone to person", f"the drone {self.v('sit')} {n} away", f"we {self.v('hold', True)} {n} off the subject",
                         f"straight-line distance to the person {was} {n}", f"the person {was} {n} from the drone", f"on average the drone {was} {n} from them")

    # ---- pitch
    def pitch_imp(self, flight):
        p = flight.pitch
        n = self.d(abs(p))
        if p == 0:
            return self.pick("keep the camera level", "leave the gimbal at zero", "camera dead level", "don't tilt the camera up or down", "point the lens straight at the horizon", "keep the lens horizontal", "set the gimbal to 0 degrees",
                             "no tilt on the camera", "shoot it level with no tilt", "have the camera looking flat out at the horizon")
        if p < 0:
            return self.pick(f"tilt the camera up {n}", f"point the lens {n} above the horizon", f"have the gimbal looking up {n}", f"aim the camera {n} upward", f"bring the lens {n} up from level", f"camera up {n}",
                             f"keep the camera pitched up by {n}", f"set the gimbal {n} above level", f"tip the camera up, {n}", f"look {n} up from the horizon with the camera")
        return self.pick(f"tilt the camera down {n}", f"point the lens {n} below the horizon", f"have the gimbal looking down {n}", f"aim the camera {n} downward", f"drop the lens {n} from level", f"camera down {n}",
                         f"keep the camera pitched down by {n}", f"set the gimbal {n} below level", f"tip the camera down, {n}", f"look {n} down from the horizon with the camera",
                         f"put the gimbal at minus {self.num(p)}, so {self.pick('looking', 'pointing')} down", f"angle the lens down by {n}")

    def pitch_note(self, flight):
        p = flight.pitch
        n = self.d(abs(p))
        if p == 0:
            return self.pick("camera level", "gimbal 0", "no tilt", "pitch 0 degrees", "camera horizontal", "lens at the horizon", "tilt: none", "gimbal flat", "camera pitch zero", "level camera")
        way, side, adj = ("up", "above", "upward") if p < 0 else ("down", "below", "downward")
        return self.pick(f"camera {n} {way}", f"gimbal {n} {way}", f"tilt: {n} {way}", f"{n} {side} the horizon on the camera", f"camera pitch {n} {adj}", f"lens {n} {side} level", f"gimbal tilt {n} {way}",
                         f"camera angle {n} {side} horizontal", f"cam looking {way} {n}", f"pitch {n} {way}", f"{n} of {adj} tilt", f"gimbal {'+' if p < 0 else '-'}{abs(p)} ({way})")

    def pitch_frag(self, flight):
        p = flight.pitch
        n = self.d(abs(p))
        if p == 0:
            return self.pick("with the camera level", "camera held level", "lens on the horizon", "gimbal at zero", "with no camera tilt", "with a level camera", "the camera neither up nor down", "camera flat", "with the lens horizontal", "and the gimbal dead level")
        way, side, adj = ("up", "above", "upward") if p < 0 else ("down", "below", "downward")
        return self.pick(f"with the camera {n} {side} the horizon", f"camera tilted {way} {n}", f"lens pointing {n} {way}", f"gimbal {n} {side} level", f"with {n} of {adj} tilt", f"camera angled {way} by {n}", f"the camera looking {way} at {n}",
                         f"with the gimbal pitched {way} {n}", f"camera {way} {n}", f"with the lens {n} {side} horizontal")

    def pitch_clause(self, flight):
        p = flight.pitch
        n, was = self.d(abs(p)), self.v("be")
        if p == 0:
            return self.pick(f"the camera {was} level", f"the gimbal {self.v('sit')} at zero", f"there {was} no tilt on the camera", f"the lens {self.v('point')} straight at the horizon", f"the camera {self.v('look')} neither up nor down",
                             f"camera pitch {was} zero", f"it {was} a level camera throughout", f"the camera {was} held horizontal", f"the tilt {was} 0 degrees", f"the lens {self.v('stay')} horizontal")
        way, side, adj = ("up", "above", "upward") if p < 0 else ("down", "below", "downward")
        return self.pick(f"the camera {self.v('point')} {n} {way}", f"the gimbal {self.v('sit')} {n} {side} level", f"camera tilt {was} {n} {adj}", f"the lens {self.v('look')} {way} at {n}", f"the camera {was} tipped {way} {n}",
                         f"the camera {was} angled {n} {side} the horizon", f"there {was} {n} of {adj} tilt on the camera", f"the gimbal {was} pitched {way} by {n}", f"we {self.v('have', True)} the camera {n} {side} the horizon",
                         f"{n} {side} horizontal {was} where the camera {self.v('look')}", f"the lens {was} {n} {side} the horizon")

    # ---- height
    def height_imp(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"fly {n} up", f"hold {n} of height", f"stay at {n} altitude", f"keep the drone {n} above their feet", f"make your height {n}", f"set your altitude to {n}", f"sit {n} above the ground they're on",
                         f"keep your height at {n} over where they {self.pick('stand', 'are')}", f"hover height's {n}, hold that", f"stay {n} up")

    def height_note(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"altitude {n}", f"height: {n}", f"{n} up", f"alt = {n}", f"drone {n} up", f"{n} above the person's feet", f"flying height {n}", f"{n} altitude", f"drone height {n}", f"{n} above ground level at the person")

    def height_frag(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"{n} up", f"at {n} altitude", f"at a height of {n}", f"{n} above the person's feet", f"{n} high", f"{n} off the ground at their feet", f"{n} above the ground the person's on", f"at {n} of height")

    def height_clause(self, flight):
        n, was = self.m(flight.altitude), self.v("be")
        return self.pick(f"the drone {self.v('fly')} {n} up", f"altitude {was} {n}", f"the drone {was} {n} above the person's feet", f"height {was} {n}", f"we {self.v('have', True)} the drone at {n} altitude", f"the drone {self.v('hold')} {n} of height",
                         f"{n} {was} the flying height", f"the drone {was} {n} higher than the person's feet", f"drone height {was} {n}", f"the drone {self.v('stay')} {n} above the ground they {self.v('be', True)} on")

    # ---- turns
    def turn_noun(self, turn, n=1):
        if turn == "around":
            word = self.pick(self.uturn, self.uturn, "180")
            return ("an " if word == "about-turn" else "a ") + word if n == 1 else f"{in_words(n)} {word}s"
        return f"a {turn}" if n == 1 else f"{in_words(n)} {turn}s"

    def turn_word(self, turn):
        return self.uword if turn == "around" else turn

    def turn_verb(self, turn):
        if turn == "around":
            return self.pick(self.vp("turn") + " around", self.vp("make") + " a U-turn", self.vp("do") + " a 180", self.vp("turn") + " back the way they came", self.vp("double") + " back")
        return self.pick(self.vp("turn") + f" {turn}", self.vp("hang") + f" a {turn}", self.vp("take") + f" a {turn}", self.vp("go") + f" {turn}", self.vp("make") + f" a {turn}", self.vp("swing") + f" {turn}")

    def vp(self, verb):
        return verb if self.t in ("fut", "pres") else VERBS[verb][1]

    def turn_nouns(self, flight):
        """A noun phrase for all turns (at least one)."""
        turns = flight.turns
        grouped = runs(turns)
        names = [self.turn_noun(*r) for r in grouped]
        again = [self.turn_noun(t) if i == 0 or turns[i - 1] != t else "another " + (t if t != "around" else self.uturn) for i, t in enumerate(turns)]
        forms = [", then ".join(names), ", ".join(again[:-1]) + " and then " + again[-1] if len(turns) > 1 else names[0], " followed by ".join(names) if len(names) < 4 else ", then ".join(names),
                 ", then ".join(again), ", ".join(again[:1] + ["next " + a for a in again[1:-1]] + ["and finally " + again[-1]]) if len(turns) > 2 else " and after that ".join(again)]
        if len(grouped) == 1 and len(turns) > 1:
            forms += [names[0] + " in a row", names[0] + " and nothing else" + " in the way of turns"]
        return self.pick(*forms)

    def turn_list(self, flight):
        words = [self.turn_word(t) for t in flight.turns]
        letters = [{"left": "L", "right": "R", "around": "U-turn"}[t] for t in flight.turns]
        return self.pick(", ".join(words), ", ".join(words), " > ".join(words), " -> ".join(words), ", then ".join(words), " / ".join(words), "-".join(letters) if "around" not in flight.turns else ", ".join(words))

    def turns_note(self, flight):
        if not flight.turns:
            return self.pick("no turns", "turns: none", "turns: 0", "zero turns", "straight, no turns", "doesn't turn anywhere", "turns - none", "not a single turn")
        n = len(flight.turns)
        plural = "" if n == 1 else "s"
        return self.pick(f"turns: {self.turn_list(flight)}", f"{self.count(n)} turn{plural}: {self.turn_list(flight)}", f"turn{plural} {self.turn_list(flight)}", self.turn_nouns(flight), f"{self.count(n)} turn{plural} ({self.turn_list(flight)})",
                         f"order of turns: {self.turn_list(flight)}" if n > 1 else f"only turn: {self.turn_list(flight)}", f"route: {self.turn_nouns(flight)}", f"turns, walker's side: {self.turn_list(flight)}")

    def turns_clause(self, flight, they="they"):
        they = "they'll" if self.t == "fut" else "they"
        if not flight.turns:
            return self.pick(f"they {self.dont('turn')} anywhere", f"there {'were' if self.t == 'past' else 'are' if self.t == 'pres' else 'will be'} no turns", f"they {self.dont('make')} a single turn", "straight on, no turns",
                             f"no turns at all", f"they {self.never('turn')}", f"they {self.dont('turn')} once", f"no lefts and no rights and no turning back, just straight on", f"{they} {self.vp('go')} straight on the whole way, no turns",
                             f"turns? none")
        n = len(flight.turns)
        chain = ", then ".join(self.turn_verb(t) for t in flight.turns)
        verbs = [self.turn_verb(t) for t in flight.turns]
        first = f"first {they} {verbs[0]}" + "".join(self.pick(", then ", ", after that ", ", next ") + ("they " if self.t != "fut" else "they'll ") + v for v in verbs[1:]) if n > 1 else f"{they} {verbs[0]} {self.pick('once', 'one time')}"
        forms = [f"{they} {chain}", f"{they} {chain}", first,
                 f"{they} {self.vp('take')} {self.turn_nouns(flight)}", f"{they} {self.vp('make')} {self.count(n)} turn{'' if n == 1 else 's'}: {self.turn_list(flight)}",
                 f"{they} {self.vp('turn')} {self.times(n)}: {self.turn_list(flight)}", f"there {('was' if n == 1 else 'were') if self.t == 'past' else ('is' if n == 1 else 'are') if self.t == 'pres' else 'will be'} {self.count(n)} turn{'' if n == 1 else 's'} on their route, {self.turn_list(flight)}",
                 f"their turns {('were' if self.t == 'past' else 'are') if n > 1 else ''}: {self.turn_list(flight)}" if n > 1 else f"the only turn {self.v('be')} {self.turn_noun(flight.turns[0])}",
                 f"the walk {self.v('have')} {self.turn_nouns(flight)} in it", f"{self.turn_nouns(flight)}, from the walker's side"]
        if n == 2:
            a, b = flight.turns
            forms += [f"{they} {self.turn_verb(a)} before they {self.turn_verb(b)}" if a != b else f"{they} {self.turn_verb(a)} and later {self.turn_verb(b)} again" if a != "around" else f"{they} {self.vp('turn')} around twice", f"after {self.turn_noun(a)} {self.v('come')} {self.turn_noun(b) if a != b else 'another one'}"]
        if n > 1 and len(set(flight.turns)) == 1 and flight.turns[0] != "around":
            other = "right" if flight.turns[0] == "left" else "left"
            forms += [f"{they} {self.vp('turn')} {flight.turns[0]} {self.times(n)} and {'never' if self.t != 'fut' else 'not once'} {other}" + (" or around" if self.pick(0, 1) else "")]
        if n == 1 and flight.turns[0] != "around":
            forms += [f"just the one turn for them, to the {flight.turns[0]}", f"one {flight.turns[0]} and that's it for turns"]
        return self.pick(*forms)

    # ---- stops
    def stops_note(self, flight):
        n = flight.stops
        if n == 0:
            return self.pick("no stops", "stops: 0", "no pauses", "zero stops", "non-stop", "stops - none", "without a stop", "never stops")
        s = self.s(flight.standing)
        if flight.standing < 1:
            return f"{self.count(n)} stop{'' if n == 1 else 's'}"
        if n == 1:
            return self.pick(f"one stop, {s}", f"1 stop of {s}", f"stops: 1 ({s})", f"one pause lasting {s}", f"a single {self.sadj(flight.standing)} stop", f"one {self.sadj(flight.standing)} pause", f"standing still once, for {s}", f"1 pause - {s}")
        c = self.count(n)
        return self.pick(f"{c} stops, {s} in total", f"stops: {n} ({s} altogether)", f"{c} pauses adding up to {s}", f"{s} of standing across {c} stops", f"{c} stops totalling {s}", f"paused {self.times(n)}, {s} all told" if self.t == "past" else f"pauses {self.times(n)}, {s} all told",
                         f"{c} pauses / {s} standing in all", f"time standing {s}, split between {c} stops", f"{c}x stopped, {s} combined")

    def stops_clause(self, flight):
        n = flight.stops
        if n == 0:
            return self.pick(f"they {self.dont('stop')}", f"they {self.never('pause')}", "no stops on the way", f"they {self.dont('stop')} once", f"there {'were' if self.t == 'past' else 'are' if self.t == 'pres' else 'will be'} no pauses", f"they {self.dont('pause')} anywhere",
                             f"{self.they('keep')} moving the whole time", "not one stop", f"{self.they('walk')} without a break", f"stops? none", f"{self.they('stop')} zero times")
        s, c, times = self.s(flight.standing), self.count(n), self.times(n)
        if flight.standing < 1:
            return self.pick(f"{self.they('stop')} {times}", f"{self.they('pause')} {times}")
        if n == 1:
            return self.pick(f"{self.they('stop')} once, for {s}", f"there {self.v('be')} one pause and it {self.v('last')} {s}", f"{self.they('pause')} a single time and {self.vp('stand')} there for {s}", f"one stop, {s} long",
                             f"{self.they('make')} one stop of {s}", f"for {s} {self.they('stand')} still, all in one stop", f"the only pause {self.v('last')} {s}", f"they {self.vp('stop') if self.t != 'fut' else 'will stop'} one time ({s})",
                             f"{self.they('have')} one {self.sadj(flight.standing)} halt", f"{s} of the time {self.they('be')} at a standstill, in one go")
        return self.pick(f"{self.they('stop')} {times}, {s} in all", f"there {'were' if self.t == 'past' else 'are' if self.t == 'pres' else 'will be'} {c} pauses, {s} put together", f"{self.they('pause')} {times} for a combined {s}",
                         f"{self.they('stand')} still for {s} in total, spread across {c} stops", f"the {c} stops {'add' if self.t == 'pres' else 'added' if self.t == 'past' else 'will add'} up to {s}", f"{self.they('make')} {c} stops totalling {s}",
                         f"{c} pauses eat up {s} altogether" if self.t == "pres" else f"{c} pauses, {s} altogether", f"{self.they('stop')} {times} and the stops come to {s} when you add them up" if self.t != "past" else f"they stopped {times} and the stops came to {s} when you add them up",
                         f"of the whole time, {s} {'went' if self.t == 'past' else 'go'} on {c} stops", f"{self.they('spend')} {s} standing about, over the course of {c} stops")

    # ---- way, duration, speed
    def way_note(self, flight):
        n = self.m(flight.way)
        return self.pick(f"{n} walked", f"walk: {n}", f"path length {n}", f"{n} on foot", f"distance walked {n}", f"route {n} long", f"walks {n} in all" if self.t != "past" else f"walked {n} in all", f"total walk {n}", f"{n} of walking", f"ground covered: {n}")

    def way_clause(self, flight):
        n = self.m(flight.way)
        return self.pick(f"{self.they('walk')} {n}", f"{self.they('cover')} {n} on foot", f"the walk {self.v('be')} {n} long", f"in all {self.they('walk')} {n}", f"{self.they('do')} {n} on foot", f"{n} {self.v('be')} the length of the walk",
                         f"the route {self.v('come')} to {n}", f"{self.they('put')} {n} of walking in", f"total walked {self.v('be')} {n}", f"the whole walk {self.v('add')} up to {n}")

    def time_note(self, flight):
        n = self.s(flight.duration)
        return self.pick(f"clip {n} long", f"duration {n}", f"length: {n}", f"runtime {n}", f"{n} of footage", f"total time {n}", f"{self.sadj(flight.duration)} clip", f"clip {n}", f"flight time {n}", f"{n} in the air")

    def time_clause(self, flight):
        n, a = self.s(flight.duration), self.sadj(flight.duration)
        return self.pick(f"the flight {self.v('last')} {n}", f"the clip {self.v('run')} {n}", f"the flight {self.v('take')} {n} start to finish", f"the whole thing {self.v('be')} {n}", f"the shot {self.v('go')} on for {n}", f"{n} {self.v('be')} the running time",
                         f"we {self.v('be', True)} rolling for {n}", f"the drone {self.v('be')} on them for {n}", f"from start to end, {n}", f"the recording {self.v('come')} out at {n}")

    def speed_note(self, flight):
        n = self.kmps(flight.speed)
        return self.pick(f"walker's speed {n}", f"walking speed: {n}", f"avg {n} on foot", f"pace {n}", f"mean walking speed {n}", f"walks at {n}" if self.t != "past" else f"walked at {n}", f"{n} on foot on average", f"average pace {n}", f"{n} walking pace", f"speed on foot {n}")

    def speed_clause(self, flight):
        n = self.kmps(flight.speed)
        return self.pick(f"{self.they('average')} {n}", f"walking speed {self.v('be')} {n}", f"the pace {self.v('be')} {n}", f"{self.they('walk')} at {n}", f"on average {self.they('do')} {n}", f"mean pace on foot {self.v('be')} {n}", f"{self.they('go')} at {n} on average",
                         f"{n} {self.v('be')} how fast {'they walked' if self.t == 'past' else 'they walk' }" if self.t != "fut" else f"walking pace will be {n}", f"their average speed {self.v('be')} {n}", f"{self.they('move')} along at {n}")

    def walk_pair(self, flight):
        """Way, duration and speed, joined somehow: a clause with `they`."""
        w, t, v = self.m(flight.way), self.s(flight.duration), self.kmps(flight.speed)
        return self.pick(f"{self.they('walk')} {w} in {t}, averaging {v}", f"{self.they('cover')} {w} at {v} during a flight of {t}", f"in {t} {self.they('do')} {w} on foot, {v} on average", f"it {self.v('be')} {w} of walking at {v} and the clip {self.v('run')} {t}",
                         f"at {v}, {self.they('walk')} {w} while the drone {self.v('film')} for {t}", f"{w} on foot, {v}, {t} from start to end", f"the shot {self.v('last')} {t}, in which {self.they('walk')} {w} at an average of {v}",
                         f"{self.way_clause(flight)} at {v}; {self.time_clause(flight)}", f"{self.time_clause(flight)}, {self.way_clause(flight)} and {self.speed_clause(flight)}")

    # ---- standing
    def stand_clause(self, flight):
        return self.pick(f"{self.they('stand')} in one spot the whole time", f"they {self.dont('go')} anywhere, just standing there", f"{self.they('stay')} put", f"{self.they('be')} standing still", f"they {self.dont('move')} from the spot", "no walking, just standing in one place",
                         f"{self.they('keep')} standing in the same place", f"they {self.dont('walk')} at all", f"the person {self.v('stay')} rooted to one spot", "standing, not walking", f"{self.they('stand')} where they are and {self.dont('take')} a step" if self.t != "past" else "they stood where they were and didn't take a step")

    def stand_time(self, flight):
        t, a = self.s(flight.duration), self.sadj(flight.duration)
        return self.pick(f"{self.they('stand')} in one place for {t}", f"for {t} {self.they('stay')} on the same spot", f"{self.they('stand')} there the whole {t}", f"they {self.dont('walk')} at all in the {t} of the flight", f"{t} of standing on one spot", f"the flight {self.v('last')} {t} and {self.they('stand')} still throughout",
                         f"all {t} of it {self.they('stand')} still", f"{self.they('stay')} put for the full {t}", f"they {self.dont('go')} anywhere; the clip {self.v('run')} {t}", f"{self.they('spend')} {t} standing in one spot")

    def stand_note(self, flight):
        return self.pick("standing still", "stands in one place", "stationary", "not walking", "no walking", "stays on one spot", "stays put", "standing the whole time")

    # ---- putting sentences together
    def sentences(self, parts):
        out = [cap(p) for p in parts]
        return " ".join(p if p[-1] in ".?!" else p + "." for p in out)

    def shuffled(self, parts):
        parts = list(parts)
        self.rng.shuffle(parts)
        return parts

    def follow(self, flight):
        return self.pick("follow", "track", "stay with", "stick with", "keep up with", "film") if flight.walks else self.pick("film", "stay on", "keep the camera on", "shoot", "frame", "hold on")

    def extras(self, flight, clause=True):
        """Optional further facts for an instruction."""
        pool = []
        if flight.altitude >= 1:
            pool += [(self.pick(self.height_imp, self.height_imp, self.height_note))(flight) if clause else self.height_note(flight)] if self.pick(1, 1, 0) else []
        if flight.walks:
            slots = self.shuffled(["turns", "stops", "way", "time", "speed"])[:self.pick(0, 0, 1, 2, 3, 5)]
            if slots and (not clause or self.pick(1, 0, 0)):
                lead = self.pick("about the walker: ", "the person's walk: ", "what they do: ", "the walker - ", "on the ground: ", "their part: ")
                pool.append(lead + self.pick(", ", "; ", ", ").join(getattr(self, slot + "_note")(flight) for slot in slots))
            else:
                pool += [getattr(self, slot + "_clause")(flight) for slot in slots]
        else:
            roll = self.pick(0, 1, 1, 2)
            if roll == 1:
                pool.append(self.stand_clause(flight) if clause else self.stand_note(flight))
            if roll == 2:
                pool.append(self.stand_time(flight) if clause else self.stand_note(flight) + " for " + self.s(flight.duration))
        return pool

    # ---- whole texts
    def instruction(self, flight):
        self.begin(self.pick("fut", "pres"))
        who, follow = self.who(flight), self.follow(flight)
        dist, pitch = self.distance_imp(flight), self.pitch_imp(flight)
        n = self.m(flight.distance)
        hello = self.pick("", "", "", "ok, ", "right, ", "next one: ", "so, ", "hey, ", "for this shot, ", "pls ")
        bye = self.pick("", "", "", "", " Thanks!", " Cheers.", " Copy?", " Got it?", " Thx", " That's it.")
        extra = self.extras(flight)
        rest = (" " + self.sentences(extra)) if extra else ""
        alt = flight.altitude >= 1
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14)
        if form == 1:
            return cap(f"{hello}{follow} {who}, {dist} and {pitch}.") + rest + bye
        if form == 2:
            ask = self.pick("Can you", "Could you", "Could you please", "Any chance you can", "Think you could", "Mind if I ask you to")
            return f"{ask} {follow} {who}, {self.distance_frag(flight)}, {self.pitch_frag(flight)}?{rest}{bye}"
        if form == 3:
            return self.sentences([self.point_out(flight)] + self.shuffled([dist, pitch]) + extra) + bye
        if form == 4:
            notes = self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + self.extras(flight, False))
            head = self.pick(f"Shot list: {follow} {who}", f"{cap(follow)} {who}", f"Task: {follow} {who}", f"Job: {follow} {who}")
            mark = self.pick("\n- ", "\n* ", " | ", "; ")
            return head + (mark if mark in (" | ", "; ") else ":" + mark) + mark.join(notes)
        if form == 5:
            return cap(f"{pitch}, {dist} and {follow} {who}.") + rest + bye
        if form == 6:
            return f"From {n} away, {self.pitch_frag(flight)}, {follow} {who}.{rest}{bye}"
        if form == 7:
            need = self.pick("I need", "We need", "What I'm after is", "We want", "The brief is", "Looking for", "Gimme")
            return f"{need} a shot of {who}, {self.distance_frag(flight)}, {self.pitch_frag(flight)}.{rest}{bye}"
        if form == 8:
            facts = ([self.stand_note(flight)] if not flight.walks else [])
            notes = [f"{self.who_note(flight)}"] + facts + self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + ([self.height_note(flight)] if alt else []))
            return self.pick(". ".join(cap(x) for x in notes), " - ".join(notes), cap(", ".join(notes)), cap("; ".join(notes))) + "." + (" " + cap(self.turns_clause(flight)) + "." if flight.walks and self.pick(1, 0) else "") + bye
        if form == 9:
            what = "walks" if flight.walks else "stands there"
            return cap(f"{hello}while {who} {what}, {dist}{self.pick(' and ', ', ')}{pitch}.") + rest + bye
        if form == 10:
            return self.sentences([f"{self.pick('Gimbal first', 'Camera first', 'Angle first')}: {pitch}", f"then {self.pick('distance', 'the gap', 'range')}: {dist}", f"and {self.pick('the subject', 'who to film', 'your subject')}: {who}"] + extra) + bye
        if form == 11:
            return self.sentences([f"{self.pick('See', 'You see', 'Spotted')} {who}? {cap(follow)} them", f"{dist}, {pitch}"] + extra) + bye
        if form == 12:
            if alt:
                joined = f"{self.pick('put', 'park', 'keep')} the drone {self.m(flight.altitude)} up and {n} from {who}, {self.pitch_frag(flight)}"
            else:
                joined = f"{self.pick('put', 'park', 'keep')} the drone {n} from {who}, {self.pitch_frag(flight)}"
            more = [e for e in ([self.turns_clause(flight), self.stops_clause(flight), self.time_clause(flight)] if flight.walks else [self.stand_time(flight)]) if self.pick(1, 0)]
            return cap(hello + joined) + "." + (" " + self.sentences(more) if more else "") + bye
        if form == 13:
            return self.sentences([self.pick(f"you're on {who}", f"stay on {who}", f"it's {who} this time"), self.pick("I'd like ", "I want ", "let's have ", "please have ") + self.pick(f"a distance of {n}", f"{n} between us and them", f"{n} of distance", f"a gap of {n}") + self.pick(f" and {self.pitch_note(flight)}", f", {self.pitch_frag(flight)}")] + extra) + bye
        q = self.pick("How far? ", "Range? ", "Distance? ", "How far off? ")
        a = self.pick("Angle? ", "Camera? ", "Tilt? ", "Gimbal? ")
        pair = self.shuffled([q + cap(self.m(flight.distance)) + self.pick("", " from them", ", drone to person") + ".", a + cap(self.pitch_note(flight)) + "."])
        return f"{self.pick('Who? ', 'Subject? ', 'On whom? ')}{cap(who)}. {' '.join(pair)}{rest}{bye}"

    def standing_description(self, flight):
        who = self.who(flight, False)
        dist, pitch = self.distance_clause(flight), self.pitch_clause(flight)
        height = [self.height_clause(flight)] if flight.altitude >= 1 else []
        t = self.s(flight.duration)
        frags = ([self.height_frag(flight)] if height else []) + [self.distance_frag(flight), self.pitch_frag(flight)]
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8, 9)
        if form == 1:
            return self.sentences([self.intro(flight), self.stand_time(flight)] + self.shuffled([dist, pitch] + height))
        if form == 2:
            return self.sentences([f"{who} {self.v('stand')} {self.pick('in one place', 'on one spot', 'still')} for {t}", f"{dist} and {pitch}"] + height)
        if form == 3:
            notes = [self.who_note(flight), self.stand_note(flight), self.time_note(flight)] + self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + ([self.height_note(flight)] if height else []))
            mark = self.pick("; ", " | ", ", ", "\n- ", ". ")
            return ("- " if mark[0] == "\n" else "") + (mark.join(notes) if mark[0] != "." else ". ".join(cap(x) for x in notes))
        if form == 4:
            return cap(f"for {t} the drone {self.v('hover')} {', '.join(frags)}, filming {who}, who {self.v('stand')} in one spot.")
        if form == 5:
            return self.sentences([f"{self.pick('Nothing to follow here', 'No walking in this one', 'No steps taken here')}: {who} {self.v('stand')} in the same place for {t}", *self.shuffled([dist, pitch] + height)])
        if form == 6:
            return self.sentences([f"{self.sadj(flight.duration)} clip of {who} standing still", ", ".join([self.distance_note(flight), self.pitch_note(flight)] + ([self.height_note(flight)] if height else []))])
        if form == 7:
            return self.sentences([f"{self.pick('Does the person walk', 'Walking', 'Do they go anywhere')}? Nope, {who} {self.v('stand')} on one spot for {t}"] + self.shuffled([dist, pitch] + height))
        if form == 8:
            return self.sentences([f"{pitch}, {dist}" + (f", {height[0]}" if height else ""), f"on camera for {t}: {who}, standing in one place"])
        return self.sentences([f"we {self.v('hold', True)} on {who} for {t}, {', '.join(frags)}", self.stand_clause(flight)])

    def description(self, flight):
        self.begin(self.pick("past", "pres", "past"))
        if not flight.walks:
            return self.standing_description(flight)
        who = self.who(flight, False)
        dist, pitch, turns, stops = self.distance_clause(flight), self.pitch_clause(flight), self.turns_clause(flight), self.stops_clause(flight)
        way, time, speed = self.way_clause(flight), self.time_clause(flight), self.speed_clause(flight)
        alt = flight.altitude >= 1
        height = [self.height_clause(flight)] if alt else []
        w, t, v = self.m(flight.way), self.s(flight.duration), self.kmps(flight.speed)
        frags = ([self.height_frag(flight)] if alt else []) + [self.distance_frag(flight), self.pitch_frag(flight)]
        note_height = [self.height_note(flight)] if alt else []
        drone_notes = self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + note_height)
        walk_notes = [self.way_note(flight), self.speed_note(flight), self.turns_note(flight), self.stops_note(flight)]
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13)
        if form == 1:
            return self.sentences([f"{who} {self.v('walk')} {w} in {t} at {v}", turns, stops, f"{dist} and {pitch}"] + height)
        if form == 2:
            return self.sentences([self.intro(flight)] + self.shuffled([way, time, speed, turns, stops, dist, pitch] + height))
        if form == 3:
            notes = [self.who_note(flight)] + self.shuffled(walk_notes + [self.time_note(flight)]) + drone_notes
            mark = self.pick("; ", " | ", "\n- ", "; ", ". ")
            return ("- " if mark[0] == "\n" else "") + (mark.join(notes) if mark[0] != "." else ". ".join(cap(x) for x in notes))
        if form == 4:
            return self.sentences([f"{self.pick('drone', 'the drone')} {self.v(self.pick('sit', 'stay', 'fly'))} {', '.join(frags)}, and {self.v(self.pick('follow', 'track'))} {who} for {t}", f"{way} and {speed}", turns, stops])
        if form == 5:
            return cap(f"{self.sadj(flight.duration)} clip: {who} {self.v('walk')} {w} at {v}; {turns}; {stops}; {dist}; {pitch}" + "".join("; " + h for h in height) + ".")
        if form == 6:
            ask = [f"{self.pick('Who?', 'Subject?', 'Who is it?')} {cap(who)}.", f"{self.pick('How long?', 'Clip length?', 'Duration?')} {cap(t)}.",
                   f"{self.pick('How far on foot?', 'Walked?', 'Length of the walk?')} {cap(w)}, at {v}.", f"{self.pick('Turns?', 'Any turns?', 'What about turns?')} {cap(self.turn_list(flight) if len(flight.turns) > 1 else 'just ' + self.turn_noun(flight.turns[0])) if flight.turns else self.pick('Not one', 'Nope', 'Zero')}.",
                   f"{self.pick('Stops?', 'Any pauses?', 'Pauses?')} {cap(self.stops_note(flight)) if flight.stops else self.pick('Not one', 'Nope', 'Zero')}.",
                   f"{self.pick('Drone?', 'Where was the drone?' if self.t == 'past' else 'Where is the drone?')} {cap(', '.join(frags))}."]
            return " ".join([ask[0]] + self.shuffled(ask[1:]))
        if form == 7:
            return self.sentences([self.pick(f"we {self.v('be', True)} on {who}", f"this is {who}", f"what I've got: {who}", f"got {who} here"), self.walk_pair(flight), self.pick(f"{turns}; {stops}", f"{turns}. {cap(stops)}", f"{stops}. {cap(turns)}"), ", ".join(drone_notes)])
        if form == 8:
            return self.sentences([", ".join(drone_notes), f"{self.pick('in frame', 'on screen', 'on camera')}: {who}, walking {w} in {t} at {v}", stops, turns])
        if form == 9:
            return self.sentences([f"{self.pick('OK so', 'So', 'Right,', 'Quick summary:', 'Log:', 'Annotation:')} {who} {self.v('cover')} {w} on foot", self.pick(f"{stops} and {turns}", f"{stops}, and {turns}") if stops.startswith("they ") and turns.startswith("they ") else f"{stops}. {cap(turns)}", f"{time}, {speed}",
                                   f"{pitch}, {dist}" + ("" if not alt else f", {height[0]}")])
        if form == 10:
            return self.sentences([f"{who} {self.v('walk')} while the drone {self.v('stay')} {', '.join(frags)}", self.pick(f"{turns}. {cap(stops)}", f"{stops}. {cap(turns)}"), self.walk_pair(flight)])
        if form == 11:
            return self.sentences([f"{t} of {who} walking: {w}, {v}, {self.turns_note(flight)}, {self.stops_note(flight)}" if not self.spelled else f"{t} of {who} walking, {w} in all, at {v}; {self.turns_note(flight)}; {self.stops_note(flight)}", self.pick(f"{dist}, {pitch}", f"{pitch} and {dist}")] + height)
        if form == 12:
            return "\n".join([f"{self.pick('Subject', 'Person', 'Who')}: {who}", f"{self.pick('Walk', 'Movement', 'Path')}: {w} at {v}, {self.turns_note(flight)}, {self.stops_note(flight)}", f"{self.pick('Time', 'Length of clip', 'Duration')}: {t}", f"{self.pick('Drone', 'Camera drone', 'Aircraft')}: {', '.join(drone_notes)}"])
        return self.sentences([f"with {who} walking {w} at {v}, the drone {self.v('stay')} {self.distance_frag(flight)}, {self.pitch_frag(flight)}, for {t}", self.pick(f"{turns}. {cap(stops)}", f"{stops}. {cap(turns)}")] + height)

    # ---- wrong texts
    def split_end(self, text):
        for bye in (" Thanks!", " Cheers.", " Copy?", " Got it?", " Thx", " That's it."):
            if text.endswith(bye):
                text = text[:-len(bye)]
        if text[-1] in ".?!":
            return text[:-1], text[-1]
        return text, ""

    def foreign(self, text):
        body, end = self.split_end(text)
        if self.pick(1, 1, 0):
            thing = self.pick(*self.things)
            return f"{body}, {thing}{end}"
        p = self.pick(*self.persons)
        return f"{body}{end or '.'} " + self.pick(f"The person's {an(p)}.", f"It's {an(p)}, by the way.", f"There's also {an(p)} in the shot.", f"Note: {an(p)} joins them.", f"They're {an(p)}.", f"{cap(an(p))} walks alongside.", f"You can tell it's {an(p)}.")

    def heading(self, text, direction):
        body, end = self.split_end(text)
        d = direction
        return f"{body}{end or '.'} " + self.pick(f"The person walks {d}.", f"They're heading {d}.", f"They walk towards the {d}.", f"Walking direction: {d}.", f"The walk goes {d}.", f"On foot, {d} all the way.", f"The person's on their way {d}.", f"They head off {d}.",
                                                  f"It's {d} that they walk.", f"Person is {d}bound." if d in ("north", "south", "east", "west") else f"The person is walking to the {d}.")


DIGITS = "零一二三四五六七八九"


def in_hanzi(n, counter=False):
    if counter and n == 2:
        return "两"
    if n < 10:
        return DIGITS[n]
    if n < 100:
        return (DIGITS[n // 10] if n >= 20 else "") + "十" + (DIGITS[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        return DIGITS[n // 100] + "百" + ("" if not rest else "零" + DIGITS[rest] if rest < 10 else DIGITS[rest // 10] + "十" + (DIGITS[rest % 10] if rest % 10 else ""))
    return str(n)


class SixteenthChinese(Grammar):
    code = "zh"
    things = ["旁边有个喷泉", "天上还打着雷", "手里牵着两条狗", "路边停着一排面包车", "旁边就是面包店", "下着大雨", "晚霞特别红", "一群人在旁边鼓掌", "有电车从旁边开过", "当时刚过半夜", "走的是一座木桥",
              "推着一辆婴儿车", "打着一把伞", "屋顶上全是雪", "就在教堂台阶边上", "有小孩在踢球", "边走边打电话", "手里拿着冰淇淋", "雾特别大", "还推着辆自行车", "正对着消防站", "到处是海鸥", "在菜市场的摊位中间", "侧风刮得挺猛", "边上有座骑马的雕像"]
    persons = ["护士", "渔夫", "女学生", "老爷爷", "邮递员", "新娘", "警察", "小伙子", "服务员", "阿姨", "军人", "小朋友"]

    def begin(self, over):
        self.over = over
        self.spelled = self.pick(True, False, False, False, False, False)
        self.short = self.pick(True, False, False)
        self.space = self.pick(" ", "", "")
        self.zhuan = self.pick("转", "转", "拐")
        self.back = self.pick("掉头", "掉头", "调头", "折返")

    def num(self, n, counter=True):
        return in_hanzi(n, counter) if self.spelled else str(n)

    def unit(self, n, long, short):
        if self.spelled:
            return self.num(n) + long
        return f"{n}{short}" if self.short else f"{n}{self.space}{long}"

    def m(self, n):
        return self.unit(n, "米", "m")

    def s(self, n):
        return self.unit(n, "秒", "s") if n >= 0 else ""

    def d(self, n):
        return self.unit(n, "度", "°")

    def v(self, x):
        if self.spelled:
            whole, tenth = f"{x:.1f}".split(".")
            return f"每秒{DIGITS[int(whole)]}点{DIGITS[int(tenth)]}米"
        return self.pick(f"{x:.1f}m/s", f"{x:.1f}米/秒", f"每秒{x:.1f}米", f"一秒{x:.1f}米", f"{x:.1f}米每秒")

    def c(self, n):
        """A count with 次 or 个 behind it."""
        return self.pick(in_hanzi(n, True), in_hanzi(n, True), str(n))

    def le(self):
        return "了" if self.over else ""

    # ---- 人
    def col(self, colour):
        return ZH_COLOURS[colour] + "色"

    def brief(self, colour):
        return ZH_COLOURS[colour] if colour in "black white red yellow green blue grey purple".split() else ZH_COLOURS[colour] + "色"

    def who(self, flight):
        noun = self.pick("人", "人", "人", "行人", "目标") if flight.walks else self.pick("人", "人", "目标")
        if not flight.wear:
            return self.pick("这个人", "那个人", "目标", "画面里的人", "拍摄对象", "被拍的人", "镜头里那个人", "画面里这位") if not flight.walks else self.pick("这个人", "那个人", "目标", "画面里的人", "拍摄对象", "被拍的人", "镜头里那个人", "那个走路的人", "画面里这位", "那个行人")
        top, low, bag = flight.wear
        a, b, sa, sb = self.col(top), self.col(low), self.brief(top), self.brief(low)
        pack = self.pick("背包", "双肩包")
        pre = self.pick(f"背着{pack}、", f"背着{pack}，", f"背了个{pack}、") if bag else self.pick("", "", "", f"没背包、")
        post = self.pick(f"、背着{pack}", f"、还背着{pack}", f"、背了个{pack}") if bag else self.pick("", "", "", "", "、没背包")
        forms = [f"{pre}穿{a}上衣和{b}裤子的{noun}", f"那个穿{a}上衣、{b}裤子{post}的{noun}", f"上身{a}、下身{b}{post}的{noun}", f"{pre}{a}上衣配{b}裤子的{noun}",
                 f"{sa}上衣{sb}裤子{post}的那位", f"穿着{b}裤子、{a}上衣{post}的{noun}", f"那个上衣是{a}、裤子是{b}{post}的{noun}", f"身穿{a}上衣、{b}裤子{post}的{noun}",
                 f"那位穿{sa}上衣、{sb}裤子{post}的", f"{pre}上面穿{sa}的、下面穿{sb}的那个人", f"{noun}（{a}上衣，{b}裤子{'，背着包' if bag else ''}）" if noun != "人" else f"这个人（{a}上衣，{b}裤子{'，背着包' if bag else ''}）",
                 f"下面{b}裤子、上面{a}上衣{post}的那个人"]
        if top == low:
            forms += [f"{pre}上衣裤子都是{a}的{noun}", f"{pre}上下都穿{a}的{noun}", f"{pre}上衣和裤子全是{a}的那个人"]
        return self.pick(*forms)

    def who_note(self, flight):
        if not flight.wear:
            return self.pick("一个人", "单人", "这个人", "一名行人" if flight.walks else "一个人")
        top, low, bag = flight.wear
        a, b, sa, sb = self.col(top), self.col(low), self.brief(top), self.brief(low)
        parts = self.pick([f"{a}上衣", f"{b}裤子"], [f"{b}裤子", f"{a}上衣"], [f"上衣{a}", f"裤子{b}"], [f"上身{sa}", f"下身{sb}"])
        if bag:
            parts.append(self.pick("背着包", "有背包", "带背包", "背双肩包"))
        elif self.pick(0, 0, 1):
            parts.append(self.pick("没背包", "无背包"))
        return self.pick("，", "、", " / ").join(parts)

    # ---- 距离
    def distance_imp(self, flight):
        n = self.m(flight.distance)
        return self.pick(f"离人{n}", f"跟人保持{n}", f"距离控制在{n}", f"跟目标拉开{n}", f"飞机离ta{n}远", f"隔着{n}跟", f"把距离定在{n}", f"保持{n}的间距", f"直线距离卡在{n}", f"人机距离锁定{n}", f"离对方{n}就行", f"中间留{n}") if flight.walks else \
            self.pick(f"离人{n}", f"跟人保持{n}", f"距离控制在{n}", f"跟目标拉开{n}", f"飞机离ta{n}远", f"隔着{n}拍", f"保持{n}的间距", f"直线距离卡在{n}", f"人机距离锁定{n}", f"离对方{n}就行", f"中间留{n}")

    def distance_clause(self, flight):
        n, le = self.m(flight.distance), self.le()
        return self.pick(f"飞机离人{n}", f"人机距离{n}", f"无人机跟人隔着{n}", f"平均离ta{n}", f"跟拍距离是{n}" if flight.walks else f"拍摄距离是{n}", f"飞机到人的直线距离有{n}", f"距离一直在{n}", f"离目标{n}远", f"和人之间是{n}的距离", f"隔{n}拍的",
                         f"间距{n}", f"{n}是飞机到人的距离", f"人在飞机{n}开外", f"无人机在离人{n}的地方")

    def distance_note(self, flight):
        n = self.m(flight.distance)
        return self.pick(f"距离{n}", f"人机距离：{n}", f"离人{n}", f"间距{n}", f"直线距离{n}", f"斜距{n}", f"拍摄距离{n}", f"距目标{n}", f"离ta{n}", f"与人相距{n}")

    def distance_adv(self, flight):
        n = self.m(flight.distance)
        return self.pick(f"离人{n}", f"隔着{n}", f"在{n}开外", f"从{n}外", f"保持{n}距离", f"以{n}的距离", f"隔开{n}", f"拉开{n}", f"在离ta{n}的位置", f"跟人隔{n}")

    # ---- 俯仰
    def pitch_imp(self, flight):
        p, n = flight.pitch, self.d(abs(flight.pitch))
        if p == 0:
            return self.pick("镜头放平", "云台打平就行", "镜头平视", "云台归零", "镜头不俯也不仰", "俯仰角0度", "镜头别往上也别往下，水平就好", "镜头水平对着前面", "云台保持水平", "镜头对准地平线的高度")
        if p < 0:
            return self.pick(f"镜头往上抬{n}", f"云台上仰{n}", f"镜头仰{n}", f"仰角打到{n}", f"镜头比水平高{n}", f"云台往上翘{n}", f"镜头从水平往上抬{n}", f"把仰角调成{n}", f"镜头朝上{n}", f"云台抬起来{n}，往上拍")
        return self.pick(f"镜头往下压{n}", f"云台下俯{n}", f"镜头俯{n}", f"俯角打到{n}", f"镜头比水平低{n}", f"云台低头{n}", f"镜头从水平往下压{n}", f"把俯角调成{n}", f"镜头朝下{n}", f"云台-{p}°，也就是往下看", f"俯拍，{n}", f"镜头向下倾斜{n}")

    def pitch_clause(self, flight):
        p, n = flight.pitch, self.d(abs(flight.pitch))
        if p == 0:
            return self.pick("镜头是平的", "云台没俯也没仰", "镜头一直平视", "俯仰角是0", "镜头朝着水平方向", "云台保持水平", "镜头既不往上也不往下", "相机水平拍", "镜头正对地平线", "是平视的角度")
        if p < 0:
            return self.pick(f"镜头往上抬了{n}", f"云台上仰{n}", f"相机仰着{n}", f"仰角{n}", f"镜头高出水平线{n}", f"镜头朝上，{n}", f"是{n}的仰拍", f"云台翘起来{n}", f"镜头朝上，跟水平线夹{n}", f"相机向上倾斜{n}")
        return self.pick(f"镜头往下压了{n}", f"云台下俯{n}", f"相机俯着{n}", f"俯角{n}", f"镜头低于水平线{n}", f"镜头朝下，{n}", f"是{n}的俯拍", f"云台低头{n}", f"镜头朝下，跟水平线夹{n}", f"相机向下倾斜{n}", f"从水平线往下{n}是镜头的朝向")

    def pitch_note(self, flight):
        p, n = flight.pitch, self.d(abs(flight.pitch))
        if p == 0:
            return self.pick("镜头水平", "平视", "云台0度", "俯仰角0", "无俯仰", "镜头平放", "云台水平", "镜头指向水平", "不俯不仰", "相机水平")
        way, side = ("仰", "上") if p < 0 else ("俯", "下")
        return self.pick(f"{way}角{n}", f"镜头{side}{'抬' if p < 0 else '压'}{n}", f"云台：{side}{way}{n}", f"{way}拍{n}", f"镜头朝{side}{n}", f"相机{way}角{n}", f"云台往{side}{n}", f"镜头指向水平线{'以' + side}{n}", f"镜头向{side}{n}", f"{n}{way}角", f"云台{'+' if p < 0 else '-'}{abs(p)}°（朝{side}）")

    # ---- 高度
    def height_imp(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"飞{n}高", f"高度{n}", f"飞高{n}", f"高度保持{n}", f"升到{n}定高", f"飞机比人脚下高{n}", f"高度锁在{n}", f"比人站的地面高{n}", f"高度就{n}，别变", f"飞行高度设{n}")

    def height_clause(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"飞机飞在{n}高", f"高度{n}", f"飞行高度是{n}", f"无人机比人脚下高{n}", f"飞机离地{n}", f"飞了{n}高" if self.over else f"飞{n}高", f"高度在{n}", f"无人机在{n}的高度", f"{n}的高度飞的" if self.over else f"高度是{n}", f"离人脚底的高度有{n}")

    def height_note(self, flight):
        n = self.m(flight.altitude)
        return self.pick(f"高度{n}", f"飞行高度：{n}", f"飞高{n}", f"离地{n}", f"高{n}", f"高于人脚下{n}", f"无人机高度{n}", f"高度 {n}", f"飞{n}高", f"相对人脚底高{n}")

    # ---- 转弯
    def turn(self, turn):
        if turn == "around":
            return self.pick("掉头", "调头", "往回走", "转身往回走", "掉头往回走", "折返", "调了个头" if self.over else "调个头")
        side = "左" if turn == "left" else "右"
        return self.pick(f"{side}转", f"{side}拐", f"往{side}拐", f"向{side}转", f"往{side}转弯", f"向{side}拐弯", f"往{side}一拐", f"朝{side}拐")

    def turn_brief(self, turn):
        if turn == "around":
            return self.back
        return ("左" if turn == "left" else "右") + self.zhuan

    def turn_list(self, flight):
        n = flight.turns
        words = [self.turn_brief(t) for t in n]
        short = [{"left": "左", "right": "右", "around": "掉头"}[t] for t in n]
        return self.pick("、".join(words), "、".join(words), "，".join(words), "→".join(words), "→".join(short), "-".join(short), "，再".join(words), "、".join(short))

    def turns_note(self, flight):
        if not flight.turns:
            return self.pick("没转弯", "无转弯", "转弯：无", "转弯0次", "一路直走", "直走，没拐弯", "没有转向", "全程不拐弯", "不转弯", "转弯数0")
        n = len(flight.turns)
        return self.pick(f"转弯：{self.turn_list(flight)}", f"转弯{n}次：{self.turn_list(flight)}", f"转向{self.c(n)}次（{self.turn_list(flight)}）", f"{self.turn_list(flight)}", f"路线：{self.turn_list(flight)}", f"依次{self.turn_list(flight)}" if n > 1 else f"只{self.turn_brief(flight.turns[0])}一次",
                         f"共{self.c(n)}次转向，{self.turn_list(flight)}", f"先后{self.turn_list(flight)}" if n > 1 else f"一次转弯：{self.turn_brief(flight.turns[0])}", f"转弯顺序{self.turn_list(flight)}" if n > 1 else f"转弯一次：{self.turn_brief(flight.turns[0])}", f"以行人视角：{self.turn_list(flight)}")

    def turns_clause(self, flight):
        turns, le = flight.turns, self.le()
        n = len(turns)
        if n == 0:
            return self.pick("一路直走，没拐弯", "全程没转弯" if self.over else "全程不转弯", "一个弯都没拐" if self.over else "一个弯都不拐", "没有转过弯" if self.over else "不会转弯", "路上没有拐弯", "从头到尾都是直走", "没左转、没右转，也没掉头" if self.over else "不左转、不右转，也不掉头",
                             "中间没有任何转向", "就一条直线走到底", "转弯？没有", "拐弯的次数是0")
        words = [self.turn(t) for t in turns]
        briefs = [self.turn_brief(t) for t in turns]
        if n == 1:
            w, b = words[0], briefs[0]
            side = {"left": "左", "right": "右"}.get(turns[0])
            forms = [f"{b}{le}一次", f"中途{b}{le}一次", f"只{b}了一次" if self.over else f"只{b}一次", f"就一个转弯，{b}" if side else "就转了一次向，是掉头" if self.over else "就转一次向，是掉头", f"转{le}一次，{b}", f"唯一一次转向是{b}", f"转弯就一次：{b}" if side else "转向就一次：掉头", f"一共转{le}一个弯，{'朝' + side if side else '是掉头'}", f"走着走着{b}{le}", f"会有一次{b}" if not self.over else f"有过一次{b}"]
            return self.pick(*forms)
        first = "先" + words[0] + "".join("，" + self.pick("再", "然后", "接着", "之后", "再") + w for w in words[1:-1]) + "，" + self.pick("最后", "再", "然后") + words[-1]
        counts = [(t, k) for t, k in runs(turns)]
        grouped = "，".join((self.pick("先", "") if i == 0 else self.pick("再", "然后", "接着")) + (f"连着{in_hanzi(k, True)}次{self.turn_brief(t)}" if k > 1 else self.turn_brief(t)) for i, (t, k) in enumerate(counts))
        forms = [first, first, f"转{le}{self.c(n)}次：{self.turn_list(flight)}", f"一共{self.c(n)}个弯，{self.turn_list(flight)}" if "around" not in turns else f"一共{self.c(n)}次转向，{self.turn_list(flight)}", f"依次是{'、'.join(briefs)}", f"路上的转向按顺序是{'、'.join(briefs)}",
                 grouped, grouped, f"{self.c(n)}次转向，第一次{briefs[0]}" + "".join(f"，{'第' + in_hanzi(i + 2) + '次'}{b}" for i, b in enumerate(briefs[1:])), f"拐弯顺序：{self.turn_list(flight)}", f"从{briefs[0]}开始，接着{'、'.join(briefs[1:])}"]
        if n == 2:
            forms += [f"{briefs[0]}之后又{briefs[1]}", f"在{briefs[1]}之前先{briefs[0]}{le}" if turns[0] != turns[1] else f"{briefs[0]}了两次" if self.over else f"{briefs[0]}两次"]
        if len(set(turns)) == 1:
            forms += [f"连着{in_hanzi(n, True)}次都是{briefs[0]}", f"{self.c(n)}次转向全是{briefs[0]}"]
        return self.pick(*forms)

    # ---- 停
    def stops_note(self, flight):
        n = flight.stops
        if n == 0:
            return self.pick("没停", "无停顿", "停顿0次", "一次没停", "没有停留", "全程不停", "停留：无")
        if flight.standing < 1:
            return f"停{self.c(n)}次"
        s = self.s(flight.standing)
        if n == 1:
            return self.pick(f"停1次，{s}", f"停留一次（{s}）", f"停顿1次共{s}", f"停一次{s}", f"一次停顿，{s}", f"停下{s}，就一次", f"站停一次{s}", f"停留{s}（1次）")
        c = self.c(n)
        return self.pick(f"停{c}次，共{s}", f"停留{c}次（合计{s}）", f"停顿{c}次，加起来{s}", f"{c}次停顿总共{s}", f"总停留{s}，分{c}次", f"{c}次站停，累计{s}", f"停{c}次/共{s}", f"停{c}次，一共站了{s}" if self.over else f"停{c}次，一共站{s}", f"停顿总时长{s}（{c}次）")

    def stops_clause(self, flight):
        n, le = flight.stops, self.le()
        if n == 0:
            return self.pick("中间没停过" if self.over else "中间不停", "一次都没停" if self.over else "一次都不停", "全程没有停顿", "路上没歇过脚" if self.over else "路上不歇脚", "一路不停地走", "没有停下来过" if self.over else "不会停下来", "停留次数是0", "一直在走，没停" if self.over else "一直走，不停", "中途没有站住", "有没有停？没有" if self.over else "停不停？不停")
        s, c = self.s(flight.standing), self.c(n)
        if flight.standing < 1:
            return f"停{le}{c}次"
        if n == 1:
            return self.pick(f"中间停{le}一次，{s}", f"停下来站{le}{s}，就这一次", f"有一次停顿，停{le}{s}", f"路上停{le}一回，一共{s}", f"有{s}是站着不动的，集中在一次", f"只停{le}一次，时长{s}", f"停{le}一次，站着{s}没动" if self.over else f"停一次，站{s}", f"唯一一次停留是{s}", f"停顿{s}，只有一次", f"走着走着停{le}{s}，总共就停这一次")
        return self.pick(f"中间停{le}{c}次，加起来{s}", f"停{le}{c}回，总共{s}", f"有{c}次停顿，合计{s}", f"一共站着不动{s}，分{c}次", f"停{c}次，前后加一块儿{s}", f"{c}次停留累计{s}", f"走走停停，停{le}{c}次，总共{s}", f"路上停{le}{c}次，所有停顿一共{s}", f"总共有{s}花在{c}次停留上", f"停{le}{c}次，总停留时间{s}")

    # ---- 路程、时间、速度
    def way_clause(self, flight):
        n, le = self.m(flight.way), self.le()
        return self.pick(f"一共走{le}{n}", f"总共走{le}{n}", f"全程{n}", f"走{le}{n}的路", f"步行{n}", f"路程{n}", f"从头到尾走{le}{n}", f"这段路有{n}", f"走的总长是{n}", f"前后走{le}{n}")

    def way_note(self, flight):
        n = self.m(flight.way)
        return self.pick(f"步行{n}", f"路程：{n}", f"走{n}", f"全长{n}", f"共走{n}", f"步行距离{n}", f"行走里程{n}", f"走的路{n}", f"总路程{n}", f"路线长{n}")

    def time_clause(self, flight):
        n, le = self.s(flight.duration), self.le()
        return self.pick(f"整段{n}", f"飞{le}{n}", f"时长{n}", f"拍{le}{n}", f"前后一共拍{le}{n}", f"全程用时{n}", f"飞行时间{n}", f"这段视频{n}", f"从开始到结束{n}", f"一共拍{le}{n}")

    def time_note(self, flight):
        n = self.s(flight.duration)
        return self.pick(f"时长{n}", f"时长：{n}", f"用时{n}", f"飞行{n}", f"视频{n}", f"总时长{n}", f"时间{n}", f"片长{n}", f"飞行时长{n}", f"拍摄{n}")

    def speed_clause(self, flight):
        n = self.v(flight.speed)
        return self.pick(f"走的速度{n}", f"走路平均{n}", f"走路速度是{n}", f"步速{n}", f"走路均速{n}", f"以{n}的速度走", f"走路平均下来{n}", f"平均步速为{n}", f"按{n}的速度走", f"人走的速度是{n}")

    def speed_note(self, flight):
        n = self.v(flight.speed)
        return self.pick(f"步速{n}", f"走路的速度：{n}", f"步行均速{n}", f"走路平均速度{n}", f"走路速度{n}", f"步行速度{n}", f"行走均速{n}", f"平均步速{n}")

    # ---- 站着
    def stand_clause(self, flight):
        return self.pick("人站着没动" if self.over else "人站着不动", "全程站在一个地方", "人一直在原地", "一步都没走" if self.over else "一步都不走", "人就站那儿" if not self.over else "人就站那儿没挪地方", "从头到尾没挪窝" if self.over else "从头到尾不挪窝", "人是站着的，没走" if self.over else "人是站着的，不走", "全程原地站立", "ta一直站在原地", "没有走动")

    def stand_time(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"人在原地站了{t}", f"站着不动，一共{t}", f"{t}里人一步没走", f"整整{t}都站在原地", f"全程{t}，人就站在一个地方", f"{t}的时间一直站在原处", f"原地站立{t}", f"视频{t}，人始终没挪地方", f"飞了{t}，人一直站着没走", f"站在同一个位置{t}没走开") if self.over else \
            self.pick(f"人在原地站{t}", f"站着不动，一共{t}", f"{t}里人一步不走", f"整整{t}都站在原地", f"全程{t}，人就站在一个地方", f"{t}的时间一直站在原处", f"原地站立{t}", f"拍{t}，人始终不挪地方", f"飞{t}，人一直站着不走")

    def stand_note(self, flight):
        return self.pick("站着不动", "原地站立", "人没走", "没走动", "原地不动", "静止站立", "全程站在一处", "站在原处") if self.over else self.pick("站着不动", "原地站立", "人不走", "原地不动", "全程站在一处")

    # ---- 组合
    def join(self, parts, marks="，，。"):
        parts = [x for x in parts if x]
        out = ""
        for i, x in enumerate(parts):
            out += x
            if i == len(parts) - 1:
                out += "" if x[-1] in "。？！" else "。"
            elif x[-1] not in "。？！":
                out += self.rng.choice(marks)
        return out

    def shuffled(self, parts):
        parts = list(parts)
        self.rng.shuffle(parts)
        return parts

    def extras(self, flight, clause=True):
        pool = []
        if flight.altitude >= 1 and self.pick(1, 1, 0):
            pool.append(self.height_imp(flight) if clause and self.pick(1, 1, 0) else self.height_note(flight))
        if flight.walks:
            slots = self.shuffled(["turns", "stops", "way", "time", "speed"])[:self.pick(0, 0, 1, 2, 3, 5)]
            names = [getattr(self, s + ("_clause" if clause and self.pick(1, 1, 0) else "_note"))(flight) for s in slots]
            if names and clause:
                names[0] = self.pick("说下人：", "人这边：", "再说人：", "走路的人：", "目标那边：", "ta那边：", "人的情况：", "关于人：") + names[0]
                pool += names
            elif names:
                pool.append(self.pick("人：", "行人：", "目标：", "ta：", "人的动作：") + "，".join(names))
        elif self.pick(1, 1, 0):
            pool.append((self.stand_clause(flight) if self.pick(1, 0) else self.stand_time(flight)) if clause else self.stand_note(flight))
        return pool

    def follow(self, flight):
        return self.pick("跟着", "跟住", "跟拍", "盯住", "跟上", "跟着拍") if flight.walks else self.pick("拍", "对着", "盯住", "拍着", "镜头对准")

    def person_hint(self, flight):
        """Facts about the walk in an instruction need a subject of their own."""
        return self.pick("人", "ta", "目标", "对方")

    def instruction(self, flight):
        self.begin(False)
        who, follow = self.who(flight), self.follow(flight)
        dist, pitch = self.distance_imp(flight), self.pitch_imp(flight)
        extra = self.extras(flight)
        rest = self.join(extra) if extra else ""
        hello = self.pick("", "", "", "来，", "麻烦", "好，", "下一条：", "辛苦，")
        bye = self.pick("", "", "", "", "谢了！", "就这样。", "OK？", "拜托了！")
        n = self.m(flight.distance)
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12)
        if form == 1:
            return f"{hello}{follow}{who}，{dist}，{pitch}。{rest}{bye}"
        if form == 2:
            ask = f"{follow}{who}，{dist}"
            return self.pick(f"能不能{ask}，{pitch}？", f"可以{ask}吗？{pitch}。", f"帮忙{ask}，{pitch}，行吗？", f"麻烦{ask}，{pitch}，可以吗？", f"能{follow}{who}不？{dist}，{pitch}。", f"{ask}，{pitch}，行不行？", f"{ask}，{pitch}，能办到吗？",
                             f"{follow}{who}好吗？{pitch}，{dist}。") + rest + bye
        if form == 3:
            return f"{self.pick('看到', '看见', '瞧见')}{who}{self.pick('没', '了吗', '了没')}？{self.pick('就拍ta', '目标就是ta', '就是ta')}，" + self.join(self.shuffled([dist, pitch]) + extra) + bye
        if form == 4:
            notes = self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + self.extras(flight, False))
            mark = self.pick("；", "\n- ", " | ", "，")
            head = self.pick("任务：", "要求：", "镜头要求：", "飞手注意：") + follow + who
            return head + mark + mark.join(notes) + ("" if mark in ("\n- ", " | ") else "。")
        if form == 5:
            return f"{pitch}，{dist}，{follow}{who}。{rest}{bye}"
        if form == 6:
            return f"{hello}{self.distance_adv(flight)}{self.pick('，', '')}{self.pick('拍' if not flight.walks else '跟拍', '拍')}{who}，{self.pitch_note(flight)}。{rest}{bye}"
        if form == 7:
            return f"{self.pick('我想要', '需要', '想要', '来')}一段{who}{'' if who[-1] == '的' else '的'}镜头，" + self.join(self.shuffled([dist, pitch]) + extra) + bye
        if form == 8:
            notes = [self.who_note(flight)] + ([self.stand_note(flight)] if not flight.walks else []) + self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + ([self.height_note(flight)] if flight.altitude >= 1 else []))
            return self.pick("，", "；", " / ", "。").join(notes) + "。" + ((self.person_hint(flight) + "的路线：" + self.turns_note(flight).split("：")[-1] + "。") if flight.walks and flight.turns and self.pick(1, 0) else "") + bye
        if form == 9:
            do = self.pick("把飞机", "把无人机", "飞机")
            at = self.pick("停在", "放在", "摆在", "保持在")
            high = f"{self.m(flight.altitude)}高、" if flight.altitude >= 1 else ""
            more = [e for e in ([self.turns_clause(flight), self.stops_clause(flight), self.time_clause(flight)] if flight.walks else [self.stand_time(flight)]) if self.pick(1, 0)]
            if more and flight.walks:
                more[0] = self.pick("人这边：", "ta那边：", "再说目标：", "走路的人：") + more[0]
            return f"{self.pick('目标是', '拍的是', '盯的人是')}{who}，{do}{at}{high}离ta{n}的地方，{pitch}。{self.join(more)}{bye}"
        if form == 10:
            return f"{self.pick('拍谁', '跟谁' if flight.walks else '拍谁', '目标')}？{who}。{self.pick('多远', '距离', '离多远')}？{n}。{self.pick('镜头', '角度', '云台')}？{self.pitch_note(flight)}。{rest}{bye}"
        if form == 11:
            lead = f"{who}{'走的时候' if flight.walks else '站在那儿'}"
            return f"{lead}，{self.pick('你', '飞机', '无人机')}{self.pick('就', '')}{self.distance_adv(flight)}{'跟着' if flight.walks else '拍'}，{pitch}。{rest}{bye}"
        steps = self.pick(("先调镜头：", "再定距离：", "然后"), ("第一，", "第二，", "第三，"), ("镜头这么弄：", "距离这么定：", "接下来"), ("角度：", "远近：", "最后"), ("先说镜头，", "再说距离，", "最后"))
        return f"{steps[0]}{pitch}；{steps[1]}{dist}；{steps[2]}{follow}{who}。" + rest + bye

    def standing_description(self, flight):
        who = self.who(flight)
        dist, pitch = self.distance_clause(flight), self.pitch_clause(flight)
        high = [self.height_clause(flight)] if flight.altitude >= 1 else []
        high_note = [self.height_note(flight)] if flight.altitude >= 1 else []
        t = self.s(flight.duration)
        drone = self.shuffled([dist, pitch] + high)
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8)
        if form == 1:
            return self.join([f"{who}在原地站了{t}"] + drone)
        if form == 2:
            return self.join([f"{self.pick('这段拍的是', '画面里是', '视频里是', '拍的是')}{who}", self.stand_time(flight)] + drone)
        if form == 3:
            notes = [self.who_note(flight), self.stand_note(flight), self.time_note(flight)] + self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + high_note)
            return self.pick("；", " | ", "，", "\n", "。").join(notes)
        if form == 4:
            return self.join([f"{t}，{who}一直站着没走"] + drone)
        if form == 5:
            return self.join(drone + [f"镜头对着{who}", self.stand_time(flight)])
        if form == 6:
            return f"走了吗？没走，{who}在一个地方站了{t}。" + self.join(drone)
        if form == 7:
            return f"人：{who}\n状态：{self.stand_note(flight)}，{t}\n飞机：{'，'.join(self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + high_note))}"
        return self.join([f"飞机悬着拍了{t}", f"拍的是{who}", self.stand_clause(flight)] + drone)

    def description(self, flight):
        self.begin(True)
        if not flight.walks:
            return self.standing_description(flight)
        who = self.who(flight)
        dist, pitch, turns, stops = self.distance_clause(flight), self.pitch_clause(flight), self.turns_clause(flight), self.stops_clause(flight)
        way, time, speed = self.way_clause(flight), self.time_clause(flight), self.speed_clause(flight)
        alt = flight.altitude >= 1
        high, high_note = ([self.height_clause(flight)], [self.height_note(flight)]) if alt else ([], [])
        w, t, v = self.m(flight.way), self.s(flight.duration), self.v(flight.speed)
        drone, drone_notes = self.shuffled([dist, pitch] + high), self.shuffled([self.distance_note(flight), self.pitch_note(flight)] + high_note)
        form = self.pick(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12)
        if form == 1:
            return self.join([f"{who}{t}走了{w}", speed, turns + "。", stops] + drone)
        if form == 2:
            return self.join([f"{self.pick('这段拍的是', '画面里是', '视频里是', '跟拍的是')}{who}。"] + self.shuffled([way, time, speed, turns, stops]) + drone)
        if form == 3:
            notes = [self.who_note(flight)] + self.shuffled([self.way_note(flight), self.speed_note(flight), self.turns_note(flight), self.stops_note(flight), self.time_note(flight)]) + drone_notes
            return self.pick("；", " | ", "；", "\n", "\n- ").join(notes)
        if form == 4:
            return self.join([f"飞机跟了{t}", f"跟的是{who}"] + drone + [f"{self.pick('人', 'ta', '对方')}{way}" if way[0] in "一总走步从前" else way, speed, turns, stops])
        if form == 5:
            qs = self.shuffled([f"走了多远？{w}，{v}。", f"{self.pick('转弯', '拐弯', '转向')}？{self.turn_list(flight) if flight.turns else '没有'}。", f"{self.pick('停过吗', '停没停', '停顿')}？{self.stops_note(flight) if flight.stops else '没有'}。", f"{self.pick('多久', '时长')}？{t}。", f"{self.pick('飞机在哪', '无人机', '机位')}？{'，'.join(drone_notes)}。"])
            return f"{self.pick('拍谁', '谁', '目标')}？{who}。" + "".join(qs)
        if form == 6:
            return self.join([f"无人机{self.pick('隔着', '离着', '拉开')}{self.m(flight.distance)}跟着{who}拍了{t}", pitch] + high + [turns + "。", stops, way, speed])
        if form == 7:
            return f"人：{who}\n{self.pick('走法', '动作', '路线')}：{self.way_note(flight)}，{self.speed_note(flight)}，{self.turns_note(flight)}，{self.stops_note(flight)}\n{self.pick('时长', '时间')}：{t}\n{self.pick('飞机', '无人机', '机位')}：{'，'.join(drone_notes)}"
        if form == 8:
            return self.join([f"{t}的{self.pick('视频', '片子', '素材')}，{who}走了{w}，{v}", turns + "。", stops, dist, pitch] + high)
        if form == 9:
            return self.join(drone + [f"{'' if who[:2] in ('画面', '镜头') else self.pick('镜头里，', '画面里，', '画面中，')}{who}走了{w}", time, speed, stops, turns])
        if form == 10:
            return self.join([f"{who}以{v}的速度走了{w}，{self.pick('用时', '全程', '飞机跟了')}{t}", f"{stops}。", turns + "。"] + drone)
        if form == 11:
            return self.join([f"{self.pick('简单说', '标注', '总结', '记录')}：{who}", self.stops_note(flight), self.turns_note(flight), f"{self.way_note(flight)}/{self.time_note(flight)}/{self.speed_note(flight)}", f"{'，'.join(drone_notes)}"], "，；，")
        return self.join([f"{self.pick('跟', '跟着', '跟拍')}{who}{'' if who[-1] == '的' else '的'}一段，{time}", dist, pitch] + high + [turns, stops, way, speed])

    # ---- 错的
    def split_end(self, text):
        for bye in ("谢了！", "就这样。", "OK？", "拜托了！"):
            if text.endswith(bye):
                text = text[:-len(bye)]
        if text and text[-1] in "。？！":
            return text[:-1], text[-1]
        return text, ""

    def foreign(self, text):
        body, end = self.split_end(text)
        if self.pick(1, 1, 0):
            return f"{body}，{self.pick(*self.things)}{end}"
        p = self.pick(*self.persons)
        return f"{body}{end or '。'}" + self.pick(f"这人是个{p}。", f"是个{p}哦。", f"旁边还有个{p}。", f"看得出是{p}。", f"另外有个{p}跟着走。", f"目标是一名{p}。", f"画面里还多了个{p}。")

    def heading(self, text, direction):
        body, end = self.split_end(text)
        d = ZH_DIRECTIONS[direction]
        return f"{body}{end or '。'}" + self.pick(f"人往{d}走。", f"ta是朝{d}走的。", f"一路向{d}走。", f"行走方向：{d}。", f"人是往{d}边去的。", f"整体是朝{d}走。", f"走的方向是{d}。", f"朝{d}面走过去。", f"目标向{d}方走。", f"人朝着{d}走去。")
