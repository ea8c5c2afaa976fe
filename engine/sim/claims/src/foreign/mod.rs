//! Things that a text about a whole flight cannot know: the facts of a flight have no landmarks, vehicles, weather, other people.
//!
//! A word is refused where it is known to name such a thing, and where it stands in the place of a thing and is none of the
//! words in which people speak of a walk, a person's clothes and a camera.

mod chinese;
mod chinese_words;
mod english;
mod english_words;

use crate::language::Language;
use crate::without_marks;

/// Words of a text that name things no facts of a flight have, in order.
pub fn foreign_things(text: &str, language: Language) -> Vec<String> {
    let text = without_marks(text);
    match language {
        Language::En => english::foreign_things(&text),
        Language::Zh => chinese::foreign_things(&text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_all(language: Language, texts: &[&str], is_foreign: bool) {
        for text in texts {
            let found = foreign_things(text, language);
            assert_eq!(!found.is_empty(), is_foreign, "{text}: {found:?}");
        }
    }

    #[test]
    fn things_that_no_list_names_are_found_by_their_place() {
        let english = [
            "Follow the walker past a glockenspiel.",
            "Stay back near the zebu.",
            "They walk with groceries.",
            "A sommelier is there too.",
            "They go at midnight.",
        ];
        check_all(Language::En, &english, true);
        let chinese = ["跟着行人路过报刊亭。", "拎着菜的行人。", "靠近码头。", "旁边有个木偶。", "和爱人一起。"];
        check_all(Language::Zh, &chinese, true);
    }

    #[test]
    fn words_about_a_walk_and_a_camera_are_no_things() {
        let english = [
            "The leisurely walk has a couple of brief pauses, with a gap of 28 m in between.",
            "Keep the gimbal at a steady angle while the person in a red top moves along the same line.",
            "At first they stand still; at no point do they turn, and in the end the pace is 1.4 m/s.",
        ];
        check_all(Language::En, &english, false);
        let chinese = [
            "云台下压45度，马上跟上身穿风衣的目标。",
            "经过两次左转，走过130米，加在一起停了3秒。",
            "目标旁边别靠太近，沿着直线往前走，途中没有停留。",
        ];
        check_all(Language::Zh, &chinese, false);
    }
}
