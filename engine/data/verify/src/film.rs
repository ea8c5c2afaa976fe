//! [`Film`]: where the points that a picture shows are in another picture, by depth and by the poses of camera and bodies in the tables.
//!
//! Rows of a rolling shutter are taken at moments of their own. Between two frames the camera and everybody move evenly.

use super::body::{Body, PlacedBody};
use super::rows::{PlacedFlight, PlacedFrame};
use cosfly_domain::TARGET_INSTANCE;
use cosfly_frames::{DVec3, Pose, real};
use cosfly_optics::ReadoutStrips;

/// Rows from the edge of two strips within which the step of the depth decides in which one a place is.
const EDGE_PX: f64 = 0.05;
/// Share of a readout by which a stored one may differ.
const SAME_SHARE: f64 = 1e-9;

/// The rows of a film, and when those of its pictures were taken.
#[derive(Clone, Copy)]
pub struct Film<'a> {
    /// The flight.
    pub flight: &'a PlacedFlight,
    /// Its frames.
    pub frames: &'a [PlacedFrame],
    /// Bodies around the target, by frame.
    pub others: &'a [PlacedBody],
    /// Strips of its pictures; none where they are unknown.
    pub readout: Option<&'a ReadoutStrips>,
}

/// A point that a pixel shows.
#[derive(Clone, Copy, Debug)]
pub struct ShownPoint {
    /// Number of the pixel.
    pub pixel: usize,
    /// Depth, metres; infinite for the sky.
    pub depth_m: f64,
    /// Instance id of the body that carries it; 0 for what stands.
    pub carrier: u32,
}

/// Way of a point on the finished picture.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Where it is here, pixels.
    pub from: (f64, f64),
    /// Where it is there, pixels.
    pub to: (f64, f64),
    /// Depth there, metres; infinite for the sky.
    pub ahead_m: f64,
    /// Row there, of the picture without its lens.
    row: f64,
}

impl Way {
    /// Right and down, pixels.
    pub fn flow_px(&self) -> [f64; 2] {
        [self.to.0 - self.from.0, self.to.1 - self.from.1]
    }
}

/// Place and heading of a body.
type BodyState = (DVec3, f64);

impl Film<'_> {
    /// The strips of the other frame in which a point is seen at its row, and its ways there: none or several, where rows between two strips
    /// show it never or twice. Nothing of a point that is at the edge of two strips.
    pub fn ways(&self, point: ShownPoint, frames: (usize, usize)) -> Vec<(usize, Way)> {
        let Some(readout) = self.readout else { return vec![] };
        let mut found = vec![];
        for strip in 0..readout.ends_px.len() {
            let Some(way) = self.way(point, frames, strip) else { continue };
            let edges = [strip.checked_sub(1), Some(strip).filter(|it| it + 1 < readout.ends_px.len())];
            if edges.into_iter().flatten().any(|edge| (readout.ends_px[edge] - way.row).abs() < EDGE_PX) {
                return vec![];
            }
            if readout.strip_at(way.row) == strip {
                found.push((strip, way));
            }
        }
        found
    }

    /// Row of the picture without its lens, of the pixel centre that a pixel shows, and the column.
    fn shown_at(&self, pixel: usize) -> Option<(f64, f64)> {
        let camera = &self.flight.camera;
        let (row, column) = (pixel / camera.width as usize, pixel % camera.width as usize);
        // Through a lens, a pixel shows the nearest pixel centre of the ideal picture, told in steps of 1/256 pixel.
        let nearest = |at: f64| (((at - 0.5) * 256.0).round() / 256.0 + 0.5).floor() + 0.5;
        let seen = self.flight.lens.unbend(camera, (column as f64 + 0.5, row as f64 + 0.5))?;
        Some((nearest(seen.0), nearest(seen.1)))
    }

    /// The strip that took a pixel.
    pub fn strip_of(&self, pixel: usize) -> Option<usize> {
        Some(self.readout?.strip_at(self.shown_at(pixel)?.1))
    }

    /// Way of the point to where a strip of the other frame would have it; none where it is not before the other camera, out of the lens's
    /// reach, or carried by somebody who is not there.
    pub fn way(&self, point: ShownPoint, (frame, to): (usize, usize), strip: usize) -> Option<Way> {
        let (camera, offsets_s) = (&self.flight.camera, &self.readout?.offsets_s);
        let (u, v) = self.shown_at(point.pixel)?;
        let here_s = *offsets_s.get(self.readout?.strip_at(v))?;
        let there_s = *offsets_s.get(strip)?;
        let (here, beside) = (self.pose(frame, here_s)?, self.pose(to, there_s)?);
        let ray = camera.ray_in_world(&here, u, v);
        let seen = if point.depth_m.is_finite() {
            let mut place = here.position_in_world + point.depth_m * ray;
            if point.carrier != 0 {
                let (from, then) = (self.body(point.carrier, frame, here_s)?, self.body(point.carrier, to, there_s)?);
                place = then.0 + turned(place - from.0, then.1 - from.1);
            }
            beside.body_from_world_point(place)
        } else {
            beside.world_from_body().transpose() * ray
        };
        if seen.x < 0.05 {
            return None;
        }
        let DVec3 { x, y, z } = seen;
        let (centre_u, centre_v, focal_px) = camera.centre_and_focal_px();
        let bend = |u: f64, v: f64| self.flight.lens.bend(camera, (u, v));
        let row = centre_v - focal_px * z / x;
        let (from, to) = (bend(u, v), bend(centre_u + focal_px * y / x, row));
        Some(Way { from, to, ahead_m: if point.depth_m.is_finite() { x } else { f64::INFINITY }, row })
    }

    /// Pose of the camera some seconds after a frame: of its mount on the drone, whose place and angles change evenly.
    pub fn pose(&self, frame: usize, offset_s: f64) -> Option<Pose> {
        let here = self.frames.get(frame)?;
        if offset_s == 0.0 {
            return Some(here.camera_pose);
        }
        let (first, share) = self.between(frame, offset_s)?;
        let (a, b) = (&self.frames.get(first)?.pose, &self.frames.get(first + 1)?.pose);
        let angle = |from: f64, to: f64| from + share * real::wrap_angle_rad(to - from);
        Some(self.flight.mount.camera_pose(&Pose {
            position_in_world: a.position_in_world.lerp(b.position_in_world, share),
            pitch_rad: angle(a.pitch_rad, b.pitch_rad),
            yaw_rad: angle(a.yaw_rad, b.yaw_rad),
            roll_rad: angle(a.roll_rad, b.roll_rad),
        }))
    }

    /// Poses of the camera and the space of a body at the beginning, in the middle and at the end of a picture's readout; of the frame's
    /// own time alone where all rows are taken at once.
    pub fn sights(&self, frame: usize, instance: u32, space: &Body) -> Vec<(Pose, Body)> {
        let half_s = 0.5 * self.flight.readout_s;
        if half_s == 0.0 {
            return self.frames.get(frame).map(|row| (row.camera_pose, space.clone())).into_iter().collect();
        }
        let sight = |offset_s: &f64| {
            let feet = self.body(instance, frame, *offset_s)?.0;
            Some((self.pose(frame, *offset_s)?, Body { feet, ..space.clone() }))
        };
        [-half_s, 0.0, half_s].iter().filter_map(sight).collect()
    }

    /// The frame before a moment, and the share of the way to the next one; beyond the film's ends it goes on.
    fn between(&self, frame: usize, offset_s: f64) -> Option<(usize, f64)> {
        let last = self.frames.len().checked_sub(2)?;
        let at = frame as f64 + offset_s / self.flight.dt_s;
        let first = (at.floor().max(0.0) as usize).min(last);
        Some((first, at - first as f64))
    }

    /// State of a body some seconds after a frame; none where the body is absent.
    pub fn body(&self, instance: u32, frame: usize, offset_s: f64) -> Option<BodyState> {
        let here = self.body_in(instance, frame)?;
        if offset_s == 0.0 {
            return Some(here);
        }
        let (first, share) = self.between(frame, offset_s)?;
        let (Some(a), Some(b)) = (self.body_in(instance, first), self.body_in(instance, first + 1)) else {
            // Others stay where they come and go.
            return Some(here);
        };
        let share = if instance == TARGET_INSTANCE { share } else { share.clamp(0.0, 1.0) };
        Some((a.0.lerp(b.0, share), a.1 + share * real::wrap_angle_rad(b.1 - a.1)))
    }

    fn body_in(&self, instance: u32, frame: usize) -> Option<BodyState> {
        let row = self.frames.get(frame)?;
        if instance == TARGET_INSTANCE {
            return Some((row.target.feet_in_world, row.target.heading_rad));
        }
        let (first, end) = [0, 1].map(|more| self.others.partition_point(|body| body.frame < row.frame + more)).into();
        let body = self.others[first..end].iter().find(|body| body.instance == Some(instance))?;
        Some((body.space.feet, body.heading_rad))
    }
}

