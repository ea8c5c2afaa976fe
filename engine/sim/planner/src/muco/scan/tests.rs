//! States of nodes against rays cast one by one.

use super::super::lattice::LatticeSize;
use super::*;
use crate::config::view::ViewConfig;
use cosfly_domain::OrientedBox;
use cosfly_frames::TargetTrack;
use cosfly_random::Seed;
use cosfly_surroundings::ground::GroundGrid;

fn one_frame() -> TargetTrack {
    let state = TargetState { feet_in_world: DVec3::new(3.0, -2.0, 1.0), heading_rad: 0.0, speed_mps: 0.0 };
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: vec![state] }
}

fn random_boxes(stream: &mut cosfly_random::RandomStream) -> Vec<OrientedBox> {
    let mut v = |low: f64, high: f64| stream.uniform(low, high);
    (0..10)
        .map(|_| OrientedBox {
            center_in_world: DVec3::new(v(-30.0, 30.0), v(-30.0, 30.0), v(0.0, 25.0)),
            half_extents_m: DVec3::new(v(0.1, 5.0), v(0.1, 5.0), v(0.1, 9.0)),
            yaw_rad: v(-3.0, 3.0),
        })
        .collect()
}

#[test]
fn every_node_agrees_with_rays_and_grown_boxes_at_every_level() {
    let track = one_frame();
    let feet = track.states[0].feet_in_world;
    let ground = GroundGrid::sample(&track, &|_, _| 1.0, 60.0);
    let lattice = Lattice::new(LatticeSize { azimuths: 72, altitudes: 6, radii: 10 }, &ViewConfig::default());
    let mut stream = Seed::of_item(2, "lattice", "rays").stream("boxes");
    let (mut wrong, mut hidden_rays, mut closed, mut nodes) = (0, 0, 0, 0);
    for _ in 0..12 {
        let boxes = random_boxes(&mut stream);
        let obstacles = LocalObstacles::filter(&track, &boxes, &ground, 60.0, 8.0);
        let mut states = vec![0; lattice.nodes()];
        Scanner::new(&lattice, 1.75).evaluate(0, &track.states[0], &obstacles, 1.7, &mut states);
        for level in Level::available() {
            let mut other = vec![0; lattice.nodes()];
            let mut scanner = Scanner::new(&lattice, 1.75).at_level(level);
            scanner.evaluate(0, &track.states[0], &obstacles, 1.7, &mut other);
            assert!(states == other, "{}", level.name());
        }
        for (node, &state) in states.iter().enumerate() {
            let position = feet + lattice.offset(node);
            let dark = |height: f64| {
                let eye = feet + DVec3::Z * height;
                obstacles.still_at(0).any(|solid| solid.meets_segment(eye, position))
            };
            let hidden: u32 = BODY_HEIGHTS.iter().filter(|(height, _)| dark(*height)).map(|(_, count)| count).sum();
            let near = obstacles.nearest(0, position, 1.7).is_some();
            assert!(!near || state == UNSAFE, "node {node} is {:?} away", obstacles.nearest(0, position, 9.0));
            closed += usize::from(state == UNSAFE);
            hidden_rays += usize::from(hidden > 0);
            wrong += usize::from(state != UNSAFE && u32::from(state & !CLOSE) != hidden);
            nodes += 1;
        }
    }
    assert!(hidden_rays > 1000 && closed > 300, "{hidden_rays} {closed}");
    assert!(wrong * 1000 < nodes, "{wrong} of {nodes} nodes differ from rays");
}
