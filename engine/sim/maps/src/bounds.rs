//! [`PlanRectangle`]: the part of a town that is kept, whatever the format of its file.

use cosfly_diagnose::plausible;
use cosfly_domain::{Lane, Obstacle, ObstacleKind, SurfaceMesh, Town, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::polygons::{triangulated, twice_area_m2};
use std::collections::{BTreeMap, BTreeSet};

/// Ground is kept so far beyond the bounds, metres: as far as readers invent it beyond everything.
const GROUND_M: f64 = cosfly_town::terrain::USUAL_MARGIN_M;
/// Narrowest bounds, metres.
const NARROWEST_M: f64 = 10.0;
/// Pieces of ground smaller than this are left out, square metres.
const SMALLEST_M2: f64 = 1e-4;

/// A rectangle in plan, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanRectangle {
    /// Smallest corner, metres.
    pub low: DVec2,
    /// Largest corner, metres.
    pub high: DVec2,
}

/// A corner of a surface with its place along and across the road.
type Corner = (DVec3, DVec2);

impl PlanRectangle {
    /// Smallest x and y, largest x and y, metres.
    ///
    /// # Errors
    /// The broken rule.
    pub fn new(numbers_m: [f64; 4]) -> Result<Self, String> {
        if let Some((number, fault)) = numbers_m.iter().find_map(|it| Some((it, plausible(*it).err()?))) {
            return Err(format!("`{number}` of `bounds_m` {fault}"));
        }
        let [low_x, low_y, high_x, high_y] = numbers_m;
        let bounds = Self { low: DVec2::new(low_x, low_y), high: DVec2::new(high_x, high_y) };
        if (bounds.high - bounds.low).min_element() < NARROWEST_M {
            return Err(format!(
                "`bounds_m` is `{numbers_m:?}`: smallest x and y, then largest x and y, at least {NARROWEST_M} m apart"
            ));
        }
        Ok(bounds)
    }

