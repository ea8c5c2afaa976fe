//! Lanes of vehicles on streets, and ways through junctions between them.

use super::roads::{self, ROAD_HEIGHT_M, Road};
use super::stated::{Doubts, EVERY, Quantity};
use super::strip::{moved_left, thinned};
use super::tags::{Tags, speed_mps};
use cosfly_domain::{Lane, LaneKind};
use cosfly_frames::DVec2;
use std::collections::BTreeMap;

/// Narrower lanes are left out, metres.
const NARROWEST_M: f64 = 2.2;
/// Width of a lane for bicycles, metres.
const BIKING_M: f64 = 1.5;
/// Limit on streets that state none, m/s: 50 km/h; and in living streets, 10 km/h.
const USUAL_LIMITS_MPS: [f64; 2] = [50.0 / 3.6, 10.0 / 3.6];
/// Lanes that are driven: all of a street, in the direction of the way, and against it.
const DRIVEN: [Quantity; 3] = [
    driven(&["lanes"], "as many as fit in their width are driven"),
    driven(&["lanes:forward"], "half of all lanes lead there"),
    driven(&["lanes:backward"], "the other lanes lead there"),
];
/// Speed limit, m/s.
const LIMIT: Quantity = Quantity {
    read: speed_mps,
    noun: ["speed", " m/s"],
    is_word: is_word_of_limit,
    ..Quantity::number(
        "streets",
        &["maxspeed"],
        [1.0, 100.0],
        "the usual limit counts: 50 km/h, in living streets 10 km/h",
    )
};
/// Room for turns beyond the widest street at a junction, metres.
const TURN_M: f64 = 3.0;
/// Length that is rounded off where two pieces of a street meet, metres.
const JOINT_M: f64 = 1.5;
/// Largest share of a street's piece that junctions take at one end.
const MOST_TAKEN: f64 = 0.4;
/// Ways that turn by more are left out, cosine of the angle.
const SHARPEST_COS: f64 = -0.85;
/// Pieces of the curve of a way through a junction.
const CURVE_PIECES: usize = 8;

/// A piece of street between two junctions, or between a junction and an end.
struct Piece {
    points: Vec<DVec2>,
    /// Lanes in the direction of the points and against it.
    lanes: [usize; 2],
    bikes: [bool; 2],
    lane_m: f64,
    half_width_m: f64,
    limit_mps: f64,
    ends: [Node; 2],
}

type Node = [u64; 2];

const fn driven(keys: &'static [&'static str], instead: &'static str) -> Quantity {
    Quantity::number("streets", keys, [1.0, 8.0], instead)
}

/// Whether a limit is one in words: none, one on signs that change, or that of a kind of street in a country (`DE:urban`).
fn is_word_of_limit(text: &str) -> bool {
    ["none", "signals", "variable", "implicit"].contains(&text) || text.contains(':')
}

/// The lanes that lead to a junction or away from it, from the kerb inwards.
struct Bundle {
    piece: usize,
    lanes: Vec<usize>,
    bike: Option<usize>,
}

/// The lanes of streets. Alleys and car parks have none, and narrow streets with traffic in both directions have none.
pub fn lanes(roads: &[Road<'_>], left_hand: bool, doubts: &mut Doubts) -> Vec<Lane> {
    let pieces = pieces(roads, doubts);
    let widest = widest_at(&pieces);
    let mut lanes: Vec<Lane> = vec![];
    let mut into: BTreeMap<Node, Vec<Bundle>> = BTreeMap::new();
    let mut out: BTreeMap<Node, Vec<Bundle>> = BTreeMap::new();
    for (number, piece) in pieces.iter().enumerate() {
        let length_m: f64 = piece.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let cut = piece.ends.map(|node| taken_m(&widest[&node]).min(MOST_TAKEN * length_m));
        let line = thinned(&trimmed(&piece.points, cut));
        for direction in 0..2 {
            let mut along = line.clone();
            if direction == 1 {
                along.reverse();
            }
            let (mut bundle, mut bike) = (vec![], None);
            let aside = Aside { piece, direction, left_hand };
            let kinds = (0..piece.lanes[direction]).map(|k| (LaneKind::Driving, k));
            for (kind, k) in kinds.chain(piece.bikes[direction].then_some((LaneKind::Biking, 0))) {
                let (offset_m, width_m) = aside.offset_and_width_m(kind, k);
                let moved = moved_left(&along, &vec![offset_m; along.len()]);
                let points = moved.iter().map(|point| point.extend(ROAD_HEIGHT_M));
                let Some(lane) = Lane::new(kind, points, width_m, piece.limit_mps) else { continue };
                match kind {
                    LaneKind::Driving => bundle.push(lanes.len()),
                    LaneKind::Biking => bike = Some(lanes.len()),
                }
                lanes.push(lane);
            }
            let [from, to] = if direction == 0 { piece.ends } else { [piece.ends[1], piece.ends[0]] };
            into.entry(to).or_default().push(Bundle { piece: number, lanes: bundle.clone(), bike });
            out.entry(from).or_default().push(Bundle { piece: number, lanes: bundle, bike });
        }
    }
    for (node, arriving) in &into {
        for from in arriving {
            for to in out.get(node).into_iter().flatten().filter(|to| to.piece != from.piece) {
                connect(&mut lanes, from, to, left_hand);
            }
        }
    }
    lanes
}

/// Place of a lane on its street.
struct Aside<'a> {
    piece: &'a Piece,
    direction: usize,
    left_hand: bool,
}

