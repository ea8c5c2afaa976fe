//! A drone's state beside a trajectory: read from a line of JSON, checked before anyone plans from it.

use cosfly_diagnose::{Diagnostic, Fault, LARGEST_MAGNITUDE, Result, counted, nearest_name, plausible};
use cosfly_frames::{DVec3, TargetTrack};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;
use serde_json::error::Category;
use std::fmt;

/// Largest distance of a drone from its target, metres: a flight back from further away does not show the target.
pub const FURTHEST_M: f64 = 1000.0;
/// Largest component of a velocity, m/s. The planner checks its own limits, which are lower.
const FASTEST_MPS: f64 = 1000.0;
/// Values are quoted up to this length.
const QUOTED_CHARACTERS: usize = 60;

const FIELDS: [&str; 5] = ["trajectory_id", "frame", "position_in_world", "velocity_in_world", "horizon_s"];
/// Former names of fields and the names that they have now.
const GONE: [(&str, &str); 3] =
    [("trajectory", "trajectory_id"), ("position", "position_in_world"), ("velocity", "velocity_in_world")];
const EXAMPLE: &str = "a state is like {\"trajectory_id\": \"expert-p00000\", \"frame\": 40, \"position_in_world\": [x, y, z], \"velocity_in_world\": [x, y, z], \"horizon_s\": 4}; velocity_in_world and horizon_s may be left out";

/// A drone's state beside a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Id of the trajectory.
    pub trajectory_id: String,
    /// Frame of the trajectory.
    pub frame: usize,
    /// Position in the world frame, metres.
    pub position_in_world: [f64; 3],
    /// Velocity in the world frame, m/s; that of the published flight in this frame where it is not given.
    pub velocity_in_world: Option<[f64; 3]>,
    /// Length of the answer, seconds; to the end of the trajectory where it is not given.
    pub horizon_s: Option<f64>,
}

impl State {
    /// Reads a line of JSON.
    ///
    /// # Errors
    /// `ask-expert-line`, naming the field and what is allowed.
    pub fn of_line(line: &[u8]) -> Result<Self> {
        Self::read(line).map_err(|(rule, hint)| {
            let refusal = Diagnostic::new("ask-expert-line", Fault::Input, rule);
            hint.into_iter().fold(refusal, Diagnostic::hint).hint(EXAMPLE)
        })
    }

    fn read(line: &[u8]) -> Result<Self, (String, Option<String>)> {
        let refused = |rule: String| (rule, None);
        let text = std::str::from_utf8(line).map_err(|error| {
            refused(format!("this line is not text: byte {} is not UTF-8", error.valid_up_to() + 1))
        })?;
        let Fields(fields) = serde_json::from_str(text).map_err(|error| refused(not_json(&error)))?;
        let mut values: [Option<Value>; FIELDS.len()] = Default::default();
        for (name, value) in fields {
            let Some(index) = FIELDS.iter().position(|known| *known == name) else {
                let now = GONE.iter().find(|(before, _)| *before == name).map(|(_, now)| *now);
                let near = now.or_else(|| nearest_name(&name, FIELDS)).map(|near| format!("did you mean `{near}`?"));
                return Err((format!("{} is not a field of a state", quoted(&Value::from(name))), near));
            };
            if values[index].replace(value).is_some() {
                return Err(refused(format!("`{name}` is there twice")));
            }
        }
        // Fields that may be absent may be null.
        let [trajectory, frame, position, velocity, horizon] =
            values.map(|value| value.filter(|value| !value.is_null()));
        let given = |name: &str, value: Option<Value>| value.ok_or_else(|| refused(format!("`{name}` is missing")));
        let trajectory = match given("trajectory_id", trajectory)? {
            Value::String(id) => id,
            other => return Err(refused(wrong("trajectory_id", &other, "the id of a trajectory, a string"))),
        };
        let frame = given("frame", frame)?;
        let index = frame.as_u64().and_then(|frame| usize::try_from(frame).ok());
        let position = given("position_in_world", position)?;
        let place =
            triple(&position).ok_or_else(|| refused(wrong("position_in_world", &position, "three numbers, metres")))?;
        let still = |value: &Value| {
            triple(value).ok_or_else(|| refused(wrong("velocity_in_world", value, "three numbers, m/s")))
        };
        let seconds =
            |value: &Value| value.as_f64().ok_or_else(|| refused(wrong("horizon_s", value, "a number, seconds")));
        Ok(Self {
            trajectory_id: trajectory,
            frame: index.ok_or_else(|| refused(wrong("frame", &frame, "a whole number from 0 on")))?,
            position_in_world: place,
            velocity_in_world: velocity.as_ref().map(still).transpose()?,
            horizon_s: horizon.as_ref().map(seconds).transpose()?,
        })
    }

