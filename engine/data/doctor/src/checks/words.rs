//! Instructions that differ from their flights.

use crate::{Episode, Flag};
use cosfly_captions::{Facts, Language, check as check_caption, facts};
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_planner::{Certificate, Trajectory};

/// Parses every instruction in a known language and compares it with the facts of the flight.
pub fn check(episode: &Episode) -> Vec<Flag> {
    let Some(facts) = facts_of(episode).filter(|_| !episode.captions.is_empty()) else { return vec![] };
    let mut flags = vec![];
    for (code, text) in &episode.captions {
        let Some(language) = [Language::Zh, Language::En].into_iter().find(|it| it.code() == code) else { continue };
        if let Err(mismatches) = check_caption(text, language, &facts) {
            let shown: Vec<String> = mismatches.iter().take(2).map(ToString::to_string).collect();
            let message = format!("its instruction ({code}) is not true: {}", shown.join("; "));
            flags.push(Flag::damage("caption-mismatch", &episode.id, message));
        }
    }
    flags
}

/// Facts of a flight; none where the target is unknown in some frames.
pub fn facts_of(episode: &Episode) -> Option<Facts> {
    trajectory(episode).filter(|it| !it.track.states.is_empty()).map(|it| facts(&it).wearing(episode.wear))
}

/// The flight as captions need it; none where the target is unknown in some frames.
fn trajectory(episode: &Episode) -> Option<Trajectory> {
    let middle = DVec3::Z * (0.5 * episode.target_height_m);
    let state = |it: &crate::Moment| {
        let (heading_rad, speed_mps) = it.heading_and_speed?;
        Some(TargetState { feet_in_world: it.target_in_world? - middle, heading_rad, speed_mps })
    };
    let states: Option<Vec<TargetState>> = episode.moments.iter().map(state).collect();
    Some(Trajectory {
        track: TargetTrack { dt_s: episode.dt_s, height_m: episode.target_height_m, radius_m: 0.3, states: states? },
        poses_in_world: episode.moments.iter().map(|it| it.drone).collect(),
        visibility: episode.moments.iter().map(|it| it.visible.unwrap_or_default()).collect(),
        clearance_m: vec![],
        terms: vec![],
        convergence: vec![],
        certificate: Certificate::default(),
        perturbation: None,
    })
}