    /// The bounds of points; none without any.
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        let none = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        let all =
            points.into_iter().fold(none, |all, point| Self { low: all.low.min(point), high: all.high.max(point) });
        (all.low.is_finite() && all.high.is_finite()).then_some(all)
    }

    /// Text of the rectangle as the parameter `bounds_m` has it, by whole metres outwards.
    pub fn written(&self) -> String {
        let ([low_x, low_y], [high_x, high_y]) = (self.low.floor().to_array(), self.high.ceil().to_array());
        format!("bounds_m = [{low_x}, {low_y}, {high_x}, {high_y}]")
    }

    /// Rectangle wider by `by_m` on each side, metres.
    #[must_use]
    pub fn grown(&self, by_m: f64) -> Self {
        Self { low: self.low - by_m, high: self.high + by_m }
    }

    /// Distance of a point from the rectangle, metres; 0 within.
    pub fn distance_m(&self, point: DVec2) -> f64 {
        (self.low - point).max(point - self.high).max(DVec2::ZERO).length()
    }

    fn holds(&self, point: DVec2) -> bool {
        self.distance_m(point) == 0.0
    }

    fn touches(&self, low: DVec2, high: DVec2) -> bool {
        low.cmple(self.high).all() && high.cmpge(self.low).all()
    }

    fn touches_box(&self, obstacle: &Obstacle) -> bool {
        let (low, high) = obstacle.shape.bounds_in_world();
        self.touches(low.truncate(), high.truncate())
    }

    /// Cuts a town: buildings and trees that touch the bounds stay whole, of walls, fences and other long things the
    /// boxes that touch them; ground and lanes end at the bounds, the ground that is seen a little beyond.
    pub fn cut(&self, town: &mut Town) {
        let is_long = |kind| {
            use ObstacleKind as Kind;
            matches!(kind, Kind::Wall | Kind::Fence | Kind::GuardRail | Kind::Bush | Kind::Bridge | Kind::Static)
        };
        let touching = town.obstacles.iter().filter(|one| self.touches_box(one));
        let kept: BTreeSet<u32> = touching.map(|one| one.object_id).collect();
        town.obstacles.retain(|one| kept.contains(&one.object_id) && (!is_long(one.kind) || self.touches_box(one)));
        let walkable = std::mem::take(&mut town.walkable);
        town.walkable = walkable.into_iter().flat_map(|polygon| self.cut_polygon(polygon)).collect();
        let lanes = std::mem::take(&mut town.lanes);
        town.lanes = lanes.iter().flat_map(|lane| self.cut_lane(lane)).collect();
        let around = self.grown(GROUND_M);
        town.surfaces.iter_mut().for_each(|mesh| around.cut_mesh(mesh));
        town.surfaces.retain(|mesh| !mesh.triangles.is_empty());
    }

    fn cut_polygon(&self, polygon: WalkablePolygon) -> Vec<WalkablePolygon> {
        let outline = &polygon.outline_in_world;
        if outline.iter().all(|corner| self.holds(corner.truncate())) {
            return vec![polygon];
        }
        let corners: Vec<Corner> = outline.iter().map(|corner| (*corner, DVec2::ZERO)).collect();
        let plan = polygon.plan();
        let is_reached = Self::around(plan.iter().copied()).is_some_and(|own| self.touches(own.low, own.high));
        if !is_reached {
            return vec![];
        }
        let triangles = if is_convex(&plan) { vec![] } else { triangulated(&plan) };
        let pieces: Vec<Vec<Corner>> = match triangles.is_empty() {
            true => vec![corners],
            false => triangles.iter().map(|it| it.map(|corner| corners[corner as usize]).to_vec()).collect(),
        };
        let cut = pieces.into_iter().filter_map(|piece| self.cut_piece(piece));
        cut.map(|piece| WalkablePolygon {
            outline_in_world: piece.into_iter().map(|(corner, _)| corner).collect(),
            ..polygon.clone()
        })
        .collect()
    }

    /// The part of a convex piece within the bounds; none where nothing of it is.
    fn cut_piece(&self, mut piece: Vec<Corner>) -> Option<Vec<Corner>> {
        for (inward, limit) in
            [(DVec2::X, self.low.x), (-DVec2::X, -self.high.x), (DVec2::Y, self.low.y), (-DVec2::Y, -self.high.y)]
        {
            let depth = |corner: &Corner| corner.0.truncate().dot(inward) - limit;
            let mut kept = Vec::with_capacity(piece.len() + 1);
            for (at, corner) in piece.iter().enumerate() {
                let next = &piece[(at + 1) % piece.len()];
                let (own, other) = (depth(corner), depth(next));
                if own >= 0.0 {
                    kept.push(*corner);
                }
                if (own >= 0.0) != (other >= 0.0) {
                    let share = own / (own - other);
                    kept.push((corner.0.lerp(next.0, share), corner.1.lerp(next.1, share)));
                }
            }
            piece = kept;
        }
        let plan: Vec<DVec2> = piece.iter().map(|(corner, _)| corner.truncate()).collect();
        (piece.len() > 2 && 0.5 * twice_area_m2(&plan).abs() >= SMALLEST_M2).then_some(piece)
    }

    fn cut_mesh(&self, mesh: &mut SurfaceMesh) {
        if mesh.vertices_in_world.iter().all(|corner| self.holds(corner.truncate())) {
            return;
        }
        let mut cut = SurfaceMesh { vertices_in_world: vec![], along_across_m: vec![], triangles: vec![], ..*mesh };
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        for triangle in &mesh.triangles {
            let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
            if corners.iter().all(|corner| self.holds(corner.truncate())) {
                let own = triangle.map(|corner| {
                    *numbers.entry(corner).or_insert_with(|| {
                        let corner = corner as usize;
                        push(&mut cut, (mesh.vertices_in_world[corner], mesh.along_across_m[corner]))
                    })
                });
                cut.triangles.push(own);
                continue;
            }
            let piece =
                triangle.map(|corner| (mesh.vertices_in_world[corner as usize], mesh.along_across_m[corner as usize]));
            let Some(piece) = self.cut_piece(piece.to_vec()) else { continue };
            let own: Vec<u32> = piece.into_iter().map(|corner| push(&mut cut, corner)).collect();
            cut.triangles.extend(own[1..].windows(2).map(|pair| [own[0], pair[0], pair[1]]));
        }
        *mesh = cut;
    }

    /// Pieces of a lane within the bounds.
    fn cut_lane(&self, lane: &Lane) -> Vec<Lane> {
        let mut pieces: Vec<Vec<DVec3>> = vec![];
        for pair in lane.middle_in_world.windows(2) {
            let Some((from, to)) = self.cut_step(pair[0], pair[1]) else { continue };
            match pieces.last_mut().filter(|piece| piece.last() == Some(&from)) {
                Some(piece) => piece.push(to),
                None => pieces.push(vec![from, to]),
            }
        }
        let piece = |points| {
            let piece = Lane::new(lane.kind, points, lane.width_m, lane.speed_limit_mps)?;
            Some(Lane { in_junction: lane.in_junction, ..piece })
        };
        pieces.into_iter().filter_map(piece).collect()
    }

    /// The part of a straight step within the bounds.
    fn cut_step(&self, from: DVec3, to: DVec3) -> Option<(DVec3, DVec3)> {
        let step = (to - from).truncate();
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (low, high) = (self.low[axis] - from[axis], self.high[axis] - from[axis]);
            if step[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low / step[axis], high / step[axis]);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        // Ends that are not cut stay exact.
        let first = if enter > 0.0 { from.lerp(to, enter) } else { from };
        let last = if leave < 1.0 { from.lerp(to, leave) } else { to };
        (enter < leave).then_some((first, last))
    }
}

