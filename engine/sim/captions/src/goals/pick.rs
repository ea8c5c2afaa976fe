//! Choice of what goals of whole flights, dialogues and goals that do not fit say.

use super::around::surroundings;
use super::claim::{Claim, Passed, Said, Subject};
use super::course::{Course, Neighbour};
use super::plan::{Grain, Plan, mirrored, other_side};
use crate::facts::Wear;
use cosfly_domain::{BodyKind, Colour};
use cosfly_random::RandomStream;

/// Goals of a whole flight, dialogues, and goals that do not fit.
const FLIGHTS: usize = 3;
const DIALOGUES: usize = 2;
const NEGATIVES: usize = 3;
/// More turns are counted instead of told.
const TOLD_TURNS: usize = 2;
/// Time between turns that nobody takes for one, seconds.
const APART_S: f64 = 20.0;
/// Draws after which there is no further goal.
const MOST_DRAWS: usize = 40;

/// Goals of the whole flight that differ in what they say; none where there is nothing to say but clothes and distance.
pub(super) fn flights(course: &Course<'_>, words: &mut RandomStream) -> Vec<Plan> {
    let mut plans: Vec<Plan> = vec![];
    for _ in 0..MOST_DRAWS {
        let plan = flight(course, words);
        let says_way = plan.said.len() > 2;
        if says_way && plans.len() < FLIGHTS && plans.iter().all(|it| it.said != plan.said) {
            plans.push(plan);
        }
    }
    plans
}

fn flight(course: &Course<'_>, words: &mut RandomStream) -> Plan {
    let frames = 0..course.len();
    let mut told = vec![];
    let turns = course.turns.sure.len();
    let moves = course.moves(&frames);
    let is_turn = |it: &&Said| matches!(it.claim, Claim::Turns(_));
    match turns {
        0 => told.extend(course.quiet(&frames).filter(|_| course.stops.is_empty() || words.index(2) == 0)),
        few if few <= TOLD_TURNS => told.extend(moves.iter().filter(is_turn).cloned()),
        // Nobody counts turns of which some are doubtful.
        count if course.turns.doubtful.is_empty() => {
            told.push(Said { claim: Claim::TurnsInAll(count), frames: frames.clone() });
        }
        _ => {}
    }
    let mut more: Vec<Said> = moves.into_iter().filter(|it| matches!(it.claim, Claim::Stops(_))).collect();
    more.extend(course.sights(&frames));
    if course.walks {
        more.extend(surroundings(course, &frames));
    }
    for _ in 0..2 {
        if told.len() < 3 && !more.is_empty() {
            let one = more.swap_remove(words.index(more.len()));
            // Nobody tells two things of one kind in the same words.
            more.retain(|it| std::mem::discriminant(&it.claim) != std::mem::discriminant(&one.claim));
            told.push(one);
        }
    }
    told.sort_by_key(|it| (it.frames.start, it.frames.end));
    let mut said = vec![course.clothes()];
    said.extend(told);
    said.push(course.distance(&frames));
    Plan { grain: Grain::Flight, frames, said, wrong: None, mistaken: None, is_other_of_two: false }
}

/// Dialogues: about one of several people where the flight shows several, about the way, about the distance.
pub(super) fn dialogues(course: &Course<'_>, words: &mut RandomStream) -> Vec<Plan> {
    let mut plans: Vec<Plan> = about_clothes(course, words).into_iter().collect();
    plans.extend(about_turn(course, words));
    plans.extend(about_distance(course, words));
    plans.truncate(DIALOGUES);
    plans
}

