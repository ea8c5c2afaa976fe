//! [`open`]: the policy at a place.

use super::manners::Manners;
use super::place::Place;
use super::seam::Pilot;
use super::{baseline, onnx, python, socket};

/// The policy at a place, for one thread.
pub fn open(place: &Place, manners: &Manners) -> Box<dyn Pilot> {
    match place {
        Place::Baseline { name, variation } => Box::new(baseline::BaselinePilot::new(name, *variation)),
        Place::Onnx(policy) => Box::new(onnx::OnnxPilot::new(policy)),
        Place::Socket(address) => Box::new(socket::SocketPilot::new(address, manners.clone())),
        Place::Python { module, function } => Box::new(python::PythonPilot::new(module, function, manners.clone())),
    }
}
