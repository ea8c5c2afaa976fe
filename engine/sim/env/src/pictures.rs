//! [`Pictures`]: what the cameras of environments see, drawn in batches.

use crate::Episode;
use crate::environment::Environment;
use crate::others::BodyAtTime;
use cosfly_batch::{BatchRenderer, Outputs, View};
use cosfly_domain::{BodyId, BodyKind, Weather};
use cosfly_figures::{BodyShape, Bystander, Walker, gait_phase_rad};
use cosfly_frames::{DVec3, TargetState};
use cosfly_render::PictureLook;
use std::ops::Range;

/// A channel of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Planar depth along the optical axis, metres, up to [`PictureFormat::farthest_m`], which the sky has.
    Depth,
    /// CARLA's label ids.
    Semantic,
    /// Ids of objects, people and vehicles: 0 for ground and sky, 1 for the target.
    Instance,
    /// 1 where the target is seen, 0 elsewhere.
    Mask,
    /// Red, green and blue.
    Rgb,
}

impl Channel {
    /// All channels, by name.
    pub const ALL: [(&'static str, Self); 5] = [
        ("depth", Self::Depth),
        ("semantic", Self::Semantic),
        ("instance", Self::Instance),
        ("mask", Self::Mask),
        ("rgb", Self::Rgb),
    ];

    /// The channel of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find_map(|(known, channel)| (known == name).then_some(channel))
    }
}

/// Content of pictures: size, channels, colours.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureFormat {
    /// Columns. Pixels are square; pictures are as wide as the environment's lens.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Channels.
    pub channels: Vec<Channel>,
    /// Greatest depth, metres.
    pub farthest_m: f32,
    /// Weather of colours; each episode's own where there is none.
    pub weather: Option<Weather>,
    /// Look of colours.
    pub look: PictureLook,
}

impl PictureFormat {
    /// Pixels of a picture.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// Pictures of several environments, one after the other, row by row from the top left pixel. Channels that the format lacks are
/// empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PictureBatch {
    pixels: usize,
    /// [`Channel::Depth`].
    pub depth_m: Vec<f32>,
    /// [`Channel::Semantic`].
    pub semantic: Vec<u8>,
    /// [`Channel::Instance`].
    pub instance: Vec<u32>,
    /// [`Channel::Mask`].
    pub mask: Vec<u8>,
    /// [`Channel::Rgb`], three elements a pixel.
    pub rgb: Vec<u8>,
}

impl PictureBatch {
    /// Room for `count` pictures.
    pub fn new(format: &PictureFormat, count: usize) -> Self {
        let length = |channel| if format.channels.contains(&channel) { count * format.pixels() } else { 0 };
        Self {
            pixels: format.pixels(),
            depth_m: vec![0.0; length(Channel::Depth)],
            semantic: vec![0; length(Channel::Semantic)],
            instance: vec![0; length(Channel::Instance)],
            mask: vec![0; length(Channel::Mask)],
            rgb: vec![0; 3 * length(Channel::Rgb)],
        }
    }

    /// Copies the picture of one environment from another album of the same format.
    pub fn copy(&mut self, other: &Self, number: usize) {
        let part = number * self.pixels..(number + 1) * self.pixels;
        copy_part(&mut self.depth_m, &other.depth_m, &part);
        copy_part(&mut self.semantic, &other.semantic, &part);
        copy_part(&mut self.instance, &other.instance, &part);
        copy_part(&mut self.mask, &other.mask, &part);
        copy_part(&mut self.rgb, &other.rgb, &(3 * part.start..3 * part.end));
    }

    /// Fills a picture with zeros.
    fn wipe(&mut self, number: usize) {
        let part = number * self.pixels..(number + 1) * self.pixels;
        fill_part(&mut self.depth_m, &part);
        fill_part(&mut self.semantic, &part);
        fill_part(&mut self.instance, &part);
        fill_part(&mut self.mask, &part);
        fill_part(&mut self.rgb, &(3 * part.start..3 * part.end));
    }

    fn outputs(&mut self, part: Range<usize>) -> Outputs<'_> {
        Outputs {
            depth_m: self.depth_m.get_mut(part.clone()),
            semantic: self.semantic.get_mut(part.clone()),
            instance: self.instance.get_mut(part.clone()),
            target_mask: self.mask.get_mut(part.clone()),
            rgb: self.rgb.get_mut(3 * part.start..3 * part.end),
        }
    }
}

fn fill_part<T: Copy + Default>(channel: &mut [T], part: &Range<usize>) {
    if let Some(part) = channel.get_mut(part.clone()) {
        part.fill(T::default());
    }
}

fn copy_part<T: Copy>(to: &mut [T], from: &[T], part: &Range<usize>) {
    if let (Some(to), Some(from)) = (to.get_mut(part.clone()), from.get(part.clone())) {
        to.copy_from_slice(from);
    }
}

