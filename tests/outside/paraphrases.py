"""Held-out paraphrases for check_text_judge.py: grammars in other words and other orders than the first one.

Each was written without a look at the lists of words of cosfly's reader. A grammar has `instruction`, `description`, `foreign` and
`heading`, as those in check_text_judge.py.
"""

ZH_COLOURS = dict(zip("black grey white red orange yellow green blue purple pink brown beige".split(), "黑 灰 白 红 橙 黄 绿 蓝 紫 粉 棕 米".split()))
ZH_DIRECTIONS = dict(east="东", west="西", north="北", south="南", northeast="东北", northwest="西北", southeast="东南", southwest="西南")


def an(word):
    return ("an " if word[0] in "aeiou" else "a ") + word


class Grammar:
    def __init__(self, rng):
        self.rng = rng

    def pick(self, *choices):
        return self.rng.choice(choices)


class SecondEnglish(Grammar):
    code = "en"
    things = ["opposite a bakery", "beyond the roundabout", "while a tram goes by", "with a toddler in tow", "through the fog", "beneath a railway bridge", "over the zebra crossing", "as the sun sets", "together with a colleague", "alongside a hedge", "outside a church", "pushing a pram"]
    persons = ["lady", "gentleman", "girl", "biker", "teenager"]

    def who(self, flight):
        noun = self.pick("individual", "person on foot", "figure", "pedestrian", "person")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", rucksack on the back", ", with a rucksack") if backpack else ""
        return self.pick(
            f"the {noun} with {trousers} chinos and {an(top)} sweater{bag}",
            f"the {noun} wearing {an(top)} pullover, {trousers} leggings{bag}",
            f"the {noun} ({top} T-shirt, {trousers} trousers{bag})",
            f"the {noun} in {an(top)} blouse above {trousers} jeans{bag}",
            f"the {noun} clad in {an(top)} top and {an(trousers)} pair of trousers{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"{d} metres away", f"{d} m behind", f"at a range of {d} metres", f"{d} m from the drone", f"with {d} metres in between", f"at {d} m")

    def view(self, flight):
        p, down = abs(flight.pitch), flight.pitch >= 0
        below, ground = ("below", "towards the ground") if down else ("above", "towards the sky")
        return self.pick(f"the camera points {p} degrees {below} the horizon", f"the gimbal is tipped {p} degrees {ground}", f"its lens looks {p}° {below} the horizontal", f"the view is angled {'down' if down else 'up'}, {p} degrees")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" There is no movement: the person just stands there.", " The person is standing the entire time.")
        who, view = self.who(flight), self.view(flight)
        return self.pick(
            f"{self.range(flight).capitalize()} is where we want you: follow {who}, and see that {view}.{still}",
            f"See that {view}. Then pursue {who} {self.range(flight)}.{still}",
            f"Our subject is {who}. Position: {self.range(flight)}; {view}.{still}",
            f"Make sure {view}, and stick to {who}, {self.range(flight)}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        hand = {"left": "left-hand turn", "right": "right-hand turn", "around": "about-turn"}
        if not turns:
            return self.pick("There is not a single turn.", "No turn is taken.", "The whole walk is without turns.")
        if len(turns) == 1:
            return self.pick(f"There is {an(hand[turns[0]])}.", f"One {hand[turns[0]]} is taken.")
        return self.pick(
            "The turns are, in order: " + ", ".join(turns) + ".",
            "It starts with " + an(hand[turns[0]]) + "".join(f", followed by {an(hand[turn])}" for turn in turns[1:]) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("Not one stop is made.", "There is no pause.", "Nothing interrupts the walk.")
        if n == 1:
            return self.pick(f"One pause lasts {s} seconds.", f"A stop of {s} seconds is made.", f"For {s} seconds the person stops.")
        return self.pick(f"{n} pauses add up to {s} seconds.", f"The person rests {n} times, {s} seconds all told.", f"With {n} stops, {s} seconds are spent standing.")

    def description(self, flight):
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"After {flight.duration} seconds and {flight.way} metres it is over; the pace is {flight.speed} m/s.",
                f"A pace of {flight.speed} m/s makes {flight.way} m in {flight.duration} seconds.",
                f"Length: {flight.way} m. Time: {flight.duration} s. Pace: {flight.speed} m/s.",
                f"{flight.way} metres are behind them after {flight.duration} seconds, at {flight.speed} metres a second.",
            )
            walk = f"On foot goes {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"For {flight.duration} seconds, {who} {self.pick('does not move', 'is standing still', 'stands in one spot')}."
        height = self.pick(f"Height over the person: {flight.altitude} m. ", f"It flies {flight.altitude} metres over their feet. ") if flight.altitude >= 1 else ""
        drone = f"The drone is {self.range(flight)}; {self.view(flight)}. {height}"
        return self.pick(f"{drone}{walk}", f"{walk} {drone}".rstrip())

    def foreign(self, text):
        if self.rng.random() < 0.3:
            for noun in ("individual", "person on foot", "figure", "pedestrian", "person"):
                if f"the {noun}" in text:
                    return text.replace(noun, self.rng.choice(self.persons), 1)
        return text.rstrip(".") + " " + self.rng.choice(self.things) + "."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", going {direction}.", f", in {an(direction)}erly direction.", f", moving {direction}wards.")


