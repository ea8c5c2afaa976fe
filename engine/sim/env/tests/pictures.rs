//! Pictures of environments: as the large renderer draws them from the same place, whoever else is drawn beside them.

use cosfly_domain::channels::{self, depth, instance, mask, rgb, semantic};
use cosfly_domain::{Around, Body, BodyId, BodyKind, BodyPlan, Camera, ChannelSet, Town, Traffic, WalkableKind};
use cosfly_domain::{Channel, FrameImages};
use cosfly_env::pictures::{PictureBatch, PictureFormat, Pictures, Pixels, bystanders, target};
use cosfly_env::{Action, Environment, EnvironmentSettings, Episode, FlightSite, Others, Start};
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack};
use cosfly_maps::{MapConfig, read_town};
use cosfly_render::{FrameParts, FrameSetup, PictureLook, Renderer, Scene};
use std::path::Path;
use std::sync::Arc;

const FARTHEST_M: f32 = 150.0;

fn downtown() -> Town {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns/downtown.xodr");
    let map = std::fs::read(path).expect("a shipped town");
    read_town(&map, &MapConfig::default(), Seed([5; 32])).expect("a map").0
}

fn walk(from: DVec3, frames: usize) -> Vec<TargetState> {
    let at = |frame: usize| from + DVec3::new(0.6 * frame as f64, 0.0, 0.0);
    (0..frames).map(|frame| TargetState { feet_in_world: at(frame), heading_rad: 0.0, speed_mps: 1.2 }).collect()
}

/// Environments behind walkers and a car, among people, cars and a bus, some steps after their beginnings.
fn environments(town: &Town, count: usize) -> Vec<Environment> {
    let place = Arc::new(FlightSite::new(Arc::new(town.clone()), Seed([1; 32])));
    let pavements: Vec<_> = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).collect();
    let mut random = Seed([2; 32]).stream("environments");
    let environment = |number: usize| {
        let feet = pavements[random.index(pavements.len())].outline_in_world[0];
        let mut body = |number: u64, kind: BodyKind, size_m: DVec3| {
            let away = DVec3::new(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), 0.0);
            let plan =
                BodyPlan { source: String::new(), kind, size_m, looks: Seed([6; 32]).child("b", number), group: None };
            Body { plan, first_frame: 0, states: walk(feet + away, 20) }
        };
        let people = (0..12).map(|k| (k, BodyKind::Pedestrian, DVec3::new(0.5, 0.5, 1.75)));
        let cars = (12..16).map(|k| (k, BodyKind::Car, DVec3::new(4.5, 1.8, 1.5)));
        let bus = [(16, BodyKind::Bus, DVec3::new(11.0, 2.5, 3.1))];
        let bodies: Vec<Body> = people.chain(cars).chain(bus).map(|(k, kind, size_m)| body(k, kind, size_m)).collect();
        let followed = (number % 3 == 1).then(|| bodies[12].plan.clone());
        let numbers = (0..bodies.len() as u32).collect();
        let around = Around { numbers, traffic: Traffic { dt_s: 0.5, frames: 20, bodies, ..Traffic::default() } };
        let size_m = followed.as_ref().map_or(DVec3::new(0.5, 0.5, 1.7), |plan| plan.size_m);
        let track = TargetTrack { dt_s: 0.5, height_m: size_m.z, radius_m: 0.5 * size_m.y, states: walk(feet, 20) };
        let position_in_world = feet + DVec3::new(random.uniform(-15.0, 15.0), 12.0, random.uniform(8.0, 25.0));
        let episode = Episode {
            name: number.to_string(),
            stratum: String::new(),
            place: Arc::clone(&place),
            target: Arc::new(track),
            others: Arc::new(Others::new(&around, followed.as_ref())),
            followed,
            looks: Seed([number as u8; 32]),
            weather: (number % 2 == 1).then(|| cosfly_materials::presets::preset("WetSunset").expect("a preset")),
            start: Start { position_in_world, velocity_in_world: DVec3::ZERO },
            seed: Seed([0; 32]),
        };
        let mut environment = Environment::new(Arc::new(episode), EnvironmentSettings::default());
        (0..3 * number).for_each(|_| _ = environment.step(Some(&Action::of_numbers([1.0, 0.0, 0.0, 0.0, 2.0]))));
        environment
    };
    (0..count).map(environment).collect()
}

