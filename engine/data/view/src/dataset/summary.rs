//! Numbers of all flights from one pass over table `frames`.

use super::causes::{Causes, Loss};
use crate::subject::FewPoints;
use cosfly_diagnose::{Result, Stop};
use cosfly_frames::real;
use cosfly_read::{PublishedDataset, PublishedFlight, RowValues, Rows, read};
use cosfly_schema::tables::Frames;

/// Angle between camera and sun below which a frame faces the sun, degrees.
const FACING_DEG: f64 = 35.0;

/// Row of a flight in the index.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Longest interval in which no pixel of the target is visible, seconds.
    pub losses_s: f64,
    /// Frame to begin with: in the middle of that interval, or where least is visible.
    pub worst_frame: usize,
    /// Why that frame is the worst, in words.
    pub reason: String,
    /// Mean share of the target that is visible.
    pub visible: f64,
    /// Smallest distance to an obstacle, metres.
    pub clearance_m: f64,
    /// Mean distance to the target, metres.
    pub distance_m: f64,
    /// Share of the frames that face the sun.
    pub sun_facing: f64,
    /// Most visible bodies in the target's clothes at once.
    pub look_alikes: f64,
    /// First place of the drone, metres.
    pub start_m: [f64; 2],
    /// The flight in few points, see [`FewPoints`].
    pub path: Vec<f64>,
}

/// Sums over the frames of a flight so far.
#[derive(Default)]
struct Pass {
    frames: usize,
    visible: f64,
    distance_m: f64,
    clearance_m: f64,
    facing: usize,
    look_alikes: u32,
    start_m: [f64; 2],
    least: (usize, f64),
    /// The loss that goes on.
    loss: Option<Loss>,
    longest: Loss,
    path: FewPoints,
}

/// The columns of table `frames` that are read.
struct Columns<'f> {
    ids: RowValues<'f, String>,
    pixels: RowValues<'f, u32>,
    by_pixels: RowValues<'f, f64>,
    by_rays: RowValues<'f, f64>,
    in_view: RowValues<'f, bool>,
    occluders: RowValues<'f, u32>,
    clearance: RowValues<'f, f64>,
    distance: RowValues<'f, f64>,
    camera_yaw: RowValues<'f, f64>,
    camera_pitch: RowValues<'f, f64>,
    look_alikes: RowValues<'f, u32>,
    place: [RowValues<'f, f64>; 2],
}

/// Summaries of all flights of a dataset, in its order.
///
/// # Errors
/// Damage of table `frames`; `stopped`.
pub fn summaries(dataset: &PublishedDataset, causes: &Causes, stop: &Stop) -> Result<Vec<Summary>> {
    let flights = dataset.flights();
    let empty = |flight: &PublishedFlight| Pass {
        clearance_m: f64::INFINITY,
        path: FewPoints::of(flight.frames),
        ..Pass::default()
    };
    let mut passes: Vec<Pass> = flights.iter().map(empty).collect();
    let mut open = (String::new(), None);
    for (_, path) in dataset.files("frames")? {
        read(&path, &mut |rows| {
            stop.check("reading the flights")?;
            let columns = Columns::of(rows)?;
            for row in 0..rows.len() {
                let id = columns.ids.text(row);
                if open.0 != id {
                    open = (id.to_owned(), dataset.place(id));
                }
                if let Some(place) = open.1 {
                    passes[place].add(&flights[place], &columns, row)?;
                }
            }
            Ok(())
        })?;
    }
    Ok(passes.into_iter().zip(flights).map(|(pass, flight)| pass.summary(flight, causes)).collect())
}

impl<'f> Columns<'f> {
    fn of(rows: &Rows<'f>) -> Result<Self> {
        let has_camera = rows.has(Frames::camera_yaw_deg);
        Ok(Self {
            ids: rows.values(Frames::trajectory_id)?,
            pixels: rows.values(Frames::visible_pixels)?,
            by_pixels: rows.values(Frames::visible_by_pixels)?,
            by_rays: rows.values(Frames::visible_by_rays)?,
            in_view: rows.values(Frames::in_view)?,
            occluders: rows.values(Frames::occluder_instance)?,
            clearance: rows.values(Frames::clearance_m)?,
            distance: rows.values(Frames::distance_m)?,
            camera_yaw: rows.values(if has_camera { Frames::camera_yaw_deg } else { Frames::drone_yaw_deg })?,
            camera_pitch: rows.values(if has_camera { Frames::camera_pitch_deg } else { Frames::drone_pitch_deg })?,
            look_alikes: rows.values(Frames::look_alikes)?,
            place: [rows.values(Frames::drone_x_m)?, rows.values(Frames::drone_y_m)?],
        })
    }
}

