//! Laws of vector environments: seeds, modes of autoreset, pictures.

use super::*;
use cosfly_domain::channels::{depth, mask};
use cosfly_domain::{Channel, ChannelSet};
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Episode, FlightSite, Start};
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack};
use cosfly_render::PictureLook;

/// Targets that stand for 1 to 4 s.
fn tasks() -> Arc<[EpisodeTask]> {
    let place = Arc::new(FlightSite::on_flat_ground(vec![]));
    let task = |seconds: usize| {
        let state = TargetState { feet_in_world: 20.0 * DVec3::X, heading_rad: 0.0, speed_mps: 0.0 };
        let states = vec![state; 2 * seconds + 1];
        let episode = Episode {
            name: format!("e{seconds}"),
            stratum: String::new(),
            place: Arc::clone(&place),
            target: Arc::new(TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states }),
            followed: None,
            looks: Seed([0; 32]),
            weather: None,
            others: Arc::default(),
            start: Start { position_in_world: 20.0 * DVec3::Z, velocity_in_world: DVec3::ZERO },
            seed: Seed([0; 32]),
        };
        let knowledge = Knowledge { flight: Arc::new([20.0 * DVec3::Z]), config: Arc::default() };
        EpisodeTask::undrawn(episode, knowledge, 1.0)
    };
    (1..=4).map(task).collect()
}

fn many(mode: Autoreset) -> VectorEnvironment {
    let mut many = VectorEnvironment::new(tasks(), 3, EnvironmentSettings::default(), mode, true);
    many.reset(&[Some(5), Some(6), Some(5)], |_| true);
    many
}

#[test]
fn equal_seeds_fly_equal_episodes_beside_any_others() {
    let mut many = many(Autoreset::SameStep);
    for step in 0..200 {
        many.step(&[[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, f64::from(step), 0.0, 9.0], [1.0, 0.0, 0.0, 0.0, 0.0]]);
        let outputs = many.outputs();
        assert_eq!(outputs.features[0], outputs.features[2]);
        assert_eq!((outputs.rewards[0], many.episode(0)), (outputs.rewards[2], many.episode(2)));
        assert_eq!(outputs.expert_actions[0], outputs.expert_actions[2]);
    }
}

#[test]
fn episodes_end_and_begin_as_each_mode_says() {
    for mode in [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled] {
        let mut many = many(mode);
        let mut steps = 0;
        while !many.outputs().truncated[0] {
            many.step(&[[0.0; ACTIONS]; 3]);
            steps += 1;
        }
        assert_eq!(steps % 10, 0, "whole seconds");
        let is_first = |many: &VectorEnvironment| many.members[0].environment.observation().step == 0;
        assert_eq!(is_first(&many), mode == Autoreset::SameStep);
        let last = many.outputs().clone();
        many.step(&[[0.0; ACTIONS]; 3]);
        assert_eq!(is_first(&many), mode == Autoreset::NextStep);
        match mode {
            Autoreset::NextStep => {
                assert_eq!((many.outputs().rewards[0], many.outputs().truncated[0]), (0.0, false))
            }
            Autoreset::SameStep => assert!(!many.outputs().truncated[0]),
            Autoreset::Disabled => {
                assert!(many.outputs().truncated[0] && many.outputs().features[0] == last.features[0]);
                many.reset(&[], |number| number == 0);
                assert!(is_first(&many) && !many.outputs().truncated[0]);
            }
        }
    }
}

fn depths(album: &PictureBatch) -> &[f32] {
    album.of(&depth::CHANNEL).expect("depth was asked for").floats()
}

fn bytes<'a>(album: &'a PictureBatch, channel: &Channel) -> &'a [u8] {
    album.of(channel).expect("the channel was asked for").bytes()
}

