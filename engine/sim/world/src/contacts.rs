//! Bodies that overlap, found by comparing all pairs that are near: the judge of simulated traffic.

use cosfly_domain::Traffic;

/// Two bodies that overlap in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Frame number.
    pub frame: u32,
    /// Numbers of the two bodies, the smaller first.
    pub bodies: [u32; 2],
    /// Depth of the overlap seen from above, metres, above 0.
    pub depth_m: f64,
}

/// All overlaps deeper than `deeper_than_m`, by frame and numbers. Bodies that pass at different heights do not touch.
pub fn contacts(traffic: &Traffic, deeper_than_m: f64) -> Vec<Contact> {
    let mut found = vec![];
    for frame in 0..traffic.frames {
        let snapshot = traffic.snapshot(frame);
        let first = found.len();
        for body in snapshot.all() {
            snapshot.near(body.state.feet_in_world.truncate(), body.radius_m, |other| {
                let [low, high] = [body, other].map(|it| it.state.feet_in_world.z);
                let apart = high >= low + body.size_m.z || low >= high + other.size_m.z;
                if other.number <= body.number || apart {
                    return;
                }
                let [plan, other_plan] = [body, other].map(|it| &traffic.bodies[it.number as usize].plan);
                let depth_m = -plan.gap_m(&body.state, other_plan, &other.state);
                if depth_m > deeper_than_m {
                    found.push(Contact { frame, bodies: [body.number, other.number], depth_m });
                }
            });
        }
        found[first..].sort_by_key(|contact| contact.bodies);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Body, BodyKind, BodyPlan};
    use cosfly_frames::{DVec3, Seed, TargetState};

    #[test]
    fn overlaps_are_found_and_bodies_on_a_bridge_are_not() {
        let body = |kind: BodyKind, size_m: DVec3, feet_in_world: DVec3| Body {
            plan: BodyPlan { source: String::new(), kind, size_m, looks: Seed([0; 32]), group: None },
            first_frame: 0,
            states: vec![TargetState { feet_in_world, heading_rad: 0.0, speed_mps: 0.0 }],
        };
        let (person, car) = (DVec3::new(0.5, 0.5, 1.8), DVec3::new(4.0, 2.0, 1.5));
        let bodies = vec![
            body(BodyKind::Pedestrian, person, DVec3::ZERO),
            body(BodyKind::Pedestrian, person, DVec3::new(0.4, 0.0, 0.0)),
            body(BodyKind::Car, car, DVec3::new(2.5, 0.0, 0.0)),
            body(BodyKind::Pedestrian, person, DVec3::new(2.5, 0.0, 5.0)),
        ];
        let traffic = Traffic { dt_s: 0.5, frames: 1, bodies, ..Traffic::default() };
        let found = contacts(&traffic, 0.0);
        assert_eq!(found.iter().map(|contact| contact.bodies).collect::<Vec<_>>(), [[0, 1], [1, 2]]);
        assert!((found[0].depth_m - 0.1).abs() < 1e-12 && (found[1].depth_m - 0.15).abs() < 1e-12, "{found:?}");
        assert_eq!(contacts(&traffic, 0.12).len(), 1);
    }
}
