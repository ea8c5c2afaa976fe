//! Tests of goals on a walk past trees, round a corner, with people.

use super::around::surroundings;
use super::claim::{Claim, Hider, Subject};
use super::compose::goals;
use super::course::{Course, CourseData, Hidden, Neighbour, Sample};
use super::plan::{Goal, Grain};
use crate::facts::Wear;
use crate::sight::Landmarks;
use cosfly_claims::Language;
use cosfly_domain::{BodyKind, Colour, Obstacle, ObstacleKind, OrientedBox, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec3, TargetState, real};
use cosfly_random::Seed;
use std::collections::BTreeSet;

fn tree(object_id: u32, x: f64, y: f64) -> Obstacle {
    let shape =
        OrientedBox { center_in_world: DVec3::new(x, y, 1.5), half_extents_m: DVec3::new(0.2, 0.2, 1.5), yaw_rad: 0.0 };
    Obstacle { shape, kind: ObstacleKind::TreeTrunk, object_id, synthetic: false }
}

/// Three trees on the left of a walk east.
fn town() -> Landmarks {
    Landmarks::among(&[tree(1, 6.0, -3.0), tree(2, 14.0, -3.0), tree(3, 22.0, -3.0)], &[])
}

/// East for 30 m, then 4 s still, then south for 24 m.
fn states() -> Vec<TargetState> {
    let mut states = vec![];
    let mut feet = DVec3::ZERO;
    for (yaw_deg, speed_mps, frames) in [(0.0_f64, 1.2, 50), (0.0, 0.0, 8), (90.0, 1.2, 40)] {
        let (sin, cos) = real::sin_cos(yaw_deg.to_radians());
        for _ in 0..frames {
            feet += 0.5 * speed_mps * DVec3::new(cos, sin, 0.0);
            states.push(TargetState { feet_in_world: feet, heading_rad: yaw_deg.to_radians(), speed_mps });
        }
    }
    states
}

fn wear(top: Colour) -> Wear {
    Wear { top, trousers: Colour::Black, backpack: false }
}

fn flight(states: &[TargetState]) -> CourseData<'_> {
    let beside = |frame: usize| Sample {
        frame,
        state: TargetState { feet_in_world: states[frame].feet_in_world + DVec3::new(0.0, 1.0, 0.0), ..states[frame] },
        is_clear: true,
    };
    CourseData {
        dt_s: 0.5,
        kind: BodyKind::Pedestrian,
        states,
        distance_m: vec![15.2; states.len()],
        is_clear: vec![true; states.len()],
        wear: wear(Colour::Grey),
        hidden: vec![Hidden { frames: 70..76, behind: Some(9), is_outside: false, is_whole: true }],
        hiders: vec![(9, Hider::Body(BodyKind::Van))],
        vehicles: vec![],
        neighbours: vec![Neighbour { wear: wear(Colour::Red), samples: (0..states.len()).map(beside).collect() }],
    }
}

fn all(seed: u64) -> Vec<Goal> {
    let states = states();
    let (flight, town) = (flight(&states), town());
    goals(&Course::of(&flight, &town), &Seed::of_item(seed, "goals", "a"))
}

#[test]
fn a_walk_is_cut_at_its_moves_and_says_what_is_on_the_way() {
    let states = states();
    let (flight, town) = (flight(&states), town());
    let course = Course::of(&flight, &town);
    let names = |claims: Vec<super::claim::Said>| -> Vec<String> { claims.iter().map(ToString::to_string).collect() };
    assert_eq!(names(course.moves(&(0..98))), ["stops 4 @ 50..58", "turns right @ 58..59"]);
    assert_eq!(names(surroundings(&course, &(0..48))), ["passes tree left 3 @ 0..48", "walks_with 1 @ 0..48"]);
    assert_eq!(names(course.sights(&(0..98))), ["lost van 3 found @ 70..76"]);
    // At the border of the frames nobody could say whether the last tree counts.
    assert_eq!(names(surroundings(&course, &(0..37))), ["walks_with 1 @ 0..37"]);
    assert_eq!(names(course.quiet(&(0..40)).into_iter().collect()), ["no_turn @ 0..40"]);
}

