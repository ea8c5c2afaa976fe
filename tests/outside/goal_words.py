"""Reads goals of table `goals` by their words: claims without frames, in the words of column `claims`, from English and Chinese."""

import re

from shared import COLOURS, IN_CHINESE

ZH = {zh: en for en, zh in IN_CHINESE.items()}
EN_NUMBERS = {word: at for at, word in enumerate("no one two three four five six seven eight".split())} | {"a": 1, "an": 1}
ORDINALS = {word: at for at, word in enumerate("zeroth first second third fourth fifth sixth".split())}
ZH_NUMBERS = {word: at for at, word in enumerate("零一二三四五六七八九")} | {"两": 2, "十": 10}
EN_THINGS = {"traffic light": "traffic_light", "street lamp": "lamp", "traffic sign": "traffic_sign", "tree": "tree", "parked car": "parked_car", "building": "building"}
ZH_THINGS = {"个红绿灯": "traffic_light", "盏路灯": "lamp", "块交通标志牌": "traffic_sign", "棵树": "tree", "辆停着的汽车": "parked_car", "栋楼": "building"}
EN_HIDERS = {
    "a building": "building", "a wall": "wall", "a fence": "fence", "a tree": "tree", "a bush": "bush", "a bridge": "bridge", "a parked car": "parked_car",
    "another person": "pedestrian", "a cyclist": "bicycle", "a motorcyclist": "motorcycle", "a car": "car", "a van": "van", "a lorry": "truck", "a bus": "bus", "another drone": "drone", "a child": "child", "an old person": "elder", "a wheelchair user": "wheelchair", "a seated person": "sitter",
    "a person with a push-chair": "push_chair", "a person with a dog": "dog_walker", "a runner": "runner", "someone on an e-scooter": "e_scooter",
}
ZH_HIDERS = {
    "一栋楼": "building", "一堵墙": "wall", "一道围栏": "fence", "一棵树": "tree", "一丛灌木": "bush", "一座桥": "bridge", "一辆停着的汽车": "parked_car",
    "另一个人": "pedestrian", "一个骑自行车的人": "bicycle", "一个骑摩托车的人": "motorcycle", "一辆汽车": "car", "一辆面包车": "van", "一个孩子": "child", "一位老人": "elder", "一个坐轮椅的人": "wheelchair", "一个坐着的人": "sitter", "一个推婴儿车的人": "push_chair",
    "一个遛狗的人": "dog_walker", "一个跑步的人": "runner", "一个骑电动滑板车的人": "e_scooter", "一辆卡车": "truck", "一辆公交车": "bus", "另一架无人机": "drone",
}
any_of = lambda words: "(" + "|".join(sorted(map(re.escape, words), key=len, reverse=True)) + ")"


class Reader:
    """Finds claims and takes their words away, so that no word is read twice."""

    def __init__(self, text):
        self.text, self.claims = text, []

    def take(self, pattern, claim):
        while found := re.search(pattern, self.text):
            claims = claim(found)
            self.claims += claims if isinstance(claims, list) else [claims]
            self.text = self.text[: found.start()] + " # " + self.text[found.end() :]


def as_walked(text):
    """A text about somebody who runs in the words of one about somebody who walks."""
    return re.sub("跑(?!步的人)", "走", re.sub(r"\b([Rr]un)(s|ning)?\b", r"walk\2", text))


def read(text, language, is_pilot=False):
    return (english if language == "en" else chinese)(as_walked(text), is_pilot)


