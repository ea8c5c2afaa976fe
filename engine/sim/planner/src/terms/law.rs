//! The law of every cost term: finite, local, and its gradient is the slope of its cost.

use super::built_in_terms;
use super::term::{CostTerm, TermContext};
use crate::config::muco::MucoConfig;
use crate::config::view::ViewConfig;
use crate::gradient::difference_gradient;
use crate::walk::Walk;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_random::{RandomStream, Seed};
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;

const FRAMES: usize = 24;

fn wandering_track() -> TargetTrack {
    let states = (0..FRAMES)
        .map(|i| TargetState {
            feet_in_world: DVec3::new(0.6 * i as f64, 0.02 * (i * i) as f64, 0.0),
            heading_rad: 0.1 * i as f64,
            speed_mps: 1.3,
        })
        .collect();
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states }
}

fn random_flight(stream: &mut RandomStream, track: &TargetTrack) -> Vec<DVec3> {
    let offset = DVec3::new(stream.uniform(-25.0, 25.0), stream.uniform(-25.0, 25.0), stream.uniform(15.0, 35.0));
    let mut jitter = || stream.uniform(-2.0, 2.0);
    track.states.iter().map(|s| s.feet_in_world + offset + DVec3::new(jitter(), jitter(), jitter())).collect()
}

fn some_boxes() -> Vec<OrientedBox> {
    let block = |x: f64, y: f64, z: f64| OrientedBox {
        center_in_world: DVec3::new(x, y, z),
        half_extents_m: DVec3::new(6.0, 5.0, 12.0),
        yaw_rad: 0.3 * x,
    };
    vec![block(-15.0, 10.0, 12.0), block(14.0, -14.0, 12.0), block(20.0, 24.0, 12.0)]
}

