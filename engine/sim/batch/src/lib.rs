//! Small pictures of many cameras at once: planar depth, semantic and instance ids, target masks, exact where the large
//! renderer (`cosfly-render`) is.
//!
//! [`BatchScene`] is made once per town and shared by all cameras and threads. One [`BatchRenderer`] draws pictures of one
//! size: [`BatchRenderer::render`] takes any number of [`BatchView`]s and writes into buffers of the caller ([`Outputs`]), picture
//! after picture. A picture depends on its own view only: never on the batch around it, the order, or the number of threads.
//!
//! Every face is a plane whose inverse depth is linear over the image. A box is hit where the nearest of the planes that
//! its rays enter by lies before the farthest of those they leave by ([`raster`]); ground and figures are convex polygons
//! between linear edges. Eight pixels are compared at a time in f32; the depth of the faces that win is evaluated in f64
//! ([`resolve`]).

mod boxes;
mod buried;
mod canvas;
mod colours;
mod eye;
mod faces;
mod figures;
mod ground;
mod hidden;
mod lanes;
mod on_request;
mod outputs;
mod painter;
mod raster;
mod renderer;
mod resolve;
mod scene;
mod view;
mod zorder;

pub use on_request::OnRequest;
pub use outputs::Outputs;
pub use renderer::BatchRenderer;
pub use scene::BatchScene;
pub use view::BatchView;
