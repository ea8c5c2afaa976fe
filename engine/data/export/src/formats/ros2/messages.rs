//! The messages of a bag, encoded.

use super::cdr::Cdr;
use cosfly_domain::{Camera, Lens, Mount};
use cosfly_frames::{DQuat, DVec3};
use cosfly_read::LoggedBox;
use cosfly_schema::log::cloud::{self, POINT_BYTES};
use cosfly_schema::log::messages::shift_px;
use cosfly_schema::tables::Edges;

/// The optical frame of the camera: x right, y down, z ahead.
pub const OPTICAL: &str = "camera_optical_frame";

/// A time in a frame.
#[derive(Clone, Copy, Debug)]
pub struct Header<'a> {
    /// Time, nanoseconds.
    pub time_ns: u64,
    /// Name of the coordinate frame.
    pub frame: &'a str,
}

/// Place of a child frame in its parent, right-handed, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Origin of the child.
    pub position: DVec3,
    /// Rotation from the child's axes to the parent's.
    pub rotation: DQuat,
}

/// Change of a child frame, along its own axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Velocity, m/s.
    pub linear: DVec3,
    /// Turn around the axes, rad/s.
    pub angular: DVec3,
}

/// A body in a picture.
#[derive(Clone, Debug)]
pub struct Detected<'a> {
    /// Kind, such as `pedestrian`.
    pub kind: &'a str,
    /// Id in the dataset's instance images.
    pub instance: u32,
    /// Edges around the visible pixels: left, top, right, bottom.
    pub edges_px: Edges,
}

impl Cdr {
    fn time(&mut self, time_ns: u64) {
        self.i32((time_ns / 1_000_000_000) as i32);
        self.u32((time_ns % 1_000_000_000) as u32);
    }

    /// A `std_msgs/Header`.
    pub fn header(&mut self, header: Header<'_>) {
        self.time(header.time_ns);
        self.text(header.frame);
    }

    fn vector(&mut self, vector: DVec3) {
        self.f64s(&vector.to_array());
    }

    fn pose(&mut self, placed: &Placed) {
        self.vector(placed.position);
        self.f64s(&placed.rotation.to_array());
    }

    fn covariance(&mut self) {
        self.f64s(&[0.0; 36]);
    }

    /// A sequence without elements.
    fn nothing(&mut self) {
        self.u32(0);
    }
}

/// `rosgraph_msgs/Clock`.
pub fn clock(time_ns: u64) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.time(time_ns);
    cdr.finish()
}

/// `std_msgs/String`.
pub fn string(text: &str) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.text(text);
    cdr.finish()
}

/// `std_msgs/Float64MultiArray` of a reading, labelled with the names of its quantities.
pub fn reading(quantities: &[String], values: &[f64]) -> Vec<u8> {
    let count = values.len() as u32;
    let mut cdr = Cdr::new();
    cdr.u32(1);
    cdr.text(&quantities.join(","));
    // Size, stride, offset of the data; the data.
    [count, count, 0, count].into_iter().for_each(|number| cdr.u32(number));
    cdr.f64s(values);
    cdr.finish()
}

/// `tf2_msgs/TFMessage` of parents, children and their places.
pub fn transforms(time_ns: u64, list: &[(&str, &str, Placed)]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.u32(list.len() as u32);
    for (parent, child, placed) in list {
        cdr.header(Header { time_ns, frame: parent });
        cdr.text(child);
        cdr.pose(placed);
    }
    cdr.finish()
}

/// `nav_msgs/Odometry`: the truth, without covariance.
pub fn odometry(header: Header<'_>, child: &str, placed: &Placed, motion: &Motion) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.text(child);
    cdr.pose(placed);
    cdr.covariance();
    cdr.vector(motion.linear);
    cdr.vector(motion.angular);
    cdr.covariance();
    cdr.finish()
}

/// `geometry_msgs/TwistStamped`.
pub fn twist(header: Header<'_>, motion: &Motion) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.vector(motion.linear);
    cdr.vector(motion.angular);
    cdr.finish()
}

