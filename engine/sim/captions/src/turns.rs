//! Turns of a walk: bends of its path that a person sees, by chords of some metres before and behind each place.
//!
//! Between what everybody calls a turn and what nobody does are doubtful bends; texts say nothing of turns where there is one.

use cosfly_claims::TurnKind;
use cosfly_frames::{DVec2, real};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Lengths of the chords, metres.
const CHORDS_M: [f64; 2] = [3.0, 5.0];
/// The path bends where one of the chords turns by this much, degrees.
const BEND_DEG: f64 = 40.0;
/// A bend is a turn to a side where each of the chords turns by this much, and the path by so much in all, degrees.
const TURN_DEG: [f64; 2] = [30.0, 45.0];
const SIDE_DEG: [f64; 2] = [60.0, 125.0];
/// A longer bend is several turns, or a curve, metres.
const LONGEST_BEND_M: f64 = 12.0;
/// A bend begins so far before a chord says so, and ends so far behind, metres.
const AROUND_BEND_M: f64 = 1.0;
/// A turn around leads back by this much (degrees) within so many metres and seconds of walking.
const AROUND_DEG: f64 = 150.0;
const AROUND_M: f64 = 3.0;
const AROUND_S: f64 = 6.0;
/// A bend beyond this may be taken for a turn around, degrees.
const MAYBE_AROUND_DEG: f64 = 110.0;
/// Nearer to the ends of a path nobody can say whether it bends, metres.
const END_M: f64 = 2.0;
/// Shorter pieces have no direction, metres.
const LEAST_PIECE_M: f64 = 0.5;
/// A way is straight where every chord goes its way within this angle, degrees.
const STRAIGHT_DEG: f64 = 20.0;
/// Least way between places of a path, metres.
const STEP_M: f64 = 0.1;
/// The path leads to a side where a chord turns by this much, degrees, within this way, metres.
const SWING_DEG: f64 = 25.0;
const SWING_M: f64 = 15.0;

/// One turn of the walk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Turn {
    /// First frame behind it.
    pub frame: u32,
    /// Change of direction, degrees; positive to the right.
    pub angle_deg: f64,
    /// Which way.
    pub kind: TurnKind,
}

/// The turns of a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Turns {
    /// Those that everybody sees, in order.
    pub sure: Vec<Turn>,
    /// Those that somebody may see, in order; nobody may, too.
    pub doubtful: Vec<Turn>,
}

/// The path of a walk, without its stops.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    /// Places, [`STEP_M`] apart at least.
    places: Vec<DVec2>,
    /// Way from the start to each place, metres.
    along_m: Vec<f64>,
    /// Last frame at each place.
    frames: Vec<usize>,
    /// Time of walking up to each place, seconds.
    walked_s: Vec<f64>,
    /// Number of frames.
    count: usize,
}

/// Places of a path, numbered, at which one of the chords turns by [`BEND_DEG`].
struct Bend {
    places: Range<usize>,
    /// Where it is sharpest.
    peak: usize,
}

impl Path {
    pub(crate) fn of(feet: &[DVec2], moving: &[bool], dt_s: f64) -> Self {
        let mut path = Self { places: vec![], along_m: vec![], frames: vec![], walked_s: vec![], count: feet.len() };
        let mut walked_s = 0.0;
        for (frame, point) in feet.iter().enumerate() {
            walked_s += if moving[frame] { dt_s } else { 0.0 };
            let step_m = path.places.last().map_or(f64::INFINITY, |last| last.distance(*point));
            if step_m < STEP_M {
                if let Some(last) = path.frames.last_mut() {
                    *last = frame;
                }
                continue;
            }
            path.along_m.push(path.along_m.last().map_or(0.0, |last| last + step_m));
            path.places.push(*point);
            path.frames.push(frame);
            path.walked_s.push(walked_s);
        }
        path
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.along_m.last().copied().unwrap_or_default()
    }

    /// Direction from one way along the path to another, radians.
    pub(crate) fn direction_rad(&self, from_m: f64, to_m: f64) -> Option<f64> {
        let (from_m, to_m) = (from_m.max(0.0), to_m.min(self.length_m()));
        let chord = self.at(to_m)? - self.at(from_m)?;
        let is_long = to_m - from_m >= LEAST_PIECE_M && chord.length() >= STEP_M;
        is_long.then(|| real::atan2(chord.y, chord.x))
    }

