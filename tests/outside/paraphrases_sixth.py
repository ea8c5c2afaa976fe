"""The sixth grammar for check_text_judge.py: a film director's English, an official's Chinese. Written in full before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


class SixthEnglish(Grammar):
    code = "en"
    things = ["outside a launderette", "as a heron takes off", "beside a skip full of rubble", "with her twin", "across a footbridge", "past two parked ambulances", "under some scaffolding", "carrying a trombone", "near a duck pond", "while a blizzard rages", "next to a kebab stall", "behind a marching band", "in front of a windmill", "arm in arm with a sailor", "by a broken vending machine"]
    persons = ["plumber", "ballerina", "toddler", "postwoman", "bricklayer"]

    def who(self, flight):
        noun = self.pick("walker", "pedestrian", "target", "subject", "person we want")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", lugging a backpack", ", rucksack slung over both shoulders", " and a daypack") if backpack else self.pick("", "", ", no bag")
        return self.pick(
            f"the {noun} kitted out in {an(top)} fleece and {trousers} joggers{bag}",
            f"the {noun} sporting {an(top)} windbreaker with {trousers} cargo pants{bag}",
            f"the {noun} ({top} up top, {trousers} below{bag})",
            f"the {noun}, {top} long-sleeved shirt, {trousers} denim jeans{bag},",
            f"the {noun} in {trousers} corduroy trousers topped with {an(top)} cardigan{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"hold the gap at {d} metres", f"tail them from {d} metres", f"let {d} metres separate you", f"hover {d} m behind", f"don't creep closer than {d} metres nor fall further back", f"{d} metres of daylight, please", f"shadow them {d} metres to the rear")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"the lens dips {p} degrees", f"look {p} degrees below level", f"depress the camera by {p} degrees", f"peer down on the scene at {p} degrees", f"nose the camera {p}° towards the floor")
        return self.pick(f"the lens rises {p} degrees", f"look {p} degrees above level", f"elevate the camera by {p} degrees", f"nose the camera {p}° towards the clouds")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" Nothing happens: they stay put.", " The subject never leaves the spot.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Right, here's the shot: {who}. {distance.capitalize()}; {view}.{still}",
            f"Action! Glue yourself to {who}, {distance}, {view}.{still}",
            f"What I need from you: {distance}, {view}, and all eyes on {who}.{still}",
            f"Camera rolling on {who}. {view.capitalize()} and {distance}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("Dead straight all the way.", "Not a single bend in the route.", "They hold one heading from first step to last.", "No corners here.")
        verbs = {"left": self.pick("hang a left", "veer left", "bear left"), "right": self.pick("hang a right", "veer right", "bear right"), "around": self.pick("double back", "make a U-turn", "about-face")}
        if len(turns) == 1:
            return self.pick(f"Just the one change of direction: they {verbs[turns[0]]}.", f"Somewhere along the way they {verbs[turns[0]]}.")
        return self.pick(
            "They " + ", then ".join(verbs[turn] for turn in turns) + ".",
            "To begin with they " + "; afterwards they ".join(verbs[turn] for turn in turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("Their feet never rest.", "They carry on walking with no let-up.", "Non-stop from start to finish.", "They don't break stride once.")
        if n == 1:
            return self.pick(f"They freeze for {s} seconds, once.", f"One breather, {s} seconds.", f"Midway they hang about for {s} seconds.", f"They come to a standstill once and stay there {s} seconds.")
        return self.pick(f"{n} breathers, {s} seconds in total.", f"They come to a standstill {n} times, costing {s} seconds.", f"On {n} occasions they hang about, {s} seconds all in all.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"{w} metres get eaten up in {t} seconds, that's {v} m/s.",
                f"The scene lasts {t} seconds and spans {w} metres on foot at {v} metres per second.",
                f"Tempo: {v} m/s. Ground covered: {w} m. Running time: {t} s.",
                f"They clock up {w} metres within {t} seconds; call it {v} m/s.",
            )
            walk = f"Our star is {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"Our star is {who}. For {t} seconds they {self.pick('stay glued to the spot', 'do not take a step', 'stand like a statue')}."
        height = self.pick(f"Vertical offset: {flight.altitude} m. ", f"We float {flight.altitude} metres overhead. ") if flight.altitude >= 1 else ""
        distance = self.range(flight)
        drone = f"{distance[0].upper() + distance[1:]}; {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f", watched by a {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", making for the {direction}.", f", {direction}ward ho.", f", on a {direction}erly course.")


class SixthChinese(Grammar):
    code = "zh"
    things = ["途经一座石拱桥", "旁边停着一辆救护车", "与其妻子同行", "头顶掠过一群大雁", "紧挨着菜市场", "身后跟着一条黄狗", "时值大雪", "在售票窗口前", "手里拎着鸟笼", "从脚手架下面过", "迎面来了个卖糖葫芦的", "经过一处公厕", "肩扛一袋水泥", "在风车前面", "与一名水手并排"]
    persons = ["水管工", "芭蕾舞演员", "邮递员", "泥瓦匠", "老太太"]

    def who(self, flight):
        noun = self.pick("被跟踪者", "行人", "目标人员", "该行人", "被摄对象")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，肩背双肩包", "，背有背包一只") if backpack else self.pick("", "", "，未携带背包")
        return self.pick(
            f"上着{top}色外衣、下着{trousers}色长裤{bag}的{noun}",
            f"着{top}色冲锋衣、{trousers}色休闲裤{bag}的{noun}",
            f"{noun}（上装{top}色，下装{trousers}色{bag}）",
            f"身披{top}色大衣、腿上是{trousers}色裤子{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"间距须保持在{d}米", f"于{d}米处跟随", f"应与其相隔{d}米", f"跟随距离为{d}米", f"不得偏离{d}米这一间距", f"距其{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头俯角设为{p}度", f"摄像头向下{p}度", f"相机下偏{p}度", f"云台俯仰下调{p}度")
        return self.pick(f"镜头仰角设为{p}度", f"摄像头向上{p}度", f"云台俯仰上调{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("该人员未发生位移。", "目标停留于原地未动。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"任务：跟随{who}。要求：{distance}，{view}。{still}",
            f"请对{who}实施跟拍，{distance}，{view}。{still}",
            f"{view}，{distance}，务必锁定{who}。{still}",
            f"现需追踪{who}，{distance}且{view}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左转", "向左转向", "左拐"), "right": self.pick("右转", "向右转向", "右拐"), "around": self.pick("掉头", "原路折返")}
        turns = flight.turns
        if not turns:
            return self.pick("未作任何转向", "行进方向保持不变", "全程直线行进", "途中无转弯")
        if len(turns) == 1:
            return self.pick(f"途中{name[turns[0]]}", f"仅有一次转向，为{name[turns[0]]}")
        return self.pick("依次" + "、".join(name[turn] for turn in turns), "先是" + "，继而".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("途中未作停留", "行进未曾中断", "全程无停顿", "持续行走，没有驻足")
        if n == 1:
            return self.pick(f"驻足一次，时长{s}秒", f"其间原地停留{s}秒", f"曾短暂停步，为时{s}秒")
        return self.pick(f"先后驻足{n}次，总时长{s}秒", f"其间停留{n}次，合计{s}秒", f"停步{n}次，累计用时{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"行进{w}米，用时{t}秒，平均速度{v}米/秒。",
                f"录像时长{t}秒，步行距离{w}米，速度为每秒{v}米。",
                f"以{v}米每秒的速度在{t}秒内行进{w}米。",
            )
            walk = f"拍摄对象为{who}。{self.turns(flight)}；{self.stops(flight)}。{length}"
        else:
            walk = f"拍摄对象为{who}，在{t}秒内{self.pick('始终处于静止状态', '未移动位置', '保持站立不动')}。"
        height = self.pick(f"相对目标高度{flight.altitude}米。", f"飞行器位于目标上方{flight.altitude}米处。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "现场另有一名" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，行进方向为{name}。", f"，朝正{name}方向移动。" if len(name) == 1 else f"，朝{name}方向移动。", f"，向{name}而行。")