    /// Refuses states that no flight can begin with, whatever the map and the limits.
    ///
    /// # Errors
    /// `ask-expert-frame`, `ask-expert-state`, `ask-expert-horizon`.
    pub fn check(&self, track: &TargetTrack) -> Result<()> {
        let state_refused = |message: String| Err(Diagnostic::new("ask-expert-state", Fault::Input, message));
        let Some(target) = track.states.get(self.frame) else {
            let (frame, frames) = (self.frame, track.len());
            let message = format!(
                "frame {frame} is beyond `{}`, which has {frames}",
                self.trajectory_id,
                frames = counted(frames, "frame")
            );
            return Err(Diagnostic::new("ask-expert-frame", Fault::Input, message).hint("frames count from 0"));
        };
        let (place, velocity) = (self.position_in_world, self.velocity_in_world.unwrap_or_default());
        if place.iter().any(|value| plausible(*value).is_err()) {
            return state_refused(format!(
                "the position is {place:?}; it must be three numbers up to {LARGEST_MAGNITUDE:e}"
            ));
        }
        if !velocity.iter().all(|value| value.abs() <= FASTEST_MPS) {
            let rule = format!("it must be three finite numbers between -{FASTEST_MPS} and {FASTEST_MPS} m/s");
            return state_refused(format!("the velocity is {velocity:?}; {rule}"));
        }
        if let Some(horizon) = self.horizon_s.filter(|horizon| !(plausible(*horizon).is_ok() && *horizon > 0.0)) {
            let message =
                format!("the horizon is {horizon:?} s; it must be above 0 s and at most {LARGEST_MAGNITUDE:e} s");
            return Err(Diagnostic::new("ask-expert-horizon", Fault::Input, message));
        }
        if DVec3::from(place).distance(target.feet_in_world) > FURTHEST_M {
            let rule =
                format!("it must be within {FURTHEST_M} m of the target, which is at {:.1}", target.feet_in_world);
            return state_refused(format!("the position is {place:?} at frame {}; {rule}", self.frame));
        }
        Ok(())
    }
}

fn triple(value: &Value) -> Option<[f64; 3]> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}

fn wrong(field: &str, value: &Value, allowed: &str) -> String {
    format!("`{field}` is {}; it must be {allowed}", quoted(value))
}

fn quoted(value: &Value) -> String {
    let text = value.to_string();
    let start: String = text.chars().take(QUOTED_CHARACTERS).collect();
    if start.len() < text.len() { format!("`{start} ...`") } else { format!("`{text}`") }
}

fn not_json(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or_default();
    match error.classify() {
        Category::Data => "this line is not a JSON object".to_owned(),
        Category::Eof | Category::Io => "this line is not JSON: it ends too early".to_owned(),
        Category::Syntax => format!("this line is not JSON: {what} at column {}", error.column()),
    }
}

/// The fields of an object in their order, with duplicates.
struct Fields(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for Fields {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(FieldsVisitor)
    }
}

struct FieldsVisitor;

impl<'de> Visitor<'de> for FieldsVisitor {
    type Value = Fields;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Fields, A::Error> {
        let mut fields = Vec::new();
        while let Some(field) = map.next_entry()? {
            fields.push(field);
        }
        Ok(Fields(fields))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_refused(line: &[u8], words: &str) {
        let refusal = State::of_line(line).expect_err(words);
        assert!(refusal.message.contains(words), "{}", refusal.message);
    }

    #[test]
    fn states_are_read_and_what_may_be_left_out_may_be_null() {
        let whole =
            br#"{"trajectory_id": "e-p0", "frame": 4, "position_in_world": [1, 2.5, 3], "velocity_in_world": [0, -1, 0], "horizon_s": 2}"#;
        let state = State::of_line(whole).unwrap();
        assert_eq!(
            (state.frame, state.position_in_world, state.velocity_in_world),
            (4, [1.0, 2.5, 3.0], Some([0.0, -1.0, 0.0]))
        );
        assert_eq!(state.horizon_s, Some(2.0));
        let null =
            br#"{"trajectory_id": "e-p0", "frame": 4, "position_in_world": [1, 2.5, 3], "velocity_in_world": null, "horizon_s": null}"#;
        assert_eq!(State::of_line(null).unwrap(), State { velocity_in_world: None, horizon_s: None, ..state });
    }

    #[test]
    fn refusals_name_the_field_and_what_is_allowed() {
        check_refused(b"\xff{}", "byte 1 is not UTF-8");
        check_refused(b"[1, 2]", "not a JSON object");
        check_refused(br#"{"frame": 4"#, "ends too early");
        check_refused(br#"{"frame": NaN}"#, "at column 11");
        check_refused(br#"{"trajectory_id": "e"}"#, "`frame` is missing");
        check_refused(br#"{"trajectory_id": 3}"#, "`trajectory_id` is `3`");
        check_refused(br#"{"frame": 4, "frame": 5}"#, "`frame` is there twice");
        check_refused(br#"{"poition": 4}"#, "`\"poition\"` is not a field");
        let with = |frame: &str, place: &str| {
            format!(r#"{{"trajectory_id": "e", "frame": {frame}, "position_in_world": {place}}}"#)
        };
        check_refused(with("-1", "[1, 2, 3]").as_bytes(), "`frame` is `-1`; it must be a whole number");
        check_refused(
            with("1", "[1, 2]").as_bytes(),
            "`position_in_world` is `[1,2]`; it must be three numbers, metres",
        );
    }
}
