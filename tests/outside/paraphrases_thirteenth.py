"""The thirteenth grammar for check_text_judge.py: a learner's English and a lawyer's, a teacher's and a grandfather's Chinese. Written before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an
from paraphrases_tenth import minutes, upper


class ThirteenthEnglish(Grammar):
    code = "en"
    things = ["in front of the bakery window", "with a bunch of tulips", "past two nuns", "under the motorway bridge", "when it began to snow", "along a canal", "behind a garbage truck", "near the roundabout", "with a limping dog", "across the car park", "on a skateboard", "beneath the station clock", "beside a hot dog stand", "holding a trombone", "among tourists"]
    persons = ["barrister", "butcher", "choirboy", "waitress", "sailor"]

    def who(self, flight):
        noun = self.pick("person", "said person", "pedestrian", "individual on foot", "target")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", bearing a backpack", " who has also a backpack", ", with one backpack") if backpack else self.pick("", "", ", bearing no backpack", " who has not any backpack")
        return self.pick(
            f"the {noun} who is wearing one {top} jacket and one pair of {trousers} trousers{bag}",
            f"the {noun} that wears trousers of {trousers} colour and a shirt of {top} colour{bag}",
            f"the {noun} identified by {an(top)} coat together with {trousers} pants{bag}",
            f"the {noun}, the jacket of whom is {top} and the trousers of whom are {trousers}{bag}",
            f"the {noun} clothed as follows: jacket {top}, trousers {trousers}{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"you must fly {d} metres far from this person", f"the distance between the drone and the target is {d} metres", f"a distance of {d} metres shall be observed by the pilot", f"it is necessary to have {d} metres of space", f"the pilot shall at no time deviate from a distance of {d} m", f"please be always {d} meters behind", f"{d} metres, this is the distance to keep")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"the camera is looking {p} degrees to the ground", f"the camera must look down with {p} degrees", f"the angle of the camera, {p} degrees below the horizon, shall not be varied", f"the camera makes {p} degrees with the horizon, downward", f"an inclination of {p} degrees in the downward direction shall apply")
        return self.pick(f"the camera is looking {p} degrees to the sky", f"the camera must look up with {p} degrees", f"the camera makes {p} degrees with the horizon, upward", f"an inclination of {p} degrees in the upward direction shall apply")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" This person is not moving.", " The person only stands.", " It is noted that no steps are taken by said person.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"You have to follow {who}. {upper(distance)}. {upper(view)}.{still}",
            f"The pilot undertakes to follow {who}, subject to the following: {distance}; {view}.{still}",
            f"Can you see {who}? Good. Follow. {upper(distance)} and {view}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("The person goes only straight", "The person does never change the direction", "No turn was performed", "The way has no curves")
        word = lambda turn: {"around": self.pick("goes back to where it came from", "makes a U-turn", "turns by 180 degrees")}.get(turn) or self.pick(f"turns to the {turn}", f"goes to the {turn} side", f"makes a curve to the {turn}")
        done = [word(turn) for turn in turns]
        if len(turns) == 1:
            return self.pick(f"The person one time {done[0]}", f"In the middle the person {done[0]}")
        return self.pick("The person " + " and afterwards ".join(done), "At first the person " + ", secondly it ".join(done[:2]) + "".join(f", next it {it}" for it in done[2:]))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("it makes no pause", "it is walking all the time without stop", "no interruption of the walk took place", "it did not stop even one time")
        if n == 1:
            return self.pick(f"it makes one pause of {s} seconds", f"one interruption of {s} seconds took place", f"it stops one time during {s} seconds")
        return self.pick(f"it makes {n} pauses, together {s} seconds", f"{n} interruptions amounting to {s} seconds took place", f"it stops {n} times during {s} seconds in total")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"The way is {w} metres, the time is {t} seconds and the speed is {v} metres per second.",
                f"Within {minutes(t)} a distance of {w} metres was traversed on foot at a mean velocity of {v} m/s.",
                f"It needs {t} seconds for walking {w} meters with {v} m/s.",
            )
            walk = f"We see {who}. {self.turns(flight)}, {self.stops(flight)}. {length}"
        else:
            walk = f"We see {who}. {self.pick('The person is standing', 'The person does not go anywhere', 'The position of said person remained unchanged')} {self.pick(f'during {t} seconds', f'for a period of {minutes(t)}')}."
        height = self.pick(f"The drone is {flight.altitude} metres higher than the person. ", f"An altitude of {flight.altitude} metres above the person shall be kept. ") if flight.altitude >= 1 else ""
        drone = f"{upper(self.range(flight))}. {upper(self.view(flight))}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". There was also a {self.rng.choice(self.persons)}."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", in {direction} direction.", f", starting toward the {direction}.", f", it goes to the {direction}.")


class ThirteenthChinese(Grammar):
    code = "zh"
    things = ["在面包房的橱窗前", "捧着一束郁金香", "与两位修女擦肩", "从高架桥下穿过", "开始飘雪花了", "顺着运河", "尾随一辆垃圾车", "在环岛附近", "身边有条瘸腿狗", "横穿停车场", "踩着滑板", "车站大钟底下", "挨着热狗摊", "抱着长号", "混在游客堆里"]
    persons = ["律师", "屠夫", "小歌手", "女服务员", "水手"]

    def who(self, flight):
        noun = self.pick("行人", "那个人", "被摄者", "目标", "走路的人")
        if noun == "走路的人" and not flight.walks:
            noun = "行人"
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，背了一个双肩包", "，并背有书包") if backpack else self.pick("", "", "，未携带背包", "，后背没有背包")
        return self.pick(
            f"{noun}，其上衣颜色是{top}色，裤子颜色是{trousers}色{bag}",
            f"上衣是{top}色的、裤子是{trousers}色的{noun}{bag}",
            f"穿着一件{top}色外套和一条{trousers}色裤子的{noun}{bag}",
            f"身着{top}色衣服与{trousers}色裤子的{noun}{bag}",
            f"{noun}（{top}色衬衫配{trousers}色长裤{bag}）",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"无人机要离得有{d}米远", f"应与之保持{d}米的跟随距离", f"飞机同人之间相隔{d}米", f"记住，距离{d}米", f"距离应为{d}米，不得更改", f"你得在{d}米以外跟着")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头要往下看{p}度", f"摄像头以{p}度的俯角对准", f"相机应下倾{p}度", f"镜头与水平线成{p}度角向下")
        return self.pick(f"镜头要往上看{p}度", f"摄像头以{p}度的仰角对准", f"相机应上倾{p}度", f"镜头与水平线成{p}度角向上")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("这个人没有动，只是站立。", "该目标处于静止状态。", "人家哪儿也没去，就站着。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"同学们，请跟随{who}。{distance}，{view}。{still}",
            f"孩子，看见{who}了吗？跟上去。{distance}，{view}。{still}",
            f"请按要求跟拍{who}：{distance}；{view}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("向左转了弯", "往左边拐", "左转"), "right": self.pick("向右转了弯", "往右边拐", "右转"), "around": self.pick("掉过头来", "转身折回")}
        turns = flight.turns
        if not turns:
            return self.pick("是一路直走的", "没有拐过弯", "路线是一条直线", "并无转弯")
        if len(turns) == 1:
            return self.pick(f"半道上{name[turns[0]]}", f"只{name[turns[0]]}这么一回")
        return self.pick("先是" + "，随后".join(name[turn] for turn in turns), "第一步" + "，下一步".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("一会儿也没停", "未作停留", "脚底下没停过", "连续行走，不曾停步")
        if n == 1:
            return self.pick(f"停过一回，停了{s}秒", f"作了一次停留，时长{s}秒", f"歇脚一次，{s}秒")
        return self.pick(f"停过{n}回，一共停了{s}秒", f"作了{n}次停留，合计时长{s}秒", f"歇脚{n}次，拢共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"路长{w}米，用了{t}秒，速度是每秒{v}米。",
                f"全长{w}米的路，以{v}米每秒的速度走了{t}秒。",
                f"人走了{w}米，花了{t}秒，每秒走{v}米。",
            )
            walk = f"画面里是{who}。{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"画面里是{who}。{self.pick('站着没走', '一直停在那儿没动', '处于站立状态，没有移动')}，时间{t}秒。"
        height = self.pick(f"飞机在人的上方{flight.altitude}米。", f"无人机应比目标高出{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "那边还有一位" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，往{name}边走。", f"，起初朝{name}。", f"，面向{name}方出发。")
