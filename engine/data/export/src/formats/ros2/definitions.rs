//! Definitions of the messages, as ROS 2 Humble and later have them, and what each of them is made of.

use std::collections::BTreeSet;

/// Line between a definition and those of its parts.
const SEPARATOR: &str = "================================================================================";

/// Types with their definitions. The name of a part stands in full.
const DEFINITIONS: &[(&str, &str)] = &[
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"),
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec"),
    ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"),
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation"),
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance"),
    ("geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1"),
    ("geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation"),
    (
        "geometry_msgs/TransformStamped",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
    ),
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular"),
    ("geometry_msgs/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist"),
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance"),
    ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"),
    (
        "nav_msgs/Odometry",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
         geometry_msgs/TwistWithCovariance twist",
    ),
    ("rosgraph_msgs/Clock", "builtin_interfaces/Time clock"),
    (
        "sensor_msgs/CameraInfo",
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\n\
         float64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi",
    ),
    ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data"),
    ("sensor_msgs/FluidPressure", "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance"),
    (
        "sensor_msgs/Image",
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data",
    ),
    (
        "sensor_msgs/Imu",
        "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
         geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
         geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance",
    ),
    (
        "sensor_msgs/MagneticField",
        "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance",
    ),
    (
        "sensor_msgs/NavSatFix",
        "uint8 COVARIANCE_TYPE_UNKNOWN=0\n\
         std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 altitude\n\
         float64[9] position_covariance\nuint8 position_covariance_type",
    ),
    (
        "sensor_msgs/NavSatStatus",
        "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nuint16 SERVICE_GPS=1\nint8 status\nuint16 service",
    ),
    (
        "sensor_msgs/PointCloud2",
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n\
         uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
    ),
    (
        "sensor_msgs/PointField",
        "uint8 UINT16=4\nuint8 UINT32=6\nuint8 FLOAT32=7\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
    ),
    ("sensor_msgs/RegionOfInterest", "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify"),
    ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a"),
    ("std_msgs/Float64MultiArray", "std_msgs/MultiArrayLayout layout\nfloat64[] data"),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"),
    ("std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride"),
    ("std_msgs/MultiArrayLayout", "std_msgs/MultiArrayDimension[] dim\nuint32 data_offset"),
    ("std_msgs/String", "string data"),
    ("tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"),
    ("vision_msgs/BoundingBox2D", "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y"),
    (
        "vision_msgs/Detection2D",
        "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\nvision_msgs/BoundingBox2D bbox\nstring id",
    ),
    ("vision_msgs/Detection2DArray", "std_msgs/Header header\nvision_msgs/Detection2D[] detections"),
    ("vision_msgs/ObjectHypothesis", "string class_id\nfloat64 score"),
    (
        "vision_msgs/ObjectHypothesisWithPose",
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
    ),
    ("vision_msgs/Point2D", "float64 x\nfloat64 y"),
    ("vision_msgs/Pose2D", "vision_msgs/Point2D position\nfloat64 theta"),
    (
        "visualization_msgs/Marker",
        "int32 CUBE=1\nint32 ADD=0\n\
         std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n\
         geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n\
         bool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n\
         sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n\
         string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials",
    ),
    ("visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers"),
    ("visualization_msgs/MeshFile", "string filename\nuint8[] data"),
    ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v"),
];

/// Definition of a type such as `sensor_msgs/Image`, followed by those of all its parts.
pub fn whole_definition(name: &'static str) -> String {
    let (mut text, mut known, mut waiting) = (String::new(), BTreeSet::from([name]), vec![name]);
    while let Some(next) = waiting.pop() {
        if !text.is_empty() {
            text.push_str(&format!("{SEPARATOR}\nMSG: {next}\n"));
        }
        let definition = definition(next);
        text.push_str(definition);
        text.push('\n');
        waiting.extend(parts(definition).filter(|part| known.insert(part)));
    }
    text
}

fn definition(name: &str) -> &'static str {
    DEFINITIONS.iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text)
}

/// Types that are not built in.
fn parts(definition: &'static str) -> impl Iterator<Item = &'static str> {
    let types = definition.lines().filter_map(|line| line.split([' ', '[']).next());
    types.filter(|part| part.contains('/'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_defined_once_and_the_list_is_sorted() {
        assert!(DEFINITIONS.is_sorted_by_key(|(name, _)| *name));
        for (name, text) in DEFINITIONS {
            for part in parts(text) {
                assert!(!definition(part).is_empty(), "`{part}` of `{name}`");
            }
            let whole = whole_definition(name);
            assert!(whole.starts_with(text));
            let mut heads: Vec<&str> = whole.lines().filter(|line| line.starts_with("MSG: ")).collect();
            let count = heads.len();
            heads.sort_unstable();
            heads.dedup();
            assert_eq!(heads.len(), count, "{whole}");
        }
    }
}
