//! Recorded tracks in a town: projected, timed by frames, on the ground, with what is odd about them in words.

use super::curve::Curve;
use super::{RecordedConfig, RecordedError, RecordedPoint, RecordedTrack, Recording};
use crate::obstruction::Obstruction;
use cosfly_domain::{Body, BodyKind, BodyPlan, Town, Traffic};
use cosfly_frames::{DVec2, DVec3, Seed, TargetState, real};
use cosfly_geodata::reference::GeoReference;
use cosfly_town::GroundIndex;
use cosfly_town::world::WorldFromMap;
use cosfly_world::{Clock, Prescribed, Snapshot};

/// Slower than this, a recorded person stands, m/s: below it, directions are the annotators' noise.
const STANDING_MPS: f64 = 0.1;

/// Smallest radius of a person, metres, however near two come.
const THINNEST_M: f64 = 0.05;

impl Recording {
    /// The recorded people in a town, at every frame of the clock; its notes come on top of the recording's own warnings. Who is outside the town is absent; who comes back is another
    /// person.
    ///
    /// # Errors
    /// When places are longitudes and latitudes and the town has no known projection, and when nobody is in the town.
    pub fn placed(
        &self,
        town: &Town,
        config: &RecordedConfig,
        clock: Clock,
        seed: Seed,
    ) -> Result<Prescribed, RecordedError> {
        let from_file = Placing::new(self, town, config)?;
        let ground = GroundIndex::new(town);
        let first_s = self.tracks.iter().flat_map(|track| track.points.first()).map(|point| point.time_s);
        let start_s = first_s.fold(f64::INFINITY, f64::min) + config.start_s;
        let mut bodies = vec![];
        let (mut outside, mut timely) = (0, 0);
        for (number, track) in self.tracks.iter().enumerate() {
            let states = states_of(track, &from_file, clock, start_s);
            timely += usize::from(!states.1.is_empty());
            outside +=
                put_on_ground(track, states, &ground, town, config, seed.child("recorded", number as u64), &mut bodies);
        }
        if bodies.is_empty() {
            let frames_s = f64::from(clock.frames) * clock.dt_s;
            if timely == 0 {
                let message = format!("no recorded person is present in the {frames_s} s from `start_s` on");
                return Err(RecordedError::new(message).hint("change `start_s`, or simulate longer"));
            }
            return Err(self.elsewhere(&from_file, town, timely));
        }
        let mut notes = vec![];
        if outside > 0 {
            notes.push(format!("recorded people leave the town: {outside} of their frames are left out"));
        }
        notes.extend(meetings_with_things(&bodies, town)?);
        notes.extend(make_room(&mut bodies, clock));
        Ok(Prescribed::new(bodies, clock.dt_s, notes))
    }
}

impl Recording {
    /// Why nobody is in the town: the distance of the first recorded place, and what may be wrong with it.
    fn elsewhere(&self, from_file: &Placing, town: &Town, people: usize) -> RecordedError {
        let middle = (0.5 * (town.min_in_world + town.max_in_world)).truncate();
        let first = self.tracks.iter().flat_map(|track| track.points.first()).next();
        let away_m = first.map_or(f64::NAN, |point| (from_file.place(point.at) - middle).length());
        let place = match away_m {
            away_m if away_m.is_finite() => format!("the first place is {away_m:.0} m from its middle"),
            _ => "the first place is outside of its projection".to_owned(),
        };
        let message = format!("none of the {people} recorded people is in the town: {place}");
        RecordedError::new(message).hint(match self.is_geographic {
            true => "is the map of the place of the recording? GeoJSON has the longitude first",
            false => "check `origin_m`, `turn_deg` and `y_is_left`",
        })
    }
}

/// From places of the file to the world.
struct Placing {
    reference: Option<GeoReference>,
    world: WorldFromMap,
    origin_m: DVec2,
    turn: (f64, f64),
    y_sign: f64,
}