fn format(size: u32) -> PictureFormat {
    let channels = ChannelSet::of(|channel| !channel.is_of_films());
    PictureFormat {
        width: size,
        height: size,
        channels,
        farthest_m: FARTHEST_M,
        weather: None,
        look: PictureLook::Simple,
    }
}

fn bytes<'a>(album: &'a PictureBatch, channel: &Channel) -> &'a [u8] {
    album.of(channel).expect("all channels were asked for").bytes()
}

fn depths_m(album: &PictureBatch) -> &[f32] {
    album.of(&depth::CHANNEL).expect("all channels were asked for").floats()
}

fn ids(album: &PictureBatch) -> &[u32] {
    album.of(&instance::CHANNEL).expect("all channels were asked for").ids()
}

/// Whether a pixel of a channel is that of a large picture, but for roundings.
fn is_same(channel: &Channel, ours: &Pixels, large: &FrameImages, pixel: usize) -> bool {
    let parts = channel.element().parts();
    let near = |theirs: &[u8], most: u8| {
        let own = &ours.bytes()[parts * pixel..parts * (pixel + 1)];
        own.iter().zip(theirs).all(|(ours, theirs)| ours.abs_diff(*theirs) <= most)
    };
    let near_m = |theirs_m: f32| (ours.floats()[pixel] - theirs_m).abs() <= 1e-3 + 1e-5 * theirs_m;
    match channel.name {
        "depth" => near_m(large.depth_m[pixel].min(FARTHEST_M)),
        "semantic" => ours.bytes()[pixel] == large.semantic[pixel],
        "instance" => ours.ids()[pixel] == large.instance[pixel],
        "rgb" => near(&large.rgb[3 * pixel..3 * (pixel + 1)], 2),
        name => {
            let theirs = large.on_request.iter().find(|image| image.channel.name == name).expect("it was asked for");
            let size = channel.bytes_on_request();
            let theirs = &theirs.bytes[size * pixel..size * (pixel + 1)];
            match (ours, <[u8; 4]>::try_from(theirs).map(f32::from_le_bytes)) {
                (Pixels::Floats(floats), Ok(number)) => floats[pixel] == number || near_m(number),
                _ => near(theirs, 1),
            }
        }
    }
}

fn drawn(environments: &[&Environment], size: u32, threads: usize) -> PictureBatch {
    let mut album = PictureBatch::new(&format(size), environments.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| Pictures::new(format(size), threads).draw(environments, &mut album, 0));
    album
}

#[test]
fn pictures_are_those_of_the_large_renderer_at_the_pose_of_the_environment() {
    let town = downtown();
    let scene = Scene::new(&town, Seed([1; 32]));
    let noon = cosfly_materials::presets::preset("ClearNoon").expect("a preset");
    let mut others_seen = 0;
    for (number, environment) in environments(&town, 8).iter().enumerate() {
        for size in [84, 128] {
            let ours = drawn(&[environment], size, 1);
            let horizontal_fov_rad = environment.settings().lens.horizontal_deg.to_radians();
            let others: Vec<_> = bystanders(environment, 0.0).collect();
            let setup = FrameSetup {
                pose: environment.camera(),
                weather: environment.episode().weather.as_ref().unwrap_or(&noon),
                target: Some(target(environment, 0.0)),
                others: &others,
            };
            let mut large = Renderer::new(Camera { width: size, height: size, horizontal_fov_rad });
            large.set_look(PictureLook::Simple);
            large.set_channels(&ChannelSet::of(|_| true));
            let images = large.render_parts(&scene, &setup, FrameParts::All).images;
            let pixels = images.depth_m.len();
            assert!(ours.channels().map(|(channel, _)| channel).eq(channels::of_moments()));
            for (channel, ours) in ours.channels() {
                let wrong = (0..pixels).filter(|pixel| !is_same(channel, ours, images, *pixel)).count();
                assert!(wrong <= pixels.div_ceil(1000), "{number}, {size} px, {}: {wrong} of {pixels}", channel.name);
            }
            let is_body = |id: &u32| others.iter().any(|other| other.instance == *id);
            others_seen += images.instance.iter().filter(|id| is_body(id)).count();
        }
    }
    assert!(others_seen > 500, "{others_seen}");
}

