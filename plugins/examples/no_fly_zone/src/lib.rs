//! `no_fly_zone`: polygons with height bands that the drone keeps out of; with gradient.

use cosfly_plugin::{CostTerm, Metadata, Point, Run, Shape, cross_2d, params};

params! {
    /// A prism over a polygon.
    pub struct Zone {
        /// Corners of the polygon, x y in metres, in either direction round it.
        corners: Vec<[f64; 2]> = vec![];
        /// Lower end of the height band, metres.
        low_m: f64 = 0.0, [-1000.0, 10000.0];
        /// Upper end of the height band, metres.
        high_m: f64 = 500.0, [-1000.0, 10000.0];
    }
}

params! {
    /// Where not to fly.
    pub struct Params {
        /// The zones.
        zones: Vec<Zone> = vec![];
        /// Distance from a zone at which the cost begins, metres.
        margin_m: f64 = 5.0, [0.0, 100.0];
    }
}

/// `(margin - d)^2` over all zones nearer than the margin; d is the distance, negative inside.
pub struct NoFlyZone {
    params: Params,
}

impl CostTerm for NoFlyZone {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Keeps the drone out of polygons with height bands.";
        Metadata { name: "no_fly_zone", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        for (index, zone) in params.zones.iter().enumerate() {
            if zone.corners.len() < 3 {
                return Err(format!("zone {index} has {} corners; it needs 3", zone.corners.len()));
            }
            if zone.low_m >= zone.high_m {
                return Err(format!("zone {index} ends at {} m, below its beginning at {} m", zone.high_m, zone.low_m));
            }
        }
        Ok(Self { params })
    }

    fn shape(&self) -> Shape {
        Shape { support: 0, gradients: true }
    }

    fn begin(&mut self, _: Run) -> Result<(), String> {
        Ok(())
    }

    fn evaluate(
        &self,
        waypoints: &[Point],
        costs: &mut [f64],
        mut gradients: Option<&mut [Point]>,
    ) -> Result<(), String> {
        for zone in &self.params.zones {
            for (frame, waypoint) in waypoints.iter().enumerate() {
                let (distance, away) = signed_distance(zone, *waypoint);
                let inside = self.params.margin_m - distance;
                if inside > 0.0 {
                    costs[frame] += inside * inside;
                    if let Some(gradients) = gradients.as_deref_mut() {
                        (0..3).for_each(|axis| gradients[frame][axis] -= 2.0 * inside * away[axis]);
                    }
                }
            }
        }
        Ok(())
    }
}

/// Distance from the prism, negative inside, and the direction in which it grows.
fn signed_distance(zone: &Zone, point: Point) -> (f64, Point) {
    let (across, toward) = polygon_distance(&zone.corners, [point[0], point[1]]);
    let (up, direction) = if zone.low_m - point[2] > point[2] - zone.high_m {
        (zone.low_m - point[2], -1.0)
    } else {
        (point[2] - zone.high_m, 1.0)
    };
    if across > 0.0 && up > 0.0 {
        let distance = (across * across + up * up).sqrt();
        return (distance, [toward[0] * across / distance, toward[1] * across / distance, direction * up / distance]);
    }
    if across > up { (across, [toward[0], toward[1], 0.0]) } else { (up, [0.0, 0.0, direction]) }
}

/// The same in the plane.
fn polygon_distance(corners: &[[f64; 2]], point: [f64; 2]) -> (f64, [f64; 2]) {
    let (mut nearest, mut toward, mut is_inside) = (f64::INFINITY, [1.0, 0.0], false);
    for (index, a) in corners.iter().enumerate() {
        let b = corners[(index + 1) % corners.len()];
        let (edge, sight) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
        let share = (sight[0] * edge[0] + sight[1] * edge[1]) / (edge[0] * edge[0] + edge[1] * edge[1]).max(1e-12);
        let share = share.clamp(0.0, 1.0);
        let gap = [sight[0] - share * edge[0], sight[1] - share * edge[1]];
        let distance = (gap[0] * gap[0] + gap[1] * gap[1]).sqrt();
        if distance < nearest {
            nearest = distance;
            toward = if distance > 1e-9 { [gap[0] / distance, gap[1] / distance] } else { [0.0, 0.0] };
        }
        if (a[1] > point[1]) != (b[1] > point[1]) && (cross_2d(edge, sight) > 0.0) == (b[1] > a[1]) {
            is_inside = !is_inside;
        }
    }
    if is_inside { (-nearest, [-toward[0], -toward[1]]) } else { (nearest, toward) }
}

cosfly_plugin::cost_term!(NoFlyZone);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_grows_inwards_and_the_gradient_is_its_slope() {
        let corners = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
        let zones = vec![Zone { corners, low_m: 0.0, high_m: 40.0 }];
        let term = NoFlyZone::new(Params { zones, margin_m: 5.0 }).unwrap();
        let cost = |point: Point| {
            let mut costs = [0.0];
            term.evaluate(&[point], &mut costs, None).unwrap();
            costs[0]
        };
        assert_eq!(cost([-5.0, 5.0, 20.0]), 0.0);
        assert_eq!(cost([-1.0, 5.0, 20.0]), 16.0);
        assert_eq!(cost([3.0, 5.0, 20.0]), 64.0);
        for point in [[-1.0, 5.0, 20.0], [3.0, 5.0, 20.0], [-2.0, -1.0, 42.0], [4.0, 5.0, 39.0]] {
            let mut slope = [[0.0; 3]];
            term.evaluate(&[point], &mut [0.0], Some(&mut slope)).unwrap();
            for axis in 0..3 {
                let (mut low, mut high) = (point, point);
                low[axis] -= 1e-5;
                high[axis] += 1e-5;
                let wanted = (cost(high) - cost(low)) / 2e-5;
                assert!((slope[0][axis] - wanted).abs() < 1e-4, "{point:?} {axis}: {slope:?} {wanted}");
            }
        }
    }

    #[test]
    fn a_zone_that_is_none_is_refused() {
        let refused = |zone: Zone| NoFlyZone::new(Params { zones: vec![zone], margin_m: 1.0 }).err().unwrap();
        assert!(refused(Zone::default()).contains("0 corners"));
        let corners = vec![[0.0; 2]; 3];
        assert!(refused(Zone { corners, low_m: 9.0, high_m: 3.0 }).contains("below"));
    }
}
