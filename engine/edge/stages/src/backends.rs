//! Rendering backends of this build, and how to get the others.

use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::Camera;
use cosfly_render::{Backend, BackendError, BackendKind, RenderConfig, Renderer};

/// Refuses a backend that this build does not have, before anything runs.
pub fn check(kind: BackendKind) -> Result<(), BackendError> {
    match kind {
        BackendKind::Cpu => Ok(()),
        BackendKind::Gpu if cfg!(feature = "gpu") => Ok(()),
        BackendKind::Gpu => Err(BackendError {
            message: "`backend` is `gpu`, but this cosfly was built without it".into(),
            hint: "build it with `cargo build --release -p cosfly --features gpu`, or leave `backend` out".into(),
        }),
    }
}

/// A backend for one camera with the look and the channels of a recipe.
pub fn open(config: &RenderConfig, camera: Camera) -> Result<Box<dyn Backend>, BackendError> {
    check(config.backend)?;
    #[cfg(feature = "gpu")]
    if config.backend == BackendKind::Gpu {
        let mut backend = cosfly_gpu::GpuBackend::new(camera)?;
        backend.set_look(config.look);
        backend.set_optics(config.optics);
        backend.set_channels(&config.channels);
        return Ok(Box::new(backend));
    }
    let mut renderer = Renderer::new(camera);
    renderer.set_look(config.look);
    renderer.set_optics(config.optics);
    renderer.set_channels(&config.channels);
    Ok(Box::new(renderer))
}

/// Diagnostic for drawing that fails in the middle of a run.
pub fn failure(kind: BackendKind, error: &BackendError) -> Box<Diagnostic> {
    Diagnostic::new("render-backend", Fault::Machine, format!("backend `{}`: {}", kind.name(), error.message))
        .hint(&error.hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backends_that_are_not_built_in_say_how_to_get_them() {
        check(BackendKind::Cpu).unwrap();
        if !cfg!(feature = "gpu") {
            assert!(check(BackendKind::Gpu).unwrap_err().hint.contains("--features gpu"));
        }
    }
}
