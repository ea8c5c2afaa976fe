//! Messages of one frame: images, calibration, transforms, poses, annotations, target state.

use super::right_handed::{self, map_from_world_point};
use super::target_state::TargetStateMessage;
use crate::RenderedTrajectory;
use cosfly_domain::{Camera, Lens, Mount, PixelBox};
use cosfly_frames::{DQuat, DVec3, Pose, TargetState};
use foxglove::bytes::Bytes;
use foxglove::messages::{self, Timestamp};

/// Coordinate frame of the images.
pub const OPTICAL_FRAME: &str = "camera_optical";
/// Coordinate frame of the world, right-handed.
pub const MAP_FRAME: &str = "map";

/// Time of a log as a message.
pub fn timestamp(time_ns: u64) -> Timestamp {
    Timestamp::new((time_ns / 1_000_000_000) as u32, (time_ns % 1_000_000_000) as u32)
}

/// An image file (`jpeg` or `png`).
pub fn compressed_image(time_ns: u64, format: &str, file: Bytes) -> messages::CompressedImage {
    messages::CompressedImage {
        timestamp: Some(timestamp(time_ns)),
        frame_id: OPTICAL_FRAME.into(),
        data: file,
        format: format.into(),
    }
}

/// Calibration of the camera with its lens; the projection of the right camera of a pair is that of the left one.
pub fn calibration(time_ns: u64, camera: &Camera, lens: &Lens, mount: &Mount) -> messages::CameraCalibration {
    let focal = camera.focal_px();
    let (cx, cy) = (0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height));
    messages::CameraCalibration {
        timestamp: Some(timestamp(time_ns)),
        frame_id: OPTICAL_FRAME.into(),
        width: camera.width,
        height: camera.height,
        distortion_model: lens.model.ros_name().into(),
        d: lens.coefficients(),
        k: vec![focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0],
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![focal, 0.0, cx, shift_px(focal, mount), 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}

/// Fourth number of a projection: the place of the left camera of a pair in the right one, times the focal length.
pub fn shift_px(focal_px: f64, mount: &Mount) -> f64 {
    if mount.right_m == 0.0 { 0.0 } else { -focal_px * mount.right_m }
}

/// Pose at the target's feet, with the target's heading.
pub fn target_pose(record: &RenderedTrajectory, frame: usize) -> Pose {
    feet_pose(&record.trajectory.track.states[frame])
}

/// Pose at somebody's feet, with their heading.
pub fn feet_pose(state: &TargetState) -> Pose {
    Pose { position_in_world: state.feet_in_world, pitch_rad: 0.0, yaw_rad: state.heading_rad, roll_rad: 0.0 }
}

/// map -> drone -> camera_optical, and map -> target.
pub fn transforms(time_ns: u64, drone: &Pose, mount: &Mount, target: &Pose) -> messages::FrameTransforms {
    let in_map = |child: &str, pose: &Pose| {
        let translation = map_from_world_point(pose.position_in_world);
        transform(time_ns, child, translation, right_handed::map_from_body(pose))
    };
    let optical = messages::FrameTransform {
        parent_frame_id: "drone".into(),
        ..transform(
            time_ns,
            OPTICAL_FRAME,
            right_handed::camera_in_body(mount, drone),
            right_handed::body_from_optical(mount, drone),
        )
    };
    messages::FrameTransforms { transforms: vec![in_map("drone", drone), optical, in_map("target", target)] }
}

/// Transform from a child frame to the `map` frame.
pub fn transform(time_ns: u64, child: &str, translation_m: DVec3, rotation: DQuat) -> messages::FrameTransform {
    messages::FrameTransform {
        timestamp: Some(timestamp(time_ns)),
        parent_frame_id: MAP_FRAME.into(),
        child_frame_id: child.into(),
        translation: Some(right_handed::vector(translation_m)),
        rotation: Some(right_handed::quaternion(rotation)),
    }
}

/// One pose in the `map` frame.
pub fn pose_in_map(time_ns: u64, pose: &Pose) -> messages::PoseInFrame {
    messages::PoseInFrame {
        timestamp: Some(timestamp(time_ns)),
        frame_id: MAP_FRAME.into(),
        pose: Some(right_handed::pose(pose)),
    }
}

/// Trajectory or walk in the `map` frame.
pub fn path_in_map(poses: impl Iterator<Item = Pose>) -> messages::PosesInFrame {
    messages::PosesInFrame {
        timestamp: Some(timestamp(0)),
        frame_id: MAP_FRAME.into(),
        poses: poses.map(|pose| right_handed::pose(&pose)).collect(),
    }
}

/// Edges of a pixel box: left, top, right, bottom; the origin is the corner of the top-left pixel.
pub fn edges_px(pixel_box: &PixelBox) -> [u32; 4] {
    [pixel_box.u_min, pixel_box.v_min, pixel_box.u_max.saturating_add(1), pixel_box.v_max.saturating_add(1)]
}

/// Boxes of the target (visible: green; without obstacles: yellow) with its visibility, and boxes of other people
/// (blue).
pub fn annotations(time_ns: u64, record: &RenderedTrajectory, frame: usize) -> messages::ImageAnnotations {
    let view = &record.views[frame];
    let outline = |pixel_box: &PixelBox, [r, g, b]: [f64; 3], thickness: f64| {
        let [left, top, right, bottom] = edges_px(pixel_box).map(f64::from);
        let corner = |x, y| messages::Point2 { x, y };
        messages::PointsAnnotation {
            timestamp: Some(timestamp(time_ns)),
            r#type: messages::points_annotation::Type::LineLoop as i32,
            points: vec![corner(left, top), corner(right, top), corner(right, bottom), corner(left, bottom)],
            outline_color: Some(messages::Color { r, g, b, a: 1.0 }),
            thickness,
            ..messages::PointsAnnotation::default()
        }
    };
    let points = view.full_box.iter().map(|full| outline(full, [1.0, 1.0, 0.0], 1.0));
    let others = record.seen_in(frame).map(|(_, seen)| outline(&seen.view.visible_box, [0.3, 0.6, 1.0], 1.0));
    let text = view.full_box.iter().map(|full| messages::TextAnnotation {
        timestamp: Some(timestamp(time_ns)),
        position: Some(messages::Point2 { x: f64::from(full.u_min), y: f64::from(full.v_min) }),
        text: format!("visible {:.0} %", 100.0 * view.visible_by_pixels),
        font_size: 14.0,
        text_color: Some(messages::Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 }),
        background_color: Some(messages::Color { r: 0.0, g: 0.0, b: 0.0, a: 0.6 }),
        ..messages::TextAnnotation::default()
    });
    messages::ImageAnnotations {
        timestamp: Some(timestamp(time_ns)),
        points: points
            .chain(view.visible_box.iter().map(|seen| outline(seen, [0.0, 1.0, 0.0], 2.0)))
            .chain(others)
            .collect(),
        texts: text.collect(),
        ..messages::ImageAnnotations::default()
    }
}