impl Placing {
    fn new(recording: &Recording, town: &Town, config: &RecordedConfig) -> Result<Self, RecordedError> {
        let reference = match recording.is_geographic {
            false => None,
            true => Some(Self::reference(town)?),
        };
        Ok(Self {
            reference,
            world: WorldFromMap { offset_m: town.origin.offset_m },
            origin_m: DVec2::from_array(config.origin_m),
            turn: real::sin_cos(config.turn_deg.to_radians()),
            y_sign: if config.y_is_left { -1.0 } else { 1.0 },
        })
    }

    fn reference(town: &Town) -> Result<GeoReference, RecordedError> {
        let hint = "choose a map with a projection (OpenStreetMap, CityJSON, OpenDRIVE with `geoReference`), or give tracks in metres";
        let Some(text) = &town.origin.geo_reference else {
            let message =
                format!("the tracks are in degrees, but the town `{}` has no geographic reference", town.name);
            return Err(RecordedError::new(message).hint(hint));
        };
        GeoReference::parse(text).ok_or_else(|| {
            let why = GeoReference::why_unknown(text);
            let text: String = text.trim().chars().take(80).collect();
            let message = format!("the projection `{text}` of the town `{}` is not supported: {why}", town.name);
            RecordedError::new(message).hint(hint)
        })
    }

    fn place(&self, at: DVec2) -> DVec2 {
        if let Some(reference) = &self.reference {
            return self.world.point(reference.project(at.to_array()).extend(0.0)).truncate();
        }
        let (sin, cos) = self.turn;
        let own = DVec2::new(at.x, self.y_sign * at.y);
        self.origin_m + DVec2::new(cos * own.x - sin * own.y, sin * own.x + cos * own.y)
    }
}

/// First frame, places and velocities of a track at the frames within it.
fn states_of(track: &RecordedTrack, placing: &Placing, clock: Clock, start_s: f64) -> (u32, Vec<(DVec2, DVec2)>) {
    let (Some(first), Some(last)) = (track.points.first(), track.points.last()) else { return (0, vec![]) };
    let frame_of = |time_s: f64| (time_s - start_s) / clock.dt_s;
    let first_frame = (frame_of(first.time_s) - 1e-9).ceil().max(0.0);
    let end_frame = ((frame_of(last.time_s) + 1e-9).floor() + 1.0).min(f64::from(clock.frames));
    if first_frame >= end_frame {
        return (0, vec![]);
    }
    let knots = track.points.iter().map(|point: &RecordedPoint| (point.time_s, placing.place(point.at)));
    let mut curve = Curve::new(knots.collect());
    let frames = first_frame as u32..end_frame as u32;
    (first_frame as u32, frames.map(|frame| curve.at(start_s + f64::from(frame) * clock.dt_s)).collect())
}

/// Adds the stretches of a track that lie in the town; returns the number of frames that do not.
fn put_on_ground(
    track: &RecordedTrack,
    (first_frame, states): (u32, Vec<(DVec2, DVec2)>),
    ground: &GroundIndex,
    town: &Town,
    config: &RecordedConfig,
    seed: Seed,
    bodies: &mut Vec<Body>,
) -> usize {
    let mut stream = seed.stream("body");
    let height_m = stream.uniform(config.height.min_m, config.height.max_m);
    let radius_m = stream.uniform(config.radius.min_m, config.radius.max_m);
    let (low, high) = (town.min_in_world.truncate(), town.max_in_world.truncate());
    let (mut outside, mut stretches) = (0, 0);
    let mut open = false;
    let mut height_before_m: Option<f64> = None;
    for (frame, (place, velocity)) in (first_frame..).zip(states) {
        let z = match height_before_m {
            Some(before_m) => ground.ground_near(place.extend(before_m)).map(|point| point.height_m),
            None => ground.ground_height_m(place.x, place.y),
        };
        let is_inside = place.cmpge(low).all() && place.cmple(high).all();
        let Some(z) = z.filter(|_| is_inside) else {
            (outside, open) = (outside + 1, false);
            continue;
        };
        height_before_m = Some(z);
        if !open {
            stretches += 1;
            let source = if stretches == 1 { track.id.clone() } else { format!("{} ({stretches})", track.id) };
            let size_m = DVec3::new(2.0 * radius_m, 2.0 * radius_m, height_m);
            let looks = seed.child("looks", stretches);
            let plan = BodyPlan { source, kind: BodyKind::Pedestrian, size_m, looks, group: None };
            bodies.push(Body { plan, first_frame: frame, states: vec![] });
            open = true;
        }
        let Some(body) = bodies.last_mut() else { continue };
        let speed_mps = velocity.length();
        let heading_rad = match body.states.last() {
            Some(before) if speed_mps < STANDING_MPS => before.heading_rad,
            _ => real::atan2(velocity.y, velocity.x),
        };
        let speed_mps = if speed_mps < STANDING_MPS { 0.0 } else { speed_mps };
        body.states.push(TargetState { feet_in_world: place.extend(z), heading_rad, speed_mps });
    }
    outside
}