def english(text, is_pilot):
    it = Reader(text.lower().replace("’", "'"))
    colour, hider, thing = any_of(COLOURS), any_of(EN_HIDERS), any_of(EN_THINGS)
    seconds = r"about (\d+) seconds?"
    it.take(rf"(?:overtake|catch up with|get ahead of) someone in an? {colour} top(?: and walk past them| who is going the same way)?", lambda m: ("overtakes", m[1]))
    it.take(rf"someone in an? {colour} top", lambda m: ("meets", m[1]))
    it.take(rf"meet {hider} coming the other way|pass {hider} that comes towards them", lambda m: ("meets_vehicle", EN_HIDERS[m[1] or m[2]]))
    it.take(rf"overtaken by {hider}|passed by {hider} from behind", lambda m: ("overtaken_by", EN_HIDERS[m[1] or m[2]]))
    it.take(r"(?:to the other side of the street )?(?:at|by|over|after) a (?:zebra|pedestrian) crossing(?: to the other side)?", lambda m: ("crosses",))
    it.take(rf"an? {colour} top(?: and|, with) {colour} trousers", lambda m: ("wears", m[1], m[2]))
    it.take(rf"{colour} trousers and an? {colour} top", lambda m: ("wears", m[2], m[1]))
    if is_pilot:
        it.take(rf"an? {colour} top", lambda m: ("wears", m[1]))
    if "backpack" in it.text:
        it.claims = [claim + ("backpack",) if claim[0] == "wears" else claim for claim in it.claims]
    gone = r"(?: and (?:do not|not) come back into view| for good|, out of sight to the end)"
    it.take(rf"(?:behind) {hider}{gone}", lambda m: ("lost", EN_HIDERS[m[1]], "?", "gone"))
    it.take(rf"(?:disappear|out of sight|vanish|completely hidden|go)(?: behind| by) {hider}(?: for {seconds}| and (?:reappear|come out again)[a-z ]* (?:after )?{seconds})", lambda m: ("lost", EN_HIDERS[m[1]], m[2] or m[3], "found"))
    it.take(rf"and reappear {seconds}", lambda m: [])
    it.take(r"(?:leave|walk out of|end up outside of) the (?:picture|frame)(?: and (?:do not|not) come back| for good)", lambda m: ("lost", "outside", "?", "gone"))
    it.take(r"end up outside of the picture", lambda m: ("lost", "outside", "?", "gone"))
    it.take(rf"(?:leave the picture|drop out of the frame|out of the picture|walk out of shot)(?: and come back after| for) {seconds}", lambda m: ("lost", "outside", m[1], "found"))
    it.take(rf"(?:partly hidden by|half covered by|only partly visible behind) {hider}", lambda m: ("partly_hidden", EN_HIDERS[m[1]]))
    count = any_of([*EN_NUMBERS, *ORDINALS])
    passes = lambda m: ("passes", EN_THINGS[m[2]], m[3], str(EN_NUMBERS.get(m[1], ORDINALS.get(m[1]))))
    it.take(rf"over the crossing and past the {count} {thing} on the (left|right)", lambda m: (*passes(m), "after_crossing"))
    it.take(rf"\b{count} {thing}s? on (?:the|their) (left|right)(?: after the crossing| once they are over the crossing|, counted from the crossing)", lambda m: (*passes(m), "after_crossing"))
    it.take(rf"\b{count} {thing}s? on (?:the|their) (left|right)", passes)
    it.take(r"walk (?:beside|along with|side by side with|together with) (?:(someone else)|(\w+) others)", lambda m: ("walks_with", "1" if m[1] else str(EN_NUMBERS[m[2]])))
    it.take(r"(\d+) (?:times|turns)", lambda m: ("turns_in_all", m[1]))
    it.take(r"sharp turns?|without turning off|never turn off", lambda m: ("no_turn",))
    it.take(r"stand still the whole time|never move from|stay put|stand where they are", lambda m: ("stands",))
    it.take(rf"(?:stop|pause|stand still|wait on the spot|halt|stand there|stop where they are)(?: for| of) {seconds}", lambda m: ("stops", m[1]))
    it.take(r"(?:turn off|head off|turn|take a|go|swing)(?: to the)? (left|right)", lambda m: ("turns", m[1]))
    it.take(r"turn round|turn back|double back|u-turn|go back the way", lambda m: ("turns", "around"))
    if is_pilot:
        it.take(r"about (\d+) m\b", lambda m: ("distance", m[1]))
    else:
        it.text = re.sub(r"not about \d+ m\b", "#", it.text)
        it.take(r"about (\d+) m\b", lambda m: ("distance", m[1]))
    return it.claims


