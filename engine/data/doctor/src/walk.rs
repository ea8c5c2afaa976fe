//! Facts of a flight that texts are judged by, from plain definitions of its own. Nothing here is shared with what writes texts.
//!
//! The way turns in a frame by the angle between two chords: from the last place before it that is 3 m away as the crow flies, and to
//! the first such place behind it; and the same with 5 m. What is clear by both chords is a turn; what one of them hints at may be one.

use cosfly_captions::{Compass, Facts, LeftOut, TargetStop, Turn, TurnKind, Wear};
use cosfly_episodes::ExaminedEpisode;
use cosfly_frames::{DVec2, DVec3, real};

/// Lengths of the chords, metres.
const CHORDS_M: [f64; 2] = [3.0, 5.0];
/// A turn by both chords, and a hint of one by either, degrees.
const CLEAR_DEG: [f64; 2] = [30.0, 47.0];
const HINT_DEG: f64 = 41.0;
/// Sharper than the first is no mere turn to a side; from the second on the way may lead back, from the third it does, degrees.
const SHARP_DEG: f64 = 125.0;
const MAY_LEAD_BACK_DEG: f64 = 100.0;
const LEADS_BACK_DEG: f64 = 160.0;
/// Way and time within which the way leads back, metres and seconds.
const BACK_M: f64 = 3.0;
const BACK_S: f64 = 6.0;
/// A longer bend may be several turns, one in each such way, metres.
const LONG_M: f64 = 13.0;
const APART_M: f64 = 4.0;
const MOST_TURNS: f64 = 6.0;
/// Nearer to the ends of the walk nothing is clear, metres.
const END_M: f64 = 3.0;
/// A chord that the walk is too short for has this length at least, metres.
const SHORT_M: f64 = 1.0;
/// Least way between places, metres.
const STEP_M: f64 = 0.02;
/// A way is straight where all of it goes within this angle of the whole, degrees.
const STRAIGHT_DEG: f64 = 30.0;
/// Slower is standing, m/s; shorter is no stop, seconds; a way that is shorter and slower is no walk, metres and m/s.
const STANDING_MPS: f64 = 0.05;
const STOP_S: f64 = 1.0;
const WALK_M: f64 = 1.0;
const WALK_MPS: f64 = 0.5;

/// Facts of a flight; none where the target is unknown in some frames.
pub fn facts_of(episode: &ExaminedEpisode) -> Option<Facts> {
    if let Some(facts) = episode.whole.as_ref().and_then(|whole| facts_of(whole)) {
        return Some(facts);
    }
    let moments = &episode.moments;
    let feet: Vec<DVec3> = (moments.iter())
        .map(|it| it.target_in_world.map(|middle| middle - DVec3::Z * (0.5 * episode.target_height_m)))
        .collect::<Option<_>>()?;
    let stands: Vec<bool> = (moments.iter())
        .map(|it| it.heading_and_speed.map(|(_, speed_mps)| speed_mps < STANDING_MPS))
        .collect::<Option<_>>()?;
    let facing_rad = moments.first()?.heading_and_speed?.0;
    let steps_m: Vec<f64> = feet.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let way_m: f64 = steps_m.iter().sum();
    let duration_s = episode.dt_s * (feet.len() - 1) as f64;
    let walks = way_m >= WALK_M || way_m > 0.0 && way_m >= WALK_MPS * duration_s;
    let walk = Walk::of(&feet, episode.dt_s);
    let (turns, doubtful_turns) = if walks { walk.turns() } else { (vec![], vec![]) };
    let walking_s = episode.dt_s * stands.iter().skip(1).filter(|stands| !**stands).count() as f64;
    let mean = |value: &dyn Fn(usize) -> f64| (0..feet.len()).map(value).sum::<f64>() / feet.len() as f64;
    let distance_m = |frame: usize| moments[frame].drone.position_in_world.distance(feet[frame]);
    let pitch_down_deg = |frame: usize| -moments[frame].drone.pitch_rad.to_degrees();
    let altitude_m = |frame: usize| moments[frame].drone.position_in_world.z - feet[frame].z;
    // Three standard errors of a mean over frames that stand for those which are left out; more of few frames, much as Student's t.
    let count = feet.len() as f64;
    let error = |value: &dyn Fn(usize) -> f64| {
        let middle = mean(value);
        let variance = mean(&|frame| (value(frame) - middle).powi(2)) * count / (count - 1.0).max(1.0);
        3.0 * (1.0 + 6.0 / count) * (variance / count).sqrt()
    };
    let left_out = episode.is_part.then(|| LeftOut {
        time_s: episode.dt_s,
        distance_m: error(&distance_m),
        pitch_deg: error(&pitch_down_deg),
        altitude_m: error(&altitude_m),
    });
    Some(Facts {
        walks,
        start_direction: Compass::of_yaw_rad(walk.ahead_rad(0, CHORDS_M[0]).unwrap_or(facing_rad)),
        end_direction: Compass::of_yaw_rad(walk.behind_rad(walk.last(), CHORDS_M[0]).unwrap_or(facing_rad)),
        turns,
        doubtful_turns,
        bends: walks && walk.bends(),
        dt_s: episode.dt_s,
        stops: if walks { stops(&stands, episode.dt_s) } else { vec![] },
        duration_s,
        way_m,
        walking_speed_mps: if walks && walking_s > 0.0 { way_m / walking_s } else { 0.0 },
        distance_m: mean(&distance_m),
        pitch_down_deg: mean(&pitch_down_deg),
        altitude_m: mean(&altitude_m),
        visibility: mean(&|frame| moments[frame].visible.unwrap_or_default()),
        wear: episode.clothes.map(|(top, trousers, backpack)| Wear { top, trousers, backpack }),
        is_runner: episode.is_runner,
        left_out,
    })
}