#[test]
fn full_colours_are_those_of_the_large_renderer_in_the_weather_of_the_episode_or_the_format() {
    let town = downtown();
    let scene = Scene::new(&town, Seed([1; 32]));
    let weather = |name: &str| cosfly_materials::presets::preset(name).expect("a preset");
    for (number, environment) in environments(&town, 4).iter().enumerate() {
        for (asked, shown) in [(None, ["ClearNoon", "WetSunset"][number % 2]), (Some("HardRainNight"), "HardRainNight")]
        {
            let size = [84, 128][number / 2];
            let channels = ChannelSet::of(|channel| *channel == rgb::CHANNEL);
            let asked = asked.map(weather);
            let format = PictureFormat { channels, weather: asked, look: PictureLook::Full, ..format(size) };
            let mut album = PictureBatch::new(&format, 1);
            Pictures::new(format, 1).draw(&[environment], &mut album, 0);
            let rain = weather(shown).precipitation;
            let others: Vec<_> = bystanders(environment, rain).collect();
            let target = Some(target(environment, rain));
            let setup = FrameSetup { pose: environment.camera(), weather: &weather(shown), target, others: &others };
            let horizontal_fov_rad = environment.settings().lens.horizontal_deg.to_radians();
            let mut large = Renderer::new(Camera { width: size, height: size, horizontal_fov_rad });
            let colours = &large.render_parts(&scene, &setup, FrameParts::All).images.rgb;
            let wrong = (bytes(&album, &rgb::CHANNEL).iter().zip(colours))
                .filter(|(ours, theirs)| ours.abs_diff(**theirs) > 2)
                .count();
            assert!(wrong <= colours.len().div_ceil(500), "{number}, {shown}: {wrong} of {}", colours.len());
        }
    }
}

#[test]
fn a_picture_is_the_same_alone_and_in_any_batch_on_any_number_of_threads() {
    let all = environments(&downtown(), 7);
    let all: Vec<&Environment> = all.iter().collect();
    let together = drawn(&all, 84, 2);
    assert_eq!(drawn(&all, 84, 1), together);
    let mut singly = PictureBatch::new(&format(84), all.len());
    let mut pictures = Pictures::new(format(84), 1);
    for number in (0..all.len()).rev() {
        pictures.draw(&all[number..=number], &mut singly, number);
    }
    assert_eq!(singly, together);
    let mut copied = PictureBatch::new(&format(84), all.len());
    (0..all.len()).for_each(|number| copied.copy(&together, number));
    assert_eq!(copied, together);
    assert!(bytes(&together, &mask::CHANNEL).contains(&1));
    assert!(depths_m(&together).iter().all(|depth_m| *depth_m <= FARTHEST_M));
}

#[test]
fn drones_of_a_team_are_in_each_others_pictures_and_nobodys_own() {
    let town = downtown();
    let first = environments(&town, 1).remove(0);
    let episode = first.episode();
    let (from, feet) = (episode.start.position_in_world, episode.target_at(0.0).feet_in_world);
    // The second hangs in the first one's line of sight, and a third is behind both.
    let beside = |share: f64| {
        let start = Start { position_in_world: from.lerp(feet + DVec3::Z, share), ..episode.start };
        Environment::new(Arc::new(Episode { start, ..Episode::clone(episode) }), EnvironmentSettings::default())
    };
    let team = [first.clone(), beside(0.15), beside(-0.15)];
    let team: Vec<&Environment> = team.iter().collect();
    let instance = |other: u32| episode.place.instance(BodyId::of_drone(other));
    let pixels = format(128).pixels();
    let drawn_by = |threads: usize| {
        let mut album = PictureBatch::new(&format(128), 3);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Pictures::new(format(128), threads).draw_team(&team, &mut album));
        album
    };
    let album = drawn_by(1);
    assert_eq!(drawn_by(2), album);
    let seen = |own: usize, other: u32| {
        let ids = self::ids(&album)[own * pixels..(own + 1) * pixels].iter();
        ids.filter(|id| **id == instance(other)).count()
    };
    let sees = |own: usize, other: u32| seen(own, other) > 0;
    assert!(sees(0, 1) && sees(2, 0), "those ahead");
    assert!([(0, 0), (0, 2), (1, 0), (1, 1), (1, 2), (2, 2)].iter().all(|(own, other)| !sees(*own, *other)));
    let at = ids(&album)[..pixels].iter().position(|id| *id == instance(1)).expect("the second drone");
    let way_m = 0.15 * (from - feet - DVec3::Z).length();
    assert!((f64::from(depths_m(&album)[at]) - way_m).abs() < 0.6 && bytes(&album, &semantic::CHANNEL)[at] == 21);
    let alone = drawn(&[&first], 128, 1);
    assert!(!ids(&alone).contains(&instance(1)));
}
