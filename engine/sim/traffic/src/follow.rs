//! [`Follow`]: the bodies of traffic that flights follow.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{BodyKind, Traffic};
use cosfly_frames::TargetState;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bodies that flights follow: the first ones, by number, of the named kinds that are there in all frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Follow {
    /// Number of followed bodies; a higher number changes none of the first. Default 4.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub count: u64,
    /// Names of those who are followed first: scripted and recorded people, vehicles and people of SUMO. They count among `count`.
    /// Default `[]`.
    pub named: Vec<String>,
    /// Kinds of the other followed bodies, in turn. Default `["pedestrian"]`.
    #[schemars(length(min = 1))]
    pub kinds: Vec<BodyKind>,
    /// Least distance that a followed body covers, metres. Default 20.
    #[schemars(range(min = 0.0, max = 100_000.0))]
    pub min_length_m: f64,
    /// Speed that no followed body exceeds, m/s, such as `limits.speed_mps` of the stage `plan`: faster ones are rejected there.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.1, max = 100.0))]
    pub max_speed_mps: Option<f64>,
}

impl Default for Follow {
    fn default() -> Self {
        Self { count: 4, named: vec![], kinds: vec![BodyKind::Pedestrian], min_length_m: 20.0, max_speed_mps: None }
    }
}

impl Follow {
    /// Parameters that no single followed body depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];

    /// Number of the body in place `place` among those that may be followed.
    ///
    /// # Errors
    /// A name in `named` that nobody has who is there all the time; too few bodies of the kinds.
    pub fn number(&self, traffic: &Traffic, place: usize) -> Result<u32> {
        let eligible = self.eligible(traffic).map_err(|name| nobody(name, traffic))?;
        eligible.get(place).copied().ok_or_else(|| self.too_few(eligible.len()))
    }

    /// Numbers of all bodies that may be followed, in the order in which they are: those with names, then the first of each
    /// kind, the second of each kind and so on, so that further ones change nothing.
    ///
    /// # Errors
    /// A name that nobody has who is there all the time.
    pub fn eligible<'a>(&'a self, traffic: &Traffic) -> Result<Vec<u32>, &'a str> {
        let is_there = |number: &u32| traffic.track(*number).is_some();
        let numbers = || 0..traffic.bodies.len() as u32;
        let of_name = |name: &'a String| {
            let mut called = numbers().filter(|number| traffic.bodies[*number as usize].plan.source == *name);
            called.find(is_there).ok_or(name.as_str())
        };
        let named: Vec<u32> = self.named.iter().map(of_name).collect::<Result<_, _>>()?;
        let of_kind = |kind: &BodyKind| -> Vec<u32> {
            let may = |number: &u32| {
                let body = &traffic.bodies[*number as usize];
                body.plan.kind == *kind
                    && !named.contains(number)
                    && is_there(number)
                    && body.length_m() >= self.min_length_m
                    && self.max_speed_mps.is_none_or(|limit_mps| fastest_mps(&body.states, traffic.dt_s) <= limit_mps)
            };
            numbers().filter(may).collect()
        };
        let lists: Vec<Vec<u32>> = self.kinds.iter().map(of_kind).collect();
        let longest = lists.iter().map(Vec::len).max().unwrap_or(0);
        let others = (0..longest).flat_map(|place| lists.iter().filter_map(move |list| list.get(place))).copied();
        Ok(named.iter().copied().chain(others).collect())
    }

    fn too_few(&self, eligible: usize) -> Box<Diagnostic> {
        let kinds: Vec<String> = self.kinds.iter().map(|kind| format!("`{}`", kind.name())).collect();
        let slow = self.max_speed_mps.map_or_else(String::new, |limit| format!(" at no more than {limit} m/s"));
        let message = format!(
            "`follow.count` is {}, but the bodies of the kinds {} that are there all the time and cover {} m{slow} are {eligible}",
            self.count,
            kinds.join(", "),
            self.min_length_m
        );
        let raise = if self.max_speed_mps.is_some() { ", or raise `follow.max_speed_mps`" } else { "" };
        Diagnostic::new("traffic-few", Fault::Recipe, message).hint(format!(
            "follow fewer, move more people or vehicles, name further kinds, or lower `follow.min_length_m`{raise}"
        ))
    }
}

/// Largest speed between two frames, m/s, as planners judge it.
fn fastest_mps(states: &[TargetState], dt_s: f64) -> f64 {
    let steps_m = states.windows(2).map(|pair| pair[1].feet_in_world.distance(pair[0].feet_in_world));
    steps_m.fold(0.0, f64::max) / dt_s
}

/// The refusal of a name in `named`.
fn nobody(name: &str, traffic: &Traffic) -> Box<Diagnostic> {
    const MOST: usize = 8;
    let called = traffic.bodies.iter().filter(|body| body.plan.source == name).count();
    let message = match called {
        0 => format!("`follow.named` names `{name}`, but nobody is called so"),
        _ => format!("`follow.named` names `{name}`, who is not there in all frames"),
    };
    let whole = (0..traffic.bodies.len()).filter(|number| traffic.track(*number as u32).is_some());
    let names = whole.map(|number| &traffic.bodies[number].plan.source).filter(|name| !name.is_empty());
    let names: Vec<String> = names.take(MOST).map(|name| format!("`{name}`")).collect();
    let has_names = traffic.bodies.iter().any(|body| !body.plan.source.is_empty());
    let hint = match names.len() {
        0 if !has_names => {
            "names are those of `scripted` and `recorded` people and of bodies of `sumo`; this stage has none"
                .to_owned()
        }
        0 => "nobody with a name is there all the time: use fewer frames, or another `start_s` or `begin_s`".to_owned(),
        _ => format!("there all the time, among others: {}", names.join(", ")),
    };
    Diagnostic::new("traffic-few", Fault::Recipe, message).hint(hint)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Body, BodyPlan};
    use cosfly_frames::{DVec3, Seed};

    fn car(speed_mps: f64) -> Body {
        let state = |frame: u32| TargetState {
            feet_in_world: DVec3::new(0.5 * speed_mps * f64::from(frame), 0.0, 0.0),
            heading_rad: 0.0,
            speed_mps,
        };
        let size_m = DVec3::new(4.5, 1.8, 1.5);
        let plan = BodyPlan { source: String::new(), kind: BodyKind::Car, size_m, looks: Seed([1; 32]), group: None };
        Body { plan, first_frame: 0, states: (0..20).map(state).collect() }
    }

    #[test]
    fn bodies_above_the_greatest_speed_are_not_followed() {
        let bodies = [8.0, 14.2, 11.9, 12.1].map(car).to_vec();
        let traffic = Traffic { dt_s: 0.5, frames: 20, bodies, ..Traffic::default() };
        let follow = |max_speed_mps| Follow { kinds: vec![BodyKind::Car], max_speed_mps, ..Follow::default() };
        assert_eq!(follow(None).eligible(&traffic), Ok(vec![0, 1, 2, 3]));
        assert_eq!(follow(Some(12.0)).eligible(&traffic), Ok(vec![0, 2]));
        let refusal = follow(Some(12.0)).number(&traffic, 2).unwrap_err();
        assert!(refusal.message.contains("at no more than 12 m/s are 2"), "{}", refusal.message);
    }
}