    fn at(&self, along_m: f64) -> Option<DVec2> {
        let next = self.along_m.partition_point(|it| *it < along_m);
        let (Some(to), Some(from)) = (self.places.get(next), next.checked_sub(1)) else {
            return self.places.get(next).or(self.places.last()).copied();
        };
        let share = (along_m - self.along_m[from]) / (self.along_m[next] - self.along_m[from]);
        Some(self.places[from].lerp(*to, share))
    }

    /// Change of direction from the chord that ends at one way along the path to the chord that begins at another, degrees.
    fn swing_deg(&self, end_m: f64, begin_m: f64, chord_m: f64) -> f64 {
        let before = self.direction_rad(end_m - chord_m, end_m);
        let after = self.direction_rad(begin_m, begin_m + chord_m);
        before.zip(after).map_or(0.0, |(before, after)| real::wrap_angle_rad(after - before).to_degrees())
    }

    /// Change of direction at a place, by each of the chords, degrees.
    fn swings_deg(&self, place: usize) -> [f64; 2] {
        CHORDS_M.map(|chord_m| self.swing_deg(self.along_m[place], self.along_m[place], chord_m))
    }

    /// Whether the way is straight from its start to its end.
    pub(crate) fn is_straight(&self) -> bool {
        let Some(whole) = self.direction_rad(0.0, self.length_m()) else { return self.length_m() < CHORDS_M[0] };
        let goes_so = |from_m: &f64| {
            let ahead = self.direction_rad(*from_m, from_m + CHORDS_M[0]);
            ahead.is_none_or(|it| real::wrap_angle_rad(it - whole).to_degrees().abs() <= STRAIGHT_DEG)
        };
        self.along_m.iter().all(goes_so)
    }

    /// Whether the path leads to a side somewhere around a frame so much that people may call it a turn.
    pub(crate) fn leads(&self, frame: usize, to: TurnKind) -> bool {
        let sign = if to == TurnKind::Left { -1.0 } else { 1.0 };
        let here = self.frames.partition_point(|it| *it < frame).min(self.frames.len().saturating_sub(1));
        let is_near = |place: &usize| (self.along_m[*place] - self.along_m[here]).abs() <= SWING_M;
        let turns = |place: usize| self.swings_deg(place).iter().any(|it| sign * it >= SWING_DEG);
        (0..self.places.len()).filter(is_near).any(turns)
    }

    pub(crate) fn turns(&self) -> Turns {
        let mut turns = Turns::default();
        for bend in self.bends() {
            match self.sure(&bend) {
                Some(turn) => turns.sure.push(turn),
                None => turns.doubtful.extend(self.doubtful(&bend)),
            }
        }
        turns
    }

    fn bends(&self) -> Vec<Bend> {
        let swings: Vec<[f64; 2]> = (0..self.places.len()).map(|place| self.swings_deg(place)).collect();
        let larger = |it: &[f64; 2]| if it[0].abs() > it[1].abs() { it[0] } else { it[1] };
        let sharpness = |place: usize| swings[place][0].abs() + swings[place][1].abs();
        let mut bends: Vec<Bend> = vec![];
        let mut last_deg = 0.0;
        for (place, here) in swings.iter().enumerate() {
            let deg = larger(here);
            if deg.abs() < BEND_DEG {
                continue;
            }
            // Who turns around has no side.
            let is_same = deg * last_deg > 0.0 || f64::min(deg.abs(), f64::abs(last_deg)) > MAYBE_AROUND_DEG;
            match bends.last_mut().filter(|bend| bend.places.end == place && is_same) {
                Some(bend) => {
                    bend.places.end = place + 1;
                    if sharpness(place) > sharpness(bend.peak) {
                        bend.peak = place;
                    }
                }
                None => bends.push(Bend { places: place..place + 1, peak: place }),
            }
            last_deg = deg;
        }
        bends
    }