/// Draws what the cameras of environments see. A picture depends on its environment and the format alone.
pub struct Pictures {
    format: PictureFormat,
    renderer: BatchRenderer,
    bystanders: Vec<Bystander>,
    /// The bystanders of each view.
    ranges: Vec<Range<usize>>,
}

impl Pictures {
    /// Up to `threads` pictures are drawn at a time, on the rayon pool that calls [`Self::draw`]; the number changes no byte.
    pub fn new(format: PictureFormat, threads: usize) -> Self {
        let renderer = BatchRenderer::on_threads(format.width, format.height, threads);
        Self { format, renderer, bystanders: vec![], ranges: vec![] }
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
        self.draw_beside(environments, |_| None, album, first);
    }

    /// Pictures of drones of a team, each of which sees the others that fly.
    ///
    /// # Panics
    /// Where the album has no room for all pictures.
    pub fn draw_team(&mut self, environments: &[&Environment], album: &mut PictureBatch) {
        let drones: Vec<Option<Walker>> = environments.iter().map(|environment| drone(environment)).collect();
        self.draw_beside(environments, |number| drones.get(number).copied().flatten(), album, 0);
    }

    /// Draws pictures with drones of their numbers, each of which all environments see but its own.
    fn draw_beside(
        &mut self,
        environments: &[&Environment],
        drone: impl Fn(usize) -> Option<Walker>,
        album: &mut PictureBatch,
        first: usize,
    ) {
        let Self { format, renderer, bystanders, ranges } = self;
        bystanders.clear();
        ranges.clear();
        for (own, environment) in environments.iter().enumerate() {
            let start = bystanders.len();
            let rain = rain(format, environment);
            bystanders.extend(self::bystanders(environment, rain));
            let others = (0..environments.len()).filter(|number| *number != own);
            bystanders.extend(others.filter_map(|number| {
                let instance = environment.episode().place.instance(BodyId::of_drone(number as u32));
                drone(number).map(|walker| Bystander { walker, instance })
            }));
            ranges.push(start..bystanders.len());
        }
        let has_colours = format.channels.contains(&Channel::Rgb);
        let views: Vec<View<'_>> = (environments.iter().zip(&*ranges))
            .map(|(environment, range)| View {
                scene: environment.episode().place.scene(has_colours),
                pose: environment.camera(),
                horizontal_fov_rad: environment.settings().lens.horizontal_deg.to_radians(),
                target: Some(target(environment, rain(format, environment))),
                others: &bystanders[range.clone()],
                weather: weather(format, environment),
                look: format.look,
                figures: &[],
            })
            .collect();
        let pixels = format.pixels();
        let part = first * pixels..(first + views.len()) * pixels;
        renderer.render(&views, album.outputs(part.clone()));
        for depth_m in album.depth_m.get_mut(part).into_iter().flatten() {
            *depth_m = depth_m.min(format.farthest_m);
        }
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
pub fn target(environment: &Environment, rain: f64) -> Walker {
    let episode = environment.episode();
    let (track, state) = (&episode.target, episode.target_at(environment.observation().time_s));
    let body = episode.followed.as_ref().map_or(BodyShape::default(), |plan| BodyShape::of(plan.kind, plan.size_m));
    Walker {
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
fn drone(environment: &Environment) -> Option<Walker> {
    let observation = environment.observation();
    let state = TargetState {
        feet_in_world: observation.motion.position_in_world - DVec3::Z * (0.5 * DRONE_M.z),
        heading_rad: observation.yaw_rad,
        speed_mps: observation.motion.velocity_in_world.length(),
    };
    environment.score().end.is_none().then_some(Walker {
        state,
        height_m: DRONE_M.z,
        radius_m: 0.5 * DRONE_M.x,
        clothes_seed: environment.episode().looks.child("drone", 0),
        gait_phase_rad: 0.0,
        body: BodyShape::of(BodyKind::Drone, DRONE_M),
    })
}

/// Everybody else who is there now, in a rain.
pub fn bystanders(environment: &Environment, rain: f64) -> impl Iterator<Item = Bystander> {
    bystanders_at(environment.episode(), environment.observation().time_s, rain)
}

/// Everybody else who is there at a time, in a rain. The bodies are the only source of their world beside the drones of a team.
pub fn bystanders_at(episode: &Episode, time_s: f64, rain: f64) -> impl Iterator<Item = Bystander> {
    episode.others.at(time_s).map(move |present| Bystander {
        walker: walker(&present, rain),
        instance: episode.place.instance(BodyId::of(0, present.mover.number as usize)),
    })
}

/// Somebody who is there as they are drawn in a rain.
fn walker(BodyAtTime { mover, state, covered_m }: &BodyAtTime<'_>, rain: f64) -> Walker {
    let dry = Walker::of(&mover.plan, *state, *covered_m);
    Walker { body: dry.body.in_rain(rain, &mover.plan.looks), ..dry }
}
