//! [`Pictures`]: what the cameras of environments see, drawn in batches.

mod album;
mod format;

use crate::Episode;
use crate::environment::Environment;
use crate::others::BodyAtTime;
use cosfly_batch::{BatchRenderer, BatchView};
use cosfly_domain::channels::rgb;
use cosfly_domain::{BodyId, BodyKind, Weather};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture, gait_phase_rad};
use cosfly_frames::{DVec3, TargetState};
use rayon::prelude::*;

pub use album::{PictureBatch, Pixels};
pub use format::PictureFormat;

/// Draws what the cameras of environments see. A picture depends on its environment and the format alone.
pub struct Pictures {
    format: PictureFormat,
    renderer: BatchRenderer,
    threads: usize,
    /// Everybody else in each view.
    bystanders: Vec<Vec<FigureInPicture>>,
}

impl Pictures {
    /// Up to `threads` pictures are drawn at a time, on the rayon pool that calls [`Self::draw`]; the number changes no byte.
    pub fn new(format: PictureFormat, threads: usize) -> Self {
        let renderer = BatchRenderer::on_threads(format.width, format.height, threads);
        Self { format, renderer, threads, bystanders: vec![] }
    }

    /// Content of the pictures.
    pub fn format(&self) -> &PictureFormat {
        &self.format
    }

    /// Draws what each environment's camera sees now into an album of the format, from picture number `first` on. Pictures of a
    /// camera that sees nothing now are zeros.
    ///
    /// # Panics
    /// Where the album has no room for all pictures.
    pub fn draw(&mut self, environments: &[&Environment], album: &mut PictureBatch, first: usize) {
        self.draw_beside(environments, &[], album, first);
    }

    /// Pictures of drones of a team, each of which sees the others that fly.
    ///
    /// # Panics
    /// Where the album has no room for all pictures.
    pub fn draw_team(&mut self, environments: &[&Environment], album: &mut PictureBatch) {
        let drones: Vec<Option<BodyFigure>> = environments.iter().map(|environment| drone(environment)).collect();
        self.draw_beside(environments, &drones, album, 0);
    }

    /// Draws pictures with the drones of a team, each of which all environments see but its own.
    fn draw_beside(
        &mut self,
        environments: &[&Environment],
        drones: &[Option<BodyFigure>],
        album: &mut PictureBatch,
        first: usize,
    ) {
        let Self { format, renderer, threads, bystanders } = self;
        bystanders.resize_with(environments.len().max(bystanders.len()), Vec::new);
        let fill = |(own, (environment, seen)): (usize, (&&Environment, &mut Vec<FigureInPicture>))| {
            seen.clear();
            seen.extend(self::bystanders(environment, rain(format, environment)));
            let others = drones.iter().enumerate().filter(|(number, _)| *number != own);
            seen.extend(others.filter_map(|(number, figure)| {
                let instance = environment.episode().place.instance(BodyId::of_drone(number as u32));
                figure.map(|figure| FigureInPicture { figure, instance })
            }));
        };
        match *threads {
            0 | 1 => environments.iter().zip(&mut *bystanders).enumerate().for_each(fill),
            _ => environments.par_iter().zip(&mut *bystanders).enumerate().for_each(fill),
        }
        let has_colours = format.channels.contains(&rgb::CHANNEL);
        let views: Vec<BatchView<'_>> = (environments.iter().zip(&*bystanders))
            .map(|(environment, others)| BatchView {
                scene: environment.episode().place.scene(has_colours),
                pose: environment.camera(),
                horizontal_fov_rad: environment.settings().lens.horizontal_deg.to_radians(),
                target: Some(target(environment, rain(format, environment))),
                others,
                weather: weather(format, environment),
                look: format.look,
            })
            .collect();
        let pixels = format.pixels();
        let part = first * pixels..(first + views.len()) * pixels;
        renderer.render(&views, album.outputs(&part));
        album.cut_depth(&part, format.farthest_m, *threads);
        for number in (first..).zip(environments).filter_map(|(number, one)| one.is_blind().then_some(number)) {
            album.wipe(number);
        }
    }
}

/// The weather of a picture of an environment.
fn weather<'a>(format: &'a PictureFormat, environment: &'a Environment) -> Option<&'a Weather> {
    format.weather.as_ref().or(environment.episode().weather.as_ref())
}

/// Precipitation in a picture of an environment.
fn rain(format: &PictureFormat, environment: &Environment) -> f64 {
    weather(format, environment).map_or(0.0, |weather| weather.precipitation)
}

/// The target of an environment as it is drawn now, in a rain.
pub fn target(environment: &Environment, rain: f64) -> BodyFigure {
    let episode = environment.episode();
    let (track, state) = (&episode.target, episode.target_at(environment.observation().time_s));
    let body = episode.followed.as_ref().map_or(BodyShape::default(), |plan| BodyShape::of(plan.kind, plan.size_m));
    BodyFigure {
        state,
        height_m: track.height_m,
        radius_m: track.radius_m,
        clothes_seed: episode.looks,
        gait_phase_rad: gait_phase_rad(environment.target_covered_m(), track.height_m),
        body: body.in_rain(rain, &episode.looks),
    }
}

/// Length, width and height of a drone in pictures, metres.
const DRONE_M: DVec3 = DVec3::new(0.6, 0.6, 0.2);

/// The drone of an environment as others see it; none where its episode is over.
fn drone(environment: &Environment) -> Option<BodyFigure> {
    let observation = environment.observation();
    let state = TargetState {
        feet_in_world: observation.motion.position_in_world - DVec3::Z * (0.5 * DRONE_M.z),
        heading_rad: observation.yaw_rad,
        speed_mps: observation.motion.velocity_in_world.length(),
    };
    environment.score().end.is_none().then_some(BodyFigure {
        state,
        height_m: DRONE_M.z,
        radius_m: 0.5 * DRONE_M.x,
        clothes_seed: environment.episode().looks.child("drone", 0),
        gait_phase_rad: 0.0,
        body: BodyShape::of(BodyKind::Drone, DRONE_M),
    })
}

/// Everybody else who is there now, in a rain.
pub fn bystanders(environment: &Environment, rain: f64) -> impl Iterator<Item = FigureInPicture> {
    bystanders_at(environment.episode(), environment.observation().time_s, rain)
}

/// Everybody else who is there at a time, in a rain. The bodies are the only source of their world beside the drones of a team.
pub fn bystanders_at(episode: &Episode, time_s: f64, rain: f64) -> impl Iterator<Item = FigureInPicture> {
    episode.others.at(time_s).map(move |present| FigureInPicture {
        figure: figure(&present, rain),
        instance: episode.place.instance(BodyId::of(0, present.body.number as usize)),
    })
}

/// Somebody who is there as they are drawn in a rain.
fn figure(BodyAtTime { body, state, covered_m }: &BodyAtTime<'_>, rain: f64) -> BodyFigure {
    let dry = BodyFigure::of(&body.plan, *state, *covered_m);
    BodyFigure { body: dry.body.in_rain(rain, &body.plan.looks), ..dry }
}
