//! Captions: facts in, texts in two languages out.

use crate::config::{CaptionConfig, Style};
use crate::description::description;
use crate::facts::Facts;
use crate::instruction::instruction;
use crate::messages::{Speaker, approximately, messages_of};
use crate::wording::TEMPLATES;
use cosfly_claims::Language;
use cosfly_random::{RandomStream, Seed};
use serde::{Deserialize, Serialize};

/// One text about one trajectory.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Caption {
    /// Language of the text.
    pub language: Language,
    /// Style of the text.
    pub style: Style,
    /// The text.
    pub text: String,
}

/// Writes the captions of one trajectory: for each language and style, `variants_per_style` different wordings,
/// chosen by the seed.
pub fn captions(facts: &Facts, config: &CaptionConfig, seed: Seed) -> Vec<Caption> {
    let mut captions = vec![];
    for language in Language::ALL.iter().copied() {
        for &style in &config.styles {
            let own = seed.child(language.code(), style as u64);
            let first = captions.len();
            for template in template_order(&mut own.stream("order"), config.variants_per_style as usize) {
                // Draws the words again where another template came to the same text.
                let drawn = (0..MOST_DRAWS).map(|draw| {
                    let words = &mut own.child("words", template as u64).child("draw", draw).stream("choice");
                    let speaker = &mut Speaker { messages: messages_of(language, facts.runs()), words };
                    let text = match style {
                        Style::Instruction => instruction(facts, template, speaker),
                        Style::Description => description(facts, template, speaker),
                    };
                    approximately(&text, language, words)
                });
                let is_new = |text: &String| captions[first..].iter().all(|it: &Caption| it.text != *text);
                let text = drawn.into_iter().find(is_new);
                captions.extend(text.map(|text| Caption { language, style, text }));
            }
        }
    }
    captions
}

/// Draws of words after which a flight has no further different text.
const MOST_DRAWS: u64 = 50;

