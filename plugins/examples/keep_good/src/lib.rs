//! `keep_good`: keeps flights whose columns fulfil your rules, and rejects the others with the reason.

use cosfly_plugin::{Answer, Column, Flight, Gives, Metadata, Stage, params};

params! {
    /// A rule on one column of flights.
    pub struct Rule {
        /// The column, such as `visibility`, `clearance`, `drone_z` or `cost_length`.
        column: String = String::new();
        /// Statistic of the column: `mean`, `min`, `max` or `share_above` (the share of frames above `level`).
        of: String = String::from("mean");
        /// See `share_above`.
        level: f64 = 0.0, [-1e9, 1e9];
        /// Least allowed value.
        at_least: f64 = -1e9, [-1e9, 1e9];
        /// Greatest allowed value.
        at_most: f64 = 1e9, [-1e9, 1e9];
    }
}

params! {
    /// Conditions on flights.
    pub struct Params {
        /// The rules; all must hold.
        rules: Vec<Rule> = vec![];
    }
}

/// See the crate.
pub struct KeepGood(Params);

impl Stage for KeepGood {
    type Params = Params;

    fn describe() -> Metadata {
        Metadata { name: "keep_good", version: "0.1.0", summary: "Keeps flights whose columns fulfil your rules." }
    }

    fn new(params: Params) -> Result<Self, String> {
        for (index, rule) in params.rules.iter().enumerate() {
            if !["mean", "min", "max", "share_above"].contains(&rule.of.as_str()) {
                return Err(format!(
                    "`rules[{index}].of` is `{}`; it must be `mean`, `min`, `max` or `share_above`",
                    rule.of
                ));
            }
        }
        Ok(Self(params))
    }

    fn reads(&self) -> Vec<Column> {
        let mut columns: Vec<Column> = self.0.rules.iter().map(|rule| Column::real(&rule.column, "")).collect();
        columns.sort_by(|a, b| a.name.cmp(&b.name));
        columns.dedup();
        columns
    }

    fn gives(&self) -> Gives {
        Gives::Verdict
    }

    fn run(&self, flight: &Flight) -> Result<Answer, String> {
        for rule in &self.0.rules {
            let values = flight.column(&rule.column)?;
            let count = values.len().max(1) as f64;
            let found = match rule.of.as_str() {
                "min" => values.iter().copied().fold(f64::INFINITY, f64::min),
                "max" => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                "share_above" => values.iter().filter(|value| **value > rule.level).count() as f64 / count,
                _ => values.iter().sum::<f64>() / count,
            };
            let what = format!("{} of `{}` is {found:.3}", rule.of, rule.column);
            if found < rule.at_least {
                return Ok(Answer::Reject(format!("{what}; it must be at least {}", rule.at_least)));
            }
            if found > rule.at_most {
                return Ok(Answer::Reject(format!("{what}; it must be at most {}", rule.at_most)));
            }
        }
        Ok(Answer::Keep)
    }
}

cosfly_plugin::stage!(KeepGood);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_that_breaks_a_rule_is_rejected_with_the_value() {
        let flight = Flight::new("p00000", &[("visibility", &[1.0, 0.5, 0.0])]);
        let rule =
            |of: &str, at_least: f64| Rule { column: "visibility".into(), of: of.into(), at_least, ..Rule::default() };
        let judge = |rule: Rule| KeepGood::new(Params { rules: vec![rule] }).unwrap().run(&flight).unwrap();
        assert_eq!(judge(rule("mean", 0.5)), Answer::Keep);
        assert_eq!(
            judge(rule("min", 0.1)),
            Answer::Reject("min of `visibility` is 0.000; it must be at least 0.1".into())
        );
        let unknown = KeepGood::new(Params { rules: vec![Rule { column: "colour".into(), ..Rule::default() }] });
        assert!(unknown.unwrap().run(&flight).unwrap_err().contains("does not read `colour`"));
    }
}
