"""The tenth grammar for check_text_judge.py: a chat assistant's English with questions and passives, the spoken Chinese of a short video. Written before its first run."""

from paraphrases import ZH_COLOURS, ZH_DIRECTIONS, Grammar, an


def minutes(seconds):
    """A time as people say it: `1 minute 20 seconds`."""
    whole, rest = divmod(seconds, 60)
    return f"{whole} minute{'s' * (whole > 1)}" + (f" {rest} seconds" if rest else "") if whole else f"{rest} seconds"


def upper(text):
    return text[0].upper() + text[1:]


class TenthEnglish(Grammar):
    code = "en"
    things = ["just past the chip shop", "with a spaniel on a lead", "while hail falls", "beneath the plane trees", "right next to a skip", "holding hands with a toddler", "over the footbridge", "in front of a parked ambulance", "by the duck pond", "with a paper bag of chips", "between two parked lorries", "along the seafront promenade railings", "outside the town hall", "chatting with a neighbour", "at sunrise"]
    persons = ["plumber", "schoolgirl", "jogger", "nun", "postman"]

    def who(self, flight):
        noun = self.pick("person", "individual", "pedestrian", "walker", "one", "target")
        if not flight.wear:
            return "the person" if noun == "one" else f"the {noun}"
        top, trousers, backpack = flight.wear
        bag = self.pick(", with a backpack on", " and wearing a rucksack", " plus a backpack") if backpack else self.pick("", "", " (no backpack)", ", no bag on the back")
        return self.pick(
            f"the {noun} who's got {an(top)} top and {trousers} trousers on{bag}",
            f"the {noun} wearing the {top} sweatshirt and {trousers} jeans{bag}",
            f"the {noun} that is dressed in {top} up top and {trousers} from the waist down{bag}",
            f"the {noun} with {trousers} legs and {an(top)} upper body{bag}",
            f"the {top}-and-{trousers}-clad {noun} ({top} jacket, {trousers} pants){bag}",
            f"the {noun} whose jacket is {top}, whose jeans are {trousers}{bag}",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"please make sure you stay around {d} m away from them", f"could you keep the drone about {d} metres from them", f"I'd suggest a follow distance of {d} m", f"a spacing of {d} metres should be maintained", f"aim for {d} metres between you and them", f"ideally hang back by {d} metres or so", f"they should be {d} m away from you at all times", f"don't let the gap become anything other than {d} metres")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"the camera should be tilted {p} degrees downward", f"could you angle the camera {p} degrees down", f"the gimbal is to be pitched down by {p}°", f"look down on the scene at {p} degrees", f"set the gimbal to {p} degrees below level", f"go for a {p}-degree downward view")
        return self.pick(f"the camera should be tilted {p} degrees upward", f"could you angle the camera {p} degrees up", f"the gimbal is to be pitched up by {p}°", f"look up at {p} degrees")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick(" Heads-up: they don't move at all.", " They'll be standing still the whole time.", " By the way, they never leave the spot.")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"Sure! Please film {who}: {distance}, and {view}.{still}",
            f"Your task, should you accept it: follow {who}. {upper(distance)}; {view}.{still}",
            f"Hi there, would you mind tracking {who}? Thanks! Also, {distance}, and {view}.{still}",
            f"{upper(view)}, {distance}, and whatever happens, stay on {who}.{still}",
        )

    def turns(self, flight):
        turns = flight.turns
        if not turns:
            return self.pick("There aren't any turns", "They keep going in the same direction", "No change of direction happens", "It's straight ahead all the way", "Not a single turn is made")
        word = lambda turn: {"around": self.pick("turn around", "turn back the way they came", "do a U-turn")}.get(turn) or self.pick(f"turn {turn}", f"make a {turn} turn", f"go {turn}", f"take a {turn}")
        done = [word(turn) for turn in turns]
        if len(turns) == 1:
            return self.pick(f"At one point they {done[0]}", f"They {done[0]} once", f"Somewhere along the way they {done[0]}, and that's the only turn")
        return self.pick("They " + ", then ".join(done), "First they " + ", after that they ".join(done), f"They make {len(turns)} turns: they " + ", they ".join(done))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("they don't stop anywhere", "no stops are made", "they walk without any interruption", "there isn't a single stop", "they never come to a standstill")
        if n == 1:
            return self.pick(f"there's one stop, which lasts {s} seconds", f"they stop once, and that stop takes {s} seconds", f"one {s}-second break is taken", f"they wait once (about {s} s)")
        return self.pick(f"there are {n} stops, which last {s} seconds when added up", f"they stop {n} times for a combined {s} seconds", f"{n} breaks are taken, {s} seconds in all", f"they wait {n} times (about {s} s in total)")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"A distance of {w} metres is covered in {minutes(t)}, so the average speed is {v} m/s.",
                f"How far? {w} m. How long? {t} seconds. How fast? {v} m/s.",
                f"In {t} seconds, {w} metres get walked, which works out at {v} metres per second.",
                f"The walk is {w} metres long, lasts {minutes(t)}, and goes at {v} m/s.",
                f"All told the video runs {t} seconds; the person walks {w} m at about {v} m/s.",
            )
            walk = f"Here's what happens with {who}. {self.turns(flight)}, and {self.stops(flight)}. {length}"
        else:
            walk = f"Here's what happens with {who}: nothing, because they {self.pick('stand still', 'stay exactly where they are', 'do not take a single step')} for {self.pick(minutes(t), f'the full {t} seconds')}."
        height = self.pick(f"The drone is {flight.altitude} m above them. ", f"Flying height over the target is {flight.altitude} metres. ", f"Keep {flight.altitude} metres of height above their feet. ") if flight.altitude >= 1 else ""
        drone = f"As for the drone: {self.range(flight)}, and {self.view(flight)}. {height}"
        return self.pick(f"{walk} {drone}".rstrip(), f"{drone}{walk}")

    def foreign(self, text):
        return text.rstrip(".") + ", " + self.rng.choice(self.things) + "." if self.rng.random() < 0.7 else text.rstrip(".") + f". There's a {self.rng.choice(self.persons)} walking along as well."

    def heading(self, text, direction):
        return text.rstrip(".") + self.pick(f", initially going {direction}.", f", walking {direction}wards at first.", f", setting off to the {direction}.")