/// State of the target in one frame.
pub fn target_state(record: &RenderedTrajectory, frame: usize) -> TargetStateMessage {
    let trajectory = &record.trajectory;
    let (state, view) = (&trajectory.track.states[frame], &record.views[frame]);
    let feet = map_from_world_point(state.feet_in_world);
    let event = trajectory.perturbation.as_ref().map(|perturbation| perturbation.frames[frame]);
    let edges = |pixel_box: &Option<PixelBox>| pixel_box.iter().flat_map(edges_px).collect();
    TargetStateMessage {
        frame: frame as u32,
        time_s: record.times().s(frame),
        feet_x_m: feet.x,
        feet_y_m: feet.y,
        feet_z_m: feet.z,
        heading_rad: -state.heading_rad,
        speed_mps: state.speed_mps,
        height_m: trajectory.track.height_m,
        radius_m: trajectory.track.radius_m,
        in_view: view.in_view,
        visible_by_rays: view.visible_by_rays,
        visible_by_pixels: view.visible_by_pixels,
        visible_pixels: view.pixels,
        visible_box_px: edges(&view.visible_box),
        full_box_px: edges(&view.full_box),
        occluder_instance: view.occluder_instance,
        distance_m: record.distance_m(frame),
        drone_clearance_m: trajectory.clearance_m[frame],
        expert_frame: event.map_or(frame as u32, |event| event.expert_frame),
        position_event: event.is_some_and(|event| event.position),
        rotation_event: event.is_some_and(|event| event.rotation),
    }
}
