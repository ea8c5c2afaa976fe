//! The nouns of the field as plain data: no algorithm, no file, no clock. Everybody imports them from here.
//!
//! World frame: CARLA's (left-handed, x forward, y right, z up), metres; angles in radians. See `cosfly-frames`.

mod around;
mod body;
mod body_kind;
mod camera;
pub mod channels;
mod frame_images;
mod instance;
mod key_points;
mod lane;
mod lens;
mod looks;
mod motion_blur;
mod noise;
mod optics;
mod oriented_box;
mod rolling_shutter;
mod season;
mod semantics;
mod town;
mod traffic;
mod trajectory;
mod view;
mod weather;

pub use around::{Around, Followed};
pub use body::{Body, BodyPlan};
pub use body_kind::{BodyKind, BodyKindRow, Driving, Walking};
pub use camera::{Camera, Mount, StereoEye};
pub use channels::{Channel, ChannelImage, ChannelSet};
pub use frame_images::FrameImages;
pub use instance::{BodyId, TARGET_INSTANCE, largest_object_instance, object_instance};
pub use key_points::{BodyInSpace, KEY_POINTS, KeyPoint, SKELETON, Shown};
pub use lane::{Lane, LaneKind};
pub use lens::{Lens, LensModel};
pub use looks::{Bag, BodyBuild, Colour, Dye, Gait, Outfit, Traits};
pub use motion_blur::MotionBlur;
pub use noise::Noise;
pub use optics::Optics;
pub use oriented_box::OrientedBox;
pub use rolling_shutter::RollingShutter;
pub use season::Season;
pub use semantics::SemanticLabel;
pub use town::{
    MapOrigin, Obstacle, ObstacleKind, SimplificationReport, SurfaceMesh, Synthetic, Town, WalkableKind,
    WalkablePolygon,
};
pub use traffic::Traffic;
pub use trajectory::{
    Certificate, FlightLabel, FramePerturbation, Limits, Perturbation, PerturbationKind, PlanOutcome, TermCost,
    Trajectory,
};
pub use view::{BodyView, PixelBox, TargetView};
pub use weather::Weather;
