//! The seam between a run and what draws its pictures: one trait.

use crate::frame::RenderedFrame;
use crate::renderer::Renderer;
use crate::scene::Scene;
use crate::setup::FrameSetup;
use cosfly_domain::Camera;
use std::fmt;

/// Draws frames of a scene with one camera. A backend owns its buffers; a run keeps one per thread.
///
/// Every channel follows the conventions of [`cosfly_domain::FrameImages`]: sampled at pixel centres, agreeing pixel by pixel,
/// planar depth in metres with infinity for the sky. [`RenderedFrame::target_pixels`] and
/// [`crate::measure_target`] give the target's view.
pub trait Backend: Send {
    /// The camera that it draws with.
    fn camera(&self) -> Camera;

    /// Draws all channels of one frame.
    ///
    /// # Errors
    /// Failure of the device; the CPU renderer never fails.
    fn render(&mut self, scene: &Scene, setup: &FrameSetup<'_>) -> Result<RenderedFrame<'_>, BackendError>;
}

/// Why a backend cannot draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BackendError {
    /// The failure: a lower-case fragment.
    pub message: String,
    /// A way out.
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
