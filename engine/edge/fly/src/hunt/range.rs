//! [`HuntRange`]: a value of a recipe that may vary, and the values that it may have.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_drone::models;
use cosfly_frames::RandomStream;
use cosfly_recipe::Recipe;

/// Table whose values change flights and leave the world as it is.
const AIR: &str = "tool.fly.";

/// A value of a recipe that may vary.
#[derive(Clone, Debug, PartialEq)]
pub struct HuntRange {
    /// Keys from the root of the recipe, joined by dots.
    pub path: String,
    values: Values,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// Whole numbers between two, both included.
    Whole(i64, i64),
    /// Numbers between two.
    Real(f64, f64),
    /// Values as TOML.
    Choice(Vec<String>),
}

/// A value that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnChange {
    /// The change as of `--set`.
    pub change: String,
    /// Place in the range, 0..=1; of a choice 0.
    pub place: f64,
}

impl HuntRange {
    /// Reads `PATH=LOW..HIGH` or `PATH=VALUE|VALUE|...`.
    ///
    /// # Errors
    /// `hunt-range`.
    pub fn read(text: &str) -> Result<Self> {
        let refused = |rule: &str| {
            Diagnostic::new("hunt-range", Fault::Recipe, format!("`{text}` is no range: {rule}")).hint(
                "write `--vary tool.fly.latency_ms=0..400`, or values with `|` between them: `--vary tool.fly.gusts=true|false`",
            )
        };
        let (path, values) = text.split_once('=').ok_or_else(|| refused("it has no `=`"))?;
        let (path, values) = (path.trim().to_owned(), values.trim());
        if path.is_empty() || ["name", "seed"].contains(&path.as_str()) {
            return Err(refused("a path of the recipe is missing before `=`; `name` and `seed` vary in every hunt"));
        }
        let Some((low, high)) = values.split_once("..") else {
            let choices: Vec<String> = values.split('|').map(|choice| choice.trim().to_owned()).collect();
            if choices.len() < 2 || choices.iter().any(String::is_empty) {
                return Err(refused("it has one value at most"));
            }
            return Ok(Self { path, values: Values::Choice(choices) });
        };
        if let (Ok(low), Ok(high)) = (low.trim().parse::<i64>(), high.trim().parse::<i64>()) {
            if low > high || high.checked_sub(low).is_none_or(|width| width >= 1 << 52) {
                return Err(refused("its first number must not be above its second, nor very far below"));
            }
            return Ok(Self { path, values: Values::Whole(low, high) });
        }
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.abs() < 1e12);
        match (number(low), number(high)) {
            (Some(low), Some(high)) if low <= high => Ok(Self { path, values: Values::Real(low, high) }),
            (Some(_), Some(_)) => Err(refused("its first number must not be above its second")),
            _ => Err(refused("`..` stands between two numbers")),
        }
    }

    /// Ranges that vary where nothing is said: latency, losses of sight, and for quadrotors the wind.
    pub fn of_flights(recipe: &Recipe) -> Vec<Self> {
        let whole = |key: &str, high: i64| Self { path: format!("{AIR}{key}"), values: Values::Whole(0, high) };
        let drone = recipe.tool.get("fly").and_then(|table| table["drone"].as_str());
        let is_quadrotor = drone.and_then(|name| models::model(name).ok()).is_some_and(|it| it.parameters.is_some());
        let mut ranges = vec![whole("blackouts", 2), whole("latency_ms", 400)];
        ranges.extend(is_quadrotor.then(|| whole("wind_mps", 10)));
        ranges
    }

    /// Whether the value changes flights alone, and no world.
    pub fn is_of_air(&self) -> bool {
        self.path.starts_with(AIR)
    }

    /// A value of the range.
    pub fn drawn(&self, stream: &mut RandomStream) -> DrawnChange {
        let of = |value: String, place: f64| DrawnChange { change: format!("{}={value}", self.path), place };
        match &self.values {
            Values::Whole(low, high) => {
                let offset = stream.index((high - low) as usize + 1) as i64;
                of((low + offset).to_string(), offset as f64 / (high - low).max(1) as f64)
            }
            Values::Real(low, high) => {
                let place = stream.unit();
                of(format!("{:?}", low + (high - low) * place), place)
            }
            Values::Choice(choices) => of(choices[stream.index(choices.len())].clone(), 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;

    #[test]
    fn ranges_are_read_and_drawn_and_what_is_wrong_is_told() {
        let mut stream = Seed([3; 32]).stream("test");
        let mut drawn = |text: &str| HuntRange::read(text).expect("a range").drawn(&mut stream);
        for _ in 0..100 {
            let whole = drawn("tool.fly.blackouts=1..3").change;
            assert!(["1", "2", "3"].iter().any(|value| whole == format!("tool.fly.blackouts={value}")), "{whole}");
            let real = drawn("stages.w.speed.mean_mps=0.5..2").place;
            assert!((0.0..1.0).contains(&real));
            let choice = drawn("tool.fly.gusts=true|false").change;
            assert!(["tool.fly.gusts=true", "tool.fly.gusts=false"].contains(&choice.as_str()));
        }
        for (text, words) in [
            ("tool.fly.gusts", "no `=`"),
            ("seed=1..2", "vary in every hunt"),
            ("a.b=1", "one value at most"),
            ("a.b=3..1", "must not be above"),
            ("a.b=3.5..1", "must not be above"),
            ("a.b=x..1", "between two numbers"),
            ("a.b=NaN..1", "between two numbers"),
            ("a.b=-9223372036854775808..9223372036854775807", "very far below"),
        ] {
            let wrong = HuntRange::read(text).expect_err(text).to_string();
            assert!(wrong.contains(words), "{text}: {wrong}");
        }
    }
}
