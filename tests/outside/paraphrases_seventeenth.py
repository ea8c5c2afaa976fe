"""The seventeenth grammar for check_text_judge.py: British and Indian researchers' logs and mission briefs, engineers' task sheets, plain storytelling. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an      # ZH_COLOURS["red"] == "红"; ZH_DIRECTIONS["north"] == "北"; an("orange") == "an orange"; Grammar gives self.pick(a, b, ...), self.rng

ONES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "_ _ twenty thirty forty fifty sixty seventy eighty ninety".split()
ORDINALS = "first second third fourth fifth sixth seventh eighth ninth tenth eleventh twelfth".split()


def spell(n):
    if n < 20: return ONES[n]
    if n < 100: return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000: return ONES[n // 100] + " hundred" + (" and " + spell(n % 100) if n % 100 else "")
    return spell(n // 1000) + " thousand" + ((" and " if n % 1000 < 100 else " ") + spell(n % 1000) if n % 1000 else "")


def cap(text): return text[:1].upper() + text[1:]


def sentences(*clauses): return " ".join(cap(c) + ("" if c[-1] in ".?!:" else ".") for c in clauses if c)


def listing(items, word="and"):
    items = [i for i in items if i]
    return items[0] if len(items) == 1 else ", ".join(items[:-1]) + f" {word} " + items[-1]


def runs(turns):
    found = []
    for t in turns:
        if found and found[-1][0] == t: found[-1][1] += 1
        else: found.append([t, 1])
    return found


class SeventeenthEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "with heavy rain falling", "between two rows of market stalls", "past a red letterbox", "accompanied by a small terrier",
              "in dense morning fog", "under a railway viaduct", "next to a parked autorickshaw", "amid the evening traffic", "with a cyclist riding alongside",
              "while church bells are ringing", "alongside a canal", "on a cobbled lane", "in front of a temple gate", "with an umbrella held open",
              "in strong gusts of wind", "with a child at their side", "near a bus shelter", "shortly after sunset", "through a school playground",
              "carrying a bag of mangoes", "with a mobile telephone at the ear", "in the shade of a banyan tree", "close to a police van", "across a stone bridge"]
    persons = ["nurse", "fisherman", "postman", "schoolgirl", "retired colonel", "bus conductor", "widow", "bricklayer", "policewoman", "tea seller", "surgeon", "teenage boy"]

    # ---- one text's habits

    def begin(self, f):
        self.spelled = self.pick(True, False, False, False, False, False)
        self.long = self.spelled or self.pick(True, False)
        self.sign = self.pick("°", " degrees") if not self.long else " degrees"
        nouns = ["subject", "subject", "person", "person", "target", "individual", "participant"]
        self.noun = self.pick(*nouns, *(["walker", "pedestrian", "walking person"] if f.walks else []))
        self.s = "the " + self.noun
        self.d = "the " + self.pick("drone", "drone", "aircraft", "UAV", "camera drone", "platform", "unmanned aircraft")
        self.habit = self.pick(0, 1, 2, 3)      # one way of saying "left turn" and "turn left" in one text
        self.feet = self.pick("the subject's feet" if self.noun == "subject" else "the person's feet", f"{self.s}'s feet", "their feet")

    def num(self, n): return spell(n) if self.spelled else str(n)
    def few(self, n): return spell(n) if n < 10 or self.spelled else str(n)
    def times(self, n): return {1: "once", 2: "twice"}.get(n) or f"{self.few(n)} times"
    def m(self, n): return f"{self.num(n)} " + (("metre" if n == 1 else "metres") if self.long else "m")
    def sec(self, n): return f"{self.num(n)} " + (("second" if n == 1 else "seconds") if self.long else "s")
    def deg(self, n):
        n = abs(n)
        return f"{n}°" if self.sign == "°" else f"{self.num(n)} degree{'' if n == 1 else 's'}"
    def mps(self, x):
        if self.spelled:
            whole, part = f"{x:.1f}".split(".")
            return f"{spell(int(whole))} point {spell(int(part))} metres per second"
        return f"{x:.1f} " + (self.pick("metres per second", "metres a second") if self.long else "m/s")
    def art(self, n): return ("an " if str(n)[0] == "8" or n in (11, 18) else "a ")
    def order(self, items):
        items, out = list(items), []
        while items:
            one = self.pick(*items); items.remove(one); out.append(one)
        return out

    # ---- the person

    def bag(self): return self.pick("backpack", "backpack", "rucksack")

    def kit(self, f):
        """red top, black trousers, backpack"""
        top, legs, pack = f.wear
        low = self.pick("trousers", "trousers", "legwear")
        items = self.order([f"{top} top", f"{legs} {low}"]) if self.pick(0, 0, 1) else [f"{top} {self.pick('top', 'upper garment')}", f"{legs} {low}"]
        if pack: items.append(self.bag())
        elif self.pick(0, 0, 1): items.append("no backpack")
        return items

    def clothes(self, f):
        """A phrase after the noun, without a comma at its end; empty when unknown."""
        if not f.wear: return ""
        top, legs, pack = f.wear
        bag = an(self.bag())
        forms = [f"in {an(top)} top and {legs} trousers" + (f" with {bag}" if pack else ""),
                 f"wearing {listing([an(top) + ' top', legs + ' trousers', bag if pack else ''])}",
                 f"({', '.join(self.kit(f))})",
                 f"dressed in {top} above the waist and {legs} below it" + (f" and carrying {bag}" if pack else ""),
                 f"whose top is {top} and whose trousers are {legs}" + (f" and who has {bag}" if pack else ""),
                 f"with {listing([an(top) + ' top', legs + ' trousers', bag if pack else ''])}",
                 f"clad in {legs} trousers and {an(top)} top" + (f" and equipped with {bag}" if pack else ""),
                 f"in {legs} trousers and {an(top)} top" + (f" who bears {bag}" if pack else ""),
                 f"attired in {an(top)} upper garment and {legs} trousers" + (f" with {bag} on the back" if pack else ""),
                 f"who wears {an(top)} top over {legs} trousers" + (f" along with {bag}" if pack else ""),
                 f"identifiable by {listing(['the ' + top + ' top', 'the ' + legs + ' trousers', 'the ' + bag.split()[-1] if pack else ''])}"]
        if pack: forms += [f"carrying {bag} and dressed in {an(top)} top with {legs} trousers", f"with {bag} over {an(top)} top and with {legs} trousers"]
        else: forms += [f"in {an(top)} top and {legs} trousers and without a backpack"]
        if top == legs: forms += [f"whose top and trousers are both {top}" + (f" and who carries {bag}" if pack else ""), f"in a matching {top} top and trousers" + (f" with {bag}" if pack else "")]
        return self.pick(*forms)

    def who(self, f, article="the"):
        c = self.clothes(f)
        return " ".join(x for x in (an(self.noun) if article == "a" else self.s, c) if x)

    def ident(self, f, be="is"):
        """A sentence of its own on the clothes, or nothing."""
        if not f.wear: return ""
        top, legs, pack = f.wear
        bag, was = an(self.bag()), be == "was"
        have = "had" if was else "has"
        k = listing([an(top) + " top", legs + " trousers", bag if pack else ""])
        return self.pick(f"{self.s} {be} dressed in {an(top)} top and {legs} trousers" + (f" and {'carried' if was else 'carries'} {bag}" if pack else ""),
                         f"{k} {'were' if was else 'are'} worn by {self.s}",
                         f"identification of {self.s}: {', '.join(self.kit(f))}",
                         f"the top {be} {top}, the trousers {'were' if was else 'are'} {legs}" + (f", and there {be} {bag}" if pack else ""),
                         f"{self.s} {have} {an(top)} top on, and {legs} trousers" + (f", and {bag} besides" if pack else ""),
                         f"{self.s} {'wore' if was else 'wears'} {k}",
                         f"{self.s} {'could' if was else 'can'} be recognised by {k}",
                         f"as to clothing, the upper garment {be} {top} and the trousers {'were' if was else 'are'} {legs}" + (f"; {bag} {be} also carried" if pack else "; there " + be + " no backpack"),
                         f"for recognition: {', '.join(self.kit(f))}",
                         f"clothing of {self.s}: {top} above, {legs} below" + (f", plus {bag}" if pack else ""))

    def who_note(self, f):
        if not f.wear: return "Subject: one person"
        return self.pick("Subject", "Target", "Person", "Identification") + self.pick(": ", " – ") + ", ".join(self.kit(f))

    # ---- distance

    def distance_np(self, f):
        m = self.m(f.distance)
        return self.pick(f"a slant distance of {m}", f"a slant range of {m}", f"a stand-off of {m}", f"a separation of {m}", f"a camera-to-subject distance of {m}", f"a spacing of {m}",
                         f"a distance of {m}", f"a gap of {m}", f"a range of {m}", f"a stand-off distance of about {m}", f"a line-of-sight distance of {m}")

    def distance_adv(self, f, them="them"):
        m = self.m(f.distance)
        return self.pick(f"at {self.distance_np(f)}", f"at {self.distance_np(f)}", f"from {m} away", f"{m} away from {them}", f"from {self.distance_np(f)}", f"at {m} from {them}", f"{m} off")

    def distance_do(self, f, them="them"):
        m = self.m(f.distance)
        return self.pick(f"maintain {self.distance_np(f)}", f"keep {m} away from {them}", f"stay {m} from {them}", f"hold {self.distance_np(f)}", f"leave {m} between yourself and {them}",
                         f"hold off at {m}", f"remain {m} away", f"keep the gap at {m}", f"keep the slant range at {m}", f"set the stand-off to {m}", f"keep the aircraft {m} from {them}",
                         f"see that {m} lie between the aircraft and {them}", f"observe {self.distance_np(f)}")

    def distance_shall(self, f):
        m, shall = self.m(f.distance), self.pick("shall be", "is to be", "should be", "must be")
        return self.pick(f"{self.distance_np(f)} {shall} maintained", f"the slant range {shall} kept at {m}", f"the separation between {self.d} and {self.s} {shall} {m}".replace("to be be", "to be"),
                         f"it is requested that {self.distance_np(f)} be maintained", f"the required stand-off is {m}", f"{self.distance_np(f)} from {self.s} {shall} observed",
                         f"a range of {m}, neither more nor less, {shall} kept", f"{m} is the distance to be kept from {self.s}", f"the distance to {self.s} {shall} held at {m}",
                         f"as regards range, {m} is required", f"{self.distance_np(f)} is needed between {self.d} and {self.s}")

    def distance_was(self, f, them=None):
        m, them = self.m(f.distance), them or self.pick("them", self.s)
        return self.pick(f"{self.d} kept {m} away from {them}", f"the mean slant range was {m}", f"{m} separated {self.d} from {them} on average", f"the gap between {self.d} and {them} averaged {m}",
                         f"{self.distance_np(f)} was maintained", f"the distance from camera to subject came to {m} on average", f"{self.d} stayed {m} from {them}",
                         f"the stand-off was held at {m}", f"on average {them if them != 'them' else self.s} was {m} away from {self.d}", f"between {self.d} and {them} there was {self.pick('a gap', 'a distance', 'a separation', 'a spacing')} of {m}",
                         f"observation was carried out from {self.distance_np(f)}", f"the range to {self.s}, averaged over the flight, was {m}")

    def distance_note(self, f):
        m = self.m(f.distance)
        return self.pick("Slant range", "Stand-off", "Range (drone to subject)", "Distance to subject", "Separation", "Mean slant distance", "Drone–person distance", "Camera-to-subject distance", "Distance kept", "Range") \
            + self.pick(": ", " – ", " = ", ": ") + m

    # ---- pitch

    def pitch_np(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0:
            return self.pick(f"a depression angle of {d}", f"a downward tilt of {d}", f"a gimbal pitch of {d} below the horizon", f"a line of sight {d} below the horizontal", f"a camera inclination of {d} downwards",
                             f"a camera angle of {d} below the horizon", f"a downward camera pitch of {d}", f"an optical axis depressed by {d}", f"a downward look angle of {d}", f"a camera dip of {d}")
        if f.pitch < 0:
            return self.pick(f"an elevation angle of {d}", f"an upward tilt of {d}", f"a gimbal pitch of {d} above the horizon", f"a line of sight {d} above the horizontal", f"a camera inclination of {d} upwards",
                             f"a camera angle of {d} above the horizon", f"an upward camera pitch of {d}", f"an optical axis raised by {d}", f"an upward look angle of {d}")
        return self.pick("a level camera", "a horizontal line of sight", f"a gimbal pitch of {self.deg(0)}", "a camera with no tilt", "a horizontal optical axis", "a camera aimed level at the horizon", f"a camera tilt of {self.deg(0)}", "zero camera pitch")

    def pitch_adv(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0:
            return self.pick(f"with the camera inclined {d} below the horizontal", f"with the lens pointing {d} downwards", f"with the camera tilted {d} down", f"with {self.pitch_np(f)}", f"the camera being depressed by {d}",
                             f"the camera looking {d} below the horizon", f"with the gimbal pitched {d} down", f"at a depression angle of {d}", f"using {self.pitch_np(f)}", f"with the optical axis {d} below the horizon",
                             f"the lens dipped {d} from the level")
        if f.pitch < 0:
            return self.pick(f"with the camera inclined {d} above the horizontal", f"with the lens pointing {d} upwards", f"with the camera tilted {d} up", f"with {self.pitch_np(f)}", f"the camera being raised by {d} above the horizon",
                             f"the camera looking {d} above the horizon", f"with the gimbal pitched {d} up", f"using {self.pitch_np(f)}", f"with the optical axis {d} above the horizon")
        return self.pick("with the camera level", "with the camera horizontal", "the camera being kept horizontal", f"with {self.pitch_np(f)}", "the lens pointing neither up nor down", "with no tilt on the camera", f"using {self.pitch_np(f)}",
                         "the camera looking straight ahead at the horizon", "with the gimbal level")

    def pitch_do(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0:
            return self.pick(f"tilt the camera {d} below the horizon", f"set the camera pitch to {d} downwards", f"angle the lens {d} down", f"depress the line of sight {d} from the horizontal", f"point the camera {d} below the horizontal",
                             f"use {self.pitch_np(f)}", f"incline the camera downwards by {d}", f"keep the camera looking {d} below the horizon", f"lower the camera by {d} from the horizontal", f"let the lens dip {d} below the horizon",
                             f"have the gimbal pitched {d} down")
        if f.pitch < 0:
            return self.pick(f"tilt the camera {d} above the horizon", f"set the camera pitch to {d} upwards", f"angle the lens {d} up", f"raise the line of sight by {d} above the horizon", f"point the camera {d} above the horizontal",
                             f"use {self.pitch_np(f)}", f"incline the camera upwards by {d}", f"keep the camera looking {d} above the horizon", f"have the gimbal pitched {d} up")
        return self.pick("keep the camera level", "leave the camera horizontal", "aim the camera level with the horizon", f"leave the camera pitch at {self.deg(0)}", "tilt the camera neither up nor down", f"use {self.pitch_np(f)}",
                         "keep the optical axis horizontal", "apply no tilt to the camera", "have the lens look out level")

    def pitch_shall(self, f):
        d, shall = self.deg(f.pitch), self.pick("shall be", "is to be", "should be", "must be")
        if f.pitch == 0:
            return self.pick(f"the camera {shall} kept level", f"the optical axis {shall} horizontal".replace("to be be", "to be"), f"the gimbal pitch {shall} left at {self.deg(0)}", "no camera tilt is required", f"{self.pitch_np(f)} is required",
                             f"the line of sight {shall} held horizontal", f"the camera {shall} tilted neither upwards nor downwards", "a level camera is asked for")
        down, below, dep = ("downwards", "below", "depressed") if f.pitch > 0 else ("upwards", "above", "raised")
        return self.pick(f"the camera {shall} inclined {d} {down}", f"the camera {shall} tilted {d} {below} the horizon", f"{self.pitch_np(f)} {shall} used", f"the line of sight {shall} {dep} {d} from the horizontal",
                         f"the optical axis is to lie {d} {below} the horizontal", f"{self.pitch_np(f)} is required", f"the lens {shall} pointed {d} {below} the horizon", f"for the gimbal, a pitch of {d} {down} is prescribed",
                         f"as regards the camera, a tilt of {d} {down} is required", f"the pitch of the camera {shall} set to {d} {below} the horizon")

    def pitch_was(self, f):
        d = self.deg(f.pitch)
        if f.pitch == 0:
            return self.pick("the camera was kept level", "the camera looked out horizontally", f"the camera pitch was {self.deg(0)}", "the lens pointed neither up nor down", "no tilt was applied to the camera", f"{self.pitch_np(f)} was used",
                             "the optical axis was horizontal", "the line of sight lay level with the horizon", f"the gimbal stood at {self.deg(0)}", "the camera did not tilt away from the horizontal")
        down, below = ("downwards", "below") if f.pitch > 0 else ("upwards", "above")
        return self.pick(f"the camera was inclined {d} {below} the horizontal", f"the camera looked {d} {below} the horizon", f"the lens pointed {d} {down}", f"{self.pitch_np(f)} was used", f"the camera was tilted {d} {down}",
                         f"the gimbal was pitched {d} {down}", f"the optical axis lay {d} {below} the horizon", f"the camera's tilt was {d} {down}", f"the angle of the camera was {d} {below} the horizon", f"imaging was done with {self.pitch_np(f)}",
                         f"the line of sight was {'depressed' if f.pitch > 0 else 'raised'} {d} from the horizontal")

    def pitch_note(self, f):
        d = self.deg(f.pitch)
        if f.pitch == 0: return self.pick("Camera: level", f"Gimbal pitch: {self.deg(0)}", f"Camera tilt: {self.deg(0)}", "Camera tilt: none", "Line of sight: horizontal", f"Camera pitch: {self.deg(0)} (level)", "Optical axis – horizontal")
        if f.pitch < 0: return self.pick(f"Camera elevation: {d}", f"Gimbal pitch: {d} up", f"Camera tilt – {d} upwards", f"Camera: {d} above the horizon", f"Line of sight: {d} above horizontal", f"Camera pitch: {d} above horizon", f"Upward tilt: {d}")
        return self.pick(f"Camera depression: {d}", f"Gimbal pitch: {d} down", f"Camera tilt – {d} downwards", f"Camera: {d} below the horizon", f"Line of sight: {d} below horizontal", f"Camera pitch: {d} below horizon", f"Depression angle = {d}",
                         f"Downward tilt: {d}", f"Camera angle: {d} down from horizontal")

    # ---- height

    def height_np(self, f):
        m = self.m(f.altitude)
        return self.pick(f"a height of {m} above {self.feet}", f"an altitude of {m}", f"a height of {m}", f"an altitude of {m} above {self.feet}", f"a flying height of {m}", f"a vertical offset of {m} above {self.feet}", f"an elevation of {m} over {self.feet}")

    def height_adv(self, f):
        m = self.m(f.altitude)
        return self.pick(f"at {self.height_np(f)}", f"at {self.height_np(f)}", f"{m} above {self.feet}", f"{m} up", f"{m} higher than {self.feet}", f"at {m} of altitude")

    def height_do(self, f):
        m = self.m(f.altitude)
        return self.pick(f"fly {self.height_adv(f)}", f"hold {self.height_np(f)}", f"keep {self.d} {m} above {self.feet}", f"maintain {self.height_np(f)}", f"climb to {m} and hold that height", f"stay {m} above the ground on which they {self.stand_walk(f)}")

    def stand_walk(self, f): return "walk" if f.walks else "stand"

    def height_shall(self, f):
        m, shall = self.m(f.altitude), self.pick("shall be", "is to be", "should be")
        return self.pick(f"{self.height_np(f)} {shall} maintained", f"the height above {self.feet} {shall} kept at {m}", f"the flying height is {m}", f"the altitude {shall} held at {m}", f"{self.height_np(f)} is required", f"{self.d} {shall} flown {m} above {self.feet}")

    def height_was(self, f):
        m = self.m(f.altitude)
        return self.pick(f"{self.d} flew {self.height_adv(f)}", f"the flying height was {m}", f"{self.height_np(f)} was maintained", f"the altitude above {self.feet} was {m}", f"{self.d} was {m} higher than {self.feet}",
                         f"in height, {self.d} was {m} above {self.feet}", f"{m} was the altitude", f"{self.d} held {self.height_np(f)}", f"vertically, {m} lay between {self.d} and {self.feet}", f"{self.d} hung {m} above {self.feet}")

    def height_note(self, f):
        return self.pick("Altitude", "Height above subject's feet", "Flying height", "Height", "Altitude above the person's feet", "Vertical offset (drone above feet)", "Drone height") + self.pick(": ", " – ", " = ", ": ") + self.m(f.altitude)

    # ---- turns

    def turn_noun(self, t):
        return {"left": ["a left turn", "a turn to the left", "a left-hand turn"], "right": ["a right turn", "a turn to the right", "a right-hand turn"],
                "around": ["an about-turn", "a U-turn", "a full reversal of direction"]}[t][self.habit % 3]

    def turns_np(self, f):
        """At least one turn: a left turn, then a right turn"""
        t = f.turns
        if len(t) == 1: return self.turn_noun(t[0])
        items = [self.turn_noun(x) for x in t]
        grouped = [self.turn_noun(x) if n == 1 else {"left": f"{self.few(n)} left turns", "right": f"{self.few(n)} right turns", "around": f"{self.few(n)} about-turns"}[x] for x, n in runs(t)]
        plain = [{"left": "left", "right": "right", "around": "about-turn"}[x] for x in t]
        return self.pick(f"{self.few(len(t))} turns, in the order {', '.join(plain)}",
                         items[0] + "".join(f", then {x}" for x in items[1:]),
                         f"{self.few(len(t))} turns ({', '.join({'around': 'about-turn'}.get(x, x) for x in t)})",
                         ", followed by ".join(grouped) if len(grouped) < 4 else f"{', '.join(grouped[:-1])} and finally {grouped[-1]}",
                         f"{', '.join(items[:-1])} and {items[-1]}, in that order" if len(items) < 5 else f"{', '.join(items[:-1])} and, last of all, {items[-1]}")

    VERBS = {"left": [("turn left", "turned left", "turns left", "turning left"), ("go left", "went left", "goes left", "going left"), ("take a left", "took a left", "takes a left", "taking a left"), ("swing to the left", "swung to the left", "swings to the left", "swinging to the left")],
             "right": [("turn right", "turned right", "turns right", "turning right"), ("go right", "went right", "goes right", "going right"), ("take a right", "took a right", "takes a right", "taking a right"), ("swing to the right", "swung to the right", "swings to the right", "swinging to the right")],
             "around": [("turn around", "turned around", "turns around", "turning around"), ("turn back", "turned back", "turns back", "turning back"), ("double back", "doubled back", "doubles back", "doubling back"), ("make a U-turn", "made a U-turn", "makes a U-turn", "making a U-turn")]}

    def turns_verb(self, f, form):
        """At least one turn; form: 0 turn, 1 turned, 2 turns, 3 turning."""
        t = f.turns
        if self.pick(0, 1):
            head = ("turn", "turned", "turns", "turning")[form]
            if len(t) == 1: return f"{head} {t[0]}" + self.pick("", " once" if form else "")
            return f"{head} " + self.pick(f"first {t[0]}" + "".join(f", then {x}" for x in t[1:]), f"{', '.join(t[:-1])} and {t[-1]}, in that order", t[0] + " and then " + ", then ".join(t[1:]))
        mix = self.pick(True, False, False)
        items = [(self.pick(*self.VERBS[x]) if mix else self.VERBS[x][self.habit])[form] for x in t]
        if len(items) == 1: return items[0]
        if len(items) == 2: return self.pick(f"{items[0]} and then {items[1]}", f"first {items[0]}, then {items[1]}", f"{items[0]}, and after that {items[1]}")
        return items[0] + "".join(self.pick(f", then {x}", f", then {x}", f", next {x}") for x in items[1:-1]) + self.pick(" and finally ", ", and lastly ") + items[-1]

    def turns_was(self, f, s=None):
        s, t = s or self.pick(self.s, "they"), f.turns
        if not t: return self.pick("no turns were made", "no change of direction was recorded", f"{s} never turned", "the walk contained no turns", "not a single turn was taken", f"{s} made no turn", "of turns there were none", f"at no point did {s} turn",
                                   "the number of turns was zero", "turning was not observed at all")
        n = len(t)
        more = [f"{s} {self.turns_verb(f, 1)}", f"{s} {self.turns_verb(f, 1)}", f"{s} made {self.turns_np(f)}", f"the walk contained {self.turns_np(f)}", f"the route comprised {self.turns_np(f)}"]
        if n == 1: more += [f"one turn was recorded, {'an about-turn' if t[0] == 'around' else 'to the ' + t[0]}", f"the only turn was {self.turn_noun(t[0])}", f"there was a single turn: {t[0]}", f"{self.turn_noun(t[0])} was executed once",
                            f"once, {s} {self.pick(*self.VERBS[t[0]])[1]}"]
        else: more += [f"{self.few(n)} turns were made: {listing(['the ' + ORDINALS[i] + (' an about-turn' if x == 'around' else ' to the ' + x) for i, x in enumerate(t)])}",
                       f"{self.few(n)} turns were recorded, namely {', '.join({'around': 'about-turn'}.get(x, x) for x in t)}",
                       f"the sequence of turns was {', '.join(t[:-1])} and {t[-1]}",
                       f"in order of occurrence, the {self.few(n)} turns were {', '.join(t)}",
                       f"the direction was changed {self.times(n)}: {', then '.join({'around': 'right round'}.get(x, 'to the ' + x) for x in t)}"]
        return self.pick(*more)

    def turns_note(self, f):
        t = f.turns
        if not t: return self.pick("Turns: none", "Turns: 0", "Turns – nil", "No turns", "Turn sequence: none")
        seq = {"around": self.pick("U-turn", "about-turn", "around")}
        short = [{"left": "L", "right": "R"}.get(x, seq["around"]) for x in t]
        full = [seq.get(x, x) for x in t]
        n = len(t)
        return self.pick(f"Turns ({n}): {self.pick(', ', ' / ', ' > ').join(full)}", f"Turns in order: {', '.join(short)}" if n > 1 else f"Turns: {n} ({full[0]})", f"Turn sequence: {', '.join(full)}", f"Turns made – {', '.join(full)}",
                         f"Turns: {n} ({', then '.join(full)})", "Turns: " + "; ".join(f"({i + 1}) {x}" for i, x in enumerate(full)))

    # ---- stops

    def total(self, f): return self.sec(f.standing) if f.standing else ""

    def stops_np(self, f):
        n, t = f.stops, self.total(f)
        if n == 0: return self.pick("no pauses", "no stops", "no halts", "no interruption")
        word = self.pick("pause", "stop", "halt")
        if n == 1: return self.pick(f"one {word}", f"a single {word}", an(word)) + (self.pick(f" of {t}", f" lasting {t}", f" ({t})") if t else "")
        return f"{self.few(n)} {word}s" + (self.pick(f" totalling {t}", f" lasting {t} altogether", f" ({t} in all)", f" with a combined length of {t}", f" adding up to {t}") if t else "")

    def stops_verb(self, f, form):
        n, t = f.stops, self.total(f)
        verb = self.pick(("pause", "paused", "pauses", "pausing"), ("stop", "stopped", "stops", "stopping"), ("halt", "halted", "halts", "halting"), ("stand still", "stood still", "stands still", "standing still"))[form]
        if n == 0: return self.pick(("make no pause", "made no pause", "makes no pause", "making no pause"), ("never stop", "never stopped", "never stops", "never stopping"), ("keep going without a halt", "kept going without a halt", "keeps going without a halt", "keeping going without a halt"))[form]
        return f"{verb} {self.times(n)}" + (self.pick(f", for {t}" + ("" if n == 1 else self.pick(" in all", " altogether", " in total")), f" ({t}{'' if n == 1 else ' in total'})") if t else "")

    def stops_was(self, f, s=None):
        s, n, t = s or self.pick(self.s, "they"), f.stops, self.total(f)
        if n == 0: return self.pick("no pauses occurred", "no pause was recorded", f"{s} did not stop anywhere", "the walk was uninterrupted", f"{s} walked without pausing", "there were no halts", f"not once did {s} stop", "of pauses there were none", "the number of stops was zero", f"{s} kept walking throughout")
        more = [f"{s} {self.stops_verb(f, 1)}", f"there {'was' if n == 1 else 'were'} {self.stops_np(f)}", f"{self.stops_np(f)} {'was' if n == 1 else 'were'} recorded", f"the walk was interrupted by {self.stops_np(f)}", f"{s} made {self.stops_np(f)}",
                f"the walk included {self.stops_np(f)}"]
        if t:
            more += [f"the walk was interrupted {self.times(n)}, {'for' if n == 1 else 'for a total of'} {t}", f"for {t}{'' if n == 1 else ' in total'}, spread over {self.few(n)} pauses, {s} stood still" if n > 1 else f"for {t}, during one pause, {s} stood still",
                     f"{t} {'was' if not self.long else 'were' if f.standing != 1 else 'was'} spent standing, in {'one pause' if n == 1 else self.few(n) + ' pauses'}", f"the time spent standing still was {t}, {'in a single halt' if n == 1 else 'shared among ' + self.few(n) + ' halts'}"]
        return self.pick(*more)

    def stops_note(self, f):
        n, t = f.stops, self.total(f)
        if n == 0: return self.pick("Pauses: none", "Stops: 0", "Stops – nil", "No halts", "Number of pauses: 0")
        head = self.pick("Pauses", "Stops", "Halts", "Number of pauses", "Number of stops")
        return f"{head}: {n}" + (self.pick(f" ({t}{'' if n == 1 else ' in total'})", f", {'duration' if n == 1 else 'total duration'} {t}", f"; time standing: {t}") if t else "")

    # ---- way, duration, speed

    def flight_np(self, f):
        t = self.sec(f.duration)
        forms = [f"a flight of {t}", f"a flight lasting {t}", f"a flight of {t} in duration", f"a recording of {t}"]
        if not self.spelled: forms += [f"{self.art(f.duration)}{f.duration}-second flight", f"{self.art(f.duration)}{f.duration} s flight"]
        return self.pick(*forms)

    def during(self, f):
        t = self.sec(f.duration)
        return self.pick(f"during {self.flight_np(f)}", f"over {self.flight_np(f)}", f"in the course of {self.flight_np(f)}", f"over {t} of flight", f"in {self.flight_np(f)}", f"within {self.flight_np(f)}", f"throughout {self.flight_np(f)}" if not f.walks else f"in {self.flight_np(f)}")

    def speed_adv(self, f):
        v = self.mps(f.speed)
        return self.pick(f"at a mean speed of {v}", f"at an average of {v}", f"at {v} on average", f"at a mean walking speed of {v}", f"with an average speed of {v}", f"at an average walking speed of {v}")

    def way_np(self, f):
        m = self.m(f.way)
        return self.pick(f"a walk of {m}", f"a path of {m}", f"a route of {m}", f"a total path length of {m}", f"a distance on foot of {m}", f"a track of {m}")

    def way_was(self, f, s=None):
        """way and speed, sometimes one clause each"""
        s, m, v = s or self.pick(self.s, "they"), self.m(f.way), self.mps(f.speed)
        return self.pick([f"{s} walked {m} {self.speed_adv(f)}"], [f"{m} were walked {self.speed_adv(f)}" if self.long else f"{m} was covered on foot {self.speed_adv(f)}"],
                         [f"the path walked had a length of {m}", f"the mean walking speed was {v}"], [f"{s} covered {m} in all", f"the average speed of the walk was {v}"],
                         [f"{self.way_np(f)} was completed {self.speed_adv(f)}"], [f"the total path length was {m}, the mean walking speed {v}"], [f"walking {self.speed_adv(f)}, {s} covered {m}"],
                         [f"the way walked amounted to {m}", f"walking speed averaged {v}"], [f"at {v} on average, {s} covered {m} on foot"],
                         [f"the walk was {m} long, done {self.speed_adv(f)}"])

    def duration_was(self, f):
        t = self.sec(f.duration)
        return self.pick(f"the flight lasted {t}", f"the duration of the flight was {t}", f"total flight time was {t}", f"{t} elapsed from start to end of the flight", f"the recording ran for {t}", f"the flight was over after {t}", f"the whole flight took {t}", f"the flight was {t} long",
                         f"time in the record: {t}", f"the flight took up {t}")

    def stand_was(self, f, s=None):
        """a standing person, and how long"""
        s, t = s or self.pick(self.s, "they"), self.sec(f.duration)
        return self.pick(f"{s} stood on one spot for the whole {t}", f"no displacement of {self.s} was observed during the {t} of flight", f"{s} remained standing in one place throughout, the flight lasting {t}",
                         f"for all {t} of the flight, {s} stood still", f"{s} did not walk at all in the {t} that the flight lasted", f"from start to end, {t} in all, {s} stood where they were",
                         f"{s} stayed on the spot for the full {t} of the flight", f"during the entire flight of {t}, {s} stood in place", f"{self.s} was stationary throughout; flight time was {t}", f"the {t} of flight passed without a single step by {self.s}")

    def way_note(self, f): return self.pick("Path length", "Distance walked", "Total way", "Length of walk", "Walked") + self.pick(": ", " – ", ": ") + self.m(f.way)
    def speed_note(self, f): return self.pick("Mean walking speed", "Average speed", "Walking speed (mean)", "Mean speed on foot", "Walking speed") + self.pick(": ", " – ", ": ") + self.mps(f.speed)
    def duration_note(self, f): return self.pick("Duration", "Flight time", "Length of flight", "Flight duration", "Duration of flight") + self.pick(": ", " – ", ": ") + self.sec(f.duration)
    def stand_note(self, f): return self.pick("Motion of subject: none (standing)", "Subject stationary throughout", "Movement: stands on one spot", "Behaviour: standing in one place", "Subject does not walk", "State: standing still")

    # ---- instructions

    def extras(self, f):
        """Things that an instruction may add: height, what the person is going to do."""
        out = []
        if f.altitude >= 1 and self.pick(0, 1): out.append("height")
        if f.walks and f.turns and self.pick(0, 0, 0, 1): out.append("turns")
        if f.walks and f.stops and self.pick(0, 0, 0, 0, 1): out.append("stops")
        if self.pick(0, 0, 0, 1): out.append("duration")
        if not f.walks and self.pick(0, 1): out.append("stands")
        return out

    def extra_clauses(self, f, skip=()):
        out = []
        for e in self.extras(f):
            if e in skip: continue
            if e == "height": out.append(self.pick(self.height_do(f), self.height_shall(f)))
            if e == "turns": out.append(self.pick(f"{self.s} is going to {self.turns_verb(f, 0)}", f"expect {self.turns_np(f)}", f"on the way {self.s} will {self.turns_verb(f, 0)}", f"be ready for {self.turns_np(f)}"))
            if e == "stops": out.append(self.pick(f"{self.s} will {self.stops_verb(f, 0)}", f"expect {self.stops_np(f)}", f"{self.stops_np(f)} {'is' if f.stops == 1 else 'are'} to be expected"))
            if e == "duration": out.append(self.pick(f"the flight is to last {self.sec(f.duration)}", f"carry on for {self.sec(f.duration)}", f"{self.sec(f.duration)} of footage {'is' if f.duration == 1 or not self.long else 'are'} required", f"end the flight after {self.sec(f.duration)}", f"total flight time: {self.sec(f.duration)}"))
            if e == "stands": out.append(self.pick(f"{self.s} stands on one spot and will stay there", f"{self.s} does not walk", f"{self.s} is standing still", f"no movement of {self.s} is to be expected", f"{self.s} remains in one place"))
        return out

    def follow(self, f, who):
        if f.walks: return self.pick(f"follow {who}", f"track {who}", f"accompany {who}", f"go along with {who}", f"stay with {who}", f"follow {who}", f"keep the camera on {who}", f"film {who}", f"fly after {who}")
        return self.pick(f"film {who}", f"observe {who}", f"keep the camera on {who}", f"watch {who}", f"record {who}", f"hold {who} in view", f"train the camera on {who}")

    def followed(self, f): return self.pick("followed", "tracked", "accompanied", "filmed", "kept in view") if f.walks else self.pick("filmed", "observed", "kept in view", "recorded", "watched")
    def following(self, f): return self.pick("following", "tracking", "accompanying", "filming") if f.walks else self.pick("filming", "observing", "recording", "watching")

    def instruction_notes(self, f):
        rows = [self.distance_note(f), self.pitch_note(f)]
        for e in self.extras(f):
            rows.append({"height": self.height_note, "turns": self.turns_note, "stops": self.stops_note, "duration": self.duration_note, "stands": self.stand_note}[e](f))
        return rows

    def instruction(self, f):
        self.begin(f)
        return self.pick(self.i_brief, self.i_passive, self.i_question, self.i_list, self.i_steps, self.i_plain, self.i_numbers_first, self.i_requested, self.i_sections, self.i_need, self.i_telegram, self.i_once, self.i_nominal, self.i_story)(f)

    def i_brief(self, f):
        task = self.pick("Mission brief", "Mission", "Task", "Tasking", "Flight order", "Brief for the pilot")
        return f"{task}: {self.follow(f, self.who(f))}. " + sentences(*self.order([self.distance_shall(f), self.pitch_shall(f)]), *self.extra_clauses(f))

    def i_passive(self, f):
        first = self.pick(f"{self.who(f)} {self.pick('is to be', 'shall be', 'should be')} {self.followed(f)} at {self.distance_np(f)}, {self.pitch_adv(f)}",
                          f"in this flight, {self.who(f)} {self.pick('is to be', 'must be')} {self.followed(f)}, {self.distance_np(f)} being maintained and {self.pitch_np(f)} being used",
                          f"it is required that {self.who(f)} be {self.followed(f)}, that {self.distance_np(f)} be kept and that {self.pitch_np(f)} be used")
        return sentences(first, *self.extra_clauses(f))

    def i_question(self, f):
        w = self.who(f, "the")
        return sentences(self.pick(f"would you please {self.follow(f, w)}, {self.pitch_adv(f)}, and {self.distance_do(f)}?", f"could the pilot kindly {self.follow(f, w)} at {self.distance_np(f)}, {self.pitch_adv(f)}?",
                                   f"may I ask you to {self.follow(f, w)}, to {self.distance_do(f)} and to {self.pitch_do(f)}?", f"can we have {w} {self.followed(f)} from {self.m(f.distance)} away, {self.pitch_adv(f)}?",
                                   f"would it be possible to {self.pitch_do(f)} and {self.follow(f, w)} at {self.distance_np(f)}?"), *self.extra_clauses(f))

    def i_list(self, f):
        rows = ([self.who_note(f)] if f.wear else []) + self.order(self.instruction_notes(f))
        goal = self.pick("Follow one person.", "Task: person following.", "Objective: to follow a person on foot.") if f.walks else self.pick("Film one person.", "Task: observation of one standing person.", "Objective: footage of a person who stands still.")
        return self.pick(goal + "\n- " + "\n- ".join(rows), goal + "\n* " + "\n* ".join(rows), goal + " " + "; ".join(rows) + ".", goal + " Parameters: " + "; ".join(r[:1].lower() + r[1:] for r in rows) + ".")

    def i_steps(self, f):
        steps = [f"{self.pick('Locate', 'Find', 'Pick out', 'Identify')} {self.who(f)}", cap(self.distance_do(f)), cap(self.pitch_do(f))] + [cap(c) for c in self.extra_clauses(f, ("stands",))]
        steps.append(cap(self.follow(f, "them")) + self.pick("", " in this way", " like this", " from then on"))
        if self.pick(0, 1): return "\n".join(f"{i + 1}. {s}." for i, s in enumerate(steps))
        return " ".join(f"({i + 1}) {s}{';' if i + 1 < len(steps) else '.'}" for i, s in enumerate(steps))

    def i_plain(self, f):
        w = self.who(f)
        if self.pick(0, 0, 1):
            return sentences(self.follow(f, self.s), self.ident(f), *self.order([self.distance_do(f), self.pitch_do(f)]), *self.extra_clauses(f))
        return sentences(self.pick(f"please {self.follow(f, w)}", self.follow(f, w), f"your job is to {self.follow(f, w)}", f"kindly {self.follow(f, w)}"), *self.order([self.distance_do(f), self.pitch_do(f)]), *self.extra_clauses(f))

    def i_numbers_first(self, f):
        w = self.who(f)
        return sentences(self.pick(f"at {self.distance_np(f)} and with {self.pitch_np(f)}, {self.follow(f, w)}", f"from {self.m(f.distance)} away, {self.pitch_adv(f)}, please {self.follow(f, w)}",
                                   f"using {self.pitch_np(f)} and keeping {self.distance_np(f)}, {self.follow(f, w)}", f"{self.m(f.distance)} away, {self.pitch_adv(f)}: this is how {w} is to be {self.followed(f)}",
                                   f"with {self.pitch_np(f)}, from {self.distance_np(f)}: {self.follow(f, w)}"), *self.extra_clauses(f))

    def i_requested(self, f):
        w = self.who(f)
        return sentences(self.pick(f"it is requested that {w} be {self.followed(f)} by {self.d}", f"kindly arrange for {w} to be {self.followed(f)}", f"the pilot is requested to {self.follow(f, w)}", f"you are hereby asked to {self.follow(f, w)}"),
                         self.pick(f"{self.distance_np(f)} may kindly be maintained", f"kindly {self.distance_do(f)}", self.distance_shall(f), f"kindly note that {self.distance_shall(f)}"),
                         self.pick(f"also, {self.pitch_shall(f)}", f"kindly {self.pitch_do(f)} also", f"further, {self.pitch_shall(f)}", f"it may be ensured that {self.pitch_np(f)} is used"), *self.extra_clauses(f))

    def i_sections(self, f):
        a, b, c = self.pick(("Task", "Geometry", "Camera"), ("Target", "Range", "Camera"), ("Objective", "Stand-off", "Gimbal"), ("Who", "How far", "What angle"))
        what = cap(self.follow(f, self.who(f)) if a in ("Task", "Objective") else self.who(f, "a"))
        parts = [f"{a}. {what}.", f"{b}. {cap(self.distance_shall(f))}.", f"{c}. {cap(self.pitch_shall(f))}."]
        more = self.extra_clauses(f)
        if more: parts.append(self.pick("Other", "Remarks", "Additional") + ". " + sentences(*more))
        return self.pick(" ", "\n").join(parts)

    def i_need(self, f):
        w = self.who(f, self.pick("a", "the"))
        return sentences(self.pick(f"what we need is footage of {w}, taken from {self.m(f.distance)} away, {self.pitch_adv(f)}", f"for our experiment, {w} has to be {self.followed(f)}; {self.distance_shall(f)}, and {self.pitch_shall(f)}",
                                   f"the study calls for footage of {w}, for which {self.distance_np(f)} and {self.pitch_np(f)} are required", f"we should like {w} to be {self.followed(f)} at {self.distance_np(f)}, {self.pitch_adv(f)}",
                                   f"required: continuous footage of {w} at {self.distance_np(f)} and with {self.pitch_np(f)}"), *self.extra_clauses(f))

    def i_telegram(self, f):
        rows = self.order(self.instruction_notes(f))
        lead = cap(self.follow(f, (f"person ({', '.join(self.kit(f))})" if f.wear else "person")))
        return self.pick(f"{lead}. " + ". ".join(rows) + ".", f"{lead} – " + ", ".join(r[:1].lower() + r[1:] for r in rows).replace(" – ", " ") + ".", ". ".join(rows) + f". {lead}.")

    def i_once(self, f):
        w = self.who(f)
        return sentences(self.pick(f"as soon as {w} is in the picture, {self.distance_do(f, 'them')} and {self.pitch_do(f)}", f"when {w} has been found, {self.pitch_do(f)} and {self.distance_do(f)}", f"while {self.following(f)} {w}, {self.distance_do(f)}; {self.pitch_do(f)}",
                                   f"in {self.following(f)} {w}, the pilot shall {self.distance_do(f).replace('yourself', 'the aircraft')} and {self.pitch_do(f)}", f"before {self.following(f)} {w}, {self.pitch_do(f)}; then {self.distance_do(f)}"), *self.extra_clauses(f))

    def i_nominal(self, f):
        act = self.pick("following", "tracking", "filming", "accompaniment") if f.walks else self.pick("filming", "observation", "recording")
        return sentences(self.pick(f"purpose of the flight: the {act} of {self.who(f, 'a')}, with {self.distance_np(f)} and {self.pitch_np(f)}", f"the {act} of {self.who(f)} is to be carried out at {self.distance_np(f)} with {self.pitch_np(f)}",
                                   f"requirements for the {act} of {self.who(f)}: {self.distance_np(f)}; {self.pitch_np(f)}", f"{cap(act)} of {self.who(f, 'a')} from {self.distance_np(f)}, under {self.pitch_np(f)}"), *self.extra_clauses(f))

    def i_story(self, f):
        self.s = "the person"
        there = self.pick("there is somebody", "you will see somebody", "look out for somebody", "somebody is out there") if not f.walks else self.pick("somebody is walking there", "there is somebody on foot", "you will see somebody walking")
        k = ""
        if f.wear:
            top, legs, pack = f.wear
            k = self.pick(f" in {an(top)} top and {legs} trousers" + (f", {an(self.bag())} on the back" if pack else ""), f" with {an(top)} top and {legs} trousers" + (f", also with {an(self.bag())}" if pack else ""), f": {top} top, {legs} trousers" + (f", {self.bag()}" if pack else ""))
        act = self.pick("go with them", "follow them", "fly along with them", "stay with them") if f.walks else self.pick("keep them in the picture", "watch them", "film them")
        return sentences(there + k, self.pick(f"{act}, but {self.distance_do(f)}", f"{act} and {self.distance_do(f)}", f"{act}, {self.distance_adv(f)}"), self.pitch_do(f), *self.extra_clauses(f))

    # ---- descriptions

    def description(self, f):
        self.begin(f)
        return self.pick(self.d_report, self.d_list, self.d_long, self.d_story, self.d_present, self.d_sections, self.d_numbered, self.d_questions, self.d_telegram, self.d_mixed, self.d_nominal, self.d_geometry_first, self.d_kindly)(f)

    def motion_was(self, f, s=None):
        if not f.walks: return [self.stand_was(f, s)]
        return self.order([*self.way_was(f, s), self.turns_was(f, s), self.stops_was(f, s), self.duration_was(f)])

    def geometry_was(self, f): return self.order([self.distance_was(f), self.pitch_was(f)] + ([self.height_was(f)] if f.altitude >= 1 else []))

    def motion_notes(self, f): return [self.way_note(f), self.speed_note(f), self.turns_note(f), self.stops_note(f), self.duration_note(f)] if f.walks else [self.stand_note(f), self.duration_note(f)]
    def geometry_notes(self, f): return [self.distance_note(f), self.pitch_note(f)] + ([self.height_note(f)] if f.altitude >= 1 else [])

    def d_report(self, f):
        lead = self.pick(f"{self.who(f, 'a')} was {self.followed(f)} by {self.d}", f"in the flight under report, {self.who(f, 'a')} was {self.followed(f)}", f"{self.d} {'followed' if f.walks else 'filmed'} {self.who(f, 'a')}", f"the flight was devoted to {self.following(f)} {self.who(f, 'a')}")
        if self.pick(0, 0, 1):
            lead = self.pick(f"one {self.noun} was {self.followed(f)} by {self.d}", f"the report concerns one {self.noun}")
            return sentences(lead, self.ident(f, "was"), *self.geometry_was(f), *self.motion_was(f))
        return sentences(lead, *self.motion_was(f), *self.geometry_was(f))

    def d_list(self, f):
        head = self.pick("Flight log", "Observation record", "Flight record", "Log entry", "Summary of flight", "Test record")
        rows = ([self.who_note(f)] if f.wear else [self.pick("Subject: one person", "Observed: one person")]) + self.pick(self.motion_notes(f) + self.geometry_notes(f), self.geometry_notes(f) + self.motion_notes(f), self.order(self.geometry_notes(f) + self.motion_notes(f)))
        return self.pick(f"{head}:\n- " + "\n- ".join(rows), f"{head}\n" + "\n".join(rows), f"{head}: " + "; ".join(r[:1].lower() + r[1:] for r in rows) + ".")

    def d_long(self, f):
        high = f" and {self.height_adv(f)}" if f.altitude >= 1 else ""
        if not f.walks:
            return sentences(self.pick(f"{self.during(f)}, {self.who(f, 'a')} who stood on one spot was {self.followed(f)} at {self.distance_np(f)}{high}, {self.pitch_adv(f)}",
                                       f"at {self.distance_np(f)}{high}, {self.pitch_adv(f)}, {self.d} filmed {self.who(f, 'a')} for {self.sec(f.duration)}, in which time {self.s} stood still",
                                       f"standing on one spot for the {self.sec(f.duration)} of the flight, {self.who(f, 'a')} was {self.followed(f)} from {self.m(f.distance)} away{high}, {self.pitch_adv(f)}"))
        ving = listing([self.turns_verb(f, 3) if f.turns else self.pick("without turning", "taking no turns"), self.stops_verb(f, 3)])
        with_np = listing([self.turns_np(f) if f.turns else "no turns", self.stops_np(f)])
        return sentences(self.pick(f"{self.during(f)}, {self.who(f, 'a')} was {self.followed(f)} at {self.distance_np(f)}{high}, {self.pitch_adv(f)}, as they walked {self.m(f.way)} {self.speed_adv(f)}, {ving}",
                                   f"while {self.who(f, 'a')} walked {self.m(f.way)} {self.speed_adv(f)}, {ving}, {self.d} {self.pick('stayed', 'kept')} {self.m(f.distance)} away{high} for {self.sec(f.duration)}, {self.pitch_adv(f)}",
                                   f"{self.who(f, 'a')}, {self.followed(f)} for {self.sec(f.duration)} at {self.distance_np(f)}{high}, {self.pitch_adv(f)}, walked {self.m(f.way)} {self.speed_adv(f)}, with {with_np}",
                                   f"{self.way_np(f)} by {self.who(f, 'a')}, {self.speed_adv(f)} and with {with_np}, was recorded {self.during(f)} from {self.m(f.distance)} away{high}, {self.pitch_adv(f)}"))

    def d_story(self, f):
        lead = self.pick(f"a drone flew out to watch {self.who(f, 'a')}", f"this is about {self.who(f, 'a')} and a drone that watched", f"there was once a drone that {'followed' if f.walks else 'watched'} {self.who(f, 'a')}", f"{self.who(f, 'a')} {'set off on foot, and a drone came along' if f.walks else 'stood there, and a drone looked on'}",
                         f"somebody was being filmed from a drone: {self.who(f, 'a')}")
        if not f.walks:
            return sentences(lead, self.stand_was(f, "they"), *self.geometry_was(f))
        turn = f"they {self.turns_verb(f, 1)}" if f.turns else self.pick("they took no turns", "they did not turn even once", "there was not one turn on the way")
        stop = f"they {self.stops_verb(f, 1)}"
        act = self.pick([f"{turn}, and {stop}"], [turn, f"on the way {stop}" if f.stops else stop], [stop, turn], [f"along the way {turn}", f"also, {stop}" if f.stops else stop])
        end = self.pick([f"after {self.sec(f.duration)} the flight was over", f"by then {self.m(f.way)} had been walked, {self.speed_adv(f)}"], [f"in the end it came to {self.m(f.way)} on foot, {self.speed_adv(f)}, and to {self.sec(f.duration)} of flight"],
                        [f"they walked {self.m(f.way)} in all, {self.speed_adv(f)}", self.duration_was(f)])
        return self.pick(sentences(lead, *act, *self.geometry_was(f), *end), sentences(lead, *self.geometry_was(f), *act, *end))

    def d_present(self, f):
        high = f"{self.d} is {self.m(f.altitude)} above {self.feet}" if f.altitude >= 1 else ""
        geo = self.pick([f"the gap between {self.d} and {self.s} is {self.m(f.distance)}", f"filming is done from there, {self.pitch_adv(f)}"], [f"{self.d} films from {self.m(f.distance)} away, {self.pitch_adv(f)}"], [f"throughout, {self.d} keeps {self.distance_np(f)} and {self.pitch_np(f)}"])
        if not f.walks:
            return sentences(self.pick(f"the recording shows {self.who(f, 'a')} who stands on one spot", f"{self.who(f, 'a')} stands still in the footage", f"we see {self.who(f, 'a')}; {self.s} stands in one place"), self.pick(f"this goes on for {self.sec(f.duration)}, the length of the flight", f"the flight lasts {self.sec(f.duration)}"), *self.order([*geo, high]))
        lead = self.pick(f"the recording shows a walk by {self.who(f, 'a')}", f"on foot in the footage: {self.who(f, 'a')}", f"{self.who(f, 'a')} is walking, and {self.d} follows")
        turn = self.pick(f"{self.s} {self.turns_verb(f, 2)}", f"they {self.turns_verb(f, 0)}") if f.turns else self.pick(f"{self.s} makes no turn", "they never turn", "turns do not occur")
        stop = self.pick(f"{self.s} {self.stops_verb(f, 2)}", f"they {self.stops_verb(f, 0)}")
        way = self.pick(f"the walk is {self.m(f.way)} long, at {self.mps(f.speed)} on average, and the flight lasts {self.sec(f.duration)}", f"in the {self.sec(f.duration)} of the flight they walk {self.m(f.way)} {self.speed_adv(f)}", f"{self.m(f.way)} is the way walked, {self.mps(f.speed)} the mean speed and {self.sec(f.duration)} the length of the flight")
        return sentences(lead, *self.pick([turn, stop, way, *geo, high], [way, turn, stop, high, *geo], [*geo, high, turn, stop, way]))

    def d_sections(self, f):
        who = f"Subject. {cap(self.who(f, 'a'))}."
        motion = self.pick("Movement", "Trajectory", "Motion") + ". " + sentences(*self.motion_was(f, self.s)) if f.walks else "Movement. " + sentences(self.stand_was(f, self.s))
        geo = self.pick("Viewing geometry", "Camera and drone", "Sensor geometry", "Set-up") + ". " + sentences(*self.geometry_was(f))
        return self.pick(" ", "\n").join([who] + self.pick([motion, geo], [geo, motion]))

    def d_numbered(self, f):
        clauses = [f"{self.who(f, 'a')} was {self.followed(f)}"] + self.pick(self.motion_was(f) + self.geometry_was(f), self.geometry_was(f) + self.motion_was(f))
        if self.pick(0, 1): return self.pick("Findings:", "Observations:", "The following is placed on record:") + "\n" + "\n".join(f"{i + 1}. {cap(c)}." for i, c in enumerate(clauses))
        return self.pick("Observations: ", "The following was noted: ", "") + "; ".join(f"({'abcdefghijklmn'[i]}) {c}" for i, c in enumerate(clauses)) + "."

    def d_questions(self, f):
        rows = [(self.pick("Who was filmed?", "Who was it?", "Whom did the drone film?"), self.who(f, "a")), (self.pick("From how far away?", "At what range?", "How far off was the drone?"), self.m(f.distance))]
        rows.append((self.pick("And the camera?", "Camera angle?", "How was the camera set?"), self.pitch_np(f)))
        if f.altitude >= 1: rows.append((self.pick("How high up?", "What height?", "Altitude?"), f"{self.m(f.altitude)} above {self.feet}"))
        if f.walks:
            rows += [(self.pick("How far did they walk?", "Length of the walk?"), self.m(f.way)), (self.pick("How fast, on average?", "Mean walking speed?"), self.mps(f.speed)), (self.pick("Which turns?", "Any turns?"), self.turns_np(f) if f.turns else self.pick("not one", "no turns", "nil")),
                     (self.pick("How many stops?", "Any pauses?"), self.stops_np(f) if f.stops else self.pick("not one", "nil", "no stops"))]
        else: rows.append((self.pick("What did they do?", "Did they move?"), self.pick("stood on one spot all the time", "stood still throughout")) if self.pick(0, 1) else ("Did they walk?", self.pick("no, they stood on one spot", "not at all; they stood still")))
        rows.append((self.pick("How long did the flight last?", "Flight time?"), self.sec(f.duration)))
        return " ".join(f"{q} {cap(a)}." for q, a in rows)

    def d_telegram(self, f):
        k = ", ".join(self.kit(f)) if f.wear else ""
        lead = f"{cap(self.pick('person', 'subject', 'individual'))} {'followed' if f.walks else 'filmed, standing'}" + (f" ({k})" if k else "")
        rows = [lead, *self.pick(self.motion_notes(f) + self.geometry_notes(f), self.geometry_notes(f) + self.motion_notes(f))]
        return ". ".join(rows) + "."

    def d_mixed(self, f):
        lead = self.pick(f"{'following' if f.walks else 'filming'} of {self.who(f, 'a')}", f"under observation: {self.who(f, 'a')}", f"{self.who(f, 'a')} formed the subject of this flight")
        geo = "; ".join(self.geometry_was(f))
        if not f.walks: return self.pick(sentences(lead, geo, self.stand_was(f)), sentences(lead, self.stand_was(f), geo))
        motion = self.motion_was(f)
        return self.pick(sentences(lead, geo, *motion), sentences(lead, "; ".join(motion), geo), sentences(lead, "; ".join(motion[:2]), "; ".join(motion[2:]), geo))

    def d_nominal(self, f):
        high = [self.height_np(f)] if f.altitude >= 1 else []
        geo = listing(self.order([self.distance_np(f), self.pitch_np(f)] + high))
        if not f.walks:
            return sentences(f"observation of {self.who(f, 'a')} standing in one place" if not f.wear else f"observation of {self.who(f, 'a')}, standing in one place throughout", self.duration_note(f), f"{self.pick('conditions of recording', 'geometry')}: {geo}")
        moves = listing([self.turns_np(f) if f.turns else "no turns", self.stops_np(f)])
        return sentences(self.pick(f"record of {self.way_np(f)}, made by {self.who(f, 'a')}", f"completion of {self.way_np(f)} by {self.who(f, 'a')}"), self.pick(f"features of the walk: {moves}", f"occurrence of {moves}", f"noted on the way: {moves}"), f"{self.speed_note(f)}; flight time {self.sec(f.duration)}",
                         f"{self.pick('conditions of recording', 'geometry', 'recording made with')}: {geo}".replace("made with:", "made with"))

    def d_geometry_first(self, f):
        return sentences(self.pick(*[f"the camera was trained on {self.who(f, 'a')}", f"from {self.d}, {self.who(f, 'a')} was {self.followed(f)}"]), *self.geometry_was(f), *self.motion_was(f))

    def d_kindly(self, f):
        first = self.pick("kindly find the particulars of the flight below", "the particulars of the flight are as under", "the details of the flight are placed below", "kindly note the following about the flight")
        noun = self.s
        return sentences(first + ".", f"{self.pick('one ' + self.noun, 'a single ' + self.noun)} was {self.followed(f)}", self.ident(f, "was"), *self.geometry_was(f), *self.motion_was(f, noun))

    # ---- wrong texts

    def end(self, text, more):
        last = text[-1] if text[-1] in ".?!" else ""
        return (text[:-1] if last else text) + more + last

    def foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        way = self.pick("thing", "thing", "thing", "remark", "person", "person", "noun")
        if way == "thing": return self.end(text, ", " + thing)
        if way == "remark": return text + self.pick(f" Remark: {thing}.", f" Noted in addition: {thing}.", f" All of it {thing}.")
        if way == "noun":
            for noun in ("subject", "person", "target", "individual", "participant", "walker", "pedestrian"):
                for a in ("the ", "The ", "a ", "A ", "an ", "An "):
                    if a + noun + " " in text: return text.replace(a + noun + " ", (a if a.lower() == "the " else (cap(an(person)[:-len(person)]) if a[0] == "A" else an(person)[:-len(person)])) + person + " ", 1)
        return text + self.pick(f" The person concerned is {an(person)}.", f" By profession or station, this is {an(person)}.", f" {cap(an(person))} is seen in the footage.", f" (It is {an(person)}.)", f" The one in view is known to be {an(person)}.")

    def heading(self, text, direction):
        d = direction
        return text + self.pick(f" The walk leads towards the {d}.", f" The person walks {d}.", f" Direction of walk: {d}.", f" They are walking in a {d}erly direction." if d[-1] in "ht" else f" They are walking towards the {d}.", f" The person on foot is {d}bound.", f" The walker heads {d}.",
                                f" The direction of travel on foot is to the {d}.", f" It is to the {d} that the person walks.", f" As to heading, the person walks towards the {d}.", f" Their steps go {d}.")


HAN = "零一二三四五六七八九"


def han(n):
    if n < 10: return HAN[n]
    if n < 20: return "十" + (HAN[n % 10] if n % 10 else "")
    if n < 100: return HAN[n // 10] + "十" + (HAN[n % 10] if n % 10 else "")
    if n < 1000:
        rest = n % 100
        return HAN[n // 100] + "百" + ("" if not rest else "零" + han(rest) if rest < 10 else "一" + han(rest) if rest < 20 else han(rest))
    rest = n % 1000
    return HAN[n // 1000] + "千" + ("" if not rest else ("零" if rest < 100 else "") + ("一" if 10 <= rest < 20 else "") + han(rest))


def zh(*clauses, mark="。"):
    return "".join(c + ("" if c[-1] in "。？！：" else mark) for c in clauses if c)


class SeventeenthChinese(Grammar):
    code = "zh"
    things = ["旁边有一座喷泉", "当时下着小雨", "路边停着一辆三轮车", "经过一家包子铺", "身后跟着一只黄狗", "头顶是一排梧桐树", "远处有人放风筝", "正赶上晚高峰", "背景里有教堂的钟声", "手里撑着雨伞",
              "身边还有一个小孩", "路过公交站台", "地上积着雪", "有一辆自行车从旁边骑过", "大风刮得很紧", "脚边落满银杏叶", "时值黄昏", "穿过一座石桥", "沿着河堤", "对面是菜市场", "边走边打电话", "雾气很重", "手里提着一袋橘子", "门口挂着红灯笼"]
    persons = ["护士", "渔民", "快递员", "老太太", "小男孩", "保安", "女教师", "外卖骑手", "退休工人", "交警", "孕妇", "厨师"]

    # ---- 一篇文字的习惯

    def begin(self, f):
        self.spelled = self.pick(True, False, False, False, False)
        self.latin = not self.spelled and self.pick(True, False, False)
        self.s = self.pick("目标", "目标", "被摄者", "拍摄对象", "跟拍对象" if f.walks else "拍摄对象", "目标人物", "被试", *(["行人", "步行者"] if f.walks else []))
        self.it = self.pick(self.s, "此人", "对方", self.s)
        self.d = self.pick("无人机", "无人机", "飞行器", "机体", "航拍机")

    def num(self, n): return han(n) if self.spelled else str(n)
    def times(self, n): return ("两" if n == 2 else han(n) if self.spelled or self.pick(0, 1) else f"{n}") + "次"
    def unit(self, n, zh_unit, latin): return f"{n} {latin}" if self.latin else ("两" if self.spelled and n == 2 else self.num(n)) + zh_unit
    def m(self, n): return self.unit(n, "米", "m")
    def sec(self, n): return self.unit(n, "秒", "s")
    def deg(self, n): return f"{abs(n)}°" if self.latin else self.num(abs(n)) + "度"
    def mps(self, x):
        if self.latin: return f"{x:.1f} m/s"
        if self.spelled:
            whole, part = f"{x:.1f}".split(".")
            return f"每秒{HAN[int(whole)]}点{HAN[int(part)]}米"
        return self.pick(f"每秒{x:.1f}米", f"{x:.1f}米每秒", f"{x:.1f}米/秒")
    def order(self, items):
        items, out = list(items), []
        while items:
            one = self.pick(*items); items.remove(one); out.append(one)
        return out

    # ---- 人

    def bag(self): return self.pick("背包", "背包", "双肩包")

    def kit(self, f):
        top, legs, pack = f.wear
        t, l = ZH_COLOURS[top], ZH_COLOURS[legs]
        items = self.pick([f"{t}色上衣", f"{l}色裤子"], [f"上衣{t}色", f"裤子{l}色"], [f"{t}上衣", f"{l}裤子"] if top not in ("beige", "pink", "brown", "orange") and legs not in ("beige", "pink", "brown", "orange") else [f"{t}色上衣", f"{l}色长裤"], [f"上身{t}色", f"下身{l}色"])
        if pack: items.append(self.pick("背有", "背着", "带", "背") + self.bag())
        elif self.pick(0, 0, 1): items.append(self.pick("无背包", "未背包"))
        return items

    def who(self, f, noun=None):
        """名词短语：穿……的人"""
        noun = noun or self.pick(self.s, "人", "那个人" if self.pick(0, 1) else "人")
        if not f.wear: return {"人": "那个人"}.get(noun, noun)
        top, legs, pack = f.wear
        t, l, bag = ZH_COLOURS[top], ZH_COLOURS[legs], self.bag()
        forms = [f"身穿{t}色上衣、{l}色裤子" + (f"、背着{bag}" if pack else "") + f"的{noun}", f"上身{t}色、下身{l}色" + (f"、背{bag}" if pack else "") + f"的{noun}", (f"背着{bag}、" if pack else "") + f"穿{t}色上衣和{l}色裤子的{noun}",
                 f"{'一人' if noun == '人' else noun}（{'，'.join(self.kit(f))}）", f"上衣为{t}色、裤子为{l}色" + (f"且背有{bag}" if pack else "") + f"的{noun}", f"下穿{l}色裤子、上穿{t}色上衣" + (f"、身背{bag}" if pack else "") + f"的{noun}",
                 f"身着{t}色上装、{l}色下装" + (f"并携带{bag}" if pack else "") + f"的{noun}", f"{t}色上衣搭配{l}色裤子" + (f"、带着{bag}" if pack else "") + f"的{noun}", f"{l}色裤子配{t}色上衣" + (f"、背上有{bag}" if pack else "") + f"的{noun}"]
        if pack: forms.append(f"背着{bag}的{noun}（{t}色上衣、{l}色裤子）")
        else: forms.append(f"穿{t}色上衣、{l}色裤子，没有背包的{noun}".replace("，", "、"))
        if top == legs: forms += [f"上衣和裤子都是{t}色" + (f"、背着{bag}" if pack else "") + f"的{noun}", f"上下装同为{t}色" + (f"、背有{bag}" if pack else "") + f"的{noun}"]
        return self.pick(*forms)

    def ident(self, f):
        if not f.wear: return ""
        top, legs, pack = f.wear
        t, l, bag, s = ZH_COLOURS[top], ZH_COLOURS[legs], self.bag(), self.it
        return self.pick(f"{s}穿的是{t}色上衣、{l}色裤子" + (f"，还背着{bag}" if pack else ""), f"{s}上身{t}色，下身{l}色" + (f"，背{bag}" if pack else ""), f"外观特征：{'，'.join(self.kit(f))}", f"{s}的上衣是{t}色，裤子是{l}色" + (f"，背上有{bag}" if pack else "，没有背包"),
                         f"识别特征为{'、'.join(self.kit(f))}", f"衣着：{'、'.join(self.kit(f))}", f"{s}上着{t}色、下着{l}色" + (f"，另有{bag}一个" if pack else ""), f"辨认时看{t}色上衣和{l}色裤子" + (f"，以及背上的{bag}" if pack else ""))

    def who_note(self, f):
        if not f.wear: return self.pick("对象：一人", "目标：一人", "目标人数：1人")
        return self.pick("目标", "对象", "目标特征", "外观", "衣着") + "：" + "、".join(self.kit(f))

    # ---- 距离

    def distance_np(self, f):
        m = self.m(f.distance)
        return self.pick(f"{m}的距离", f"{m}的斜距", f"{m}间距", f"{m}的直线距离", f"{m}左右的距离", f"约{m}的间隔", f"{m}的拍摄距离")

    def distance_adv(self, f, named=True):
        """状语"""
        m, s = self.m(f.distance), self.it
        plain = [f"在{m}外", f"隔着{m}", f"保持{m}的距离", f"保持{m}的斜距", f"拍摄距离{m}", f"保持{m}间距"]
        return self.pick(*plain, *([f"在距{s}{m}处", f"在离{s}{m}的地方", f"与{s}保持{m}间距", f"与{s}相距{m}", f"距{s}{m}"] if named else []))

    def distance_do(self, f):
        m, s = self.m(f.distance), self.it
        return self.pick(f"与{s}保持{m}的距离", f"离{s}{m}", f"斜距保持在{m}", f"机身到{s}的直线距离控制在{m}", f"始终与{s}相隔{m}", f"间距定为{m}", f"拍摄距离取{m}", f"别靠太近也别离太远，{m}正好", f"把距离维持在{m}左右", f"跟{s}隔开{m}",
                         f"人机之间留出{m}", f"人机斜距要求{m}", f"距离按{m}执行")

    def distance_was(self, f):
        m, s, d = self.m(f.distance), self.it, self.d
        return self.pick(f"{d}与{s}的平均斜距为{m}", f"{d}一直离{s}{m}左右", f"人机之间平均相隔{m}", f"拍摄距离平均{m}", f"{d}保持在{m}之外", f"{s}到{d}的直线距离约为{m}", f"{d}和{s}隔着{m}", f"全程平均间距{m}", f"镜头离{s}有{m}", f"斜距均值为{m}",
                         f"距离方面，{d}与{s}相距{m}")

    def distance_note(self, f): return self.pick("斜距", "距离", "人机距离", "拍摄距离", "平均斜距", "与目标距离", "人机间距", "直线距离") + self.pick("：", "：", "：约") + self.m(f.distance)

    # ---- 俯仰

    def pitch_np(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0: return self.pick(f"{d}俯角", f"{d}的俯角", f"下俯{d}的镜头", f"低于水平线{d}的视角", f"向下{d}的镜头角度", f"下倾{d}的云台角度")
        if f.pitch < 0: return self.pick(f"{d}仰角", f"{d}的仰角", f"上仰{d}的镜头", f"高于水平线{d}的视角", f"向上{d}的镜头角度", f"上扬{d}的云台角度")
        return self.pick("水平视角", "平视的镜头", f"{self.deg(0)}的俯仰角", "水平的镜头")

    def pitch_adv(self, f):
        """状语小句"""
        d = self.deg(f.pitch)
        if f.pitch > 0: return self.pick(f"镜头下俯{d}", f"以{d}俯角", f"相机向下倾斜{d}", f"云台下压{d}", f"镜头朝下{d}", f"用{d}的俯角", f"视线低于水平线{d}", f"光轴下倾{d}")
        if f.pitch < 0: return self.pick(f"镜头上仰{d}", f"以{d}仰角", f"相机向上倾斜{d}", f"云台上抬{d}", f"镜头朝上{d}", f"用{d}的仰角", f"视线高于水平线{d}", f"光轴上扬{d}")
        return self.pick("镜头平视", "以水平视角", "相机保持水平", "云台不俯不仰", "镜头放平", f"俯仰角取{self.deg(0)}", "光轴水平")

    def pitch_do(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0: return self.pick(f"镜头向下压{d}", f"相机俯角设为{d}", f"云台下俯{d}", f"俯角取{d}", f"把镜头放低到水平线以下{d}", f"相机朝下倾斜{d}", f"让镜头低头{d}", f"用{d}俯角拍摄", f"光轴应低于水平面{d}", f"镜头从水平位置往下转{d}", f"俯仰角要求向下{d}")
        if f.pitch < 0: return self.pick(f"镜头向上抬{d}", f"相机仰角设为{d}", f"云台上仰{d}", f"仰角取{d}", f"把镜头抬到水平线以上{d}", f"相机朝上倾斜{d}", f"让镜头抬头{d}", f"用{d}仰角拍摄", f"光轴应高于水平面{d}", f"俯仰角要求向上{d}")
        return self.pick("镜头保持水平", f"相机俯仰角设为{self.deg(0)}", "云台置平", "镜头平视，不俯不仰", "把镜头放平", "相机既不朝上也不朝下", "光轴应与水平面平行", "用平视角度拍摄", f"俯仰角要求{self.deg(0)}")

    def pitch_was(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0: return self.pick(f"镜头下俯{d}", f"相机俯角为{d}", f"云台向下倾了{d}", f"镜头低于水平线{d}", f"拍摄时用的是{d}俯角", f"相机朝下倾斜{d}", f"光轴位于水平面以下{d}", f"画面以{d}的俯角拍得", f"镜头往下压了{d}", f"俯角{d}")
        if f.pitch < 0: return self.pick(f"镜头上仰{d}", f"相机仰角为{d}", f"云台向上抬了{d}", f"镜头高于水平线{d}", f"拍摄时用的是{d}仰角", f"相机朝上倾斜{d}", f"光轴位于水平面以上{d}", f"画面以{d}的仰角拍得", f"镜头往上抬了{d}", f"仰角{d}")
        return self.pick("镜头保持水平", f"相机俯仰角为{self.deg(0)}", "云台没有俯仰", "镜头平视前方", "拍摄时用的是平视角度", "相机既不朝上也不朝下", "光轴与水平面平行", "画面是平视拍得的", "镜头放得水平")

    def pitch_note(self, f):
        d = self.deg(f.pitch)
        if f.pitch > 0: return self.pick(f"俯角：{d}", f"镜头：下俯{d}", f"云台俯仰：向下{d}", f"相机角度：水平线以下{d}", f"相机俯角：{d}", f"镜头角度：向下{d}", f"俯仰角：下俯{d}", f"光轴：低于水平面{d}")
        if f.pitch < 0: return self.pick(f"仰角：{d}", f"镜头：上仰{d}", f"云台俯仰：向上{d}", f"相机角度：水平线以上{d}", f"相机仰角：{d}", f"镜头角度：向上{d}", f"俯仰角：上仰{d}", f"光轴：高于水平面{d}")
        return self.pick("镜头：水平", f"云台俯仰：{self.deg(0)}", "相机角度：平视", f"俯仰角：{self.deg(0)}", f"俯仰角：{self.deg(0)}（水平）", "光轴：水平", "镜头角度：平视")

    # ---- 高度

    def height_adv(self, f): return self.pick(f"在{self.m(f.altitude)}高度", f"飞行高度{self.m(f.altitude)}", f"比{self.it}脚下高出{self.m(f.altitude)}", f"高度{self.m(f.altitude)}", f"离地{self.m(f.altitude)}")
    def height_do(self, f):
        m, s = self.m(f.altitude), self.it
        return self.pick(f"飞行高度{m}", f"高度保持在{m}", f"飞在比{s}脚下高{m}的位置", f"升到{m}高并保持", f"相对{s}脚底的高度取{m}", f"高度按{m}控制", f"离地{m}飞行", f"机身应高出{s}脚面{m}")
    def height_was(self, f):
        m, s, d = self.m(f.altitude), self.it, self.d
        return self.pick(f"飞行高度为{m}", f"{d}飞在{m}高处", f"{d}比{s}脚下高{m}", f"相对{s}脚底的高度为{m}", f"{d}离地{m}", f"高度{m}", f"论高度，{d}高出{s}脚面{m}", f"垂直方向上，{d}与{s}脚下相差{m}，{d}在上", f"{d}的高度维持在{m}")
    def height_note(self, f): return self.pick("高度", "飞行高度", "相对高度", "高度（距目标脚底）", "离地高度", "机高") + "：" + self.m(f.altitude)

    # ---- 转弯

    SHORT = {"left": ["左转", "向左转", "往左拐", "左拐"], "right": ["右转", "向右转", "往右拐", "右拐"], "around": ["掉头", "转身往回走", "折返", "原路折回"]}

    def turn_words(self, f):
        kind = self.pick(0, 1, 2, 3)
        back = self.pick("掉头", "折返", "转身往回走") if kind != 3 else "掉头"
        return [back if t == "around" else self.SHORT[t][kind] for t in f.turns]

    def turns_chain(self, f):
        """至少一次：先左转，再右转，最后掉头"""
        w = self.turn_words(f)
        if len(w) == 1: return self.pick(f"{w[0]}一次", f"{w[0]}了一次" if not w[0].endswith("走") else f"{w[0]}一次", f"有一次{w[0]}")
        if len(w) == 2: return self.pick(f"先{w[0]}，再{w[1]}", f"先{w[0]}、后{w[1]}", f"{w[0]}之后又{w[1]}", f"依次{w[0]}、{w[1]}") if w[0] != w[1] else self.pick(f"连着两次{w[0]}", f"{w[0]}之后又{w[1]}", f"先后两次{w[0]}", f"先{w[0]}，再{w[1]}")
        grouped, back = [], self.pick("掉头", "折返")
        for t, n in runs(f.turns):
            one = {"left": "左转", "right": "右转", "around": back}[t]
            grouped.append(one if n == 1 else f"连续{one}{self.times(n)}")
        mids = self.pick(["再", "接着", "然后", "又"], ["接着", "然后", "再", "之后"], ["然后", "再", "接着", "又"])
        forms = [f"先{w[0]}" + "".join(f"，{mids[i % 4]}{x}" for i, x in enumerate(w[1:-1])) + f"，最后{w[-1]}", f"依次{'、'.join(w)}", "，".join(f"第{han(i + 1)}次{'转向' if not i else ''}是{x}" for i, x in enumerate(w))]
        if len(grouped) > 1: forms.append(f"先{grouped[0]}" + "".join(f"，{mids[i % 4]}{x}" for i, x in enumerate(grouped[1:-1])) + f"，最后{grouped[-1]}")
        else: forms.append(grouped[0])
        return self.pick(*forms)

    def turns_list(self, f):
        if len(f.turns) == 1: return {"left": "左转", "right": "右转", "around": "掉头"}[f.turns[0]] + "一次"
        return self.pick("、", "—", "，").join({"left": "左", "right": "右", "around": "掉头"}[t] for t in f.turns)

    def turns_was(self, f, s=None):
        s, n = s or self.it, len(f.turns)
        if not n: return self.pick("全程没有转弯", f"{s}一次弯也没转", f"{s}始终未转向", "途中未出现转弯", "转弯次数为零", f"{s}一路上没拐过弯", "没有记录到转弯", f"{s}走的路上没有转弯", "转向动作未出现")
        w = self.turns_chain(f)
        forms = [f"{s}{w}", f"途中{s}{w}", f"{s}一路上{w}", f"走的过程中，{s}{w}"]
        if n > 1: forms += [f"{s}共转向{self.times(n)}：{self.turns_list(f)}", f"转向顺序为{self.turns_list(f)}", f"途中转向{self.times(n)}，依次是{'、'.join(self.turn_words(f))}", f"记录到{self.times(n)}转向，按先后为{'、'.join(self.turn_words(f))}", f"{s}的转向共有{self.times(n)}，顺序是{self.turns_list(f)}"]
        else:
            x = f.turns[0]
            forms += [f"途中只有一次{'掉头' if x == 'around' else '左转' if x == 'left' else '右转'}", f"唯一的一次转向是{self.turn_words(f)[0]}", f"转向一次，为{'掉头' if x == 'around' else '左转' if x == 'left' else '右转'}", f"{s}转向一次：{self.turn_words(f)[0]}"]
        return self.pick(*forms)

    def turns_note(self, f):
        if not f.turns: return self.pick("转弯：无", "转向次数：0", "转向：无", "转弯：0次")
        return self.pick("转向", "转向顺序", "转弯顺序", f"转向（{len(f.turns)}次）", "转向记录") + "：" + self.pick(self.turns_list(f), "、".join(self.turn_words(f)), "，".join(self.turn_words(f)), "→".join({"left": "左", "right": "右", "around": "掉头"}[t] for t in f.turns))

    # ---- 停留

    def stops_verb(self, f):
        n = f.stops
        if not n: return self.pick("没有停过", "一次也没停", "未作停留", "中间没有停顿", "没停下来过")
        t = f.standing and self.sec(f.standing)
        verb = self.pick("停", "停", "停留", "停顿", "驻足")
        head = f"停下{self.times(n)}" if self.pick(0, 0, 1) else f"{verb}了{self.times(n)}"
        if not t: return head
        return head + (self.pick(f"，停了{t}", f"，时长{t}", f"（{t}）", f"，站了{t}") if n == 1 else self.pick(f"，共{t}", f"，合计{t}", f"，加起来{t}", f"（共{t}）", f"，累计{t}", f"，总共站了{t}"))

    def stops_was(self, f, s=None):
        s, n, t = s or self.it, f.stops, f.standing and self.sec(f.standing)
        if not n: return self.pick(f"{s}{self.stops_verb(f)}", f"途中{s}{self.stops_verb(f)}", "停留次数为零", "未记录到停留", f"{s}一直在走，没有停", "全程无停顿", "途中没有停留", f"{s}走的时候没有停下")
        forms = [f"{s}{self.stops_verb(f)}", f"途中{s}{self.stops_verb(f)}", f"中途{s}{self.stops_verb(f)}", f"路上{s}{self.stops_verb(f)}"]
        if t:
            if n == 1: forms += [f"停留一次，时长{t}", f"{s}有{t}站着没动，就这一次", f"有一次停留，历时{t}", f"记录到一次停顿，持续{t}", f"{s}只停过一次，为时{t}"]
            else: forms += [f"停留{self.times(n)}，总时长{t}", f"{self.times(n)}停顿加在一起是{t}", f"{s}停下的次数是{self.times(n)}，站立时间合计{t}", f"记录到{self.times(n)}停顿，累计{t}", f"{s}前后停了{self.times(n)}，一共{t}", f"有{t}是站着的，分{self.times(n)}"]
        return self.pick(*forms)

    def stops_note(self, f):
        n, t = f.stops, f.standing and self.sec(f.standing)
        if not n: return self.pick("停留：无", "停留次数：0", "停顿：0次", "停顿：无")
        return self.pick("停留", "停顿", "驻足") + f"：{n}次" + ((self.pick(f"，{t}", f"（{t}）", f"，时长{t}") if n == 1 else self.pick(f"，共{t}", f"（合计{t}）", f"，总时长{t}")) if t else "")

    # ---- 路程、速度、时长

    def speed_adv(self, f):
        v = self.mps(f.speed)
        return self.pick(f"平均速度{v}", f"平均步速{v}", f"步行均速{v}", f"均速{v}", f"平均{v}")

    def way_was(self, f, s=None):
        s, m, v = s or self.it, self.m(f.way), self.mps(f.speed)
        return self.pick([f"{s}共走了{m}，{self.speed_adv(f)}"], [f"{s}以{v}的平均速度走了{m}"], [f"步行路程{m}", f"平均步速为{v}"], [f"{s}走过的路全长{m}", f"走路的平均速度是{v}"], [f"总路程为{m}，{self.speed_adv(f)}"], [f"按平均{v}的步速，{s}走完{m}"],
                         [f"{s}一共走出{m}", f"{s}步行的平均速度为{v}"], [f"{s}走了{m}的路", f"论速度，平均{v}"], [f"{m}的路程由{s}步行完成，{self.speed_adv(f)}"], [f"平均{v}，总计走了{m}"])

    def duration_was(self, f):
        t = self.sec(f.duration)
        return self.pick(f"飞行持续{t}", f"整个飞行历时{t}", f"飞行时长为{t}", f"从开始到结束共{t}", f"这次飞行用了{t}", f"全程{t}", f"飞行总时间{t}", f"前后飞了{t}", f"记录时长{t}", f"飞满{t}后结束")

    def stand_was(self, f, s=None):
        s, t = s or self.it, self.sec(f.duration)
        return self.pick(f"{s}在原地站了{t}，也就是整个飞行时间", f"飞行{t}，{s}始终站在原地", f"整个{t}里{s}没有走动", f"{s}全程站立不动，飞行时长{t}", f"在{t}的飞行中，{s}一直站在同一个位置", f"飞行历时{t}，期间{s}一步未走", f"{s}从头到尾站着没走，前后{t}",
                         f"{t}内{s}未发生位移，保持站立", f"{s}站在一处，直到{t}的飞行结束", f"飞了{t}，{s}就在原处站了{t}")

    def way_note(self, f): return self.pick("路程", "步行路程", "行走距离", "总路程", "路线长度") + "：" + self.m(f.way)
    def speed_note(self, f): return self.pick("平均步速", "步行均速", "平均速度（步行）", "平均行走速度") + "：" + self.mps(f.speed)
    def duration_note(self, f): return self.pick("时长", "飞行时长", "飞行时间", "总时长", "历时") + "：" + self.sec(f.duration)
    def stand_note(self, f): return self.pick("目标状态：原地站立", "目标：原地站立不动", "状态：站着不走", "目标：站在原地不走", "位移：无（原地站立）")

    # ---- 任务书

    def extras(self, f):
        out = []
        if f.altitude >= 1 and self.pick(0, 1): out.append("height")
        if f.walks and f.turns and self.pick(0, 0, 0, 1): out.append("turns")
        if f.walks and f.stops and self.pick(0, 0, 0, 0, 1): out.append("stops")
        if self.pick(0, 0, 0, 1): out.append("duration")
        if not f.walks and self.pick(0, 1): out.append("stands")
        return out

    def extra_clauses(self, f):
        out = []
        for e in self.extras(f):
            if e == "height": out.append(self.height_do(f))
            if e == "turns": out.append(self.pick(f"{self.it}会{self.turns_chain(f)}".replace("了一次", "一次").replace("会有一次", "会有一次"), f"路线上的转向{'依次' if len(f.turns) > 1 else ''}为{self.turns_list(f)}", f"注意{self.it}的转向：{self.turns_list(f)}", f"预计转向{self.times(len(f.turns))}：{self.turns_list(f)}" if len(f.turns) > 1 else f"预计{self.turns_list(f)}"))
            if e == "stops":
                t = f.standing and self.sec(f.standing)
                out.append(self.pick(f"{self.it}途中会停{self.times(f.stops)}", f"预计停留{self.times(f.stops)}", f"路上将停{self.times(f.stops)}") + ("" if not t else f"，{'时长' if f.stops == 1 else '共'}{t}"))
            if e == "duration": out.append(self.pick(f"飞行时长{self.sec(f.duration)}", f"全程{self.sec(f.duration)}", f"拍满{self.sec(f.duration)}结束", f"飞{self.sec(f.duration)}", f"任务时间为{self.sec(f.duration)}"))
            if e == "stands": out.append(self.pick(f"{self.it}站在原地不走", f"{self.it}不会走动", f"{self.it}一直站着", f"{self.it}全程站立"))
        return out

    def notes(self, f):
        rows = [self.distance_note(f), self.pitch_note(f)]
        for e in self.extras(f):
            rows.append({"height": self.height_note, "turns": self.turns_note, "stops": self.stops_note, "duration": self.duration_note, "stands": self.stand_note}[e](f))
        return rows

    def act(self, f): return self.pick("跟拍", "跟踪拍摄", "跟随", "跟飞", "跟住", "全程跟拍") if f.walks else self.pick("拍摄", "对准", "拍", "持续拍摄", "观察", "盯住")

    def instruction(self, f):
        self.begin(f)
        return self.pick(self.i_task, self.i_list, self.i_one, self.i_steps, self.i_please, self.i_question, self.i_ba, self.i_params_first, self.i_find, self.i_sections, self.i_short, self.i_talk)(f)

    def i_task(self, f):
        return self.pick("任务：", "任务内容：", "飞行任务：", "任务目标：") + zh(f"{self.act(f)}{self.who(f)}", self.pick("，", "；").join([self.distance_do(f), self.pitch_do(f)]), *self.extra_clauses(f))

    def i_list(self, f):
        rows = self.pick([self.who_note(f)], [self.who_note(f)]) + self.order(self.notes(f))
        head = self.pick("任务书", "飞行任务单", "拍摄要求", "作业参数", "任务要求") if f.walks else self.pick("任务书", "飞行任务单", "拍摄要求")
        act = "跟拍一人" if f.walks else "拍摄一人"
        return self.pick(f"{head}（{act}）\n" + "\n".join(f"{i + 1}. {x}" for i, x in enumerate(rows)), f"{head}：{act}。" + "；".join(rows) + "。", f"{head}：{act}\n- " + "\n- ".join(rows), f"{act}。\n" + "\n".join(f"（{han(i + 1)}）{x}；" for i, x in enumerate(rows))[:-1] + "。")

    def i_one(self, f):
        w, a = self.who(f), self.act(f)
        return zh(self.pick(f"{self.pitch_adv(f)}，{self.distance_adv(f, False)}，{a}{w}", f"{a}{w}，{self.distance_do(f)}，{self.pitch_do(f)}", f"以{self.m(f.distance)}的距离和{self.pitch_np(f)}{a}{w}", f"{a}{w}时，{self.distance_do(f)}，同时{self.pitch_do(f)}"), *self.extra_clauses(f))

    def i_steps(self, f):
        steps = [f"{self.pick('找到', '锁定', '确认', '识别')}{self.who(f)}", self.distance_do(f), self.pitch_do(f)]
        steps += self.extra_clauses(f) + [self.pick("按以上要求跟拍", "一路跟下去", "保持该状态跟飞") if f.walks else self.pick("按以上要求拍摄", "一直拍下去", "保持该状态拍摄")]
        return self.pick("步骤：\n" + "\n".join(f"{i + 1}、{x}" for i, x in enumerate(steps)), "".join(f"{'①②③④⑤⑥⑦⑧⑨⑩'[i]}{x}；" for i, x in enumerate(steps))[:-1] + "。", f"首先，{steps[0]}；其次，{steps[1]}；再次，{steps[2]}；" + "；".join(steps[3:-1] + ["最后，" + steps[-1]]) + "。")

    def i_please(self, f):
        return zh(self.pick(f"请{self.act(f)}{self.who(f)}", f"请飞手{self.act(f)}{self.who(f)}", f"麻烦{self.act(f)}{self.who(f)}", f"本次需{self.act(f)}{self.who(f)}"), *self.order([self.distance_do(f), self.pitch_do(f)]), *self.extra_clauses(f))

    def i_question(self, f):
        w, a = self.who(f), self.act(f)
        return zh(self.pick(f"能不能{a}{w}，{self.distance_do(f)}，{self.pitch_do(f)}？", f"可以用{self.pitch_np(f)}、隔{self.m(f.distance)}{a}{w}吗？", f"{a}{w}，{self.distance_do(f)}，{self.pitch_do(f)}，可以吗？", f"可否{self.distance_adv(f, False)}{a}{w}，{self.pitch_adv(f)}？"), *self.extra_clauses(f))

    def i_ba(self, f):
        w = self.who(f)
        return zh(self.pick(f"把镜头对准{w}", f"始终把{w}放在画面里", f"将{w}保持在画面内", f"让{w}一直留在镜头里"), f"{self.distance_do(f)}，{self.pitch_do(f)}", *self.extra_clauses(f))

    def i_params_first(self, f):
        w = self.who(f)
        return zh("，".join(self.order([self.distance_note(f).replace("：", ""), self.pitch_note(f).replace("：", "")])) + self.pick("，照此", "，按这个参数", "，以此参数", "。以上述条件") + f"{self.act(f)}{w}", *self.extra_clauses(f))

    def i_find(self, f):
        there = self.pick("前面有个人", "那边有一个人", "画面里有一个人") + ("在走" if f.walks else "站着")
        act = self.pick("跟上去", "跟着走", "跟着拍", "一路跟着") if f.walks else self.pick("对着拍就行", "盯着拍", "把镜头对过去")
        ident = ""
        if f.wear:
            t, l = ZH_COLOURS[f.wear[0]], ZH_COLOURS[f.wear[1]]
            ident = self.pick(f"，{t}色上衣，{l}色裤子", f"，上身{t}色下身{l}色", f"，穿着{t}色上衣和{l}色裤子") + (f"，背着{self.bag()}" if f.wear[2] else "")
        self.it = self.pick("此人", "这个人", "对方")
        return zh(there + ident, f"{act}，{self.distance_do(f)}", self.pitch_do(f), *self.extra_clauses(f))

    def i_sections(self, f):
        a, b, c = self.pick(("一、对象", "二、距离", "三、镜头"), ("【目标】", "【距离】", "【云台】"), ("对象", "间距", "角度"))
        sep = "" if a[0] == "【" else "："
        parts = [f"{a}{sep}{self.whom(f)}。", f"{b}{sep}{self.distance_do(f)}。", f"{c}{sep}{self.pitch_do(f)}。"]
        more = self.extra_clauses(f)
        if more: parts.append(("【其他】" if not sep else "四、其他：" if a[0] == "一" else "其他：") + zh(*more))
        return self.pick("", "\n").join(parts)

    def i_short(self, f):
        rows = self.order(self.notes(f))
        lead = self.act(f).replace("对准", "拍摄") + self.pick("目标", "一人", "目标人物") + (f"（{'、'.join(self.kit(f))}）" if f.wear else "")
        return self.pick(lead + "，" + "，".join(x.replace("：", "") for x in rows) + "。", lead + "；" + "；".join(rows) + "。", "，".join(x.replace("：", "") for x in rows) + "，" + lead + "。")

    def i_talk(self, f):
        return zh(f"{self.act(f)}{self.s}", self.ident(f), self.pick(f"要求如下：{self.distance_do(f)}；{self.pitch_do(f)}", f"注意两点，一是{self.distance_do(f)}，二是{self.pitch_do(f)}", f"{self.pitch_do(f)}，{self.distance_do(f)}"), *self.extra_clauses(f))

    # ---- 记录

    def description(self, f):
        self.begin(f)
        return self.pick(self.d_report, self.d_list, self.d_long, self.d_story, self.d_sections, self.d_numbered, self.d_questions, self.d_short, self.d_geometry_first, self.d_when, self.d_result)(f)

    def motion_was(self, f, s=None): return self.order([*self.way_was(f, s), self.turns_was(f, s), self.stops_was(f, s), self.duration_was(f)]) if f.walks else [self.stand_was(f, s)]
    def geometry_was(self, f): return self.order([self.distance_was(f), self.pitch_was(f)] + ([self.height_was(f)] if f.altitude >= 1 else []))
    def motion_notes(self, f): return [self.way_note(f), self.speed_note(f), self.turns_note(f), self.stops_note(f), self.duration_note(f)] if f.walks else [self.stand_note(f), self.duration_note(f)]
    def geometry_notes(self, f): return [self.distance_note(f), self.pitch_note(f)] + ([self.height_note(f)] if f.altitude >= 1 else [])
    def whom(self, f): return self.who(f, "人") if f.wear else self.pick("一个人", "一名" + self.s) if self.s in ("行人", "被试", "步行者") else "一个人"
    def did(self, f): return self.pick("跟拍了", "跟踪拍摄了", "跟随") if f.walks else self.pick("拍摄了", "观察了", "拍了")

    def d_report(self, f):
        w = self.who(f)
        lead = self.pick(f"本次飞行{self.did(f)}{w}", f"{self.d}{self.did(f)}{w}", f"本次{'跟拍' if f.walks else '拍摄'}的对象是{self.whom(f)}", f"飞行中{'跟拍' if f.walks else '拍摄'}了{w}")
        return self.pick(zh(lead, *self.motion_was(f), *self.geometry_was(f)), zh(lead, "，".join(self.geometry_was(f)), *self.motion_was(f)), zh(f"{self.d}{'跟拍' if f.walks else '拍摄'}了一个人", self.ident(f), "，".join(self.geometry_was(f)), *self.motion_was(f)))

    def d_list(self, f):
        head = self.pick("实验记录", "飞行记录", "飞行日志", "试飞记录", "数据摘要")
        rows = [self.who_note(f)] + self.pick(self.motion_notes(f) + self.geometry_notes(f), self.geometry_notes(f) + self.motion_notes(f), self.order(self.motion_notes(f) + self.geometry_notes(f)))
        return self.pick(f"{head}\n" + "\n".join(f"{i + 1}. {x}" for i, x in enumerate(rows)), f"{head}：\n- " + "\n- ".join(rows), f"{head}：" + "；".join(rows) + "。")

    def d_long(self, f):
        self.it = self.s
        w, high = self.who(f), (f"，{self.height_adv(f)}" if f.altitude >= 1 else "")
        t = self.sec(f.duration)
        if not f.walks:
            return zh(self.pick(f"在{t}的飞行中，{self.d}{self.distance_adv(f, False)}{high}，{self.pitch_adv(f)}，拍摄了站在原地的{w}", f"{w}在原地站了{t}，{self.d}{self.distance_adv(f, False)}{high}，{self.pitch_adv(f)}，拍到飞行结束", f"{self.d}{self.distance_adv(f, False)}{high}，{self.pitch_adv(f)}，对着{w}拍了{t}，{self.it}始终站着没走"))
        turns = self.turns_chain(f) if f.turns else self.pick("没有转弯", "一路没拐弯")
        return zh(self.pick(f"在{t}的飞行中，{self.d}{self.distance_adv(f, False)}{high}，{self.pitch_adv(f)}，跟拍{w}走了{self.m(f.way)}，{self.speed_adv(f)}，{self.it}途中{turns}，{self.stops_verb(f)}",
                            f"{w}走了{self.m(f.way)}，{self.speed_adv(f)}，途中{turns}，{self.stops_verb(f)}，{self.d}则{self.distance_adv(f)}{high}，{self.pitch_adv(f)}，跟拍了{t}",
                            f"{self.d}{self.distance_adv(f, False)}{high}，{self.pitch_adv(f)}，用{t}记录了{w}的一段步行：路程{self.m(f.way)}，{self.speed_adv(f)}，{turns}，{self.stops_verb(f)}"))

    def d_story(self, f):
        w = self.who(f, "人" if f.wear else "一个人")
        if f.wear and not w.startswith("一人（"): w = "一个" + w
        elif f.wear: w = "一个" + w[1:] if w.startswith("一人（") else "一个" + w
        lead = self.pick(f"{self.d}升空后，镜头里是{w}", f"镜头里有{w}", f"{self.d}拍的是{w}", f"这段画面拍的是{w}")
        self.it = self.pick("此人", "这个人", "那人")
        if not f.walks: return zh(lead, self.stand_was(f), *self.geometry_was(f))
        turns = self.turns_chain(f) if f.turns else self.pick("没有拐弯", "没转过弯")
        a = self.pick([f"{self.it}一路走着，{turns}，{self.stops_verb(f)}"], [self.turns_was(f), self.stops_was(f)], [self.stops_was(f), self.turns_was(f)])
        b = self.pick([f"等到{self.sec(f.duration)}的飞行结束，{self.it}一共走了{self.m(f.way)}，{self.speed_adv(f)}"], [f"前后{self.sec(f.duration)}，{self.it}走了{self.m(f.way)}，{self.speed_adv(f)}"], [*self.way_was(f), self.duration_was(f)])
        geo = self.geometry_was(f)
        return self.pick(zh(lead, *a, *geo, *b), zh(lead, *b, *a, *geo), zh(lead, "，".join(geo), *a, *b))

    def d_sections(self, f):
        a = self.pick("对象", "目标", "被摄对象") + f"：{self.whom(f)}。"
        b = self.pick("运动情况", "行走情况", "目标运动") + "：" + "；".join(self.motion_was(f)) + "。" if f.walks else "目标状态：" + self.stand_was(f) + "。"
        c = self.pick("拍摄条件", "飞行参数", "相机与机位") + "：" + "；".join(self.geometry_was(f)) + "。"
        return self.pick("", "\n").join([a] + self.pick([b, c], [c, b]))

    def d_numbered(self, f):
        rows = [f"{'跟拍' if f.walks else '拍摄'}对象为{self.whom(f)}"] + self.pick(self.motion_was(f) + self.geometry_was(f), self.geometry_was(f) + self.motion_was(f))
        return self.pick("结果如下：\n" + "\n".join(f"（{i + 1}）{x}。" for i, x in enumerate(rows)), "".join(f"{'①②③④⑤⑥⑦⑧⑨⑩⑪⑫'[i]}{x}；" for i, x in enumerate(rows))[:-1] + "。", "观测结果：" + "；".join(rows) + "。")

    def d_questions(self, f):
        rows = [("拍的是谁？" if self.pick(0, 1) else "拍摄对象？", self.whom(f)), (self.pick("离多远？", "距离多少？"), self.m(f.distance)), (self.pick("镜头什么角度？", "相机角度？"), self.pitch_np(f) if f.pitch else self.pick("水平", "平视"))]
        if f.altitude >= 1: rows.append((self.pick("飞多高？", "高度？"), self.m(f.altitude)))
        if f.walks: rows += [(self.pick("走了多远？", "路程？"), self.m(f.way)), (self.pick("走得多快？", "平均步速？"), "平均" + self.mps(f.speed)), (self.pick("转弯了吗？", "转向情况？"), self.turns_chain(f) if f.turns else "没有转弯"), (self.pick("停过没有？", "停留情况？"), self.stops_verb(f))]
        else: rows.append((self.pick("走了吗？", "有没有走动？"), self.pick("没有，一直站在原地", "没走，始终站着")))
        rows.append((self.pick("飞了多久？", "飞行时长？"), self.sec(f.duration)))
        return "".join(f"{q}{a}。" for q, a in rows)

    def d_short(self, f):
        lead = ("跟拍一人" if f.walks else "拍摄一人") + (f"（{'、'.join(self.kit(f))}）" if f.wear else "")
        rows = self.pick(self.motion_notes(f) + self.geometry_notes(f), self.geometry_notes(f) + self.motion_notes(f))
        return lead + "，" + "，".join(x.replace("：", "") for x in rows) + "。" if self.pick(0, 1) else lead + "。" + "；".join(rows) + "。"

    def d_geometry_first(self, f):
        self.it = self.s
        return zh("，".join(self.geometry_was(f)), self.pick(f"{'跟拍' if f.walks else '拍摄'}对象是{self.whom(f)}", f"镜头对着的是{self.whom(f)}", f"画面中是{self.whom(f)}"), *self.motion_was(f))

    def d_when(self, f):
        w, t = self.who(f), self.sec(f.duration)
        if not f.walks: return zh(f"{self.d}对{w}进行了{t}的拍摄，拍摄期间{self.it}站立未动", "，".join(self.geometry_was(f)))
        motion = self.order([*self.way_was(f), self.turns_was(f), self.stops_was(f)])
        return zh(self.pick(f"{self.d}对{w}进行了{t}的跟拍", f"{self.d}花{t}跟拍了{w}", f"对{w}的跟拍历时{t}"), self.pick("跟拍期间", "其间", "这段时间里") + "，" + "；".join(motion), "，".join(self.geometry_was(f)))

    def d_result(self, f):
        w, t = self.who(f), self.sec(f.duration)
        geo = [self.distance_note(f).replace("：", ""), self.pitch_note(f).replace("：", "")] + ([self.height_note(f).replace("：", "")] if f.altitude >= 1 else [])
        if not f.walks: return zh(f"实验中，{w}站立于原地，飞行{t}", self.pick("机位：", "拍摄设置：", "条件：") + "，".join(geo))
        return zh(f"实验中，{w}步行{self.m(f.way)}，{self.speed_adv(f)}，飞行{t}", f"{self.turns_was(f)}；{self.stops_was(f)}", self.pick("机位：", "拍摄设置：", "条件：") + "，".join(geo))

    # ---- 错的

    def end(self, text, more): return text[:-1] + more + text[-1] if text[-1] in "。？！；" else text + more

    def foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        kind = self.pick(0, 0, 0, 1, 2, 3)
        if kind == 0: return self.end(text, "，" + thing)
        if kind == 1: return text + f"备注：{thing}。"
        if kind == 2: return text + self.pick(f"目标是一名{person}。", f"此人是{person}。", f"画面中的人为{person}。", f"据辨认，被拍的是一位{person}。")
        for noun in ("目标人物", "被摄者", "被试", "行人", "步行者", "那个人", "此人"):
            if noun in text: return text.replace(noun, person, 1)
        return text + f"画面里还能看到一位{person}。"

    def heading(self, text, direction):
        d = ZH_DIRECTIONS[direction]
        return text + self.pick(f"此人向{d}行走。", f"行走方向：{d}。", f"目标是朝{d}走的。", f"人往{d}边走。" if len(d) == 1 else f"人往{d}方向走。", f"步行方向为正{d}。" if len(d) == 1 else f"步行方向为{d}。", f"目标一路朝{d}而去。", f"行人前进方向是{d}。", f"走的是{d}向。", f"目标朝{d}方向步行。")
