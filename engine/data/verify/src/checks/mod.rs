//! Checks of single flights.
//!
//! To add one, write its file here and add two lines: its `mod` and its entry in [`OF_FLIGHTS`].

mod films;
mod in_space;
mod labels;
mod losses;
mod twins;

use crate::flight_rows::FlightRows;
use crate::report::VerifyReport;
use crate::{bodies, frames, sums};

/// A check of a flight: findings go into the report.
pub type Check = fn(&FlightRows<'_>, &mut VerifyReport);

/// All checks of single flights, in the order of their findings.
pub const OF_FLIGHTS: &[Check] = &[
    |it, report| frames::check_frames(it.file, it.flight, it.frames, report),
    |it, report| sums::check_frames(it.flight, it.frames, report),
    |it, report| labels::compare(it.file, it.flight, it.frames, report),
    |it, report| bodies::check(it.bodies_file, it.flight, it.frames, it.bodies, it.objects, report),
    |it, report| frames::check_occluders(it.file, it.objects, it.bodies, it.frames, report),
    |it, report| frames::check_pair(it.pairs, it.flight, it.frames, report),
    |it, report| frames::check_town(it.file, it.extent, it.flight, it.frames, report),
    twins::check,
    films::check,
    losses::check,
    in_space::check,
];