#[test]
fn crossings_are_told_whole_and_the_only_one_begins_a_count() {
    let states = states();
    let crossing = |x: f64| WalkablePolygon {
        kind: WalkableKind::Crossing,
        outline_in_world: [(x, -2.0), (x + 7.0, -2.0), (x + 7.0, 2.0), (x, 2.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0))
            .to_vec(),
        synthetic: false,
    };
    let trees = [tree(1, 6.0, -3.0), tree(2, 14.0, -3.0), tree(3, 22.0, -3.0)];
    let told = |ground: &[WalkablePolygon]| -> Vec<String> {
        let (flight, town) = (flight(&states), Landmarks::among(&trees, ground));
        let all = surroundings(&Course::of(&flight, &town), &(0..48));
        all.iter().map(ToString::to_string).filter(|it| it.contains("cross")).collect()
    };
    assert_eq!(told(&[crossing(4.0)]), ["crosses @ 6..18", "passes tree left 2 after_crossing @ 18..48"]);
    assert_eq!(told(&[crossing(4.0), crossing(16.0)]), ["crosses @ 6..18", "crosses @ 26..38"]);
    // Already on it in the first frame: nobody sees the target step onto it.
    assert!(told(&[crossing(-2.0)]).is_empty());
}

#[test]
fn who_passes_is_told_by_the_way_it_goes() {
    let states = states();
    let drive = |from_m: f64, speed_mps: f64| -> Vec<Sample> {
        let heading_rad = if speed_mps < 0.0 { std::f64::consts::PI } else { 0.0 };
        let at = |frame: usize| TargetState {
            feet_in_world: DVec3::new(from_m + 0.5 * speed_mps * frame as f64, 2.5, 0.0),
            heading_rad,
            speed_mps: speed_mps.abs(),
        };
        (0..48).map(|frame| Sample { frame, state: at(frame), is_clear: true }).collect()
    };
    let neighbours = vec![Neighbour { wear: wear(Colour::Green), samples: drive(9.1, 0.5) }];
    let vehicles = vec![(BodyKind::Bus, drive(60.0, -4.0)), (BodyKind::Bicycle, drive(-30.0, 4.0))];
    let (flight, town) = (CourseData { neighbours, vehicles, ..flight(&states) }, Landmarks::default());
    let told: Vec<String> =
        surroundings(&Course::of(&flight, &town), &(0..48)).iter().map(ToString::to_string).collect();
    assert_eq!(told, ["overtaken_by bicycle @ 21..23", "meets_vehicle bus @ 22..24", "overtakes green @ 24..26"]);
}

#[test]
fn goals_have_every_grain_in_both_languages_and_depend_on_the_seed_alone() {
    let goals = all(1);
    for grain in Grain::ALL {
        for language in Language::ALL.iter().copied() {
            let of_kind = goals.iter().filter(|it| it.grain == grain && it.language == language);
            assert!(of_kind.count() >= 2, "{grain:?} {language:?}");
        }
    }
    assert_eq!(goals, all(1));
    assert_ne!(goals, all(2));
    for goal in &goals {
        let slots = ['[', ']', '{', '}'];
        assert!(goal.lines.iter().all(|line| !line.is_empty() && !line.contains(slots)), "{:?}", goal.lines);
        assert_eq!(goal.lines.len(), if goal.grain == Grain::Dialogue { 3 } else { 1 });
        assert_eq!(goal.wrong.is_some(), matches!(goal.grain, Grain::Dialogue | Grain::Negative));
    }
}

#[test]
fn a_goal_that_does_not_fit_differs_from_a_true_one_in_one_claim() {
    for seed in 0..30 {
        let goals = all(seed);
        let true_claims: Vec<&Claim> =
            goals.iter().filter(|it| it.wrong.is_none()).flat_map(|it| &it.said).map(|it| &it.claim).collect();
        for goal in goals.iter().filter(|it| it.grain == Grain::Negative) {
            let strange: Vec<Subject> =
                goal.said.iter().filter(|it| !true_claims.contains(&&it.claim)).map(|it| it.claim.subject()).collect();
            assert_eq!(strange, goal.wrong.into_iter().collect::<Vec<_>>(), "{:?}", goal.lines);
        }
    }
}

