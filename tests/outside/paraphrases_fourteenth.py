"""The fourteenth grammar for check_text_judge.py: a coach's and a robot's English, a poet's and a controller's Chinese. Written before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an
from paraphrases_tenth import upper


class FourteenthEnglish(Grammar):
    code = "en"
    things = ["beside the chapel", "with a rottweiler", "past a pile of bricks", "under the scaffolding", "as the wind howls", "along the quay", "behind a concrete mixer", "near a playground", "eating a doughnut", "across a cattle grid", "in the pouring rain", "next to a kiosk", "between two buses", "with her sister", "through a herd of goats"]
    persons = ["mechanic", "bishop", "street sweeper", "firefighter", "shopkeeper"]

    def who(self, flight):
        noun = self.pick("subject", "target", "pedestrian", "person", "walker")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", pack on back", ", with backpack", " (backpack on)") if backpack else self.pick("", "", ", no pack", " (backpack off)")
        return self.pick(
            f"the {noun} in {top} and {trousers}, {top} being the top{bag}",
            f"the {noun} decked out in {trousers} tracksuit bottoms plus {an(top)} sweater{bag}",
            f"the {noun} showing {top} on the shirt and {trousers} on the trousers{bag}",
            f"{an(top)} jersey and {trousers} shorts: that is the {noun}{bag}",
            f"the {noun} we know by the {top} vest and the {trousers} leggings{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"give them {d} metres and hold it", f"maintain separation: {d} metres", f"your place is {d} m behind, so stay there", f"range to target equals {d} metres", f"sit tight {d} metres back", f"you and the target, {d} metres, nothing else", f"{d} metres between the two of you, got it")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"nose the lens down, {p} degrees", f"camera attitude: {p} degrees down", f"eyes down {p} degrees", f"point it low, {p} degrees beneath the skyline", f"depression angle equals {p} degrees")
        return self.pick(f"nose the lens up, {p} degrees", f"camera attitude: {p} degrees up", f"eyes up {p} degrees", f"elevation angle equals {p} degrees")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" They stand there and that's that.", " They hold their ground throughout.", " Motion status: none.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Listen up. On {who}, now! {upper(distance)}. {upper(view)}.{still}",
            f"Command: follow. Object: {who}. {upper(distance)}. {upper(view)}.{still}",
            f"Let's go, stick with {who}! {upper(view)}. And {distance}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("Heading: never changed.", "Ran a straight line, no cuts.", "Number of turns equals zero.", "Straight down the middle all the way, no lefts, no rights.")
        word = lambda turn: {"around": self.pick("spun around", "went back the other way", "turned 180 degrees")}.get(turn) or self.pick(f"cut {turn}", f"broke {turn}", f"turned {turn}", f"peeled off to the {turn}")
        done = [word(turn) for turn in turns]
        if len(turns) == 1:
            return self.pick(f"One move: {done[0]}.", f"They {done[0]}, job done.", f"Then they {done[0]}.")
        return self.pick("They " + ", then ".join(done) + ".", "Play by play: " + ", ".join(done) + ".", f"{len(turns)} turns in all: " + ", ".join(done) + ".")

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("Never took a breather.", "Did not stop once.", "Number of stops equals zero.", "No standing about, no stopping.")
        if n == 1:
            return self.pick(f"Took one breather of {s} seconds.", f"Stopped once for {s} seconds.", f"Number of stops equals one, dwell time {s} seconds.")
        return self.pick(f"Took {n} breathers, {s} seconds all up.", f"Stopped {n} times, {s} seconds put together.", f"Number of stops equals {n}, dwell time {s} seconds.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"{w} metres in {t} seconds, that's {v} m/s.",
                f"Path length equals {w} metres; elapsed time equals {t} seconds; mean speed equals {v} m/s.",
                f"They put in {w} metres over {t} seconds at a clip of {v} metres a second.",
            )
            walk = f"Today's report: {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"Today's report: {who}. {self.pick('Did not move', 'Stood there', 'Zero displacement, standing')} {self.pick(f'for {t} seconds', f'the whole {t} seconds')}."
        height = self.pick(f"Height above target equals {flight.altitude} metres. ", f"You're up {flight.altitude} metres above their feet. ") if flight.altitude >= 1 else ""
        drone = f"{upper(self.range(flight))}. {upper(self.view(flight))}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". Also in the picture: a {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", out {direction}.", f", facing {direction} to begin with.", f", course {direction}.")


class FourteenthChinese(Grammar):
    code = "zh"
    things = ["挨着小教堂", "遛着罗威纳犬", "路过一堆砖头", "脚手架下", "狂风呼啸", "沿着码头", "跟在水泥搅拌车后面", "在儿童乐园附近", "吃着甜甜圈", "走过一道铁栅栏", "大雨滂沱", "紧邻售货亭", "夹在两辆公交车当中", "和妹妹一起", "穿过羊群"]
    persons = ["修理工", "主教", "环卫工人", "消防员", "店主"]

    def who(self, flight):
        noun = self.pick("行人", "这位行人", "目标", "所跟之人")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，背负双肩包", "，有双肩包在背") if backpack else self.pick("", "", "，身无背包", "，不背包")
        return self.pick(
            f"一袭{top}色上衣、一条{trousers}色长裤的{noun}{bag}",
            f"{noun}，上衣{top}色，裤子{trousers}色{bag}",
            f"身披{top}色外套、腿着{trousers}色裤子的{noun}{bag}",
            f"{noun}（上：{top}色衬衫；下：{trousers}色裤子{bag}）",
            f"那{top}色衣衫、{trousers}色裤子的{noun}{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"相去{d}米", f"隔着{d}米遥遥相随", f"间距设为{d}米", f"与目标距离{d}米，请保持", f"{d}米之外，默默跟随", f"跟随间隔{d}米，收到请回答")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头低垂{p}度", f"俯角设为{p}度", f"俯视{p}度", f"镜头往地面方向倾{p}度")
        return self.pick(f"镜头高扬{p}度", f"仰角设为{p}度", f"仰视{p}度", f"镜头往天空方向倾{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("此人伫立不移。", "目标保持静止。", "目标不走，只是站着。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"指令：跟随{who}，{distance}，{view}。{still}",
            f"且随{who}而行，{distance}，{view}。{still}" if flight.walks else f"且看{who}，{distance}，{view}。{still}",
            f"{distance}；{view}；对象为{who}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左转", "折向左边"), "right": self.pick("右转", "折向右边"), "around": self.pick("掉头", "转身折返")}
        turns = flight.turns
        if not turns:
            return self.pick("一径向前，不曾转弯", "转弯数为零", "未见左转，亦未见右转", "直行到底")
        if len(turns) == 1:
            return self.pick(f"中道{name[turns[0]]}", f"转弯一处：{name[turns[0]]}")
        return self.pick("初" + "，复".join(name[turn] for turn in turns), f"转弯{len(turns)}处：" + "、".join(name[turn] for turn in turns), "先" + "，又".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("步履不歇", "停留数为零", "片刻未停", "一步不停")
        if n == 1:
            return self.pick(f"驻足一次，凡{s}秒", f"停留数为一，计{s}秒", f"停了{s}秒，仅一次")
        return self.pick(f"驻足{n}次，凡{s}秒", f"停留{n}处，计{s}秒", f"停了{n}次，共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"行{w}米，历{t}秒，每秒{v}米。",
                f"里程{w}米，时长{t}秒，速度{v}米每秒。",
                f"{t}秒之间，走过{w}米，步速{v}米/秒。",
            )
            walk = f"报告：{who}，{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"报告：{who}，{self.pick('久立未动', '静止', '原地伫立')}{t}秒。"
        height = self.pick(f"机高于人{flight.altitude}米。", f"相对高度{flight.altitude}米，在目标上方。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "画面中另有一名" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，向{name}而行。", f"，航向{name}。", f"，望{name}而去。")