fn push(mesh: &mut SurfaceMesh, (corner, along_across): Corner) -> u32 {
    mesh.vertices_in_world.push(corner);
    mesh.along_across_m.push(along_across);
    mesh.vertices_in_world.len() as u32 - 1
}

fn is_convex(plan: &[DVec2]) -> bool {
    let at = |corner: usize| plan[corner % plan.len()];
    let turn = |corner: usize| (at(corner + 1) - at(corner)).perp_dot(at(corner + 2) - at(corner + 1));
    let turns = || (0..plan.len()).map(turn);
    plan.len() < 4 || turns().all(|turn| turn >= 0.0) || turns().all(|turn| turn <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{LaneKind, OrientedBox, SemanticLabel, WalkableKind};

    fn bounds() -> PlanRectangle {
        PlanRectangle::new([0.0, 0.0, 100.0, 50.0]).unwrap()
    }

    fn area_m2(polygons: &[WalkablePolygon]) -> f64 {
        polygons.iter().map(|polygon| 0.5 * twice_area_m2(&polygon.plan()).abs()).sum()
    }

    fn ground(corners: &[(f64, f64)]) -> WalkablePolygon {
        let outline_in_world = corners.iter().map(|(x, y)| DVec3::new(*x, *y, 0.1 * x)).collect();
        WalkablePolygon { kind: WalkableKind::Plaza, outline_in_world, synthetic: false }
    }

    #[test]
    fn bounds_are_in_order_and_plausible() {
        for (numbers, expected) in [
            ([0.0, 0.0, -5.0, 50.0], "smallest x and y"),
            ([0.0, 0.0, 1.0, 50.0], "at least 10 m"),
            ([0.0, f64::NAN, 100.0, 50.0], "is not a number"),
            ([0.0, -1e23, 100.0, 50.0], "larger than 1e9"),
        ] {
            assert!(PlanRectangle::new(numbers).unwrap_err().contains(expected), "{numbers:?}");
        }
        assert_eq!(bounds().written(), "bounds_m = [0, 0, 100, 50]");
    }

    #[test]
    fn ground_ends_at_the_bounds_and_keeps_its_slope() {
        let square = ground(&[(-50.0, 10.0), (50.0, 10.0), (50.0, 20.0), (-50.0, 20.0)]);
        // An L around the corner of the bounds: only its foot and its shaft are inside.
        let ell = ground(&[(80.0, -40.0), (120.0, -40.0), (120.0, 40.0), (90.0, 40.0), (90.0, 0.0), (80.0, 0.0)]);
        let far = ground(&[(500.0, 0.0), (600.0, 0.0), (600.0, 9.0)]);
        let mut town = Town { walkable: vec![square, ell, far], ..Town::default() };
        bounds().cut(&mut town);
        assert!((area_m2(&town.walkable) - 500.0 - 400.0).abs() < 1e-6, "{}", area_m2(&town.walkable));
        for corner in town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world) {
            assert!(bounds().distance_m(corner.truncate()) < 1e-9 && (corner.z - 0.1 * corner.x).abs() < 1e-9);
        }
    }

    #[test]
    fn houses_stay_whole_and_walls_end_near_the_bounds() {
        let at = |x: f64, kind, object_id| Obstacle {
            shape: OrientedBox {
                center_in_world: DVec3::new(x, 25.0, 5.0),
                half_extents_m: DVec3::new(10.0, 1.0, 5.0),
                yaw_rad: 0.0,
            },
            kind,
            object_id,
            synthetic: false,
        };
        let (house, wall) = (ObstacleKind::Building, ObstacleKind::Wall);
        let obstacles = [(95.0, house, 1), (115.0, house, 1), (400.0, house, 2), (95.0, wall, 3), (115.0, wall, 3)];
        let mut town = Town { obstacles: obstacles.map(|(x, kind, id)| at(x, kind, id)).to_vec(), ..Town::default() };
        bounds().cut(&mut town);
        let kept: Vec<(f64, u32)> =
            town.obstacles.iter().map(|it| (it.shape.center_in_world.x, it.object_id)).collect();
        assert_eq!(kept, [(95.0, 1), (115.0, 1), (95.0, 3)]);
    }

    #[test]
    fn lanes_are_parted_and_surfaces_go_on_a_little() {
        let points = [(-50.0, 25.0), (50.0, 25.0), (50.0, 80.0), (60.0, 80.0), (60.0, 10.0)];
        let points = points.map(|(x, y)| DVec3::new(x, y, 0.0));
        let lane = Lane::new(LaneKind::Driving, points, 3.0, 10.0).unwrap();
        let corners = [(-900.0, 0.0), (900.0, 0.0), (900.0, 40.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let mesh = SurfaceMesh {
            label: SemanticLabel::Roads,
            vertices_in_world: corners.to_vec(),
            along_across_m: corners.map(|corner| corner.truncate()).to_vec(),
            triangles: vec![[0, 1, 2]],
            synthetic: false,
        };
        let mut town = Town { lanes: vec![lane], surfaces: vec![mesh], ..Town::default() };
        bounds().cut(&mut town);
        assert_eq!(town.lanes.len(), 2);
        let lengths_m = [0, 1].map(|lane| town.lanes[lane].length_m());
        assert!(lengths_m.into_iter().zip([75.0, 40.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{lengths_m:?}");
        let reach = PlanRectangle::around(town.surfaces[0].vertices_in_world.iter().map(|it| it.truncate())).unwrap();
        assert!((reach.low.x + 60.0).abs() < 1e-9 && (reach.high.x - 160.0).abs() < 1e-9, "{reach:?}");
        for (corner, along_across) in town.surfaces[0].vertices_in_world.iter().zip(&town.surfaces[0].along_across_m) {
            assert!(corner.truncate().distance(*along_across) < 1e-9);
        }
    }
}
