//! Films of a flight, before any picture is drawn.
//!
//! * [`shooting`]: camera, mount and weather that all frames share.
//! * [`walks`]: people and vehicles on their tracks, by the clock of a flight; [`looks`]: seeds of what they look like.
//! * [`nearby`]: who may appear in the pictures, or throw a shadow into them.
//! * [`rate`]: films of every n-th frame.
//! * [`body_rays`], [`hidden`]: how much of the target rays reach.
//! * [`in_space`]: boxes and key points of bodies, by a picture.

pub mod body_rays;
pub mod hidden;
pub mod in_space;
pub mod looks;
pub mod nearby;
pub mod rate;
pub mod shooting;
pub mod walks;

pub use shooting::Shooting;
pub use walks::{BodyOnTrack, followed_on};
