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


class FourthEnglish(Grammar):
    """Written after the reader was widened for the third grammar, and measured once before any change."""

    code = "en"
    things = ["by a launderette", "in front of a greengrocer's", "under some scaffolding", "with a walking frame", "past an ice-cream van", "along the towpath", "in the blazing heat", "beside a skip", "just before lunch", "holding a clipboard", "next to a wheelie bin", "round the back of a garage", "while a siren wails", "in flip-flops", "through a turnstile"]
    persons = ["sailor", "jogger", "plumber", "twin brother", "traffic warden", "salesman"]

    def who(self, flight):
        noun = self.pick("person", "pedestrian", "walker", "target", "passer-by")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(" and a backpack", ", rucksack included,", " with a backpack slung over the shoulders") if backpack else ""
        return self.pick(
            f"the {noun} in the {top} coat and the {trousers} trousers{bag}",
            f"the {noun} with {an(top)} jacket, {trousers} jeans{bag}",
            f"the {noun} who is wearing {trousers} pants and {an(top)} top{bag}",
            f"the {noun} dressed in {top} and {trousers}" + (" who carries a backpack" if backpack else ""),
            f"the {noun} (coat: {top}, trousers: {trousers}{', backpack' if backpack else ''})",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"keep {d} metres between yourself and them", f"sit {d} m off", f"hold station {d} metres away", f"the gap should be {d} m", f"don't let the distance drift from {d} metres", f"work from {d} m out")

    def view(self, flight):
        p, way = abs(flight.pitch), "down" if flight.pitch >= 0 else "up"
        return self.pick(f"with the camera angled {p} degrees {way}", f"gimbal at {p} degrees {way}", f"shooting {way} at {p}°", f"the lens tipped {way} {p} degrees", f"looking {way} at a {p}-degree angle")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" They won't be moving.", " They're standing still the whole time.")
        return self.pick(
            f"I want you on {self.who(flight)}; {self.range(flight)}, {self.view(flight)}.{still}",
            f"Could you pick up {self.who(flight)}? {self.range(flight).capitalize()}, {self.view(flight)}.{still}",
            f"{self.range(flight).capitalize()}, {self.view(flight)}: that's {self.who(flight)} you're following.{still}",
            f"Tag along behind {self.who(flight)}, {self.view(flight)}, and {self.range(flight)}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        spoken = {"left": "left", "right": "right", "around": "back"}
        if not turns:
            return self.pick("No turns at all.", "They don't turn once.", "Not one corner is turned.")
        if len(turns) == 1:
            return {"around": "At one point they turn back."}.get(turns[0], self.pick(f"At one point they hang a {turns[0]}.", f"They turn {turns[0]} once."))
        one = {"left": "a left", "right": "a right", "around": "a U-turn"}
        return self.pick(
            "They take " + ", then ".join(one[turn] for turn in turns) + ".",
            f"In all they make {len(turns)} turns: " + ", then ".join(one[turn] for turn in turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("They keep walking from start to finish without stopping.", "Nothing holds them up and they never stop.", "There isn't a single stop.", "They don't stop anywhere.")
        if n == 1:
            return self.pick(f"They stop just once, for {s} seconds.", f"There's a {s}-second stop.", f"They stand still once, waiting for {s} seconds.")
        return self.pick(f"There are {n} stops, {s} seconds all together.", f"They stop {n} times and spend {s} seconds standing.", f"They make {n} stops totalling {s} seconds.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        if flight.walks:
            length = self.pick(
                f"It's a {t}-second walk of {w} metres, so roughly {v} m/s.",
                f"They do {w} m in {t} seconds, an average of {v} m/s.",
                f"The whole walk is {w} metres; it takes them {t} seconds at {v} m/s.",
                f"{t} seconds, {w} metres walked, {v} m/s.",
            )
            walk = f"We're with {self.who(flight)}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"We're with {self.who(flight)}, who {self.pick('stands there', 'stays put', 'stands still')} for {t} seconds."
        height = self.pick(f"We're {flight.altitude} m above them. ", f"Our height over the target is {flight.altitude} metres. ") if flight.altitude >= 1 else ""
        drone = f"Pilot: {self.range(flight)}, {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f", and there's {an(self.rng.choice(self.persons))} as well."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", making for the {direction}.", f", due {direction}.", f", on {an(direction)}ward course.")


class FourthChinese(Grammar):
    code = "zh"
    things = ["身后跟着一条狗", "路边停着救护车", "拐进菜市场", "手里捏着票", "戴着草帽", "走在河堤上", "赶上下班高峰", "从脚手架下面钻过去", "同伴走在左边", "路口有人发传单", "太阳很晒", "在彩票店前面", "踩着滑板", "拖着箱子", "旁边是施工围挡"]
    persons = ["环卫工", "外卖员", "中学生", "老大爷", "推销员"]

    def who(self, flight):
        noun = self.pick("行人", "目标", "路人", "那个人", "人")
        if not flight.wear:
            return "那个人" if noun == "人" else noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("、还背着双肩包", "、背个背包") if backpack else ""
        return self.pick(
            f"穿{top}色上衣、{trousers}色裤子{bag}的{noun}",
            f"上面{top}色外套、下面{trousers}色裤子{bag}的{noun}",
            f"{trousers}裤子、{top}外套{bag}的那个{noun}".replace("那个那个", "那个"),
            f"衣服是{top}色、裤子是{trousers}色{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"离着{d}米", f"保持{d}米不变", f"距离稳在{d}米", f"和人拉开{d}米", f"飞在{d}米外", f"隔{d}米跟着")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头往下{p}度", f"{p}度俯拍", f"云台压低{p}度", f"镜头斜向下{p}度")
        return self.pick(f"镜头往上{p}度", f"{p}度仰拍", f"镜头斜向上{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("人一直站着没动。", "人就站在原地。")
        return self.pick(
            f"给我盯紧{self.who(flight)}，{self.range(flight)}，{self.view(flight)}。{still}",
            f"{self.view(flight)}，{self.range(flight)}，跟的就是{self.who(flight)}。{still}",
            f"麻烦跟拍一下{self.who(flight)}，{self.view(flight)}，{self.range(flight)}。{still}",
            f"这次拍{self.who(flight)}。{self.range(flight)}就行，{self.view(flight)}。{still}",
        )

    def turns(self, flight):
        name = {"left": "左拐", "right": "右拐", "around": "掉头"}
        turns = flight.turns
        if not turns:
            return self.pick("中间没拐过弯", "一次弯都没转", "路上一个弯也不拐")
        if len(turns) == 1:
            return self.pick(f"中间{name[turns[0]]}了一次", f"只{name[turns[0]]}过一回")
        return self.pick("先" + "，再".join(name[turn] for turn in turns), f"总共转了{len(turns)}次弯：" + "、".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("路上没歇过", "中间一次都没停", "没停下来过")
        if n == 1:
            return self.pick(f"中间停了一下，{s}秒", f"歇了一回，有{s}秒", f"停过一次，停了{s}秒")
        return self.pick(f"停了{n}回，加一块儿{s}秒", f"中间停过{n}次，总共停了{s}秒", f"歇了{n}次脚，共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        if flight.walks:
            length = self.pick(
                f"{w}米走了{t}秒，一秒走{v}米。",
                f"用{t}秒走了{w}米，速度大概{v}米每秒。",
                f"这一趟{w}米，前后{t}秒，步速{v}米/秒。",
            )
            walk = f"画面里是{self.who(flight)}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"{self.who(flight)}{self.pick('站在那儿没动', '一直站着', '原地站着')}，{t}秒。"
        height = self.pick(f"飞机比人高{flight.altitude}米。", f"人在下方，高差{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"飞的时候{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "还有个" + self.rng.choice(self.persons) + "在场") + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，直奔{name}边。", f"，朝着{name}面走。", f"，往{name}去了。")


class FifthEnglish(Grammar):
    """Held out: written after the reader was widened for the fourth grammar, and measured once before any change."""

    code = "en"
    things = ["beneath a pergola", "past a row of lockers", "with an elderly relative", "as hailstones fall", "while chewing gum", "along the embankment", "around a crater", "in a wheelchair", "beside a vending machine", "with a violin case", "towards the town hall", "amid fallen leaves", "on crutches", "near some pigeons", "behind a hearse"]
    persons = ["butcher", "farmer", "nun", "street sweeper", "juggler"]

    def who(self, flight):
        noun = self.pick("pedestrian", "person", "walker", "subject", "individual")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(" and wears a backpack", " and has a backpack on", ", backpack and all,") if backpack else ""
        return self.pick(
            f"the {noun} who's got {an(top)} jacket and {trousers} trousers on{bag}",
            f"the {noun} whose trousers are {trousers} and whose shirt is {top}{bag}",
            f"{an(noun)} in {an(top)} sweater with {trousers} trousers{bag}",
            f"the one with the {trousers} jeans and the {top} hoodie{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"stick to {d} metres", f"give them {d} metres", f"stay within sight, {d} m away", f"park yourself {d} m behind", f"the right distance is {d} m", f"make it {d} metres of clearance")

    def view(self, flight):
        p, way = abs(flight.pitch), "down" if flight.pitch >= 0 else "up"
        return self.pick(f"point your camera {p} degrees {way}", f"dial in {p} degrees of {way}ward tilt", f"swing the gimbal {way} to {p} degrees", f"have the lens {p}° {way}")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" They aren't going anywhere; they just stand there.", " The person is rooted to the spot.")
        who = self.who(flight)
        return self.pick(
            f"See {who}? Follow, {self.range(flight)}, and {self.view(flight)}.{still}",
            f"Latch on to {who}. Then {self.range(flight)} and {self.view(flight)}.{still}",
            f"Before anything else, {self.view(flight)}. After that {self.range(flight)} and stay on {who}.{still}",
            f"Our job is {who}: {self.range(flight)}, {self.view(flight)}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("Not once do they turn.", "They walk without making a turn.", "There are zero turns.")
        side = {"left": "to the left", "right": "to the right", "around": "around"}
        if len(turns) == 1:
            return self.pick(f"There's just one turn, {side[turns[0]]}." if turns[0] != "around" else "They do a single U-turn.", f"Halfway they turn {turns[0]}.")
        return self.pick(
            "They first turn " + ", later ".join(turns) + ".",
            "Their turns go " + ", ".join(turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("Without a break they walk on.", "They don't pause even once.", "The walk is uninterrupted.", "They make no stops.")
        if n == 1:
            return self.pick(f"They take one break of {s} seconds.", f"Once, they wait for {s} seconds.", f"A {s}-second pause is all the rest they get.")
        return self.pick(f"They take {n} breaks, {s} seconds taken together.", f"{n} times they stop, which adds up to {s} seconds.", f"Their {n} pauses last {s} seconds overall.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        if flight.walks:
            length = self.pick(
                f"They get through {w} metres in {t} seconds, doing {v} m/s.",
                f"{w} m of walking takes {t} seconds at {v} m/s.",
                f"The clip runs for {t} seconds, in which they walk {w} m at {v} metres per second.",
                f"Distance walked: {w} m. Duration: {t} s. Speed: {v} m/s.",
            )
            walk = f"This is about {self.who(flight)}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"This is about {self.who(flight)}. They {self.pick('stand still', 'stay where they are', 'do not move')} for {t} seconds."
        height = self.pick(f"Altitude above the target: {flight.altitude} m. ", f"Climb to {flight.altitude} m above them. ") if flight.altitude >= 1 else ""
        rest = f"{self.range(flight)}, and {self.view(flight)}. "
        drone = rest[0].upper() + rest[1:] + height
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + " " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". Mind the {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", pointing {direction}.", f", {direction} all the way.", f", along a {direction}-facing line.")


class FifthChinese(Grammar):
    code = "zh"
    things = ["手持自拍杆", "在葡萄架下", "前方有救火车", "肩上扛着梯子", "路过派出所", "跟一个老外聊着天", "地上结了冰", "在电影院外面", "身后是一片麦地", "正赶上庙会", "躲着水洼走", "头顶飞过一只风筝", "穿过牌坊", "拿了根甘蔗", "有辆洒水车经过"]
    persons = ["消防员", "护工", "小朋友", "和尚", "卖花的"]

    def who(self, flight):
        noun = self.pick("行人", "目标", "这位", "走路的人", "那名路人")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，背上有双肩包", "、背着个背包") if backpack else ""
        return self.pick(
            f"上衣{top}色、裤子{trousers}色{bag}的{noun}",
            f"穿一件{top}色外套、一条{trousers}色长裤{bag}的{noun}",
            f"身穿{top}衬衫{trousers}裤子{bag}的{noun}",
            f"{trousers}色裤子配{top}色上衣{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"跟{d}米远", f"差不多隔{d}米", f"距离定在{d}米", f"留{d}米距离", f"别离开{d}米这个距离", f"人机相距{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头下俯{p}度", f"俯角{p}度", f"相机往下斜{p}度", f"角度朝下，{p}度")
        return self.pick(f"镜头上仰{p}度", f"仰角{p}度", f"相机往上斜{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("对方没有挪动，一直站着。", "人是站着的。")
        return self.pick(
            f"看到{self.who(flight)}了吧？{self.range(flight)}，{self.view(flight)}，跟上。{still}",
            f"咬住{self.who(flight)}，{self.range(flight)}，{self.view(flight)}。{still}",
            f"起飞后{self.view(flight)}，{self.range(flight)}，去拍{self.who(flight)}。{still}",
            f"飞行要求：{self.range(flight)}，{self.view(flight)}，拍摄对象是{self.who(flight)}。{still}",
        )

    def turns(self, flight):
        name = {"left": "左转", "right": "右转", "around": "调头"}
        turns = flight.turns
        if not turns:
            return self.pick("没拐弯", "始终不曾转弯", "全程不转弯")
        if len(turns) == 1:
            return self.pick(f"走着走着{name[turns[0]]}", f"{name[turns[0]]}一次")
        return self.pick("、".join(name[turn] for turn in turns) + f"，共转弯{len(turns)}次", "起先" + "，后来".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("一口气走完", "不停脚", "一路上没有停顿", "没有停过脚")
        if n == 1:
            return self.pick(f"停顿一次，{s}秒", f"中途等了一次，等了{s}秒", f"歇脚一次，{s}秒后再走")
        return self.pick(f"停顿{n}次，合起来{s}秒", f"先后{n}次停步，总计{s}秒", f"走走停停，停了{n}次，共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        if flight.walks:
            length = self.pick(
                f"{t}秒钟走出{w}米，每秒{v}米的速度。",
                f"全程{w}米，{t}秒，{v}米/秒。",
                f"路程共{w}米，走了{t}秒，平均速度{v}米/秒。",
            )
            walk = f"主角是{self.who(flight)}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"主角是{self.who(flight)}，{self.pick('站住没走', '没挪过步', '一动不动')}，共{t}秒。"
        height = self.pick(f"飞行高度在目标上方{flight.altitude}米。", f"无人机高出人{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "边上那个" + self.rng.choice(self.persons) + "别拍到") + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，面朝{name}方。", f"，一直往{name}。", f"，冲{name}边走。")
