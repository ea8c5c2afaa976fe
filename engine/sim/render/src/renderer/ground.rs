//! The ground of a frame, cluster by cluster from near to far.

use super::Renderer;
use super::mesh::BEHIND;
use crate::faces::{DrawnFace, FaceSource, ground_lift};
use crate::scene::Scene;
use cosfly_frames::DVec3;
use cosfly_materials::parts::Cluster;
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{MAX_CORNERS, NEAR_M, PlaneOnScreen, bounds};

impl Renderer {
    pub(super) fn draw_ground(&mut self, scene: &Scene, eye: &Eye) {
        self.visible.clear();
        for (index, cluster) in scene.clusters.iter().enumerate() {
            if let Some(key) = eye.order_if_seen(&self.screen, cluster.center_in_world, cluster.half_bounds_m) {
                self.visible.push((key, index as u32));
            }
        }
        self.visible.sort_unstable();
        for position in 0..self.visible.len() {
            let index = self.visible[position].1;
            let cluster = &scene.clusters[index as usize];
            self.draw_cluster(cluster, index, eye, scene.mesh.is_some());
        }
    }

    /// Whether all of the seen points lie behind what is drawn.
    fn is_hidden_cluster(&self) -> bool {
        let nearest_m = self.seen_points.iter().map(|(seen, _)| seen.x).fold(f64::INFINITY, f64::min);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (_, point) in &self.seen_points {
            for k in 0..2 {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        nearest_m >= NEAR_M && self.nearer.hides(low, high, 1.0 / nearest_m)
    }

    fn draw_cluster(&mut self, cluster: &Cluster, index: u32, eye: &Eye, is_behind: bool) {
        let screen = self.screen;
        self.seen_points.clear();
        self.seen_points.extend(cluster.points_in_world.iter().map(|point| {
            let seen = eye.see(*point);
            (seen, screen.point(seen))
        }));
        if self.is_hidden_cluster() {
            return;
        }
        for (number, polygon) in cluster.polygons.iter().enumerate() {
            let mut corners = [DVec3::ZERO; MAX_CORNERS];
            let mut points = [[0.0; 2]; MAX_CORNERS];
            let mut nearest_m = f64::INFINITY;
            let numbers = &cluster.corners[polygon.range()];
            let count = numbers.len().min(MAX_CORNERS);
            for ((corner, point), number) in corners.iter_mut().zip(&mut points).zip(numbers) {
                (*corner, *point) = self.seen_points[usize::from(*number)];
                nearest_m = nearest_m.min(corner.x);
            }
            let is_ahead = nearest_m >= NEAR_M;
            let (low, high) = bounds(&points[..count]);
            let rows = if is_ahead { self.nearest.rows_between(low, high) } else { Some((0, 0)) };
            let Some(rows) = rows else { continue };
            if is_ahead && self.nearer.hides(low, high, 1.0 / nearest_m) {
                continue;
            }
            let normal = eye.turn(polygon.normal_in_world);
            let Some(plane) = PlaneOnScreen::new(&screen, normal, eye.see(polygon.middle_in_world)) else { continue };
            let face = self.faces.len() as u32;
            let lift = ground_lift(polygon.label);
            let bias = if is_behind { (1.0 + lift) * f64::from(BEHIND) - 1.0 } else { lift };
            if is_ahead {
                self.nearest.draw_rows(&points[..count], rows, &plane.lifted(bias), face);
            } else {
                self.nearest.draw_polygon(&screen, &corners[..count], &plane, bias, face);
            }
            let source = FaceSource::Ground { cluster: index, polygon: number as u16 };
            let normal = polygon.normal_in_world.as_vec3().to_array();
            self.faces.push(DrawnFace { plane, normal, source, label: polygon.label.id(), instance: 0 });
        }
    }
}
