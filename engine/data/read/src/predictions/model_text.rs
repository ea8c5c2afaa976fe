//! Increments in the text of a language model, parsed as in the published evaluation scripts: text before `</think>` is
//! dropped, and one JSON object has a list `waypoint_deltas`.

use super::waypoint::Waypoint;
use serde::Deserialize;

const KEY: &str = "\"waypoint_deltas\"";
/// Most enclosing objects that are tried, from the innermost one.
const TRIES: usize = 32;

#[derive(Deserialize)]
struct Answer {
    waypoint_deltas: Vec<Waypoint>,
}

/// Parses the increments in `text`: those of the first JSON object that has them. Surrounding words, code fences and
/// enclosing objects are ignored.
///
/// # Errors
/// Reason why there are none.
pub fn deltas_in(text: &str) -> Result<Vec<[f64; 6]>, String> {
    let said = text.rsplit_once("</think>").map_or(text, |(_, after)| after);
    let Some(key) = said.find(KEY) else {
        return Err("the text has no `\"waypoint_deltas\"`".to_owned());
    };
    let mut why = "the text has no JSON object around `\"waypoint_deltas\"`".to_owned();
    for (brace, _) in said[..key].rmatch_indices('{').take(TRIES) {
        let mut reader = serde_json::Deserializer::from_str(&said[brace..]);
        match Answer::deserialize(&mut reader) {
            Ok(answer) => return Ok(answer.waypoint_deltas.into_iter().map(|waypoint| waypoint.0).collect()),
            Err(error) if why.starts_with("the text has") => why = format!("the object in the text: {error}"),
            Err(_) => {}
        }
    }
    Err(why)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thoughts_are_dropped_and_words_around_the_object_do_not_matter() {
        let text = "<think>{\"waypoint_deltas\": [[9]]}</think>Sure! ```json\n{\"plan\": {\"waypoint_deltas\": [[1, 2], {\"dyaw\": 5, \"why\": \"turn\"}]}}\n```";
        assert_eq!(deltas_in(text).unwrap(), [[1.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 5.0, 0.0]]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, expected) in [
            ("I cannot help", "no `\"waypoint_deltas\"`"),
            ("\"waypoint_deltas\": [[1]]", "no JSON object"),
            ("{\"waypoint_deltas\": [[1,2,3,4,5,6,7]]}", "more than six"),
            ("{\"waypoint_deltas\": [[1,2", "EOF"),
            ("{\"waypoint_deltas\": [[\"left\"]]}", "invalid type"),
            ("{\"waypoint_deltas\": [{\"x\": 1}]}", "names none of"),
        ] {
            let why = deltas_in(text).unwrap_err();
            assert!(why.contains(expected), "{text}: {why}");
        }
        assert!(deltas_in(&"{\"waypoint_deltas\":".repeat(2000)).is_err());
    }
}
