"""The ninth grammar for check_text_judge.py: a detective's English, a newspaper's Chinese. Written in full before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


class NinthEnglish(Grammar):
    code = "en"
    things = ["outside a pawn shop", "with an accomplice", "past a row of dustbins", "as sleet comes down", "under the railway arches", "smoking a cigar", "beside a rusty bicycle", "in front of the courthouse", "carrying a holdall", "near a telephone box", "arguing with a cabbie", "across the cobbled market square", "behind a delivery truck", "at the edge of a reservoir", "with an alsatian"]
    persons = ["priest", "burglar", "widow", "bellboy", "taxi driver"]

    def who(self, flight):
        noun = self.pick("subject", "suspect", "target", "person of interest", "pedestrian")
        if not flight.wear:
            return f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", backpack worn", ", toting a rucksack", ", backpack on both shoulders") if backpack else self.pick("", "", ", carrying no bag")
        return self.pick(
            f"the {noun}: {top} overcoat, {trousers} slacks{bag}",
            f"the {noun}, last seen in {an(top)} polo shirt and {trousers} chinos{bag},",
            f"the {noun} (clothing: {top} jacket, {trousers} trousers{bag})",
            f"the {noun} in the {top} anorak and the {trousers} pants{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"remain {d} metres to the rear", f"tailing distance {d} metres", f"do not let more or less than {d} metres come between you", f"stay put at {d} metres from the mark", f"keep back {d} metres", f"surveillance is to be kept up from {d} m", f"allow a lead of {d} metres")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"camera trained {p} degrees downwards", f"look down on them, {p} degrees", f"optics {p}° under the horizontal", f"set a {p}-degree down angle", f"have the camera point {p} degrees at the ground")
        return self.pick(f"camera trained {p} degrees upwards", f"optics {p}° over the horizontal", f"set a {p}-degree up angle")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" No movement was noted.", " The subject is standing and has not moved.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Orders: {distance}; {view}. Your mark is {who}.{still}",
            f"Put a tail on {who}. {distance.capitalize()}, {view}.{still}",
            f"Do not let {who} out of your sight; {distance}; {view}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("No turnings were taken.", "Proceeded in a straight line.", "Direction of travel remained constant.", "At no corner did the subject turn off.")
        verb = {"left": "left", "right": "right"}
        word = lambda turn: {"around": self.pick("doubled back", "turned around")}.get(turn) or self.pick(f"turned {turn}", f"took a {turn}-hand turning", f"went {turn}")
        del verb
        if len(turns) == 1:
            return self.pick(f"En route the subject {word(turns[0])}.", f"Subject {word(turns[0])} once and only once.")
        return self.pick(
            "Subject " + ", subsequently ".join(word(turn) for turn in turns) + ".",
            "Log: " + "; ".join(word(turn) for turn in turns) + ".",
        )

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("No stops were observed.", "At no stage was the walk broken off.", "Subject kept up the walk without so much as a pause.", "There were no halts to report.")
        if n == 1:
            return self.pick(f"One stop was observed, of {s} seconds' duration.", f"Subject loitered once, for {s} seconds.", f"A single wait of {s} seconds is on record.")
        return self.pick(f"{n} stops were observed, {s} seconds in the aggregate.", f"Subject loitered {n} times, amounting to {s} seconds.", f"Waits: {n}, making {s} seconds.")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"Covered {w} metres in {t} seconds, walking speed {v} m/s.",
                f"Observation ran to {t} seconds; the subject got {w} metres further at {v} metres per second.",
                f"Speed on foot {v} m/s. Distance on foot {w} metres. Time under observation {t} seconds.",
                f"It took the subject {t} seconds to walk the {w} metres, a rate of {v} m/s.",
            )
            walk = f"Report on {who}. {self.turns(flight)} {self.stops(flight)} {length}"
        else:
            walk = f"Report on {who}. For {t} seconds the subject {self.pick('made no move', 'stood on the spot', 'remained stationary')}."
        height = self.pick(f"Observer's height above subject {flight.altitude} metres. ", f"Drone stationed {flight.altitude} metres above. ") if flight.altitude >= 1 else ""
        distance = self.range(flight)
        drone = f"{distance[0].upper() + distance[1:]}; {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". A {self.rng.choice(self.persons)} was also present."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", proceeding {direction}.", f", last seen heading {direction}.", f", in the direction of the {direction}.")


class NinthChinese(Grammar):
    code = "zh"
    things = ["当时正下着冻雨", "途中与一名出租车司机争执", "在法院门前", "骑着一辆旧自行车", "身边跟着一条狼狗", "沿水库边缘", "手提旅行袋", "叼着雪茄", "在电话亭旁", "穿过石板铺的集市", "经过一家当铺", "身后有货车驶过", "与同伙碰头", "铁路桥拱下", "绕开一排垃圾桶"]
    persons = ["神父", "窃贼", "寡妇", "门童", "出租车司机"]

    def who(self, flight):
        noun = self.pick("该男女不详的行人", "当事行人", "目标", "这名行人", "被拍摄者")
        if noun.startswith("该"):
            noun = "该行人"
        if not flight.wear:
            return noun
        top, trousers, backpack = flight.wear
        top, trousers = ZH_COLOURS[top], ZH_COLOURS[trousers]
        bag = self.pick("、身背双肩包", "、背有背包") if backpack else self.pick("", "", "、未背包")
        return self.pick(
            f"身穿{top}色大衣、{trousers}色西裤{bag}的{noun}",
            f"{noun}（衣着：{top}色夹克，{trousers}色裤子{bag}）",
            f"衣着为{top}色上衣、{trousers}色长裤{bag}的{noun}",
            f"上身着{top}色外套、下身着{trousers}色裤子{bag}的{noun}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"无人机与其保持{d}米距离", f"跟拍距离约{d}米", f"在其{d}米外跟进", f"相隔约{d}米", f"距离控制在{d}米上下", f"在相距{d}米处跟踪")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头以{p}度角俯拍", f"镜头朝下倾斜{p}度", f"拍摄俯角{p}度", f"机载相机向下{p}度")
        return self.pick(f"镜头以{p}度角仰拍", f"镜头朝上倾斜{p}度", f"拍摄仰角{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("截至拍摄结束，该人未曾移动。", "其间目标始终站立。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"据要求，需跟拍{who}，{distance}，{view}。{still}",
            f"本次跟拍对象系{who}，{distance}，{view}。{still}",
            f"{distance}，{view}，持续关注{who}的动向。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("左转", "向左拐弯"), "right": self.pick("右转", "向右拐弯"), "around": self.pick("掉头", "折返")}
        turns = flight.turns
        if not turns:
            return self.pick("沿直线前行", "未见转弯", "其间并未改变方向", "没有任何拐弯")
        if len(turns) == 1:
            return self.pick(f"其间{name[turns[0]]}一次", f"途中曾{name[turns[0]]}")
        return self.pick("先后" + "、".join(name[turn] for turn in turns), "首先" + "，随后".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("其间未见停顿", "全程没有停步", "并未停留", "未作任何停歇")
        if n == 1:
            return self.pick(f"其间停留一次，历时{s}秒", f"一度停步{s}秒", f"曾停下{s}秒")
        return self.pick(f"其间停留{n}次，共计{s}秒", f"曾{n}次停步，累计{s}秒", f"先后停下{n}次，总共{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"全程{w}米，耗时{t}秒，时速折算为每秒{v}米。",
                f"据统计，其在{t}秒内步行{w}米，平均每秒{v}米。",
                f"画面长{t}秒，其间步行{w}米，步速为{v}米/秒。",
            )
            walk = f"画面显示，{who}{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"画面显示，{who}在{t}秒内{self.pick('没有移动', '一直站立', '始终停留在原地')}。"
        height = self.pick(f"无人机高出其{flight.altitude}米。", f"飞行高度为其上方{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "一名" + self.rng.choice(self.persons) + "亦在现场") + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，前往{name}方向。", f"，向{name}行进。", f"，朝{name}离去。")
