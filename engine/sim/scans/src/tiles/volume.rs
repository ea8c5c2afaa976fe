//! Bounds of tiles: where they are, and whether they reach into an area.

use super::earth::Geodetic;
use cosfly_frames::{DVec3, real};
use glam::DMat4;
use serde::Deserialize;

/// Slack of an area in degrees, radians: half a metre.
const SLACK_RAD: f64 = 1e-7;
/// Points along each side of an area that are compared with regions.
const STEPS: u32 = 4;

/// Bounds of a tile: one of these.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Volume {
    /// West, south, east, north, radians; lowest and highest, metres above the ellipsoid. Never moved by transforms.
    pub region: Option<[f64; 6]>,
    /// Middle and three half axes.
    #[serde(rename = "box")]
    pub oriented: Option<[f64; 12]>,
    /// Middle and radius.
    pub sphere: Option<[f64; 4]>,
}

/// Frame of the joined tiles: x to the east, y to the north, z up, metres.
pub(super) struct Frame {
    /// The place of its origin on the Earth, where it is known.
    pub origin: Option<Geodetic>,
}

/// A rectangle of the frame that is wanted: west, south, east, north, metres.
pub(super) struct Area {
    sides_m: [f64; 4],
    /// Least and greatest latitude, and longitude from the origin's, radians.
    on_earth: Option<[[f64; 2]; 2]>,
}

impl Volume {
    /// Middle of the bounds in the frame of the tile.
    pub fn middle(&self) -> Option<DVec3> {
        let oriented = self.oriented.map(|it| [it[0], it[1], it[2]]);
        oriented.or(self.sphere.map(|it| [it[0], it[1], it[2]])).map(DVec3::from_array)
    }

    /// The place in the middle of a region, on its lowest ground.
    pub fn place(&self) -> Option<Geodetic> {
        let [west, south, east, north, low, _] = self.region?;
        let east = if east < west { east + real::TAU } else { east };
        Some(Geodetic { lat_rad: 0.5 * (south + north), lon_rad: 0.5 * (west + east), height_m: low })
    }
}

impl Area {
    /// The rectangle in a frame.
    pub fn new(sides_m: [f64; 4], frame: &Frame) -> Self {
        let on_earth = frame.origin.map(|origin| {
            let here = origin.earth_from_here();
            let [west, south, east, north] = sides_m;
            let between = |from: f64, to: f64, step: u32| from + (to - from) * f64::from(step) / f64::from(STEPS);
            let points = (0..=STEPS).flat_map(|column| (0..=STEPS).map(move |row| [column, row]));
            let places = points.map(|[column, row]| {
                let plan = DVec3::new(between(west, east, column), between(south, north, row), 0.0);
                let place = Geodetic::of_point(here.transform_point3(plan));
                [place.lat_rad, real::wrap_angle_rad(place.lon_rad - origin.lon_rad)]
            });
            let ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
            places.fold(ends, |ends, place| {
                [0, 1].map(|k| [ends[k][0].min(place[k] - SLACK_RAD), ends[k][1].max(place[k] + SLACK_RAD)])
            })
        });
        Self { sides_m, on_earth }
    }

    /// Whether bounds reach into the area; those that cannot be compared do.
    pub fn meets(&self, volume: &Volume, scene_from_tile: &DMat4, frame: &Frame) -> bool {
        if let (Some([west, south, east, north, ..]), Some([lats, lons]), Some(origin)) =
            (volume.region, self.on_earth, frame.origin)
        {
            let width = if east < west { east + real::TAU - west } else { east - west };
            let from = real::wrap_angle_rad(west - origin.lon_rad);
            // A region from beyond the other side of the Earth comes round to this one.
            let is_across = |from: f64| from <= lons[1] && from + width >= lons[0];
            return south <= lats[1] && north >= lats[0] && (is_across(from) || is_across(from - real::TAU));
        }
        let half = match (volume.oriented, volume.sphere) {
            (Some(it), _) => (1..4)
                .map(|k| DVec3::from_slice(&it[3 * k..]))
                .fold(DVec3::ZERO, |sum, axis| sum + scene_from_tile.transform_vector3(axis).abs()),
            (None, Some(it)) => DVec3::splat(it[3] * scale_of(scene_from_tile)),
            _ => return true,
        };
        let Some(middle) = volume.middle().map(|middle| scene_from_tile.transform_point3(middle)) else { return true };
        let [west, south, east, north] = self.sides_m;
        let is_apart = middle.x + half.x < west
            || middle.x - half.x > east
            || middle.y + half.y < south
            || middle.y - half.y > north;
        !is_apart
    }
}

/// Largest stretch of a transform.
pub(super) fn scale_of(matrix: &DMat4) -> f64 {
    [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.truncate().length()).into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_meet_boxes_spheres_and_regions_on_either_side_of_the_date_line() {
        let origin = Geodetic::of_degrees([10.0, 180.0, 0.0]);
        let frame = Frame { origin: Some(origin) };
        let area = Area::new([-100.0, -100.0, 100.0, 100.0], &frame);
        let region = |west: f64, east: f64| {
            let sides = [west, 9.9999, east, 10.0001].map(f64::to_radians);
            let region = Some([sides[0], sides[1], sides[2], sides[3], 0.0, 9.0]);
            area.meets(&Volume { region, ..Volume::default() }, &DMat4::IDENTITY, &frame)
        };
        assert!(region(179.9995, -179.9995) && region(-180.0, -179.9) && region(170.0, 179.9995));
        assert!(!region(-179.99, -179.9) && !region(170.0, 179.99));
        let sphere = |x: f64| Volume { sphere: Some([x, 0.0, 0.0, 5.0]), ..Volume::default() };
        let doubled = DMat4::from_scale(DVec3::splat(2.0));
        assert!(area.meets(&sphere(54.9), &doubled, &frame) && !area.meets(&sphere(55.1), &doubled, &frame));
        let turned = [104.0, 0.0, 0.0, 3.0, 3.0, 0.0, -3.0, 3.0, 0.0, 0.0, 0.0, 1.0];
        let oriented = |first: f64| {
            let mut numbers = turned;
            numbers[0] = first;
            Volume { oriented: Some(numbers), ..Volume::default() }
        };
        assert!(area.meets(&oriented(105.9), &DMat4::IDENTITY, &frame));
        assert!(!area.meets(&oriented(106.1), &DMat4::IDENTITY, &frame));
    }
}