fn with_context(check: impl Fn(&TermContext<'_>, &mut RandomStream)) {
    let (track, view) = (wandering_track(), ViewConfig::default());
    let ground = GroundGrid::sample(&track, &|_, _| 0.0, 50.0);
    let obstacles = LocalObstacles::filter(&track, &some_boxes(), &ground, 45.0, view.safety_influence_m);
    let walk = Walk::of(&track);
    let context = TermContext { track: &track, view: &view, walk: &walk, surroundings: &obstacles };
    check(&context, &mut Seed::of_item(3, "law", "terms").stream("flights"));
}

#[test]
fn every_gradient_is_the_slope_of_its_cost() {
    with_context(|context, stream| {
        for _ in 0..20 {
            let flight = random_flight(stream, context.track);
            for weighted in built_in_terms(&MucoConfig::default().resolved_weights()) {
                let mut exact = vec![DVec3::ZERO; FRAMES];
                if !weighted.term.add_gradient(&flight, context, 1.0, &mut exact) {
                    continue;
                }
                let mut differences = vec![DVec3::ZERO; FRAMES];
                difference_gradient(weighted.term.as_ref(), &flight, context, 1.0, 1e-5, &mut differences);
                for (frame, (a, b)) in exact.iter().zip(&differences).enumerate() {
                    let tolerance = 1e-4 * (1.0 + a.length());
                    assert!((*a - *b).length() < tolerance, "{} frame {frame}: {a} {b}", weighted.term.name());
                }
            }
        }
    });
}

#[test]
fn no_term_reads_beyond_its_support() {
    with_context(|context, stream| {
        let flight = random_flight(stream, context.track);
        let mut moved = flight.clone();
        moved[12] += DVec3::new(1.0, -2.0, 3.0);
        for weighted in built_in_terms(&MucoConfig::default().resolved_weights()) {
            let (mut before, mut after) = (vec![f64::NAN; FRAMES], vec![f64::NAN; FRAMES]);
            weighted.term.cost(&flight, context, &mut before);
            weighted.term.cost(&moved, context, &mut after);
            for frame in 0..FRAMES {
                assert!(before[frame].is_finite() && before[frame] >= 0.0);
                if frame.abs_diff(12) > weighted.term.support() {
                    assert_eq!(before[frame], after[frame], "{} frame {frame}", weighted.term.name());
                }
            }
        }
    });
}

#[test]
fn motion_terms_do_not_depend_on_where_the_origin_is() {
    with_context(|context, stream| {
        let flight = random_flight(stream, context.track);
        let shifted: Vec<DVec3> = flight.iter().map(|w| w + DVec3::new(100.0, -50.0, 7.0)).collect();
        for weighted in built_in_terms(&MucoConfig::default().resolved_weights()) {
            if !["smoothness", "jerk", "length"].contains(&weighted.term.name()) {
                continue;
            }
            let (mut before, mut after) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
            weighted.term.cost(&flight, context, &mut before);
            weighted.term.cost(&shifted, context, &mut after);
            for (a, b) in before.iter().zip(&after) {
                assert!((a - b).abs() < 1e-8, "{}", weighted.term.name());
            }
        }
    });
}

#[test]
fn every_term_takes_flights_of_any_length() {
    with_context(|context, stream| {
        let flight = random_flight(stream, context.track);
        for weighted in built_in_terms(&MucoConfig::default().resolved_weights()) {
            for length in 0..5 {
                let mut costs = vec![f64::NAN; length];
                weighted.term.cost(&flight[..length], context, &mut costs);
                assert!(costs.iter().all(|cost| cost.is_finite()), "{} with {length}", weighted.term.name());
                weighted.term.add_gradient(&flight[..length], context, 1.0, &mut vec![DVec3::ZERO; length]);
            }
        }
    });
}

#[test]
fn the_pitch_cost_is_continuous_at_the_edges_of_its_band() {
    for edge in [30.0, 60.0] {
        let (inside, _) = super::pitch::pitch_cost(edge, 45.0);
        for step in [-1e-9, 1e-9] {
            assert!((super::pitch::pitch_cost(edge + step, 45.0).0 - inside).abs() < 1e-6);
        }
    }
}

/// Half the gradient that residuals add up to must be half the cost's own, wherever the residuals stand for the cost
/// itself. Visibility's do not (its cost is a step function), altitude's leave out the oscillation.
#[test]
fn residuals_have_the_slope_of_their_cost() {
    with_context(|context, stream| {
        for _ in 0..20 {
            let mut flight = random_flight(stream, context.track);
            // A steady climb: nothing oscillates.
            (0..FRAMES).for_each(|i| flight[i].z = flight[0].z + 0.2 * i as f64);
            for weighted in built_in_terms(&MucoConfig::default().resolved_weights()) {
                let mut equations = crate::equations::NormalEquations::default();
                equations.reset(FRAMES);
                let term = weighted.term.as_ref();
                if term.name() == "visibility" || !term.add_residuals(&flight, context, 1.0, &mut equations) {
                    continue;
                }
                let mut exact = vec![DVec3::ZERO; FRAMES];
                assert!(term.add_gradient(&flight, context, 1.0, &mut exact), "{}", term.name());
                for (frame, slope) in exact.iter().enumerate() {
                    let off = (2.0 * equations.slope(frame) - *slope).length();
                    assert!(off <= 1e-9 * (1.0 + slope.length()), "{} at {frame}: {off}", term.name());
                }
            }
        }
    });
}

#[test]
fn visibility_residuals_lead_out_of_shadows() {
    with_context(|context, stream| {
        let mut better = 0;
        for _ in 0..200 {
            let flight = random_flight(stream, context.track);
            let mut equations = crate::equations::NormalEquations::default();
            equations.reset(FRAMES);
            crate::terms::visibility::Visibility.add_residuals(&flight, context, 1.0, &mut equations);
            let mut step = Vec::new();
            equations.solve(1e-3, &mut step);
            for frame in 0..FRAMES {
                if step[frame].length() > 0.1 {
                    let before = context.surroundings.visibility(frame, flight[frame]);
                    let after = context.surroundings.visibility(frame, flight[frame] + step[frame]);
                    better += i32::from(after > before) - i32::from(after < before);
                }
            }
        }
        assert!(better > 20, "{better}");
    });
}
