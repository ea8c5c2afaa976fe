"""The fifteenth grammar for check_text_judge.py: English as a large language model writes it when asked for natural, varied captions; Chinese of a mainland journalist and a video editor. Written before its first run."""
from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an

PAST = dict(be="was", keep="kept", have="had", stand="stood", make="made", go="went", take="took", hold="held", fly="flew", come="came", wear="wore", stop="stopped", leave="left", put="put", swing="swung", spend="spent", see="saw", set="set", dip="dipped", do="did", sit="sat", bring="brought", get="got", show="showed", hang="hung", cover="covered", follow="followed", look="looked", stay="stayed", carry="carried")
ONES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen nineteen".split()
TENS = "0 10 twenty thirty forty fifty sixty seventy eighty ninety".split()


def words(n):
    if n < 20:
        return ONES[n]
    if n < 100:
        return TENS[n // 10] + ("-" + ONES[n % 10] if n % 10 else "")
    if n < 1000:
        return ONES[n // 100] + " hundred" + (" and " + words(n % 100) if n % 100 else "")
    return str(n)


def gerund(verb):
    if verb in ("stop", "dip", "set", "sit", "get"):
        return verb + verb[-1] + "ing"
    return (verb[:-1] if verb.endswith("e") and verb != "be" else verb) + "ing"


def conjugated(verb, plural, past):
    if past:
        if verb == "be" and plural:
            return "were"
        return PAST.get(verb) or (verb + "d" if verb.endswith("e") else verb[:-1] + "ied" if verb.endswith("y") and verb[-2] not in "aeo" else verb + "ed")
    if plural:
        return "are" if verb == "be" else verb
    if verb in ("be", "have", "do", "go"):
        return dict(be="is", have="has", do="does", go="goes")[verb]
    if verb.endswith(("s", "sh", "ch", "x")):
        return verb + "es"
    return verb[:-1] + "ies" if verb.endswith("y") and verb[-2] not in "aeo" else verb + "s"


def verbs(text, form):
    """Every [verb] of the text by form(verb, plural); <subject> or <+subject> says which number the next verbs have."""
    out, plural, at = "", False, 0
    while at < len(text):
        c = text[at]
        if c == "<":
            plural = text[at + 1] == "+" or text[at + 1:at + 6].lower() == "they>"
            at += text[at + 1] == "+"
        elif c == "[":
            end = text.index("]", at)
            out += form(text[at + 1:end], plural)
            at = end
        elif c != ">":
            out += c
        at += 1
    return out


def doing(phrase):
    return verbs(phrase, lambda verb, plural: gerund(verb))


def infinitive(phrase):
    return verbs(phrase, lambda verb, plural: verb)


def sentences(text):
    """The text with a capital at the start of every sentence."""
    out, fresh = "", True
    for at, c in enumerate(text):
        if fresh and (c.isalpha() or c.isdigit()):
            out += c.upper()
            fresh = False
        else:
            out += c
        if c == "\n" or (c in ".?!" and text[at + 1:at + 2] in (" ", "\n")):
            fresh = True
    return out


def listed(items, last=" and "):
    return items[0] if len(items) == 1 else ", ".join(items[:-1]) + last + items[-1]


def lower(text):
    return text[:1].lower() + text[1:] if not text.startswith("I ") else text


class FifteenthEnglish(Grammar):
    code = "en"
    things = ["beside a fountain", "past a row of parked cars", "as thunder rolls in the distance", "with two dogs on a leash", "under a striped umbrella", "while church bells ring", "near a bakery",
              "across a stone bridge", "in pouring rain", "beneath tall palm trees", "just before sunset", "in front of a red-brick school", "with a bicycle at their side", "holding a paper cup of coffee",
              "while a tram rattles by", "amid a crowd of tourists", "on a foggy morning", "along the riverbank", "next to a bus shelter", "wearing a straw hat", "with a phone pressed to one ear", "as snow drifts down",
              "through a busy market", "pushing a pram", "while pigeons scatter"]
    persons = ["nurse", "fisherman", "young woman", "schoolboy", "policeman", "bearded man", "teenager", "waiter", "grandmother", "soldier", "jogger's wife", "businessman", "tourist guide", "bride"]

    # numbers, units, the voice of one text
    def voice(self, past=False):
        self.past = past
        self.metre = self.pick("metre", "metre", "meter", "meter", "meter", "m")
        self.spelled = self.rng.random() < .15 and self.metre != "m"
        self.round = self.rng.random() < .4 and not self.spelled

    def n(self, number):
        return words(number) if self.spelled else str(number)

    def count(self, number):
        return words(number) if self.spelled or number < 10 and self.rng.random() < .6 else str(number)

    def times(self, number):
        return {1: "once", 2: "twice"}.get(number) or self.count(number) + " times"

    def m(self, number):
        return self.n(number) + " " + (self.metre if self.metre == "m" or number == 1 else self.metre + "s")

    def m_adjective(self, number):
        article = "an " if str(number)[0] == "8" or number in (11, 18) else "a "
        return article + self.n(number) + (" m" if self.metre == "m" else "-" + self.metre)

    def s(self, number):
        return self.n(number) + (" second" if number == 1 else " seconds")

    def degrees(self, flight):
        number = abs(flight.pitch)
        return f"{number}°" if self.round else self.n(number) + (" degree" if number == 1 else " degrees")

    def speed(self, flight):
        if self.metre == "m":
            return f"{flight.speed} m/s"
        number = "{} point {}".format(*map(words, map(int, str(flight.speed).split(".")))) if self.spelled else str(flight.speed)
        return self.pick(f"{number} {self.metre}s per second", f"{number} {self.metre}s per second", f"{number} {self.metre}s a second", f"{flight.speed} m/s")

    def done(self, text):
        return sentences(verbs(text, lambda verb, plural: conjugated(verb, plural, self.past)))

    # the person
    def who(self, flight, article=None):
        article = article or self.pick("a ", "the ")
        noun = self.pick("person", "person", "person", "individual", "figure", *(["walker", "pedestrian"] if flight.walks else ["subject"]))
        a = "an " if article == "a " and noun[0] in "aeiou" else article
        if flight.wear is None:
            return self.pick("one person", a + noun, a + noun) if article == "a " else a + noun
        top, legs, pack = flight.wear
        if self.metre == "meter":
            top, legs = top.replace("grey", "gray"), legs.replace("grey", "gray")
        trousers = self.pick("trousers", "trousers", "pants")
        atop, legwear = an(top) + " top", f"{legs} {trousers}"
        bag = self.pick("backpack", "backpack", "rucksack")
        if pack:
            choices = [f"{a}{noun} wearing {atop}, {legwear} and a {bag}", f"{a}{noun} with {atop}, {legwear} and a {bag}", f"{a}{noun} dressed in {atop} and {legwear} <who> [be] carrying a {bag}",
                       f"{article}{bag}-wearing {noun} in {atop} and {legwear}", f"{a}{noun} with a {bag} <who> [wear] {atop} and {legwear}", f"{a}{noun} in {legwear} and {atop} <who> [have] a {bag} on",
                       f"{a}{noun} carrying a {bag} and wearing {atop} with {legwear}", f"{a}{noun} whose <top> [be] {top}, whose <+{trousers}> [be] {legs} and <who> [carry] a {bag}",
                       f"{a}{noun} in {atop}, {legwear} and a {bag}", f"{a}{noun} with a {bag}, clad in {atop} and {legwear},", f"{a}{noun} (top: {top}, {trousers}: {legs}, plus a {bag})"]
            if top == legs:
                choices += [f"{a}{noun} with a {bag} whose <+top and {trousers}> [be] both {top}", f"{a}{noun} in an all-{top} outfit of top and {trousers}, complete with a {bag},"]
        else:
            choices = [f"{a}{noun} in {atop} and {legwear}", f"{a}{noun} wearing {atop} and {legwear}", f"{a}{noun} dressed in {atop} and {legwear}", f"{a}{noun} <who> [wear] {atop} and {legwear}",
                       f"{a}{noun} whose <top> [be] {top} and whose <+{trousers}> [be] {legs}", f"{a}{noun} in {atop} over {legwear}", f"{a}{noun} clad in {legwear} and {atop}", f"{a}{noun} with {legwear} and {atop}",
                       f"{a}{noun} in {atop} and {legwear} but without a {bag}", f"{a}{noun} (top: {top}, {trousers}: {legs})", f"{a}{noun} dressed in {top} above the waist and {legs} below it"]
            if top == legs:
                choices += [f"{a}{noun} whose <+top and {trousers}> [be] both {top}", f"{a}{noun} dressed in {top}, both top and {trousers},"]
        return self.pick(*choices) + "<>"

    def clothes(self, flight):
        """A sentence of its own about the clothes (for texts that begin with a bare person); empty where they are unknown."""
        if flight.wear is None:
            return ""
        top, legs, pack = flight.wear
        if self.metre == "meter":
            top, legs = top.replace("grey", "gray"), legs.replace("grey", "gray")
        bag = " and a backpack" if pack else ""
        extra = self.pick(", and there <>[be] a backpack on their back", ", and <they> [carry] a backpack") if pack else self.pick("", "", ", and <they> [carry] no backpack")
        joined = f"{an(top)} top, {legs} trousers{bag}" if pack else f"{an(top)} top and {legs} trousers"
        return self.pick(f"<They> [wear] {joined}. ", f"<They> [be] dressed in {joined}. ", f"Their <outfit> [consist] of {joined}. ", f"Their <top> [be] {top} and their <+trousers> [be] {legs}{extra}. ",
                         f"For clothing, <they> [have] on {joined}. ", f"<They> [be] recognizable by {joined}. ", f"<They> [be] wearing {joined}. ",
                         f"As to clothes, the <top> [be] {top} while the <+trousers> [be] {legs}{extra}. ", f"Above {legs} trousers, <they> [wear] {an(top)} top{extra}. ", f"<They> [have] {joined} on. ")

    def they(self, flight):
        return self.pick("<they>", "<they>", "<the person>", "<the subject>", *(["<the walker>"] if flight.walks else []))

    def them(self):
        return self.pick("them", "the person", "the subject")

    # distance
    def distance(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"at a distance of {d}", f"from {d} away", f"from a distance of {d}", f"at a range of {d}",
                         f", keeping a gap of {d}", f", staying {d} away", f", maintaining a separation of {d}", f", holding a distance of {d}", f"with {d} between drone and person", f"while leaving {d} of distance",
                         f"with {self.m_adjective(flight.distance)} gap in between", f"while remaining {d} away", f"at a straight-line distance of {d}")

    def distance_sentence(self, flight):
        d, t = self.m(flight.distance), self.pick("the person", "the subject", "them")
        return self.pick(f"<the drone> [stay] {d} away from {t}", f"<the drone> [keep] a distance of {d}", f"the <distance> between the drone and {t} [be] {d} on average", f"<{'+' if flight.distance > 1 else ''}{d}> [separate] the drone from {t}",
                         f"<the aircraft> [maintain] a gap of {d}", f"on average, <the drone> [be] {d} from {t}", f"there <>[be] {self.m_adjective(flight.distance)} gap between the drone and {t}",
                         f"measured in a straight line, <the drone> [remain] {d} from {t}", f"{self.m_adjective(flight.distance)} <distance> [be] kept from {t}", f"<{t if t != 'them' else 'the person'}> [be] {d} away from the drone",
                         f"the <drone>, for its part, [hold] a separation of {d}", f"a mean <distance> of {d} [lie] between {t} and the drone" if not self.past else f"a mean <distance> of {d} [be] kept between {t} and the drone")

    def distance_order(self, flight):
        d, t = self.m(flight.distance), self.them()
        return self.pick(f"keep {d} away from {t}", f"stay {d} from {t}", f"hold a distance of {d}", f"leave a gap of {d} between the drone and {t}", f"your distance to {t} should be {d}", f"make sure that there are {d} between you and {t}",
                         f"fly so that {t} is always {d} away".replace("them is", "they are"), f"I would like the drone to keep {self.m_adjective(flight.distance)} gap", f"maintain a separation of {d}", f"the drone ought to be {d} from {t}",
                         f"as far as distance goes, {d} is what I want", f"{d} is the distance to aim for", f"position the drone {d} from {t}")

    # pitch
    def pitch(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("with the camera held level", f"with the camera level at {a}", "with the lens pointing straight at the horizon", "with the camera perfectly horizontal", "with the camera tilted neither up nor down",
                             "with no tilt on the camera", f"with the camera pitch at {a}, in line with the horizon", "with the gimbal left level", "the camera looking out horizontally", f"the camera set to a pitch of {a}", "the lens kept parallel to the horizon")
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        return self.pick(f"with the camera tilted {a} {down}ward", f"with the camera angled {a} {below} the horizon", f"the camera pitched {down} by {a}", f"with the lens pointing {a} {below} the horizontal",
                         f"with the lens aimed {a} {below} the horizon", f"with {'a' if down == 'down' else 'an'} {down}ward camera tilt of {a}", f"with the gimbal set {a} {below} the horizon", f"the camera looking {down} at an angle of {a}",
                         f"with the camera's line of sight inclined {down}ward by {a}", f"with the optical axis {a} {below} the horizontal", f"with the view tipped {a} {down}", f"the camera facing {a} {below} the level of the horizon")

    def pitch_sentence(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("<the camera> [be] level", f"<the camera> [have] a pitch of {a}", "<the lens> [point] straight at the horizon", "<the camera> [be] tilted neither up nor down", "<the view> [stay] horizontal", "there <>[be] no tilt on the camera",
                             f"the camera <angle> [be] {a}, level with the horizon", "<the gimbal> [keep] the camera level", "<the camera> [look] out horizontally", "<the line of sight> [run] parallel to the horizon" if not self.past else "<the line of sight> [be] parallel to the horizon",
                             "instead of tilting, <the camera> [remain] horizontal")
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        return self.pick(f"<the camera> [point] {a} {below} the horizon", f"<the camera> [be] tilted {a} {down}ward", f"<the lens> [look] {down} at an angle of {a} to the horizontal", f"<the view> [be] inclined {a} {down}ward",
                         f"measured from the horizon, <the camera> [look] {a} {down}ward", f"<the gimbal> [hold] the camera {a} {below} the horizon", f"the camera <pitch> [be] {a} {below} horizontal", f"{'a' if down == 'down' else 'an'} {down}ward <tilt> of {a} [be] used for the camera",
                         f"<the optical axis> [be] {a} {below} the horizontal", f"<the camera>, pitched {down} by {a}, [have] the person in view", f"<the camera> [gaze] {down} by {a}", f"the <angle> at which the camera [look] {down} [be] {a}")

    def pitch_order(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("keep the camera level", "hold the camera horizontal", "point the lens straight at the horizon", "tilt the camera neither up nor down", f"set the camera pitch to {a}, level with the horizon", "leave the gimbal level",
                             "the camera should look out horizontally", "I want the camera level", f"make sure that the camera stays at {a}", "no camera tilt is needed, so leave it level", "have the camera face the horizon squarely, without any tilt")
        down, below = ("down", "below") if flight.pitch > 0 else ("up", "above")
        return self.pick(f"tilt the camera {a} {down}ward", f"set the gimbal so that the lens looks {a} {below} the horizon", f"point the camera {a} {below} the horizontal", f"angle the lens {down} by {a}", f"the camera should be pitched {a} {down}",
                         f"I want the camera to look {a} {below} the horizon", f"make sure that the lens is aimed {a} {below} the horizon", f"have the camera face {down}ward at an angle of {a}", f"give the camera {'a' if down == 'down' else 'an'} {down}ward tilt of {a}",
                         f"as for the camera, let it look {down} at {a}", f"the line of sight should run {a} {below} the horizontal", f"the camera angle I have in mind is {a} {below} the horizon", f"pitch the camera {down} until it is {a} {below} the horizon")

    # height
    def height(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"at a height of {h}", f"{h} above the person's feet", f"at an altitude of {h} over the ground at the person's feet", f"from a height of {h} above the person's feet", f"flying {h} up", f"at an altitude of {h}",
                         f"from an altitude of {h}", f"{h} higher than the person's feet", f"at a flying height of {h}", f"while flying at a height of {h}", f"while staying {h} above the level of the person's feet")

    def height_sentence(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"<the drone> [fly] {h} above the person's feet", f"the flying <height> [be] {h}", f"<the drone> [be] {h} higher than the person's feet", f"<the aircraft> [keep] an altitude of {h}", f"<the drone> [stay] at a height of {h}",
                         f"measured from the person's feet, the <altitude> [be] {h}", f"in terms of altitude, <the drone> [be] {h} above the ground at the person's feet", f"the <aircraft's height> above the person's feet [be] {h}",
                         f"an <altitude> of {h} [be] maintained", f"vertically, <{'+' if flight.altitude > 1 else ''}{h}> [separate] the drone from the person's feet", f"<it> [be] at an altitude of {h} that the drone [fly]")

    def height_order(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"fly {h} above the person's feet", f"keep an altitude of {h}", f"stay at a height of {h}", f"the flying height should be {h}", f"I would like you to fly at {h} above the person's feet", f"climb to {h} and stay there",
                         f"make {h} your altitude", f"hold the drone {h} above the ground that the person is on", f"for altitude, go with {h}", f"let the drone fly at a height of {h}")

    # turns
    def ordered(self, items):
        if len(items) == 1:
            return items[0]
        if len(items) == 2:
            a, b = items
            return self.pick(f"{a} and then {b}", f"{a}, then {b}", f"first {a} and then {b}", f"first {a}, later {b}")
        *most, z = items
        return self.pick(", ".join(most) + f", and then {z}", ", then ".join(items), ", then ".join(most) + f" and finally {z}", f"first {most[0]}, then " + ", then ".join(most[1:]) + f", and lastly {z}")

    def turn_noun(self, turn):
        return self.pick("a U-turn", "a U-turn", "an about-turn", "a reversal of direction") if turn == "around" else self.pick(f"a {turn} turn", f"a {turn} turn", f"a turn to the {turn}")

    def turn_verb(self, turn):
        if turn == "around":
            return self.pick("[turn] around", "[make] a U-turn", "[double] back", "[turn] back", "[reverse] direction", "[make] an about-turn")
        return self.pick(f"[turn] {turn}", f"[turn] {turn}", f"[make] a {turn}", f"[take] a {turn}", f"[turn] to the {turn}", f"[make] a {turn} turn", f"[swing] {turn}")

    def turning(self, flight):
        """A verb phrase of the person."""
        turns, k = flight.turns, len(flight.turns)
        if not k:
            return self.pick("never [turn]", "[make] no turns", "[go] straight on without turning", "[make] no turn of any kind", "[take] neither a left nor a right and never [turn] around", "[continue] without a single turn", "[keep] going without any turns")
        if k == 1:
            t = turns[0]
            if t == "around":
                return self.pick("[turn] around once", "[make] a single U-turn", "[double] back once", "[turn] around a single time", "[reverse] direction once", "[make] one turn, a U-turn", "[make] exactly one about-turn")
            return self.pick(f"[turn] {t} once", f"[make] a single {t} turn", f"[take] one {t} turn", f"[turn] once, to the {t}", f"[make] one turn, a {t}", f"[make] just one turn, namely to the {t}", f"[turn] to the {t} a single time", f"[take] a {t} once")
        if len(set(turns)) == 1:
            t, count = turns[0], self.count(k)
            if t == "around":
                return self.pick(f"[turn] around {self.times(k)}", f"[make] {count} U-turns", f"[reverse] direction {self.times(k)}", f"[double] back {self.times(k)}", f"[make] {count} turns, each of them a U-turn")
            return self.pick(f"[turn] {t} {self.times(k)}", f"[make] {count} {t} turns", f"[take] {count} {t}s", f"[make] {count} turns, all of them to the {t}", f"[turn] to the {t} {self.times(k)}", f"[turn] {self.times(k)}, always to the {t}")
        runs = []
        for t in turns:
            if runs and runs[-1][0] == t:
                runs[-1][1] += 1
            else:
                runs.append([t, 1])
        choices = ["[turn] " + self.ordered(turns), self.ordered([self.turn_verb(t) for t in turns]), "[make] " + self.ordered([self.turn_noun(t) for t in turns]),
                   f"[change] direction {self.times(k)}: " + self.ordered(turns), f"[make] {self.count(k)} turns, namely " + self.ordered([self.turn_noun(t) for t in turns]), f"[turn] {self.times(k)}, " + self.ordered(turns),
                   f"[make] {self.count(k)} turns (" + ", ".join(turns) + ")", f"[make] {self.turn_noun(turns[0])}, followed by " + ", then ".join(self.turn_noun(t) for t in turns[1:])]
        if len(runs) < k:
            grouped = [t if c == 1 else f"{t} {self.times(c)}" for t, c in runs]
            choices += ["[turn] " + ", then ".join(grouped)] * 2
        if k == 2:
            a, b = turns
            choices += [f"[turn] {a} before turning {b}", f"[turn] {b} after an earlier turn to the {a}" if "around" not in turns else f"[turn] {a} before turning {b}"]
        return self.pick(*choices)

    def turns_sentence(self, flight):
        turns, k = flight.turns, len(flight.turns)
        t = self.they(flight)
        if not k:
            return self.pick(f"{t} {self.turning(flight)}", "the <walk> [include] no turns", "there <+>[be] no turns along the way", "not a single <turn> [be] made", "at no point [do] the person turn".replace("[do]", "did" if self.past else "does"), f"{t} {self.turning(flight)}")
        one = self.turn_noun(turns[0])
        nouns = self.ordered([self.turn_noun(x) for x in turns])
        choices = [f"{t} {self.turning(flight)}"] * 4 + [f"along the way, {t} {self.turning(flight)}", f"during the walk, {t} {self.turning(flight)}", f"the <walk> [include] {nouns}", f"the <route> [involve] {nouns}",
                                                        f"there <+>[be] {self.count(k)} turns in all: " + self.ordered(turns) if k > 1 else f"there <>[be] one turn, {one}",
                                                        f"the <+turns>, in order, [be] {', then '.join(turns)}" if k > 1 else f"the only <turn> [be] {one}", f"what <they> [do] along the way is {infinitive(self.turning(flight))}".replace(" is ", " was " if self.past else " is ")]
        return self.pick(*choices)

    def turns_noun(self, flight):
        """After a statement of the walk: with ..."""
        if not flight.turns:
            return self.pick("without any turns", "without a single turn", "with no turns at all", "without ever turning")
        nouns = [self.turn_noun(x) for x in flight.turns]
        return self.pick("with " + self.ordered(nouns), "with " + self.ordered(nouns) + " along the way", doing(self.turning(flight)), doing(self.turning(flight)))

    # stops
    def stopping(self, flight):
        k, t = flight.stops, self.s(flight.standing)
        if not k:
            return self.pick("never [stop]", "[make] no stops", "[keep] going without a pause", "never [pause]", "[take] no breaks", "never [come] to a halt", "[go] on without pausing even once")
        if k == 1:
            return self.pick(f"[stop] once, for {t}", f"[pause] once and [stand] still for {t}", f"[make] one stop of {t}", f"[come] to a halt once, for {t}", f"[stop] a single time for {t}", f"[take] a single break of {t}", f"[stand] still once, for {t}",
                             f"[pause] for {t} on one occasion", f"[spend] {t} standing still during one pause")
        c = self.count(k)
        return self.pick(f"[stop] {self.times(k)}, for a total of {t}", f"[pause] {self.times(k)}, {t} altogether", f"[make] {c} stops with a combined length of {t}", f"[spend] {t} standing still, spread over {c} pauses", f"[take] {c} breaks totaling {t}",
                         f"[come] to a halt {self.times(k)}, for {t} in all", f"[stand] still for {t} in total over the course of {c} stops", f"[pause] on {c} occasions for {t} all told", f"[stop] {self.times(k)} and [stand] still for {t} in all", f"[interrupt] the walk {self.times(k)}, for {t} altogether")

    def stops_sentence(self, flight):
        k, t, p = flight.stops, self.s(flight.standing), self.they(flight)
        if not k:
            return self.pick(f"{p} {self.stopping(flight)}", f"{p} {self.stopping(flight)}", "there <+>[be] no pauses", "the <walk> [be] not interrupted by any pause", "not once did the walk come to a halt" if self.past else "not once does the walk come to a halt", "the <walk> [contain] no stops")
        if k == 1:
            return self.pick(f"{p} {self.stopping(flight)}", f"{p} {self.stopping(flight)}", f"at one point, {p} [pause] for {t}", f"there <>[be] one pause, which [last] {t}", f"the <walk> [be] interrupted once, for {t}", f"a single <stop> [take] {t}", f"the only <pause> [last] {t}",
                             f"one <pause> of {t} [interrupt] the walk")
        c = self.count(k)
        return self.pick(f"{p} {self.stopping(flight)}", f"{p} {self.stopping(flight)}", f"there <+>[be] {c} pauses, which together [last] {t}", f"the <walk> [be] interrupted {self.times(k)}, for {t} in total", f"<+{c} stops> [add] up to {t} of standing still",
                         f"taken together, the <+{c} pauses> [last] {t}", f"<+{c} pauses>, {t} in total, [interrupt] the walk", f"in the course of {c} stops, {p} [stand] still for {t} altogether")

    def stops_noun(self, flight):
        k, t = flight.stops, self.s(flight.standing)
        if not k:
            return self.pick("without a single pause", "without stopping", "with no stops", "without ever coming to a halt", "never pausing")
        if k == 1:
            return self.pick(f"with one pause of {t}", f"with a single stop of {t}", f"pausing once for {t}", f"with one stop that <>[last] {t}", f"stopping just once, for {t}")
        c = self.count(k)
        return self.pick(f"with {c} pauses totaling {t}", f"with {c} stops of {t} altogether", f"pausing {self.times(k)} for a total of {t}", f"with {c} pauses that together <+>[last] {t}", f"stopping {self.times(k)}, for {t} in all")

    # length, speed, time
    def walking(self, flight):
        w, v = self.m(flight.way), self.speed(flight)
        at = self.pick(f"at an average speed of {v}", f"at a mean walking speed of {v}", f"at {v}", f"averaging {v}", f"at a speed of {v} on average", f"at an average pace of {v}")
        return self.pick(f"[walk] {w} {at}", f"[cover] {w} {at}", f"[walk] a total of {w} {at}", f"[travel] {w} on foot {at}", f"[walk] for a total of {w} {at}", f"[complete] a walk of {w} {at}", f"[go] {w} on foot {at}",
                         f"[walk] {w} in all, {at}", f"[make] a walk of {w} {at}", f"[cover] a distance of {w} on foot {at}")

    def walk_sentence(self, flight):
        w, v, p = self.m(flight.way), self.speed(flight), self.they(flight)
        return self.pick(*[f"{p} {self.walking(flight)}"] * 4, f"the <walk> [measure] {w} in total, and the mean walking <speed> [be] {v}", f"the <route> [be] {w} long and [be] walked at an average of {v}", f"<+{w}> [be] covered on foot, at {v} on average",
                         f"{p} [average] {v} over a walk of {w}", f"at an average of {v}, {p} [walk] {w} in all", f"the <length> of the walk [come] to {w}, the average <speed> to {v}", f"moving at {v} on average, {p} [cover] {w}")

    def time_sentence(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"the <flight> [last] {t}", f"the whole <flight> [take] {t}", f"in all, the <flight> [last] {t}", f"the <recording> [run] for {t}" if not self.past else f"the <recording> [last] {t}", f"the <flight> [be] over after {t}", f"from beginning to end, the <flight> [take] {t}",
                         f"<+{t}> [pass] between the start and the end of the flight", f"the <duration> of the flight [be] {t}", f"<it> [be] a flight of {t}", f"the <flight> [come] to an end after {t}", f"the total flight <time> [be] {t}")

    def time_open(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"over the course of {t}", f"during a flight of {t}", f"for {t}", f"throughout a flight that [last] {t}", f"in a flight of {t}", f"over a period of {t}", f"in footage lasting {t}")

    def standing(self, flight):
        return self.pick("[stand] on one spot", "[stay] put", "[remain] standing in the same place", "[stand] still", "never [leave] the spot", "[stand] in one place without walking", "[keep] standing where they are" if not self.past else "[keep] standing on the same spot",
                         "[stay] on the same spot, standing", "[stand] there without taking a step", "[remain] stationary on their feet")

    def standing_time(self, flight):
        t, p, v = self.s(flight.duration), self.they(flight), self.standing(flight)
        return self.pick(f"{p} {v} for the whole flight, which [last] {t}", f"for all {t} of the flight, {p} {v}", f"{p} {v} during the entire flight of {t}", f"throughout the flight, {p} {v}; {self.time_sentence(flight)}", f"{self.time_sentence(flight)}, and all that time {p} {v}",
                         f"from the first second to the last, {t} in all, {p} {v}", f"the <flight> [last] {t}, during which {p} {v}", f"not once in the {t} of the flight do they walk anywhere; <they> simply [stand] there".replace("do they", "did they" if self.past else "do they"),
                         f"standing on one spot, {p} [stay] there for the {t} that the <flight> [last]", f"there <>[be] no walking at all, since {p} {v} for the full {t}")

    # instruction
    def forecast(self, flight):
        """What the person will do, said by the one who orders the flight; may be empty."""
        if not flight.walks:
            return self.pick("", "", "the person stands on one spot the whole time. ", "they are not going to walk; they stand still. ", "since the person stays where they are, there is no walk to follow. ", "note that the person remains standing in one place. ")
        out = ""
        if self.rng.random() < .25:
            out += f"they will {infinitive(self.turning(flight))}. " if flight.turns else self.pick("there will be no turns. ", "you need not expect any turns. ", "the person will not turn. ")
            if flight.turns and self.rng.random() < .4:
                out = self.pick(f"expect them to {infinitive(self.turning(flight))}. ", f"be ready: the person is going to {infinitive(self.turning(flight))}. ", f"on the way, the person will {infinitive(self.turning(flight))}. ", f"stay with them as they {infinitive(self.turning(flight))}. ")
        if self.rng.random() < .2:
            out += self.pick(f"the person will {infinitive(self.stopping(flight))}. ", f"expect them to {infinitive(self.stopping(flight))}. ") if flight.stops else self.pick("there will be no stops. ", "the person will not pause at all. ", "no pauses are to be expected. ")
        if self.rng.random() < .15:
            out += self.pick(f"the walk is {self.m(flight.way)} long. ", f"they will walk {self.m(flight.way)} in all. ", f"expect an average walking speed of {self.speed(flight)}. ", f"all in all, the person will cover {self.m(flight.way)} on foot. ")
        return out

    def extras(self, flight):
        out = []
        if flight.altitude >= 1 and self.rng.random() < .4:
            out.append(self.height_order(flight) + ". ")
        if self.rng.random() < .2:
            t = self.s(flight.duration)
            out.append(self.pick(f"film for {t}. ", f"the flight should last {t}. ", f"keep this up for {t}. ", f"you have {t} for the whole flight. ", f"end the flight after {t}. "))
        out.append(self.forecast(flight))
        self.rng.shuffle(out)
        return "".join(out)

    def chase(self, flight):
        return self.pick("follow", "track", "stay with", "keep up with", "accompany", "shadow", "film", "go along with") if flight.walks else self.pick("film", "keep the camera on", "watch", "record", "keep filming", "observe")

    def instruction(self, flight):
        self.voice()
        who, d, a, verb = self.who(flight), self.distance(flight), self.pitch(flight), self.chase(flight)
        the = self.who(flight, "the ")
        d_order, a_order = self.distance_order(flight), self.pitch_order(flight)
        move = self.pick("walks", "walks along", "makes their way on foot", "moves along on foot") if flight.walks else self.pick("stands on one spot", "stands still", "stays where they are")
        asking = self.pick("Could you please", "Would you mind if I asked you to", "Can you", "Would you")
        text = self.pick(
            f"{verb} {who} {d}, {a}. ",
            f"{verb} {who}. {d_order}, and {lower(a_order)}. ",
            f"{verb} {who}. {a_order}. {d_order}. ",
            f"I would like you to {verb} {who} {d}, {a}. ",
            f"{asking} {verb} {the} {d}, {a}? ",
            f"{a}, {verb} {who} {d}. ",
            f"your subject is {the}. {d_order}; {lower(a_order)}. ",
            f"for this shot, {d_order}, and {a_order}; the subject is {the}. ",
            f"as {the} {move}, {verb} them {d}, {a}. ",
            f"while {the} {move}, {lower(d_order)}. {a_order}. ",
            f"what I need is a shot of {who}, taken from {self.m(flight.distance)} away {a}. ",
            f"the task is simple: {verb} {the} {d}. {a_order} the entire time. " if flight.pitch and a_order.startswith(("tilt", "point", "angle")) else f"the task is simple: {verb} {the} {d}. {a_order}. ",
            f"please make sure that {the} stays in the picture. {a_order}, and {lower(d_order)}. ",
            f"subject: {who}. Distance: {self.m(flight.distance)}. Camera: {self.note(flight)}. ",
            f"- {verb} {the}\n- {d_order}\n- {a_order}\n",
            f"how about this: {verb} {who} {d}, {a}. ",
            f"{verb} the person {d}, {a}. {self.clothes(flight)}",
            f"fly the drone at a distance of {self.m(flight.distance)} from {the}, {a}. ",
            f"before anything else, {a_order}. then {verb} {the} {d}. " if not a_order.startswith(("the ", "I ", "no ", "as ")) else f"then there is the camera: {a_order}. {verb} {the} {d}. ".replace("then there is the camera", "first, the camera"),
            f"{the} is the one to {verb}, {d} and {a}. ",
        ).replace("<>", "").replace(" ,", ",").replace(",,", ",").replace(",.", ".").replace(",;", ";").replace(",?", "?").replace(", and with", " and with")
        extra = self.extras(flight)
        if text.startswith("- ") and extra:
            extra = "".join(f"- {x}\n" for x in extra.strip().rstrip(".").split(". "))
        if extra and self.rng.random() < .1 and not text.startswith("- "):
            text = extra + text if "they" not in extra and "them" not in extra and "person" not in extra else text + extra
        else:
            text += extra
        return self.done(text.strip())

    def note(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("level", f"{a}, level", "horizontal", "no tilt", f"pitch {a}")
        return self.pick(f"{a} below the horizon", f"tilted {a} down", f"{a} downward", f"pitched down {a}", f"looking {a} below horizontal") if flight.pitch > 0 else \
            self.pick(f"{a} above the horizon", f"tilted {a} up", f"{a} upward", f"pitched up {a}", f"looking {a} above horizontal")

    # description
    def tracked(self, flight):
        return self.pick("[follow]", "[track]", "[accompany]", "[shadow]", "[stay] with", "[keep] up with", "[film]") if flight.walks else self.pick("[film]", "[watch]", "[record]", "[observe]", "[keep] its camera on")

    def followed(self, flight):
        return self.pick("followed", "tracked", "accompanied", "filmed", "shadowed") if flight.walks else self.pick("filmed", "watched", "recorded", "observed")

    def notes(self, flight):
        turns = ", ".join(flight.turns) or "none"
        t = self.s(flight.standing)
        stops = "none" if not flight.stops else f"{flight.stops}, {t} " + self.pick("in total", "altogether", "in all") if flight.stops > 1 else f"one, {t}" + self.pick("", " long")
        items = [self.pick("Subject: ", "Person: ", "Who: ") + self.who(flight, "a ").replace(",<>", "<>"), self.pick("Distance: ", "Distance to the person: ", "Drone-to-person distance: ") + self.m(flight.distance), self.pick("Camera: ", "Camera angle: ", "Camera tilt: ") + self.note(flight),
                 self.pick("Flight time: ", "Duration: ", "Length of the flight: ") + self.s(flight.duration)]
        if flight.altitude >= 1:
            items.append(self.pick("Altitude: ", "Flying height: ", "Height above the person's feet: ") + self.m(flight.altitude))
        if flight.walks:
            items += [self.pick("Turns: ", "Turns, in order: ", "Changes of direction: ") + turns, self.pick("Stops: ", "Pauses: ") + stops, self.pick("Distance walked: ", "Length of the walk: ", "Walked: ") + self.m(flight.way), self.pick("Average walking speed: ", "Mean speed on foot: ", "Average pace: ") + self.speed(flight)]
        else:
            items.append(self.pick("Movement: none, the person stands on one spot", "Activity: standing in one place", "The person stands still throughout"))
        first, rest = items[0], items[1:]
        self.rng.shuffle(rest)
        items = [first] + rest
        style = self.pick("\n- ", "; ", ". ", "\n* ")
        return (style.strip(" ") + " " if style[0] == "\n" else "").lstrip("\n") + style.join(items) + ("" if style[0] == "\n" else ".")

    def sentences_of(self, flight, kinds):
        made = dict(turns=self.turns_sentence, stops=self.stops_sentence, walk=self.walk_sentence, time=self.time_sentence, distance=self.distance_sentence, pitch=self.pitch_sentence, height=self.height_sentence, stand=self.standing_time)
        kinds = [k for k in kinds if k != "height" or flight.altitude >= 1]
        out, at = [], 0
        while at < len(kinds):
            s = made[kinds[at]](flight)
            if at + 1 < len(kinds) and self.rng.random() < .4 and ";" not in s and ":" not in s:
                more = made[kinds[at + 1]](flight)
                s += self.pick(", and ", "; ", ", while " if more.startswith(("the ", "<the ")) else ", and ", ", and ") + more
                at += 1
            out.append(s + ". ")
            at += 1
        return "".join(out)

    def drone_rest(self, flight, kinds=("distance", "pitch", "height")):
        kinds = list(kinds)
        self.rng.shuffle(kinds)
        return self.sentences_of(flight, kinds)

    def motion(self, flight):
        """Turns, stops, way and speed of a walker."""
        p = self.they(flight)
        mixed = ["turns", "stops", "walk"]
        self.rng.shuffle(mixed)
        return self.pick(
            self.sentences_of(flight, mixed),
            f"{doing(self.turning(flight))}, {p} {self.walking(flight)}. {self.stops_sentence(flight)}. ",
            f"{p} {self.walking(flight)}, {self.stops_noun(flight)}. {self.turns_sentence(flight)}. ",
            f"{p} {self.walking(flight)}, {self.turns_noun(flight)}. {self.stops_sentence(flight)}. ",
            f"{p} {self.turning(flight)}, and in the course of the walk <they> {self.stopping(flight)}; {self.walk_sentence(flight)}. ",
            f"on the whole walk, which <>[be] {self.m(flight.way)} long and [have] a mean speed of {self.speed(flight)}, {p} {self.turning(flight)}; <they> {self.stopping(flight)}. ",
            f"{doing(self.walking(flight))}, {p} {self.turning(flight)}. {self.stops_sentence(flight)}. ",
            f"{self.walk_sentence(flight)}. Apart from that, <they> {self.turning(flight)}, and <they> {self.stopping(flight)}. ")

    def description(self, flight):
        self.voice(past=self.rng.random() < .55)
        if self.rng.random() < .08:
            return self.done(self.notes(flight))
        text = (self.walk_text if flight.walks else self.stand_text)(flight)
        for a, b in ((" ,", ","), (",<>", "<>,"), (",,", ","), (",.", "."), (",;", ";"), (",:", ":")):
            text = text.replace(a, b)
        return self.done(text.strip())

    def stand_text(self, flight):
        who, d, a, t = self.who(flight), self.distance(flight), self.pitch(flight), self.tracked(flight)
        drone = self.pick("a drone", "a camera drone", "the drone", "the camera drone")
        high = self.sentences_of(flight, ["height"])
        stand = self.standing_time(flight) + ". "
        return self.pick(
            f"<{drone}> {t} {who} {d}, {a}. {stand}{high}",
            f"<{who}> {self.standing(flight)} while {drone} {t} the scene {d}, {a}. {high}{self.time_sentence(flight)}. ".replace("[keep] its camera on the scene", "[film]").replace(" the scene", " them"),
            f"{self.time_open(flight)}, <{drone}> {t} {who} <who> [stand] on one spot. ".replace(", <who>", " <who>") + self.drone_rest(flight),
            f"{a}, <{drone}> {t} {who} {d}. {high}{stand}",
            f"this <footage> [show] {who}. {stand}{self.drone_rest(flight)}",
            f"<{who}> [be] {self.followed(flight)} by {drone} {d}, {a}. {stand}{high}",
            stand.replace("<they>", "<the person>", 1) + f"<It> [be] {who} that {drone} {t}. {self.drone_rest(flight)}",
            f"<{drone}> {t} a person. {self.clothes(flight)}{stand}{self.drone_rest(flight)}",
            f"what the <recording> [show] [be] {who}, standing in one place. {self.drone_rest(flight)}{self.time_sentence(flight)}. ",
            f"{self.time_sentence(flight)}. in that time, <{drone}> {t} {who}, and <the person> {self.standing(flight)}. {self.drone_rest(flight)}")

    def walk_text(self, flight):
        who, d, a, t = self.who(flight), self.distance(flight), self.pitch(flight), self.tracked(flight)
        drone = self.pick("a drone", "a camera drone", "the drone", "the camera drone")
        high = self.sentences_of(flight, ["height"])
        at_height = " " + self.pick(*[f"{x} {self.m(flight.altitude)}" for x in ("at a height of", "at an altitude of", "from an altitude of", "at a flying height of", "from a height of")]) if flight.altitude >= 1 else ""
        time, motion = self.time_sentence(flight) + ". ", self.motion(flight)
        opened = self.time_open(flight)
        return self.pick(
            f"<{drone}> {t} {who} {d}, {a}. {motion}{high}{time}",
            f"{opened}, <{drone}> {t} {who} {d}, {a}. {high}{motion}",
            f"<{who}> [be] {self.followed(flight)} by {drone} {d}, {a}. {high}{time}{motion}",
            f"{a}, <{drone}> {t} {who} {d}. {motion}{time}{high}",
            f"<{who}> {self.walking(flight)}, {self.stops_noun(flight)}, while {drone} {t} them {d}. ".replace("<They>", "they") + f"{self.turns_sentence(flight)}. " + self.sentences_of(flight, ["pitch", "height", "time"]),
            f"this <clip> [show] {who}. {motion}{self.drone_rest(flight)}{time}",
            time + motion.replace("<they>", "<the person>", 1) + f"All the while, <{drone}> {t} {self.pick('this person', 'the person')} {d}, {a}. {self.clothes(flight)}{high}",
            f"<{drone}> {t} a person on foot. {self.clothes(flight)}{motion}{self.drone_rest(flight)}{time}",
            f"{opened}, <{who}> {self.walking(flight)}, {self.turns_noun(flight)}. {self.stops_sentence(flight)}. {self.drone_rest(flight)}",
            f"{self.drone_rest(flight)}the <one being filmed> [be] {who}. {motion}{time}" if self.rng.random() < .5 else f"{self.time_sentence(flight)}, and its <subject> [be] {who}. {self.drone_rest(flight)}{motion}",
            f"<{who}> {self.turning(flight)} and, over a walk of {self.m(flight.way)} at an average of {self.speed(flight)}, {self.stopping(flight)}, all of which {drone} [record] {d}, {a}. {time}{high}",
            f"as <{who}> {self.walking(flight)}, <{drone}> {t} them {d}, {a}. {self.sentences_of(flight, ['turns', 'stops', 'time', 'height'])}",
            f"in this flight, which [last] {self.s(flight.duration)}, <{drone}>{',' + at_height + ',' if at_height else ''} {t} {who} {d}, {a}. {motion}",
            f"<{drone}> [fly]{at_height or ' along'}, {a}, and {t} {who} {d}. {motion}{time}",
            motion.replace("<they>", "<the person>", 1) + f"{time}it [be] {who} that {drone} {t}. {self.drone_rest(flight)}".replace("it [be]", "<it> [be]"))

    # wrong texts
    def tail(self, text):
        text = text.rstrip()
        end = text[-1] if text[-1] in ".?!" else ""
        return (text[:-1] if end else text), end or ("" if "\n" in text else ".")

    def foreign(self, text):
        body, end = self.tail(text)
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        choices = [f"{body}, {thing}{end}", f"{body}, {thing}{end}", f"{text} All of this happens {thing}.", f"{text} The scene plays out {thing}.", f"{text} A {person} walks right beside them.", f"{text} In the background, a {person} looks on.",
                   f"{text} The person is a {person}.", f"{text} Judging by appearances, this is a {person}."]
        if "the person" in text:
            choices += [text.replace("the person", "the " + person, 1)] * 2
        return self.pick(*choices)

    def heading(self, text, direction):
        body, end = self.tail(text)
        return self.pick(f"{text} The person walks {direction}.", f"{text} They are heading {direction}.", f"{text} The walk leads toward the {direction}.", f"{body}, walking {direction}{end}", f"{text} {direction.capitalize()} is the direction in which the person walks.",
                         f"{text} Their course takes them {direction}.", f"{text} The person's destination lies to the {direction}, and that is the way they walk.", f"{body}, with the person moving toward the {direction}{end}", f"{text} All the walking is done in {'an' if direction[0] == 'e' else 'a'} {direction}erly direction.",
                         f"{text} On foot, the person makes for the {direction}.")


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


class FifteenthChinese(Grammar):
    code = "zh"
    things = ["旁边有一座喷泉", "路边停着一排汽车", "远处雷声隆隆", "手里牵着两条狗", "撑着一把雨伞", "教堂钟声正响", "身旁是一家面包店", "脚下是一座石桥", "天上下着大雨", "两侧长满梧桐树", "时值傍晚", "背景是一所小学", "推着一辆自行车", "手里端着一杯咖啡", "有轨电车从旁驶过",
              "周围挤满了游客", "当天大雾弥漫", "沿着河边", "就在公交站牌旁", "头戴一顶草帽", "正在打电话", "雪花纷纷飘落", "穿过热闹的菜市场", "推着婴儿车", "一群鸽子飞起", "夕阳洒在墙上"]
    persons = ["护士", "渔民", "老太太", "小学生", "交警", "小伙子", "姑娘", "外卖员", "老大爷", "士兵", "快递小哥", "导游", "新娘", "大学生"]

    def voice(self):
        self.spelled = self.rng.random() < .15
        self.gap = "" if self.spelled or self.rng.random() < .75 else " "
        self.latin = not self.spelled and not self.gap and self.rng.random() < .15

    def n(self, number, unit):
        if self.spelled:
            return ("两" if number == 2 else hanzi(number)) + unit
        return f"{number}{self.gap}{unit}"

    def m(self, number):
        return f"{number}m" if self.latin else self.n(number, "米")

    def s(self, number):
        return self.n(number, self.pick("秒", "秒", "秒", "秒钟"))

    def c(self, number, unit):
        if self.spelled or number < 10 and self.rng.random() < .65:
            return ("两" if number == 2 else hanzi(number)) + unit
        return f"{number}{self.gap}{unit}"

    def degrees(self, flight):
        number = abs(flight.pitch)
        return hanzi(number) + "度" if self.spelled else f"{number}°" if self.latin else f"{number}{self.gap}度"

    def speed(self, flight):
        if self.latin:
            return f"{flight.speed}m/s"
        number = "点".join(hanzi(int(x)) for x in str(flight.speed).split(".")) if self.spelled else f"{flight.speed}"
        return self.pick(f"每秒{self.gap}{number}{self.gap}米", f"每秒{self.gap}{number}{self.gap}米", f"{number}{self.gap}米每秒" if self.spelled else f"{number}{self.gap}米/秒")

    def colour(self, colour):
        return self.pick(*[ZH_COLOURS[colour] + "色"] * 4, *dict(orange=["橘色"], brown=["褐色"], pink=["粉红色"]).get(colour, []))

    def spaced(self, text):
        """In texts with a space between figures and characters: the space on both sides."""
        if not self.gap:
            return text
        out = text[0]
        for a, b in zip(text, text[1:]):
            out += " " if a.isdigit() and "\u4e00" <= b <= "\u9fff" or b.isdigit() and "\u4e00" <= a <= "\u9fff" else ""
            out += b
        return out

    # the person
    def who(self, flight):
        noun = self.pick("人", "人", "目标人物") if not flight.walks else self.pick("人", "人", "人", "行人", "行人", "步行者")
        one = {"人": self.pick("一个人", "一人", "一个人"), "人物": "一个人物", "目标人物": "目标人物", "行人": "一名行人", "步行者": "一名步行者"}[noun]
        the = {"人": self.pick("那个人", "这个人"), "人物": "画面中的人物", "目标人物": "目标人物", "行人": "这名行人", "步行者": "那名步行者"}[noun]
        if flight.wear is None:
            return self.pick(one, the)
        top, legs, pack = flight.wear
        t, l = self.colour(top), self.colour(legs)
        l = t if top == legs else l
        trousers = self.pick("裤子", "裤子", "长裤")
        bag = self.pick("背包", "双肩包")
        article = self.pick("一个", "那个", "那名" if noun in ("行人", "步行者") else "那个", "一名" if noun in ("行人", "步行者") else "一个")
        if noun == "目标人物":
            noun, article = "人", self.pick("一个", "那个")
        choices = [f"{article}穿{t}上衣、{l}{trousers}{{}}的{noun}", f"{article}上身穿{t}、下身穿{l}{{}}的{noun}", f"{article}身穿{t}上衣和{l}{trousers}{{}}的{noun}", f"{article}上衣{t}、裤子{l}{{}}的{noun}", f"{article}身着{t}上衣、{l}{trousers}{{}}的{noun}",
                   f"{article}上着{t}上衣、下着{l}{trousers}{{}}的{noun}", f"{article}{t}上衣配{l}{trousers}{{}}的{noun}", f"穿{t}上衣和{l}{trousers}{{}}的{article}{noun}" if article[0] == "那" else f"{article}穿着{t}上衣、{l}{trousers}{{}}的{noun}"]
        if top in ("black", "grey", "white", "red", "yellow", "green", "blue", "purple") and legs in ("black", "grey", "white", "red", "yellow", "green", "blue", "purple"):
            choices.append(f"{article}{ZH_COLOURS[top]}衣{ZH_COLOURS[legs]}裤{{}}的{noun}")
        if top == legs:
            choices.append(f"{article}上衣和裤子都是{t}{{}}的{noun}")
        text = self.pick(*choices)
        if pack:
            if self.rng.random() < .25:
                return text.format("").replace(article, f"{article}背着{bag}、", 1) if text.startswith(article) else f"背着{bag}、" + text.format("")
            return text.format(self.pick(f"、背着{bag}", f"、背{bag}", f"、身背{bag}"))
        return text.format(self.pick("", "", "", "", "、没背包", "、没有背包"))

    def clothes(self, flight):
        if flight.wear is None:
            return ""
        top, legs, pack = flight.wear
        t, l = self.colour(top), self.colour(legs)
        l = t if top == legs else l
        bag = self.pick("，背着背包", "，背了个双肩包", "，还背着一个背包") if pack else self.pick("", "", "，没有背包")
        p = self.pick("此人", "这个人", "这人", "TA")
        return self.pick(f"{p}穿{t}上衣、{l}裤子{bag}", f"{p}上身{t}，下身{l}{bag}", f"{p}上衣是{t}的，裤子是{l}的{bag}", f"穿着上，{p}是{t}上衣配{l}裤子{bag}", f"衣着方面，上衣{t}，裤子{l}{bag}", f"{p}身着{t}上衣和{l}长裤{bag}", f"{p}一件{t}上衣，一条{l}裤子{bag}",
                         f"从衣着看，{p}上穿{t}、下穿{l}{bag}", f"认准{t}上衣、{l}裤子{bag}".replace("认准", "辨认特征是"), f"{p}的打扮是{t}上衣加{l}长裤{bag}") + "。"

    def person(self, flight):
        return self.pick("此人", "这个人", "这人", "TA", "对方", "人物", *(["行人", "步行者"] if flight.walks else ["被拍的人"]))

    # distance
    def distance(self, flight):
        """Before the verb of filming: 无人机<distance>跟拍…"""
        d = self.m(flight.distance)
        return self.pick(f"在{d}外", f"从{d}外", f"在{d}远的地方", f"隔着{d}", f"保持{d}的距离", f"以{d}的距离", f"相隔{d}", f"在相距{d}处", f"拉开{d}距离", f"在离人{d}的位置", f"距人{d}")

    def distance_clause(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"无人机与人相距{d}", f"无人机离人{d}", f"无人机和人之间隔着{d}", f"人机距离{d}", f"机身到人的直线距离为{d}", f"无人机与人保持{d}的距离", f"拍摄距离{d}", f"拍摄距离为{d}", f"无人机与人之间的平均距离是{d}", f"人与无人机之间有{d}", f"人离无人机{d}远",
                         f"无人机跟人的距离平均是{d}", f"机位距人物{d}", f"飞机与被摄者的距离为{d}")

    def distance_order(self, flight):
        d = self.m(flight.distance)
        return self.pick(f"跟人保持{d}距离", f"离人{d}", f"距离控制在{d}", f"与人拉开{d}", f"无人机别近也别远，就隔{d}", f"拍摄距离{d}", f"机位放在离人{d}的地方", f"和人之间留出{d}", f"让无人机与人相距{d}", f"距离就按{d}来", f"人机距离要求{d}", f"飞机到人的距离请保持在{d}")

    # pitch
    def pitch(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("镜头保持水平", "镜头平视", f"镜头俯仰角为{a}", "镜头放平", "镜头不俯不仰", "云台保持水平", "以平视角度拍摄", "镜头正对地平线方向", "相机水平朝前", f"俯仰角{a}，即平视", "镜头与地平线平行", "画面为平视视角")
        if flight.pitch > 0:
            return self.pick(f"镜头向下{a}", f"镜头俯角{a}", f"镜头下压{a}", f"镜头朝下倾斜{a}", f"以{a}的俯角拍摄", f"云台下俯{a}", f"相机向下倾{a}", f"镜头低于水平线{a}", f"俯拍角度{a}", f"俯角为{a}", f"镜头从水平往下偏{a}", f"镜头以{a}角俯拍", f"镜头视线比地平线低{a}")
        return self.pick(f"镜头向上{a}", f"镜头仰角{a}", f"镜头上抬{a}", f"镜头朝上倾斜{a}", f"以{a}的仰角拍摄", f"云台上仰{a}", f"相机向上仰{a}", f"镜头高于水平线{a}", f"仰拍角度{a}", f"仰角为{a}", f"镜头从水平往上偏{a}", f"镜头以{a}角仰拍", f"镜头视线比地平线高{a}")

    def pitch_order(self, flight):
        a = self.degrees(flight)
        if flight.pitch == 0:
            return self.pick("镜头放平", "镜头保持水平", "用平视角度拍", f"俯仰角调到{a}", "云台不要上抬也不要下压，保持水平", "镜头别俯也别仰", "相机水平朝前就行", "角度要平视", "把镜头调平", "镜头请对准地平线方向")
        down = flight.pitch > 0
        return self.pick(*([f"镜头下压{a}", f"把镜头往下压{a}", f"云台向下调{a}", f"镜头朝下{a}", f"俯角{a}", f"俯角设为{a}", f"用{a}俯角拍", f"相机要比水平线低{a}", f"角度往下打{a}", f"镜头向下倾斜{a}", f"请把俯角调成{a}"] if down else
                           [f"镜头上抬{a}", f"把镜头往上抬{a}", f"云台向上调{a}", f"镜头朝上{a}", f"仰角{a}", f"仰角设为{a}", f"用{a}仰角拍", f"相机要比水平线高{a}", f"角度往上打{a}", f"镜头向上倾斜{a}", f"请把仰角调成{a}"]))

    # height
    def height(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"飞行高度{h}", f"飞行高度为{h}", f"无人机比人的脚面高{h}", f"无人机离地{h}", f"无人机飞在{h}高处", f"高度{h}", f"无人机高出人物脚下地面{h}", f"机身在人脚下地面以上{h}", f"航高{h}", f"从高度看，无人机比人的脚高出{h}", f"无人机的高度是{h}", f"以人的脚面为基准，无人机高{h}")

    def height_order(self, flight):
        h = self.m(flight.altitude)
        return self.pick(f"飞行高度{h}", f"飞{h}高", f"高度保持{h}", f"无人机升到{h}高", f"高度定在{h}", f"无人机要比人的脚面高{h}", f"飞行高度请控制在{h}", f"机身离地{h}", f"高度给到{h}", f"航高按{h}来")

    # turns
    def turn(self, turn):
        return self.pick("掉头", "掉头", "调头", "折返", "转身往回走") if turn == "around" else {"left": self.pick("左转", "左转", "左拐", "向左拐", "往左转", "向左转"), "right": self.pick("右转", "右转", "右拐", "向右拐", "往右转", "向右转")}[turn]

    def turns(self, flight):
        """A predicate of the person."""
        turns, k = flight.turns, len(flight.turns)
        if not k:
            return self.pick("全程没有转弯", "一个弯也没拐", "没有拐弯，也没有掉头", "一次都没转向", "途中未曾转弯", "一路没拐弯", "始终没有转向", "既不左转也不右转，更没有掉头", "中间没转过弯", "全程未转向")
        once = {"left": "向左", "right": "向右"}
        if k == 1:
            t = turns[0]
            if t == "around":
                return self.pick("掉了一次头", "途中掉头一次", "折返一次", "中途转身往回走了一次", "只掉过一次头", "转向一次，是掉头", "中途有一次掉头", "调头一次")
            z = once[t]
            return self.pick(f"{z}转弯一次", f"{z}拐了一个弯", f"途中{z}拐了一次", f"只{z}转过一次", f"转弯一次，方向是{z[1]}", f"拐了一个弯，{z}", f"有一次{z}转", f"中途{z[1]}转一次", f"{z[1]}拐一次")
        if len(set(turns)) == 1:
            t = turns[0]
            times = self.c(k, "次")
            if t == "around":
                return self.pick(f"掉头{times}", f"前后掉了{times}头", f"先后{times}折返", f"一共调头{times}", f"转向{times}，都是掉头")
            z = once[t]
            return self.pick(f"{z}转弯{times}", f"先后{times}{z}拐", f"{z}拐了{self.c(k, '个')}弯", f"拐了{times}弯，都是{z}", f"{times}{z[1]}转", f"接连{z[1]}转{times}", f"一共{z[1]}拐{times}")
        steps = [self.turn(t) for t in turns]
        short = [dict(left="左", right="右", around="掉头")[t] for t in turns]
        # 连续 runs
        runs = []
        for t in turns:
            if runs and runs[-1][0] == t:
                runs[-1][1] += 1
            else:
                runs.append([t, 1])
        grouped = [self.turn(t) if c == 1 else {"left": "左转", "right": "右转", "around": "掉头"}[t] + self.c(c, "次") for t, c in runs]
        plain = [dict(left="左转", right="右转", around="掉头")[t] for t in turns]
        choices = ["依次" + "、".join(plain), "先" + steps[0] + "".join("，再" + x for x in steps[1:]), f"共转向{self.c(k, '次')}，依次为{'、'.join(plain)}", f"转向{self.c(k, '次')}：{'、'.join(short)}",
                   f"先{steps[0]}，随后{steps[1]}" if k == 2 else f"先{steps[0]}，" + "".join(f"接着{x}，" if i == 0 else f"之后{x}，" if i % 2 else f"随后{x}，" for i, x in enumerate(steps[1:-1])) + f"最后{steps[-1]}", "先后" + "、".join(plain), f"{self.c(k, '次')}改变方向，顺序是{'、'.join(short)}",
                   "，".join([plain[0] + "之后" + plain[1]] + ["再" + x for x in plain[2:]]), f"方向变了{self.c(k, '次')}，{'，'.join(['先' + plain[0]] + ['后' + plain[1] if k == 2 else '再' + x for x in plain[1:]])}"]
        if len(runs) < k and len(runs) > 1:
            choices += ["先" + grouped[0] + "".join("，再" + x for x in grouped[1:])] * 3
        if "around" not in turns:
            choices += [f"拐了{self.c(k, '个')}弯，依次是{'、'.join(short)}", f"按{'、'.join(short)}的顺序拐了{self.c(k, '个')}弯"]
        return self.pick(*choices)

    # stops
    def stops(self, flight):
        k, t = flight.stops, self.s(flight.standing)
        if not k:
            return self.pick("一路没停", "中途没有停留", "全程未作停留", "一次也没停下", "没有停顿", "途中一刻没停", "中间没停过", "从未停步", "没有停下来过", "始终没有驻足")
        if k == 1:
            return self.pick(f"中途停了一次，停了{t}", f"停下一次，历时{t}", f"途中停留一次，共{t}", f"有一次停下脚步，站了{t}", f"驻足一次，时长{t}", f"停顿一次，{t}", f"曾停步{t}，仅此一次", f"中间站住一回，用了{t}", f"只停过一次，前后{t}", f"中途有一次{t}的停顿")
        c = self.c(k, "次")
        return self.pick(f"中途停了{c}，一共停了{t}", f"停下{c}，累计{t}", f"途中停留{c}，合计{t}", f"{c}停下脚步，总共站了{t}", f"驻足{c}，总时长{t}", f"停顿{c}，加起来{t}", f"先后停步{c}，共计{t}", f"有{c}停顿，总计{t}", f"中间站住{c}，前后加起来{t}", f"分{c}在原地站了共{t}")

    # way, speed, time
    def way(self, flight):
        """A predicate of the person with length and speed."""
        w, v = self.m(flight.way), self.speed(flight)
        return self.pick(f"共走了{w}，平均速度{v}", f"步行{w}，均速{v}", f"以平均{v}的速度走了{w}", f"一共走出{w}，平均{v}", f"走完{w}，步行速度平均为{v}", f"全程步行{w}，平均步速{v}", f"走了{w}的路，平均速度为{v}", f"平均步速{v}，总共走了{w}", f"用{v}的平均速度走了{w}", f"步行总长{w}，平均{v}",
                         f"累计行走{w}，步速平均{v}", f"徒步{w}，平均速度{v}")

    def time(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"飞行历时{t}", f"整段飞行{t}", f"全程{t}", f"飞行持续了{t}", f"这次飞行一共{t}", f"片长{t}", f"整个过程{t}", f"飞行时长{t}", f"视频总长{t}", f"前后一共飞了{t}", f"总时长为{t}")

    def time_open(self, flight):
        t = self.s(flight.duration)
        return self.pick(f"在{t}的飞行中", f"{t}的画面里", f"这段{t}的航拍中", f"在历时{t}的飞行里", f"飞行的{t}里", f"一段{t}的跟拍" + "里" if flight.walks else f"一段{t}的视频里")

    def stand(self, flight):
        return self.pick("站在原地不动", "一直站在原地", "原地站着，没有走动", "始终站着没挪地方", "站定不动", "一步没走，就站在那里", "全程站在同一个位置", "没有走动，一直站着", "站着，一步也没挪", "停在原地站着", "始终在原处站立")

    # instruction
    def film(self, flight):
        return self.pick("跟拍", "跟住", "跟着拍", "跟着", "跟踪拍摄", "跟随") if flight.walks else self.pick("拍", "拍摄", "对准", "盯住", "拍下")

    def extras(self, flight):
        out = []
        if flight.altitude >= 1 and self.rng.random() < .4:
            out.append(self.height_order(flight))
        if self.rng.random() < .2:
            t = self.s(flight.duration)
            out.append(self.pick(f"拍{t}", f"整段飞{t}", f"时长{t}", f"拍够{t}再收", f"飞行时间{t}", f"一共要{t}的素材"))
        if flight.walks:
            if self.rng.random() < .2:
                steps = [dict(left="左转", right="右转", around="掉头")[t] for t in flight.turns]
                out.append(self.pick(f"人会依次{'、'.join(steps)}", f"途中人要先{'，再'.join(steps)}", f"路线上有{self.c(len(steps), '次')}转向：{'、'.join(steps)}", f"注意，对方会{'，然后'.join(steps)}") if len(steps) > 1 else
                           self.pick(f"途中人会{steps[0]}一次", f"注意人会有一次{steps[0]}") if steps else self.pick("人不会转弯", "途中没有转弯", "路上不会拐弯，也不会掉头"))
            if self.rng.random() < .2:
                t = self.s(flight.standing)
                c = self.c(flight.stops, "次")
                out.append(self.pick("人中途不会停", "途中没有停顿") if not flight.stops else self.pick(f"途中人会停一次，停{t}", f"人会停下一次，为时{t}") if flight.stops == 1 else self.pick(f"途中人会停{c}，共{t}", f"人会停下{c}，加起来{t}"))
            if self.rng.random() < .15:
                out.append(self.pick(f"人一共要走{self.m(flight.way)}", f"整段路程{self.m(flight.way)}", f"人的平均步速{self.speed(flight)}", f"步行速度平均{self.speed(flight)}"))
        elif self.rng.random() < .6:
            out.append(self.pick("人站着不动", "人一直站在原地", "对方不走动，就站在那里", "被拍的人原地站着"))
        self.rng.shuffle(out)
        return out

    def instruction(self, flight):
        self.voice()
        who, d, verb = self.who(flight), self.distance(flight), self.film(flight)
        a, d_order, a_order = self.pitch(flight), self.distance_order(flight), self.pitch_order(flight)
        dist, deg = self.m(flight.distance), self.degrees(flight)
        angle = "平视" if flight.pitch == 0 else ("俯角" if flight.pitch > 0 else "仰角") + deg
        look = "水平" if flight.pitch == 0 else ("向下" if flight.pitch > 0 else "向上") + deg
        please = self.pick("请", "麻烦", "麻烦你", "请你", "劳驾", "")
        extra = self.extras(flight)
        text = self.pick(
            f"{please}{verb}{who}，{d_order}，{a_order}",
            f"{please}{d}{verb}{who}，{a_order}",
            f"{a_order}，{d_order}，{verb}{who}",
            f"能不能{d}{verb}{who}？{a_order}",
            f"目标：{who}；距离：{dist}；镜头：{look}",
            f"拍摄要求如下：{verb}{who}；{d_order}；{a_order}",
            f"看到{who.replace('一个', '那个').replace('一名', '那名').replace('一人', '那个人')}了吗？{verb}TA，{d_order}，{a_order}",
            f"这条镜头要{angle}，机位离人{dist}，拍的是{who}",
            f"我需要一段素材：无人机{d}{verb}{who}，{a}",
            f"拍摄对象是{who}。{d_order}，{a_order}",
            f"把{who}放在画面里，{d_order}，{a_order}",
            f"你来飞，{verb}{who}，{d_order}；{a_order}",
            f"{verb}{who}时，{d_order}，{a_order}",
            f"给{who}拍一段：距离{dist}，{angle}",
            f"机位：离人{dist}，{angle}。对象：{who}",
            f"飞的时候{d_order}，{a_order}。要拍的是{who}",
            f"1. {verb}{who}；2. {d_order}；3. {a_order}" if not extra else f"{verb}{who}，要点两个：一是{d_order}，二是{a_order}",
            f"无人机{d}{verb}{who}，{a}")
        if extra:
            text += self.pick("，", "。", "；") + "，".join(extra) if "：" not in text and "；" not in text else "。" + "，".join(extra)
        return self.spaced(text + ("！" if not extra and self.rng.random() < .08 else "。"))

    # description
    def drone(self, flight, kinds=("distance", "pitch", "height")):
        made = dict(distance=self.distance_clause, pitch=self.pitch, height=self.height)
        kinds = [k for k in kinds if k != "height" or flight.altitude >= 1]
        self.rng.shuffle(kinds)
        return self.pick("，", "，", "；").join(made[k](flight) for k in kinds) + "。"

    def motion(self, flight, p=None):
        p = p or self.person(flight)
        q = self.pick("此人", "这个人", "TA")
        turns, stops, way = self.turns(flight), self.stops(flight), self.way(flight)
        return self.pick(f"{p}{turns}；{stops}；{way}。", f"{p}{way}，{stops}。路上{turns}。", f"{p}{way}。走的过程中，{q}{turns}；{stops}。", f"{p}{turns}，{way}。{q}{stops}。", f"{p}{stops}。{q}{turns}，{way}。", f"行走路线上，{p}{turns}；{way}；{stops}。",
                         f"{p}{way}，{turns}，{stops}。", f"走法是这样的：{p}{turns}，{stops}，{way}。", f"{p}{stops}，{turns}，{way}。", f"{stops}，{turns}，{p}就这样{way}。")

    def notes(self, flight):
        dist = self.m(flight.distance)
        deg = self.degrees(flight)
        angle = "平视（0°）" if flight.pitch == 0 and not self.spelled else "平视" if flight.pitch == 0 else ("俯角" if flight.pitch > 0 else "仰角") + deg
        items = [self.pick("人物", "对象", "被摄者") + "：" + self.who(flight), self.pick("距离", "机位距离", "人机距离") + "：" + dist, self.pick("角度", "镜头", "机位角度") + "：" + angle, self.pick("时长", "飞行时长", "片长") + "：" + self.s(flight.duration)]
        if flight.altitude >= 1:
            items.append(self.pick("高度", "飞行高度", "航高") + "：" + self.m(flight.altitude))
        if flight.walks:
            steps = [dict(left="左", right="右", around="掉头")[t] for t in flight.turns]
            items += [self.pick("转向", "转弯") + "：" + ("、".join(steps) or "无"), self.pick("停顿", "停留") + "：" + (f"{self.c(flight.stops, '次')}，共{self.s(flight.standing)}" if flight.stops else "无"), self.pick("步行", "行走距离", "步行路程") + "：" + self.m(flight.way), self.pick("平均步速", "均速") + "：" + self.speed(flight)]
        else:
            items.append(self.pick("动作：站在原地", "状态：原地站立，没有走动", "走动：无，一直站着"))
        rest = items[1:]
        self.rng.shuffle(rest)
        style = self.pick("；", "\n", "。")
        return style.join([items[0]] + rest) + ("" if style == "\n" else "。")

    def description(self, flight):
        self.voice()
        if self.rng.random() < .08:
            return self.spaced(self.notes(flight))
        return self.spaced(self.told(flight))

    def told(self, flight):
        who, d = self.who(flight), self.distance(flight)
        film = self.pick("跟拍", "跟随拍摄", "跟踪拍摄", "一路跟拍", "追踪拍摄") if flight.walks else self.pick("拍摄", "拍下", "记录", "拍到")
        film_noun = self.pick("跟拍", "跟随拍摄") if flight.walks else "拍摄"
        drone = self.pick("无人机", "无人机", "一架无人机", "航拍无人机")
        a, time, opened = self.pitch(flight), self.time(flight), self.time_open(flight)
        high = self.height(flight) + "。" if flight.altitude >= 1 else ""
        comma_high = "，" + self.height(flight) if flight.altitude >= 1 else ""
        p = self.person(flight)
        if not flight.walks:
            stand = self.stand(flight)
            return self.pick(
                f"{drone}{d}{film}{who}，{a}{comma_high}。{p}{stand}，{time}。",
                f"{opened}，{who}{stand}。{self.drone(flight)}",
                f"{who}{stand}，{drone}{d}拍摄，{a}{comma_high}。{time}。",
                f"{self.drone(flight)}画面里，{who}{stand}，{time}。",
                f"航拍画面显示，{who}{stand}。{time}，{self.drone(flight)}",
                f"{time}，镜头里是{who}，{stand}。{self.drone(flight)}",
                f"这段素材拍的是{who}，{p}{stand}。{self.drone(flight)}{time}。",
                f"{drone}拍了一个人。{self.clothes(flight)}{p}{stand}，{time}。{self.drone(flight)}",
                f"被拍的是{who}：{stand}。{a}，{self.distance_clause(flight)}{comma_high}，{time}。",
                f"{a}，{drone}{d}{film}{who}。{time}，其间{p}{stand}。{high}")
        motion, turns, stops, way = self.motion(flight), self.turns(flight), self.stops(flight), self.way(flight)
        return self.pick(
            f"{drone}{d}{film}{who}，{a}{comma_high}。{motion}{time}。",
            f"{opened}，{drone}{d}{film}{who}，{a}{comma_high}。{motion}",
            f"{who}{way}，{stops}，{drone}{d}{film}。{p}{turns}。{a}{comma_high}。{time}。",
            f"航拍画面显示，{who}{turns}。{p}{way}，{stops}。{self.drone(flight)}{time}。",
            f"这段素材{film_noun}的是{who}，{time}。{self.drone(flight)}{motion}",
            f"{self.drone(flight)}镜头里，{who}{way}；{turns}；{stops}。{time}。",
            f"{time}。{self.motion(flight, self.pick('画面中的人', '被拍的人', '镜头里的人'))}{self.drone(flight)}全程拍的都是{who}。",
            f"{drone}{film}一个步行的人。{self.clothes(flight)}{motion}{self.drone(flight)}{time}。",
            f"镜头对准的是{who}：{turns}，{stops}，{way}。{time}，{self.drone(flight)}",
            f"{who}被{drone}{d}{film}，{a}。{high}{motion}{time}。",
            f"{a}，{drone}{d}{film}{who}，{time}。{motion}{high}",
            f"{opened}，{who}{turns}，{way}。{p}{stops}。{self.drone(flight)}",
            f"画面主角是{who}，{p}{way}。{turns}，{stops}。{self.drone(flight)}{time}。")

    # wrong texts
    def foreign(self, text):
        thing, person = self.pick(*self.things), self.pick(*self.persons)
        body, end = (text[:-1], text[-1]) if text[-1] in "。！？" else (text, "")
        return self.pick(f"{body}，{thing}{end}", f"{body}，{thing}{end}", f"{body}。画面中，{thing}。", f"{body}。旁边还有一位{person}。", f"{body}。这人是一位{person}。", f"{body}。一位{person}迎面走来。", f"{body}，看样子是一位{person}{end}", f"{thing}，{text}" if "\n" not in text else f"{body}，{thing}")

    def heading(self, text, direction):
        z = ZH_DIRECTIONS[direction]
        body = text[:-1] if text[-1] in "。！？" else text
        return self.pick(f"{body}。人往{z}走。", f"{body}。此人一路向{z}。", f"{body}，朝{z}面走去。" if len(z) == 1 else f"{body}，朝{z}方向走去。", f"{body}。行进方向为{z}。", f"{body}。走的是{z}方向。", f"{body}，人物向{z}步行。", f"{body}。TA要去的方向是{z}边。" if len(z) == 1 else f"{body}。TA要去的方向是{z}。",
                         f"{body}。步行方向：{z}。", f"{body}。这个人正朝{z}走。", f"{body}。方向上，人是往{z}去的。")