/// In a frame that shows the target and somebody in other clothes clearly, and nobody else like either.
fn about_clothes(course: &Course<'_>, words: &mut RandomStream) -> Option<Plan> {
    let own = course.flight.wear;
    let seen_in = |frame: usize| -> Vec<&Neighbour> {
        let is_seen = |it: &&Neighbour| it.samples.binary_search_by_key(&frame, |sample| sample.frame).is_ok();
        course.flight.neighbours.iter().filter(is_seen).collect()
    };
    let mut fitting = vec![];
    for frame in (0..course.len()).filter(|frame| course.flight.is_clear[*frame]) {
        let seen = seen_in(frame);
        let is_single = seen.iter().all(|it| (it.wear.top, it.wear.trousers) != (own.top, own.trousers));
        let other = seen.iter().find(|it| {
            let is_clear = it.samples.iter().any(|sample| sample.frame == frame && sample.is_clear);
            is_clear && it.wear.top != own.top && seen.iter().filter(|same| same.wear.top == it.wear.top).count() == 1
        });
        fitting.extend(other.filter(|_| is_single).map(|other| (frame, other.wear, seen.len() == 1)));
    }
    let (frame, other, is_other_of_two) = *fitting.get(words.index(fitting.len().max(1)))?;
    let said = Said { claim: Claim::Wears(own), frames: frame..frame + 1 };
    Some(Plan {
        grain: Grain::Dialogue,
        frames: frame..frame + 1,
        said: vec![said],
        wrong: Some(Subject::Clothes),
        mistaken: Some(Claim::Wears(other)),
        is_other_of_two,
    })
}

fn about_turn(course: &Course<'_>, words: &mut RandomStream) -> Option<Plan> {
    let all = super::steps::steps(course, words);
    let with_turn: Vec<(&Plan, &Said, Claim)> = all
        .iter()
        .filter_map(|plan| {
            plan.said.iter().find_map(|said| match said.claim {
                Claim::Turns(kind) => mirrored(kind).map(|other| (plan, said, Claim::Turns(other))),
                _ => None,
            })
        })
        .collect();
    let (plan, said, mistaken) = with_turn.get(words.index(with_turn.len().max(1)))?.clone();
    Some(Plan {
        grain: Grain::Dialogue,
        frames: plan.frames.clone(),
        said: vec![course.clothes(), said.clone()],
        wrong: Some(Subject::Turn),
        mistaken: Some(mistaken),
        is_other_of_two: false,
    })
}

fn about_distance(course: &Course<'_>, words: &mut RandomStream) -> Option<Plan> {
    let frames = 0..course.len();
    let distance = course.distance(&frames);
    let Claim::Distance(metres) = distance.claim else { return None };
    Some(Plan {
        grain: Grain::Dialogue,
        frames,
        said: vec![course.clothes(), distance],
        wrong: Some(Subject::Distance),
        mistaken: Some(Claim::Distance(wrong_metres(metres, words))),
        is_other_of_two: false,
    })
}

/// Another distance that nobody would take for the true one.
fn wrong_metres(metres: u32, words: &mut RandomStream) -> u32 {
    let step = metres / 2 + 4 + words.index(4) as u32;
    if metres > 2 * step && words.index(2) == 0 { metres - step } else { metres + step }
}

/// Goals with one false claim, each about another subject.
pub(super) fn negatives(course: &Course<'_>, plans: &[Plan], words: &mut RandomStream) -> Vec<Plan> {
    let mut found: Vec<Plan> = vec![];
    let grounds: Vec<&Plan> = plans.iter().filter(|it| matches!(it.grain, Grain::Flight | Grain::Step)).collect();
    for _ in 0..MOST_DRAWS {
        if grounds.is_empty() || found.len() == NEGATIVES {
            break;
        }
        let ground = grounds[words.index(grounds.len())];
        let at = words.index(ground.said.len());
        let Some(claim) = falsified(course, ground, &ground.said[at], words) else { continue };
        let wrong = claim.subject();
        if found.iter().any(|it| it.wrong == Some(wrong)) {
            continue;
        }
        let mut said = ground.said.clone();
        said[at].claim = claim;
        found.push(Plan { grain: Grain::Negative, said, wrong: Some(wrong), ..ground.clone() });
    }
    found
}

