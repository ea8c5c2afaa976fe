//! The CPU renderer: RGB, planar depth, semantic and instance ids from one visibility pass.
//!
//! [`Scene`] is built once per town and shared; one [`Renderer`] per thread owns all buffers. A frame goes through
//! [`visibility`] (which face is nearest at each pixel centre), `passes` (depth and ids, exact, from the plane of that
//! face), `shade` (light, materials, weather) and [`target_view`] (how much of people is seen). Every channel comes
//! from the same face at the same pixel centre, so they agree pixel by pixel; only RGB is smoothed along edges afterwards.

pub mod backend;
mod buildings;
mod channel_set;
pub mod channels;
pub mod config;
pub mod effects;
mod faces;
mod found;
pub mod frame;
mod ground_polygons;
mod kerb_lines;
mod look;
mod outlook;
pub mod outside;
mod passes;
mod people;
pub mod preview;
mod props;
pub mod renderer;
pub mod scene;
mod setup;
mod shade;
mod stages;
mod target_view;

use cosfly_materials::{parts as scene_parts, roof_edges, roof_steps};
use cosfly_raster::{eye, nearer, visibility};

pub use backend::{Backend, BackendError};
pub use buildings::Buildings;
pub use channel_set::ChannelSet;
pub use channels::Channel;
pub use config::{BackendKind, ConfigProblem, GimbalConfig, RenderConfig};
pub use cosfly_figures::{BodyShape, Bystander, Clothes, Livery, TargetSetup, Walker, Wardrobe};
pub use cosfly_figures::{clothes, figure};
pub use cosfly_figures::{clothes_seed_of_target, gait_phase_rad, pedal_phase_rad, target_triangles, walker_triangles};
pub use cosfly_materials::presets;
pub use cosfly_materials::weather::{self, WeatherRanges};
pub use cosfly_models::{Model, ModelConfig, ModelFit, ModelKind};
pub use cosfly_optics::Optics;
pub use cosfly_raster::camera;
pub use effects::{Effects, Lens, Moment, MotionBlur, Noise, RollingShutter, Shot};
pub use found::{BodyPart, FoundFace, FoundPicture, FoundSource};
pub use frame::{ChannelImage, FrameImages, PersonView, PixelBox, RenderedFrame, TargetView};
pub use look::PictureLook;
pub use outlook::Outlook;
pub use people::LEAST_HEIGHT_PX;
pub use props::SceneModel;
pub use renderer::{FrameParts, Renderer};
pub use scene::{Scene, SceneTriangle};
pub use setup::FrameSetup;
pub use stages::Stages;
pub use target_view::measure as measure_target;
