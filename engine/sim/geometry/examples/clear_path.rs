//! Distance to the obstacles along a path between two houses: `cargo run -p cosfly-geometry --example clear_path`.

use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use cosfly_geometry::{BoxBvh, SpatialQuery};

/// Radius of the drone, metres.
const RADIUS_M: f64 = 0.5;

fn main() {
    let house = |x: f64, y: f64| OrientedBox {
        center_in_world: DVec3::new(x, y, 4.0),
        half_extents_m: DVec3::new(5.0, 3.0, 4.0),
        yaw_rad: 0.2,
    };
    let map = BoxBvh::build(vec![house(0.0, 6.0), house(2.0, -6.0)]);
    let path = [DVec3::new(-12.0, 0.0, 3.0), DVec3::new(0.0, 0.5, 3.0), DVec3::new(12.0, 6.0, 3.0)];
    for leg in path.windows(2) {
        let clearance_m = map.segment_clearance(leg[0], leg[1], 20.0);
        let verdict = if clearance_m > RADIUS_M { "free" } else { "blocked" };
        println!("{} to {}: {verdict}, {clearance_m:.2} m to the nearest wall", leg[0], leg[1]);
    }
}
