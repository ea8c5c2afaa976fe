//! Ground polygons of a town in clusters of neighbours, which share their points.

use crate::canvas::WIDE;
use crate::eye::Eye;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, simd_kernel};
use cosfly_render::outside::SceneFace;
use std::collections::BTreeMap;
use std::ops::Range;

/// Polygons of a cluster.
const CLUSTER: usize = 32;

/// Ground of a town.
pub struct Ground {
    pub clusters: Vec<Cluster>,
    polygons: Vec<Polygon>,
    /// Corners of all polygons: numbers of points within their cluster.
    corners: Vec<u16>,
    /// Points by cluster, eight side by side, from the cluster's centre, metres.
    points: Vec<[[f32; WIDE]; 3]>,
    exact_in_world: Vec<DVec3>,
}

/// Neighbouring polygons.
pub struct Cluster {
    pub center_in_world: DVec3,
    pub half_m: DVec3,
    polygons: Range<u32>,
    points: Range<u32>,
}

/// A flat convex polygon.
pub struct Polygon {
    pub normal_in_world: DVec3,
    pub point_in_world: DVec3,
    pub lift: f64,
    pub label: u8,
    corners: Range<u32>,
}

/// Points of a cluster on the screen: metres ahead; pixels from the image's centre to the right and down.
#[derive(Default)]
pub struct SeenPoints {
    blocks: Vec<[[f32; WIDE]; 3]>,
}

impl SeenPoints {
    #[inline(always)]
    pub fn get(&self, point: u16) -> [f32; 3] {
        let (block, lane) = (&self.blocks[usize::from(point) / WIDE], usize::from(point) % WIDE);
        [block[0][lane], block[1][lane], block[2][lane]]
    }
}

impl Ground {
    /// Ground by its faces, neighbours together.
    pub fn of(faces: &[SceneFace]) -> Self {
        let mut ground =
            Self { clusters: vec![], polygons: vec![], corners: vec![], points: vec![], exact_in_world: vec![] };
        faces.chunks(CLUSTER).for_each(|members| ground.add(members));
        ground
    }

    fn add(&mut self, faces: &[SceneFace]) {
        let mut numbers = BTreeMap::new();
        let mut points: Vec<DVec3> = vec![];
        let first = self.polygons.len() as u32;
        for face in faces {
            let start = self.corners.len() as u32;
            for corner in &face.corners_in_world {
                let number = *numbers.entry(corner.to_array().map(f64::to_bits)).or_insert_with(|| {
                    points.push(*corner);
                    (points.len() - 1) as u16
                });
                self.corners.push(number);
            }
            self.polygons.push(Polygon {
                normal_in_world: face.normal_in_world,
                point_in_world: face.point_in_world,
                lift: face.lift,
                label: face.label,
                corners: start..self.corners.len() as u32,
            });
        }
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let center_in_world = 0.5 * (low + high);
        let first_block = self.points.len() as u32;
        for eight in points.chunks(WIDE) {
            let from_center = |k: usize| eight.get(k).map_or(DVec3::ZERO, |point| *point - center_in_world);
            self.points.push([0, 1, 2].map(|axis| core::array::from_fn(|k| from_center(k)[axis] as f32)));
            self.exact_in_world.extend((0..WIDE).map(|k| eight.get(k).copied().unwrap_or(center_in_world)));
        }
        self.clusters.push(Cluster {
            center_in_world,
            half_m: 0.5 * (high - low),
            polygons: first..self.polygons.len() as u32,
            points: first_block..self.points.len() as u32,
        });
    }

    pub fn polygons(&self, cluster: &Cluster) -> &[Polygon] {
        &self.polygons[cluster.polygons.start as usize..cluster.polygons.end as usize]
    }

    /// Point numbers of a polygon's corners within its cluster.
    #[inline]
    pub fn corners(&self, polygon: &Polygon) -> &[u16] {
        &self.corners[polygon.corners.start as usize..polygon.corners.end as usize]
    }

    pub fn exact_in_world(&self, cluster: &Cluster, point: u16) -> DVec3 {
        self.exact_in_world[cluster.points.start as usize * WIDE + usize::from(point)]
    }

    /// Projects the points of a cluster.
    pub fn project(&self, level: Level, eye: &Eye, cluster: &Cluster, seen: &mut SeenPoints) {
        let points = &self.points[cluster.points.start as usize..cluster.points.end as usize];
        let focal = eye.focal_px as f32;
        let scale = |at: [f32; 3]| [at[0], focal * at[1], -focal * at[2]];
        let origin = scale(eye.see(cluster.center_in_world).as_vec3().to_array());
        let turn = eye.body_from_world.to_cols_array_2d().map(|column| scale(column.map(|part| part as f32)));
        seen.blocks.resize(points.len(), [[0.0; WIDE]; 3]);
        project(level, points, origin, &turn, &mut seen.blocks);
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.clusters)
            + size_of_val(&*self.polygons)
            + size_of_val(&*self.corners)
            + size_of_val(&*self.points)
            + size_of_val(&*self.exact_in_world)
    }
}

simd_kernel! {
    fn project(points: &[[[f32; WIDE]; 3]], origin: [f32; 3], turn: &[[f32; 3]; 3], seen: &mut [[[f32; WIDE]; 3]]) {
        for (point, seen) in points.iter().zip(seen) {
            for k in 0..WIDE {
                let at = |part: usize| {
                    origin[part] + (point[0][k] * turn[0][part] + point[1][k] * turn[1][part] + point[2][k] * turn[2][part])
                };
                let ahead = at(0);
                seen[0][k] = ahead;
                seen[1][k] = at(1) / ahead;
                seen[2][k] = at(2) / ahead;
            }
        }
    }
}