/// A claim in the place of a true one that is certainly false in the same frames.
fn falsified(course: &Course<'_>, ground: &Plan, said: &Said, words: &mut RandomStream) -> Option<Claim> {
    Some(match &said.claim {
        Claim::Wears(wear) => {
            let others: Vec<Colour> =
                Colour::ALL.into_iter().filter(|it| *it != wear.top && *it != wear.trousers).collect();
            Claim::Wears(Wear { top: others[words.index(others.len())], ..*wear })
        }
        Claim::Distance(metres) => Claim::Distance(wrong_metres(*metres, words)),
        Claim::Turns(kind) => {
            let other = mirrored(*kind)?;
            let mut all = course.turns.sure.iter().chain(&course.turns.doubtful);
            // Of two turns in a row, people may see one, to the side of both together.
            let is_in_a_row = |away: usize| away > 0 && (away as f64) < APART_S / course.flight.dt_s;
            let may_be_other = all.any(|it| {
                let is_there = ground.frames.contains(&(it.frame as usize)) && it.kind != *kind;
                is_there || is_in_a_row((it.frame as usize).abs_diff(said.frames.start))
            });
            if may_be_other || course.leads(said.frames.start, other) {
                return None;
            }
            Claim::Turns(other)
        }
        Claim::TurnsInAll(count) => Claim::TurnsInAll(count + 2),
        Claim::Stops(seconds) => Claim::Stops(unlike(2 * seconds + 5, &pauses_s(course))?),
        Claim::Passes(passed) if words.index(2) == 0 && passed.count <= 4 => {
            Claim::Passes(Passed { count: passed.count + 2, ..*passed })
        }
        Claim::Passes(passed) => {
            let other = Passed { side: other_side(passed.side), ..*passed };
            let is_free = super::passing::is_free(course, &said.frames, other.kind, other.side);
            return is_free.then_some(Claim::Passes(other));
        }
        Claim::Lost { behind, seconds, found: true } => {
            Claim::Lost { behind: *behind, seconds: unlike(2 * seconds + 5, &losses_s(course))?, found: true }
        }
        Claim::WalksWith(count) if *count <= 4 => Claim::WalksWith(count + 2),
        Claim::Meets(_) => Claim::Meets(worn_by_nobody(course, words)?),
        Claim::Overtakes(_) => Claim::Overtakes(worn_by_nobody(course, words)?),
        Claim::MeetsVehicle(_) => Claim::MeetsVehicle(not_there(course, words)?),
        Claim::OvertakenBy(_) => Claim::OvertakenBy(not_there(course, words)?),
        _ => return None,
    })
}

/// Colour of a top that no one else in the flight wears.
fn worn_by_nobody(course: &Course<'_>, words: &mut RandomStream) -> Option<Colour> {
    let is_free = |colour: &Colour| course.flight.neighbours.iter().all(|it| it.wear.top != *colour);
    let free: Vec<Colour> = Colour::ALL.into_iter().filter(is_free).collect();
    free.get(words.index(free.len().max(1))).copied()
}

/// Kind of vehicle that the flight does not show.
fn not_there(course: &Course<'_>, words: &mut RandomStream) -> Option<BodyKind> {
    let kinds = [BodyKind::Bicycle, BodyKind::Motorcycle, BodyKind::Car, BodyKind::Truck, BodyKind::Bus];
    let is_free = |kind: &BodyKind| course.flight.vehicles.iter().all(|it| it.0 != *kind);
    let free: Vec<BodyKind> = kinds.into_iter().filter(is_free).collect();
    free.get(words.index(free.len().max(1))).copied()
}

/// A time that is not near any of the true ones.
fn unlike(seconds: u32, times_s: &[f64]) -> Option<u32> {
    times_s.iter().all(|it| (it - f64::from(seconds)).abs() > 3.0).then_some(seconds)
}

fn pauses_s(course: &Course<'_>) -> Vec<f64> {
    course.stops.iter().map(|it| it.len() as f64 * course.flight.dt_s).collect()
}

fn losses_s(course: &Course<'_>) -> Vec<f64> {
    course.flight.hidden.iter().map(|it| it.frames.len() as f64 * course.flight.dt_s).collect()
}
