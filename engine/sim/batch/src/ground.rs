//! Ground polygons of a town in clusters of neighbours, projected eight at a time.

use crate::canvas::{Parts, WIDE};
use crate::eye::{Eye, NEAR_M};
use crate::lanes::{Bounds, BoxLanes};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, simd_kernel};
use cosfly_render::outside::SceneFace;
use std::ops::Range;

/// Beyond this, pixels from the image's centre, corners are too coarse in single precision.
pub const FAR_OFF_PX: f32 = 3000.0;
/// Polygons of a cluster.
const CLUSTER: usize = 8 * WIDE;

/// Ground of a town.
pub struct Ground {
    clusters: Vec<Cluster>,
    /// Boxes around the clusters.
    around: BoxLanes,
    packs: Vec<Pack>,
    /// Corners of the packs, eight polygons side by side, from the cluster's centre, metres.
    corners: Vec<[[f32; WIDE]; 3]>,
    polygons: Vec<Polygon>,
    corners_in_world: Vec<DVec3>,
}

/// Neighbouring polygons.
pub struct Cluster {
    pub center_in_world: DVec3,
    /// Boxes around its packs.
    pub around: BoxLanes,
    first_pack: u32,
}

/// Eight polygons of a cluster side by side.
pub struct Pack {
    first: u32,
    pub count: usize,
    corners: Range<u32>,
}

/// A flat convex polygon.
pub struct Polygon {
    pub normal_in_world: DVec3,
    /// Component of its points along the normal, metres.
    pub offset_m: f64,
    pub lift: f64,
    corners: Range<u32>,
    /// Its number in the scene.
    pub number: u32,
    pub label: u8,
}

impl Polygon {
    /// Number of corners.
    #[inline]
    pub fn count(&self) -> usize {
        (self.corners.end - self.corners.start) as usize
    }
}

/// Eight polygons on the screen; pixels from the image's centre, metres ahead.
#[derive(Default)]
pub struct SeenPack {
    /// Right and down, corner by corner; polygons with fewer corners repeat their last.
    pub corners: Vec<[[f32; WIDE]; 2]>,
    /// The pixels that they may cover.
    pub parts: Parts<WIDE>,
    pub nearest_m: [f32; WIDE],
    /// Greatest distance from the image's centre over the way ahead, pixels per metre: where it is great, a rounding of the
    /// corner in the world moves the corner on the screen.
    pub coarse: [f32; WIDE],
}

impl Ground {
    /// Ground by its faces, whose instances are their numbers in the scene.
    pub fn of(mut faces: Vec<&SceneFace>) -> Self {
        let mut ground = Self {
            clusters: vec![],
            around: BoxLanes::of(&[]),
            packs: vec![],
            corners: vec![],
            polygons: vec![],
            corners_in_world: vec![],
        };
        sort(&mut faces);
        let bounds: Vec<Bounds> = faces.chunks(CLUSTER).map(bounds_of).collect();
        faces.chunks(CLUSTER).zip(&bounds).for_each(|(members, bounds)| ground.add(members, bounds.center_in_world));
        ground.around = BoxLanes::of(&bounds);
        ground
    }