fn turned(way: DVec3, angle_rad: f64) -> DVec3 {
    let (sin, cos) = real::sin_cos(angle_rad);
    DVec3::new(cos * way.x - sin * way.y, sin * way.x + cos * way.y, way.z)
}

/// Strips of a film from what its log says of its camera; none where rows between its frames cannot be told.
///
/// # Errors
/// The fault, in words.
pub fn readout_of(
    flight: &PlacedFlight,
    ends: Option<&str>,
    offsets: Option<&str>,
) -> Result<Option<ReadoutStrips>, String> {
    let (ends, offsets) = match (ends, offsets) {
        (None, None) => return Ok((flight.readout_s == 0.0).then(ReadoutStrips::at_once)),
        (ends, offsets) => (ends.and_then(numbers), offsets.and_then(numbers)),
    };
    let (Some(ends_px), Some(offsets_s)) = (ends, offsets) else {
        return Err("the strips of its rolling shutter cannot be read".to_owned());
    };
    let height = f64::from(flight.camera.height);
    let (Some(bottom), true) = (ends_px.last().copied(), ends_px.len() == offsets_s.len()) else {
        return Err("its rolling shutter has not one moment for each strip".to_owned());
    };
    let (top, mut begin) = (height - bottom, height - bottom);
    for (strip, (end, offset_s)) in ends_px.iter().zip(&offsets_s).enumerate() {
        let due_s = flight.readout_s * ((0.5 * (begin + end) - top) / (bottom - top) - 0.5);
        let is_due = (offset_s - due_s).abs() <= SAME_SHARE * (1.0 + flight.readout_s);
        if !(*end > begin && is_due) {
            return Err(format!(
                "strip {strip} of its rolling shutter ends at row {end} and is taken {offset_s} s after the frame; `camera_readout_s` of \
                 table `trajectories` gives {due_s} s"
            ));
        }
        begin = *end;
    }
    // Between frames that are not those of the flight the tables do not have its motion.
    let is_whole = flight.every == 1 && flight.begins_ns == 0;
    Ok(Some(ReadoutStrips { ends_px, offsets_s }).filter(|_| is_whole))
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.strip_prefix('[')?
        .strip_suffix(']')?
        .split(',')
        .map(|it| it.trim().parse().ok().filter(|it: &f64| it.is_finite()))
        .collect()
}