#[test]
fn pictures_are_those_of_the_observations_for_any_number_of_threads_and_in_each_mode() {
    let format = || PictureFormat {
        width: 160,
        height: 120,
        channels: ChannelSet::of(|channel| [&depth::CHANNEL, &mask::CHANNEL].contains(&channel)),
        farthest_m: 99.0,
        weather: None,
        look: PictureLook::Simple,
    };
    for mode in [Autoreset::NextStep, Autoreset::SameStep, Autoreset::Disabled] {
        let mut both = [1, 2].map(|threads| {
            let many = VectorEnvironment::new(tasks(), 3, EnvironmentSettings::default(), mode, false);
            let mut many = many.on_threads(threads).expect("threads").with_pictures(format());
            many.reset(&[Some(5), Some(6), Some(7)], |_| true);
            many
        });
        let alone = |many: &VectorEnvironment, number: usize| {
            let mut album = PictureBatch::new(&format(), 1);
            Pictures::new(format(), 1).draw(&[&many.members[number].environment], &mut album, 0);
            album
        };
        let (mut ended, mut is_seen) = (0, false);
        for step in 0..60 {
            let before: Vec<_> = (0..3).map(|number| both[0].members[number].environment.clone()).collect();
            let action = [0.3, 0.1, 0.0, f64::from(step) % 7.0, 0.0];
            both.iter_mut().for_each(|many| many.step(&[action; 3]));
            let [one, other] = &both;
            assert_eq!(one.outputs.album, other.outputs.album);
            is_seen |= bytes(&one.outputs.album, &mask::CHANNEL).contains(&1);
            let pixels = format().pixels();
            for (number, mut environment) in before.into_iter().enumerate() {
                let part = number * pixels..(number + 1) * pixels;
                let album = &one.outputs.album;
                let alone = alone(one, number);
                assert_eq!(depths(album)[part.clone()], *depths(&alone));
                assert_eq!(bytes(album, &mask::CHANNEL)[part.clone()], *bytes(&alone, &mask::CHANNEL));
                if mode == Autoreset::SameStep && one.outputs.truncated[number] {
                    ended += 1;
                    environment.step(Some(&Action::of_numbers(action.map(|number| f64::from(number as f32)))));
                    let mut last = PictureBatch::new(&format(), 1);
                    Pictures::new(format(), 1).draw(&[&environment], &mut last, 0);
                    assert_eq!(depths(&one.outputs.last_album)[part], *depths(&last));
                }
            }
        }
        assert!(is_seen && (ended > 0) == (mode == Autoreset::SameStep), "{mode:?} {ended}");
    }
}

#[test]
fn a_team_flies_one_episode_from_several_starts() {
    let mut many =
        VectorEnvironment::new(tasks(), 3, EnvironmentSettings::default(), Autoreset::Disabled, false).as_team();
    many.reset(&[Some(5), None, None], |_| true);
    assert!((1..3).all(|number| many.episode(number) == many.episode(0)));
    let place = |many: &VectorEnvironment, number: usize| {
        many.members[number].environment.observation().motion.position_in_world
    };
    assert!(place(&many, 0).distance(place(&many, 1)) > 3.0 && place(&many, 1).distance(place(&many, 2)) > 3.0);
    let beside = &many.outputs().beside[1];
    assert_eq!((beside.len(), beside[0], beside[BESIDE]), (2 * BESIDE, 1.0, 1.0));
    let away = place(&many, 0) - place(&many, 1);
    assert!(
        (DVec3::new(f64::from(beside[1]), f64::from(beside[2]), f64::from(beside[3])).length() - away.length()).abs()
            < 1e-4
    );
}

#[test]
fn drones_of_a_team_that_meet_collide_and_are_out_of_the_way_of_others() {
    let mut many =
        VectorEnvironment::new(tasks(), 3, EnvironmentSettings::default(), Autoreset::Disabled, false).as_team();
    assert!(many.begin_episode(0, "e4"));
    let mut ended = 0;
    while !many.outputs().truncated[2] {
        // The first two fly at each other, the third stays.
        let toward = |one: usize, other: usize| {
            let environment = &many.members[one].environment;
            let (own, goal) = (environment.observation(), many.members[other].environment.observation());
            let way = own.along_heading(goal.motion.position_in_world - own.motion.position_in_world) * 5.0;
            [way.x, way.y, way.z, 0.0, 0.0]
        };
        let actions = [toward(0, 1), toward(1, 0), [0.0; ACTIONS]];
        many.step(&actions);
        let outputs = many.outputs();
        assert_eq!(outputs.terminated[0], outputs.terminated[1]);
        if outputs.terminated[0] && ended == 0 {
            assert!(outputs.rewards[0] < -10.0 && outputs.terms[1][4] == -1.0);
            assert_eq!((outputs.beside[2][0], outputs.beside[2][BESIDE]), (0.0, 0.0));
            ended += 1;
        }
    }
    assert_eq!((ended, many.outputs().terminated[2]), (1, false));
}