#[test]
fn hundreds_of_seeds_give_hundreds_of_different_goals() {
    let texts: BTreeSet<Vec<String>> = (0..60).flat_map(all).map(|goal| goal.lines).collect();
    assert!(texts.len() > 1000, "{}", texts.len());
}

#[test]
fn a_flight_of_one_frame_and_one_without_people_have_goals_without_a_panic() {
    let states = states();
    for count in [1, 3, 7] {
        let states = &states[..count];
        let flight = CourseData { hidden: vec![], neighbours: vec![], ..flight(states) };
        for goal in goals(&Course::of(&flight, &Landmarks::default()), &Seed::of_item(1, "goals", "a")) {
            assert!(goal.frames.end <= count);
        }
    }
}

#[test]
fn what_is_said_depends_on_times_and_not_on_numbers_of_frames() {
    const FINER: usize = 5;
    let coarse = states();
    let fine: Vec<TargetState> = (0..coarse.len() * FINER)
        .map(|frame| {
            let (at, before) = (coarse[frame / FINER], coarse[(frame / FINER).saturating_sub(1)]);
            let share = (frame % FINER + 1) as f64 / FINER as f64;
            TargetState { feet_in_world: before.feet_in_world.lerp(at.feet_in_world, share), ..at }
        })
        .collect();
    let partly =
        |frames: std::ops::Range<usize>| Hidden { frames, behind: Some(9), is_outside: false, is_whole: false };
    let (mut of_coarse, mut of_fine) = (flight(&coarse), CourseData { dt_s: 0.1, ..flight(&fine) });
    // Partly hidden for a second, and for half of one.
    of_coarse.hidden = vec![partly(20..22), partly(30..31)];
    of_fine.hidden = vec![partly(100..110), partly(150..155)];
    let town = town();
    let told = |course: &Course<'_>, scale: usize| -> Vec<Vec<String>> {
        let frames = |from: usize, to: usize| scale * from..scale * to;
        let claims = |said: Vec<super::claim::Said>| said.into_iter().map(|it| format!("{:?}", it.claim)).collect();
        vec![
            claims(course.sights(&frames(0, 98))),
            claims(surroundings(course, &frames(0, 48))),
            claims(surroundings(course, &frames(0, 37))),
            claims(surroundings(course, &frames(0, 5))),
        ]
    };
    let expected = told(&Course::of(&of_coarse, &town), 1);
    assert_eq!(expected[0], ["PartlyHidden(Body(Van))"]);
    assert_eq!(told(&Course::of(&of_fine, &town), FINER), expected);
}

#[test]
fn a_runner_runs_unless_company_slows_it_to_a_walk() {
    let (slow, town) = (states(), town());
    let faster = |state: TargetState| TargetState {
        feet_in_world: 2.0 * state.feet_in_world,
        speed_mps: 2.0 * state.speed_mps,
        ..state
    };
    let fast: Vec<TargetState> = slow.iter().copied().map(faster).collect();
    let texts = |kind: BodyKind, states: &[TargetState]| -> String {
        let flight = CourseData { kind, ..flight(states) };
        let course = Course::of(&flight, &town);
        let all = (0..20).flat_map(|seed| goals(&course, &Seed::of_item(seed, "goals", "a")));
        all.flat_map(|goal| goal.lines).collect::<Vec<_>>().join("\n")
    };
    for walks in [texts(BodyKind::Pedestrian, &slow), texts(BodyKind::Runner, &slow)] {
        assert!(walks.contains("walk") && !walks.contains(" run") && !walks.contains('跑'), "{walks}");
    }
    let runs = texts(BodyKind::Runner, &fast);
    assert!(!runs.contains("walk") && runs.contains("run") && runs.contains('跑'));
}
