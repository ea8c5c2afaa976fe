"""The seventh grammar for check_text_judge.py: American English of a text message, Chinese of a chat. Written in full before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


class SeventhEnglish(Grammar):
    code = "en"
    things = ["right next to a taco truck", "with snow coming down", "hand in hand with a boyfriend", "past the gas station", "in the shadow of a water tower", "dragging a wheeled suitcase", "over by the dumpsters", "with a golden retriever", "as a school bus rolls by", "through a parking garage", "alongside a chain-link fence", "holding a pizza box", "by the swimming pool", "after a mailman", "under a billboard"]
    persons = ["cop", "grandpa", "skateboarder", "mailman", "waitress"]

    def colour(self, name):
        return {"grey": "gray"}.get(name, name)

    def who(self, flight):
        noun = self.pick("person", "pedestrian", "walker", "individual", "target")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        top, trousers = self.colour(top), self.colour(trousers)
        bag = self.pick(" and a backpack", " and a bookbag on", " with a backpack strapped on") if backpack else self.pick("", "", " (no backpack)")
        return self.pick(
            f"the {noun} rocking {an(top)} sweatshirt and {trousers} pants{bag}",
            f"the {noun} w/ {an(top)} tee, {trousers} jeans{bag}",
            f"the {noun} who has on {an(top)} shirt and {trousers} slacks{bag}",
            f"the {noun} in {an(top)} puffer jacket and {trousers} sweats{bag}",
            f"the {top}-shirt, {trousers}-pants {noun}{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"stay {d} meters back", f"keep it at {d} meters", f"{d} meters is the magic number for your distance", f"don't get any nearer than {d} meters or any farther", f"maintain {d} m of buffer", f"make sure you're {d} meters from them", f"float along {d} meters out")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"tip the camera down {p} degrees", f"camera angle: {p} degrees down", f"face the lens {p} degrees toward the ground", f"shoot from above at {p} degrees", f"drop the camera angle to {p} degrees below the horizon")
        return self.pick(f"tip the camera up {p} degrees", f"camera angle: {p} degrees up", f"face the lens {p} degrees toward the sky")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" FYI they're not moving.", " They're just standing around the whole time.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Hey, can you follow {who}? {distance.capitalize()}, and {view}. Thanks!{still}",
            f"Gonna need you on {who}. {view.capitalize()}. Also {distance}.{still}",
            f"So basically: {distance}, {view}, don't lose {who}.{still}",
            f"OK so {who} is your target. {distance.capitalize()} and {view}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("They go straight the entire time.", "Zero turns, super easy.", "They never change direction.", "They don't make any turns at all.")
        verb = {"left": self.pick("make a left", "go left", "take a left"), "right": self.pick("make a right", "go right", "take a right"), "around": self.pick("turn around", "flip a U-turn", "head back the other way")}
        if len(turns) == 1:
            return self.pick(f"At some point they {verb[turns[0]]}.", f"They {verb[turns[0]]} and that's the only turn.")
        return self.pick(
            "They " + ", ".join(verb[turn] for turn in turns[:-1]) + f", and then {verb[turns[-1]]}.",
            "First they " + ", after which they ".join(verb[turn] for turn in turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("They don't stop.", "They keep walking the whole way through.", "No stopping whatsoever.", "They just keep on going, zero breaks.")
        if n == 1:
            return self.pick(f"They stop for like {s} seconds one time.", f"They take a quick {s}-second break.", f"There's this one spot where they wait for {s} seconds.", f"They stand around for {s} seconds at one point.")
        return self.pick(f"They stop {n} different times ({s} seconds if you add it all up).", f"They take {n} breaks, which is {s} seconds total.", f"{n} stops, {s} seconds combined.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"They walk {w} meters in {t} seconds, so {v} m/s.",
                f"Whole thing is {t} seconds long and they go {w} meters at {v} meters per second.",
                f"It's {w} meters total, takes {t} seconds, speed is {v} m/s.",
                f"They're moving at {v} m/s for {t} seconds and make it {w} meters.",
            )
            walk = f"We're watching {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"We're watching {who}. For all {t} seconds they {self.pick('just stand there', 'do not move an inch', 'stay in the same place')}."
        height = self.pick(f"You'll be {flight.altitude} meters higher than they are. ", f"Your altitude over the target is {flight.altitude} meters. ") if flight.altitude >= 1 else ""
        distance, view = self.range(flight), self.view(flight)
        drone = f"{distance[0].upper() + distance[1:]} and {view}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + " " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f", and there's a {self.rng.choice(self.persons)} too."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", headed {direction}.", f", going toward the {direction}.", f", walking due {direction}." if len(direction) < 6 else f", walking {direction}.")


class SeventhChinese(Grammar):
    code = "zh"
    things = ["旁边有家奶茶店", "还牵着一条金毛", "跟男朋友手拉着手", "路过加油站的时候", "天上下着雪", "拖着个行李箱", "在垃圾桶那边", "后面有辆校车开过来", "穿过地下停车场", "手里还端着披萨", "挨着游泳池", "在广告牌底下", "跟着一个邮递员", "撞见一群小学生", "躲在一棵大树后头"]
    persons = ["警察", "大爷", "滑板少年", "服务员", "快递小哥"]

    def who(self, flight):
        noun = self.pick("那个人", "那位路人", "目标", "那个行人", "咱们的目标")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("还背着个双肩包", "背了个包") if backpack else self.pick("", "", "没背包")
        comma = "，" if bag else ""
        return self.pick(
            f"穿{top}色卫衣{trousers}色裤子{comma}{bag}的{noun}",
            f"上面{top}色T恤下面{trousers}色牛仔裤{comma}{bag}的{noun}",
            f"{noun}（{top}外套配{trousers}裤{comma}{bag}）",
            f"上身{top}色、裤子{trousers}色{comma}{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"离他{d}米就行", f"保持个{d}米", f"隔{d}米跟着", f"距离嘛{d}米", f"跟在后头{d}米", f"别近过{d}米也别远过{d}米", f"差不多{d}米的样子")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头往下压{p}度", f"相机低头{p}度", f"往下拍，角度{p}度", f"摄像头朝下{p}度", f"从上面往下{p}度看")
        return self.pick(f"镜头往上抬{p}度", f"相机抬头{p}度", f"摄像头朝上{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("对了，人没在动。", "他就一直站那儿。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"帮我跟一下{who}呗，{distance}，{view}哈。{still}",
            f"{who}看见没？就跟着，{distance}，{view}。{still}",
            f"{view}，{distance}，别把{who}跟丢了。{still}",
            f"麻烦跟拍{who}，{distance}，然后{view}，谢啦。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左拐", "往左拐", "左转"), "right": self.pick("右拐", "往右拐", "右转"), "around": self.pick("掉头", "扭头往回走")}
        turns = flight.turns
        if not turns:
            return self.pick("一路直着走没拐弯", "压根没转过弯", "就一条直线走到底", "方向一直没变")
        if len(turns) == 1:
            return self.pick(f"走到一半{name[turns[0]]}了", f"就{name[turns[0]]}了一下")
        return self.pick("先" + "，再".join(name[turn] for turn in turns), "、".join(name[turn] for turn in turns) + "这么走的")

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("一下都没停", "没停过", "一直在走", "中间也没歇")
        if n == 1:
            return self.pick(f"中间停了{s}秒", f"站了{s}秒才又走", f"歇了一会儿，{s}秒吧", f"停过一回，{s}秒")
        return self.pick(f"停了{n}回，加一起{s}秒", f"前后歇了{n}次总共{s}秒", f"停停走走，停了{n}次，一共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"走了{w}米，花了{t}秒，差不多每秒{v}米。",
                f"整段{t}秒，走了有{w}米，速度{v}米/秒。",
                f"{t}秒走{w}米，也就是{v}米每秒。",
            )
            walk = f"咱们拍的是{who}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"咱们拍的是{who}，{t}秒里{self.pick('就没动过', '一直站着', '一步没挪')}。"
        height = self.pick(f"飞机比他高{flight.altitude}米。", f"在他头上{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "边上还有个" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，往{name}边走。", f"，朝{name}去。", f"，一路奔{name}。")
