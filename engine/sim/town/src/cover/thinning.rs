//! Fewer corners for rings that have very many.

use cosfly_frames::DVec2;

/// Most corners that are left as they are: in all rings, or on average where there are many rings.
const MOST_CORNERS: usize = 256;
const MOST_OF_A_RING: usize = 8;
/// Most corners of all rings, and of each, after the first thinning, which moves next to nothing.
const MOST_FINE_CORNERS: usize = 1024;
const MOST_FINE_OF_A_RING: usize = 16;
/// Most corners of a ring that the exact thinning (quadratic at worst) works on at a time.
const MOST_FOR_EXACT: usize = 4096;
/// First distance that is tried, metres.
const FIRST_M: f64 = 0.02;

/// Drops corners until few are left. Every point of a ring lies within the returned distance of the new ring, metres.
pub(super) fn thin_out(rings: &mut Vec<Vec<DVec2>>) -> f64 {
    let corners = |rings: &[Vec<DVec2>]| rings.iter().map(Vec::len).sum::<usize>();
    let longest = |rings: &[Vec<DVec2>]| rings.iter().map(Vec::len).max().unwrap_or(0);
    if corners(rings) <= MOST_CORNERS.max(MOST_OF_A_RING * rings.len()) {
        return 0.0;
    }
    let mut moved_m = FIRST_M;
    let is_long = longest(rings) > MOST_FOR_EXACT;
    for ring in rings.iter_mut() {
        *ring = if ring.len() > MOST_FOR_EXACT {
            ring.chunks(MOST_FOR_EXACT).flat_map(|line| line_without_small_bends(line, FIRST_M)).collect()
        } else {
            without_small_bends(ring, FIRST_M)
        };
    }
    drop_lines(rings);
    let mut step_m = FIRST_M;
    while is_long && longest(rings) > MOST_FOR_EXACT {
        drop_close(rings, step_m);
        moved_m += step_m;
        step_m *= 2.0;
    }
    let mut step_m = 2.0 * FIRST_M;
    while corners(rings) > MOST_FINE_CORNERS.max(MOST_FINE_OF_A_RING * rings.len()) {
        for ring in rings.iter_mut() {
            *ring = without_small_bends(ring, step_m);
        }
        moved_m += step_m;
        drop_lines(rings);
        step_m *= 2.0;
    }
    moved_m
}

/// Keeps corners that are farther than `step_m` from the corner kept before.
fn drop_close(rings: &mut Vec<Vec<DVec2>>, step_m: f64) {
    for ring in rings.iter_mut() {
        let mut kept: Option<DVec2> = None;
        ring.retain(|corner| {
            let far = kept.is_none_or(|kept| kept.distance(*corner) > step_m);
            if far {
                kept = Some(*corner);
            }
            far
        });
    }
    drop_lines(rings);
}

/// A ring that shrank to a line holds next to nothing. The first one stays, so that something is left.
fn drop_lines(rings: &mut Vec<Vec<DVec2>>) {
    let mut index = 0;
    rings.retain(|ring| (index == 0 || ring.len() > 2, index += 1).0);
}

/// The ring without corners that lie within `step_m` of the line between their neighbours that stay.
fn without_small_bends(ring: &[DVec2], step_m: f64) -> Vec<DVec2> {
    let Some(first) = ring.first() else { return Vec::new() };
    let far = (0..ring.len()).max_by(|a, b| first.distance(ring[*a]).total_cmp(&first.distance(ring[*b]))).unwrap_or(0);
    let back: Vec<DVec2> = ring[far..].iter().chain([first]).copied().collect();
    let mut kept = Vec::new();
    for line in [&ring[..=far], &back] {
        kept.extend(line_without_small_bends(line, step_m));
        kept.pop();
    }
    kept
}

/// A line without small bends; its ends stay.
fn line_without_small_bends(line: &[DVec2], step_m: f64) -> Vec<DVec2> {
    let mut keeps = vec![false; line.len()];
    let mut stack = vec![(0, line.len().saturating_sub(1))];
    keeps.iter_mut().take(1).for_each(|first| *first = true);
    keeps.iter_mut().rev().take(1).for_each(|last| *last = true);
    while let Some((from, to)) = stack.pop() {
        let bend_m = |i: usize| distance_m(line[i], line[from], line[to]);
        let widest = (from + 1..to).max_by(|a, b| bend_m(*a).total_cmp(&bend_m(*b)));
        if let Some(at) = widest.filter(|at| bend_m(*at) > step_m) {
            keeps[at] = true;
            stack.extend([(from, at), (at, to)]);
        }
    }
    line.iter().zip(&keeps).filter(|(_, keep)| **keep).map(|(corner, _)| *corner).collect()
}

fn distance_m(point: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = ((point - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(a + share * along)
}
