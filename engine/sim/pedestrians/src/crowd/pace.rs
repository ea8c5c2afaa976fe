//! The speed that a person plans: own tempo, level with the company, slower before a stop and before a road that is not free.

use crate::crowd::company::{Activity, Company};
use crate::crowd::person::{HARDEST_MPS2, Person};
use crate::crowd::roads::Right;
use crate::crowd::{CrowdConfig, pursuit};
use cosfly_frames::DVec2;

/// Change of the speed for each metre behind the middle of the company, as a share, and its limits.
const CATCHING_UP: f64 = 0.25;
const MOST_SLOWER: f64 = -0.5;
const MOST_FASTER: f64 = 0.35;

/// Brings the person's planned speed up to date and returns the direction to walk in, which is back where a vehicle comes.
pub(crate) fn plan(
    config: &CrowdConfig,
    company: &Company,
    person: &mut Person,
    right: Right,
    (places, ahead): (&[DVec2], DVec2),
    step_s: f64,
) -> DVec2 {
    let free_mps = |most_slower: f64| {
        let level = CATCHING_UP * pursuit::lag_m(company, person, places, ahead);
        company.cruise_mps * (1.0 + person.tempo + level.clamp(most_slower, MOST_FASTER))
    };
    let goal_mps = match (company.activity, right) {
        (_, Right::Escape(way)) => way.length() * company.cruise_mps,
        (Activity::Standing { .. }, _) => 0.0,
        (Activity::Walking, Right::Wait(way_m)) => {
            free_mps(MOST_SLOWER).min((2.0 * config.braking_mps2 * way_m).sqrt())
        }
        (Activity::Walking, Right::Free) => free_mps(MOST_SLOWER),
        (Activity::Walking, Right::Cross) => free_mps(0.0),
    };
    let is_escape = matches!(right, Right::Escape(_));
    let change_mps = if is_escape { HARDEST_MPS2 } else { config.braking_mps2 } * step_s;
    person.pace_mps += (goal_mps - person.pace_mps).clamp(-change_mps, change_mps);
    match right {
        Right::Escape(way) => way.try_normalize().unwrap_or(ahead),
        _ => ahead,
    }
}