    fn add(&mut self, faces: &[&SceneFace], center_in_world: DVec3) {
        let around: Vec<Bounds> = faces.chunks(WIDE).map(bounds_of).collect();
        let first_pack = self.packs.len() as u32;
        self.clusters.push(Cluster { center_in_world, around: BoxLanes::of(&around), first_pack });
        for eight in faces.chunks(WIDE) {
            let (first, first_corner) = (self.polygons.len() as u32, self.corners.len() as u32);
            for face in eight {
                let start = self.corners_in_world.len() as u32;
                self.corners_in_world.extend(&face.corners_in_world);
                self.polygons.push(Polygon {
                    normal_in_world: face.normal_in_world,
                    offset_m: face.normal_in_world.dot(face.point_in_world),
                    lift: face.lift,
                    number: face.instance,
                    label: face.label,
                    corners: start..self.corners_in_world.len() as u32,
                });
            }
            let most = eight.iter().map(|face| face.corners_in_world.len()).max().unwrap_or(0);
            for number in 0..most {
                let from_center = |k: usize| {
                    let corners = eight.get(k).map_or(&[][..], |face| &face.corners_in_world);
                    corners.get(number).or(corners.last()).map_or(DVec3::ZERO, |corner| *corner - center_in_world)
                };
                let lane = |axis: usize| core::array::from_fn(|k| from_center(k)[axis] as f32);
                self.corners.push([lane(0), lane(1), lane(2)]);
            }
            let corners = first_corner..self.corners.len() as u32;
            self.packs.push(Pack { first, count: eight.len(), corners });
        }
    }

    /// Boxes around the clusters.
    pub fn around(&self) -> &BoxLanes {
        &self.around
    }

    /// A cluster by its number.
    pub fn cluster(&self, number: u32) -> &Cluster {
        &self.clusters[number as usize]
    }

    /// A pack of a cluster.
    pub fn pack(&self, cluster: &Cluster, number: u32) -> &Pack {
        &self.packs[cluster.first_pack as usize + number as usize]
    }

    /// Polygon `k` of a pack.
    #[inline]
    pub fn polygon(&self, pack: &Pack, k: usize) -> &Polygon {
        &self.polygons[pack.first as usize + k]
    }

    /// Corners of a polygon.
    #[inline]
    pub fn corners_in_world(&self, polygon: &Polygon) -> &[DVec3] {
        &self.corners_in_world[polygon.corners.start as usize..polygon.corners.end as usize]
    }

    /// Projects a pack of a cluster whose centre is seen at `origin` ([`Eye::pixels_ahead`]).
    pub fn project(&self, level: Level, eye: &Eye, origin: [f32; 3], pack: &Pack, seen: &mut SeenPack) {
        let size = eye.half_px.map(|half| 2.0 * half as f32);
        let corners = &self.corners[pack.corners.start as usize..pack.corners.end as usize];
        seen.corners.resize(corners.len(), [[0.0; WIDE]; 2]);
        project(level, corners, origin, &eye.turn_to_pixels, size, seen);
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.clusters)
            + self.clusters.iter().map(|cluster| cluster.around.bytes()).sum::<usize>()
            + self.around.bytes()
            + size_of_val(&*self.packs)
            + size_of_val(&*self.corners)
            + size_of_val(&*self.polygons)
            + size_of_val(&*self.corners_in_world)
    }
}

/// Sorts neighbours together: halves along the longer side until a pack is left.
fn sort(faces: &mut [&SceneFace]) {
    if faces.len() <= WIDE {
        return;
    }
    let bounds = bounds_of(faces);
    let axis = usize::from(bounds.half_m.y > bounds.half_m.x);
    faces.sort_by(|a, b| a.point_in_world[axis].total_cmp(&b.point_in_world[axis]));
    // Whole clusters on the left while there are several, then whole packs.
    let unit = if faces.len() > CLUSTER { CLUSTER } else { WIDE };
    let middle = (faces.len() / 2).next_multiple_of(unit).min((faces.len() - 1) / unit * unit);
    let (left, right) = faces.split_at_mut(middle);
    sort(left);
    sort(right);
}

fn bounds_of(faces: &[&SceneFace]) -> Bounds {
    let corners = || faces.iter().flat_map(|face| &face.corners_in_world).copied();
    Bounds::between(corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max))
}

