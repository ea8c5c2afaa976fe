//! Relief of a place: ground that rises in one direction, steep and gentle in turn.

use crate::alignment::{Alignment, Pose2};
use crate::geometry::{bounds, cut};
use crate::lot::Lot;
use crate::things::{Footprint, GeneratedThing, ThingKind};
use cosfly_frames::{DVec2, real};

/// From one steep part to the next, metres.
const WAVE_M: f64 = 240.0;
/// The slope is a share of the steepest one: its mean, and how much it is more or less.
const SHARES: [f64; 2] = [0.65, 0.35];
/// Ground is level in pieces of this length up the slope, and walls, fences and hedges step after as much, metres.
const PIECE_M: f64 = 6.0;
const STEP_M: f64 = 3.0;
/// Distance of the records of profiles, metres.
const RECORD_M: f64 = 6.0;

/// The relief; usually level.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relief {
    up: DVec2,
    steepest: f64,
    phase_rad: f64,
}

impl Relief {
    /// Ground that rises in direction `up`, by `steepest` metres a metre at most; `phase_rad` shifts its steep parts.
    pub fn rising(up: DVec2, steepest: f64, phase_rad: f64) -> Self {
        Self { up, steepest, phase_rad }
    }

    /// Whether there is none.
    pub fn is_level(&self) -> bool {
        self.steepest == 0.0
    }

    /// Height of the ground, metres.
    pub fn height_m(&self, at: DVec2) -> f64 {
        let (wave, up_m) = (2.0 * real::PI / WAVE_M, at.dot(self.up));
        self.steepest * (SHARES[0] * up_m - SHARES[1] / wave * real::cos(wave * up_m + self.phase_rad))
    }

    /// Its rise, metres a metre.
    pub fn rise(&self, at: DVec2) -> DVec2 {
        let turn_rad = 2.0 * real::PI / WAVE_M * at.dot(self.up) + self.phase_rad;
        self.steepest * (SHARES[0] + SHARES[1] * real::sin(turn_rad)) * self.up
    }

    /// Profiles of a road along a line: height, and roll, which is positive where the left side is higher. Records are a station
    /// and the four coefficients of a cubic from there on.
    pub fn profiles(&self, line: &Alignment) -> [Vec<[f64; 5]>; 2] {
        let roll_rad = |pose: Pose2| real::atan(self.rise(pose.at).dot(pose.left()));
        let (mut start_m, mut profiles) = (0.0, [Vec::new(), Vec::new()]);
        for piece in &line.pieces {
            let count = (piece.length_m / RECORD_M).ceil().max(1.0) as usize;
            let length_m = piece.length_m / count as f64;
            for record in 0..count {
                let from_m = start_m + record as f64 * length_m;
                let pose = |share: f64| line.pose_at(from_m + share * length_m);
                let [from, to] = [0.0, 1.0].map(pose);
                let heights_m = [from, to].map(|it| [self.height_m(it.at), self.rise(it.at).dot(it.ahead())]);
                profiles[0].push(cubic(from_m, length_m, heights_m));
                let rolls_rad = [0.0, 0.01, 0.99, 1.0].map(|share| roll_rad(pose(share)));
                let turn = |at: usize| (rolls_rad[at + 1] - rolls_rad[at]) / (0.01 * length_m);
                profiles[1].push(cubic(from_m, length_m, [[rolls_rad[0], turn(0)], [rolls_rad[3], turn(2)]]));
            }
            start_m += piece.length_m;
        }
        profiles
    }

    /// A thing in pieces short enough for the slope. Patches of ground must be convex.
    pub fn pieces(&self, thing: &GeneratedThing) -> Vec<GeneratedThing> {
        let piece = |footprint: Footprint| GeneratedThing { footprint, ..thing.clone() };
        match &thing.footprint {
            _ if self.is_level() => vec![thing.clone()],
            Footprint::Polygon(outline) if thing.kind == ThingKind::Ground => {
                self.strips(outline).into_iter().map(|strip| piece(Footprint::Polygon(strip))).collect()
            }
            Footprint::Rectangle(lot)
                if matches!(thing.kind, ThingKind::Wall | ThingKind::Fence | ThingKind::Hedge) =>
            {
                let count = (2.0 * lot.half_m.x / STEP_M).ceil().max(1.0);
                let half_m = DVec2::new(lot.half_m.x / count, lot.half_m.y);
                let along = lot.axes()[0];
                let center = |number: usize| lot.center + (2.0 * number as f64 + 1.0 - count) * half_m.x * along;
                let lots = (0..count as usize).map(|number| Lot { center: center(number), half_m, ..*lot });
                lots.map(|lot| piece(Footprint::Rectangle(lot))).collect()
            }
            _ => vec![thing.clone()],
        }
    }

    /// Strips of a convex polygon across the slope.
    fn strips(&self, outline: &[DVec2]) -> Vec<Vec<DVec2>> {
        let ups: Vec<DVec2> = outline.iter().map(|corner| DVec2::new(corner.dot(self.up), 0.0)).collect();
        let [low_m, high_m] = bounds(&ups).map(|corner| corner.x);
        let count = ((high_m - low_m) / PIECE_M).ceil().max(1.0);
        let line = |number: f64| (low_m + number / count * (high_m - low_m)) * self.up;
        let across = self.up.perp();
        let strip = |number: usize| cut(&cut(outline, line(number as f64), -across), line(number as f64 + 1.0), across);
        (0..count as usize).map(strip).filter(|strip| strip.len() > 2).collect()
    }
}

/// The cubic with given values and slopes at both ends.
fn cubic(from_m: f64, length_m: f64, [[a, b], [end, end_slope]]: [[f64; 2]; 2]) -> [f64; 5] {
    let mean = (end - a) / length_m;
    [from_m, a, b, (3.0 * mean - 2.0 * b - end_slope) / length_m, (b + end_slope - 2.0 * mean) / (length_m * length_m)]
}
