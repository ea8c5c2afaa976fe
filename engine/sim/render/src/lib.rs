//! The CPU renderer: RGB, planar depth, semantic and instance ids from one visibility pass.
//!
//! [`Scene`] is built once per town and shared; one [`Renderer`] per thread owns all buffers. A frame goes through
//! [`cosfly_raster::visibility`] (which face is nearest at each pixel centre), `passes` (depth and ids, exact, from the plane of that
//! face), `shade` (light, materials, weather) and `target_view` (how much of people is seen). Every channel comes
//! from the same face at the same pixel centre, so they agree pixel by pixel; only RGB is smoothed along edges afterwards.

mod body_bounds;
mod buildings;
mod cameras;
pub mod config;
pub mod effects;
mod faces;
mod found;
pub mod frame;
mod lenses;
mod look;
mod mesh_labels;
mod outlook;
pub mod outside;
mod parked;
mod passes;
mod people;
mod props;
pub mod renderer;
mod rig;
mod scan_air;
pub mod scene;
mod scene_mesh;
mod scene_splats;
mod setup;
mod shade;
mod stages;
mod target_view;

pub use body_bounds::LEAST_HEIGHT_PX;
pub use buildings::Buildings;
pub use cameras::{CameraConfig, GimbalConfig};
pub use config::{ConfigProblem, RenderConfig};
pub use effects::{Effects, FrameBeside, Moment, Neighbours, Shot};
pub use found::{BodyPart, FoundFace, FoundPicture, FoundSource};
pub use frame::RenderedFrame;
pub use look::PictureLook;
pub use outlook::Outlook;
pub use props::SceneModel;
pub use renderer::{FrameParts, Renderer};
pub use scene::{Scene, SceneScan, SceneTriangle};
pub use scene_mesh::SceneMesh;
pub use scene_splats::SceneSplats;
pub use setup::FrameSetup;
pub use stages::Stages;
pub use target_view::measure as measure_target;