    /// Change of direction from before a bend to behind it, degrees.
    fn angle_deg(&self, bend: &Bend) -> f64 {
        let (begin_m, end_m) = (self.along_m[bend.places.start], self.along_m[bend.places.end - 1]);
        let whole_m = self.length_m();
        let (begin_m, end_m) =
            ((begin_m - AROUND_BEND_M).max(END_M / 2.0), (end_m + AROUND_BEND_M).min(whole_m - END_M / 2.0));
        self.swing_deg(begin_m, end_m, CHORDS_M[0])
    }

    fn turn(&self, bend: &Bend, kind: TurnKind) -> Turn {
        let frame = (self.frames[bend.peak] + 1).min(self.count.saturating_sub(1));
        Turn { frame: frame as u32, angle_deg: self.angle_deg(bend), kind }
    }

    /// The turn that everybody sees in a bend.
    fn sure(&self, bend: &Bend) -> Option<Turn> {
        let at_m = self.along_m[bend.peak];
        let whole_deg = self.angle_deg(bend);
        let length_m = self.along_m[bend.places.end - 1] - self.along_m[bend.places.start];
        let is_inside = at_m >= END_M && self.length_m() - at_m >= END_M;
        let is_side = |sign: f64| {
            let turns = self.swings_deg(bend.peak).into_iter().zip(TURN_DEG).all(|(it, least)| sign * it >= least);
            turns && (SIDE_DEG[0]..=SIDE_DEG[1]).contains(&(sign * whole_deg)) && length_m <= LONGEST_BEND_M
        };
        let kind = match () {
            () if !is_inside => return None,
            () if self.leads_back(bend) && whole_deg.abs() >= AROUND_DEG => TurnKind::Around,
            () if is_side(1.0) => TurnKind::Right,
            () if is_side(-1.0) => TurnKind::Left,
            () => return None,
        };
        Some(self.turn(bend, kind))
    }

    /// Whether the path leads back within some metres and seconds.
    fn leads_back(&self, bend: &Bend) -> bool {
        let leads = |from: usize, to: usize| {
            let (from_m, to_m) = (self.along_m[from], self.along_m[to]);
            to_m - from_m <= AROUND_M
                && self.walked_s[to] - self.walked_s[from] <= AROUND_S
                && self.swing_deg(from_m, to_m, CHORDS_M[0]).abs() >= AROUND_DEG
        };
        bend.places.clone().any(|from| {
            let near = (from..bend.places.end).take_while(|to| self.along_m[*to] - self.along_m[from] <= AROUND_M);
            near.into_iter().any(|to| leads(from, to))
        })
    }

