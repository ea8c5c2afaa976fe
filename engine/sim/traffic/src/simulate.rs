//! [`simulate_traffic`]: everybody of a traffic, moved and dressed.

use crate::avoided::{Avoided, take_out};
use crate::config::TrafficConfig;
use crate::populations::{self, TrackFile};
use cosfly_diagnose::Result;
use cosfly_domain::{BodyKind, Town, Traffic, Traits};
use cosfly_figures::{BodyShape, grey_haired, outfit_of};
use cosfly_frames::Seed;
use cosfly_world::{OutfitsBySeed, dress, give_looks, simulate};

/// Traffic, and what happened on the way.
pub struct SimulatedTraffic {
    /// Everybody, those who were avoided left out.
    pub traffic: Traffic,
    /// Notes of the populations, in words.
    pub about: String,
    /// Omissions, in words; they stand among the notes of the traffic, too.
    pub warnings: Vec<String>,
    /// Number of people who were avoided.
    pub avoided: usize,
    /// Number of bodies left out because one of those walks through them.
    pub left_out: usize,
}

/// Moves everybody of a traffic called `name` through a town. `files` are those of [`TrafficConfig::recorded`], then the two of
/// [`TrafficConfig::sumo`]; `check` is called before each frame.
///
/// # Errors
/// Towns without ground for people, files that cannot be used, and those of `check`.
pub fn simulate_traffic(
    config: &TrafficConfig,
    (name, seed): (&str, Seed),
    town: &Town,
    files: &[TrackFile],
    avoided: Avoided,
    check: &dyn Fn() -> Result<()>,
) -> Result<SimulatedTraffic> {
    let (clock, count) = (config.clock(), avoided.len());
    let mut populations = populations::all(config, town, (clock, seed), files, avoided)?;
    let simulated = simulate(&mut populations.all, clock, |_| check())?;
    let mut traffic = Traffic { name: name.to_owned(), ..simulated };
    let left_out = take_out(&mut traffic, count);
    // Followed people matter here to those who are dressed like them; walks refuse names that nobody has.
    let mut followed = config.follow.eligible(&traffic).unwrap_or_default();
    followed.truncate(config.follow.count as usize);
    let outfit = |looks: &Seed| outfit_of(BodyShape::default(), looks);
    let traits = |looks: &Seed| outfit(looks).traits.unwrap_or(Traits::PLAIN);
    let alike = |a: &Seed, b: &Seed| outfit(a).is_like(&outfit(b));
    let looks_note = give_looks(&mut traffic, &config.looks, &traits, &seed.child("looks", 0));
    for body in traffic.bodies.iter_mut().filter(|body| body.plan.kind == BodyKind::Elder) {
        body.plan.looks = grey_haired(&body.plan.looks);
    }
    let outfits = OutfitsBySeed { alike: &alike, traits: &traits };
    let note = dress(&mut traffic, &followed, &config.look_alikes, outfits, &seed.child("look-alikes", 0));
    let about = traffic.notes.join("; ");
    let warnings: Vec<String> = populations.notes.into_iter().chain(looks_note).chain(note).collect();
    traffic.notes.extend(warnings.iter().cloned());
    Ok(SimulatedTraffic { traffic, about, warnings, avoided: count, left_out })
}
