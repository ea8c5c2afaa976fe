//! How a planned trajectory is flown: the aim of its camera, and its perturbed twins.
//!
//! * [`aim`]: a pilot who frames, lags and leads.
//! * [`perturb`]: departures from an expert's flight.

pub mod aim;
pub mod perturb;