fn stops(stands: &[bool], dt_s: f64) -> Vec<TargetStop> {
    let mut stops: Vec<TargetStop> = vec![];
    for frame in (0..stands.len()).filter(|frame| stands[*frame]) {
        match stops.last_mut().filter(|_| frame > 0 && stands[frame - 1]) {
            Some(stop) => stop.duration_s += dt_s,
            None => stops.push(TargetStop { frame: frame as u32, duration_s: dt_s }),
        }
    }
    stops.retain(|stop| stop.duration_s >= STOP_S - 1e-6);
    stops
}

/// Places of the feet on the ground, without those at which the target stays.
#[derive(Default)]
struct Walk {
    feet: Vec<DVec2>,
    /// Last frame at each place.
    frames: Vec<usize>,
    /// Time of walking up to each place, seconds.
    walked_s: Vec<f64>,
}

impl Walk {
    fn of(feet: &[DVec3], dt_s: f64) -> Self {
        let (mut walk, mut walked_s) = (Self::default(), 0.0);
        for (frame, point) in feet.iter().enumerate() {
            let step_m = if frame > 0 { feet[frame - 1].distance(*point) } else { 0.0 };
            walked_s += if step_m >= STANDING_MPS * dt_s { dt_s } else { 0.0 };
            if walk.feet.last().is_none_or(|last| last.distance(point.truncate()) >= STEP_M) {
                walk.feet.push(point.truncate());
                walk.frames.push(frame);
                walk.walked_s.push(walked_s);
            }
            if let Some(last) = walk.frames.last_mut() {
                *last = frame;
            }
        }
        walk
    }

    fn last(&self) -> usize {
        self.feet.len() - 1
    }

    /// Direction from a place to the first later one so far away, or to the end, radians.
    fn ahead_rad(&self, place: usize, chord_m: f64) -> Option<f64> {
        self.chord(place, self.feet[place..].iter(), chord_m).map(|way| real::atan2(way.y, way.x))
    }

    /// Direction to a place from the last earlier one so far away, or from the start, radians.
    fn behind_rad(&self, place: usize, chord_m: f64) -> Option<f64> {
        self.chord(place, self.feet[..=place].iter().rev(), chord_m).map(|way| real::atan2(-way.y, -way.x))
    }

