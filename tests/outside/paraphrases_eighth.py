"""The eighth grammar for check_text_judge.py: a wildlife narrator's English, a storyteller's Chinese. Written in full before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


class EighthEnglish(Grammar):
    code = "en"
    things = ["near a beehive", "beneath a flyover", "with a ferret on a lead", "where the tramlines cross", "past an ice-cream van", "by the cathedral steps", "as thunder rolls", "beside a sleeping tramp", "holding a lantern", "in the company of two monks", "around a fallen oak", "close to a hot-dog stand", "through a turnstile", "between rows of tulips", "with a newspaper under the arm"]
    persons = ["fisherman", "schoolgirl", "violinist", "beekeeper", "tourist"]

    def who(self, flight):
        noun = self.pick("walker", "figure", "individual", "pedestrian", "subject")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", a rucksack riding on the back,", ", burdened with a backpack,", ", knapsack and all,") if backpack else self.pick("", "", ", travelling without a backpack,")
        return self.pick(
            f"the {noun} draped in {an(top)} coat, with trousers of {trousers}{bag}",
            f"the {noun} whose upper half is {top} and whose lower half is {trousers}{bag}",
            f"the {noun} recognisable by {an(top)} waistcoat and {trousers} breeches{bag}",
            f"the {noun} in a knitted {top} jumper and faded {trousers} jeans{bag}",
            f"the {noun}, dressed in {top} above the waist and {trousers} below it{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"we observe from {d} metres", f"our hide is {d} metres off", f"some {d} metres lie between us and them", f"we trail at a respectful {d} metres", f"the aircraft lingers {d} m in their wake", f"{d} metres: that is as near as we dare come, and as far as we stray", f"our separation measures {d} metres")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"gazing down at {p} degrees", f"the glass inclined {p} degrees earthward", f"our eye tilted {p} degrees below the skyline", f"with the lens lowered through {p} degrees", f"at a plunging angle of {p} degrees")
        return self.pick(f"gazing up at {p} degrees", f"the glass inclined {p} degrees skyward", f"with the lens raised through {p} degrees")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" The creature has not stirred.", " All the while it remains stock-still.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Here we follow {who}: {distance}, {view}.{still}",
            f"Watch closely now, for this is {who}; {distance}, {view}.{still}",
            f"Pilot, do as we do: {distance}, {view}, with {who} forever in sight.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("The course never wavers.", "It runs as straight as a ruler.", "No deviation from the line is seen.", "Onward it goes, turning neither left nor right.")
        noun = {"left": self.pick("a swing to the left", "a leftward curve"), "right": self.pick("a swing to the right", "a rightward curve"), "around": self.pick("a complete about-turn", "a reversal of course")}
        if len(turns) == 1:
            return self.pick(f"We witness {noun[turns[0]]}.", f"The path knows {noun[turns[0]]}, and no more.")
        return self.pick(
            "We witness " + ", next ".join(noun[turn] for turn in turns) + ".",
            "The path takes " + ", followed in due course by ".join(noun[turn] for turn in turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("At no time does it falter.", "There is no halt along the way.", "It presses on without respite.", "Never once does the walker come to rest.")
        if n == 1:
            return self.pick(f"A solitary halt of {s} seconds occurs.", f"It pauses but once, for {s} seconds.", f"It lingers a single time, {s} seconds long.")
        return self.pick(f"It halts on {n} separate occasions, for {s} seconds altogether.", f"{n} halts there are, lasting {s} seconds when summed.", f"It tarries {n} times over, {s} seconds in sum.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"In the space of {t} seconds it journeys {w} metres, at a gait of {v} m/s.",
                f"A march of {w} metres, accomplished in {t} seconds at {v} metres per second.",
                f"{t} seconds elapse; {w} metres pass underfoot; the pace is {v} m/s.",
                f"At a steady {v} m/s, {w} metres are put behind it in {t} seconds.",
            )
            walk = f"Behold {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"Behold {who}. For {t} seconds it {self.pick('stands motionless', 'does not stir', 'remains in one place')}."
        height = self.pick(f"We soar {flight.altitude} metres above it. ", f"Our elevation over the quarry is {flight.altitude} metres. ") if flight.altitude >= 1 else ""
        distance = self.range(flight)
        drone = f"{distance[0].upper() + distance[1:]}, {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f", and beside it strolls a {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", bound for the {direction}.", f", ever {direction}wards.", f", with its face to the {direction}.")


class EighthChinese(Grammar):
    code = "zh"
    things = ["牵着一头毛驴", "蹲着个乞丐", "正赶上打雷下雨", "路过一片油菜花田", "遇上两个尼姑", "夹着一份报纸", "绕着古井走了一圈", "在天主堂台阶边", "提着一盏灯笼", "桥洞底下", "有个钓鱼的坐在那儿", "同一位姑娘有说有笑", "卖冰棍的小车边", "走进了郁金香花丛", "几只麻雀在蹦"]
    persons = ["渔夫", "女学生", "琴师", "养蜂人", "观光客"]

    def who(self, flight):
        noun = self.pick("此君", "这位行人", "行路人", "那位过客", "咱这位主角")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，后背一个双肩包", "，肩上背着背包") if backpack else self.pick("", "", "，身上没有背包")
        return self.pick(
            f"一身{top}色褂子、{trousers}色裤子{bag}的{noun}",
            f"上半身{top}色，下半身{trousers}色{bag}的{noun}",
            f"{noun}，穿的是{top}色马甲，配{trousers}色西裤{bag}，",
            f"外罩{top}色大衣，里头{trousers}色长裤{bag}的{noun}",
        ).rstrip("，")

    def range(self, flight):
        d = flight.distance
        return self.pick(f"咱们远远地在{d}米外瞧着", f"一前一后相差{d}米", f"人与机之间{d}米", f"不远不近，正好{d}米", f"身后{d}米处悄悄跟着", f"始终保持{d}米开外")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头往下一沉，{p}度", f"居高临下，俯视{p}度", f"镜头压下去{p}度", f"垂下镜头{p}度")
        return self.pick(f"镜头往上一挑，{p}度", f"仰视{p}度", f"扬起镜头{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("只见此人立在那里，动也不动。", "那人站得稳稳的，半步没挪。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"话说要跟的是{who}：{distance}，{view}。{still}",
            f"且看{who}，{distance}，{view}，可别跟丢。{still}",
            f"飞手听好：{distance}，{view}，盯的就是{who}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("拐向左边", "向左一转", "左拐"), "right": self.pick("拐向右边", "向右一转", "右拐"), "around": self.pick("掉转头来", "转身往回走")}
        turns = flight.turns
        if not turns:
            return self.pick("一条直路走到底", "左不拐右不绕", "从头到尾没转过弯", "径直走去")
        if len(turns) == 1:
            return self.pick(f"走着走着，{name[turns[0]]}", f"半道上{name[turns[0]]}")
        return self.pick("起先" + "，接着".join(name[turn] for turn in turns), "头一回" + "，下一回".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("脚下不曾歇过", "一路没停脚", "半步也没停", "走得连贯，没有停顿")
        if n == 1:
            return self.pick(f"当中歇了一回，{s}秒钟", f"停下脚步{s}秒", f"站住过一次，约莫{s}秒")
        return self.pick(f"歇了{n}回脚，拢共{s}秒", f"停停走走{n}次，统共{s}秒", f"前前后后停了{n}遭，合计{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"{t}秒的工夫，走出去{w}米，一秒钟合{v}米。",
                f"这一程{w}米，走了{t}秒，脚程每秒{v}米。",
                f"算起来{w}米路用了{t}秒，步速{v}米每秒。",
            )
            walk = f"今儿个说的是{who}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"今儿个说的是{who}，{t}秒里头{self.pick('立着没动', '原地站着', '一动也不动')}。"
        height = self.pick(f"飞机悬在头顶上{flight.altitude}米。", f"比那人高出{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "身边走着一个" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，奔{name}去了。", f"，一路向{name}。", f"，脸朝{name}边。")