impl Pass {
    fn add(&mut self, flight: &PublishedFlight, columns: &Columns<'_>, row: usize) -> Result<()> {
        let frame = self.frames;
        let [x, y] = [columns.place[0].at(row)?, columns.place[1].at(row)?];
        if frame == 0 {
            self.start_m = [x, y];
            self.least = (0, f64::INFINITY);
        }
        let is_point = is_point(flight);
        let visible = if is_point { columns.by_rays.at(row)? } else { columns.by_pixels.at(row)? };
        self.path.add([x, y, visible]);
        if visible < self.least.1 {
            self.least = (frame, visible);
        }
        let is_lost = if is_point { visible <= 0.0 } else { columns.pixels.at(row)? == 0 };
        if is_lost {
            let loss = self.loss.get_or_insert_with(|| Loss::from(frame));
            loss.add(columns.in_view.at(row)?, columns.occluders.at(row)?);
        } else {
            self.end_loss();
        }
        self.frames += 1;
        self.visible += visible;
        self.distance_m += columns.distance.at(row)?;
        self.clearance_m = self.clearance_m.min(columns.clearance.at(row)?);
        self.look_alikes = self.look_alikes.max(columns.look_alikes.at(row)?);
        let ahead = [columns.camera_yaw.at(row)?, columns.camera_pitch.at(row)?].map(f64::to_radians);
        self.facing += usize::from(faces_sun(flight, ahead));
        Ok(())
    }

    fn end_loss(&mut self) {
        if let Some(loss) = self.loss.take().filter(|loss| loss.frames() > self.longest.frames()) {
            self.longest = loss;
        }
    }

    fn summary(mut self, flight: &PublishedFlight, causes: &Causes) -> Summary {
        self.end_loss();
        let mean = |sum: f64| sum / self.frames.max(1) as f64;
        let losses_s = self.longest.frames() as f64 * flight.dt_s;
        let (worst_frame, reason) = match self.longest.frames() {
            0 if self.frames == 0 => (0, "it has no frames".to_owned()),
            0 if self.least.1 >= 0.999 => (self.least.0, "always seen whole".to_owned()),
            0 => (self.least.0, format!("{:.0} % visible at frame {}", 100.0 * self.least.1, self.least.0)),
            frames => {
                let cause = causes.words(&flight.town, &self.longest);
                let begin = self.longest.begin;
                (begin + frames / 2, format!("{cause} for {losses_s:.1} s from frame {begin}"))
            }
        };
        Summary {
            losses_s,
            worst_frame,
            reason,
            visible: mean(self.visible),
            clearance_m: self.clearance_m,
            distance_m: mean(self.distance_m),
            sun_facing: mean(self.facing as f64),
            look_alikes: f64::from(self.look_alikes),
            start_m: self.start_m,
            path: self.path.numbers(),
        }
    }
}

/// Whether a point without extent is watched: it has no pixels.
pub fn is_point(flight: &PublishedFlight) -> bool {
    flight.target_radius_m == 0.0
}

/// Height of the sun, degrees; none in datasets that do not say.
pub fn sun_deg(flight: &PublishedFlight) -> Option<f64> {
    flight.weather_numbers.get("sun_altitude_angle").copied()
}

/// `day`, `dusk` (sun below 15 degrees) or `night` (below the horizon); empty where nobody knows.
pub fn light(flight: &PublishedFlight) -> &'static str {
    match sun_deg(flight) {
        None => "",
        Some(sun_deg) if sun_deg < 0.0 => "night",
        Some(sun_deg) if sun_deg < 15.0 => "dusk",
        Some(_) => "day",
    }
}

fn faces_sun(flight: &PublishedFlight, [yaw, pitch]: [f64; 2]) -> bool {
    let azimuth = flight.weather_numbers.get("sun_azimuth_angle").copied();
    let (Some(azimuth), Some(altitude)) = (azimuth, sun_deg(flight)) else { return false };
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    let cosine =
        real::sin(pitch) * real::sin(altitude) + real::cos(pitch) * real::cos(altitude) * real::cos(yaw - azimuth);
    altitude > 0.0 && cosine > real::cos(FACING_DEG.to_radians())
}