    fn chord<'a>(&self, place: usize, places: impl Iterator<Item = &'a DVec2>, chord_m: f64) -> Option<DVec2> {
        let here = self.feet[place];
        let mut way = DVec2::ZERO;
        for place in places {
            way = *place - here;
            if way.length() >= chord_m {
                return Some(way);
            }
        }
        (way.length() >= SHORT_M).then_some(way)
    }

    /// Angles between the chords at a place, degrees; positive to the right.
    fn angles_deg(&self, place: usize) -> [f64; 2] {
        CHORDS_M.map(|chord_m| self.angle_deg(place, place, chord_m))
    }

    fn angle_deg(&self, from: usize, to: usize, chord_m: f64) -> f64 {
        let [before, after] = [self.behind_rad(from, chord_m), self.ahead_rad(to, chord_m)];
        before.zip(after).map_or(0.0, |(before, after)| real::wrap_angle_rad(after - before).to_degrees())
    }

    fn way_m(&self, from: usize, to: usize) -> f64 {
        self.feet[from..=to].windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    fn bends(&self) -> bool {
        let whole = self.feet[self.last()] - self.feet[0];
        let whole_rad = real::atan2(whole.y, whole.x);
        let leaves = |place: usize| {
            let ahead = self.ahead_rad(place, CHORDS_M[0]);
            ahead.is_some_and(|it| real::wrap_angle_rad(it - whole_rad).to_degrees().abs() > STRAIGHT_DEG)
        };
        (0..self.feet.len()).any(leaves)
    }

    /// Turns that are clear, and those that may be some, in order.
    fn turns(&self) -> (Vec<Turn>, Vec<Turn>) {
        let (mut clear, mut doubtful) = (vec![], vec![]);
        for bend in self.hints() {
            let most = bend.iter().flat_map(|(_, angles)| angles).fold(0.0, |most: f64, it| most.max(it.abs()));
            let ends = [bend[0].0, bend[bend.len() - 1].0];
            let sharpest = bend.iter().max_by(|a, b| sum_deg(&a.1).abs().total_cmp(&sum_deg(&b.1).abs()));
            let (place, angles) = *sharpest.unwrap_or(&bend[0]);
            let turn = |kind| Turn { frame: self.frames[place] as u32, angle_deg: 0.5 * sum_deg(&angles), kind };
            let is_inside = self.way_m(0, place).min(self.way_m(place, self.last())) >= END_M;
            let length_m = self.way_m(ends[0], ends[1]);
            let back_deg = self.back_deg(ends);
            let is_clear = angles.iter().zip(CLEAR_DEG).all(|(it, least)| it.abs() >= least)
                && most <= SHARP_DEG
                && length_m <= LONG_M;
            let side = if sum_deg(&angles) > 0.0 { TurnKind::Right } else { TurnKind::Left };
            match () {
                () if is_inside && back_deg >= LEADS_BACK_DEG => clear.push(turn(TurnKind::Around)),
                () if is_inside && is_clear => clear.push(turn(side)),
                () => {
                    let sides = [(TurnKind::Left, -1.0), (TurnKind::Right, 1.0)]
                        .into_iter()
                        .filter(|(_, sign)| bend.iter().flat_map(|(_, angles)| angles).any(|it| sign * it >= HINT_DEG));
                    let mut kinds: Vec<TurnKind> = sides.map(|(kind, _)| kind).collect();
                    kinds.extend((most.max(back_deg) >= MAY_LEAD_BACK_DEG).then_some(TurnKind::Around));
                    let times = (length_m / APART_M).round().clamp(1.0, MOST_TURNS) as usize;
                    doubtful.extend(std::iter::repeat_n(kinds, times).flatten().map(turn));
                }
            }
        }
        (clear, doubtful)
    }

    /// Runs of places with hints of a turn to one side, each place with its angles.
    fn hints(&self) -> Vec<Vec<(usize, [f64; 2])>> {
        let mut runs: Vec<Vec<(usize, [f64; 2])>> = vec![];
        for place in 0..self.feet.len() {
            let angles = self.angles_deg(place);
            if angles.iter().all(|it| it.abs() < HINT_DEG) {
                continue;
            }
            let goes_on = |run: &&mut Vec<(usize, [f64; 2])>| {
                let (last, before) = run[run.len() - 1];
                let is_back = [&before, &angles].into_iter().flatten().any(|it| it.abs() > SHARP_DEG);
                last + 1 == place && (is_back || sum_deg(&before) * sum_deg(&angles) > 0.0)
            };
            match runs.last_mut().filter(goes_on) {
                Some(run) => run.push((place, angles)),
                None => runs.push(vec![(place, angles)]),
            }
        }
        runs
    }

    /// Largest change of direction over at most [`BACK_M`] and [`BACK_S`] between two places, degrees.
    fn back_deg(&self, [first, last]: [usize; 2]) -> f64 {
        let mut most = 0.0_f64;
        for from in first..=last {
            let is_near =
                |to: &usize| self.way_m(from, *to) <= BACK_M && self.walked_s[*to] - self.walked_s[from] <= BACK_S;
            for to in (from..=last).take_while(is_near) {
                most = most.max(self.angle_deg(from, to, CHORDS_M[0]).abs());
            }
        }
        most
    }
}