/// `sensor_msgs/Imu` of rates (rad/s) and specific forces (m/s^2) along right-handed axes, without orientation.
pub fn imu(header: Header<'_>, rates_rad_s: &[f64], force_mps2: &[f64]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.f64s(&[0.0, 0.0, 0.0, 1.0]);
    // -1: there is no orientation.
    cdr.f64s(&[-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    cdr.f64s(rates_rad_s);
    cdr.f64s(&[0.0; 9]);
    cdr.f64s(force_mps2);
    cdr.f64s(&[0.0; 9]);
    cdr.finish()
}

/// `sensor_msgs/CameraInfo`. The middle of the top-left pixel is (0, 0), as ROS and OpenCV have it.
pub fn camera_info(header: Header<'_>, camera: &Camera, lens: &Lens, mount: &Mount) -> Vec<u8> {
    let focal = camera.focal_px();
    let [cx, cy] = [camera.width, camera.height].map(|pixels| 0.5 * f64::from(pixels) - 0.5);
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.u32(camera.height);
    cdr.u32(camera.width);
    cdr.text(lens.model.ros_name());
    let coefficients = lens.coefficients();
    cdr.u32(coefficients.len() as u32);
    cdr.f64s(&coefficients);
    cdr.f64s(&[focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0]);
    cdr.f64s(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    cdr.f64s(&[focal, 0.0, cx, shift_px(focal, mount), 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0]);
    // No binning, the whole picture, nothing rectified.
    (0..6).for_each(|_| cdr.u32(0));
    cdr.u8(0);
    cdr.finish()
}

/// `sensor_msgs/CompressedImage` of a file.
pub fn compressed_image(header: Header<'_>, format: &str, file: &[u8]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.text(format);
    cdr.byte_sequence(file);
    cdr.finish()
}

/// `sensor_msgs/PointCloud2` of a sweep.
pub fn point_cloud(header: Header<'_>, points: &[[u8; POINT_BYTES]]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.u32(1);
    cdr.u32(points.len() as u32);
    let fields = cloud::fields();
    cdr.u32(fields.len() as u32);
    for (name, offset, kind) in fields {
        cdr.text(name);
        cdr.u32(offset);
        cdr.u8(match kind {
            "u2" => 4,
            "u4" => 6,
            _ => 7,
        });
        cdr.u32(1);
    }
    cdr.u8(0);
    cdr.u32(POINT_BYTES as u32);
    cdr.u32((POINT_BYTES * points.len()) as u32);
    cdr.byte_sequence(points.as_flattened());
    cdr.u8(1);
    cdr.finish()
}

/// `sensor_msgs/Image` of rows of little-endian pixels.
pub fn image(header: Header<'_>, [width, height]: [u32; 2], encoding: &str, bytes: &[u8]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.u32(height);
    cdr.u32(width);
    cdr.text(encoding);
    cdr.u8(0);
    cdr.u32((bytes.len() / height.max(1) as usize) as u32);
    cdr.byte_sequence(bytes);
    cdr.finish()
}

/// `vision_msgs/Detection2DArray`: boxes around visible pixels. The middle of the top-left pixel is (0, 0).
pub fn detections(header: Header<'_>, bodies: &[Detected<'_>]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.header(header);
    cdr.u32(bodies.len() as u32);
    for body in bodies {
        let [left, top, right, bottom] = body.edges_px.map(f64::from);
        cdr.header(header);
        cdr.u32(1);
        cdr.text(body.kind);
        cdr.f64(1.0);
        // Detections of pictures have no pose.
        cdr.pose(&Placed { position: DVec3::ZERO, rotation: DQuat::IDENTITY });
        cdr.covariance();
        cdr.f64s(&[0.5 * (left + right) - 0.5, 0.5 * (top + bottom) - 0.5, 0.0, right - left, bottom - top]);
        cdr.text(&body.instance.to_string());
    }
    cdr.finish()
}

/// `visualization_msgs/MarkerArray` of boxes.
pub fn markers(header: Header<'_>, boxes: &[LoggedBox]) -> Vec<u8> {
    let mut cdr = Cdr::new();
    cdr.u32(boxes.len() as u32);
    for (number, shape) in boxes.iter().enumerate() {
        let (sin, cos) = cosfly_frames::real::sin_cos(0.5 * shape.yaw_rad);
        cdr.header(header);
        cdr.text(&shape.label);
        cdr.i32(number as i32);
        // Type: a cube. Action: add.
        cdr.i32(1);
        cdr.i32(0);
        cdr.pose(&Placed { position: shape.center_in_map, rotation: DQuat::from_xyzw(0.0, 0.0, sin, cos) });
        cdr.vector(2.0 * shape.half_extents_m);
        shape.colour.iter().for_each(|channel| cdr.f32(*channel as f32));
        cdr.f32(1.0);
        // It stays, does not follow its frame, and has no points, colours, texture, text or mesh.
        cdr.time(0);
        cdr.u8(0);
        cdr.nothing();
        cdr.nothing();
        cdr.text("");
        cdr.header(Header { time_ns: 0, frame: "" });
        cdr.text("");
        cdr.nothing();
        cdr.nothing();
        cdr.text("");
        cdr.text("");
        cdr.text("");
        cdr.nothing();
        cdr.u8(0);
    }
    cdr.finish()
}
