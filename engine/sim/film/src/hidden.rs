//! Frames of a flight in which nothing of the target's figure is in sight, before any picture is made: hundreds of rays.

use crate::body_rays::BodyRays;
use crate::shooting::Shooting;
use crate::walks::BodyOnTrack;
use cosfly_domain::{Around, Followed, Trajectory};
use cosfly_figures::FigureInPicture;
use cosfly_frames::Seed;
use cosfly_geometry::BoxBvh;

/// Where more of the eight points of the certificate is seen, the figure is in sight.
const MOST_SEEN: f64 = 0.25;

/// Whether the figure of the target is hidden, frame by frame: from the default camera, by the boxes of the town and the bodies
/// around the target.
pub fn hidden(flight: &Trajectory, boxes: &BoxBvh, around: &Around, followed: Option<&Followed>) -> Vec<bool> {
    let track = &flight.track;
    let target = BodyOnTrack::target(track, followed);
    let others: Vec<BodyOnTrack> =
        around.bodies().map(|(_, body)| BodyOnTrack::of(body, around.traffic.dt_s)).collect();
    let camera = Shooting::plain(Seed([0; 32])).camera;
    let mut rays = BodyRays::default();
    let mut is_hidden = |frame: usize| {
        let time_s = frame as f64 * track.dt_s;
        let Some(figure) = target.figure(time_s) else { return false };
        let about =
            others.iter().filter_map(|other| Some(FigureInPicture { figure: other.figure(time_s)?, instance: 1 }));
        let about: Vec<FigureInPicture> = about.collect();
        let seen = rays.visible_share(boxes, &about, &camera, &flight.poses_in_world[frame], &figure);
        seen.is_none_or(|share| share == 0.0)
    };
    (0..track.states.len()).map(|frame| flight.visibility[frame] <= MOST_SEEN && is_hidden(frame)).collect()
}