fn sum_deg(angles: &[f64; 2]) -> f64 {
    angles[0] + angles[1]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use TurnKind::{Around, Left, Right};
    use cosfly_episodes::ExaminedMoment;
    use cosfly_frames::Pose;

    /// Places of a walk in steps of 0.6 m through the yaws (degrees), so many metres each.
    fn places(legs: &[(f64, f64)]) -> Vec<DVec3> {
        let mut feet = vec![DVec3::ZERO];
        for &(yaw_deg, length_m) in legs {
            let (sin, cos) = real::sin_cos(f64::to_radians(yaw_deg));
            for _ in 0..(length_m / 0.6_f64).round() as usize {
                feet.push(feet[feet.len() - 1] + 0.6 * DVec3::new(cos, sin, 0.0));
            }
        }
        feet
    }

    fn walk(legs: &[(f64, f64)]) -> Walk {
        Walk::of(&places(legs), 0.5)
    }

    /// A flight 28 m behind and above a walk, with one instruction.
    pub(crate) fn episode(legs: &[(f64, f64)], text: &str) -> ExaminedEpisode {
        let moment = |(frame, feet): (usize, &DVec3)| {
            let drone = Pose::looking_at(*feet + DVec3::new(-20.0, 0.0, 20.0), *feet);
            ExaminedMoment {
                time_s: 0.5 * frame as f64,
                drone,
                camera: drone,
                next_in_world: None,
                turn_deg: None,
                target_in_world: Some(*feet + 0.85 * DVec3::Z),
                heading_and_speed: Some((0.0, 1.2)),
                in_image: None,
                visible_box: None,
                visible: Some(1.0),
                clearance_m: None,
            }
        };
        ExaminedEpisode {
            id: "a".to_owned(),
            dt_s: 0.5,
            target_height_m: 1.7,
            moments: places(legs).iter().enumerate().map(moment).collect(),
            captions: vec![(
                "en".to_owned(),
                format!("The person {text}; keep about 28 m away and look down about 45 degrees."),
            )],
            ..ExaminedEpisode::default()
        }
    }

    #[test]
    fn true_texts_pass_and_planted_false_ones_are_flagged() {
        let corner = vec![(0.0, 12.0), (90.0, 12.0)];
        let curve = curve(180.0, 12.0);
        let back = vec![(0.0, 24.0), (180.0, 24.0)];
        for (legs, text, holds) in [
            (&corner, "sets off, turns right, and walks on", true),
            (&corner, "sets off, soon turns right, and walks on", false),
            (&corner, "sets off, turns left, and walks on", false),
            (&corner, "turns around and walks on", false),
            (&corner, "makes no sharp turn", false),
            (&corner, "turns right, then left, and walks on", false),
            (&curve, "makes no sharp turn", true),
            (&curve, "turns around and walks on", false),
            (&curve, "turns right and walks on", false),
            (&curve, "heads straight on throughout", false),
            (&back, "turns around and walks on", true),
            (&back, "makes no sharp turn", false),
            (&back, "heads straight on throughout", false),
        ] {
            assert_eq!(crate::checks::words::check(&episode(legs, text)).is_empty(), holds, "{text}: {legs:?}");
        }
    }

    /// A slow curve through an angle (degrees) of a radius.
    fn curve(angle_deg: f64, radius_m: f64) -> Vec<(f64, f64)> {
        let steps = (angle_deg.abs().to_radians() * radius_m / 0.6).round();
        (0..steps as usize).map(|i| (angle_deg * i as f64 / steps, 0.6)).collect()
    }

    #[test]
    fn corners_are_clear_turns_and_curves_are_none() {
        for (legs, expected) in [
            (vec![(0.0, 24.0)], vec![]),
            (vec![(0.0, 12.0), (90.0, 12.0)], vec![Right]),
            (vec![(0.0, 12.0), (-90.0, 12.0), (0.0, 12.0)], vec![Left, Right]),
            (vec![(0.0, 12.0), (180.0, 12.0)], vec![Around]),
            (vec![(0.0, 12.0), (90.0, 12.0), (180.0, 12.0)], vec![Right, Right]),
            (curve(180.0, 12.0), vec![]),
            (curve(-90.0, 20.0), vec![]),
        ] {
            let clear: Vec<TurnKind> = walk(&legs).turns().0.iter().map(|turn| turn.kind).collect();
            assert_eq!(clear, expected, "{legs:?}");
        }
        assert!(walk(&curve(180.0, 12.0)).turns().1.is_empty(), "nobody calls that a turn");
    }

    #[test]
    fn a_way_bends_where_part_of_it_goes_another_way_and_be_it_the_end() {
        assert!(!walk(&[(0.0, 12.0), (10.0, 12.0)]).bends());
        assert!(walk(&[(0.0, 24.0), (180.0, 1.8)]).bends());
        assert!(walk(&curve(90.0, 30.0)).bends());
    }
}
