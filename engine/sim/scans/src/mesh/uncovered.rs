//! Faces to walk on without what lies close under other ground: steps, stacked slabs, decks.

use super::level::is_level;
use super::names::{Kind, Thing};
use super::plan_index::{PlanIndex, bounds};
use cosfly_frames::DVec3;

/// Ground this close above leaves no room for a person, metres.
const HEADROOM_M: f64 = 2.2;
/// Ground of the same mesh lies over a face from this height on, of other meshes from that height on: lower ones are drawings on the
/// ground, metres.
const OVER_M: [f64; 2] = [0.01, 0.05];
/// Smallest piece to walk on, and smallest piece that is cut away, square metres.
const SMALLEST_M2: f64 = 1e-3;
const SMALLEST_CUT_M2: f64 = 0.02;
/// Most pairs of faces that are compared; what is beyond stays as it is.
const MOST_WORK: usize = 50_000_000;

/// A triangle of ground, and the number of its mesh.
struct Face {
    corners: [DVec3; 3],
    thing: usize,
}

/// A line in plan or a plane, positive on the inner side: normal and shift.
type Border = (DVec3, f64);

/// Faces of pavements without what is covered.
#[derive(Default)]
pub struct Uncovered {
    /// Their outlines.
    pub outlines: Vec<Vec<DVec3>>,
    /// Area that was cut away, square metres.
    pub lost_m2: f64,
    /// Faces that were not compared with others: there are too many.
    pub unchecked: usize,
}

/// Faces of pavements that one can stand on.
pub fn uncovered(things: &[Thing]) -> Uncovered {
    let (mut walkable, mut ground, mut owners) = (Vec::new(), Vec::new(), Vec::new());
    for (number, thing) in things.iter().enumerate() {
        let Kind::Ground(_, is_walkable) = thing.kind else { continue };
        let faces = thing.parts.iter().flat_map(|part| part.triangles.iter().map(|it| part.corners(*it)));
        for corners in faces.filter(is_level) {
            if is_walkable {
                walkable.push(ground.len());
            }
            ground.push(corners);
            owners.push(number);
        }
    }
    let face = |at: usize| Face { corners: ground[at], thing: owners[at] };
    let index = PlanIndex::of(&ground);
    let (mut out, mut work) = (Uncovered::default(), 0);
    for at in walkable {
        let own = face(at);
        let mut pieces = vec![own.corners.to_vec()];
        let before_m2 = area_m2(&pieces[0]);
        let near = if work < MOST_WORK { index.near(&own.corners) } else { Vec::new() };
        work += near.len();
        out.unchecked += usize::from(near.is_empty());
        for other in near.into_iter().filter(|other| *other != at).map(face) {
            if may_cover(&other, &own) {
                pieces = without(pieces, &cover(&other, &own));
            }
        }
        out.lost_m2 += before_m2 - pieces.iter().map(|piece| area_m2(piece)).sum::<f64>();
        out.outlines.extend(pieces);
    }
    out
}

fn over_m(upper: &Face, lower: &Face) -> f64 {
    OVER_M[usize::from(upper.thing != lower.thing)]
}

fn may_cover(upper: &Face, lower: &Face) -> bool {
    let ends = |face: &Face| bounds(&face.corners);
    let ([low, high], [own_low, own_high]) = (ends(upper), ends(lower));
    let overlaps = low.truncate().cmplt(own_high.truncate()).all() && high.truncate().cmpgt(own_low.truncate()).all();
    overlaps && high.z > own_low.z + over_m(upper, lower) && low.z < own_high.z + HEADROOM_M
}

/// Borders of the part of the plan where one face lies over another with no room between them.
fn cover(upper: &Face, lower: &Face) -> [Border; 5] {
    let [a, b, c] = upper.corners;
    let normal = (b - a).cross(c - a);
    let side = |from: DVec3, to: DVec3| {
        let along = (to - from).truncate() * normal.z.signum();
        let inward = along.perp().extend(0.0);
        (inward, -inward.dot(from))
    };
    // Height of the upper face over a point of the lower one: linear in the point.
    let rise = DVec3::new(-normal.x / normal.z, -normal.y / normal.z, -1.0);
    let shift = normal.dot(a) / normal.z;
    [side(a, b), side(b, c), side(c, a), (rise, shift - over_m(upper, lower)), (-rise, HEADROOM_M - shift)]
}

/// The pieces without what lies within all borders.
fn without(pieces: Vec<Vec<DVec3>>, borders: &[Border]) -> Vec<Vec<DVec3>> {
    let mut out = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let inside = borders.iter().fold(piece.clone(), |inside, border| half(&inside, *border, 1.0));
        if area_m2(&inside) < SMALLEST_CUT_M2.min(0.5 * area_m2(&piece)) {
            out.push(piece);
            continue;
        }
        let mut rest = piece;
        for border in borders {
            let outside = half(&rest, *border, -1.0);
            if area_m2(&outside) > SMALLEST_M2 {
                out.push(outside);
            }
            rest = half(&rest, *border, 1.0);
        }
    }
    out
}

/// The part of a convex polygon on one side of a border.
fn half(polygon: &[DVec3], (normal, shift): Border, side: f64) -> Vec<DVec3> {
    let depth = |point: DVec3| side * (normal.dot(point) + shift);
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (at, a) in polygon.iter().enumerate() {
        let b = polygon[(at + 1) % polygon.len()];
        let (in_a, in_b) = (depth(*a), depth(b));
        if in_a >= 0.0 {
            out.push(*a);
        }
        if (in_a >= 0.0) != (in_b >= 0.0) {
            out.push(a.lerp(b, in_a / (in_a - in_b)));
        }
    }
    out
}

fn area_m2(polygon: &[DVec3]) -> f64 {
    let Some((first, rest)) = polygon.split_first() else { return 0.0 };
    let plan = |point: &DVec3| (*point - *first).truncate();
    0.5 * rest.windows(2).map(|pair| plan(&pair[0]).perp_dot(plan(&pair[1]))).sum::<f64>().abs()
}
