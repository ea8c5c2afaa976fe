//! `aim`: the camera aims coarsely and late.

use super::kind::{Departing, Departure, Kind, no_offsets};
use crate::aim::{AimConfig, aimed};
use crate::perturb::sizes::FlyableConfig;
use cosfly_frames::{DVec3, Pose, TargetTrack};

pub(super) const KIND: Kind = Kind {
    name: "aim",
    doc: "The camera aims coarsely and late.",
    departure: Departure::Flown { offsets: no_offsets, views: coarse_views },
};

fn coarse_views(departing: &Departing<'_>, track: &TargetTrack, straight: &[Pose]) -> Vec<Pose> {
    let places: Vec<DVec3> = straight.iter().map(|pose| pose.position_in_world).collect();
    aimed(&places, track, 0, None, &coarse_aim(departing.config), departing.seed.child("aim", 0))
}

fn coarse_aim(config: &FlyableConfig) -> AimConfig {
    AimConfig {
        framing_deg: config.aim_deg,
        framing_s: 5.0,
        tremor_deg: 1.0,
        lag_s: config.aim_lag_s,
        lag_deviation_s: 0.4 * config.aim_lag_s,
        max_deg: 3.0 * config.aim_deg,
        max_rate_deg_s: config.max_rate_deg_s,
    }
}
