//! Topics of texts, by their words alone: relations of the target to its surroundings, and intents, what a pilot shall do.
//!
//! No facts are needed, so that anyone's texts can be counted. A kind without texts shows what a model cannot learn from them.

use crate::diversity::words;
use cosfly_claims::{Language, Script};
use std::collections::BTreeMap;

/// A kind of relation or intent, with phrases that speak of it. An English phrase stands between the ends of words; one that ends
/// in `~` may go on.
struct Kind {
    name: &'static str,
    english: &'static [&'static str],
    chinese: &'static [&'static str],
}

const RELATIONS: [Kind; 12] = [
    Kind {
        name: "passes a landmark",
        english: &["past", "passes", "passing", "passed", "walk by", "walks by", "go by", "goes by"],
        chinese: &["经过", "路过", "走过", "旁过", "掠过"],
    },
    Kind {
        name: "nears a landmark",
        english: &["approach~", "towards a", "towards the", "up to a", "up to the"],
        chinese: &["走近", "走向", "靠近"],
    },
    Kind {
        name: "beside a landmark",
        english: &["beside", "next to", "alongside", "near a", "near the", "close to a", "close to the"],
        chinese: &["旁边", "附近", "边上", "近旁", "紧挨"],
    },
    Kind { name: "in front of", english: &["in front of", "ahead of"], chinese: &["前面", "前方", "跟前"] },
    Kind {
        name: "on a side",
        english: &["on the left", "on the right", "on their left", "on their right", "to the left", "to the right"],
        chinese: &["左边", "右边", "左侧", "右侧", "左手", "右手"],
    },
    Kind {
        name: "by number",
        english: &["the first", "the second", "the third", "the fourth", "the fifth", "the sixth"],
        chinese: &["第一", "第二", "第三", "第四", "第五", "第六"],
    },
    Kind {
        name: "before or after",
        english: &["after the", "after a", "before the", "before a", "until the"],
        chinese: &["之后", "以后", "之前", "过了", "过后"],
    },
    Kind {
        name: "hidden",
        english: &[
            "hidden",
            "hides",
            "hid",
            "out of sight",
            "out of view",
            "lost behind",
            "disappear~",
            "vanish~",
            "blocks",
        ],
        chinese: &["挡", "遮", "看不见", "看不到", "消失", "不见", "画面外", "视野外"],
    },
    Kind {
        name: "seen again",
        english: &[
            "seen again",
            "back in sight",
            "back in view",
            "reappear~",
            "comes back",
            "come back",
            "found again",
        ],
        chinese: &["重新出现", "再次出现", "又出现", "回到画面", "露出", "再出现", "找回", "重新"],
    },
    Kind {
        name: "with other people",
        english: &[
            "people",
            "others",
            "another person",
            "other person",
            "someone",
            "side by side",
            "other one",
            "nobody else",
        ],
        chinese: &["旁人", "别人", "另一", "其他人", "迎面", "并排", "一起走", "人群", "几个人", "个人里", "那一位"],
    },
    Kind {
        name: "with vehicles",
        english: &["car", "cars", "vehicle", "vehicles", "van", "truck", "lorry", "bus", "bicycle", "motorcycle"],
        chinese: &["汽车", "轿车", "车辆", "卡车", "货车", "公交", "自行车", "摩托", "辆车"],
    },
    Kind {
        name: "in the picture",
        english: &[
            "of the picture",
            "in the picture",
            "of the frame",
            "in the frame",
            "leftmost",
            "rightmost",
            "nearest",
            "closest",
        ],
        chinese: &["画面", "最左", "最右", "最近", "镜头左", "镜头右"],
    },
];

const INTENTS: [Kind; 10] = [
    Kind {
        name: "follow",
        english: &[
            "follow~",
            "track~",
            "tail~",
            "pursue~",
            "trail~",
            "shadow~",
            "stay with",
            "stay on",
            "keep up with",
            "keep with",
        ],
        chinese: &["跟随", "跟踪", "跟住", "跟着", "跟拍", "追随", "追踪", "尾随", "跟上", "盯"],
    },
    Kind {
        name: "keep a distance",
        english: &["away", "distance", "behind", "gap", "apart", "keep back", "stay back", "metres back", "m back"],
        chinese: &["距离", "间距", "相距", "相隔", "间隔", "保持", "开外", "之外"],
    },
    Kind {
        name: "aim the camera",
        english: &[
            "camera",
            "lens",
            "gimbal",
            "look down",
            "look up",
            "looks down",
            "looks up",
            "looking down",
            "looking up",
            "degrees",
            "tilt~",
            "pitch~",
        ],
        chinese: &["镜头", "相机", "云台", "俯", "仰", "度角"],
    },
    Kind {
        name: "keep a height",
        english: &[
            "height",
            "altitude",
            "above them",
            "above the target",
            "above the person",
            "m above",
            "metres above",
            "higher",
        ],
        chinese: &["高度", "上方", "高出", "上空", "头顶", "高于"],
    },
    Kind {
        name: "turn",
        english: &["turn~", "bend~", "corner", "left", "right", "veer~"],
        chinese: &["转", "拐", "掉头", "折返", "弯"],
    },
    Kind {
        name: "go straight",
        english: &["straight", "same direction", "no turn", "no turns", "without turning", "one direction"],
        chinese: &["直行", "直走", "直线", "笔直", "一直往前", "不转弯", "没有转弯", "没转弯"],
    },
    Kind {
        name: "wait",
        english: &["stop~", "pause~", "halt~", "wait~", "stand~", "still"],
        chinese: &["停", "等", "驻足", "站", "不动", "歇"],
    },
    Kind {
        name: "tell apart",
        english: &["not that", "not the", "other one", "wrong one", "wrong person", "not them", "i mean", "no the"],
        chinese: &["不是", "另一个", "错了", "不对", "是那"],
    },
    Kind {
        name: "find again",
        english: &["find~", "search~", "pick up", "pick them up", "wait until", "lose sight", "lost", "again"],
        chinese: &["找", "搜", "重新", "再次", "跟丢了", "又出现"],
    },
    Kind {
        name: "film",
        english: &["film~", "record~", "shoot~", "shot", "footage", "video", "picture"],
        chinese: &["拍", "录", "画面", "视频"],
    },
];

