"""The twenty-fourth grammar for check_text_judge.py: a large language model's polished instructions and summaries (briefs, bullet points, prose), a translator's careful prose, police reports, sports commentary, a parent explaining to a child."""
import re

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

ONES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "- - twenty thirty forty fifty sixty seventy eighty ninety".split()

# base: third person, past, gerund
VERBS = {
    "be": ("is", "was", "being"),
    "have": ("has", "had", "having"),
    "do": ("does", "did", "doing"),
    "go": ("goes", "went", "going"),
    "make": ("makes", "made", "making"),
    "take": ("takes", "took", "taking"),
    "come": ("comes", "came", "coming"),
    "stand": ("stands", "stood", "standing"),
    "keep": ("keeps", "kept", "keeping"),
    "hold": ("holds", "held", "holding"),
    "fly": ("flies", "flew", "flying"),
    "wear": ("wears", "wore", "wearing"),
    "stop": ("stops", "stopped", "stopping"),
    "spend": ("spends", "spent", "spending"),
    "set": ("sets", "set", "setting"),
    "run": ("runs", "ran", "running"),
    "swing": ("swings", "swung", "swinging"),
    "halt": ("halts", "halted", "halting"),
    "carry": ("carries", "carried", "carrying"),
    "put": ("puts", "put", "putting"),
    "lie": ("lies", "lay", "lying"),
    "leave": ("leaves", "left", "leaving"),
    "show": ("shows", "showed", "showing"),
    "sit": ("sits", "sat", "sitting"),
    "accompany": ("accompanies", "accompanied", "accompanying"),
    "move": ("moves", "moved", "moving"),
}


def number_words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + number_words(n % 100) if n % 100 else "")
    return str(n)


def form_of(verb, form):
    """form: 0 third person, 1 past, 2 base, 3 gerund."""
    if form == 2:
        return verb
    if verb in VERBS:
        return VERBS[verb][(0, 1, None, 2)[form]]
    if form == 0:
        return verb + "es" if verb.endswith(("s", "sh", "ch", "x")) else verb + "s"
    if form == 1:
        return verb + ("d" if verb.endswith("e") else "ed")
    return (verb[:-1] if verb.endswith("e") else verb) + "ing"


def formed(text, form):
    text = re.sub(r"\[([^|\]]+)\|([^\]]+)\]", lambda it: it[2] if form == 1 else it[1], text)
    return re.sub(r"\[([a-z]+)\]", lambda it: form_of(it[1], form), text)


def base(text):
    return formed(text, 2)


def gerund(text):
    return formed(text, 3)


def capitals(text):
    """The text with a capital at the start of every sentence and line."""
    out, fresh = "", True
    for at, c in enumerate(text):
        if fresh and c.isalnum():
            out += c.upper()
            fresh = False
        else:
            out += c
        if c == "\n" or (c in ".?!" and text[at + 1:at + 2] in (" ", "\n")):
            fresh = True
    return out