class SecondChinese(Grammar):
    code = "zh"
    things = ["对面是一家面包店", "绕过环岛", "有电车驶过", "带着小孩", "在雾里", "从铁路桥下穿过", "走过斑马线", "正值日落", "和同事一道", "挨着一排灌木", "在教堂门口", "推着婴儿车"]
    persons = ["女士", "先生", "女孩", "骑车人", "少年"]

    def who(self, flight):
        noun = self.pick("这个人", "步行的人", "行人", "那位", "此人")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，背个双肩包", "，背着包") if backpack else ""
        return self.pick(
            f"{noun}（{top}色毛衣，{trousers}色裤子{bag}）",
            f"穿{top}色T恤、{trousers}色牛仔裤{bag}的{noun}",
            f"{noun}，上衣是{top}色，裤子是{trousers}色{bag}",
            f"套着{top}色卫衣、下面是{trousers}色长裤{bag}的{noun}",
            f"裤子{trousers}色、上衣{top}色{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"距离{d}米", f"隔着{d}米", f"{d}米远", f"离人{d}米", f"中间留出{d}米", f"相隔{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头低于水平线{p}度", f"云台朝地面压{p}度", f"机位往下看{p}度", f"视角下倾{p}度", f"从上往下{p}度拍")
        return self.pick(f"镜头高于水平线{p}度", f"云台往上抬{p}度", f"机位往上看{p}度", f"视角上仰{p}度", f"从下往上{p}度拍")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("人站着，没有走动。", "此人全程站立。")
        who, view = self.who(flight), self.view(flight)
        return self.pick(
            f"{self.range(flight)}，{view}，对象是{who}。{still}",
            f"要跟的对象：{who}。{view}，{self.range(flight)}。{still}",
            f"先让{view}，再去跟{who}，{self.range(flight)}。{still}",
            f"{view}；{self.range(flight)}；跟着{who}。{still}",
        )

    def turns(self, flight):
        name = {"left": "左转弯", "right": "右转弯", "around": "掉头"}
        turns = flight.turns
        if not turns:
            return self.pick("一个弯都没拐", "没有任何转弯", "自始至终没转弯")
        if len(turns) == 1:
            return self.pick(f"有一次{name[turns[0]]}", f"{name[turns[0]]}一回")
        return self.pick("转弯顺序：" + "、".join(name[turn] for turn in turns), "第一次" + "，接下来".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("一次也没停", "没有停过", "不带停的")
        if n == 1:
            return self.pick(f"停过一次，{s}秒", f"歇了一次，{s}秒", f"有一次停留，时长{s}秒")
        return self.pick(f"停过{n}次，总共{s}秒", f"歇了{n}次，一共{s}秒", f"{n}次停留加在一起{s}秒")

    def description(self, flight):
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"{flight.way}米的路，{flight.duration}秒走到头，每秒{flight.speed}米。",
                f"路长{flight.way}米，时间{flight.duration}秒，速度每秒{flight.speed}米。",
                f"走了{flight.duration}秒、{flight.way}米，速度是{flight.speed}米/秒。",
            )
            walk = f"走路的是{who}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"{flight.duration}秒里，{who}{self.pick('没有动过', '站在原处', '一步没走')}。"
        height = self.pick(f"高度在人之上{flight.altitude}米。", f"飞得比人高{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"无人机{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        if self.rng.random() < 0.3:
            for noun in ("这个人", "步行的人", "行人", "那位", "此人"):
                if noun in text:
                    return text.replace(noun, self.rng.choice(self.persons), 1)
        return text.rstrip("。") + "，" + self.rng.choice(self.things) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，方向{name}。", f"，往{name}走。", f"，走向{name}边。")


class ThirdEnglish(Grammar):
    """Written after the reader was widened for the second grammar."""

    code = "en"
    things = ["by a newsstand", "past the petrol station", "between two lorries", "with their spouse", "in the drizzle", "through an underpass", "carrying groceries", "near a playground", "at midnight", "close to the harbour"]
    persons = ["jogger in his sixties", "schoolgirl", "policeman", "waiter", "grandmother"]

    def who(self, flight):
        noun = self.pick("pedestrian", "walker", "person", "target")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(" plus a backpack", " and carries a rucksack") if backpack else ""
        return self.pick(
            f"the {noun} who has {an(top)} jumper on and {trousers} trousers{bag}",
            f"the {noun} whose jacket is {top} and whose pants are {trousers}{bag}",
            f"the {top}-topped {noun} with {trousers} jeans{bag}",
            f"the {noun} sporting {an(top)} sweatshirt and {trousers} joggers{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"never leave the {d} m mark", f"your standoff is {d} metres", f"let there be {d} m between you and the target", f"settle at a {d}-metre gap", f"fly at a distance of {d} m")

    def view(self, flight):
        p, way = abs(flight.pitch), "down" if flight.pitch >= 0 else "up"
        return self.pick(f"have the camera look {way} by {p} degrees", f"set the gimbal {p}° {way}", f"look {way}wards at an angle of {p} degrees", f"use {an('downward' if way == 'down' else 'upward')} angle of {p} degrees")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" They are not moving.", " They remain stationary.")
        return self.pick(
            f"Your job: {self.range(flight)}, {self.view(flight)}, and watch {self.who(flight)}.{still}",
            f"First {self.view(flight)}; then {self.range(flight)} while you trail {self.who(flight)}.{still}",
            f"Watch {self.who(flight)}; {self.range(flight)}; {self.view(flight)}.{still}",
        )

    def description(self, flight):
        t, w, v, s, n = flight.duration, flight.way, flight.speed, flight.standing, flight.stops
        if flight.walks:
            turns = flight.turns
            if not turns:
                turned = self.pick("They keep to one street without turning.", "They do not turn at all.")
            elif len(turns) == 1:
                turned = f"They make one turn, {'to the ' if turns[0] != 'around' else ''}{turns[0]}."
            else:
                turned = "They turn " + ", ".join(turns[:-1]) + " and finally " + turns[-1] + "."
            stopped = self.pick("At no point do they stop.", "They never stop.") if n == 0 else f"They stop once, for {s} seconds." if n == 1 else self.pick(f"They stop {n} times for a total of {s} seconds.", f"They stop {n} times, {s} seconds in sum.")
            length = self.pick(f"The walk of {w} m lasts {t} seconds, so {v} m/s.", f"They walk {w} metres in {t} seconds, which is {v} m/s.", f"Walking at {v} m/s, they need {t} seconds for {w} m of path.")
            walk = f"Watch {self.who(flight)}. {turned} {stopped} {length}"
        else:
            walk = f"Over {t} seconds {self.who(flight)} {self.pick('stays put', 'is motionless', 'does not budge and stands still')}."
        height = f"Fly {flight.altitude} m higher than the target. " if flight.altitude >= 1 else ""
        drone = f"{self.range(flight).capitalize()}; {self.view(flight)}. {height}".rstrip()
        return self.pick(f"{walk} {drone}", f"{drone} {walk}")

    def foreign(self, text):
        return text.rstrip(".") + " " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f"; a {self.rng.choice(self.persons)} is there too."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", bearing {direction}.", f", off to the {direction}.", f", {direction}ward.")


class ThirdChinese(Grammar):
    code = "zh"
    things = ["路过报刊亭", "加油站旁边", "夹在两辆货车之间", "和爱人一起", "下着毛毛雨", "穿过地下通道", "拎着菜", "操场附近", "深夜时分", "靠近码头"]
    persons = ["警察", "服务员", "老奶奶", "女学生"]

    def who(self, flight):
        noun = self.pick("行人", "目标", "走路的人", "路人")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("、背双肩包", "、背了背包") if backpack else ""
        return self.pick(
            f"身上是{top}色衬衫、腿上是{trousers}色裤子{bag}的{noun}",
            f"穿{top}色夹克搭{trousers}色长裤{bag}的{noun}",
            f"{top}上衣{trousers}裤子{bag}的{noun}",
            f"外面穿{top}色外套、下穿{trousers}色裤子{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"人机间距{d}米", f"跟在后方{d}米处", f"维持{d}米的间隔", f"别超过也别小于{d}米的距离", f"和目标之间隔{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        return self.pick(f"镜头朝下{p}度角", f"俯角打到{p}度", f"往下压{p}度拍", f"俯拍角度为{p}度") if flight.pitch >= 0 else self.pick(f"镜头朝上{p}度角", f"仰角打到{p}度", f"往上抬{p}度拍")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("目标没走动。", "目标一直站在那里。")
        return self.pick(
            f"你的任务是看住{self.who(flight)}，{self.range(flight)}，{self.view(flight)}。{still}",
            f"{self.view(flight)}，然后{self.range(flight)}，拍{self.who(flight)}。{still}",
            f"飞手注意：{self.range(flight)}；{self.view(flight)}；跟的是{self.who(flight)}。{still}",
        )

    def description(self, flight):
        t, w, v, s, n = flight.duration, flight.way, flight.speed, flight.standing, flight.stops
        if flight.walks:
            names = {"left": "向左拐弯", "right": "向右拐弯", "around": "掉头"}
            turns = [names[turn] for turn in flight.turns]
            turned = self.pick("路上不拐弯", "没有转过一个弯") if not turns else "，之后".join(turns)
            stopped = self.pick("没有停步", "从没停下") if n == 0 else f"停下一次{s}秒" if n == 1 else self.pick(f"停下{n}次，合计{s}秒", f"先后停了{n}次，共{s}秒")
            length = self.pick(f"这段路程{w}米，走了{t}秒，每秒{v}米。", f"全程{w}米用了{t}秒，步速{v}米/秒。", f"步速{v}米/秒，用{t}秒走完{w}米。")
            walk = f"拍的是{self.who(flight)}。{turned}，{stopped}。{length}"
        else:
            walk = f"{self.who(flight)}在{t}秒内{self.pick('一直站着', '原地不动', '没有走动')}。"
        height = f"比目标高出{flight.altitude}米。" if flight.altitude >= 1 else ""
        drone = f"飞行时{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "旁边有个" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，一路向{name}。", f"，奔{name}去。", f"，朝{name}方向。")


GRAMMARS = {2: (SecondEnglish, SecondChinese), 3: (ThirdEnglish, ThirdChinese)}
