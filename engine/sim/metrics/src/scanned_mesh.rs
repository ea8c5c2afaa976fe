//! [`ScannedMesh`]: triangles of a scan, and how near a path comes to them.

use cosfly_frames::DVec3;
use cosfly_geometry::{SpatialQuery, TriangleBvh};

/// Least step along a path, metres.
const STEP_M: f64 = 0.005;

/// The triangles of a scan in the world of a town.
pub struct ScannedMesh {
    /// Town whose world they lie in.
    pub town: String,
    triangles: TriangleBvh,
}

impl std::fmt::Debug for ScannedMesh {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ScannedMesh").field("town", &self.town).finish_non_exhaustive()
    }
}

impl ScannedMesh {
    /// Triangles in the world of the flights in `town`, metres.
    pub fn new(town: String, triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let corners: Vec<DVec3> = triangles.flatten().collect();
        let numbers: Vec<[u32; 3]> = (0..corners.len() as u32 / 3).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
        Self { town, triangles: TriangleBvh::build(&corners, &numbers) }
    }

    /// How far a point lies over the surface below or above it that is nearest to it, metres (negative: under it); none where there is no
    /// surface within `within_m`.
    pub fn height_over(&self, point: DVec3, within_m: f64) -> Option<f64> {
        let (reach, mut best) = (DVec3::Z * within_m, None);
        self.triangles.within(point - reach, point + reach, &mut |number| {
            let [a, b, c] = self.triangles.triangles()[number as usize].corners_in_world;
            let (u, v, w) = (b - a, c - a, point - a);
            let whole = u.x * v.y - u.y * v.x;
            let (second, third) = ((w.x * v.y - w.y * v.x) / whole, (u.x * w.y - u.y * w.x) / whole);
            // Upright triangles have no extent in plan: their shares are no numbers.
            if second >= 0.0 && third >= 0.0 && second + third <= 1.0 {
                let over_m = w.z - second * u.z - third * v.z;
                let is_nearer = best.is_none_or(|best: f64| over_m.abs() < best.abs());
                best = if over_m.abs() <= within_m && is_nearer { Some(over_m) } else { best };
            }
        });
        best
    }

    /// The part of a path that comes nearer than `within_m`, by the number of its first point, and how near it comes there.
    pub fn nearest(&self, path: &[DVec3], within_m: f64) -> Option<(usize, f64)> {
        let mut best = None;
        let mut least_m = within_m;
        for (number, pair) in path.windows(2).enumerate() {
            let reach = DVec3::splat(least_m);
            let (low, high) = (pair[0].min(pair[1]) - reach, pair[0].max(pair[1]) + reach);
            self.triangles.within(low, high, &mut |triangle| {
                let away_m = away_m(&self.triangles.triangles()[triangle as usize].corners_in_world, pair, least_m);
                if away_m < least_m {
                    (least_m, best) = (away_m, Some((number, away_m)));
                }
            });
        }
        best
    }
}

/// Distance of a triangle from a path of two points where it is less than `within_m`: walks as far as no point can come nearer.
fn away_m(triangle: &[DVec3; 3], pair: &[DVec3], within_m: f64) -> f64 {
    let (length_m, mut best_m, mut walked_m) = (pair[0].distance(pair[1]), within_m, 0.0);
    loop {
        let point = pair[0].lerp(pair[1], if length_m > 0.0 { walked_m / length_m } else { 0.0 });
        let here_m = from_point_m(triangle, point);
        best_m = best_m.min(here_m);
        if walked_m >= length_m {
            return best_m;
        }
        walked_m = (walked_m + (here_m - best_m).max(STEP_M)).min(length_m);
    }
}

/// Distance of a point: over the triangle to its plane, elsewhere to the nearest edge. Weights of the corners tell which.
fn from_point_m([a, b, c]: &[DVec3; 3], point: DVec3) -> f64 {
    let (u, v, w) = (*b - *a, *c - *a, point - *a);
    let [uu, uv, vv, wu, wv] = [u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v)];
    let whole = uu * vv - uv * uv;
    let (second, third) = ((vv * wu - uv * wv) / whole, (uu * wv - uv * wu) / whole);
    if second >= 0.0 && third >= 0.0 && second + third <= 1.0 {
        return (w - second * u - third * v).length();
    }
    let edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share = (point - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        (point - from - along * share.clamp(0.0, 1.0)).length()
    };
    edge(*a, *b).min(edge(*b, *c)).min(edge(*c, *a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_geometry::{Shape, Triangle};

    #[test]
    fn both_measures_of_distance_agree() {
        let mut state = 7_u32;
        let mut number = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) * 10.0 - 5.0
        };
        let mut point = || DVec3::new(number(), number(), number());
        for _ in 0..2000 {
            let (corners, pair) = ([point(), point(), point()], [point(), point()]);
            let exact = Triangle { corners_in_world: corners }.segment_distance(pair[0], pair[1], 4.0).unwrap_or(4.0);
            let walked = away_m(&corners, &pair, 4.0);
            assert!(walked >= exact - 1e-9 && walked <= exact + STEP_M, "{walked} {exact}");
        }
        let flat = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        assert_eq!(from_point_m(&flat, DVec3::new(1.5, 0.0, 2.0)), 2.0);
    }

    #[test]
    fn heights_count_from_the_nearest_surface_below_or_above() {
        let level = |z: f64| [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(|[x, y]| DVec3::new(x, y, z + 0.1 * x));
        let upright = [DVec3::ZERO, DVec3::new(2.0, 2.0, 0.0), DVec3::new(1.0, 1.0, 9.0)];
        let mesh = ScannedMesh::new("a".to_owned(), [level(0.0), level(2.0), upright].into_iter());
        let over = |z: f64| mesh.height_over(DVec3::new(1.0, 1.0, z), 1.5);
        for (z, expected) in [(0.4, 0.3), (0.0, -0.1), (1.6, -0.5), (2.3, 0.2)] {
            assert!(over(z).is_some_and(|it| (it - expected).abs() < 1e-9), "{z}: {:?}", over(z));
        }
        assert_eq!((over(4.0), mesh.height_over(DVec3::new(3.0, 3.0, 0.3), 1.5)), (None, None));
    }
}
