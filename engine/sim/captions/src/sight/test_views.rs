//! Pictures with known facts.

use super::landmarks::Landmarks;
use super::view::{SeenPerson, WindowView};
use crate::facts::Wear;
use cosfly_domain::{BodyKind, Camera, Colour, Obstacle, ObstacleKind, OrientedBox};
use cosfly_frames::{DVec3, Pose, real};

/// Somebody at x, y (m) who walks along a yaw (degrees) at 1.3 m/s, seen by the camera of [`view`].
pub(crate) fn person(x: f64, y: f64, yaw_deg: f64, top: Colour) -> SeenPerson {
    let (across_px, height_px) = (320.0 + 320.0 * y / x, 400.0 / x);
    let edges = [across_px - 0.2 * height_px, 200.0, across_px + 0.2 * height_px, 200.0 + height_px];
    SeenPerson {
        feet_in_world: DVec3::new(x, y, 0.0),
        heading_rad: yaw_deg.to_radians(),
        speed_mps: 1.3,
        box_px: Some(edges),
        pixels: (0.3 * height_px * height_px) as u32,
        top,
    }
}

/// A town with a tree, a lamp and a building near the people of [`views`].
pub(crate) fn town() -> Landmarks {
    let thing = |kind, object_id, center: [f64; 3], half: [f64; 3]| Obstacle {
        shape: OrientedBox {
            center_in_world: DVec3::from_array(center),
            half_extents_m: DVec3::from_array(half),
            yaw_rad: 0.0,
        },
        kind,
        object_id,
        synthetic: false,
    };
    Landmarks::among(
        &[
            thing(ObstacleKind::TreeTrunk, 0, [12.5, 7.0, 1.2], [0.2, 0.2, 1.2]),
            thing(ObstacleKind::TreeCrown, 0, [12.5, 7.0, 3.2], [1.0, 1.0, 1.0]),
            thing(ObstacleKind::Lamp, 1, [17.0, -4.0, 2.5], [0.2, 0.2, 2.5]),
            thing(ObstacleKind::Building, 2, [21.0, 0.0, 4.0], [3.0, 12.0, 4.0]),
        ],
        &[],
    )
}

/// A picture 640 pixels wide, taken 5 m above the world's origin along x. Everybody walked on for 2 s.
pub(crate) fn view(target: SeenPerson, others: Vec<SeenPerson>) -> WindowView {
    let (sin, cos) = real::sin_cos(target.heading_rad);
    WindowView {
        camera: Pose::looking_at(DVec3::Z * 5.0, DVec3::new(12.0, 0.0, 1.0)),
        optics: Camera { width: 640, height: 480, horizontal_fov_rad: 90f64.to_radians() },
        wide_lens: None,
        kind: BodyKind::Pedestrian,
        wear: Some(Wear { top: target.top, trousers: Colour::Blue, backpack: false }),
        moved_in_world: 2.0 * target.speed_mps * DVec3::new(cos, sin, 0.0),
        target,
        others,
    }
}

/// Pictures with every kind of fact.
pub(crate) fn views() -> Vec<WindowView> {
    let target = |y, yaw_deg| person(12.0, y, yaw_deg, Colour::Red);
    let still = SeenPerson { speed_mps: 0.0, ..target(-5.0, 0.0) };
    let hidden = SeenPerson { box_px: None, pixels: 0, ..target(0.0, 0.0) };
    let faint = SeenPerson { pixels: 5, ..person(13.0, 5.5, 90.0, Colour::Grey) };
    let follower = person(10.0, 0.3, 5.0, Colour::Black);
    vec![
        view(target(0.0, 0.0), vec![]),
        view(target(0.0, 45.0), vec![]),
        view(target(-4.0, 180.0), vec![person(22.0, 4.0, 90.0, Colour::White)]),
        view(target(4.0, 90.0), vec![person(12.0, -3.0, 0.0, Colour::White), person(14.0, 0.0, 0.0, Colour::Grey)]),
        view(target(0.0, 0.0), vec![follower]),
        view(target(0.0, 0.0), vec![follower, person(8.5, -0.4, -3.0, Colour::Green)]),
        view(target(0.0, 180.0), vec![person(10.0, 0.2, 178.0, Colour::Purple)]),
        view(target(0.0, -90.0), vec![person(13.0, 0.2, -90.0, Colour::Beige)]),
        view(target(0.0, -90.0), vec![person(13.0, 0.2, -90.0, Colour::Beige), person(90.0, 3.0, 0.0, Colour::Red)]),
        view(still, vec![person(11.0, 5.0, 0.0, Colour::Orange)]),
        view(hidden, vec![person(11.0, 5.0, 0.0, Colour::Orange)]),
        view(target(-5.2, 0.0), vec![faint]),
        view(target(0.0, 0.0), vec![faint]),
        view(target(5.2, 0.0), vec![faint]),
        view(target(4.5, 0.0), vec![]),
        view(target(9.5, 0.0), vec![]),
        view(target(4.5, 90.0), vec![]),
        view(SeenPerson { speed_mps: 0.0, ..target(5.5, 0.0) }, vec![]),
        view(person(16.7, 3.0, 90.0, Colour::Red), vec![]),
    ]
}