/// A note where recorded people are inside the town's things.
fn meetings_with_things(bodies: &[Body], town: &Town) -> Result<Option<String>, RecordedError> {
    let places = || bodies.iter().flat_map(|body| &body.states).map(|state| state.feet_in_world.truncate());
    let low = places().fold(DVec2::INFINITY, DVec2::min) - 1.0;
    let high = places().fold(DVec2::NEG_INFINITY, DVec2::max) + 1.0;
    let things =
        Obstruction::new(town, low, high).map_err(|error| RecordedError::new(error.to_string()).hint(error.hint()))?;
    let (mut people, mut frames) = (0, 0);
    let mut first: Option<(String, DVec3)> = None;
    for body in bodies {
        let (radius_m, height_m) = (body.plan.radius_m(), body.plan.size_m.z);
        let is_met =
            |state: &&TargetState| !things.lets_through(state.feet_in_world, state.feet_in_world, radius_m, height_m);
        let mut met = body.states.iter().filter(is_met);
        if let Some(state) = met.next() {
            first.get_or_insert((body.plan.source.clone(), state.feet_in_world));
            (people, frames) = (people + 1, frames + 1 + met.count());
        }
    }
    Ok(first.map(|(source, at)| {
        format!(
            "{people} recorded people cross the town's things in {frames} frames, the first is `{source}` at ({:.1}, {:.1})",
            at.x, at.y
        )
    }))
}

/// Makes the radii of people so small that no two overlap in any frame; returns a note where some are.
fn make_room(bodies: &mut [Body], clock: Clock) -> Option<String> {
    let bodies_now = bodies.to_vec();
    let traffic = Traffic { dt_s: clock.dt_s, frames: clock.frames, bodies: bodies_now, ..Traffic::default() };
    let mut nearest_m = vec![f64::INFINITY; bodies.len()];
    for frame in 0..clock.frames {
        let snapshot: Snapshot = traffic.snapshot(frame);
        for body in snapshot.all() {
            let at = body.state.feet_in_world.truncate();
            snapshot.near(at, body.radius_m, |other| {
                if other.number != body.number {
                    let away_m = (other.state.feet_in_world.truncate() - at).length();
                    nearest_m[body.number as usize] = nearest_m[body.number as usize].min(away_m);
                }
            });
        }
    }
    let (mut smaller, mut smallest_m) = (0, f64::INFINITY);
    for (body, nearest_m) in bodies.iter_mut().zip(nearest_m) {
        let room_m = (0.5 * nearest_m - 1e-9).max(THINNEST_M);
        if room_m < body.plan.radius_m() {
            (body.plan.size_m.x, body.plan.size_m.y) = (2.0 * room_m, 2.0 * room_m);
            (smaller, smallest_m) = (smaller + 1, smallest_m.min(room_m));
        }
    }
    (smaller > 0).then(|| {
        format!("{smaller} recorded people come nearer to others than their radii; the smallest radius is now {smallest_m:.2} m")
    })
}