impl Aside<'_> {
    /// How far the lane's middle lies to the left of the street's middle in the direction of driving, and its width, metres;
    /// lanes count from the kerb inwards.
    fn offset_and_width_m(&self, kind: LaneKind, lane: usize) -> (f64, f64) {
        let Piece { lanes, lane_m, half_width_m, .. } = *self.piece;
        let is_oneway = lanes[1 - self.direction] == 0;
        let to_kerb_m = match (kind, is_oneway) {
            (LaneKind::Biking, _) => half_width_m - 0.5 * BIKING_M,
            (_, true) => (0.5 * lanes[self.direction] as f64 - lane as f64 - 0.5) * lane_m,
            (_, false) => (lanes[self.direction] as f64 - lane as f64 - 0.5) * lane_m,
        };
        let sign = if self.left_hand { 1.0 } else { -1.0 };
        (sign * to_kerb_m, if kind == LaneKind::Biking { BIKING_M } else { lane_m })
    }
}

/// Streets cut where others meet them.
fn pieces(roads: &[Road<'_>], doubts: &mut Doubts) -> Vec<Piece> {
    let key = |point: DVec2| [point.x.to_bits(), point.y.to_bits()];
    let mut uses: BTreeMap<Node, usize> = BTreeMap::new();
    let driven: Vec<(&Road<'_>, Piece)> = roads.iter().filter_map(|road| Some((road, layout(road, doubts)?))).collect();
    for point in driven.iter().flat_map(|(road, _)| &road.pieces).flatten() {
        *uses.entry(key(*point)).or_default() += 1;
    }
    let mut found = vec![];
    for (road, layout) in &driven {
        for line in &road.pieces {
            let mut from = 0;
            for at in 1..line.len() {
                if at + 1 < line.len() && uses[&key(line[at])] < 2 {
                    continue;
                }
                let mut points = line[from..=at].to_vec();
                from = at;
                if road.way.tags.is("oneway", &["-1"]) {
                    points.reverse();
                }
                let ends = [key(points[0]), key(points[points.len() - 1])];
                if ends[0] != ends[1] {
                    found.push(Piece { points, ends, ..*layout });
                }
            }
        }
    }
    found
}

/// Lanes of a street, without its line; `None` where vehicles do not drive.
fn layout(road: &Road<'_>, doubts: &mut Doubts) -> Option<Piece> {
    let tags = &road.way.tags;
    if tags.is("highway", &["service", "escape", "raceway", "bus_guideway", "busway"]) {
        return None;
    }
    let is_oneway = road.is_oneway;
    let name = format_args!("way {}", road.way.id);
    let mut count = |lanes: &Quantity| doubts.read(tags, lanes, name).map(|lanes| lanes as usize);
    let [all, forward, backward] = &DRIVEN;
    // A number that gives no width either is told of there.
    let stated = tags.stated(&roads::LANES).and_then(|_| count(all));
    let bikes = bikes(tags, is_oneway);
    let bikes_m = bikes.iter().filter(|has| **has).count() as f64 * BIKING_M;
    let drivable_m = 2.0 * road.half_width_m - bikes_m;
    let all = stated.unwrap_or((drivable_m / 3.0).floor().max(1.0) as usize);
    let lanes = match is_oneway {
        true => [all, 0],
        false => {
            let all = all.max(2);
            let [there, back] = [count(forward), count(backward)];
            let lanes = there.unwrap_or(all.div_ceil(2)).min(all - 1);
            if there.is_some_and(|there| there > lanes) {
                let less = Quantity {
                    noun: ["number below that of all lanes", ""],
                    instead: "all lanes but one lead there",
                    ..*forward
                };
                doubts.add(tags, &Quantity { range: EVERY, ..less }, name);
            }
            let room = all - lanes;
            if back.is_some_and(|back| back > room) {
                let rest = Quantity {
                    noun: ["number that all lanes leave room for", ""],
                    instead: "the lanes are narrower",
                    ..*backward
                };
                doubts.add(tags, &Quantity { range: EVERY, ..rest }, name);
            }
            [lanes, back.unwrap_or(room)]
        }
    };
    let lane_m = match is_oneway {
        true => drivable_m / lanes[0] as f64,
        false => 0.5 * drivable_m / lanes[0].max(lanes[1]) as f64,
    };
    // Bicycles beside the lanes take their room on both sides alike.
    let usual = USUAL_LIMITS_MPS[usize::from(tags.is("highway", &["living_street"]))];
    let limit_mps = doubts.read(tags, &LIMIT, name).unwrap_or(usual);
    (lane_m >= NARROWEST_M).then(|| Piece {
        points: vec![],
        lanes,
        bikes,
        lane_m: lane_m.min(4.0),
        half_width_m: road.half_width_m,
        limit_mps,
        ends: [[0; 2]; 2],
    })
}

/// Lanes for bicycles on the carriageway, in the direction of the way and against it.
fn bikes(tags: &Tags, is_oneway: bool) -> [bool; 2] {
    let has = |keys: &[&str]| keys.iter().any(|key| tags.is(key, &["lane"]));
    let both = has(&["cycleway", "cycleway:both"]);
    [both || has(&["cycleway:right"]), (both || has(&["cycleway:left"])) && !is_oneway]
}

/// Number of street ends at each place, and half the width of the widest, metres.
fn widest_at(pieces: &[Piece]) -> BTreeMap<Node, (usize, f64)> {
    let mut ends: BTreeMap<Node, (usize, f64)> = BTreeMap::new();
    for piece in pieces {
        for node in piece.ends {
            let (count, widest) = ends.entry(node).or_default();
            (*count, *widest) = (*count + 1, widest.max(piece.half_width_m));
        }
    }
    ends
}

/// Length that a junction takes of the streets that meet there, metres.
fn taken_m((count, widest_m): &(usize, f64)) -> f64 {
    match count {
        0 | 1 => 0.0,
        2 => JOINT_M,
        _ => widest_m + TURN_M,
    }
}

/// A line without so much at its beginning and end, metres.
fn trimmed(points: &[DVec2], [begin_m, end_m]: [f64; 2]) -> Vec<DVec2> {
    let cut = |points: &[DVec2], mut left_m: f64| -> Vec<DVec2> {
        for (index, pair) in points.windows(2).enumerate() {
            let length_m = pair[0].distance(pair[1]);
            if length_m > left_m {
                let first = pair[0].lerp(pair[1], left_m / length_m);
                return [first].into_iter().chain(points[index + 1..].iter().copied()).collect();
            }
            left_m -= length_m;
        }
        vec![]
    };
    let mut line = cut(points, begin_m);
    line.reverse();
    let mut line = cut(&line, end_m);
    line.reverse();
    line
}

/// Adds the ways from one street to another: the lane at the kerb turns to the near side, the inner lane to the far side, and
/// all go straight on.
fn connect(lanes: &mut Vec<Lane>, from: &Bundle, to: &Bundle, left_hand: bool) {
    let ([first, ..], [onto, ..]) = (&from.lanes[..], &to.lanes[..]) else { return };
    let [(_, ahead), (_, onward)] = [end_of(&lanes[*first], true), end_of(&lanes[*onto], false)];
    let (straight, aside) = (ahead.dot(onward), ahead.perp_dot(onward));
    if straight < SHARPEST_COS {
        return;
    }
    let near_side = (aside > 0.0) != left_hand;
    let pairs: Vec<(usize, usize)> = match straight > 0.7 {
        true => from.lanes.iter().enumerate().map(|(k, own)| (*own, to.lanes[k.min(to.lanes.len() - 1)])).collect(),
        false if near_side => vec![(*first, *onto)],
        false => vec![(from.lanes[from.lanes.len() - 1], to.lanes[to.lanes.len() - 1])],
    };
    let bikes = from.bike.zip(to.bike);
    for (own, next) in pairs.into_iter().chain(bikes) {
        let way = curve(&lanes[own], &lanes[next]);
        lanes.extend(way);
    }
}

/// Place and direction of the last or the first point of a lane, in plan.
fn end_of(lane: &Lane, last: bool) -> (DVec2, DVec2) {
    let line = &lane.middle_in_world;
    let [from, to] = if last { [line.len() - 2, line.len() - 1] } else { [0, 1] };
    let along = (line[to] - line[from]).truncate().normalize_or_zero();
    (line[if last { to } else { from }].truncate(), along)
}

/// A way from the end of a lane to the beginning of another one: a cubic Bézier curve along both.
fn curve(own: &Lane, next: &Lane) -> Option<Lane> {
    let ([from, ahead], [to, onward]) =
        (<[DVec2; 2]>::from(end_of(own, true)), <[DVec2; 2]>::from(end_of(next, false)));
    let reach_m = 0.39 * from.distance(to) * (1.0 + 0.4 * (1.0 - ahead.dot(onward)));
    let controls = [from, from + reach_m * ahead, to - reach_m * onward, to];
    let at = |t: f64| {
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        controls.iter().zip(weights).map(|(point, weight)| *point * weight).sum::<DVec2>()
    };
    let points = (0..=CURVE_PIECES).map(|step| at(step as f64 / CURVE_PIECES as f64).extend(ROAD_HEIGHT_M));
    let (width_m, limit) = (own.width_m.min(next.width_m), own.speed_limit_mps.min(next.speed_limit_mps));
    Lane::new(own.kind, points, width_m, limit).map(|lane| Lane { in_junction: true, ..lane })
}