    /// Turns that somebody may see in a bend: to its sides, and around where it leads far enough.
    fn doubtful(&self, bend: &Bend) -> Vec<Turn> {
        let swings: Vec<f64> = bend.places.clone().flat_map(|place| self.swings_deg(place)).collect();
        let has = |sign: f64| swings.iter().any(|it| sign * it >= BEND_DEG);
        let far = swings.iter().any(|it| it.abs() >= MAYBE_AROUND_DEG);
        let kinds = [
            (has(-1.0), TurnKind::Left),
            (has(1.0), TurnKind::Right),
            (far || self.angle_deg(bend).abs() >= MAYBE_AROUND_DEG, TurnKind::Around),
        ];
        kinds.into_iter().filter(|(may_be, _)| *may_be).map(|(_, kind)| self.turn(bend, kind)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A walk in steps of `step_m` through the yaws (degrees), so many metres each, at 1.2 m/s.
    fn path(legs: &[(f64, f64)], step_m: f64) -> Path {
        let mut feet = vec![DVec2::ZERO];
        for &(yaw_deg, length_m) in legs {
            let (sin, cos) = real::sin_cos(f64::to_radians(yaw_deg));
            for _ in 0..(length_m / step_m).round() as usize {
                feet.push(feet[feet.len() - 1] + step_m * DVec2::new(cos, sin));
            }
        }
        Path::of(&feet, &vec![true; feet.len()], step_m / 1.2)
    }

    /// A curve through an angle (degrees) of a radius, between straight legs of 12 m.
    fn curve(angle_deg: f64, radius_m: f64) -> Vec<(f64, f64)> {
        let pieces = 60;
        let piece_m = angle_deg.abs().to_radians() * radius_m / f64::from(pieces);
        let bend = (0..pieces).map(|i| (angle_deg * (f64::from(i) + 0.5) / f64::from(pieces), piece_m));
        [(0.0, 12.0)].into_iter().chain(bend).chain([(angle_deg, 12.0)]).collect()
    }

    fn sure(legs: &[(f64, f64)]) -> Vec<TurnKind> {
        path(legs, 0.6).turns().sure.iter().map(|turn| turn.kind).collect()
    }

    #[test]
    fn turns_are_bends_of_a_few_metres_and_have_their_side() {
        use TurnKind::{Around, Left, Right};
        for (legs, expected) in [
            (vec![(0.0, 30.0)], vec![]),
            (vec![(0.0, 12.0), (90.0, 12.0)], vec![Right]),
            (vec![(0.0, 12.0), (-90.0, 12.0), (0.0, 12.0)], vec![Left, Right]),
            (vec![(170.0, 12.0), (-100.0, 12.0)], vec![Right]),
            (vec![(0.0, 12.0), (179.0, 12.0)], vec![Around]),
            (vec![(0.0, 12.0), (90.0, 1.8), (180.0, 12.0)], vec![Around]),
            (vec![(0.0, 12.0), (30.0, 12.0)], vec![]),
            // Two bends that are 9 m apart are two turns, and none around.
            (vec![(0.0, 12.0), (90.0, 9.0), (180.0, 12.0)], vec![Right, Right]),
        ] {
            assert_eq!(sure(&legs), expected, "{legs:?}");
        }
    }

    #[test]
    fn a_slow_curve_is_no_turn_and_a_narrow_one_is() {
        for (angle_deg, radius_m, expected) in
            [(90.0, 1.5, 1), (90.0, 12.0, 0), (180.0, 1.0, 1), (180.0, 9.0, 0), (180.0, 25.0, 0), (-90.0, 1.5, 1)]
        {
            let piece_m = f64::to_radians(f64::abs(angle_deg)) * radius_m / 60.0;
            let turns = path(&curve(angle_deg, radius_m), piece_m.clamp(0.05, 0.5)).turns();
            assert_eq!(turns.sure.len(), expected, "{angle_deg} at {radius_m}: {turns:?}");
        }
    }

    #[test]
    fn what_somebody_may_call_a_turn_is_doubtful() {
        for legs in [
            vec![(0.0, 12.0), (50.0, 12.0)],
            vec![(0.0, 12.0), (135.0, 12.0)],
            vec![(0.0, 12.0), (90.0, 5.0), (180.0, 12.0)],
            vec![(0.0, 24.0), (180.0, 1.2)],
            vec![(0.0, 1.2), (90.0, 24.0)],
        ] {
            let turns = path(&legs, 0.6).turns();
            assert!(turns.sure.is_empty() && !turns.doubtful.is_empty(), "{legs:?}: {turns:?}");
        }
    }

    #[test]
    fn a_way_is_straight_only_if_it_is_so_to_the_end() {
        assert!(path(&[(0.0, 30.0)], 0.6).is_straight());
        assert!(path(&[(0.0, 15.0), (10.0, 15.0)], 0.6).is_straight());
        assert!(!path(&[(0.0, 30.0), (180.0, 1.2)], 0.6).is_straight());
        assert!(!path(&[(0.0, 30.0), (180.0, 30.0)], 0.6).is_straight());
        assert!(!path(&curve(90.0, 30.0), 0.6).is_straight());
    }

    #[test]
    fn turns_do_not_depend_on_the_time_step() {
        let legs = [(0.0, 12.0), (90.0, 12.0), (0.0, 12.0), (180.0, 12.0)];
        let kinds = |step_m: f64| path(&legs, step_m).turns().sure.iter().map(|it| it.kind).collect::<Vec<_>>();
        for step_m in [0.02, 0.1, 0.3, 1.2, 2.0] {
            assert_eq!(kinds(step_m), kinds(0.6), "{step_m}");
        }
    }

    #[test]
    fn a_walk_without_steps_has_no_turns() {
        assert_eq!(Path::of(&[DVec2::ZERO; 20], &[true; 20], 0.5).turns(), Turns::default());
        assert_eq!(Path::of(&[], &[], 0.5).turns(), Turns::default());
        assert!(Path::of(&[], &[], 0.5).is_straight());
    }
}