class TenthChinese(Grammar):
    code = "zh"
    things = ["路过一家螺蛳粉店", "怀里抱着只橘猫", "天上飘着小雪", "从梧桐树底下走过", "旁边停着辆救护车", "牵着娃", "上了过街天桥", "边走边跟人唠嗑", "手里提溜着早点", "两边停满了车", "在湖边溜达", "对面来了个遛狗的", "打着伞", "一辆电瓶车从身边窜过去", "早高峰人挤人"]
    persons = ["外卖小哥", "老奶奶", "初中生", "保安大叔", "修水管的师傅"]

    def who(self, flight):
        noun = self.pick("人", "路人", "主角", "行人", "目标")
        if not flight.wear:
            return {"人": "这个行人", "主角": "咱们的主角"}.get(noun, noun)
        top, trousers, backpack = flight.wear
        top, trousers = (ZH_COLOURS[it] + ("" if ZH_COLOURS[it] in "黑白红蓝绿黄灰" and self.rng.random() < 0.7 else "色") for it in (top, trousers))
        bag = self.pick("、背上有个双肩包", "、还背了书包") if backpack else self.pick("", "", "、没背包")
        return self.pick(
            f"穿{top}上衣、{trousers}裤子{bag}的那个{noun}",
            f"上面穿{top}的、下面穿{trousers}的那个{noun}" + bag.replace("、", "，"),
            f"{top}衣服{trousers}裤子{bag}的{noun}",
            f"一身{top}上衣加{trousers}长裤{bag}的{noun}",
            f"{noun}（{top}外套，{trousers}裤子{bag}）",
        )

    def range(self, flight):
        d = flight.distance
        return self.pick(f"离人家大概{d}米", f"咱就保持{d}米这个距离", f"别跟太紧，{d}米刚刚好", f"中间隔个{d}米", f"距离嘛，{d}米", f"拉开{d}米跟着拍", f"麻烦和对方差不多隔{d}米")

    def view(self, flight):
        p = abs(flight.pitch)
        if flight.pitch >= 0:
            return self.pick(f"镜头往下压个{p}度", f"云台朝下打{p}度", f"俯拍，{p}度", f"镜头低下去{p}度", f"从上往下看，角度{p}度")
        return self.pick(f"镜头往上抬个{p}度", f"云台朝上打{p}度", f"仰拍，{p}度", f"从下往上看，角度{p}度")

    def instruction(self, flight):
        still = "" if flight.walks else self.pick("对了，人家压根没动过。", "放心，目标就站那儿不动。", "这人全程都站着呢。")
        who, distance, view = self.who(flight), self.range(flight), self.view(flight)
        return self.pick(
            f"家人们，今天拍的是{who}，{distance}，{view}。{still}",
            f"能不能帮忙跟一下{who}？{distance}，{view}，谢谢！{still}",
            f"{view}；{distance}；镜头别离开{who}。{still}",
        )

    def turns(self, flight):
        name = {"left": self.pick("往左拐", "左转", "向左转"), "right": self.pick("往右拐", "右转", "向右转"), "around": self.pick("掉头", "转身往回走")}
        turns = flight.turns
        if not turns:
            return self.pick("一个弯都没拐", "直直地往前走", "方向一点没变", "全程走直线")
        if len(turns) == 1:
            return self.pick(f"中间{name[turns[0]]}了一次", f"走着走着{name[turns[0]]}")
        return self.pick("先" + "，接着".join(name[turn] for turn in turns), f"一共拐了{len(turns)}个弯：" + "、".join(name[turn] for turn in turns))

    def stops(self, flight):
        s, n = flight.standing, flight.stops
        if n == 0:
            return self.pick("一次都没停过", "中间不带停的", "走得一点没耽误，没停过", "没有停下来过")
        if n == 1:
            return self.pick(f"就停了一次，{s}秒", f"中间歇了一下，{s}秒钟", f"停下来等了{s}秒，就这一回")
        return self.pick(f"停了{n}次，加一起{s}秒", f"中间歇了{n}回，总共{s}秒钟", f"前前后后停下来{n}次，{s}秒")

    def description(self, flight):
        t, w, v = flight.duration, flight.way, flight.speed
        who = self.who(flight)
        if flight.walks:
            length = self.pick(
                f"视频{t}秒，走了{w}米，一秒{v}米的样子。",
                f"多远？{w}米。多久？{t}秒。多快？每秒{v}米。",
                f"{w}米的路走了{t}秒，速度是{v}米/秒。",
                f"算下来{t}秒走出去{w}米，平均每秒钟{v}米。",
            )
            walk = f"说说{who}：{self.turns(flight)}，{self.stops(flight)}。{length}"
        else:
            walk = f"说说{who}：{self.pick('一步都没动', '就在原地站着', '压根没挪地方')}，整整{t}秒。"
        height = self.pick(f"飞机比人高{flight.altitude}米。", f"飞在人头顶上{flight.altitude}米。") if flight.altitude >= 1 else ""
        drone = f"咱们这边：{self.range(flight)}，{self.view(flight)}。{height}"
        return self.pick(drone + walk, walk + drone)

    def foreign(self, text):
        return text.rstrip("。") + "，" + (self.rng.choice(self.things) if self.rng.random() < 0.7 else "旁边还有个" + self.rng.choice(self.persons)) + "。"

    def heading(self, text, direction):
        name = ZH_DIRECTIONS[direction]
        return text.rstrip("。") + self.pick(f"，一开始是往{name}走的。", f"，先朝{name}边去。", f"，冲着{name}面走。")
