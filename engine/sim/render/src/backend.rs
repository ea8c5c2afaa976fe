//! The seam between a run and what draws its pictures: one trait, one list of kinds.

use crate::camera::Camera;
use crate::renderer::{FrameSetup, RenderedFrame, Renderer};
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What draws the pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BackendKind {
    /// cosfly's own renderer: exact, the same bytes on every machine.
    Cpu,
    /// A graphics card through wgpu; needs a cosfly built with the feature `gpu`.
    Gpu,
    /// A CARLA server, which is driven from outside of a run by a job file.
    Carla,
}

impl BackendKind {
    /// The name in recipes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
            Self::Carla => "carla",
        }
    }
}

/// Draws frames of a scene with one camera. A backend owns its buffers; a run keeps one per thread.
///
/// Every channel follows the conventions of [`crate::FrameImages`]: sampled at pixel centres, agreeing pixel by pixel,
/// planar depth in metres with infinity for the sky. [`RenderedFrame::target_pixels`] and
/// [`crate::measure_target`] give the target's view.
pub trait Backend: Send {
    /// The camera that it draws with.
    fn camera(&self) -> Camera;

    /// Draws all channels of one frame.
    ///
    /// # Errors
    /// What the device says; the CPU renderer never fails.
    fn render(&mut self, scene: &Scene, setup: &FrameSetup<'_>) -> Result<RenderedFrame<'_>, BackendError>;
}

/// Why a backend cannot draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackendError {
    /// What happened: a lower-case fragment.
    pub message: String,
    /// What to do about it.
    pub hint: String,
}

impl fmt::Display for BackendError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.message, self.hint)
    }
}

impl std::error::Error for BackendError {}

impl Backend for Renderer {
    fn camera(&self) -> Camera {
        Renderer::camera(self)
    }

    fn render(&mut self, scene: &Scene, setup: &FrameSetup<'_>) -> Result<RenderedFrame<'_>, BackendError> {
        Ok(Renderer::render(self, scene, setup))
    }
}
