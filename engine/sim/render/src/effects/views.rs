//! Six views from one place, a quarter turn each, that see in all directions together.

use cosfly_frames::{DMat3, DVec3, Pose};

/// Axes of a view (ahead, right, up) as columns, before the camera.
pub(crate) type View = DMat3;

/// The camera's own view.
pub(crate) const AHEAD: View = DMat3::IDENTITY;

/// Ahead, to the right, behind, to the left, up, down.
pub(crate) fn views() -> impl Iterator<Item = View> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    [(x, y, z), (y, -x, z), (-x, -y, z), (-y, x, z), (z, y, -x), (-z, y, x)]
        .into_iter()
        .map(|(ahead, right, up)| DMat3::from_cols(ahead, right, up))
}

/// Pose of a view of a camera.
pub(crate) fn turned(pose: &Pose, view: &View) -> Pose {
    if *view == AHEAD { *pose } else { Pose::of_axes(pose.position_in_world, pose.world_from_body() * *view) }
}