/// The first `count` of the template numbers in random order (Fisher-Yates).
fn template_order(stream: &mut RandomStream, count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..TEMPLATES).collect();
    for last in (1..TEMPLATES).rev() {
        order.swap(last, stream.index(last + 1));
    }
    order.truncate(count);
    order
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::check::check;
    use crate::facts::{Wear, facts, test_flights::flight};
    use cosfly_domain::{BodyKind, Colour};

    /// Walks of every shape: straight, bent, many turns, with and without stops, standing, seen from below.
    pub(crate) fn flights() -> Vec<Facts> {
        let mut from_below = flight(&[(Some(0.0), 100), (None, 4)]);
        for pose in &mut from_below.poses_in_world {
            (pose.pitch_rad, pose.position_in_world.z) = (0.2, -3.0);
        }
        let mut flights = walks();
        flights.push(facts(&from_below));
        let wear = |top, backpack| Some(Wear { top, trousers: Colour::Black, backpack });
        let dressed = |(at, facts): (usize, Facts)| match at % 3 {
            0 => facts.wearing(wear(Colour::Red, false)),
            1 => facts.wearing(wear(Colour::Orange, true)),
            _ => facts,
        };
        flights.into_iter().enumerate().map(dressed).collect()
    }

    fn walks() -> Vec<Facts> {
        let many: Vec<(Option<f64>, usize)> =
            (0..14).map(|i| (Some(if i % 2 == 0 { 90.0 } else { 0.0 }), 12)).collect();
        let mut with_stops = many.clone();
        with_stops.insert(5, (None, 7));
        let slow_bend: Vec<(Option<f64>, usize)> = (0..60).map(|i| (Some(3.0 * f64::from(i)), 2)).collect();
        [
            vec![(Some(0.0), 200)],
            vec![(Some(-45.0), 60), (None, 6), (Some(-45.0), 60)],
            vec![(Some(90.0), 60), (Some(180.0), 60)],
            vec![(Some(135.0), 40), (Some(-45.0), 40), (None, 9), (Some(45.0), 40), (None, 4), (Some(-45.0), 20)],
            many,
            with_stops,
            vec![(None, 40)],
            vec![(Some(-90.0), 30), (Some(0.0), 30), (Some(-90.0), 30), (Some(180.0), 30), (Some(-90.0), 30)],
            slow_bend,
            // Soon, late, and neither a turn to a side nor around.
            vec![(Some(0.0), 8), (Some(90.0), 60)],
            vec![(Some(0.0), 50), (None, 20), (Some(-90.0), 20)],
            vec![(Some(0.0), 40), (Some(135.0), 40)],
        ]
        .iter()
        .map(|legs| facts(&flight(legs)))
        .collect()
    }

    #[test]
    fn every_caption_of_every_wording_passes_its_own_check() {
        let config = CaptionConfig { variants_per_style: 6, ..CaptionConfig::default() };
        let mut count = 0;
        for (walk, known) in flights().iter().enumerate() {
            for item in 0..25 {
                for caption in captions(known, &config, Seed::of_item(1, "captions", &format!("{walk}-{item}"))) {
                    let checked = check(&caption.text, caption.language, known);
                    assert_eq!(checked, Ok(()), "{}\n{known:?}", caption.text);
                    count += 1;
                }
            }
        }
        assert_eq!(count, 13 * 25 * Language::ALL.len() * 2 * 6);
    }

    #[test]
    fn both_languages_say_when_the_first_turn_comes_and_only_where_it_is_so() {
        let config = CaptionConfig { styles: vec![Style::Description], ..CaptionConfig::default() };
        for (legs, soon, late) in [
            (vec![(Some(0.0), 8), (Some(90.0), 60)], true, false),
            (vec![(Some(0.0), 50), (Some(-90.0), 20)], false, true),
            (vec![(Some(0.0), 30), (Some(-90.0), 60)], false, false),
        ] {
            let known = facts(&flight(&legs));
            for caption in (0..20).flat_map(|seed| captions(&known, &config, Seed::of_item(seed, "captions", "a"))) {
                let has = |phrases: &[&str]| phrases.iter().any(|phrase| caption.text.contains(phrase));
                let said =
                    (has(&["soon", "before long", "Before long", "不久"]), has(&["later", "good while", "好一阵"]));
                assert_eq!(said, (soon, late), "{}", caption.text);
            }
        }
    }

    #[test]
    fn length_time_and_pace_agree_as_they_are_read() {
        let config =
            CaptionConfig { styles: vec![Style::Description], variants_per_style: 6, ..CaptionConfig::default() };
        let stop = |frames| vec![(Some(0.0), 20), (None, frames), (Some(0.0), 14)];
        for legs in (4..30).map(stop).chain((3..60).map(|frames| vec![(Some(0.0), frames)])) {
            let known = facts(&flight(&legs));
            for caption in captions(&known, &config, Seed::of_item(1, "captions", "a")) {
                let claims = read_numbers(&caption.text, caption.language);
                let [Some(way), Some(time), Some(pace)] = claims else { continue };
                let is_said =
                    ["while walking", "while they walk", "走动时", "行走时"].iter().any(|it| caption.text.contains(it));
                let time = if is_said { time - known.standing_s().round() } else { time };
                assert!((way / time / pace - 1.0).abs() <= 0.101, "{}", caption.text);
            }
        }
    }

    /// Way, duration and pace of a text.
    fn read_numbers(text: &str, language: Language) -> [Option<f64>; 3] {
        use cosfly_claims::{Claim, read};
        let claims = read(text, language);
        let find = |of: &dyn Fn(&Claim) -> Option<f64>| claims.iter().find_map(of);
        [
            find(&|it| if let Claim::Way(value) = it { Some(*value) } else { None }),
            find(&|it| if let Claim::Duration(value) = it { Some(*value) } else { None }),
            find(&|it| if let Claim::Speed(value) = it { Some(*value) } else { None }),
        ]
    }

    #[test]
    fn wordings_of_one_trajectory_differ_and_repeat_with_the_seed() {
        let config = CaptionConfig { variants_per_style: 6, ..CaptionConfig::default() };
        for known in flights() {
            let seed = Seed::of_item(1, "captions", "p0");
            let texts = captions(&known, &config, seed);
            let mut distinct: Vec<&str> = texts.iter().map(|caption| caption.text.as_str()).collect();
            distinct.sort_unstable();
            distinct.dedup();
            assert_eq!(distinct.len(), texts.len());
            assert_eq!(texts, captions(&known, &config, seed));
        }
    }

    #[test]
    fn one_second_is_no_plural() {
        let config = CaptionConfig { variants_per_style: 8, ..CaptionConfig::default() };
        let mut said = 0;
        for (at, known) in flights().into_iter().enumerate() {
            let brief = Facts { duration_s: 1.0, stops: vec![], ..known };
            for caption in captions(&brief, &config, Seed::of_item(3, "captions", &at.to_string())) {
                assert!(!caption.text.contains(" 1 seconds"), "{}", caption.text);
                said += usize::from([" 1 second", "1秒"].iter().any(|it| caption.text.contains(it)));
            }
        }
        assert!(said > 60, "{said}");
    }

    #[test]
    fn who_runs_is_not_said_to_walk() {
        let config = CaptionConfig { variants_per_style: 8, ..CaptionConfig::default() };
        let walking = ["walk", "on foot", "步行", "行走", "走"];
        let (mut running, mut refused) = (0, 0);
        for (at, walker) in flights().into_iter().enumerate().filter(|(_, it)| it.walks) {
            let at_pace = |walking_speed_mps: f64| {
                let way_m = walker.way_m * walking_speed_mps / walker.walking_speed_mps;
                Facts { walking_speed_mps, way_m, ..walker.clone() }
            };
            let (fast, slow) = (at_pace(3.2), at_pace(2.0).of_kind(BodyKind::Runner));
            // Company holds a runner up.
            let held_up = walker.clone().of_kind(BodyKind::Runner);
            assert!(fast.runs() && slow.runs() && !walker.runs() && !held_up.runs());
            for runner in [&fast, &slow] {
                for caption in captions(runner, &config, Seed::of_item(3, "captions", &at.to_string())) {
                    assert_eq!(check(&caption.text, caption.language, runner), Ok(()), "{}", caption.text);
                    assert!(!walking.iter().any(|it| caption.text.contains(it)), "{}", caption.text);
                    running += usize::from(["runs", "running", "跑"].iter().any(|it| caption.text.contains(it)));
                }
                let texts = ["walks along, about 10 m away", "步行前行"];
                let wrong = |(it, language): &(&str, &Language)| check(it, **language, runner).is_err();
                refused += texts.into_iter().zip(Language::ALL.iter()).filter(wrong).count();
            }
        }
        assert!(running > 120 && refused > 40, "{running} {refused}");
    }
}