def chinese(text, is_pilot):
    it = Reader(text)
    colour, hider, thing = any_of(ZH), any_of(ZH_HIDERS), any_of(ZH_THINGS)
    it.take(rf"(?:超过|赶上)前面一个穿{colour}上衣的人(?:并超了过去)?|从一个穿{colour}上衣的人身旁超过去", lambda m: ("overtakes", ZH[m[1] or m[2]]))
    it.take(rf"迎面遇上{hider}|(?:迎面|对面)过来的{hider}", lambda m: ("meets_vehicle", ZH_HIDERS[m[1] or m[2]]))
    it.take(rf"被{hider}从后面超过|后面来的{hider}超", lambda m: ("overtaken_by", ZH_HIDERS[m[1] or m[2]]))
    it.take(rf"穿{colour}上衣的人(?=擦肩|错身|，|。|；|#)|(?<=遇上一个)穿{colour}上衣的人", lambda m: ("meets", ZH[m[1] or m[2]]) if "迎面" in text or "对面" in text else [("wears", ZH[m[1] or m[2]])])
    it.take(rf"{colour}上衣(?:和|、下身|、下穿|配|、){colour}裤子|(?<=穿){colour}上衣、{colour}裤子", lambda m: ("wears", ZH[m[1] or m[3]], ZH[m[2] or m[4]]))
    it.take(rf"{colour}裤子、{colour}上衣", lambda m: ("wears", ZH[m[2]], ZH[m[1]]))
    it.take(rf"上衣是{colour}，裤子是{colour}", lambda m: ("wears", ZH[m[1]], ZH[m[2]]))
    if is_pilot:
        it.take(rf"{colour}上衣", lambda m: ("wears", ZH[m[1]]))
    if "背包" in it.text:
        it.claims = [claim + ("backpack",) if claim[0] == "wears" else claim for claim in it.claims]
    it.take(rf"(?:走到|消失在){hider}后面，(?:再也没出现|没有再出来)|被{hider}完全挡住，直到最后也没露面", lambda m: ("lost", ZH_HIDERS[m[1] or m[2]], "?", "gone"))
    it.take(rf"(?:走到|消失在){hider}后面，(?:过了)?约(\d+)秒", lambda m: ("lost", ZH_HIDERS[m[1]], m[2], "found"))
    it.take(rf"(?:被|让){hider}(?:完全挡住|整个挡住|遮住)约(\d+)秒", lambda m: ("lost", ZH_HIDERS[m[1]], m[2], "found"))
    it.take(r"走出画面，没有再回来|离开画面，直到最后也没回来", lambda m: ("lost", "outside", "?", "gone"))
    it.take(r"离开画面约(\d+)秒|走出画面，约(\d+)秒|出画约(\d+)秒", lambda m: ("lost", "outside", m[1] or m[2] or m[3], "found"))
    it.take(rf"被{hider}(?:挡住大半|遮去大半)|从{hider}后面走过", lambda m: ("partly_hidden", ZH_HIDERS[m[1] or m[2]]))
    number = "([零一二三四五六七八九十两])"
    passes = lambda m: ("passes", ZH_THINGS[m[3]], {"左": "left", "右": "right"}[m[1]], str(ZH_NUMBERS[m[2]]))
    it.take(rf"过[了完]?斑马线(?:后面|后，走过|，再过|后经过|后走过|又路过)(左|右)(?:边|手边|侧)的?第?{number}{thing}", lambda m: (*passes(m), "after_crossing"))
    it.take(rf"(左|右)(?:边|手边|侧)的?第?{number}{thing}", passes)
    it.take(r"(?:走|走过一道|过[了完]|沿)斑马线(?:过马路|走到马路对面)?|从人行横道过马路", lambda m: ("crosses",))
    it.take(rf"(?:和|跟|与|同)(?:另一个人|另外{number}个人)(?:走在一起|并肩|结伴|一块儿)", lambda m: ("walks_with", str(ZH_NUMBERS[m[1]]) if m[1] else "1"))
    it.take(rf"(?:拐了|转了|转弯)(?:{number}|(\d+))次", lambda m: ("turns_in_all", str(ZH_NUMBERS[m[1]]) if m[1] else m[2]))
    it.take(r"没有急转弯|没拐急弯", lambda m: ("no_turn",))
    it.take(r"一直站在原地|始终站着没动|没有挪动|一直站着不走", lambda m: ("stands",))
    it.take(r"(?:站了|停了|等了|不动|停下)约(\d+)秒", lambda m: ("stops", m[1]))
    it.take(r"(?:往|向|拐向)?(左|右)(?:边拐|拐|转|边(?!的))", lambda m: ("turns", {"左": "left", "右": "right"}[m[1]]))
    it.take(r"掉头|转身往回|原路折返", lambda m: ("turns", "around"))
    it.take(r"约(\d+)米", lambda m: ("distance", m[1]))
    return it.claims


def skeleton(text, language):
    """A text whose slots are blank: numbers, colours, things, sides."""
    slots = [*EN_HIDERS, *EN_THINGS, *COLOURS, *ORDINALS, "left", "right"] if language == "en" else [*ZH_HIDERS, *ZH_THINGS, *ZH, "左", "右"]
    text = re.sub(r"\d+(?: seconds?)?", "_", text)
    if language == "en":
        text = re.sub(any_of(EN_THINGS) + "s?", "_", text)
        text = re.sub(r"\b" + any_of(slots) + r"\b", "_", text)
        text = re.sub(r"\b(an?|one|two|three|four|five|six) _", "_ _", text)
        return re.sub(r"\b(two|three|four|five|six) others", "_ others", text)
    text = re.sub(any_of(slots), "_", text)
    return re.sub("[一二两三四五六七八九十](?=_|个人|次)", "_", text)
