//! The server: HTTP/1.1 on the loopback interface, for one person on this machine.
//!
//! * [`request`]: reads a request, strictly and within bounds; [`response`]: writes an answer with its headers.
//! * [`gate`]: who may ask; [`listen`]: connections, each on a thread, within bounds.
//!
//! Written on the standard library: the viewer needs GET and a few headers of HTTP/1.1, and each bound of it in sight.

mod gate;
mod listen;
mod request;
mod response;

pub use listen::Server;
pub use request::Request;
pub use response::Response;
