//! Flights, what stands and what moves around them as plain numbers, for judges outside of this program
//! (`tests/outside/check_flights_among.py`).
//!
//! Little-endian records, each with a letter first. `S`, a scene: number of boxes (u32), each with middle, half extents (m) and yaw
//! (rad), seven f64. `F`, a flight in the last scene: length of its name (u32), the name; numbers of frames and of boxes that move (u32);
//! time between frames (s), least clearance (m), two f64; the waypoints, three f64 a frame; the boxes that move, seven f64 for each frame
//! of each. `N`, a path without a flight: length of its name (u32), the name.

use cosfly_domain::OrientedBox;
use cosfly_frames::DVec3;
use std::io::{self, Write};

/// A flight among boxes that move.
pub struct FlightAmong<'a> {
    /// Name of the path.
    pub name: &'a str,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Least distance that the flight was to keep, metres.
    pub clearance_m: f64,
    /// One place per frame; `None` where no flight was found.
    pub waypoints: Option<&'a [DVec3]>,
    /// Places of every box, frame by frame.
    pub movers: &'a [Vec<OrientedBox>],
}

/// Writes a scene.
///
/// # Errors
/// Those of the writer.
pub fn scene(out: &mut dyn Write, boxes: &[OrientedBox]) -> io::Result<()> {
    out.write_all(b"S")?;
    number(out, boxes.len())?;
    boxes.iter().try_for_each(|shape| place(out, shape))
}

/// Writes a flight in the scene written last.
///
/// # Errors
/// Those of the writer.
pub fn flight(out: &mut dyn Write, flight: &FlightAmong<'_>) -> io::Result<()> {
    out.write_all(if flight.waypoints.is_some() { b"F" } else { b"N" })?;
    number(out, flight.name.len())?;
    out.write_all(flight.name.as_bytes())?;
    let Some(waypoints) = flight.waypoints else { return Ok(()) };
    number(out, waypoints.len())?;
    number(out, flight.movers.len())?;
    reals(out, &[flight.dt_s, flight.clearance_m])?;
    waypoints.iter().try_for_each(|waypoint| reals(out, &waypoint.to_array()))?;
    flight.movers.iter().flatten().try_for_each(|shape| place(out, shape))
}

fn number(out: &mut dyn Write, number: usize) -> io::Result<()> {
    let number = u32::try_from(number).map_err(|_| io::Error::other("more than 4294967295 parts"))?;
    out.write_all(&number.to_le_bytes())
}

fn reals(out: &mut dyn Write, reals: &[f64]) -> io::Result<()> {
    reals.iter().try_for_each(|real| out.write_all(&real.to_le_bytes()))
}

fn place(out: &mut dyn Write, shape: &OrientedBox) -> io::Result<()> {
    reals(out, &shape.center_in_world.to_array())?;
    reals(out, &shape.half_extents_m.to_array())?;
    reals(out, &[shape.yaw_rad])
}