class TwentyFourthEnglish(Grammar):
    code = "en"
    styles = ["brief", "summary", "translator", "police", "commentator", "parent"]
    things = [
        "beside a parked lorry",
        "past a flower shop",
        "while a fire engine wails",
        "with a small terrier on a lead",
        "under a transparent umbrella",
        "along a canal",
        "near a petrol station",
        "over a wooden footbridge",
        "in a light drizzle",
        "between two rows of poplars",
        "just after dawn",
        "in front of a town hall",
        "next to a child on a scooter",
        "with an ice cream in one hand",
        "as a train thunders by",
        "among a group of schoolchildren",
        "in thick fog",
        "alongside a brick wall",
        "by an open market stall",
        "wearing a baseball cap",
        "with earphones in",
        "as snow falls",
        "through a playground",
        "pulling a suitcase",
        "while a flock of crows takes off",
        "at the edge of a lake",
    ]
    persons = ["postman", "surgeon", "elderly lady", "schoolgirl", "firefighter", "young man", "toddler", "chef", "grandfather", "sailor", "shop assistant", "lawyer", "farmer", "bridegroom"]

    # voice and numbers
    def voice(self, description):
        self.named = self.craft = None
        self.style = self.pick(*self.styles)
        self.past = description and (self.style in ("translator", "police") or self.style == "summary" and self.rng.random() < .3)
        self.unit = self.pick("metre", "metre", "meter", "meter", "m") if self.style in ("brief", "summary", "police") else self.pick("metre", "metre", "meter")
        self.spelled = self.unit != "m" and self.rng.random() < (.3 if self.style in ("translator", "parent") else .08)
        self.sign = not self.spelled and self.style in ("brief", "summary") and self.rng.random() < .6

    def of(self, **styled):
        """What the style of this text adds to a list of choices."""
        return [it for names, choices in styled.items() for it in choices if self.style in names.split("_")] * 2

    def n(self, number):
        return number_words(number) if self.spelled else str(number)

    def c(self, number):
        return number_words(number) if self.spelled or number < 10 and self.rng.random() < .6 else str(number)

    def times(self, number):
        return {1: "once", 2: "twice"}.get(number) or self.c(number) + " times"

    def m(self, number):
        return self.n(number) + " " + (self.unit if self.unit == "m" or number == 1 else self.unit + "s")

    def m_adj(self, number):
        article = "an " if str(number)[0] == "8" or number in (11, 18) else "a "
        return article + self.n(number) + ("-metre" if self.unit == "m" else "-" + self.unit)

    def s(self, number):
        return self.n(number) + (" second" if number == 1 else " seconds")

    def deg(self, flight):
        number = abs(flight.pitch)
        return f"{number}°" if self.sign else self.n(number) + (" degree" if number == 1 else " degrees")

    def v(self, flight):
        if self.unit == "m":
            return f"{flight.speed} m/s"
        name = "meters" if self.unit == "meter" else "metres"
        if self.spelled:
            whole, tenth = str(flight.speed).split(".")
            return f"{ONES[int(whole)]} point {ONES[int(tenth)]} {name} per second"
        return self.pick(f"{flight.speed} {name} per second", f"{flight.speed} {name} a second", f"{flight.speed} m/s")

    def finish(self, text):
        text = re.sub("\x01(?= (at|from|while|with) )", ",", formed(text.strip(), 1 if self.past else 0))
        return capitals(text.replace("\x01", ""))

    # the person
    def noun(self, flight):
        self.named = self.named or self.pick(*dict(
            brief=["subject", "subject", "target", "individual"],
            summary=["person", "subject", "individual", "pedestrian" if flight.walks else "figure"],
            translator=["person", "figure", "walker" if flight.walks else "person"],
            police=["individual", "person", "subject"],
            commentator=["walker", "person"] if flight.walks else ["person", "figure"],
            parent=["person", "person", "walker"] if flight.walks else ["person"],
        )[self.style])
        return self.named

    def who(self, flight, article=None):
        """The person with clothes; after a relative clause a mark that becomes a comma before `at a distance of …`."""
        text = self.clothed(flight, article)
        return text + "\x01" if flight.wear else text

    def clothed(self, flight, article=None):
        article = article or self.pick("the", "a")
        noun = self.noun(flight)
        a = an(noun) if article == "a" else "the " + noun
        if flight.wear is None:
            return a
        top, legs, pack = flight.wear
        if self.unit == "meter":
            top, legs = top.replace("grey", "gray"), legs.replace("grey", "gray")
        shirt = self.pick("top", "top", "top", "shirt", "jacket")
        trousers = self.pick("trousers", "trousers", "pants")
        bag = self.pick("backpack", "backpack", "rucksack")
        upper, lower = f"{an(top)} {shirt}", f"{legs} {trousers}"
        if pack:
            return self.pick(
                f"{a} wearing {upper}, {lower} and a {bag}",
                f"{a} in {upper} and {lower} with a {bag}",
                f"{a} dressed in {upper} and {lower} and carrying a {bag}",
                f"{a} who [wear] {upper} and {lower} and [carry] a {bag}",
                f"{a} with a {bag}, {upper} and {lower}",
                f"{a} identified by {upper}, {lower} and a {bag}",
                f"{a} with {upper}, {lower} and a {bag}",
                f"{a} carrying a {bag} and dressed in {upper} and {lower}",
                f"{a} in {lower}, {upper} and a {bag}",
                f"{a} whose {shirt} [be] {top}, whose {trousers} [are|were] {legs} and who [have] a {bag}",
                *self.of(police=[f"{a} clothed in {upper} and {lower} and in possession of a {bag}", f"{a} (upper garment: {top}; lower garment: {legs}; backpack: one)"],
                         parent=[f"{a} with the {top} {shirt} and the {legs} {trousers} and a {bag} on", f"{a} who [have] {upper}, {lower} and a {bag}"],
                         brief_summary=[f"{a} ({top} {shirt}, {lower}, {bag})", f"{a} attired in {upper} and {lower} and equipped with a {bag}"],
                         translator=[f"{a} clad in {upper} and {lower} and carrying a {bag}"]))
        plain = [
            f"{a} wearing {upper} and {lower}",
            f"{a} in {upper} and {lower}",
            f"{a} dressed in {upper} and {lower}",
            f"{a} who [wear] {upper} and {lower}",
            f"{a} in {lower} and {upper}",
            f"{a} identified by {upper} and {lower}",
            f"{a} with {upper} and {lower}",
            f"{a} whose {shirt} [be] {top} and whose {trousers} [are|were] {legs}",
            f"{a} wearing {lower} with {upper}",
            *self.of(police=[f"{a} clothed in {upper} and {lower}", f"{a} in {upper} and {lower} and without a {bag}", f"{a} (upper garment: {top}; lower garment: {legs}; backpack: none)"],
                     parent=[f"{a} with the {top} {shirt} and the {legs} {trousers}", f"{a} who [have] {upper} and {lower}"],
                     brief_summary=[f"{a} ({top} {shirt}, {lower})", f"{a} ({top} {shirt}, {lower}, no {bag})", f"{a} attired in {upper} and {lower}"],
                     translator=[f"{a} clad in {upper} and {lower}"])]
        return self.pick(*plain)

    def p(self, flight):
        """The person again."""
        return "the " + self.noun(flight)

    def drone(self):
        self.craft = self.craft or self.pick("the drone", "the drone", *self.of(brief_summary=["the aircraft", "the UAV"], police=["the unmanned aircraft"], translator=["the camera drone"], commentator=["our drone", "our camera drone"], parent=["the flying camera"]))
        return self.craft

    # distance
    def distance_clause(self, flight):
        d, p, x = self.m(flight.distance), self.p(flight), self.drone()
        return self.pick(
            f"{x} [keep] a distance of {d} from {p}",
            f"{x} [stay] {d} away from {p}",
            f"{x} [maintain] a separation of {d} from {p}",
            f"the distance between {x} and {p} [be] {d}",
            f"a gap of {d} [separate] {x} from {p}",
            f"{x} [hold] {self.m_adj(flight.distance)} gap to {p}",
            f"{x} and {p} [are|were] {d} apart",
            *self.of(
                brief=[f"separation from {p} [be] held at {d}", f"{x} [preserve] a standoff distance of {d}", f"the standoff distance [be] {d}"],
                summary=[f"{x} [maintain] a consistent separation of {d}", f"the straight-line distance from {x} to {p} [be] {d}", f"{x} [remain] {d} from {p} throughout"],
                translator=[f"between {x} and {p} there [be] a distance of {d}", f"{x} [keep] itself {d} away from {p}", f"{p} and {x} [are|were] separated by {d}"],
                police=[f"the distance between {x} and {p} [be] recorded as {d}", f"{x} [maintain] a distance of {d} from {p}", f"surveillance [be] conducted from a distance of {d}"],
                commentator=[f"{x} [sit] {d} off {p}", f"there are {d} between {x} and {p}", f"{d}, that is the gap between {x} and {p}"],
                parent=[f"{x} [keep] {d} away from {p}", f"from {x} to {p} it [be] {d}", f"if you measured from {x} to {p}, you would get {d}"]))

    def distance_order(self, flight):
        d, p = self.m(flight.distance), self.p(flight)
        return self.pick(
            f"keep a distance of {d} from {p}",
            f"stay {d} away from {p}",
            f"maintain a separation of {d}",
            f"hold a distance of {d} to {p}",
            f"leave a gap of {d} between the drone and {p}",
            f"keep the drone {d} from {p}",
            *self.of(
                brief=[f"maintain a separation of {d} from {p}", f"preserve a standoff distance of {d}", f"ensure that the drone remains {d} from {p}", f"hold the separation constant at {d}"],
                summary=[f"maintain a consistent distance of {d} from {p}", f"position the drone {d} from {p}", f"sustain {self.m_adj(flight.distance)} separation"],
                translator=[f"see to it that the distance to {p} is {d}", f"let there be {d} between you and {p}", f"keep yourself {d} away from {p}"],
                police=[f"maintain a distance of {d} from {p}", f"observe {p} from a distance of {d}", f"do not deviate from a distance of {d} to {p}"],
                commentator=[f"sit {d} off {p}", f"give {p} a gap of {d}", f"stay locked in at a distance of {d}"],
                parent=[f"stay {d} away from {p}, please", f"keep the drone {d} away from {p}, no closer and no farther", f"remember to leave {d} between the drone and {p}"]))

    def distance_by(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"from a distance of {d}", f"at a distance of {d}", f"from {d} away", f"at a separation of {d}", f"at a range of {d}", f"while keeping a distance of {d}", f"while staying {d} away", f"at {self.m_adj(flight.distance)} distance")

    # pitch
    def pitch_clause(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick(
                "the camera [be] held level",
                "the camera [point] straight at the horizon",
                "the lens [be] kept horizontal",
                f"the camera tilt [be] {a}",
                "the camera [be] tilted neither up nor down",
                "the camera [look] out horizontally",
                *self.of(brief_summary=["the gimbal [maintain] a level orientation", "the camera [maintain] a level line of sight", f"camera pitch [be] {a}, level with the horizon"],
                         translator=["the gaze of the camera [be] level with the horizon", "the lens [be] inclined neither upward nor downward"],
                         police=["the camera [be] set level with the horizon", "no camera tilt [be] applied"],
                         commentator=["the camera [be] dead level", "no tilt on the camera at all"],
                         parent=["the camera [look] straight ahead, not up and not down", "the camera [be] flat level"]))
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        article = "a" if down == "down" else "an"
        return self.pick(
            f"the camera [be] tilted {a} {down}ward",
            f"the camera [point] {a} {below} the horizon",
            f"the lens [be] angled {a} {below} the horizontal",
            f"the camera [be] pitched {down} by {a}",
            f"the camera [look] {down} at an angle of {a}",
            f"the camera [have] {article} {down}ward tilt of {a}",
            *self.of(brief_summary=[f"the gimbal [maintain] {article} {down}ward pitch of {a}", f"the camera [be] oriented {a} {below} the horizon", f"the line of sight [be] inclined {a} {below} the horizontal", f"camera pitch [be] {a} {down}ward"],
                     translator=[f"the lens [be] inclined {down}ward at an angle of {a}", f"the gaze of the camera [be] directed {a} {below} the horizon"],
                     police=[f"the camera [be] set at {article} {down}ward angle of {a}", f"the camera angle [be] {a} {below} the horizontal"],
                     commentator=[f"the camera [be] tipped {down} by {a}", f"we have {a} of {down}ward tilt on the camera"],
                     parent=[f"the camera [look] {down} a bit, {a} to be exact".replace(" a bit", ""), f"the camera [tilt] {a} {down}", f"the camera [be] tipped {a} {down}ward"]))

    def pitch_order(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick(
                "keep the camera level",
                "hold the camera horizontal",
                "point the lens straight at the horizon",
                f"set the camera tilt to {a}",
                "tilt the camera neither up nor down",
                *self.of(brief_summary=["maintain a level camera orientation", "ensure that the gimbal remains level", f"set the gimbal pitch to {a}"],
                         translator=["let the lens be level with the horizon", "incline the lens neither upward nor downward"],
                         police=["keep the camera level with the horizon", "apply no camera tilt"],
                         commentator=["keep that camera dead level", "keep that camera level, with no tilt at all"],
                         parent=["let the camera look straight ahead, not up and not down", "keep the camera nice and level"]))
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        article = "a" if down == "down" else "an"
        return self.pick(
            f"tilt the camera {a} {down}ward",
            f"point the camera {a} {below} the horizon",
            f"angle the lens {a} {below} the horizontal",
            f"pitch the camera {down} by {a}",
            f"set the camera to {article} {down}ward angle of {a}",
            *self.of(brief_summary=[f"maintain {article} {down}ward camera pitch of {a}", f"orient the gimbal {a} {below} the horizon", f"set the gimbal to a pitch of {a} {down}ward", f"ensure that the camera points {a} {below} the horizon"],
                     translator=[f"incline the lens {down}ward at an angle of {a}", f"let the camera be directed {a} {below} the horizon"],
                     police=[f"keep the camera angled {a} {below} the horizontal", f"set the camera at {article} {down}ward angle of {a}"],
                     commentator=[f"tip that camera {down} by {a}", f"give the camera {a} of {down}ward tilt"],
                     parent=[f"tip the camera {a} {down}, like this", f"let the camera look {down} by {a}"]))

    def pitch_by(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick("with the camera level", "with the camera held horizontal", "with the lens aimed straight at the horizon", "with no camera tilt", f"with the camera tilt at {a}", "with the camera tilted neither up nor down")
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        article = "a" if down == "down" else "an"
        return self.pick(f"with the camera tilted {a} {down}ward", f"with the camera pitched {down} by {a}", f"with the lens {a} {below} the horizon", f"with {article} {down}ward camera angle of {a}", f"with the camera angled {a} {below} the horizontal", f"with the camera pointing {a} {below} the horizon")

    # height
    def height_clause(self, flight):
        h, p, x = self.m(flight.altitude), self.p(flight), self.drone()
        return self.pick(
            f"{x} [fly] at a height of {h}",
            f"{x} [fly] {h} above the ground",
            f"the flying height [be] {h}",
            f"{x} [be] at an altitude of {h}",
            f"{x} [stay] {h} above the ground at the feet of {p}",
            *self.of(brief_summary=[f"{x} [maintain] an altitude of {h}", f"flight altitude [be] {h}", f"{x} [operate] at a height of {h} above ground"],
                     translator=[f"{x} [keep] to a height of {h} above the ground", f"the height at which {x} [fly] [be] {h}"],
                     police=[f"{x} [be] operated at an altitude of {h}", f"the altitude of {x} [be] {h} above ground level"],
                     commentator=[f"altitude on {x}, {h}", f"{x} [be] {h} up in the air"],
                     parent=[f"{x} [be] {h} up in the air", f"from the ground up to {x} it [be] {h}"]))

    def height_order(self, flight):
        h = self.m(flight.altitude)
        return self.pick(
            f"fly at a height of {h}",
            f"fly {h} above the ground",
            f"keep an altitude of {h}",
            f"hold the drone at a height of {h}",
            *self.of(brief_summary=[f"maintain an altitude of {h}", f"operate at a height of {h} above ground"],
                     translator=[f"let the drone fly at a height of {h}"],
                     police=[f"operate the drone at an altitude of {h}"],
                     commentator=[f"fly it {h} up in the air"],
                     parent=[f"keep the drone {h} up in the air"]))

    # turns
    def turn_noun(self, turn):
        if turn == "around":
            return self.pick("a U-turn", "a U-turn", "an about-turn", "a reversal of direction")
        return self.pick(f"a {turn} turn", f"a {turn} turn", f"a turn to the {turn}")

    def turn_verb(self, turn):
        if turn == "around":
            return self.pick("[turn] around", "[make] a U-turn", "[double] back", "[reverse] direction")
        return self.pick(f"[turn] {turn}", f"[turn] {turn}", f"[turn] to the {turn}", f"[make] a {turn} turn", f"[take] a {turn} turn")

    def row(self, items):
        if len(items) == 1:
            return items[0]
        if len(items) == 2:
            return self.pick(f"{items[0]}, then {items[1]}", f"first {items[0]}, then {items[1]}", f"{items[0]} and then {items[1]}")
        return self.pick(", then ".join(items), ", ".join(items[:-1]) + ", and finally " + items[-1], f"first {items[0]}, then " + ", then ".join(items[1:]))

    def turn_vp(self, flight):
        turns, k = flight.turns, len(flight.turns)
        if not k:
            return self.pick("[make] no turns", "never [turn]", "[walk] straight on without turning", "[make] no turns at all", "[take] neither a left nor a right and never [turn] around",
                             *self.of(brief_summary=["[proceed] without any turns", "[complete] the route without turning"], police=["[make] no change of direction", "[proceed] without turning"], commentator=["[go] straight on, not one turn"], parent=["[go] straight on, with no turns at all"]))
        if k == 1:
            t = turns[0]
            if t == "around":
                return self.pick("[turn] around once", "[make] a single U-turn", "[double] back once", "[reverse] direction once", "[make] one U-turn", *self.of(police=["[execute] one about-turn"], brief_summary=["[execute] a single U-turn"]))
            return self.pick(f"[turn] {t} once", f"[make] a single {t} turn", f"[make] one turn, to the {t}", f"[turn] to the {t} one time", f"[take] one {t} turn", *self.of(police=[f"[execute] one {t} turn"], brief_summary=[f"[execute] a single {t} turn"]))
        if len(set(turns)) == 1:
            t = turns[0]
            if t == "around":
                return self.pick(f"[turn] around {self.times(k)}", f"[make] {self.c(k)} U-turns", f"[double] back {self.times(k)}", f"[reverse] direction {self.times(k)}")
            return self.pick(f"[turn] {t} {self.times(k)}", f"[make] {self.c(k)} {t} turns", f"[turn] {self.times(k)}, each time to the {t}", f"[make] {self.c(k)} turns, all to the {t}")
        runs = []
        for t in turns:
            if runs and runs[-1][0] == t:
                runs[-1][1] += 1
            else:
                runs.append([t, 1])
        grouped = [t if c == 1 else f"{t} {self.times(c)}" for t, c in runs]
        nouns = [self.turn_noun(t) for t in turns]
        return self.pick(
            "[turn] " + self.row(turns),
            "[turn] " + ", then ".join(grouped),
            self.row([self.turn_verb(t) for t in turns]),
            "[make] " + self.row(nouns).replace("first ", "", 1),
            f"[make] {self.c(k)} turns, in this order: " + ", ".join(turns),
            f"[turn] {self.times(k)}: " + self.row(turns),
            f"[make] {self.c(k)} turns ({', '.join(turns)})",
            f"[make] {nouns[0]}, followed by " + ", then ".join(nouns[1:]),
            *self.of(brief_summary=[f"[execute] {self.c(k)} turns in sequence: " + ", ".join(turns), f"[execute] {nouns[0]}, followed by " + ", then ".join(nouns[1:])],
                     police=["[execute] " + self.row(nouns).replace("first ", "", 1), f"[change] direction {self.times(k)}, namely " + self.row(turns)],
                     commentator=["[go] " + ", then ".join(turns)] if "around" not in turns else [])
        )

    def turn_clause(self, flight):
        turns, k, p = flight.turns, len(flight.turns), self.p(flight)
        said = [f"{p} {self.turn_vp(flight)}"] * 5
        if not k:
            return self.pick(*said, "there [are|were] no turns", "the route [have] no turns", "the walk [include] no turns",
                             *self.of(brief_summary=["the route [contain] no turns", "no turns [are|were] made along the route"], translator=["not once [does|did] the walker turn", "the walk [have] not a single turn"], police=["no turns [are|were] observed", "no change of direction [be] observed"],
                                      commentator=["no turns, none at all", "how many turns? None at all"], parent=["how many turns? None at all", "you will not see a single turn"]))
        row = ", then ".join(turns)
        if k == 1:
            one = self.turn_noun(turns[0])
            return self.pick(*said, f"there [be] one turn, {one}", f"the route [include] {one}, the only turn of the walk", f"the only turn [be] {one}",
                             *self.of(police=[f"one turn [be] observed, namely {one}"], commentator=[f"just the one turn, {one}"], parent=[f"how many turns? Just one, {one}"], translator=[f"a single time the walker [turn], and that [be] {one}".replace("[turn], and that [be]", "[make] a turn, namely")], brief_summary=[f"the route [feature] a single turn: {one}"]))
        return self.pick(*said, f"there [are|were] {self.c(k)} turns: {row}", f"the turns, in order, [are|were] {row}", f"the route [include] {self.c(k)} turns, in order {row}",
                         *self.of(police=[f"{self.c(k)} turns [are|were] observed in the following order: {', '.join(turns)}"], commentator=[f"{self.c(k)} turns on this walk, {row}", f"here come the turns: {row}"],
                                  parent=[f"count the turns with me: {row}", f"first comes {self.turn_noun(turns[0])}, then " + ", then ".join(self.turn_noun(t) for t in turns[1:])],
                                  brief_summary=[f"the turn sequence [be] {row}", f"the route [comprise] {self.c(k)} turns: {row}"], translator=[f"the turns [follow] one another in this order: {row}"]))

    # stops
    def stop_vp(self, flight):
        k, t = flight.stops, self.s(flight.standing)
        if not k:
            return self.pick("never [stop]", "[make] no stops", "[take] no pauses", "never [pause]", "[keep] going without a pause", *self.of(brief_summary=["[proceed] without stopping", "[make] no stops at any point"], police=["at no time [stop]"], commentator=["never [stop], not once"], parent=["[keep] going and never [stop]"]))
        if k == 1:
            return self.pick(f"[stop] once, for {t}", f"[pause] once for {t}", f"[make] one stop of {t}", f"[make] a single stop lasting {t}", f"[come] to a halt once, for {t}", f"[stand] still once, for {t}",
                             *self.of(brief_summary=[f"[pause] a single time for {t}"], police=[f"[come] to a standstill once, for {t}"], parent=[f"[take] one little rest of {t}".replace("little rest", "break")], translator=[f"[halt] one single time, for {t}"]))
        return self.pick(f"[stop] {self.times(k)}, for {t} in total", f"[pause] {self.times(k)}, {t} altogether", f"[make] {self.c(k)} stops totalling {t}", f"[make] {self.c(k)} stops, {t} in all", f"[stop] {self.times(k)} for a combined {t}", f"[come] to a halt {self.times(k)}, {t} in total",
                         *self.of(brief_summary=[f"[pause] {self.times(k)} for a cumulative {t}"], police=[f"[come] to a standstill on {self.c(k)} occasions, for a total of {t}"], parent=[f"[take] {self.c(k)} breaks, {t} all together"], translator=[f"[halt] {self.times(k)}, {t} if one adds the halts together"]))

    def stop_clause(self, flight):
        k, t, p = flight.stops, self.s(flight.standing), self.p(flight)
        said = [f"{p} {self.stop_vp(flight)}"] * 4
        if not k:
            return self.pick(*said, "there [are|were] no stops", "the walk [include] no stops", "there [be] not a single pause", *self.of(police=["no stops [are|were] observed", "no halt [be] recorded"], commentator=["no stops at all", "stops? Not one"], parent=["how many stops? None at all"], brief_summary=["no stops [occur] during the walk".replace("[occur]", "[are|were] made")], translator=["of a pause there [be] none"]))
        if k == 1:
            return self.pick(*said, f"there [be] one stop of {t}", f"the only stop [last] {t}", f"a single pause of {t} [interrupt] the walk", *self.of(police=[f"one stop of {t} [be] observed"], commentator=[f"just the one stop, {t} long"], parent=[f"there [be] one stop, and it [last] {t}"], brief_summary=[f"the walk [include] a single stop of {t}"], translator=[f"once the walk [be] interrupted, for {t}"]))
        c = self.c(k)
        return self.pick(*said, f"there [are|were] {c} stops, {t} in total", f"the walk [include] {c} stops totalling {t}", f"the {c} stops together [last|lasted] {t}", *self.of(police=[f"{c} stops totalling {t} [are|were] observed"], commentator=[f"{c} stops, {t} all told"], parent=[f"there [are|were] {c} stops, and all together they [last|lasted] {t}"], brief_summary=[f"{c} stops [account|accounted] for a total of {t} of standing time"], translator=[f"the walk [be] interrupted {self.times(k)}, for {t} in all"]))

    # walk
    def walk_vp(self, flight):
        w, v = self.m(flight.way), self.v(flight)
        return self.pick(f"[walk] {w} at an average speed of {v}", f"[cover] {w} on foot at a mean speed of {v}", f"[walk] a total of {w} at {v}", f"[walk] {w} in all, averaging {v}", f"[cover] a path of {w} at an average walking speed of {v}",
                         *self.of(brief_summary=[f"[proceed] along a path of {w} at an average walking speed of {v}", f"[traverse] {w} on foot at an average of {v}"], police=[f"[proceed] on foot for {w} at an average speed of {v}"], commentator=[f"[put] in {w} of walking at an average of {v}"], parent=[f"[walk] {w}, and the walking speed [be] {v}"], translator=[f"[travel] {w} on foot at an average speed of {v}"]))

    def walk_clause(self, flight):
        w, v, p = self.m(flight.way), self.v(flight), self.p(flight)
        return self.pick(*[f"{p} {self.walk_vp(flight)}"] * 4, f"the walk [be] {w} long, at an average speed of {v}", f"the path walked [measure] {w}, and the average walking speed [be] {v}", f"the length of the walk [be] {w} and the average walking speed {v}",
                         *self.of(brief_summary=[f"the total path length [be] {w}, with an average walking speed of {v}"], police=[f"the distance covered on foot [be] {w}, the average walking speed {v}"], commentator=[f"{w} of walking at an average of {v}"], parent=[f"the whole walk [be] {w} long, at a walking speed of {v}"], translator=[f"the way that {p} [walk] [be] {w} long, and the average speed of the walk [be] {v}"]))

    # time and standing
    def time_clause(self, flight):
        t, x = self.s(flight.duration), self.drone()
        return self.pick(f"the flight [last] {t}", f"the whole flight [take] {t}", f"the duration of the flight [be] {t}", f"the flight [be] over after {t}", f"the flight time [be] {t}",
                         *self.of(brief_summary=[f"total flight duration [be] {t}", f"the recording [span] {t}".replace("[span]", "[last]")], police=[f"the duration of the observation flight [be] {t}", f"the flight [be] concluded after {t}"], commentator=[f"{t} on the clock for this flight", f"the flight clock [stop] at {t}"], parent=[f"the flight [last] {t}, from start to end", f"after {t} the flight [be] over"], translator=[f"from beginning to end, the flight [last] {t}"]))

    def stand_vp(self):
        return self.pick("[stand] still", "[stand] in one place", "[remain] standing on one spot", "[stay] on the same spot without walking", "[remain] stationary", *self.of(brief_summary=["[remain] stationary throughout", "[maintain] a standing position in one place"], police=["[remain] stationary at all times"], commentator=["[stand] on the spot, no walking at all"], parent=["[stand] still and never [walk]"], translator=["[stand] in one and the same place"]))

    def stand_clause(self, flight):
        t, p = self.s(flight.duration), self.p(flight)
        return self.pick(f"{p} {self.stand_vp()} for the whole flight of {t}", f"for all {t} of the flight, {p} {self.stand_vp()}", f"throughout the flight, which [last] {t}, {p} {self.stand_vp()}", f"{p} {self.stand_vp()}; {self.time_clause(flight)}", f"{self.time_clause(flight)}, and {p} {self.stand_vp()} all that time",
                         *self.of(police=[f"during the entire {t} of the flight, {p} {self.stand_vp()}"], parent=[f"{p} {self.stand_vp()}, and that goes on for the {t} of the flight".replace("goes on", "[go] on")]))

    def stand_note(self, flight):
        p = self.p(flight)
        return self.pick(f"{p} stands still throughout", f"{p} does not walk and stands on one spot", f"{p} remains stationary", f"there is no walking; {p} stands in one place",
                         *self.of(brief_summary=[f"note that {p} remains stationary", f"{p} is stationary for the duration of the flight"], police=[f"{p} is stationary and does not walk"], commentator=[f"{p} stands on the spot, no walking here"], parent=[f"{p} is just standing there, not walking", f"{p} will not walk and just stands still"], translator=[f"{p} stands in one place and does not walk"]))

    # instruction
    def verb(self, flight):
        if not flight.walks:
            return self.pick("film", "record", "keep the camera on", "observe", "watch")
        return self.pick("follow", "track", "film", "shadow", "accompany", *self.of(police=["observe", "follow"], parent=["follow"], commentator=["stay with", "track"], brief_summary=["maintain visual tracking of", "keep pace with"]))

    def extras(self, flight):
        out, p = [], self.p(flight)
        if flight.altitude >= 1 and self.rng.random() < .35:
            out.append(self.height_order(flight))
        if self.rng.random() < .2:
            t = self.s(flight.duration)
            out.append(self.pick(f"the flight lasts {t}", f"keep filming for {t}", f"end the flight after {t}", f"the flight should last {t}"))
        if flight.walks:
            if self.rng.random() < .15:
                out.append(self.pick(f"{p} will ", f"expect that {p} will ", f"on the way, {p} will ") + base(self.turn_vp(flight)).replace("never turn", "not turn"))
            if self.rng.random() < .15:
                out.append(f"{p} will " + base(self.stop_vp(flight)).replace("never stop", "not stop").replace("at no time stop", "not stop at any time"))
            if self.rng.random() < .1:
                out.append(self.pick(f"the walk is {self.m(flight.way)} long", f"the average walking speed is {self.v(flight)}"))
        else:
            out.append(self.stand_note(flight))
        self.rng.shuffle(out)
        return out

    def camera_note(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick("level", "horizontal", "level with the horizon", f"{a} tilt")
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        return self.pick(f"{a} {down}ward", f"{a} {below} the horizon", f"tilted {a} {down}", f"pitched {down} {a}")

    def instruction(self, flight):
        self.voice(False)
        who, the, verb = self.who(flight), self.who(flight, "the"), self.verb(flight)
        by, view, d, a = self.distance_by(flight), self.pitch_by(flight), self.distance_order(flight), self.pitch_order(flight)
        extra = self.extras(flight)
        dist, cam = self.m(flight.distance), self.camera_note(flight)
        general = [
            f"{verb} {who} {by}, {view}.",
            f"{verb} {who}. {d}, and {a}.",
            f"{verb} {who}. {a}. {d}.",
            f"{view}, {verb} {who} {by}.",
            f"{d}, {a}, and {verb} {the}.",
        ]
        styled = dict(
            brief=[
                f"objective: {verb} {the}. {d}. {a}.",
                f"mission brief: {verb} {the}. {d} and {a}.",
                f"subject: {who}. Distance to subject: {dist}. Camera: {cam}.",
                f"- {verb} {the}\n- {d}\n- {a}",
                f"1. {verb} {the}\n2. {d}\n3. {a}",
                f"**Subject:** {who}\n**Distance to subject:** {dist}\n**Camera tilt:** {cam}",
                f"your task is to {verb} {the}. To do so, {d} and {a}.",
                f"{verb} {the} while adhering to two parameters: distance to the subject {dist}; camera {cam}.",
                f"primary target: {the}. Required separation: {dist}. Required camera angle: {cam}.",
                f"operational guidance: {d}; {a}; {verb} {the}.",
            ],
            summary=[
                f"please {verb} {the}, ensuring that you {d} and {a}.",
                f"to capture this shot, {verb} {the} {by}, {view}.",
                f"{verb} {the} throughout the flight. As you do so, {d} and {a}.",
                f"the goal is to {verb} {the} {by}. Be sure to {a}.",
                f"{d} while you {verb} {the}. In addition, {a}.",
                f"for optimal framing, {d} and {a} as you {verb} {the}.",
                f"keep {the} in view: {d}, and {a}.",
            ],
            translator=[
                f"may I ask you to {verb} {the} {by}, {view}?",
                f"be so kind as to {verb} {the}. {d}, and {a}.",
                f"it is {the} whom you are to {verb}. {d}; {a}.",
                f"you are requested to {verb} {the} {by}. {a}.",
                f"in doing this work, {d}, and {a}. You are to {verb} {the}.",
                f"the one to {verb} is {the}. {d}. {a}.",
            ],
            police=[
                f"officers are to {verb} {the} {by}, {view}.",
                f"the operator shall {verb} {the}. {d}. {a}.",
                f"surveillance order: {verb} {the}. {d}. {a}.",
                f"unit to {verb} {the}. Distance to be kept: {dist}. Camera: {cam}.",
                f"subject of observation: {the}. {d} and {a}.",
                f"you are instructed to {verb} {the} {by}, {view}.",
                f"description of subject: {who}. Order: {d}; {a}.",
            ],
            commentator=[
                f"all right, pilot, {verb} {the}! {d}, and {a}!",
                f"eyes on {the}! {d} and {a}.",
                f"here is the game plan: {verb} {the} {by}, {view}.",
                f"{the}, that is who we {verb}! {d}, {a}.",
                f"come on, {verb} {the}! {a}! {d}!",
                f"this is the play: {d}, {a}, and {verb} {the}.",
            ],
            parent=[
                f"do you see {the}? {verb} them. {d}, and {a}.",
                f"now listen: {verb} {the}. {d}. And {a}.",
                f"can you {verb} {the} for me? {d}, and {a}.",
                f"okay, sweetheart, {verb} {the}. {d}. Then {a}.",
                f"you may {verb} {the} now. {d}, and {a}.",
                f"look, there is {the}. {d}, and {a}.",
                f"let us {verb} {the}, shall we? {d}, and {a}.",
            ])[self.style]
        text = self.pick(*general, *styled, *styled)
        if text.startswith(("- ", "1. ", "**")):
            if text[0] == "*":
                text += "".join(f"\n**Note:** {it}" for it in extra)
            else:
                text += "".join(f"\n- {it}" if text[0] == "-" else f"\n{at}. {it}" for at, it in enumerate(extra, 4))
        elif extra:
            text += " " + (". ".join(extra) if len(extra) != 2 or self.rng.random() < .6 or ":" in extra[0] else "; ".join(extra)) + "."
        return self.finish(text)

    # description
    def notes(self, flight):
        self.past = False
        bold = self.rng.random() < .4
        name = (lambda text: f"**{text}:** ") if bold else (lambda text: text + ": ")
        items = [
            name(self.pick("Distance to subject", "Drone-to-person distance", "Separation from the person")) + self.m(flight.distance),
            name(self.pick("Camera tilt", "Camera angle", "Camera")) + self.camera_note(flight),
            name(self.pick("Flight duration", "Duration of the flight", "Flight time")) + self.s(flight.duration),
        ]
        if flight.altitude >= 1:
            items.append(name(self.pick("Altitude", "Flying height", "Height above ground")) + self.m(flight.altitude))
        if flight.walks:
            k = flight.stops
            items += [
                name(self.pick("Turns", "Turns in order", "Turn sequence")) + (", ".join(flight.turns) or "none"),
                name(self.pick("Stops", "Pauses")) + ("none" if not k else f"one, {self.s(flight.standing)}" if k == 1 else f"{self.c(k)}, {self.s(flight.standing)} in total"),
                name(self.pick("Length of the walk", "Distance walked", "Path length")) + self.m(flight.way),
                name(self.pick("Average walking speed", "Mean walking speed")) + self.v(flight),
            ]
        else:
            items.append(name(self.pick("Movement", "Activity")) + self.pick("none, the subject stands still", "standing in one place", "the subject stands on one spot throughout"))
        self.rng.shuffle(items)
        items.insert(0, name(self.pick("Subject", "Person")) + self.who(flight))
        style = self.pick("- ", "- ", "* ", "", "; ")
        return "; ".join(items) + "." if style == "; " else "\n".join(style + it for it in items)

    def facts(self, flight, left):
        """Sentences about the facts in `left`."""
        made = dict(distance=self.distance_clause, pitch=self.pitch_clause, height=self.height_clause, turns=self.turn_clause, stops=self.stop_clause, walk=self.walk_clause, time=self.time_clause, stand=self.stand_clause)
        air = [it for it in ("distance", "pitch", "height") if it in left]
        ground = [it for it in ("turns", "stops", "walk", "stand") if it in left]
        self.rng.shuffle(air)
        self.rng.shuffle(ground)
        groups = [air, ground]
        self.rng.shuffle(groups)
        time = ["time"] if "time" in left else []
        order = self.pick(groups[0] + groups[1] + time, time + groups[0] + groups[1], groups[0] + time + groups[1], groups[0] + groups[1] + time)
        out, at = [], 0
        while at < len(order):
            said = made[order[at]](flight)
            if at + 1 < len(order) and self.rng.random() < (.45 if self.style in ("translator", "summary") else .25) and not set(said) & set(":;?"):
                more = made[order[at + 1]](flight)
                if not set(more) & set(":;?"):
                    said += self.pick(", and ", "; ", ", and ") + more
                    at += 1
            out.append(said + ("!" if self.style == "commentator" and self.rng.random() < .25 else "."))
            at += 1
        return " ".join(out)

    def description(self, flight):
        self.voice(True)
        if self.rng.random() < (.35 if self.style == "brief" else .12 if self.style in ("summary", "police") else 0):
            return self.finish(self.notes(flight))
        opener, used = self.walk_opener(flight) if flight.walks else self.stand_opener(flight)
        left = {"distance", "pitch", "turns", "stops", "walk", "time"} if flight.walks else {"distance", "pitch", "stand"}
        if flight.altitude >= 1:
            left.add("height")
        if not flight.walks and "time" in used and "stand" not in used:
            used |= {"stand"}
        left -= used
        text = f"{opener} {self.facts(flight, left)}" if left else opener
        return self.finish(text)

    def filmed(self, flight):
        return self.pick("filmed", "recorded", "observed", *(["followed", "tracked", "followed"] if flight.walks else []))

    def films(self, flight):
        return self.pick("[film]", "[record]", "[observe]", *(["[follow]", "[track]", "[accompany]", "[follow]"] if flight.walks else []))

    def walk_opener(self, flight):
        who, the, films, filmed, x = self.who(flight), self.who(flight, "the"), self.films(flight), self.filmed(flight), self.drone()
        by, view, t = self.distance_by(flight), self.pitch_by(flight), self.s(flight.duration)
        turn, stop, walk = self.turn_vp(flight), self.stop_vp(flight), self.walk_vp(flight)
        dp = {"distance", "pitch"}
        general = [
            (f"{x} {films} {who} {by}, {view}.", dp),
            (f"{who} [be] {filmed} by {x} {by}.", {"distance"}),
            (f"{who} {walk}.", {"walk"}),
            (f"{x} {films} {who}.", set()),
            (f"{the} {walk}. On the way, {self.p(flight)} {turn}.", {"walk", "turns"}),
        ]
        styled = dict(
            brief=[
                (f"overview: {x} {films} {who} {by}, {view}.", dp),
                (f"summary: {the} {walk} and {stop}.", {"walk", "stops"}),
                (f"flight brief: {x} {films} {the} for {t}.", {"time"}),
                (f"key facts: the one filmed [be] {who}.", set()),
                (f"the flight [document] {who}. Along the path, {self.p(flight)} {turn}.", {"turns"}),
            ],
            summary=[
                (f"in this flight of {t}, {x} {films} {who}.", {"time"}),
                (f"the footage [show] {who}, {filmed} {by}.", {"distance"}),
                (f"over {t}, {x} {films} {who} {by}, {view}.", dp | {"time"}),
                (f"the subject [move] on foot and {stop}. {x} {films} {who}.".replace("the subject", the, 1).replace(f"{x} {films} {who}", f"{x} {films} the whole walk"), {"stops"}),
                (f"this {flight.duration}-second flight [follow] {who}.", {"time"}),
                (f"{gerund(walk)}, {the} {turn}.", {"walk", "turns"}),
            ],
            translator=[
                (f"it [be] {who} that {x} {films}.", set()),
                (f"for {t}, {x} {films} {who}, and it [do] so {by}.", {"time", "distance"}),
                (f"the one whom {x} {films} [be] {who}.", set()),
                (f"{the} {walk}, and while doing so {stop}.", {"walk", "stops"}),
                (f"as {the} [walk], {x} [keep] its camera on the scene {view}.".replace("its camera on the scene", "its lens on the walk"), {"pitch"}),
                (f"{view}, {x} {films} {who} {by}.", dp),
            ],
            police=[
                (f"at the time of the flight, {who} [be] {filmed} {by}.", {"distance"}),
                (f"the subject of the observation [be] {who}.", set()),
                (f"{x} {films} {who} for a period of {t}.", {"time"}),
                (f"{the} [be] {filmed} by drone {by}, {view}.", dp),
                (f"report: {the} {turn}. {self.p(flight)} {stop}.", {"turns", "stops"}),
                (f"{the} [be] seen to walk. {self.p(flight)} {turn}.", {"turns"}),
            ],
            commentator=[
                (f"and here we go, {x} {films} {the}!", set()),
                (f"eyes on {the}! {self.p(flight)} {turn}!", {"turns"}),
                (f"what do we have here? {who}, {filmed} {by}!", {"distance"}),
                (f"{the} is off, ladies and gentlemen! {self.p(flight)} {walk}.", {"walk"}),
                (f"that is {the} on your screen, {filmed} {by}, {view}!", dp),
                (f"{the} {turn}, and {stop}!", {"turns", "stops"}),
            ],
            parent=[
                (f"look, {x} {films} {the}!", set()),
                (f"do you see {the}? {x} {films} this person {by}.", {"distance"}),
                (f"see {the}? That is who {x} {films}.", set()),
                (f"watch {the}. {self.p(flight)} {turn}.", {"turns"}),
                (f"this is how it works: {x} {films} {who} {by}, {view}.", dp),
                (f"let me explain: {the} {walk}, and {x} {films} along.".replace(f"{x} {films} along", f"{x} {films} the walk"), {"walk"}),
            ])[self.style]
        return self.pick(*general, *styled, *styled)

    def stand_opener(self, flight):
        who, the, films, filmed, x = self.who(flight), self.who(flight, "the"), self.films(flight), self.filmed(flight), self.drone()
        by, view, t, stand = self.distance_by(flight), self.pitch_by(flight), self.s(flight.duration), self.stand_vp()
        dp = {"distance", "pitch"}
        general = [
            (f"{x} {films} {who} {by}, {view}.", dp),
            (f"{who} [be] {filmed} by {x} {by}.", {"distance"}),
            (f"{x} {films} {who}.", set()),
            (f"for {t}, {the} {stand}.", {"stand"}),
        ]
        styled = dict(
            brief=[
                (f"overview: {x} {films} {who} {by}, {view}.", dp),
                (f"flight brief: over {t}, {the} {stand}.", {"stand"}),
                (f"key facts: the one filmed [be] {who}.", set()),
            ],
            summary=[
                (f"in this flight of {t}, {x} {films} {who}; {self.p(flight)} {stand}.", {"stand"}),
                (f"the footage [show] {who}, {filmed} {by}.", {"distance"}),
                (f"over the {t} of the flight, {the} {stand} while {x} [film] {view}.", {"stand", "pitch"}),
            ],
            translator=[
                (f"it [be] {who} that {x} {films}.", set()),
                (f"for {t}, {x} {films} {who}, and in that time {self.p(flight)} {stand}.", {"stand"}),
                (f"{view}, {x} {films} {who} {by}.", dp),
            ],
            police=[
                (f"the subject of the observation [be] {who}.", set()),
                (f"{the} [be] {filmed} by drone {by}, {view}.", dp),
                (f"for a period of {t}, {the} {stand}.", {"stand"}),
            ],
            commentator=[
                (f"and here we are, {x} {films} {the}!", set()),
                (f"that is {the} on your screen, {filmed} {by}, {view}!", dp),
                (f"{the} {stand} for all {t} of the flight!", {"stand"}),
            ],
            parent=[
                (f"look, {x} {films} {the}!", set()),
                (f"do you see {the}? {x} {films} this person {by}.", {"distance"}),
                (f"watch {the}: for {t}, this person {stand}.", {"stand"}),
            ])[self.style]
        return self.pick(*general, *styled, *styled)

    # wrong texts
    def parts(self, text):
        text = text.rstrip()
        end = text[-1] if text[-1] in ".?!" else ""
        return (text[:-1] if end else text), end

    def foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        body, end = self.parts(text)
        a = an(person)
        choices = [
            f"{text} The person is shown {thing}.",
            f"{text} The person is seen {thing}.",
            f"{text} {a.capitalize()} stands close by.",
            f"{text} The person filmed is {a}.",
            f"{text} {a.capitalize()} comes the other way.",
        ]
        if "\n" not in text:
            choices += [f"{body}, {thing}{end}", f"{body}, {thing}{end}"]
        for noun in ("the subject", "the individual", "the person", "the walker"):
            if noun + " " in text:
                choices += [text.replace(noun + " ", f"the {person} ", 1)] * 2
                break
        return self.pick(*choices)

    def heading(self, text, direction):
        body, end = self.parts(text)
        choices = [
            f"{text} The person walks {direction}.",
            f"{text} The walk leads to the {direction}.",
            f"{text} The direction of travel is {direction}.",
            f"{text} The person is heading {direction}.",
            f"{text} The subject proceeds {direction}.",
            f"{text} The person on foot makes for the {direction}.",
        ]
        if "\n" not in text:
            choices += [f"{body}, heading {direction}{end}", f"{body}, with the person walking {direction}{end}", f"{body}, bound for the {direction}{end}"]
        return self.pick(*choices)


ZH_DIGITS = "零一二三四五六七八九"


def hanzi(n):
    """A whole number in characters, without 两."""
    if n < 10:
        return ZH_DIGITS[n]
    if n < 20:
        return "十" + (ZH_DIGITS[n % 10] if n % 10 else "")
    if n < 100:
        return ZH_DIGITS[n // 10] + "十" + (ZH_DIGITS[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        return ZH_DIGITS[n // 100] + "百" + ("" if not rest else "零" + ZH_DIGITS[rest] if rest < 10 else ("一" if rest < 20 else "") + hanzi(rest))
    return str(n)


class TwentyFourthChinese(Grammar):
    code = "zh"
    styles = ["brief", "summary", "translator", "police", "commentator", "parent"]
    things = [
        "路旁停着一辆货车",
        "身后是一家花店",
        "远处传来消防车的警笛声",
        "手里牵着一只小狗",
        "打着一把透明雨伞",
        "身旁是一条运河",
        "附近有个加油站",
        "脚下是一座木桥",
        "天下着毛毛雨",
        "两边种着白杨树",
        "天刚蒙蒙亮",
        "背后是市政厅",
        "手里拿着冰淇淋",
        "一列火车呼啸而过",
        "周围是一群小学生",
        "当时雾很大",
        "旁边是一堵砖墙",
        "头上戴着棒球帽",
        "耳朵里塞着耳机",
        "天上飘着雪花",
        "正穿过一个游乐场",
        "手里拖着行李箱",
        "一群乌鸦从头顶飞过",
        "湖边风很大",
    ]
    persons = ["邮递员", "外科医生", "老奶奶", "女学生", "消防员", "年轻小伙", "幼儿", "厨师", "老爷爷", "水手", "售货员", "律师", "农民", "新郎"]

    # voice and numbers
    def voice(self):
        self.named = None
        self.style = self.pick(*self.styles)
        self.spelled = self.rng.random() < (.3 if self.style in ("parent", "translator") else .08)
        self.gap = " " if not self.spelled and self.style in ("brief", "summary") and self.rng.random() < .4 else ""
        self.sign = not self.spelled and not self.gap and self.style in ("brief", "summary") and self.rng.random() < .2

    def of(self, **styled):
        return [it for names, choices in styled.items() for it in choices if self.style in names.split("_")] * 2

    def n(self, number, unit):
        if self.spelled:
            return ("两" if number == 2 else hanzi(number)) + unit
        return f"{number}{self.gap}{unit}"

    def m(self, number):
        return self.n(number, "米")

    def s(self, number):
        return self.n(number, "秒" if self.style in ("brief", "summary", "police") else self.pick("秒", "秒", "秒钟"))

    def c(self, number, unit):
        if self.spelled or number < 10 and self.rng.random() < .65:
            return ("两" if number == 2 else hanzi(number)) + unit
        return f"{number}{self.gap}{unit}"

    def deg(self, flight):
        number = abs(flight.pitch)
        return f"{number}°" if self.sign else ("两" if self.spelled and number == 2 else hanzi(number) if self.spelled else f"{number}{self.gap}") + "度"

    def v(self, flight):
        whole, tenth = str(flight.speed).split(".")
        if self.spelled:
            return f"每秒{hanzi(int(whole))}点{hanzi(int(tenth))}米"
        return self.pick(f"每秒{self.gap}{flight.speed}{self.gap}米", f"每秒{self.gap}{flight.speed}{self.gap}米", *self.of(brief_summary_police=[f"{flight.speed}{self.gap}米/秒"]))

    def finish(self, text):
        text = text.strip()
        if self.gap:
            text = re.sub(r"([\u4e00-\u9fff])(\d)", r"\1 \2", text)
            text = re.sub(r"(\d)([\u4e00-\u9fff])", r"\1 \2", text)
        return text

    # the person
    def colour(self, colour):
        return ZH_COLOURS[colour] + "色"

    def who(self, flight, article=None):
        noun = self.pick(*dict(
            brief=["目标", "目标人物"],
            summary=["人", "行人" if flight.walks else "人"],
            translator=["人", "行人" if flight.walks else "人"],
            police=["人员", "行人" if flight.walks else "人员"],
            commentator=["人", "行人" if flight.walks else "人"],
            parent=["人", "人"],
        )[self.style])
        one, that = {"目标": ("", ""), "目标人物": ("", ""), "人": ("一个", "那个"), "行人": ("一名", "那名"), "人员": ("一名", "该名")}[noun]
        a = that if article == "the" else self.pick(one, that)
        if flight.wear is None:
            return (one if article is None else a) + noun
        if a == "该名":
            a = "一名"
        top, legs, pack = flight.wear
        t, l = self.colour(top), self.colour(legs)
        shirt = self.pick("上衣", "上衣", "上衣", "外套")
        trousers = self.pick("裤子", "裤子", "长裤")
        bag = self.pick("背包", "双肩包")
        extra = self.pick(f"、背着{bag}", f"、身背{bag}", "、背双肩包") if pack else self.pick("", "", "", "", "、没背包", "、未背双肩包" if self.style in ("police", "brief") else "")
        return self.pick(
            f"{a}身穿{t}{shirt}、{l}{trousers}{extra}的{noun}",
            f"{a}穿{t}{shirt}和{l}{trousers}{extra}的{noun}",
            f"{a}上身穿{t}{shirt}、下身穿{l}{trousers}{extra}的{noun}",
            f"{a}穿着{t}{shirt}、{l}{trousers}{extra}的{noun}",
            f"{a}上衣{t}、裤子{l}{extra}的{noun}",
            f"{a}身着{t}{shirt}和{l}{trousers}{extra}的{noun}",
            *self.of(
                brief=[f"{noun}（{t}{shirt}，{l}{trousers}{extra.replace('、', '，')}）"],
                police=[f"{a}上穿{t}{shirt}、下穿{l}{trousers}{extra}的{noun}", f"{a}上身着{t}{shirt}、下身着{l}{trousers}{extra}的{noun}"],
                commentator=[f"{a}{t}{shirt}配{l}{trousers}{extra}的{noun}"],
                parent=[f"{a}穿{t}{shirt}、{l}{trousers}{extra}的{noun}"],
                translator=[f"{a}身着{t}{shirt}、下穿{l}{trousers}{extra}的{noun}"]))

    def p(self, flight):
        self.named = self.named or self.pick(*dict(
            brief=["目标", "目标", "目标人物"],
            summary=["此人", "该人物", "目标人物"],
            translator=["此人", "这个人", "那人"],
            police=["该人员", "该人", "此人"],
            commentator=["这个人", "这位" + ("行人" if flight.walks else "主角")],
            parent=["这个人", "那个人"],
        )[self.style])
        return self.named

    # distance
    def distance_clause(self, flight):
        d, p = self.m(flight.distance), self.p(flight)
        return self.pick(
            f"无人机与{p}保持{d}的距离",
            f"无人机距{p}{d}",
            f"无人机离{p}{d}",
            f"无人机与{p}之间的距离为{d}",
            f"无人机和{p}相距{d}",
            *self.of(
                brief=[f"与{p}的间距保持{d}", f"人机间距{d}", f"无人机与目标的间隔维持在{d}"],
                summary=[f"无人机与{p}的直线距离为{d}", f"全程与{p}保持{d}间距", f"拍摄距离为{d}"],
                translator=[f"无人机与{p}之间隔着{d}", f"无人机始终在离{p}{d}的地方"],
                police=[f"无人机与{p}的距离为{d}", f"无人机在距{p}{d}处进行观察"],
                commentator=[f"无人机跟{p}之间隔着{d}", f"咱们的无人机离{p}{d}"],
                parent=[f"无人机离{p}有{d}远", f"从无人机到{p}那儿有{d}"]))

    def distance_order(self, flight):
        d, p = self.m(flight.distance), self.p(flight)
        return self.pick(
            f"与{p}保持{d}的距离",
            f"距离{p}{d}",
            f"和{p}相隔{d}",
            f"将与{p}的距离控制在{d}",
            *self.of(
                brief=[f"与目标保持{d}间距", f"间距维持在{d}", f"人机距离设定为{d}", f"确保无人机距目标{d}"],
                summary=[f"全程与{p}保持{d}的间距", f"将无人机置于距{p}{d}处", f"将拍摄距离保持在{d}"],
                translator=[f"务必使无人机与{p}相距{d}", f"无人机与{p}之间须留出{d}的距离"],
                police=[f"须与{p}保持{d}距离", f"在距{p}{d}处实施观察"],
                commentator=[f"跟{p}拉开{d}", f"咬住{d}的距离"],
                parent=[f"离{p}{d}，不要太近也不要太远".replace("不要太近也不要太远", "别再近也别再远"), f"让无人机离{p}{d}远", f"记住要离{p}{d}"]))

    def distance_by(self, flight):
        """Before the verb of filming."""
        d = self.m(flight.distance)
        return self.pick(f"在{d}外", f"以{d}的距离", f"保持{d}距离", f"隔着{d}", f"在相距{d}处", f"在{d}远处")

    # pitch
    def pitch_clause(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick("镜头保持水平", "镜头平视", "相机水平朝前", "镜头不俯不仰", f"镜头俯仰角为{a}",
                             *self.of(brief_summary=["云台保持水平", "相机维持水平姿态"], translator=["镜头与地平线齐平", "镜头既不上仰，也不下俯"], police=["摄像头处于水平状态", "镜头未作俯仰"], commentator=["镜头端得平平的", "平视视角"], parent=["镜头平平地往前看", "镜头不朝上也不朝下，是平的"]))
        if flight.pitch > 0:
            return self.pick(f"镜头向下倾斜{a}", f"镜头俯角{a}", f"镜头下俯{a}", f"相机朝下{a}", f"镜头低于水平线{a}",
                             *self.of(brief_summary=[f"云台俯角为{a}", f"相机俯角维持在{a}", f"镜头视线位于地平线以下{a}"], translator=[f"镜头自水平线向下倾{a}", f"镜头以{a}的俯角对着画面".replace("对着画面", "拍摄")], police=[f"摄像头下倾{a}", f"拍摄俯角为{a}"], commentator=[f"镜头往下压了{a}", f"{a}俯拍视角"], parent=[f"镜头朝下歪{a}".replace("歪", "斜着"), f"镜头往下低了{a}"]))
        return self.pick(f"镜头向上倾斜{a}", f"镜头仰角{a}", f"镜头上仰{a}", f"相机朝上{a}", f"镜头高于水平线{a}",
                         *self.of(brief_summary=[f"云台仰角为{a}", f"相机仰角维持在{a}", f"镜头视线位于地平线以上{a}"], translator=[f"镜头自水平线向上仰{a}", f"镜头以{a}的仰角拍摄"], police=[f"摄像头上仰{a}", f"拍摄仰角为{a}"], commentator=[f"镜头往上抬了{a}", f"{a}仰拍视角"], parent=[f"镜头朝上斜着{a}", f"镜头往上抬了{a}"]))

    def pitch_order(self, flight):
        a = self.deg(flight)
        if flight.pitch == 0:
            return self.pick("镜头保持水平", "镜头放平", "采用平视角度", "镜头不要俯也不要仰", *self.of(brief_summary=["云台保持水平", f"俯仰角设为{a}"], translator=["镜头须与地平线齐平"], police=["摄像头保持水平"], commentator=["镜头端平"], parent=["镜头要放得平平的", "让镜头平平地往前看"]))
        if flight.pitch > 0:
            return self.pick(f"镜头向下倾斜{a}", f"镜头下压{a}", f"俯角保持{a}", f"相机朝下{a}", *self.of(brief_summary=[f"云台俯角设为{a}", f"将俯角维持在{a}", f"确保镜头指向地平线以下{a}"], translator=[f"镜头须向下倾斜{a}"], police=[f"摄像头下倾{a}", f"拍摄俯角设为{a}"], commentator=[f"镜头往下压{a}"], parent=[f"把镜头往下低{a}", f"让镜头朝下{a}"]))
        return self.pick(f"镜头向上倾斜{a}", f"镜头上抬{a}", f"仰角保持{a}", f"相机朝上{a}", *self.of(brief_summary=[f"云台仰角设为{a}", f"将仰角维持在{a}", f"确保镜头指向地平线以上{a}"], translator=[f"镜头须向上仰{a}"], police=[f"摄像头上仰{a}", f"拍摄仰角设为{a}"], commentator=[f"镜头往上抬{a}"], parent=[f"把镜头往上抬{a}", f"让镜头朝上{a}"]))

    # height
    def height_clause(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"无人机飞行高度{h}", f"飞行高度为{h}", f"无人机离地{h}", f"无人机离地面{h}高", *self.of(brief_summary=[f"飞行高度维持在{h}", f"离地高度{h}"], translator=[f"无人机飞在离地{h}的空中", f"无人机高出地面{h}"], police=[f"无人机离地高度为{h}"], commentator=[f"无人机飞在{h}的高度"], parent=[f"无人机飞得有{h}高", f"从地面到无人机有{h}高"]))

    def height_order(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"飞行高度保持{h}", f"飞在离地{h}的高度", f"离地{h}飞行", *self.of(brief_summary=[f"飞行高度设定为{h}"], police=[f"飞行高度控制在{h}"], commentator=[f"高度就定在{h}"], parent=[f"让无人机飞{h}高"]))

    # turns
    def turn(self, turn):
        if turn == "around":
            return self.back
        z = dict(left="左", right="右")[turn]
        return z.join(self.turning)

    def turns(self, flight):
        """A predicate of the person."""
        turns, k = flight.turns, len(flight.turns)
        if not k:
            return self.pick("没有转弯", "全程没有转弯", "一次也没有转弯", "没有转弯，也没有掉头", *self.of(brief_summary=["全程未转向", "途中未作任何转向"], translator=["一路上不曾转弯", "自始至终未曾转弯"], police=["未转弯", "途中未改变方向"], commentator=["一个弯都没拐", "一个弯也没转"], parent=["一个弯也没拐", "一个弯都没有转"]))
        z = dict(left="左", right="右", around="掉头")
        if k == 1:
            if turns[0] == "around":
                return self.pick("掉头一次", "途中掉头一次", "掉了一次头", *self.of(brief_summary=["执行一次掉头"], translator=["折返了一次"], police=["中途折返一次"], commentator=["来了一次掉头"], parent=["只掉了一次头"]))
            side = z[turns[0]]
            return self.pick(f"{side}转一次", f"途中向{side}转弯一次", f"向{side}转了一次弯", f"只向{side}转过一次", *self.of(brief_summary=[f"完成一次{side}转"], translator=[f"曾向{side}转弯一次"], police=[f"在途中{side}转一次"], commentator=[f"来了一个{side}转"], parent=[f"往{side}拐了一个弯"]))
        if len(set(turns)) == 1:
            times = self.c(k, "次")
            if turns[0] == "around":
                return self.pick(f"掉头{times}", f"先后掉头{times}", f"掉了{times}头", f"折返{times}")
            side = z[turns[0]]
            return self.pick(f"{side}转{times}", f"先后{times}向{side}转弯", f"向{side}转了{times}弯", f"转弯{times}，都是向{side}", *self.of(parent=[f"往{side}拐了{self.c(k, '个')}弯"], commentator=[f"连着{times}{side}转"]))
        plain = [dict(left="左转", right="右转", around="掉头")[t] for t in turns]
        short = [z[t] for t in turns]
        self.turning = self.pick(("", "转"), ("", "转"), ("向", "转"), *self.of(parent=[("往", "拐")], commentator=[("", "拐")], translator=[("向", "拐")]))
        self.back = self.pick("掉头", "掉头", "折返") if self.style != "parent" else "掉头"
        steps = [self.turn(t) for t in turns]
        runs = []
        for t, name in zip(turns, plain):
            if runs and runs[-1][0] == name:
                runs[-1][1] += 1
            else:
                runs.append([name, 1])
        grouped = [name if c == 1 else name + self.c(c, "次") for name, c in runs]
        times = self.c(k, "次")
        last = f"先{steps[0]}，" + "".join(f"再{x}，" for x in steps[1:-1]) + f"最后{steps[-1]}" if k > 2 else f"先{steps[0]}，后{steps[1]}"
        return self.pick(
            "依次" + "、".join(plain),
            "先" + "，再".join(steps),
            last,
            f"转向{times}，依次为{'、'.join(plain)}",
            f"先{'，然后'.join(grouped)}",
            "先后" + "、".join(plain),
            *self.of(
                brief_summary=[f"共转向{times}，顺序为{'、'.join(short)}", f"依次完成{'、'.join(plain)}", f"执行{times}转向：{'、'.join(plain)}"],
                translator=["先" + steps[0] + "，继而" + "，继而".join(steps[1:]), f"方向改变{times}，先后是{'、'.join(plain)}"],
                police=[f"先后{times}改变方向，依次为{'、'.join(plain)}", f"共改变方向{times}：{'、'.join(plain)}"],
                commentator=[f"一共转向{times}，{'，'.join(plain)}", "先" + steps[0] + "，接着" + "，接着".join(steps[1:])],
                parent=["先" + steps[0] + "，然后" + "，然后".join(steps[1:]), f"一共改变了{times}方向，{'、'.join(plain)}"]))

    # stops
    def stops(self, flight):
        k, t = flight.stops, self.s(flight.standing)
        if not k:
            return self.pick("中途没有停留", "一次也没有停", "没有停下来过", "全程没有停顿", *self.of(brief_summary=["途中无停留", "全程未停顿"], translator=["一路上不曾停步", "从未驻足"], police=["途中未停留", "未作停留"], commentator=["一步没停", "中间一次都没停"], parent=["一次都没有停下来", "中间没停过"]))
        if k == 1:
            return self.pick(f"中途停留一次，共{t}", f"停了一次，停了{t}", f"停下一次，时长{t}", f"停顿一次，持续{t}", *self.of(brief_summary=[f"期间停留一次，时长{t}"], translator=[f"曾停步一次，历时{t}", f"驻足一次，为时{t}"], police=[f"途中停留一次，时长{t}"], commentator=[f"中间停了一次，{t}"], parent=[f"停下来一次，站了{t}", f"只停了一次，停了{t}"]))
        c = self.c(k, "次")
        return self.pick(f"中途停留{c}，共{t}", f"停了{c}，一共停了{t}", f"停下{c}，合计{t}", f"停顿{c}，累计{t}", *self.of(brief_summary=[f"期间停留{c}，累计时长{t}"], translator=[f"先后停步{c}，前后合计{t}", f"驻足{c}，总共{t}"], police=[f"途中停留{c}，累计{t}"], commentator=[f"中间停了{c}，加起来{t}"], parent=[f"停下来{c}，加在一起站了{t}", f"停了{c}，加起来是{t}"]))

    # walk, time, standing
    def walk(self, flight):
        """A predicate of the person with length and speed."""
        w, v = self.m(flight.way), self.v(flight)
        return self.pick(f"步行{w}，平均速度{v}", f"一共走了{w}，平均速度{v}", f"走了{w}，平均步速{v}", f"以平均{v}的速度走了{w}", *self.of(brief_summary=[f"步行路程{w}，平均步速{v}", f"沿路线步行{w}，平均速度为{v}"], translator=[f"共行走{w}，平均速度为{v}", f"以{v}的平均速度步行{w}"], police=[f"步行{w}，平均步行速度为{v}"], commentator=[f"走出了{w}，平均速度{v}"], parent=[f"一共走了{w}的路，走路的速度是{v}"]))

    def time(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"飞行历时{t}", f"整段飞行持续{t}", f"飞行时长{t}", f"飞行共{t}", *self.of(brief_summary=[f"飞行总时长{t}", f"飞行时长为{t}"], translator=[f"整个飞行历时{t}", f"飞行自始至终共{t}"], police=[f"飞行持续时间为{t}"], commentator=[f"这趟飞行总共{t}", f"全场飞行用时{t}".replace("全场", "全程")], parent=[f"无人机一共飞了{t}", f"这次飞行一共{t}"]))

    def stand(self):
        return self.pick("站在原地不动", "一直站在原地", "站着没有走动", *self.of(brief_summary=["保持静止站立", "原地站立，未移动"], translator=["始终站在同一个地方", "伫立原地，未曾走动"], police=["始终站立于原地", "未走动，一直站在原地"], commentator=["就站在原地，一步没走", "站定了没走"], parent=["一直站着，没有走路", "站在那里，一步也没走"]))

    def stand_note(self, flight):
        p = self.p(flight)
        return self.pick(f"{p}站在原地不动", f"{p}一直站着，不走动", *self.of(brief_summary=[f"{p}保持静止站立"], translator=[f"{p}始终站在同一个地方"], police=[f"{p}未走动，站在原地"], commentator=[f"{p}就站在原地，不走"], parent=[f"{p}不走路，一直站着"]))

    # instruction
    def verb(self, flight):
        if not flight.walks:
            return self.pick("拍摄", "观察", "对准", *self.of(parent=["拍", "看住"][:1], commentator=["拍"]))
        return self.pick("跟拍", "跟随", *self.of(brief_summary=["跟踪拍摄", "持续跟踪"], translator=["跟随拍摄"], police=["跟踪观察", "跟踪拍摄"], commentator=["跟住", "盯住"], parent=["跟着", "跟着拍"]))

    def angle(self, flight):
        return "平视" if flight.pitch == 0 else ("俯角" if flight.pitch > 0 else "仰角") + self.deg(flight)

    def extras(self, flight):
        out = []
        if flight.altitude >= 1 and self.rng.random() < .35:
            out.append(self.height_order(flight))
        if self.rng.random() < .2:
            t = self.s(flight.duration)
            out.append(self.pick(f"飞行时长{t}", f"整段飞行{t}", f"飞满{t}结束"))
        if flight.walks:
            plain = [dict(left="左转", right="右转", around="掉头")[t] for t in flight.turns]
            p = self.p(flight)
            if self.rng.random() < .15:
                out.append(f"{p}途中不会转弯" if not plain else f"{p}途中会{plain[0]}一次" if len(plain) == 1 else self.pick(f"{p}会依次{'、'.join(plain)}", f"{p}会先{'，再'.join(plain)}"))
            if self.rng.random() < .15:
                t = self.s(flight.standing)
                out.append(f"{p}中途不会停" if not flight.stops else f"{p}会停一次，停{t}" if flight.stops == 1 else f"{p}会停{self.c(flight.stops, '次')}，合计{t}")
            if self.rng.random() < .1:
                out.append(self.pick(f"步行路程{self.m(flight.way)}", f"平均步速{self.v(flight)}"))
        else:
            out.append(self.stand_note(flight))
        self.rng.shuffle(out)
        return out

    def instruction(self, flight):
        self.voice()
        who, the, verb, by = self.who(flight), self.who(flight, "the"), self.verb(flight), self.distance_by(flight)
        d, a, view = self.distance_order(flight), self.pitch_order(flight), self.pitch_clause(flight)
        dist, angle, extra = self.m(flight.distance), self.angle(flight), self.extras(flight)
        general = [
            f"请{verb}{who}，{d}，{a}。",
            f"{verb}{who}，{d}，{a}。",
            f"{d}，{a}，{verb}{the}。",
            f"请{by}{verb}{who}，{a}。",
        ]
        styled = dict(
            brief=[
                f"任务：{verb}{the}。要求：{d}；{a}。",
                f"任务目标：{verb}{the}。{d}，{a}。",
                f"拍摄对象：{the}；与对象的距离：{dist}；镜头角度：{angle}。",
                f"- {verb}{the}\n- {d}\n- {a}",
                f"1. {verb}{the}\n2. {d}\n3. {a}",
                f"**对象**：{the}\n**拍摄距离**：{dist}\n**镜头角度**：{angle}",
                f"执行以下任务：{verb}{the}，{d}，{a}。",
                f"参数设定如下：距目标{dist}，镜头{angle}。{verb}{the}。",
            ],
            summary=[
                f"请在飞行过程中{verb}{the}，{d}，同时{a}。",
                f"本次拍摄需{verb}{the}。请{d}，并确保{view}。",
                f"为获得理想画面，请{d}，{a}，{verb}{the}。",
                f"请{verb}{the}，全程{a}。此外，{d}。",
                f"请始终将{the}置于画面中，{d}，{a}。",
            ],
            translator=[
                f"请您{verb}{the}，并{d}。{a}。",
                f"您要{verb}的是{the}。{d}，{a}。",
                f"烦请{by}{verb}{the}，{a}。",
                f"劳驾{verb}{the}；{d}，{a}。",
            ],
            police=[
                f"指令：{verb}{the}，{d}，{a}。",
                f"请警用无人机操作员{verb}{the}。{d}，{a}。".replace("警用无人机操作员", "操作员"),
                f"观察对象为{the}。{d}，{a}。",
                f"现要求：{by}{verb}{the}，{a}。",
                f"对象特征：{the}。与对象的距离：{dist}。镜头：{angle}。请{verb}该对象。",
            ],
            commentator=[
                f"好，{verb}{the}！{d}，{a}！",
                f"各位看好了，{verb}{the}，{d}，{a}！",
                f"飞手请注意，{verb}{the}！{a}，{d}！",
                f"这一局的打法是：{d}，{a}，{verb}{the}。".replace("这一局的打法", "咱们的打法"),
            ],
            parent=[
                f"宝贝，你看见{the}了吗？{verb}{self.p(flight)}，{d}，{a}。",
                f"来，咱们{verb}{the}吧。{d}，{a}。",
                f"乖，{verb}{the}，{d}，再把角度调好：{a}。",
                f"听好了，{verb}{the}。{d}，{a}，好不好？",
                f"你来{verb}{the}，好吗？{d}，{a}。",
            ])[self.style]
        text = self.pick(*general, *styled, *styled)
        if text.startswith(("- ", "1. ", "**")):
            text += "".join("\n" + (f"**备注**：{it}" if text[0] == "*" else f"- {it}" if text[0] == "-" else f"{at}. {it}") for at, it in enumerate(extra, 4))
        elif extra:
            text += self.pick("，", "；", "。").join(extra) + "。"
        return self.finish(text)

    # description
    def notes(self, flight):
        bold = self.rng.random() < .35
        name = (lambda text: f"**{text}**：") if bold else (lambda text: text + "：")
        items = [
            name(self.pick("拍摄距离", "人机距离", "与人物的距离")) + self.m(flight.distance),
            name(self.pick("镜头角度", "相机角度", "镜头")) + self.angle(flight),
            name(self.pick("飞行时长", "飞行总时长")) + self.s(flight.duration),
        ]
        if flight.altitude >= 1:
            items.append(name(self.pick("飞行高度", "离地高度")) + self.m(flight.altitude))
        if flight.walks:
            plain = [dict(left="左转", right="右转", around="掉头")[t] for t in flight.turns]
            items += [
                name(self.pick("转向", "转向顺序", "依次转向")) + ("、".join(plain) or "无"),
                name(self.pick("停留", "停顿")) + (f"{self.c(flight.stops, '次')}，共{self.s(flight.standing)}" if flight.stops else "无"),
                name(self.pick("步行路程", "行走距离")) + self.m(flight.way),
                name(self.pick("平均步速", "平均步行速度")) + self.v(flight),
            ]
        else:
            items.append(name(self.pick("动作", "状态")) + self.pick("原地站立，没有走动", "站在原地不动", "一直站着"))
        self.rng.shuffle(items)
        items.insert(0, name(self.pick("人物", "对象", "拍摄对象")) + self.who(flight))
        style = self.pick("- ", "- ", "", "；")
        return "；".join(items) + "。" if style == "；" else "\n".join(style + it for it in items)

    def facts(self, flight, left):
        p = lambda: self.p(flight)
        made = dict(distance=self.distance_clause, pitch=self.pitch_clause, height=self.height_clause, time=self.time,
                    turns=lambda f: p() + self.turns(f), stops=lambda f: p() + self.stops(f), walk=lambda f: p() + self.walk(f),
                    stand=lambda f: self.pick(f"{p()}{self.stand()}，{self.time(f)}", f"在{self.s(f.duration)}的飞行中，{p()}{self.stand()}", f"{self.time(f)}，其间{p()}{self.stand()}"))
        air = [it for it in ("distance", "pitch", "height") if it in left]
        ground = [it for it in ("turns", "stops", "walk", "stand") if it in left]
        self.rng.shuffle(air)
        self.rng.shuffle(ground)
        bare = dict(turns=self.turns, stops=self.stops, walk=self.walk)

        def air_text():
            return self.pick("，", "，", "；").join(made[it](flight) for it in air) + "。" if air else ""

        def ground_text():
            if not ground:
                return ""
            if self.rng.random() < .5 and "stand" not in ground:
                return p() + self.pick("；", "；", "，").join(bare[it](flight) for it in ground) + "。"
            return "".join(made[it](flight) + ("！" if self.style == "commentator" and self.rng.random() < .25 else "。") for it in ground)

        time = self.time(flight) + "。" if "time" in left else ""
        return self.pick(air_text() + ground_text() + time, ground_text() + air_text() + time, time + ground_text() + air_text(), ground_text() + time + air_text(), air_text() + time + ground_text())

    def description(self, flight):
        self.voice()
        if self.rng.random() < (.35 if self.style == "brief" else .12 if self.style in ("summary", "police") else 0):
            return self.finish(self.notes(flight))
        opener, used = self.walk_opener(flight) if flight.walks else self.stand_opener(flight)
        left = {"distance", "pitch", "turns", "stops", "walk", "time"} if flight.walks else {"distance", "pitch", "stand"}
        if flight.altitude >= 1:
            left.add("height")
        left -= used
        return self.finish(opener + (self.facts(flight, left) if left else ""))

    def walk_opener(self, flight):
        who, the, by, view, t = self.who(flight), self.who(flight, "the"), self.distance_by(flight), self.pitch_clause(flight), self.s(flight.duration)
        turns, stops, walk, p = self.turns(flight), self.stops(flight), self.walk(flight), self.p(flight)
        film = self.pick("跟拍", "跟拍", "跟随拍摄", "拍摄")
        dp = {"distance", "pitch"}
        general = [
            (f"无人机{by}{film}{who}，{view}。", dp),
            (f"{who}{walk}。", {"walk"}),
            (f"{who}{turns}；{stops}。", {"turns", "stops"}),
            (f"无人机{film}{who}。", set()),
        ]
        styled = dict(
            brief=[
                (f"概述：无人机{by}{film}{who}，{view}。", dp),
                (f"飞行简报：{who}{walk}；{stops}。", {"walk", "stops"}),
                (f"任务摘要：无人机{film}{who}，历时{t}。", {"time"}),
                (f"要点如下：拍摄对象为{the}；{p}{turns}。" if flight.wear else f"要点如下：{p}{turns}。", {"turns"}),
            ],
            summary=[
                (f"在这段{t}的飞行中，无人机{film}{who}。", {"time"}),
                (f"画面呈现的是{who}，无人机{by}拍摄，{view}。", dp),
                (f"本段飞行记录了{who}的步行过程，{p}{turns}。", {"turns"}),
                (f"{t}内，无人机{by}{film}{who}。", {"time", "distance"}),
                (f"{view}，无人机{by}{film}{who}。", dp),
            ],
            translator=[
                (f"无人机所{film}的，是{who}。", set()),
                (f"在历时{t}的飞行中，无人机{by}{film}{who}。", {"time", "distance"}),
                (f"{who}{walk}；行走途中，{p}{stops}。", {"walk", "stops"}),
                (f"{who}{turns}，无人机则{by}{film}，{view}。", {"turns"} | dp),
            ],
            police=[
                (f"经无人机观察，{who}{turns}。", {"turns"}),
                (f"观察对象为{who}。", set()),
                (f"飞行期间，无人机{by}对{who}进行拍摄，{view}。", dp),
                (f"据航拍记录，{who}{walk}，{stops}。", {"walk", "stops"}),
                (f"无人机对{who}进行了{t}的拍摄。", {"time"}),
            ],
            commentator=[
                (f"来了来了，镜头里是{who}！", set()),
                (f"各位观众，无人机正{by}{film}{who}，{view}！", dp),
                (f"看，{who}{turns}！", {"turns"}),
                (f"大家请看{the}，{walk}！", {"walk"}),
                (f"好，咱们的无人机{by}{film}{who}！", {"distance"}),
            ],
            parent=[
                (f"宝贝你看，无人机在拍{who}呢。", set()),
                (f"看到{the}了吗？无人机{by}拍{self.p(flight)}呢。", {"distance"}),
                (f"爸爸告诉你，{the}{turns}。", {"turns"}),
                (f"妈妈跟你说，{the}{walk}。", {"walk"}),
                (f"你看{the}，{stops}。", {"stops"}),
                (f"无人机是这样拍的：{by}{film}{the}，{view}。", dp),
            ])[self.style]
        return self.pick(*general, *styled, *styled)

    def stand_opener(self, flight):
        who, the, by, view, t = self.who(flight), self.who(flight, "the"), self.distance_by(flight), self.pitch_clause(flight), self.s(flight.duration)
        stand, p, film = self.stand(), self.p(flight), self.pick("拍摄", "拍摄", "观察")
        dp = {"distance", "pitch"}
        general = [
            (f"无人机{by}{film}{who}，{view}。", dp),
            (f"在{t}的飞行中，{who}{stand}。", {"stand"}),
            (f"无人机{film}{who}。", set()),
            (f"{who}{stand}，{self.time(flight)}。", {"stand"}),
        ]
        styled = dict(
            brief=[(f"概述：无人机{by}{film}{who}，{view}。", dp), (f"飞行简报：{who}{stand}，飞行时长{t}。", {"stand"})],
            summary=[(f"画面呈现的是{who}，无人机{by}拍摄，{view}。", dp), (f"在这段{t}的飞行中，{who}{stand}。", {"stand"})],
            translator=[(f"无人机所{film}的，是{who}。", set()), (f"飞行历时{t}，其间{who}{stand}。", {"stand"})],
            police=[(f"观察对象为{who}。", set()), (f"经无人机观察，{who}在{t}的飞行期间{stand}。", {"stand"})],
            commentator=[(f"各位观众，镜头里是{who}！", set()), (f"看，{who}{stand}，飞行一共{t}！", {"stand"})],
            parent=[(f"宝贝你看，无人机在拍{who}呢。", set()), (f"看到{the}了吗？无人机飞了{t}，{p}{stand}。", {"stand"})])[self.style]
        return self.pick(*general, *styled, *styled)

    # wrong texts
    def foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        body, end = (text[:-1], text[-1]) if text[-1] in "。！？" else (text, "")
        choices = [f"{body}。画面里，{thing}。", f"{body}。旁边站着一位{person}。", f"{body}。被拍的人是一位{person}。", f"{body}。对面走来一位{person}。"]
        if "\n" not in text:
            choices += [f"{body}，{thing}{end}"] * 3
        return self.pick(*choices)

    def heading(self, text, direction):
        z = ZH_DIRECTIONS[direction]
        body = text[:-1] if text[-1] in "。！？" else text
        side = z + ("面" if len(z) == 1 else "方向")
        return self.pick(f"{body}。此人往{z}走。", f"{body}。行进方向为{z}。", f"{body}，朝{side}走去。", f"{body}。步行方向是向{z}。", f"{body}。这个人一路向{z}走。", f"{body}。人是朝着{side}去的。", f"{body}。目标向{z}行进。")