/// Texts that speak of each kind of relation and of intent.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Texts by relation; a relation that no text has counts 0.
    pub relations: BTreeMap<&'static str, usize>,
    /// Texts by intent.
    pub intents: BTreeMap<&'static str, usize>,
}

impl Coverage {
    /// Relations and intents that some text has, and all that are counted.
    pub fn found(&self) -> [[usize; 2]; 2] {
        [&self.relations, &self.intents].map(|it| [it.values().filter(|count| **count > 0).count(), it.len()])
    }
}

/// Counts what texts of one language speak of.
pub fn coverage<'t>(texts: impl IntoIterator<Item = &'t str>, language: Language) -> Coverage {
    let none = |kinds: &[Kind]| kinds.iter().map(|kind| (kind.name, 0)).collect();
    let mut found = Coverage { relations: none(&RELATIONS), intents: none(&INTENTS) };
    for text in texts {
        let plain = match language.script() {
            Script::Latin => format!(" {} ", words(text, language).join(" ")),
            Script::Han => text.to_owned(),
        };
        for (kinds, counts) in [(&RELATIONS[..], &mut found.relations), (&INTENTS[..], &mut found.intents)] {
            for kind in kinds.iter().filter(|kind| speaks_of(&plain, kind, language)) {
                *counts.entry(kind.name).or_default() += 1;
            }
        }
    }
    found
}

fn speaks_of(plain: &str, kind: &Kind, language: Language) -> bool {
    match language.script() {
        Script::Latin => kind.english.iter().any(|phrase| has_phrase(plain, phrase)),
        Script::Han => kind.chinese.iter().any(|phrase| plain.contains(phrase)),
    }
}

/// Whether words joined by spaces have a phrase; the phrase ends with a word, or with a beginning of one.
fn has_phrase(plain: &str, phrase: &str) -> bool {
    let (phrase, is_stem) = phrase.strip_suffix('~').map_or((phrase, false), |stem| (stem, true));
    plain.match_indices(phrase).any(|(at, _)| {
        let after = &plain[at + phrase.len()..];
        plain[..at].ends_with(' ') && (is_stem || after.starts_with(' '))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str, language: Language) -> [Vec<&'static str>; 2] {
        let found = coverage([text], language);
        [found.relations, found.intents]
            .map(|it| it.into_iter().filter(|(_, count)| *count > 0).map(|it| it.0).collect())
    }

    #[test]
    fn texts_are_counted_by_what_they_speak_of() {
        let english = "Follow them past the second tree on the left; if a car hides them, wait until they come back.";
        let [relations, intents] = names(english, Language::En);
        let expected = ["by number", "hidden", "on a side", "passes a landmark", "seen again", "with vehicles"];
        assert_eq!(relations, expected);
        assert_eq!(intents, ["find again", "follow", "turn", "wait"]);
        let [relations, intents] = names("跟住此人，经过左边第二棵树，被汽车挡住后重新出现。", Language::Zh);
        let expected = ["by number", "hidden", "on a side", "passes a landmark", "seen again", "with vehicles"];
        assert_eq!(relations, expected);
        assert_eq!(intents, ["find again", "follow"]);
        let [relations, intents] = names("别跟丢穿红色上衣的行人。", Language::Zh);
        assert!(relations.is_empty() && intents.is_empty(), "an order that speaks of no loss");
    }

    #[test]
    fn a_kind_without_texts_counts_none_and_a_word_within_a_word_is_none() {
        let found = coverage(["They scarcely move."], Language::En);
        assert_eq!(found.relations["with vehicles"], 0);
        assert_eq!(found.found(), [[0, 12], [0, 10]]);
    }
}
