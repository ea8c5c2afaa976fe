//! The shore of a place at the water: a straight belt along its southern streets, and the water beyond.

use super::mesh::Mesh;
use crate::geometry::rectangle;
use crate::lot::Lot;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, real};

/// How far the water reaches out and beyond the last streets, metres.
const WATER_M: [f64; 2] = [190.0, 300.0];

/// The straight outer edge of the southern streets of a mesh; the water lies to its left.
pub struct Shore {
    /// Middle of the edge, metres.
    pub middle: DVec2,
    /// Its direction.
    pub along: DVec2,
    /// Its length, metres.
    pub length_m: f64,
}

impl Shore {
    /// South of a place on a mesh whose points stay where they are.
    pub fn south_of(site: &Site, mesh: &Mesh) -> Self {
        let (sin, cos) = real::sin_cos(mesh.heading_rad);
        let along = -DVec2::new(cos, sin);
        let corners = site.faces.iter().flat_map(|face| &face.outline);
        let farthest_m = corners.map(|corner| corner.dot(along.perp())).fold(f64::NEG_INFINITY, f64::max);
        Self { middle: farthest_m * along.perp(), along, length_m: mesh.columns_m.iter().sum() }
    }

    /// A point, so far along the edge from its middle and so far out.
    pub fn at(&self, along_m: f64, out_m: f64) -> DVec2 {
        self.middle + along_m * self.along + out_m * self.along.perp()
    }

    /// A line of some length along the edge.
    pub fn line(&self, out_m: f64, length_m: f64) -> [DVec2; 2] {
        [-0.5, 0.5].map(|share| self.at(share * length_m, out_m))
    }

    /// A belt between two distances, which ends so far beyond the edge on either side.
    pub fn belt(&self, from_m: f64, to_m: f64, beyond_m: f64) -> Vec<DVec2> {
        let size_m = DVec2::new(self.length_m + 2.0 * beyond_m, to_m - from_m);
        rectangle(self.at(0.0, from_m), self.along, size_m)
    }

    /// A boat along the edge, from its length and width and its height above the water.
    pub fn boat(&self, site: &mut Site, along_m: f64, out_m: f64, size_m: DVec2, height_m: f64) -> bool {
        let heading_rad = real::atan2(self.along.y, self.along.x);
        let lot = Lot { center: self.at(along_m, out_m), half_m: 0.5 * size_m, heading_rad };
        site.stand(ThingKind::Boat, lot, height_m, 0.5)
    }

    /// The water from some distance on.
    pub fn water(&self, site: &mut Site, from_m: f64) {
        let water = self.belt(from_m, from_m + WATER_M[0], WATER_M[1]);
        site.surface(&water, Surface::Water);
        site.take(&water);
    }
}
