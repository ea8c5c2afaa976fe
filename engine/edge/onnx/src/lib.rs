//! Networks in ONNX files: an interpreter with the same bytes on every processor.
//!
//! * [`OnnxModel`]: a file that was read and checked; it runs on [`Tensor`]s.
//! * `wire`, `file`, `numbers`: protocol buffers, and the messages of ONNX, read in place.
//! * `operators`: the list of operators, one function each.
//!
//! Numbers are 32-bit floats, added in the order in which they stand; functions are those of the crate `libm`. Sizes, counts and the
//! work of a run are bounded, and files are never trusted: no file that a stranger made harms who runs it.

mod attributes;
mod call;
mod file;
mod graph;
mod model;
mod numbers;
mod operators;
mod tensor;
mod wire;

pub use file::{MOST_BYTES, Port};
pub use model::OnnxModel;
pub use operators::OPERATORS;
pub use tensor::{Kind, Tensor, TensorValues};
