"""The twelfth grammar for check_text_judge.py: notes in haste with loose case and punctuation, engineers' logs and plain talk in English, a dispatcher's and a netizen's Chinese. Written before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an
from paraphrases_tenth import minutes, upper


class TwelfthEnglish(Grammar):
    code = "en"
    things = ["dodging scooters", "with a dachshund in tow", "along the tram tracks", "past some roadworks", "under flickering neon", "next to a food truck", "while it is pouring", "sharing an umbrella", "behind the gasworks", "between the market stalls", "in front of a vending machine", "beside a flooded underpass", "with two mates", "eating a kebab", "through the turnstiles"]
    persons = ["busker", "traffic warden", "toddler", "delivery rider", "nurse"]

    def who(self, flight):
        noun = self.pick("pedestrian", "person", "target", "walker")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", backpack: yes", ", has a backpack", ", rucksack visible") if backpack else self.pick("", "", ", backpack: no", ", doesn't have a backpack", ", zero bags")
        return self.pick(
            f"{noun} - top: {top}, bottoms: {trousers}{bag} -",
            f"a {noun} in {top} (shirt) and {trousers} (trousers){bag}",
            f"the {noun} w/ {top} jacket + {trousers} pants{bag}",
            f"{noun} wearing {trousers} trousers, {top} shirt{bag}",
            f"the {noun} - shirt's {top}, jeans are {trousers}{bag} -",
            f"the {noun} {self.pick('dressed', 'kitted out')} in {an(top)} hoodie & {trousers} joggers{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"dist {d}m", f"{d}m standoff", f"stay {d} meters back", f"keep ~{d} m of distance", f"follow at {d}m", f"{d}-metre gap pls", f"hold off by {d} metres", f"no closer than {d} m, no farther than {d} m")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"cam {p} deg down", f"gimbal pitch minus {p} degrees", f"tilt down {p}°", f"{p} degree look-down angle", f"camera facing down at {p} degrees", f"lens {p}° low of the horizon")
        return self.pick(f"cam {p} deg up", f"gimbal pitch plus {p} degrees", f"tilt up {p}°", f"{p} degree look-up angle", f"camera facing up at {p} degrees")

    def loose(self, text):
        """The text as it is typed in haste: all lower case, all upper case, doubled or missing punctuation, or as it was."""
        kind = self.rng.randrange(6)
        if kind == 0:
            return text.lower()
        if kind == 1:
            return text.upper().replace("M/S", "m/s")
        if kind == 2:
            return text.replace(". ", "... ").replace(", ", " , ")
        if kind == 3:
            return text.replace("!", "!!").replace("; ", ", ")
        return text

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" nb: standing, not walking.", " Target stationary throughout.", " They stay in one place.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.loose(self.pick(
            f"Job: tail {who}, {distance}, {view}.{still}",
            f"{upper(distance)}; {view}; target is {who}.{still}",
            f"New mission! Track {who}; {distance}; {view}.{still}",
            f"ok so, follow {who}. {distance} and {view}, thx!{still}",
        ))

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("turns: 0", "zero turns", "course constant", "doesn't turn", "goes dead ahead the entire time")
        around = lambda: self.pick("180-degree turn", "U-turn", "comes about and heads back")
        words = [around() if turn == "around" else self.pick(f"{turn} turn", f"hangs a {turn}", f"cuts {turn}") for turn in turns]
        if len(turns) == 1:
            return self.pick(f"1 turn ({words[0]})", f"single turn: {words[0]}", f"{words[0]} midway")
        return self.pick(f"{len(turns)} turns ({', '.join(words)})", "turns in order: " + ", ".join(words), " and then ".join(words))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("stops: none", "0 stops", "walks non-stop", "doesn't pause", "keeps on walking, no breaks")
        if n == 1:
            return self.pick(f"1 stop ({s} s)", f"one stop of {s} sec", f"pauses once, {s} seconds", f"stands around for {s} seconds one time")
        return self.pick(f"{n} stops ({s} s total)", f"{n} stops with {s} sec overall", f"pauses {n} times, {s} seconds in sum", f"stops: {n}, standing time: {s} s")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"walked {w} m / took {t} s / avg {v} m/s.",
                f"Total {w}m walked, total time {t}s, mean speed {v} m/s.",
                f"path length: {w} metres. duration: {minutes(t)}. walking pace: {v} m/s.",
                f"does {w} metres in {t} secs ({v} meters per second).",
            )
            walk = f"Log entry: {who}; {self.turns(flight)}; {self.stops(flight)}; {length}"
        else:
            walk = f"Log entry: {who}; {self.pick('not moving', 'standing still', 'no movement')}, {t} s long."
        height = self.pick(f"alt {flight.altitude} m above target. ", f"Drone altitude: {flight.altitude} metres over the person. ", f"{flight.altitude}m high. ") if flight.altitude >= 1 else ""
        drone = f"{upper(self.range(flight))}, {self.view(flight)}. {height}"
        return self.loose(self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}"))

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". One {self.rng.choice(self.persons)} nearby."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", heading: {direction}.", f", goes {direction}.", f", walks off {direction}.")


class TwelfthChinese(Grammar):
    code = "zh"
    things = ["躲着满街的电动滑板车", "后头拖着条腊肠犬", "沿电车轨道走", "碰上修路", "头顶霓虹闪烁", "紧挨快餐车", "外面下着倾盆大雨", "跟人合打一把伞", "在煤气厂后身", "挤在菜摊之间", "在自动售货机前", "地下通道积了水", "同两个哥们儿一道", "啃着肉夹馍", "过闸机"]
    persons = ["卖唱的", "协管员", "小娃娃", "骑手", "护士"]

    def who(self, flight):
        noun = self.pick("目标", "行人", "跟踪对象", "该人员", "被跟者")
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("，有背包", "，带双肩包") if backpack else self.pick("", "", "，无背包", "，没有带包")
        return self.pick(
            f"{noun}（{top}色上装，{trousers}色下装{bag}）",
            f"{noun}，特征：上衣为{top}色，长裤为{trousers}色{bag}",
            f"{noun}：{top}色短袖+{trousers}色裤子{bag}",
            f"着{top}色夹克和{trousers}色休闲裤的{noun}{bag}",
            f"身上是{top}色外套、腿上是{trousers}色裤子的{noun}{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"间距{d}米", f"距离：{d}米", f"跟踪时相距{d}米", f"别近了也别远了，就{d}米", f"留出{d}米", f"两者间隔{d}米，不变", f"在{d}米处伴随")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"俯角：{p}度", f"云台俯仰负{p}度", f"相机下视{p}度", f"镜头角度向下{p}度", f"朝下{p}度")
        return self.pick(f"仰角：{p}度", f"云台俯仰正{p}度", f"相机上视{p}度", f"镜头角度向上{p}度", f"朝上{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("目标状态：静止。", "注意目标不走动。", "对方站着，未移动。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"任务：{who}。{distance}，{view}。{still}",
            f"呼叫飞手，请跟踪{who}！{distance}，{view}，完毕。{still}",
            f"{view}，{distance}，跟紧{who}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左转", "向左转弯"), "right": self.pick("右转", "向右转弯"), "around": self.pick("掉头", "一百八十度转弯")}
        turns = flight.turns
        if not turns:
            return self.pick("转弯：无", "零转弯", "航向不变", "未发生转向")
        if len(turns) == 1:
            return self.pick(f"转弯一次：{name[turns[0]]}", f"有一个{name[turns[0]]}的动作")
        return self.pick(f"转弯{len(turns)}次（" + "，".join(name[turn] for turn in turns) + "）", "顺序为" + "、".join(name[turn] for turn in turns), "，之后".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("停留：无", "零停留", "未停", "中途无停顿", "一直在走没停")
        if n == 1:
            return self.pick(f"停留一次（{s}秒）", f"有一次停顿，{s}秒钟", f"停下一次，用时{s}秒")
        return self.pick(f"停留{n}次（共{s}秒）", f"有{n}次停顿，合计{s}秒钟", f"停下{n}次，停留总时长{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"总路程{w}米/总时间{t}秒/均速{v}米每秒。",
                f"步行{w}米，{t}秒，均速每秒{v}米。",
                f"用了{t}秒走{w}米，速度{v}米/秒。",
                f"走完{w}米用时{t}秒，配速{v}米/秒。",
            )
            walk = f"记录：{who}；{self.turns(flight)}；{self.stops(flight)}；{length}"
        else:
            walk = f"记录：{who}；{self.pick('全程静止', '停在原地未动', '无位移')}，{t}秒。"
        height = self.pick(f"高度：目标上方{flight.altitude}米。", f"飞行高度比目标高{flight.altitude}米。", f"相对目标高度{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "附近有" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，方向：{name}。", f"，向{name}前进。", f"，往{name}去。")