simd_kernel! {
    fn project(corners: &[[[f32; WIDE]; 3]], origin: [f32; 3], turn: &[[f32; 3]; 3], size: [f32; 2], seen: &mut SeenPack) {
        let (mut low_u, mut low_v) = ([f32::INFINITY; WIDE], [f32::INFINITY; WIDE]);
        let (mut high_u, mut high_v) = ([f32::NEG_INFINITY; WIDE], [f32::NEG_INFINITY; WIDE]);
        let mut nearest = [f32::INFINITY; WIDE];
        let mut farthest = [f32::NEG_INFINITY; WIDE];
        let mut coarse = [0.0f32; WIDE];
        // How far corners reach within the sides of the view.
        let (mut left, mut right_side) = ([f32::NEG_INFINITY; WIDE], [f32::NEG_INFINITY; WIDE]);
        let (mut top, mut bottom) = ([f32::NEG_INFINITY; WIDE], [f32::NEG_INFINITY; WIDE]);
        for (corner, seen) in corners.iter().zip(seen.corners.iter_mut()) {
            for k in 0..WIDE {
                let [x, y, z] = [corner[0][k], corner[1][k], corner[2][k]];
                let ahead = origin[0] + (x * turn[0][0] + y * turn[1][0] + z * turn[2][0]);
                let right = origin[1] + (x * turn[0][1] + y * turn[1][1] + z * turn[2][1]);
                let down = origin[2] + (x * turn[0][2] + y * turn[1][2] + z * turn[2][2]);
                let scale = 1.0 / ahead;
                let (u, v) = (right * scale, down * scale);
                seen[0][k] = u;
                seen[1][k] = v;
                low_u[k] = if u < low_u[k] { u } else { low_u[k] };
                low_v[k] = if v < low_v[k] { v } else { low_v[k] };
                high_u[k] = if u > high_u[k] { u } else { high_u[k] };
                high_v[k] = if v > high_v[k] { v } else { high_v[k] };
                let (wide, tall) = (0.5 * size[0] * ahead, 0.5 * size[1] * ahead);
                let (from_left, from_right) = (wide + right, wide - right);
                let (from_top, from_bottom) = (tall + down, tall - down);
                left[k] = if from_left > left[k] { from_left } else { left[k] };
                right_side[k] = if from_right > right_side[k] { from_right } else { right_side[k] };
                top[k] = if from_top > top[k] { from_top } else { top[k] };
                bottom[k] = if from_bottom > bottom[k] { from_bottom } else { bottom[k] };
                nearest[k] = if ahead < nearest[k] { ahead } else { nearest[k] };
                farthest[k] = if ahead > farthest[k] { ahead } else { farthest[k] };
                let away = if u.abs() > v.abs() { u.abs() } else { v.abs() };
                let spread = away * scale;
                coarse[k] = if spread > coarse[k] { spread } else { coarse[k] };
            }
        }
        let (low, high) = ([low_u, low_v], [high_u, high_v]);
        let within = [left, right_side, top, bottom];
        let mut from = [[0.0f32; WIDE]; 2];
        let mut to = [[0.0f32; WIDE]; 2];
        for axis in 0..2 {
            for k in 0..WIDE {
                let low = if low[axis][k] < -FAR_OFF_PX { f32::INFINITY } else { coarse[k] };
                coarse[k] = if high[axis][k] > FAR_OFF_PX { f32::INFINITY } else { low };
            }
            for k in 0..WIDE {
                // Anywhere, where it reaches behind the camera; nothing of what lies behind or beside the view.
                from[axis][k] = if nearest[k] >= NEAR_M as f32 { low[axis][k] } else { f32::NEG_INFINITY };
                let end = if nearest[k] >= NEAR_M as f32 { high[axis][k] } else { f32::INFINITY };
                let end = if farthest[k] >= NEAR_M as f32 { end } else { f32::NEG_INFINITY };
                let end = if within[2 * axis][k] >= 0.0 { end } else { f32::NEG_INFINITY };
                to[axis][k] = if within[2 * axis + 1][k] >= 0.0 { end } else { f32::NEG_INFINITY };
            }
        }
        seen.parts.find(size, &from, &to);
        (seen.nearest_m, seen.coarse) = (nearest, coarse);
    }
}
