"""The eleventh grammar for check_text_judge.py: letters and commentary in English, a diary and a class of pilots in Chinese. Written before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an
from paraphrases_tenth import upper


class EleventhEnglish(Grammar):
    code = "en"
    things = ["as church bells ring", "past a row of beach huts", "with a parrot on the shoulder", "in the shade of an oak", "round a broken-down tractor", "beside the cricket pavilion", "licking an ice cream", "behind a brass band", "through a flock of sheep", "next to the war memorial", "carrying a ladder", "during a thunderstorm", "with a stranger", "near the petrol pumps", "up the steps of the museum"]
    persons = ["vicar", "milkman", "ballerina", "fisherman", "grandmother"]

    def who(self, flight):
        noun = self.pick("person below", "walker", "human being", "pedestrian", "soul on foot", "subject")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(" and, on the back, a rucksack", ", complete with backpack", ", shouldering a backpack") if backpack else self.pick("", "", ", unencumbered by any bag", ", without a backpack")
        return self.pick(
            f"the {noun}, in {top} shirt and {trousers} trousers{bag},",
            f"the {noun} sporting {an(top)} cardigan above {trousers} corduroys{bag}",
            f"the {noun} ({trousers} below, {top} above{bag})",
            f"the {noun} attired in {trousers} slacks and {an(top)} blazer{bag}",
            f"the {noun} with the {top} pullover, the {trousers} jeans{bag}",
            f"the {noun}, whose coat is {an(top)} one and whose trousers are {trousers}{bag},",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"the drone trails by {d} metres", f"we sit {d} metres off", f"{d} metres is what separates us from our friend", f"our drone keeps its {d} metres, no more and no less", f"it is kept at a remove of {d} metres", f"I have you {d} metres astern", f"from a respectful {d} metres we observe", f"roughly {d} m lie between lens and walker")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"the lens bowed {p} degrees", f"peering {p} degrees downwards", f"with the nose of the camera {p} degrees beneath the horizontal", f"the eye in the sky gazes {p} degrees down", f"the camera is lowered by {p} degrees", f"our view slopes {p} degrees earthward")
        return self.pick(f"the lens raised {p} degrees", f"peering {p} degrees upwards", f"with the nose of the camera {p} degrees above the horizontal", f"our view slopes {p} degrees skyward")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" And still as a statue they stand.", " Not so much as a step is taken.", " They have not budged an inch.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Eyes on {who} please; {distance}, {view}.{still}",
            f"Be so kind as to accompany {who}: {distance}; {view}.{still}",
            f"Dear pilot, kindly keep company with {who}. {upper(distance)}, {view}.{still}",
            f"Good afternoon and welcome! We are watching {who}. {upper(distance)}, {view}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("Onward it goes, never bending left or right.", "As the crow flies, that is how they go.", "Not once is the course altered.", "The line is straight as a die.", "Left or right? Neither.")
        word = lambda turn: {"around": self.pick("about-turn", "turn on the heel and back again")}.get(turn) or self.pick(f"{turn} turn", f"swing to the {turn}", f"{turn}-hander")
        done = [word(turn) for turn in turns]
        if len(turns) == 1:
            return self.pick(f"Just the one {done[0]}, ladies and gentlemen.", f"There comes a {done[0]}.", f"A {done[0]} is the only surprise.")
        return self.pick(
            "First a " + ", next a ".join(done) + ".",
            "What a course: a " + ", followed by a ".join(done) + ".",
            f"Of turns there are {len(turns)}: " + ", ".join(done) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("They do not dally.", "The feet never rest.", "Nowhere do they pause.", "They carry on and on without stopping.", "Stops? None.")
        if n == 1:
            return self.pick(f"One rest is had, of {s} seconds.", f"They tarry once, {s} seconds by my watch.", f"Once, and for {s} seconds, they stand and wait.", f"Stops? One, {s} seconds long.")
        return self.pick(f"{n} rests are had, {s} seconds between them.", f"They tarry {n} times, {s} seconds by my watch altogether.", f"Stops? {n}, taking {s} seconds.", f"On {n} occasions they stand and wait, {s} seconds all in all.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"They put {w} metres behind them before the {t} seconds are up, strolling at {v} m/s.",
                f"{w} metres on foot, {t} seconds on the clock, {v} metres per second: not bad.",
                f"A promenade of {w} metres and {t} seconds, then, at {v} m/s.",
                f"The {w} metres are done in {t} seconds, that is to say at {v} metres each second.",
            )
            walk = f"Down there we have {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"Down there we have {who}. {self.pick('They are going nowhere', 'There they stand, unmoving', 'Rooted to the spot they are')}, and for {t} seconds at that."
        height = self.pick(f"We float {flight.altitude} metres overhead. ", f"The drone is up {flight.altitude} metres from where the feet are. ", f"Our height over the ground beneath the walker: {flight.altitude} metres. ") if flight.altitude >= 1 else ""
        drone = f"{upper(self.range(flight))}, {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". Oh, and here comes a {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", bound for the {direction}.", f", {direction} being the way they go.", f", facing {direction}.")


class EleventhChinese(Grammar):
    code = "zh"
    things = ["教堂的钟敲响了", "肩头停着一只鹦鹉", "在大橡树的阴凉里", "身后跟着一支铜管乐队", "舔着冰淇淋", "从羊群里穿过", "扛着梯子", "赶上雷阵雨", "绕过抛锚的拖拉机", "挨着加油机", "顺着博物馆的台阶往上", "身边有个陌生人", "途经一排更衣小屋", "在板球场边", "纪念碑前"]
    persons = ["牧师", "送奶工", "芭蕾舞演员", "渔夫", "奶奶"]

    def who(self, flight):
        noun = self.pick("行人", "目标人物", "拍摄对象", "步行者", "此人")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，肩上背着双肩包", "，还背着背包") if backpack else self.pick("", "", "，身上没有背包", "，没背双肩包")
        return self.pick(
            f"{noun}（上衣{top}色、裤子{trousers}色{bag}）",
            f"一位上穿{top}色毛衣、下着{trousers}色裤子的{noun}{bag}",
            f"穿着{top}色衬衣、{trousers}色长裤的{noun}{bag}",
            f"{noun}，上半身{top}色，下半身{trousers}色{bag}，",
            f"{top}色外套搭配{trousers}色牛仔裤的{noun}{bag}",
        ).rstrip("，")

    def range(self, flight):
        d = flight.distance
        return self.pick(f"我与其之间的距离是{d}米", f"请大家把距离定在{d}米", f"跟随距离以{d}米为宜", f"飞机落后{d}米", f"始终同目标差着{d}米", f"隔了{d}米在拍", f"不远不近，{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"相机俯角调到{p}度", f"镜头向下看，偏{p}度", f"画面是{p}度的俯视", f"镜头压低了{p}度", f"低头{p}度拍摄")
        return self.pick(f"相机仰角调到{p}度", f"镜头向上看，偏{p}度", f"画面是{p}度的仰视", f"镜头抬高了{p}度", f"抬头{p}度拍摄")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("对方并没有走，只是站着。", "这期间脚步未曾移动。", "目标站在那里，动也不动。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"各位学员请注意，本次要跟的是{who}。{distance}，{view}。{still}",
            f"今天的练习：跟拍{who}。要求是{distance}，{view}。{still}",
            f"盯住{who}。{view}，{distance}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左转弯", "向左一拐", "左拐"), "right": self.pick("右转弯", "向右一拐", "右拐"), "around": self.pick("掉转方向", "原路折返")}
        turns = flight.turns
        if not turns:
            return self.pick("路上没转过弯", "一条直线走到底", "既没左转也没右转", "朝着同一个方向走")
        if len(turns) == 1:
            return self.pick(f"只在途中{name[turns[0]]}", f"走到一半{name[turns[0]]}")
        return self.pick("依次是" + "、".join(name[turn] for turn in turns), "起先" + "，后来".join(name[turn] for turn in turns), "；过一会儿".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("走走停停是没有的，一气走完", "脚步没有停过", "没有哪一处停下", "不曾驻足")
        if n == 1:
            return self.pick(f"有过一次停顿，大约{s}秒", f"站住等了{s}秒，仅此一次", f"停步一次，时间是{s}秒")
        return self.pick(f"有过{n}次停顿，加总{s}秒", f"停步{n}次，时间总和{s}秒", f"先后{n}次站住，共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"这段路有{w}米，走了{t}秒，合每秒{v}米。",
                f"历时{t}秒，行程{w}米，速度为每秒{v}米。",
                f"{t}秒过去，已走出{w}米，步行速度{v}米每秒。",
                f"路程{w}米，时间{t}秒，平均速度{v}米/秒。",
            )
            walk = f"我看见{who}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"我看见{who}。{self.pick('整个过程都没有走动', '原地站立', '自始至终没有挪步')}，时间是{t}秒。"
        height = self.pick(f"飞行高度在目标之上{flight.altitude}米。", f"我的飞机比目标高{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "这时走来一位" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，出发时面朝{name}。", f"，朝{name}方向去了。", f"，走的是{name}向。")
